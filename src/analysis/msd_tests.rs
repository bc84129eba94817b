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
        of_cells(positions.view(), &[0.0, 2.0, 4.0, 6.0, 8.0], &[0, 1, 3]).displacements(),
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
    let overlapping = of_cells(jump.view(), &[0.0, 1.0, 2.0, 3.0], &[1]).displacements();
    assert!((overlapping[0].msd - 4.0 / 3.0).abs() < 1e-15);
    assert_eq!(from_the_start(jump.view(), &[0.0, 1.0, 2.0, 3.0], &[1])[0].msd, 0.0);
    assert!(overlapping[0].error.is_nan());
}

#[test]
fn windows_of_unequal_frames_have_the_lag_that_they_have() {
    // One cell at 2 µm/s; the third frame is late by 0.2 s of 1 s, and one is missing.
    let times = [0.0, 1.0, 2.2, 3.0, 5.0];
    let positions = Array3::from_shape_fn((5, 1, 1), |(frame, _, _)| 2.0 * times[frame]);
    let found = of_cells(positions.view(), &times, &[1, 2]);
    // 0 to 1, 1 to 2.2 and 2.2 to 3; 0 to 2.2, 1 to 3, 3 to 5.
    assert!((found.lags[0] - 1.0).abs() < 1e-12 && (found.lags[1] - 6.2 / 3.0).abs() < 1e-12, "{found:?}");
    assert!((found.squares[[0, 0]] - 4.0 * (1.0 + 1.44 + 0.64) / 3.0).abs() < 1e-12);
}

#[test]
fn a_cell_that_is_away_for_a_while_has_the_windows_that_it_has() {
    let mut positions = straight();
    positions.slice_mut(ndarray::s![2..4, 0, ..]).fill(f64::NAN);
    let found = of_cells(positions.view(), &[0.0, 2.0, 4.0, 6.0, 8.0], &[1, 2, 4]);
    assert_eq!(found.squares.column(0).to_vec()[..1], [1.0]);
    assert!(found.squares[[1, 0]].is_nan() && found.squares[[2, 0]] == 16.0);
    assert_eq!(found.mean_of(&[0, 1])[1], 36.0);
    let [low, high] = found.intervals(1)[2];
    assert!(low == 16.0 && high == 144.0, "two cells give draws of one or both");
}
