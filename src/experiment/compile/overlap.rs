//! Whether cells that touch each other overlap where they start.

use super::super::Document;
use super::Compiled;
use crate::Vec3;
use crate::contact::{Overlap, find_overlaps};
use crate::error::{Error, Fault, Result, short};
use crate::geometry::bounding_box;
use crate::sim::Model;
use crate::sim::contact::ContactModel;

/// Overlaps that a message lists.
const MOST: usize = 5;

/// Two surfaces that overlap, or a cell behind a plane.
struct Found {
    /// The kind whose place is to be changed.
    kind: usize,
    words: String,
}

/// Refuses a start in which cells overlap or reach behind planes, where the experiment has contacts. For the start of a
/// run only: a run that goes on was good at its start.
///
/// # Errors
/// [`Error::Input`] with the cells that overlap.
pub fn check_start(document: &Document, compiled: &Compiled) -> Result<()> {
    let Compiled { model, state, .. } = compiled;
    let Some(contact) = &model.contact else { return Ok(()) };
    let cells = model.kinds.iter().zip(&state.kinds);
    let positions: Vec<Vec3> =
        cells.flat_map(|(kind, now)| (0..kind.cells).flat_map(|cell| now.cell(kind, cell))).collect();
    let overlaps = find_overlaps(&contact.scene, &positions);
    let mut found: Vec<Found> = overlaps.iter().map(|overlap| told(model, overlap)).collect();
    found.extend(behind_planes(model, contact, &positions));
    let Some(first) = found.first() else { return Ok(()) };
    let kind = &model.kinds[first.kind];
    let mut list: Vec<&str> = found.iter().take(MOST).map(|found| found.words.as_str()).collect();
    let more = format!("and {} more", found.len().saturating_sub(MOST));
    list.extend((found.len() > MOST).then_some(more.as_str()));
    let extent = bounding_box(&kind.rest.positions).map_or(0.0, |(low, high)| (high - low).max());
    let fault = Fault::new(format!("cells overlap at the start, and contacts keep them so: {}", list.join("; "))).help(
        format!(
            "place them apart: cells of type `{}` are {} um wide, and a grid needs a `spacing` above that; \
             random_from and random_to find places that do not overlap",
            kind.name,
            short(extent)
        ),
    );
    let place = document.key_place(&format!("cells.{}.placement", kind.name), "these cells");
    Err(Error::input(place.into_iter().fold(fault, Fault::at)))
}

fn name_of(model: &Model, body: u32) -> String {
    let (kind, cell) = model.kind_of(body as usize);
    format!("cell {cell} of type `{}`", model.kinds[kind].name)
}

/// What overlaps how.
fn told(model: &Model, overlap: &Overlap) -> Found {
    let [first, second] = overlap.bodies;
    let [inside_second, inside_first] = overlap.atoms_inside;
    let (inner, outer, inside) = match overlap.nested() {
        Some(nested) if nested == first => (first, second, inside_second),
        None if inside_second > inside_first => (first, second, inside_second),
        _ => (second, first, inside_first),
    };
    let (inner_name, outer_name) = (name_of(model, inner), name_of(model, outer));
    let words = match (overlap.nested(), inside) {
        (Some(_), _) => format!("{inner_name} is wholly inside {outer_name}"),
        (None, 0) => format!("edges of {inner_name} pass through {outer_name} at {} places", overlap.crossings),
        (None, _) => {
            let atoms = model.kinds[model.kind_of(inner as usize).0].atoms();
            format!("{inner_name} has {inside} of its {atoms} atoms inside {outer_name}")
        }
    };
    Found { kind: model.kind_of(second as usize).0, words }
}

/// Cells that reach farther behind a plane than a step may move an atom.
fn behind_planes(model: &Model, contact: &ContactModel, positions: &[Vec3]) -> Vec<Found> {
    let mut found = Vec::new();
    let mut atoms = positions;
    for body in 0..model.cells() as u32 {
        let number = model.kind_of(body as usize).0;
        let kind = &model.kinds[number];
        let (own, others) = atoms.split_at(kind.atoms());
        atoms = others;
        for plane in &model.planes {
            let height = |p: &Vec3| (p - plane.point).dot(&plane.normal);
            let depth = -own.iter().map(height).fold(f64::INFINITY, f64::min);
            if depth > contact.scene.safe_travel() {
                let (name, depth) = (name_of(model, body), short(depth));
                let words = format!("{name} reaches {depth} um behind the plane `{}`", plane.name);
                found.push(Found { kind: number, words });
            }
        }
    }
    found
}
