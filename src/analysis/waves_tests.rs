//! What rises, periods and arrivals promise.

use super::*;
use std::f64::consts::TAU;

#[test]
fn rises_lie_on_the_straight_line_between_frames() {
    let (times, values) = ([0.0, 1.0, 3.0, 4.0, 5.0, 6.0], [0.0, 4.0, 0.0, 1.0, 1.0, 2.0]);
    assert_eq!(rises(&times, &values, 1.0).collect::<Vec<_>>(), [0.25, 4.0]);
    assert_eq!(rises(&times, &values, 1.5).collect::<Vec<_>>(), [0.375, 5.5]);
    assert_eq!(rises(&times, &values, -1.0).count(), 0, "what begins above the level does not rise through it");
    assert_eq!(rises(&times, &[f64::NAN; 6], 1.0).count(), 0);
}

#[test]
fn a_sine_has_its_period_whatever_its_level_and_the_steps() {
    let mut times: Vec<f64> = (0..400).map(|frame| 0.25 * f64::from(frame)).collect();
    times.iter_mut().skip(1).step_by(3).for_each(|time| *time += 0.07);
    let values: Vec<f64> = times.iter().map(|time| 40.0 + 3.0 * (TAU * time / 7.3 + 1.0).sin()).collect();
    // Straight lines miss the sine by (ωΔt)²/8 of its height, which hits first and last rise alike within that.
    assert!((period(&times, &values).unwrap() / 7.3 - 1.0).abs() < 5e-4);
}

#[test]
fn two_rises_make_no_period() {
    let times: Vec<f64> = (0..100).map(f64::from).collect();
    let values: Vec<f64> = times.iter().map(|time| (TAU * time / 40.0).cos()).collect();
    assert_eq!(period(&times, &values), Err(2));
    assert_eq!(period(&times, &[1.0; 100]), Err(0));
    assert_eq!(period(&[], &[]), Err(0));
}

#[test]
fn a_line_through_arrivals_needs_three_of_them_and_time_between() {
    let arrivals = |distances: &[f64], times: &[f64]| {
        Arrivals { distances: distances.to_vec(), times: times.to_vec(), points: 9 }.line()
    };
    let line = arrivals(&[1.0, 2.0, 4.0], &[5.0, 5.5, 6.5]).unwrap();
    assert!((line.slope - 0.5).abs() < 1e-14 && (line.r_squared - 1.0).abs() < 1e-14);
    let message = |distances: &[f64], times: &[f64]| arrivals(distances, times).unwrap_err().to_string();
    assert_eq!(message(&[1.0, 2.0], &[5.0, 5.5]), "a wave came to 2 of 9 points; three are needed");
    assert_eq!(message(&[1.0, 2.0, 3.0], &[5.0; 3]), "the wave comes to all points at once");
    let all = Arrivals { distances: vec![0.1 + 0.2, 1.0, 2.0], times: vec![1.0, 2.0, 3.0], points: 4 };
    let kept = all.between(Some(0.3), Some(1.0));
    assert_eq!((kept.times.as_slice(), kept.points), ([1.0, 2.0].as_slice(), 4));
}

#[test]
fn frames_from_a_time_on_forgive_round_off() {
    let times = [0.0, 0.1, 0.1 + 0.2 - 1e-16, 0.4];
    assert_eq!([None, Some(0.3), Some(0.31), Some(1.0)].map(|from| first_frame(&times, from)), [0, 2, 3, 4]);
}
