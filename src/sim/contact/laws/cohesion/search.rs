//! What attracts each part of a surface most.

use super::super::super::vectors::gather_corners;
use super::attracted::{Attracted, Attracting, more};
use super::candidates::Candidates;
use super::facet::{Facet, Looking};
use super::patch::{Partner, Patch, depth_of_well};
use super::points::points_of_facet;
use super::table::CohesionTable;
use crate::Vec3;
use crate::contact::{Near, Plane, Scene, is_surely_beyond, opening_to_facet, opening_to_plane};
use crate::sim::controls::Controls;

/// All surfaces at an instant.
pub struct Seen<'a> {
    pub table: &'a CohesionTable,
    pub scene: &'a Scene,
    pub controls: &'a Controls,
    pub positions: &'a [Vec3],
    pub facets: &'a [Facet],
    /// By how much each may have come nearer since it was looked for what is near, µm.
    pub nearer: &'a [f64],
    /// The farthest that anything attracts, µm.
    pub range: f64,
}

/// Which part of a surface a point stands for.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// Its facet, numbered through all bodies.
    pub facet: u32,
    /// The number of the point on it; of surfaces with two sides those of the one from behind count on.
    pub point: u32,
}

/// What may attract points of the facet that is looked at.
#[derive(Debug, Clone, Default)]
pub struct Around {
    /// What is near it, and what of this its points may be attracted by.
    near: Candidates,
    candidates: Candidates,
    bodies: Vec<Attracting>,
    /// What is known to attract each of its points before candidates are looked at.
    first: Vec<Option<Attracted>>,
}

/// No facet is known.
pub const UNKNOWN: u32 = u32::MAX;

impl Seen<'_> {
    /// Calls `found` with the parts of a body that are attracted; `near` are the facets near each of its. `known` are the facets that
    /// attracted each of its points when it was looked last, and becomes those of now, or is empty: a guess that spares looking at most
    /// others and changes nothing.
    pub fn find<'a>(
        &self,
        body: u32,
        near: impl Iterator<Item = Near<'a>>,
        known: &mut [u32],
        around: &mut Around,
        mut found: impl FnMut(Spot, Patch),
    ) {
        let (scene, of) = (self.scene, self.scene.bodies[body as usize]);
        let points = points_of_facet(self.table.points[of.shape as usize]);
        let share = 1.0 / points.len() as f64;
        let sides = scene.sides_of(body);
        let mut known = known.chunks_exact_mut(sides * points.len());
        for (facet, near) in (of.first_facet..).zip(near) {
            let Facet { normal, middle, radius } = self.facets[facet as usize];
            let known = known.next().unwrap_or_default();
            let is_near = |plane: &Plane| (middle - plane.point).dot(&plane.normal) < self.range + radius;
            if near.facets.is_empty() && !scene.planes.iter().any(is_near) {
                known.fill(UNKNOWN);
                continue;
            }
            let own = scene.facet_atoms(body, facet);
            let corners = gather_corners(self.positions, own);
            let at = |weights: &[f64; 3]| weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
            let seen_from = [(own, normal), ([own[0], own[2], own[1]], -normal)];
            around.first.clear();
            for (side, (_, n)) in seen_from[..sides].iter().enumerate() {
                around.first.extend(points.iter().enumerate().map(|(number, weights)| {
                    let known = known.get(side * points.len() + number).copied().unwrap_or(UNKNOWN);
                    more(self.of_known(body, (at(weights), *n), known), self.of_planes(body, (at(weights), *n)))
                }));
            }
            self.look_around(body, (facet, &corners, sides), near, around);
            for (side, (own, n)) in seen_from[..sides].iter().enumerate() {
                around.candidates.bound(points.iter().map(at), *n);
                for (number, weights) in points.iter().enumerate() {
                    let point = side * points.len() + number;
                    let first = around.first[point];
                    let most = self.strongest((at(weights), *n), first, (around, number));
                    if let Some(known) = known.get_mut(point) {
                        *known = most.map_or(UNKNOWN, |most| most.number);
                    }
                    let Some(Attracted { strength, range, partner: other, .. }) = most else { continue };
                    let strength = share * strength * self.adhesion_of(*own, weights, other);
                    let spot = Spot { facet, point: point as u32 };
                    found(spot, Patch { own: *own, other, weights, share, strength, range });
                }
            }
        }
    }

    /// Factor of the strength between a point of a facet and what attracts it.
    fn adhesion_of(&self, own: [u32; 3], weights: &[f64; 3], other: Partner) -> f64 {
        let of_other = match other {
            Partner::Facet(atoms, _) => self.controls.adhesion_between(atoms, [1.0 / 3.0; 3]),
            Partner::Plane(_) => 1.0,
        };
        self.controls.adhesion_between(own, *weights) * of_other
    }

    /// How a body's points are attracted by another body, as if no candidates were known.
    fn between(&self, body: u32, other: u32) -> Attracting {
        let [kind, of_other] = [body, other].map(|body| self.scene.bodies[body as usize].shape as usize);
        let cohesive = self.table.between[kind * self.table.points.len() + of_other];
        let factors = self.controls.adhesion_of(body as usize) * self.controls.adhesion_of(other as usize);
        Attracting { body: other, end: 0, strength: 0.5 * factors * cohesive.strength, range: cohesive.range() }
    }

    /// Finds what of the facets near one of a body, with these corners and so many sides, may attract a point of it more than what is known
    /// to.
    fn look_around(
        &self,
        body: u32,
        (facet, corners, sides): (u32, &[Vec3; 3], usize),
        near: Near,
        around: &mut Around,
    ) {
        let (own, own_nearer) = (self.facets[facet as usize], self.nearer[facet as usize]);
        let Around { near: all, candidates, bodies, first } = around;
        all.empty_for(near.facets.len());
        bodies.clear();
        let Near { facets: mut rest, apart: mut rest_apart } = near;
        while let Some(&next) = rest.first() {
            let other = self.scene.body_of_facet(next);
            let facets_end =
                self.scene.bodies[other as usize].first_facet + self.scene.shape(other).facets.len() as u32;
            let end = rest.partition_point(|facet| *facet < facets_end);
            let (facets, apart);
            (facets, rest) = rest.split_at(end);
            (apart, rest_apart) = rest_apart.split_at(end);
            for (&facet, &apart) in facets.iter().zip(apart) {
                // Not what was too far apart then and has not come near enough since.
                let counts = f64::from(apart) <= own_nearer + self.nearer[facet as usize];
                all.add_if(counts, facet, &self.facets[facet as usize]);
            }
            bodies.push(Attracting { end: all.count(), ..self.between(body, other) });
        }
        all.bound_all(&Looking::from(own, corners), sides == 2);
        let released = first.iter().map(|first| first.map_or(0.0, |first| first.released));
        let released = released.reduce(f64::min).unwrap_or_default();
        candidates.empty_for(all.count());
        let mut start = 0;
        for attracting in bodies {
            candidates.take_nearer(all, start..attracting.end, attracting.widest(released));
            (start, attracting.end) = (attracting.end, candidates.count());
        }
    }

    /// What attracts a point most, with the normal of its surface there, of this and all candidates; its number is that by which their
    /// bounds were found.
    fn strongest(
        &self,
        point: (Vec3, Vec3),
        first: Option<Attracted>,
        (around, number): (&Around, usize),
    ) -> Option<Attracted> {
        let bounds = around.candidates.bounds_of(number);
        let (mut most, mut start) = (first, 0);
        for attracting in &around.bodies {
            let widest = |most: &Option<Attracted>| attracting.widest(most.map_or(0.0, |most| most.released));
            let mut least = widest(&most);
            for candidate in start..attracting.end {
                if bounds[candidate] >= least {
                    continue;
                }
                let facet = around.candidates.facets[candidate];
                if first.is_some_and(|first| first.number == facet) {
                    continue;
                }
                if let Some(found) = self.of_facet(attracting, facet, point, least)
                    && most.is_none_or(|most| found.is_more_than(&most))
                {
                    most = Some(found);
                    least = widest(&most);
                }
            }
            start = attracting.end;
        }
        most
    }

    /// How a facet attracts a point of a body, if there is such a one.
    fn of_known(&self, body: u32, point: (Vec3, Vec3), facet: u32) -> Option<Attracted> {
        let is_there = (facet as usize) < self.facets.len();
        let other = is_there.then(|| self.scene.body_of_facet(facet)).filter(|other| *other != body)?;
        let attracting = self.between(body, other);
        self.of_facet(&attracting, facet, point, attracting.range)
    }

    /// How a facet of a body attracts a point, where the opening is less than the `widest`, µm.
    fn of_facet(&self, by: &Attracting, facet: u32, (x, n): (Vec3, Vec3), widest: f64) -> Option<Attracted> {
        let Facet { normal: mut m, middle, .. } = self.facets[facet as usize];
        let mut atoms = self.scene.facet_atoms(by.body, facet);
        if self.scene.sides_of(by.body) == 2 && (x - middle).dot(&m) < 0.0 {
            (atoms, m) = ([atoms[0], atoms[2], atoms[1]], -m);
        }
        let corners = gather_corners(self.positions, atoms);
        if is_surely_beyond(x, n, &corners, m, widest) {
            return None;
        }
        let (opening, feature) = opening_to_facet(x, n, &corners, m)?;
        self.attracted(by, facet, opening.width, Partner::Facet(atoms, feature))
    }

    /// What attracts a point so far open, if it does.
    fn attracted(&self, by: &Attracting, number: u32, width: f64, partner: Partner) -> Option<Attracted> {
        let Attracting { strength, range, .. } = *by;
        let released = strength * range * depth_of_well(width / range);
        (released > 0.0).then_some(Attracted { released, width, number, strength, range, partner })
    }

    /// What of the planes attracts a point of a body most.
    fn of_planes(&self, body: u32, (x, n): (Vec3, Vec3)) -> Option<Attracted> {
        let kind = self.scene.bodies[body as usize].shape as usize;
        let planes = (0..).zip(&self.scene.planes).filter_map(|(number, plane)| {
            let cohesive = self.table.on_planes[kind * self.scene.planes.len() + number as usize];
            let strength = self.controls.adhesion_of(body as usize) * cohesive.strength;
            let by = Attracting { body, end: 0, strength, range: cohesive.range() };
            let (width, _) = opening_to_plane(n, (x - plane.point).dot(&plane.normal), plane.normal)?;
            self.attracted(&by, self.facets.len() as u32 + number, width, Partner::Plane(number))
        });
        planes.fold(None, |most, found| more(most, Some(found)))
    }
}
