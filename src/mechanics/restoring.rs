//! How loads hold a cell in its direction: the torque with which they turn it back, eq. (step.13).

use super::control::Context;
use super::{CONTROLLED, Force};
use crate::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

/// The restoring torque of the loads on the cell of a lane over the angle by which it is turned about its centre, pN·µm: of Σ (r·F) − r Fᵀ the
/// symmetric part, and of that what is positive; 0 where loads turn it further, or where there are none. `x` is the block of its positions,
/// µm.
pub fn restoring(forces: &[Force], context: &Context, (lanes, lane): (usize, usize), x: &[f64]) -> Matrix3<f64> {
    let mut sum = Matrix3::zeros();
    let at = |atom: usize| Vec3::from_fn(|axis, _| x[(3 * atom + axis) * lanes + lane]);
    let atoms = x.len() / (3 * lanes);
    let (mut centre, mut number) = (None, 0);
    for force in forces {
        let (Force::Load(load), Some((handle, _))) = (force, force.handle()) else { continue };
        let set = context.control(handle, number, CONTROLLED[handle].unset);
        number += 1;
        let force = load.strength(context.time, &set)[lane];
        if force == 0.0 {
            continue;
        }
        let centre = *centre.get_or_insert_with(|| (0..atoms).map(at).sum::<Vec3>() / atoms as f64);
        for &(atom, share) in &load.atoms {
            let (arm, pull) = (at(atom as usize) - centre, share * force * load.direction);
            sum += Matrix3::from_diagonal_element(arm.dot(&pull)) - arm * pull.transpose();
        }
    }
    if sum == Matrix3::zeros() {
        return sum;
    }
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(0.5 * (sum + sum.transpose()));
    eigenvectors * Matrix3::from_diagonal(&eigenvalues.map(|value| value.max(0.0))) * eigenvectors.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::icosphere;
    use crate::mechanics::course::Course;
    use crate::mechanics::load::Load;
    use nalgebra::Rotation3;

    fn loads(pull: f64) -> Vec<Force> {
        let load = |direction: Vec3, atoms: [u32; 2]| {
            let shares = atoms.map(|atom| (atom, 0.5)).into();
            Force::Load(Load::new("pull", shares, direction, Course::constant(pull)))
        };
        vec![load(Vec3::new(0.6, 0.0, 0.8), [3, 8]), load(-Vec3::new(0.6, 0.0, 0.8), [6, 11])]
    }

    /// The torque of the loads about the centre of a shape.
    fn torque(forces: &[Force], x: &[Vec3]) -> Vec3 {
        let centre = x.iter().sum::<Vec3>() / x.len() as f64;
        let of = |force: &Force| match force {
            Force::Load(load) => {
                let of_atom = |(atom, share): &(u32, f64)| {
                    (x[*atom as usize] - centre).cross(&(*share * load.force.at(0.0) * load.direction))
                };
                load.atoms.iter().map(of_atom).sum::<Vec3>()
            }
            _ => Vec3::zeros(),
        };
        forces.iter().map(of).sum()
    }

    #[test]
    fn loads_turn_a_cell_back_as_their_torque_changes_when_it_is_turned() {
        let (x, forces) = (icosphere(5.0, 1).positions, loads(7.0));
        let flat: Vec<f64> = x.iter().flatten().copied().collect();
        let found = restoring(&forces, &Context::at(0.0), (1, 0), &flat);
        let angle = 1e-6;
        let column = |axis: usize| {
            let turned = |sign: f64| -> Vec<Vec3> {
                let turn = Rotation3::new(sign * angle * Vec3::ith(axis, 1.0));
                x.iter().map(|x| turn * x).collect()
            };
            -(torque(&forces, &turned(1.0)) - torque(&forces, &turned(-1.0))) / (2.0 * angle)
        };
        let slope = Matrix3::from_columns(&[column(0), column(1), column(2)]);
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(0.5 * (slope + slope.transpose()));
        let positive = Matrix3::from_diagonal(&eigenvalues.map(|value| value.max(0.0)));
        let wanted = eigenvectors * positive * eigenvectors.transpose();
        assert!(wanted.norm() > 10.0 && (found - wanted).norm() < 1e-6 * wanted.norm(), "{found} {wanted}");
    }

    #[test]
    fn pulls_apart_hold_a_cell_along_them_and_pushes_in_no_direction() {
        let x = icosphere(5.0, 1).positions;
        let flat: Vec<f64> = x.iter().flatten().copied().collect();
        let opposite = (0..x.len()).find(|atom| (x[*atom] + x[3]).norm() < 1e-9).expect("it is symmetric");
        let of = |pull: f64| {
            let load = |atom: usize| {
                let force = Course::constant(pull);
                Force::Load(Load::new("pull", vec![(atom as u32, 1.0)], x[atom] / x[atom].norm(), force))
            };
            restoring(&[load(3), load(opposite)], &Context::at(0.0), (1, 0), &flat)
        };
        let along = x[3] / 5.0;
        let wanted = 7.0 * 10.0 * (Matrix3::identity() - along * along.transpose());
        assert!((of(7.0) - wanted).norm() < 1e-9, "{}", of(7.0));
        assert!(of(-7.0).norm() < 1e-9 && of(0.0) == Matrix3::zeros(), "{}", of(-7.0));
    }
}
