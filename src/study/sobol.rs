//! Points of the Sobol sequence, scrambled as Owen does it, in up to 21 dimensions.
//!
//! Directions are those of Joe and Kuo (2008, `new-joe-kuo-6.21201`). Scrambling permutes the halves of every interval at random, each by
//! itself (Owen 1995): points stay as even as they were, and every seed has its own.

use crate::random::{Purpose, Stream};

/// Most dimensions that there are directions for.
pub const MOST_DIMENSIONS: usize = 21;

/// Bits of a coordinate.
const BITS: usize = 32;

/// Degree, inner coefficients and first directions of the primitive polynomial of each dimension after the first.
const POLYNOMIALS: [(u32, u32, &[u32]); MOST_DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// The direction numbers of a dimension, the first for the lowest bit of an index.
fn directions(dimension: usize) -> [u32; BITS] {
    let mut found = [0; BITS];
    let Some(&(degree, inner, first)) = dimension.checked_sub(1).and_then(|number| POLYNOMIALS.get(number)) else {
        return std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
    };
    let degree = degree as usize;
    for bit in 0..BITS {
        found[bit] = match first.get(bit) {
            Some(number) => number << (BITS - 1 - bit),
            None => {
                let mut next = found[bit - degree] ^ (found[bit - degree] >> degree);
                for k in 1..degree {
                    if inner >> (degree - 1 - k) & 1 == 1 {
                        next ^= found[bit - k];
                    }
                }
                next
            }
        };
    }
    found
}

/// A coordinate of a point of the sequence as it is, in units of 2⁻³². Points are in the order of their indices.
fn plain(index: u32, directions: &[u32; BITS]) -> u32 {
    let bits = (0..BITS).filter(|bit| index >> bit & 1 == 1);
    bits.fold(0, |sum, bit| sum ^ directions[bit])
}

/// The same with the halves of all intervals permuted: each bit is turned or not by a draw that belongs to the bits above it.
fn scrambled(plain: u32, seed: u64, dimension: u32) -> u32 {
    let mut turned = 0;
    for bit in 0..BITS as u32 {
        // A one in front tells beginnings of different lengths apart.
        let above = (1_u64 << bit) | u64::from(plain).checked_shr(BITS as u32 - bit).unwrap_or(0);
        let draw = Stream::new(seed, Purpose::Design, dimension, above).uniform_pair()[0];
        turned |= u32::from(draw < 0.5) << (BITS as u32 - 1 - bit);
    }
    plain ^ turned
}

/// The first `number` points of the scrambled sequence, each with `dimensions` coordinates inside (0, 1).
///
/// # Panics
/// For more than [`MOST_DIMENSIONS`] dimensions.
pub fn points(number: u32, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    assert!(dimensions <= MOST_DIMENSIONS, "there are directions for {MOST_DIMENSIONS} dimensions");
    let all: Vec<[u32; BITS]> = (0..dimensions).map(directions).collect();
    let at = |index: u32, dimension: usize| {
        let found = scrambled(plain(index, &all[dimension]), seed, dimension as u32);
        (f64::from(found) + 0.5) / 2f64.powi(BITS as i32)
    };
    (0..number).map(|index| (0..dimensions).map(|dimension| at(index, dimension)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point of the sequence as it is, in Gray code as others count, in units of 2⁻¹⁰.
    fn known_order(index: u32) -> Vec<u32> {
        (0..MOST_DIMENSIONS).map(|dimension| plain(index ^ (index >> 1), &directions(dimension)) >> 22).collect()
    }

    #[test]
    fn points_are_those_that_others_find() {
        // stats.qmc.Sobol(21, scramble=False).random(1024) of scipy 1.17.1, rows 1000 and 777, times 1024: between them all bits of all
        // directions up to the tenth.
        let known =
            [225, 99, 531, 693, 287, 929, 47, 921, 513, 71, 87, 261, 165, 393, 147, 379, 737, 353, 1015, 743, 535];
        assert_eq!(known_order(1000), known);
        let known =
            [709, 959, 167, 281, 651, 365, 195, 781, 357, 331, 763, 713, 393, 485, 583, 527, 413, 885, 379, 771, 243];
        assert_eq!(known_order(777), known);
        let first: Vec<[u32; 3]> = (0..5).map(|k| [0, 1, 2].map(|dimension| known_order(k)[dimension])).collect();
        assert_eq!(first, [[0; 3], [512; 3], [768, 256, 256], [256, 768, 768], [384, 384, 640]]);
    }

    #[test]
    fn scrambled_points_have_one_in_each_part_of_every_axis() {
        for seed in [0, 1, 77] {
            let all = points(64, MOST_DIMENSIONS, seed);
            for dimension in 0..MOST_DIMENSIONS {
                let mut parts: Vec<usize> = all.iter().map(|point| (64.0 * point[dimension]) as usize).collect();
                parts.sort_unstable();
                assert_eq!(parts, (0..64).collect::<Vec<_>>(), "dimension {dimension}, seed {seed}");
            }
        }
    }

    #[test]
    fn scrambled_points_stay_even_in_two_dimensions() {
        // The first two dimensions are a net of quality 0: each of 64 boxes of any shape with area 1/64 holds one point.
        let all = points(64, 2, 5);
        for columns in [1, 2, 4, 8, 16, 32, 64] {
            let rows = 64 / columns;
            let mut boxes: Vec<usize> = all
                .iter()
                .map(|point| (columns as f64 * point[0]) as usize * rows + (rows as f64 * point[1]) as usize)
                .collect();
            boxes.sort_unstable();
            assert_eq!(boxes, (0..64).collect::<Vec<_>>(), "{columns} columns");
        }
    }

    #[test]
    fn more_points_begin_with_the_same_and_seeds_differ() {
        assert_eq!(points(16, 3, 1)[..8], points(8, 3, 1));
        assert_ne!(points(8, 3, 1), points(8, 3, 2));
    }
}
