//! Random numbers that belong to (seed, purpose, cell, draw) and to nothing else.
//!
//! Philox4x32-10 (Salmon et al. 2011) is a function, not a generator with a state: the same question gets the same
//! answer on every machine, with any number of threads and after any resume. Key = seed, counter = (draw, cell and
//! purpose), eq. (random.1).

mod choices;
mod normals;
mod uniforms;

pub use choices::Choices;
pub use normals::Normals;
pub use uniforms::Uniforms;

use crate::elementary::{FNV_START, fnv1a};

use std::convert::Infallible;

use rand::TryRng;

/// What a number is used for. The values are part of the promise that results can be reproduced: never change them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// Directions and latencies of walks.
    Motility = 1,
    /// Where cells are put at the start.
    Placement = 2,
    /// Permutations of cell types in the test for segregation; the number of the permutation stands for the cell.
    Permutation = 3,
    /// Which cells are removed; the number of the change is that of the draw.
    Removal = 4,
    /// Durations and directions of pseudopods.
    Pseudopods = 5,
    /// Noise in equations; see [`Normals`].
    Noise = 6,
    /// Which atoms the fibres of a pseudopod join; the number of the pseudopod and that of the fibre stand for the draw.
    Fibres = 7,
    /// Which of the events of one time and one priority is executed next; see [`Choices`].
    Events = 8,
    /// Points of the designs of studies; the number of the parameter stands for the cell.
    Design = 9,
    /// Seeds of the runs of a study; the number of the replicate stands for the cell, that of the point for the draw.
    Replicate = 10,
    /// Values with which systems start; see [`Uniforms`].
    Starts = 11,
    /// Which cells are drawn for an interval by the bootstrap; the number of the draw stands for the cell. Numbers of analysis begin with 100.
    Bootstrap = 100,
}

const ROUNDS: usize = 10;
const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];

/// Philox4x32-10: four numbers for a counter under a key.
pub fn philox(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    philox_lanes(counter.map(|word| [word]), key).map(|[word]| word)
}

/// The same for several counters side by side.
#[inline(always)]
fn philox_lanes<const L: usize>(mut counter: [[u32; L]; 4], mut key: [u32; 2]) -> [[u32; L]; 4] {
    for round in 0..ROUNDS {
        if round > 0 {
            key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
        }
        let mut next = [[0; L]; 4];
        for l in 0..L {
            let first = u64::from(counter[0][l]) * u64::from(MULTIPLIERS[0]);
            let second = u64::from(counter[2][l]) * u64::from(MULTIPLIERS[1]);
            next[0][l] = (second >> 32) as u32 ^ counter[1][l] ^ key[0];
            next[1][l] = second as u32;
            next[2][l] = (first >> 32) as u32 ^ counter[3][l] ^ key[1];
            next[3][l] = first as u32;
        }
        counter = next;
    }
    counter
}

/// The key of what has a name, written in parts, eq. (random.2).
fn named_key(seed: u64, purpose: Purpose, name: &[&str]) -> [u32; 2] {
    let label = label(name);
    let counter = [label as u32, (label >> 32) as u32, 0, purpose as u32];
    let [first, second, ..] = philox(counter, [seed as u32, (seed >> 32) as u32]);
    [first, second]
}

/// FNV-1a in 64 bits of the parts of a name. 0xff, which never occurs in UTF-8, parts them.
fn label(name: &[&str]) -> u64 {
    let bytes = name.iter().flat_map(|part| part.bytes().chain([0xff]));
    fnv1a(FNV_START, bytes)
}

/// The numbers of one purpose and one cell, addressed by draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stream {
    seed: u64,
    purpose: Purpose,
    cell: u32,
    /// The next draw: all that must be kept to go on.
    pub draw: u64,
}

impl Stream {
    /// The stream of a purpose and a cell, at a draw.
    pub fn new(seed: u64, purpose: Purpose, cell: u32, draw: u64) -> Self {
        Self { seed, purpose, cell, draw }
    }

    /// The next four numbers.
    fn next_block(&mut self) -> [u32; 4] {
        let counter = [self.draw as u32, (self.draw >> 32) as u32, self.cell, self.purpose as u32];
        self.draw += 1;
        philox(counter, [self.seed as u32, (self.seed >> 32) as u32])
    }

    /// Two numbers uniform in [0, 1) with 53 bits each; one draw.
    pub fn uniform_pair(&mut self) -> [f64; 2] {
        let [a, b, c, d] = self.next_block();
        let unit = |high: u32, low: u32| ((u64::from(high) << 32 | u64::from(low)) >> 11) as f64 * 2f64.powi(-53);
        [unit(a, b), unit(c, d)]
    }
}

/// For the distributions of `rand_distr`; every number costs a draw.
impl TryRng for Stream {
    type Error = Infallible;
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.next_block()[0])
    }
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        let [a, b, ..] = self.next_block();
        Ok(u64::from(a) << 32 | u64::from(b))
    }
    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(4) {
            let word = self.next_block()[0].to_le_bytes();
            chunk.copy_from_slice(&word[..chunk.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn philox_gives_the_known_answers_of_random123() {
        assert_eq!(philox([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        let pi = [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344];
        let known = [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1];
        assert_eq!(philox(pi, [0xa409_3822, 0x299f_31d0]), known);
    }

    #[test]
    fn streams_differ_by_seed_purpose_cell_and_draw_and_repeat_otherwise() {
        let first = |seed, purpose, cell, draw| Stream::new(seed, purpose, cell, draw).uniform_pair();
        let base = first(1, Purpose::Motility, 2, 3);
        assert_eq!(base, first(1, Purpose::Motility, 2, 3));
        for other in [
            first(2, Purpose::Motility, 2, 3),
            first(1, Purpose::Placement, 2, 3),
            first(1, Purpose::Motility, 3, 3),
            first(1, Purpose::Motility, 2, 4),
        ] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn the_distributions_of_rand_accept_a_stream() {
        let mut stream = Stream::new(5, Purpose::Placement, 0, 0);
        let mean = (0..10_000).map(|_| stream.random::<f64>()).sum::<f64>() / 10_000.0;
        // Standard error 1/√(12·10⁴) = 0.0029; five of them.
        assert!((mean - 0.5).abs() < 0.0145, "{mean}");
    }
}
