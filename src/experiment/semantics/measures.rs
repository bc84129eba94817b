//! Has measures check their keys, each its own, beside the document that declares them.

use super::super::cut_short::Late;
use super::Check;
use crate::analysis::measures::Declared;
use crate::units::Time;

/// A measure in its document.
struct InDocument<'c, 'd> {
    check: &'c mut Check<'d>,
    path: String,
    name: &'c str,
}

impl InDocument<'_, '_> {
    /// The path of a key of the measure.
    fn of(&self, key: &str) -> String {
        if key.is_empty() { self.path.clone() } else { format!("{}.{key}", self.path) }
    }
}

impl Declared for InDocument<'_, '_> {
    fn path(&self) -> &str {
        &self.path
    }

    fn types(&self) -> Vec<&str> {
        self.check.document.experiment.cells.keys().map(String::as_str).collect()
    }

    fn cells(&self) -> usize {
        self.check.document.experiment.cells.values().map(|cell| cell.count()).sum()
    }

    fn has_contacts(&self) -> bool {
        self.check.document.experiment.contact.is_some()
    }

    fn records_tractions(&self) -> bool {
        self.check.document.experiment.keeps_tractions()
    }

    fn has_pseudopods(&self, kind: Option<&str>) -> bool {
        let cells = &self.check.document.experiment.cells;
        cells.iter().any(|(name, cell)| kind.is_none_or(|kind| kind == name) && cell.pseudopods.is_some())
    }

    fn system_of(&mut self, key: &str, quantity: &str) {
        let path = self.of(key);
        match quantity.split_once('.') {
            Some((system, _)) => self.check.system(&path, system),
            None => {
                let message = format!("`{path}` is \"{quantity}\", which is no SYSTEM.VARIABLE");
                let help = "write the name of the system in [chemistry], a dot, and the variable on its membrane";
                self.check.fault(&path, "no system", message, help);
            }
        }
    }

    fn fault(&mut self, key: &str, label: &str, message: String, help: &str) {
        self.check.fault(&self.of(key), label, message, help);
    }

    fn instant(&mut self, key: &str, time: Time) {
        let late = Late::Measure(self.name.to_owned());
        self.check.instant(&self.of(key), time.value(), late);
    }

    fn direction(&mut self, key: &str, direction: [f64; 3]) {
        self.check.direction(&self.of(key), direction);
    }
}

impl Check<'_> {
    pub(super) fn measures(&mut self) {
        for (name, measure) in &self.document.experiment.measure {
            measure.kind.check(&mut InDocument { check: self, path: format!("measure.{name}"), name });
        }
    }
}
