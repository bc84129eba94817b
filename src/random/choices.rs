//! Choices among things of which none comes first.

use super::{Purpose, named_key, philox};

/// Choices that belong to (seed, purpose, name, time, cell, number) and to nothing else, eq. (random.4): each can be had without any
/// other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choices {
    key: [u32; 2],
}

impl Choices {
    /// The choices of what has this name, written in parts.
    pub fn new(seed: u64, purpose: Purpose, name: &[&str]) -> Self {
        Self { key: named_key(seed, purpose, name) }
    }

    /// One of so many things, each as likely as any other to 2⁻⁶⁴: its number from 0. `number` counts the choices of a cell at a time.
    pub fn one(&self, time: f64, (cell, number): (u32, u32), things: usize) -> usize {
        // The two zeros are one time.
        let time = (time + 0.0).to_bits();
        let [high, low, ..] = philox([time as u32, (time >> 32) as u32, cell, number], self.key);
        let share = u128::from(u64::from(high) << 32 | u64::from(low));
        ((share * things as u128) >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choices(seed: u64, name: &str) -> Choices {
        Choices::new(seed, Purpose::Events, &[name])
    }

    #[test]
    fn choices_differ_by_seed_name_time_cell_and_number_and_repeat_otherwise() {
        let things = 1 << 40;
        let base = choices(1, "u").one(0.5, (2, 3), things);
        assert_eq!(base, choices(1, "u").one(0.5, (2, 3), things));
        assert_eq!(choices(1, "u").one(0.0, (2, 3), things), choices(1, "u").one(-0.0, (2, 3), things));
        let others = [
            choices(2, "u").one(0.5, (2, 3), things),
            choices(1, "v").one(0.5, (2, 3), things),
            choices(1, "u").one(0.5 + f64::EPSILON, (2, 3), things),
            choices(1, "u").one(0.5, (1, 3), things),
            choices(1, "u").one(0.5, (2, 4), things),
        ];
        assert!(others.iter().all(|other| *other != base));
    }

    #[test]
    fn all_things_are_equally_likely() {
        let (of, n) = (choices(3, "u"), 60_000_u32);
        let mut counts = [0_u32; 6];
        (0..n).for_each(|k| counts[of.one(0.01 * f64::from(k), (0, k % 7), 6)] += 1);
        // Chi-square of five degrees of freedom is above 20.5 once in a thousand.
        let expected = f64::from(n) / 6.0;
        let chi: f64 = counts.iter().map(|&count| (f64::from(count) - expected).powi(2) / expected).sum();
        assert!(chi < 20.5, "{counts:?}");
    }
}
