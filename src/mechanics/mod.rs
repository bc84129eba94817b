//! How forces move atoms: elasticity, loads, integration in time, constraints.
//!
//! Every force is one file: its parameters, `add_forces` (which returns the energy) written over
//! [`lanes::Real`], and `add_stiffness`, its constant linear part for the implicit step. [`Force`] is the one list of them,
//! which the step, the stiffness, the energy account, chemistry and the shared test walk alike.

pub mod angles;
pub mod attraction;
pub mod barrier;
pub mod bending;
pub mod control;
pub mod course;
mod envelope;
pub mod fibres;
pub mod gravity;
mod hinge;
pub mod implicit;
pub mod integrator;
pub mod lanes;
pub mod load;
pub mod membrane;
pub mod modes;
pub mod moved;
pub mod ordering;
pub mod plate;
pub mod pressure;
pub mod restoring;
pub mod rigid;
pub mod shape_memory;
pub mod shape_modulus;
pub mod solid;
pub mod springs;
pub mod stability;
pub mod stiffness;
pub mod sum;
pub mod tangent;
pub mod tension;
pub mod torque;
pub mod trap;
pub mod viscosity;
pub mod volume;

use crate::Vec3;
use control::{Context, Handle};
use course::Course;
use lanes::{LANES, Real, Vectors, VectorsMut};
use stiffness::StiffnessMatrix;
use tangent::matrix::Blocks;

/// A force on the atoms of every cell of a kind. Drag is none: it is what the schemes divide by.
#[derive(Debug, Clone, PartialEq)]
pub enum Force {
    /// Shape memory in the triplet form.
    ShapeMemory(shape_memory::ShapeMemory),
    /// Shape memory in the (α, β, γ) form.
    Angles(angles::Angles),
    /// In-plane elasticity of a membrane.
    Membrane(membrane::Membrane),
    /// Surface tension and the modulus of the total area.
    Tension(tension::Tension),
    /// Pulls along a surface that keep its atoms in order.
    Ordering(ordering::Ordering),
    /// Bending of a membrane.
    Bending(bending::Bending),
    /// Springs on edges and links between any two atoms.
    Springs(springs::Springs),
    /// A body filled with an elastic material.
    Solid(solid::Solid),
    /// The barrier against folding and collapsing facets.
    Barrier(barrier::Barrier),
    /// A load with a course in time on some atoms.
    Load(load::Load),
    /// A pressure with a course in time on some facets.
    Pressure(pressure::Pressure),
    /// A torque with a course in time on some atoms.
    Torque(torque::Torque),
    /// Contractile fibres.
    Fibres(fibres::Fibres),
    /// Weight.
    Gravity(gravity::Gravity),
    /// A pull of every atom to a point.
    Attraction(attraction::Attraction),
    /// A spring from the centre of a rigid body to a point.
    Trap(trap::Trap),
    /// A flexible plate to which atoms are bonded.
    Plate(plate::Plate),
}

/// The kinds of forces that chemistry or a program may set, in the order in which messages list them.
pub const CONTROLLED: [Handle; 2] = [load::HANDLE, fibres::HANDLE];

impl Force {
    /// Whether it answers to the shape of the cell alone and at all times: its energy is the cell's elastic energy, and chemistry may
    /// scale it as a whole. All others do work on the cell.
    pub fn is_elastic(&self) -> bool {
        match self {
            Self::ShapeMemory(_) | Self::Angles(_) | Self::Membrane(_) | Self::Tension(_) => true,
            Self::Ordering(_) | Self::Bending(_) | Self::Springs(_) | Self::Solid(_) | Self::Barrier(_) => true,
            Self::Load(_) | Self::Fibres(_) | Self::Gravity(_) | Self::Attraction(_) => false,
            Self::Pressure(_) | Self::Torque(_) | Self::Trap(_) | Self::Plate(_) => false,
        }
    }

    /// Whether something outside of the cell exerts it: what a cell does to itself has neither sum nor torque.
    pub fn is_outer(&self) -> bool {
        match self {
            Self::Load(_) | Self::Pressure(_) | Self::Gravity(_) | Self::Attraction(_) => true,
            Self::Torque(_) | Self::Trap(_) | Self::Plate(_) => true,
            Self::ShapeMemory(_) | Self::Angles(_) | Self::Membrane(_) | Self::Tension(_) | Self::Ordering(_) => false,
            Self::Bending(_) | Self::Springs(_) | Self::Solid(_) | Self::Barrier(_) | Self::Fibres(_) => false,
        }
    }

    /// Whether it is, at any instant, the gradient of the energy that it tells. Not so are the documents' shape memories, pulls
    /// that keep order, pressures on a part of a surface, and torques.
    pub fn is_conservative(&self) -> bool {
        match self {
            Self::ShapeMemory(force) => force.is_gradient(),
            Self::Angles(_) | Self::Ordering(_) | Self::Pressure(_) | Self::Torque(_) => false,
            _ => true,
        }
    }

    /// Its course in time, if it has one.
    pub fn course(&self) -> Option<&Course> {
        match self {
            Self::Load(force) => Some(&force.force),
            Self::Pressure(force) => Some(&force.pressure),
            Self::Torque(force) => Some(&force.torque),
            Self::Fibres(force) => Some(&force.activation),
            Self::Trap(force) => force.course(),
            Self::Plate(force) => Some(&force.displacement),
            _ => None,
        }
    }

    /// The times at which its course bends, s: a step must not run over them.
    pub fn kinks(&self) -> impl Iterator<Item = f64> + '_ {
        self.course().into_iter().flat_map(Course::kinks)
    }

    /// The number in [`CONTROLLED`] and the name by which it may be set, if it may.
    pub fn handle(&self) -> Option<(usize, &str)> {
        match self {
            Self::Load(force) => Some((0, &force.name)),
            Self::Fibres(force) => Some((1, &force.name)),
            _ => None,
        }
    }

    /// Adds its linear part for the implicit step, pN/µm, as it is fit for the shape `x` (µm) of a cell with this rest shape.
    pub fn add_stiffness(&self, rest: &[Vec3], x: &[Vec3], matrix: &mut StiffnessMatrix) {
        match self {
            Self::ShapeMemory(force) => force.add_stiffness(rest, x, matrix),
            Self::Angles(force) => force.add_stiffness(matrix),
            Self::Membrane(force) => force.add_stiffness(x, matrix),
            Self::Tension(force) => force.add_stiffness(matrix),
            Self::Ordering(force) => force.add_stiffness(x, matrix),
            Self::Bending(force) => force.add_stiffness(x, matrix),
            Self::Springs(force) => force.add_stiffness(matrix),
            Self::Solid(force) => force.add_stiffness(matrix),
            Self::Barrier(force) => force.add_stiffness(matrix),
            Self::Fibres(force) => force.add_stiffness(matrix),
            Self::Attraction(force) => force.add_stiffness(matrix),
            Self::Plate(force) => force.add_stiffness(matrix),
            // What a trap does to a body as a whole is in the step beside K, eq. (rigid.4).
            Self::Load(_) | Self::Pressure(_) | Self::Torque(_) | Self::Gravity(_) | Self::Trap(_) => {}
        }
    }

    /// Whether it has a tangent stiffness of its own, eq. (step.10).
    pub fn has_tangent(&self) -> bool {
        match self {
            Self::Membrane(_) | Self::Bending(_) | Self::Springs(_) | Self::Solid(_) | Self::Plate(_) => true,
            Self::Tension(force) => force.has_tangent(),
            _ => false,
        }
    }

    /// Adds its tangent stiffness for the cells at `x`, pN/µm, if it has one; of a filled body the `whole` of it, or what is positive.
    #[inline(always)]
    fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>, whole: bool) {
        match self {
            Self::Membrane(force) => force.add_tangent(x, blocks),
            Self::Bending(force) => force.add_tangent(x, blocks),
            Self::Springs(force) => force.add_tangent(x, blocks),
            Self::Solid(force) => force.add_tangent(x, blocks, whole),
            Self::Plate(force) => force.add_tangent(x, blocks),
            Self::Tension(force) if force.has_tangent() => force.add_tangent(x, blocks),
            _ => {}
        }
    }

    /// What the largest eigenvalue of its stiffness is at most, pN/µm, where it is not elastic; of elastic forces it is measured.
    pub fn largest_stiffness(&self) -> Option<f64> {
        match self {
            Self::Fibres(force) => Some(force.largest_stiffness()),
            Self::Attraction(force) => Some(force.stiffness),
            Self::Plate(force) => Some(force.largest_stiffness()),
            Self::Load(_) | Self::Pressure(_) | Self::Torque(_) | Self::Gravity(_) | Self::Trap(_) => Some(0.0),
            Self::ShapeMemory(_) | Self::Angles(_) | Self::Membrane(_) | Self::Tension(_) => None,
            Self::Ordering(_) | Self::Bending(_) | Self::Springs(_) | Self::Solid(_) | Self::Barrier(_) => None,
        }
    }

    /// How strongly it acts on the cell of each lane of a block where these numbers are `set`; elastic forces act as they are.
    fn strength(&self, context: &Context, set: &[f64; LANES]) -> [f64; LANES] {
        match self {
            Self::Load(force) => force.strength(context.time, set),
            Self::Pressure(force) => [force.pressure.at(context.time); LANES],
            Self::Torque(force) => [force.torque.at(context.time); LANES],
            Self::Fibres(force) => force.activation(context.time, set),
            Self::Gravity(_) => [context.mass; LANES],
            Self::Trap(force) => [force.gone(context.time); LANES],
            Self::Plate(force) => [force.displacement.at(context.time); LANES],
            _ => [1.0; LANES],
        }
    }

    /// Adds the force on every atom, pN, at the strength of each cell, and returns the energy, pN·µm. Matched once for a register
    /// of cells.
    #[inline(always)]
    fn add_forces<T: Real>(&self, strength: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        match self {
            Self::ShapeMemory(force) => force.add_forces(x, f),
            Self::Angles(force) => force.add_forces(x, f),
            Self::Membrane(force) => force.add_forces(x, f),
            Self::Tension(force) => force.add_forces(x, f),
            Self::Ordering(force) => force.add_forces(x, f),
            Self::Bending(force) => force.add_forces(x, f),
            Self::Springs(force) => force.add_forces(x, f),
            Self::Solid(force) => force.add_forces(x, f),
            Self::Barrier(force) => force.add_forces(x, f),
            Self::Load(force) => force.add_forces(strength, x, f),
            Self::Pressure(force) => force.add_forces(strength, x, f),
            Self::Torque(force) => force.add_forces(strength, x, f),
            Self::Fibres(force) => force.add_forces(strength, x, f),
            Self::Gravity(force) => force.add_forces(strength, x, f),
            Self::Attraction(force) => force.add_forces(x, f),
            Self::Trap(force) => force.add_forces(strength, x, f),
            Self::Plate(force) => force.add_forces(strength, x, f),
        }
    }
}
