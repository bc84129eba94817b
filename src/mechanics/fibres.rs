//! Contractile fibres: bundles of actomyosin that draw the atoms at their ends together, as far as they are active.
//!
//! `F = A K (X_b − X_a)` on atom a and its opposite on b, eq. (fibres.1); Promayon 2008 and MODEL.md §4. A fibre has no length of
//! its own: relaxed it does nothing, and active it pulls with a force in proportion to its length.

use super::course::Course;
use super::lanes::LANES;
use super::stiffness::StiffnessMatrix;

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
    /// Adds the forces on the atoms of a block (pN) and adds the energy of each lane (pN·µm); `activation` is that of each
    /// lane.
    pub fn add_forces(&self, lanes: usize, activation: &[f64; LANES], x: &[f64], f: &mut [f64], energy: &mut [f64]) {
        for &[from, to] in &self.pairs {
            for axis in 0..3 {
                let [from, to] = [from, to].map(|atom| (3 * atom as usize + axis) * lanes);
                for lane in 0..lanes {
                    let along = x[to + lane] - x[from + lane];
                    let pull = activation[lane] * self.stiffness * along;
                    f[from + lane] += pull;
                    f[to + lane] -= pull;
                    energy[lane] += 0.5 * pull * along;
                }
            }
        }
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
