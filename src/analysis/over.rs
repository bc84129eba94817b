//! How values of several cells become one.

use super::statistics;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the values of several cells become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Over {
    /// Their mean.
    #[default]
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// Their sum.
    Sum,
    /// The first cell's.
    First,
}

impl Over {
    /// Makes one of the values; NaN if there is none, but for the sum.
    pub fn reduce(self, values: &[f64]) -> f64 {
        if values.is_empty() && self != Self::Sum {
            return f64::NAN;
        }
        match self {
            Self::Mean => statistics::mean(values),
            Self::Min => values.iter().copied().fold(f64::INFINITY, f64::min),
            Self::Max => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            Self::Sum => values.iter().sum(),
            Self::First => values[0],
        }
    }
}
