//! Standard normal numbers, many side by side, from plain arithmetic: the same bits on every processor and for every number of lanes.

use super::{Purpose, named_key, philox_lanes};
use crate::elementary::{ln, turn};

/// Normal numbers of mean 0 and variance 1 that belong to (seed, purpose, name, counter, cell, element) and to nothing else: each can be
/// had without any other, eq. (random.2) and (random.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Normals {
    key: [u32; 2],
}

impl Normals {
    /// The numbers of what has this name, written in parts.
    pub fn new(seed: u64, purpose: Purpose, name: &[&str]) -> Self {
        Self { key: named_key(seed, purpose, name) }
    }

    /// Of each lane, a cell and a pair, the numbers of the elements 2·pair and 2·pair + 1.
    #[inline(always)]
    pub fn pairs<const L: usize>(&self, counter: u64, cells: &[u32; L], pairs: &[u32; L]) -> [[f64; L]; 2] {
        let counter = [[counter as u32; L], [(counter >> 32) as u32; L], *cells, *pairs];
        let [a, b, c, d] = philox_lanes(counter, self.key);
        let mut numbers = [[0.0; L]; 2];
        for l in 0..L {
            // The logarithm wants numbers above 0: (0, 1] for it, [0, 1) for the angle.
            let (radius, angle) = (2.0 - one_to_two(a[l], b[l]), one_to_two(c[l], d[l]) - 1.0);
            let radius = (-2.0 * ln(radius)).sqrt();
            let [cos, sin] = turn(angle);
            (numbers[0][l], numbers[1][l]) = (radius * cos, radius * sin);
        }
        numbers
    }

    /// The number of one element of a cell.
    pub fn one(&self, counter: u64, cell: u32, element: u32) -> f64 {
        self.pairs(counter, &[cell], &[element / 2])[element as usize % 2][0]
    }
}

/// A number uniform in [1, 2) with 52 bits.
#[inline(always)]
fn one_to_two(high: u32, low: u32) -> f64 {
    f64::from_bits((u64::from(high) << 32 | u64::from(low)) >> 12 | 1.0_f64.to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normals(seed: u64, id: &str) -> Normals {
        Normals::new(seed, Purpose::Noise, &["system", id])
    }

    #[test]
    fn a_number_is_the_same_alone_and_side_by_side() {
        let of = normals(7, "u");
        let (cells, pairs) = ([3, 3, 9, 1, 0, 4, 4, 4], [0, 1, 2, 3, 4, 5, 6, 900]);
        let many = of.pairs(41, &cells, &pairs);
        for l in 0..8 {
            for half in 0..2 {
                let alone = of.one(41, cells[l], 2 * pairs[l] + half);
                assert_eq!(alone.to_bits(), many[half as usize][l].to_bits());
            }
        }
    }

    #[test]
    fn numbers_differ_by_seed_name_counter_cell_and_element_and_repeat_otherwise() {
        let base = normals(1, "u").one(5, 2, 3);
        assert_eq!(base, normals(1, "u").one(5, 2, 3));
        let others = [
            normals(2, "u").one(5, 2, 3),
            normals(1, "v").one(5, 2, 3),
            Normals::new(1, Purpose::Noise, &["systemu"]).one(5, 2, 3),
            Normals::new(1, Purpose::Motility, &["system", "u"]).one(5, 2, 3),
            normals(1, "u").one(6, 2, 3),
            normals(1, "u").one(5 + (1 << 32), 2, 3),
            normals(1, "u").one(5, 1, 3),
            normals(1, "u").one(5, 2, 2),
            normals(1, "u").one(5, 2, 5),
        ];
        assert!(others.iter().all(|other| *other != base));
    }

    #[test]
    fn moments_and_correlations_are_those_of_independent_normal_numbers() {
        let (of, n) = (normals(3, "u"), 200_000_u32);
        let numbers: Vec<f64> = (0..n).map(|k| of.one(u64::from(k / 1000), k % 1000 / 8, k % 8)).collect();
        let mean = |power: i32| numbers.iter().map(|x| x.powi(power)).sum::<f64>() / f64::from(n);
        // Standard errors of the moments are the roots of (2p)-th moments less squares, over n: 1, 2, 15, 96. Four of them.
        for (power, expected, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)] {
            let off = (mean(power) - expected) / f64::sqrt(variance / f64::from(n));
            assert!(off.abs() < 4.0, "moment {power} is off by {off} standard errors");
        }
        // Neighbours: of a pair, of an atom, of a cell, of a counter.
        for apart in [1, 2, 8, 1000] {
            let products = numbers.windows(apart + 1).map(|window| window[0] * window[apart]);
            let off = products.sum::<f64>() / f64::from(n).sqrt();
            assert!(off.abs() < 4.0, "numbers {apart} apart are correlated by {off} standard errors");
        }
        // A part of 0.0455 lies beyond two.
        let far = numbers.iter().filter(|x| x.abs() > 2.0).count() as f64 / f64::from(n);
        assert!((far - 0.045_500_3).abs() < 4.0 * (0.0455 * 0.9545 / f64::from(n)).sqrt(), "{far}");
    }
}
