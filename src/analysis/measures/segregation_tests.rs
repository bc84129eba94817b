//! What the permutation test promises, on lattices whose indices are known.

use super::*;
use crate::analysis::noise;

/// Pairs of a square lattice of n × n cells with neighbours along x and y.
fn lattice(n: u32) -> Vec<[u32; 2]> {
    let right = |cell: u32| (cell % n < n - 1).then_some([cell, cell + 1]);
    let up = |cell: u32| (cell < n * (n - 1)).then_some([cell, cell + n]);
    (0..n * n).flat_map(|cell| [right(cell), up(cell)]).flatten().collect()
}

fn types(n: u32, kind: impl Fn(u32) -> u32) -> Vec<u32> {
    (0..n * n).map(kind).collect()
}

#[test]
fn two_blocks_are_sorted_beyond_chance_and_a_checkerboard_is_the_opposite() {
    let pairs = lattice(8);
    let blocks = sorting(&types(8, |cell| cell / 32), &pairs, 1000, 1);
    // 104 of 112 pairs are alike, by chance 31 of 63.
    assert!((blocks.index - (104.0 / 112.0 - 31.0 / 63.0) / (32.0 / 63.0)).abs() < 1e-14);
    assert_eq!(blocks.p_value, 1.0 / 1001.0);
    let checkerboard = sorting(&types(8, |cell| (cell + cell / 8) % 2), &pairs, 1000, 1);
    assert!((checkerboard.index + 31.0 / 32.0).abs() < 1e-14);
    assert_eq!(checkerboard.p_value, 1.0);
    // As many of each type on the same pairs: the same law. Each is uncertain by 1/√2000; five standard errors.
    assert!((blocks.standard_deviation / checkerboard.standard_deviation - 1.0).abs() < 0.15);
}

#[test]
fn the_permutations_have_the_mean_and_the_variance_of_join_counts() {
    // Three types of 30, 20 and 14 cells. Five standard errors of the mean of 20 000 permutations.
    let (pairs, types) = (lattice(8), types(8, |cell| if cell < 30 { 0 } else { 1 + u32::from(cell >= 50) }));
    let found = sorting(&types, &pairs, 20_000, 7);
    assert!(found.mean.abs() < 5.0 * found.standard_deviation / 20_000_f64.sqrt(), "{found:?}");

    // The variance of the number of alike pairs, over all pairs of pairs: those that are the same, share a cell, or are
    // apart (Cliff & Ord 1981, sampling without replacement).
    let numbers = [30.0, 20.0, 14.0];
    let falling = |n: f64, k: u32| (0..k).map(|i| n - f64::from(i)).product::<f64>();
    let all = |k| falling(64.0, k);
    let two: f64 = numbers.iter().map(|n| falling(*n, 2)).sum::<f64>() / all(2);
    let three: f64 = numbers.iter().map(|n| falling(*n, 3)).sum::<f64>() / all(3);
    let same: f64 = numbers.iter().map(|n| falling(*n, 4)).sum();
    let mixed: f64 = (0..3)
        .flat_map(|a| (0..3).map(move |b| (a, b)))
        .filter(|(a, b)| a != b)
        .map(|(a, b)| falling(numbers[a], 2) * falling(numbers[b], 2))
        .sum();
    let four = (same + mixed) / all(4);
    let mut degrees = [0.0_f64; 64];
    pairs.iter().flatten().for_each(|cell| degrees[*cell as usize] += 1.0);
    let number = pairs.len() as f64;
    let sharing: f64 = degrees.iter().map(|degree| degree * (degree - 1.0)).sum();
    let apart = number * (number - 1.0) - sharing;
    let variance = number * two + sharing * three + apart * four - (number * two).powi(2);
    let wanted = variance.sqrt() / number / (1.0 - two);
    // A standard deviation of 20 000 values is uncertain by 1/√40 000 = 0.5 %; four of those.
    assert!((found.standard_deviation / wanted - 1.0).abs() < 0.02, "{} {wanted}", found.standard_deviation);
}

#[test]
fn types_at_random_have_p_values_without_preference() {
    let pairs = lattice(10);
    let mut next = noise::uniform(11);
    let mut values: Vec<f64> = (0..400)
        .map(|seed| {
            let kinds: Vec<u32> = (0..100).map(|_| u32::from(next() < 0.4)).collect();
            sorting(&kinds, &pairs, 199, seed).p_value
        })
        .collect();
    values.sort_by(f64::total_cmp);
    // The number of alike pairs is whole, so ties make p larger, by no more than the largest probability of one number,
    // 0.4/6.7 = 0.06. Chance alone moves all shares of 400 values by less than 1.36/20 = 0.068 in 95 of 100 cases.
    for level in [0.05, 0.1, 0.25, 0.5, 0.75, 0.9] {
        let share = values.iter().filter(|value| **value <= level).count() as f64 / 400.0;
        assert!(share < level + 0.068 && share > level - 0.13, "{share} of p values are below {level}");
    }
}

#[test]
fn what_is_undefined_is_no_number() {
    let pairs = lattice(4);
    for found in [sorting(&[0; 16], &pairs, 100, 0), sorting(&[0, 1], &[], 100, 0), sorting(&[], &[], 100, 0)] {
        assert!([found.index, found.mean, found.standard_deviation, found.p_value].iter().all(|n| n.is_nan()));
    }
    // Two cells of different types have one index only, and every permutation has it.
    let pair = sorting(&[0, 1], &[[0, 1]], 100, 0);
    assert_eq!((pair.index, pair.p_value), (0.0, 1.0));
    // Cells of another type that touch nobody are not dealt.
    assert!(sorting(&[0, 0, 1], &[[0, 1]], 100, 0).index.is_nan());
}

#[test]
fn a_seed_has_its_permutations() {
    let (pairs, types) = (lattice(6), types(6, |cell| cell % 3));
    assert_eq!(sorting(&types, &pairs, 50, 3), sorting(&types, &pairs, 50, 3));
    assert_ne!(sorting(&types, &pairs, 50, 3).mean, sorting(&types, &pairs, 50, 4).mean);
}
