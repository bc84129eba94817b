//! A stiffness of shape memory that does not depend on the mesh.
//!
//! At a fixed k_e a cell softens as its mesh is refined: the energy of a smooth deformation falls in proportion to the
//! number of atoms. The shape modulus E_s (pN/µm) is defined by the energy that a mesh stores in small deformations
//! that keep the volume: averaged over all directions, a stretch tensor ε without trace costs `½ E_s A tr(ε²)`, A the
//! area of the surface, eq. (shape.4). The stiffness that gives a mesh this energy follows from one evaluation of the
//! energy for each of the five such tensors.

use super::lanes::{Vectors, VectorsMut};
use super::shape_memory::{Reaction, ShapeMemory};
use crate::Vec3;
use crate::geometry::{self, Surface};
use nalgebra::Matrix3;

/// Strain at which the energy is taken: small enough to be quadratic to six digits, far above round-off.
const STRAIN: f64 = 1e-4;

/// Energy over `½ A tr(ε²)` below which a mesh counts as flat, for k_e = 1 pN/µm.
const FLAT: f64 = 1e-9;

/// The stiffness k_e (pN/µm) that gives a mesh the shape modulus `modulus` (pN/µm); `None` for a flat mesh.
pub fn stiffness_of_modulus(rest: &Surface, rings: &[Vec<u32>], modulus: f64) -> Option<f64> {
    let memory = ShapeMemory::new(&rest.positions, rings, 1.0, Reaction::Exact);
    let area = geometry::area(rest);
    let tensors = [
        Matrix3::from_diagonal(&Vec3::new(1.0, -1.0, 0.0)),
        Matrix3::from_diagonal(&Vec3::new(-0.5, -0.5, 1.0)),
        Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        Matrix3::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0),
    ];
    let mut sum = 0.0;
    for tensor in tensors {
        // Both signs: the cubic term of the energy drops out.
        for strain in [STRAIN, -STRAIN] {
            let moved: Vec<f64> =
                rest.positions.iter().flat_map(|p| <[f64; 3]>::from(p + strain * tensor * p)).collect();
            let mut force = vec![0.0; moved.len()];
            let x = Vectors::<f64>::new((), &moved, 1, 0);
            let energy = memory.add_forces(&x, &mut VectorsMut::new((), &mut force, 1, 0));
            sum += energy / (0.5 * area * strain * strain * tensor.norm_squared());
        }
    }
    let mean = sum / (2.0 * tensors.len() as f64);
    (mean > FLAT).then_some(modulus / mean)
}
