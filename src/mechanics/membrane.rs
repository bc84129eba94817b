//! The skin of a cell as an elastic sheet: it resists shear and change of area, measured from its rest shape.
//!
//! Every facet is a constant-strain triangle. With the metric g of its current edges and the metric G of its rest
//! edges, `I = tr(G⁻¹g) = λ₁² + λ₂²` and `D = det g / det G = (λ₁λ₂)²`, eq. (membrane.1), so that a law W(I, D) and its
//! gradient need no principal directions and nothing is divided by zero at rest. The energy is the rest area times W;
//! the force is its exact gradient, eq. (membrane.2). All laws have the same small-strain response: shear modulus µ
//! and area modulus K. Sources: Skalak, Tözeren, Zarda & Chien 1973; Evans & Skalak 1980; Mills et al. 2004.

use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use super::tangent::facet::{Curvatures, Stretched};
use super::tangent::matrix::Blocks;
use crate::Vec3;

/// How the energy of a membrane depends on its two principal stretches; moduli in pN/µm (= µN/m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MembraneLaw {
    /// Skalak's law, eq. (membrane.3): `W = µ/4 (I₁² + 2 I₁ − 2 I₂) + B/4 I₂²` with `I₁ = I − 2`, `I₂ = D − 1` and
    /// `B = (K − µ)/2`, which is `C µ` in Skalak's letters (K = µ(1 + 2C)). It stiffens with stretch. Needs K > µ.
    Skalak {
        /// Shear modulus µ, pN/µm.
        shear: f64,
        /// Area modulus K, pN/µm, above µ.
        area: f64,
    },
    /// Two-dimensional neo-Hookean law, eq. (membrane.4): `W = µ/2 s + h µ s³ + K/2 (J − 1)²` with `J = √D` and
    /// `s = I/J − 2`, the pure shear. On a membrane that keeps its area it is the law of Mills et al. 2004, whose
    /// third-order term is `hardening` = 1/30 (`C = G₀/30`).
    NeoHookean {
        /// Shear modulus µ, pN/µm.
        shear: f64,
        /// Area modulus K, pN/µm.
        area: f64,
        /// Coefficient h of the third-order term, in units of µ; 0 for none.
        hardening: f64,
    },
}

impl MembraneLaw {
    /// Small-strain shear modulus µ, pN/µm.
    pub fn shear(&self) -> f64 {
        match *self {
            Self::Skalak { shear, .. } | Self::NeoHookean { shear, .. } => shear,
        }
    }

    /// Small-strain area modulus K, pN/µm.
    pub fn area(&self) -> f64 {
        match *self {
            Self::Skalak { area, .. } | Self::NeoHookean { area, .. } => area,
        }
    }

    /// A bound of the second derivatives of W by the deformation gradient at these principal stretches, pN/µm: in the
    /// plane, and across it (tension over stretch). Differences of the density stand in for its second derivatives.
    fn stiffness_at(&self, long: f64, short: f64) -> f64 {
        // A collapsed facet is the barrier's matter.
        let (long, short) = (long.max(0.1), short.max(0.1));
        let density = |a: f64, b: f64| self.energy_density((), a * a + b * b, (a * b).powi(2)).0;
        let h = 1e-3;
        let (here, twice) = (density(long, short), h * h);
        let along = [(h, 0.0), (0.0, h)].map(|(a, b)| {
            let (more, less) = (density(long + a, short + b), density(long - a, short - b));
            ((more - 2.0 * here + less) / twice, (more - less) / (2.0 * h))
        });
        let both = density(long + h, short + h) - density(long + h, short - h) - density(long - h, short + h)
            + density(long - h, short - h);
        let mixed = (both / (4.0 * twice)).abs();
        let across = (along[0].1 / long).max(along[1].1 / short);
        (along[0].0.abs().max(along[1].0.abs()) + mixed).max(across)
    }

    /// The second derivatives of W by I twice, by I and D, and by D twice, pN/µm.
    #[inline(always)]
    fn second_derivatives<T: Real>(&self, token: T::Token, i: T, d: T) -> [T; 3] {
        match *self {
            Self::Skalak { shear, area } => [0.5 * shear, 0.0, 0.25 * (area - shear)].map(|c| T::constant(token, c)),
            Self::NeoHookean { shear, area, hardening } => {
                let per_j = T::constant(token, 1.0) / d.sqrt();
                let (s, per_d) = (i * per_j + -2.0, per_j * per_j);
                let slope = s * s * (3.0 * hardening * shear) + 0.5 * shear;
                let bend = s * (6.0 * hardening * shear);
                let half = i * per_d * 0.5;
                [
                    bend * per_d,
                    -((slope * per_j * 0.5 + bend * half) * per_d),
                    (bend * half * half + slope * half * per_j * 1.5 + per_j * (0.25 * area)) * per_d,
                ]
            }
        }
    }

    /// How W bends with the principal stretches and with turns of their directions.
    #[inline(always)]
    fn curvatures<T: Real>(&self, token: T::Token, [a, b]: [T; 2]) -> Curvatures<T> {
        let (aa, bb, j) = (a * a, b * b, a * b);
        let (i, d) = (aa + bb, j * j);
        let (_, by_i, by_d) = self.energy_density(token, i, d);
        let [ii, id, dd] = self.second_derivatives(token, i, d);
        let derivatives = [by_i, by_d, ii, id, dd];
        let mixed = (by_d + ii + id * (aa + bb) + dd * d) * j * 4.0;
        Curvatures {
            stretch: [by_stretch_twice(derivatives, a, bb), mixed, by_stretch_twice(derivatives, b, aa)],
            twist: (by_i + by_d * j) * 2.0,
            flip: (by_i - by_d * j) * 2.0,
            out: [(by_i + by_d * bb) * 2.0, (by_i + by_d * aa) * 2.0],
        }
    }

    /// W and its derivatives by I and by D, pN/µm.
    #[inline(always)]
    fn energy_density<T: Real>(&self, token: T::Token, i: T, d: T) -> (T, T, T) {
        match *self {
            Self::Skalak { shear, area } => {
                let dilation = 0.5 * (area - shear);
                let (i1, i2) = (i + -2.0, d + -1.0);
                let w = (i1 * i1 + (i1 - i2) * 2.0) * (0.25 * shear) + i2 * i2 * (0.25 * dilation);
                (w, (i1 + 1.0) * (0.5 * shear), i2 * (0.5 * dilation) + -0.5 * shear)
            }
            Self::NeoHookean { shear, area, hardening } => {
                let j = d.sqrt();
                let per_j = T::constant(token, 1.0) / j;
                let s = i * per_j + -2.0;
                let stretch = j + -1.0;
                let cubic = s * s * (hardening * shear);
                let slope = cubic * 3.0 + 0.5 * shear;
                let w = s * (cubic + 0.5 * shear) + stretch * stretch * (0.5 * area);
                let by_j = stretch * area - slope * i * per_j * per_j;
                (w, slope * per_j, by_j * per_j * 0.5)
            }
        }
    }
}

/// The second derivative of W by the stretch a, which has ∂I/∂a = 2a and ∂D/∂a = 2a b², from those by I and D. (A closure in its place is
/// not compiled for wide registers.)
#[inline(always)]
fn by_stretch_twice<T: Real>([by_i, by_d, ii, id, dd]: [T; 5], a: T, bb: T) -> T {
    let (on_i, on_d) = (a * 2.0, a * bb * 2.0);
    by_i * 2.0 + by_d * bb * 2.0 + (ii * on_i + id * on_d * 2.0) * on_i + dd * on_d * on_d
}

/// A facet at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RestFacet {
    atoms: [u32; 3],
    /// Inverse rest metric G⁻¹ (11, 12, 22), µm⁻².
    inverse: [f64; 3],
    /// 1 / det G, µm⁻⁴.
    inverse_determinant: f64,
    /// Rest area, µm².
    area: f64,
}

/// The membrane of a mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Membrane {
    law: MembraneLaw,
    facets: Vec<RestFacet>,
    /// Half the cotangents of the corners of each facet at rest.
    cotangents: Vec<[f64; 3]>,
}

impl Membrane {
    /// A membrane that is free of stress when its atoms stand at `rest_positions` (µm), which need not be where a
    /// cell starts. Every facet must have an area at rest, as the checks of geometry assure.
    pub fn new(rest_positions: &[Vec3], facets: &[[u32; 3]], law: MembraneLaw) -> Self {
        let rest = |&atoms: &[u32; 3]| {
            let [a, b, c] = atoms.map(|i| rest_positions[i as usize]);
            let (u, v) = (b - a, c - a);
            let (uu, uv, vv) = (u.dot(&u), u.dot(&v), v.dot(&v));
            let determinant = u.cross(&v).norm_squared();
            RestFacet {
                atoms,
                inverse: [vv / determinant, -uv / determinant, uu / determinant],
                inverse_determinant: 1.0 / determinant,
                area: 0.5 * determinant.sqrt(),
            }
        };
        Self {
            law,
            facets: facets.iter().map(rest).collect(),
            cotangents: facets.iter().map(|&facet| half_cotangents(rest_positions, facet)).collect(),
        }
    }

    /// The law and its moduli.
    pub fn law(&self) -> MembraneLaw {
        self.law
    }

    /// Adds the elastic force on every atom, eq. (membrane.2), and returns the energy, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for facet in &self.facets {
            let [a, b, c] = facet.atoms.map(|atom| atom as usize);
            let (stored, [on_b, on_c]) = self.of_facet(facet, x);
            energy += stored;
            f.sub(b, on_b);
            f.sub(c, on_c);
            f.add(a, on_b + on_c);
        }
        energy
    }

    /// The energy of a facet, pN·µm, and its derivatives by where its second and third atom are, pN.
    #[inline(always)]
    fn of_facet<T: Real>(&self, facet: &RestFacet, x: &Vectors<T>) -> (T, [V3<T>; 2]) {
        let [a, b, c] = facet.atoms.map(|atom| atom as usize);
        let origin = x.get(a);
        let (u, v) = (x.get(b) - origin, x.get(c) - origin);
        let (uu, uv, vv) = (u.squared(), u.dot(v), v.squared());
        let [g11, g12, g22] = facet.inverse;
        let i = uu * g11 + uv * (2.0 * g12) + vv * g22;
        let d = (uu * vv - uv * uv) * facet.inverse_determinant;
        let (w, by_i, by_d) = self.law.energy_density(x.token, i, d);
        // ∂W/∂u = 2 W_I (g11 u + g12 v) + 2 W_D (vv u − uv v)/det G, and the same for v.
        let by_i = by_i * (2.0 * facet.area);
        let by_d = by_d * (2.0 * facet.area * facet.inverse_determinant);
        let across = by_i * g12 - by_d * uv;
        let on_b = u.times(by_i * g11 + by_d * vv) + v.times(across);
        let on_c = v.times(by_i * g22 + by_d * uu) + u.times(across);
        (w * facet.area, [on_b, on_c])
    }

    /// Adds what one cell's membrane does more than with its own moduli where atoms have factors of them, eq. (membrane.6), `whole` times,
    /// and returns the energy of that, pN·µm.
    pub fn add_excess(&self, whole: f64, factors: &[f64], x: &Vectors<f64>, f: &mut VectorsMut<f64>) -> f64 {
        let mut energy = 0.0;
        for facet in &self.facets {
            let [a, b, c] = facet.atoms.map(|atom| atom as usize);
            let excess = whole * ((factors[a] + factors[b] + factors[c]) / 3.0 - 1.0);
            if excess == 0.0 {
                continue;
            }
            let (stored, [on_b, on_c]) = self.of_facet(facet, x);
            energy += excess * stored;
            f.sub(b, on_b.scaled(excess));
            f.sub(c, on_c.scaled(excess));
            f.add(a, (on_b + on_c).scaled(excess));
        }
        energy
    }

    /// Adds the tangent stiffness of each facet, without what is negative of it, eq. (step.10).
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        for facet in &self.facets {
            let [a, b, c] = facet.atoms;
            let corner = [x.get(a as usize), x.get(b as usize), x.get(c as usize)];
            let sides = [corner[1] - corner[0], corner[2] - corner[0]];
            let stretched = Stretched::measure(x.token, sides, facet.frame());
            let bent = self.law.curvatures(x.token, stretched.stretches).positive(x.token);
            for i in 0..3 {
                for j in 0..=i {
                    blocks.add(facet.atoms[i], facet.atoms[j], stretched.block(i, j, &bent, facet.area));
                }
            }
        }
    }

    /// Adds (µ + K) times the cotangent Laplacian of the rest shape: the stiffness against a longitudinal wave in the
    /// plane, and at least half of any facet's own small-strain stiffness. A facet that is stretched in the shape
    /// `x` counts as many times more as its law is stiffer there.
    pub fn add_stiffness(&self, x: &[Vec3], matrix: &mut StiffnessMatrix) {
        let modulus = self.law.shear() + self.law.area();
        let at_rest = self.law.stiffness_at(1.0, 1.0);
        for (facet, cotangents) in self.facets.iter().zip(&self.cotangents) {
            let [long, short] = facet.stretches(x);
            let stiffer = (self.law.stiffness_at(long, short) / at_rest).max(1.0);
            add_cotangents(matrix, facet.atoms, *cotangents, stiffer * modulus);
        }
    }
}

impl RestFacet {
    /// The matrix [[p, q], [0, r]] that takes its edges at rest to a frame of unit vectors, 1/µm.
    #[inline(always)]
    fn frame(&self) -> [f64; 3] {
        let [g11, g12, g22] = self.inverse;
        let r = g22.sqrt();
        let q = g12 / r;
        [(g11 - q * q).max(0.0).sqrt(), q, r]
    }

    /// Principal stretches of the facet in the shape `x`.
    fn stretches(&self, x: &[Vec3]) -> [f64; 2] {
        let [a, b, c] = self.atoms.map(|atom| x[atom as usize]);
        let (u, v) = (b - a, c - a);
        let [g11, g12, g22] = self.inverse;
        let half = 0.5 * (u.dot(&u) * g11 + 2.0 * u.dot(&v) * g12 + v.dot(&v) * g22);
        let d = u.cross(&v).norm_squared() * self.inverse_determinant;
        let apart = (half * half - d).max(0.0).sqrt();
        [(half + apart).sqrt(), (half - apart).max(0.0).sqrt()]
    }
}

/// Half the cotangents of a facet's three corners.
pub(super) fn half_cotangents(positions: &[Vec3], facet: [u32; 3]) -> [f64; 3] {
    let corner = facet.map(|i| positions[i as usize]);
    [0, 1, 2].map(|k| {
        let (u, v) = (corner[(k + 1) % 3] - corner[k], corner[(k + 2) % 3] - corner[k]);
        0.5 * u.dot(&v) / u.cross(&v).norm()
    })
}

/// Adds a facet's share of `modulus` (pN/µm) times the cotangent Laplacian.
pub(super) fn add_cotangents(matrix: &mut StiffnessMatrix, facet: [u32; 3], cotangents: [f64; 3], modulus: f64) {
    for k in 0..3 {
        let (i, j) = (facet[(k + 1) % 3] as usize, facet[(k + 2) % 3] as usize);
        matrix.add_spring(i, j, modulus * cotangents[k]);
    }
}
