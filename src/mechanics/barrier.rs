//! The barrier that keeps facets from collapsing and from folding onto each other, and else does nothing.
//!
//! Its energy is eq. (barrier.1), `E = e Σ b(s)` with `b(s) = (1 − s)³/s` below s = 1 and nothing above: smooth to the
//! second derivative at 1, infinite at 0. For a facet s is its area over a share of its rest area; for an edge s is
//! cos²(θ/2) over its value at the fold angle where the barrier begins, eq. (barrier.2). Shape memory, springs and
//! bending all have finite energy in a collapsed or folded facet; this is what stops them.

use super::hinge::{Hinge, HingeAtoms, hinge_atoms, rest_hinge};
use super::lanes::{Real, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;
use crate::geometry::Flap;

/// Where the barrier begins and how strong it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarrierRules {
    /// Energy scale e, pN·µm. A good value is the elastic energy that could collapse a facet.
    pub energy: f64,
    /// The share of its rest area below which a facet resists, between 0 and 1.
    pub area_share: f64,
    /// The angle between the normals of two neighbours above which they resist, rad, between 0 and π.
    pub fold_angle: f64,
}

impl BarrierRules {
    /// Facets resist below a fifth of their rest area and beyond a fold of 140°: far outside ordinary deformation, yet
    /// early enough that a step of ordinary size meets the barrier before it has jumped over it.
    pub fn with_energy(energy: f64) -> Self {
        Self { energy, area_share: 0.2, fold_angle: 140f64.to_radians() }
    }
}

/// The barrier of a mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Barrier {
    energy: f64,
    /// Atoms of each facet and the squared doubled area (µm⁴) where the barrier begins.
    facets: Vec<([u32; 3], f64)>,
    /// Atoms of each hinge and cos²(θ/2) where the barrier begins.
    hinges: Vec<(HingeAtoms, f64)>,
}

/// Smallest s that is told from zero: b stays finite, about 10⁸.
const LEAST: f64 = 1e-8;

/// Squared doubled areas (µm⁴) and squared lengths (µm²) below this count as this.
const TINY: f64 = 1e-100;

/// An edge's barrier never begins above this share of its rest value, so that sharp edges rest in peace.
const SHARE_OF_REST: f64 = 0.5;

impl Barrier {
    /// The barrier of a mesh with the rest positions `positions` (µm).
    pub fn new(positions: &[Vec3], facets: &[[u32; 3]], flaps: &[Flap], rules: BarrierRules) -> Self {
        let facet_bound = |&facet: &[u32; 3]| {
            let [a, b, c] = facet.map(|i| positions[i as usize]);
            (facet, (b - a).cross(&(c - a)).norm_squared() * rules.area_share.powi(2))
        };
        let hinge_bound = |flap: &Flap| {
            let atoms = hinge_atoms(flap);
            let rest = 0.5 * (1.0 + rest_hinge(positions, atoms).cosine);
            (atoms, (0.5 * rules.fold_angle).cos().powi(2).min(SHARE_OF_REST * rest))
        };
        Self {
            energy: rules.energy,
            facets: facets.iter().map(facet_bound).collect(),
            // An edge that rests folded flat has no side to be kept on.
            hinges: flaps.iter().map(hinge_bound).filter(|&(_, bound)| bound > LEAST).collect(),
        }
    }

    /// Adds the force on every atom and returns the energy, eq. (barrier.1), pN·µm: exactly 0 in ordinary deformation.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for &(facet, bound) in &self.facets {
            let [a, b, c] = facet.map(|atom| atom as usize);
            let origin = x.get(a);
            let (u, v) = (x.get(b) - origin, x.get(c) - origin);
            let normal = u.cross(v);
            let squared = normal.squared();
            if !squared.any_less(bound) {
                continue;
            }
            // s² = |N|²/bound, so ∂s/∂b = (c − a) × N / (s bound).
            let s = share(x.token, (squared * (1.0 / bound)).sqrt());
            let (height, slope) = barrier(x.token, s);
            energy += height * self.energy;
            let normal = normal.times(slope / s * (self.energy / bound));
            let on_b = normal.cross(v);
            let on_c = u.cross(normal);
            f.add(b, on_b);
            f.add(c, on_c);
            f.sub(a, on_b + on_c);
        }
        for &(atoms, bound) in &self.hinges {
            let hinge = Hinge::measure(x, atoms);
            // The barrier begins beyond a right angle at the earliest, since the bound is at most one half.
            if !hinge.alignment().any_less(0.0) {
                continue;
            }
            let fold = hinge.fold(x.token, TINY);
            let s = (fold.cosine + 1.0) * (0.5 / bound);
            if !s.any_less(1.0) {
                continue;
            }
            let (height, slope) = barrier(x.token, share(x.token, s));
            energy += height * self.energy;
            fold.add_forces(f, atoms, slope * fold.sine * (-0.5 * self.energy / bound));
        }
        energy
    }

    /// Adds nothing: at rest the barrier does not act.
    pub fn add_stiffness(&self, _matrix: &mut StiffnessMatrix) {}
}

/// Keeps s between the least that is told from zero and 1, where the barrier and its slope vanish.
#[inline(always)]
fn share<T: Real>(token: T::Token, s: T) -> T {
    s.max(T::constant(token, LEAST)).min(T::constant(token, 1.0))
}

/// b(s) and b'(s) = −(1 − s)²(1 + 2s)/s².
#[inline(always)]
fn barrier<T: Real>(token: T::Token, s: T) -> (T, T) {
    let per_s = T::constant(token, 1.0) / s;
    let left = -s + 1.0;
    let squared = left * left * per_s;
    (squared * left, -(squared * per_s * (s * 2.0 + 1.0)))
}
