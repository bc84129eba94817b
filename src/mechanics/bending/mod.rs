//! The resistance of a cell's skin to bending, from a rigidity that can be measured.
//!
//! On a closed mesh it is Helfrich's energy, eq. (bending.1), `E = κ/2 ∫ (c₁ + c₂ − c₀)² dA` (Helfrich 1973), with the curvature and the
//! area of each atom in the present shape: where atoms stand on a surface makes no difference but that of the mesh, so that bending leaves
//! shear to the membrane, and a pulled sphere is as eq. (bending.7) says. An open sheet has hinges on its edges instead, eq. (bending.5),
//! with weights of the rest shape.

mod atoms;
mod hinges;
mod star;
#[cfg(test)]
mod tests;

use super::lanes::{Real, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use super::tangent::matrix::Blocks;
use crate::Vec3;
use crate::geometry::Topology;
use atoms::Atoms;
use hinges::Hinges;

/// The curvature at which a skin is free of stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RestAngle {
    /// That of the rest shape: a skin that remembers its curvature.
    #[default]
    Remembered,
    /// Flat: a lipid bilayer without spontaneous curvature.
    Flat,
}

/// The bending of a mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Bending(Form);

#[derive(Debug, Clone, PartialEq)]
enum Form {
    Atoms(Atoms),
    Hinges(Hinges),
}

impl Bending {
    /// A skin of bending rigidity κ = `rigidity` (pN·µm; a lipid bilayer has about 0.08 to 0.2) over a mesh with the rest positions
    /// `positions` (µm).
    pub fn new(positions: &[Vec3], topology: &Topology, rigidity: f64, rest_angle: RestAngle) -> Self {
        let remembers = rest_angle == RestAngle::Remembered;
        if topology.is_closed() {
            let rings = topology.rings.iter().map(|ring| ring.atoms.as_slice());
            Self(Form::Atoms(Atoms::new(positions, rings, rigidity, remembers)))
        } else {
            Self(Form::Hinges(Hinges::new(positions, &topology.flaps, rigidity, remembers)))
        }
    }

    /// Adds the force on every atom, eq. (bending.4) or (bending.6), and returns the energy, eq. (bending.1) or (bending.5), pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        match &self.0 {
            Form::Atoms(atoms) => atoms.add_forces(x, f),
            Form::Hinges(hinges) => hinges.add_forces(x, f),
        }
    }

    /// Adds the tangent stiffness of each atom or hinge against a change of its curvature or angle, eq. (step.10).
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        match &self.0 {
            Form::Atoms(atoms) => atoms.add_tangent(x, blocks),
            Form::Hinges(hinges) => hinges.add_tangent(x, blocks),
        }
    }

    /// Adds an isotropic bound of that stiffness in the shape `x` (µm), for hinges at rest: equal to it for a flat mesh.
    pub fn add_stiffness(&self, x: &[Vec3], matrix: &mut StiffnessMatrix) {
        match &self.0 {
            Form::Atoms(atoms) => atoms.add_stiffness(x, matrix),
            Form::Hinges(hinges) => hinges.add_stiffness(matrix),
        }
    }
}
