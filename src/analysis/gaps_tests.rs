//! What is empty between bodies whose packing is known.

use super::{Body, find_empty};
use crate::Vec3;
use crate::geometry::{box_surface, icosphere, translate};

/// Bodies of one shape at these places.
fn at(places: &[Vec3], shape: &crate::geometry::Surface) -> Vec<Body> {
    let moved = |place: &Vec3| {
        let mut surface = shape.clone();
        translate(&mut surface, *place);
        Body::new(surface.positions, surface.facets)
    };
    places.iter().map(moved).collect()
}

#[test]
fn spheres_that_touch_in_the_densest_packing_leave_its_holes() {
    // The cube of a face-centred lattice: its corners and the middles of its faces. A quarter of the cube is empty, and in its middle
    // a ball of (√2 − 1) R fits.
    let (radius, side) = (1.0, 8f64.sqrt());
    let of = |i: usize| Vec3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64) * 0.5 * side;
    let places: Vec<Vec3> = (0..27).filter(|i| (i % 3 + i / 3 % 3 + i / 9) % 2 == 0).map(of).collect();
    assert_eq!(places.len(), 14);
    let empty = find_empty(&at(&places, &icosphere(radius, 2))).expect("an inside");
    assert!((empty.largest_ball - (2f64.sqrt() - 1.0)).abs() < 1e-3, "{empty:?}");
    // A sphere of 320 facets has 0.97 of the volume.
    let filled = std::f64::consts::PI / 18f64.sqrt() * 0.97;
    assert!((empty.share - (1.0 - filled)).abs() < 0.01, "{empty:?}");
}

#[test]
fn boxes_with_slits_between_them_leave_slits() {
    let (side, slit) = (2.0, 0.1);
    let of = |i: usize| Vec3::new((i % 2) as f64, (i / 2 % 2) as f64, (i / 4) as f64) * (side + slit);
    let places: Vec<Vec3> = (0..8).map(of).collect();
    let empty = find_empty(&at(&places, &box_surface([side; 3], [1; 3]))).expect("an inside");
    // Where three slits cross the next corners are farthest.
    assert!((empty.largest_ball - 0.75f64.sqrt() * slit).abs() < 1e-3, "{empty:?}");
    let share = 1.0 - (side / (side + slit)).powi(3);
    assert!((empty.share - share).abs() < 0.05, "{empty:?}");
}

#[test]
fn cells_in_one_plane_have_nothing_inside() {
    let places = [Vec3::zeros(), 2.0 * Vec3::x(), 2.0 * Vec3::y(), 2.0 * Vec3::new(1.0, 1.0, 0.0)];
    assert_eq!(find_empty(&at(&places, &icosphere(1.0, 1))), None);
    assert_eq!(find_empty(&at(&places[..1], &icosphere(1.0, 1))), None);
}
