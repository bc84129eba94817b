//! Where skins are not bent: where a body lies on a sheet, or a sheet on it. Meshes do not go through each other, and skins that bulge
//! beyond them would.

use rayon::prelude::*;

use super::topology::Topology;
use crate::Vec3;
use crate::picture::render::camera::Bounds;
use crate::picture::render::scene::Surface;

/// An atom that is nearer to another surface than this, in mean edges of that one, has no bent skin around it: skins of meshes that are
/// worth a picture bulge by less than a tenth of an edge.
const NEAR: f64 = 0.1;
/// Beyond this its skin is as bent as that of others.
const FAR: f64 = 0.35;
/// How far the nearest atom of that surface may be, in its edges: how far the surface is follows from the plane through that atom.
const REACH: f64 = 1.0;

/// How much of its bend the skin has at each atom of each surface, from 0 to 1; empty where it has all of it everywhere.
pub(super) fn bends(surfaces: &[Surface], topologies: &[impl AsRef<Topology>]) -> Vec<Vec<f64>> {
    let mut bends = vec![Vec::new(); surfaces.len()];
    let is_bent = |surface: &Surface| !surface.has_normals() && !surface.facets.is_empty();
    let is_sheet = |n: &usize| is_bent(&surfaces[*n]) && !topologies[*n].as_ref().is_closed;
    let sheets: Vec<usize> = (0..surfaces.len()).filter(is_sheet).collect();
    if sheets.is_empty() {
        return bends;
    }
    let bodies: Vec<Option<Body>> =
        surfaces.par_iter().map(|surface| if is_bent(surface) { Body::of(surface) } else { None }).collect();
    for &sheet in &sheets {
        for other in (0..surfaces.len()).filter(|n| *n != sheet) {
            if let (Some(one), Some(two)) = (&bodies[sheet], &bodies[other]) {
                one.flatten(two, &mut bends[sheet]);
                two.flatten(one, &mut bends[other]);
            }
        }
    }
    bends
}

/// A surface, and what others ask of it.
struct Body<'a> {
    positions: &'a [[f64; 3]],
    /// At the atoms, the mean over the facets around by their areas.
    normals: Vec<Vec3>,
    bounds: Bounds,
    /// The mean length of the sides of facets, µm.
    edge: f64,
}

impl<'a> Body<'a> {
    /// None of a surface that is nowhere.
    fn of(surface: &'a Surface) -> Option<Self> {
        let bounds = Bounds::around(&surface.positions)?;
        Some(Self { positions: &surface.positions, normals: normals(surface), bounds, edge: mean_edge(surface) })
    }

    /// Takes the bend away of its atoms that are near another one.
    fn flatten(&self, other: &Self, bends: &mut Vec<f64>) {
        let reach = REACH * other.edge;
        let is_in = |bounds: &Bounds, at: &[f64; 3]| {
            (0..3).all(|k| at[k] >= bounds.low[k] - reach && at[k] <= bounds.high[k] + reach)
        };
        let atoms = other.positions.iter().zip(&other.normals).filter(|(at, _)| is_in(&self.bounds, at));
        let near: Vec<(Vec3, Vec3)> = atoms.map(|(at, normal)| (Vec3::from(*at), *normal)).collect();
        for (atom, at) in self.positions.iter().enumerate().filter(|(_, at)| is_in(&other.bounds, at)) {
            let at = Vec3::from(*at);
            let away = |near: &&(Vec3, Vec3)| (near.0 - at).norm_squared();
            let Some((nearest, normal)) = near.iter().min_by(|one, other| away(one).total_cmp(&away(other))) else {
                return;
            };
            if (nearest - at).norm() > reach {
                continue;
            }
            let gap = (nearest - at).dot(normal).abs() / other.edge;
            let share = ((gap - NEAR) / (FAR - NEAR)).clamp(0.0, 1.0);
            if share < 1.0 {
                bends.resize(self.positions.len(), 1.0);
                bends[atom] = bends[atom].min(share);
            }
        }
    }
}

/// The unit normal of a surface at each atom, the mean over the facets around by their areas.
fn normals(surface: &Surface) -> Vec<Vec3> {
    let mut sums = vec![Vec3::zeros(); surface.positions.len()];
    for facet in surface.facets.iter().filter(|facet| surface.is_drawable(facet)) {
        let [a, b, c] = facet.map(|atom| Vec3::from(surface.positions[atom as usize]));
        facet.iter().for_each(|atom| sums[*atom as usize] += (b - a).cross(&(c - a)));
    }
    sums.into_iter().map(|sum| sum.try_normalize(1e-300).unwrap_or_default()).collect()
}

/// The mean length of the sides of the facets of a surface, µm.
fn mean_edge(surface: &Surface) -> f64 {
    let at = |atom: u32| surface.positions.get(atom as usize).map_or_else(Vec3::zeros, |at| Vec3::from(*at));
    let sides = surface.facets.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let lengths = sides.map(|(one, other)| (at(one) - at(other)).norm()).filter(|length| length.is_finite());
    let (sum, count) = lengths.fold((0.0, 0), |(sum, count), length| (sum + length, count + 1));
    if count > 0 && sum > 0.0 { sum / f64::from(count) } else { 1e-300 }
}
