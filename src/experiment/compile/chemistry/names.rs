//! Whether the series and fields that measures, charts and pictures name are there, once their documents are read.

use super::super::super::Document;
use super::at;
use crate::error::{Fault, words};
use crate::sim::chemistry::Chemistry;

/// Adds a fault for every series `SYSTEM.QUANTITY` and every field that the run will not record.
pub(super) fn check(document: &Document, chemistry: &Chemistry, faults: &mut Vec<Fault>) {
    for reference in &document.references {
        let (path, text) = (reference.path.as_str(), reference.text.as_str());
        let fault = match reference.kind.as_str() {
            // Their names were checked with the document.
            "series" if document.experiment.contact.is_some() && text.starts_with("contact.") => None,
            "series" if document.experiment.is_of_what_is_moved(text) => None,
            "series" => series(chemistry, path, text),
            // What a picture has that shows no field.
            "field" if path == "picture.field" && text == "none" => None,
            "field" => field(chemistry, path, text),
            _ => None,
        };
        faults.extend(fault.map(|(label, fault)| at(document, path, &label, fault)));
    }
}

/// What is wrong with the name of a series of chemistry, with a label for its location.
fn series(chemistry: &Chemistry, path: &str, text: &str) -> Option<(String, Fault)> {
    let stored = text.strip_prefix("chemistry.").unwrap_or(text);
    let (system, quantity) = stored.split_once('.').filter(|(system, _)| *system != "load")?;
    if let Some(reactor) = chemistry.reactors.iter().find(|reactor| reactor.name == system) {
        let known = || reactor.recorded.iter().map(|(_, id, _)| id.as_str());
        let is_there = reactor.program.names.iter().any(|name| name == quantity);
        return match known().any(|id| id == quantity) {
            true => None,
            false if reactor.membrane.as_ref().is_some_and(|membrane| membrane.system.variable(quantity).is_some()) => {
                let fault =
                    Fault::new(format!("`{path}`: `{quantity}` of `{system}` is on the membrane, one number an atom"));
                let help =
                    format!("take a <mean> or <integral> of it in the document; series are {}", words::all_of(known()));
                Some(("one number an atom".into(), fault.help(help)))
            }
            false if is_there => {
                let fault =
                    Fault::new(format!("`{path}`: `{quantity}` of `{system}` keeps its value and is not recorded"));
                let help = format!("its value stands in the document; recorded are {}", words::all_of(known()));
                Some(("is constant".into(), fault.help(help)))
            }
            false => Some(missing(path, &format!("`{system}`"), "quantity", quantity, known)),
        };
    }
    let message = format!("`{path}`: there is no series \"{text}\"");
    if chemistry.fields.iter().any(|field| field.name == system) {
        let help = "measure a field with kind = \"field_value\"; series are of cells and of systems";
        return Some(("is of a field".into(), Fault::new(message).help(help)));
    }
    let help = format!("add [chemistry.{system}] with a document that has `{quantity}`");
    Some(("no such system".into(), Fault::new(message).help(help)))
}

/// What is wrong with `FIELD.SPECIES`, or with the name of a field or a species.
fn field(chemistry: &Chemistry, path: &str, text: &str) -> Option<(String, Fault)> {
    let fields = &chemistry.fields;
    let names = || fields.iter().map(|field| field.name.as_str());
    let (name, species) = text.split_once('.').map_or((text, None), |(name, species)| (name, Some(species)));
    match (fields.iter().find(|field| field.name == name), species) {
        (Some(field), Some(species)) if field.system.species_number(species).is_none() => {
            let known = || field.system.species().iter().map(|species| species.name.as_str());
            Some(missing(path, &format!("`{name}`"), "species", species, known))
        }
        (Some(_), _) => None,
        (None, None) if fields.iter().any(|field| field.system.species_number(text).is_some()) => None,
        (None, _) => Some(missing(path, "[chemistry]", "field", name, names)),
    }
}

/// The fault of a name that is not among those that are known.
fn missing<'a, I: Iterator<Item = &'a str>>(
    path: &str,
    owner: &str,
    what: &str,
    name: &str,
    known: impl Fn() -> I,
) -> (String, Fault) {
    let label = words::meant(name, known()).map_or("unknown".to_owned(), |meant| format!("did you mean `{meant}`?"));
    let fault = Fault::new(format!("`{path}`: {owner} has no {what} `{name}`"));
    let help = match known().next() {
        Some(_) => format!("it has {}", words::all_of(known())),
        None => format!("no document of [chemistry] has a {what}"),
    };
    (label, fault.help(help))
}
