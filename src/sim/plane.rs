//! What cells cannot pass.

use crate::Vec3;

/// A rigid plane: the half space that its normal points into is free.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Name for pictures and messages.
    pub name: String,
    /// A point of the plane, µm.
    pub point: Vec3,
    /// Unit normal towards the free side.
    pub normal: Vec3,
}
