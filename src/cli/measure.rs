//! `pseudopod measure`: the measures of cell migration of tracks, simulated or measured.

use super::files::{Named, refuse_existing, refuse_same};
use super::report::Report;
use super::track_file::{Told, TrackArgs};
use crate::analysis::bootstrap::{self, Estimate};
use crate::analysis::furth::Localisation;
use crate::analysis::msd;
use crate::analysis::tracks::Tracks;
use crate::analysis::tracks::motion::{Cue, Motion, Quantity};
use crate::analysis::tracks::summary::{Line, Wishes, forward_indices, summary};
use crate::analysis::tracks::velocity::{Correlated, products};
use crate::error::{Error, Fault, Result, short};
use crate::output::write_text;
use serde_json::{Map, Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// Measures tracks: speed, directness, forward migration index, displacements, persistence, directions, with intervals of 95 % by the bootstrap over cells.
#[derive(Debug, Clone, clap::Args)]
pub struct MeasureArgs {
    /// The tracks.
    #[command(flatten)]
    pub tracks: TrackArgs,
    /// The direction of the cue, for the forward migration indices, as in 1,0 or 0,0,1.
    #[arg(long, value_name = "X,Y[,Z]", value_parser = super::track_file::vector, allow_hyphen_values = true, conflicts_with = "towards")]
    pub cue: Option<[f64; 3]>,
    /// A point where the cue comes from, in um, in place of a direction.
    #[arg(long, value_name = "X,Y[,Z]", value_parser = super::track_file::vector, allow_hyphen_values = true)]
    pub towards: Option<[f64; 3]>,
    /// The longest lag of displacements, in intervals between frames; a quarter of the frames when absent.
    #[arg(long, value_name = "NUMBER")]
    pub lags: Option<usize>,
    /// Positions without an error: no error of localisation is fitted. So it is for result files.
    #[arg(long, conflicts_with = "noisy")]
    pub exact: bool,
    /// Positions with an error that is fitted, too. So it is for measured tracks.
    #[arg(long)]
    pub noisy: bool,
    /// A table to write, as CSV; --table says which.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// What the table holds; a row for each track when absent.
    #[arg(long, value_enum, requires = "output")]
    pub table: Option<TableKind>,
    /// Seed of the draws of cells for intervals.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
    /// Prints what was measured as JSON.
    #[arg(long)]
    pub json: bool,
}

/// What a table holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum TableKind {
    /// A row per track with its measures.
    Tracks,
    /// A row per lag: the mean squared displacement with its interval.
    Msd,
    /// A row per lag: the autocorrelations of velocities and of directions with their intervals.
    Correlation,
}

/// Runs the command.
///
/// # Errors
/// Tracks that cannot be read; a cue without a length; a file that exists or cannot be written.
pub fn run(args: &MeasureArgs) -> Result<Report> {
    if let Some(output) = &args.output {
        refuse_same(&[&args.tracks.file, output])?;
        refuse_existing(output, args.force, Named::ByUser)?;
    }
    let cue = match (args.cue, args.towards) {
        (Some(direction), _) if direction == [0.0; 3] => {
            let fault = Fault::new("the cue 0,0 has no length and so no direction");
            return Err(Error::input(fault.help("give a direction such as 1,0")));
        }
        (Some(direction), _) => Some(Cue::Direction(direction)),
        (None, point) => point.map(Cue::Point),
    };
    let Told { tracks, notes, simulated } = args.tracks.read()?;
    let exact = args.exact || simulated && !args.noisy;
    let localisation = if exact { Localisation::Exact } else { Localisation::Noisy };
    let lags = match args.lags {
        Some(longest) => (1..=longest.clamp(1, tracks.times.len().saturating_sub(1).max(1))).collect(),
        None => tracks.usual_lags(),
    };
    let wishes = Wishes { cue, localisation, lags, seed: args.seed };
    let lines = summary(&tracks, &wishes);
    let mut report = tell(&args.tracks.file.display().to_string(), &tracks, &lines, &notes);
    if let Some(output) = &args.output {
        let text = match args.table.unwrap_or(TableKind::Tracks) {
            TableKind::Tracks => table_of_tracks(&tracks, cue),
            TableKind::Msd => table_of_displacements(&tracks, &wishes),
            TableKind::Correlation => table_of_correlations(&tracks, &wishes),
        };
        write_text(&text, output)?;
        let _ = writeln!(report.words, "{}", output.display());
        report = report.fact("files", super::report::paths(std::slice::from_ref(output)));
    }
    Ok(report)
}

/// The page for people and the object for scripts, in which what is not defined is null.
fn tell(name: &str, tracks: &Tracks, lines: &[Line], notes: &[String]) -> Report {
    let space = if tracks.axes() == 2 { "in the plane" } else { "in space" };
    let (number, frames, interval) = (tracks.number(), tracks.times.len(), tracks.interval());
    let plural = if number == 1 { "" } else { "s" };
    let mut words = format!("{name}: {number} track{plural} {space}, {frames} frames");
    if !interval.is_nan() {
        let _ = write!(words, " of {} s", short(interval));
    }
    words.push_str("\n\n");
    let unit = |line: &Line| if line.unit == "1" { String::new() } else { format!(" {}", line.unit) };
    let width = lines.iter().map(|line| line.label.chars().count()).max().unwrap_or(0);
    let mut measures = Map::new();
    for line in lines {
        let Estimate { value, low, high } = line.estimate;
        let _ = write!(words, "  {:width$}  ", line.label);
        let _ = match &line.undefined {
            Some(why) => writeln!(words, "NaN: {why}"),
            None if low.is_nan() => writeln!(words, "{}{}", rounded(value), unit(line)),
            None => writeln!(words, "{} ({} to {}){}", rounded(value), rounded(low), rounded(high), unit(line)),
        };
        let number = |value: f64| if value.is_nan() { Value::Null } else { json!(value) };
        let mut facts = json!({ "value": number(value), "low": number(low), "high": number(high), "unit": line.unit });
        if let Some(why) = &line.undefined {
            facts["undefined"] = json!(why);
        }
        measures.insert(line.name.to_owned(), facts);
    }
    let level = 100.0 * bootstrap::LEVEL;
    let _ =
        writeln!(words, "\nMeans over tracks; in brackets what holds {level} % of {} draws of them.", bootstrap::DRAWS);
    for note in notes {
        let _ = writeln!(words, "note: {note}");
    }
    Report { words, ..Report::default() }
        .fact("tracks", number)
        .fact("axes", tracks.axes())
        .fact("frames", frames)
        .fact("interval_s", interval)
        .fact("measures", measures)
        .fact("notes", notes.to_vec())
}

/// Four digits that count: intervals say that more would be noise.
fn rounded(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-4 {
        return format!("{value:.1e}");
    }
    format!("{value:.3e}").parse::<f64>().unwrap_or(value).to_string()
}

/// A row for each track.
fn table_of_tracks(tracks: &Tracks, cue: Option<Cue>) -> String {
    let quantities = [
        Quantity::MeanSpeed,
        Quantity::Directness,
        Quantity::PathLength,
        Quantity::NetDisplacement,
        Quantity::TurningAngle,
    ];
    let mut text = String::from("TRACK_ID,TYPE,start (s),duration (s)");
    for quantity in quantities {
        let unit = if quantity.unit() == "1" { String::new() } else { format!(" ({})", quantity.unit()) };
        let _ = write!(text, ",{}{unit}", quantity.label());
    }
    text.push_str(",direction (deg)");
    let forward = cue.map(|cue| forward_indices(tracks, cue));
    text.push_str(if forward.is_some() { ",forward index parallel,forward index perpendicular\n" } else { "\n" });
    let values: Vec<Vec<f64>> = quantities.iter().map(|quantity| quantity.of(tracks)).collect();
    for track in 0..tracks.number() {
        let motion = Motion::of(tracks, track);
        let start = tracks.frames_of(track).next().map_or(f64::NAN, |frame| tracks.times[frame]);
        let duration = motion.map_or(0.0, |motion| motion.duration);
        let _ = write!(text, "{},{},{start},{duration}", quoted(&tracks.names[track]), quoted(&tracks.types[track]));
        for of in &values {
            let _ = write!(text, ",{}", of[track]);
        }
        let _ = write!(text, ",{}", motion.map_or(f64::NAN, |motion| motion.direction().to_degrees()));
        for of in forward.iter().flatten() {
            let _ = write!(text, ",{}", of[track]);
        }
        text.push('\n');
    }
    text
}

/// A text as one field.
fn quoted(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// A row for each lag.
fn table_of_displacements(tracks: &Tracks, wishes: &Wishes) -> String {
    let of = msd::of_cells(tracks.positions.view(), &tracks.times, &wishes.lags);
    let mut text = String::from("lag (s),msd (um^2),low (um^2),high (um^2),standard error (um^2)\n");
    for (one, [low, high]) in of.displacements().iter().zip(of.intervals(wishes.seed)) {
        let _ = writeln!(text, "{},{},{low},{high},{}", one.lag, one.msd, one.error);
    }
    text
}

/// A row for each lag.
fn table_of_correlations(tracks: &Tracks, wishes: &Wishes) -> String {
    let lags: Vec<usize> = std::iter::once(0).chain(wishes.lags.iter().copied()).collect();
    let found = [Correlated::Velocity, Correlated::Direction].map(|of| products(tracks, of, &lags));
    let [velocity, direction] = found.each_ref().map(|products| (products.of_all(), products.intervals(wishes.seed)));
    let mut text = String::from("lag (s),velocity,low,high,direction,low of directions,high of directions\n");
    for (row, lag) in found[0].lags.iter().enumerate() {
        let of = |(values, intervals): &(Vec<f64>, Vec<[f64; 2]>)| {
            format!("{},{},{}", values[row], intervals[row][0], intervals[row][1])
        };
        let _ = writeln!(text, "{lag},{},{}", of(&velocity), of(&direction));
    }
    text
}
