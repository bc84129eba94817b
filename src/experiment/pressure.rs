//! Pressures on facets. What documents say of them, and what it means.

use super::compile::{Builder, course, unit};
use super::selection::Selection;
use super::semantics::Check;
use crate::Vec3;
use crate::mechanics::pressure;
use crate::units::{Length, Stress};
use crate::values::Course;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A pressure on facets of every cell of the type, along their normals wherever these are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Pressure {
    /// Names the series `pressure.NAME` in the result; `pressure.TYPE.NAME` where several types have pressures of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// The atoms of the facets on which it acts: all three of a facet are among them.
    #[serde(flatten)]
    pub selection: Selection,
    /// How much higher it is outside, constant or in the course of time: it pushes facets in, or draws them out where it is negative, as suction
    /// does.
    pub pressure: Course<Stress>,
    /// Where it acts; everywhere when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond: Option<Beyond>,
}

/// What is beyond a plane, as within the mouth of a pipette.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beyond {
    /// A point of the plane.
    pub point: [Length; 3],
    /// The direction, at right angles to the plane, in which what is beyond lies; its length does not matter.
    pub direction: [f64; 3],
    /// How far from the axis through the point, along the direction, it acts: some radius within the wall of a pipette. Everywhere beyond the plane
    /// when absent.
    #[schemars(extend("x-exclusive-minimum" = 0, "x-maximum" = 1e6))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<Length>,
}

impl Pressure {
    /// What it means; it stands at this key of its type.
    pub(super) fn compiled(&self, path: &str, to: &mut Builder) -> pressure::Pressure {
        let atoms = to.atoms(path, &self.selection);
        let chosen = |facet: &&[u32; 3]| facet.iter().all(|atom| atoms.binary_search(atom).is_ok());
        let facets: Vec<[u32; 3]> = to.rest().facets.iter().filter(chosen).copied().collect();
        if facets.is_empty() && !atoms.is_empty() {
            let found = "no facet of the mesh has all three of its atoms among those that are chosen";
            to.fault(path, "acts on no facet", found, "choose more atoms: a wider cap, or all = true");
        }
        let beyond = self.beyond.as_ref().map(|beyond| pressure::Beyond {
            point: Vec3::from(beyond.point.map(|length| length.value())),
            direction: unit(beyond.direction),
            radius: beyond.radius.map(|radius| radius.value()),
        });
        let pressure = course(self.pressure.points());
        pressure::Pressure { name: self.name.clone(), facets, pressure, beyond }
    }
}

impl Check<'_> {
    /// What must hold of the pressures on a type of cells.
    pub(super) fn pressures(&mut self, path: &str, pressures: &[Pressure]) {
        for (index, pressure) in pressures.iter().enumerate() {
            let path = format!("{path}.pressures[{index}]");
            self.selection(&path, &pressure.selection);
            self.course(&format!("{path}.pressure"), &pressure.pressure.points());
            if let Some(beyond) = &pressure.beyond {
                self.direction(&format!("{path}.beyond.direction"), beyond.direction);
            }
            if let Some(other) = pressures[..index].iter().position(|other| other.name == pressure.name) {
                let message = format!("`{path}.name` is the name of pressure {other} too");
                let help = "names of pressures differ within a type of cells";
                self.fault(&format!("{path}.name"), "taken", message, help);
            }
        }
    }
}
