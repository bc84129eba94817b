//! Shape memory in the founding documents' first form: two angles and a distance for every atom.
//!
//! An atom remembers where it stood seen from the middle G of its neighbours: at the distance γ, inclined by β from the
//! normal of its ring and turned by α about it from the direction of the first neighbour, eq. (angles.1). It is drawn
//! there by `F = k (P* − P)`, and the neighbours take equal shares of the reaction. That conserves momentum but not
//! angular momentum, and the force is not a gradient: it is kept to reproduce old figures. Where the ring is flat the
//! form loses the inclination only if γ = 0. Source: Promayon, Martiel & Tracqui 2003; MODEL.md §2.1.

use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;

/// Where an atom stands in the frame of its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stance {
    /// Angle about the normal from the first neighbour's direction, rad.
    pub alpha: f64,
    /// Angle from the normal, rad.
    pub beta: f64,
    /// Distance from the middle of the neighbours, µm.
    pub gamma: f64,
}

/// The remembered angles of a mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub struct Angles {
    stiffness: f64,
    rings: Vec<Vec<u32>>,
    stances: Vec<Stance>,
    /// The stances as components along normal, tangent and binormal, µm.
    coordinates: Vec<[f64; 3]>,
}

/// The middle of an atom's neighbours and the frame they span.
#[derive(Clone, Copy)]
struct Frame<T> {
    middle: V3<T>,
    normal: V3<T>,
    tangent: V3<T>,
}

/// A squared length (µm² or µm⁴) below which a frame's axis has no direction.
const NO_DIRECTION: f64 = 1e-100;

impl Angles {
    /// Remembers the shape `positions` (µm). `rings[i]` holds the neighbours of atom i in the order in which they stand
    /// around it. An atom with two neighbours lives in the plane z = const, whose normal ẑ completes its frame; an
    /// atom with fewer feels nothing. `stiffness` is k of each atom, pN/µm.
    pub fn new(positions: &[Vec3], rings: &[Vec<u32>], stiffness: f64) -> Self {
        let flat: Vec<f64> = positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        let x = Vectors::<f64>::new((), &flat, 1, 0);
        let stance = |(atom, ring): (usize, &Vec<u32>)| {
            if ring.len() < 2 {
                return Stance::default();
            }
            let frame = frame(&x, ring);
            let away = x.get(atom) - frame.middle;
            let (up, along) = (away.dot(frame.normal), away.dot(frame.tangent));
            let across = away.dot(frame.normal.cross(frame.tangent));
            Stance { alpha: across.atan2(along), beta: along.hypot(across).atan2(up), gamma: away.squared().sqrt() }
        };
        let stances: Vec<Stance> = rings.iter().enumerate().map(stance).collect();
        let coordinates_of = |s: &Stance| {
            let flat = s.gamma * s.beta.sin();
            [s.gamma * s.beta.cos(), flat * s.alpha.cos(), flat * s.alpha.sin()]
        };
        let coordinates = stances.iter().map(coordinates_of).collect();
        Self { stiffness, rings: rings.to_vec(), stances, coordinates }
    }

    /// What every atom remembers.
    pub fn stances(&self) -> &[Stance] {
        &self.stances
    }

    /// Adds the force on every atom and returns ½ k Σ |P* − P|², pN·µm, of which it is not quite the gradient.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for (atom, (ring, &[up, along, across])) in self.rings.iter().zip(&self.coordinates).enumerate() {
            if ring.len() < 2 {
                continue;
            }
            let frame = frame(x, ring);
            let binormal = frame.normal.cross(frame.tangent);
            let coordinates_of = frame.normal.scaled(up) + frame.tangent.scaled(along) + binormal.scaled(across);
            let offset = frame.middle + coordinates_of - x.get(atom);
            let pull = offset.scaled(self.stiffness);
            energy += offset.dot(pull) * 0.5;
            f.add(atom, pull);
            let share = pull.scaled(1.0 / ring.len() as f64);
            for &j in ring {
                f.sub(j as usize, share);
            }
        }
        energy
    }

    /// Adds k LᵀL, where L takes from every atom the mean of its neighbours.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        for (atom, ring) in self.rings.iter().enumerate().filter(|(_, ring)| ring.len() >= 2) {
            let share = -1.0 / ring.len() as f64;
            let row: Vec<(usize, f64)> =
                std::iter::once((atom, 1.0)).chain(ring.iter().map(|&j| (j as usize, share))).collect();
            for &(i, a) in &row {
                for &(j, b) in &row {
                    matrix.add(i, j, self.stiffness * a * b);
                }
            }
        }
    }
}

/// The frame of a ring of two or more atoms.
#[inline(always)]
fn frame<T: Real>(x: &Vectors<T>, ring: &[u32]) -> Frame<T> {
    let first = x.get(ring[0] as usize);
    let mut middle = V3::zero(x.token);
    for &j in ring {
        middle += x.get(j as usize);
    }
    let middle = middle.scaled(1.0 / ring.len() as f64);
    let normal = match ring {
        &[_, last] => {
            let side = x.get(last as usize) - first;
            V3 { x: -side.y, y: side.x, z: T::constant(x.token, 0.0) }
        }
        _ => {
            // Measured from the middle, so that a cell far from the origin loses no digits.
            let mut sum = V3::zero(x.token);
            let mut from = x.get(ring[ring.len() - 1] as usize) - middle;
            for &j in ring {
                let to = x.get(j as usize) - middle;
                sum += from.cross(to);
                from = to;
            }
            sum
        }
    };
    let normal = direction(x.token, normal);
    let arm = first - middle;
    let tangent = direction(x.token, arm - normal.times(normal.dot(arm)));
    Frame { middle, normal, tangent }
}

/// A vector made one long.
#[inline(always)]
fn direction<T: Real>(token: T::Token, v: V3<T>) -> V3<T> {
    v.times(T::constant(token, 1.0) / v.squared().max(T::constant(token, NO_DIRECTION)).sqrt())
}
