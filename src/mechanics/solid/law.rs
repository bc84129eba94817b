//! Energies of a solid per volume at rest, by its deformation gradient F, eqs. (solids.2) to (solids.5).

use super::super::lanes::{Real, V3};
use super::principal::{Curvatures, Principal};
use crate::elementary::{exp, ln};

/// How the energy of a solid depends on its deformation. All have the same response to small strain: shear modulus µ and Lamé's λ, but for
/// the neo-Hookean one, which resists shear alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolidLaw {
    /// Linear in displacements, eq. (solids.2): `W = λ/2 tr²E + µ E:E` with E the symmetric part of F − I. It takes a turn for a strain.
    Linear,
    /// Linear in the strain that is left once the rotation R of F = R U is taken out, eq. (solids.3).
    Corotational,
    /// St Venant and Kirchhoff, eq. (solids.4): the same W with Green's strain ½ (FᵀF − I). It gives way when compressed far.
    StVenantKirchhoff,
    /// Neo-Hookean, of the shape alone, eq. (solids.5): `W = µ/2 (J^(−2/3) tr FᵀF − 3)` with J = det F.
    NeoHookean,
}

/// A law with its moduli, Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// The law.
    pub law: SolidLaw,
    /// Shear modulus µ, Pa.
    pub shear: f64,
    /// Lamé's λ, Pa; not used by the neo-Hookean law. −2µ/3 where changes of volume are resisted by something else.
    pub lame: f64,
}

impl Elastic {
    /// The energy, Pa, and the first Piola–Kirchhoff stress by columns, Pa, at a deformation gradient by its columns.
    #[inline(always)]
    pub fn stress<T: Real>(&self, token: T::Token, f: [V3<T>; 3]) -> (T, [V3<T>; 3]) {
        match self.law {
            SolidLaw::Linear => self.linear(f),
            SolidLaw::Corotational => self.corotational(token, f),
            SolidLaw::StVenantKirchhoff => self.st_venant_kirchhoff(f),
            SolidLaw::NeoHookean => self.neo_hookean(f),
        }
    }

    #[inline(always)]
    fn linear<T: Real>(&self, [f, g, h]: [V3<T>; 3]) -> (T, [V3<T>; 3]) {
        let (xx, yy, zz) = (f.x + -1.0, g.y + -1.0, h.z + -1.0);
        let (yz, zx, xy) = ((h.y + g.z) * 0.5, (f.z + h.x) * 0.5, (g.x + f.y) * 0.5);
        let trace = xx + yy + zz;
        let squares = xx * xx + yy * yy + zz * zz + (yz * yz + zx * zx + xy * xy) * 2.0;
        let (p, m) = (trace * self.lame, 2.0 * self.shear);
        (
            trace * p * 0.5 + squares * self.shear,
            [
                V3 { x: xx * m + p, y: xy * m, z: zx * m },
                V3 { x: xy * m, y: yy * m + p, z: yz * m },
                V3 { x: zx * m, y: yz * m, z: zz * m + p },
            ],
        )
    }

    #[inline(always)]
    fn corotational<T: Real>(&self, token: T::Token, f: [V3<T>; 3]) -> (T, [V3<T>; 3]) {
        let principal = Principal::of(token, f);
        let [r, s, t] = principal.rotation();
        let [a, b, c] = principal.stretches;
        let (u, v, w) = (a + -1.0, b + -1.0, c + -1.0);
        let trace = u + v + w;
        let (p, m) = (trace * self.lame, 2.0 * self.shear);
        let energy = trace * p * 0.5 + (u * u + v * v + w * w) * self.shear;
        let stress =
            [(f[0] - r).scaled(m) + r.times(p), (f[1] - s).scaled(m) + s.times(p), (f[2] - t).scaled(m) + t.times(p)];
        (energy, stress)
    }

    #[inline(always)]
    fn st_venant_kirchhoff<T: Real>(&self, [f, g, h]: [V3<T>; 3]) -> (T, [V3<T>; 3]) {
        let (xx, yy, zz) = ((f.squared() + -1.0) * 0.5, (g.squared() + -1.0) * 0.5, (h.squared() + -1.0) * 0.5);
        let (yz, zx, xy) = (g.dot(h) * 0.5, h.dot(f) * 0.5, f.dot(g) * 0.5);
        let trace = xx + yy + zz;
        let squares = xx * xx + yy * yy + zz * zz + (yz * yz + zx * zx + xy * xy) * 2.0;
        let (p, m) = (trace * self.lame, 2.0 * self.shear);
        (
            trace * p * 0.5 + squares * self.shear,
            [
                f.times(xx * m + p) + g.times(xy * m) + h.times(zx * m),
                f.times(xy * m) + g.times(yy * m + p) + h.times(yz * m),
                f.times(zx * m) + g.times(yz * m) + h.times(zz * m + p),
            ],
        )
    }

    #[inline(always)]
    fn neo_hookean<T: Real>(&self, [f, g, h]: [V3<T>; 3]) -> (T, [V3<T>; 3]) {
        let (p, q, r) = (g.cross(h), h.cross(f), f.cross(g));
        let (volume, first) = (f.dot(p), f.squared() + g.squared() + h.squared());
        let scale = volume.map(to_minus_two_thirds) * self.shear;
        let per = first / (volume * 3.0);
        let stress =
            [(f - p.times(per)).times(scale), (g - q.times(per)).times(scale), (h - r.times(per)).times(scale)];
        (first * scale * 0.5 + -1.5 * self.shear, stress)
    }

    /// How the energy bends with the principal stretches and with turns of their directions, Pa; the linear one, which knows no stretches,
    /// as the corotational one at rest.
    #[inline(always)]
    pub fn curvatures<T: Real>(&self, token: T::Token, [a, b, c]: [T; 3]) -> Curvatures<T> {
        let (lame, shear) = (self.lame, self.shear);
        let (aa, bb, cc) = (a * a, b * b, c * c);
        let (bc, ca, ab) = (b * c, c * a, a * b);
        match self.law {
            SolidLaw::Linear | SolidLaw::Corotational => {
                let (both, only) = (T::constant(token, lame), T::constant(token, lame + 2.0 * shear));
                let p = (a + b + c + -3.0) * (2.0 * lame) + -4.0 * shear;
                let least = T::constant(token, 1e-150);
                let flip = T::constant(token, 2.0 * shear);
                let [bc, ca, ab] = [(b + c).max(least), (c + a).max(least), (a + b).max(least)];
                Curvatures {
                    stretch: [[only; 3], [both; 3]],
                    twist: [p / bc + 2.0 * shear, p / ca + 2.0 * shear, p / ab + 2.0 * shear],
                    flip: [flip; 3],
                }
            }
            SolidLaw::StVenantKirchhoff => {
                let p = (aa + bb + cc + -3.0) * (0.5 * lame) + -shear;
                let m = lame + 3.0 * shear;
                Curvatures {
                    stretch: [[aa * m + p, bb * m + p, cc * m + p], [bc * lame, ca * lame, ab * lame]],
                    twist: [(bb + cc - bc) * shear + p, (cc + aa - ca) * shear + p, (aa + bb - ab) * shear + p],
                    flip: [(bb + cc + bc) * shear + p, (cc + aa + ca) * shear + p, (aa + bb + ab) * shear + p],
                }
            }
            SolidLaw::NeoHookean => {
                let third = T::constant(token, 1.0 / 3.0);
                let scale = (ab * c).map(to_minus_two_thirds) * shear;
                let first = (aa + bb + cc) * third;
                let of = [aa, bb, cc];
                let [p, q, r] = [first / bc, first / ca, first / ab];
                let mut stretch = [[scale; 3]; 2];
                for k in 0..3 {
                    stretch[0][k] = (first / of[k] * (5.0 / 3.0) - third) * scale;
                }
                stretch[1][0] = (p - b / c - c / b) * (scale * (2.0 / 3.0));
                stretch[1][1] = (q - c / a - a / c) * (scale * (2.0 / 3.0));
                stretch[1][2] = (r - a / b - b / a) * (scale * (2.0 / 3.0));
                Curvatures {
                    stretch,
                    twist: [(-p + 1.0) * scale, (-q + 1.0) * scale, (-r + 1.0) * scale],
                    flip: [(p + 1.0) * scale, (q + 1.0) * scale, (r + 1.0) * scale],
                }
            }
        }
    }

    /// What multiplies the Laplacian of the body so that it is nowhere less stiff than the law at small strain, Pa: no gradient u of displacements
    /// has λ tr²u + 2µ |sym u|² above (3λ + 2µ) |u|².
    pub fn bound(&self) -> f64 {
        let lame = if self.law == SolidLaw::NeoHookean { 0.0 } else { self.lame.max(0.0) };
        3.0 * lame + 2.0 * self.shear
    }
}

/// A ratio of volumes to the power −2/3; what is no volume has no number.
fn to_minus_two_thirds(ratio: f64) -> f64 {
    exp(ln(ratio) * (-2.0 / 3.0))
}
