//! Flexible plates that cells are bonded to. What documents say of them, and what it means.

use super::compile::{Builder, course, unit};
use super::selection::Selection;
use crate::mechanics::plate;
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::units::{Length, LineStiffness};
use crate::values::Course;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How many times as stiff the bond of an atom is as what holds it in the cell: bonded atoms of a drawn cell are off the plane of the plate by
/// about the same part of what their neighbours go.
const BOND: f64 = 100.0;

/// A plate that bends, or the lever of a force microscope, to which atoms of a cell are bonded: along its direction they go as one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Plate {
    /// Names the series `plate_force.NAME`, the force of the plate on the cell along the direction, and `plate_displacement.NAME`, how far it has
    /// gone; with the name of the type in between where several types have one of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// The atoms that are bonded to it.
    #[serde(flatten)]
    pub selection: Selection,
    /// The direction in which it goes and bends; its length does not matter. Across it, it leaves atoms free.
    pub direction: [f64; 3],
    /// Force over deflection.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub stiffness: LineStiffness,
    /// How far the base is from where it began, in the course of time; it rests when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Course<Length>>,
}

impl Plate {
    /// What it means, for a cell with the forces that there are so far.
    pub(super) fn compiled(&self, path: &str, to: &mut Builder) -> plate::Plate {
        let direction = unit(self.direction);
        let rest = &to.rest().positions;
        let atoms = to.atoms(path, &self.selection);
        let mut own = StiffnessMatrix::new(rest.len());
        to.forces.iter().filter(|force| force.is_elastic()).for_each(|force| force.add_stiffness(rest, rest, &mut own));
        let least = 1e-3 * self.stiffness.value();
        let bonded = atoms.iter().map(|&atom| plate::Bonded {
            atom,
            stiffness: (BOND * own.diagonal(atom as usize)).max(least),
            offset: rest[atom as usize].dot(&direction),
        });
        plate::Plate {
            name: self.name.clone(),
            bonded: bonded.collect(),
            direction,
            stiffness: self.stiffness.value(),
            at: 0.0,
            displacement: self
                .displacement
                .as_ref()
                .map_or(crate::mechanics::course::Course::constant(0.0), |own| course(own.points())),
        }
    }
}
