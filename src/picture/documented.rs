//! What the document of a result says of its pictures and charts.

use super::colour::Colour;
use super::render::ClockUnit;
use crate::experiment::Document;
use crate::output::ResultFile;

/// The unit of times that the document of a run uses.
pub fn clock_of(document: &Document) -> Option<ClockUnit> {
    document.clock_unit().and_then(|unit| ClockUnit::named(unit, document.experiment.run.until.value()))
}

/// The colours of the types of cells of a result: those of its document, else of the palette.
pub fn type_colours(result: &ResultFile, document: &Document) -> Vec<Colour> {
    let given = |name: &String| document.experiment.cells.get(name).and_then(|cell| cell.colour);
    let types = result.layout().type_names();
    let colour = |(i, name)| given(name).map_or_else(|| Colour::of_palette(i), |colour| Colour(colour.0));
    types.iter().enumerate().map(colour).collect()
}
