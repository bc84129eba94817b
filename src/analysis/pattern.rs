//! The wavelength of a pattern in a flat field, from the power of its waves.

use crate::error::{Error, Fault, Result};
use crate::output::FieldLayout;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// The waves that count are those whose number lies within this share of the strongest ring's. A row of stripes has its
/// next wave at 2, hexagons at √3 times the first.
const ABOUT_THE_PEAK: f64 = 0.35;

/// They are also those within so many waves of the shorter side, for the window spreads a wave over two on each side.
const WINDOW: f64 = 2.5;

/// The pattern must repeat at least this often along each side.
const REPEATS: f64 = 2.0;

/// Values that differ by less than this share of their size are the same: they are stored with seven digits.
const STORED: f64 = 1e-6;

/// One wave of the spectrum.
struct Wave {
    /// Wave numbers along x and y, 1/µm.
    k: [f64; 2],
    power: f64,
}

impl Wave {
    fn number(&self) -> f64 {
        self.k[0].hypot(self.k[1])
    }
}

/// The wavelength 2π/k of a flat field, µm, with k the power-weighted mean wave number about the peak of the spectrum, eq.
/// (analysis.14).
///
/// The field is faded out towards its walls by a window of Hann, so that a pattern need not fit into the field. The
/// window spreads a wave over its neighbours in the spectrum; what this adds to the length of wave vectors is taken off.
///
/// # Errors
/// When the field is not flat, is the same everywhere, or does not hold the pattern twice along each side.
///
/// # Panics
/// If there is not one value for each box.
pub fn wavelength(layout: &FieldLayout, values: &[f64]) -> Result<f64> {
    assert_eq!(values.len(), layout.len(), "one value for each box of {}", layout.name);
    let name = &layout.name;
    if !layout.is_flat() {
        let fault = Fault::new(format!("the field {name} is not flat: it has {} boxes along z", layout.cells[2]));
        return Err(Error::input(fault.help("measure the wavelength of a field on the substrate")));
    }
    let [least, most] = super::waves::extremes(values);
    let (swing, noise) = (most - least, STORED * least.abs().max(most.abs()));
    if !swing.is_finite() || swing <= noise {
        let fault = Fault::new(format!("the field {name} has no pattern: its values are {least} to {most}"));
        return Err(Error::input(fault.help("give a time at which the field is not the same everywhere")));
    }
    let size = [0, 1].map(|axis| layout.cells[axis] as f64 * layout.spacing[axis]);
    // A side of one or two boxes holds no waves, and the window does not change it.
    let sides: Vec<usize> = [0, 1].into_iter().filter(|&axis| layout.cells[axis] > 2).collect();
    let shortest = sides.iter().map(|&axis| size[axis]).fold(f64::INFINITY, f64::min);
    let blur = [0, 1].map(|axis| if sides.contains(&axis) { (TAU / size[axis]).powi(2) / 3.0 } else { 0.0 });
    let waves = spectrum(layout, values);
    let peak = peak(&waves, size);
    let reach = (ABOUT_THE_PEAK * peak).max(WINDOW * TAU / shortest);
    let (mut sum, mut power) = (0.0, 0.0);
    for wave in &waves {
        let number = wave.number();
        if (number - peak).abs() <= reach {
            // The window's spread across the wave vector: half of its square over k is what it adds to k.
            let across = (blur[0] * wave.k[1].powi(2) + blur[1] * wave.k[0].powi(2)) / number.powi(2);
            sum += wave.power * (number - across / (2.0 * number));
            power += wave.power;
        }
    }
    let found = TAU * power / sum;
    if !(found.is_finite() && found > 0.0 && found * REPEATS <= shortest) {
        let found = format!("the field {name} of {} × {} µm holds no pattern twice along each side", size[0], size[1]);
        return Err(Error::input(Fault::new(found).help("give a time at which there is a pattern, or a larger field")));
    }
    Ok(found)
}

/// The weight of a box in the window of Hann.
fn hann(index: usize, number: usize) -> f64 {
    (PI * (index as f64 + 0.5) / number as f64).sin().powi(2)
}

/// All waves of the field, its windowed mean taken off.
fn spectrum(layout: &FieldLayout, values: &[f64]) -> Vec<Wave> {
    let [nx, ny, _] = layout.cells;
    let (across, up): (Vec<f64>, Vec<f64>) =
        ((0..nx).map(|x| hann(x, nx)).collect(), (0..ny).map(|y| hann(y, ny)).collect());
    let weight = |at: usize| across[at % nx] * up[at / nx];
    let (mut sum, mut weights) = (0.0, 0.0);
    for (at, value) in values.iter().enumerate() {
        sum += weight(at) * value;
        weights += weight(at);
    }
    let mean = sum / weights;
    let windowed = values.iter().enumerate().map(|(at, value)| Complex::new(weight(at) * (value - mean), 0.0));
    let mut rows: Vec<Complex<f64>> = windowed.collect();
    let mut planner = FftPlanner::new();
    planner.plan_fft_forward(nx).process(&mut rows);
    let mut columns: Vec<Complex<f64>> = (0..nx * ny).map(|at| rows[at % ny * nx + at / ny]).collect();
    planner.plan_fft_forward(ny).process(&mut columns);
    let number = |index: usize, boxes: usize, spacing: f64| {
        let signed = if 2 * index > boxes { index as f64 - boxes as f64 } else { index as f64 };
        TAU * signed / (boxes as f64 * spacing)
    };
    let wave = |(at, value): (usize, &Complex<f64>)| Wave {
        k: [number(at / ny, nx, layout.spacing[0]), number(at % ny, ny, layout.spacing[1])],
        power: value.norm_sqr(),
    };
    // The first is the mean, which is not a wave.
    columns.iter().enumerate().skip(1).map(wave).collect()
}

/// The wave number at which the power of rings, each as wide as the wave number of the longer side, is greatest.
fn peak(waves: &[Wave], size: [f64; 2]) -> f64 {
    let width = TAU / size[0].max(size[1]);
    let mut rings: Vec<[f64; 2]> = Vec::new();
    for wave in waves {
        let ring = (wave.number() / width).round() as usize;
        if rings.len() <= ring {
            rings.resize(ring + 1, [0.0; 2]);
        }
        rings[ring][0] += wave.power;
        rings[ring][1] += wave.power * wave.number();
    }
    let strongest = rings.iter().max_by(|a, b| a[0].total_cmp(&b[0])).copied().unwrap_or([1.0, 0.0]);
    strongest[1] / strongest[0]
}

#[cfg(test)]
#[path = "pattern_tests.rs"]
mod tests;
