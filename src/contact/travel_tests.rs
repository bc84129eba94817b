//! How far a step may go: what it is held against.

use super::inside::passes_through;
use super::test_scenes::{Dice, deform, packed_stage, stage};
use super::{Detector, Itself, Reach, Scene, Sides, Stride, atom_meets_facet, closest_on_facet};
use crate::Vec3;
use crate::geometry::Obstacle;

const REACH: Reach = Reach { proximity: 0.2, prediction: 0.2, depth: 0.2, margin: 0.1 };

fn measure(detector: &mut Detector, scene: &Scene, before: &[Vec3], after: &[Vec3]) -> f64 {
    let strides: Vec<Stride> = (0..scene.bodies.len() as u32)
        .map(|body| {
            let [before, after] = [before, after].map(|at| scene.of_body(body, at));
            let shape = scene.shape(body);
            let itself = if shape.closed { Itself::Closed(&shape.facets) } else { Itself::Anywhere };
            Stride::of(scene, (before.len(), itself), |atom| before[atom], |atom| after[atom])
        })
        .collect();
    detector.travel(scene, &strides).share
}

/// Every body goes somewhere, and its atoms a little beside it.
fn gone(scene: &Scene, positions: &[Vec3], dice: &mut Dice, [together, apart, beside]: [f64; 3]) -> Vec<Vec3> {
    let all = dice.vector() * together;
    let mut after = positions.to_vec();
    for body in 0..scene.bodies.len() as u32 {
        let own = all + dice.vector() * apart;
        let first = scene.bodies[body as usize].first_atom as usize;
        for x in &mut after[first..first + scene.shape(body).atoms] {
            *x += own + dice.vector() * beside;
        }
    }
    after
}

#[test]
fn what_goes_together_goes_far_and_what_is_told_depends_on_the_step_alone() {
    let stage = packed_stage(27, REACH, 1);
    let (mut kept, mut dice) = (Detector::default(), Dice(5));
    let mut positions = stage.positions.clone();
    for number in 0..20 {
        let sizes = [0.4, 0.02 * f64::from(number % 7), 0.01];
        let after = gone(&stage.scene, &positions, &mut dice, sizes);
        let share = measure(&mut kept, &stage.scene, &positions, &after);
        let fresh = measure(&mut Detector::default(), &stage.scene, &positions, &after);
        assert_eq!(share.to_bits(), fresh.to_bits());
        let farthest = positions.iter().zip(&after).map(|(x, y)| (y - x).norm()).fold(0.0, f64::max);
        let absolute = farthest / stage.scene.safe_travel();
        assert!(share <= absolute, "never more than by what each goes: {share}, {absolute}");
        if number % 7 == 0 && absolute > 2.0 {
            assert!(share < 0.3 * absolute, "{share}, {absolute}");
        }
        positions = after;
    }
}

#[test]
fn where_a_step_is_safe_nothing_met_that_was_farther_apart_than_the_prediction() {
    let mut dice = Dice(11);
    let (mut safe_steps, mut near) = (0, 0);
    for seed in 0..12 {
        let stage = packed_stage(8, REACH, seed);
        let scene = &stage.scene;
        let size = 0.3 * f64::from(seed as u32 % 4);
        let mut after = gone(scene, &stage.positions, &mut dice, [size, 0.3 * size, 0.02]);
        let share = measure(&mut Detector::default(), scene, &stage.positions, &after);
        if share > 1.0 {
            // Just safe.
            let shorten = |(after, before): (&mut Vec3, &Vec3)| *after = before + (*after - before) / share;
            after.iter_mut().zip(&stage.positions).for_each(shorten);
        }
        let share = measure(&mut Detector::default(), scene, &stage.positions, &after);
        assert!(share < 1.0 + 1e-9, "{share}");
        safe_steps += usize::from(share > 0.9);
        near += meetings(scene, &stage.positions, &after);
    }
    assert!(safe_steps > 3 && near > 0, "a test of nothing: {safe_steps} {near}");
}

/// Looks at all pairs of different bodies; those that meet must have been within the prediction. Returns how many do.
fn meetings(scene: &Scene, before: &[Vec3], after: &[Vec3]) -> usize {
    let at = |atom: u32| [before[atom as usize], after[atom as usize]];
    let (mut met, bodies) = (0, scene.bodies.len() as u32);
    for body in 0..bodies {
        for other in (0..bodies).filter(|other| *other != body) {
            let (own, there) = (scene.bodies[body as usize], scene.bodies[other as usize]);
            for atom in own.first_atom..own.first_atom + scene.shape(body).atoms as u32 {
                for facet in there.first_facet..there.first_facet + scene.shape(other).facets.len() as u32 {
                    let corners = scene.facet_atoms(other, facet).map(at);
                    let facet = [0, 1].map(|end| corners.map(|corner| corner[end]));
                    if atom_meets_facet(at(atom), facet, 0.0).is_some() {
                        let gap = closest_on_facet(before[atom as usize], facet[0]).offset.norm();
                        assert!(gap <= scene.reach.prediction, "{gap}");
                        met += 1;
                    }
                }
            }
        }
    }
    met
}

#[test]
fn atoms_near_planes_go_no_farther_than_is_safe_and_those_far_from_them_no_farther_than_they_are() {
    let ball = crate::geometry::icosphere(1.0, 1);
    let obstacle = |height: f64| Obstacle::Plane { point: Vec3::z() * height, normal: Vec3::z() };
    let share = |height: f64, displacement: Vec3| {
        let stage = stage(&[(&ball, Sides::Outer, ball.positions.clone())], vec![obstacle(height)], REACH);
        let after: Vec<Vec3> = stage.positions.iter().map(|x| x + displacement).collect();
        measure(&mut Detector::default(), &stage.scene, &stage.positions, &after)
    };
    let lowest = ball.positions.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    assert!((share(lowest - 0.05, Vec3::z() * -0.1) - 1.0).abs() < 1e-9);
    assert!((share(lowest - 1.0, Vec3::z() * -0.5) - 0.5).abs() < 1e-9);
    // Along it and away from it as far as anywhere.
    assert_eq!(share(lowest - 0.05, Vec3::new(0.5, 0.0, 0.3)), 0.0);
    assert!((share(-1e9, Vec3::z() * -3.2) - 1.0).abs() < 1e-6, "far from everything it goes as far as is looked at");
}

/// Whether an edge of a body goes through a facet of it with which it shares no atom.
fn is_through_itself(scene: &Scene, positions: &[Vec3]) -> bool {
    let shape = scene.shape(0);
    shape.edges.iter().any(|edge| {
        let [from, to] = edge.map(|atom| positions[atom as usize]);
        let mut others = shape.facets.iter().filter(|facet| !facet.iter().any(|atom| edge.contains(atom)));
        others.any(|facet| passes_through(from, to, facet.map(|atom| positions[atom as usize])))
    })
}

#[test]
fn what_stays_round_deforms_as_far_as_it_likes_and_does_not_go_through_itself_and_what_does_not_goes_a_little() {
    let ball = crate::geometry::icosphere(1.0, 1);
    let mut dice = Dice(17);
    let (mut far, mut held, mut wild) = (0, 0, 0);
    for number in 0..80 {
        let bends = [dice.roll(), dice.roll()];
        let noise = 0.15 * f64::from(number % 4);
        let before = deform(&ball, &mut dice, 0.5 * bends[0], 0.2 * noise);
        let mut after = deform(&ball, &mut dice, f64::from(number % 3) * bends[1], noise);
        let stage = stage(&[(&ball, Sides::Outer, before.clone())], Vec::new(), REACH);
        if is_through_itself(&stage.scene, &before) {
            continue;
        }
        wild += usize::from(is_through_itself(&stage.scene, &after));
        let share = measure(&mut Detector::default(), &stage.scene, &before, &after);
        if share > 1.0 {
            held += 1;
            after.iter_mut().zip(&before).for_each(|(after, before)| *after = before + (*after - before) / share);
        }
        let share = measure(&mut Detector::default(), &stage.scene, &before, &after);
        assert!(share < 1.0 + 1e-9, "{share}");
        let farthest = before.iter().zip(&after).map(|(x, y)| (y - x).norm()).fold(0.0, f64::max);
        far += usize::from(farthest > 3.0 * stage.scene.safe_travel());
        assert!(!is_through_itself(&stage.scene, &after), "{number}: {farthest}");
    }
    assert!(far > 10 && held > 10 && wild > 3, "a test of nothing: {far} {held} {wild}");
}
