//! The schemes with inertia and explicit Euler: trajectories that are known, orders of convergence, momentum, energy,
//! exact volume, and that scratch is scratch.

use pseudopod::Vec3;
use pseudopod::geometry::{self, Surface, Topology, icosphere};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::gravity::Gravity;
use pseudopod::mechanics::integrator::{Integrator, Method, StepSize};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::mechanics::springs::{Spring, Springs};
use pseudopod::sim::{Kind, Model, State, VolumeRule, Workspace, step};

const INERTIAL: [Method; 4] = [Method::Euler, Method::SemiImplicitEuler, Method::Verlet, Method::RungeKutta4];

fn model(kind: Kind, method: Method, dt: f64, until: f64) -> Model {
    let integrator = Integrator { method, size: StepSize::Fixed(dt) };
    Model::of(vec![kind], integrator, until)
}

/// Two atoms on a spring of 3 pN/µm and 1 µm at rest, a facet of no matter; mass 0.5 mg each.
fn pair(drag: f64) -> Kind {
    let surface = Surface { positions: vec![Vec3::zeros(), Vec3::x(), Vec3::y()], facets: vec![[0, 1, 2]] };
    let spring = Spring { from: 0, to: 1, rest_length: 1.0, stiffness: 3.0 };
    let mut kind = Kind::new("pair", surface, vec![Force::Springs(Springs::between(vec![spring]))]);
    (kind.drag, kind.mass, kind.volume) = (drag, 0.5, VolumeRule::Free);
    kind
}

/// Half the change of the spring's length after it was drawn out by 0.4 µm and let go, at the end of the run.
fn elongation(method: Method, drag: f64, dt: f64, until: f64) -> f64 {
    let model = model(pair(drag), method, dt, until);
    let mut state = State::new(&model, &[vec![vec![-0.2 * Vec3::x(), 1.2 * Vec3::x(), Vec3::y()]]]);
    let mut ws = Workspace::new(&model);
    while state.time < until {
        step(&model, &mut state, &mut ws).unwrap();
    }
    let x = &state.kinds[0].positions;
    0.5 * (x[3] - x[0] - 1.0)
}

/// The same in closed form: each atom swings about the middle with twice the spring's stiffness.
fn exact(drag: f64, time: f64) -> f64 {
    let (rate, squared) = (0.5 * drag / 0.5, 2.0 * 3.0 / 0.5);
    let swing = (squared - rate * rate).sqrt();
    0.2 * (-rate * time).exp() * ((swing * time).cos() + rate / swing * (swing * time).sin())
}

#[test]
fn each_inertial_scheme_follows_a_damped_swing_with_its_order() {
    // The largest error at a few times: at a single one the leading term may be near zero.
    let error = |method: Method, dt: f64| {
        let at = |until: f64| (elongation(method, 0.7, dt, until) - exact(0.7, until)).abs();
        [0.8, 1.0, 1.2, 1.6, 2.0].map(at).into_iter().fold(0.0, f64::max)
    };
    for (method, order) in INERTIAL.into_iter().zip([1.0, 1.0, 2.0, 4.0]) {
        let errors = [0.02, 0.01, 0.005].map(|dt| error(method, dt));
        let found = (errors[1] / errors[2]).log2();
        println!("{method:?}: errors {errors:?}, order {found:.2}");
        // The next order's term at these steps.
        assert!((found - order).abs() < 0.15, "{method:?}: order {found}");
        assert!(errors[2] < 0.01, "{method:?}: {errors:?}");
    }
}

#[test]
fn verlet_and_semi_implicit_euler_keep_the_energy_of_a_free_swing() {
    for method in [Method::SemiImplicitEuler, Method::Verlet] {
        let dt = 0.05;
        let model = model(pair(0.0), method, dt, 1e9);
        let mut state = State::new(&model, &[vec![vec![-0.2 * Vec3::x(), 1.2 * Vec3::x(), Vec3::y()]]]);
        let mut ws = Workspace::new(&model);
        let energy = |state: &State| {
            let (x, v) = (&state.kinds[0].positions, &state.kinds[0].velocities);
            0.25 * v.iter().map(|v| v * v).sum::<f64>() + 1.5 * (x[3] - x[0] - 1.0).powi(2)
        };
        let start = energy(&state);
        let mut worst: f64 = 0.0;
        // A thousand periods of 1.8 s.
        for _ in 0..36_000 {
            step(&model, &mut state, &mut ws).unwrap();
            worst = worst.max((energy(&state) / start - 1.0).abs());
        }
        println!("{method:?}: energy within {worst:.3} of its start over a thousand periods");
        // The energy of a symplectic scheme swings by about ω dt (first order) and (ω dt)²/4 (second), and does not drift.
        let bound = if method == Method::Verlet { 0.01 } else { 0.12 };
        assert!(worst < bound, "{method:?}: {worst}");
    }
}

#[test]
fn a_body_falls_as_gravity_and_drag_say() {
    let surface = icosphere(2.0, 1);
    for method in INERTIAL {
        let weight = Force::Gravity(Gravity { acceleration: Vec3::new(0.0, 0.0, -5.0) });
        let mut kind = Kind::new("stone", surface.clone(), vec![weight]);
        (kind.drag, kind.mass) = (0.3, 0.6);
        let model = model(kind, method, 1e-3, 2.0);
        let mut state = State::new(&model, &[vec![surface.positions.clone()]]);
        let mut ws = Workspace::new(&model);
        while state.time < 2.0 {
            step(&model, &mut state, &mut ws).unwrap();
        }
        let rate: f64 = 0.3 / 0.6;
        let terminal = -5.0 / rate;
        let exact = terminal * (2.0 - (1.0 - (-rate * 2.0f64).exp()) / rate);
        let cell = state.kinds[0].cell(&model.kinds[0], 0);
        for (now, then) in cell.iter().zip(&surface.positions) {
            let fallen = now - then;
            // First order schemes are off by about g t dt/2 = 5e-3.
            assert!((fallen.z - exact).abs() < 6e-3 && fallen.xy().norm() < 1e-9, "{method:?}: {fallen:?} {exact}");
        }
    }
}

#[test]
fn without_drag_a_body_falls_by_half_g_t_squared() {
    let surface = icosphere(2.0, 1);
    let (g, dt, until): (f64, f64, f64) = (5.0, 0.01, 2.0);
    for method in INERTIAL {
        let weight = Force::Gravity(Gravity { acceleration: Vec3::new(0.0, 0.0, -g) });
        let mut kind = Kind::new("stone", surface.clone(), vec![weight]);
        (kind.drag, kind.mass) = (0.0, 0.6);
        let model = model(kind, method, dt, until);
        let mut state = State::new(&model, &[vec![surface.positions.clone()]]);
        let mut ws = Workspace::new(&model);
        while state.time < until {
            step(&model, &mut state, &mut ws).unwrap();
        }
        // Sums of t = n dt: the Euler schemes take the velocity of one end of each step, the others integrate g exactly.
        let lag = match method {
            Method::Euler => -0.5 * g * until * dt,
            Method::SemiImplicitEuler => 0.5 * g * until * dt,
            _ => 0.0,
        };
        let exact = -(0.5 * g * until * until + lag);
        let cell = state.kinds[0].cell(&model.kinds[0], 0);
        let worst = (cell.iter().zip(&surface.positions))
            .map(|(now, then)| (now - then - Vec3::new(0.0, 0.0, exact)).norm())
            .fold(0.0, f64::max);
        println!("{method:?}: {worst:.1e} um from the closed form after {until} s");
        // Round-off of two hundred steps, and of the volume put back exactly in each.
        assert!(worst < 1e-10, "{method:?}: {worst}");
    }
}

/// A cell with shape memory, drawn out and let go; exact volume.
fn cell(cells: usize) -> Kind {
    let surface = icosphere(5.0, 1);
    let rings: Vec<Vec<u32>> = Topology::of(&surface).rings.into_iter().map(|ring| ring.atoms).collect();
    let memory = ShapeMemory::new(&surface.positions, &rings, 10.0, Reaction::Exact);
    let mut kind = Kind::new("cell", surface, vec![Force::ShapeMemory(memory)]);
    (kind.drag, kind.mass) = (1.0, 0.3);
    kind.bound_stiffness();
    kind.for_cells(cells)
}

fn stretched(kind: &Kind) -> Vec<Vec3> {
    kind.rest.positions.iter().map(|p| Vec3::new(p.x / 1.1, p.y / 1.1, p.z * 1.21)).collect()
}

#[test]
fn a_free_cell_keeps_its_volume_its_momentum_and_its_spin_at_rest() {
    for method in INERTIAL.into_iter().chain([Method::Explicit]) {
        let mut kind = cell(1);
        let shape = stretched(&kind);
        if method != Method::Euler {
            kind.drag = 0.2;
        }
        let model = model(kind, method, 2e-3, 1e9);
        let mut state = State::new(&model, &[vec![shape.clone()]]);
        let mut ws = Workspace::new(&model);
        let target = geometry::volume(&model.kinds[0].rest);
        for _ in 0..2000 {
            step(&model, &mut state, &mut ws).unwrap();
            let now = Surface { positions: state.kinds[0].cell(&model.kinds[0], 0), ..model.kinds[0].rest.clone() };
            assert!((geometry::volume(&now) / target - 1.0).abs() < 1e-10, "{method:?}");
        }
        let middle = |positions: &[Vec3]| positions.iter().sum::<Vec3>() / positions.len() as f64;
        let drift = (middle(&state.kinds[0].cell(&model.kinds[0], 0)) - middle(&shape)).norm();
        // Round-off of two thousand steps of a few micrometres.
        assert!(drift < 1e-11, "{method:?}: {drift}");
        if method.is_inertial() {
            let x = state.kinds[0].cell(&model.kinds[0], 0);
            let v: Vec<Vec3> = state.kinds[0].velocities.chunks_exact(3).map(Vec3::from_column_slice).collect();
            let momentum: Vec3 = v.iter().sum();
            let spin: Vec3 = x.iter().zip(&v).map(|(x, v)| x.cross(v)).sum();
            assert!(momentum.norm() < 1e-9 && spin.norm() < 1e-8, "{method:?}: {momentum:?} {spin:?}");
        }
    }
}

#[test]
fn internal_forces_leave_the_momentum_of_a_lopsided_cell() {
    for method in INERTIAL {
        let mut kind = cell(1);
        kind.drag = 0.0;
        // Bent and thrown, so that no symmetry balances the forces.
        let bend = |p: &Vec3| Vec3::new(p.x + 0.04 * p.z * p.z, 1.1 * p.y + 0.02 * p.x * p.z, p.z - 0.1 * p.y);
        let shape: Vec<Vec3> = kind.rest.positions.iter().map(bend).collect();
        let model = model(kind, method, 2e-3, 1e9);
        let mut state = State::new(&model, &[vec![shape.clone()]]);
        for (i, v) in state.kinds[0].velocities.iter_mut().enumerate() {
            *v = ((i * 37 + 11) % 23) as f64 / 23.0 - 0.3;
        }
        let momentum = |state: &State| -> Vec3 {
            state.kinds[0].velocities.chunks_exact(3).map(Vec3::from_column_slice).sum::<Vec3>() * 0.3
        };
        let (start, mut ws) = (momentum(&state), Workspace::new(&model));
        let mut strayed: f64 = 0.0;
        let mut pushed: f64 = 0.0;
        for _ in 0..500 {
            let before = state.kinds[0].velocities[0];
            step(&model, &mut state, &mut ws).unwrap();
            pushed = pushed.max((state.kinds[0].velocities[0] - before).abs());
            strayed = strayed.max((momentum(&state) - start).norm());
        }
        let moved = state.kinds[0].cell(&model.kinds[0], 0).iter().zip(&shape).map(|(a, b)| a - b).sum::<Vec3>() / 42.0;
        let expected = start / (0.3 * 42.0) * state.time;
        println!("{method:?}: momentum {:.3} strays by {strayed:.1e} mg um/s", start.norm());
        assert!(pushed > 1e-3, "{method:?}: the forces act");
        // Round-off of the corrections of 500 steps, each a position error of some 1e-15 µm over a step of 2e-3 s.
        assert!(strayed < 1e-8 * start.norm(), "{method:?}: {strayed}");
        // The first step sets the volume right and moves no middle; afterwards the middle goes straight on.
        assert!((moved - expected).norm() < 1e-9, "{method:?}: {moved:?} {expected:?}");
    }
}

#[test]
fn scratch_is_scratch_for_every_scheme() {
    for method in INERTIAL.into_iter().chain([Method::Explicit]) {
        let model = model(cell(11), method, 2e-3, 1e9);
        let shape = stretched(&model.kinds[0]);
        let (mut clean, mut ws) = (State::new(&model, &[vec![shape.clone(); 11]]), Workspace::new(&model));
        let (mut poisoned, mut bad) = (clean.clone(), Workspace::new(&model));
        for _ in 0..20 {
            bad.poison(&model);
            step(&model, &mut clean, &mut ws).unwrap();
            step(&model, &mut poisoned, &mut bad).unwrap();
            assert_eq!(clean, poisoned, "{method:?}");
        }
    }
}
