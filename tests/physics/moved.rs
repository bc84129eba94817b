//! Atoms that are moved on courses are where these have them, others feel them there, and the force that it takes is told.

use pseudopod::Vec3;
use pseudopod::experiment::Document;
use pseudopod::geometry::Surface;
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::moved::{Moved, Rotation, Translation};
use pseudopod::mechanics::springs::{Spring, Springs};
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, run};
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
    let translation = Some(Translation { direction: Vec3::x(), displacement });
    kind.moved = vec![Moved { name: "end".into(), atoms: vec![2], translation, rotation: None }];
    kind.bound_stiffness();
    if has_tangent {
        kind.use_tangent(false);
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
    // Sixty-four displacements are added up.
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
            // Two steps of a halving differ from the limit by the next order's term.
            assert!((orders[0] - wanted).abs() < 0.2, "{order:?}: {orders:?}");
            // The force in the mean over a step is that of its middle to second order, and the scheme's own error comes to it.
            assert!(orders[1] > wanted - 0.2, "{order:?}: {orders:?}");
        }
    }
}

/// An atom on a spring without length to another that goes in a circle: with z = x + iy it is ζ ż = k (e^{iωt} − z), from z = 1 on.
#[test]
fn what_is_tied_to_an_atom_that_turns_follows_with_second_order_and_its_torque_is_told() {
    const TURN: f64 = 1.5;
    let errors = |dt: f64| {
        let spring = Spring { from: 0, to: 1, rest_length: 0.0, stiffness: STIFFNESS };
        let springs = Force::Springs(Springs::between(vec![spring]));
        let positions = vec![Vec3::x(), Vec3::x(), Vec3::zeros()];
        let mut kind = Kind::new("pair", Surface { positions, facets: vec![[0, 1, 2]] }, vec![springs]);
        kind.drag = DRAG;
        kind.held = [[1.0; 3], [0.0; 3], [0.0; 3]].concat();
        let angle = Course::through(vec![(0.0, 0.0), (10.0, 10.0 * TURN)]).expect("times rise");
        let rotation = Some(Rotation { axis: Vec3::z_axis(), through: Vec3::new(0.0, 0.0, 3.0), angle });
        kind.moved = vec![Moved { name: "hand".into(), atoms: vec![1], translation: None, rotation }];
        kind.bound_stiffness();
        let size = StepSize::Fixed(dt);
        let integrator = Integrator { method: Method::Implicit { order: Order::Second }, size };
        let mut model = Model::of(vec![kind], integrator, 1.0);
        model.keeps_tractions = true;
        let mut state = State::new(&model, &[vec![model.kinds[0].rest.positions.clone()]]);
        let mut ws = Workspace::new(&model);
        while state.time < model.until {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        }
        let [tied, hand] = [0, 1].map(|atom| state.kinds[0].position(&model.kinds[0], 0, atom));
        assert!((hand - Vec3::new(TURN.cos(), TURN.sin(), 0.0)).norm() < 1e-13, "{hand}");
        let exact = |t: f64| {
            // z = a/(a + iω) e^{iωt} + iω/(a + iω) e^{−at}, a = k/ζ.
            let (a, fall) = (STIFFNESS / DRAG, (-STIFFNESS / DRAG * t).exp());
            let (sin, cos) = (TURN * t).sin_cos();
            let size = a * a + TURN * TURN;
            let (re, im) =
                (a * (a * cos + TURN * sin) + TURN * TURN * fall, a * (a * sin - TURN * cos) + TURN * a * fall);
            Vec3::new(re / size, im / size, 0.0)
        };
        // The torque of the hand in the middle of the last step: that of the spring and of its own drag.
        let middle = 1.0 - 0.5 * dt;
        let at = Vec3::new((TURN * middle).cos(), (TURN * middle).sin(), 0.0);
        let wanted = STIFFNESS * at.cross(&(at - exact(middle))).z + DRAG * TURN;
        let told = at.cross(&Vec3::from(state.kinds[0].balance[1].held)).z;
        ((tied - exact(1.0)).norm(), (told - wanted).abs())
    };
    let [coarse, fine] = [32.0, 64.0].map(|steps| errors(1.0 / steps));
    let orders = [(coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2()];
    println!("orders {orders:?}, errors {fine:?}");
    assert!((orders[0] - 2.0).abs() < 0.2 && orders[1] > 1.8, "{orders:?} {fine:?}");
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
        // At rest the wall bears what the grip does.
        assert!(balance[1].abs() < 1e-6 * balance[0] && balance[2].abs() < 1e-6 * balance[0], "{balance:?}");
        (value("energy"), balance[0])
    };
    let (way, apart) = (1.0, 0.02);
    let [before, at, after] = [way - apart, way, way + apart].map(energy_and_force);
    let slope = (after.0 - before.0) / (2.0 * apart);
    println!("{} pN on the grip, energy rises by {slope} pN", at.1);
    // The energy is curved, so that its slope over 0.04 um is off by some (0.02/1)² = 4e-4 of itself at most.
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
        // Contacts carry forces of seven digits.
        assert!((of_cell[1] + force - drag).abs() < 1e-5 * force, "what moves the plate bears its drag and the cell");
        assert!((of_cell[0] + of_cell[1]).abs() < 1e-5 * force, "action and reaction");
        if time > 5.0 {
            // After 15 s the cell still creeps by what its error allows, and has the drag of that.
            assert!(force > 10.0 && (on_floor + force).abs() < 1e-3 * force, "{force} {on_floor}");
        }
    }
    assert!(simulation.series("volume_error").is_ok_and(|errors| errors.iter().all(|error| error.abs() < 1e-10)));
}

#[test]
fn moved_atoms_are_on_their_courses_within_steps_too() {
    let text = gripped(1.0).replace("tolerance = 1e-4", "step = \"0.3 s\"").replace("40 s", "1.5 s");
    let text = text.replace("[cells.shell]", "[output]\nevery = \"0.1 s\"\n[cells.shell]");
    let document = Document::parse("moved.toml", &text, std::path::Path::new("."), &[]);
    let document = document.unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("moved.h5");
    run(&document, &RunOptions::new(&path), &mut Quiet).unwrap_or_else(|error| panic!("{error}"));
    let result = ResultFile::open(&path).unwrap_or_else(|error| panic!("{error}"));
    let (times, told) = (result.times().expect("times"), result.scene_series("displacement.grip").expect("the series"));
    assert!(result.interpolated().expect("what is within").iter().filter(|within| **within).count() >= 8);
    for (frame, time) in times.iter().enumerate() {
        let positions = result.positions(frame).expect("positions");
        let highest = positions.iter().map(|x| x[2]).fold(0.0, f64::max);
        // The highest atom is one that is moved; positions are kept with all digits.
        let way = time.min(1.0);
        assert!((highest - 5.0 - way).abs() < 1e-12 && (told[frame] - way).abs() < 1e-12, "{time} s: {highest}");
    }
}

#[test]
fn a_shell_of_constant_volume_follows_a_grip_with_second_order() {
    let after = |steps: u32| {
        // So slow that steps are short beside what the stiffest shapes take.
        let text = gripped(1.0).replace("20 pN s/um", "2000 pN s/um").replace("level = 2", "level = 1");
        let text = text.replace("tolerance = 1e-4", &format!("step = \"{} s\"", 0.4 / f64::from(steps)));
        let mut simulation = simulation(&text);
        simulation.run_until(0.4).unwrap_or_else(|error| panic!("{error}"));
        simulation.snapshot().positions().to_vec()
    };
    let exact = after(512);
    let [coarse, fine] = [16, 32].map(|steps| {
        let apart = |(one, other): (&[f64; 3], &[f64; 3])| (Vec3::from(*one) - Vec3::from(*other)).norm();
        after(steps).iter().zip(&exact).map(apart).fold(0.0, f64::max)
    });
    let order = (coarse / fine).log2();
    println!("order {order:.2}, {fine:.1e} um");
    // Two steps of a halving differ from the limit by the next order's term; 1.3 where pressure acts with moved atoms at the end in both stages.
    assert!((order - 2.0).abs() < 0.3, "{order}");
}

#[test]
fn a_cell_that_is_wrung_between_grips_keeps_its_volume_and_bears_the_torque() {
    let text = |angle: f64| {
        let turning = format!(
            "rotation = {{ axis = [0, 0, 2], through = [\"0 um\", \"0 um\", \"0 um\"], angle = [[\"0 s\", \"0 deg\"], [\"1 s\", \"{angle} deg\"]] }} }}]\n"
        );
        let text = gripped(1.0).replace("[output]", "[output]\ntractions = true");
        let (before, _) = text.split_once("direction = [0, 0, 2], displacement").expect("the grip");
        format!("{before}{turning}")
    };
    let energy_and_torque = |angle: f64| {
        let mut simulation = simulation(&text(angle));
        simulation.run_until(40.0).unwrap_or_else(|error| panic!("{error}"));
        let value = |name: &str| simulation.series(name).unwrap_or_else(|error| panic!("{error}"))[0];
        assert!((value("angle.grip") - angle.to_radians()).abs() < 1e-15);
        assert!(value("volume_error").abs() < 1e-10, "{}", value("volume_error"));
        (value("energy"), value("torque.grip"))
    };
    let (angle, apart) = (30.0, 1.0);
    let [before, at, after] = [angle - apart, angle, angle + apart].map(energy_and_torque);
    let slope = (after.0 - before.0) / (2.0 * f64::to_radians(apart));
    println!("{} pN um on the grip, energy rises by {slope} pN um", at.1);
    // The energy is curved, so that its slope over two degrees is off by some (1/30)² = 1e-3 of itself at most.
    assert!(at.1 > 10.0 && (at.1 / slope - 1.0).abs() < 2e-3, "{} {slope}", at.1);
}

#[test]
fn atoms_that_turn_are_on_their_circles_within_steps_too() {
    let text = "title = \"a tool that turns\"\n[run]\nuntil = \"1 s\"\nintegrator = { step = \"0.4 s\" }\n[output]\nevery = \"0.1 s\"\n[cells.tool]\n\
         mesh = { shape = \"box\", size = [\"4 um\", \"1 um\", \"1 um\"], divisions = [2, 1, 1] }\nmechanics = { drag = \"20 pN s/um\" }\n\
         placement = { at = [[\"3 um\", \"0 um\", \"0 um\"]] }\n\
         moved = [{ name = \"swing\", all = true, direction = [0, 0, 1], displacement = [[\"0 s\", \"0 um\"], [\"1 s\", \"2 um\"]],\n\
         rotation = { axis = [0, 0, 1], through = [\"1 um\", \"0 um\", \"0 um\"], angle = [[\"0 s\", \"0 rad\"], [\"1 s\", \"2 rad\"]] } }]\n";
    let document = Document::parse("moved.toml", text, std::path::Path::new("."), &[]);
    let document = document.unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("moved.h5");
    run(&document, &RunOptions::new(&path), &mut Quiet).unwrap_or_else(|error| panic!("{error}"));
    let result = ResultFile::open(&path).unwrap_or_else(|error| panic!("{error}"));
    let times = result.times().expect("times");
    assert!(result.interpolated().expect("what is within").iter().filter(|within| **within).count() >= 6);
    let begun = result.positions(0).expect("positions");
    for (frame, time) in times.iter().enumerate() {
        let (sin, cos) = (2.0 * time).sin_cos();
        for (now, then) in result.positions(frame).expect("positions").iter().zip(&begun) {
            let (x, y) = (then[0] - 1.0, then[1]);
            let wanted = [1.0 + cos * x - sin * y, sin * x + cos * y, then[2] + 2.0 * time];
            assert!((0..3).all(|axis| (now[axis] - wanted[axis]).abs() < 1e-12), "{time} s: {now:?} {wanted:?}");
        }
    }
}
