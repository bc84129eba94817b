//! Rhythms and waves: when a value rises through a level, how often, and how fast the rise travels.

use super::fields::{self, Field};
use super::statistics::{self, Line};
use crate::error::{Error, Fault, Result};

/// The times at which a course, straight between its points, rises through a level: is below it before and reaches it.
pub fn rises<'a>(times: &'a [f64], values: &'a [f64], level: f64) -> impl Iterator<Item = f64> + 'a {
    (1..values.len()).filter_map(move |at| rise([times[at - 1], times[at]], [values[at - 1], values[at]], level))
}

/// When the straight line between two points rises through a level, if it does.
fn rise([earlier, later]: [f64; 2], [before, after]: [f64; 2], level: f64) -> Option<f64> {
    let through = before < level && level <= after;
    through.then(|| earlier + (level - before) / (after - before) * (later - earlier))
}

/// The smallest and the largest of some values; infinities the wrong way round for none. NaN is passed over.
pub fn extremes<'a>(values: impl IntoIterator<Item = &'a f64>) -> [f64; 2] {
    let ends = |[least, most]: [f64; 2], value: &f64| [least.min(*value), most.max(*value)];
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends)
}

/// Mean interval between the rises of a course through the middle between its smallest and its largest value, eq.
/// (analysis.12). None when there are fewer than three rises; their number comes with it.
pub fn period(times: &[f64], values: &[f64]) -> std::result::Result<f64, usize> {
    let [least, most] = extremes(values);
    let rises: Vec<f64> = rises(times, values, 0.5 * (least + most)).collect();
    match rises.as_slice() {
        [first, .., last] if rises.len() > 2 => Ok((last - first) / (rises.len() - 1) as f64),
        few => Err(few.len()),
    }
}

/// When a wave came to points at some distances from its centre.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Arrivals {
    /// Distance of each point that it came to, µm.
    pub distances: Vec<f64>,
    /// When it came there, s.
    pub times: Vec<f64>,
    /// Number of points that were looked at.
    pub points: usize,
}

impl Arrivals {
    /// Only the points whose distances lie between two ends, which count themselves.
    pub fn between(mut self, from: Option<f64>, to: Option<f64>) -> Self {
        let slack = 1e-9 * self.distances.iter().fold(0.0, |most: f64, distance| most.max(*distance));
        let within = |distance: f64| {
            from.is_none_or(|from| from - slack <= distance) && to.is_none_or(|to| distance <= to + slack)
        };
        let kept: Vec<usize> = (0..self.times.len()).filter(|&at| within(self.distances[at])).collect();
        self.times = kept.iter().map(|&at| self.times[at]).collect();
        self.distances = kept.iter().map(|&at| self.distances[at]).collect();
        self
    }

    /// The line through times of arrival against distances; one over its slope is the speed, eq. (analysis.13).
    ///
    /// # Errors
    /// When the wave came to fewer than three points, to all of them at the same distance, or at once.
    pub fn line(&self) -> Result<Line> {
        if self.times.len() < 3 {
            let found = format!("a wave came to {} of {} points; three are needed", self.times.len(), self.points);
            let help = "give a level that the wave rises through, or a wider range of times or distances";
            return Err(Error::input(Fault::new(found).help(help)));
        }
        let line = statistics::fit_line(&self.distances, &self.times)?;
        if line.slope == 0.0 {
            let fault = Fault::new("the wave comes to all points at once");
            return Err(Error::input(fault.help("record frames more often, or give another level")));
        }
        Ok(line)
    }
}

/// The frames from a time on: the first of them. Round-off of a sum of steps does not cost a frame.
pub fn first_frame(times: &[f64], from: Option<f64>) -> usize {
    let slack = 1e-9 * times.iter().fold(0.0, |most: f64, time| most.max(time.abs()));
    from.map_or(0, |from| times.partition_point(|time| *time < from - slack))
}

/// Where in a field a wave is waited for.
pub enum Where {
    /// In every box.
    Boxes,
    /// On the ray from the centre in this direction, at steps of a box.
    Ray([f64; 3]),
}

/// The first rise of a field through a level at each of its boxes or points of a ray.
///
/// * `times` – of all frames, s.
/// * `first` – the frame to begin with.
/// * `level` – midway between the smallest and the largest value there when none is given.
/// * `axes` – 2 when distances are measured in the plane x, y.
///
/// # Errors
/// A centre of a ray outside of the field, or a damaged file.
pub fn arrivals_in_field(
    field: &Field,
    times: &[f64],
    first: usize,
    level: Option<f64>,
    centre: [f64; 3],
    along: &Where,
    axes: usize,
) -> Result<Arrivals> {
    let axes = if field.layout.is_flat() { 2 } else { axes };
    let (distances, ray) = match along {
        Where::Boxes => (fields::distances(field.layout, centre, axes), None),
        Where::Ray(direction) => {
            let points = points_of_ray(field, centre, *direction, axes)?;
            let radial =
                |point: &[f64; 3]| (0..axes).map(|axis| (point[axis] - centre[axis]).powi(2)).sum::<f64>().sqrt();
            (points.iter().map(radial).collect(), Some(points))
        }
    };
    let read = |frame: usize| -> Result<Vec<f64>> {
        let values = field.frame(frame)?;
        Ok(match &ray {
            None => values,
            Some(points) => points.iter().map(|point| fields::value_at(field.layout, &values, *point)).collect(),
        })
    };
    let level = match level {
        Some(level) => level,
        None => {
            let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
            for frame in first..times.len() {
                ends = extremes(extremes(&read(frame)?).iter().chain(&ends));
            }
            0.5 * (ends[0] + ends[1])
        }
    };
    let mut came: Vec<Option<f64>> = vec![None; distances.len()];
    let mut before: Option<Vec<f64>> = None;
    for frame in first..times.len() {
        let now = read(frame)?;
        if let Some(before) = before {
            for ((came, before), now) in came.iter_mut().zip(&before).zip(&now) {
                *came = came.or_else(|| rise([times[frame - 1], times[frame]], [*before, *now], level));
            }
        }
        before = Some(now);
    }
    let points = distances.len();
    let (distances, times) = distances.into_iter().zip(came).filter_map(|(d, came)| Some((d, came?))).unzip();
    Ok(Arrivals { distances, times, points })
}

/// Places on a ray from a point to the wall of a field, a box apart. Those within half a box of a wall that the ray leads
/// to are left out: the value there is that of the box at the wall, to which the wave comes earlier or later.
fn points_of_ray(field: &Field, centre: [f64; 3], direction: [f64; 3], axes: usize) -> Result<Vec<[f64; 3]>> {
    fields::check_inside(field.layout, centre)?;
    let length = direction[..axes].iter().map(|part| part * part).sum::<f64>().sqrt();
    let step = field.layout.spacing[..axes].iter().copied().fold(f64::INFINITY, f64::min);
    let mut points = Vec::new();
    if length > 0.0 {
        let point = |number: usize| {
            let radial = number as f64 * step / length;
            let part = |axis: usize| if axis < axes { centre[axis] + radial * direction[axis] } else { centre[axis] };
            [part(0), part(1), part(2)]
        };
        points = (0..).map(point).take_while(|point| fields::check_inside(field.layout, *point).is_ok()).collect();
        points
            .retain(|point| (0..axes).all(|axis| direction[axis] == 0.0 || between_centres(field, axis, point[axis])));
    }
    Ok(points)
}

/// Whether a point lies between the centres of the first and the last box along an axis.
fn between_centres(field: &Field, axis: usize, position: f64) -> bool {
    let boxes = (position - field.layout.origin[axis]) / field.layout.spacing[axis];
    // A billionth of a box forgives the round-off of a point that is meant to be a centre.
    (0.5 - 1e-9..=field.layout.cells[axis] as f64 - 0.5 + 1e-9).contains(&boxes)
}

#[cfg(test)]
#[path = "waves_tests.rs"]
mod tests;
