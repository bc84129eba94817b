//! `pseudopod plot`: charts of a result file.

use super::chart_look::ChartLook;
use super::files::{Named, refuse_existing};
use super::report::Report;
use super::track_file::Known;
use crate::analysis::tracks::Tracks;
use crate::analysis::tracks::motion::Quantity;
use crate::analysis::tracks::read::Read;
use crate::error::words::any_of;
use crate::error::{Error, Fault, Result};
use crate::experiment::{Axis, FieldLine, OneOrMany, Plot, PlotKind, When};
use crate::output::ResultFile;
use crate::picture::display::known;
use crate::picture::from_file::beside;
use crate::picture::plots::chart_of;
use crate::picture::save_chart;
use crate::picture::track_plots::{self, Group};
use crate::units::Length;
use std::path::PathBuf;

/// Draws the charts of the experiment, or one of its own.
#[derive(Debug, Clone, clap::Args)]
pub struct PlotArgs {
    /// The result file; or measured tracks, a CSV file or the folder of a biotracks package.
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
    /// Into which directions cells came.
    #[arg(long, conflicts_with_all = ["y", "name", "tracks", "msd"])]
    pub rose: bool,
    /// How a number that each track has is distributed.
    #[arg(long, value_name = "QUANTITY", value_parser = quantity, conflicts_with_all = ["y", "name", "tracks", "msd", "rose"])]
    pub histogram: Option<Quantity>,
    /// The columns of a histogram, or the sectors of a rose; chosen when absent.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(3..=72))]
    pub bins: Option<u32>,
    /// What a file with measured tracks does not say by itself.
    #[command(flatten)]
    pub known: Known,
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
    /// Colours of a kymograph that count in powers of ten, for a field over decades.
    #[arg(long, requires = "kymograph")]
    pub log_colours: bool,
    /// The type of cells that is shown; what the chart says, or all, when absent.
    #[arg(long, value_name = "TYPE")]
    pub cells: Option<String>,
    /// Axes and words.
    #[command(flatten)]
    pub look: ChartLook,
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
    if let Some(read) = args.known.read(&args.result)? {
        return plot_tracks(args, read);
    }
    let result = ResultFile::open(&args.result)?;
    let document = crate::run::recorded_document_of(result.header(), &args.result)?;
    let mut plots = wanted(args, &document.experiment.plot)?;
    if let Some(name) = &args.cells {
        known(name, &result.layout().type_names())?;
        plots.iter_mut().for_each(|plot| plot.cells = Some(name.clone()));
    }
    for ending in plots.iter().flat_map(|plot| ["svg", "png"].map(|ending| format!("{}.{ending}", plot.name))) {
        refuse_existing(&beside(&args.result, &ending), args.force, Named::ByItself)?;
    }
    let mut made = Vec::new();
    for plot in plots {
        let mut chart = chart_of(&result, &document, &plot)?;
        args.look.apply(&mut chart, &plot.name)?;
        made.extend(save_chart(&chart, &beside(&args.result, &plot.name))?);
    }
    Ok(Report::of_files(&args.result, &made))
}

/// The charts of measured tracks: the one that is asked for, or paths, displacements and directions.
fn plot_tracks(args: &PlotArgs, read: Read) -> Result<Report> {
    let unlike =
        [("--y", !args.y.is_empty()), ("--profile", args.profile.is_some()), ("--kymograph", args.kymograph.is_some())];
    let unlike = unlike.into_iter().find(|(_, given)| *given).map(|(option, _)| option.to_owned());
    if let Some(what) = unlike.or_else(|| args.name.clone()) {
        let fault = Fault::new(format!("{what}: {} has tracks and nothing else", args.result.display()));
        return Err(Error::input(fault.help("use --tracks, --msd, --rose or --histogram")));
    }
    let file = args.result.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let mut groups = groups_of(read.tracks, &file)?;
    if let Some(name) = &args.cells {
        known(name, &groups.iter().map(|group| group.label.clone()).collect::<Vec<_>>())?;
        groups.retain(|group| group.label == *name);
    }
    let all = !(args.tracks || args.msd || args.rose || args.histogram.is_some());
    let mut charts = Vec::new();
    if args.tracks || all {
        charts.push(("tracks".to_owned(), track_plots::paths(&groups)));
    }
    if args.msd || all {
        charts.push(("msd".to_owned(), track_plots::displacements(&groups, None, 0)));
    }
    if args.rose || all {
        charts.push(("rose".to_owned(), track_plots::rose(&groups, args.bins.unwrap_or(track_plots::SECTORS))?));
    }
    if let Some(quantity) = args.histogram {
        charts.push((histogram_name(quantity), track_plots::histogram(&groups, quantity, args.bins)?));
    }
    for ending in charts.iter().flat_map(|(name, _)| ["svg", "png"].map(|ending| format!("{name}.{ending}"))) {
        refuse_existing(&beside(&args.result, &ending), args.force, Named::ByItself)?;
    }
    let mut made = Vec::new();
    for (name, mut chart) in charts {
        chart.title = file.clone();
        args.look.apply(&mut chart, &name)?;
        made.extend(save_chart(&chart, &beside(&args.result, &name))?);
    }
    Ok(Report::of_files(&args.result, &made))
}

/// Tracks by the types of their cells, in the order of the file.
fn groups_of(tracks: Tracks, file: &str) -> Result<Vec<Group>> {
    let mut kinds: Vec<String> = Vec::new();
    tracks.types.iter().for_each(|kind| {
        if !kinds.contains(kind) {
            kinds.push(kind.clone());
        }
    });
    if let [only] = &kinds[..] {
        let label = if only.is_empty() { file.to_owned() } else { only.clone() };
        return Ok(vec![Group { label, tracks, colour: None }]);
    }
    kinds
        .into_iter()
        .map(|kind| Ok(Group { tracks: tracks.clone().of_type(&kind)?, label: kind, colour: None }))
        .collect()
}

fn histogram_name(quantity: Quantity) -> String {
    format!("histogram-{}", quantity.label().replace(' ', "-"))
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
    if args.rose {
        return Ok(vec![own("rose", PlotKind::Rose { sectors: args.bins })]);
    }
    if let Some(quantity) = args.histogram {
        return Ok(vec![own(&histogram_name(quantity), PlotKind::Histogram { quantity, bins: args.bins })]);
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
        let kind = PlotKind::Kymograph { line: line(field), range: args.range, log: args.log_colours };
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
            true => "it declares no [[plot]]; name series with --y, or use --tracks, --msd, --rose, --histogram, --profile or --kymograph"
                .to_owned(),
            false => format!("its charts are: {}; or name series with --y", names.join(", ")),
        };
        let fault = Fault::new(format!("the experiment has no chart \"{name}\"")).help(help);
        return Err(Error::input(fault));
    }
    Ok(found)
}

fn quantity(text: &str) -> std::result::Result<Quantity, String> {
    let all = [
        Quantity::MeanSpeed,
        Quantity::Directness,
        Quantity::PathLength,
        Quantity::NetDisplacement,
        Quantity::TurningAngle,
    ];
    let name = |quantity: &Quantity| quantity.label().replace(' ', "_");
    let found = all.iter().find(|quantity| name(quantity) == text.replace('-', "_"));
    found
        .copied()
        .ok_or_else(|| format!("give {}", any_of(all.iter().map(name).collect::<Vec<_>>().iter().map(String::as_str))))
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
