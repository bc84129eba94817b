//! What must hold of types that are rigid, and of traps.

use super::Check;
use crate::experiment::{CellType, ContactModel, Method};

impl Check<'_> {
    /// What must hold of a type that is rigid, and of its traps.
    pub(super) fn rigid(&mut self, path: &str, cell: &CellType) {
        self.traps(path, cell);
        if cell.mechanics.rigid.is_none() {
            return;
        }
        let (mechanics, applied) = (&cell.mechanics, &cell.applied);
        let has = [
            ("mechanics.shape_memory", mechanics.shape_memory.is_some()),
            ("mechanics.membrane", mechanics.membrane.is_some()),
            ("mechanics.springs", mechanics.springs.is_some()),
            ("mechanics.solid", mechanics.solid.is_some()),
            ("mechanics.viscosity", mechanics.viscosity.is_some()),
            ("mechanics.barrier", mechanics.barrier != Default::default()),
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
        let experiment = &self.document.experiment;
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
    pub(in crate::experiment) fn both(&mut self, path: &str, keys: [(&str, bool); 2]) {
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
