//! What a cell senses of a field at a point.

use crate::Vec3;

/// What is sensed at a position.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensed {
    /// Value there.
    pub value: f64,
    /// Gradient there, per µm.
    pub gradient: Vec3,
}
