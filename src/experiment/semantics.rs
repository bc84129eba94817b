//! Checks that need more than one key: what requires, excludes or names what.

use super::check::Reference;
use super::cut_short::Late;
use super::document::{Document, near_file};
use crate::error::Fault;
use crate::error::words;
use crate::recorded::{
    CONTACTS, ContactQuantity, NAMED, OUT_OF_BALANCE, OnDemand, Recorded, Touch, cell_series, contact_quantities,
};
use std::path::Path;

mod cells;
mod chemistry;
mod contact;
mod measures;
mod plates;
mod pseudopods;
mod rigid;
mod scene;
mod tools;
mod torques;

/// Whether files that a document names have to be there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Files {
    /// They are read when it is run.
    Needed,
    /// It has been run, and its result is looked at.
    MayBeGone,
}

pub(super) struct Check<'a> {
    document: &'a Document,
    faults: Vec<Fault>,
    /// What lies beyond the end of a run that is cut short.
    late: Vec<Late>,
}

/// Finds the faults that the keys of a well-formed document have together, and what is left out where its run is cut short.
pub(super) fn check(document: &Document, files: Files) -> (Vec<Fault>, Vec<Late>) {
    let mut check = Check { document, faults: Vec::new(), late: Vec::new() };
    for reference in document.references.iter().filter(|one| one.kind != "file" || files == Files::Needed) {
        check.reference(reference);
    }
    for (name, cell) in &document.experiment.cells {
        let path = format!("cells.{name}");
        check.drag_and_mass(&path, cell);
        check.placements(&path, cell);
        check.volume(&path, cell);
        check.remembering_atoms(&path, cell);
        check.pseudopods(&path, cell);
        check.applied(&path, &cell.applied);
        check.torques(&path, cell);
        check.moved_by_scheme(&path, cell);
        check.rigid(&path, cell);
        check.viscosity(&path, cell);
        check.plates(&path, cell);
        check.filling(&path, cell);
        if let Some(turn) = &cell.orientation {
            check.direction(&format!("{path}.orientation.axis"), turn.axis);
        }
    }
    check.chemistry();
    check.grips();
    check.scene();
    check.contact();
    check.measures();
    (check.faults, check.late)
}

impl Check<'_> {
    /// A fault at the value of a key.
    pub(super) fn fault(&mut self, path: &str, label: &str, message: String, help: impl Into<String>) {
        let mut fault = Fault::new(message).help(help);
        fault.location = self.document.location(path, label);
        self.faults.push(fault);
    }

    fn reference(&mut self, Reference { kind, path, text }: &Reference) {
        match kind.as_str() {
            "file" => self.file(path, text),
            "cell type" => self.cell_type(path, text),
            "series" => self.series(path, text),
            "measure" => self.measure(path, text),
            "field" => {
                if let Some((name, _)) = text.split_once('.') {
                    self.system(path, name);
                }
            }
            _ => {}
        }
    }

    fn file(&mut self, path: &str, text: &str) {
        let file = self.document.resolve(Path::new(text));
        if file.is_file() || self.document.equations.contains_key(text) {
            return;
        }
        // The experiment itself is never the file that it names.
        let own = Path::new(&self.document.source.name).file_name();
        let near = near_file(&file).filter(|near| near.file_name() != own);
        let (message, help) = match (file.is_dir(), near) {
            (true, _) => (format!("`{path}`: {text} is a folder"), "name a file in it".to_owned()),
            (false, Some(near)) => {
                let near = Path::new(text).with_file_name(near.file_name().unwrap_or_default());
                (format!("`{path}`: there is no file {text}"), format!("did you mean {}?", near.display()))
            }
            (false, None) => {
                let help = "paths start from the folder of the document".to_owned();
                (format!("`{path}`: there is no file {text}"), help)
            }
        };
        self.fault(path, "not found", message, help);
    }

    fn cell_type(&mut self, path: &str, text: &str) {
        let known = &self.document.experiment.cells;
        if known.contains_key(text) {
            return;
        }
        let meant = words::meant(text, known.keys().map(String::as_str));
        let label = meant.map_or("unknown type".to_owned(), |meant| format!("did you mean \"{meant}\"?"));
        let help = format!("types of cells here are {}", words::all_of(known.keys().map(String::as_str)));
        self.fault(path, &label, format!("`{path}`: there is no type of cells \"{text}\""), help);
    }

    fn measure(&mut self, path: &str, text: &str) {
        let known = &self.document.experiment.measure;
        if known.contains_key(text) {
            return;
        }
        let meant = words::meant(text, known.keys().map(String::as_str));
        let label = meant.map_or("unknown measure".to_owned(), |meant| format!("did you mean \"{meant}\"?"));
        let help = match known.is_empty() {
            true => "declare it, as [measure.NAME]".to_owned(),
            false => format!("measures here are {}", words::all_of(known.keys().map(String::as_str))),
        };
        self.fault(path, &label, format!("`{path}`: there is no measure \"{text}\""), help);
    }

    fn series(&mut self, path: &str, text: &str) {
        let with = self.document.experiment.on_demand();
        let (pairs, of_cells) = (self.series_of_pairs(), cell_series(with).collect::<Vec<String>>());
        let experiment = &self.document.experiment;
        let pressures = experiment.series_of_pressures();
        let balance: Vec<String> = experiment.run.equilibrium.map(|_| OUT_OF_BALANCE.to_owned()).into_iter().collect();
        let loads = [
            balance,
            experiment.series_of_loads(),
            experiment.series_of_moved(),
            experiment.series_of_traps(),
            experiment.series_of_plates(),
            experiment.series_of_tools(),
            pressures,
            experiment.series_of_torques(),
        ]
        .concat();
        let contact = self.document.experiment.contact.as_ref();
        let contacts = contact.is_some();
        let of_model = contact.into_iter().flat_map(|contact| contact_quantities(contact.recorded()));
        let of_contacts: Vec<&str> = of_model.map(|row| row.name).collect();
        let of_pairs = pairs.iter().filter(|_| contacts);
        let known = || {
            let own = of_cells.iter().map(String::as_str).chain(of_contacts.iter().copied()).chain(["time"]);
            own.chain(loads.iter().chain(of_pairs.clone()).map(String::as_str))
        };
        if known().any(|name| name == text) || self.document.experiment.may_be_of_load_file(text) {
            return;
        }
        if cell_series(OnDemand { viscosity: true, ..OnDemand::default() }).any(|name| name == text) {
            let message = format!("`{path}`: there is no series \"{text}\" where nothing is viscous");
            return self.fault(path, "not recorded", message, "add `viscosity` to the mechanics of a type");
        }
        if cell_series(OnDemand { fibres: true, ..OnDemand::default() }).any(|name| name == text) {
            let message = format!("`{path}`: there is no series \"{text}\" without fibres that are made at run time");
            return self.fault(
                path,
                "not recorded",
                message,
                "add `fibres` to the pseudopods of a type, or `fibre_budget` to the type",
            );
        }
        if cell_series(OnDemand::ALL).any(|name| name == text) {
            let message = format!("`{path}`: there is no series \"{text}\" without tractions");
            return self.fault(path, "not recorded", message, "add `tractions = true` to [output]");
        }
        let row: Option<&ContactQuantity> = CONTACTS.iter().find(|row| row.name == text);
        let lacks = row.and_then(|row| match row.recorded {
            Recorded::Always => None,
            Recorded::WithBonds => Some(("without bonds", "`bonds` to [contact] or a pair of its table")),
            Recorded::WithLinks => Some(("in this contact model", "model = \"links\" to [contact]")),
            Recorded::WithAdhesives => Some(("in this contact model", "model = \"virtual_adhesives\" to [contact]")),
        });
        if let (true, Some((without, key))) = (contacts, lacks) {
            let message = format!("`{path}`: there is no series \"{text}\" {without}");
            return self.fault(path, "not recorded", message, format!("add {key}"));
        }
        let is_of_contacts = row.is_some() || pairs.iter().any(|name| name == text);
        if is_of_contacts && !self.document.experiment.chemistry.contains_key("contact") {
            let message = format!("`{path}`: there is no series \"{text}\" without contacts");
            return self.fault(path, "not recorded", message, "add [contact] to the document");
        }
        // Quantities of chemistry are SYSTEM.QUANTITY; which there are is known once their documents are read.
        let stored = text.strip_prefix("chemistry.").unwrap_or(text);
        let systems = &self.document.experiment.chemistry;
        let is_own = |word: &str| {
            words::meant(word, NAMED.map(|(word, _)| word)).is_some()
                || contacts && words::meant(word, ["contact"]).is_some()
        };
        if let Some((system, _)) =
            stored.split_once('.').filter(|(word, _)| systems.contains_key(*word) || !is_own(word))
        {
            return self.system(path, system);
        }
        if contacts && self.pair_of_contacts(path, text, &pairs) {
            return;
        }
        let label = words::meant(text, known()).map(|meant| format!("did you mean \"{meant}\"?"));
        let mut list: Vec<&str> = loads.iter().map(String::as_str).collect();
        list.extend(["time", "volume", "area", "energy", "speed", "position_x", "velocity_x", "size_x", "principal_1"]);
        let help = format!("there are series such as {}", words::all_of(list));
        let message = format!("`{path}`: there is no series \"{text}\"");
        self.fault(path, label.as_deref().unwrap_or("unknown series"), message, help);
    }

    /// Names of the series of contacts by pair and by type.
    fn series_of_pairs(&self) -> Vec<String> {
        let types: Vec<&str> = self.document.experiment.cells.keys().map(String::as_str).collect();
        let obstacles: Vec<&str> = self.document.experiment.obstacles().collect();
        Touch::all(types.len(), obstacles.len()).into_iter().map(|series| series.name(&types, &obstacles)).collect()
    }

    /// Whether a text is `contact.SOMETHING.NAME` or `contact.SOMETHING.NAME.NAME` and not one of the series `pairs`: a
    /// fault that says which name is wrong.
    fn pair_of_contacts(&mut self, path: &str, text: &str, pairs: &[String]) -> bool {
        let parts: Vec<&str> = text.split('.').collect();
        let ["contact", stem, names @ ..] = parts.as_slice() else { return false };
        let of_stem = |name: &&String| name.starts_with(&format!("contact.{stem}."));
        let alike: Vec<&str> = pairs.iter().filter(of_stem).map(String::as_str).collect();
        if alike.is_empty() || names.is_empty() {
            return false;
        }
        let experiment = &self.document.experiment;
        let types = || experiment.cells.keys().map(String::as_str);
        let surfaces = || types().chain(experiment.obstacles());
        let turned = format!("contact.{stem}.{}", names.iter().rev().copied().collect::<Vec<_>>().join("."));
        let message = format!("`{path}`: there is no series \"{text}\"");
        let (message, label) = match names.iter().find(|name| !surfaces().any(|known| known == **name)) {
            _ if alike.contains(&turned.as_str()) => (message, format!("did you mean \"{turned}\"?")),
            Some(name) => {
                let message = format!("`{path}`: there is no type of cells, plane or tool \"{name}\"");
                let meant = words::meant(name, surfaces());
                (message, meant.map_or("unknown name".to_owned(), |meant| format!("did you mean \"{meant}\"?")))
            }
            None => (message, "unknown series".to_owned()),
        };
        // Of many types the pairs are too many to be listed.
        let help = match alike.len() {
            ..=12 => format!("there are {}", words::all_of(alike)),
            _ => format!("there are series such as {}; pairs have the order of the document", alike[0]),
        };
        self.fault(path, &label, message, help);
        true
    }

    /// A part of `[chemistry]` that a text names.
    fn system(&mut self, path: &str, name: &str) {
        let known = &self.document.experiment.chemistry;
        // A document without chemistry may be read beside a result that has some.
        if known.is_empty() || known.contains_key(name) {
            return;
        }
        let meant = words::meant(name, known.keys().map(String::as_str));
        let label = meant.map_or("unknown system".to_owned(), |meant| format!("did you mean \"{meant}\"?"));
        let help = format!("[chemistry] has {}", words::all_of(known.keys().map(String::as_str)));
        self.fault(path, &label, format!("`{path}`: there is no `{name}` in [chemistry]"), help);
    }

    /// A direction must not be zero.
    pub(super) fn direction(&mut self, path: &str, direction: [f64; 3]) {
        if direction.iter().all(|component| *component == 0.0) {
            let message = format!("`{path}` has no length and so no direction");
            self.fault(path, "is zero", message, "give at least one component, such as [1, 0, 0]");
        }
    }
}
