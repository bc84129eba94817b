//! The shapes of cells as triangle surfaces: how they are made, read, checked and measured. No physics, no time.

use crate::Vec3;

/// A triangle surface, closed or open. Facets are oriented: seen from outside, their atoms run counter-clockwise,
/// so that `(b − a) × (c − a)` points outwards and a closed surface has a positive volume.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Positions of the atoms, µm.
    pub positions: Vec<Vec3>,
    /// The three atoms of each facet.
    pub facets: Vec<[u32; 3]>,
}
