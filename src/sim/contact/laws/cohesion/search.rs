//! What attracts each part of a surface most.

use super::super::super::vectors::gather_corners;
use super::attracted::{Attracted, Attracting, more};
use super::bounds::Looked;
use super::candidates::Candidates;
use super::facet::Facet;
use super::pairs::{Pairs, SeenFacet};
use super::patch::{Partner, Patch};
use super::points::points_of_facet;
use super::table::CohesionTable;
use crate::Vec3;
use crate::contact::{Near, Scene, opening_to_plane};
use crate::geometry::{Beside, Obstacle};
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
    /// What is near it, and the bodies of that.
    near: Candidates,
    bodies: Vec<Attracting>,
    /// Where its points are, and the unit normals there.
    points: Vec<(Vec3, Vec3)>,
    looked: Vec<Looked>,
    pairs: Pairs,
    /// What attracts each of its points most of all that was looked at.
    most: Vec<Option<Attracted>>,
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
            let is_near = |obstacle: &Obstacle| obstacle.gap(&middle) < self.range + radius;
            if near.facets.is_empty() && !scene.obstacles.iter().any(is_near) {
                known.fill(UNKNOWN);
                continue;
            }
            let own = scene.facet_atoms(body, facet);
            let corners = gather_corners(self.positions, own);
            let at = |weights: &[f64; 3]| weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
            let seen_from = [(own, normal), ([own[0], own[2], own[1]], -normal)];
            around.points.clear();
            for (_, n) in &seen_from[..sides] {
                around.points.extend(points.iter().map(|weights| (at(weights), *n)));
            }
            self.look_at_known(body, known, around);
            self.look_around(body, facet, near, around);
            self.look_at_nearer(points.len(), known, around);
            for (point, most) in around.most.iter().enumerate() {
                if let Some(known) = known.get_mut(point) {
                    *known = most.map_or(UNKNOWN, |most| most.number);
                }
                let Some(Attracted { strength, range, partner: other, .. }) = *most else { continue };
                let (own, weights) = (seen_from[point / points.len()].0, &points[point % points.len()]);
                let strength = share * strength * self.adhesion_of(own, weights, other);
                let spot = Spot { facet, point: point as u32 };
                found(spot, Patch { own, other, weights, share, strength, range });
            }
        }
    }

    /// Factor of the strength between a point of a facet and what attracts it.
    fn adhesion_of(&self, own: [u32; 3], weights: &[f64; 3], other: Partner) -> f64 {
        let of_other = match other {
            Partner::Facet(atoms, _) => self.controls.adhesion_between(atoms, [1.0 / 3.0; 3]),
            Partner::Obstacle(_) => 1.0,
        };
        self.controls.adhesion_between(own, *weights) * of_other
    }

    /// How a body's points are attracted by another body, as if no candidates were known.
    fn between(&self, body: u32, other: u32) -> Attracting {
        let [kind, of_other] = [body, other].map(|body| self.scene.bodies[body as usize].shape as usize);
        let cohesive = self.table.between[kind * self.table.points.len() + of_other];
        let factors = self.controls.adhesion_of(body as usize) * self.controls.adhesion_of(other as usize);
        Attracting { body: other, strength: 0.5 * factors * cohesive.strength, range: cohesive.range() }
    }

    /// Finds what attracts the points of a facet of a body most of the facets that are known to have done so, and of obstacles.
    fn look_at_known(&self, body: u32, known: &[u32], around: &mut Around) {
        let Around { points, pairs, most, .. } = around;
        most.clear();
        most.resize(points.len(), None);
        for (point, (at, facet)) in points.iter().zip(known).enumerate() {
            let is_there = (*facet as usize) < self.facets.len();
            let Some(other) = is_there.then(|| self.scene.body_of_facet(*facet)).filter(|other| *other != body) else {
                continue;
            };
            let by = self.between(body, other);
            pairs.add((point, *at), self.seen_from(at.0, by.body, *facet), by, most);
        }
        pairs.look(most);
        for (most, at) in most.iter_mut().zip(points) {
            *most = more(*most, self.of_obstacles(body, *at));
        }
    }

    /// Gathers the facets near one of a body.
    fn look_around(&self, body: u32, facet: u32, near: Near, around: &mut Around) {
        let own_nearer = self.nearer[facet as usize];
        let Around { near: all, bodies, .. } = around;
        all.empty_for(near.facets.len() + 1);
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
                all.add_if(counts, (facet, bodies.len() as u32), &self.facets[facet as usize]);
            }
            bodies.push(self.between(body, other));
        }
    }

    /// Looks at all of what is near that may attract points, so many on a side, more than what is known to, these facets among that.
    fn look_at_nearer(&self, on_side: usize, known: &[u32], around: &mut Around) {
        let Around { near, bodies, points, looked, pairs, most } = around;
        looked.clear();
        looked.extend(points.iter().zip(&*most).map(|((x, _), most)| {
            let released = most.map_or(0.0, |most| most.released);
            let widest = bodies.iter().map(|by| by.widest(released)).fold(0.0, f64::max);
            Looked { x: [x.x, x.y, x.z], widest }
        }));
        for (side, (looked, points)) in looked.chunks(on_side).zip(points.chunks(on_side)).enumerate() {
            near.look_from(looked, side * on_side, points[0].1);
        }
        near.near_points(|point, facet, body| {
            if known.get(point) != Some(&facet) {
                let (at, by) = (points[point], bodies[body as usize]);
                pairs.add((point, at), self.seen_from(at.0, by.body, facet), by, most);
            }
        });
        pairs.look(most);
    }

    /// A facet of a body as a point sees it: of a surface with two sides the one on which the point is.
    #[inline]
    fn seen_from(&self, x: Vec3, body: u32, facet: u32) -> SeenFacet {
        let Facet { mut normal, middle, .. } = self.facets[facet as usize];
        let mut atoms = self.scene.facet_atoms(body, facet);
        if self.scene.sides_of(body) == 2 && (x - middle).dot(&normal) < 0.0 {
            (atoms, normal) = ([atoms[0], atoms[2], atoms[1]], -normal);
        }
        SeenFacet { number: facet, atoms, corners: gather_corners(self.positions, atoms), normal }
    }

    /// What of the obstacles attracts a point of a body most.
    fn of_obstacles(&self, body: u32, (x, n): (Vec3, Vec3)) -> Option<Attracted> {
        let kind = self.scene.bodies[body as usize].shape as usize;
        let obstacles = (0..).zip(&self.scene.obstacles).filter_map(|(number, obstacle)| {
            let cohesive = self.table.on_obstacles[kind * self.scene.obstacles.len() + number as usize];
            let strength = self.controls.adhesion_of(body as usize) * cohesive.strength;
            let by = Attracting { body, strength, range: cohesive.range() };
            let Beside { gap, normal } = obstacle.beside(&x);
            let (width, _) = opening_to_plane(n, gap, normal)?;
            by.attracted(self.facets.len() as u32 + number, width, Partner::Obstacle(number))
        });
        obstacles.fold(None, |most, found| more(most, Some(found)))
    }
}
