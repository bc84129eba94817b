//! Random scenes: kept pairs find what all pairs find, and what is found is right by independent means.

use super::test_scenes::{Dice, Stage, packed_stage, random_stage, stage};
use super::{
    Contacts, Detector, Reach, Sides, closest_on_facet, closest_on_segments, detect_all_pairs, winding_number,
};
use crate::Vec3;
use crate::geometry::icosphere;

const REACH: Reach = Reach { proximity: 0.06, prediction: 0.06, depth: 0.06, margin: 0.1 };

/// Round-off of positions of size 5 over a few operations.
const ROUND_OFF: f64 = 1e-11;

fn all_pairs(stage: &Stage) -> Contacts {
    let mut contacts = Contacts::default();
    detect_all_pairs(&stage.scene, &stage.positions, &mut contacts);
    contacts
}

#[test]
fn kept_pairs_find_exactly_what_all_pairs_find_while_everything_moves() {
    let (mut kept, mut found) = (0, [0; 3]);
    for seed in 0..24 {
        let mut stage = random_stage(seed);
        let mut dice = Dice(1_000 + seed);
        let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
        for step in 0..5 {
            let detection = detector.detect(&stage.scene, &stage.positions, &mut contacts);
            assert_eq!(contacts, all_pairs(&stage), "seed {seed}, step {step}");
            kept += usize::from(!detection.collected);
            found[0] += contacts.atoms.len();
            found[1] += contacts.edges.len();
            found[2] += contacts.obstacles.len();
            // Three such steps pass half of the margin for some atom.
            stage.positions.iter_mut().for_each(|x| *x += dice.vector() * 0.02);
        }
    }
    assert!(kept > 48 && found.iter().all(|&count| count > 100), "a fuzz of nothing: {kept}, {found:?}");
}

#[test]
fn kept_pairs_find_what_all_pairs_find_in_packed_cells_that_drift_and_roll() {
    let reach = Reach { margin: 0.3, ..REACH };
    let (mut kept, mut edges) = (0, 0);
    for seed in 0..4 {
        let mut stage = packed_stage(12, reach, seed);
        let mut dice = Dice(2_000 + seed);
        let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
        let displacements: Vec<Vec3> = stage.scene.bodies.iter().map(|_| dice.vector() * 0.008).collect();
        let turns: Vec<Vec3> = displacements.iter().map(|_| dice.vector() * 0.008).collect();
        for step in 0..12 {
            let detection = detector.detect(&stage.scene, &stage.positions, &mut contacts);
            assert_eq!(contacts, all_pairs(&stage), "seed {seed}, step {step}");
            kept += usize::from(!detection.collected);
            edges += contacts.edges.len();
            for (body, (displacement, turn)) in stage.scene.bodies.iter().zip(displacements.iter().zip(&turns)) {
                let own = &mut stage.positions[body.first_atom as usize..][..42];
                let centre = own.iter().sum::<Vec3>() / 42.0;
                own.iter_mut().for_each(|x| *x += displacement + turn.cross(&(*x - centre)) + dice.vector() * 0.015);
            }
        }
    }
    assert!(kept > 30 && edges > 2000, "a fuzz of nothing: {kept}, {edges}");
}

#[test]
fn where_few_bodies_move_far_their_pairs_are_collected_anew_and_those_of_others_go_on() {
    let reach = Reach { margin: 0.3, ..REACH };
    let (mut few, mut edges) = (0, 0);
    for seed in 0..2 {
        let mut stage = packed_stage(30, reach, seed);
        let mut dice = Dice(3_000 + seed);
        let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
        for step in 0..14 {
            let detection = detector.detect(&stage.scene, &stage.positions, &mut contacts);
            assert_eq!(contacts, all_pairs(&stage), "seed {seed}, step {step}");
            few += usize::from((1..30).contains(&detection.renewed));
            edges += contacts.edges.len();
            // All stir, and two change their places.
            stage.positions.iter_mut().for_each(|x| *x += dice.vector() * 0.004);
            for body in [5 * step % 30, (7 * step + 11) % 30] {
                let displacement = dice.vector() * 0.3;
                stage.positions[42 * body..][..42].iter_mut().for_each(|x| *x += displacement);
            }
        }
    }
    assert!(few > 12 && edges > 2000, "a fuzz of nothing: {few}, {edges}");
}

#[test]
fn contacts_are_the_same_bits_for_any_number_of_threads_and_any_past() {
    let stage = packed_stage(60, REACH, 5);
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of threads");
        pool.install(|| {
            let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
            // A past at other positions, near enough that the pairs are kept.
            let past: Vec<Vec3> = stage.positions.iter().map(|x| x + Vec3::repeat(0.01 * threads as f64)).collect();
            detector.detect(&stage.scene, &past, &mut contacts);
            detector.detect(&stage.scene, &stage.positions, &mut contacts);
            contacts
        })
    };
    let one = with_threads(1);
    assert!(one.atoms.len() > 500 && one.edges.len() > 100, "{} {}", one.atoms.len(), one.edges.len());
    assert_eq!(one, with_threads(2));
    assert_eq!(one, with_threads(3));
    assert!(one.atoms.is_sorted_by_key(|contact| (contact.atom, contact.facet)));
    assert!(one.edges.is_sorted_by_key(|contact| contact.edges));
}

#[test]
fn nothing_grows_once_warmed_up() {
    let mut stage = packed_stage(30, REACH, 2);
    let rest = stage.positions.clone();
    let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
    let mut held = Vec::new();
    for _ in 0..3 {
        let mut dice = Dice(7);
        for _ in 0..6 {
            stage.positions = rest.iter().map(|x| x + dice.vector() * 0.06).collect();
            detector.detect(&stage.scene, &stage.positions, &mut contacts);
        }
        held.push(detector.bytes() + contacts.bytes());
    }
    assert_eq!(held[1], held[2]);
}

#[test]
fn a_contact_is_a_point_of_the_facet_and_a_gap_along_a_unit_normal() {
    for seed in 0..40 {
        let stage = random_stage(seed);
        let contacts = all_pairs(&stage);
        let at = |atom: u32| stage.positions[atom as usize];
        for contact in &contacts.atoms {
            let corners = stage.scene.facet_atoms(contact.body(&stage.scene), contact.facet).map(at);
            let weights = contact.weights();
            // Weights have seven digits, and so have normals.
            assert!(weights.iter().all(|weight| (-1e-7..=1.0 + 1e-7).contains(weight)), "{contact:?}");
            let point: Vec3 = (0..3).map(|k| corners[k] * weights[k]).sum();
            let off = (point + contact.normal.wide() * contact.gap - at(contact.atom)).norm();
            let longest = (0..3).map(|k| (corners[k] - corners[(k + 1) % 3]).norm()).fold(0.0, f64::max);
            assert!(off < ROUND_OFF + 1e-7 * (contact.gap.abs() + longest), "{contact:?}");
            assert!((contact.normal.wide().norm() - 1.0).abs() < 1e-6, "{contact:?}");
        }
        for contact in &contacts.edges {
            let [first, second] = [0, 1].map(|k| {
                let [a, b] = stage.scene.edge_atoms(contact.bodies(&stage.scene)[k], contact.edges[k]).map(at);
                a + (b - a) * f64::from(contact.along[k])
            });
            // Nearly parallel edges: the direction loses digits with the sine of their angle.
            assert!((second + contact.normal.wide() * contact.gap - first).norm() < 1e-6, "seed {seed} {contact:?}");
            assert!((contact.normal.wide().norm() - 1.0).abs() < 1e-6, "{contact:?}");
        }
    }
}

/// The distance of an atom to a surface, by looking at all facets.
fn distance(position: Vec3, positions: &[Vec3], facets: &[[u32; 3]]) -> f64 {
    let of = |facet: &[u32; 3]| closest_on_facet(position, facet.map(|atom| positions[atom as usize])).offset.norm();
    facets.iter().map(of).fold(f64::INFINITY, f64::min)
}

#[test]
fn the_sign_of_a_gap_is_that_of_the_winding_number_and_its_size_the_distance() {
    let (mut inside, mut outside) = (0, 0);
    for seed in 0..60 {
        let mut dice = Dice(seed);
        let rest = icosphere(1.0, 1);
        let mut bodies = Vec::new();
        for _ in 0..2 {
            let (turn, centre) = (dice.turn(), dice.vector() * 0.7);
            // Squeezed and bent, without noise that could make facets pass through each other.
            let bend = 0.5 * dice.roll();
            let points = super::test_scenes::deform(&rest, &mut dice, bend, 0.0);
            bodies.push((&rest, Sides::Outer, points.into_iter().map(|x| turn * x + centre).collect()));
        }
        let reach = Reach { proximity: 0.2, prediction: 0.2, depth: 0.25, margin: 0.1 };
        let stage = stage(&bodies, Vec::new(), reach);
        let contacts = all_pairs(&stage);
        for atom in 0..84 {
            let other = usize::from(atom < 42);
            let there = &stage.positions[42 * other..42 * other + 42];
            let position = stage.positions[atom];
            let far = distance(position, there, &rest.facets);
            let gaps: Vec<f64> = contacts
                .atoms
                .iter()
                .filter(|contact| contact.atom == atom as u32 && contact.body(&stage.scene) == other as u32)
                .map(|contact| contact.gap)
                .collect();
            if winding_number(position, there, &rest.facets) > 0.5 {
                let expected = if far <= reach.depth { vec![-far] } else { vec![] };
                assert_eq!(gaps.len(), expected.len(), "seed {seed}, atom {atom} at −{far}");
                assert!(gaps.iter().zip(&expected).all(|(a, b)| (a - b).abs() < ROUND_OFF), "{gaps:?} {expected:?}");
                inside += gaps.len();
            } else if far < reach.prediction {
                let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
                assert!((least - far).abs() < ROUND_OFF, "seed {seed}, atom {atom}: {gaps:?}, distance {far}");
                outside += 1;
            } else {
                assert!(gaps.is_empty(), "seed {seed}, atom {atom} at {far}: {gaps:?}");
            }
        }
    }
    assert!(inside > 200 && outside > 500, "{inside} {outside}");
}

#[test]
fn the_smallest_gap_of_two_cells_apart_is_their_distance() {
    let mut by_edges = 0;
    for seed in 0..100 {
        let mut dice = Dice(seed);
        let rest = icosphere(1.0, 1);
        let first: Vec<Vec3> = rest.positions.clone();
        let (turn, displacement) = (dice.turn(), dice.vector().normalize());
        let second: Vec<Vec3> =
            rest.positions.iter().map(|x| turn * x + displacement * (2.02 + 0.02 * dice.roll())).collect();
        let reach = Reach { proximity: 0.3, prediction: 0.3, depth: 0.1, margin: 0.1 };
        let stage = stage(&[(&rest, Sides::Outer, first), (&rest, Sides::Outer, second)], Vec::new(), reach);
        let (one, other) = stage.positions.split_at(42);
        let mut least = f64::INFINITY;
        for (position, there) in one.iter().map(|x| (x, other)).chain(other.iter().map(|x| (x, one))) {
            least = least.min(distance(*position, there, &rest.facets));
        }
        let of_atoms = least;
        for a in &stage.scene.shapes[0].edges {
            for b in &stage.scene.shapes[1].edges {
                let segment = |ends: &[u32; 2], positions: &[Vec3]| ends.map(|atom| positions[atom as usize]);
                least = least.min(closest_on_segments(segment(a, one), segment(b, other)).0.sqrt());
            }
        }
        by_edges += usize::from(least < of_atoms - ROUND_OFF);
        assert!((all_pairs(&stage).smallest_gap() - least).abs() < 1e-9, "seed {seed}: {least}");
    }
    assert!(by_edges > 10, "no pair in which edges are nearest: {by_edges}");
}

#[test]
fn the_closest_point_is_no_farther_than_any_point_of_the_facet() {
    let mut dice = Dice(9);
    for case in 0..2_000 {
        let mut corners = [dice.vector(), dice.vector(), dice.vector()];
        match case % 5 {
            1 => corners[2] = corners[0] + (corners[1] - corners[0]) * dice.roll(),
            2 => corners[1] = corners[0],
            3 => corners[2] = corners[0] + (corners[1] - corners[0]) * 0.5 + dice.vector() * 1e-8,
            _ => {}
        }
        let position = dice.vector() * 2.0;
        let found = closest_on_facet(position, corners);
        let [second, third] = found.weights;
        let point = corners[0] * (1.0 - second - third) + corners[1] * second + corners[2] * third;
        // A sliver of height 1e-8 may answer with its side, that much off.
        assert!((position - found.offset - point).norm() < 2e-8);
        for i in 0..=12 {
            for j in 0..=12 - i {
                let [s, t] = [i, j].map(|n| f64::from(n) / 12.0);
                let other = corners[0] * (1.0 - s - t) + corners[1] * s + corners[2] * t;
                assert!((position - other).norm() > found.offset.norm() - 2e-8, "case {case}");
            }
        }
    }
}
