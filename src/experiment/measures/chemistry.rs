//! Measures of fields and of chemistry: values, cells that follow an attractant, rhythms, waves and patterns.

use super::Reduction;
use crate::cell::motility::Space;
use crate::experiment::values::When;
use crate::units::{Length, Time};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A field at a place, or its mean, extremes or amount.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct FieldValue {
    /// The field: its name, or FIELD.SPECIES for another than its first species.
    #[schemars(extend("x-text" = "field"))]
    pub field: String,
    /// The place, between the centres of boxes on straight lines; its z does not count in a flat field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[Length; 3]>,
    /// How the values of all boxes become one, where no place is given; their mean when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<OverBoxes>,
    /// The instant, or how the values at several instants become one.
    #[serde(default)]
    pub time: Reduction,
}

/// How the values of all boxes of a field become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum OverBoxes {
    /// Their mean.
    #[default]
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The amount: the sum of value times volume (µm³) of a box, or times its area (µm²) in a flat field.
    Amount,
}

/// How straight cells go towards a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct ChemotacticIndex {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The point.
    pub towards: [Length; 3],
    /// When the way begins; with the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// When the way ends; with the last frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
    /// Whether distances are measured in the plane x, y or in space.
    #[serde(default)]
    pub space: Space,
    /// Which number of the values of all cells.
    #[serde(default)]
    pub statistic: Statistic,
}

/// The period of a series that goes up and down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Period {
    /// The series.
    #[schemars(extend("x-text" = "series"))]
    pub series: String,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// One cell instead, by its number from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cell: Option<u32>,
    /// Only from this time on; from the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// Which number of the periods of all cells.
    #[serde(default)]
    pub statistic: Statistic,
}

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

/// How fast a wave leaves a point, in a series of cells or in a field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct WaveSpeed {
    /// The series of cells; give it or `field`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "series"))]
    pub series: Option<String>,
    /// The type of cells of the series; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The field: its name, or FIELD.SPECIES for another than its first species; give it or `series`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "field"))]
    pub field: Option<String>,
    /// Looks at the field along the ray from the centre in this direction only; at all boxes when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The point that distances are measured from.
    pub centre: [Length; 3],
    /// Whether distances are measured in the plane x, y or in space; in the plane of a flat field in any case.
    #[serde(default)]
    pub space: Space,
    /// The wave arrives when the value first rises through this level, in the unit of the series or field; midway between
    /// the smallest and the largest value when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    /// Only from this time on; from the first frame when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Time>,
    /// Only places at this distance from the centre or farther.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub distance_from: Option<Length>,
    /// Only places at this distance from the centre or nearer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub distance_to: Option<Length>,
    /// Which number of the fitted line.
    #[serde(default)]
    pub statistic: WaveStatistic,
}

/// Which number of the line that is fitted to times of arrival against distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum WaveStatistic {
    /// The speed, one over the slope.
    #[default]
    Speed,
    /// The standard error of the speed.
    StandardError,
    /// R², the share of the variance of arrivals that the line explains.
    RSquared,
}

/// The wavelength of a pattern in a flat field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Wavelength {
    /// The field: its name, or FIELD.SPECIES for another than its first species.
    #[schemars(extend("x-text" = "field"))]
    pub field: String,
    /// The instant.
    #[serde(default)]
    pub time: When,
}
