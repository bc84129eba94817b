//! Starts that are drawn at random: for each cell others, by numbers that belong to the seed, the system, the variable and the cell.

use std::borrow::Cow;

use super::noise::Numbers;
use crate::equations::program::initial_values;
use crate::equations::tree::{Draw, Expr, System};
use crate::random::{Normals, Purpose, Uniforms};

/// The starts of a system of which some are drawn.
#[derive(Debug, Clone)]
pub struct Starts {
    system: System,
}

impl Starts {
    /// Those of a system; none where nothing is drawn.
    pub fn new(system: &System) -> Option<Self> {
        (!system.draws.is_empty()).then(|| Self { system: system.clone() })
    }

    /// The values of the variables of a cell, in order.
    pub fn values(&self, numbers: Numbers, cell: u64) -> Vec<f64> {
        let drawn = drawn(&self.system, numbers, cell);
        // There is no circle: the system has been compiled.
        let values = initial_values(&drawn, 0.0).unwrap_or_default();
        self.system.variables().into_iter().map(|variable| values[variable as usize]).collect()
    }
}

/// A system with what is drawn for a cell.
pub fn drawn<'a>(system: &'a System, numbers: Numbers, cell: u64) -> Cow<'a, System> {
    if system.draws.is_empty() {
        return Cow::Borrowed(system);
    }
    let mut drawn = system.clone();
    for Draw { quantity, variable, element, is_normal } in &system.draws {
        let name = [numbers.system, variable.as_str()];
        let value = match is_normal {
            true => Normals::new(numbers.seed, Purpose::Starts, &name).one(0, cell as u32, *element),
            false => Uniforms::new(numbers.seed, Purpose::Starts, &name).one(cell as u32, *element),
        };
        drawn.quantities[*quantity as usize].initial = Expr::Number(value);
    }
    Cow::Owned(drawn)
}
