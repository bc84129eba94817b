//! Uniform numbers by name.

use super::{Purpose, named_key, philox};

/// Numbers uniform in [0, 1) with 53 bits that belong to (seed, purpose, name, cell, element) and to nothing else: each can be had without any other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Uniforms {
    key: [u32; 2],
}

impl Uniforms {
    /// The numbers of what has this name, written in parts.
    pub fn new(seed: u64, purpose: Purpose, name: &[&str]) -> Self {
        Self { key: named_key(seed, purpose, name) }
    }

    /// The number of one element of a cell.
    pub fn one(&self, cell: u32, element: u32) -> f64 {
        // Normal numbers of the same name have other counters.
        let [high, low, ..] = philox([u32::MAX, u32::MAX, cell, element], self.key);
        ((u64::from(high) << 32 | u64::from(low)) >> 11) as f64 * 2f64.powi(-53)
    }
}
