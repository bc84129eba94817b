//! How large a surface is and where it faces: volume, area, normals, and how the volume answers to every atom.

use super::Surface;
use crate::Vec3;

/// Signed volume enclosed by a closed surface, µm³; negative when the facets face inwards.
///
/// V = 1/6 Σ det(a, b, c) over the facets, with the corners taken from the first atom, so that a cell far from the
/// origin loses no digits. It means nothing for an open surface.
pub fn volume(surface: &Surface) -> f64 {
    let Some(&origin) = surface.positions.first() else { return 0.0 };
    let sixfold: f64 = surface
        .facets
        .iter()
        .map(|&facet| {
            let [a, b, c] = surface.corners(facet).map(|corner| corner - origin);
            a.dot(&b.cross(&c))
        })
        .sum();
    sixfold / 6.0
}

/// Derivative of the volume of a closed surface by the position of every atom, µm².
///
/// ∇ᵢV = 1/6 Σⱼ χⱼ × χⱼ₊₁ over the ring of neighbours χ of atom i: a third of its [`area_vectors`].
pub fn volume_gradient(surface: &Surface) -> Vec<Vec3> {
    let mut gradient = area_vectors(surface);
    gradient.iter_mut().for_each(|vector| *vector /= 3.0);
    gradient
}

/// The area vector of the ring around every atom, µm²: ½ Σⱼ χⱼ × χⱼ₊₁ over the ordered neighbours χ.
///
/// It is summed from the facets around the atom, ½ Σ (b − a) × (c − a), which is the same for a closed ring and
/// stays meaningful on the boundary of an open surface.
pub fn area_vectors(surface: &Surface) -> Vec<Vec3> {
    let mut vectors = vec![Vec3::zeros(); surface.positions.len()];
    for &facet in &surface.facets {
        let half = 0.5 * doubled_area_vector(surface, facet);
        for atom in facet {
            vectors[atom as usize] += half;
        }
    }
    vectors
}

/// The outward unit normal at every atom: the direction of its area vector; zero where that vanishes.
pub fn atom_normals(surface: &Surface) -> Vec<Vec3> {
    let mut normals = area_vectors(surface);
    for normal in &mut normals {
        *normal = normal.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    }
    normals
}

/// Area of the surface, µm².
pub fn area(surface: &Surface) -> f64 {
    surface.facets.iter().map(|&facet| 0.5 * doubled_area_vector(surface, facet).norm()).sum()
}

/// Area of every facet, µm².
pub fn facet_areas(surface: &Surface) -> Vec<f64> {
    surface.facets.iter().map(|&facet| 0.5 * doubled_area_vector(surface, facet).norm()).collect()
}

/// The share of the area that belongs to every atom, µm²: a third of the facets around it.
pub fn atom_areas(surface: &Surface) -> Vec<f64> {
    let mut areas = vec![0.0; surface.positions.len()];
    for &facet in &surface.facets {
        let third = doubled_area_vector(surface, facet).norm() / 6.0;
        for atom in facet {
            areas[atom as usize] += third;
        }
    }
    areas
}

/// Centre of the body that a closed surface encloses, µm; the mean of the atoms where it encloses no volume.
pub fn centre_of_volume(surface: &Surface) -> Vec3 {
    let count = surface.positions.len().max(1) as f64;
    let mean = surface.positions.iter().sum::<Vec3>() / count;
    let mut sixfold = 0.0;
    let mut moment = Vec3::zeros();
    for &facet in &surface.facets {
        let [a, b, c] = surface.corners(facet).map(|corner| corner - mean);
        let tetrahedron = a.dot(&b.cross(&c));
        sixfold += tetrahedron;
        moment += tetrahedron * (a + b + c) / 4.0;
    }
    if sixfold == 0.0 { mean } else { mean + moment / sixfold }
}

/// Mean length of the edges, µm, every edge counted once per facet (once in all on a boundary); 0 without facets.
pub fn mean_edge_length(surface: &Surface) -> f64 {
    let total: f64 = surface
        .facets
        .iter()
        .map(|&facet| {
            let [a, b, c] = surface.corners(facet);
            (b - a).norm() + (c - b).norm() + (a - c).norm()
        })
        .sum();
    if surface.facets.is_empty() { 0.0 } else { total / (3 * surface.facets.len()) as f64 }
}

/// The mean length of the edges of the facets around the atom where it is least, µm; 0 without facets.
pub fn finest_edge_length(surface: &Surface) -> f64 {
    let mut sums = vec![(0.0, 0.0); surface.positions.len()];
    for &facet in &surface.facets {
        let [a, b, c] = surface.corners(facet);
        let around = (b - a).norm() + (c - b).norm() + (a - c).norm();
        for corner in facet {
            let (sum, count) = &mut sums[corner as usize];
            (*sum, *count) = (*sum + around, *count + 3.0);
        }
    }
    let around = sums.iter().filter(|(_, count)| *count > 0.0).map(|(sum, count)| sum / count);
    if surface.facets.is_empty() { 0.0 } else { around.fold(f64::INFINITY, f64::min) }
}

/// The smallest and the largest coordinates of a set of points, µm; `None` without points.
pub fn bounding_box(positions: &[Vec3]) -> Option<(Vec3, Vec3)> {
    let first = *positions.first()?;
    Some(positions.iter().fold((first, first), |(low, high), point| (low.inf(point), high.sup(point))))
}

/// How well shaped every facet is: 4√3 area / (sum of the squared edges), 1 for an equilateral triangle and 0 for a
/// degenerate one.
pub fn facet_qualities(surface: &Surface) -> Vec<f64> {
    surface
        .facets
        .iter()
        .map(|&facet| {
            let [a, b, c] = surface.corners(facet);
            let squares = (b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared();
            let doubled = (b - a).cross(&(c - a)).norm();
            if squares > 0.0 { 2.0 * 3.0_f64.sqrt() * doubled / squares } else { 0.0 }
        })
        .collect()
}

/// The smallest angle in any facet, radians; π/3 at best. Zero for a degenerate facet, infinite without facets.
pub fn smallest_angle(surface: &Surface) -> f64 {
    let mut smallest = f64::INFINITY;
    for &facet in &surface.facets {
        let [a, b, c] = surface.corners(facet);
        for (tip, left, right) in [(a, b, c), (b, c, a), (c, a, b)] {
            let (u, v) = (left - tip, right - tip);
            smallest = smallest.min(u.cross(&v).norm().atan2(u.dot(&v)));
        }
    }
    smallest
}

/// Twice the area of a facet along its outward normal, µm².
fn doubled_area_vector(surface: &Surface, facet: [u32; 3]) -> Vec3 {
    let [a, b, c] = surface.corners(facet);
    (b - a).cross(&(c - a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Topology, box_surface, grade_sphere, icosphere, sheet, translate};
    use std::f64::consts::PI;

    #[test]
    fn a_box_has_the_volume_area_and_centre_of_a_box() {
        let mut surface = box_surface([2.0, 3.0, 5.0], [2, 3, 4]);
        translate(&mut surface, Vec3::new(1e3, -2e3, 7.0));
        // Round-off of positions near 2e3: 2e3 × 2^-53 × area 62 = 1e-11.
        assert!((volume(&surface) - 30.0).abs() < 1e-10);
        assert!((area(&surface) - 62.0).abs() < 1e-10);
        assert!((atom_areas(&surface).iter().sum::<f64>() - 62.0).abs() < 1e-10);
        assert!((facet_areas(&surface).iter().sum::<f64>() - 62.0).abs() < 1e-10);
        assert!((centre_of_volume(&surface) - Vec3::new(1e3, -2e3, 7.0)).norm() < 1e-10);
        let (low, high) = bounding_box(&surface.positions).unwrap();
        assert!((high - low - Vec3::new(2.0, 3.0, 5.0)).norm() < 1e-10);
    }

    #[test]
    fn a_mesh_is_finest_where_it_is_made_so() {
        let mut ball = icosphere(3.0, 3);
        let mean = mean_edge_length(&ball);
        // Edges of an icosphere are shortest about its twelve first corners.
        assert!((0.8..1.0).contains(&(finest_edge_length(&ball) / mean)));
        grade_sphere(&mut ball.positions, &Vec3::z(), 9.0);
        // Edges are a third of what they were there, a little more on the far side of the atom, and three times that opposite.
        assert!((0.8..1.1).contains(&(3.0 * finest_edge_length(&ball) / mean)), "{}", finest_edge_length(&ball) / mean);
    }

    #[test]
    fn the_volume_gradient_is_the_derivative_of_the_volume() {
        let mut surface = icosphere(3.0, 1);
        for (k, position) in surface.positions.iter_mut().enumerate() {
            *position += Vec3::new(5.0 + (k as f64).sin() * 0.3, (2.0 * k as f64).cos() * 0.3, 0.0);
        }
        let gradient = volume_gradient(&surface);
        for atom in [0, 7, 41] {
            for axis in 0..3 {
                let h = 1e-4;
                let mut moved = surface.clone();
                moved.positions[atom][axis] += h;
                let up = volume(&moved);
                moved.positions[atom][axis] -= 2.0 * h;
                let slope = (up - volume(&moved)) / (2.0 * h);
                // The volume is linear in one coordinate, so only round-off is left: 1e-14 × 100 µm³ / 1e-4.
                assert!((slope - gradient[atom][axis]).abs() < 1e-8, "atom {atom} axis {axis}");
            }
        }
    }

    #[test]
    fn area_vectors_are_half_the_sum_of_cross_products_around_the_ring() {
        let surface = icosphere(2.0, 1);
        let topology = Topology::of(&surface);
        let vectors = area_vectors(&surface);
        for (ring, vector) in topology.rings.iter().zip(&vectors) {
            let mut sum = Vec3::zeros();
            for k in 0..ring.atoms.len() {
                let here = surface.positions[ring.atoms[k] as usize];
                let next = surface.positions[ring.atoms[(k + 1) % ring.atoms.len()] as usize];
                sum += 0.5 * here.cross(&next);
            }
            assert!((sum - vector).norm() < 1e-13); // round-off of products near 4
        }
        // The area vectors of a closed surface add up to nothing.
        assert!(vectors.iter().sum::<Vec3>().norm() < 1e-12);
    }

    #[test]
    fn normals_of_a_sphere_point_outwards_and_of_a_sheet_up() {
        let sphere = icosphere(4.0, 3);
        for (normal, position) in atom_normals(&sphere).iter().zip(&sphere.positions) {
            // The mesh is not quite symmetric around an atom: half a degree at 642 atoms.
            assert!(normal.dot(&(position / 4.0)) > 0.9999);
        }
        for normal in atom_normals(&sheet(2.0, 1.0, 4, 3)) {
            assert_eq!(normal, Vec3::z());
        }
    }

    #[test]
    fn facets_of_an_icosahedron_are_equilateral() {
        let surface = icosphere(1.0, 0);
        assert!(facet_qualities(&surface).iter().all(|quality| (quality - 1.0).abs() < 1e-14));
        assert!((smallest_angle(&surface) - PI / 3.0).abs() < 1e-14);
        let edge = 1.0 / (2.0 * PI / 5.0).sin();
        assert!((mean_edge_length(&surface) - edge).abs() < 1e-14);
    }

    #[test]
    fn an_empty_surface_measures_nothing() {
        let nothing = Surface::default();
        assert_eq!((volume(&nothing), area(&nothing), mean_edge_length(&nothing)), (0.0, 0.0, 0.0));
        assert_eq!(finest_edge_length(&nothing), 0.0);
        assert_eq!(centre_of_volume(&nothing), Vec3::zeros());
        assert!(bounding_box(&[]).is_none());
    }
}
