//! The pressure that keeps the volumes of cells in the implicit step.

use super::kind::{Kind, VolumeRule};
use crate::mechanics::lanes::LANES;
use crate::mechanics::volume;

/// The pressure multiplier of eq. (step.5): how much of `swell` is added to meet the wanted change of volume, or, in a
/// compressible cell, how much the pressure's own stiffness takes back.
pub fn pressure(kind: &Kind, gamma: f64, along: f64, swelling: f64, wanted: f64, target: f64) -> f64 {
    match &kind.volume {
        VolumeRule::Free => 0.0,
        VolumeRule::Exact(_) => (wanted - along) / swelling,
        VolumeRule::Compressible { modulus, .. } => -along / (swelling + target / (modulus * gamma)),
    }
}

/// Adds the first stage's pressure to the forces of the second, along the gradient where the atoms now are: the
/// gradient turns with the cell, and without this the scheme would be of first order in an incompressible cell.
pub fn carry_pressure(kind: &Kind, x: &[f64], pressure: &[f64], f: &mut [f64], gradient: &mut [f64]) {
    if !matches!(kind.volume, VolumeRule::Exact(_)) {
        return;
    }
    let lanes = kind.lanes;
    let mut volumes = [0.0; LANES];
    volume::measure_block(&kind.rest.facets, x, &kind.held, gradient, &mut volumes[..lanes]);
    for (f, g) in f.chunks_exact_mut(lanes).zip(gradient.chunks_exact(lanes)) {
        for lane in 0..lanes {
            f[lane] += pressure[lane] * g[lane];
        }
    }
}

/// Adds a share of what pressure does to held atoms, pN, which it does not move, to what is added up of the forces on them.
pub fn add_pressure_on_held(
    kind: &Kind,
    x: &[f64],
    (pressure, share): (&[f64], f64),
    on_held: &mut [f64],
    gradient: &mut [f64],
) {
    if kind.volume == VolumeRule::Free {
        return;
    }
    let lanes = kind.lanes;
    let mut volumes = [0.0; LANES];
    volume::measure_block(&kind.rest.facets, x, &[], gradient, &mut volumes[..lanes]);
    for (sum, g) in on_held.chunks_exact_mut(lanes).zip(gradient.chunks_exact(lanes)) {
        for lane in 0..lanes {
            sum[lane] += share * pressure[lane] * g[lane];
        }
    }
}

/// Adds the pressure's part to the increments of a block, eq. (step.5), so that volumes change as wanted; `factor` are the multipliers.
pub fn constrain(
    kind: &Kind,
    gamma: f64,
    gradient: &[f64],
    swell: &[f64],
    wanted: &[f64],
    target: &[f64],
    y: &mut [f64],
    factor: &mut [f64],
) {
    if kind.volume == VolumeRule::Free {
        return;
    }
    let lanes = kind.lanes;
    let (mut along, mut swelling) = ([0.0; LANES], [0.0; LANES]);
    for ((g, s), y) in gradient.chunks_exact(lanes).zip(swell.chunks_exact(lanes)).zip(y.chunks_exact(lanes)) {
        for lane in 0..lanes {
            along[lane] += g[lane] * y[lane];
            swelling[lane] += g[lane] * s[lane];
        }
    }
    for lane in 0..lanes {
        factor[lane] = pressure(kind, gamma, along[lane], swelling[lane], wanted[lane], target[lane]);
    }
    for (y, s) in y.chunks_exact_mut(lanes).zip(swell.chunks_exact(lanes)) {
        for lane in 0..lanes {
            y[lane] += factor[lane] * s[lane];
        }
    }
}
