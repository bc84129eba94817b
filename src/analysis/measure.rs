//! The scalar measures that an experiment declares, computed from the series of its run.

use super::curve::Curve;
use super::msd;
use super::recording::{Over, Recording};
use super::statistics::{self, Line};
use super::table::Table;
use crate::error::{Error, Fault, Result};
use std::path::PathBuf;

/// One number to compute. Series go by their names in the result, values are in base units: µm, s, pN.
#[derive(Debug, Clone, PartialEq)]
pub enum Measure {
    /// A series at one instant, or its mean or extremes in time.
    Value {
        /// The series.
        series: String,
        /// The type of cells; all when absent.
        cells: Option<String>,
        /// How the values of several cells become one.
        over: Over,
        /// The instant, or how the values at several instants become one.
        time: Reduction,
    },
    /// The slope of the line fitted to y against x.
    Slope(Stretch),
    /// R² of the line fitted to y against x.
    RSquared(Stretch),
    /// Root mean square of the relative distance between a measured table and the curve y(x).
    TableRms(Comparison),
    /// Number of rows of a measured table whose bars hold the curve y(x).
    TableBars(Comparison),
    /// Mean ratio of the curve y(x) to a measured table.
    TableRatio(Comparison),
    /// Largest distance, in standard errors, of the mean squared displacement from Fürth's law, eq. (analysis.8).
    MsdDeviation {
        /// The type of cells; all when absent.
        cells: Option<String>,
        /// Speed in the law, µm/s.
        speed: f64,
        /// Persistence in the law, s.
        persistence: f64,
        /// Shortest lag, s.
        lag_from: f64,
        /// Longest lag, s.
        lag_to: f64,
    },
    /// Probability of durations of runs at least as unlike the exponential law as these, eq. (analysis.9).
    RunLengthP {
        /// The type of cells; all when absent.
        cells: Option<String>,
        /// Mean duration of a run in the law, s.
        persistence: f64,
    },
}

/// A curve y(x), the mean over cells, or the stretch of it between two x.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// The series along x.
    pub x: String,
    /// The series along y.
    pub y: String,
    /// The type of cells; all when absent.
    pub cells: Option<String>,
    /// Only points with x from here on.
    pub x_from: Option<f64>,
    /// Only points with x up to here.
    pub x_to: Option<f64>,
}

/// A curve y(x), the mean over cells, beside a measured table.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The table, a path that can be opened from here.
    pub table: PathBuf,
    /// Its column along x.
    pub x_column: String,
    /// Its column along y.
    pub y_column: String,
    /// Its column with the lower ends of the bars.
    pub low_column: Option<String>,
    /// Its column with the upper ends of the bars.
    pub high_column: Option<String>,
    /// The series along x.
    pub x: String,
    /// The series along y.
    pub y: String,
    /// The type of cells; all when absent.
    pub cells: Option<String>,
}

/// How the values at several instants become one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Reduction {
    /// The value in the last frame.
    #[default]
    Last,
    /// The value in the first frame.
    First,
    /// The mean over all frames.
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The largest less the smallest.
    Range,
    /// The value at this time, s, between frames on a straight line.
    At(f64),
}

/// Number of lags at which displacements are held against Fürth's law. Neighbouring lags share most of their steps, so
/// more of them would tell little more.
const LAGS: usize = 12;

impl Measure {
    /// Names of the series that [`Measure::evaluate`] asks a recording for, besides `time`.
    pub fn series(&self) -> Vec<&str> {
        let names: Vec<&str> = match self {
            Self::Value { series, .. } => vec![series],
            Self::Slope(stretch) | Self::RSquared(stretch) => vec![&stretch.x, &stretch.y],
            Self::TableRms(table) | Self::TableBars(table) | Self::TableRatio(table) => vec![&table.x, &table.y],
            Self::MsdDeviation { .. } => vec!["position_x", "position_y", "position_z"],
            Self::RunLengthP { .. } => Vec::new(),
        };
        names.into_iter().filter(|name| *name != "time").collect()
    }

    /// Computes the number.
    ///
    /// # Errors
    /// When a series, type, column or table is not there, or does not reach where it is asked for.
    pub fn evaluate(&self, recording: &Recording) -> Result<f64> {
        match self {
            Self::Value { series, cells, over, time } => {
                time.reduce(&recording.times, &recording.series(series, cells.as_deref(), *over)?)
            }
            Self::Slope(stretch) => Ok(stretch.line(recording)?.slope),
            Self::RSquared(stretch) => Ok(stretch.line(recording)?.r_squared),
            Self::TableRms(comparison) => {
                let (table, curve) = comparison.open(recording)?;
                curve.relative_rms(table.column(&comparison.x_column)?, table.column(&comparison.y_column)?)
            }
            Self::TableRatio(comparison) => {
                let (table, curve) = comparison.open(recording)?;
                curve.mean_ratio(table.column(&comparison.x_column)?, table.column(&comparison.y_column)?)
            }
            Self::TableBars(comparison) => comparison.bars(recording).map(|rows| rows as f64),
            Self::MsdDeviation { cells, speed, persistence, lag_from, lag_to } => {
                msd_deviation(recording, cells.as_deref(), [*speed, *persistence], [*lag_from, *lag_to])
            }
            Self::RunLengthP { cells, persistence } => run_length_p(recording, cells.as_deref(), *persistence),
        }
    }
}

impl Reduction {
    fn reduce(self, times: &[f64], values: &[f64]) -> Result<f64> {
        let (Some(first), Some(last)) = (values.first(), values.last()) else {
            let fault = Fault::new("the run has no frames to measure");
            return Err(Error::input(fault.help("let the run record at least one frame")));
        };
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        match self {
            Self::Last => Ok(*last),
            Self::First => Ok(*first),
            Self::Mean => Ok(statistics::mean(values)),
            Self::Min => Ok(least),
            Self::Max => Ok(most),
            Self::Range => Ok(most - least),
            Self::At(time) => statistics::interpolate(times, values, time).ok_or_else(|| {
                let (from, to) = (times[0], times[times.len() - 1]);
                let fault = Fault::new(format!("nothing was recorded at {time} s"));
                Error::input(fault.help(format!("give a time from {from} s to {to} s")))
            }),
        }
    }
}

/// The curve y(x) of a recording; each series a mean over the cells of a type, or over all cells.
///
/// # Errors
/// When there is no such series, type or cell.
pub fn curve(recording: &Recording, x: &str, y: &str, cells: Option<&str>) -> Result<Curve> {
    Ok(Curve::new(&recording.series(x, cells, Over::Mean)?, &recording.series(y, cells, Over::Mean)?))
}

impl Stretch {
    fn line(&self, recording: &Recording) -> Result<Line> {
        let curve = curve(recording, &self.x, &self.y, self.cells.as_deref())?;
        let within = |x: f64| self.x_from.is_none_or(|from| from <= x) && self.x_to.is_none_or(|to| x <= to);
        let (x, y): (Vec<f64>, Vec<f64>) = curve.points().filter(|[x, _]| within(*x)).map(|[x, y]| (x, y)).unzip();
        statistics::fit_line(&x, &y)
    }
}

impl Comparison {
    fn open(&self, recording: &Recording) -> Result<(Table, Curve)> {
        Ok((Table::read(&self.table)?, curve(recording, &self.x, &self.y, self.cells.as_deref())?))
    }

    fn bars(&self, recording: &Recording) -> Result<usize> {
        let (Some(low), Some(high)) = (&self.low_column, &self.high_column) else {
            let fault = Fault::new("error bars cannot be counted without the columns of their ends");
            return Err(Error::input(fault.help("give low_column and high_column")));
        };
        let (table, curve) = self.open(recording)?;
        curve.rows_within(table.column(&self.x_column)?, table.column(low)?, table.column(high)?)
    }
}

/// Compares at [`LAGS`] lags, or the frames nearest to them, from the shortest to the longest in equal ratios.
fn msd_deviation(
    recording: &Recording,
    kind: Option<&str>,
    [speed, persistence]: [f64; 2],
    [lag_from, lag_to]: [f64; 2],
) -> Result<f64> {
    let cells = recording.cells_of(kind)?;
    let times = &recording.times;
    // A millionth forgives the round-off of frames that are due at the very ends.
    let within = |lag: f64| lag > 0.0 && lag_from * (1.0 - 1e-6) <= lag && lag <= lag_to * (1.0 + 1e-6);
    let usable: Vec<usize> = (0..times.len()).filter(|&frame| within(times[frame] - times[0])).collect();
    let reaches = times.last().is_some_and(|last| last - times[0] >= lag_to * (1.0 - 1e-6));
    if cells.len() < 2 || usable.is_empty() || !reaches {
        let recorded = times.last().map_or(0.0, |last| last - times[0]);
        let found = format!(
            "displacements of {} cells over {lag_from} s to {lag_to} s cannot be measured from {} frames of {recorded} s",
            cells.len(),
            times.len()
        );
        return Err(Error::input(Fault::new(found).help("give two cells or more, and lags within the recorded time")));
    }
    let wanted = |index: usize| lag_from * (lag_to / lag_from).powf(index as f64 / (LAGS - 1) as f64);
    let distance = |frame: usize, lag: f64| (times[frame] - times[0] - lag).abs();
    let nearest = |lag: f64| usable.iter().copied().min_by(|&a, &b| distance(a, lag).total_cmp(&distance(b, lag)));
    let mut frames: Vec<usize> = (0..LAGS).filter_map(|index| nearest(wanted(index))).collect();
    frames.dedup();
    let measured = msd::from_the_start(recording.positions(&cells)?.view(), times, &frames);
    let deviation = |one: &msd::Displacement| (one.msd - msd::furth(one.lag, speed, persistence)).abs() / one.error;
    // A maximum that NaN passes through: cells that stand still all alike agree with no law.
    Ok(measured.iter().map(deviation).fold(0.0, |most: f64, next| if next <= most { most } else { next }))
}

/// Runs that begin near the end of a recording are seen only when they are short. So only those are taken that begin
/// earlier than the longest duration kept before the end, and they are held against the law cut at that duration.
fn run_length_p(recording: &Recording, kind: Option<&str>, persistence: f64) -> Result<f64> {
    let cells = recording.cells_of(kind)?;
    let (first, last) = match (recording.times.first(), recording.times.last()) {
        (Some(first), Some(last)) => (*first, *last),
        _ => (0.0, 0.0),
    };
    let longest = (10.0 * persistence).min(0.5 * (last - first));
    let durations: Vec<f64> = recording
        .runs
        .iter()
        .filter(|(cell, end, duration)| {
            cells.binary_search(&(*cell as usize)).is_ok() && *duration <= longest && end - duration <= last - longest
        })
        .map(|(_, _, duration)| *duration)
        .collect();
    if durations.is_empty() {
        let fault = Fault::new("no run of motility ended that could be compared with the exponential law");
        return Err(Error::input(
            fault.help("give the cells motility and let them wander for several persistence times"),
        ));
    }
    let whole = -(-longest / persistence).exp_m1();
    let law = |duration: f64| -(-duration / persistence).exp_m1() / whole;
    Ok(statistics::kolmogorov_smirnov(&durations, law)?.p_value)
}

#[cfg(test)]
#[path = "measure_tests.rs"]
mod tests;
