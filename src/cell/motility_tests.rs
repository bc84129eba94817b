//! What a Brownian walk promises, held without any mechanics.

use super::*;

const WALKERS: u64 = 2_000;
const SEED: u64 = 20_080;

/// 5 µm/min with a persistence of 2 min, as amoebae do.
fn amoeba(space: Space) -> BrownianMotility {
    BrownianMotility { speed: 5.0 / 60.0, persistence: 120.0, space }
}

/// Positions of a walker at the end of each of `steps` steps.
fn positions(motility: &BrownianMotility, cell: u64, dt: f64, steps: usize) -> Vec<Vec3> {
    let mut walk = motility.start(SEED, cell);
    let mut position = Vec3::zeros();
    (0..steps)
        .map(|_| {
            position += dt * motility.advance(SEED, cell, &mut walk, dt, |_, _| ());
            position
        })
        .collect()
}

#[test]
fn walkers_spread_as_fuerth_says() {
    for space in [Space::Plane, Space::Volume] {
        let motility = amoeba(space);
        let (speed, p) = (motility.speed, motility.persistence);
        let steps = [1, 2, 3, 4, 6, 8, 12, 16, 20, 26, 32, 40];
        let tracks: Vec<Vec<Vec3>> = (0..WALKERS).map(|cell| positions(&motility, cell, p / 4.0, 40)).collect();
        for lag in steps {
            let squares: Vec<f64> = tracks.iter().map(|track| track[lag - 1].norm_squared()).collect();
            let number = squares.len() as f64;
            let mean = squares.iter().sum::<f64>() / number;
            let variance = squares.iter().map(|square| (square - mean).powi(2)).sum::<f64>() / (number - 1.0);
            let t = lag as f64 / 4.0;
            let furth = furth(t * p, speed, p);
            // Three standard errors: the walkers are independent of each other.
            let deviation = (mean - furth).abs() / (variance / number).sqrt();
            assert!(deviation < 3.0, "{space:?}, {t} p: {mean} against {furth}, {deviation} standard errors");
        }
    }
}

#[test]
fn the_step_does_not_change_the_walk() {
    for space in [Space::Plane, Space::Volume] {
        let motility = amoeba(space);
        let p = motility.persistence;
        for cell in 0..50 {
            let fine = positions(&motility, cell, p / 100.0, 3_000);
            let coarse = positions(&motility, cell, 3.0 * p, 10);
            for (index, position) in coarse.iter().enumerate() {
                let distance = (position - fine[300 * index + 299]).norm();
                // Sums of 3 000 terms of about 0.1 µm, rounded each by 1e-17 and at worst all one way.
                assert!(distance < 1e-10, "cell {cell}: {distance} µm apart after {} p", 3 * (index + 1));
            }
        }
    }
}

#[test]
fn runs_fill_the_time_from_the_start() {
    let motility = amoeba(Space::Plane);
    let dt = 0.7 * motility.persistence;
    for cell in 0..100 {
        let mut walk = motility.start(SEED, cell);
        let (mut ends, mut total) = (0.0, 0.0);
        for step in 0..60 {
            motility.advance(SEED, cell, &mut walk, dt, |duration, offset| {
                total += duration;
                ends = f64::from(step) * dt + offset;
            });
        }
        // Round-off over some sixty steps and runs of about 100 s.
        assert!((total - ends).abs() < 1e-9, "runs of {total} s ended at {ends} s");
        assert!((ends + walk.duration - walk.left - 60.0 * dt).abs() < 1e-9);
    }
}

#[test]
fn directions_are_units_and_favour_no_side() {
    for (space, share) in [(Space::Plane, [0.5, 0.5, 0.0]), (Space::Volume, [1.0 / 3.0; 3])] {
        let walks: Vec<Walk> = (0..WALKERS).map(|cell| amoeba(space).start(SEED, cell)).collect();
        for axis in 0..3 {
            let values = walks.iter().map(|walk| walk.direction[axis]);
            let mean = values.clone().sum::<f64>() / WALKERS as f64;
            let square = values.map(|value| value * value).sum::<f64>() / WALKERS as f64;
            // Four standard errors of values that lie within [-1, 1] and have this variance or less.
            assert!(mean.abs() < 4.0 * (share[axis] / WALKERS as f64).sqrt() + 1e-15, "{space:?} {axis}: {mean}");
            assert!((square - share[axis]).abs() < 4.0 * (0.125 / WALKERS as f64).sqrt(), "{space:?} {axis}: {square}");
        }
        assert!(walks.iter().all(|walk| (Vec3::from(walk.direction).norm() - 1.0).abs() < 1e-14));
    }
}

#[test]
fn no_step_gives_the_velocity_of_the_moment_and_changes_nothing() {
    let motility = amoeba(Space::Volume);
    let mut walk = motility.start(SEED, 3);
    let before = walk;
    let velocity = motility.advance(SEED, 3, &mut walk, 0.0, |_, _| panic!("no run can end"));
    assert_eq!(walk, before);
    assert!((velocity.norm() - motility.speed).abs() < 1e-15);
}
