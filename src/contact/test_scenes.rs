//! Random scenes for tests: round, squeezed, bent and noisy cells, sheets, packed and overlapping.

use super::{Reach, Scene, Shape, Sides};
use crate::Vec3;
use crate::geometry::Obstacle;
use crate::geometry::{Surface, icosphere, red_cell, sheet};

/// Numbers uniform in [−1, 1) (splitmix64): a seed gives the same scene on every machine.
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ bits >> 31) >> 11) as f64 * 2f64.powi(-52) - 1.0
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.roll(), self.roll(), self.roll())
    }

    pub fn turn(&mut self) -> nalgebra::UnitQuaternion<f64> {
        nalgebra::UnitQuaternion::from_scaled_axis(self.vector() * std::f64::consts::PI)
    }
}

/// A scene and where its atoms are.
pub struct Stage {
    pub scene: Scene,
    pub positions: Vec<Vec3>,
}

/// Bodies in a scene, from surfaces at rest and positions of their atoms.
pub fn stage(bodies: &[(&Surface, Sides, Vec<Vec3>)], obstacles: Vec<Obstacle>, reach: Reach) -> Stage {
    let shapes: Vec<Shape> =
        bodies.iter().map(|(rest, sides, _)| Shape::new(rest, *sides, 1.5 * reach.prediction)).collect();
    let scene = Scene::new(shapes, &(0..bodies.len()).collect::<Vec<_>>(), obstacles, reach);
    Stage { scene, positions: bodies.iter().flat_map(|body| body.2.iter().copied()).collect() }
}

/// Squeezes along one axis, bends into a banana and adds noise: not convex any more.
pub fn deform(rest: &Surface, dice: &mut Dice, bend: f64, noise: f64) -> Vec<Vec3> {
    let squeeze = 1.0 + 0.3 * dice.roll();
    let position = |x: &Vec3| {
        let squeezed = Vec3::new(x.x / squeeze.sqrt(), x.y / squeeze.sqrt(), x.z * squeeze);
        squeezed + Vec3::x() * (bend * x.z * x.z) + dice.vector() * noise
    };
    rest.positions.iter().map(position).collect()
}

/// Three to eight bodies of all kinds close together, many of them overlapping, and two obstacles.
pub fn random_stage(seed: u64) -> Stage {
    let mut dice = Dice(seed);
    let near = 0.15 + 0.1 * dice.roll();
    let reach = Reach { proximity: near, prediction: near, depth: 0.2, margin: 0.15 };
    let kinds = [
        (icosphere(1.0, 1), Sides::Outer),
        (icosphere(1.0, 0), Sides::Outer),
        (icosphere(1.2, 2), Sides::Outer),
        (red_cell(2.6, 2), Sides::Outer),
        (sheet(2.0, 2.0, 4, 5), Sides::Both),
        (sheet(3.0, 2.0, 3, 2), Sides::Outer),
    ];
    let count = 3 + (2.5 * (1.0 + dice.roll())) as usize;
    let spread = 1.8 + dice.roll();
    let bodies: Vec<_> = (0..count)
        .map(|_| {
            // Half of all are cells of 42 atoms.
            let choice = (6.0 * (1.0 + dice.roll())) as usize;
            let (rest, sides) = &kinds[if choice < kinds.len() { choice } else { 0 }];
            let (bend, noise) = (0.4 * dice.roll(), 0.04 * (1.0 + dice.roll()));
            let (turn, centre) = (dice.turn(), dice.vector() * spread);
            let points = deform(rest, &mut dice, bend, noise).into_iter().map(|x| turn * x + centre).collect();
            (rest, *sides, points)
        })
        .collect();
    let obstacles = vec![
        Obstacle::Plane { point: Vec3::z() * -1.5, normal: Vec3::z() },
        Obstacle::Plane { point: Vec3::x() * 2.5, normal: -Vec3::x() },
    ];
    stage(&bodies, obstacles, reach)
}

/// `count` cells of 42 atoms on an fcc lattice, turned, flattened where they meet and noisy, so that one in three atoms
/// touches; radius 1, mean edge 0.55.
pub fn packed_stage(count: usize, reach: Reach, seed: u64) -> Stage {
    const HALF_DISTANCE: f64 = 0.82;
    let mut dice = Dice(seed);
    let rest = icosphere(1.0, 1);
    let shape = Shape::new(&rest, Sides::Outer, 1.5 * reach.prediction);
    let side = (1..).find(|side: &usize| side.pow(3).div_ceil(2) >= count).expect("a cube large enough");
    let cube = (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side / side]);
    let sites = cube.filter(|site| site.iter().sum::<usize>() % 2 == 0).take(count);
    let displacements = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
    let displacements =
        displacements.map(|displacement: [i8; 3]| Vec3::from(displacement.map(f64::from)) / 2f64.sqrt());
    let mut positions = Vec::new();
    for site in sites {
        let centre = Vec3::from(site.map(|index| index as f64)) * (2f64.sqrt() * HALF_DISTANCE);
        let turn = dice.turn();
        for x in &rest.positions {
            let mut position = turn * x;
            for displacement in displacements {
                let height = position.dot(&displacement);
                position -= displacement * (height - height.clamp(0.02 - HALF_DISTANCE, HALF_DISTANCE - 0.02));
            }
            positions.push(centre + position + dice.vector() * 0.01);
        }
    }
    Stage { scene: Scene::new(vec![shape], &vec![0; count], Vec::new(), reach), positions }
}
