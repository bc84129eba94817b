//! Shape memory in the triplet form: every atom remembers where it stood among its neighbours.
//!
//! Each non-collinear triplet t = (a, b, c) of an atom's neighbours gives, at rest, the barycentric coordinates of the
//! atom's projection on the triplet's plane and its signed height β_t above it. The point the atom is drawn to is the
//! mean over its m triplets, eq. (shape.1), `X* = Σ_j w_j X_j + (1/m) Σ_t β_t n̂_t`: the projections collapse, once,
//! into one fixed weight per neighbour; only the normals are recomputed. The energy is eq. (shape.2),
//! `E = ½ k Σ_i |X*_i − X_i|²`, and its exact gradient conserves momentum and angular momentum.
//! Source: Promayon 2008 eq. 4–5, Marchal 2006 eq. 1–3; the exact gradient is ours (eq. shape.3).

use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;

/// How the force on an atom is answered by its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reaction {
    /// The exact gradient of the energy, the normals differentiated too: no net force, no net torque.
    #[default]
    Exact,
    /// The founding documents' spread by the weights alone: no net force, but a small net torque.
    Spread,
}

/// One triplet of neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Triplet {
    a: u32,
    b: u32,
    c: u32,
    /// β_t / m, µm.
    height: f64,
    /// (τ|N|)² at rest, µm⁴, and its inverse: below it the normal shrinks, eq. (shape.5).
    flat: f64,
    per_flat: f64,
}

/// The shape memory of a mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeMemory {
    /// k_e of each atom, pN/µm.
    stiffness: f64,
    reaction: Reaction,
    /// Triplets of atom i: `triplets[first_triplet[i]..first_triplet[i + 1]]`.
    triplets: Vec<Triplet>,
    first_triplet: Vec<u32>,
    /// Neighbours of atom i and their weights: `weights[first_weight[i]..first_weight[i + 1]]`.
    weights: Vec<(u32, f64)>,
    first_weight: Vec<u32>,
}

/// Triplets whose vectors are kept from the first pass over an atom to the second; beyond them (atoms with more than
/// eight neighbours) they are computed again.
const KEPT: usize = 56;

/// τ of eq. (shape.5): the share of its area at rest below which a triplet's normal shrinks smoothly to nothing.
const FLAT: f64 = 0.2;

/// Sine of the smallest angle of a triplet; flatter ones count as collinear.
const COLLINEAR: f64 = 1e-6;

/// A triplet's two edges, its normal without and with the factor p of eq. (shape.5), one over what N was divided by, and r².
#[derive(Clone, Copy)]
struct Span<T> {
    u: V3<T>,
    v: V3<T>,
    unit: V3<T>,
    normal: V3<T>,
    inverse: T,
    narrow: T,
}

impl ShapeMemory {
    /// Remembers the shape `positions` (µm) in which atom i has the given neighbours; `stiffness` is k_e, pN/µm.
    /// An atom without any valid triplet feels nothing.
    pub fn new(positions: &[Vec3], neighbours: &[Vec<u32>], stiffness: f64, reaction: Reaction) -> Self {
        let mut memory = Self {
            stiffness,
            reaction,
            triplets: Vec::new(),
            first_triplet: vec![0],
            weights: Vec::new(),
            first_weight: vec![0],
        };
        for (atom, around) in neighbours.iter().enumerate() {
            memory.remember_atom(positions, atom, around);
        }
        memory
    }

    /// Whether its forces are the gradient of its energy.
    pub fn is_gradient(&self) -> bool {
        self.reaction == Reaction::Exact
    }

    fn remember_atom(&mut self, positions: &[Vec3], atom: usize, around: &[u32]) {
        let first = self.triplets.len();
        let mut weights: Vec<(u32, f64)> = around.iter().map(|&j| (j, 0.0)).collect();
        let n = around.len();
        for i in 0..n {
            for j in i + 1..n {
                for k in j + 1..n {
                    let corner = [around[i], around[j], around[k]];
                    let Some((coordinates, height, size)) = project(positions, atom, corner) else { continue };
                    let flat = (FLAT * size).powi(2);
                    let [a, b, c] = corner;
                    self.triplets.push(Triplet { a, b, c, height, flat, per_flat: 1.0 / flat });
                    for (slot, share) in [i, j, k].into_iter().zip(coordinates) {
                        weights[slot].1 += share;
                    }
                }
            }
        }
        let count = (self.triplets.len() - first) as f64;
        if count > 0.0 {
            self.triplets[first..].iter_mut().for_each(|t| t.height /= count);
            self.weights.extend(weights.into_iter().map(|(j, w)| (j, w / count)));
        }
        self.first_triplet.push(self.triplets.len() as u32);
        self.first_weight.push(self.weights.len() as u32);
    }

    /// The stiffness k_e of each atom, pN/µm.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// The same memory with another stiffness k_e, pN/µm.
    pub fn with_stiffness(mut self, stiffness: f64) -> Self {
        self.stiffness = stiffness;
        self
    }

    /// Number of triplets of all atoms.
    pub fn triplet_count(&self) -> usize {
        self.triplets.len()
    }

    /// Adds the elastic force on every atom, eq. (shape.3), and returns the energy, eq. (shape.2).
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let token = x.token;
        let (zero, none) = (V3::zero(token), T::constant(token, 0.0));
        let mut kept = [Span { u: zero, v: zero, unit: zero, normal: zero, inverse: none, narrow: none }; KEPT];
        let mut energy = T::constant(token, 0.0);
        for atom in 0..self.first_triplet.len() - 1 {
            let triplets = &self.triplets[self.first_triplet[atom] as usize..self.first_triplet[atom + 1] as usize];
            if triplets.is_empty() {
                continue;
            }
            let weights = &self.weights[self.first_weight[atom] as usize..self.first_weight[atom + 1] as usize];
            let mut offset = -x.get(atom);
            for &(j, w) in weights {
                offset += x.get(j as usize).scaled(w);
            }
            for (t, keep) in triplets.iter().zip(kept.iter_mut()) {
                *keep = span(x, t);
                offset += keep.normal.scaled(t.height);
            }
            for t in triplets.iter().skip(KEPT) {
                offset += span(x, t).normal.scaled(t.height);
            }
            let pull = offset.scaled(self.stiffness);
            energy += offset.dot(pull) * 0.5;
            f.add(atom, pull);
            for &(j, w) in weights {
                f.sub(j as usize, pull.scaled(w));
            }
            if self.reaction == Reaction::Exact {
                for (t, keep) in triplets.iter().zip(kept.iter()) {
                    add_tilt(f, t, keep, pull);
                }
                for t in triplets.iter().skip(KEPT) {
                    add_tilt(f, t, &span(x, t), pull);
                }
            }
        }
        energy
    }

    /// How far the target of an atom moves at most when a corner of one of its triplets moves by one: the tilt of the
    /// normals, eq. (shape.3).
    fn tilt(&self, atom: usize, x: &[Vec3]) -> f64 {
        let triplets = &self.triplets[self.first_triplet[atom] as usize..self.first_triplet[atom + 1] as usize];
        let part = |t: &Triplet| {
            let [a, b, c] = [t.a, t.b, t.c].map(|i| x[i as usize]);
            let (u, v) = (b - a, c - a);
            let area = u.cross(&v).norm_squared();
            let narrow = (area * t.per_flat).min(1.0);
            t.height.abs() * (u.norm() + v.norm()) * shrink(narrow) / area.max(t.flat).sqrt()
        };
        triplets.iter().map(part).sum()
    }

    /// Adds k LᵀL, L = I − W, the constant linear part that the implicit step uses. Where triplets are smaller in the
    /// shape `x` than at `rest`, so that their normals tilt more easily, the atom counts more.
    pub fn add_stiffness(&self, rest: &[Vec3], x: &[Vec3], matrix: &mut StiffnessMatrix) {
        for atom in 0..self.first_weight.len() - 1 {
            let weights = &self.weights[self.first_weight[atom] as usize..self.first_weight[atom + 1] as usize];
            if weights.is_empty() {
                continue;
            }
            let stiffer = ((1.0 + self.tilt(atom, x)) / (1.0 + self.tilt(atom, rest))).max(1.0).powi(2);
            let row: Vec<(usize, f64)> =
                std::iter::once((atom, 1.0)).chain(weights.iter().map(|&(j, w)| (j as usize, -w))).collect();
            for &(i, a) in &row {
                for &(j, b) in &row {
                    matrix.add(i, j, stiffer * self.stiffness * a * b);
                }
            }
        }
    }
}

/// The plane of a triplet in the current shape.
#[inline(always)]
fn span<T: Real>(x: &Vectors<T>, t: &Triplet) -> Span<T> {
    let a = x.get(t.a as usize);
    let u = x.get(t.b as usize) - a;
    let v = x.get(t.c as usize) - a;
    let cross = u.cross(v);
    let area = cross.squared();
    let inverse = T::constant(x.token, 1.0) / area.max(T::constant(x.token, t.flat)).sqrt();
    let narrow = (area * t.per_flat).min(T::constant(x.token, 1.0));
    let unit = cross.times(inverse);
    let factor = shrink(narrow);
    Span { u, v, unit, normal: unit.times(factor), inverse, narrow }
}

/// p(r) of eq. (shape.5) from r²: 1, without slope or curvature, where r is 1.
#[inline(always)]
fn shrink<T: Real>(narrow: T) -> T {
    narrow * narrow * 0.375 - narrow * 1.25 + 1.875
}

/// The answer of a triplet's corners to the tilt of their normal.
#[inline(always)]
fn add_tilt<T: Real>(f: &mut VectorsMut<T>, t: &Triplet, span: &Span<T>, pull: V3<T>) {
    let narrow = span.narrow;
    let factor = shrink(narrow);
    let along = narrow * -1.5 + 2.5;
    let across = pull.times(factor) - span.unit.times(span.unit.dot(pull) * along);
    let g = across.times(span.inverse * t.height);
    let on_b = span.v.cross(g);
    let on_c = g.cross(span.u);
    f.add(t.a as usize, on_b + on_c);
    f.sub(t.b as usize, on_b);
    f.sub(t.c as usize, on_c);
}

/// Barycentric coordinates of an atom's projection on a triplet, its signed height and |N|, or nothing for a collinear one.
fn project(positions: &[Vec3], atom: usize, corner: [u32; 3]) -> Option<([f64; 3], f64, f64)> {
    let [a, b, c] = corner.map(|i| positions[i as usize]);
    let (u, v, p) = (b - a, c - a, positions[atom] - a);
    let cross = u.cross(&v);
    let size = cross.norm();
    if size <= COLLINEAR * u.norm() * v.norm() {
        return None;
    }
    let normal = cross / size;
    let on_c = u.cross(&p).dot(&normal) / size;
    let on_b = p.cross(&v).dot(&normal) / size;
    Some(([1.0 - on_b - on_c, on_b, on_c], p.dot(&normal), size))
}

/// The plain scalar reference of [`ShapeMemory::add_forces`]: the equations as the book writes them, one atom and one
/// triplet after the other. The fast kernel is held against it in tests and benches.
pub mod reference {
    use super::*;

    /// Adds the force on every atom of one cell and returns the energy, pN·µm.
    pub fn add_forces(memory: &ShapeMemory, x: &[Vec3], f: &mut [Vec3]) -> f64 {
        let mut energy = 0.0;
        for atom in 0..x.len() {
            let triplets =
                &memory.triplets[memory.first_triplet[atom] as usize..memory.first_triplet[atom + 1] as usize];
            let weights = &memory.weights[memory.first_weight[atom] as usize..memory.first_weight[atom + 1] as usize];
            if triplets.is_empty() {
                continue;
            }
            let mut target = Vec3::zeros();
            for &(j, w) in weights {
                target += w * x[j as usize];
            }
            for t in triplets {
                let (a, b, c) = (x[t.a as usize], x[t.b as usize], x[t.c as usize]);
                target += t.height * normal(t, &(b - a).cross(&(c - a)));
            }
            let offset = target - x[atom];
            let pull = memory.stiffness * offset;
            energy += 0.5 * memory.stiffness * offset.norm_squared();
            f[atom] += pull;
            for &(j, w) in weights {
                f[j as usize] -= w * pull;
            }
            if memory.reaction == Reaction::Spread {
                continue;
            }
            for t in triplets {
                let (a, b, c) = (x[t.a as usize], x[t.b as usize], x[t.c as usize]);
                let (u, v) = (b - a, c - a);
                let g = t.height * tilt(t, &u.cross(&v), &pull);
                let (on_b, on_c) = (v.cross(&g), g.cross(&u));
                f[t.a as usize] += on_b + on_c;
                f[t.b as usize] -= on_b;
                f[t.c as usize] -= on_c;
            }
        }
        energy
    }

    /// n of eq. (shape.5).
    fn normal(t: &Triplet, cross: &Vec3) -> Vec3 {
        let (size, least) = (cross.norm(), t.flat.sqrt());
        if size >= least { cross / size } else { cross * (shrink((size / least).powi(2)) / least) }
    }

    /// The derivative of n by N applied to a vector, eq. (shape.6).
    fn tilt(t: &Triplet, cross: &Vec3, pull: &Vec3) -> Vec3 {
        let (size, least) = (cross.norm(), t.flat.sqrt());
        if size >= least {
            let unit = cross / size;
            return (pull - unit * unit.dot(pull)) / size;
        }
        let r = (size / least).powi(2);
        (shrink(r) * pull - cross * (cross.dot(pull) * (2.5 - 1.5 * r) / (least * least))) / least
    }
}
