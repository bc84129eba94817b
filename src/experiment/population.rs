//! Cells that come and go during a run.

use super::cells::{CellType, Placement};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cells that come to a type at one instant, as a second seeding.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Added {
    /// When they come.
    #[schemars(extend("x-minimum" = 0))]
    pub time: Time,
    /// How many; without it as many as the placement says, or one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 4_294_967_295_u32))]
    pub number: Option<u32>,
    /// Where they come, at rest. At random points they keep clear of the cells that are there.
    pub placement: Placement,
}

impl Added {
    /// How many cells come.
    pub fn count(&self) -> usize {
        self.number.map_or(self.placement.positions(), |number| number as usize)
    }
}

/// Cells of a type that go at one instant, as in a washout: all, unless a part or a number of them is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Removed {
    /// When they go.
    #[schemars(extend("x-minimum" = 0))]
    pub time: Time,
    /// The part of them that goes, from 0 to 1, drawn at random.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub share: Option<f64>,
    /// How many go, drawn at random.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 4_294_967_295_u32))]
    pub number: Option<u32>,
}

impl CellType {
    /// The most cells that there can be at a time: those of the start and all that come.
    pub fn most(&self) -> usize {
        self.count() + self.added.iter().map(Added::count).sum::<usize>()
    }
}
