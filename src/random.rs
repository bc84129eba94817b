//! Random numbers that belong to (seed, purpose, cell, draw) and to nothing else.
//!
//! There is no generator that runs along: a draw is a pure function of its address, the counter-based Philox4x32-10 of
//! Salmon et al. 2011 ("Parallel random numbers: as easy as 1, 2, 3"). So the numbers that a cell gets depend neither on
//! the order in which cells are treated nor on the number of threads, and a run resumes with nothing but one counter a
//! cell. The address is laid into the 128-bit counter as eq. (random.1) of the book says.

use std::convert::Infallible;

/// What a random number is for.
///
/// The numbers are part of the promise that a seed gives the same run for ever: they are never changed nor used again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Purpose {
    /// Latencies and directions of Brownian motility.
    Motility = 1,
    /// Where cells stand at the start.
    Placement = 2,
    /// How cells are turned at the start.
    Orientation = 3,
    /// Numbers drawn while a finished file is analysed (resampling).
    Analysis = 4,
}

/// Multipliers and key increments of Philox4x32 (Salmon et al. 2011, table 2 and §4.3).
const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
const KEY_STEPS: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
const ROUNDS: usize = 10;

/// Number of draws that an address can tell apart; at a thousand million draws a second they last two years.
pub const DRAWS: u64 = 1 << 56;

/// The Philox4x32-10 bijection, eq. (random.2): a 128-bit counter scrambled under a 64-bit key.
fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for round in 0..ROUNDS {
        if round > 0 {
            key = [key[0].wrapping_add(KEY_STEPS[0]), key[1].wrapping_add(KEY_STEPS[1])];
        }
        let left = u64::from(MULTIPLIERS[0]) * u64::from(counter[0]);
        let right = u64::from(MULTIPLIERS[1]) * u64::from(counter[2]);
        counter = [
            (right >> 32) as u32 ^ counter[1] ^ key[0],
            right as u32,
            (left >> 32) as u32 ^ counter[3] ^ key[1],
            left as u32,
        ];
    }
    counter
}

/// The 128 random bits at an address.
///
/// Only the low 56 bits of `draw` count, see [`DRAWS`]. The same address gives the same bits on every machine.
pub fn draw(seed: u64, purpose: Purpose, cell: u64, draw: u64) -> [u32; 4] {
    debug_assert!(draw < DRAWS, "draw {draw} lies beyond the {DRAWS} that an address can tell apart");
    let purpose_and_high = (u32::from(purpose as u8) << 24) | ((draw >> 32) as u32 & 0x00FF_FFFF);
    let counter = [draw as u32, purpose_and_high, cell as u32, (cell >> 32) as u32];
    philox(counter, [seed as u32, (seed >> 32) as u32])
}

/// A number uniform in [0, 1) from 64 random bits: the multiples of 2⁻⁵³, all equally likely; eq. (random.3).
pub fn uniform(low: u32, high: u32) -> f64 {
    let bits = (u64::from(high) << 32) | u64::from(low);
    (bits >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// Two independent numbers uniform in [0, 1) from one draw.
pub fn uniform_pair(bits: [u32; 4]) -> [f64; 2] {
    [uniform(bits[0], bits[1]), uniform(bits[2], bits[3])]
}

/// The draws of one cell for one purpose, in order; serves `rand` and `rand_distr`.
///
/// Its whole state is the number of draws made: keep [`Stream::draws`] and come back with [`Stream::at`].
/// Every request takes one draw, however few bits it needs, so no left-over bits have to be remembered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stream {
    seed: u64,
    purpose: Purpose,
    cell: u64,
    draws: u64,
}

impl Stream {
    /// The stream from its first draw.
    pub fn new(seed: u64, purpose: Purpose, cell: u64) -> Self {
        Self { seed, purpose, cell, draws: 0 }
    }

    /// The same stream after `draws` draws.
    pub fn at(self, draws: u64) -> Self {
        Self { draws, ..self }
    }

    /// Number of draws made.
    pub fn draws(&self) -> u64 {
        self.draws
    }

    /// The next 128 random bits.
    pub fn next_bits(&mut self) -> [u32; 4] {
        let bits = draw(self.seed, self.purpose, self.cell, self.draws);
        self.draws += 1;
        bits
    }

    /// The next number uniform in [0, 1).
    pub fn uniform_f64(&mut self) -> f64 {
        let bits = self.next_bits();
        uniform(bits[0], bits[1])
    }
}

impl rand::TryRng for Stream {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.next_bits()[0])
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        let bits = self.next_bits();
        Ok((u64::from(bits[1]) << 32) | u64::from(bits[0]))
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(16) {
            let drawn = self.next_bits().map(u32::to_le_bytes).concat();
            chunk.copy_from_slice(&drawn[..chunk.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_distr::{Distribution, StandardNormal};

    /// The known answers published with Random123 (kat_vectors, philox4x32 with 10 rounds).
    #[test]
    fn philox_gives_the_published_answers() {
        assert_eq!(philox([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        let pi = [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344];
        let answer = [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1];
        assert_eq!(philox(pi, [0xa409_3822, 0x299f_31d0]), answer);
    }

    #[test]
    fn every_part_of_the_address_changes_the_numbers() {
        let here = draw(7, Purpose::Motility, 3, 5);
        assert_ne!(here, draw(8, Purpose::Motility, 3, 5));
        assert_ne!(here, draw(7 + (1 << 40), Purpose::Motility, 3, 5));
        assert_ne!(here, draw(7, Purpose::Placement, 3, 5));
        assert_ne!(here, draw(7, Purpose::Motility, 4, 5));
        assert_ne!(here, draw(7, Purpose::Motility, 3 + (1 << 40), 5));
        assert_ne!(here, draw(7, Purpose::Motility, 3, 6));
        assert_ne!(here, draw(7, Purpose::Motility, 3, 5 + (1 << 40)));
    }

    #[test]
    fn a_stream_comes_back_where_it_stood() {
        let mut first = Stream::new(1, Purpose::Placement, 2);
        first.uniform_f64();
        first.uniform_f64();
        let mut second = Stream::new(1, Purpose::Placement, 2).at(first.draws());
        assert_eq!(first.next_bits(), second.next_bits());
    }

    #[test]
    fn uniform_numbers_fill_the_unit_interval_without_its_end() {
        assert_eq!(uniform(0, 0), 0.0);
        assert_eq!(uniform(u32::MAX, u32::MAX), 1.0 - 2f64.powi(-53));
        let mut stream = Stream::new(11, Purpose::Analysis, 0);
        let number = 100_000;
        let numbers: Vec<f64> = (0..number).map(|_| stream.uniform_f64()).collect();
        let mean = numbers.iter().sum::<f64>() / f64::from(number);
        // Four standard errors of the mean of a uniform number, sqrt(1/12/100000) = 0.00091.
        assert!((mean - 0.5).abs() < 0.0037, "mean {mean}");
    }

    #[test]
    fn the_distributions_of_rand_draw_from_a_stream() {
        let mut stream = Stream::new(5, Purpose::Analysis, 9);
        let number = 20_000;
        let squares: f64 = (0..number).map(|_| f64::powi(StandardNormal.sample(&mut stream), 2)).sum();
        // The variance of n normal numbers has the standard error sqrt(2/n) = 0.01; four of them.
        assert!((squares / f64::from(number) - 1.0).abs() < 0.04);
    }
}
