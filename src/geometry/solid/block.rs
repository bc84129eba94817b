//! Blocks of tissue, gel or a beam.

use super::{Solid, SolidCell, SolidFault};
use crate::Vec3;

/// A filled box centred on the origin, with edges of `size` µm along x, y, z that are cut into so many parts.
///
/// # Errors
/// Flat tetrahedra, where parts are far longer along one axis than along another, or no parts at all.
pub fn block(size: [f64; 3], divisions: [u32; 3]) -> Result<Solid, Vec<SolidFault>> {
    graded_block(size, divisions, [0.0; 3], 1.0)
}

/// The same with parts that are finest at a point within it (µm): along each axis they grow with the distance from it, to `ratio` times as long at
/// the end that is farther.
///
/// # Errors
/// As [`block`].
pub fn graded_block(
    size: [f64; 3],
    divisions: [u32; 3],
    finest: [f64; 3],
    ratio: f64,
) -> Result<Solid, Vec<SolidFault>> {
    let [nx, ny, nz] = divisions;
    let number = |i: u32, j: u32, k: u32| (k * (ny + 1) + j) * (nx + 1) + i;
    let axes: [Vec<f64>; 3] = std::array::from_fn(|axis| graded(size[axis], divisions[axis], finest[axis], ratio));
    let along = |axis: usize, i: u32| axes[axis][i as usize];
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

/// Where a length that is centred is cut into parts whose lengths grow with the distance from a point, to `ratio` times the shortest.
fn graded(length: f64, parts: u32, finest: f64, ratio: f64) -> Vec<f64> {
    let (low, high) = (-0.5 * length - finest, 0.5 * length - finest);
    let growth = (ratio - 1.0) / high.max(-low);
    // Counted in parts from the finest point on, and back.
    let counted = |s: f64| if growth > 0.0 { s.signum() * (growth * s.abs()).ln_1p() / growth } else { s };
    let at = |u: f64| if growth > 0.0 { u.signum() * (growth * u.abs()).exp_m1() / growth } else { u };
    let (first, last) = (counted(low), counted(high));
    let inner = |i: u32| finest + at(first + (last - first) * (f64::from(i) / f64::from(parts)));
    let of = |i: u32| match i {
        0 => -0.5 * length,
        _ if i == parts => 0.5 * length,
        _ => inner(i),
    };
    (0..=parts).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_grow_away_from_where_they_are_finest() {
        let at = graded(10.0, 20, 2.0, 5.0);
        let parts: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert_eq!((at[0], at[20], parts.len()), (-5.0, 5.0, 20));
        let finest = (0..20).min_by(|&a, &b| parts[a].total_cmp(&parts[b])).expect("parts");
        assert!(at[finest] <= 2.0 && at[finest + 1] >= 2.0 - 1e-9, "{at:?}");
        assert!(parts[..finest].is_sorted_by(|a, b| a > b) && parts[finest..].is_sorted(), "{parts:?}");
        let ratio = parts[0] / parts[finest];
        assert!((4.0..5.0).contains(&ratio), "{ratio}");
        let even = graded(10.0, 4, 1.0, 1.0);
        assert!(even.iter().zip([-5.0, -2.5, 0.0, 2.5, 5.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{even:?}");
    }
}
