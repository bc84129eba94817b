//! Torques on some atoms of cells. What documents say of them, and what it means.

use super::compile::{Builder, course, unit};
use super::selection::Selection;
use super::spread::Spread;
use crate::geometry;
use crate::mechanics::torque;
use crate::units::Energy;
use crate::values::Course;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Atoms that spread across a line by less than this part of how they spread along it are on it.
const LINE: f64 = 1e-9;

/// A torque on some atoms of every cell of the type, by forces that have no sum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Torque {
    /// Names the series `twist.NAME`, the torque, and `twist_angle.NAME`, by how much the atoms have turned about the axis, in the mean over all cells of
    /// the type; with the name of the type in between where several types have one of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// The atoms that are twisted.
    #[serde(flatten)]
    pub selection: Selection,
    /// The axis in space, right-handed; its length does not matter.
    pub axis: [f64; 3],
    /// The torque about the axis, constant or in the course of time.
    pub torque: Course<Energy>,
    /// How it is shared by the atoms.
    #[serde(default)]
    pub spread: Spread,
}

impl Torque {
    /// What it means; it stands at this key of its type.
    pub(super) fn compiled(&self, path: &str, to: &mut Builder) -> torque::Torque {
        let axis = unit(self.axis);
        let shares = self.spread.shares(path, &self.selection, axis, &geometry::atom_areas(to.rest()), to);
        let made = torque::Torque::new(&self.name, shares, axis, course(self.torque.points()), &to.rest().positions);
        if !made.atoms.is_empty() && made.spread() < LINE {
            let found = "the atoms that are chosen lie on a line, along which forces on them have no torque";
            to.fault(path, "on a line", found, "choose more atoms: a wider cap, or all = true");
        }
        made
    }
}
