//! The measure of what cells of an aggregate leave empty between them.

use crate::experiment::values::When;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is empty inside the largest aggregate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Gaps {
    /// The instant.
    #[serde(default)]
    pub time: When,
    /// Which number.
    #[serde(default)]
    pub statistic: GapStatistic,
}

/// Which number of the gaps in an aggregate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum GapStatistic {
    /// The radius of the largest ball that fits between the cells, µm.
    #[default]
    LargestBall,
    /// The part of the inside that no cell fills.
    EmptyShare,
}
