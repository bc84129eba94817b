//! How long, wide and thick a body is, and along which directions.

use crate::Vec3;
use nalgebra::Matrix3;

/// The three main directions of a set of points, longest extent first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipalAxes {
    /// Mean of the points, µm.
    pub centre: Vec3,
    /// Unit vectors, right-handed. The largest component of the first two is positive.
    pub axes: [Vec3; 3],
    /// Size of the body along each axis, µm: the largest minus the smallest projection.
    pub extents: [f64; 3],
    /// Root mean square distance from the centre along each axis, µm.
    pub spreads: [f64; 3],
}

/// The principal axes of the second moments of a set of points, ordered by the extent of the points along them.
///
/// A body as wide as it is long (a sphere, a red cell seen along its axis) has no single answer: the axes are then any
/// of those that fit. `None` without points or where a position is not finite.
pub fn principal_axes(positions: &[Vec3]) -> Option<PrincipalAxes> {
    if positions.is_empty() {
        return None;
    }
    let count = positions.len() as f64;
    let centre = positions.iter().sum::<Vec3>() / count;
    let mut moments = Matrix3::zeros();
    for position in positions {
        let arm = position - centre;
        moments += arm * arm.transpose();
    }
    moments /= count;
    // Checked before the decomposition, which would never end on NaN.
    if !moments.iter().all(|value| value.is_finite()) {
        return None;
    }
    let found = moments.symmetric_eigen();
    let mut directions: Vec<(Vec3, f64, f64)> = (0..3)
        .map(|k| {
            let axis: Vec3 = found.eigenvectors.column(k).into();
            (axis, extent_along(positions, &axis), found.eigenvalues[k].max(0.0).sqrt())
        })
        .collect();
    directions.sort_by(|one, other| other.1.total_cmp(&one.1));
    let first = with_positive_largest_component(directions[0].0);
    let second = with_positive_largest_component(directions[1].0);
    Some(PrincipalAxes {
        centre,
        axes: [first, second, first.cross(&second)],
        extents: [directions[0].1, directions[1].1, directions[2].1],
        spreads: [directions[0].2, directions[1].2, directions[2].2],
    })
}

/// The size of a set of points along its principal axes, µm, longest first; NaN where a position is not finite, zero
/// without points.
pub fn principal_extents(positions: &[Vec3]) -> [f64; 3] {
    match principal_axes(positions) {
        Some(found) => found.extents,
        None if positions.is_empty() => [0.0; 3],
        None => [f64::NAN; 3],
    }
}

/// The largest minus the smallest projection on an axis, µm.
fn extent_along(positions: &[Vec3], axis: &Vec3) -> f64 {
    let (low, high) = positions.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), position| {
        let along = position.dot(axis);
        (low.min(along), high.max(along))
    });
    high - low
}

/// One of the two senses of an axis, always the same one.
fn with_positive_largest_component(axis: Vec3) -> Vec3 {
    if axis[axis.iamax()] < 0.0 { -axis } else { axis }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{box_surface, icosphere, rotate, scale, translate};
    use nalgebra::UnitQuaternion;

    #[test]
    fn a_turned_ellipsoid_keeps_its_extents_and_shows_its_axes() {
        let mut surface = icosphere(1.0, 3);
        scale(&mut surface, Vec3::new(2.0, 1.0, 5.0));
        let turn = UnitQuaternion::from_scaled_axis(Vec3::new(1.0, 0.4, -0.2));
        rotate(&mut surface, &turn);
        translate(&mut surface, Vec3::new(10.0, 20.0, 30.0));
        let found = principal_axes(&surface.positions).unwrap();
        // The poles of the icosphere are atoms, so 10 is exact; its widths along x and y miss the atoms a little.
        assert!((found.extents[0] - 10.0).abs() < 1e-6, "{:?}", found.extents);
        assert!((found.extents[1] - 4.0).abs() < 0.02 && (found.extents[2] - 2.0).abs() < 0.02);
        assert!(found.axes[0].dot(&(turn * Vec3::z())).abs() > 1.0 - 1e-9);
        assert!((found.centre - Vec3::new(10.0, 20.0, 30.0)).norm() < 1e-12);
        assert!((found.axes[0].cross(&found.axes[1]) - found.axes[2]).norm() < 1e-12);
        // A sphere's atoms have a mean square of a third along every axis.
        assert!((found.spreads[0] - 5.0 / 3.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn extents_are_sorted_longest_first() {
        let surface = box_surface([1.0, 3.0, 2.0], [1, 3, 2]);
        let extents = principal_extents(&surface.positions);
        for (found, wanted) in extents.iter().zip([3.0, 2.0, 1.0]) {
            assert!((found - wanted).abs() < 1e-12, "{extents:?}");
        }
    }

    #[test]
    fn points_that_are_not_finite_give_nan_instead_of_hanging() {
        assert!(principal_extents(&[Vec3::new(f64::NAN, 0.0, 0.0), Vec3::x()])[0].is_nan());
        assert_eq!(principal_extents(&[]), [0.0; 3]);
    }
}
