//! What passes through in a step is never missed.

use super::test_scenes::Dice;
use super::{
    Contacts, Coverage, Detector, Pair, Reach, Sides, atom_meets_facet, closest_on_facet, closest_on_segments,
    edges_meet,
};
use crate::Vec3;
use crate::geometry::icosphere;

const FACET: [Vec3; 3] = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];

#[test]
fn an_atom_falling_through_a_facet_meets_it_half_way() {
    let fall = |x: f64| atom_meets_facet([Vec3::new(x, 0.0, 1.0), Vec3::new(x, 0.0, -1.0)], [FACET, FACET], 1e-9);
    assert!((fall(0.0).expect("a meeting") - 0.5).abs() < 1e-6);
    assert_eq!(fall(0.9), None, "beside the facet");
    let away = [Vec3::z() * 0.1, Vec3::z()];
    assert_eq!(atom_meets_facet(away, [FACET, FACET], 1e-9), None);
    // Moving together, however far, is no meeting.
    let far = Vec3::new(50.0, -20.0, 10.0);
    assert_eq!(atom_meets_facet([Vec3::z() * 0.1, Vec3::z() * 0.1 + far], [FACET, FACET.map(|x| x + far)], 1e-9), None);
    // In the plane of the facet all the time: the cubic is zero, the distance decides.
    let beside = |x: f64| [Vec3::new(3.0, 0.0, 0.0), Vec3::new(x, 0.0, 0.0)];
    assert_eq!(atom_meets_facet(beside(2.0), [FACET, FACET], 1e-9), None);
    assert!(atom_meets_facet(beside(0.0), [FACET, FACET], 1e-9).is_some());
}

#[test]
fn an_edge_through_an_edge_is_met() {
    let x = [Vec3::x() * -1.0, Vec3::x()];
    let y = |height: f64| [Vec3::new(0.3, -1.0, height), Vec3::new(0.3, 1.0, height)];
    let meeting = edges_meet([x, x], [y(0.3), y(-0.1)], 1e-9).expect("a meeting");
    assert!((meeting - 0.75).abs() < 1e-6);
    assert_eq!(edges_meet([x, x], [y(0.3), y(0.1)], 1e-9), None);
    let past = y(0.0).map(|end| end + Vec3::x());
    assert_eq!(edges_meet([x, x], [past.map(|end| end + Vec3::z()), past.map(|end| end - Vec3::z())], 1e-9), None);
}

#[test]
fn no_meeting_of_random_motions_is_missed_and_few_are_made_up() {
    let mut dice = Dice(3);
    let (mut met, mut made_up) = (0, 0);
    for _ in 0..2_000 {
        let mut points = || [0, 1, 2, 3].map(|_| dice.vector());
        let (start, end) = (points(), points());
        let at = |share: f64| [0, 1, 2, 3].map(|k| start[k] + (end[k] - start[k]) * share);
        // Dense samples: the distance between two samples changes by less than the motion between them.
        let least = |distance: &dyn Fn([Vec3; 4]) -> f64| {
            (0..=400).map(|k| distance(at(f64::from(k) / 400.0))).fold(f64::INFINITY, f64::min)
        };
        let facet = |p: [Vec3; 4]| closest_on_facet(p[0], [p[1], p[2], p[3]]).offset.norm();
        let edges = |p: [Vec3; 4]| closest_on_segments([p[0], p[1]], [p[2], p[3]]).0.sqrt();
        let of = |p: [Vec3; 4]| [p[1], p[2], p[3]];
        let by_facet = atom_meets_facet([start[0], end[0]], [of(start), of(end)], 1e-9);
        let pairs = |p: [Vec3; 4]| ([p[0], p[1]], [p[2], p[3]]);
        let (one, other) = (pairs(start), pairs(end));
        let by_edges = edges_meet([one.0, other.0], [one.1, other.1], 1e-9);
        for (found, least, at_meeting) in [
            (by_facet, least(&facet), by_facet.map(|share| facet(at(share)))),
            (by_edges, least(&edges), by_edges.map(|share| edges(at(share)))),
        ] {
            // A sample nearer than 1e-4 is a meeting or a near miss; one in 400 steps of motion 7 cannot hide more.
            if let Some(distance) = at_meeting {
                met += 1;
                assert!(least < 0.02 && distance < 1e-4, "made up: {distance}, sampled {least}");
            } else {
                made_up += usize::from(least < 1e-3);
            }
            assert!(found.is_some() || least > 0.0);
        }
    }
    assert!(met > 300 && made_up < 40, "{met} {made_up}");
}

#[test]
fn a_cell_that_flies_through_a_sheet_in_one_step_is_seen_to_pass() {
    let flat = crate::geometry::sheet(3.0, 3.0, 3, 3);
    let rest = icosphere(0.5, 1);
    let above: Vec<Vec3> = rest.positions.iter().map(|x| x + Vec3::new(0.1, 0.2, 0.55)).collect();
    let reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.05, margin: 2.5 };
    let bodies = [(&flat, Sides::Both, flat.positions.clone()), (&rest, Sides::Outer, above)];
    let stage = super::test_scenes::stage(&bodies, Vec::new(), reach);
    let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
    detector.detect(&stage.scene, &stage.positions, &mut contacts);
    let moved = |displacement: f64| -> Vec<Vec3> {
        let fall = |(atom, x): (usize, &Vec3)| if atom < 16 { *x } else { x - Vec3::z() * displacement };
        stage.positions.iter().enumerate().map(fall).collect()
    };
    let mut passages = Vec::new();
    let mut pass = |displacement: f64| {
        let coverage =
            detector.find_passages(&stage.scene, &stage.positions, &moved(displacement), 1e-9, &mut passages);
        (coverage, passages.clone())
    };
    assert_eq!(pass(0.02), (Coverage::Complete, vec![]));
    let (coverage, through) = pass(1.2);
    assert_eq!(coverage, Coverage::Complete);
    let atoms = through.iter().filter(|passage| matches!(passage.pair, Pair::AtomFacet { .. })).count();
    // Each of the 42 atoms passes a facet, or two on their common side.
    assert!((42..60).contains(&atoms), "{atoms} of 42 atoms pass");
    assert!(through.iter().all(|passage| passage.bodies.contains(&0) && passage.bodies.contains(&1)));
    assert_eq!(pass(1.5).0, Coverage::Partial, "farther than half of the margin");
}

#[test]
fn atoms_that_go_through_a_surface_by_less_than_the_safe_travel_are_found_inside() {
    let reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.05 };
    let mut dice = Dice(8);
    let mut entered = 0;
    for _ in 0..60 {
        let rest = icosphere(1.0, 1);
        let (turn, displacement) = (dice.turn(), dice.vector().normalize());
        let points = rest.positions.iter().map(|x| turn * x + displacement * 1.97).collect();
        let bodies = [(&rest, Sides::Outer, rest.positions.clone()), (&rest, Sides::Outer, points)];
        let mut stage = super::test_scenes::stage(&bodies, Vec::new(), reach);
        let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
        for _ in 0..4 {
            let travel = stage.scene.safe_travel();
            detector.detect(&stage.scene, &stage.positions, &mut contacts);
            let before = contacts.clone();
            let is_inside = |x: &Vec3, there: &[Vec3]| super::winding_number(*x, there, &rest.facets) > 0.5;
            let were_inside: Vec<bool> = (0..84)
                .map(|atom| is_inside(&stage.positions[atom], &stage.positions[if atom < 42 { 42..84 } else { 0..42 }]))
                .collect();
            // The second cell comes nearer, the first not.
            stage.positions[42..].iter_mut().for_each(|x| *x -= displacement * travel);
            detector.detect(&stage.scene, &stage.positions, &mut contacts);
            for atom in 0..84 {
                let there = &stage.positions[if atom < 42 { 42..84 } else { 0..42 }];
                if !were_inside[atom] && is_inside(&stage.positions[atom], there) {
                    entered += 1;
                    let of = |contacts: &Contacts| contacts.atoms.iter().any(|contact| contact.atom == atom as u32);
                    assert!(of(&before), "an atom that enters was a contact before");
                    let gap = contacts.atoms.iter().find(|contact| contact.atom == atom as u32).expect("found").gap;
                    assert!(gap < 0.0 && gap >= -2.0 * travel);
                }
            }
        }
    }
    assert!(entered > 30, "{entered}");
}
