//! Small dense linear systems, one for each cell, factored side by side.

use pulp::Simd;

use super::wide::take_away;
use crate::equations::program::Lanes;

/// A row is taken as pivot instead of the present one when its entry is this many times larger: the diagonal, which always holds
/// one over the step, is kept where that is no danger, as in KLU (Davis and Palamadai Natarajan, ACM TOMS 37, 2010).
pub const EXCHANGE: f64 = 1000.0;

/// Two rows that some lanes exchange.
#[derive(Debug, Clone, Copy)]
pub struct Swap<const L: usize> {
    upper: u32,
    lower: u32,
    lanes: [bool; L],
}

#[inline(always)]
fn exchange<const L: usize>(values: &mut [Lanes<L>], first: usize, second: usize, lanes: &[bool; L]) {
    let (a, b) = (values[first], values[second]);
    for l in 0..L {
        values[first][l] = if lanes[l] { b[l] } else { a[l] };
        values[second][l] = if lanes[l] { a[l] } else { b[l] };
    }
}

/// Factors matrices in place, `matrix[row·n + column]`. Each lane chooses its own pivots, so that its result does not
/// depend on its neighbours. A singular matrix gives numbers that are not finite.
#[inline(always)]
pub fn factor<S: Simd, const L: usize>(simd: S, matrix: &mut [Lanes<L>], n: usize, swaps: &mut Vec<Swap<L>>) {
    swaps.clear();
    for k in 0..n {
        for i in k + 1..n {
            let (pivot, entry) = (matrix[k * n + k], matrix[i * n + k]);
            let mut lanes = [false; L];
            let mut any = false;
            for l in 0..L {
                lanes[l] = entry[l].abs() > EXCHANGE * pivot[l].abs();
                any |= lanes[l];
            }
            if any {
                for j in 0..n {
                    exchange(matrix, k * n + j, i * n + j, &lanes);
                }
                swaps.push(Swap { upper: k as u32, lower: i as u32, lanes });
            }
        }
        let mut inverse = matrix[k * n + k];
        for l in 0..L {
            inverse[l] = 1.0 / inverse[l];
        }
        matrix[k * n + k] = inverse;
        for i in k + 1..n {
            let mut factor = matrix[i * n + k];
            let mut any = false;
            for l in 0..L {
                any |= factor[l] != 0.0;
                factor[l] *= inverse[l];
            }
            if !any {
                continue;
            }
            matrix[i * n + k] = factor;
            let (above, below) = matrix.split_at_mut(i * n);
            let (above, below) = (&above[k * n + k + 1..k * n + n], &mut below[k + 1..n]);
            for (a, b) in below.iter_mut().zip(above) {
                take_away(simd, a, &factor, b);
            }
        }
    }
}

/// Solves with factored matrices, in place.
#[inline(always)]
pub fn solve<const L: usize>(matrix: &[Lanes<L>], n: usize, swaps: &[Swap<L>], right: &mut [Lanes<L>]) {
    for swap in swaps {
        exchange(right, swap.upper as usize, swap.lower as usize, &swap.lanes);
    }
    for i in 1..n {
        let mut sum = right[i];
        for (factor, known) in matrix[i * n..i * n + i].iter().zip(&right[..i]) {
            for l in 0..L {
                sum[l] -= factor[l] * known[l];
            }
        }
        right[i] = sum;
    }
    for i in (0..n).rev() {
        let mut sum = right[i];
        for (factor, known) in matrix[i * n + i + 1..i * n + n].iter().zip(&right[i + 1..n]) {
            for l in 0..L {
                sum[l] -= factor[l] * known[l];
            }
        }
        let inverse = matrix[i * n + i];
        for l in 0..L {
            sum[l] *= inverse[l];
        }
        right[i] = sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries between −1 and 1 that look random.
    fn entry(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn factored_systems_give_back_what_they_were_multiplied_with() {
        let mut seed = 7;
        for n in [1, 2, 5, 30] {
            let mut matrix = vec![[0.0; 4]; n * n];
            matrix.iter_mut().flatten().for_each(|value| *value = entry(&mut seed));
            // A zero in the corner of one lane and an empty diagonal in another ask for pivots.
            if n > 1 {
                matrix[0][1] = 0.0;
                (0..n).for_each(|i| matrix[i * n + i][2] = 0.0);
            }
            let wanted: Vec<[f64; 4]> = (0..n).map(|_| [0; 4].map(|_| entry(&mut seed))).collect();
            let mut right = vec![[0.0; 4]; n];
            for (i, j, l) in (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..4).map(move |l| (i, j, l)))) {
                right[i][l] += matrix[i * n + j][l] * wanted[j][l];
            }
            let mut swaps = Vec::new();
            factor(pulp::Scalar, &mut matrix, n, &mut swaps);
            solve(&matrix, n, &swaps, &mut right);
            let worst = right.iter().flatten().zip(wanted.iter().flatten()).map(|(a, b)| (a - b).abs());
            // Random matrices of this size have condition numbers up to about 1e4.
            assert!(worst.fold(0.0, f64::max) < 1e-10);
        }
    }

    #[test]
    fn a_lane_is_solved_the_same_whatever_its_neighbours() {
        let (mut seed, n) = (3, 6);
        let mut together = vec![[0.0; 3]; n * n];
        together.iter_mut().flatten().for_each(|value| *value = entry(&mut seed));
        let mut alone: Vec<[f64; 1]> = together.iter().map(|lanes| [lanes[1]]).collect();
        let (mut right, mut right_alone) = (vec![[1.0; 3]; n], vec![[1.0; 1]; n]);
        let (mut swaps, mut swaps_alone) = (Vec::new(), Vec::new());
        factor(pulp::Scalar, &mut together, n, &mut swaps);
        solve(&together, n, &swaps, &mut right);
        factor(pulp::Scalar, &mut alone, n, &mut swaps_alone);
        solve(&alone, n, &swaps_alone, &mut right_alone);
        (0..n).for_each(|i| assert_eq!(right[i][1].to_bits(), right_alone[i][0].to_bits()));
    }
}
