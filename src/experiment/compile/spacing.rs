//! Finds free points for cells that are placed at random and must not overlap.

use super::super::{CellType, Document, Placement};
use super::numbers::vector;
use super::positions::{centres, first_cells};
use crate::Vec3;
use crate::error::{Error, Fault, Result};
use crate::geometry::{Occupied, bounding_box};
use crate::random::{Purpose, Stream};
use crate::sim::seeding::{TRIES, radius_around, take_point};
use crate::sim::{Kind, Obstacle};
use std::ops::Range;

/// Centres of all cells of all kinds, `[kind][cell]`: those placed at random draw until the spheres around them keep `gap` (µm)
/// between each other and from all other cells, and no atom is behind a plane.
///
/// # Errors
/// When the box is too full.
pub fn centres_apart(document: &Document, kinds: &[Kind], obstacles: &[Obstacle], gap: f64) -> Result<Vec<Vec<Vec3>>> {
    let experiment = &document.experiment;
    let cells = || experiment.cells.values().zip(kinds).zip(first_cells(experiment));
    let is_random = |cell: &CellType| matches!(cell.placement, Some(Placement::Random { .. }));
    let mut taken = Occupied::new(kinds.iter().map(radius_around).fold(0.0, f64::max), gap);
    if cells().any(|((cell, _), _)| is_random(cell)) {
        for ((cell, kind), first) in cells().filter(|((cell, _), _)| !is_random(cell)) {
            let Some((low, high)) = bounding_box(&kind.rest.positions) else { continue };
            for centre in centres(experiment, cell, kind, first) {
                taken.add_box(low + centre, high + centre);
            }
        }
    }
    let mut all = Vec::new();
    for ((cell, kind), first) in cells() {
        all.push(match &cell.placement {
            Some(Placement::Random { random_from, random_to }) => {
                let corners = [random_from, random_to].map(|corner| vector(corner.map(|x| x.value())));
                seed_kind(document, kind, first..first + cell.count(), obstacles, corners, &mut taken)?
            }
            _ => centres(experiment, cell, kind, first),
        });
    }
    Ok(all)
}

/// Centres of the cells of a kind, drawn until each fits.
fn seed_kind(
    document: &Document,
    kind: &Kind,
    cells: Range<usize>,
    obstacles: &[Obstacle],
    [low, high]: [Vec3; 2],
    taken: &mut Occupied,
) -> Result<Vec<Vec3>> {
    let mut centres = Vec::new();
    for cell in cells.clone() {
        let mut stream = Stream::new(document.experiment.seed, Purpose::Placement, cell as u32, 0);
        let Some(centre) = take_point(kind, obstacles, [low, high], &mut stream, taken) else {
            return Err(too_full(document, kind, [cell - cells.start, cells.len()], taken, [low, high]));
        };
        centres.push(centre);
    }
    Ok(centres)
}

/// That there is no space for a cell.
fn too_full(
    document: &Document,
    kind: &Kind,
    [placed, wanted]: [usize; 2],
    taken: &Occupied,
    [low, high]: [Vec3; 2],
) -> Error {
    let ball = |radius: f64| 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let margin = Vec3::repeat(radius_around(kind));
    let around = [low - margin, high + margin];
    let size = around[1] - around[0];
    let inside = |(centre, _): &&(Vec3, f64)| centre.inf(&around[1]).sup(&around[0]) == *centre;
    let filled: f64 = taken.spheres().iter().filter(inside).map(|(_, radius)| ball(*radius)).sum();
    let share = 100.0 * filled / (size.x * size.y * size.z);
    let message = format!(
        "there is no space for all cells of type `{}`: {placed} of {wanted} found a position that overlaps no other cell and no \
         plane, the next did not in {TRIES} tries; spheres around the cells fill {share:.0} % of the box",
        kind.name
    );
    let help =
        "make the box larger or the cells fewer; positions at random rarely fill more than 30 %, a grid fills more";
    let fault = Fault::new(message).help(help);
    let location = document.location(&format!("cells.{}.placement", kind.name), "too full");
    Error::input(location.into_iter().fold(fault, Fault::at))
}
