//! Bodies that never change their shape, and traps that hold them. What documents say of them, and what it means.

use super::CellType;
use super::compile::{course, unit};
use super::semantics::Check;
use super::{ContactModel, Experiment, Method};
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

impl Check<'_> {
    /// What must hold of a type that is rigid, and of its traps.
    pub(super) fn rigid(&mut self, path: &str, cell: &CellType, experiment: &Experiment) {
        self.traps(path, cell);
        if cell.mechanics.rigid.is_none() {
            return;
        }
        let (mechanics, applied) = (&cell.mechanics, &cell.applied);
        let has = [
            ("mechanics.shape_memory", mechanics.shape_memory.is_some()),
            ("mechanics.membrane", mechanics.membrane.is_some()),
            ("mechanics.springs", mechanics.springs.is_some()),
            ("mechanics.volume", mechanics.volume != Default::default()),
            ("links", !applied.links.is_empty()),
            ("fibres", !applied.fibres.is_empty()),
            ("fixed", !applied.fixed.is_empty()),
            ("moved", !applied.moved.is_empty()),
            ("loads_file", applied.loads_file.is_some()),
            ("pseudopods", cell.pseudopods.is_some()),
        ];
        for (key, _) in has.into_iter().filter(|(_, there)| *there) {
            let key = format!("{path}.{key}");
            let message = format!("`{key}` has no meaning for a rigid body, which `{path}` is");
            let help = "remove it, or `rigid`; what is to be held or to go on a course is `moved`, with `all = true`, and not rigid besides";
            self.fault(&key, "of a body that is rigid", message, help);
        }
        if experiment.run.integrator.method != Method::Implicit {
            let message = format!("`{path}.mechanics.rigid` needs the implicit scheme");
            self.fault("run.integrator.method", "knows no rigid bodies", message, "remove run.integrator.method");
        }
        if experiment.contact.as_ref().is_some_and(|contact| contact.model == ContactModel::VirtualAdhesives) {
            let message = format!(
                "`{path}.mechanics.rigid`: virtual adhesives move atoms one by one, also those of rigid bodies"
            );
            let help = "use another model of contacts, such as model = \"cohesion\"";
            self.fault("contact.model", "knows no rigid bodies", message, help);
        }
    }

    fn traps(&mut self, path: &str, cell: &CellType) {
        let traps = &cell.applied.traps;
        if !traps.is_empty() && cell.mechanics.rigid.is_none() {
            let message = format!("`{path}.traps` hold rigid bodies, and `{path}` is none");
            let help = "add `rigid = {}` to its mechanics; a deformable cell is pulled by a rigid body that sticks to it, or by `loads`";
            self.fault(&format!("{path}.traps"), "of cells that deform", message, help);
        }
        for (index, trap) in traps.iter().enumerate() {
            let path = format!("{path}.traps[{index}]");
            if let Some(along) = trap.direction {
                self.direction(&format!("{path}.direction"), along);
            }
            if let Some(displacement) = &trap.displacement {
                self.course(&format!("{path}.displacement"), &displacement.points());
            }
            self.both(&path, [("direction", trap.direction.is_some()), ("displacement", trap.displacement.is_some())]);
            if let Some(other) = traps[..index].iter().position(|other| other.name == trap.name) {
                let message = format!("`{path}.name` is the name of trap {other} too");
                self.fault(&format!("{path}.name"), "taken", message, "names of traps differ within a type of cells");
            }
        }
    }

    /// Of two keys each is of no use without the other.
    pub(super) fn both(&mut self, path: &str, keys: [(&str, bool); 2]) {
        let [(one, has_one), (other, has_other)] = keys;
        if has_one == has_other {
            return;
        }
        let (has, lacks) = if has_one { (one, other) } else { (other, one) };
        let (message, help) =
            (format!("`{path}` has `{has}` and no `{lacks}`"), format!("give `{lacks}` too, or leave `{has}` out"));
        self.fault(&format!("{path}.{has}"), "lacks its other half", message, help);
    }
}
