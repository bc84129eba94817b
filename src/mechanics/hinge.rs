//! Two facets that share an edge, and the angle between them: what bending and the barrier against folding measure.

use super::lanes::{Real, V3, Vectors, VectorsMut};
use crate::Vec3;
use crate::geometry::Flap;

/// The edge (a, b) and the two atoms across it, c in the facet (a, b, c) and d in the facet (b, a, d).
pub(super) type HingeAtoms = [u32; 4];

/// The atoms of a flap.
pub(super) fn hinge_atoms(flap: &Flap) -> HingeAtoms {
    [flap.a, flap.b, flap.c, flap.d]
}

/// The edges and area vectors of a hinge in the current shape.
#[derive(Clone, Copy)]
pub(super) struct Hinge<T> {
    /// From a to b.
    pub edge: V3<T>,
    /// From a to c and from a to d.
    to_c: V3<T>,
    to_d: V3<T>,
    /// Twice the area vector of the facet on the left, and of the one on the right.
    left: V3<T>,
    right: V3<T>,
}

/// What a fold angle θ looks like: its cosine and sine, and what its gradient needs.
#[derive(Clone, Copy)]
pub(super) struct Fold<T> {
    /// cos θ.
    pub cosine: T,
    /// sin θ, positive where the surface is convex.
    pub sine: T,
    /// −∂θ/∂c and −∂θ/∂d, 1/µm.
    lift_c: V3<T>,
    lift_d: V3<T>,
    /// Where the feet of c and of d stand between a (0) and b (1).
    foot_c: T,
    foot_d: T,
}

impl<T: Real> Hinge<T> {
    /// Measures a hinge without any root or division.
    #[inline(always)]
    pub fn measure(x: &Vectors<T>, atoms: HingeAtoms) -> Self {
        let [a, b, c, d] = atoms.map(|atom| atom as usize);
        let origin = x.get(a);
        let (edge, to_c, to_d) = (x.get(b) - origin, x.get(c) - origin, x.get(d) - origin);
        Self { edge, to_c, to_d, left: edge.cross(to_c), right: to_d.cross(edge) }
    }

    /// |N₁| |N₂| cos θ, µm⁴.
    #[inline(always)]
    pub fn alignment(&self) -> T {
        self.left.dot(self.right)
    }

    /// The fold angle and its gradient, eq. (bending.6). `tiny` keeps a collapsed facet from dividing by zero.
    #[inline(always)]
    pub fn fold(&self, token: T::Token, tiny: f64) -> Fold<T> {
        let (one, tiny) = (T::constant(token, 1.0), T::constant(token, tiny));
        let squared = self.edge.squared().max(tiny);
        let length = squared.sqrt();
        let (left, right) = (self.left.squared().max(tiny), self.right.squared().max(tiny));
        let scale = one / (left * right).sqrt();
        let per_squared = one / squared;
        Fold {
            cosine: self.alignment() * scale,
            sine: self.left.cross(self.right).dot(self.edge) * scale / length,
            lift_c: self.left.times(length / left),
            lift_d: self.right.times(length / right),
            foot_c: self.to_c.dot(self.edge) * per_squared,
            foot_d: self.to_d.dot(self.edge) * per_squared,
        }
    }
}

impl<T: Real> Fold<T> {
    /// −∂θ/∂a, −∂θ/∂b, −∂θ/∂c and −∂θ/∂d, 1/µm.
    #[inline(always)]
    pub fn lifts(&self) -> [V3<T>; 4] {
        let on_b = self.lift_c.times(self.foot_c) + self.lift_d.times(self.foot_d);
        [on_b - (self.lift_c + self.lift_d), -on_b, self.lift_c, self.lift_d]
    }

    /// Adds the forces of an energy whose derivative by θ is `slope` (pN·µm).
    #[inline(always)]
    pub fn add_forces(&self, f: &mut VectorsMut<T>, atoms: HingeAtoms, slope: T) {
        let [a, b, c, d] = atoms.map(|atom| atom as usize);
        let (on_c, on_d) = (self.lift_c.times(slope), self.lift_d.times(slope));
        let on_b = on_c.times(self.foot_c) + on_d.times(self.foot_d);
        f.add(c, on_c);
        f.add(d, on_d);
        f.sub(b, on_b);
        f.sub(a, on_c + on_d - on_b);
    }
}

/// A hinge at rest, measured in set-up code.
pub(super) struct RestHinge {
    /// Length of the edge, µm.
    pub length: f64,
    /// Areas of both facets, µm².
    pub areas: [f64; 2],
    /// cos θ and sin θ.
    pub cosine: f64,
    pub sine: f64,
    /// How c's and d's distances from the edge change with the displacement of a, b, c, d along the normals, 1/µm:
    /// −δθ = c's row + d's row when the facets are flat.
    pub rows: [[f64; 4]; 2],
}

/// Measures a hinge at rest.
pub(super) fn rest_hinge(positions: &[Vec3], atoms: HingeAtoms) -> RestHinge {
    let [a, b, c, d] = atoms.map(|atom| positions[atom as usize]);
    let (edge, to_c, to_d) = (b - a, c - a, d - a);
    let (left, right) = (edge.cross(&to_c), to_d.cross(&edge));
    let length = edge.norm();
    let (n1, n2) = (left.normalize(), right.normalize());
    let (foot_c, foot_d) = (to_c.dot(&edge) / length.powi(2), to_d.dot(&edge) / length.powi(2));
    let (lift_c, lift_d) = (length / left.norm(), length / right.norm());
    RestHinge {
        length,
        areas: [0.5 * left.norm(), 0.5 * right.norm()],
        cosine: n1.dot(&n2),
        sine: n1.cross(&n2).dot(&edge) / length,
        rows: [
            [-(1.0 - foot_c) * lift_c, -foot_c * lift_c, lift_c, 0.0],
            [-(1.0 - foot_d) * lift_d, -foot_d * lift_d, 0.0, lift_d],
        ],
    }
}
