//! The scalar measures that an experiment declares, computed from the series of its run.

use super::chemistry;
use super::curve::Curve;
use super::fields::Fields;
use super::gaps;
use super::msd;
use super::recording::Recording;
use super::sorting;
use super::statistics::{self, Line};
use super::table::Table;
use crate::error::{Error, Fault, Result};
use crate::experiment::{Comparison, Fit, MeasureKind, OneOrMany, Over, Reduction, SphereFit, WaveSpeed};
use crate::output::ResultFile;
use crate::units::Time;
use std::path::{Path, PathBuf};

/// Number of lags at which displacements are held against Fürth's law. Neighbouring lags share most of their steps, so
/// more of them would tell little more.
const LAGS: usize = 12;

/// Two times are the same when they differ by at most this share: the round-off of millions of steps.
const ROUND_OFF: f64 = 1e-9;

/// Names of the series that [`evaluate`] asks a recording for, besides `time`.
pub fn series_of(kind: &MeasureKind) -> Vec<&str> {
    let names: Vec<&str> = match kind {
        MeasureKind::Value { series, .. } => vec![series],
        MeasureKind::Slope(fit) | MeasureKind::RSquared(fit) => with_x(&fit.x, &fit.y),
        MeasureKind::SphereShear(fit) => with_x(&fit.x, &fit.y),
        MeasureKind::TableRms(table) | MeasureKind::TableBars(table) | MeasureKind::TableRatio(table) => {
            vec![&table.x, &table.y]
        }
        MeasureKind::MsdDeviation { .. } => vec!["position_x", "position_y", "position_z"],
        MeasureKind::ChemotacticIndex(_) => vec!["position_x", "position_y", "position_z"],
        MeasureKind::Period(period) => vec![&period.series],
        MeasureKind::WaveSpeed(WaveSpeed { series: Some(series), .. }) => {
            vec![series, "position_x", "position_y", "position_z"]
        }
        MeasureKind::RunLengthP { .. }
        | MeasureKind::WaveSpeed(_)
        | MeasureKind::FieldValue(_)
        | MeasureKind::Wavelength(_)
        | MeasureKind::Segregation(_)
        | MeasureKind::Gaps(_) => Vec::new(),
    };
    names.into_iter().filter(|name| *name != "time").collect()
}

fn with_x<'a>(x: &'a String, y: &'a OneOrMany<String>) -> Vec<&'a str> {
    std::iter::once(x).chain(y.as_slice()).map(String::as_str).collect()
}

/// Computes the number, in base units: µm, s, pN.
///
/// * `file` – the same run, for what is read frame by frame: fields, and who touches whom. A run without these has none.
/// * `resolve` – makes a path of the document one that the system can open.
///
/// # Errors
/// When a series, type, column or table is not there, or does not reach where it is asked for.
pub fn evaluate(
    kind: &MeasureKind,
    recording: &Recording,
    file: Option<&ResultFile>,
    resolve: &dyn Fn(&Path) -> PathBuf,
) -> Result<f64> {
    let fields = Fields::of(file);
    match kind {
        MeasureKind::Value { series, cells, over, time } => {
            let value = reduce(*time, &recording.times, &recording.series(series, cells.as_deref(), *over)?)?;
            match value.is_nan() && series.starts_with("contact.") {
                true => Err(nobody_touches(series)),
                false if value.is_nan() && !recording.lives.is_empty() => Err(nobody_there(series, cells.as_deref())),
                false => Ok(value),
            }
        }
        MeasureKind::Slope(fit) => fitted(recording, fit).map(|line| line.slope),
        MeasureKind::RSquared(fit) => fitted(recording, fit).map(|line| line.r_squared),
        MeasureKind::SphereShear(SphereFit { x, y, cells, x_to, area }) => {
            let fit = Fit { x: x.clone(), y: y.clone(), cells: cells.clone(), x_from: None, x_to: *x_to };
            fitted(recording, &fit).map(|line| sphere_shear(line.slope, area.value()))
        }
        MeasureKind::TableRms(comparison) => {
            let (table, curve) = open(comparison, recording, resolve)?;
            curve.relative_rms(table.column(&comparison.x_column)?, table.column(&comparison.y_column)?)
        }
        MeasureKind::TableRatio(comparison) => {
            let (table, curve) = open(comparison, recording, resolve)?;
            curve.mean_ratio(table.column(&comparison.x_column)?, table.column(&comparison.y_column)?)
        }
        MeasureKind::TableBars(comparison) => bars(comparison, recording, resolve).map(|rows| rows as f64),
        MeasureKind::MsdDeviation { cells, speed, persistence, lag_from, lag_to } => {
            let (law, lags) = ([speed.value(), persistence.value()], [lag_from.value(), lag_to.value()]);
            msd_deviation(recording, cells.as_deref(), law, lags)
        }
        MeasureKind::RunLengthP { cells, persistence } => {
            run_length_p(recording, cells.as_deref(), persistence.value())
        }
        MeasureKind::FieldValue(value) => chemistry::field_value(value, &recording.times, fields),
        MeasureKind::ChemotacticIndex(index) => chemistry::chemotactic_index(index, recording),
        MeasureKind::Period(period) => chemistry::period(period, recording),
        MeasureKind::WaveSpeed(wave) => chemistry::wave_speed(wave, recording, fields),
        MeasureKind::Wavelength(pattern) => chemistry::wavelength(pattern, &recording.times, fields),
        MeasureKind::Segregation(wanted) => sorting::segregation(wanted, recording, file),
        MeasureKind::Gaps(wanted) => gaps::gaps(wanted, recording, file),
    }
}

/// That a series of contacts has no value where it is asked for.
fn nobody_touches(series: &str) -> Error {
    let fault = Fault::new(format!("\"{series}\" has no value where no two cells touch, or none of different types"));
    Error::input(fault.help("give a time at which such cells touch"))
}

/// That there is no cell to measure where a series is asked for.
fn nobody_there(series: &str, kind: Option<&str>) -> Error {
    let which = kind.map_or("no cell".to_owned(), |kind| format!("no cell of the type \"{kind}\""));
    let fault = Fault::new(format!("\"{series}\" has no value: {which} is there at a time at which it is asked for"));
    Error::input(fault.help("give a time at which there are such cells, or take `min` or `max`"))
}

/// Makes one of the values at several instants.
pub(super) fn reduce(reduction: Reduction, times: &[f64], values: &[f64]) -> Result<f64> {
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        let fault = Fault::new("the run has no frames to measure");
        return Err(Error::input(fault.help("let the run record at least one frame")));
    };
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    match reduction {
        Reduction::Last => Ok(*last),
        Reduction::First => Ok(*first),
        Reduction::Mean => Ok(statistics::mean(values)),
        Reduction::Min => Ok(least),
        Reduction::Max => Ok(most),
        Reduction::Range => Ok(most - least),
        Reduction::At(time) => at(time, times, values),
    }
}

/// The value at a time, between frames on a straight line.
pub(super) fn at(time: Time, times: &[f64], values: &[f64]) -> Result<f64> {
    let (from, to) = (times[0], times[times.len() - 1]);
    // Steps add up to a duration only to some digits: a time that is meant to be that of the last frame is.
    let slack = ROUND_OFF * from.abs().max(to.abs());
    let wanted = time.value();
    let near = if from - slack <= wanted && wanted <= to + slack { wanted.clamp(from, to) } else { wanted };
    statistics::interpolate(times, values, near).ok_or_else(|| {
        let fault = Fault::new(format!("nothing was recorded at {time}"));
        Error::input(fault.help(format!("give a time from {from} s to {to} s")))
    })
}

/// The curve y(x) of a recording; each series a mean over the cells of a type, or over all cells.
///
/// # Errors
/// When there is no such series, type or cell.
pub fn curve(recording: &Recording, x: &str, y: &str, cells: Option<&str>) -> Result<Curve> {
    Ok(Curve::new(&recording.series(x, cells, Over::Mean)?, &recording.series(y, cells, Over::Mean)?))
}

/// Fits a line to a part of the mean of some curves.
fn fitted(recording: &Recording, fit: &Fit) -> Result<Line> {
    let x = recording.series(&fit.x, fit.cells.as_deref(), Over::Mean)?;
    let mut mean = vec![0.0; x.len()];
    for name in fit.y.as_slice() {
        let y = recording.series(name, fit.cells.as_deref(), Over::Mean)?;
        mean.iter_mut().zip(y).for_each(|(mean, y)| *mean += y / fit.y.as_slice().len() as f64);
    }
    let curve = Curve::new(&x, &mean);
    let (x, y): (Vec<f64>, Vec<f64>) = curve.between(fit.x_from, fit.x_to).map(|[x, y]| (x, y)).unzip();
    statistics::fit_line(&x, &y)
}

/// The shear modulus µ of a spherical membrane of area modulus K whose equatorial diameter changes with the force at
/// its poles by `slope` (µm/pN), from eq. (membrane.5) for forces at points.
fn sphere_shear(slope: f64, area: f64) -> f64 {
    1.0 / (-std::f64::consts::TAU * slope - 0.5 / area)
}

fn open(comparison: &Comparison, recording: &Recording, resolve: &dyn Fn(&Path) -> PathBuf) -> Result<(Table, Curve)> {
    let curve = curve(recording, &comparison.x, &comparison.y, comparison.cells.as_deref())?;
    Ok((Table::read(&resolve(&comparison.table))?, curve))
}

fn bars(comparison: &Comparison, recording: &Recording, resolve: &dyn Fn(&Path) -> PathBuf) -> Result<usize> {
    let (Some(low), Some(high)) = (&comparison.low_column, &comparison.high_column) else {
        let fault = Fault::new("error bars cannot be counted without the columns of their ends");
        return Err(Error::input(fault.help("give low_column and high_column")));
    };
    let (table, curve) = open(comparison, recording, resolve)?;
    curve.rows_within(table.column(&comparison.x_column)?, table.column(low)?, table.column(high)?)
}

/// Largest distance, in standard errors, of the mean squared displacement from Fürth's law, eq. (analysis.8): at
/// [`LAGS`] lags, or the frames nearest to them, from the shortest to the longest in equal ratios.
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

/// Probability of durations of runs at least as unlike the exponential law as these, eq. (analysis.9).
///
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
            cells.binary_search(cell).is_ok() && *duration <= longest && end - duration <= last - longest
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
