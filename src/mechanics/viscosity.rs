//! How a membrane resists being deformed at a rate, as a sheet of a fluid does: with its surface viscosities, eq. (viscosity.1).
//!
//! On a facet whose atoms move at v the rate of deformation is constant, D = sym(P Σ v_i ⊗ g_i), with P the projection on the facet and g_i the
//! gradient of the weight of an atom on it. The power that is lost is that of Boussinesq and Scriven, `A (κ tr²D + 2 η |dev D|²)`, and the force
//! −V(x) v half of its gradient by v. V is symmetric, has no negative eigenvalue and nothing to say to rigid motion, so that these forces have
//! neither sum nor torque. What fills a body may be viscous, too, see [`inside`]. A drop with such a surface lets its shapes go at the rates of eq. (viscosity.6), which tests hold. Sources: Scriven 1960; Evans & Hochmuth 1976.

pub mod inside;

use super::lanes::{BlockWork, Real, V3, Vectors, VectorsMut, dispatch};
use super::tangent::matrix::Blocks;
use inside::Inside;

/// A facet's smallest doubled area, µm²: below it the plane in which it resists is not defined.
const NO_AREA: f64 = 1e-100;

/// The viscosity of a membrane and of what it encloses, ready for all cells that share its mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Viscosity {
    facets: Vec<[u32; 3]>,
    /// Surface viscosity η against shear, pN·s/µm.
    shear: f64,
    /// Surface viscosity κ against dilation, pN·s/µm.
    area: f64,
    /// What fills the body.
    inside: Option<Inside>,
}

/// A facet as its viscosity sees it.
struct Seen<T> {
    /// Gradients of the weights of its atoms, 1/µm.
    gradients: [V3<T>; 3],
    /// Its unit normal.
    normal: V3<T>,
    /// Its area, µm².
    area: T,
}

impl<T: Real> Seen<T> {
    #[inline(always)]
    fn new(token: T::Token, [a, b, c]: [V3<T>; 3]) -> Self {
        let (bc, ca, ab) = (c - b, a - c, b - a);
        let normal = ca.cross(ab);
        let doubled = normal.squared().sqrt().max(T::constant(token, NO_AREA));
        let per = T::constant(token, 1.0) / doubled;
        let normal = normal.times(per);
        let across = normal.times(per);
        Self { gradients: [across.cross(bc), across.cross(ca), across.cross(ab)], normal, area: doubled * 0.5 }
    }

    /// What of a vector lies in the plane of the facet.
    #[inline(always)]
    fn within(&self, v: V3<T>) -> V3<T> {
        v - self.normal.times(v.dot(self.normal))
    }
}

impl Viscosity {
    /// Of a membrane with these facets: surface viscosities against shear and against dilation, pN·s/µm; each may be 0.
    pub fn new(facets: &[[u32; 3]], shear: f64, area: f64) -> Self {
        let is_any = shear > 0.0 || area > 0.0;
        Self { facets: if is_any { facets.to_vec() } else { Vec::new() }, shear, area, inside: None }
    }

    /// The same, filled with what is viscous.
    pub fn with_inside(self, inside: Inside) -> Self {
        Self { inside: Some(inside), ..self }
    }

    /// What fills the body.
    pub fn inside(&self) -> Option<&Inside> {
        self.inside.as_ref()
    }

    /// The pairs of atoms that it ties, some more than once.
    pub fn pairs(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let of_facets = self.facets.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let of_tetrahedra = self.inside.iter().flat_map(|inside| inside.tetrahedra());
        of_facets.chain(of_tetrahedra.flat_map(|&[a, b, c, d]| [[a, b], [b, c], [c, a], [a, d], [b, d], [c, d]]))
    }

    /// Adds `factor` times V(x) v to `f`, where atoms at `x` (µm) move by `v`, for a block of `lanes` cells: pN for v in µm/s and a factor of 1.
    pub fn add_to(&self, lanes: usize, factor: f64, [x, v]: [&[f64]; 2], f: &mut [f64]) {
        dispatch(lanes, Apply { viscosity: self, factor, x, v, f });
    }

    /// Adds `factor` times V(x) to the blocks of a matrix.
    #[inline(always)]
    pub fn add_blocks<T: Real>(&self, factor: f64, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        for facet in &self.facets {
            let seen = Seen::new(x.token, corners(x, facet));
            let (n, area) = (seen.normal, seen.area * factor);
            let (shear, between) = (area * self.shear, area * (self.area - self.shear));
            for i in 0..3 {
                for j in 0..=i {
                    let (of_i, of_j) = (seen.gradients[i], seen.gradients[j]);
                    let along = of_i.dot(of_j) * shear;
                    let rows = [
                        row([of_i, of_j, n], [of_j.x * shear, of_i.x * between, -(n.x * along)], along, 0),
                        row([of_i, of_j, n], [of_j.y * shear, of_i.y * between, -(n.y * along)], along, 1),
                        row([of_i, of_j, n], [of_j.z * shear, of_i.z * between, -(n.z * along)], along, 2),
                    ];
                    blocks.add(facet[i], facet[j], rows);
                }
            }
        }
        if let Some(inside) = &self.inside {
            inside.add_blocks(factor, x, blocks);
        }
    }
}

/// The vectors of the atoms of a facet. (A closure in its place is not compiled for wide registers.)
#[inline(always)]
fn corners<T: Real>(values: &Vectors<T>, [a, b, c]: &[u32; 3]) -> [V3<T>; 3] {
    [values.get(*a as usize), values.get(*b as usize), values.get(*c as usize)]
}

/// A row of the block of atoms i and j: g_i, g_j and n with these weights, and a number on the diagonal.
#[inline(always)]
fn row<T: Real>([of_i, of_j, n]: [V3<T>; 3], [p, q, r]: [T; 3], diagonal: T, axis: usize) -> V3<T> {
    let mut row = of_i.times(p) + of_j.times(q) + n.times(r);
    match axis {
        0 => row.x += diagonal,
        1 => row.y += diagonal,
        _ => row.z += diagonal,
    }
    row
}

struct Apply<'a> {
    viscosity: &'a Viscosity,
    factor: f64,
    x: &'a [f64],
    v: &'a [f64],
    f: &'a mut [f64],
}

impl BlockWork for Apply<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let Self { viscosity: &Viscosity { ref facets, shear, area, ref inside }, factor, x, v, f } = self;
        let (x, v, f) = (T::view(token, x), T::view(token, v), T::view_mut(token, f));
        for part in 0..stride {
            let x = Vectors::<T>::new(token, x, stride, part);
            let v = Vectors::<T>::new(token, v, stride, part);
            let mut f = VectorsMut::<T>::new(token, &mut *f, stride, part);
            for facet in facets {
                let seen = Seen::new(token, corners(&x, facet));
                let ([a, b, c], [p, q, r]) = (seen.gradients, corners(&v, facet));
                let divergence = a.dot(p) + b.dot(q) + c.dot(r);
                let dilation = divergence * (area - shear);
                for (g, atom) in seen.gradients.iter().zip(facet) {
                    // V_ij = A (η ((g_i·g_j) P + g_j g_iᵀ) + (κ − η) g_i g_jᵀ), eq. (viscosity.2).
                    let turned = p.times(g.dot(a)) + q.times(g.dot(b)) + r.times(g.dot(c));
                    let drawn = a.times(g.dot(p)) + b.times(g.dot(q)) + c.times(g.dot(r));
                    let stress = (seen.within(turned) + drawn).times(T::constant(token, shear)) + g.times(dilation);
                    f.add(*atom as usize, stress.times(seen.area * factor));
                }
            }
            if let Some(inside) = inside {
                inside.add_to(factor, &x, &v, &mut f);
            }
        }
    }
}
