//! Finds free points for cells that are placed at random, at the start of a run and during it.

use super::kind::Kind;
use super::model::Model;
use super::obstacle::Obstacle;
use super::population_trouble::PopulationTrouble;
use super::state::State;
use crate::Vec3;
use crate::geometry::{Occupied, bounding_box, point_in_box};
use crate::random::{Purpose, Stream};

/// Points tried for a cell before a box counts as full.
pub const TRIES: u32 = 10_000;

/// A cell may stand on an obstacle: how far below it round-off may put it, over its radius.
const ROUND_OFF: f64 = 1e-9;

/// Radius of the sphere around a cell at rest, µm.
pub fn radius_around(kind: &Kind) -> f64 {
    kind.rest.positions.iter().map(|p| p.norm()).fold(0.0, f64::max)
}

/// Takes a free point for a cell of a kind in a box: points are drawn until the sphere around the cell keeps the gap from all that is taken and no
/// atom is behind an obstacle. Returns its centre, µm; none when the box is too full.
pub fn take_point(
    kind: &Kind,
    obstacles: &[Obstacle],
    [low, high]: [Vec3; 2],
    stream: &mut Stream,
    taken: &mut Occupied,
) -> Option<Vec3> {
    let radius = radius_around(kind);
    let height = |obstacle: &Obstacle, centre: &Vec3| {
        let atoms = kind.rest.positions.iter().map(|p| obstacle.surface.gap(&(centre + p)));
        atoms.fold(f64::INFINITY, f64::min)
    };
    let is_free = |centre: &Vec3| {
        taken.is_clear(*centre, radius)
            && obstacles.iter().all(|obstacle| height(obstacle, centre) >= -ROUND_OFF * radius)
    };
    let centre = (0..TRIES).map(|_| point_in_box(stream, low, high)).find(is_free)?;
    taken.add_sphere(centre, radius);
    Some(centre)
}

/// Centres of cells that come to a kind at random points of a box, µm, where they keep clear of the cells that there are. Cells that touch
/// nothing are drawn anywhere in it.
///
/// # Errors
/// [`PopulationTrouble::NoSpace`] when the box is too full.
pub(super) fn seed(
    model: &Model,
    state: &State,
    number: usize,
    count: usize,
    corners: [Vec3; 2],
) -> Result<Vec<Vec3>, PopulationTrouble> {
    let kind = &model.kinds[number];
    // The ids that they will have.
    let ids = (0..count as u64).map(|cell| state.next_id + cell);
    let mut streams = ids.map(|id| Stream::new(model.seed, Purpose::Placement, id as u32, 0));
    let Some(contact) = &model.contact else {
        return Ok(streams.map(|mut stream| point_in_box(&mut stream, corners[0], corners[1])).collect());
    };
    let mut taken = Occupied::new(radius_around(kind), contact.reach.proximity);
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for [low, high] in
            (0..now.cells()).filter_map(|cell| bounding_box(&now.cell(kind, cell)).map(<[Vec3; 2]>::from))
        {
            taken.add_box(low, high);
        }
    }
    let found: Option<Vec<Vec3>> = streams
        .by_ref()
        .map(|mut stream| take_point(kind, &model.obstacles, corners, &mut stream, &mut taken))
        .collect();
    found.ok_or_else(|| PopulationTrouble::NoSpace {
        kind: kind.name.clone(),
        found: taken.spheres().len(),
        wanted: count,
    })
}
