//! The law of contact that the project stands on: surfaces bear any push, and a pull and a shear up to a strength. What holds is
//! found by the projection alone, so that the law adds no force of its own.

/// How strongly two surfaces stick, eq. (adhesion.2). It depends neither on the step nor on the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strength {
    /// The pull at which they part, pN/µm².
    pub tensile: f64,
    /// The shear at which they slide, pN/µm².
    pub shear: f64,
    /// What an area of contact releases, pN/µm, eq. (adhesion.9): contacts spread against the tension of the surfaces.
    pub energy: f64,
}

/// The depth that is promised, over the shorter mean edge of the two cells.
pub(in crate::sim::contact) const PROMISED: f64 = 0.02;
