//! Bending at atoms against differences of its energy, where rings are large and where facets fold.

use super::*;
use crate::geometry::{RED_CELL_DIAMETER, Surface, icosphere, red_cell};
use crate::mechanics::Force;
use crate::mechanics::sum::measure_elastic;
use std::f64::consts::PI;

/// Energy (pN·µm) and forces (pN) of a surface with κ = 1 pN·µm.
fn measured(bending: &Force, positions: &[Vec3]) -> (f64, Vec<f64>) {
    let x: Vec<f64> = positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let (mut f, mut energy) = (vec![0.0; x.len()], [0.0]);
    measure_elastic(std::slice::from_ref(bending), 1, &x, &mut f, &mut energy);
    (energy[0], f)
}

fn skin(rest: &Surface, angle: RestAngle) -> Force {
    Force::Bending(Bending::new(&rest.positions, &Topology::of(rest), 1.0, angle))
}

/// The surface with each atom moved by up to `by` (µm) along each axis.
fn shaken(surface: &Surface, by: f64) -> Vec<Vec3> {
    let noise = |i: usize, axis: usize| ((i * 7919 + axis * 104_729 + 13) % 1009) as f64 / 504.0 - 1.0;
    surface.positions.iter().enumerate().map(|(i, p)| Vec3::from_fn(|axis, _| p[axis] + by * noise(i, axis))).collect()
}

/// Two poles over a ring of so many atoms.
fn top(around: u32) -> Surface {
    let at = |k: u32| 2.0 * PI * f64::from(k) / f64::from(around);
    let ring = (0..around).map(|k| Vec3::new(3.0 * at(k).cos(), 3.0 * at(k).sin(), 0.0));
    let positions = ring.chain([Vec3::new(0.0, 0.0, 1.5), Vec3::new(0.0, 0.0, -1.0)]).collect();
    let facets = (0..around)
        .flat_map(|k| {
            let next = (k + 1) % around;
            [[k, next, around], [next, k, around + 1]]
        })
        .collect();
    Surface { positions, facets }
}

#[test]
fn its_forces_are_the_gradient_of_its_energy_on_shapes_that_are_far_from_rest() {
    let ball = icosphere(3.0, 1);
    let long = |x: &Vec3| Vec3::new(2.1 * x.x, 0.8 * x.y, 0.7 * x.z);
    let ellipsoid = Surface { positions: ball.positions.iter().map(long).collect(), facets: ball.facets.clone() };
    // The poles have more neighbours than are kept.
    for (name, shape) in [
        ("ball", ball.clone()),
        ("ellipsoid", ellipsoid),
        ("red cell", red_cell(RED_CELL_DIAMETER, 1)),
        ("top", top(13)),
    ] {
        let edge = crate::geometry::mean_edge_length(&shape);
        for angle in [RestAngle::Remembered, RestAngle::Flat] {
            let (bending, x) = (skin(&shape, angle), shaken(&shape, 0.12 * edge));
            let (energy, forces) = measured(&bending, &x);
            let largest = forces.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            assert!(energy > 0.1, "{name}: {energy}");
            for (k, force) in forces.iter().enumerate() {
                let at = |by: f64| {
                    let mut moved = x.clone();
                    moved[k / 3][k % 3] += by;
                    measured(&bending, &moved).0
                };
                let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                assert!((force + slope).abs() < 1e-6 * largest, "{name}, {angle:?}, {k}: {force} and {}", -slope);
            }
        }
    }
}

#[test]
fn folds_beyond_any_that_a_cell_has_stay_finite() {
    let ball = icosphere(3.0, 1);
    for angle in [RestAngle::Remembered, RestAngle::Flat] {
        let bending = skin(&ball, angle);
        for share in [0.0, -0.5, -1.0, -1.5] {
            let mut x = ball.positions.clone();
            x[12] *= share;
            let (energy, forces) = measured(&bending, &x);
            assert!(energy.is_finite() && forces.iter().all(|f| f.is_finite()), "{share}: {energy}");
        }
    }
}
