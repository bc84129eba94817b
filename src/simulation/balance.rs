//! What is recorded of the forces between cells and what is around them.

use nalgebra::{Matrix3, SymmetricEigen};

use crate::Vec3;
use crate::output::{Frame, Tractions};
use crate::recorded::TractionRecord;
use crate::sim::{AtomBalance, Model, State};

/// Writes what the atoms of all cells did in the last step, and the sums over each cell; nothing before the first step.
pub fn record_tractions(model: &Model, state: &State, frame: &mut Frame) {
    let mut all = Tractions::default();
    let up = model.obstacles.first().and_then(|obstacle| obstacle.surface.as_plane());
    let mut first_cell = 0;
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for cell in 0..now.cells() {
            let own = cell * kind.atoms()..(cell + 1) * kind.atoms();
            let first_atom = all.traction.len();
            match now.balance.get(own) {
                Some(own) => own.iter().for_each(|atom| all.push(atom)),
                None => (0..kind.atoms()).for_each(|_| all.push(&AtomBalance::NONE)),
            }
            let atoms = first_atom..all.traction.len();
            frame.records[first_cell + cell].traction = of_cell(all.cut(atoms.clone()), &frame.positions[atoms], up);
        }
        first_cell += now.cells();
    }
    frame.tractions = all;
}

impl Tractions {
    fn push(&mut self, atom: &AtomBalance) {
        let AtomBalance { traction, of_cells, drag, outer, inertia, held } = *atom;
        self.traction.push(traction);
        self.of_cells.push(of_cells);
        self.drag.push(drag);
        self.outer.push(outer);
        self.inertia.push(inertia);
        self.held.push(held);
    }

    fn cut(&self, atoms: std::ops::Range<usize>) -> [&[[f64; 3]]; 6] {
        let Self { traction, of_cells, drag, outer, inertia, held } = self;
        [traction, of_cells, drag, outer, inertia, held].map(|list| &list[atoms.clone()])
    }
}

/// Sums of the forces of the atoms of a cell, and the moment of its traction along what it stands on, whose normal is `up`, eq.
/// (traction.2).
fn of_cell(
    [traction, of_cells, drag, outer, inertia, held]: [&[[f64; 3]]; 6],
    positions: &[[f64; 3]],
    up: Option<Vec3>,
) -> TractionRecord {
    let sum = |forces: &[[f64; 3]]| <[f64; 3]>::from(forces.iter().map(|force| Vec3::from(*force)).sum::<Vec3>());
    let along = |vector: Vec3| up.map_or(vector, |up| vector - vector.dot(&up) * up);
    let pulls = || traction.iter().zip(positions).map(|(force, x)| (along(Vec3::from(*force)), along(Vec3::from(*x))));
    let total = traction.iter().map(|force| Vec3::from(*force).norm()).sum();
    let whole: f64 = pulls().map(|(force, _)| force.norm()).sum();
    let mut record = TractionRecord {
        traction: sum(traction),
        of_cells: sum(of_cells),
        drag: sum(drag),
        outer: sum(outer),
        inertia: sum(inertia),
        held: sum(held),
        total,
        ..TractionRecord::default()
    };
    if whole > 0.0 {
        let centre = pulls().map(|(force, x)| force.norm() * x).sum::<Vec3>() / whole;
        let moment: Matrix3<f64> = pulls().map(|(force, x)| (x - centre) * force.transpose()).sum();
        let axes = SymmetricEigen::new(0.5 * (moment + moment.transpose()));
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| axes.eigenvalues[*a].total_cmp(&axes.eigenvalues[*b]));
        let axis: Vec3 = axes.eigenvectors.column(order[0]).into();
        record.dipole = moment.trace();
        record.moment = order.map(|number| axes.eigenvalues[number]);
        // Both ways along an axis are the same: the one with its largest part positive.
        record.axis = (axis * axis[axis.iamax()].signum()).into();
    }
    record
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pulls_towards_each_other_are_a_contractile_dipole_along_their_line() {
        let (pull, apart) = (3.0, 4.0);
        let traction = [[pull, 0.0, 0.0], [-pull, 0.0, 0.0], [0.0; 3]];
        let positions = [[-2.0, 1.0, 0.0], [-2.0 + apart, 1.0, 0.0], [0.0, 9.0, 5.0]];
        let none = [[0.0; 3]; 3];
        let record = of_cell([&traction, &none, &none, &none, &none, &none], &positions, None);
        assert_eq!((record.total, record.dipole, record.traction), (2.0 * pull, -pull * apart, [0.0; 3]));
        assert_eq!((record.moment, record.axis), ([-pull * apart, 0.0, 0.0], [1.0, 0.0, 0.0]));
        // Along a plane what presses on it counts in the total alone.
        let pressed = [[pull, 0.0, -4.0], [-pull, 0.0, 4.0], [0.0; 3]];
        let on_plane = of_cell([&pressed, &none, &none, &none, &none, &none], &positions, Some(Vec3::z()));
        assert_eq!((on_plane.total, on_plane.dipole), (10.0, -pull * apart));
        let still = of_cell([&none, &none, &none, &none, &none, &none], &positions, Some(Vec3::z()));
        assert_eq!(still, TractionRecord::default());
    }
}
