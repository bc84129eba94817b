//! The measures of fields and of chemistry, computed as the document declares them.

use super::fields::{self, Fields};
use super::measure;
use super::recording::Recording;
use super::waves::{self, Arrivals, Where};
use super::{pattern, statistics};
use crate::error::{Error, Fault, Result};
use crate::experiment::{
    ChemotacticIndex, FieldValue, Period, Reduction, Space, Statistic, WaveSpeed, WaveStatistic, Wavelength, When,
};
use crate::units::{Length, Time};
use std::ops::Range;

/// Number of axes that distances are measured along.
fn axes_of(space: Space) -> usize {
    match space {
        Space::Plane => 2,
        Space::Volume => 3,
    }
}

/// A field at a place, or its mean, extremes or amount.
///
/// # Errors
/// When there is no such field, place or time.
pub(super) fn field_value(wanted: &FieldValue, times: &[f64], fields: Fields) -> Result<f64> {
    let field = fields.field(&wanted.field)?;
    let position = wanted.at.map(|at| at.map(Length::value));
    if let Some(position) = position {
        fields::check_inside(field.layout, position)?;
    }
    let frames = frames_for(wanted.time, times)?;
    let value = |frame: usize| -> Result<f64> {
        let values = field.frame(frame)?;
        Ok(match position {
            Some(position) => fields::value_at(field.layout, &values, position),
            None => fields::reduce(field.layout, &values, wanted.over.unwrap_or_default()),
        })
    };
    let values: Vec<f64> = frames.clone().map(value).collect::<Result<_>>()?;
    measure::reduce(wanted.time, &times[frames], &values)
}

/// The frames that a reduction in time looks at, so that no others need be read.
fn frames_for(time: Reduction, times: &[f64]) -> Result<Range<usize>> {
    let last = times.len().saturating_sub(1);
    Ok(match time {
        Reduction::First => 0..times.len().min(1),
        Reduction::Last => last..times.len(),
        Reduction::At(wanted) if !times.is_empty() => {
            let near = measure::at(wanted, times, times)?;
            let after = times.partition_point(|time| *time < near).min(last);
            // A frame more on either side: the time may be meant to be that of a frame.
            after.saturating_sub(1)..(after + 2).min(times.len())
        }
        _ => 0..times.len(),
    })
}

/// How straight cells go towards a point, eq. (analysis.11).
///
/// # Errors
/// When there is no such type, fewer than two frames lie between the times, or no cell moved.
pub(super) fn chemotactic_index(wanted: &ChemotacticIndex, recording: &Recording) -> Result<f64> {
    let cells = recording.cells_of(wanted.cells.as_deref())?;
    let (axes, towards) = (axes_of(wanted.space), wanted.towards.map(Length::value));
    let times = &recording.times;
    let first = waves::first_frame(times, wanted.from.map(Time::value));
    let slack = 1e-9 * times.last().map_or(0.0, |last| last.abs());
    let end = wanted.to.map_or(times.len(), |to| times.partition_point(|time| *time <= to.value() + slack));
    if end < first + 2 {
        let found = format!("the way of cells is not known from {} frames", end.saturating_sub(first));
        return Err(Error::input(Fault::new(found).help("give times with two frames or more between them")));
    }
    let positions = recording.positions(&cells)?;
    let distance = |frame: usize, cell: usize, to: &dyn Fn(usize) -> f64| {
        (0..axes).map(|axis| (positions[[frame, cell, axis]] - to(axis)).powi(2)).sum::<f64>().sqrt()
    };
    let index = |cell: usize| {
        // Of cells that come later or leave earlier the part of the path that they make.
        let mut there = (first..end).filter(|frame| recording.is_there(*frame, cells[cell]));
        let first = there.next()?;
        let end = there.next_back()? + 1;
        let step = |frame: usize| distance(frame, cell, &|axis| positions[[frame - 1, cell, axis]]);
        let nearer = distance(first, cell, &|axis| towards[axis]) - distance(end - 1, cell, &|axis| towards[axis]);
        let path: f64 = (first + 1..end).map(step).sum();
        (path > 0.0).then_some(nearer / path)
    };
    let indices: Vec<f64> = (0..cells.len()).filter_map(index).collect();
    if indices.is_empty() {
        let fault = Fault::new(format!("none of {} cells moved", cells.len()));
        return Err(Error::input(fault.help("give the cells motility or a pull")));
    }
    describe(wanted.statistic, &indices)
}

/// One number for the values of several cells.
fn describe(statistic: Statistic, values: &[f64]) -> Result<f64> {
    let found = match statistic {
        Statistic::Mean => statistics::mean(values),
        Statistic::StandardError => statistics::standard_error(values),
        Statistic::StandardDeviation => statistics::standard_deviation(values),
    };
    if statistic != Statistic::Mean && values.len() < 2 {
        let fault = Fault::new("one value has no standard deviation or error");
        return Err(Error::input(fault.help("measure two cells or more, or ask for the mean")));
    }
    Ok(found)
}

/// The mean period of a series, eq. (analysis.12), over cells.
///
/// # Errors
/// When there is no such series or cell, or one does not rise three times.
pub(super) fn period(wanted: &Period, recording: &Recording) -> Result<f64> {
    let first = waves::first_frame(&recording.times, wanted.from.map(Time::value));
    let times = &recording.times[first..];
    let few = |whose: String, rises: usize| {
        let found = format!("{whose} rises through its middle {rises} times, which makes no period; three are needed");
        Error::input(Fault::new(found).help("let the run last longer, record more frames, or begin earlier (from)"))
    };
    if let Some(values) = recording.scene.get(&wanted.series) {
        let found = waves::period(times, &values[first..]);
        let periods = [found.map_err(|rises| few(format!("\"{}\"", wanted.series), rises))?];
        return describe(wanted.statistic, &periods);
    }
    let mut cells = recording.cells_with(&wanted.series, wanted.cells.as_deref())?;
    if let Some(cell) = wanted.cell {
        let number = cells.len();
        cells.retain(|known| recording.number_of(u64::from(cell)) == Some(*known));
        if cells.is_empty() {
            let found =
                format!("cell {cell} is not among the {number} cells that have values of \"{}\"", wanted.series);
            return Err(Error::input(Fault::new(found).help("cells are counted from 0 over all types")));
        }
    }
    let series = recording.cell_series(&wanted.series)?;
    let mut periods = Vec::new();
    for cell in cells {
        let values: Vec<f64> = series.column(cell).iter().skip(first).copied().collect();
        match waves::period(times, &values) {
            Ok(period) => periods.push(period),
            // One that came later or left earlier had no time for more.
            Err(_) if !(first..recording.times.len()).all(|frame| recording.is_there(frame, cell)) => {}
            Err(rises) => return Err(few(format!("\"{}\" of cell {}", wanted.series, recording.ids[cell]), rises)),
        }
    }
    if periods.is_empty() {
        return Err(few(format!("\"{}\" of any cell", wanted.series), 0));
    }
    describe(wanted.statistic, &periods)
}

/// How fast a wave leaves a point, eq. (analysis.13).
///
/// # Errors
/// When there is no such series, field or cell, or the wave does not arrive.
pub(super) fn wave_speed(wanted: &WaveSpeed, recording: &Recording, fields: Fields) -> Result<f64> {
    let times = &recording.times;
    let first = waves::first_frame(times, wanted.from.map(Time::value));
    let arrivals = match (&wanted.field, &wanted.series) {
        (Some(name), _) => {
            let position = wanted.direction.map_or(Where::Boxes, Where::Ray);
            let (centre, axes) = (wanted.centre.map(Length::value), axes_of(wanted.space));
            waves::arrivals_in_field(&fields.field(name)?, times, first, wanted.level, centre, &position, axes)?
        }
        (None, Some(series)) => arrivals_at_cells(wanted, series, first, recording)?,
        (None, None) => {
            let fault = Fault::new("a wave of nothing has no speed");
            return Err(Error::input(fault.help("give a `series` or a `field`")));
        }
    };
    let arrivals = arrivals.between(wanted.distance_from.map(Length::value), wanted.distance_to.map(Length::value));
    let line = arrivals.line()?;
    Ok(match wanted.statistic {
        WaveStatistic::Speed => 1.0 / line.slope,
        WaveStatistic::StandardError => line.slope_error / (line.slope * line.slope),
        WaveStatistic::RSquared => line.r_squared,
    })
}

/// The first rise of a series in each cell, and how far from the centre the cell was then.
fn arrivals_at_cells(wanted: &WaveSpeed, name: &str, first: usize, recording: &Recording) -> Result<Arrivals> {
    if name == "time" || recording.scene.contains_key(name) {
        let fault = Fault::new(format!("\"{name}\" is a series of the whole scene; a wave passes through cells"));
        return Err(Error::input(fault.help("name a series of cells")));
    }
    let cells = recording.cells_with(name, wanted.cells.as_deref())?;
    let (series, positions) = (recording.cell_series(name)?, recording.positions(&cells)?);
    let times = &recording.times[first..];
    let courses: Vec<Vec<f64>> =
        cells.iter().map(|&cell| series.column(cell).iter().skip(first).copied().collect()).collect();
    let [least, most] = waves::extremes(courses.iter().flatten());
    let level = wanted.level.unwrap_or(0.5 * (least + most));
    let mut arrivals = Arrivals { points: cells.len(), ..Arrivals::default() };
    for (cell, course) in courses.iter().enumerate() {
        let Some(time) = waves::rises(times, course, level).next() else { continue };
        let part = |axis: usize| {
            let path: Vec<f64> = (first..recording.times.len()).map(|frame| positions[[frame, cell, axis]]).collect();
            let position = statistics::interpolate(times, &path, time).unwrap_or(f64::NAN);
            (position - wanted.centre[axis].value()).powi(2)
        };
        arrivals.distances.push((0..axes_of(wanted.space)).map(part).sum::<f64>().sqrt());
        arrivals.times.push(time);
    }
    Ok(arrivals)
}

/// The wavelength of a pattern in the frame that a time means.
///
/// # Errors
/// When there is no such field, or no pattern in it.
pub(super) fn wavelength(wanted: &Wavelength, times: &[f64], fields: Fields) -> Result<f64> {
    let field = fields.field(&wanted.field)?;
    pattern::wavelength(field.layout, &field.frame(frame_at(wanted.time, times))?)
}

/// The frame that a time means.
pub(super) fn frame_at(time: When, times: &[f64]) -> usize {
    let last = times.len().saturating_sub(1);
    match time {
        When::First => 0,
        When::Last => last,
        When::At(time) => {
            let away = |frame: &usize| (times[*frame] - time.value()).abs();
            (0..times.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(last)
        }
    }
}

#[cfg(test)]
#[path = "chemistry_tests.rs"]
mod tests;
