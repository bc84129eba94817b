//! Where a mesh has edges that are to be seen as such: those of blocks, the rims of rods and of open surfaces.

use super::topology::{NONE, Topology, ends};
use crate::Vec3;

/// Facets that turn by more than this at a side, rad, may meet there in an edge: those of the coarsest round cell, an icosahedron, turn
/// by 41.8°, and those of a rod of eight sides by 45°.
const SHARP: f64 = 50.0 * std::f64::consts::PI / 180.0;
/// An edge turns by more than this many times what other sides of its mesh turn by.
const OVER_OTHERS: f64 = 3.0;
/// The edges of a mesh.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Creases {
    /// Which sides are edges or rims; empty when none are.
    pub sharp: Vec<bool>,
    /// Whether there are edges where facets meet, and not only rims.
    pub has_edges: bool,
    /// The direction of the curve that edges make at each atom; zero where they make none. Empty when there are no edges.
    tangents: Vec<Vec3>,
}

impl Creases {
    /// Of a mesh with these normals of its facets, now or at rest, zero for those that are not drawn.
    pub fn find(positions: &[Vec3], facets: &[[u32; 3]], topology: &Topology, normals: &[Vec3]) -> Self {
        let mut sharp = turned(topology, normals);
        let has_edges = sharp.contains(&true) && keep_lines(&mut sharp, facets, topology, positions.len());
        for (side, across) in topology.across.iter().enumerate() {
            sharp[side] |= *across == NONE && normals[side / 3] != Vec3::zeros();
        }
        if !sharp.contains(&true) {
            return Self::default();
        }
        let tangents = tangents(&sharp, positions, facets, topology);
        Self { sharp, has_edges, tangents }
    }

    /// For an edge: the directions in which it leaves its two ends, unit vectors along `chord` where it is straight.
    pub fn tangents_of(&self, side: usize, atoms: [u32; 2], chord: Vec3) -> Option<[Vec3; 2]> {
        if !self.sharp.get(side).copied().unwrap_or(false) {
            return None;
        }
        let along = chord.try_normalize(1e-300)?;
        Some(atoms.map(|atom| {
            let tangent = self.tangents[atom as usize];
            if tangent == Vec3::zeros() { along } else { tangent }
        }))
    }
}

/// Sides at which facets turn sharply, and by much more than at the other sides of the mesh.
fn turned(topology: &Topology, normals: &[Vec3]) -> Vec<bool> {
    let sides = topology.across.iter().enumerate();
    let angle = |(side, other): (usize, &u32)| match *other {
        NONE => 0.0,
        other => normals[side / 3].dot(&normals[other as usize / 3]).clamp(-1.0, 1.0).acos(),
    };
    // What most meshes have needs no angle.
    let least = SHARP.cos();
    let is_sharp = |(side, other): (usize, &u32)| {
        *other != NONE && {
            let (one, other) = (normals[side / 3], normals[*other as usize / 3]);
            one.dot(&other) < least && one != Vec3::zeros() && other != Vec3::zeros()
        }
    };
    let mut sharp: Vec<bool> = sides.clone().map(is_sharp).collect();
    if sharp.contains(&true) {
        let mut others: Vec<f64> = sides.clone().filter(|at| !is_sharp(*at)).map(angle).collect();
        let middle = others.len() / 2;
        let typical = if others.is_empty() { 0.0 } else { *others.select_nth_unstable_by(middle, f64::total_cmp).1 };
        for (side, other) in sides {
            sharp[side] &= angle((side, other)) > OVER_OTHERS * typical;
        }
    }
    sharp
}

/// Keeps the edges that go on at both ends: one that ends within a surface is a fold of a soft skin. Whether any are left.
fn keep_lines(sharp: &mut [bool], facets: &[[u32; 3]], topology: &Topology, atoms: usize) -> bool {
    let is_rim = |side: usize| topology.across[side] == NONE;
    let counts_once = |side: usize| is_rim(side) || side < topology.across[side] as usize;
    let mut degree = vec![0_u32; atoms];
    let known = |side: usize| ends(facets, side).iter().all(|atom| (*atom as usize) < atoms);
    for side in (0..sharp.len()).filter(|side| counts_once(*side) && known(*side)) {
        if sharp[side] || is_rim(side) {
            ends(facets, side).iter().for_each(|atom| degree[*atom as usize] += 1);
        }
    }
    loop {
        let mut changed = false;
        for side in 0..sharp.len() {
            if sharp[side] && ends(facets, side).iter().any(|atom| degree[*atom as usize] < 2) {
                sharp[side] = false;
                sharp[topology.across[side] as usize] = false;
                ends(facets, side).iter().for_each(|atom| degree[*atom as usize] -= 1);
                changed = true;
            }
        }
        if !changed {
            return sharp.contains(&true);
        }
    }
}

/// At atoms that two edges meet at, which do not turn sharply themselves: the direction from one neighbour along them to the other.
fn tangents(sharp: &[bool], positions: &[Vec3], facets: &[[u32; 3]], topology: &Topology) -> Vec<Vec3> {
    let mut met: Vec<([u32; 2], u32)> = vec![([NONE; 2], 0); positions.len()];
    for side in (0..sharp.len()).filter(|side| sharp[*side]) {
        // A side at a rim is there once, others twice.
        if topology.across[side] == NONE || side < topology.across[side] as usize {
            let [from, to] = ends(facets, side);
            for (atom, other) in [(from, to), (to, from)] {
                let (others, count) = &mut met[atom as usize];
                if let Some(slot) = others.get_mut(*count as usize) {
                    *slot = other;
                }
                *count += 1;
            }
        }
    }
    let tangent = |(atom, ([before, after], count)): (usize, &([u32; 2], u32))| {
        if *count != 2 {
            return Vec3::zeros();
        }
        let (at, before, after) = (positions[atom], positions[*before as usize], positions[*after as usize]);
        let (one, other) = ((at - before).try_normalize(1e-300), (after - at).try_normalize(1e-300));
        let straight = one.zip(other).filter(|(one, other)| one.dot(other) > SHARP.cos());
        straight.and_then(|(one, other)| (one + other).try_normalize(1e-300)).unwrap_or_default()
    };
    met.iter().enumerate().map(tangent).collect()
}
