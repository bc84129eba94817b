//! Where cells are put.

use crate::units::Length;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the cells of a type start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, deny_unknown_fields)]
pub enum Placement {
    /// Centres, one for each cell.
    At {
        /// The centres.
        at: Vec<[Length; 3]>,
    },
    /// A regular grid, filled along x, then y, then z.
    Grid {
        /// Places along x, y and z.
        #[schemars(inner(range(min = 1, max = 100_000_000)))]
        grid: [u32; 3],
        /// Distance between neighbouring centres.
        #[schemars(extend("x-exclusive-minimum" = 0))]
        spacing: Length,
        /// The centre of the grid.
        #[serde(default)]
        origin: [Length; 3],
    },
    /// Uniformly at random in a box.
    Random {
        /// The corner with the smallest coordinates.
        random_from: [Length; 3],
        /// The corner with the largest coordinates.
        random_to: [Length; 3],
    },
}

impl Placement {
    /// How many cells it has positions for; one where they are drawn.
    pub fn positions(&self) -> usize {
        match self {
            Self::At { at } => at.len(),
            Self::Grid { grid, .. } => grid.iter().map(|n| *n as usize).fold(1, usize::saturating_mul),
            Self::Random { .. } => 1,
        }
    }
}
