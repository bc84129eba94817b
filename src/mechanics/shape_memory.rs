//! Shape memory in the triplet form: every atom remembers where it stood among its neighbours.
//!
//! Each non-collinear triplet t = (a, b, c) of an atom's neighbours gives, at rest, the barycentric coordinates of the
//! atom's projection on the triplet's plane and its signed height β_t above it. The place the atom is drawn to is the
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

/// Sine of the smallest angle of a triplet; flatter ones count as collinear.
const COLLINEAR: f64 = 1e-6;

/// A triplet's two edges, its unit normal and one over twice its area.
#[derive(Clone, Copy)]
struct Span<T> {
    u: V3<T>,
    v: V3<T>,
    normal: V3<T>,
    inverse: T,
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

    fn remember_atom(&mut self, positions: &[Vec3], atom: usize, around: &[u32]) {
        let first = self.triplets.len();
        let mut weights: Vec<(u32, f64)> = around.iter().map(|&j| (j, 0.0)).collect();
        let n = around.len();
        for i in 0..n {
            for j in i + 1..n {
                for k in j + 1..n {
                    let corner = [around[i], around[j], around[k]];
                    let Some((coordinates, height)) = project(positions, atom, corner) else { continue };
                    self.triplets.push(Triplet { a: corner[0], b: corner[1], c: corner[2], height });
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
        let nothing =
            Span { u: V3::zero(token), v: V3::zero(token), normal: V3::zero(token), inverse: T::constant(token, 0.0) };
        let mut kept = [nothing; KEPT];
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

    /// How far the place of an atom moves at most when a corner of one of its triplets moves by one: the tilt of the
    /// normals, eq. (shape.3).
    fn tilt(&self, atom: usize, x: &[Vec3]) -> f64 {
        let triplets = &self.triplets[self.first_triplet[atom] as usize..self.first_triplet[atom + 1] as usize];
        let part = |t: &Triplet| {
            let [a, b, c] = [t.a, t.b, t.c].map(|i| x[i as usize]);
            let (u, v) = (b - a, c - a);
            t.height.abs() * (u.norm() + v.norm()) / u.cross(&v).norm().max(f64::MIN_POSITIVE)
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
    let inverse = T::constant(x.token, 1.0) / cross.squared().sqrt();
    Span { u, v, normal: cross.times(inverse), inverse }
}

/// The answer of a triplet's corners to the tilt of their normal.
#[inline(always)]
fn add_tilt<T: Real>(f: &mut VectorsMut<T>, t: &Triplet, span: &Span<T>, pull: V3<T>) {
    let across = pull - span.normal.times(span.normal.dot(pull));
    let g = across.times(span.inverse * t.height);
    let on_b = span.v.cross(g);
    let on_c = g.cross(span.u);
    f.add(t.a as usize, on_b + on_c);
    f.sub(t.b as usize, on_b);
    f.sub(t.c as usize, on_c);
}

/// Barycentric coordinates of an atom's projection on a triplet and its signed height, or nothing for a collinear one.
fn project(positions: &[Vec3], atom: usize, corner: [u32; 3]) -> Option<([f64; 3], f64)> {
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
    Some(([1.0 - on_b - on_c, on_b, on_c], p.dot(&normal)))
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
                target += t.height * (b - a).cross(&(c - a)).normalize();
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
                let cross = u.cross(&v);
                let normal = cross.normalize();
                let g = (pull - normal * normal.dot(&pull)) * (t.height / cross.norm());
                let (on_b, on_c) = (v.cross(&g), g.cross(&u));
                f[t.a as usize] += on_b + on_c;
                f[t.b as usize] -= on_b;
                f[t.c as usize] -= on_c;
            }
        }
        energy
    }
}
