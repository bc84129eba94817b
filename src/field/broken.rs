//! Where and when the values of a window of reactions first stopped being numbers.

use super::grid::Grid;
use super::species::Species;
use crate::error::{Error, short};

/// A value that a step of reactions made of finite ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Broken {
    /// The species.
    pub species: usize,
    /// Its value.
    pub value: f64,
    /// The largest value that the box had before.
    pub before: f64,
    /// The box.
    pub at: usize,
    /// Start of the step, s.
    pub time: f64,
    /// The step, s.
    pub dt: f64,
}

impl Broken {
    /// What the user is told.
    pub fn error(&self, document: &str, species: &[Species], grid: &Grid) -> Error {
        let (name, time, point) = (&species[self.species].name, short(self.time), grid.told(self.at));
        Error::Numbers {
            message: format!(
                "document '{document}': its reactions make field '{name}' {} at {point} µm, after t = {time} s",
                self.value
            ),
            help: "look for growth without bound, a division by zero or a root of a negative number; take smaller steps, or \
                   for stiff reactions scheme=\"rosenbrock\""
                .into(),
            kept: None,
        }
    }
}
