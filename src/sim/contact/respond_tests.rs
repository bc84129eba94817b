//! Columns of cells that have a stiffness of their own against the implicit step itself.

use nalgebra::{DMatrix, Rotation3, SymmetricEigen};

use super::model::ContactModel;
use super::respond::find_columns;
use super::rows::{Pairing, Row};
use crate::Vec3;
use crate::contact::Reach;
use crate::geometry::icosphere;
use crate::mechanics::Force;
use crate::mechanics::integrator::{Integrator, Method, Order, StepSize};
use crate::mechanics::membrane::{Membrane, MembraneLaw};
use crate::mechanics::viscosity::Viscosity;
use crate::sim::implicit::advance_implicitly;
use crate::sim::kind::Kind;
use crate::sim::model::Model;
use crate::sim::state::{State, vector};
use crate::sim::workspace::Workspace;

/// A step in which the softest shapes take back as much as is left, and dilation two hundred times that, s.
const DT: f64 = 0.05;

/// Cells at rest, each turned by another angle, whose membrane resists area a hundred times more than shear, and its rates as much as drag does if it
/// is viscous.
fn cells(count: usize, order: Order, is_viscous: bool) -> (Model, State) {
    let ball = icosphere(5.0, 1);
    let law = MembraneLaw::Skalak { shear: 3.0, area: 500.0 };
    let membrane = Force::Membrane(Membrane::new(&ball.positions, &ball.facets, law));
    let mut kind = Kind::new("ball", ball, vec![membrane]);
    kind.drag = 0.5;
    kind.viscosity = is_viscous.then(|| Viscosity::new(&kind.rest.facets, 0.4, 1.0));
    kind.bound_stiffness();
    kind.use_tangent(false);
    assert!(kind.tangent.is_some());
    let kind = kind.for_cells(count);
    let reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 };
    let turned = |cell: usize| -> Vec<Vec3> {
        let turn = Rotation3::from_euler_angles(0.3 * cell as f64, 0.1 + 0.2 * cell as f64, 0.5);
        kind.rest.positions.iter().map(|x| turn * x + Vec3::new(11.0 * cell as f64, 0.0, 0.0)).collect()
    };
    let positions = vec![(0..count).map(turned).collect()];
    let integrator = Integrator { method: Method::Implicit { order }, size: StepSize::Fixed(DT) };
    let mut model = Model::of(vec![kind], integrator, 1.0);
    model.contact = Some(ContactModel::new(&model.kinds, &[], reach));
    let state = State::new(&model, &positions);
    (model, state)
}

/// Rows of an atom on an obstacle, and of an atom of each cell on facets of the next, some of which bear shear; so many of the latter that there are
/// more of them than atoms that they touch, or one.
fn rows(model: &Model, cells: usize, is_crowded: bool) -> Vec<Row> {
    let kind = &model.kinds[0];
    let (count, facets) = (kind.atoms() as u32, &kind.rest.facets);
    let row = |number: u32, atoms: [u32; 4], pairing| {
        let normal = Vec3::new(0.3 + 0.1 * f64::from(number % 5), -0.5, 0.8 - 0.2 * f64::from(number % 3)).normalize();
        let normal_and_gap = [normal.x as f32, normal.y as f32, normal.z as f32, 0.01];
        let shear = if number.is_multiple_of(3) { 1.0 } else { 0.0 };
        Row { atoms, coordinates: [0.2, 0.5], normal_and_gap, shear, pairing, ..Row::NOTHING }
    };
    let mut rows: Vec<Row> = (0..5).map(|number| row(number, [7 * number; 4], Pairing::AtomOnObstacle)).collect();
    for cell in 0..cells as u32 {
        let (own, next) = (cell * count, (cell + 1) % cells as u32 * count);
        let [a, b, c] = facets[(9 * cell + 3) as usize].map(|atom| next + atom);
        rows.push(row(cell, [own + 11, a, b, c], Pairing::AtomOnFacet));
        if is_crowded {
            rows.extend((0..30).map(|number| row(number, [own + 11, b, c, a], Pairing::AtomOnFacet)));
        }
    }
    rows
}

/// Displacements of all atoms of all cells in a step in which these forces act on them, µm.
fn stepped(model: &Model, state: &State, order: Order, forces: &[Vec3], ws: &mut Workspace) -> (Vec<Vec3>, State) {
    let mut next = state.clone();
    ws.suit(model, state);
    ws.contact.forces.carried = forces.to_vec();
    advance_implicitly(model, DT, order, state, &mut next, ws);
    let (kind, now, then) = (&model.kinds[0], &state.kinds[0], &next.kinds[0]);
    let atoms = (0..now.cells()).flat_map(|cell| (0..kind.atoms()).map(move |atom| (cell, atom)));
    let moved =
        atoms.map(|(cell, atom)| vector(kind, &then.positions, cell, atom) - vector(kind, &now.positions, cell, atom));
    (moved.collect(), next)
}

#[test]
fn columns_are_what_the_step_makes_of_a_force_and_symmetric_and_positive() {
    let all =
        [(1, Order::First, false), (1, Order::Second, false), (9, Order::Second, false), (2, Order::Second, true)];
    for ((count, order, is_crowded), is_viscous) in all.into_iter().flat_map(|of| [(of, false), (of, true)]) {
        let (model, state) = cells(count, order, is_viscous);
        let mut ws = Workspace::new(&model);
        let atoms = count * model.kinds[0].atoms();
        let free = stepped(&model, &state, order, &vec![Vec3::zeros(); atoms], &mut ws).1;
        let rows = rows(&model, count, is_crowded);
        let mut scratch = ws.clone();
        let s = &mut scratch.contact;
        let contact = s.scene(&model, &state.kinds).expect("contacts");
        s.rows.clone_from(&rows);
        s.mobility.columns.begin([true].into_iter());
        scratch.buffers.suit(&model);
        find_columns(&model, &contact, DT, (&state, &free), s, &mut scratch.kinds, &scratch.buffers);
        let columns = &s.mobility.columns;
        (0..count).for_each(|body| assert_eq!(!columns.touched_of(body).is_empty(), is_crowded, "{body}"));
        // Each row under a small force along each of its directions, both ways.
        let epsilon = 1e-3;
        let mut found = Vec::new();
        for (number, row) in rows.iter().enumerate() {
            let bears_shear = row.shear > 0.0;
            let directions: Vec<Vec3> =
                if bears_shear { (0..3).map(|axis| Vec3::ith(axis, 1.0)).collect() } else { vec![row.normal()] };
            for direction in directions {
                let at = |sign: f64, ws: &mut Workspace| {
                    let mut forces = vec![Vec3::zeros(); atoms];
                    for (atom, weight) in row.atoms.iter().zip(row.weights()) {
                        forces[*atom as usize] += sign * epsilon * weight * direction;
                    }
                    stepped(&model, &state, order, &forces, ws).0
                };
                let (plus, minus) = (at(1.0, &mut ws), at(-1.0, &mut ws));
                let true_one: Vec<Vec3> = plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * epsilon)).collect();
                let mut moved = vec![[0.0; 4]; atoms];
                let [x, y, z] = <[f64; 3]>::from(direction);
                let normal = <[f64; 3]>::from(row.normal());
                let together = super::together::Together::new(&mut moved);
                columns.push(number, &[normal[0], normal[1], normal[2], 0.0], &[x, y, z, 0.0], &together);
                let size = true_one.iter().map(Vec3::norm).fold(0.0, f64::max);
                for (by_column, true_one) in moved.iter().zip(&true_one) {
                    let off = (Vec3::new(by_column[0], by_column[1], by_column[2]) - true_one).norm();
                    // What the differences leave: a force bends the response by its square.
                    assert!(off < 2e-6 * size, "{count} cells, row {number}: {by_column:?} and {true_one}");
                }
                found.push((row, direction, moved));
            }
        }
        let apart = |row: &Row, direction: &Vec3, moved: &[[f64; 4]]| -> f64 {
            let parts = row.atoms.iter().zip(row.weights());
            parts
                .map(|(atom, w)| {
                    let [x, y, z, _] = moved[*atom as usize];
                    w * direction.dot(&Vec3::new(x, y, z))
                })
                .sum()
        };
        let size = found.len();
        let matrix = DMatrix::from_fn(size, size, |i, j| apart(found[i].0, &found[i].1, &found[j].2));
        let largest = matrix.amax();
        assert!((&matrix - matrix.transpose()).amax() < 1e-6 * largest, "symmetric");
        let least = SymmetricEigen::new(0.5 * (&matrix + matrix.transpose())).eigenvalues.min();
        // More rows than motions of their atoms have combinations that move nothing, but for round-off.
        assert!(if is_crowded { least > -1e-12 * largest } else { least > 0.0 }, "positive: {least}");
        for (number, row) in rows.iter().enumerate() {
            let [along, across] = columns.response(number, row);
            let own = |direction: &Vec3| {
                let moved = &found.iter().find(|(other, by, _)| std::ptr::eq(*other, row) && by == direction)?.2;
                Some(apart(row, direction, moved))
            };
            if let Some(found) = own(&row.normal()) {
                assert!((along / found - 1.0).abs() < 1e-6, "{along} and {found}");
            } else {
                let trace: f64 = (0..3).filter_map(|axis| own(&Vec3::ith(axis, 1.0))).sum();
                assert!(along + across <= trace * (1.0 + 1e-6) && along + 2.0 * across >= trace * (1.0 - 1e-6));
            }
        }
    }
}
