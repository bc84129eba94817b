//! What attracts each part of a surface most.

use super::super::super::vectors::gather_corners;
use super::candidates::{Candidates, Facet, apart, least_opening_between, may_meet, nearer};
use super::patch::{Partner, Patch, depth_of_well, width_of_well};
use super::table::CohesionTable;
use crate::Vec3;
use crate::contact::{Near, NearFacets, Plane, Scene, Sides, is_surely_beyond, opening_to_facet, opening_to_plane};
use crate::sim::controls::Controls;

/// The facets at an instant, and which are near which.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    pub near: NearFacets,
    /// All facets.
    pub facets: Vec<Facet>,
    /// What they were when it was looked for what is near.
    then: Vec<Facet>,
    /// By how much each may have come nearer to others since then, µm.
    pub nearer: Vec<f64>,
}

impl Surroundings {
    /// Those at these positions, of facets nearer than `range` (µm) to each other. Where they are followed from instant to instant,
    /// what is near is looked for some way farther and kept as long as it will do.
    pub fn find(&mut self, scene: &Scene, positions: &[Vec3], range: f64, are_followed: bool) {
        let Self { near, facets, then, nearer: of_facets } = self;
        facets.clear();
        facets.extend((0..scene.bodies.len() as u32).flat_map(|body| {
            let first = scene.bodies[body as usize].first_atom;
            let corners = move |facet: &[u32; 3]| gather_corners(positions, facet.map(|atom| first + atom));
            scene.shape(body).facets.iter().map(move |facet| Facet::of(&corners(facet)))
        }));
        // Rounded so that it is less than it was.
        let apart = |own: u32, other: u32| {
            let has_two = scene.shape(scene.body_of_facet(own)).sides == Sides::Both;
            let [own, other] = [own, other].map(|facet| &facets[facet as usize]);
            let before = apart(own, own.normal, other, range);
            (if has_two { before.min(apart(own, -own.normal, other, range)) } else { before } - 1e-5) as f32
        };
        let are_new = if are_followed {
            near.follow(scene, positions, range, apart)
        } else {
            near.find(scene, positions, range, apart);
            true
        };
        if are_new {
            then.clone_from(facets);
        }
        of_facets.clear();
        of_facets.extend(facets.iter().zip(&*then).map(|(now, then)| nearer(now, then, range)));
    }
}

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

/// What attracts a point.
struct Attracted {
    /// Of the point's side, pN/µm².
    strength: f64,
    /// µm.
    range: f64,
    partner: Partner,
}

/// A body whose facets may attract points of a facet.
#[derive(Debug, Clone, Copy)]
struct Attracting {
    body: u32,
    /// The end of its candidates; they begin where those of the body before it end.
    end: usize,
    /// Of the point's side, pN/µm².
    strength: f64,
    /// µm.
    range: f64,
}

/// What may attract points of the facet that is looked at.
#[derive(Debug, Clone, Default)]
pub struct Around {
    candidates: Candidates,
    bodies: Vec<Attracting>,
}

impl Seen<'_> {
    /// Calls `found` with the parts of a body that are attracted; `near` are the facets near each of its.
    pub fn find<'a>(
        &self,
        body: u32,
        near: impl Iterator<Item = Near<'a>>,
        around: &mut Around,
        mut found: impl FnMut(Spot, Patch),
    ) {
        let (scene, of) = (self.scene, self.scene.bodies[body as usize]);
        let points = points_of_facet(self.table.points[of.shape as usize]);
        let share = 1.0 / points.len() as f64;
        let has_two = scene.shape(body).sides == Sides::Both;
        for (facet, near) in (of.first_facet..).zip(near) {
            let Facet { normal, middle, radius } = self.facets[facet as usize];
            self.look_around(body, (facet, has_two), near, around);
            let is_near = |plane: &Plane| (middle - plane.point).dot(&plane.normal) < self.range + radius;
            if around.candidates.facets.is_empty() && !scene.planes.iter().any(is_near) {
                continue;
            }
            let own = scene.facet_atoms(body, facet);
            let corners = gather_corners(self.positions, own);
            let at = |weights: &[f64; 3]| weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
            let other_side = has_two.then_some(([own[0], own[2], own[1]], -normal));
            for (side, (own, n)) in (0..).zip(std::iter::once((own, normal)).chain(other_side)) {
                around.candidates.bound(points.iter().map(at), n);
                let mut first = 0;
                for (number, weights) in points.iter().enumerate() {
                    if let Some(most) = self.strongest(body, (at(weights), n), (around, number), &mut first) {
                        let Attracted { strength, range, partner: other } = most;
                        let strength = strength * self.adhesion_of(own, weights, other);
                        let spot = Spot { facet, point: (side * points.len() + number) as u32 };
                        found(spot, Patch { own, other, weights, share, strength: share * strength, range });
                    }
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

    /// Finds what of the facets near one of a body may attract a point of it, be it from behind where it `has_two` sides.
    fn look_around(&self, body: u32, (facet, has_two): (u32, bool), near: Near, around: &mut Around) {
        let (scene, kinds) = (self.scene, self.table.points.len());
        let (own, own_nearer) = (self.facets[facet as usize], self.nearer[facet as usize]);
        let kind = scene.bodies[body as usize].shape as usize;
        let factor = self.controls.adhesion_of(body as usize);
        let Around { candidates, bodies } = around;
        candidates.clear();
        bodies.clear();
        let Near { facets: mut rest, apart: mut rest_apart } = near;
        while let Some(&next) = rest.first() {
            let other = scene.body_of_facet(next);
            let there = scene.bodies[other as usize];
            let facets_end = there.first_facet + scene.shape(other).facets.len() as u32;
            let end = rest.partition_point(|facet| *facet < facets_end);
            let (facets, apart);
            (facets, rest) = rest.split_at(end);
            (apart, rest_apart) = rest_apart.split_at(end);
            let cohesive = self.table.between[kind * kinds + there.shape as usize];
            let strength = 0.5 * factor * self.controls.adhesion_of(other as usize) * cohesive.strength;
            let range = cohesive.range();
            for (&facet, &apart) in facets.iter().zip(apart) {
                // What was too far apart then and has not come near enough since.
                if f64::from(apart) > own_nearer + self.nearer[facet as usize] {
                    continue;
                }
                let seen = &self.facets[facet as usize];
                let is_met = |n: Vec3| may_meet(&own, n, seen, range) && least_opening_between(&own, n, seen) < range;
                if is_met(own.normal) || has_two && is_met(-own.normal) {
                    candidates.push(facet, seen);
                }
            }
            bodies.push(Attracting { body: other, end: candidates.facets.len(), strength, range });
        }
    }

    /// What attracts a point of a body most, with the normal of its surface there; its number is that by which bounds were found. `first`
    /// is what to look at first: the candidate found for a point beside it.
    fn strongest(
        &self,
        body: u32,
        point: (Vec3, Vec3),
        (around, number): (&Around, usize),
        first: &mut usize,
    ) -> Option<Attracted> {
        let (mut most, mut best, mut start) = (0.0, None, 0);
        for &Attracting { body: other, end, strength, range } in &around.bodies {
            let candidates = start..end;
            start = end;
            let whole = strength * range;
            if whole <= most {
                continue;
            }
            let widest = range * width_of_well(most / whole);
            let found = self.nearest(other, point, (&around.candidates, number, candidates), widest, first);
            if let Some((width, partner)) = found {
                most = whole * depth_of_well(width / range);
                best = Some(Attracted { strength, range, partner });
            }
        }
        let (x, n) = point;
        let kind = self.scene.bodies[body as usize].shape as usize;
        for (number, plane) in (0..).zip(&self.scene.planes) {
            let cohesive = self.table.on_planes[kind * self.scene.planes.len() + number as usize];
            let strength = self.controls.adhesion_of(body as usize) * cohesive.strength;
            let range = cohesive.range();
            let height = (x - plane.point).dot(&plane.normal);
            let Some((width, _)) = opening_to_plane(n, height, plane.normal) else { continue };
            let depth = strength * range * depth_of_well(width / range);
            if depth > most {
                (most, best) = (depth, Some(Attracted { strength, range, partner: Partner::Plane(number) }));
            }
        }
        best
    }

    /// The facet of a body with the least opening to a point, and that, if it is less than `widest` (µm), of the candidates in a range of
    /// their numbers.
    fn nearest(
        &self,
        other: u32,
        (x, n): (Vec3, Vec3),
        (candidates, point, numbers): (&Candidates, usize, std::ops::Range<usize>),
        mut widest: f64,
        first: &mut usize,
    ) -> Option<(f64, Partner)> {
        let is_thin = self.scene.shape(other).sides == Sides::Both;
        let bounds = &candidates.bounds_of(point)[..numbers.end];
        let known = numbers.contains(first).then_some(*first);
        let mut best = None;
        let mut look = |number: usize, widest: &mut f64| {
            let facet = candidates.facets[number];
            let Facet { normal: mut m, middle, .. } = self.facets[facet as usize];
            let mut atoms = self.scene.facet_atoms(other, facet);
            if is_thin && (x - middle).dot(&m) < 0.0 {
                (atoms, m) = ([atoms[0], atoms[2], atoms[1]], -m);
            }
            let corners = gather_corners(self.positions, atoms);
            if is_surely_beyond(x, n, &corners, m, *widest) {
                return;
            }
            let found = opening_to_facet(x, n, &corners, m);
            if let Some((opening, feature)) = found.filter(|(opening, _)| opening.width < *widest) {
                (*widest, *first) = (opening.width, number);
                best = Some((opening.width, Partner::Facet(atoms, feature)));
            }
        };
        // What is surely farther than the best so far is passed over: so what is likely the best is looked at first.
        let likely = numbers.clone().min_by(|one, other| bounds[*one].total_cmp(&bounds[*other]));
        let likely = likely.filter(|likely| Some(*likely) != known);
        for number in [known, likely].into_iter().flatten() {
            if bounds[number] < widest {
                look(number, &mut widest);
            }
        }
        for number in numbers {
            if bounds[number] < widest && Some(number) != known && Some(number) != likely {
                look(number, &mut widest);
            }
        }
        best
    }
}

/// Barycentric weights of the middles of the parts of a facet whose sides are cut into so many.
pub fn points_of_facet(parts: u32) -> &'static [[f64; 3]] {
    const fn middles<const N: usize>(parts: usize) -> [[f64; 3]; N] {
        let (mut all, mut next) = ([[0.0; 3]; N], 0);
        let mut i = 0;
        while i < parts {
            let mut j = 0;
            while i + j < parts {
                let mut half = 0;
                while half < 2 && i + j + half < parts {
                    let third = (1 + half) as f64 / 3.0;
                    let (v, w) = ((i as f64 + third) / parts as f64, (j as f64 + third) / parts as f64);
                    all[next] = [1.0 - v - w, v, w];
                    next += 1;
                    half += 1;
                }
                j += 1;
            }
            i += 1;
        }
        all
    }
    const ONE: [[f64; 3]; 1] = middles(1);
    const TWO: [[f64; 3]; 4] = middles(2);
    const THREE: [[f64; 3]; 9] = middles(3);
    const FOUR: [[f64; 3]; 16] = middles(4);
    match parts {
        0 | 1 => &ONE,
        2 => &TWO,
        3 => &THREE,
        _ => &FOUR,
    }
}
