//! Sums over stages, written for the processor's registers: as plain loops over lanes they are not always compiled so.

use pulp::Simd;

use crate::equations::program::Lanes;

/// Σ weight·stage for a register of one variable, without fused multiply-add: the same bits whatever the registers. The stages
/// stand one after the other, `n` variables each; those of weight 0 are left out.
#[inline(always)]
fn sum<S: Simd, const L: usize>(
    simd: S,
    weights: &[f64],
    stages: &[Lanes<L>],
    (n, variable): (usize, usize),
    slot: usize,
) -> S::f64s {
    let mut sum = None;
    for (stage, &weight) in weights.iter().enumerate() {
        if weight != 0.0 {
            let part = simd.mul_f64s(simd.splat_f64s(weight), S::as_simd_f64s(&stages[stage * n + variable]).0[slot]);
            // No closure: it would be compiled for the registers of all processors, and then not always put in its place.
            sum = Some(match sum {
                Some(sum) => simd.add_f64s(sum, part),
                None => part,
            });
        }
    }
    match sum {
        Some(sum) => sum,
        None => simd.splat_f64s(0.0),
    }
}

/// begin + factor·Σ weight·stage for one variable.
#[inline(always)]
pub fn combine<S: Simd, const W: usize, const L: usize>(
    simd: S,
    weights: &[f64; W],
    stages: &[Lanes<L>],
    which: (usize, usize),
    begin: Lanes<L>,
    factor: &Lanes<L>,
    to: &mut Lanes<L>,
) {
    let (begin, factor, to) = (S::as_simd_f64s(&begin).0, S::as_simd_f64s(factor).0, S::as_mut_simd_f64s(to).0);
    for slot in 0..to.len() {
        let change = simd.mul_f64s(factor[slot], sum(simd, weights, stages, which, slot));
        to[slot] = simd.add_f64s(begin[slot], change);
    }
}

/// begin + factor·Σ weight·stage for one variable, and then the latest stage by itself: what waits for it is short.
#[inline(always)]
pub fn combine_from<S: Simd, const W: usize, const L: usize>(
    simd: S,
    weights: &[f64; W],
    stages: &[Lanes<L>],
    (n, variable): (usize, usize),
    begin: &Lanes<L>,
    factor: &Lanes<L>,
    to: &mut Lanes<L>,
) {
    let (last, earlier) = (weights[W - 1], &weights[..W - 1]);
    let latest = S::as_simd_f64s(&stages[(W - 1) * n + variable]).0;
    let (begin, factor, to) = (S::as_simd_f64s(begin).0, S::as_simd_f64s(factor).0, S::as_mut_simd_f64s(to).0);
    for slot in 0..to.len() {
        let mut value = begin[slot];
        if W > 1 {
            let change = simd.mul_f64s(factor[slot], sum(simd, earlier, stages, (n, variable), slot));
            value = simd.add_f64s(value, change);
        }
        let weight = simd.mul_f64s(factor[slot], simd.splat_f64s(last));
        to[slot] = simd.add_f64s(value, simd.mul_f64s(weight, latest[slot]));
    }
}

/// The numbers negated, and 0 where they are not finite.
#[inline(always)]
pub fn negated_where_finite<S: Simd, const L: usize>(simd: S, from: &Lanes<L>, to: &mut Lanes<L>) {
    let (from, to) = (S::as_simd_f64s(from).0, S::as_mut_simd_f64s(to).0);
    let (zero, infinite) = (simd.splat_f64s(0.0), simd.splat_f64s(f64::INFINITY));
    for (to, &from) in to.iter_mut().zip(from) {
        let finite = simd.less_than_f64s(simd.abs_f64s(from), infinite);
        *to = simd.select_f64s(finite, simd.neg_f64s(from), zero);
    }
}

/// Takes factor·other away. A zero factor leaves the numbers, sign of zero and all, as if nothing had been done.
#[inline(always)]
pub fn take_away<S: Simd, const L: usize>(simd: S, from: &mut Lanes<L>, factor: &Lanes<L>, other: &Lanes<L>) {
    let (from, factor, other) = (S::as_mut_simd_f64s(from).0, S::as_simd_f64s(factor).0, S::as_simd_f64s(other).0);
    let zero = simd.splat_f64s(0.0);
    for ((from, &factor), &other) in from.iter_mut().zip(factor).zip(other) {
        let less = simd.sub_f64s(*from, simd.mul_f64s(factor, other));
        *from = simd.select_f64s(simd.equal_f64s(factor, zero), *from, less);
    }
}
