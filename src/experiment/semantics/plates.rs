//! What must hold of flexible plates.

use super::Check;
use crate::experiment::{CellType, Method};

impl Check<'_> {
    /// What must hold of the plates of a type.
    pub(super) fn plates(&mut self, path: &str, cell: &CellType) {
        let list = &cell.applied.plates;
        if list.is_empty() {
            return;
        }
        self.bear_plates(path, cell);
        for (index, plate) in list.iter().enumerate() {
            let path = format!("{path}.plates[{index}]");
            self.selection(&path, &plate.selection);
            self.direction(&format!("{path}.direction"), plate.direction);
            if let Some(displacement) = &plate.displacement {
                self.begins_at_zero(&format!("{path}.displacement"), displacement.points(), "um");
            }
            if let Some(other) = list[..index].iter().position(|other| other.name == plate.name) {
                let message = format!("`{path}.name` is the name of plate {other} too");
                self.fault(&format!("{path}.name"), "taken", message, "names of plates differ within a type of cells");
            }
        }
    }

    /// Whether the cells can have plates at all.
    fn bear_plates(&mut self, path: &str, cell: &CellType) {
        let key = format!("{path}.plates");
        if cell.count() != 1 || !cell.added.is_empty() {
            let message = format!("`{key}` hold one cell, and there are others of `{path}`");
            let help = "let the type have one cell, there from the start, and others be of another type";
            self.fault(&key, "of several cells", message, help);
        }
        if cell.mechanics.rigid.is_some() {
            let message = format!("`{key}` hold cells that deform, and `{path}` is rigid");
            self.fault(&key, "of a rigid body", message, "hold a rigid body by `traps`");
        }
        if self.document.experiment.run.integrator.method != Method::Implicit {
            let message = format!("`{key}` need the implicit scheme");
            self.fault("run.integrator.method", "knows no plates", message, "remove run.integrator.method");
        }
        self.not_by_drag_alone(&key, "knows no plates");
    }
}
