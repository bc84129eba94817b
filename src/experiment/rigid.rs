//! Bodies that never change their shape, and traps that hold them. What documents say of them, and what it means.

use super::compile::{course, unit};
use crate::Vec3;
use crate::mechanics::moved::Translation;
use crate::mechanics::trap;
use crate::sim;
use crate::units::{Length, LineStiffness};
use crate::values::Course;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A body that goes and turns, and never changes its shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rigid {
    /// Whether it turns where something turns it; else it only goes, as a plate that is guided.
    pub turns: bool,
}

impl Default for Rigid {
    fn default() -> Self {
        Self { turns: true }
    }
}

impl Rigid {
    /// What it means.
    pub(super) fn compiled(self) -> sim::Rigid {
        sim::Rigid { turns: self.turns }
    }
}

/// A spring from the centre of every body of a rigid type to a point: an optical trap, or the arm of a flexible plate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trap {
    /// Names the series `trap_x.NAME`, `trap_y.NAME` and `trap_z.NAME` in the result, the force of the trap on the bodies; with the name of the
    /// type in between where several types have one of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// Force over distance, alike in all directions.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub stiffness: LineStiffness,
    /// Where the point is at the start.
    pub at: [Length; 3],
    /// The direction in which it goes; its length does not matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// How far it is from where it began, in the course of time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Course<Length>>,
}

impl Trap {
    /// What it means.
    pub(super) fn compiled(&self) -> trap::Trap {
        let translation = self.direction.zip(self.displacement.as_ref()).map(|(along, displacement)| Translation {
            direction: unit(along),
            displacement: course(displacement.points()),
        });
        let at = Vec3::from(self.at.map(|length| length.value()));
        trap::Trap { name: self.name.clone(), stiffness: self.stiffness.value(), at, translation }
    }
}
