//! EML, the Equations Markup Language: an XML text that describes a system of differential equations, or fields that
//! diffuse and react, in space or on the surfaces of cells, and the links that join them to cells.
//!
//! [`read`] turns a text into a [`Document`] or tells every fault in it at its location. Numbers stay as the document
//! writes them; where quantities have units, these are checked through every expression. The book has the language in
//! its chapter EML, `eml/eml.xsd` has its grammar.

mod algebraic;
mod build;
mod circles;
mod context;
mod declare;
mod delays;
mod document;
mod draws;
mod events;
mod fields;
mod include;
mod links;
mod measured;
mod membrane;
mod noise;
mod parts;
mod prefix;
mod random_words;
mod reactions;
mod reads;
mod repeat;
mod scene;
mod solver;
mod start;
mod tables;
mod transport;
mod vocabulary;
mod write;
mod xml;

pub use declare::SURFACE;
pub use document::{
    Document, Endpoint, FieldDescription, FieldSource, GridDescription, Index, Level, LinkDescription,
    MembraneDescription, NoiseDescription, Profile, Root, SIDES, SceneDescription, Scheme, SolverChoice, Step,
    SurfaceVariable, Taken, Taxis, Total, Wall,
};
pub use links::{read_end, read_transfer};
pub use membrane::reached;
pub use parts::FieldEvent;
pub use reads::{Reads, reads};
pub use solver::SCHEMES;
pub use vocabulary::{Attribute, ELEMENTS, Kind};
pub use write::{Written, numbers_are_plain, write};
pub use xml::{DEEPEST_ELEMENT, LARGEST_DOCUMENT, MOST_ATTRIBUTES, MOST_NODES};

use super::files::{Files, NamedFile};
use super::tree::System;
use crate::error::{Result, Source};
use build::Builder;
use context::Context;
use std::sync::Arc;

/// Reads a document. A caller that reads files refuses those above [`LARGEST_DOCUMENT`] bytes unread.
///
/// # Errors
/// [`crate::error::Error::Input`] with every fault: what is no XML, unknown elements, attributes and identifiers, faults
/// of expressions, units that do not fit, circles, values that are missing or not finite.
pub fn read(source: Arc<Source>) -> Result<Document> {
    read_in(source, Files::default())
}

/// The files that a document names and that are read with it: documents that it includes, tables, images and datasets. What is wrong
/// with the document is left to [`read_in`].
pub fn named_files(source: Arc<Source>, files: Files) -> Vec<NamedFile> {
    let mut context = Context::new(source, files);
    let Some(mut root) = xml::tree(&mut context, 0) else { return Vec::new() };
    include::take(&mut context, &mut root);
    include::named(&context, &root)
}

/// As [`read`], of a document that names files.
///
/// # Errors
/// As [`read`], and what is wrong with these files.
pub fn read_in(source: Arc<Source>, files: Files) -> Result<Document> {
    let mut context = Context::new(source, files);
    let Some(mut root) = xml::tree(&mut context, 0) else { return Err(context.error()) };
    include::take(&mut context, &mut root);
    repeat::expand(&mut context, &mut root);
    let mut known = declare::declare(&mut context, &root);
    measured::complete(&mut context, &mut known);
    if known.quantities.is_empty() && context.is_clean() {
        let help = "declare <variable id=\"U\" initial=\"1\" rate=\"-0.1*U\"/>";
        context.fault(root.at.clone(), "the document declares nothing", "empty", help);
    }
    let mut builder = Builder::new(&mut context, known);
    let (mut quantities, locations) = builder.quantities(&root);
    builder.algebraic(&mut quantities);
    let events = builder.events(&root);
    let reactions = builder.known.reactions.clone();
    let history = builder.history(&root);
    let grid = builder.grid(&root);
    let mut fields = builder.fields(&root, grid.as_ref().map_or(3, |grid| grid.dimension));
    let mut membrane = builder.membrane(&root);
    let mut scene = builder.scene(&root, grid.as_ref().map_or(3, |grid| grid.dimension));
    let noise = builder.noise(&root, grid.as_ref().map_or(3, |grid| grid.dimension));
    let links = builder.links(&root);
    let solver = builder.solver(&root);
    builder.check_noise(&root, &noise);
    let draws = builder.draws.iter().map(|(draw, _)| draw.clone()).collect();
    let system = System { name: root.word("name"), quantities, events, history, reactions, draws };
    builder.check_values(&system);
    builder.finish_fields(&mut fields, &system);
    if let Some(scene) = &mut scene {
        builder.finish_scene(scene, &fields, &system);
        builder.check_events_of_scene(&root, scene, &system);
    }
    if let Some(membrane) = &mut membrane {
        builder.finish_membrane(membrane, &system);
        builder.check_noise_of_pools(membrane, &noise);
    }
    let (level, time_unit, seconds) = (builder.known.level, builder.known.time_text.clone(), builder.known.time.size());
    if !context.is_clean() {
        return Err(context.error());
    }
    let name = root.word("name");
    Ok(Document {
        name,
        level,
        time_unit,
        seconds,
        system,
        locations,
        grid,
        fields,
        scene,
        membrane,
        noise,
        links,
        solver,
    })
}
