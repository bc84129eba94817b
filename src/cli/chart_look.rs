//! What the axes of a chart are like and which words stand at it, as the command line says.

use crate::error::{Error, Fault, Result};
use crate::picture::chart::{Aspect, Axis, Chart, Ground, Range, Scale};

/// Options about the look of charts.
#[derive(Debug, Clone, clap::Args)]
pub struct ChartLook {
    /// Axes that count in powers of ten: x, y or xy.
    #[arg(long, value_name = "AXES", value_parser = ["x", "y", "xy"])]
    pub log: Option<String>,
    /// From where to where the x axis goes, in its unit; round numbers around the data when absent.
    #[arg(long, value_name = "LOW,HIGH", value_parser = super::render::ends, allow_hyphen_values = true)]
    pub x_range: Option<[f64; 2]>,
    /// From where to where the y axis goes.
    #[arg(long, value_name = "LOW,HIGH", value_parser = super::render::ends, allow_hyphen_values = true)]
    pub y_range: Option<[f64; 2]>,
    /// The label of the x axis.
    #[arg(long, value_name = "TEXT")]
    pub x_label: Option<String>,
    /// The label of the y axis.
    #[arg(long, value_name = "TEXT")]
    pub y_label: Option<String>,
    /// The title; that of the chart or the experiment when absent.
    #[arg(long, value_name = "TEXT", conflicts_with = "no_title")]
    pub title: Option<String>,
    /// Leaves out the title.
    #[arg(long)]
    pub no_title: bool,
}

impl ChartLook {
    /// Changes the chart of this name as the options say.
    ///
    /// # Errors
    /// [`Error::Input`] for an axis that cannot be what is asked for.
    pub fn apply(&self, chart: &mut Chart, name: &str) -> Result<()> {
        if self.no_title {
            chart.title.clear();
        }
        self.title.iter().for_each(|title| chart.title.clone_from(title));
        let is_map = chart.aspect == Aspect::Equal || chart.ground != Ground::Frame || chart.heat.is_some();
        let log = self.log.as_deref().unwrap_or_default();
        if is_map && !log.is_empty() {
            let fault = Fault::new(format!("--log {log}: {name} is a map, whose axes are linear"));
            return Err(Error::input(fault.help("curves, points and histograms may have logarithmic axes, and a kymograph logarithmic colours (--log-colours)")));
        }
        let axes = [('x', &mut chart.x, self.x_range, &self.x_label), ('y', &mut chart.y, self.y_range, &self.y_label)];
        for (letter, axis, range, label) in axes {
            label.iter().for_each(|label| axis.label.clone_from(label));
            if log.contains(letter) {
                axis.scale = Scale::Log;
            }
            if let Some([low, high]) = range {
                checked(axis, letter, low)?;
                axis.range = Range::Fixed(low, high);
            }
        }
        Ok(())
    }
}

/// Makes sure that an axis may begin at `low`.
fn checked(axis: &Axis, letter: char, low: f64) -> Result<()> {
    if axis.scale == Scale::Log && low <= 0.0 {
        let fault = Fault::new(format!("--{letter}-range: a logarithmic axis cannot begin at {low}"));
        return Err(Error::input(fault.help("let it begin above 0, as in 0.1,100")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(options: &[&str]) -> ChartLook {
        #[derive(clap::Parser)]
        struct Line {
            #[command(flatten)]
            look: ChartLook,
        }
        <Line as clap::Parser>::parse_from([&["plot"], options].concat()).look
    }

    #[test]
    fn axes_and_words_are_what_is_asked_for_and_else_what_they_were() {
        let start = Chart { title: "t".into(), x: Axis::linear("x"), y: Axis::linear("y"), ..Chart::default() };
        let mut chart = start.clone();
        look(&[]).apply(&mut chart, "c").expect("nothing to do");
        assert_eq!(chart, start);
        let options = ["--log", "y", "--y-range", "0.1,100", "--x-range", "-5,5", "--x-label", "a", "--title", "b"];
        look(&options).apply(&mut chart, "c").expect("axes that may be so");
        let x = Axis { label: "a".into(), range: Range::Fixed(-5.0, 5.0), ..start.x.clone() };
        let y = Axis { range: Range::Fixed(0.1, 100.0), scale: Scale::Log, ..start.y.clone() };
        assert_eq!(chart, Chart { title: "b".into(), x, y, ..start.clone() });
        look(&["--no-title"]).apply(&mut chart, "c").expect("a chart without a title");
        assert!(chart.title.is_empty());
        let mut map = Chart { aspect: Aspect::Equal, ..start };
        assert!(look(&["--log", "x"]).apply(&mut map, "tracks").is_err());
    }
}
