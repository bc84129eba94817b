//! Whether a frame is one of a layout: its arrays have the sizes that the layout and its own cells ask for.

use super::systems::SystemScope;
use super::{Frame, Layout, Tractions};

/// What does not fit, in words, of a frame of a run that records forces or none.
pub(super) fn misfit(layout: &Layout, forces: bool, frame: &Frame) -> Option<String> {
    if frame.cells.iter().any(|cell| cell.kind as usize >= layout.types.len()) {
        return Some("the cells of a frame must be of types of the layout".into());
    }
    let (atoms, cells) = (layout.atoms(&frame.cells), frame.cells.len());
    let expected = (atoms, if forces { atoms } else { 0 }, cells, layout.scene_series.len());
    let found = (frame.positions.len(), frame.forces.len(), frame.records.len(), frame.scene.len());
    if found != expected {
        return Some("positions, forces, cells and scene values of a frame must fit the layout".into());
    }
    let Tractions { traction, of_cells, drag, outer, inertia, held } = &frame.tractions;
    let kept = if layout.tractions { atoms } else { 0 };
    if [traction, of_cells, drag, outer, inertia, held].iter().any(|list| list.len() != kept) {
        return Some("tractions of a frame must fit the layout".into());
    }
    if !layout.fibres && !frame.fibres.is_empty() {
        return Some("fibres of a frame must fit the layout".into());
    }
    if !layout.linked && !frame.links.is_empty() {
        return Some("links of a frame must fit the layout".into());
    }
    let sizes = frame.membranes.iter().map(Vec::len);
    if !sizes.eq(layout.membranes.iter().map(|_| atoms)) {
        return Some("substances on membranes of a frame must fit the layout".into());
    }
    misfit_of_chemistry(layout, frame)
}

fn misfit_of_chemistry(layout: &Layout, frame: &Frame) -> Option<String> {
    if frame.fields.len() != layout.fields.len() {
        return Some("the fields of a frame must fit the layout".into());
    }
    for (field, species) in layout.fields.iter().zip(&frame.fields) {
        let boxes: usize = field.cells.iter().product();
        if species.len() != field.species.len() || species.iter().any(|values| values.len() != boxes) {
            return Some(format!("the species of the field {} of a frame must fit the layout", field.name));
        }
    }
    if frame.systems.len() != layout.systems.len() {
        return Some("the systems of a frame must fit the layout".into());
    }
    for (system, quantities) in layout.systems.iter().zip(&frame.systems) {
        let members = if system.scope == SystemScope::Scene { 1 } else { frame.cells.len() };
        if quantities.len() != system.quantities.len() || quantities.iter().any(|values| values.len() != members) {
            return Some(format!("the quantities of {} must fit the layout and the cells of the frame", system.name));
        }
    }
    None
}
