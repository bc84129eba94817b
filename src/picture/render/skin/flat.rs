//! Where skins are not bent: where a body lies on a sheet, or a sheet on it. Meshes do not go through each other, and skins that bulge
//! beyond them would.

use super::topology::Topology;
use crate::Vec3;
use crate::picture::render::camera::Bounds;
use crate::picture::render::scene::Surface;

/// An atom whose nearest one of another surface is nearer than this, in mean edges of that one, has no bent skin around it: where surfaces
/// touch, an atom is at most 0.6 edges away from the corners of a facet.
const NEAR: f64 = 0.9;
/// Beyond this its skin is as bent as that of others.
const FAR: f64 = 1.6;

/// How much of its bend the skin has at each atom of each surface, from 0 to 1; empty where it has all of it everywhere.
pub(super) fn bends(surfaces: &[Surface], topologies: &[impl AsRef<Topology>]) -> Vec<Vec<f64>> {
    let mut bends = vec![Vec::new(); surfaces.len()];
    let is_bent = |surface: &Surface| !surface.has_normals() && !surface.facets.is_empty();
    let all = std::env::var_os("PSEUDOPOD_FLAT").is_some();
    for sheet in (0..surfaces.len()).filter(|n| is_bent(&surfaces[*n]) && (all || !topologies[*n].as_ref().is_closed)) {
        for other in (0..surfaces.len()).filter(|n| *n != sheet && is_bent(&surfaces[*n])) {
            flatten(&surfaces[sheet], &surfaces[other], &mut bends[sheet]);
            flatten(&surfaces[other], &surfaces[sheet], &mut bends[other]);
        }
    }
    bends
}

/// Takes the bend away of atoms of a surface that are near another one.
fn flatten(surface: &Surface, other: &Surface, bends: &mut Vec<f64>) {
    let edge = mean_edge(other);
    let (Some(own), Some(there)) = (Bounds::around(&surface.positions), Bounds::around(&other.positions)) else {
        return;
    };
    let is_in = |bounds: &Bounds, at: &[f64; 3]| {
        (0..3).all(|k| at[k] >= bounds.low[k] - FAR * edge && at[k] <= bounds.high[k] + FAR * edge)
    };
    let near: Vec<Vec3> = other.positions.iter().filter(|at| is_in(&own, at)).map(|at| Vec3::from(*at)).collect();
    if near.is_empty() {
        return;
    }
    for (atom, at) in surface.positions.iter().enumerate().filter(|(_, at)| is_in(&there, at)) {
        let at = Vec3::from(*at);
        let nearest = near.iter().map(|near| (near - at).norm_squared()).fold(f64::INFINITY, f64::min).sqrt();
        let share = ((nearest / edge - NEAR) / (FAR - NEAR)).clamp(0.0, 1.0);
        if share < 1.0 {
            bends.resize(surface.positions.len(), 1.0);
            bends[atom] = bends[atom].min(share);
        }
    }
}

/// The mean length of the sides of the facets of a surface, µm.
fn mean_edge(surface: &Surface) -> f64 {
    let at = |atom: u32| surface.positions.get(atom as usize).map_or_else(Vec3::zeros, |at| Vec3::from(*at));
    let sides = surface.facets.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let lengths = sides.map(|(one, other)| (at(one) - at(other)).norm()).filter(|length| length.is_finite());
    let (sum, count) = lengths.fold((0.0, 0), |(sum, count), length| (sum + length, count + 1));
    if count > 0 && sum > 0.0 { sum / f64::from(count) } else { 1e-300 }
}
