//! How fast a wave leaves a point.

use super::declared::Declared;
use super::finished::Finished;
use crate::analysis::recording::{POSITION, Recording};
use crate::analysis::statistics;
use crate::analysis::waves::{self, Arrivals, Where};
use crate::cell::motility::Space;
use crate::error::{Error, Fault, Result};
use crate::units::{Length, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How fast a wave leaves a point, in a series of cells or in a field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct WaveSpeed {
    /// The series of cells; give it or `field`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "series"))]
    pub series: Option<String>,
    /// The type of cells of the series; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The field: its name, or FIELD.SPECIES for another than its first species; give it or `series`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "field"))]
    pub field: Option<String>,
    /// Looks at the field along the ray from the centre in this direction only; at all boxes when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The point that distances are measured from.
    pub centre: [Length; 3],
    /// Whether distances are measured in the plane x, y or in space; in the plane of a flat field in any case.
    #[serde(default)]
    pub space: Space,
    /// The wave arrives when the value first rises through this level, in the unit of the series or field; midway between
    /// the smallest and the largest value when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    /// Only from this time on; from the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// Only points at this distance from the centre or farther.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub distance_from: Option<Length>,
    /// Only points at this distance from the centre or nearer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub distance_to: Option<Length>,
    /// Which number of the fitted line.
    #[serde(default)]
    pub statistic: WaveStatistic,
}

/// Which number of the line that is fitted to times of arrival against distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum WaveStatistic {
    /// The speed, one over the slope.
    #[default]
    Speed,
    /// The standard error of the speed.
    StandardError,
    /// R², the share of the variance of arrivals that the line explains.
    RSquared,
}

impl WaveSpeed {
    pub(super) fn series(&self) -> Vec<&str> {
        let with_positions = |series| [series].into_iter().chain(POSITION).collect();
        self.series.as_deref().map(with_positions).unwrap_or_default()
    }

    pub(super) fn check(&self, at: &mut dyn Declared) {
        match (&self.series, &self.field) {
            (Some(_), Some(_)) => at.two_keys("field", "series", "measure the wave in one of them"),
            (None, None) => {
                let message = format!("`{}` lacks what the wave runs through", at.path());
                let help = "add `field = \"NAME\"`, or `series = \"chemistry.SYSTEM.QUANTITY\"` of cells";
                at.fault("", "`field` or `series` is missing here", message, help);
            }
            (Some(_), None) if self.direction.is_some() => {
                at.two_keys("direction", "series", "a ray is for fields; leave `direction` out");
            }
            (None, Some(_)) if self.cells.is_some() => {
                at.two_keys("cells", "field", "leave `cells` out: a field has none");
            }
            _ => {}
        }
        if let Some(direction) = self.direction {
            at.direction("direction", direction);
        }
        if let (Some(from), Some(to)) = (self.distance_from, self.distance_to)
            && from >= to
        {
            let message = format!("`{}.distance_to` is not above `distance_from`", at.path());
            at.fault("distance_to", "too small", message, "exchange the two");
        }
        at.stretch(self.from, None);
    }

    /// How fast the wave leaves the point, eq. (analysis.13).
    ///
    /// # Errors
    /// When there is no such series, field or cell, or the wave does not arrive.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let recording = run.recording;
        let times = &recording.times;
        let first = waves::first_frame(times, self.from.map(Time::value));
        let arrivals = match (&self.field, &self.series) {
            (Some(name), _) => {
                let along = self.direction.map_or(Where::Boxes, Where::Ray);
                let (centre, axes) = (self.centre.map(Length::value), self.space.axes());
                waves::arrivals_in_field(&run.fields().field(name)?, times, first, self.level, centre, &along, axes)?
            }
            (None, Some(series)) => self.arrivals_at_cells(series, first, recording)?,
            (None, None) => {
                let fault = Fault::new("a wave of nothing has no speed");
                return Err(Error::input(fault.help("give a `series` or a `field`")));
            }
        };
        let arrivals = arrivals.between(self.distance_from.map(Length::value), self.distance_to.map(Length::value));
        let line = arrivals.line()?;
        Ok(match self.statistic {
            WaveStatistic::Speed => 1.0 / line.slope,
            WaveStatistic::StandardError => line.slope_error / (line.slope * line.slope),
            WaveStatistic::RSquared => line.r_squared,
        })
    }

    /// The first rise of a series in each cell, and how far from the centre the cell was then.
    fn arrivals_at_cells(&self, name: &str, first: usize, recording: &Recording) -> Result<Arrivals> {
        if name == "time" || recording.scene.contains_key(name) {
            let fault = Fault::new(format!("\"{name}\" is a series of the whole scene; a wave passes through cells"));
            return Err(Error::input(fault.help("name a series of cells")));
        }
        let cells = recording.cells_with(name, self.cells.as_deref())?;
        let (series, positions) = (recording.cell_series(name)?, recording.positions(&cells)?);
        let times = &recording.times[first..];
        let courses: Vec<Vec<f64>> =
            cells.iter().map(|&cell| series.column(cell).iter().skip(first).copied().collect()).collect();
        let [least, most] = waves::extremes(courses.iter().flatten());
        let level = self.level.unwrap_or(0.5 * (least + most));
        let mut arrivals = Arrivals { points: cells.len(), ..Arrivals::default() };
        for (cell, course) in courses.iter().enumerate() {
            let Some(time) = waves::rises(times, course, level).next() else { continue };
            let part = |axis: usize| {
                let coordinates: Vec<f64> =
                    (first..recording.times.len()).map(|frame| positions[[frame, cell, axis]]).collect();
                let coordinate = statistics::interpolate(times, &coordinates, time).unwrap_or(f64::NAN);
                (coordinate - self.centre[axis].value()).powi(2)
            };
            arrivals.distances.push((0..self.space.axes()).map(part).sum::<f64>().sqrt());
            arrivals.times.push(time);
        }
        Ok(arrivals)
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::measures::test_results::all_are;

    #[test]
    fn waves_have_their_speed_in_cells_and_in_fields() {
        let cells = |rest: &str| {
            format!(
                "kind = 'wave_speed'; centre = ['0 um', '0 um', '0 um']; series = 'chemistry.oscillator.cAMP'; {rest}"
            )
        };
        let field = |rest: &str| {
            format!("kind = 'wave_speed'; centre = ['5 um', '4 um', '0 um']; field = 'front'; level = 1; {rest}")
        };
        all_are(&[
            // The wave passes points 10 µm apart every 2.5 s; the cells have meanwhile come nearer by less than 3 µm.
            (&cells("from = '8 s'"), 4.0, 0.2),
            (&cells("from = '8 s'; statistic = 'r_squared'"), 1.0, 1e-3),
            (&field(""), 0.25, 1e-3),
            (&field("direction = [1, 0, 0]; distance_from = '2 um'"), 0.25, 2e-3),
            (&field("direction = [-1, 1, 0]; distance_from = '2 um'"), 0.25, 5e-3),
            (&field("from = '20 s'; distance_to = '20 um'"), 0.25, 1e-3),
            (&field("statistic = 'r_squared'"), 1.0, 1e-4),
            (&field("statistic = 'standard_error'"), 0.0, 1e-3),
        ]);
    }
}
