//! What every force must do (be the gradient of its energy where it says so, leave a free cell alone, see no rotation, run on lanes
//! to the last bit), and in `laws` what each one must do by its own law.

mod cases;
mod laws;

use cases::{
    Case, EDGE, FORCES, cases, cell, context, flat, gradient_error, largest, number, on, on_cell, shaken, stiffness,
};
use nalgebra::{DMatrix, DVector, Rotation3};
use pseudopod::Vec3;
use pseudopod::mechanics::Force;
use pseudopod::mechanics::control::Context;
use pseudopod::mechanics::lanes::LANES;
use pseudopod::mechanics::sum::measure_forces;

/// The cell of a case, moved about.
fn moved_about(case: &Case, seed: usize) -> Vec<Vec3> {
    shaken(&cell().positions, case.shake * EDGE, seed)
}

#[test]
fn every_force_of_the_list_has_a_case() {
    let mut known = [false; FORCES];
    cases().iter().for_each(|case| known[number(&case.force)] = true);
    assert_eq!(known, [true; FORCES], "forces by their number");
}

#[test]
fn every_force_that_says_so_is_the_gradient_of_its_energy() {
    let says_not: Vec<&str> =
        cases().iter().filter(|case| !case.force.is_conservative()).map(|case| case.name).collect();
    assert_eq!(
        says_not,
        [
            "shape memory, spread",
            "ordering",
            "angles",
            "pressure",
            "pressure beyond a plane",
            "torque",
            "pressure in a mouth"
        ]
    );
    for case in cases().iter().filter(|case| case.force.is_conservative()) {
        let positions = moved_about(case, 1);
        let (energy, forces) = on(&case.force, &positions);
        assert!(energy.abs() > 1e-3, "{}: the test must wake the force, its energy is {energy}", case.name);
        // Central differences: 1e-10 of the third derivative, which is largest in the barrier, and round-off 1e-16/1e-5.
        let (error, at) = gradient_error(&case.force, &positions, &forces);
        assert!(error < 1e-7, "{}, {at}: off by {error:e} of the largest force", case.name);
    }
}

#[test]
fn no_force_within_a_cell_moves_it() {
    for case in cases().iter().filter(|case| case.internal) {
        let positions = moved_about(case, 2);
        let (_, forces) = on(&case.force, &positions);
        let total: Vec3 = forces.iter().sum();
        let turn: Vec3 = positions.iter().zip(&forces).map(|(x, f)| x.cross(f)).sum();
        let scale: f64 = forces.iter().map(|f| f.norm()).sum();
        // Sums of some thousand terms of round-off.
        assert!(total.norm() < 1e-13 * scale, "{}: net force {:e} of {scale}", case.name, total.norm());
        if case.turns_nothing {
            assert!(turn.norm() < 1e-12 * scale, "{}: net torque {:e} of {scale}", case.name, turn.norm());
        }
    }
}

#[test]
fn no_force_within_a_cell_sees_where_it_stands_and_how_it_is_turned() {
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let shift = Vec3::new(11.0, -7.0, 5.0);
    for case in cases().iter().filter(|case| case.internal) {
        let positions = moved_about(case, 3);
        let (energy, forces) = on(&case.force, &positions);
        let moved: Vec<Vec3> = positions.iter().map(|x| turn * x + shift).collect();
        let (moved_energy, moved_forces) = on(&case.force, &moved);
        // Positions of 20 µm keep 1e-15 of themselves; the stiffest case, the barrier, multiplies this.
        let off = (moved_energy - energy).abs();
        assert!(off <= 1e-11 * energy.abs(), "{}: energy {energy} became {moved_energy}", case.name);
        for (f, g) in forces.iter().zip(&moved_forces) {
            assert!((turn * f - g).norm() < 1e-11 * largest(&forces), "{}: {f} became {g}", case.name);
        }
    }
}

#[test]
fn the_rest_shape_is_free_of_force() {
    for case in cases().iter().filter(|case| case.rests) {
        let (energy, forces) = on(&case.force, &cell().positions);
        assert!(energy.abs() < 1e-12, "{}: energy {energy:e} at rest", case.name);
        assert!(largest(&forces) < 1e-12, "{}: force {:e} at rest", case.name, largest(&forces));
    }
}

#[test]
fn eight_cells_side_by_side_equal_one_cell_alone_to_the_last_bit() {
    let rest = cell().positions;
    for case in &cases() {
        // Some cells at rest and some far from it: a sleeping lane beside a woken one.
        let cells: Vec<Vec<Vec3>> =
            (0..LANES).map(|lane| shaken(&rest, case.shake * EDGE * 0.2 * lane as f64, lane)).collect();
        let mut x = vec![0.0; 3 * rest.len() * LANES];
        for (lane, positions) in cells.iter().enumerate() {
            flat(positions).into_iter().enumerate().for_each(|(k, value)| x[k * LANES + lane] = value);
        }
        let (mut f, mut energies) = (vec![0.0; x.len()], [0.0; LANES]);
        let forces = std::slice::from_ref(&case.force);
        measure_forces(forces, &context(0..LANES), LANES, &x, &mut f, &mut energies);
        for (lane, positions) in cells.iter().enumerate() {
            let (energy, forces) = on_cell(&case.force, lane, positions);
            assert_eq!(energy.to_bits(), energies[lane].to_bits(), "{}: energy in lane {lane}", case.name);
            for (k, value) in flat(&forces).into_iter().enumerate() {
                assert_eq!(value.to_bits(), f[k * LANES + lane].to_bits(), "{}: lane {lane}, {k}", case.name);
            }
        }
    }
}

#[test]
fn chemistry_scales_elastic_forces_and_nothing_else() {
    for case in &cases() {
        let x = flat(&moved_about(case, 4));
        let measure = |stiffness: &[f64]| {
            let (mut f, mut energy) = (vec![0.0; x.len()], [0.0]);
            let context = Context { stiffness, ..context(0..1) };
            measure_forces(std::slice::from_ref(&case.force), &context, 1, &x, &mut f, &mut energy);
            (f, energy[0])
        };
        // A power of two, so that nothing is rounded.
        let (factor, (plain, energy), (scaled, scaled_energy)) = (4.0, measure(&[]), measure(&[4.0]));
        let factor = if case.force.is_elastic() { factor } else { 1.0 };
        assert_eq!(scaled_energy, factor * energy, "{}", case.name);
        assert_eq!(scaled, plain.iter().map(|f| factor * f).collect::<Vec<_>>(), "{}", case.name);
    }
}

#[test]
fn forces_with_a_course_tell_where_it_bends() {
    for case in &cases() {
        let kinks: Vec<f64> = case.force.kinks().collect();
        let expected = if case.force.course().is_some() { vec![0.0, 1.0] } else { Vec::new() };
        assert_eq!(kinks, expected, "{}", case.name);
    }
}

#[test]
fn a_force_that_chemistry_may_set_follows_its_course_where_nothing_is_set() {
    for case in cases().iter().filter(|case| case.force.handle().is_some()) {
        let positions = moved_about(case, 5);
        let largest_at = |context: &Context| {
            let x = flat(&positions);
            let (mut f, mut energy) = (vec![0.0; x.len()], [0.0]);
            measure_forces(std::slice::from_ref(&case.force), context, 1, &x, &mut f, &mut energy);
            f.iter().fold(0.0_f64, |most, f| most.max(f.abs()))
        };
        // The course rises from 0.4 at 0 s to 1.4 at 1 s.
        let (early, late) = (largest_at(&Context::at(0.2)), largest_at(&Context::at(0.7)));
        assert!((late / early - 1.1 / 0.6).abs() < 1e-12, "{}: {early} and {late}", case.name);
        let set = largest_at(&context(0..1));
        // The first cell's control is 0.9: the activation of fibres, a factor of the load.
        let expected = if let Force::Load(_) = case.force { 0.9 * late } else { 0.9 * late / 1.1 };
        assert!((set / expected - 1.0).abs() < 1e-12, "{}: {set} for {expected}", case.name);
    }
}

#[test]
fn the_linear_part_is_symmetric_positive_and_blind_to_translation() {
    for case in &cases() {
        let stiffness = stiffness(&case.force, &cell().positions);
        let scale = stiffness.amax().max(1e-300);
        assert!((&stiffness - stiffness.transpose()).amax() < 1e-13 * scale, "{}: not symmetric", case.name);
        let drift = (&stiffness * DVector::from_element(42, 1.0)).amax();
        assert!(!case.internal || drift < 1e-12 * scale, "{}: resists drift", case.name);
        let least = stiffness.symmetric_eigenvalues().min();
        assert!(least > -1e-12 * scale, "{}: eigenvalue {least}", case.name);
    }
}

/// The largest ratio of the true stiffness at rest (by differences of the force) to the linear part.
fn stiffness_ratio(force: &Force, positions: &[Vec3]) -> f64 {
    let n = positions.len();
    let step = 1e-5;
    let mut tangent = DMatrix::zeros(3 * n, 3 * n);
    for column in 0..3 * n {
        let forces_at = |by: f64| {
            let mut moved = positions.to_vec();
            moved[column / 3][column % 3] += by;
            DVector::from_vec(flat(&on(force, &moved).1))
        };
        tangent.set_column(column, &((forces_at(-step) - forces_at(step)) / (2.0 * step)));
    }
    let tangent = (&tangent + tangent.transpose()) * 0.5;
    // The linear part on x, y and z; what it does not resist, as drift, the force does not either, and a little is filled in there.
    let linear = stiffness(force, positions);
    let filled = 1e-6 * linear.amax();
    let linear = (linear + DMatrix::identity(n, n) * filled).kronecker(&DMatrix::identity(3, 3));
    let root = linear.cholesky().expect("positive once drift is filled in").l();
    let half = root.solve_lower_triangular(&tangent).expect("regular");
    let whole = root.solve_lower_triangular(&half.transpose()).expect("regular");
    ((&whole + whole.transpose()) * 0.5).symmetric_eigenvalues().max()
}

#[test]
fn the_linear_part_keeps_the_implicit_step_stable_at_rest() {
    // A linearly implicit step of any size is stable when the true stiffness is below twice the linear part.
    for case in cases().iter().filter(|case| case.bounded) {
        let ratio = stiffness_ratio(&case.force, &cell().positions);
        println!("{}: true stiffness at most {ratio:.3} of the linear part", case.name);
        assert!(ratio < 2.0, "{}: the true stiffness is {ratio} of the linear part", case.name);
        assert!(ratio > 0.4, "{}: the linear part slows the step, true stiffness {ratio} of it", case.name);
    }
}
