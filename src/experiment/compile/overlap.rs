//! Words for cells that overlap where they start.

use super::super::Document;
use crate::Vec3;
use crate::contact::{Overlap, Scene, centre_is_inside, winding_number};
use crate::error::{Error, Fault, Result, short};
use crate::geometry::{self, bounding_box};
use crate::sim::contact::ContactScene;
use crate::sim::{Model, State};

/// An atom may begin so deep in a tool, over the mean edge: what placing a cell by hand to four digits leaves.
const DEEP: f64 = 0.01;

/// Overlaps that a message lists.
const MOST: usize = 5;

/// Two surfaces that overlap, or a cell behind a plane.
pub struct Found {
    /// The kind whose position is to be changed.
    pub kind: usize,
    /// What is wrong.
    pub words: String,
}

/// Refuses a start with these; good when there are none. `else_do` is what helps besides placing cells apart, from a comma on.
///
/// # Errors
/// [`Error::Input`] with the cells that overlap.
pub fn refusal(document: &Document, model: &Model, head: &str, found: &[Found], else_do: &str) -> Result<()> {
    let Some(first) = found.first() else { return Ok(()) };
    let kind = &model.kinds[first.kind];
    let mut list: Vec<&str> = found.iter().take(MOST).map(|found| found.words.as_str()).collect();
    let more = format!("and {} more", found.len().saturating_sub(MOST));
    list.extend((found.len() > MOST).then_some(more.as_str()));
    let extent = bounding_box(&kind.rest.positions).map_or(0.0, |(low, high)| (high - low).max());
    let fault = Fault::new(format!("{head}{}", list.join("; "))).help(format!(
        "place them apart{else_do}: cells of type `{}` are {} um wide, and a grid needs a `spacing` above that; \
         random_from and random_to find positions that do not overlap",
        kind.name,
        short(extent)
    ));
    let location = document.key_location(&format!("cells.{}.placement", kind.name), "these cells");
    Err(Error::input(location.into_iter().fold(fault, Fault::at)))
}

/// Whether one of two cells is wholly inside the other, or most of its atoms or its centre are: then none knows the direction
/// out that was meant. A sheet has no centre in this sense.
pub fn too_deep(scene: &Scene, positions: &[Vec3], overlap: &Overlap) -> bool {
    let [first, second] = overlap.bodies;
    let is_in = |inner: u32, outer: u32, inside: u32| {
        let shape = scene.shape(inner);
        2 * inside as usize > shape.atoms || (shape.closed && centre_is_inside(scene, positions, inner, outer))
    };
    let [inside_second, inside_first] = overlap.atoms_inside;
    overlap.nested().is_some() || is_in(first, second, inside_second) || is_in(second, first, inside_first)
}

fn name_of(model: &Model, state: &State, body: u32) -> String {
    let (kind, cell) = state.kind_of(body as usize);
    format!("cell {cell} of type `{}`", model.kinds[kind].name)
}

/// What overlaps how.
pub fn told(model: &Model, state: &State, overlap: &Overlap) -> Found {
    let [first, second] = overlap.bodies;
    let [inside_second, inside_first] = overlap.atoms_inside;
    let (inner, outer, inside) = match overlap.nested() {
        Some(nested) if nested == first => (first, second, inside_second),
        None if inside_second > inside_first => (first, second, inside_second),
        _ => (second, first, inside_first),
    };
    let (inner_name, outer_name) = (name_of(model, state, inner), name_of(model, state, outer));
    let words = match (overlap.nested(), inside) {
        (Some(_), _) => format!("{inner_name} is wholly inside {outer_name}"),
        (None, 0) => format!("edges of {inner_name} pass through {outer_name} at {} points", overlap.crossings),
        (None, _) => {
            let atoms = model.kinds[state.kind_of(inner as usize).0].atoms();
            format!("{inner_name} has {inside} of its {atoms} atoms inside {outer_name}")
        }
    };
    Found { kind: state.kind_of(second as usize).0, words }
}

/// Cells that reach farther behind a plane than a step may move an atom.
pub fn behind_obstacles(model: &Model, state: &State, contact: &ContactScene, positions: &[Vec3]) -> Vec<Found> {
    let mut found = Vec::new();
    let mut atoms = positions;
    for body in 0..state.cells() as u32 {
        let number = state.kind_of(body as usize).0;
        let kind = &model.kinds[number];
        let (own, others) = atoms.split_at(kind.atoms());
        atoms = others;
        for obstacle in &model.obstacles {
            let height = |p: &Vec3| obstacle.surface.gap(p);
            let depth = -own.iter().map(height).fold(f64::INFINITY, f64::min);
            if depth > contact.reach.safe_travel() {
                let (name, depth) = (name_of(model, state, body), short(depth));
                let into = if obstacle.surface.as_plane().is_some() { "behind the plane" } else { "into the tool" };
                let words = format!("{name} reaches {depth} um {into} `{}`", obstacle.name);
                found.push(Found { kind: number, words });
            }
        }
    }
    found
}

/// Cells that begin within tools, or have one within them.
pub fn within_tools(model: &Model, state: &State) -> Vec<Found> {
    let mut found = Vec::new();
    let cells =
        (0..model.kinds.len()).flat_map(|number| (0..state.kinds[number].cells()).map(move |cell| (number, cell)));
    for (body, (number, cell)) in cells.enumerate() {
        let kind = &model.kinds[number];
        let atoms = state.kinds[number].cell(kind, cell);
        for tool in model.obstacles.iter().filter(|obstacle| !obstacle.is_flat()) {
            let geometry::Obstacle::Turned(turned) = &tool.surface else { continue };
            let name = name_of(model, state, body as u32);
            let depth = -atoms.iter().map(|x| turned.beside(x).gap).fold(f64::INFINITY, f64::min);
            if depth > DEEP * kind.edge {
                let words = format!("{name} reaches {} um into the tool `{}`", short(depth), tool.name);
                found.push(Found { kind: number, words });
            } else if kind.closed && winding_number(turned.a_point(), &atoms, &kind.rest.facets) > 0.5 {
                found.push(Found { kind: number, words: format!("the tool `{}` is within {name}", tool.name) });
            }
        }
    }
    found
}
