//! `pseudopod plot`: charts of a result file.

use super::render::{Named, refuse_existing};
use super::report::Report;
use crate::error::{Error, Fault, Result};
use crate::experiment::{OneOrMany, Plot, PlotKind};
use crate::output::ResultFile;
use crate::picture::from_file::beside;
use crate::picture::plots::chart_of;
use crate::picture::save_chart;
use std::path::PathBuf;

/// Draws the charts of the experiment, or one of its own.
#[derive(Debug, Clone, clap::Args)]
pub struct PlotArgs {
    /// The result file.
    pub result: PathBuf,
    /// A chart that the experiment names; all of them when absent.
    pub name: Option<String>,
    /// Series along y, by commas: a chart of its own.
    #[arg(long, value_delimiter = ',', value_name = "SERIES")]
    pub y: Vec<String>,
    /// Series along x; time when absent.
    #[arg(long, requires = "y", value_name = "SERIES")]
    pub x: Option<String>,
    /// The tracks of the cells seen from above.
    #[arg(long, conflicts_with_all = ["y", "name"])]
    pub tracks: bool,
    /// The mean squared displacement.
    #[arg(long, conflicts_with_all = ["y", "name", "tracks"])]
    pub msd: bool,
    /// Replaces files that are there.
    #[arg(long)]
    pub force: bool,
    /// Prints what was made as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command.
///
/// # Errors
/// A result, chart or series that is not there; files that exist or cannot be written.
pub fn run(args: &PlotArgs) -> Result<Report> {
    let result = ResultFile::open(&args.result)?;
    let document = crate::run::document_of(result.header(), &args.result)?;
    let plots = wanted(args, &document.experiment.plot)?;
    for ending in plots.iter().flat_map(|plot| ["svg", "png"].map(|ending| format!("{}.{ending}", plot.name))) {
        refuse_existing(&beside(&args.result, &ending), args.force, Named::ByItself)?;
    }
    let mut made = Vec::new();
    for plot in plots {
        made.extend(save_chart(&chart_of(&result, &document, &plot)?, &beside(&args.result, &plot.name))?);
    }
    Ok(Report::of_files(&args.result, &made))
}

/// The charts that the arguments ask for.
fn wanted(args: &PlotArgs, known: &[Plot]) -> Result<Vec<Plot>> {
    let own = |name: &str, kind: PlotKind| Plot {
        name: name.to_owned(),
        kind,
        cells: None,
        table: None,
        title: None,
        x_label: None,
        y_label: None,
    };
    if args.tracks {
        return Ok(vec![own("tracks", PlotKind::Tracks)]);
    }
    if args.msd {
        return Ok(vec![own("msd", PlotKind::Msd { speed: None, persistence: None })]);
    }
    if !args.y.is_empty() {
        let y = OneOrMany::Many(args.y.clone());
        let kind = match &args.x {
            Some(x) => PlotKind::Curve { x: x.clone(), y },
            None => PlotKind::Series { y },
        };
        return Ok(vec![own(&args.y.join("-"), kind)]);
    }
    let Some(name) = &args.name else { return Ok(known.to_vec()) };
    let found: Vec<Plot> = known.iter().filter(|plot| plot.name == *name).cloned().collect();
    if found.is_empty() {
        let names: Vec<&str> = known.iter().map(|plot| plot.name.as_str()).collect();
        let help = match names.is_empty() {
            true => "it declares no [[plot]]; name series with --y, or use --tracks or --msd".to_owned(),
            false => format!("its charts are: {}; or name series with --y", names.join(", ")),
        };
        let fault = Fault::new(format!("the experiment has no chart \"{name}\"")).help(help);
        return Err(Error::input(fault));
    }
    Ok(found)
}
