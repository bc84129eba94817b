//! Exact answers for the start of a run: whether a point is inside a closed surface, and which surfaces overlap.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::boxes::Bounds;
use super::neighbours::Neighbours;
use super::parts::Parts;
use super::scene::{Scene, centre};
use super::shape::Sides;
use crate::Vec3;

/// How often a closed surface winds around a point: 1 inside, 0 outside, for a surface that faces outwards.
///
/// The sum of the solid angles of the facets over 4π (van Oosterom & Strackee 1983), eq. (contacts.7). It needs no
/// direction and no tolerance, and facets without area count nothing.
pub fn winding_number(point: Vec3, positions: &[Vec3], facets: &[[u32; 3]]) -> f64 {
    let solid_angle = |facet: &[u32; 3]| {
        let [a, b, c] = facet.map(|atom| positions[atom as usize] - point);
        let [la, lb, lc] = [a.norm(), b.norm(), c.norm()];
        let volume = a.dot(&b.cross(&c));
        2.0 * volume.atan2(la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb)
    };
    facets.iter().map(solid_angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Two surfaces that overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overlap {
    /// The two bodies, the smaller number first.
    pub bodies: [u32; 2],
    /// How many atoms of each are inside the other.
    pub atoms_inside: [u32; 2],
    /// How often an edge of one passes through a facet of the other.
    pub crossings: u32,
}

impl Overlap {
    /// The body that is wholly inside the other, if one is.
    pub fn nested(&self) -> Option<u32> {
        let [first, second] = self.atoms_inside;
        match self.crossings {
            0 if first > 0 => Some(self.bodies[0]),
            0 if second > 0 => Some(self.bodies[1]),
            _ => None,
        }
    }
}

/// Bodies after which it is told how many have been looked at.
const TOLD_EVERY: usize = 256;

/// All pairs of surfaces that overlap or cross, however deep, by the order of bodies. Exact and slow where boxes meet:
/// for the start of a run.
///
/// # Panics
/// When there are not as many positions as atoms.
pub fn find_overlaps(scene: &Scene, positions: &[Vec3]) -> Vec<Overlap> {
    find_overlaps_told(scene, positions, &|_| ())
}

/// The same, telling from time to time which share of the bodies has been looked at.
///
/// # Panics
/// As [`find_overlaps`].
pub fn find_overlaps_told(scene: &Scene, positions: &[Vec3], tell: &(dyn Fn(f64) + Sync)) -> Vec<Overlap> {
    find_among(scene, positions, &|_| true, tell)
}

/// Overlaps after some bodies have moved: what `before` says of the others still holds.
///
/// # Panics
/// As [`find_overlaps`].
pub(super) fn find_overlaps_again(
    scene: &Scene,
    positions: &[Vec3],
    before: &[Overlap],
    moved: &(dyn Fn(u32) -> bool + Sync),
) -> Vec<Overlap> {
    let is_new = |bodies: [u32; 2]| bodies.into_iter().any(moved);
    let mut overlaps = find_among(scene, positions, &is_new, &|_| ());
    overlaps.extend(before.iter().filter(|overlap| !is_new(overlap.bodies)));
    overlaps.sort_unstable_by_key(|overlap| overlap.bodies);
    overlaps
}

/// Overlaps of the pairs of bodies that are asked for.
fn find_among(
    scene: &Scene,
    positions: &[Vec3],
    is_asked: &(dyn Fn([u32; 2]) -> bool + Sync),
    tell: &(dyn Fn(f64) + Sync),
) -> Vec<Overlap> {
    assert_eq!(positions.len(), scene.atoms, "one position per atom of the scene");
    let bounds = bounds_of_bodies(scene, positions);
    let mut neighbours = Neighbours::default();
    neighbours.find(&bounds);
    let looked = AtomicUsize::new(0);
    let with_later = |first: u32| {
        let count = looked.fetch_add(1, Ordering::Relaxed);
        if count.is_multiple_of(TOLD_EVERY) {
            tell(count as f64 / scene.bodies.len() as f64);
        }
        let later = neighbours.of(first).iter().filter(move |&&second| second > first);
        let pairs = later.map(|&second| [first, second]).filter(|pair| is_asked(*pair));
        pairs.filter_map(|pair| overlap_of(scene, positions, pair, &bounds)).collect::<Vec<_>>()
    };
    let of_bodies: Vec<Vec<Overlap>> = (0..scene.bodies.len() as u32).into_par_iter().map(with_later).collect();
    of_bodies.concat()
}

/// The boxes of all bodies.
pub(super) fn bounds_of_bodies(scene: &Scene, positions: &[Vec3]) -> Vec<Bounds> {
    let around = |body: u32| match scene.of_body(body, positions) {
        [] => Bounds::EMPTY,
        atoms => Bounds::around(atoms, 0.0),
    };
    (0..scene.bodies.len() as u32).map(around).collect()
}

/// How two bodies overlap, if they do.
fn overlap_of(scene: &Scene, positions: &[Vec3], bodies: [u32; 2], bounds: &[Bounds]) -> Option<Overlap> {
    let [first, second] = bodies;
    let through = |edges: u32, facets: u32| crossings(scene, positions, [edges, facets], bounds);
    let crossings = [through(first, second), through(second, first)];
    let inside = |inner: u32, outer: u32, crossings: u32| match crossings {
        0 => inside_by_parts(scene, positions, [inner, outer], bounds),
        _ => {
            let within = |position: &&Vec3| is_inside(scene, positions, **position, outer, &bounds[outer as usize]);
            scene.of_body(inner, positions).iter().filter(within).count() as u32
        }
    };
    let atoms_inside = [inside(first, second, crossings[0]), inside(second, first, crossings[1])];
    let crossings = crossings[0] + crossings[1];
    (atoms_inside != [0, 0] || crossings > 0).then_some(Overlap { bodies, atoms_inside, crossings })
}

/// How many atoms of a body are inside another through which none of its edges passes: all atoms that edges join are on one side.
fn inside_by_parts(scene: &Scene, positions: &[Vec3], [inner, outer]: [u32; 2], bounds: &[Bounds]) -> u32 {
    let (shape, here, around) = (scene.shape(inner), scene.of_body(inner, positions), &bounds[outer as usize]);
    let is_beside = |position: &Vec3| !Bounds::around(&[*position], 0.0).meets(around);
    // Most cells are in one piece, with an atom that is not even near the other.
    let mut parts = Parts::new(here.len());
    shape.edges.iter().for_each(|&[a, b]| parts.join(a, b));
    let mut sides = vec![None; here.len()];
    for (position, atom) in here.iter().zip(0..) {
        if is_beside(position) {
            sides[parts.root(atom) as usize] = Some(false);
        }
    }
    let mut is_in = |atom: usize| {
        let root = parts.root(atom as u32) as usize;
        *sides[root].get_or_insert_with(|| is_inside(scene, positions, here[root], outer, around))
    };
    (0..here.len()).filter(|&atom| is_in(atom)).count() as u32
}

/// Whether a point is inside a body, whose box is given; never when the body is open.
pub(super) fn is_inside(scene: &Scene, positions: &[Vec3], position: Vec3, body: u32, bounds: &Bounds) -> bool {
    let shape = scene.shape(body);
    shape.closed
        && shape.sides == Sides::Outer
        && Bounds::around(&[position], 0.0).meets(bounds)
        && winding_number(position, scene.of_body(body, positions), &shape.facets).abs() > 0.5
}

/// Whether the mean of the atoms of a body is inside another, which is closed.
pub fn centre_is_inside(scene: &Scene, positions: &[Vec3], inner: u32, outer: u32) -> bool {
    let bounds = Bounds::around(scene.of_body(outer, positions), 0.0);
    is_inside(scene, positions, centre(scene.of_body(inner, positions)), outer, &bounds)
}

/// The first of `bodies` that has the mean of its atoms inside another, or inside which another has its own: the inner one and the outer
/// one. Where that is so, boxes meet, so that other pairs are not looked at.
///
/// # Panics
/// When there are not as many positions as atoms.
pub fn find_centre_inside(scene: &Scene, positions: &[Vec3], bodies: Range<u32>) -> Option<[u32; 2]> {
    assert_eq!(positions.len(), scene.atoms, "one position per atom of the scene");
    let mut neighbours = Neighbours::default();
    neighbours.find(&bounds_of_bodies(scene, positions));
    let mut both = near_pairs(&neighbours, bodies).flat_map(|[one, other]| [[one, other], [other, one]]);
    both.find(|&[inner, outer]| centre_is_inside(scene, positions, inner, outer))
}

/// Each of `bodies` with each other one whose box meets its own.
fn near_pairs(neighbours: &Neighbours, bodies: Range<u32>) -> impl Iterator<Item = [u32; 2]> {
    let with_others = |body: u32| neighbours.of(body).iter().map(move |other| [body, *other]);
    bodies.flat_map(with_others).filter(|[body, other]| body != other)
}

/// How often edges of one body pass through facets of another.
fn crossings(scene: &Scene, positions: &[Vec3], [edges, facets]: [u32; 2], bounds: &[Bounds]) -> u32 {
    let (here, there) = (scene.of_body(edges, positions), scene.of_body(facets, positions));
    let [around_edges, around_facets] = [edges, facets].map(|body| &bounds[body as usize]);
    let corners = |facet: &[u32; 3]| facet.map(|atom| there[atom as usize]);
    let boxed = scene.shape(facets).facets.iter().map(corners).map(|facet| (Bounds::around(&facet, 0.0), facet));
    let near: Vec<(Bounds, [Vec3; 3])> = boxed.filter(|(bounds, _)| bounds.meets(around_edges)).collect();
    if near.is_empty() {
        return 0;
    }
    let mut count = 0;
    for &[a, b] in &scene.shape(edges).edges {
        let [from, to] = [here[a as usize], here[b as usize]];
        let own = Bounds::around(&[from, to], 0.0);
        if own.meets(around_facets) {
            let passes =
                |(bounds, facet): &&(Bounds, [Vec3; 3])| bounds.meets(&own) && passes_through(from, to, *facet);
            count += near.iter().filter(passes).count() as u32;
        }
    }
    count
}

/// Whether a segment passes through a facet.
pub(super) fn passes_through(from: Vec3, to: Vec3, corners: [Vec3; 3]) -> bool {
    crossing(from, to, corners).is_some()
}

/// Where a segment passes through a facet, from 0 at its begin to 1: its ends are on different sides of the plane, and the line on
/// the same side of all three sides of the facet.
pub(super) fn crossing(from: Vec3, to: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f64> {
    let normal = (b - a).cross(&(c - a));
    let [before, after] = [from, to].map(|point| normal.dot(&(point - a)));
    if before * after >= 0.0 {
        return None;
    }
    let displacement = to - from;
    let turn = |one: Vec3, other: Vec3| displacement.dot(&(one - from).cross(&(other - from)));
    let turns = [turn(a, b), turn(b, c), turn(c, a)];
    let through = turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0);
    through.then(|| before / (before - after))
}

#[cfg(test)]
mod tests {
    use super::super::Reach;
    use super::super::test_scenes::stage;
    use super::*;
    use crate::geometry::icosphere;

    const REACH: Reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 };

    #[test]
    fn middles_are_looked_for_among_neighbours_alone() {
        let ball = icosphere(1.0, 0);
        let shifted = |offset: Vec3| ball.positions.iter().map(|position| position + offset).collect::<Vec<_>>();
        // A lattice so tight that boxes of neighbours meet: each of its 5000 balls has up to 26.
        let at = |n: u32| Vec3::new(f64::from(n % 20), f64::from(n / 20 % 25), f64::from(n / 500)) * 1.5;
        let mut bodies: Vec<_> = (0..5000).map(|n| (&ball, Sides::Outer, shifted(at(n)))).collect();
        let lattice = stage(&bodies, Vec::new(), REACH);
        let mut neighbours = Neighbours::default();
        neighbours.find(&bounds_of_bodies(&lattice.scene, &lattice.positions));
        let looked_at = near_pairs(&neighbours, 0..5000).count();
        assert!(looked_at <= 26 * 5000, "{looked_at} of 25 million pairs");
        assert_eq!(find_centre_inside(&lattice.scene, &lattice.positions, 0..5000), None);
        // One more in the place of another, and one beside it that is in nobody's place.
        bodies.push((&ball, Sides::Outer, shifted(Vec3::new(-9.0, 0.0, 0.0))));
        bodies.push((&ball, Sides::Outer, shifted(at(4321))));
        let with_more = stage(&bodies, Vec::new(), REACH);
        let found = |bodies: Range<u32>| find_centre_inside(&with_more.scene, &with_more.positions, bodies);
        assert_eq!(found(5000..5002), Some([5001, 4321]));
        assert_eq!(found(4000..5000), Some([4321, 5001]));
        assert_eq!(found(0..4321), None);
    }
}
