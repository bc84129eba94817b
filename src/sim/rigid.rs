//! The stage that gives rigid bodies back their shape: what moves them in a step, eq. (rigid.1), is linear in their rotation, eq. (rigid.2).

use nalgebra::Matrix3;

use super::kind::Kind;
use super::model::Model;
use crate::Vec3;
use crate::geometry::Beside;

/// Times that a body is lifted onto the obstacles one after the other.
const ROUNDS: usize = 8;

/// Iterations within which a singular value decomposition of nine numbers comes to an end, unless one of them is none.
const DECOMPOSED: usize = 100;

/// Puts the bodies of a block to where the mesh at rest fits their atoms best, and out of the obstacles as a whole.
pub fn make_rigid(model: &Model, kind: &Kind, time: f64, x: &mut [f64]) {
    for lane in 0..kind.lanes {
        let mut body = Body { x, lanes: kind.lanes, lane };
        body.fit(&kind.rest.positions, kind.may_turn());
        body.lift(model, time);
    }
}

/// The atoms of a body in a lane of a block.
struct Body<'a> {
    x: &'a mut [f64],
    lanes: usize,
    lane: usize,
}

impl Body<'_> {
    fn atoms(&self) -> usize {
        self.x.len() / (3 * self.lanes)
    }

    fn at(&self, atom: usize) -> Vec3 {
        Vec3::from_fn(|axis, _| self.x[(3 * atom + axis) * self.lanes + self.lane])
    }

    fn put(&mut self, atom: usize, position: Vec3) {
        (0..3).for_each(|axis| self.x[(3 * atom + axis) * self.lanes + self.lane] = position[axis]);
    }

    /// Puts it to where a mesh, turned and moved, is nearest to its atoms in the mean of squares (Kabsch 1976).
    fn fit(&mut self, rest: &[Vec3], turns: bool) {
        let atoms = self.atoms() as f64;
        let (from, to) =
            (rest.iter().sum::<Vec3>() / atoms, (0..self.atoms()).map(|atom| self.at(atom)).sum::<Vec3>() / atoms);
        let of_atom = |(atom, rest): (usize, &Vec3)| (self.at(atom) - to) * (rest - from).transpose();
        let covariance = || rest.iter().enumerate().map(of_atom).sum::<Matrix3<f64>>();
        let turn = if turns { rotation_of(covariance()) } else { Matrix3::identity() };
        rest.iter().enumerate().for_each(|(atom, rest)| self.put(atom, to + turn * (rest - from)));
    }

    /// Moves it along the normals of the obstacles that it is in.
    fn lift(&mut self, model: &Model, time: f64) {
        for _ in 0..ROUNDS {
            let mut lifted = false;
            for obstacle in &model.obstacles {
                let beside = (0..self.atoms()).map(|atom| obstacle.beside(time, &self.at(atom)));
                let none = Beside { gap: 0.0, normal: Vec3::zeros() };
                let deepest = beside.fold(none, |deepest, one| if one.gap < deepest.gap { one } else { deepest });
                if deepest.gap < 0.0 {
                    let back = deepest.gap * deepest.normal;
                    (0..self.atoms()).for_each(|atom| self.put(atom, self.at(atom) - back));
                    lifted = true;
                }
            }
            if !lifted {
                return;
            }
        }
    }
}

/// The rotation nearest to a matrix; none where one of its numbers is none, which the step finds.
fn rotation_of(matrix: Matrix3<f64>) -> Matrix3<f64> {
    let found = matrix.try_svd(true, true, f64::EPSILON, DECOMPOSED);
    let Some((left, right)) = found.and_then(|found| found.u.zip(found.v_t)) else { return Matrix3::identity() };
    // Singular values fall; the last direction is that of least weight, and alone turned over where the product is a reflection.
    let hand = (left * right).determinant().signum();
    left * Matrix3::from_diagonal(&Vec3::new(1.0, 1.0, hand)) * right
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{box_surface, icosphere};
    use nalgebra::Rotation3;

    fn fitted(rest: &[Vec3], points: &[Vec3]) -> Vec<Vec3> {
        let mut x: Vec<f64> = points.iter().flatten().copied().collect();
        Body { x: &mut x, lanes: 1, lane: 0 }.fit(rest, true);
        x.chunks_exact(3).map(Vec3::from_column_slice).collect()
    }

    #[test]
    fn numbers_that_are_none_end_nothing() {
        let rest = icosphere(3.0, 1).positions;
        let found = fitted(&rest, &vec![Vec3::repeat(f64::NAN); rest.len()]);
        assert!(found.iter().all(|x| x.x.is_nan()), "the step that finds them is told");
    }

    #[test]
    fn a_body_that_was_turned_and_bent_a_little_is_where_it_was_turned_to() {
        for rest in [icosphere(3.0, 1).positions, box_surface([4.0, 2.0, 0.5], [2, 1, 1]).positions] {
            for angle in [0.0, 0.3, 3.1, std::f64::consts::PI] {
                let turn = Rotation3::from_scaled_axis(angle * Vec3::new(0.6, 0.0, 0.8));
                let wanted: Vec<Vec3> = rest.iter().map(|r| turn * r + Vec3::new(1.0, 2.0, 3.0)).collect();
                let found = fitted(&rest, &wanted);
                let off = found.iter().zip(&wanted).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                assert!(off < 1e-13, "{angle}: {off}");
                // Swollen alike, it shrinks back to where it was.
                let centre = Vec3::new(1.0, 2.0, 3.0);
                let swollen: Vec<Vec3> = wanted.iter().map(|x| centre + 1.1 * (x - centre)).collect();
                let swollen = fitted(&rest, &swollen);
                let off = swollen.iter().zip(&wanted).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                assert!(off < 1e-13, "{angle}: {off}");
            }
        }
    }
}
