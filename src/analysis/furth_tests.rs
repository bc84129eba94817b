//! What the fit of Fürth's law promises.

use super::*;
use crate::analysis::msd;
use crate::analysis::noise;
use crate::analysis::statistics::mean;
use ndarray::Array3;
use rayon::prelude::*;

#[test]
fn fuerths_law_is_straight_first_and_diffuses_later() {
    let (speed, persistence) = (0.1, 120.0);
    // v²t² with the relative correction −t/3p, and 2v²p(t − p).
    assert!((furth(1e-4, speed, persistence) / 1e-10 - 1.0).abs() < 1e-6);
    assert!((furth(1e5, speed, persistence) / (2.0 * 0.01 * 120.0 * (1e5 - 120.0)) - 1.0).abs() < 1e-12);
    // The series and the closed form meet at a thousandth of p without a jump: across 2e-9 of the lag the law itself
    // changes by 4e-9, the closed form has lost 1e-10 and the series leaves out 2e-14.
    let (below, above) = (1e-3 * (1.0 - 1e-9) * persistence, 1e-3 * (1.0 + 1e-9) * persistence);
    assert!((furth(above, speed, persistence) / furth(below, speed, persistence) - 1.0 - 4e-9).abs() < 1e-9);
}

#[test]
fn the_fit_finds_what_made_the_curve() {
    let lags = [30.0, 60.0, 120.0, 300.0, 1200.0];
    for (speed, persistence, noise) in [(0.0833, 120.0, 0.5), (3.0, 20.0, 1.0), (0.01, 2_000.0, 0.0)] {
        for localisation in [Localisation::Exact, Localisation::Noisy] {
            let offset: f64 = if localisation == Localisation::Exact { 0.0 } else { 4.0 * noise * noise };
            let point = |&lag: &f64| {
                let msd = furth(lag, speed, persistence) + offset;
                Displacement { lag, msd, error: f64::NAN }
            };
            let walk = fit_furth(&lags.iter().map(point).collect::<Vec<_>>(), localisation).unwrap();
            // The curve is exact; the persistence is found to 1e-9 of its logarithm, and as far as a minimum can be told from its neighbourhood, 1e-8.
            assert!((walk.speed / speed - 1.0).abs() < 1e-6, "{walk:?}");
            assert!((walk.persistence / persistence - 1.0).abs() < 1e-6, "{walk:?}");
            // Where lags begin beyond the persistence, the offset is told from it by the shortest lag alone: ten times as far.
            assert!((walk.offset - offset).abs() < 1e-5 * offset.max(1e-2), "{walk:?}");
        }
    }
}

#[test]
fn a_fit_without_movement_is_refused() {
    let still = [1.0, 2.0].map(|lag| Displacement { lag, msd: 0.0, error: 0.0 });
    assert!(fit_furth(&still, Localisation::Exact).is_err());
    assert!(fit_furth(&[], Localisation::Exact).is_err());
}

#[test]
fn a_persistence_far_beyond_the_lags_is_refused() {
    let curve = |power: f64| [1.0_f64, 2.0, 4.0, 8.0].map(|lag| Displacement { lag, msd: lag.powf(power), error: 1.0 });
    let message = |power| fit_furth(&curve(power), Localisation::Exact).unwrap_err().to_string();
    assert!(message(2.0).contains("hardly turn"), "{}", message(2.0));
    assert!(message(1.0).contains("turn faster"), "{}", message(1.0));
}

/// Cells whose velocities are Ornstein–Uhlenbeck processes, exact at the frames, and whose positions are measured with an error.
///
/// * `speed` – root mean square, in the plane or in space.
fn tracks(
    cells: usize,
    frames: usize,
    axes: usize,
    interval: f64,
    [speed, persistence, error]: [f64; 3],
    seed: u64,
) -> Array3<f64> {
    let mut uniform = noise::uniform(seed);
    let mut normal = move || (-2.0 * (-uniform()).ln_1p()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
    let deviation = speed / (axes as f64).sqrt();
    let (x, decay) = (interval / persistence, (-interval / persistence).exp());
    // The exact joint law of velocity and position after an interval (Gillespie 1996).
    let velocity_variance = 1.0 - decay * decay;
    let position_variance = persistence * persistence * (2.0 * x - 3.0 + 4.0 * decay - decay * decay);
    let covariance = persistence * (1.0 - decay).powi(2);
    let mut positions = Array3::zeros((frames, cells, axes));
    for cell in 0..cells {
        for axis in 0..axes {
            let (mut now, mut velocity) = (0.0, deviation * normal());
            for frame in 0..frames {
                positions[[frame, cell, axis]] = now + error * normal();
                let (a, b) = (normal(), normal());
                let root = velocity_variance.sqrt();
                let other = (position_variance - covariance * covariance / velocity_variance).max(0.0).sqrt();
                now += persistence * (1.0 - decay) * velocity + deviation * (covariance / root * a + other * b);
                velocity = decay * velocity + deviation * root * a;
            }
        }
    }
    positions
}

/// Speed (µm/min), persistence (min) and the intervals of both between which celltrackR's two-photon tracks of three types of cells lie; here they make tracks. The error of localisation is
/// ours.
const CELLS: [(&str, [f64; 3]); 3] =
    [("B cells", [4.58, 1.80, 0.4]), ("T cells", [9.51, 0.44, 0.4]), ("neutrophils", [9.87, 1.23, 0.4])];

#[test]
fn intervals_of_noisy_tracks_hold_what_made_them_in_95_of_100_trials() {
    let (trials, cells, frames, interval) = (100, 60, 40, 0.4);
    let times: Vec<f64> = (0..frames).map(|frame| frame as f64 * interval).collect();
    let lags: Vec<usize> = (1..=frames / 4).collect();
    let mut all = [0_usize; 3];
    for (name, truth) in CELLS {
        let trial = |trial: u64| {
            let positions = tracks(cells, frames, 3, interval, truth, 1_000 + trial);
            let of = msd::of_cells(positions.view(), &times, &lags);
            let found = estimate(&of, 3, Localisation::Noisy, trial).unwrap();
            [found.speed, found.persistence, found.noise]
        };
        let found: Vec<[Estimate; 3]> = (0..trials).into_par_iter().map(trial).collect();
        let holds = |index: usize, one: &Estimate| one.low <= truth[index] && truth[index] <= one.high;
        let held: [usize; 3] =
            std::array::from_fn(|index| found.iter().filter(|one| holds(index, &one[index])).count());
        let means: [f64; 3] =
            std::array::from_fn(|index| mean(&found.iter().map(|one| one[index].value).collect::<Vec<_>>()));
        println!("{name}: {truth:?} held by {held:?} of {trials}, means {means:?}");
        // Without bias: a mean of 100 trials has an error of about 0.3 % of the speed and 1 % of the persistence.
        assert!(
            (means[0] / truth[0] - 1.0).abs() < 0.01 && (means[1] / truth[1] - 1.0).abs() < 0.03,
            "{name}: {means:?}"
        );
        all.iter_mut().zip(held).for_each(|(all, held)| *all += held);
    }
    // A share of 300 has a standard error of 0.013 to 0.015; percentiles of 60 cells are known to fall short of 0.95 by about 0.02. Three errors below that, and above.
    assert!(all.iter().all(|held| (266..=297).contains(held)), "{all:?} of 300");
}

#[test]
fn without_the_offset_noisy_tracks_seem_faster_and_less_persistent() {
    let (frames, interval, truth) = (40, 0.4, [4.58, 1.80, 0.8]);
    let times: Vec<f64> = (0..frames).map(|frame| frame as f64 * interval).collect();
    let positions = tracks(400, frames, 3, interval, truth, 5);
    let of = msd::of_cells(positions.view(), &times, &(1..=10).collect::<Vec<_>>());
    let [exact, noisy] =
        [Localisation::Exact, Localisation::Noisy].map(|kind| fit_furth(&of.displacements(), kind).unwrap());
    println!("{exact:?} {noisy:?}");
    assert!(exact.speed > 1.2 * truth[0] && exact.persistence < 0.7 * truth[1]);
    // 400 cells: a seventh of the errors of 60 cells times √(60/400); five of them.
    assert!((noisy.speed / truth[0] - 1.0).abs() < 0.07 && (noisy.persistence / truth[1] - 1.0).abs() < 0.2);
}
