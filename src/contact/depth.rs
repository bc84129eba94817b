//! How deep one surface is inside another, whatever contacts were found: exact and slow, for the instants that are recorded.

use rayon::prelude::*;

use super::boxes::Bounds;
use super::closest::closest_on_facet;
use super::inside::{bounds_of_bodies, crossing, is_inside};
use super::neighbours::Neighbours;
use super::parts::Parts;
use super::scene::Scene;
use super::shape::Sides;
use crate::Vec3;

/// Points at which each part of an edge between two crossings is looked at.
const SAMPLES: usize = 5;

/// The first body, with another, that is deeper inside that than `most` of the two (µm), and the depth. The same whatever the threads.
///
/// # Panics
/// When there are not as many positions as atoms.
pub fn find_deeper(
    scene: &Scene,
    positions: &[Vec3],
    most: impl Fn(u32, u32) -> f64 + Sync,
) -> Option<(u32, u32, f64)> {
    assert_eq!(positions.len(), scene.atoms, "one position per atom of the scene");
    let bounds = bounds_of_bodies(scene, positions);
    let mut neighbours = Neighbours::default();
    neighbours.find(&bounds);
    let first = |inner: u32| {
        neighbours.of(inner).iter().filter(|outer| **outer != inner).find_map(|&outer| {
            let most = most(inner, outer);
            // Any depth is right: there is nothing to measure.
            let depth =
                if most < f64::INFINITY { depth_inside(scene, positions, [inner, outer], &bounds, most) } else { most };
            (depth > most).then_some((inner, outer, depth))
        })
    };
    (0..scene.bodies.len() as u32).into_par_iter().find_map_first(first)
}

/// The deepest that an atom or an edge of one body is inside another, µm: the distance to the surface of the other. No more than
/// `most` where nothing is deeper, and for bodies that have no inside.
fn depth_inside(scene: &Scene, positions: &[Vec3], [inner, outer]: [u32; 2], bounds: &[Bounds], most: f64) -> f64 {
    let (shape, other) = (scene.shape(inner), scene.shape(outer));
    let (here, there) = (scene.of_body(inner, positions), scene.of_body(outer, positions));
    if !other.closed || other.sides != Sides::Outer {
        return most;
    }
    // What passes through the other does so where their boxes overlap: for packed cells that is a thin slab.
    let around_outer = bounds[outer as usize];
    let shared = around_outer.shared_with(&bounds[inner as usize]);
    let corners = |facet: &[u32; 3]| facet.map(|atom| there[atom as usize]);
    let near = other.facets.iter().map(corners).filter(|facet| !shared.is_beside(facet));
    let near: Vec<(Bounds, [Vec3; 3])> = near.map(|facet| (Bounds::around(&facet, 0.0), facet)).collect();
    let distance = |position: Vec3, facets: &mut dyn Iterator<Item = [Vec3; 3]>| {
        facets.map(|facet| closest_on_facet(position, facet).offset.norm()).fold(f64::INFINITY, f64::min)
    };
    // The facets that are near tell at once that most points are not deeper, on whichever side they are, which takes longer to find out.
    let is_shallow =
        |deepest: f64, position: Vec3| distance(position, &mut near.iter().map(|(_, facet)| *facet)) <= deepest;
    let deeper = |deepest: f64, position: Vec3| match is_shallow(deepest, position) {
        true => deepest,
        false => deepest.max(distance(position, &mut other.facets.iter().map(corners))),
    };
    let is_inside = |position: Vec3| is_inside(scene, positions, position, outer, &around_outer);
    let (mut deepest, mut crossings) = (most, Vec::new());
    // Atoms that edges join without a crossing are on one side.
    let mut parts = Parts::new(here.len());
    for &[a, b] in &shape.edges {
        let [from, to] = [here[a as usize], here[b as usize]];
        crossings.clear();
        if !shared.is_beside(&[from, to]) {
            let own = Bounds::around(&[from, to], 0.0);
            let met = near.iter().filter(|(around, _)| around.meets(&own));
            crossings.extend(met.filter_map(|(_, facet)| crossing(from, to, *facet)));
        }
        if crossings.is_empty() {
            parts.join(a, b);
            continue;
        }
        crossings.extend([0.0, 1.0]);
        crossings.sort_unstable_by(f64::total_cmp);
        for part in crossings.windows(2) {
            let at = |share: f64| from.lerp(&to, part[0] + share * (part[1] - part[0]));
            let points = (1..=SAMPLES).map(|position| at(position as f64 / (SAMPLES + 1) as f64));
            if !points.clone().all(|position| is_shallow(deepest, position)) && is_inside(at(0.5)) {
                deepest = points.fold(deepest, deeper);
            }
        }
    }
    // Of each part, by its root, whether it is inside, once that is known.
    let mut sides = vec![None; here.len()];
    for (position, atom) in here.iter().zip(0..) {
        if around_outer.is_beside(&[*position]) {
            sides[parts.root(atom) as usize] = Some(false);
        }
    }
    for (position, atom) in here.iter().zip(0..) {
        let root = parts.root(atom) as usize;
        if sides[root] == Some(false) || is_shallow(deepest, *position) {
            continue;
        }
        if *sides[root].get_or_insert_with(|| is_inside(here[root])) {
            deepest = deeper(deepest, *position);
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::super::Reach;
    use super::super::test_scenes::{Stage, stage};
    use super::*;
    use crate::geometry::{icosphere, sheet};

    const REACH: Reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 };

    /// Depth of the second body in the first.
    fn depth(stage: &Stage) -> f64 {
        let most = |inner: u32, _: u32| if inner == 1 { -1.0 } else { f64::INFINITY };
        find_deeper(&stage.scene, &stage.positions, most).map_or(0.0, |(.., depth)| depth)
    }

    #[test]
    fn a_ball_in_a_ball_is_as_deep_as_its_farthest_point() {
        let ball = icosphere(1.0, 3);
        let at = |x: f64| ball.positions.iter().map(|position| position + Vec3::new(x, 0.0, 0.0)).collect::<Vec<_>>();
        for shift in [1.2, 1.7, 1.95] {
            let bodies = [(&ball, Sides::Outer, at(0.0)), (&ball, Sides::Outer, at(shift))];
            let stage = stage(&bodies, Vec::new(), REACH);
            let depth = depth(&stage);
            // The atom towards the centre of the other is at 2 - shift; facets cut a little off the other ball.
            assert!((depth - (2.0 - shift)).abs() < 0.01, "{shift}: {depth}");
        }
        let bodies = [(&ball, Sides::Outer, at(0.0)), (&ball, Sides::Outer, at(2.1))];
        let stage = stage(&bodies, Vec::new(), REACH);
        assert_eq!(depth(&stage), 0.0);
    }

    #[test]
    fn an_edge_through_a_ball_is_seen_though_its_ends_are_outside() {
        let (ball, flat) = (icosphere(1.0, 3), sheet(8.0, 8.0, 1, 1));
        for height in [0.5, 0.9, 0.97] {
            let bodies = [
                (&ball, Sides::Outer, ball.positions.clone()),
                (
                    &flat,
                    Sides::Both,
                    flat.positions.iter().map(|position| position + Vec3::new(0.0, 0.0, height)).collect(),
                ),
            ];
            let stage = stage(&bodies, Vec::new(), REACH);
            // A sheet has no inside; its diagonal passes over the middle of the ball.
            assert_eq!(
                find_deeper(&stage.scene, &stage.positions, |inner, _| f64::from(inner)).map(|found| found.0),
                None
            );
            let depth = depth(&stage);
            assert!((depth - (1.0 - height)).abs() < 0.02, "{height}: {depth}");
        }
    }
}
