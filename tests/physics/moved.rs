//! Atoms that are moved on courses are where these have them, others feel them there, and the force that it takes is told.

use pseudopod::Vec3;
use pseudopod::geometry::Surface;
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::moved::Moved;
use pseudopod::mechanics::springs::{Spring, Springs};
use pseudopod::sim::{AtomBalance, Kind, Model, State, Workspace, step};
use pseudopod::simulation::Simulation;

const STIFFNESS: f64 = 3.0;
const DRAG: f64 = 2.0;
const SPEED: f64 = 0.4;

/// Three atoms in a row on two springs: the first is fixed, the last goes away at a speed.
fn row(order: Order, dt: f64, has_tangent: bool) -> Model {
    let positions: Vec<Vec3> = [0.0, 1.0, 2.0].map(|x| Vec3::new(x, 0.0, 0.0)).into();
    let spring = |from: u32| Spring { from, to: from + 1, rest_length: 1.0, stiffness: STIFFNESS };
    let springs = Force::Springs(Springs::between([0, 1].map(spring).into()));
    let mut kind = Kind::new("row", Surface { positions, facets: vec![[0, 1, 2]] }, vec![springs]);
    kind.drag = DRAG;
    kind.held = [[0.0; 3], [1.0; 3], [0.0; 3]].concat();
    let displacement = Course::through(vec![(0.0, 0.0), (10.0, 10.0 * SPEED)]).expect("times rise");
    kind.moved = vec![Moved { name: "end".into(), atoms: vec![2], direction: Vec3::x(), displacement }];
    kind.bound_stiffness();
    if has_tangent {
        kind.use_tangent();
    }
    let mut model =
        Model::of(vec![kind], Integrator { method: Method::Implicit { order }, size: StepSize::Fixed(dt) }, 1.0);
    model.keeps_tractions = true;
    model
}

/// Where the atom between is at a time, and the force on the last: ζ ẋ = k (x₂ − 2 x) about the state at rest.
fn exact(t: f64) -> (f64, f64) {
    let lag = SPEED * DRAG / (4.0 * STIFFNESS) * (1.0 - (-2.0 * STIFFNESS * t / DRAG).exp());
    let x = 0.5 * SPEED * t - lag;
    (1.0 + x, STIFFNESS * (SPEED * t - x) + DRAG * SPEED)
}

/// What is wrong after a second: the place of the atom between, and the force in the mean over the last step.
fn errors(order: Order, dt: f64, has_tangent: bool) -> (f64, f64) {
    let model = row(order, dt, has_tangent);
    let mut state = State::new(&model, &[vec![model.kinds[0].rest.positions.clone()]]);
    let mut ws = Workspace::new(&model);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    }
    let [start, middle, end] = [0, 1, 2].map(|atom| state.kinds[0].position(&model.kinds[0], 0, atom));
    assert!(start == Vec3::zeros() && (end.x - (2.0 + SPEED)).abs() < 1e-13, "{start} {end}");
    let (x, _) = exact(1.0);
    let force = state.kinds[0].balance[2].held[0];
    let left: Vec3 = state.kinds[0].balance.iter().map(AtomBalance::left).sum();
    assert!(left.norm() < 1e-12, "the forces on the row add up to nothing: {left}");
    ((middle.x - x).abs(), (force - exact(1.0 - 0.5 * dt).1).abs())
}

#[test]
fn what_is_tied_to_a_moved_atom_follows_with_the_order_of_the_scheme() {
    for (order, wanted) in [(Order::First, 1.0), (Order::Second, 2.0)] {
        for has_tangent in [false, true] {
            let [coarse, fine] = [32.0, 64.0].map(|steps| errors(order, 1.0 / steps, has_tangent));
            let orders = [(coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2()];
            println!("{order:?}, tangent {has_tangent}: {orders:?}, {fine:?}");
            assert!((orders[0] - wanted).abs() < 0.2, "{order:?}: {orders:?}");
            // The force in the mean over a step is that of its middle to second order, and the scheme's own error comes to it.
            assert!(orders[1] > wanted - 0.2, "{order:?}: {orders:?}");
        }
    }
}

fn simulation(text: &str) -> Simulation {
    Simulation::from_text("moved.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

/// A shell of constant volume between two grips, of which one goes away until 1 s and rests then.
fn gripped(way: f64) -> String {
    format!(
        "title = \"a shell between grips\"\n[run]\nuntil = \"40 s\"\nintegrator = {{ tolerance = 1e-4 }}\n[cells.shell]\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 2 }}\n\
         mechanics = {{ drag = \"20 pN s/um\", membrane = {{ law = \"skalak\", shear = \"5 pN/um\", area = \"10 pN/um\", bending = \"0.5 pN um\" }} }}\n\
         fixed = [{{ cap = {{ direction = [0, 0, -1], angle = \"30 deg\" }} }}]\n\
         moved = [{{ name = \"grip\", cap = {{ direction = [0, 0, 1], angle = \"30 deg\" }}, direction = [0, 0, 2], displacement = [[\"0 s\", \"0 um\"], [\"1 s\", \"{way} um\"]] }}]\n"
    )
}

#[test]
fn the_force_on_a_grip_is_the_slope_of_the_energy() {
    let energy_and_force = |way: f64| {
        let mut simulation = simulation(&gripped(way));
        simulation.run_until(40.0).unwrap_or_else(|error| panic!("{error}"));
        let value = |name: &str| simulation.series(name).unwrap_or_else(|error| panic!("{error}"))[0];
        assert_eq!(value("displacement.grip"), way);
        let balance = [value("force.grip"), value("holding_force_z"), value("drag_z")];
        assert!(balance[1].abs() < 1e-6 * balance[0] && balance[2].abs() < 1e-6 * balance[0], "{balance:?}");
        (value("energy"), balance[0])
    };
    let (way, apart) = (1.0, 0.02);
    let [before, at, after] = [way - apart, way, way + apart].map(energy_and_force);
    let slope = (after.0 - before.0) / (2.0 * apart);
    println!("{} pN on the grip, energy rises by {slope} pN", at.1);
    // The slope of a line through points so near has an error of their distance squared over that of the shapes.
    assert!(at.1 > 5.0 && (at.1 / slope - 1.0).abs() < 1e-3, "{} {slope}", at.1);
}

#[test]
fn a_plate_that_comes_down_bears_what_the_floor_bears() {
    let text = "title = \"a plate on a cell\"\n[run]\nuntil = \"20 s\"\n[contact]\n\
         [[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.cell]\n\
         mesh = { shape = \"icosphere\", radius = \"5 um\", level = 2 }\nplacement = { at = [[\"0 um\", \"0 um\", \"5.05 um\"]] }\n\
         mechanics = { drag = \"20 pN s/um\", shape_memory = { shape_modulus = \"10 pN/um\" } }\n[cells.plate]\n\
         mesh = { shape = \"box\", size = [\"14 um\", \"14 um\", \"1 um\"], divisions = [4, 4, 1] }\nplacement = { at = [[\"0 um\", \"0 um\", \"10.7 um\"]] }\n\
         mechanics = { drag = \"20 pN s/um\" }\n\
         moved = [{ name = \"down\", all = true, direction = [0, 0, -1], displacement = [[\"0 s\", \"0 um\"], [\"5 s\", \"2 um\"]] }]\n";
    let mut simulation = simulation(text);
    for (time, drag) in [(2.5, 20.0 * 0.4), (20.0, 0.0)] {
        simulation.run_until(time).unwrap_or_else(|error| panic!("{error}"));
        let values = |name: &str| simulation.series(name).unwrap_or_else(|error| panic!("{error}"));
        let way = 0.4 * time.min(5.0);
        assert!((values("position_z")[1] - (10.7 - way)).abs() < 1e-12, "{:?}", values("position_z"));
        let (force, on_floor, of_cell) =
            (values("force.down")[0], values("traction_z")[0], values("traction_of_cells_z"));
        println!("{time} s: {force} pN on the plate, {on_floor} on the floor, {of_cell:?} on each other");
        assert!((of_cell[1] + force - drag).abs() < 1e-5 * force, "what moves the plate bears its drag and the cell");
        assert!((of_cell[0] + of_cell[1]).abs() < 1e-5 * force, "action and reaction");
        if time > 5.0 {
            assert!(force > 10.0 && (on_floor + force).abs() < 1e-3 * force, "{force} {on_floor}");
        }
    }
    assert!(simulation.series("volume_error").is_ok_and(|errors| errors.iter().all(|error| error.abs() < 1e-10)));
}

#[test]
fn moved_atoms_are_on_their_courses_within_steps_too() {
    let mut simulation = simulation(&gripped(1.0).replace("tolerance = 1e-4", "step = \"0.3 s\""));
    simulation.keep(&["displacement.grip"], 0.0).unwrap_or_else(|error| panic!("{error}"));
    simulation.run_until(1.0).unwrap_or_else(|error| panic!("{error}"));
    let times = simulation.history().times().to_vec();
    assert!(times.contains(&1.0), "a step ends where the course bends: {times:?}");
    let positions: Vec<f64> = simulation.snapshot().positions().iter().map(|x| x[2]).collect();
    let highest = positions.iter().copied().fold(0.0, f64::max);
    assert!((highest - 6.0).abs() < 1e-12, "{highest}");
}
