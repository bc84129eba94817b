//! The stage that gives rigid bodies back their shape: what moves them in a step is linear in their rotation, eq. (rigid.2).

use nalgebra::Matrix3;

use super::kind::Kind;
use super::model::Model;
use crate::Vec3;

/// Times that a body is lifted onto the planes one after the other.
const ROUNDS: usize = 8;

/// Puts the bodies of a block to where the mesh at rest fits their atoms best, and out of the planes as a whole.
pub fn make_rigid(model: &Model, kind: &Kind, x: &mut [f64]) {
    let lanes = kind.lanes;
    let mut own = Vec::with_capacity(kind.atoms());
    for lane in 0..lanes {
        own.clear();
        own.extend((0..kind.atoms()).map(|atom| Vec3::from_fn(|axis, _| x[(3 * atom + axis) * lanes + lane])));
        fit(&kind.rest.positions, kind.may_turn(), &mut own);
        lift(model, &mut own);
        for (atom, position) in own.iter().enumerate() {
            (0..3).for_each(|axis| x[(3 * atom + axis) * lanes + lane] = position[axis]);
        }
    }
}

/// Puts points to where others, turned and moved, are nearest to them in the mean of squares (Kabsch 1976).
fn fit(rest: &[Vec3], turns: bool, points: &mut [Vec3]) {
    let mean = |points: &[Vec3]| points.iter().sum::<Vec3>() / points.len() as f64;
    let (from, to) = (mean(rest), mean(points));
    let covariance = rest.iter().zip(&*points).map(|(r, x)| (x - to) * (r - from).transpose()).sum::<Matrix3<f64>>();
    let turn = if turns { rotation_of(covariance) } else { Matrix3::identity() };
    points.iter_mut().zip(rest).for_each(|(point, rest)| *point = to + turn * (rest - from));
}

/// The rotation nearest to a matrix.
fn rotation_of(matrix: Matrix3<f64>) -> Matrix3<f64> {
    let found = matrix.svd(true, true);
    let (Some(left), Some(right)) = (found.u, found.v_t) else { return Matrix3::identity() };
    // Singular values fall; the last direction is that of least weight, and alone turned over where the product is a reflection.
    let hand = (left * right).determinant().signum();
    left * Matrix3::from_diagonal(&Vec3::new(1.0, 1.0, hand)) * right
}

/// Moves a body along the normals of the planes that it is in.
fn lift(model: &Model, points: &mut [Vec3]) {
    for _ in 0..ROUNDS {
        let mut lifted = false;
        for plane in &model.planes {
            let deepest = points.iter().map(|x| (x - plane.point).dot(&plane.normal)).fold(0.0, f64::min);
            if deepest < 0.0 {
                points.iter_mut().for_each(|x| *x -= deepest * plane.normal);
                lifted = true;
            }
        }
        if !lifted {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{box_surface, icosphere};
    use nalgebra::Rotation3;

    #[test]
    fn a_body_that_was_turned_and_bent_a_little_is_where_it_was_turned_to() {
        for rest in [icosphere(3.0, 1).positions, box_surface([4.0, 2.0, 0.5], [2, 1, 1]).positions] {
            for angle in [0.0, 0.3, 3.1, std::f64::consts::PI] {
                let turn = Rotation3::from_scaled_axis(angle * Vec3::new(0.6, 0.0, 0.8));
                let wanted: Vec<Vec3> = rest.iter().map(|r| turn * r + Vec3::new(1.0, 2.0, 3.0)).collect();
                let mut found = wanted.clone();
                fit(&rest, true, &mut found);
                let off = found.iter().zip(&wanted).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                assert!(off < 1e-14 * 10.0, "{angle}: {off}");
                // Swollen alike, it shrinks back to where it was.
                let centre = Vec3::new(1.0, 2.0, 3.0);
                let mut swollen: Vec<Vec3> = wanted.iter().map(|x| centre + 1.1 * (x - centre)).collect();
                fit(&rest, true, &mut swollen);
                let off = swollen.iter().zip(&wanted).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                assert!(off < 1e-13, "{angle}: {off}");
            }
        }
    }
}
