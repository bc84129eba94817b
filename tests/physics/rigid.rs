//! Rigid bodies go and turn as drag lets them, keep their shape, bear each other and floors, and are held by traps.

use pseudopod::Vec3;
use pseudopod::geometry::box_surface;
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::moved::Translation;
use pseudopod::mechanics::trap::Trap;
use pseudopod::sim::{Kind, Model, Rigid, State, VolumeRule, Workspace, step};
use pseudopod::simulation::Simulation;

const DRAG: f64 = 0.7;

/// A bar of 6 × 1 × 1 µm.
fn bar(forces: impl Fn(&[Vec3]) -> Vec<Force>) -> Kind {
    let surface = box_surface([6.0, 1.0, 1.0], [3, 1, 1]);
    let forces = forces(&surface.positions);
    let mut kind = Kind::new("bar", surface, forces);
    kind.drag = DRAG;
    kind.rigid = Some(Rigid { turns: true });
    kind.volume = VolumeRule::Free;
    kind.bound_stiffness();
    kind
}

/// The atoms of a body after a second in steps of this size.
fn after(kind: Kind, order: Order, dt: f64, start: &[Vec3]) -> Vec<Vec3> {
    let integrator = Integrator { method: Method::Implicit { order }, size: StepSize::Fixed(dt) };
    let model = Model::of(vec![kind], integrator, 1.0);
    let mut state = State::new(&model, &[vec![start.to_vec()]]);
    let mut ws = Workspace::new(&model);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    }
    state.kinds[0].cell(&model.kinds[0], 0)
}

fn mean(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len() as f64
}

/// By how much a distance between two atoms differs from that at rest at most, µm.
fn bent(points: &[Vec3], rest: &[Vec3]) -> f64 {
    let pairs = (0..rest.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs.map(|(i, j)| ((points[i] - points[j]).norm() - (rest[i] - rest[j]).norm()).abs()).fold(0.0, f64::max)
}

/// A bar that is drawn by one end turns into the direction of the pull: θ' = −a sin θ with a = F r/(ζ Σ(x² + y²)), so that
/// tan(θ/2) falls by e^{−at}, and its middle goes with F/(n ζ).
#[test]
fn a_bar_that_is_drawn_by_one_end_turns_and_goes_as_drag_lets_it() {
    const PULL: f64 = 40.0;
    let begun = f64::to_radians(120.0);
    let errors = |order: Order, dt: f64| {
        let kind = bar(|rest| {
            let end: Vec<u32> = (0..).zip(rest).filter(|(_, r)| r.x > 2.9).map(|(atom, _)| atom).collect();
            let shares = end.iter().map(|atom| (*atom, 1.0 / end.len() as f64)).collect();
            vec![Force::Load(Load::new("pull", shares, Vec3::x(), Course::constant(PULL)))]
        });
        let rest = kind.rest.positions.clone();
        let turn = nalgebra::Rotation3::from_axis_angle(&Vec3::z_axis(), begun);
        let start: Vec<Vec3> = rest.iter().map(|r| turn * r).collect();
        let end = after(kind, order, dt, &start);
        assert!(bent(&end, &rest) < 1e-13, "{}", bent(&end, &rest));
        let inertia: f64 = rest.iter().map(|r| r.x * r.x + r.y * r.y).sum();
        let rate = 3.0 * PULL / (DRAG * inertia);
        let wanted = 2.0 * ((0.5 * begun).tan() * (-rate).exp()).atan();
        let axis = end.iter().zip(&rest).filter(|(_, r)| r.x > 2.9).map(|(x, _)| x - mean(&end)).sum::<Vec3>();
        let middle = (mean(&end) - Vec3::new(PULL / (DRAG * rest.len() as f64), 0.0, 0.0)).norm();
        assert!(middle < 1e-12 && axis.z.abs() < 1e-12, "{middle} {axis}");
        (axis.y.atan2(axis.x) - wanted).abs()
    };
    for (order, wanted) in [(Order::First, 1.0), (Order::Second, 2.0)] {
        let [coarse, fine] = [32.0, 64.0].map(|steps| errors(order, 1.0 / steps));
        let found = (coarse / fine).log2();
        println!("{order:?}: order {found:.2}, {fine:.1e} rad");
        // Two steps of a halving differ from the limit by the next order's term.
        assert!((found - wanted).abs() < 0.25, "{found} {fine}");
    }
}

/// n ζ ẋ = k (v t − x) from 0: x = v (t − τ (1 − e^{−t/τ})) with τ = n ζ/k.
#[test]
fn a_body_follows_its_trap_with_the_order_of_the_scheme_and_in_any_step() {
    const SPEED: f64 = 3.0;
    let error = |stiffness: f64, order: Order, dt: f64| {
        let displacement = Course::through(vec![(0.0, 0.0), (2.0, 2.0 * SPEED)]).expect("times rise");
        let translation = Some(Translation { direction: Vec3::y(), displacement });
        let trap = Trap { name: "trap".into(), stiffness, at: Vec3::zeros(), translation };
        let kind = bar(|_| vec![Force::Trap(trap.clone())]);
        let rest = kind.rest.positions.clone();
        let time = DRAG * rest.len() as f64 / stiffness;
        let end = after(kind, order, dt, &rest);
        assert!(bent(&end, &rest) < 1e-13);
        let wanted = SPEED * (1.0 - time * (1.0 - (-1.0 / time).exp()));
        (mean(&end) - Vec3::new(0.0, wanted, 0.0)).norm()
    };
    for (order, wanted) in [(Order::First, 1.0), (Order::Second, 2.0)] {
        let [coarse, fine] = [32.0, 64.0].map(|steps| error(30.0, order, 1.0 / steps));
        let found = (coarse / fine).log2();
        println!("{order:?}: order {found:.2}, {fine:.1e} um");
        assert!((found - wanted).abs() < 0.2, "{found} {fine}");
        // Thousands of times as stiff as a step resolves, whose forces are then those of the end of the step in the first order.
        assert!(error(3e5, order, 0.1) < 1e-3, "{}", error(3e5, order, 0.1));
    }
}

fn simulation(text: &str) -> Simulation {
    Simulation::from_text("rigid.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn run_until(simulation: &mut Simulation, time: f64) {
    simulation.run_until(time).unwrap_or_else(|error| panic!("{error}"));
}

fn values(simulation: &Simulation, name: &str) -> Vec<f64> {
    simulation.series(name).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_plate_on_a_spring_reads_what_the_cell_below_it_bears() {
    let text = "title = \"a plate on a spring\"\n[run]\nuntil = \"60 s\"\n[contact]\n[output]\ntractions = true\n\
         [[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.cell]\n\
         mesh = { shape = \"icosphere\", radius = \"5 um\", level = 2 }\nplacement = { at = [[\"0 um\", \"0 um\", \"5.05 um\"]] }\n\
         mechanics = { drag = \"20 pN s/um\", shape_memory = { shape_modulus = \"10 pN/um\" } }\n[cells.plate]\n\
         mesh = { shape = \"box\", size = [\"14 um\", \"14 um\", \"1 um\"], divisions = [4, 4, 1] }\nplacement = { at = [[\"0 um\", \"0 um\", \"10.7 um\"]] }\n\
         mechanics = { drag = \"20 pN s/um\", rigid = { turns = false } }\n\
         traps = [{ name = \"arm\", stiffness = \"40 pN/um\", at = [\"0 um\", \"0 um\", \"10.7 um\"], direction = [0, 0, -1], displacement = [[\"0 s\", \"0 um\"], [\"5 s\", \"3 um\"]] }]\n\
         [measure.read]\nkind = \"value\"\nseries = \"trap_z.arm\"\ntime = \"last\"\n";
    let mut simulation = simulation(text);
    run_until(&mut simulation, 60.0);
    let read = values(&simulation, "trap_z.arm")[0];
    let (height, between) = (values(&simulation, "position_z")[1], values(&simulation, "traction_of_cells_z"));
    let on_floor = values(&simulation, "traction_z")[0];
    println!("{read} pN by the arm, {between:?} between, {on_floor} on the floor; the plate is at {height} um");
    assert!(read < -10.0 && (read - 40.0 * (7.7 - height)).abs() < 1e-9, "the arm is bent as it pushes");
    // At rest after 55 s; contacts carry forces of seven digits, and what still creeps has a drag.
    assert!((between[1] - read).abs() < 1e-4 * read.abs(), "what bends the arm is the cell");
    assert!((between[0] + between[1]).abs() < 1e-5 * read.abs(), "action and reaction");
    assert!((on_floor - read).abs() < 1e-3 * read.abs(), "the floor bears it");
}

#[test]
fn a_plate_that_is_pushed_takes_a_bead_with_it() {
    for number in [1, 9] {
        // Pairs far apart from each other; nine bodies of a type stand in lanes.
        let body = |name: &str, x: f64, mesh: &str, mechanics: &str| {
            let at: String = (0..number).map(|pair| format!("[\"{x} um\", \"{} um\", \"0 um\"],", 40 * pair)).collect();
            format!(
                "[cells.{name}]\nnumber = {number}\nmesh = {{ {mesh} }}\nplacement = {{ at = [{at}] }}\nmechanics = {{ {mechanics} }}\n"
            )
        };
        let plate = "shape = \"box\", size = [\"1 um\", \"6 um\", \"6 um\"], divisions = [1, 3, 3]";
        let text = format!(
            "title = \"a plate and a bead\"\n[run]\nuntil = \"40 s\"\n[contact]\n{}loads = [{{ name = \"push\", all = true, direction = [1, 0, 0], force = \"12 pN\" }}]\n{}",
            body("plate", -2.0, plate, "drag = \"20 pN s/um\", rigid = { turns = false }"),
            body(
                "bead",
                2.0,
                "shape = \"icosphere\", radius = \"2 um\", level = 2",
                "drag = \"60 pN s/um\", rigid = {}"
            )
        );
        let mut simulation = simulation(&text);
        run_until(&mut simulation, 20.0);
        let before = values(&simulation, "position_x");
        run_until(&mut simulation, 40.0);
        let after = values(&simulation, "position_x");
        for body in 0..2 * number {
            // 12 pN on 80 pN s/um for 20 s; contacts are swept until what moves still is a thousandth of an edge.
            let way = after[body] - before[body];
            assert!((way - 3.0).abs() < 3e-3, "{number}: body {body} goes {way} um");
        }
        let errors = values(&simulation, "volume_error");
        assert!(errors.iter().all(|error| error.abs() < 1e-13), "rigid bodies keep their volume: {errors:?}");
    }
}

#[test]
fn a_box_rests_on_the_floor_with_its_weight_and_stays_level() {
    let text = "title = \"a box on a floor\"\n[run]\nuntil = \"20 s\"\n[output]\ntractions = true\n[environment]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n\
         [[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.box]\n\
         mesh = { shape = \"box\", size = [\"6 um\", \"4 um\", \"2 um\"], divisions = [3, 2, 1] }\nplacement = { at = [[\"0 um\", \"0 um\", \"2 um\"]] }\n\
         orientation = { axis = [1, 2, 0], angle = \"9 deg\" }\n\
         mechanics = { drag = \"20 pN s/um\", mass = \"2 ng\", rigid = {} }\n";
    let mut simulation = simulation(text);
    run_until(&mut simulation, 20.0);
    // 2 ng fall with 19.62 pN.
    let (height, floor) = (values(&simulation, "position_z")[0], values(&simulation, "traction_z")[0]);
    println!("at {height} um with {floor} pN on the floor");
    assert!((height - 1.0).abs() < 1e-6, "{height}");
    assert!((floor + 19.62).abs() < 1e-4, "{floor}");
}

#[test]
fn scratch_is_scratch_where_bodies_are_rigid() {
    let text = "title = \"a bead on a cell\"\n[run]\nuntil = \"4 s\"\n[contact]\n\
         [[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.cell]\n\
         mesh = { shape = \"icosphere\", radius = \"5 um\", level = 1 }\nplacement = { at = [[\"0 um\", \"0 um\", \"5.05 um\"]] }\n\
         mechanics = { drag = \"20 pN s/um\", shape_memory = { shape_modulus = \"10 pN/um\" } }\n[cells.bead]\n\
         mesh = { shape = \"icosphere\", radius = \"2 um\", level = 1 }\nplacement = { at = [[\"0 um\", \"0 um\", \"12.1 um\"], [\"9 um\", \"0 um\", \"2.05 um\"]] }\n\
         mechanics = { drag = \"10 pN s/um\", rigid = {} }\nnumber = 2\n\
         loads = [{ name = \"press\", cap = { direction = [1, 0, 0], number = 3 }, direction = [-1, 0, -1], force = \"4 pN\" }]\n";
    let course = |is_poisoned: bool| {
        let (model, mut state) = simulation(text).into_parts();
        let mut ws = Workspace::new(&model);
        for _ in 0..40 {
            if is_poisoned {
                ws.poison(&model);
            }
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        }
        state.kinds.iter().map(|now| now.positions.to_vec()).collect::<Vec<_>>()
    };
    let plain = course(false);
    assert!(plain.iter().flatten().all(|x| x.is_finite()));
    assert!(plain == course(true));
}
