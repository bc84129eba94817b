//! Vectors of several things side by side, for loops that are compiled for wide registers: no closures, and one rounding each, as of
//! [`Vec3`](crate::Vec3).

/// A vector.
pub type V = [f64; 3];

/// That of one lane.
#[inline(always)]
pub fn lane<const L: usize>(rows: &[[f64; L]; 3], k: usize) -> V {
    [rows[0][k], rows[1][k], rows[2][k]]
}

/// The scalar product.
#[inline(always)]
pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The difference.
#[inline(always)]
pub fn minus(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
