//! What displacements and their fit promise.

use super::*;
use ndarray::Array3;

/// Two cells that go straight, at 1 and 3 µm a frame.
fn straight() -> Array3<f64> {
    Array3::from_shape_fn(
        (5, 2, 3),
        |(frame, cell, axis)| if axis == 0 { (frame * (1 + 2 * cell)) as f64 } else { 7.0 },
    )
}

#[test]
fn straight_walks_spread_with_the_square_of_time() {
    let positions = straight();
    for displacements in [
        from_the_start(positions.view(), &[0.0, 2.0, 4.0, 6.0, 8.0], &[0, 1, 3]),
        over_origins(positions.view(), 2.0, &[0, 1, 3]),
    ] {
        for (displacement, frames) in displacements.iter().zip([0.0, 1.0, 3.0_f64]) {
            assert_eq!(displacement.lag, 2.0 * frames);
            // (1² + 3²)/2 and half the difference of the two squares.
            assert!((displacement.msd - 5.0 * frames * frames).abs() < 1e-12);
            assert!((displacement.error - 4.0 * frames * frames).abs() < 1e-12);
        }
    }
}

#[test]
fn origins_are_averaged() {
    // One cell that stands, jumps by 2 µm, and stands: squares 0, 4, 0 from three origins, 0 from the first.
    let jump = Array3::from_shape_vec((4, 1, 1), vec![0.0, 0.0, 2.0, 2.0]).unwrap();
    assert!((over_origins(jump.view(), 1.0, &[1])[0].msd - 4.0 / 3.0).abs() < 1e-15);
    assert_eq!(from_the_start(jump.view(), &[0.0, 1.0, 2.0, 3.0], &[1])[0].msd, 0.0);
    assert!(over_origins(jump.view(), 1.0, &[1])[0].error.is_nan());
}

#[test]
fn fuerths_law_is_straight_first_and_diffuses_later() {
    let (speed, persistence) = (0.1, 120.0);
    // v²t² with the relative correction −t/3p, and 2v²p(t − p).
    assert!((furth(1e-4, speed, persistence) / 1e-10 - 1.0).abs() < 1e-6);
    assert!((furth(1e5, speed, persistence) / (2.0 * 0.01 * 120.0 * (1e5 - 120.0)) - 1.0).abs() < 1e-12);
    // Both forms of the shape agree where one takes over: the series leaves out x⁵/120.
    let x: f64 = 1e-3;
    let series = x * x * (0.5 - x / 6.0 * (1.0 - x / 4.0));
    assert!((furth_shape(x) / series - 1.0).abs() < 1e-9);
}

#[test]
fn the_fit_finds_what_made_the_curve() {
    let lags = [30.0, 60.0, 120.0, 300.0, 1200.0];
    for (speed, persistence) in [(0.0833, 120.0), (3.0, 20.0), (0.01, 2_000.0)] {
        let curve: Vec<Displacement> = lags
            .iter()
            .map(|&lag| Displacement { lag, msd: furth(lag, speed, persistence), error: f64::NAN })
            .collect();
        let walk = fit_furth(&curve).unwrap();
        // The curve is exact, and the fit stops at relative changes of 1e-10.
        assert!((walk.speed / speed - 1.0).abs() < 1e-6, "{walk:?}");
        assert!((walk.persistence / persistence - 1.0).abs() < 1e-6, "{walk:?}");
    }
}

#[test]
fn a_fit_without_movement_is_refused() {
    let still = [1.0, 2.0].map(|lag| Displacement { lag, msd: 0.0, error: 0.0 });
    assert!(fit_furth(&still).is_err());
    assert!(fit_furth(&[]).is_err());
}
