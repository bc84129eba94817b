//! How strongly a surface bends at every atom.

use super::{Surface, measure::atom_normals};
use crate::Vec3;
use std::f64::consts::PI;

/// The area that belongs to every atom, µm²: its Voronoi cell on the facets around it, cut at the middle of the long
/// side of obtuse facets. These areas tile the surface like [`atom_areas`](super::atom_areas), and suit curvature
/// better. Source: Meyer, Desbrun, Schröder & Barr 2003, Discrete differential-geometry operators, §3.3.
pub fn mixed_areas(surface: &Surface) -> Vec<f64> {
    let mut areas = vec![0.0; surface.positions.len()];
    for &facet in &surface.facets {
        let corners = surface.corners(facet);
        let facet_area = 0.5 * (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
        let cotangents = [0, 1, 2].map(|k| cotangent(&corners, k));
        let obtuse = (0..3).find(|&k| cotangents[k] < 0.0);
        for k in 0..3 {
            areas[facet[k] as usize] += match obtuse {
                Some(wide) if wide == k => 0.5 * facet_area,
                Some(_) => 0.25 * facet_area,
                None => {
                    let (next, last) = ((k + 1) % 3, (k + 2) % 3);
                    let to_next = (corners[next] - corners[k]).norm_squared();
                    let to_last = (corners[last] - corners[k]).norm_squared();
                    (to_next * cotangents[last] + to_last * cotangents[next]) / 8.0
                }
            };
        }
    }
    areas
}

/// Mean curvature at every atom, 1/µm: half the sum of the principal curvatures, 1/R on a sphere of radius R,
/// positive where the surface bulges outwards.
///
/// The cotangent formula, H n = 1/(4A) Σⱼ (cot α + cot β)(xᵢ − xⱼ) with A from [`mixed_areas`] (Meyer et al. 2003,
/// §3.5). It means nothing at the boundary of an open surface and is 0 at atoms without area.
pub fn mean_curvature(surface: &Surface) -> Vec<f64> {
    let mut vectors = vec![Vec3::zeros(); surface.positions.len()];
    for &facet in &surface.facets {
        let corners = surface.corners(facet);
        for k in 0..3 {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            let pull = cotangent(&corners, k) * (corners[next] - corners[last]);
            vectors[facet[next] as usize] += pull;
            vectors[facet[last] as usize] -= pull;
        }
    }
    let (areas, normals) = (mixed_areas(surface), atom_normals(surface));
    (0..vectors.len())
        .map(|atom| if areas[atom] > 0.0 { vectors[atom].dot(&normals[atom]) / (4.0 * areas[atom]) } else { 0.0 })
        .collect()
}

/// Gaussian curvature at every atom, 1/µm²: the product of the principal curvatures, 1/R² on a sphere of radius R.
///
/// The angle that the facets around the atom leave of a full turn, over its share of [`mixed_areas`]; the sum of
/// curvature times area over a closed surface like a sphere is exactly 4π. It means nothing at a boundary and is 0
/// at atoms without area.
pub fn gaussian_curvature(surface: &Surface) -> Vec<f64> {
    let mut left = vec![2.0 * PI; surface.positions.len()];
    for &facet in &surface.facets {
        let corners = surface.corners(facet);
        for k in 0..3 {
            let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
            left[facet[k] as usize] -= u.cross(&v).norm().atan2(u.dot(&v));
        }
    }
    let areas = mixed_areas(surface);
    left.iter().zip(areas).map(|(angle, area)| if area > 0.0 { angle / area } else { 0.0 }).collect()
}

/// Cotangent of the angle of a facet at corner `k`; 0 in a degenerate facet.
fn cotangent(corners: &[Vec3; 3], k: usize) -> f64 {
    let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
    let doubled_area = u.cross(&v).norm();
    if doubled_area > 0.0 { u.dot(&v) / doubled_area } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Topology, area, icosphere, red_cell, sheet};

    #[test]
    fn a_sphere_bends_by_one_over_its_radius() {
        let radius = 2.5;
        let sphere = icosphere(radius, 3);
        for (mean, gaussian) in mean_curvature(&sphere).iter().zip(gaussian_curvature(&sphere)) {
            // The error of the formulas falls with the square of the edge, (0.16)²/3 = 0.9 % at 642 atoms, and more
            // where an atom's facets differ.
            assert!((mean * radius - 1.0).abs() < 0.01, "{mean}");
            assert!((gaussian * radius * radius - 1.0).abs() < 0.03, "{gaussian}");
        }
    }

    #[test]
    fn gaussian_curvature_of_a_closed_cell_adds_up_to_four_pi() {
        let cell = red_cell(7.82, 2);
        let total: f64 = gaussian_curvature(&cell).iter().zip(mixed_areas(&cell)).map(|(k, a)| k * a).sum();
        assert!((total - 4.0 * PI).abs() < 1e-10); // round-off only: the theorem of Gauss and Bonnet is exact here
        assert!((mixed_areas(&cell).iter().sum::<f64>() - area(&cell)).abs() < 1e-10);
        // The dimple bends inwards, the rim outwards.
        assert!(mean_curvature(&cell)[0] < 0.0);
    }

    #[test]
    fn a_sheet_is_flat_inside() {
        let flat = sheet(2.0, 2.0, 5, 4);
        let (mean, gaussian) = (mean_curvature(&flat), gaussian_curvature(&flat));
        for (atom, ring) in Topology::of(&flat).rings.iter().enumerate().filter(|(_, ring)| ring.closed) {
            assert!(mean[atom].abs() < 1e-12 && gaussian[atom].abs() < 1e-12, "atom {atom} of {ring:?}");
        }
    }
}
