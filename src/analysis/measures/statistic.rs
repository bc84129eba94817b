//! Which number describes values of several cells.

use crate::analysis::statistics;
use crate::error::{Error, Fault, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which number describes values of several cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Statistic {
    /// Their mean.
    #[default]
    Mean,
    /// The standard error of their mean.
    StandardError,
    /// Their standard deviation.
    StandardDeviation,
}

impl Statistic {
    /// One number for the values of several cells.
    ///
    /// # Errors
    /// When a single value has no such number.
    pub fn of(self, values: &[f64]) -> Result<f64> {
        let found = match self {
            Self::Mean => statistics::mean(values),
            Self::StandardError => statistics::standard_error(values),
            Self::StandardDeviation => statistics::standard_deviation(values),
        };
        if self != Self::Mean && values.len() < 2 {
            let fault = Fault::new("one value has no standard deviation or error");
            return Err(Error::input(fault.help("measure two cells or more, or ask for the mean")));
        }
        Ok(found)
    }
}
