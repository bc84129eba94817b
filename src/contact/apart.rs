//! Pushes bodies that overlap apart, each as a whole: for the start of a run.

use rayon::prelude::*;

use super::inside::{Overlap, find_overlaps, find_overlaps_again};
use super::scene::Scene;
use super::separation::separation;
use crate::Vec3;
use crate::geometry::{Beside, Obstacle};

/// What bodies may do while they are pushed apart.
#[derive(Debug, Clone, Copy)]
pub struct Yielding<'a> {
    /// How much each body resists: two bodies move in inverse proportion. Infinite: it stays where it is.
    pub resistance: &'a [f64],
    /// What is left between two bodies that were pushed, µm.
    pub gap: f64,
    /// The farthest that a body moves in a round, µm: less than would bring it past another unseen.
    pub stride: f64,
    /// Rounds after which what still overlaps is left so.
    pub rounds: u32,
}

/// Moves bodies as wholes until none overlaps another. In a round every pair that overlaps asks for the shortest displacement
/// apart along the line of centres, or along the normal of their overlap where that is clearly shorter; a body makes the
/// sum of what its pairs ask for. No body is moved behind an obstacle, or farther behind it than it was. Returns how far each
/// has been moved, µm, and what still overlaps. Each round that begins is told, with the number of pairs that overlap. Deterministic,
/// whatever the threads.
///
/// # Panics
/// When there are not as many positions as atoms, or not as many resistances as bodies.
pub fn push_apart(
    scene: &Scene,
    positions: &mut [Vec3],
    yielding: &Yielding,
    tell: &dyn Fn(u32, usize),
) -> (Vec<Vec3>, Vec<Overlap>) {
    assert_eq!(yielding.resistance.len(), scene.bodies.len(), "one resistance for each body");
    let bodies = 0..scene.bodies.len() as u32;
    let floors: Vec<Vec<f64>> =
        bodies.clone().map(|body| heights(scene, body, positions).map(|height| height.min(0.0)).collect()).collect();
    let mut moves = vec![Vec3::zeros(); scene.bodies.len()];
    let mut left = find_overlaps(scene, positions);
    for round in 1..=yielding.rounds {
        if left.is_empty() {
            break;
        }
        tell(round, left.len());
        let displacements: Vec<Vec3> =
            left.par_iter().map(|overlap| separation(scene, positions, overlap.bodies, yielding.gap)).collect();
        let mut steps = vec![Vec3::zeros(); scene.bodies.len()];
        for (overlap, displacement) in left.iter().zip(displacements) {
            let [first, second] = overlap.bodies.map(|body| body as usize);
            let [share, other] = shares(yielding.resistance[first], yielding.resistance[second]);
            steps[first] += share * displacement;
            steps[second] -= other * displacement;
        }
        let mut moved: Vec<bool> = steps.iter().map(|step| *step != Vec3::zeros()).collect();
        for body in bodies.clone().filter(|body| moved[*body as usize]) {
            let step = steps[body as usize].cap_magnitude(yielding.stride);
            moves[body as usize] += step;
            shift(scene, body, positions, step);
        }
        for (body, displacement) in
            bodies.clone().zip(&mut moves).filter(|(_, displacement)| **displacement != Vec3::zeros())
        {
            let back = back_before_obstacles(scene, body, positions, &floors[body as usize]);
            *displacement += back;
            moved[body as usize] |= back != Vec3::zeros();
        }
        left = find_overlaps_again(scene, positions, &left, &|body| moved[body as usize]);
    }
    (moves, left)
}

/// What two bodies move of the displacement between them.
fn shares(resistance: f64, other: f64) -> [f64; 2] {
    match (resistance.is_finite(), other.is_finite()) {
        (true, true) => [other / (resistance + other), resistance / (resistance + other)],
        (true, false) => [1.0, 0.0],
        (false, true) => [0.0, 1.0],
        (false, false) => [0.0, 0.0],
    }
}

/// Heights of a body's lowest atom over each obstacle, µm.
fn heights<'a>(scene: &'a Scene, body: u32, positions: &'a [Vec3]) -> impl Iterator<Item = f64> + 'a {
    scene.obstacles.iter().map(move |obstacle| lowest(obstacle, scene.of_body(body, positions)).gap)
}

/// Where the lowest of some atoms is over an obstacle.
fn lowest(obstacle: &Obstacle, atoms: &[Vec3]) -> Beside {
    let none = Beside { gap: f64::INFINITY, normal: Vec3::zeros() };
    let all = atoms.iter().map(|x| obstacle.beside(x));
    all.fold(none, |lowest, beside| if beside.gap < lowest.gap { beside } else { lowest })
}

fn shift(scene: &Scene, body: u32, positions: &mut [Vec3], step: Vec3) {
    let first = scene.bodies[body as usize].first_atom as usize;
    let atoms = scene.shape(body).atoms;
    positions[first..first + atoms].iter_mut().for_each(|x| *x += step);
}

/// Times that a body is put back before all obstacles; where two of them meet, one puts it behind the other a little.
const TURNS: u32 = 8;

/// Puts a body back to where no obstacle is passed, and tells how far.
fn back_before_obstacles(scene: &Scene, body: u32, positions: &mut [Vec3], floors: &[f64]) -> Vec3 {
    let mut back = Vec3::zeros();
    for _ in 0..TURNS {
        let mut good = true;
        for (number, obstacle) in scene.obstacles.iter().enumerate() {
            let Beside { gap, normal } = lowest(obstacle, scene.of_body(body, positions));
            if gap < floors[number] {
                let step = (floors[number] - gap) * normal;
                shift(scene, body, positions, step);
                (back, good) = (back + step, false);
            }
        }
        if good {
            break;
        }
    }
    back
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::test_scenes::random_stage;

    #[test]
    fn after_some_bodies_moved_overlaps_are_those_of_a_whole_look() {
        let mut compared = 0;
        for seed in 0..40 {
            let mut stage = random_stage(seed);
            let before = find_overlaps(&stage.scene, &stage.positions);
            let moves = |body: u32| body.is_multiple_of(3);
            for body in (0..stage.scene.bodies.len() as u32).filter(|body| moves(*body)) {
                shift(&stage.scene, body, &mut stage.positions, Vec3::new(0.3, -0.2, 0.1));
            }
            let whole = find_overlaps(&stage.scene, &stage.positions);
            assert_eq!(find_overlaps_again(&stage.scene, &stage.positions, &before, &moves), whole, "seed {seed}");
            compared += usize::from(before != whole);
        }
        assert!(compared > 20, "in {compared} scenes only something changed");
    }
}
