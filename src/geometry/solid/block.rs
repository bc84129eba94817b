//! Blocks of tissue, gel or a beam.

use super::{Solid, SolidCell, SolidFault};
use crate::Vec3;

/// A filled box centred on the origin, with edges of `size` µm along x, y, z that are cut into so many parts.
///
/// # Errors
/// Flat tetrahedra, where parts are far longer along one axis than along another, or no parts at all.
pub fn block(size: [f64; 3], divisions: [u32; 3]) -> Result<Solid, Vec<SolidFault>> {
    graded_block(size, divisions, [0.0; 3], Grading { ratio: 1.0, even: 0.0 })
}

/// How parts grow away from where they are finest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grading {
    /// How many times as long they are at the end that is farthest.
    pub ratio: f64,
    /// Up to which distance they do not grow, µm.
    pub even: f64,
}

/// The same with parts that are finest at a point within it (µm): along each axis they grow with the distance from it.
///
/// # Errors
/// As [`block`].
pub fn graded_block(
    size: [f64; 3],
    divisions: [u32; 3],
    finest: [f64; 3],
    grading: Grading,
) -> Result<Solid, Vec<SolidFault>> {
    let [nx, ny, nz] = divisions;
    let number = |i: u32, j: u32, k: u32| (k * (ny + 1) + j) * (nx + 1) + i;
    let axes: [Vec<f64>; 3] = std::array::from_fn(|axis| graded(size[axis], divisions[axis], finest[axis], grading));
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

/// Where a length that is centred is cut into parts whose lengths grow with the distance from a point.
fn graded(length: f64, parts: u32, finest: f64, Grading { ratio, even }: Grading) -> Vec<f64> {
    let (low, high) = (-0.5 * length - finest, 0.5 * length - finest);
    let far = high.max(-low) - even;
    let growth = if far > 0.0 { (ratio - 1.0) / far } else { 0.0 };
    // Counted in parts from the finest point on, and back.
    let changed = |s: f64, beyond: fn(f64) -> f64| match s.abs() - even {
        over if growth > 0.0 && over > 0.0 => s.signum() * (even + beyond(growth * over) / growth),
        _ => s,
    };
    let (counted, at) = (|s: f64| changed(s, f64::ln_1p), |u: f64| changed(u, f64::exp_m1));
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
        let at = graded(10.0, 20, 2.0, Grading { ratio: 5.0, even: 0.0 });
        let parts: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert_eq!((at[0], at[20], parts.len()), (-5.0, 5.0, 20));
        let finest = (0..20).min_by(|&a, &b| parts[a].total_cmp(&parts[b])).expect("parts");
        assert!(at[finest] <= 2.0 && at[finest + 1] >= 2.0 - 1e-9, "{at:?}");
        assert!(parts[..finest].is_sorted_by(|a, b| a > b) && parts[finest..].is_sorted(), "{parts:?}");
        let ratio = parts[0] / parts[finest];
        assert!((4.0..5.0).contains(&ratio), "{ratio}");
        for grading in [Grading { ratio: 1.0, even: 0.0 }, Grading { ratio: 9.0, even: 6.0 }] {
            let even = graded(10.0, 4, 1.0, grading);
            assert!(even.iter().zip([-5.0, -2.5, 0.0, 2.5, 5.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{even:?}");
        }
    }

    #[test]
    fn parts_are_even_beside_where_they_are_finest() {
        let at = graded(80.0, 20, 0.0, Grading { ratio: 20.0, even: 6.0 });
        let parts: Vec<f64> = at.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let shortest = parts[10];
        for (part, from) in parts.iter().zip(&at) {
            let nearest = from.abs().min((from + part).abs());
            let farthest = from.abs().max((from + part).abs());
            match nearest {
                _ if farthest <= 6.0 => assert!((part - shortest).abs() < 1e-12, "{parts:?}"),
                // Between the lengths that parts have at both its ends.
                _ => {
                    let there = |far: f64| shortest * (1.0 + 19.0 / 34.0 * (far - 6.0).max(0.0));
                    assert!((there(nearest)..=there(farthest)).contains(part), "{parts:?}");
                }
            }
        }
        assert_eq!((at[0], at[20]), (-40.0, 40.0));
    }
}
