//! What is empty between bodies whose packing is known.

use super::{Body, find_empty};
use crate::Vec3;
use crate::geometry::{box_surface, icosphere, translate, volume};

/// Bodies of one shape at these points.
fn at(positions: &[Vec3], shape: &crate::geometry::Surface) -> Vec<Body> {
    let moved = |position: &Vec3| {
        let mut surface = shape.clone();
        translate(&mut surface, *position);
        Body::new(surface.positions, surface.facets)
    };
    positions.iter().map(moved).collect()
}

#[test]
fn spheres_that_touch_in_the_densest_packing_leave_its_holes() {
    // The cube of a face-centred lattice: its corners and the middles of its faces. A quarter of the cube is empty, and in its middle
    // a ball of (√2 − 1) R fits.
    let (radius, side) = (1.0, 8f64.sqrt());
    let of = |i: usize| Vec3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64) * 0.5 * side;
    let positions: Vec<Vec3> = (0..27).filter(|i| (i % 3 + i / 3 % 3 + i / 9) % 2 == 0).map(of).collect();
    assert_eq!(positions.len(), 14);
    let sphere = icosphere(radius, 2);
    let empty = find_empty(&at(&positions, &sphere)).expect("an inside");
    // Its centre is found to a thousandth of the distance of points, and an atom of each sphere stands on each axis.
    assert!((empty.largest_ball - (2f64.sqrt() - 1.0)).abs() < 1e-3, "{empty:?}");
    // Four spheres to a cube. Of 40 000 points a few hundred are so near a surface that chance places them.
    let filled = 4.0 * volume(&sphere) / side.powi(3);
    assert!((empty.share - (1.0 - filled)).abs() < 0.01, "{empty:?}");
}

#[test]
fn boxes_with_slits_between_them_leave_slits() {
    let (side, slit) = (2.0, 0.5);
    let of = |i: usize| Vec3::new((i % 2) as f64, (i / 2 % 2) as f64, (i / 4) as f64) * (side + slit);
    let positions: Vec<Vec3> = (0..8).map(of).collect();
    let empty = find_empty(&at(&positions, &box_surface([side; 3], [1; 3]))).expect("an inside");
    // Where three slits cross the next corners are farthest.
    assert!((empty.largest_ball - 0.75f64.sqrt() * slit).abs() < 1e-3, "{empty:?}");
    let share = 1.0 - (side / (side + slit)).powi(3);
    // Points are a tenth apart: one layer of 25 more or less in each of three slits.
    let layer = 3.0 / 25.0 * (side / (side + slit)).powi(2);
    assert!((empty.share - share).abs() <= layer, "{empty:?}");
}

#[test]
fn cells_in_one_plane_have_nothing_inside() {
    let positions = [Vec3::zeros(), 2.0 * Vec3::x(), 2.0 * Vec3::y(), 2.0 * Vec3::new(1.0, 1.0, 0.0)];
    assert_eq!(find_empty(&at(&positions, &icosphere(1.0, 1))), None);
    assert_eq!(find_empty(&at(&positions[..1], &icosphere(1.0, 1))), None);
}
