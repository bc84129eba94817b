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
        let found = Points::inside(&bodies).map(|points| match self.statistic {
            GapStatistic::LargestBall => points.largest_ball(&bodies),
            GapStatistic::EmptyShare => points.empty_share(&bodies),
        });
        found.ok_or_else(|| {
            let time = recording.times[frame];
            let cells = if bodies.len() == 1 { "one cell".to_owned() } else { format!("{} cells", bodies.len()) };
            let fault = Fault::new(format!("the largest aggregate at {time} s, of {cells}, has no inside"));
            Error::input(fault.help("give a time at which four cells or more that do not lie in a plane touch"))
        })
    }
}

/// A cell: its atoms and facets, and balls around it and within it.
pub(super) struct Body {
    atoms: Vec<Vec3>,
    facets: Vec<[u32; 3]>,
    /// The middle of each facet, and how far its corners are from there.
    balls: Vec<(Vec3, f64)>,
    centre: Vec3,
    /// No atom is farther from the centre.
    radius: f64,
    /// What is nearer to the centre is inside.
    inscribed: f64,
}

impl Body {
    /// A closed surface that faces outwards.
    pub(super) fn new(atoms: Vec<Vec3>, facets: Vec<[u32; 3]>) -> Self {
        let centre = atoms.iter().sum::<Vec3>() / atoms.len() as f64;
        let radius = atoms.iter().map(|atom| (atom - centre).norm()).fold(0.0, f64::max);
        let ball = |facet: &[u32; 3]| {
            let corners = facet.map(|atom| atoms[atom as usize]);
            let middle = corners.iter().sum::<Vec3>() / 3.0;
            (middle, corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max))
        };
        let balls = facets.iter().map(ball).collect();
        let mut body = Self { atoms, facets, balls, centre, radius, inscribed: 0.0 };
        if winding_number(centre, &body.atoms, &body.facets) > 0.5 {
            body.inscribed = body.distance(centre, f64::INFINITY);
        }
        body
    }

    fn has_inside(&self, position: Vec3) -> bool {
        let distance = (position - self.centre).norm();
        distance < self.inscribed || distance < self.radius && winding_number(position, &self.atoms, &self.facets) > 0.5
    }

    /// How far the surface is from a point, µm; `most` where it is no nearer.
    fn distance(&self, position: Vec3, mut most: f64) -> f64 {
        for (facet, (middle, reach)) in self.facets.iter().zip(&self.balls) {
            let near = most + reach;
            if (position - middle).norm_squared() < near * near {
                let corners = facet.map(|atom| self.atoms[atom as usize]);
                most = most.min(closest_on_facet(position, corners).offset.norm());
            }
        }
        most
    }

    /// No part of it is nearer to a point, µm.
    fn at_least(&self, position: Vec3) -> f64 {
        (position - self.centre).norm() - self.radius
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
    // The one that is nearest by its ball spares most of the others.
    let by_ball = |one: &&Body, other: &&Body| one.at_least(position).total_cmp(&other.at_least(position));
    let nearest = bodies.iter().min_by(by_ball).map_or(f64::INFINITY, |body| body.distance(position, f64::INFINITY));
    bodies.iter().fold(nearest, |nearest, body| match body.at_least(position) < nearest {
        true => body.distance(position, nearest),
        false => nearest,
    })
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

/// Points inside an aggregate, evenly.
pub(super) struct Points {
    inside: Inside,
    points: Vec<Vec3>,
    /// The distance between them, µm.
    step: f64,
}

impl Points {
    /// Those of an aggregate; none where its centres are almost in one plane, so that nothing is inside.
    pub(super) fn inside(bodies: &[Body]) -> Option<Self> {
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
        let points: Vec<Vec3> = (0..nx * ny * nz)
            .into_par_iter()
            .map(|number| [number / ny / nz, number / nz % ny, number % nz].map(|index| index as f64 + 0.5))
            .map(|index| low + Vec3::from(index).component_mul(&step))
            .filter(|position| inside.holds(position))
            .collect();
        (!points.is_empty()).then_some(Self { inside, points, step: step.max() })
    }

    /// The part that no cell fills.
    pub(super) fn empty_share(&self, bodies: &[Body]) -> f64 {
        let is_empty = |position: &&Vec3| !bodies.iter().any(|body| body.has_inside(**position));
        self.points.par_iter().filter(is_empty).count() as f64 / self.points.len() as f64
    }

    /// The radius of the largest ball that fits between the cells, µm.
    pub(super) fn largest_ball(&self, bodies: &[Body]) -> f64 {
        let clearances = self.points.par_iter().map(|position| (clearance(bodies, *position), *position));
        let mut starts: Vec<(f64, Vec3)> = clearances.collect();
        starts.sort_by(|one, other| other.0.total_cmp(&one.0));
        starts.truncate(STARTS);
        let largest = starts.into_par_iter().map(|start| climb(bodies, &self.inside, start, self.step));
        largest.reduce(|| 0.0, f64::max)
    }
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
