//! What a run still has to tell that ends earlier than its document has it, as `--until` makes it.

use super::document::Document;
use super::{Experiment, MeasureCurve, OneOrMany, PlotKind, When};
use crate::error::words;
use crate::units::{Dimension, pretty};

/// Something in a document that lies beyond the end of the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Late {
    /// A measure, by its name.
    Measure(String),
    /// The instant of the picture.
    Picture,
    /// One of the instants of a plot: the numbers of both.
    Plot(usize, usize),
}

impl Document {
    /// Leaves out what lies beyond the end, and the plots that show it; notes what that was.
    pub(super) fn leave_out(&mut self, late: &[Late]) {
        let experiment = &mut self.experiment;
        let measures: Vec<&str> = late
            .iter()
            .filter_map(|late| if let Late::Measure(name) = late { Some(name.as_str()) } else { None })
            .filter(|name| experiment.measure.shift_remove(*name).is_some())
            .collect();
        self.left_out.extend((!measures.is_empty()).then(|| counted("measure", &measures)));
        let plots = leave_out_of_plots(experiment, late, &measures);
        let plots: Vec<&str> = plots.iter().map(String::as_str).collect();
        self.left_out.extend((!plots.is_empty()).then(|| counted("plot", &plots)));
        if late.contains(&Late::Picture) {
            experiment.picture.time = When::Last;
            self.left_out.push("the time of the picture, which shows the last frame".to_owned());
        }
    }

    /// What was left out because the run is cut short, as a sentence; none where nothing was.
    pub(super) fn what_is_left_out(&self) -> Option<String> {
        let until = pretty(self.experiment.run.until.value(), Dimension::TIME);
        let all = self.left_out.join("; ");
        (!self.left_out.is_empty()).then(|| format!("left out, as the run ends at {until} and they look beyond: {all}"))
    }
}

/// "measures `a` and `b`".
fn counted(what: &str, names: &[&str]) -> String {
    format!("{what}{} {}", if names.len() > 1 { "s" } else { "" }, words::all_of(names.iter().copied()))
}

/// Takes late instants out of plots, and plots out of which nothing is left or that need a measure which was left out; returns the names
/// of these.
fn leave_out_of_plots(experiment: &mut Experiment, late: &[Late], measures: &[&str]) -> Vec<String> {
    let mut number = 0;
    let mut gone = Vec::new();
    experiment.plot.retain_mut(|plot| {
        let is_late = |instant: usize| late.contains(&Late::Plot(number, instant));
        let is_left = match &mut plot.kind {
            PlotKind::Profile { times: Some(times), .. } => {
                let kept = times.as_slice().iter().enumerate().filter(|(instant, _)| !is_late(*instant));
                let kept: Vec<When> = kept.map(|(_, time)| *time).collect();
                let is_left = !kept.is_empty();
                *times = OneOrMany::Many(kept);
                is_left
            }
            PlotKind::Measures { curves, .. } => !curves.iter().any(|curve| needs(curve, measures)),
            _ => true,
        };
        gone.extend((!is_left).then(|| plot.name.clone()));
        number += 1;
        is_left
    });
    gone
}

fn needs(curve: &MeasureCurve, measures: &[&str]) -> bool {
    let lists = [Some(&curve.y), curve.low.as_ref(), curve.high.as_ref()];
    lists.into_iter().flatten().any(|list| list.as_slice().iter().any(|name| measures.contains(&name.as_str())))
}
