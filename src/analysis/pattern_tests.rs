//! What the wavelength of a pattern promises, on patterns of known wavelength.

use super::*;
use crate::analysis::noise;

fn grid(cells: [usize; 2], spacing: [f64; 2]) -> FieldLayout {
    let species = vec![("a".to_owned(), "1".to_owned())];
    let (cells, spacing) = ([cells[0], cells[1], 1], [spacing[0], spacing[1], 1.0]);
    FieldLayout { name: "a".into(), species, cells, spacing, origin: [-7.0, 3.0, 0.0] }
}

/// The sum of waves of the same length in some directions, shifted by a phase; 1 beside it.
fn pattern(layout: &FieldLayout, wavelength: f64, angles: &[f64], phase: f64) -> Vec<f64> {
    let nx = layout.cells[0];
    let wave = |x: f64, y: f64, angle: f64| (TAU / wavelength * (x * angle.cos() + y * angle.sin()) + phase).cos();
    let position = |at: usize| [(at % nx) as f64 * layout.spacing[0], (at / nx) as f64 * layout.spacing[1]];
    let value =
        |at: usize| 1.0 + angles.iter().map(|angle| wave(position(at)[0], position(at)[1], *angle)).sum::<f64>();
    (0..layout.len()).map(value).collect()
}

/// The largest error over angles and phases, as a share.
fn worst(layout: &FieldLayout, length: f64, fold: &[f64]) -> f64 {
    let mut worst: f64 = 0.0;
    for turn in 0..12 {
        for phase in [0.0, 1.0, 2.5, 4.0] {
            let angles: Vec<f64> = fold.iter().map(|angle| angle + f64::from(turn) * PI / 12.0).collect();
            let found = wavelength(layout, &pattern(layout, length, &angles, phase)).unwrap();
            worst = worst.max((found / length - 1.0).abs());
        }
    }
    worst
}

const STRIPES: [f64; 1] = [0.0];
const HEXAGONS: [f64; 3] = [0.0, PI / 3.0, 2.0 * PI / 3.0];

/// Grids with sides and boxes that are not square, some with odd numbers.
const GRIDS: [([usize; 2], [f64; 2]); 3] =
    [([128, 128], [1.0, 1.0]), ([151, 70], [1.0, 1.0]), ([64, 161], [2.0, 0.75])];

#[test]
fn stripes_at_any_angle_have_their_wavelength() {
    for (cells, spacing) in GRIDS {
        // At 25 µm the shorter side of the second grid holds 2.8 stripes, which costs almost a thousandth.
        for (length, tolerance) in [(8.0, 1e-4), (13.7, 3e-4), (25.0, 1e-3)] {
            let worst = worst(&grid(cells, spacing), length, &STRIPES);
            assert!(worst < tolerance, "{cells:?}, {length} µm: {worst:e}");
        }
    }
    // The least that is accepted: a little more than twice along each side.
    let worst = worst(&grid([128, 128], [1.0, 1.0]), 60.0, &STRIPES);
    assert!(worst < 0.01, "{worst:e}");
}

#[test]
fn hexagons_at_any_angle_have_the_wavelength_of_their_waves() {
    for (cells, spacing) in GRIDS {
        for (length, tolerance) in [(8.0, 1e-4), (13.7, 3e-4), (25.0, 1e-3)] {
            let worst = worst(&grid(cells, spacing), length, &HEXAGONS);
            assert!(worst < tolerance, "{cells:?}, {length} µm: {worst:e}");
        }
    }
}

#[test]
fn narrow_stripes_have_the_wavelength_of_their_first_wave() {
    // Ridges a quarter of the wavelength wide, so that the second wave has half the power of the first.
    let layout = grid([120, 90], [1.0, 1.0]);
    let ridge = |at: usize| if (at % 120) % 12 < 3 { 1.0 } else { 0.0 };
    let values: Vec<f64> = (0..layout.len()).map(ridge).collect();
    let found = wavelength(&layout, &values).unwrap();
    assert!((found / 12.0 - 1.0).abs() < 1e-4, "{found}");
}

#[test]
fn noise_beside_a_pattern_moves_its_wavelength_little() {
    let layout = grid([128, 128], [1.0, 1.0]);
    let mut uniform = noise::uniform(7);
    let noisy: Vec<f64> = pattern(&layout, 13.7, &[0.4], 0.0).iter().map(|value| value + uniform() - 0.5).collect();
    let found = wavelength(&layout, &noisy).unwrap();
    // Noise of a sixth of the stripes' power, of which the waves about the peak hold a fiftieth.
    assert!((found / 13.7 - 1.0).abs() < 2e-3, "{found}");
}

#[test]
fn a_field_of_one_row_has_a_wavelength_too() {
    for cells in [[200, 1], [1, 200], [200, 2]] {
        let layout = grid(cells, [0.5, 0.5]);
        let turned = if cells[0] == 1 { PI / 2.0 } else { 0.0 };
        let found = wavelength(&layout, &pattern(&layout, 9.3, &[turned], 0.3)).unwrap();
        assert!((found / 9.3 - 1.0).abs() < 1e-3, "{cells:?}: {found}");
    }
}

#[test]
fn what_is_no_pattern_is_refused() {
    let layout = grid([40, 30], [1.0, 1.0]);
    let message = |layout: &FieldLayout, values: &[f64]| wavelength(layout, values).unwrap_err().to_string();
    assert_eq!(message(&layout, &[2.0; 1200]), "the field a has no pattern: its values are 2 to 2");
    let slope: Vec<f64> = (0..1200).map(|at| (at % 40) as f64).collect();
    let wide = "the field a of 40 × 30 µm holds no pattern twice along each side";
    assert_eq!(message(&layout, &slope), wide);
    assert_eq!(message(&layout, &pattern(&layout, 17.0, &[0.0], 0.0)), wide);
    assert!(message(&layout, &[f64::NAN; 1200]).contains("no pattern"));
    let deep = FieldLayout { cells: [4, 5, 6], ..layout };
    assert_eq!(message(&deep, &[0.0; 120]), "the field a is not flat: it has 6 boxes along z");
}
