//! How long cells go on as they went: the autocorrelation of velocities and of directions.

use super::set::Tracks;
use crate::analysis::bootstrap;
use ndarray::Array3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is correlated with itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Correlated {
    /// Velocities: fast steps weigh more.
    #[default]
    Velocity,
    /// Directions of steps: all weigh alike.
    Direction,
}

/// Products of velocities of each cell, summed over all pairs of steps that lie a lag apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Products {
    /// Lags, s.
    pub lags: Vec<f64>,
    /// Sum and number of the products, [lag, cell, 2].
    sums: Array3<f64>,
}

/// The products at lags in frames, of which the first is to be 0. Steps are those between neighbouring frames in both of which the cell is there.
pub fn products(tracks: &Tracks, of: Correlated, lags: &[usize]) -> Products {
    let (frames, cells, axes) = tracks.positions.dim();
    let steps = frames.saturating_sub(1);
    let x = &tracks.positions;
    let mut velocities = Array3::from_shape_fn((steps, cells, axes), |(frame, cell, axis)| {
        (x[[frame + 1, cell, axis]] - x[[frame, cell, axis]]) / (tracks.times[frame + 1] - tracks.times[frame])
    });
    if of == Correlated::Direction {
        for mut velocity in velocities.rows_mut() {
            // A step of no length has no direction: 0/0 leaves it out.
            let length = velocity.iter().map(|part| part * part).sum::<f64>().sqrt();
            velocity /= length;
        }
    }
    let mut sums = Array3::zeros((lags.len(), cells, 2));
    for (row, &lag) in lags.iter().enumerate() {
        for cell in 0..cells {
            for step in lag..steps {
                let product: f64 =
                    (0..axes).map(|axis| velocities[[step, cell, axis]] * velocities[[step - lag, cell, axis]]).sum();
                if !product.is_nan() {
                    sums[[row, cell, 0]] += product;
                    sums[[row, cell, 1]] += 1.0;
                }
            }
        }
    }
    let interval = tracks.interval();
    Products { lags: lags.iter().map(|lag| *lag as f64 * interval).collect(), sums }
}

impl Products {
    /// The autocorrelation of some cells, by their numbers, at each lag: 1 at lag 0, eq. (analysis.24). NaN where there are no steps, or no movement.
    pub fn correlation(&self, cells: &[usize]) -> Vec<f64> {
        let mean = |row: usize| {
            let sum = |part: usize| cells.iter().map(|cell| self.sums[[row, *cell, part]]).sum::<f64>();
            sum(0) / sum(1)
        };
        let square = mean(0);
        (0..self.lags.len()).map(|row| mean(row) / square).collect()
    }

    /// The autocorrelation of all cells.
    pub fn of_all(&self) -> Vec<f64> {
        self.correlation(&(0..self.sums.dim().1).collect::<Vec<_>>())
    }

    /// Its intervals at each lag by the bootstrap over cells.
    pub fn intervals(&self, seed: u64) -> Vec<[f64; 2]> {
        let mut drawn = vec![Vec::new(); self.lags.len()];
        bootstrap::resample(self.sums.dim().1, bootstrap::DRAWS, seed, |cells| {
            drawn.iter_mut().zip(self.correlation(cells)).for_each(|(drawn, value)| drawn.push(value));
        });
        drawn.iter().map(|drawn| bootstrap::interval(drawn)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tracks(x: &[f64]) -> Tracks {
        Tracks {
            times: (0..x.len()).map(|frame| 0.5 * frame as f64).collect(),
            names: vec!["1".into()],
            types: vec![String::new()],
            positions: Array3::from_shape_vec((x.len(), 1, 1), x.to_vec()).unwrap(),
        }
    }

    #[test]
    fn straight_lines_correlate_wholly_and_zigzags_alternate() {
        let straight = products(&tracks(&[0.0, 1.0, 2.0, 3.0]), Correlated::Velocity, &[0, 1, 2]);
        assert_eq!((straight.of_all(), straight.lags.as_slice()), (vec![1.0; 3], [0.0, 0.5, 1.0].as_slice()));
        let zigzag = products(&tracks(&[0.0, 1.0, 0.0, 1.0]), Correlated::Direction, &[0, 1, 2]);
        assert_eq!(zigzag.of_all(), [1.0, -1.0, 1.0]);
        assert!(products(&tracks(&[1.0; 4]), Correlated::Velocity, &[0, 1]).of_all()[1].is_nan());
    }

    #[test]
    fn fast_steps_weigh_more_in_velocities_than_in_directions() {
        // Steps 1, 1, −3, −3: velocities 2, 2, −6, −6 µm/s.
        let found = |of| products(&tracks(&[0.0, 1.0, 2.0, -1.0, -4.0]), of, &[0, 1]).of_all()[1];
        assert!((found(Correlated::Velocity) - ((4.0 - 12.0 + 36.0) / 3.0) / 20.0).abs() < 1e-15);
        assert!((found(Correlated::Direction) - 1.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn steps_beside_a_frame_without_the_cell_do_not_count() {
        let found = products(&tracks(&[0.0, 1.0, f64::NAN, 4.0, 6.0]), Correlated::Velocity, &[0, 1, 3]);
        // Steps of 1 and 2 µm three apart are left.
        assert!(found.of_all()[1].is_nan());
        assert!((found.of_all()[2] - 8.0 / ((4.0 + 16.0) / 2.0)).abs() < 1e-15);
    }
}
