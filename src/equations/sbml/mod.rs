//! SBML, the exchange format of biochemical models, read into a system of equations.
//!
//! Every species gives two quantities: `S`, its amount, and `[S]`, its concentration. Compartments, parameters,
//! reactions (their rates) and species references with an identifier keep theirs; the local parameter `k` of reaction
//! `J` is `J.k`. What is read, and how it is meant, is told in the chapter on SBML of the book.

mod algebraic;
mod catalysis;
mod checks;
mod document;
mod events;
mod fast;
mod history;
mod math;
mod notes;
mod operators;
mod plan;
mod quantities;
mod species;
mod statements;
mod write;
mod xml;

pub use write::write;
pub use xml::LARGEST_DOCUMENT;

use crate::equations::reactions;
use crate::equations::tree::{QuantityId, System};
use crate::error::{Result, Source};
use std::sync::Arc;

/// A species of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Species {
    /// Its identifier.
    pub id: String,
    /// Its amount, the quantity `id`.
    pub amount: QuantityId,
    /// Its concentration, the quantity `[id]`.
    pub concentration: QuantityId,
    /// The size of its compartment.
    pub compartment: QuantityId,
}

/// A model read from SBML.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Its equations and events.
    pub system: System,
    /// Its species, in the order of the text.
    pub species: Vec<Species>,
    /// Sizes of its compartments.
    pub compartments: Vec<QuantityId>,
    /// Its global parameters.
    pub parameters: Vec<QuantityId>,
    /// Rates of its reactions.
    pub reactions: Vec<QuantityId>,
    /// What the reader should know: what was left aside and what was assumed.
    pub notices: Vec<String>,
}

impl Model {
    /// The quantity of a column: `S` is the amount of a species, `[S]` its concentration; everything else goes by its
    /// identifier.
    pub fn column(&self, name: &str) -> Option<QuantityId> {
        self.system.find(name)
    }
}

/// Whether a text looks like SBML: its first element is named `sbml`.
pub fn is_sbml(text: &str) -> bool {
    let mut rest = text.trim_start_matches('\u{feff}').trim_start();
    loop {
        let end = match rest.get(..2) {
            Some("<?") => "?>",
            Some("<!") if rest.starts_with("<!--") => "-->",
            _ => break,
        };
        let Some(found) = rest.find(end) else { return false };
        rest = rest[found + end.len()..].trim_start();
    }
    let Some(name) = rest.strip_prefix('<') else { return false };
    let name = name.split(|c: char| c.is_whitespace() || c == '>' || c == '/').next().unwrap_or_default();
    name.rsplit(':').next() == Some("sbml")
}

/// Reads an SBML document. A caller that reads files refuses those above [`LARGEST_DOCUMENT`] bytes unread.
///
/// # Errors
/// [`crate::error::Error::Input`] with all faults found, each at its location: XML that is hostile or not well formed,
/// constructs that are not supported (packages that the model needs, fast reactions that are not
/// linear in what they determine), names
/// that are not known, contradicting statements, definitions in a circle.
pub fn read(source: &Arc<Source>) -> Result<Model> {
    let xml = xml::parse(source)?;
    let page = xml::Page::new(source, xml.root())?;
    let document = document::read(&page, &xml);
    let mut plan = plan::Plan::new(&page, &document);
    plan.plain_quantities();
    plan.reactions();
    plan.all_species();
    let events = plan.events();
    plan.rates();
    plan.check_values(&events);
    plan.check_circles();
    let notices = page.finish()?;

    let quantity_id = |id: &str| plan.reader.symbols[id];
    let species = document.species.iter().enumerate().map(|(number, species)| Species {
        id: species.id.to_owned(),
        amount: plan.amounts[number],
        concentration: plan.amounts[number] + 1,
        compartment: quantity_id(species.compartment),
    });
    let reactions = plan.reactions_by_number();
    let mut system =
        System { name: document.name.to_owned(), quantities: plan.quantities, events, reactions, ..System::default() };
    if system.has_delays() {
        system.history = plan.history;
        history::of_starts(&mut system);
    }
    reactions::keep_whole(&mut system);
    Ok(Model {
        species: species.collect(),
        compartments: document.compartments.iter().map(|compartment| quantity_id(compartment.id)).collect(),
        parameters: document.parameters.iter().map(|parameter| quantity_id(parameter.id)).collect(),
        reactions: document.reactions.iter().map(|reaction| quantity_id(reaction.id)).collect(),
        system,
        notices,
    })
}
