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
    let place = |at: usize| [(at % nx) as f64 * layout.spacing[0], (at / nx) as f64 * layout.spacing[1]];
    let value = |at: usize| 1.0 + angles.iter().map(|angle| wave(place(at)[0], place(at)[1], *angle)).sum::<f64>();
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

#[test]
fn stripes_at_any_angle_have_their_wavelength() {
    for (cells, spacing) in [([128, 128], [1.0, 1.0]), ([150, 70], [1.0, 1.0]), ([64, 160], [2.0, 0.75])] {
        let layout = grid(cells, spacing);
        for length in [10.0, 13.7, 25.0] {
            println!("{cells:?} {length}: {:e}", worst(&layout, length, &STRIPES));
        }
    }
}

#[test]
fn hexagons_at_any_angle_have_the_wavelength_of_their_waves() {
    for (cells, spacing) in [([128, 128], [1.0, 1.0]), ([150, 70], [1.0, 1.0]), ([64, 160], [2.0, 0.75])] {
        let layout = grid(cells, spacing);
        for length in [10.0, 13.7, 25.0] {
            println!("{cells:?} {length}: {:e}", worst(&layout, length, &HEXAGONS));
        }
    }
}
