//! What must hold between types of cells and chemistry.

use super::Check;
use crate::error::words;

impl Check<'_> {
    pub(super) fn chemistry(&mut self) {
        let experiment = &self.document.experiment;
        if experiment.cells.is_empty() && experiment.chemistry.is_empty() {
            let message = "the experiment has neither cells nor chemistry".to_owned();
            let help = "describe a type of cells in [cells.NAME], or name a document of fields in [chemistry.NAME]";
            self.fault("cells", "nothing to simulate", message, help);
        }
        for (name, cell) in &experiment.cells {
            for (index, system) in cell.chemistry.iter().enumerate() {
                let path = format!("cells.{name}.chemistry[{index}]");
                if !experiment.chemistry.contains_key(system) {
                    let known = || experiment.chemistry.keys().map(String::as_str);
                    let label = words::meant(system, known()).map(|near| format!("did you mean \"{near}\"?"));
                    let help = match known().next() {
                        Some(_) => format!("systems here are {}", words::all_of(known())),
                        None => format!("add [chemistry.{system}] with its document"),
                    };
                    let message = format!("`{path}`: there is no system \"{system}\" in [chemistry]");
                    self.fault(&path, label.as_deref().unwrap_or("unknown system"), message, help);
                } else if cell.chemistry[..index].contains(system) {
                    let message = format!("`{path}` names \"{system}\" a second time");
                    self.fault(&path, "named before", message, "a cell has a system once: remove it");
                }
            }
        }
    }
}
