//! `pseudopod plot`: charts of a result file.

use super::render::{Named, refuse_existing};
use super::report::Report;
use crate::error::{Error, Fault, Result};
use crate::experiment::{Axis, FieldLine, OneOrMany, Plot, PlotKind, When};
use crate::output::ResultFile;
use crate::picture::from_file::beside;
use crate::picture::plots::chart_of;
use crate::picture::save_chart;
use crate::units::Length;
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
    /// Every cell as a thin line besides the mean.
    #[arg(long, requires = "y", conflicts_with = "x")]
    pub each_cell: bool,
    /// A field along an axis at some instants: FIELD or FIELD.SPECIES.
    #[arg(long, value_name = "FIELD", conflicts_with_all = ["y", "name", "tracks", "msd"])]
    pub profile: Option<String>,
    /// A field along an axis against time, as colours.
    #[arg(long, value_name = "FIELD", conflicts_with_all = ["y", "name", "tracks", "msd", "profile"])]
    pub kymograph: Option<String>,
    /// The axis of a profile or kymograph: x, y or z; x when absent.
    #[arg(long, value_name = "AXIS", value_parser = axis)]
    pub along: Option<Axis>,
    /// A point that a profile or kymograph goes through, in um, as in 10,20,0; the mean over the other axes when absent.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub through: Option<[Length; 3]>,
    /// The instants of a profile, by commas: first, last, or times such as "12 s"; five of the run when absent.
    #[arg(long, value_delimiter = ',', value_name = "TIME", requires = "profile", value_parser = instant)]
    pub times: Vec<When>,
    /// The numbers at the ends of a kymograph's colour bar; those of the field when absent.
    #[arg(long, value_name = "LOW,HIGH", requires = "kymograph", value_parser = super::render::ends, allow_hyphen_values = true)]
    pub range: Option<[f64; 2]>,
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
    let line = |field: &String| FieldLine {
        field: Some(field.clone()),
        along: args.along.unwrap_or(Axis::X),
        through: args.through,
    };
    let file = |kind: &str, field: &str| format!("{kind}-{}", field.replace(['.', '/'], "-"));
    if let Some(field) = &args.profile {
        let times = (!args.times.is_empty()).then(|| OneOrMany::Many(args.times.clone()));
        return Ok(vec![own(&file("profile", field), PlotKind::Profile { line: line(field), times })]);
    }
    if let Some(field) = &args.kymograph {
        let kind = PlotKind::Kymograph { line: line(field), range: args.range };
        return Ok(vec![own(&file("kymograph", field), kind)]);
    }
    if args.along.is_some() || args.through.is_some() {
        let fault = Fault::new("--along and --through belong to a field");
        return Err(Error::input(fault.help("add --profile FIELD or --kymograph FIELD")));
    }
    if !args.y.is_empty() {
        let y = OneOrMany::Many(args.y.clone());
        let kind = match &args.x {
            Some(x) => PlotKind::Curve { x: x.clone(), y },
            None => PlotKind::Series { y, each_cell: args.each_cell },
        };
        return Ok(vec![own(&args.y.join("-"), kind)]);
    }
    let Some(name) = &args.name else { return Ok(known.to_vec()) };
    let found: Vec<Plot> = known.iter().filter(|plot| plot.name == *name).cloned().collect();
    if found.is_empty() {
        let names: Vec<&str> = known.iter().map(|plot| plot.name.as_str()).collect();
        let help = match names.is_empty() {
            true => "it declares no [[plot]]; name series with --y, or use --tracks, --msd, --profile or --kymograph"
                .to_owned(),
            false => format!("its charts are: {}; or name series with --y", names.join(", ")),
        };
        let fault = Fault::new(format!("the experiment has no chart \"{name}\"")).help(help);
        return Err(Error::input(fault));
    }
    Ok(found)
}

fn axis(text: &str) -> std::result::Result<Axis, String> {
    match text {
        "x" => Ok(Axis::X),
        "y" => Ok(Axis::Y),
        "z" => Ok(Axis::Z),
        _ => Err("give x, y or z".to_owned()),
    }
}

/// Three numbers, µm.
fn point(text: &str) -> std::result::Result<[Length; 3], String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|number| number.is_finite()) => Ok([x, y, z].map(Length::new)),
        _ => Err("give three numbers in um, as in 10,20,0".to_owned()),
    }
}

fn instant(text: &str) -> std::result::Result<When, String> {
    text.trim()
        .parse::<When>()
        .map_err(|fault| format!("{}; write first, last, or a time such as \"12 s\"", fault.message))
}
