//! What is empty between bodies whose packing is known.

use super::{Body, Points, clearance};
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

/// The largest ball in an aggregate, and the part that is empty.
fn find_empty(bodies: &[Body]) -> Option<(f64, f64)> {
    Points::inside(bodies).map(|points| (points.largest_ball(bodies), points.empty_share(bodies)))
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
    let (ball, share) = find_empty(&at(&positions, &sphere)).expect("an inside");
    // Its centre is found to a thousandth of the distance of points, and an atom of each sphere stands on each axis.
    assert!((ball - (2f64.sqrt() - 1.0)).abs() < 1e-3, "{ball}");
    // Four spheres to a cube. Of 40 000 points a few hundred are so near a surface that chance places them.
    let filled = 4.0 * volume(&sphere) / side.powi(3);
    assert!((share - (1.0 - filled)).abs() < 0.01, "{share}");
}

#[test]
fn boxes_with_slits_between_them_leave_slits() {
    let (side, slit) = (2.0, 0.5);
    let of = |i: usize| Vec3::new((i % 2) as f64, (i / 2 % 2) as f64, (i / 4) as f64) * (side + slit);
    let positions: Vec<Vec3> = (0..8).map(of).collect();
    let (ball, share) = find_empty(&at(&positions, &box_surface([side; 3], [1; 3]))).expect("an inside");
    // Where three slits cross the next corners are farthest.
    assert!((ball - 0.75f64.sqrt() * slit).abs() < 1e-3, "{ball}");
    let slits = 1.0 - (side / (side + slit)).powi(3);
    // Points are a tenth apart: one layer of 25 more or less in each of three slits.
    let layer = 3.0 / 25.0 * (side / (side + slit)).powi(2);
    assert!((share - slits).abs() <= layer, "{share}");
}

#[test]
fn cells_in_one_plane_have_nothing_inside() {
    let positions = [Vec3::zeros(), 2.0 * Vec3::x(), 2.0 * Vec3::y(), 2.0 * Vec3::new(1.0, 1.0, 0.0)];
    assert_eq!(find_empty(&at(&positions, &icosphere(1.0, 1))), None);
    assert_eq!(find_empty(&at(&positions[..1], &icosphere(1.0, 1))), None);
}

#[test]
fn a_clearance_is_the_distance_from_all_facets_of_all_bodies() {
    use crate::contact::{closest_on_facet, winding_number};
    // Balls and a box with corners, at distances that are no one's alone.
    let mut bodies = at(&[Vec3::zeros(), Vec3::new(2.3, 0.4, 0.0), Vec3::new(0.5, 2.2, 0.9)], &icosphere(1.0, 1));
    bodies.extend(at(&[Vec3::new(0.3, 0.4, 2.6)], &box_surface([2.0, 1.0, 3.0], [1; 3])));
    let mut inside = 0;
    for number in 0..1000 {
        let part = |step: usize| (number * step % 1000) as f64 / 1000.0;
        let point = Vec3::new(part(7), part(73), part(619)) * 5.0 - Vec3::repeat(1.3);
        let is_in = |body: &Body| winding_number(point, &body.atoms, &body.facets) > 0.5;
        let corners = |body: &Body, facet: &[u32; 3]| facet.map(|atom| body.atoms[atom as usize]);
        let of_all = bodies.iter().flat_map(|body| body.facets.iter().map(|facet| corners(body, facet)));
        let distances = of_all.map(|corners| closest_on_facet(point, corners).offset.norm());
        let wanted = if bodies.iter().any(is_in) { 0.0 } else { distances.fold(f64::INFINITY, f64::min) };
        inside += usize::from(wanted == 0.0);
        assert_eq!(clearance(&bodies, point), wanted, "{point}");
    }
    assert!((50..900).contains(&inside), "{inside}");
}
