//! Blocks of tissue, gel or a beam.

use super::{Solid, SolidCell, SolidFault};
use crate::Vec3;

/// A filled box centred on the origin, with edges of `size` µm along x, y, z that are cut into so many parts.
///
/// # Errors
/// Flat tetrahedra, where parts are far longer along one axis than along another, or no parts at all.
pub fn block(size: [f64; 3], divisions: [u32; 3]) -> Result<Solid, Vec<SolidFault>> {
    let [nx, ny, nz] = divisions;
    let number = |i: u32, j: u32, k: u32| (k * (ny + 1) + j) * (nx + 1) + i;
    let along = |axis: usize, i: u32| size[axis] * (f64::from(i) / f64::from(divisions[axis]) - 0.5);
    let (mut positions, mut cells) = (Vec::new(), Vec::new());
    for k in 0..=nz {
        for j in 0..=ny {
            positions.extend((0..=nx).map(|i| Vec3::new(along(0, i), along(1, j), along(2, k))));
        }
    }
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let level = |k| [number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k)];
                let ([a, b, c, d], [e, f, g, h]) = (level(k), level(k + 1));
                cells.push(SolidCell::Hexahedron([a, b, c, d, e, f, g, h]));
            }
        }
    }
    Solid::of_cells(&positions, &cells).map(|(solid, _)| solid)
}
