//! What must hold of tools.

use super::Check;

impl Check<'_> {
    /// What must hold of tools.
    pub(super) fn tools(&mut self) {
        let experiment = &self.document.experiment;
        for (index, tool) in experiment.tools.iter().enumerate() {
            let path = format!("tools[{index}]");
            self.direction(&format!("{path}.axis"), tool.axis);
            let known = if experiment.tools[..index].iter().any(|other| other.name == tool.name) {
                Some("another tool")
            } else if experiment.planes.iter().any(|plane| plane.name == tool.name) {
                Some("a plane")
            } else {
                experiment.cells.contains_key(&tool.name).then_some("a type of cells")
            };
            if let Some(known) = known {
                let message = format!("`{path}.name` is the name of {known} too");
                let help = "give every tool its own name: its series and [[contact.between]] go by it";
                self.fault(&format!("{path}.name"), "taken", message, help);
            }
            if let Some(along) = tool.direction {
                self.direction(&format!("{path}.direction"), along);
            }
            let Some(displacement) = &tool.displacement else {
                if tool.direction.is_some() {
                    let message = format!("`{path}.direction` is there, and `displacement` is not");
                    let help = "give both, or none for a tool that stands";
                    self.fault(&format!("{path}.direction"), "goes nowhere", message, help);
                }
                continue;
            };
            self.begins_at_zero(&format!("{path}.displacement"), displacement.points(), "um");
            if experiment.contact.is_some() {
                let message = format!("`{path}` goes, and contacts between cells know only tools that stand");
                let help =
                    "remove [contact], which one cell beside a tool does not need, or move the cell: `moved`, `traps`";
                self.fault(&format!("{path}.displacement"), "with [contact]", message, help);
            }
        }
    }
}
