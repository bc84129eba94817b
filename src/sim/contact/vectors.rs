//! Vectors of four numbers, which fill a register.

/// x, y, z and one number more.
pub type V4 = [f64; 4];

/// Four numbers from a function of their numbers.
#[inline(always)]
pub fn map(f: impl Fn(usize) -> f64) -> V4 {
    [f(0), f(1), f(2), f(3)]
}
