//! Measures of how cells of several types are sorted.

use crate::experiment::values::{OneOrMany, When};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How much cells of a type touch each other beyond chance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Segregation {
    /// The types of cells, two or more; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<OneOrMany<String>>,
    /// The instant.
    #[serde(default)]
    pub time: When,
    /// How often the types are dealt anew to the cells that touch another.
    #[serde(default = "permutations")]
    #[schemars(range(min = 1, max = 1_000_000))]
    pub permutations: u32,
    /// Which number.
    #[serde(default)]
    pub statistic: SegregationStatistic,
}

fn permutations() -> u32 {
    1000
}

/// Which number of the segregation index and its permutations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum SegregationStatistic {
    /// The index itself.
    #[default]
    Index,
    /// The probability of an index as large or larger by chance; at least 1/(1 + permutations).
    PValue,
    /// The mean of the permutations.
    RandomMean,
    /// The standard deviation of the permutations.
    RandomDeviation,
}
