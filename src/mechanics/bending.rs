//! The resistance of a cell's skin to bending, from a rigidity that can be measured.
//!
//! Every edge is a hinge between two facets whose normals make the angle θ. Its energy is eq. (bending.1),
//! `E = κ l²/(A₁ + A₂) (1 − cos(θ − θ₀))`, with the edge's length l and its facets' areas at rest. On a cylinder this is
//! Helfrich's `κ/2 ∫ c²` to discretisation error, on equilateral facets (where the factor is 2/√3, Seung & Nelson 1988) and
//! on rectangles cut in two. On any other shape it is Helfrich's with the Gaussian rigidity −4κ/3, so on a closed
//! surface it differs from Helfrich's by the constant −16πκ/3 and has the same forces: a sphere has 8πκ − 16πκ/3 = 8πκ/3.
//! Only sines and cosines of θ enter, no angle; the gradient, eq. (bending.2), is exact.

use super::hinge::{Hinge, HingeAtoms, hinge_atoms, rest_hinge};
use super::lanes::{Real, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use super::tangent::matrix::Blocks;
use crate::Vec3;
use crate::geometry::Flap;

/// The angle θ₀ at which a hinge is free of stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RestAngle {
    /// The angle of the rest shape: a skin that remembers its curvature.
    #[default]
    Remembered,
    /// Flat: a lipid bilayer without spontaneous curvature.
    Flat,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct RestedHinge {
    atoms: HingeAtoms,
    /// κ l²/(A₁ + A₂), pN·µm.
    rigidity: f64,
    cosine: f64,
    sine: f64,
}

/// The bending of a mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Bending {
    hinges: Vec<RestedHinge>,
    /// Rows whose squares make the stiffness: the bending of the hinge, and the shear of a folded one.
    rows: Vec<[[f64; 4]; 2]>,
}

/// Squared lengths (µm²) and squared doubled areas (µm⁴) below this count as this.
const TINY: f64 = 1e-100;

impl Bending {
    /// A skin of bending rigidity κ = `rigidity` (pN·µm; a lipid bilayer has about 0.08 to 0.2) over the interior edges of
    /// a mesh with the rest positions `positions` (µm).
    pub fn new(positions: &[Vec3], flaps: &[Flap], rigidity: f64, rest_angle: RestAngle) -> Self {
        let mut bending = Self { hinges: Vec::new(), rows: Vec::new() };
        for flap in flaps {
            let atoms = hinge_atoms(flap);
            let rest = rest_hinge(positions, atoms);
            let rigidity = rigidity * rest.length.powi(2) / (rest.areas[0] + rest.areas[1]);
            let (cosine, sine) = match rest_angle {
                RestAngle::Remembered => (rest.cosine, rest.sine),
                RestAngle::Flat => (1.0, 0.0),
            };
            bending.hinges.push(RestedHinge { atoms, rigidity, cosine, sine });
            // With n₁, n₂ = c m ± s t: (c P + s Q)² ≤ c (c + s) P² + s (c + s) Q², P the sum and Q the difference of both rows.
            let half_cosine = (0.5 * (1.0 + rest.cosine)).max(0.0).sqrt();
            let half_sine = (0.5 * (1.0 - rest.cosine)).max(0.0).sqrt();
            let weight = |share: f64| (rigidity * share * (half_cosine + half_sine)).sqrt();
            let [on_c, on_d] = rest.rows;
            let row = |sign: f64, share: f64| [0, 1, 2, 3].map(|k| weight(share) * (on_c[k] + sign * on_d[k]));
            bending.rows.push([row(1.0, half_cosine), row(-1.0, half_sine)]);
        }
        bending
    }

    /// Adds the force on every atom, eq. (bending.2), and returns the energy, eq. (bending.1), pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for hinge in &self.hinges {
            let fold = Hinge::measure(x, hinge.atoms).fold(x.token, TINY);
            let cosine = fold.cosine * hinge.cosine + fold.sine * hinge.sine;
            let sine = fold.sine * hinge.cosine - fold.cosine * hinge.sine;
            energy += (-cosine + 1.0) * hinge.rigidity;
            fold.add_forces(f, hinge.atoms, sine * hinge.rigidity);
        }
        energy
    }

    /// Adds the tangent stiffness of each hinge against a change of its angle, eq. (step.10).
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        for hinge in &self.hinges {
            let fold = Hinge::measure(x, hinge.atoms).fold(x.token, TINY);
            let cosine = fold.cosine * hinge.cosine + fold.sine * hinge.sine;
            let weight = cosine.max(T::constant(x.token, 0.0)) * hinge.rigidity;
            blocks.add_square(hinge.atoms, fold.lifts(), weight);
        }
    }

    /// Adds an isotropic bound of the stiffness at rest: equal to it for a flat mesh.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        for (hinge, rows) in self.hinges.iter().zip(&self.rows) {
            for row in rows {
                for (i, left) in hinge.atoms.iter().zip(row) {
                    for (j, right) in hinge.atoms.iter().zip(row) {
                        matrix.add(*i as usize, *j as usize, left * right);
                    }
                }
            }
        }
    }
}
