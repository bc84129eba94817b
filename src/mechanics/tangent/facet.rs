//! How a facet deforms, and the positive part of the stiffness of an energy of its principal stretches.
//!
//! In the frame of its principal stretches the second derivatives of an isotropic energy by the deformation gradient fall apart into a
//! 2 × 2 block of both stretches, a twist and a flip in the plane, and a turn of each direction out of it; each is kept where it is
//! positive, eq. (step.10). After Smith, de Goes & Kim 2019, for surfaces.

use super::matrix::Block;
use crate::mechanics::lanes::{Real, V3};

/// Squared stretches below this have no direction.
const NOTHING: f64 = 1e-24;

/// The second derivatives of an energy by the principal stretches a ≥ b and by turns of their directions, pN/µm.
#[derive(Clone, Copy)]
pub struct Curvatures<T> {
    /// By a twice, by both, by b twice.
    pub stretch: [T; 3],
    /// Of turns of the deformation against the rest frame: (ψ_a + ψ_b)/(a + b).
    pub twist: T,
    /// Of shear at 45° to both directions: (ψ_a − ψ_b)/(a − b).
    pub flip: T,
    /// Of turns out of the plane of each: ψ_a/a and ψ_b/b.
    pub out: [T; 2],
}

impl<T: Real> Curvatures<T> {
    /// Without what is negative.
    #[inline(always)]
    pub fn positive(self, token: T::Token) -> Self {
        let (zero, tiny) = (T::constant(token, 0.0), T::constant(token, 1e-300));
        let [aa, ab, bb] = self.stretch;
        let (middle, half) = ((aa + bb) * 0.5, (aa - bb) * 0.5);
        let radius = (half * half + ab * ab).sqrt();
        let (large, small) = ((middle + radius).max(zero), (middle - radius).max(zero));
        let (middle, share) = ((large + small) * 0.5, (large - small) * 0.5 / radius.max(tiny));
        Self {
            stretch: [middle + half * share, ab * share, middle - half * share],
            twist: self.twist.max(zero),
            flip: self.flip.max(zero),
            out: [self.out[0].max(zero), self.out[1].max(zero)],
        }
    }
}

/// The deformation of a facet.
pub struct Stretched<T> {
    /// Principal stretches, the larger first.
    pub stretches: [T; 2],
    /// Their directions in space, and the normal.
    directions: [V3<T>; 3],
    /// How each atom takes part in both, 1/µm.
    parts: [[T; 2]; 3],
}

impl<T: Real> Stretched<T> {
    /// Measures the facet with the edges `u` and `v` from its first atom (µm), where `[[p, q], [0, r]]` takes edges at rest to a frame
    /// of unit vectors (1/µm).
    #[inline(always)]
    pub fn measure(token: T::Token, [u, v]: [V3<T>; 2], [p, q, r]: [f64; 3]) -> Self {
        let (zero, one, tiny) = (T::constant(token, 0.0), T::constant(token, 1.0), T::constant(token, NOTHING));
        let (f, g) = (u.scaled(p), u.scaled(q) + v.scaled(r));
        let (ff, fg, gg) = (f.squared(), f.dot(g), g.squared());
        let (middle, half) = ((ff + gg) * 0.5, (ff - gg) * 0.5);
        let radius = (half * half + fg * fg).sqrt();
        let per_radius = one / radius.max(tiny);
        // Half the angle of the first direction; where both stretches are alike any direction will do.
        let cosine = (half * per_radius * 0.5 + 0.5).max(zero).sqrt();
        let side = fg + 1e-300;
        let sine = (half * per_radius * -0.5 + 0.5).max(zero).sqrt() * (side / side.max(-side));
        // Without a radius both are √½, which is as good as any.
        let (a, b) = ((middle + radius).max(tiny).sqrt(), (middle - radius).max(tiny).sqrt());
        let long = (f.times(cosine) + g.times(sine)).times(one / a);
        let short = (g.times(cosine) - f.times(sine)).times(one / b);
        let on_b = [cosine * p + sine * q, cosine * q - sine * p];
        let on_c = [sine * r, cosine * r];
        let on_a = [-(on_b[0] + on_c[0]), -(on_b[1] + on_c[1])];
        Self { stretches: [a, b], directions: [long, short, long.cross(short)], parts: [on_a, on_b, on_c] }
    }

    /// The block of two atoms of the facet, for an energy per rest area with these second derivatives and this rest area, pN/µm.
    #[inline(always)]
    pub fn block(&self, i: usize, j: usize, of: &Curvatures<T>, area: f64) -> Block<T> {
        let ([a, b], [c, d]) = (self.parts[i], self.parts[j]);
        let [one, other, normal] = self.directions;
        let [aa, ab, bb] = of.stretch;
        let (sum, difference) = ((of.flip + of.twist) * 0.5, (of.flip - of.twist) * 0.5);
        let (ac, ad, bc, bd) = (a * c * area, a * d * area, b * c * area, b * d * area);
        let along = one.times(aa * ac + sum * bd) + other.times(ab * ad + difference * bc);
        let across = one.times(ab * bc + difference * ad) + other.times(bb * bd + sum * ac);
        let out = normal.times(of.out[0] * ac + of.out[1] * bd);
        let in_frame = [along, across, out];
        [
            row(in_frame, [one.x, other.x, normal.x]),
            row(in_frame, [one.y, other.y, normal.y]),
            row(in_frame, [one.z, other.z, normal.z]),
        ]
    }
}

/// A sum of three vectors with weights. (A closure in its place is not compiled for wide registers.)
#[inline(always)]
fn row<T: Real>([a, b, c]: [V3<T>; 3], [p, q, r]: [T; 3]) -> V3<T> {
    a.times(p) + b.times(q) + c.times(r)
}
