//! Round cells: spheres made from an icosahedron (the most even facets) and from an octahedron (level rows).

use super::Surface;
use super::topology::half_edges;
use crate::Vec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// The finest icosphere that [`icosphere`] makes: 655 362 atoms.
pub const MAX_ICOSPHERE_LEVEL: u32 = 8;

/// A sphere around the origin, made from an icosahedron whose facets are divided in four `level` times: 12, 42, 162,
/// 642, 2562 … atoms and 20, 80, 320, 1280, 5120 … facets for levels 0, 1, 2, 3, 4 …
///
/// All atoms lie on the sphere of the given radius (µm), so the enclosed volume is a little less than the sphere's.
/// Atom 0 is the pole at +z and atom 11 the pole at −z at every level: a finer sphere keeps the numbers of the atoms
/// of the coarser one and adds one atom per edge, in the order of the sorted edges.
///
/// # Panics
/// When `level` exceeds [`MAX_ICOSPHERE_LEVEL`].
pub fn icosphere(radius: f64, level: u32) -> Surface {
    assert!(level <= MAX_ICOSPHERE_LEVEL, "icosphere level {level} is finer than {MAX_ICOSPHERE_LEVEL}");
    let mut sphere = icosahedron();
    for _ in 0..level {
        sphere = divide_facets(&sphere);
        for position in &mut sphere.positions {
            *position = position.normalize();
        }
    }
    // The poles stay on the axis exactly; normalising them again could only add round-off.
    sphere.positions[0] = Vec3::z();
    sphere.positions[11] = -Vec3::z();
    sphere.positions.iter_mut().for_each(|position| *position *= radius);
    sphere
}

/// A sphere around the origin, made from an octahedron whose edges are split into `divisions` parts:
/// 4 n² + 2 atoms and 8 n² facets, so 66 atoms and 128 facets for 4 divisions.
///
/// The atoms stand in level rows at equal steps of latitude, evenly spaced along each row (1, 4, 8 … 4n … 8, 4, 1
/// atoms from the pole at +z to the pole at −z, numbered in this order, each row from the x axis counter-clockwise
/// seen from +z). All atoms lie on the sphere of the given radius, µm.
///
/// # Panics
/// When `divisions` is 0 or above 1000.
pub fn octasphere(radius: f64, divisions: u32) -> Surface {
    assert!((1..=1000).contains(&divisions), "an octasphere needs 1 to 1000 divisions, not {divisions}");
    let row_length = |row: u32| 4 * row.min(2 * divisions - row).max(1);
    let mut surface = Surface { positions: vec![Vec3::z() * radius], facets: Vec::new() };
    let mut first_of_row = vec![0];
    for row in 1..2 * divisions {
        first_of_row.push(surface.positions.len() as u32);
        let (height, width) = if row == divisions {
            (0.0, 1.0)
        } else {
            let polar = FRAC_PI_2 * f64::from(row) / f64::from(divisions);
            (polar.cos(), polar.sin())
        };
        for column in 0..row_length(row) {
            let azimuth = 2.0 * PI * f64::from(column) / f64::from(row_length(row));
            surface.positions.push(radius * Vec3::new(width * azimuth.cos(), width * azimuth.sin(), height));
        }
    }
    first_of_row.push(surface.positions.len() as u32);
    surface.positions.push(Vec3::z() * -radius);

    // Atom `column` of the quarter `quarter` of a row; a row of half a turn's step k has k atoms in a quarter.
    let atom = |row: u32, quarter: u32, column: u32| {
        let quarter_length = row.min(2 * divisions - row);
        if quarter_length == 0 {
            return first_of_row[row as usize];
        }
        first_of_row[row as usize] + (quarter * quarter_length + column) % (4 * quarter_length)
    };
    for row in 0..divisions {
        let mirror = 2 * divisions - row;
        for quarter in 0..4 {
            for column in 0..=row {
                let at = |row: u32, column: u32| atom(row, quarter, column);
                surface.facets.push([at(row, column), at(row + 1, column), at(row + 1, column + 1)]);
                surface.facets.push([at(mirror, column), at(mirror - 1, column + 1), at(mirror - 1, column)]);
                if column < row {
                    surface.facets.push([at(row, column), at(row + 1, column + 1), at(row, column + 1)]);
                    surface.facets.push([at(mirror, column), at(mirror, column + 1), at(mirror - 1, column + 1)]);
                }
            }
        }
    }
    surface
}

/// The icosahedron with corners on the unit sphere, one of them (atom 0) at +z and the opposite one (11) at −z.
fn icosahedron() -> Surface {
    let height = 1.0 / 5.0_f64.sqrt();
    let width = 2.0 * height;
    let mut positions = vec![Vec3::z()];
    for (level, turn) in [(height, 0.0), (-height, 0.5)] {
        for corner in 0..5 {
            let azimuth = 2.0 * PI * (f64::from(corner) + turn) / 5.0;
            positions.push(Vec3::new(width * azimuth.cos(), width * azimuth.sin(), level));
        }
    }
    positions.push(-Vec3::z());
    let mut facets = Vec::new();
    for corner in 0..5 {
        let next = (corner + 1) % 5;
        let (upper, upper_next, lower, lower_next) = (1 + corner, 1 + next, 6 + corner, 6 + next);
        facets.push([0, upper, upper_next]);
        facets.push([upper, lower, upper_next]);
        facets.push([upper_next, lower, lower_next]);
        facets.push([11, lower_next, lower]);
    }
    Surface { positions, facets }
}

/// Divides every facet in four by the middles of its edges.
fn divide_facets(surface: &Surface) -> Surface {
    let mut edges: Vec<[u32; 2]> = half_edges(&surface.facets).iter().map(|side| side.edge()).collect();
    edges.dedup();
    let mut positions = surface.positions.clone();
    let first_new = positions.len();
    for &[a, b] in &edges {
        positions.push(0.5 * (positions[a as usize] + positions[b as usize]));
    }
    let middle = |a: u32, b: u32| {
        let found = edges.binary_search(&[a.min(b), a.max(b)]).expect("every side of a facet is an edge");
        (first_new + found) as u32
    };
    let mut facets = Vec::with_capacity(4 * surface.facets.len());
    for &[a, b, c] in &surface.facets {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        facets.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Surface { positions, facets }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{area, facet_qualities, volume};

    /// Atoms, facets, volume and area over the sphere's, from the project's table of analytic values
    /// (`analytic/icosphere.json`, computed independently with NumPy from the textbook construction).
    const REFERENCE: [(usize, usize, f64, f64); 5] = [
        (12, 20, 0.605_461_382_912_525_6, 0.761_917_794_492_980_4),
        (42, 80, 0.873_453_200_003_063_9, 0.928_345_323_381_441),
        (162, 320, 0.966_160_748_598_587_7, 0.981_178_175_753_132_6),
        (642, 1280, 0.991_393_842_629_75, 0.995_235_069_677_088),
        (2562, 5120, 0.997_839_171_610_618_1, 0.998_805_006_256_473),
    ];

    #[test]
    fn icospheres_have_the_volume_and_area_of_the_table() {
        let radius = 3.5_f64;
        for (level, (atoms, facets, of_volume, of_area)) in REFERENCE.into_iter().enumerate() {
            let sphere = icosphere(radius, level as u32);
            assert_eq!((sphere.positions.len(), sphere.facets.len()), (atoms, facets));
            let volume_ratio = volume(&sphere) / (4.0 / 3.0 * PI * radius.powi(3));
            let area_ratio = area(&sphere) / (4.0 * PI * radius.powi(2));
            // Round-off of a sum of 5120 terms.
            assert!((volume_ratio - of_volume).abs() < 1e-12, "level {level}: {volume_ratio}");
            assert!((area_ratio - of_area).abs() < 1e-12, "level {level}: {area_ratio}");
        }
    }

    #[test]
    fn all_atoms_lie_on_the_sphere_and_the_poles_on_the_axis() {
        for sphere in [icosphere(2.0, 3), octasphere(2.0, 4)] {
            for position in &sphere.positions {
                assert!((position.norm() - 2.0).abs() < 1e-14);
            }
        }
        let (ico, octa) = (icosphere(2.0, 3), octasphere(2.0, 4));
        assert_eq!((ico.positions[0], ico.positions[11]), (2.0 * Vec3::z(), -2.0 * Vec3::z()));
        assert_eq!((octa.positions[0], octa.positions[65]), (2.0 * Vec3::z(), -2.0 * Vec3::z()));
    }

    #[test]
    fn the_octasphere_of_four_divisions_has_66_atoms_in_level_rows() {
        let sphere = octasphere(1.0, 4);
        assert_eq!((sphere.positions.len(), sphere.facets.len()), (66, 128));
        assert!(volume(&sphere) > 0.9 * 4.0 / 3.0 * PI, "facets face outwards and fill the sphere");
        let equator = sphere.positions.iter().filter(|position| position.z == 0.0).count();
        assert_eq!(equator, 16);
        assert_eq!(octasphere(1.0, 1).positions.len(), 6);
    }

    #[test]
    fn a_finer_icosphere_keeps_the_atoms_of_the_coarser() {
        let (coarse, fine) = (icosphere(1.0, 1), icosphere(1.0, 2));
        for (old, new) in coarse.positions.iter().zip(&fine.positions) {
            assert!((old - new).norm() < 1e-15);
        }
    }

    #[test]
    fn facets_of_spheres_are_well_shaped_at_any_resolution() {
        let spheres = [1, 2, 4, 8, 32].map(|divisions| octasphere(1.0, divisions));
        for sphere in spheres.into_iter().chain((0..5).map(|level| icosphere(1.0, level))) {
            let worst = facet_qualities(&sphere).into_iter().fold(1.0, f64::min);
            assert!(worst > 0.75, "worst facet {worst} of {}", sphere.facets.len());
        }
    }
}
