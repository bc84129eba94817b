//! All that resists a change of shape in one kind of cell: a list per force, empty where a feature is absent.

use super::angles::Angles;
use super::barrier::Barrier;
use super::bending::Bending;
use super::lanes::{BlockWork, Real, Vectors, VectorsMut, dispatch};
use super::membrane::Membrane;
use super::ordering::Ordering;
use super::shape_memory::ShapeMemory;
use super::springs::Springs;
use super::stiffness::StiffnessMatrix;
use super::tension::Tension;
use crate::Vec3;

/// The elastic forces of a mesh, shared by all cells that have it.
#[derive(Debug, Clone, Default)]
pub struct Elasticity {
    /// Shape memory in the triplet form.
    pub shape_memory: Vec<ShapeMemory>,
    /// Shape memory in the (α, β, γ) form.
    pub angles: Vec<Angles>,
    /// In-plane elasticity of a membrane.
    pub membrane: Vec<Membrane>,
    /// Surface tension and the modulus of the total area.
    pub tension: Vec<Tension>,
    /// Pulls along a surface that keep its atoms in order.
    pub ordering: Vec<Ordering>,
    /// Bending of a membrane.
    pub bending: Vec<Bending>,
    /// Springs on edges and links between any two atoms.
    pub springs: Vec<Springs>,
    /// The barrier against folding and collapsing facets.
    pub barrier: Vec<Barrier>,
}

impl Elasticity {
    /// Whether all forces are the gradient of the energy. Not those of the documents' shape memories, nor pulls that keep order.
    pub fn is_conservative(&self) -> bool {
        let exact = self.shape_memory.iter().all(ShapeMemory::is_gradient);
        exact && self.angles.is_empty() && self.ordering.is_empty()
    }

    /// Adds the forces on the atoms of a block (pN) and adds the energy of each lane (pN·µm) to `energy`.
    pub fn add_forces(&self, lanes: usize, x: &[f64], f: &mut [f64], energy: &mut [f64]) {
        dispatch(lanes, Work { elasticity: self, x, f, energy });
    }

    /// The linear part of all forces for the implicit step, as it is fit for the shape `x` of a cell with this rest
    /// shape.
    pub fn stiffness(&self, rest: &[Vec3], x: &[Vec3]) -> StiffnessMatrix {
        let mut matrix = StiffnessMatrix::new(rest.len());
        self.shape_memory.iter().for_each(|force| force.add_stiffness(rest, x, &mut matrix));
        self.angles.iter().for_each(|force| force.add_stiffness(&mut matrix));
        self.membrane.iter().for_each(|force| force.add_stiffness(x, &mut matrix));
        self.tension.iter().for_each(|force| force.add_stiffness(&mut matrix));
        self.ordering.iter().for_each(|force| force.add_stiffness(x, &mut matrix));
        self.bending.iter().for_each(|force| force.add_stiffness(&mut matrix));
        self.springs.iter().for_each(|force| force.add_stiffness(&mut matrix));
        self.barrier.iter().for_each(|force| force.add_stiffness(&mut matrix));
        matrix
    }
}

struct Work<'a> {
    elasticity: &'a Elasticity,
    x: &'a [f64],
    f: &'a mut [f64],
    energy: &'a mut [f64],
}

impl BlockWork for Work<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let x = T::view(token, self.x);
        let f = T::view_mut(token, self.f);
        let energy = T::view_mut(token, self.energy);
        for part in 0..stride {
            let x = Vectors::<T>::new(token, x, stride, part);
            let mut f = VectorsMut::<T>::new(token, f, stride, part);
            let mut sum = T::load(token, energy[part]);
            for force in &self.elasticity.shape_memory {
                sum += force.add_forces(&x, &mut f);
            }
            for force in &self.elasticity.angles {
                sum += force.add_forces(&x, &mut f);
            }
            for force in &self.elasticity.membrane {
                sum += force.add_forces(&x, &mut f);
            }
            for force in &self.elasticity.tension {
                sum += force.add_forces(&x, &mut f);
            }
            for force in &self.elasticity.ordering {
                sum += force.add_forces(&x, &mut f);
            }
            for force in &self.elasticity.bending {
                sum += force.add_forces(&x, &mut f);
            }
            for force in &self.elasticity.springs {
                sum += force.add_forces(&x, &mut f);
            }
            for force in &self.elasticity.barrier {
                sum += force.add_forces(&x, &mut f);
            }
            energy[part] = sum.raw();
        }
    }
}
