//! Finds room for cells that are placed at random and must not overlap.

use super::super::{CellType, Document, Placement};
use super::place::{atoms_at, centres, draw};
use super::vector;
use crate::Vec3;
use crate::error::{Error, Fault, Result};
use crate::geometry::bounding_box;
use crate::random::{Purpose, Stream};
use crate::sim::{Kind, Plane};

/// Places tried for a cell before the box is called full.
const TRIES: u32 = 10_000;

/// A cell may stand on a plane: how far below it round-off may put it, over its radius.
const ROUND_OFF: f64 = 1e-9;

/// Cells that have a place.
#[derive(Default)]
struct Taken {
    /// Boxes around cells whose place the document gives.
    boxes: Vec<[Vec3; 2]>,
    /// Spheres around cells placed at random: centre and radius.
    spheres: Vec<(Vec3, f64)>,
}

impl Taken {
    /// Whether a sphere is farther than `gap` from all that have a place.
    fn leaves_room(&self, centre: Vec3, radius: f64, gap: f64) -> bool {
        let of_box = |[low, high]: &[Vec3; 2]| (centre - centre.sup(low).inf(high)).norm();
        self.spheres.iter().all(|(other, its)| (centre - other).norm() >= radius + its + gap)
            && self.boxes.iter().all(|one| of_box(one) >= radius + gap)
    }
}

/// Positions of all atoms of all cells of all kinds, `[kind][cell][atom]`: those placed at random draw until the spheres
/// around them keep `gap` (µm) between each other and from all other cells, and no atom is behind a plane.
///
/// # Errors
/// When the box is too full.
pub fn place_apart(document: &Document, kinds: &[Kind], planes: &[Plane], gap: f64) -> Result<Vec<Vec<Vec<Vec3>>>> {
    let experiment = &document.experiment;
    let cells = || experiment.cells.values().zip(kinds);
    let is_random = |cell: &CellType| matches!(cell.placement, Some(Placement::Random { .. }));
    let mut taken = Taken::default();
    for (cell, kind) in cells().filter(|(cell, _)| !is_random(cell)) {
        let placed = atoms_at(kind, &centres(experiment, cell, kind));
        taken.boxes.extend(placed.iter().filter_map(|atoms| bounding_box(atoms)).map(|(low, high)| [low, high]));
    }
    let mut places = Vec::new();
    for (cell, kind) in cells() {
        let centres = match &cell.placement {
            Some(Placement::Random { random_from, random_to }) => {
                let corners = [random_from, random_to].map(|corner| vector(corner.map(|x| x.value())));
                place_kind(document, kind, planes, corners, gap, &mut taken)?
            }
            _ => centres(experiment, cell, kind),
        };
        places.push(atoms_at(kind, &centres));
    }
    Ok(places)
}

/// Centres of the cells of a kind, drawn until each has room.
fn place_kind(
    document: &Document,
    kind: &Kind,
    planes: &[Plane],
    [low, high]: [Vec3; 2],
    gap: f64,
    taken: &mut Taken,
) -> Result<Vec<Vec3>> {
    let atoms = &kind.rest.positions;
    let radius = atoms.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let lowest = |plane: &Plane| atoms.iter().map(|p| p.dot(&plane.normal)).fold(f64::INFINITY, f64::min);
    let floors: Vec<(&Plane, f64)> = planes.iter().map(|plane| (plane, lowest(plane) + ROUND_OFF * radius)).collect();
    let mut centres = Vec::new();
    for number in 0..kind.cells {
        let seed = document.experiment.seed;
        let mut stream = Stream::new(seed, Purpose::Placement, (kind.first_cell + number) as u32, 0);
        let is_free = |centre: &Vec3| {
            floors.iter().all(|(plane, lowest)| (centre - plane.point).dot(&plane.normal) + lowest >= 0.0)
                && taken.leaves_room(*centre, radius, gap)
        };
        let found = (0..TRIES).map(|_| draw(&mut stream, low, high)).find(is_free);
        let Some(centre) = found else {
            return Err(too_full(document, kind, number, taken, [low, high], radius));
        };
        taken.spheres.push((centre, radius));
        centres.push(centre);
    }
    Ok(centres)
}

/// That there is no room for a cell.
fn too_full(
    document: &Document,
    kind: &Kind,
    placed: usize,
    taken: &Taken,
    [low, high]: [Vec3; 2],
    radius: f64,
) -> Error {
    let ball = |radius: f64| 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let margin = Vec3::repeat(radius);
    let around = [low - margin, high + margin];
    let size = around[1] - around[0];
    let inside = |(centre, _): &&(Vec3, f64)| centre.inf(&around[1]).sup(&around[0]) == *centre;
    let filled: f64 = taken.spheres.iter().filter(inside).map(|(_, radius)| ball(*radius)).sum();
    let share = 100.0 * filled / (size.x * size.y * size.z);
    let message = format!(
        "there is no room for all cells of type `{}`: {placed} of {} found a place that overlaps no other cell and no \
         plane, the next did not in {TRIES} tries; spheres around the cells fill {share:.0} % of the box",
        kind.name, kind.cells
    );
    let help = "make the box larger or the cells fewer; places at random rarely fill more than 30 %, a grid fills more";
    let fault = Fault::new(message).help(help);
    let place = document.place(&format!("cells.{}.placement", kind.name), "too full");
    Error::input(place.into_iter().fold(fault, Fault::at))
}
