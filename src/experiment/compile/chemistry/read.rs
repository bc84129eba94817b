//! Reads the documents, takes in what the experiment changes, and finds out who has each system.

use super::super::super::{Chemistry as Entry, Document};
use super::{BesideFields, Part, at, tell};
use crate::equations::eml::{self, Level};
use crate::equations::tree::{Expr, Role};
use crate::error::words;
use crate::error::{Fault, Source};
use crate::sim::Kind;
use std::io::ErrorKind;
use std::sync::Arc;

/// All documents of equations and fields, in the order of the experiment.
pub(super) fn parts<'a>(document: &'a Document, kinds: &[Kind], faults: &mut Vec<Fault>) -> Vec<Part<'a>> {
    let experiment = &document.experiment;
    let mut parts: Vec<Part> = Vec::new();
    for (name, entry) in &experiment.chemistry {
        let Some(mut eml) = read(document, name, entry, faults) else { continue };
        set(document, name, entry, &mut eml, faults);
        let has = |kind: &Kind| experiment.cells.get(&kind.name).is_some_and(|cell| cell.chemistry.contains(name));
        let owners: Vec<usize> = (0..kinds.len()).filter(|&kind| has(&kinds[kind])).collect();
        check_level(document, name, &eml, &owners, faults);
        let number = |parts: &[Part], is_field: bool| parts.iter().filter(|part| part.is_field() == is_field).count();
        if eml.scene.is_some() {
            super::links::open_linked(&mut eml.system, entry);
        }
        let (is_field, scene) = (!eml.fields.is_empty(), eml.scene_alone());
        let own = number(&parts, is_field);
        if let (Some((alone, _)), Some(scene)) = (scene, &eml.scene) {
            // Its links are those of what stands beside the fields, which hands on what comes from outside.
            let beside = Some(BesideFields { field: own, local: scene.local.clone() });
            let number = number(&parts, false);
            eml.links.clear();
            parts.push(Part { name, entry, document: alone, kinds: Vec::new(), number, beside });
        }
        parts.push(Part { name, entry, document: eml, kinds: owners, number: own, beside: None });
    }
    parts
}

/// Reads one document, EML or SBML.
fn read(document: &Document, name: &str, entry: &Entry, faults: &mut Vec<Fault>) -> Option<eml::Document> {
    let path = document.resolve(&entry.document);
    let key = format!("chemistry.{name}.document");
    let refuse = |message: String, help: &str, faults: &mut Vec<Fault>| {
        faults.push(at(document, &key, "this file", Fault::new(message).help(help)));
    };
    let text = match document.equations_at(&entry.document).map(String::from_utf8) {
        Ok(Ok(text)) => text,
        Ok(Err(_)) => {
            refuse(format!("{} is not UTF-8 text", path.display()), "name an EML document or an SBML model", faults);
            return None;
        }
        Err(error) if error.kind() == ErrorKind::FileTooLarge => {
            let message = format!("{} cannot be a document of equations: {error}", path.display());
            refuse(message, "name an EML document or an SBML model", faults);
            return None;
        }
        Err(error) => {
            refuse(format!("{} cannot be read: {error}", path.display()), "check the file and its permissions", faults);
            return None;
        }
    };
    let source = Arc::new(Source { name: path.display().to_string(), text });
    crate::equations::read_in(source, document.files_beside(&entry.document))
        .map_err(|error| tell(error, faults))
        .ok()
        .map(|read| read.document)
}

/// Puts the experiment's values in the place of the document's.
fn set(document: &Document, name: &str, entry: &Entry, eml: &mut eml::Document, faults: &mut Vec<Fault>) {
    for (id, value) in &entry.set {
        let key = format!("chemistry.{name}.set.{id}");
        let system = &mut eml.system;
        let Some(number) = system.find(id) else {
            let meant = words::meant(id, system.quantities.iter().map(|q| q.id.as_str()));
            let label = meant.map_or("unknown".to_owned(), |meant| format!("did you mean `{meant}`?"));
            let settable = system.quantities.iter().filter(|q| !matches!(q.role, Role::Defined { .. }));
            let help = format!("it has {}", words::all_of(settable.map(|q| q.id.as_str())));
            faults.push(at(document, &key, &label, Fault::new(format!("`{name}` has no quantity `{id}`")).help(help)));
            continue;
        };
        let quantity = &mut system.quantities[number as usize];
        let is_field = eml.fields.iter().any(|field| field.quantity == number);
        let is_given = eml.membrane.as_ref().is_some_and(|membrane| {
            eml::SURFACE.contains(&id.as_str()) || membrane.totals.iter().any(|total| total.quantity == number)
        });
        let of_scene =
            eml.scene.as_ref().is_some_and(|scene| scene.totals.iter().any(|total| total.quantity == number));
        let refused = if of_scene {
            Some("it is taken from the fields: set what it is taken of")
        } else if is_given {
            Some("it is taken from the membrane: set what it is taken of")
        } else if is_field {
            Some("it is a field, which starts from a profile: set a parameter that its initial expression uses")
        } else if matches!(quantity.role, Role::Defined { .. }) {
            Some("its definition gives it: set what the definition uses")
        } else if !value.is_finite() {
            Some("give a finite number")
        } else {
            None
        };
        match refused {
            Some(help) => {
                let fault = Fault::new(format!("`{id}` of `{name}` cannot be set to {value}")).help(help);
                faults.push(at(document, &key, "cannot be set", fault));
            }
            None => quantity.initial = Expr::Number(*value),
        }
    }
}

/// Whether the document is for whom the experiment gives it.
fn check_level(document: &Document, name: &str, eml: &eml::Document, owners: &[usize], faults: &mut Vec<Fault>) {
    let is_field = !eml.fields.is_empty();
    if is_field && !owners.is_empty() {
        let fault = Fault::new(format!("`{name}` is a document of fields, which cells cannot have"))
            .help(format!("remove \"{name}\" from the types' `chemistry`; cells sense a field through links"));
        faults.push(at(document, &format!("chemistry.{name}.document"), "fields", fault));
    }
    if eml.level == Level::Membrane && owners.is_empty() {
        let fault = Fault::new(format!("`{name}` is of membranes (level=\"membrane\"), but no type of cells has it"))
            .help(format!("add `chemistry = [\"{name}\"]` to a type of cells"));
        faults.push(at(document, &format!("chemistry.{name}.document"), "no type has it", fault));
    }
    if eml.level == Level::Cell && owners.is_empty() {
        let fault = Fault::new(format!("`{name}` is a system of cells (level=\"cell\"), but no type of cells has it"))
            .help(format!("add `chemistry = [\"{name}\"]` to a type of cells"));
        faults.push(at(document, &format!("chemistry.{name}.document"), "no type has it", fault));
    }
}
