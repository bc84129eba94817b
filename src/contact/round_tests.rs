//! Bodies that are round have no pairs with themselves; those that fold do, from the first look on.

use super::round::least_cosine;
use super::scene::centre;
use super::test_scenes::{Stage, stage};
use super::{Contacts, Detector, Itself, Reach, Scene, Shape, Sides, Stride, detect_all_pairs};
use crate::Vec3;
use crate::geometry::{Surface, icosphere};

/// With a margin that is wider than anything moves here.
const REACH: Reach = Reach { proximity: 0.2, prediction: 0.2, depth: 0.2, margin: 2.5 };

/// A ball with a groove along z whose walls come to each other: none at 0, shut at 1.
fn grooved(ball: &Surface, groove: f64) -> Vec<Vec3> {
    let grooved = |x: &Vec3| {
        let near = |width: f64| groove * (-(x.x / width).powi(2)).exp();
        let upper = if x.y > 0.0 { 1.0 } else { 0.0 };
        Vec3::new(x.x * (1.0 - 0.75 * upper * near(0.5)), x.y * (1.0 - upper * near(0.35)), x.z)
    };
    ball.positions.iter().map(grooved).collect()
}

/// Five balls in a row, none near another: two of 162 atoms, which fold, and three of 12.
fn row([fine, coarse]: [&Surface; 2]) -> Stage {
    let at = |ball: &Surface, k: usize| ball.positions.iter().map(|x| x + site(k)).collect::<Vec<_>>();
    let balls = [fine, fine, coarse, coarse, coarse].into_iter().enumerate();
    stage(&balls.map(|(k, ball)| (ball, Sides::Outer, at(ball, k))).collect::<Vec<_>>(), Vec::new(), REACH)
}

fn site(number: usize) -> Vec3 {
    Vec3::x() * (2.6 * number as f64)
}

/// Contacts of atoms and edges of a body with itself.
fn with_itself(stage: &Stage, contacts: &Contacts, body: u32) -> usize {
    let scene = &stage.scene;
    let facet_of =
        |facet: u32| (0..scene.bodies.len() as u32).rfind(|b| scene.bodies[*b as usize].first_facet <= facet);
    let atoms = contacts.atoms.iter().filter(|contact| scene.body_of_atom(contact.atom) == body);
    let edges = contacts.edges.iter().filter(|contact| contact.edges.iter().all(|e| scene.body_of_edge(*e) == body));
    atoms.filter(|contact| facet_of(contact.facet) == Some(body)).count() + edges.count()
}

#[test]
fn a_body_that_folds_touches_itself_at_once_and_one_that_is_round_does_not() {
    let balls = [2, 0].map(|level| icosphere(1.0, level));
    let mut stage = row([&balls[0], &balls[1]]);
    let (mut detector, mut contacts, mut all) = (Detector::default(), Contacts::default(), Contacts::default());
    let (mut few, mut folded, mut round) = (0, 0, 0);
    for step in 0..24 {
        // One after the other closes its groove in eight steps, and opens it while the next does.
        for body in 0..2 {
            let phase = f64::from(step) / 8.0 - body as f64;
            let points = grooved(&balls[0], phase.min(2.0 - phase).clamp(0.0, 1.0));
            let to = &mut stage.positions[162 * body..][..162];
            to.iter_mut().zip(points).for_each(|(to, x)| *to = x + site(body));
        }
        let detection = detector.detect(&stage.scene, &stage.positions, &mut contacts);
        detect_all_pairs(&stage.scene, &stage.positions, &mut all);
        assert_eq!(contacts, all, "step {step}");
        few += usize::from(detection.renewed == 1);
        for body in 0..2 {
            let (is_round, touches) = (stage.scene.is_round(body, &stage.positions), with_itself(&stage, &all, body));
            assert!(!is_round || touches == 0, "step {step}, body {body}");
            folded += usize::from(touches > 0);
            round += usize::from(is_round);
        }
    }
    assert!(few >= 2 && folded > 5 && round > 20, "a test of nothing: {few} {folded} {round}");
}

#[test]
fn pairs_of_a_round_body_with_itself_are_not_kept_however_wide_the_prediction() {
    let ball = icosphere(1.0, 3);
    let pairs = |far: f64| {
        let reach = Reach { proximity: far, prediction: far, depth: far, margin: far };
        // As if surfaces touched themselves wherever they are near enough.
        let shape = Shape::new(&ball, Sides::Outer, 0.0);
        let scene = Scene::new(vec![shape], &[0], Vec::new(), reach);
        let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
        let kept = detector.detect(&scene, &ball.positions, &mut contacts).pairs;
        assert!(contacts.atoms.is_empty() && contacts.edges.is_empty());
        let folded = grooved(&ball, 1.0);
        [kept, detector.detect(&scene, &folded, &mut contacts).pairs]
    };
    let [round, folded] = pairs(0.5);
    assert!(round == 0 && folded > 10_000, "{round} {folded}");
}

#[test]
fn the_least_cosine_is_that_of_the_steepest_wall() {
    let ball = icosphere(1.0, 3);
    let cosine = |points: &[Vec3]| least_cosine(&ball.facets, |atom| points[atom], centre(points));
    assert!(cosine(&ball.positions) > 0.999);
    // Walls of an ellipsoid: of the normals to (x/a, y, z), that lie in a plane with the axis, the one with cos = 2a/(1 + a^2).
    let long: Vec<Vec3> = ball.positions.iter().map(|x| Vec3::new(2.0 * x.x, x.y, x.z)).collect();
    assert!((cosine(&long) - 0.8).abs() < 0.02, "{}", cosine(&long));
    let grooves = [0.2, 0.5, 1.0].map(|groove| cosine(&grooved(&ball, groove)));
    assert!(grooves.is_sorted_by(|one, other| one > other) && grooves[0] > 0.8 && grooves[2] < 0.25, "{grooves:?}");
    let shrunk = vec![Vec3::zeros(); ball.positions.len()];
    assert_eq!(cosine(&shrunk), -1.0);
}

/// A step that begins round is safe where it ends with cosines above an eighth, (contacts.16), though it goes less than by which atoms are held.
#[test]
fn what_begins_round_does_not_end_far_from_it() {
    let ball = icosphere(1.0, 3);
    let reach = Reach { proximity: 4.0, prediction: 4.0, depth: 4.0, margin: 0.1 };
    let scene = Scene::new(vec![Shape::new(&ball, Sides::Outer, 0.0)], &[0], Vec::new(), reach);
    let cosine = |points: &[Vec3]| least_cosine(&ball.facets, |atom| points[atom], centre(points));
    let before = grooved(&ball, 0.3);
    assert!(cosine(&before) > 0.5, "{}", cosine(&before));
    let (mut safe, mut unsafe_ones) = (0, 0);
    for number in 0..=40 {
        let after = grooved(&ball, 0.8 + 0.01 * f64::from(number));
        let itself = Itself::Closed(&ball.facets);
        let stride = Stride::of(&scene, (before.len(), itself), |atom| before[atom], |atom| after[atom]);
        let share = Detector::default().travel(&scene, &[stride]).share;
        assert_eq!(share > 1.0, cosine(&after) < 0.125, "{number}: {share}, {}", cosine(&after));
        assert_eq!(share == 0.0, cosine(&after) > 0.25, "{number}: {share}, {}", cosine(&after));
        safe += usize::from(share <= 1.0);
        unsafe_ones += usize::from(share > 1.0);
    }
    assert!(safe > 2 && unsafe_ones > 2, "a test of nothing: {safe} {unsafe_ones}");
}
