//! Contractile fibres: bundles of actomyosin that draw the atoms at their ends together, as far as they are active.
//!
//! `F = A K (X_b − X_a)` on atom a and its opposite on b, eq. (fibres.1); Promayon 2008 and MODEL.md §4. A fibre has no length of
//! its own: relaxed it does nothing, and active it pulls with a force in proportion to its length.

use serde::{Deserialize, Serialize};

use super::control::Handle;
use super::course::Course;
use super::lanes::{LANES, Real, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;

/// What may be set is the activation; below 0 the course stands.
pub const HANDLE: Handle =
    Handle { word: "fibre", key: "fibres", range: [0.0, 1.0], expected: "a number from 0 to 1", unset: -1.0 };

/// A single fibre of a cell, which may come and go while it runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fibre {
    /// The atoms at its ends.
    pub atoms: [u32; 2],
    /// Stiffness K at full activation, pN/µm.
    pub stiffness: f64,
    /// Activation A, 0 to 1.
    pub activation: f64,
}

impl Fibre {
    /// The force on the atom at the first end, pN, where the other is this far off (µm), and the energy, pN·µm, eq. (fibres.1). The
    /// force on the other end is opposite.
    pub fn pull(&self, along: Vec3) -> (Vec3, f64) {
        let pull = along * (self.activation * self.stiffness);
        (pull, 0.5 * pull.dot(&along))
    }
}

/// Fibres of a cell that are active together.
#[derive(Debug, Clone, PartialEq)]
pub struct Fibres {
    /// The name by which chemistry knows them.
    pub name: String,
    /// The atoms at the two ends of each.
    pub pairs: Vec<[u32; 2]>,
    /// Stiffness K of each at full activation, pN/µm.
    pub stiffness: f64,
    /// Activation A, 0 to 1, in the course of time.
    pub activation: Course,
}

impl Fibres {
    /// Fibres.
    pub fn new(name: &str, pairs: Vec<[u32; 2]>, stiffness: f64, activation: Course) -> Self {
        Self { name: name.to_owned(), pairs, stiffness, activation }
    }

    /// The activation in each lane at a time: what is set, or else that of the course.
    pub(super) fn activation(&self, time: f64, set: &[f64; LANES]) -> [f64; LANES] {
        let own = self.activation.at(time);
        set.map(|set| if set >= 0.0 { set } else { own })
    }

    /// Adds the force on every atom at this activation and returns the energy, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, activation: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        let stiffness = activation * self.stiffness;
        for &[from, to] in &self.pairs {
            let along = x.get(to as usize) - x.get(from as usize);
            let pull = along.times(stiffness);
            f.add(from as usize, pull);
            f.sub(to as usize, pull);
            energy += pull.dot(along) * 0.5;
        }
        energy
    }

    /// Adds the stiffness at full activation: the implicit step bears one that is too large, but not one that is too small.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        self.pairs.iter().for_each(|&[from, to]| matrix.add_spring(from as usize, to as usize, self.stiffness));
    }

    /// What the largest eigenvalue of the stiffness at full activation is at most, pN/µm: twice that of the fibres of one atom.
    pub fn largest_stiffness(&self) -> f64 {
        let mut ends: Vec<u32> = self.pairs.iter().flatten().copied().collect();
        ends.sort_unstable();
        let most = ends.chunk_by(|one, other| one == other).map(<[u32]>::len).max().unwrap_or(0);
        2.0 * self.stiffness * most as f64
    }
}
