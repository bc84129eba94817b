//! Whether a value that has become small has any digits: where it is a remainder of larger ones, round-off may be all that is left.
//!
//! The error of a step is held to the tolerances, but what was lost before stays lost. A sum of variables that the
//! equations keep is kept to the round-off of the rates when these were large, and a value that falls below the round-off of the largest
//! ones may be that alone. A second solve with other steps then ends somewhere else.

use super::Tolerances;

/// Two solves that differ by more than this share of a value have no digit of it in common that could be told of.
const APART: f64 = 1e-2;
/// The same, in relative tolerances: loose ones may leave that much.
const TOLERANCES_APART: f64 = 100.0;

/// How a solve ended.
pub struct Ended {
    /// The variables at the end.
    pub state: Vec<f64>,
    /// The largest that any has been, without its sign.
    pub largest: f64,
}

impl Ended {
    /// The variables that are below round-off of the largest, and above what the absolute tolerance counts as nothing.
    pub fn small<'e>(&'e self, sizes: &'e [f64], tolerances: Tolerances) -> impl Iterator<Item = usize> + use<'e> {
        (0..self.state.len()).filter(move |&v| {
            let value = self.state[v].abs();
            value < f64::EPSILON * self.largest && value > tolerances.absolute * sizes[v]
        })
    }

    /// The variable among the small ones that another solve finds elsewhere, and its value there.
    pub fn lost(&self, other: &Self, sizes: &[f64], tolerances: Tolerances) -> Option<(usize, f64)> {
        let share = APART.max(TOLERANCES_APART * tolerances.relative);
        let apart = |&v: &usize| {
            let (a, b) = (self.state[v], other.state[v]);
            (a - b).abs() > share * a.abs().max(b.abs()) + 10.0 * tolerances.absolute * sizes[v]
        };
        self.small(sizes, tolerances).find(apart).map(|v| (v, other.state[v]))
    }
}
