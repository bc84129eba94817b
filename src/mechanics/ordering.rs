//! Order of the atoms on a surface without elasticity: every atom is drawn along the surface, and only along it, to its
//! neighbours, the more the farther they are.
//!
//! Tension and volume say where a surface is, not where on it the atoms are; facets shrink until nothing is left of them.
//! The pull here does no work where the surface moves along its normals and has no net force and torque, eq. (order.4), so
//! that shapes are left to the other forces. It is not the gradient of an energy.

use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;

/// The share ε of eq. (order.3): where normals around an atom scatter by more than this (squared sine), the atom is on a
/// crease and is drawn along it only.
const CREASE: f64 = 0.1;

/// A squared length below which nothing has a direction.
const NOTHING: f64 = 1e-100;

/// The ordering of a closed surface, ready for all cells that share its mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Ordering {
    stiffness: f64,
    /// The other two atoms of every facet at each atom, in the facet's order.
    rings: Vec<Vec<[u32; 2]>>,
}

/// A symmetric matrix: xx, yy, zz, xy, xz, yz.
type Symmetric<T> = [T; 6];

impl Ordering {
    /// `stiffness` k in pN/µm draws each atom of a closed surface of `atoms` atoms to each of its neighbours.
    pub fn new(atoms: usize, facets: &[[u32; 3]], stiffness: f64) -> Self {
        let mut rings = vec![Vec::new(); atoms];
        for &[i, j, k] in facets {
            rings[i as usize].push([j, k]);
            rings[j as usize].push([k, i]);
            rings[k as usize].push([i, j]);
        }
        Self { stiffness, rings }
    }

    /// Adds the force on every atom, eq. (order.4), and returns 0: it has no energy.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let token = x.token;
        let zero = T::constant(token, 0.0);
        let mut centre = V3::zero(token);
        (0..self.rings.len()).for_each(|atom| centre += x.get(atom));
        let centre = centre.scaled(1.0 / self.rings.len().max(1) as f64);
        let mut squares = zero;
        for (atom, ring) in self.rings.iter().enumerate() {
            ring.iter().for_each(|&[next, _]| squares += (x.get(next as usize) - x.get(atom)).squared());
        }
        let neighbours = self.rings.iter().map(Vec::len).sum::<usize>();
        let per_square = T::constant(token, neighbours as f64) / squares.max(T::constant(token, NOTHING));
        // Σ BᵀQB of the rigid motions B = (I, −[r]×), and Σ BᵀQL beside it.
        let mut system = [[zero; 7]; 6];
        for (atom, ring) in self.rings.iter().enumerate() {
            let (pull, q) = along_surface(x, atom, ring, per_square);
            let r = x.get(atom) - centre;
            let q = columns(&q);
            let pulled = times(&q, pull);
            let turned =
                [V3 { x: zero, y: -r.z, z: r.y }, V3 { x: r.z, y: zero, z: -r.x }, V3 { x: -r.y, y: r.x, z: zero }];
            let moved = [q[0], q[1], q[2], times(&q, turned[0]), times(&q, turned[1]), times(&q, turned[2])];
            for (column, direction) in moved.iter().chain([&pulled]).enumerate() {
                let torque = r.cross(*direction);
                for (row, value) in
                    [direction.x, direction.y, direction.z, torque.x, torque.y, torque.z].into_iter().enumerate()
                {
                    system[row][column] += value;
                }
            }
        }
        let [a, b, c, u, v, w] = solved(system);
        let (mean, spin) = (V3 { x: a, y: b, z: c }, V3 { x: u, y: v, z: w });
        for (atom, ring) in self.rings.iter().enumerate() {
            let (pull, q) = along_surface(x, atom, ring, per_square);
            let rigid = mean + spin.cross(x.get(atom) - centre);
            f.add(atom, times(&columns(&q), pull - rigid).scaled(self.stiffness));
        }
        zero
    }

    /// Adds springs to all neighbours in every direction, as stiff as the pull is along an edge of the shape `x` (a cube has
    /// three times the slope of its chord), and no softer than between neighbours at the mean distance.
    pub fn add_stiffness(&self, x: &[Vec3], matrix: &mut StiffnessMatrix) {
        let square = |atom: usize, next: u32| (x[next as usize] - x[atom]).norm_squared();
        let neighbours = || {
            self.rings
                .iter()
                .enumerate()
                .flat_map(|(atom, ring)| ring.iter().map(move |direction| (atom, direction[0])))
        };
        let mean =
            neighbours().map(|(atom, next)| square(atom, next)).sum::<f64>() / neighbours().count().max(1) as f64;
        for (atom, next) in neighbours() {
            let stiffer = 3.0 * (square(atom, next) / mean).max(1.0);
            // Each edge is met from both of its ends.
            matrix.add_spring(atom, next as usize, 0.5 * stiffer * self.stiffness);
        }
    }
}

/// The pull to all neighbours over the stiffness, eq. (order.1), and the matrix Q of eqs. (order.2) and (order.3) that keeps
/// what of it lies along the surface; `per_square` is one over the mean squared length of edges.
#[inline(always)]
fn along_surface<T: Real>(x: &Vectors<T>, atom: usize, ring: &[[u32; 2]], per_square: T) -> (V3<T>, Symmetric<T>) {
    let token = x.token;
    let (zero, one) = (T::constant(token, 0.0), T::constant(token, 1.0));
    let here = x.get(atom);
    let (mut pull, mut normal, mut area) = (V3::zero(token), V3::zero(token), zero);
    let mut scatter = [zero; 6];
    for &[j, k] in ring {
        let (u, v) = (x.get(j as usize) - here, x.get(k as usize) - here);
        let facet = u.cross(v);
        let size = facet.squared().max(T::constant(token, NOTHING)).sqrt();
        pull += u.times(u.squared() * per_square);
        normal += facet;
        area += size;
        let unit = facet.times(one / size);
        add_square(&mut scatter, facet, unit);
    }
    let normal = normal.times(one / normal.squared().max(T::constant(token, NOTHING)).sqrt());
    // What of the normals lies across the mean normal: P M P with M = scatter / area.
    let m = columns(&scatter.map(|entry| entry / area.max(T::constant(token, NOTHING)) * (1.0 / CREASE)));
    let on_normal = times(&m, normal);
    let twice = normal.dot(on_normal);
    let mut flat = [m[0].x, m[1].y, m[2].z, m[0].y, m[0].z, m[1].z];
    let across = on_normal - normal.times(twice * 0.5);
    // P M P = M − n (Mn − ½ n nMn)ᵀ − (Mn − ½ n nMn) nᵀ.
    let pairs = [
        normal.x * across.x * 2.0,
        normal.y * across.y * 2.0,
        normal.z * across.z * 2.0,
        normal.x * across.y + normal.y * across.x,
        normal.x * across.z + normal.z * across.x,
        normal.y * across.z + normal.z * across.y,
    ];
    for (entry, pair) in flat.iter_mut().zip(pairs) {
        *entry -= pair;
    }
    (0..3).for_each(|axis| flat[axis] += one);
    let mut q = inverse(&flat);
    let outer = [
        normal.x * normal.x,
        normal.y * normal.y,
        normal.z * normal.z,
        normal.x * normal.y,
        normal.x * normal.z,
        normal.y * normal.z,
    ];
    for (entry, outer) in q.iter_mut().zip(outer) {
        *entry -= outer;
    }
    (pull, q)
}

/// Adds a bᵀ of two parallel vectors.
#[inline(always)]
fn add_square<T: Real>(to: &mut Symmetric<T>, a: V3<T>, b: V3<T>) {
    to[0] += a.x * b.x;
    to[1] += a.y * b.y;
    to[2] += a.z * b.z;
    to[3] += a.x * b.y;
    to[4] += a.x * b.z;
    to[5] += a.y * b.z;
}

#[inline(always)]
fn columns<T: Real>(&[xx, yy, zz, xy, xz, yz]: &Symmetric<T>) -> [V3<T>; 3] {
    [V3 { x: xx, y: xy, z: xz }, V3 { x: xy, y: yy, z: yz }, V3 { x: xz, y: yz, z: zz }]
}

#[inline(always)]
fn times<T: Real>(columns: &[V3<T>; 3], v: V3<T>) -> V3<T> {
    columns[0].times(v.x) + columns[1].times(v.y) + columns[2].times(v.z)
}

/// The inverse of a matrix that is at least the identity.
#[inline(always)]
fn inverse<T: Real>(&[xx, yy, zz, xy, xz, yz]: &Symmetric<T>) -> Symmetric<T> {
    let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
    let determinant = xx * a + xy * b + xz * c;
    [a, xx * zz - xz * xz, xx * yy - xy * xy, b, c, xy * xz - xx * yz].map(|minor| minor / determinant)
}

/// Solves a symmetric positive system of six unknowns by elimination.
#[inline(always)]
fn solved<T: Real>(mut system: [[T; 7]; 6]) -> [T; 6] {
    for pivot in 0..6 {
        let row = system[pivot];
        for below in pivot + 1..6 {
            let share = system[below][pivot] / row[pivot];
            for column in pivot..7 {
                system[below][column] -= row[column] * share;
            }
        }
    }
    let mut solution = system.map(|row| row[6]);
    for row in (0..6).rev() {
        for column in row + 1..6 {
            let known = solution[column];
            solution[row] -= known * system[row][column];
        }
        solution[row] = solution[row] / system[row][row];
    }
    solution
}
