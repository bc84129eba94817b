//! What attracts each part of a surface most.

use super::super::super::vectors::gather_corners;
use super::patch::{Partner, Patch, depth_of_well, width_of_well};
use super::table::CohesionTable;
use crate::Vec3;
use crate::contact::{NearFacets, Plane, Scene, Sides, opening_to_facet, opening_to_plane};
use crate::sim::controls::Controls;

/// The facets at an instant, and which are near which.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    pub near: NearFacets,
    /// All facets.
    pub facets: Vec<Facet>,
}

impl Surroundings {
    /// Those at these positions, of facets nearer than `range` (µm) to each other. Where they are followed from instant to instant,
    /// what is near is looked for some way farther and kept as long as it will do.
    pub fn find(&mut self, scene: &Scene, positions: &[Vec3], range: f64, are_followed: bool) {
        if are_followed {
            self.near.follow(scene, positions, range);
        } else {
            self.near.find(scene, positions, range);
        }
        self.facets.clear();
        self.facets.extend((0..scene.bodies.len() as u32).flat_map(|body| {
            let first = scene.bodies[body as usize].first_atom;
            let corners = move |facet: &[u32; 3]| gather_corners(positions, facet.map(|atom| first + atom));
            scene.shape(body).facets.iter().map(move |facet| Facet::of(&corners(facet)))
        }));
    }
}

/// All surfaces at an instant.
pub struct Seen<'a> {
    pub table: &'a CohesionTable,
    pub scene: &'a Scene,
    pub controls: &'a Controls,
    pub positions: &'a [Vec3],
    pub facets: &'a [Facet],
    /// The farthest that anything attracts, µm.
    pub range: f64,
}

/// A facet at an instant.
#[derive(Debug, Clone, Copy)]
pub struct Facet {
    /// Its unit normal; zero where it has no area.
    normal: Vec3,
    /// Its middle, µm.
    middle: Vec3,
    /// From there to its farthest corner, µm.
    radius: f64,
}

impl Facet {
    /// The facet with these corners.
    pub fn of(corners: &[Vec3; 3]) -> Self {
        let [a, b, c] = corners;
        let middle = (a + b + c) / 3.0;
        let squared = corners.iter().map(|corner| (corner - middle).norm_squared()).fold(0.0, f64::max);
        Self { normal: (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default(), middle, radius: squared.sqrt() }
    }
}

/// What attracts a point.
struct Attracted {
    /// Of the point's side, pN/µm².
    strength: f64,
    /// µm.
    range: f64,
    partner: Partner,
}

impl Seen<'_> {
    /// Calls `found` with the parts of a body that are attracted; `near` are the facets near each of its.
    pub fn find<'a>(&self, body: u32, near: impl Iterator<Item = &'a [u32]>, mut found: impl FnMut(Patch)) {
        let (scene, of) = (self.scene, self.scene.bodies[body as usize]);
        let points = points_of_facet(self.table.points[of.shape as usize]);
        let share = 1.0 / points.len() as f64;
        for (facet, near) in (of.first_facet..).zip(near) {
            let Facet { normal, middle, radius } = self.facets[facet as usize];
            let is_near = |plane: &Plane| (middle - plane.point).dot(&plane.normal) < self.range + radius;
            if near.is_empty() && !scene.planes.iter().any(is_near) {
                continue;
            }
            let own = scene.facet_atoms(body, facet);
            let corners = gather_corners(self.positions, own);
            let mut first = 0;
            for weights in points {
                let x = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
                let mut add = |own, n| {
                    if let Some(most) = self.strongest(body, (x, n), near, &mut first) {
                        let Attracted { strength, range, partner: other } = most;
                        found(Patch { own, other, weights, share, strength: share * strength, range });
                    }
                };
                add(own, normal);
                if scene.shape(body).sides == Sides::Both {
                    add([own[0], own[2], own[1]], -normal);
                }
            }
        }
    }

    /// What attracts a point of a body most, with the normal of its surface there. `first` is what to look at first: the facet found for a
    /// point beside it.
    fn strongest(&self, body: u32, point: (Vec3, Vec3), near: &[u32], first: &mut u32) -> Option<Attracted> {
        let (scene, kinds) = (self.scene, self.table.points.len());
        let kind = scene.bodies[body as usize].shape as usize;
        let factor = self.controls.adhesion_of(body as usize);
        let (mut most, mut best) = (0.0, None);
        let mut rest = near;
        while let Some(&next) = rest.first() {
            let other = scene.body_of_facet(next);
            let there = scene.bodies[other as usize];
            let count =
                rest.partition_point(|facet| *facet < there.first_facet + scene.shape(other).facets.len() as u32);
            let facets;
            (facets, rest) = rest.split_at(count);
            let cohesive = self.table.between[kind * kinds + there.shape as usize];
            let (strength, range) =
                (0.5 * factor * self.controls.adhesion_of(other as usize) * cohesive.strength, cohesive.range());
            let whole = strength * range;
            if whole <= most {
                continue;
            }
            let widest = range * width_of_well(most / whole);
            if let Some((width, partner)) = self.nearest(other, point, facets, widest, first) {
                most = whole * depth_of_well(width / range);
                best = Some(Attracted { strength, range, partner });
            }
        }
        let (x, n) = point;
        for (number, plane) in (0..).zip(&scene.planes) {
            let cohesive = self.table.on_planes[kind * scene.planes.len() + number as usize];
            let (strength, range) = (factor * cohesive.strength, cohesive.range());
            let height = (x - plane.point).dot(&plane.normal);
            let Some((width, _)) = opening_to_plane(n, height, plane.normal) else { continue };
            let depth = strength * range * depth_of_well(width / range);
            if depth > most {
                (most, best) = (depth, Some(Attracted { strength, range, partner: Partner::Plane(number) }));
            }
        }
        best
    }

    /// The facet of a body with the least opening to a point, and that, if it is less than `widest` (µm).
    fn nearest(
        &self,
        other: u32,
        (x, n): (Vec3, Vec3),
        facets: &[u32],
        mut widest: f64,
        first: &mut u32,
    ) -> Option<(f64, Partner)> {
        let is_thin = self.scene.shape(other).sides == Sides::Both;
        let mut best = None;
        let known = facets.binary_search(first).ok().map(|_| *first);
        for facet in known.into_iter().chain(facets.iter().copied().filter(|facet| Some(*facet) != known)) {
            let Facet { normal, middle, radius } = self.facets[facet as usize];
            // Only what reaches into the ball of the best so far can be better.
            let half = 0.5 * widest.max(0.0);
            let from_centre = x + half * n - middle;
            let reach = half + radius;
            if from_centre.norm_squared() > reach * reach || from_centre.dot(&normal).abs() > half + BEHIND * radius {
                continue;
            }
            let (mut atoms, mut m) = (self.scene.facet_atoms(other, facet), normal);
            if is_thin && (x - middle).dot(&m) < 0.0 {
                (atoms, m) = ([atoms[0], atoms[2], atoms[1]], -m);
            }
            let found = opening_to_facet(x, n, &gather_corners(self.positions, atoms), m);
            if let Some((opening, feature)) = found.filter(|(opening, _)| opening.width < widest) {
                (widest, *first) = (opening.width, facet);
                best = Some((opening.width, Partner::Facet(atoms, feature)));
            }
        }
        best
    }
}

/// What a point may be behind a facet and still be looked at, over the size of the facet.
const BEHIND: f64 = 0.2;

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
