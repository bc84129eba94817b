//! A stiffness of shape memory that does not depend on the mesh.
//!
//! At a fixed k_e a cell softens as its mesh is refined: the energy of a smooth deformation falls in proportion to the
//! number of atoms. The shape modulus E_s (pN/µm) is defined by the energy that a mesh stores in small deformations
//! that keep the volume: averaged over all directions, a stretch tensor ε without trace costs `½ E_s A tr(ε²)`, A the
//! area of the surface, eq. (shape.4). The stiffness that gives a mesh this energy follows from one evaluation of the
//! energy for each of the five such tensors.

use super::Force;
use super::lanes::{Vectors, VectorsMut};
use super::shape_memory::{Reaction, ShapeMemory};
use super::sum::measure_elastic;
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
    let tensors = tensors();
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

/// The five ways to stretch a body that keep its volume.
fn tensors() -> [Matrix3<f64>; 5] {
    [
        Matrix3::from_diagonal(&Vec3::new(1.0, -1.0, 0.0)),
        Matrix3::from_diagonal(&Vec3::new(-0.5, -0.5, 1.0)),
        Matrix3::new(0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        Matrix3::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0),
    ]
}

/// Strain at which energies of all forces are compared with areas: areas grow by its square, which must be told from round-off.
const STRETCH: f64 = 1e-3;

/// The energy an area, pN/µm, that may be had for surface before the shape at rest is no longer the best one, eq. (shape.7): the least, over
/// ways to stretch the body that keep its volume, of the elastic energy over the area that is gained. Infinite where none gains any.
pub fn energy_that_shape_bears(forces: &[Force], rest: &Surface) -> f64 {
    let measured = |stretch: Matrix3<f64>| {
        let positions: Vec<Vec3> = rest.positions.iter().map(|position| stretch * position).collect();
        let moved: Vec<f64> = positions.iter().flat_map(|position| <[f64; 3]>::from(*position)).collect();
        let (mut force, mut energy) = (vec![0.0; moved.len()], [0.0]);
        measure_elastic(forces, 1, &moved, &mut force, &mut energy);
        (energy[0], geometry::area(&Surface { positions, facets: rest.facets.clone() }))
    };
    let (energy_at_rest, area_at_rest) = measured(Matrix3::identity());
    let of_tensor = |tensor: Matrix3<f64>| {
        let (mut energy, mut area) = (0.0, 0.0);
        for strain in [STRETCH, -STRETCH] {
            // The exponential, to the order that counts: it has a determinant of 1.
            let by = strain * tensor;
            let stretched = measured(Matrix3::identity() + by + 0.5 * by * by);
            energy += stretched.0 - energy_at_rest;
            area += stretched.1 - area_at_rest;
        }
        if area > 0.0 { energy / area } else { f64::INFINITY }
    };
    tensors().into_iter().map(of_tensor).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::super::tension::Tension;
    use super::*;
    use crate::geometry::{Topology, icosphere};

    #[test]
    fn a_ball_bears_fifteen_eighths_of_its_shape_modulus_and_a_drop_its_tension() {
        let ball = icosphere(5.0, 2);
        let rings: Vec<Vec<u32>> = Topology::of(&ball).rings.into_iter().map(|ring| ring.atoms).collect();
        let stiffness = stiffness_of_modulus(&ball, &rings, 0.4).expect("not flat");
        let memory = ShapeMemory::new(&ball.positions, &rings, stiffness, Reaction::Exact);
        // Of ½ E A tr(ε²) over 4/15 A tr(ε²); the mesh is a ball within half a per cent, and stretches are not all the same on it.
        let bears = energy_that_shape_bears(&[Force::ShapeMemory(memory)], &ball);
        assert!((bears / (1.875 * 0.4) - 1.0).abs() < 0.02, "{bears}");
        let tension = Tension::new(&ball.positions, &ball.facets, 3.0, 0.0);
        let bears = energy_that_shape_bears(&[Force::Tension(tension)], &ball);
        // Energies of 942 pN·µm that differ by 10⁻⁶ of them.
        assert!((bears / 3.0 - 1.0).abs() < 1e-8, "{bears}");
    }
}
