//! Friction against area under the cohesive law: what slides is held back by its area and its speed, and by nothing else.

use pseudopod::Simulation;

fn simulation(text: &str) -> Simulation {
    Simulation::from_text("friction.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn run(simulation: &mut Simulation, until: f64) {
    simulation.run_until(until).unwrap_or_else(|error| panic!("{error}"));
}

fn series(simulation: &Simulation, name: &str) -> Vec<f64> {
    simulation.series(name).unwrap_or_else(|error| panic!("{error}"))
}

/// A stiff box of 10 x 10 µm with a height of its floor over z = 0 (µm), divided into so many parts, pushed along x by a force (pN).
fn block(name: &str, parts: u32, floor: f64, force: f64) -> String {
    wide_block(name, (10.0, parts), floor, force)
}

/// The same with another width (µm).
fn wide_block(name: &str, (width, parts): (f64, u32), floor: f64, force: f64) -> String {
    format!(
        "[cells.{name}]\nmesh = {{ shape = \"box\", size = [\"{width} um\", \"{width} um\", \"5 um\"], divisions = [{parts}, {parts}, 4] }}\n\
         placement = {{ at = [[\"0 um\", \"0 um\", \"{} um\"]] }}\n[cells.{name}.mechanics]\ndrag = \"20 pN s/um\"\n\
         shape_memory = {{ shape_modulus = \"200 pN/um\" }}\n[[cells.{name}.loads]]\nname = \"push\"\nall = true\ndirection = [1, 0, 0]\n\
         force = \"{force} pN\"\n",
        2.5 + floor
    )
}

/// A scene of such boxes and a floor, with what is said of the pair that touches.
fn scene(integrator: &str, blocks: &str, pair: [&str; 2], rules: &str) -> String {
    format!(
        "title = \"Boxes that slide\"\n[run]\nuntil = \"60 s\"\nintegrator = {{ {integrator} }}\n[[planes]]\nname = \"floor\"\n\
         point = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n{blocks}[contact]\nmodel = \"cohesion\"\nstrength = \"0 Pa\"\n\
         [[contact.between]]\ntypes = [\"{}\", \"{}\"]\nstrength = \"1 pN/um^2\"\nenergy = \"0.5 pN/um\"\n{rules}\n[output]\nevery = \"2 s\"\n",
        pair[0], pair[1]
    )
}

/// How fast the boxes slide between 20 and 60 s, µm/s.
fn speeds(text: &str) -> Vec<f64> {
    let mut simulation = simulation(text);
    run(&mut simulation, 20.0);
    let before = series(&simulation, "position_x");
    run(&mut simulation, 60.0);
    series(&simulation, "position_x").iter().zip(before).map(|(now, then)| (now - then) / 40.0).collect()
}

#[test]
fn a_box_dragged_over_a_floor_slides_at_its_force_over_friction_times_area_and_drag_whatever_the_step() {
    for step in ["step = \"1 s\"", "step = \"0.125 s\"", "max_step = \"2 s\""] {
        let speed =
            speeds(&scene(step, &block("box", 8, 0.0, 1.0), ["box", "floor"], "friction = \"0.2 pN s/um^3\""))[0];
        let theory = 1.0 / (0.2 * 100.0 + 20.0);
        assert!((speed / theory - 1.0).abs() < 0.01, "{step}: {speed} um/s where theory has {theory}");
    }
}

#[test]
fn what_is_apart_or_at_rest_feels_no_friction() {
    let friction = "friction = \"5 pN s/um^3\"";
    let speed = speeds(&scene("max_step = \"1 s\"", &block("box", 8, 1.5, 1.0), ["box", "floor"], friction))[0];
    assert!((speed - 0.05).abs() < 1e-6, "apart, drag alone: {speed} um/s");
    let speed = speeds(&scene("max_step = \"1 s\"", &block("box", 8, 0.0, 0.0), ["box", "floor"], friction))[0];
    // Sweeps come to rest within 3e-4 of an edge of 1.25 µm.
    assert!(40.0 * speed.abs() < 3e-4 * 1.25, "at rest: {speed} um/s");
}

#[test]
fn with_a_shear_strength_a_box_stands_up_to_that_and_slides_by_what_is_beyond() {
    let rules = "shear_strength = \"0.2 pN/um^2\"\nfriction = \"0.2 pN s/um^3\"";
    let speed_at =
        |force| speeds(&scene("max_step = \"0.5 s\"", &block("box", 8, 0.0, force), ["box", "floor"], rules))[0];
    let (stands, slides, theory) = (speed_at(19.0), speed_at(24.0), (24.0 - 20.0) / 40.0);
    assert!(stands.abs() < 1e-3, "{stands} um/s below its strength");
    assert!((slides / theory - 1.0).abs() < 0.02, "{slides} um/s where theory has {theory}");
}

#[test]
fn two_boxes_that_drag_each_other_keep_their_momentum() {
    // The upper one is smaller: rims that lie on each other would hook.
    let blocks = wide_block("upper", (6.0, 5), 5.001, 1.0) + &block("lower", 7, 0.0, 0.0);
    let text = scene("max_step = \"1 s\"", &blocks, ["upper", "lower"], "friction = \"0.2 pN s/um^3\"");
    let momentum = |simulation: &Simulation| {
        let mut positions = vec![[0.0; 3]; simulation.atom_count()];
        simulation.positions_into(&mut positions).unwrap_or_else(|error| panic!("{error}"));
        // The drag of each cell is shared by its atoms.
        let (of_upper, of_lower) = positions.split_at(6 * 6 * 5 - 4 * 4 * 3);
        let mean = |of: &[[f64; 3]]| of.iter().map(|x| x[0]).sum::<f64>() / of.len() as f64;
        20.0 * (mean(of_upper) + mean(of_lower))
    };
    let mut moved = simulation(&text);
    let before = momentum(&moved);
    run(&mut moved, 10.0);
    let pushed = momentum(&moved) - before;
    assert!((pushed - 10.0).abs() < 1e-6, "{pushed} pN s after 10 s of 1 pN");
}

#[test]
fn a_box_on_another_one_with_a_mesh_that_does_not_match_slides_as_on_a_floor() {
    let lower = block("lower", 7, 0.0, 0.0).replace(
        "[cells.lower.mechanics]",
        "fixed = [{ cap = { direction = [0, 0, 1], number = 212 } }]\n[cells.lower.mechanics]",
    );
    let lower = lower.split_once("[[cells.lower.loads]]").map(|(before, _)| before.to_owned()).expect("loads");
    // 5 pN: the rim of the upper one goes over the points of the lower by jerks of some tenths of a pN.
    let blocks = wide_block("upper", (6.0, 5), 5.001, 5.0) + &lower;
    let text = scene("max_step = \"1 s\"", &blocks, ["upper", "lower"], "friction = \"2 pN s/um^3\"");
    let mut simulation = simulation(&text);
    run(&mut simulation, 5.0);
    let before = series(&simulation, "position_x")[0];
    run(&mut simulation, 30.0);
    let speed = (series(&simulation, "position_x")[0] - before) / 25.0;
    let theory = 5.0 / (20.0 + 2.0 * 36.0);
    assert!((speed / theory - 1.0).abs() < 0.05, "{speed} um/s where theory has {theory}");
}

#[test]
fn cells_that_zip_up_with_friction_never_gain_energy() {
    let cell = |name: &str, x: f64, turn: &str| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 2 }}\n\
             placement = {{ at = [[\"{x} um\", \"0.3 um\", \"0 um\"]] }}\n{turn}\n[cells.{name}.mechanics]\ndrag = \"20 pN s/um\"\n\
             shape_memory = {{ shape_modulus = \"5 pN/um\" }}\n"
        )
    };
    let turn = "orientation = { axis = [0.3, 0.7, 0.72], angle = \"37 deg\" }";
    let text = format!(
        "title = \"Cells that zip up\"\n[run]\nuntil = \"20 s\"\nintegrator = {{ max_step = \"0.5 s\" }}\n{}{}[contact]\n\
         model = \"cohesion\"\nstrength = \"1.333 pN/um^2\"\nenergy = \"1 pN/um\"\nfriction = \"5 pN s/um^3\"\n[output]\nevery = \"1 s\"\n",
        cell("left", -5.02, ""),
        cell("right", 5.02, turn)
    );
    let mut simulation = simulation(&text);
    let energy = |simulation: &Simulation| {
        series(simulation, "energy").iter().sum::<f64>() + series(simulation, "contact.energy")[0]
    };
    let mut before = energy(&simulation);
    let (first, mut area) = (before, 0.0);
    for second in 1..=20 {
        run(&mut simulation, f64::from(second));
        let now = energy(&simulation);
        assert!(now <= before + 1e-6 * first.abs().max(1.0), "{second} s: {now} after {before} pN um");
        (before, area) = (now, series(&simulation, "contact.area.left.right")[0]);
    }
    assert!(before < first - 1.0 && area > 5.0, "{first} to {before} pN um, {area} um^2");
}
