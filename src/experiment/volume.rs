//! What happens to the enclosed volume of cells.

use crate::units::{Stress, Volume};
use crate::values::Course;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What happens to the enclosed volume.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct VolumeControl {
    /// The rule; when absent exact for closed surfaces, and free for open ones and where a material with Poisson's ratio fills the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<VolumeRule>,
    /// Bulk modulus of the compressible rule.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub modulus: Option<Stress>,
    /// The volume to keep, or its course in time; the volume at rest when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Course<Volume>>,
    /// The same as a multiple of the volume at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<Course<f64>>,
}

/// A rule for the enclosed volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum VolumeRule {
    /// The volume is the target at the end of every step, to round-off.
    Exact,
    /// A pressure proportional to the relative change of volume.
    Compressible,
    /// Nothing keeps the volume.
    Free,
}
