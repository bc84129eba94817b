//! Springs between pairs of atoms: along the edges of a mesh (the mass–spring model) or across a cell (internal links).
//!
//! `F = k (|d| − l₀) d/|d|` on one end and its opposite on the other, eq. (springs.1); Promayon 2008 and MODEL.md §2.3.

use super::lanes::{Real, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use super::tangent::matrix::Blocks;
use crate::Vec3;

/// A spring between two atoms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// One end.
    pub from: u32,
    /// The other end.
    pub to: u32,
    /// The length at which it is free of force, µm; 0 for a link that only pulls.
    pub rest_length: f64,
    /// Stiffness k, pN/µm.
    pub stiffness: f64,
}

/// The springs of a mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Springs {
    springs: Vec<Spring>,
}

/// A squared length, µm², below which a spring has no direction and pulls nowhere.
const NO_LENGTH: f64 = 1e-100;

impl Springs {
    /// Springs between any two atoms.
    pub fn between(springs: Vec<Spring>) -> Self {
        Self { springs }
    }

    /// Springs of one stiffness (pN/µm) on the given edges (or other pairs), free of force at `positions` (µm).
    pub fn on_edges(positions: &[Vec3], edges: &[[u32; 2]], stiffness: f64) -> Self {
        let spring = |&[from, to]: &[u32; 2]| Spring {
            from,
            to,
            rest_length: (positions[to as usize] - positions[from as usize]).norm(),
            stiffness,
        };
        Self { springs: edges.iter().map(spring).collect() }
    }

    /// Adds the force on every atom and returns the energy, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for spring in &self.springs {
            let (from, to) = (spring.from as usize, spring.to as usize);
            let along = x.get(to) - x.get(from);
            let length = along.squared().max(T::constant(x.token, NO_LENGTH)).sqrt();
            let stretch = length + -spring.rest_length;
            let pull = stretch * spring.stiffness;
            energy += pull * stretch * 0.5;
            let force = along.times(pull / length);
            f.add(from, force);
            f.sub(to, force);
        }
        energy
    }

    /// Adds the tangent stiffness of every spring: along itself, and across where it is drawn out, eq. (step.10).
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        let (zero, one) = (T::constant(x.token, 0.0), T::constant(x.token, 1.0));
        for spring in &self.springs {
            let along = x.get(spring.to as usize) - x.get(spring.from as usize);
            let per_length = one / along.squared().max(T::constant(x.token, NO_LENGTH)).sqrt();
            let across = ((one - per_length * spring.rest_length) * spring.stiffness).max(zero);
            let direction = along.times(per_length);
            let ends = [spring.from, spring.to];
            blocks.add_square(ends, [-direction, direction], -across + spring.stiffness);
            for (i, j, sign) in [(0, 0, 1.0), (1, 1, 1.0), (1, 0, -1.0)] {
                blocks.add_isotropic(ends[i], ends[j], across * sign);
            }
        }
    }

    /// Adds the stiffness of every spring along itself, in all directions.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        for spring in &self.springs {
            matrix.add_spring(spring.from as usize, spring.to as usize, spring.stiffness);
        }
    }
}
