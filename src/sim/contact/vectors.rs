//! Vectors of four numbers, which fill a register, and those of corners.

use crate::Vec3;

/// x, y, z and one number more.
pub type V4 = [f64; 4];

/// Four numbers from a function of their numbers.
#[inline(always)]
pub fn map(f: impl Fn(usize) -> f64) -> V4 {
    [f(0), f(1), f(2), f(3)]
}

/// The positions of three atoms.
#[inline(always)]
pub fn gather_corners(positions: &[Vec3], [a, b, c]: [u32; 3]) -> [Vec3; 3] {
    [positions[a as usize], positions[b as usize], positions[c as usize]]
}
