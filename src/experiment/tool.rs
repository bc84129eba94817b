//! Rigid tools with exact surfaces.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::units::Length;
use crate::values::Course;

/// A rigid body of revolution that no atom passes, with an exact surface in place of a mesh: a pipette, an indenter, a needle, a ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// Its name in the result.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// Its surface.
    pub surface: ToolSurface,
    /// The middle of a ball; the point of the axis at the height 0 of a profile.
    #[serde(default, skip_serializing_if = "is_origin")]
    pub point: [Length; 3],
    /// The direction of the axis, in which the heights of a profile grow; its length does not matter.
    #[serde(default = "upwards", skip_serializing_if = "is_upwards")]
    pub axis: [f64; 3],
    /// The direction in which it goes; its length does not matter. That of the axis when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// How far it is from where it begins, in the course of time: 0 at the start. It stands when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Course<Length>>,
}

/// The surface of a tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "snake_case", deny_unknown_fields)]
pub enum ToolSurface {
    /// A ball.
    Ball {
        /// Its radius.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-maximum" = 1e6))]
        radius: Length,
    },
    /// A profile turned about the axis, with round corners.
    Lathe {
        /// Corners of the profile, each its distance from the axis and its height. With both ends on the axis it makes a body without a hole; with
        /// no corner on the axis it is closed from the last to the first, and makes a ring.
        #[schemars(length(min = 3, max = 1000))]
        profile: Vec<[Length; 2]>,
        /// The radius to which corners beside the axis are rounded.
        #[schemars(extend("x-minimum" = 0, "x-maximum" = 1e6))]
        #[serde(default, skip_serializing_if = "is_sharp")]
        rounding: Length,
    },
}

fn is_origin(point: &[Length; 3]) -> bool {
    point.iter().all(|axis| axis.value() == 0.0)
}

fn upwards() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

fn is_upwards(axis: &[f64; 3]) -> bool {
    *axis == upwards()
}

fn is_sharp(rounding: &Length) -> bool {
    rounding.value() == 0.0
}
