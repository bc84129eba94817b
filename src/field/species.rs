//! A species of a field: how fast it spreads and decays, and what the walls do to it.

use super::grid::{Grid, Wall, Walls};
use crate::equations::Range;
use crate::error::{Error, Fault, Result};

/// A substance that diffuses and decays on a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Species {
    /// Its name in messages and results.
    pub name: String,
    /// Diffusion coefficient, µm²/s, not negative.
    pub diffusion: f64,
    /// Rate of decay, 1/s, not negative.
    pub decay: f64,
    /// What each wall does.
    pub walls: Walls,
    /// Which values it may take.
    pub range: Range,
    /// Whether a document's transport carries it: then that spreads it and lets it decay, and the coefficients here are told alone.
    pub carried: bool,
}

impl Species {
    /// A concentration that no wall lets pass.
    pub fn new(name: impl Into<String>, diffusion: f64, decay: f64) -> Self {
        Self {
            name: name.into(),
            diffusion,
            decay,
            walls: [[Wall::NoFlux; 2]; 3],
            range: Range::NonNegative,
            carried: false,
        }
    }

    /// The same with other walls.
    pub fn with_walls(self, walls: Walls) -> Self {
        Self { walls, ..self }
    }

    /// The same with another range.
    pub fn with_range(self, range: Range) -> Self {
        Self { range, ..self }
    }

    /// Whether the species can leave or enter through no wall.
    pub fn is_closed(&self) -> bool {
        self.walls.iter().flatten().all(|wall| !matches!(wall, Wall::Fixed(_)))
    }

    /// Checks that the numbers have a meaning on the grid.
    ///
    /// # Errors
    /// Each coefficient that is negative or not finite, each wall that is periodic on one side only, holds a value
    /// that is not allowed, or acts along an axis that has one box.
    pub fn check(&self, grid: &Grid) -> Result<()> {
        let (name, mut faults) = (&self.name, Vec::new());
        for (what, value) in [("diffusion coefficient", self.diffusion), ("rate of decay", self.decay)] {
            if !(value.is_finite() && value >= 0.0) {
                let help = "give a finite number that is not negative";
                faults.push(Fault::new(format!("the {what} of species '{name}' is {value}")).help(help));
            }
        }
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let pair = self.walls[axis];
            if (pair[0] == Wall::Periodic) != (pair[1] == Wall::Periodic) {
                let message = format!("species '{name}' is periodic at one wall along {letter} only");
                faults.push(Fault::new(message).help("make both walls of the axis periodic, or none"));
            }
            for wall in pair {
                let Wall::Fixed(value) = wall else { continue };
                if grid.cells[axis] == 1 {
                    let message =
                        format!("species '{name}' has a fixed wall along {letter}, where the grid has one box");
                    faults.push(Fault::new(message).help("let nothing pass there, or give the grid more boxes"));
                }
                if !value.is_finite() || (value < 0.0 && self.range == Range::NonNegative) {
                    let message = format!("a wall along {letter} holds species '{name}' at {value}");
                    faults.push(Fault::new(message).help("give a finite concentration that is not negative"));
                }
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
    }
}
