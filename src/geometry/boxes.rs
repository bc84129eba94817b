//! Boxes, such as a cantilever or a block of tissue.

use super::Surface;
use super::sheet::cut_square;
use crate::Vec3;
use std::collections::HashMap;

/// The closed surface of a box centred on the origin, with edges of `size` µm along x, y, z, each side cut into
/// `divisions` equal squares along x, y, z and each square into two facets along alternating diagonals.
///
/// Atoms are numbered in the order in which the sides (−x, +x, −y, +y, −z, +z) first name them.
///
/// # Panics
/// When a number of divisions is 0.
pub fn box_surface(size: [f64; 3], divisions: [u32; 3]) -> Surface {
    assert!(divisions.iter().all(|&count| count > 0), "a box needs at least one division along every axis");
    let mut surface = Surface::default();
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let mut atom = |grid: [u32; 3], positions: &mut Vec<Vec3>| {
        *numbers.entry(grid).or_insert_with(|| {
            let along = |axis: usize| size[axis] * (f64::from(grid[axis]) / f64::from(divisions[axis]) - 0.5);
            positions.push(Vec3::new(along(0), along(1), along(2)));
            positions.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for end in [0, divisions[axis]] {
            for j in 0..divisions[v] {
                for i in 0..divisions[u] {
                    let mut corner = |right: u32, up: u32| {
                        let mut grid = [0; 3];
                        (grid[axis], grid[u], grid[v]) = (end, i + right, j + up);
                        atom(grid, &mut surface.positions)
                    };
                    let mut square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    if end == 0 {
                        square.swap(1, 3); // the far side is seen from the other way round
                    }
                    surface.facets.extend(cut_square(square, i + j));
                }
            }
        }
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Topology;

    #[test]
    fn a_box_is_closed_with_one_atom_per_lattice_point_of_its_surface() {
        let surface = box_surface([1.0, 2.0, 3.0], [2, 3, 4]);
        let topology = Topology::of(&surface);
        assert!(topology.is_closed());
        assert_eq!(topology.euler_characteristic(), 2);
        assert_eq!(surface.positions.len(), 3 * 4 * 5 - 2 * 3); // lattice points less those inside
        assert_eq!(surface.facets.len(), 4 * (2 * 3 + 3 * 4 + 4 * 2));
    }
}
