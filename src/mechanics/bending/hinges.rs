//! Hinges on the edges of an open sheet.
//!
//! Every edge is a hinge between two facets whose normals make the angle θ. Its energy is eq. (bending.5),
//! `E = κ l²/(A₁ + A₂) (1 − cos(θ − θ₀))`, with the edge's length l and its facets' areas at rest. On a cylinder this is
//! Helfrich's `κ/2 ∫ c²` to discretisation error, on equilateral facets (where the factor is 2/√3, Seung & Nelson 1988) and
//! on rectangles cut in two. On any other shape it is Helfrich's with the Gaussian rigidity −4κ/3.
//! Only sines and cosines of θ enter, no angle; the gradient, eq. (bending.6), is exact.

use crate::Vec3;
use crate::geometry::Flap;
use crate::mechanics::hinge::{Hinge, HingeAtoms, hinge_atoms, rest_hinge};
use crate::mechanics::lanes::{Real, Vectors, VectorsMut};
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::mechanics::tangent::matrix::Blocks;

#[derive(Debug, Clone, Copy, PartialEq)]
struct RestedHinge {
    atoms: HingeAtoms,
    /// κ l²/(A₁ + A₂), pN·µm.
    rigidity: f64,
    cosine: f64,
    sine: f64,
}

/// The bending of a sheet, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hinges {
    hinges: Vec<RestedHinge>,
    /// Rows whose squares make the stiffness: the bending of the hinge, and the shear of a folded one.
    rows: Vec<[[f64; 4]; 2]>,
}

/// Squared lengths (µm²) and squared doubled areas (µm⁴) below this count as this.
const TINY: f64 = 1e-100;

impl Hinges {
    /// A skin of bending rigidity κ = `rigidity` (pN·µm) over the interior edges of a mesh with the rest positions `positions`
    /// (µm), free of stress at their angles or where it is flat.
    pub fn new(positions: &[Vec3], flaps: &[Flap], rigidity: f64, remembers: bool) -> Self {
        let mut made = Self { hinges: Vec::new(), rows: Vec::new() };
        for flap in flaps {
            let atoms = hinge_atoms(flap);
            let rest = rest_hinge(positions, atoms);
            let rigidity = rigidity * rest.length.powi(2) / (rest.areas[0] + rest.areas[1]);
            let (cosine, sine) = if remembers { (rest.cosine, rest.sine) } else { (1.0, 0.0) };
            made.hinges.push(RestedHinge { atoms, rigidity, cosine, sine });
            // With n₁, n₂ = c m ± s t: (c P + s Q)² ≤ c (c + s) P² + s (c + s) Q², P the sum and Q the difference of both rows.
            let half_cosine = (0.5 * (1.0 + rest.cosine)).max(0.0).sqrt();
            let half_sine = (0.5 * (1.0 - rest.cosine)).max(0.0).sqrt();
            let weight = |share: f64| (rigidity * share * (half_cosine + half_sine)).sqrt();
            let [on_c, on_d] = rest.rows;
            let row = |sign: f64, share: f64| [0, 1, 2, 3].map(|k| weight(share) * (on_c[k] + sign * on_d[k]));
            made.rows.push([row(1.0, half_cosine), row(-1.0, half_sine)]);
        }
        made
    }

    /// Adds the force on every atom, eq. (bending.6), and returns the energy, eq. (bending.5), pN·µm.
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
