//! What must hold of the torques on a type of cells.

use super::Check;
use crate::experiment::CellType;

impl Check<'_> {
    /// What must hold of the torques on a type of cells.
    pub(super) fn torques(&mut self, path: &str, cell: &CellType) {
        let torques = &cell.applied.torques;
        if !torques.is_empty() && cell.mechanics.rigid.is_some_and(|rigid| !rigid.turns) {
            let message = format!("`{path}` never turns, and has torques");
            let help = "leave `turns = false` out of `rigid`, or leave the torques out";
            self.fault(&format!("{path}.torques"), "without effect", message, help);
        }
        for (index, torque) in torques.iter().enumerate() {
            let path = format!("{path}.torques[{index}]");
            self.selection(&path, &torque.selection);
            self.direction(&format!("{path}.axis"), torque.axis);
            self.course(&format!("{path}.torque"), &torque.torque.points());
            if let Some(other) = torques[..index].iter().position(|other| other.name == torque.name) {
                let message = format!("`{path}.name` is the name of torque {other} too");
                let help = "names of torques differ within a type of cells";
                self.fault(&format!("{path}.name"), "taken", message, help);
            }
        }
    }
}
