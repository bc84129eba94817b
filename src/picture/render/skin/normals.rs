//! Normals of a mesh at its atoms, apart on the two sides of an edge.

use super::creases::Creases;
use super::topology::{NONE, Topology};
use crate::Vec3;
use crate::picture::render::scene::Surface;

/// Where the skin of a mesh looks.
pub(super) struct Bearing {
    /// Unit normals, one for each atom, or for each group of corners that no edge divides.
    pub normals: Vec<Vec3>,
    /// The group of each facet's corners, 3 f + k for corner k of facet f; empty when atoms have one normal each.
    groups: Vec<u32>,
    pub creases: Creases,
}

impl Bearing {
    /// As given, or from the facets around, each weighted by the angle that it has at the atom.
    pub fn of(surface: &Surface, positions: &[Vec3], topology: &Topology) -> Self {
        if surface.has_normals() {
            let normals = surface.normals.iter().map(|normal| unit(Vec3::from(*normal))).collect();
            return Self { normals, groups: Vec::new(), creases: Creases::default() };
        }
        let facets = &surface.facets;
        let normals_at = |positions: &[Vec3]| -> Vec<Vec3> {
            facets.iter().map(|facet| facet_normal(surface, positions, facet)).collect()
        };
        let own = normals_at(positions);
        let at_rest = (surface.rest.len() == positions.len())
            .then(|| normals_at(&surface.rest.iter().map(|position| Vec3::from(*position)).collect::<Vec<_>>()));
        let creases = Creases::find(positions, facets, topology, at_rest.as_ref().unwrap_or(&own));
        let groups = if creases.has_edges { groups(topology, &creases.sharp) } else { Vec::new() };
        let mut sums = vec![Vec3::zeros(); if groups.is_empty() { positions.len() } else { groups.len() }];
        for (number, facet) in facets.iter().enumerate().filter(|(number, _)| own[*number] != Vec3::zeros()) {
            let corners = facet.map(|atom| positions[atom as usize]);
            for k in 0..3 {
                let group = groups.get(3 * number + k).copied().unwrap_or(facet[k]);
                sums[group as usize] += angle(&corners, k) * own[number];
            }
        }
        Self { normals: sums.into_iter().map(unit).collect(), groups, creases }
    }

    /// The unit normal at a corner of a facet.
    pub fn normal(&self, facet: usize, corner: usize, surface: &Surface) -> Vec3 {
        let group = self.groups.get(3 * facet + corner).copied().unwrap_or(surface.facets[facet][corner]);
        self.normals[group as usize]
    }
}

fn unit(sum: Vec3) -> Vec3 {
    sum.try_normalize(1e-300).unwrap_or_else(Vec3::z)
}

/// The unit normal of a facet; zero for one that is not drawn or has no area.
fn facet_normal(surface: &Surface, positions: &[Vec3], facet: &[u32; 3]) -> Vec3 {
    if !surface.is_drawable(facet) {
        return Vec3::zeros();
    }
    let [a, b, c] = facet.map(|atom| positions[atom as usize]);
    (b - a).cross(&(c - a)).try_normalize(1e-300).unwrap_or_default()
}

/// The angle of a facet at a corner, rad.
fn angle(corners: &[Vec3; 3], k: usize) -> f64 {
    let (one, other) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
    one.cross(&other).norm().atan2(one.dot(&other))
}

/// Groups of corners at one atom that sides without an edge join; each has the number of one of its corners.
fn groups(topology: &Topology, sharp: &[bool]) -> Vec<u32> {
    let mut groups: Vec<u32> = (0..sharp.len() as u32).collect();
    fn root(groups: &mut [u32], mut corner: u32) -> u32 {
        while groups[corner as usize] != corner {
            groups[corner as usize] = groups[groups[corner as usize] as usize];
            corner = groups[corner as usize];
        }
        corner
    }
    let next = |side: u32| side - side % 3 + (side + 1) % 3;
    for (side, other) in topology.across.iter().enumerate().filter(|(side, other)| **other != NONE && !sharp[*side]) {
        let side = side as u32;
        // The two facets run along the side in opposite directions.
        for (one, other) in [(side, next(*other)), (next(side), *other)] {
            let (one, other) = (root(&mut groups, one), root(&mut groups, other));
            groups[one.max(other) as usize] = one.min(other);
        }
    }
    (0..groups.len() as u32).map(|corner| root(&mut groups, corner)).collect()
}
