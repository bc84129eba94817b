//! What cells of an aggregate leave empty between them.

use rayon::prelude::*;

use super::declared::Declared;
use super::finished::Finished;
use crate::Vec3;
use crate::contact::{closest_on_facet, winding_number};
use crate::error::{Error, Fault, Result};
use crate::geometry::icosphere;
use crate::values::When;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Points along the side of a cube with the volume of a cell.
const POINTS_PER_SIDE: f64 = 20.0;

/// Points in all, at most: of very many cells fewer each.
const MOST_POINTS: f64 = 400_000.0;

/// Points from which the largest ball is looked for, those with most clearance.
const STARTS: usize = 16;

/// How exactly its centre is found, over the distance between points.
const EXACT: f64 = 1e-3;

/// What is empty inside the largest aggregate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Gaps {
    /// The instant.
    #[serde(default)]
    pub time: When,
    /// Which number.
    #[serde(default)]
    pub statistic: GapStatistic,
}

/// Which number of the gaps in an aggregate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum GapStatistic {
    /// The radius of the largest ball that fits between the cells, µm.
    #[default]
    LargestBall,
    /// The part of the inside that no cell fills.
    EmptyShare,
}

impl Gaps {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        if at.records_contacts() {
            at.when("time", self.time);
        }
    }

    /// The number that is asked for.
    ///
    /// # Errors
    /// When the run has no contacts, or the largest aggregate no inside.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let recording = run.recording;
        let Some(file) = run.file else {
            let fault = Fault::new("there is no file that says where the cells are");
            return Err(Error::input(fault.help("measure the result of a run")));
        };
        let frame = recording.frame_at(self.time);
        let aggregate: Vec<u64> = file.cell_values("aggregate", frame)?.iter().map(|first| *first as u64).collect();
        let size = |first: u64| aggregate.iter().filter(|other| **other == first).count();
        let largest = aggregate.iter().copied().min_by_key(|first| (std::cmp::Reverse(size(*first)), *first));
        let (positions, layout, cells) = (file.positions(frame)?, file.layout(), file.cells(frame));
        let of_largest = cells.iter().zip(layout.atoms_of(&cells)).zip(&aggregate);
        let bodies: Vec<Body> = of_largest
            .filter(|(_, first)| Some(**first) == largest)
            .map(|((cell, atoms), _)| {
                let atoms = positions[atoms].iter().map(|position| Vec3::from(*position)).collect();
                Body::new(atoms, layout.types[cell.kind as usize].facets.clone())
            })
            .collect();
        let Some(empty) = find_empty(&bodies) else {
            let time = recording.times[frame];
            let cells = if bodies.len() == 1 { "one cell".to_owned() } else { format!("{} cells", bodies.len()) };
            let fault = Fault::new(format!("the largest aggregate at {time} s, of {cells}, has no inside"));
            return Err(Error::input(
                fault.help("give a time at which four cells or more that do not lie in a plane touch"),
            ));
        };
        Ok(match self.statistic {
            GapStatistic::LargestBall => empty.largest_ball,
            GapStatistic::EmptyShare => empty.share,
        })
    }
}

/// A cell: its atoms and facets, and a ball around it.
pub(super) struct Body {
    atoms: Vec<Vec3>,
    facets: Vec<[u32; 3]>,
    centre: Vec3,
    radius: f64,
}

/// What is empty inside an aggregate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Empty {
    /// Radius of the largest ball that fits between the cells, µm.
    pub largest_ball: f64,
    /// Part of the inside that no cell fills.
    pub share: f64,
}

impl Body {
    /// A closed surface that faces outwards.
    pub(super) fn new(atoms: Vec<Vec3>, facets: Vec<[u32; 3]>) -> Self {
        let centre = atoms.iter().sum::<Vec3>() / atoms.len() as f64;
        let radius = atoms.iter().map(|atom| (atom - centre).norm()).fold(0.0, f64::max);
        Self { atoms, facets, centre, radius }
    }

    fn has_inside(&self, position: Vec3) -> bool {
        (position - self.centre).norm() < self.radius && winding_number(position, &self.atoms, &self.facets) > 0.5
    }

    fn distance(&self, position: Vec3) -> f64 {
        let of_facet = |facet: &[u32; 3]| {
            closest_on_facet(position, facet.map(|atom| self.atoms[atom as usize])).offset.norm_squared()
        };
        self.facets.iter().map(of_facet).fold(f64::INFINITY, f64::min).sqrt()
    }

    fn volume(&self) -> f64 {
        let corner = |atom: u32| self.atoms[atom as usize] - self.centre;
        let of_facet = |&[a, b, c]: &[u32; 3]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0;
        self.facets.iter().map(of_facet).sum()
    }
}

/// The clearance around a point: the distance to the nearest cell, µm, 0 inside one.
fn clearance(bodies: &[Body], position: Vec3) -> f64 {
    if bodies.iter().any(|body| body.has_inside(position)) {
        return 0.0;
    }
    let mut nearest = f64::INFINITY;
    for body in bodies {
        if (position - body.centre).norm() - body.radius < nearest {
            nearest = nearest.min(body.distance(position));
        }
    }
    nearest
}

/// The inside of an aggregate, eq. (analysis.18): what no plane through a centre, with all others behind it, cuts off, in 642 directions.
struct Inside {
    /// Directions and how far the outermost centre is along each, µm.
    planes: Vec<(Vec3, f64)>,
}

impl Inside {
    fn of(bodies: &[Body]) -> Self {
        let farthest =
            |direction: &Vec3| bodies.iter().map(|body| body.centre.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
        Self {
            planes: icosphere(1.0, 3)
                .positions
                .into_iter()
                .map(|direction| (direction, farthest(&direction)))
                .collect(),
        }
    }

    /// How thick it is where it is thinnest, µm.
    fn thickness(&self, bodies: &[Body]) -> f64 {
        let nearest =
            |direction: &Vec3| bodies.iter().map(|body| body.centre.dot(direction)).fold(f64::INFINITY, f64::min);
        self.planes.iter().map(|(direction, farthest)| farthest - nearest(direction)).fold(f64::INFINITY, f64::min)
    }

    fn holds(&self, position: &Vec3) -> bool {
        self.planes.iter().all(|(direction, farthest)| position.dot(direction) <= *farthest)
    }
}

/// Finds what is empty inside an aggregate; none where its centres are almost in one plane, so that nothing is inside.
pub(super) fn find_empty(bodies: &[Body]) -> Option<Empty> {
    let inside = Inside::of(bodies);
    let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    for body in bodies {
        (low, high) = (low.inf(&body.centre), high.sup(&body.centre));
    }
    let size = high - low;
    let volume = bodies.iter().map(Body::volume).sum::<f64>() / bodies.len() as f64;
    let spacing = (volume.cbrt() / POINTS_PER_SIDE).max((size.x * size.y * size.z / MOST_POINTS).cbrt());
    if inside.thickness(bodies) < spacing {
        return None;
    }
    // In the middles of boxes that fill the extent, so that none lies on its rim.
    let counts = size.map(|side| (side / spacing).ceil().max(1.0));
    let step = size.component_div(&counts);
    let [nx, ny, nz] = [counts.x, counts.y, counts.z].map(|count| count as usize);
    let clearances: Vec<(f64, Vec3)> = (0..nx * ny * nz)
        .into_par_iter()
        .map(|number| [number / ny / nz, number / nz % ny, number % nz].map(|index| index as f64 + 0.5))
        .map(|index| low + Vec3::from(index).component_mul(&step))
        .filter(|position| inside.holds(position))
        .map(|position| (clearance(bodies, position), position))
        .collect();
    if clearances.is_empty() {
        return None;
    }
    let share = clearances.iter().filter(|(clearance, _)| *clearance > 0.0).count() as f64 / clearances.len() as f64;
    let mut starts = clearances;
    starts.sort_by(|one, other| other.0.total_cmp(&one.0));
    starts.truncate(STARTS);
    let largest = starts.into_par_iter().map(|start| climb(bodies, &inside, start, step.max()));
    Some(Empty { largest_ball: largest.reduce(|| 0.0, f64::max), share })
}

/// The most clearance near a point: the best of the points around it, ever closer. Clearance has ridges, where it rises along few directions, so
/// that points on all sides are looked at.
fn climb(bodies: &[Body], inside: &Inside, (mut most, mut position): (f64, Vec3), first: f64) -> f64 {
    let mut step = 0.5 * first;
    while step > EXACT * first {
        let around =
            (0..125).map(|number| [number / 25, number / 5 % 5, number % 5].map(|index| f64::from(index) - 2.0));
        let next = around.map(|index| position + step * Vec3::from(index)).filter(|next| inside.holds(next));
        let next = next.map(|next| (clearance(bodies, next), next)).max_by(|one, other| one.0.total_cmp(&other.0));
        match next.filter(|next| next.0 > most) {
            Some(next) => (most, position) = next,
            None => step *= 0.5,
        }
    }
    most
}

#[cfg(test)]
#[path = "gaps_tests.rs"]
mod tests;
