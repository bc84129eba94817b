//! Surface tension, and the reluctance of a cell's whole surface to change its area while it flows freely within.
//!
//! Tension is an energy per current area, eq. (tension.1); the total-area energy, eq. (tension.2), is that of lipids
//! that move freely over the cell, so that only the sum over all facets counts. Together they pull like one tension
//! `γ + k (A − A₀)/A₀`, the same everywhere on a cell, eq. (tension.3).

use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::membrane::{add_cotangents, half_cotangents};
use super::stiffness::StiffnessMatrix;
use super::tangent::matrix::Blocks;
use crate::Vec3;

/// The tension of a closed or open surface, ready for all cells that share its mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Tension {
    tension: f64,
    total_area: f64,
    rest_area: f64,
    facets: Vec<[u32; 3]>,
    cotangents: Vec<[f64; 3]>,
}

/// A facet's smallest doubled area, µm²: below it the direction of its normal is not defined and it pulls no more.
const NO_AREA: f64 = 1e-100;

impl Tension {
    /// `tension` γ in pN/µm, and `total_area`, the modulus k (pN/µm) against a change of the summed area from that
    /// of `rest_positions` (µm); each may be 0.
    pub fn new(rest_positions: &[Vec3], facets: &[[u32; 3]], tension: f64, total_area: f64) -> Self {
        let area = |&facet: &[u32; 3]| {
            let [a, b, c] = facet.map(|i| rest_positions[i as usize]);
            0.5 * (b - a).cross(&(c - a)).norm()
        };
        Self {
            tension,
            total_area,
            rest_area: facets.iter().map(area).sum(),
            facets: facets.to_vec(),
            cotangents: facets.iter().map(|&facet| half_cotangents(rest_positions, facet)).collect(),
        }
    }

    /// The rest area A₀ of the whole surface, µm².
    pub fn rest_area(&self) -> f64 {
        self.rest_area
    }

    /// Adds the force on every atom, eq. (tension.3), and returns the energy, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut doubled = T::constant(x.token, 0.0);
        for &facet in &self.facets {
            doubled += area_vector(x, facet).2.squared().sqrt();
        }
        let area = doubled * 0.5;
        let excess = area + -self.rest_area;
        let relative = excess * (self.total_area / self.rest_area);
        // ∂A/∂b = ½ (c − a) × n and ∂A/∂c = ½ n × (b − a).
        let pull = (relative + self.tension) * 0.5;
        for &facet in &self.facets {
            let (u, v, normal) = area_vector(x, facet);
            let length = normal.squared().sqrt().max(T::constant(x.token, NO_AREA));
            let normal = normal.times(pull / length);
            let on_b = normal.cross(v);
            let on_c = u.cross(normal);
            f.add(facet[1] as usize, on_b);
            f.add(facet[2] as usize, on_c);
            f.sub(facet[0] as usize, on_b + on_c);
        }
        area * self.tension + relative * excess * 0.5
    }

    /// Whether it has a tangent stiffness: the modulus of the total area has none that is sparse.
    pub fn has_tangent(&self) -> bool {
        self.total_area == 0.0
    }

    /// Adds the tangent stiffness of a positive tension against motion along the normals, eq. (step.10): along a flat surface it has none.
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        let tiny = T::constant(x.token, NO_AREA);
        for &facet in &self.facets {
            let (u, v, normal) = area_vector(x, facet);
            let doubled = normal.squared().sqrt().max(tiny);
            let n = normal.times(T::constant(x.token, 1.0) / doubled);
            let weight = T::constant(x.token, 0.5 * self.tension.max(0.0)) / doubled;
            blocks.add_tension(facet, [v - u, -v, u], n, weight);
        }
    }

    /// Adds (γ + 5k/4) times the cotangent Laplacian of the rest shape: exact for a tension on a nearly flat surface. When every
    /// facet dilates alike the total area resists with 8/5 of that, below the 2 at which a linearly implicit step fails.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        for (&facet, &cotangents) in self.facets.iter().zip(&self.cotangents) {
            add_cotangents(matrix, facet, cotangents, self.tension.max(0.0) + 1.25 * self.total_area);
        }
    }
}

/// Two edges of a facet from its first atom, and their cross product.
#[inline(always)]
fn area_vector<T: Real>(x: &Vectors<T>, facet: [u32; 3]) -> (V3<T>, V3<T>, V3<T>) {
    let a = x.get(facet[0] as usize);
    let u = x.get(facet[1] as usize) - a;
    let v = x.get(facet[2] as usize) - a;
    (u, v, u.cross(v))
}
