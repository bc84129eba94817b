//! Writes systems of EML as SBML Level 3 Version 2: the core, without packages.

mod element;
mod events;
mod functions;
mod kinds;
mod left_out;
mod math;
mod names;
mod quantities;
mod reactions;
mod shape;
mod units;

use super::LARGEST_DOCUMENT;
use crate::equations::eml::{Document, Written, numbers_are_plain};
use crate::error::{Error, Fault, Result, Source};
use element::{Element, NAMESPACE};
use kinds::Kinds;
use math::Formulas;
use names::{Names, identifier};
use std::sync::Arc;
use units::Units;

/// Writes a system as an SBML model. Functions are written out where they were called. What SBML has nothing for (links, how it is
/// solved) is left out and told in the notices and in the notes of the model; inputs are constants.
///
/// # Errors
/// [`Error::Input`] for what has no meaning without what SBML cannot say: fields, membranes, noise; and for formulas that nest too
/// deep to be read again.
pub fn write(document: &Document) -> Result<Written> {
    left_out::refuse(document)?;
    let written = Writer::new(document).model();
    // What readers refuse (a formula that is too deep, a text that is too long) shows when it is read.
    let source = Source { name: format!("{} as SBML", document.name), text: written.text };
    let size = source.text.len();
    if size > LARGEST_DOCUMENT {
        let fault =
            Fault::new(format!("{} has {size} bytes as SBML; a model has at most {LARGEST_DOCUMENT}", document.name));
        return Err(Error::input(
            fault.help("write shorter formulas: functions are written out where they are called"),
        ));
    }
    let source = Arc::new(source);
    super::read(&source)?;
    Ok(Written { text: source.text.clone(), notices: written.notices })
}

/// A model as it is written.
struct Writer<'a> {
    document: &'a Document,
    names: Names,
    kinds: Kinds,
    formulas: Formulas,
    units: Units,
    /// Whether quantities have units.
    measured: bool,
    /// The compartment of all species: a word that no other language of models keeps for itself.
    compartment: String,
    /// The unit of the extents of reactions.
    extent: Option<String>,
    initial: Vec<Element>,
}

impl<'a> Writer<'a> {
    fn new(document: &'a Document) -> Self {
        let measured = document.system.quantities.iter().any(|quantity| !quantity.unit.is_empty());
        let mut names = Names::of(&document.system);
        let kinds = Kinds::new(&document.system);
        let compartment = names.new_id("vessel");
        let mut units = Units::default();
        let time = units.reference(&document.time_unit).filter(|_| measured && numbers_are_plain(document));
        let formulas = Formulas::new(&mut names, &kinds.of, &compartment, time);
        Self { document, names, kinds, formulas, units, measured, compartment, extent: None, initial: Vec::new() }
    }

    fn model(mut self) -> Written {
        let document = self.document;
        let (compartments, species, parameters) = self.quantities();
        let rules = self.rules();
        let reactions = self.reactions();
        let events = self.events();
        let mut notices = std::mem::take(&mut self.names.notices);
        notices.extend(left_out::notices(document, &self.names.quantities));
        if self.measured && !self.formulas.has_units() {
            notices.push("numbers with units of their own stand without them".to_owned());
        }
        // Without other units that of time would only be found amiss.
        let has_time = self.measured || document.time_unit != "s";
        let id = self.names.new_id(&identifier(&document.name));
        let model = Element::new("model")
            .with("id", id)
            .with("name", &document.name)
            .with_some("timeUnits", self.units.reference(&document.time_unit).filter(|_| has_time))
            .with_some("extentUnits", self.extent.take())
            .child(notes(&document.name, &notices))
            .list("listOfFunctionDefinitions", self.formulas.functions())
            .list("listOfUnitDefinitions", self.units.elements())
            .list("listOfCompartments", compartments)
            .list("listOfSpecies", species)
            .list("listOfParameters", parameters)
            .list("listOfInitialAssignments", self.initial)
            .list("listOfRules", rules)
            .list("listOfReactions", reactions)
            .list("listOfEvents", events);
        let root = Element::new("sbml").with("xmlns", NAMESPACE).with("level", "3").with("version", "2").child(model);
        Written { text: root.document(), notices }
    }
}

/// Where a model comes from, and what it lacks, for people.
fn notes(name: &str, notices: &[String]) -> Element {
    let origin = format!("Written by Pseudopod from the EML document \"{name}\".");
    let lines = std::iter::once(&origin).chain(notices);
    let lines = lines.map(|line| Element::new("p").text(line));
    Element::new("notes").child(Element::new("body").with("xmlns", "http://www.w3.org/1999/xhtml").children(lines))
}
