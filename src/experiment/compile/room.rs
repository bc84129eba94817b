//! Finds room for cells that are placed at random and must not overlap.

use super::super::{CellType, Document, Placement};
use super::place::{centres, draw};
use super::vector;
use crate::Vec3;
use crate::error::{Error, Fault, Result};
use crate::geometry::bounding_box;
use crate::random::{Purpose, Stream};
use crate::sim::{Kind, Plane};
use std::collections::HashMap;

/// Places tried for a cell before the box is called full.
const TRIES: u32 = 10_000;

/// A cell may stand on a plane: how far below it round-off may put it, over its radius.
const ROUND_OFF: f64 = 1e-9;

/// Cells that have a place, found by where they are.
struct Taken {
    /// Boxes around cells whose place the document gives.
    boxes: Near<[Vec3; 2]>,
    /// Spheres around cells placed at random: centre and radius.
    spheres: Near<(Vec3, f64)>,
}

impl Taken {
    /// None yet, where no sphere is larger than `largest` and gaps are `gap`, µm.
    fn new(largest: f64, gap: f64) -> Self {
        let width = 2.0 * largest + gap;
        Self { boxes: Near::new(width), spheres: Near::new(width) }
    }

    /// Whether a sphere is farther than `gap` from all that have a place.
    fn leaves_room(&self, centre: Vec3, radius: f64, gap: f64) -> bool {
        let of_box = |[low, high]: &[Vec3; 2]| (centre - centre.sup(low).inf(high)).norm();
        self.spheres.around(centre).all(|(other, its)| (centre - other).norm() >= radius + its + gap)
            && self.boxes.around(centre).all(|one| of_box(one) >= radius + gap)
    }
}

/// What may be near a point: things in the cubes of a grid, each in those that it meets.
struct Near<T> {
    all: Vec<T>,
    /// Side of a cube, µm: nothing farther than this matters.
    width: f64,
    cubes: HashMap<[i64; 3], Vec<u32>>,
    /// Those that meet too many cubes.
    everywhere: Vec<u32>,
}

/// What meets more cubes than this is looked at everywhere.
const MOST_CUBES: f64 = 10_000.0;

impl<T> Near<T> {
    fn new(width: f64) -> Self {
        Self { all: Vec::new(), width, cubes: HashMap::new(), everywhere: Vec::new() }
    }

    fn cube(&self, point: Vec3) -> [i64; 3] {
        [point.x, point.y, point.z].map(|x| (x / self.width).floor() as i64)
    }

    /// Adds something that lies within a box.
    fn add(&mut self, thing: T, low: Vec3, high: Vec3) {
        let number = self.all.len() as u32;
        self.all.push(thing);
        let cubes = (high - low).iter().map(|side| side / self.width + 2.0).product::<f64>();
        // What is not a number is everywhere, too.
        if cubes.is_nan() || cubes > MOST_CUBES {
            return self.everywhere.push(number);
        }
        let (from, to) = (self.cube(low), self.cube(high));
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                (from[2]..=to[2]).for_each(|z| self.cubes.entry([x, y, z]).or_default().push(number));
            }
        }
    }

    /// All that may be nearer to a point than the width of a cube; some of it several times.
    fn around(&self, point: Vec3) -> impl Iterator<Item = &T> {
        let [x, y, z] = self.cube(point);
        let offsets = (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
        let cubes =
            offsets.map(move |[i, j, k]: [i64; 3]| [x.saturating_add(i), y.saturating_add(j), z.saturating_add(k)]);
        let near = cubes.filter_map(|cube| self.cubes.get(&cube)).flatten();
        near.chain(&self.everywhere).map(|number| &self.all[*number as usize])
    }
}

/// Centres of all cells of all kinds, `[kind][cell]`: those placed at random draw until the spheres around them keep `gap` (µm)
/// between each other and from all other cells, and no atom is behind a plane.
///
/// # Errors
/// When the box is too full.
pub fn centres_apart(document: &Document, kinds: &[Kind], planes: &[Plane], gap: f64) -> Result<Vec<Vec<Vec3>>> {
    let experiment = &document.experiment;
    let cells = || experiment.cells.values().zip(kinds);
    let is_random = |cell: &CellType| matches!(cell.placement, Some(Placement::Random { .. }));
    let mut taken = Taken::new(kinds.iter().map(radius).fold(0.0, f64::max), gap);
    if cells().any(|(cell, _)| is_random(cell)) {
        for (cell, kind) in cells().filter(|(cell, _)| !is_random(cell)) {
            let Some((low, high)) = bounding_box(&kind.rest.positions) else { continue };
            for centre in centres(experiment, cell, kind) {
                taken.boxes.add([low + centre, high + centre], low + centre, high + centre);
            }
        }
    }
    let mut all = Vec::new();
    for (cell, kind) in cells() {
        all.push(match &cell.placement {
            Some(Placement::Random { random_from, random_to }) => {
                let corners = [random_from, random_to].map(|corner| vector(corner.map(|x| x.value())));
                place_kind(document, kind, planes, corners, gap, &mut taken)?
            }
            _ => centres(experiment, cell, kind),
        });
    }
    Ok(all)
}

/// Of the sphere around a cell of a kind, µm.
fn radius(kind: &Kind) -> f64 {
    kind.rest.positions.iter().map(|p| p.norm()).fold(0.0, f64::max)
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
    let radius = radius(kind);
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
        taken.spheres.add((centre, radius), centre, centre);
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
    let filled: f64 = taken.spheres.all.iter().filter(inside).map(|(_, radius)| ball(*radius)).sum();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_is_nearer_than_the_width_is_found_in_the_grid() {
        let mut stream = Stream::new(1, Purpose::Placement, 0, 0);
        let corner = Vec3::repeat(20.0);
        let (mut points, mut boxes) = (Near::new(3.0), Near::new(3.0));
        for number in 0..400 {
            let low = draw(&mut stream, -corner, corner);
            // Boxes from a speck to one that is wider than the whole scene.
            let high = low + Vec3::new(1.0, 0.3, 0.1) * 0.2 * f64::from(number);
            points.add(low, low, low);
            boxes.add([low, high], low, high);
        }
        boxes.add([-1e9 * corner, 1e9 * corner], -1e9 * corner, 1e9 * corner);
        for _ in 0..50 {
            let here = draw(&mut stream, -corner, corner);
            let is_near = |point: &&Vec3| (here - **point).norm() < 3.0;
            let count = points.all.iter().filter(is_near).count();
            assert_eq!(points.around(here).filter(is_near).count(), count, "a point is in one cube");
            let is_near = |[low, high]: &&[Vec3; 2]| (here - here.sup(low).inf(high)).norm() < 3.0;
            let found: Vec<_> = boxes.around(here).filter(is_near).collect();
            assert!(boxes.all.iter().filter(is_near).all(|one| found.contains(&one)));
        }
    }
}
