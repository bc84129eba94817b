//! Charts of fields: profiles along an axis at some instants, and along an axis against time.

use super::chart::{Axis, Chart, Heat, Range, Scale, Series};
use super::colour::{ColourMap, decades_of, scale_of};
use super::field_view::{check_decades, species_label};
use super::instant::frame_at;
use crate::error::{Result, short};
use crate::experiment::{Axis as Name, FieldLine, OneOrMany, When};
use crate::output::{Along, FieldLayout, ResultFile};

/// Rows of time in an image: enough for smooth fronts at the size of a chart.
const TIMES: usize = 400;

/// A species of a field along a line.
struct Line<'a> {
    result: &'a ResultFile,
    field: &'a FieldLayout,
    species: usize,
    along: Along,
    through: Option<[f64; 3]>,
}

impl<'a> Line<'a> {
    fn of(result: &'a ResultFile, line: &FieldLine) -> Result<Self> {
        let first = result.layout().fields.first().map_or("", |field| field.name.as_str());
        let (field, species) = result.field_species(line.field.as_deref().unwrap_or(first))?;
        let along = match line.along {
            Name::X => Along::X,
            Name::Y => Along::Y,
            Name::Z => Along::Z,
        };
        let through = line.through.map(|index| index.map(|length| length.value()));
        Ok(Self { result, field, species, along, through })
    }

    /// Positions (µm) and values in a frame.
    fn points(&self, frame: usize) -> Result<Vec<[f64; 2]>> {
        let values = self.result.field_frame(&self.field.name, &self.field.species[self.species].0, frame)?;
        let profile = self.field.profile(&values, self.along, self.through);
        Ok(profile.into_iter().enumerate().map(|(i, value)| [self.field.centre(self.along, i), value]).collect())
    }

    fn label(&self) -> String {
        species_label(self.field, self.species)
    }

    /// The ends of the field along the axis, µm.
    fn ends(&self) -> [f64; 2] {
        let axis = self.along.number();
        let start = self.field.origin[axis];
        [start, start + self.field.cells[axis] as f64 * self.field.spacing[axis]]
    }

    fn axis(&self) -> Axis {
        let [low, high] = self.ends();
        Axis::linear(format!("{} (µm)", self.along.letter())).range(Range::Fixed(low, high))
    }
}

/// The field along an axis, a curve for each instant.
///
/// # Errors
/// A field that the result does not have, or a damaged file.
pub fn profile(result: &ResultFile, line: &FieldLine, times: Option<&OneOrMany<When>>) -> Result<Chart> {
    let line = Line::of(result, line)?;
    let frames = match times {
        Some(times) => times.as_slice().iter().map(|when| frame_at(result, *when)).collect::<Result<Vec<_>>>()?,
        None => evenly(result.frames(), 5),
    };
    let recorded = result.times()?;
    let mut chart = Chart { x: line.axis(), y: Axis::linear(line.label()), ..Chart::default() };
    for (number, frame) in frames.iter().enumerate() {
        // Later curves are darker; the palest end of the map would be lost on white.
        let share = if frames.len() > 1 { number as f64 / (frames.len() - 1) as f64 } else { 1.0 };
        let colour = ColourMap::Viridis.at(0.86 * (1.0 - share));
        let label = format!("t = {} s", short(recorded[*frame]));
        chart.series.push(Series::line(label, line.points(*frame)?).coloured(colour));
    }
    Ok(chart)
}

/// Some frames at equal distances, the first and the last among them.
fn evenly(frames: usize, some: usize) -> Vec<usize> {
    let last = frames.saturating_sub(1);
    let mut found: Vec<usize> = (0..some).map(|k| k * last / (some - 1)).collect();
    found.dedup();
    found
}

/// The field along an axis against time, as colours.
///
/// # Errors
/// As [`profile`], and ends that are not above 0 on a logarithmic scale.
pub fn kymograph(result: &ResultFile, line: &FieldLine, range: Option<[f64; 2]>, scale: Scale) -> Result<Chart> {
    if scale == Scale::Log {
        check_decades("the colours of the kymograph", range)?;
    }
    let line = Line::of(result, line)?;
    let times = result.times()?;
    let mut rows = Vec::with_capacity(times.len());
    for frame in 0..times.len() {
        rows.push(line.points(frame)?.into_iter().map(|point| point[1]).collect::<Vec<f64>>());
    }
    let boxes = rows[0].len();
    let (start, end) = (times[0], times[times.len() - 1]);
    let columns = if end > start { TIMES } else { 1 };
    let mut values = vec![0.0; columns * boxes];
    for column in 0..columns {
        let time = start + (column as f64 + 0.5) / columns as f64 * (end - start);
        let after = times.partition_point(|known| *known <= time).clamp(1, times.len().max(2) - 1).min(times.len() - 1);
        let before = after.saturating_sub(1);
        let span = times[after] - times[before];
        let share = if span > 0.0 { (time - times[before]) / span } else { 0.0 };
        for index in 0..boxes {
            values[index * columns + column] = rows[before][index] + share * (rows[after][index] - rows[before][index]);
        }
    }
    let finite = || rows.iter().flatten().copied().filter(|value| value.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let least = || finite().filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
    let found = match scale {
        Scale::Linear => scale_of([low, high], 0.0),
        Scale::Log => decades_of([least(), high]),
    };
    // A run that never got further than its first frame is shown as an instant.
    let time_ends = if end > start { [start, end] } else { [start, start + 1.0] };
    let heat = Heat {
        x: time_ends,
        y: line.ends(),
        size: [columns, boxes],
        values,
        map: ColourMap::Viridis,
        range: range.unwrap_or(found),
        scale,
        label: line.label(),
        ..Heat::default()
    };
    Ok(Chart {
        x: Axis::linear("time (s)").range(Range::Fixed(time_ends[0], time_ends[1])),
        y: line.axis(),
        heat: Some(heat),
        ..Chart::default()
    })
}

#[cfg(test)]
mod tests {
    use super::evenly;

    #[test]
    fn instants_are_spread_over_the_run() {
        assert_eq!(evenly(11, 5), [0, 2, 5, 7, 10]);
        assert_eq!(evenly(2, 5), [0, 1]);
        assert_eq!(evenly(1, 5), [0]);
    }
}
