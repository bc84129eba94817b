//! The tangent stiffness against differences of the forces, and its factor against dense matrices.

use super::*;
use crate::geometry::{Topology, icosphere};
use crate::mechanics::bending::{Bending, RestAngle};
use crate::mechanics::membrane::{Membrane, MembraneLaw};
use crate::mechanics::springs::Springs;
use crate::mechanics::sum::measure_elastic;
use crate::mechanics::tension::Tension;

/// The tangent stiffness of one cell, by columns of the whole matrix.
fn whole(forces: &[Force], rest: &[Vec3], x: &[f64]) -> nalgebra::DMatrix<f64> {
    let tangent = Tangent::new(forces, None, rest, LANES);
    let mut values = vec![0.0; tangent.len(1)];
    let scales = Scales { diagonal: 0.0, gamma: 1.0, elastic: &[], held: &[], viscous: None };
    dispatch(1, Make { tangent: &tangent, forces, x, scales, values: &mut values, is_factored: false, whole: true });
    let size = x.len();
    let mut matrix = nalgebra::DMatrix::zeros(size, size);
    for i in 0..rest.len() {
        for j in 0..rest.len() {
            let Some((block, is_turned)) = tangent.pattern.block(i as u32, j as u32) else { continue };
            for (k, value) in values[9 * block..9 * block + 9].iter().enumerate() {
                let (row, column) = if is_turned { (k % 3, k / 3) } else { (k / 3, k % 3) };
                // Of a block on the diagonal all nine numbers are there.
                matrix[(3 * i + row, 3 * j + column)] = *value;
            }
        }
    }
    matrix
}

/// The true stiffness by differences of the forces.
fn by_differences(forces: &[Force], x: &[f64]) -> nalgebra::DMatrix<f64> {
    let (size, epsilon) = (x.len(), 1e-6);
    let force = |column: usize, shift: f64| {
        let mut moved = x.to_vec();
        moved[column] += shift;
        let mut f = vec![0.0; size];
        measure_elastic(forces, 1, &moved, &mut f, &mut [0.0]);
        nalgebra::DVector::from_vec(f)
    };
    let columns: Vec<_> = (0..size).map(|c| (force(c, -epsilon) - force(c, epsilon)) / (2.0 * epsilon)).collect();
    nalgebra::DMatrix::from_columns(&columns)
}

fn flat(x: &[Vec3]) -> Vec<f64> {
    x.iter().flat_map(|p| [p.x, p.y, p.z]).collect()
}

fn laws() -> [MembraneLaw; 2] {
    [
        MembraneLaw::Skalak { shear: 3.0, area: 50.0 },
        MembraneLaw::NeoHookean { shear: 3.0, area: 50.0, hardening: 1.0 / 30.0 },
    ]
}

#[test]
fn at_rest_it_is_the_derivative_of_the_forces() {
    let ball = icosphere(5.0, 1);
    let (rest, topology) = (&ball.positions, Topology::of(&ball));
    let edges = Topology::of(&ball).edges.clone();
    let mut forces: Vec<Force> =
        laws().into_iter().map(|law| Force::Membrane(Membrane::new(rest, &ball.facets, law))).collect();
    forces.push(Force::Bending(Bending::new(rest, &topology, 0.7, RestAngle::Remembered)));
    forces.push(Force::Springs(Springs::on_edges(rest, &edges, 2.0)));
    for force in forces {
        let forces = [force];
        let (found, wanted) = (whole(&forces, rest, &flat(rest)), by_differences(&forces, &flat(rest)));
        let off = (&found - &wanted).amax() / wanted.amax();
        assert!(off < 1e-6, "{off}");
    }
}

#[test]
fn of_a_membrane_that_is_drawn_out_it_is_the_derivative_of_the_forces() {
    // All curvatures of the energy of a facet are positive where it is drawn out a little along both directions, not alike.
    let ball = icosphere(5.0, 1);
    let drawn: Vec<Vec3> =
        ball.positions.iter().map(|p| Vec3::new(1.04 * p.x, 1.03 * p.y + 0.002 * p.x * p.z, 1.06 * p.z)).collect();
    for law in laws() {
        let forces = [Force::Membrane(Membrane::new(&ball.positions, &ball.facets, law))];
        let (found, wanted) = (whole(&forces, &ball.positions, &flat(&drawn)), by_differences(&forces, &flat(&drawn)));
        let off = (&found - &wanted).amax() / wanted.amax();
        assert!(off < 1e-6, "{law:?}: {off}");
    }
}

#[test]
fn it_is_never_negative_and_never_less_than_the_true_stiffness() {
    let ball = icosphere(5.0, 1);
    let bent: Vec<Vec3> = ball
        .positions
        .iter()
        .map(|p| Vec3::new(1.6 * p.x, 0.7 * p.y + 0.05 * p.x * p.z, 0.6 * p.z + 0.04 * p.x * p.x))
        .collect();
    let mut forces: Vec<Force> =
        laws().into_iter().map(|law| Force::Membrane(Membrane::new(&ball.positions, &ball.facets, law))).collect();
    let edges = Topology::of(&ball).edges.clone();
    forces.push(Force::Springs(Springs::on_edges(&ball.positions, &edges, 2.0)));
    for force in forces {
        let forces = [force];
        let (found, wanted) = (whole(&forces, &ball.positions, &flat(&bent)), by_differences(&forces, &flat(&bent)));
        let wanted = (&wanted + wanted.transpose()) * 0.5;
        let size = found.amax();
        let least = |matrix: nalgebra::DMatrix<f64>| nalgebra::SymmetricEigen::new(matrix).eigenvalues.min();
        assert!(least(wanted.clone()) < -1e-3 * size, "a shape in which the true one is not positive");
        assert!(least(found.clone()) > -1e-12 * size);
        assert!(least(found - wanted) > -1e-6 * size);
    }
}

#[test]
fn of_a_bilayer_it_is_more_than_half_of_the_true_stiffness_but_for_little() {
    // Below half of it a step overshoots by more than the whole way; drag, membrane and smaller steps must make up for what is left.
    let ball = icosphere(5.0, 2);
    let long: Vec<Vec3> = ball.positions.iter().map(|p| Vec3::new(1.3 * p.x, 0.9 * p.y, 0.85 * p.z)).collect();
    for shape in [&ball.positions, &long] {
        let forces = [Force::Bending(Bending::new(&ball.positions, &Topology::of(&ball), 0.7, RestAngle::Flat))];
        let (found, wanted) = (whole(&forces, &ball.positions, &flat(shape)), by_differences(&forces, &flat(shape)));
        let half = (&wanted + wanted.transpose()) * 0.25;
        let least = nalgebra::SymmetricEigen::new(&found - half).eigenvalues.min() / found.amax();
        println!("{least}");
        assert!(least > -0.01, "{least}");
    }
}

#[test]
fn tension_resists_along_normals_alone() {
    // A flat sheet has no stiffness in its plane, and the Laplacian's across it.
    let mut positions = Vec::new();
    for i in 0..4 {
        for j in 0..4 {
            positions.push(Vec3::new(f64::from(i) + 0.1 * f64::from(j % 2), f64::from(j), 0.0));
        }
    }
    let at = |i: u32, j: u32| 4 * i + j;
    let facets: Vec<[u32; 3]> = (0..3)
        .flat_map(|i| (0..3).map(move |j| (i, j)))
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]])
        .collect();
    let forces = [Force::Tension(Tension::new(&positions, &facets, 4.0, 0.0))];
    let (found, wanted) = (whole(&forces, &positions, &flat(&positions)), by_differences(&forces, &flat(&positions)));
    for (at, value) in found.iter().enumerate() {
        let (row, column) = (at % found.nrows(), at / found.nrows());
        let wanted = if row % 3 == 2 && column % 3 == 2 { wanted[(row, column)] } else { 0.0 };
        assert!((value - wanted).abs() < 1e-6, "{row} {column}: {value} {wanted}");
    }
}

#[test]
fn its_factor_solves_with_atoms_that_are_held_and_in_every_lane() {
    let ball = icosphere(5.0, 2);
    let rest = &ball.positions;
    let forces = [Force::Membrane(Membrane::new(rest, &ball.facets, laws()[0]))];
    let tangent = Tangent::new(&forces, None, rest, LANES);
    let size = 3 * rest.len();
    let mut held = vec![1.0; size];
    (30..36).chain([91]).for_each(|at| held[at] = 0.0);
    // Each lane is drawn out more, and twice as stiff as the one before.
    let shape = |lane: usize| -> Vec<f64> {
        flat(rest)
            .iter()
            .enumerate()
            .map(|(at, x)| if at % 3 == 0 { x * (1.0 + 0.05 * lane as f64) } else { *x })
            .collect()
    };
    let elastic: Vec<f64> = (0..LANES).map(|lane| 2f64.powi(lane as i32)).collect();
    let side = |lane: usize| -> Vec<f64> { (0..size).map(|at| ((at * 7919 + lane) % 101) as f64 - 50.0).collect() };
    let interleaved = |of: &dyn Fn(usize) -> Vec<f64>| -> Vec<f64> {
        let lanes: Vec<Vec<f64>> = (0..LANES).map(of).collect();
        (0..size).flat_map(|at| lanes.iter().map(move |lane| lane[at]).collect::<Vec<_>>()).collect()
    };
    let scales = Scales { diagonal: 2.0, gamma: 0.7, elastic: &elastic, held: &held, viscous: None };
    let mut factor = vec![f64::NAN; tangent.len(LANES)];
    tangent.factor(&forces, LANES, &interleaved(&shape), scales, &mut factor);
    let mut y = interleaved(&side);
    tangent.solve(LANES, &factor, &mut y);
    for lane in 0..LANES {
        let mut matrix = whole(&forces, rest, &shape(lane)) * (0.7 * elastic[lane]);
        let mut right = nalgebra::DVector::from_vec(side(lane));
        for at in 0..size {
            matrix[(at, at)] += 2.0;
        }
        for at in (0..size).filter(|at| held[*at] == 0.0) {
            matrix.row_mut(at).fill(0.0);
            matrix.column_mut(at).fill(0.0);
            matrix[(at, at)] = 1.0;
        }
        let mut alone: Vec<f64> = right.iter().copied().collect();
        let own: Vec<f64> = factor.iter().skip(lane).step_by(LANES).copied().collect();
        tangent.solve(1, &own, &mut alone);
        let found = nalgebra::DVector::from_iterator(size, y.iter().skip(lane).step_by(LANES).copied());
        assert_eq!(alone, found.as_slice(), "one lane alone");
        right -= &matrix * &found;
        assert!(right.amax() < 1e-9, "{lane}: {}", right.amax());
    }
}

/// A block that is pressed beyond what it bears upright has no factor of its whole stiffness, and takes that of the positive part.
#[test]
fn a_stiffness_that_is_not_positive_is_told_and_replaced() {
    use crate::geometry::solid::block;
    use crate::mechanics::solid::Solid;
    use crate::mechanics::solid::law::{Elastic, SolidLaw};
    let body = block([1.0, 1.0, 4.0], [1, 1, 4]).expect("a sound body");
    let rest = &body.surface.positions;
    let elastic = Elastic { law: SolidLaw::Corotational, shear: 1.0, lame: 0.5 };
    let forces = [Force::Solid(Solid::new(rest, &body.tetrahedra, elastic, None))];
    let tangent = Tangent::new(&forces, None, rest, LANES);
    let at = |by: f64| flat(&rest.iter().map(|p| Vec3::new(p.x, p.y, by * p.z)).collect::<Vec<_>>());
    let made = |x: &[f64], whole: bool| {
        let mut values = vec![0.0; tangent.len(1)];
        let scales = Scales { diagonal: 0.05, gamma: 1.0, elastic: &[], held: &[], viscous: None };
        let work =
            Make { tangent: &tangent, forces: &forces, x, scales, values: &mut values, is_factored: true, whole };
        (dispatch(1, work), values)
    };
    assert!(made(&at(1.1), true).0, "drawn out it is stable");
    let pressed = at(0.5);
    assert!(!made(&pressed, true).0 && made(&pressed, false).0);
    let mut values = vec![0.0; tangent.len(1)];
    let scales = Scales { diagonal: 0.05, gamma: 1.0, elastic: &[], held: &[], viscous: None };
    tangent.factor(&forces, 1, &pressed, scales, &mut values);
    assert_eq!(values, made(&pressed, false).1);
    // What is not clipped is the true stiffness.
    let (found, expected) = (whole(&forces, rest, &at(0.9)), by_differences(&forces, &at(0.9)));
    assert!((&found - &expected).amax() < 1e-6 * expected.amax(), "off by {}", (&found - &expected).amax());
}

/// The matrix of a filled block of 5 x 5 x 8 atoms that is bent, some of its numbers held.
fn filled() -> (Vec<Vec3>, Vec<Force>, Vec<f64>, Vec<f64>) {
    use crate::geometry::solid::block;
    use crate::mechanics::solid::Solid;
    use crate::mechanics::solid::law::{Elastic, SolidLaw};
    let body = block([2.0, 2.0, 4.0], [4, 4, 7]).expect("a sound body");
    let rest = body.surface.positions;
    let elastic = Elastic { law: SolidLaw::NeoHookean, shear: 1.0, lame: 2.0 };
    let forces = vec![Force::Solid(Solid::new(&rest, &body.tetrahedra, elastic, None))];
    let x = flat(&rest.iter().map(|p| Vec3::new(p.x + 0.02 * p.z * p.z, p.y, 1.05 * p.z)).collect::<Vec<_>>());
    let held = (0..x.len()).map(|at| if at % 17 == 3 || at < 30 { 0.0 } else { 1.0 }).collect();
    (rest, forces, x, held)
}

#[test]
fn fronts_solve_what_columns_solve() {
    let (rest, forces, x, held) = filled();
    let scales = Scales { diagonal: 0.3, gamma: 0.7, elastic: &[], held: &held, viscous: None };
    let [by_columns, by_fronts] = [LANES, 1].map(|lanes| Tangent::new(&forces, None, &rest, lanes));
    assert!(by_columns.fronts.is_none() && by_fronts.fronts.is_some());
    let made = |tangent: &Tangent| {
        let mut values = vec![f64::NAN; tangent.len(1)];
        tangent.factor(&forces, 1, &x, scales, &mut values);
        values
    };
    let (columns, fronts) = (made(&by_columns), made(&by_fronts));
    let side = |lane: usize| -> Vec<f64> { (0..x.len()).map(|at| ((at * 7919 + lane) % 101) as f64 - 50.0).collect() };
    let mut together: Vec<f64> =
        (0..x.len()).flat_map(|at| (0..LANES).map(move |lane| (at, lane))).map(|(at, lane)| side(lane)[at]).collect();
    by_fronts.solve_columns(&fronts, &mut together);
    // Two sets after each other, the first of them on a single atom: each as alone.
    for (tangent, factor) in [(&by_fronts, &fronts), (&by_columns, &columns)] {
        let mut one: Vec<f64> = (0..x.len() * LANES).map(|at| if at < 3 * LANES { at as f64 } else { 0.0 }).collect();
        let mut other: Vec<f64> = (0..x.len() * LANES).map(|at| ((at * 7) % 23) as f64).collect();
        let mut both = [one.as_slice(), &other].concat();
        for alone in [&mut one, &mut other] {
            tangent.solve_columns(factor, alone);
        }
        tangent.solve_columns(factor, &mut both);
        assert_eq!(both, [one, other].concat());
    }
    for lane in 0..LANES {
        let [mut expected, mut found] = [side(lane), side(lane)];
        by_columns.solve(1, &columns, &mut expected);
        by_fronts.solve(1, &fronts, &mut found);
        let scale = expected.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
        for at in 0..x.len() {
            assert!((found[at] - expected[at]).abs() < 1e-11 * scale, "{at}: {} {}", found[at], expected[at]);
            let one = together[at * LANES + lane];
            assert!((one - expected[at]).abs() < 1e-11 * scale, "{at} of {lane}: {one} {}", expected[at]);
        }
    }
}

/// Wide registers take sums in the order in which single numbers are taken.
#[test]
fn fronts_make_the_same_bits_with_any_registers() {
    let (rest, forces, x, held) = filled();
    let scales = Scales { diagonal: 0.3, gamma: 0.7, elastic: &[], held: &held, viscous: None };
    let tangent = Tangent::new(&forces, None, &rest, 1);
    let mut values = vec![0.0; tangent.len(1)];
    tangent.factor(&forces, 1, &x, scales, &mut values);
    let fronts = tangent.fronts.as_ref().expect("a body large enough");
    let (blocks, wide) = values.split_at(9 * tangent.pattern.blocks());
    let mut plain = vec![0.0; fronts.len()];
    Factorise { fronts, pattern: &tangent.pattern, blocks, factor: &mut plain }.run::<f64>((), 1);
    assert_eq!(plain[..fronts.panels()], wide[..fronts.panels()]);
    let [mut once, mut again] = [x.clone(), x.clone()];
    SolveOne { fronts, factor: &plain, values: &mut once }.run::<f64>((), 1);
    dispatch(LANES, SolveOne { fronts, factor: &plain, values: &mut again });
    assert_eq!(once, again);
}

#[test]
fn fronts_tell_a_matrix_that_is_not_positive() {
    let (rest, forces, x, _) = filled();
    let tangent = Tangent::new(&forces, None, &rest, 1);
    let made = |diagonal: f64, x: &[f64]| {
        let mut values = vec![0.0; tangent.len(1)];
        let scales = Scales { diagonal, gamma: 1.0, elastic: &[], held: &[], viscous: None };
        let work =
            Make { tangent: &tangent, forces: &forces, x, scales, values: &mut values, is_factored: true, whole: true };
        tangent.make(1, work)
    };
    assert!(made(0.3, &x));
    let pressed: Vec<f64> = x.iter().enumerate().map(|(at, x)| if at % 3 == 2 { 0.4 * x } else { *x }).collect();
    assert!(!made(0.01, &pressed));
}
