//! Walks without mechanics: what cells do when nothing holds them is Fürth's walk with exponential runs.

use ndarray::Array3;
use pseudopod::Vec3;
use pseudopod::analysis::furth::{Localisation, fit_furth};
use pseudopod::analysis::msd::{from_the_start, of_cells};
use pseudopod::analysis::statistics::kolmogorov_smirnov;
use pseudopod::cell::motility::{BrownianMotility, Space, furth};

const WALKERS: usize = 2_000;
const SEED: u64 = 3;
/// 5 µm/min and 2 min, as amoebae do.
const SPEED: f64 = 5.0 / 60.0;
const PERSISTENCE: f64 = 120.0;
/// Four frames fill a persistence, 81 frames twenty of them.
const INTERVAL: f64 = PERSISTENCE / 4.0;
const FRAMES: usize = 81;
const LAGS: [usize; 12] = [1, 2, 3, 4, 6, 8, 12, 16, 20, 26, 32, 40];

/// Positions [frame, walker, axis], µm, and for each run that ended its duration and when it began, s.
fn walks(space: Space) -> (Array3<f64>, Vec<(f64, f64)>) {
    let motility = BrownianMotility { speed: SPEED, persistence: PERSISTENCE, space };
    let mut positions = Array3::zeros((FRAMES, WALKERS, 3));
    let mut runs = Vec::new();
    for walker in 0..WALKERS {
        let mut walk = motility.start(SEED, walker as u64);
        let mut position = Vec3::zeros();
        for frame in 1..FRAMES {
            let began = (frame - 1) as f64 * INTERVAL;
            let velocity = motility.advance(SEED, walker as u64, &mut walk, INTERVAL, |duration, offset| {
                runs.push((duration, began + offset - duration));
            });
            position += INTERVAL * velocity;
            for axis in 0..3 {
                positions[[frame, walker, axis]] = position[axis];
            }
        }
    }
    (positions, runs)
}

#[test]
fn displacements_follow_furth_from_any_origin() {
    for space in [Space::Plane, Space::Volume] {
        let (positions, _) = walks(space);
        let times: Vec<f64> = (0..FRAMES).map(|frame| frame as f64 * INTERVAL).collect();
        let fixed = from_the_start(positions.view(), &times, &LAGS);
        let averaged = of_cells(positions.view(), &times, &LAGS).displacements();
        for one in fixed.iter().chain(&averaged) {
            // Three standard errors of independent walkers.
            let deviation = (one.msd - furth(one.lag, SPEED, PERSISTENCE)) / one.error;
            assert!(deviation.abs() < 3.0, "{space:?}, {} s: {deviation} standard errors", one.lag);
        }
        let fitted = fit_furth(&averaged, Localisation::Exact).unwrap();
        // The averaged displacements have errors of 1 to 3 %, of which the fit keeps less.
        assert!((fitted.speed / SPEED - 1.0).abs() < 0.03, "{fitted:?}");
        assert!((fitted.persistence / PERSISTENCE - 1.0).abs() < 0.05, "{fitted:?}");
    }
}

#[test]
fn durations_of_runs_are_exponential() {
    for space in [Space::Plane, Space::Volume] {
        let (_, runs) = walks(space);
        // A run that begins ten persistences before the end is still going there once in 22 000; taking only these
        // keeps the long ones in.
        let last = (FRAMES - 1) as f64 * INTERVAL - 10.0 * PERSISTENCE;
        let durations: Vec<f64> = runs.iter().filter(|(_, began)| *began < last).map(|run| run.0).collect();
        let test = kolmogorov_smirnov(&durations, |duration| -(-duration / PERSISTENCE).exp_m1()).unwrap();
        assert!(test.p_value > 0.01, "{space:?}: {test:?} of {} runs", durations.len());
        let wrong = kolmogorov_smirnov(&durations, |duration| -(-duration / (1.05 * PERSISTENCE)).exp_m1()).unwrap();
        assert!(wrong.p_value < 1e-4, "{space:?}: five per cent off must show, {wrong:?}");
    }
}
