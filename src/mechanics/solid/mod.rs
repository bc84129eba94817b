//! Bodies that are filled with an elastic material: tetrahedra of constant strain, eqs. (solids.1) to (solids.7).
//!
//! A tetrahedron whose atoms are at x_i has the deformation gradient F = Σ x_i ⊗ g_i with g_i the gradient at rest of the weight of an atom in it
//! (1 at it, 0 at the three others), and the energy V W(F), V its volume at rest. The force on an atom is its exact gradient, −V P g_i with
//! P = ∂W/∂F. Changes of volume may be resisted over larger parts of the body than single tetrahedra, see [`dilation`]. Sources: MODEL §2.3 and
//! the documents' mass–tensor (Cotin 1999, Picinbono 2001); Bonet & Wood 2008; Smith, de Goes & Kim 2019 for the tangent.

pub mod dilation;
pub mod law;
mod principal;
#[cfg(test)]
mod tests;

use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use super::tangent::matrix::Blocks;
use crate::Vec3;
use dilation::Dilation;
use law::{Elastic, SolidLaw};
use principal::Principal;

/// A tetrahedron at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Element {
    atoms: [u32; 4],
    /// Gradients of the weights of the atoms, 1/µm.
    gradients: [[f64; 3]; 4],
    /// Volume, µm³.
    volume: f64,
}

/// The elasticity of a filled body, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    elastic: Elastic,
    dilation: Option<Dilation>,
    elements: Vec<Element>,
}

impl Solid {
    /// A body that is free of stress when its atoms stand at `rest` (µm). Every tetrahedron must have a volume there, as the checks of
    /// geometry assure.
    pub fn new(rest: &[Vec3], tetrahedra: &[[u32; 4]], elastic: Elastic, dilation: Option<Dilation>) -> Self {
        let element = |&atoms: &[u32; 4]| {
            let [a, b, c, d] = atoms.map(|atom| rest[atom as usize]);
            let (u, v, w) = (b - a, c - a, d - a);
            let six_volumes = u.cross(&v).dot(&w);
            let (on_b, on_c, on_d) = (v.cross(&w) / six_volumes, w.cross(&u) / six_volumes, u.cross(&v) / six_volumes);
            let gradients = [-(on_b + on_c + on_d), on_b, on_c, on_d].map(Into::into);
            Element { atoms, gradients, volume: six_volumes / 6.0 }
        };
        Self { elastic, dilation, elements: tetrahedra.iter().map(element).collect() }
    }

    /// The law and its moduli.
    pub fn elastic(&self) -> Elastic {
        self.elastic
    }

    /// The atoms of its tetrahedra.
    pub fn tetrahedra(&self) -> impl Iterator<Item = [u32; 4]> + '_ {
        self.elements.iter().map(|element| element.atoms)
    }

    /// The atoms of the first tetrahedron without a positive volume at these positions (µm), for laws that have no energy there.
    pub fn inside_out(&self, position: impl Fn(u32) -> Vec3) -> Option<[u32; 4]> {
        if self.elastic.law != SolidLaw::NeoHookean {
            return None;
        }
        let has_volume = |atoms: [u32; 4]| {
            let [a, b, c, d] = atoms.map(&position);
            (b - a).cross(&(c - a)).dot(&(d - a)) > 0.0
        };
        self.elements.iter().map(|element| element.atoms).find(|atoms| !has_volume(*atoms))
    }

    /// Adds the force on every atom, eq. (solids.1), and returns the energy, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for element in &self.elements {
            let (stored, stress) = self.elastic.stress(x.token, element.deformation(x));
            energy += stored * element.volume;
            let [b, c, d] = [element.push(1, stress), element.push(2, stress), element.push(3, stress)];
            f.sub(element.atoms[1] as usize, b);
            f.sub(element.atoms[2] as usize, c);
            f.sub(element.atoms[3] as usize, d);
            f.add(element.atoms[0] as usize, b + c + d);
        }
        if let Some(dilation) = &self.dilation {
            energy += dilation.add_forces(x, f);
        }
        energy
    }

    /// Adds the tangent stiffness of each tetrahedron, the `whole` of it or without what is negative, and that of volumes, eq. (solids.7).
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>, whole: bool) {
        for (number, element) in self.elements.iter().enumerate() {
            let frame = match self.elastic.law {
                // It knows no turns.
                SolidLaw::Linear => Principal::of(x.token, identity(x.token)),
                _ => Principal::of(x.token, element.deformation(x)),
            };
            let mut bent = self.elastic.curvatures(x.token, frame.stretches);
            if let Some(dilation) = self.dilation.as_ref().filter(|_| self.elastic.law != SolidLaw::Linear) {
                bent = bent.with_volume(dilation.slope_of(number, x), frame.stretches);
            }
            let bent = if whole { bent } else { bent.positive(x.token) };
            for i in 0..4 {
                let on_i = frame.part(x.token, element.gradients[i]);
                for j in 0..=i {
                    let on_j = frame.part(x.token, element.gradients[j]);
                    let block = frame.block(on_i, on_j, &bent, element.volume);
                    blocks.add(element.atoms[i], element.atoms[j], block);
                }
            }
        }
        if let Some(dilation) = &self.dilation {
            dilation.add_tangent(x, blocks);
        }
    }

    /// Adds the Laplacian of the body times a bound of the moduli, which is nowhere less than the true stiffness at rest.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        let modulus = self.elastic.bound() + self.dilation.as_ref().map_or(0.0, Dilation::bound);
        for element in &self.elements {
            let g = element.gradients.map(Vec3::from);
            for i in 0..4 {
                for j in 0..i {
                    let stiffness = -modulus * element.volume * g[i].dot(&g[j]);
                    matrix.add_spring(element.atoms[i] as usize, element.atoms[j] as usize, stiffness);
                }
            }
        }
        if let Some(dilation) = &self.dilation {
            dilation.add_pattern(matrix);
        }
    }
}

impl Element {
    /// The deformation gradient by its columns.
    #[inline(always)]
    fn deformation<T: Real>(&self, x: &Vectors<T>) -> [V3<T>; 3] {
        let [a, b, c, d] = self.atoms;
        let origin = x.get(a as usize);
        let (u, v, w) = (x.get(b as usize) - origin, x.get(c as usize) - origin, x.get(d as usize) - origin);
        let [_, p, q, r] = self.gradients;
        [
            u.scaled(p[0]) + v.scaled(q[0]) + w.scaled(r[0]),
            u.scaled(p[1]) + v.scaled(q[1]) + w.scaled(r[1]),
            u.scaled(p[2]) + v.scaled(q[2]) + w.scaled(r[2]),
        ]
    }

    /// V P g of an atom.
    #[inline(always)]
    fn push<T: Real>(&self, atom: usize, [p, q, r]: [V3<T>; 3]) -> V3<T> {
        let g = self.gradients[atom];
        p.scaled(g[0] * self.volume) + q.scaled(g[1] * self.volume) + r.scaled(g[2] * self.volume)
    }
}

/// The deformation of a body that is not deformed.
#[inline(always)]
fn identity<T: Real>(token: T::Token) -> [V3<T>; 3] {
    [V3::constant(token, [1.0, 0.0, 0.0]), V3::constant(token, [0.0, 1.0, 0.0]), V3::constant(token, [0.0, 0.0, 1.0])]
}
