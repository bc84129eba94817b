//! Cells that touch come nearer to where they are in infinitely short steps in proportion to the step: contacts are found and pushed where
//! a step begins and ends.

use pseudopod::Simulation;

/// Two cells pressed together with 10 pN for four seconds, in steps of one size (s): the distance of their centres, µm.
fn distance(contact: &str, step: f64) -> f64 {
    let cell = |name: &str, x: f64, along: i32, turn: &str| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 2 }}\n\
             placement = {{ at = [[\"{x} um\", \"0 um\", \"0 um\"]] }}\n{turn}\n[cells.{name}.mechanics]\ndrag = \"20 pN s/um\"\n\
             shape_memory = {{ shape_modulus = \"5 pN/um\" }}\n[[cells.{name}.loads]]\nname = \"press\"\nall = true\n\
             direction = [{along}, 0, 0]\nforce = \"10 pN\"\n"
        )
    };
    let turn = "orientation = { axis = [0.3, 0.7, 0.72], angle = \"37 deg\" }";
    let (left, right) = (cell("left", -5.3, 1, ""), cell("right", 5.3, -1, turn));
    let text = format!(
        "title = \"Pressed\"\n[run]\nuntil = \"4 s\"\nintegrator = {{ step = \"{step} s\" }}\n{left}{right}[contact]\n{contact}\n[output]\nevery = \"4 s\"\n"
    );
    let mut simulation = Simulation::from_text("pressed.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    simulation.run_until(4.0).unwrap_or_else(|error| panic!("{error}"));
    let [x, y, z] = ["position_x", "position_y", "position_z"]
        .map(|axis| simulation.series(axis).unwrap_or_else(|error| panic!("{error}")));
    (x[0] - x[1]).hypot(y[0] - y[1]).hypot(z[0] - z[1])
}

/// The distances in steps of a size (s), half and a quarter of it.
fn distances(contact: &str, longest: f64) -> [f64; 3] {
    [1.0, 0.5, 0.25].map(|part| distance(contact, part * longest))
}

#[test]
fn what_steps_err_by_where_cells_touch_is_proportional_to_them() {
    let [long, half, quarter] = distances("", 0.05);
    // The differences fall by 2 to the order.
    let order = ((long - half) / (half - quarter)).log2();
    println!("{long} {half} {quarter}, order {order}");
    assert!((0.9..1.6).contains(&order), "{long} {half} {quarter}, order {order}");
}

#[test]
fn surfaces_that_attract_each_other_come_as_near_whatever_the_step() {
    let rules = "model = \"cohesion\"\nstrength = \"1 pN/um^2\"\nshear_strength = \"0 Pa\"\nenergy = \"0.75 pN/um\"";
    let [long, half, quarter] = distances(rules, 0.025);
    println!("{long} {half} {quarter}");
    assert!((long - quarter).abs() < 3e-4 && (half - quarter).abs() < 3e-4, "{long} {half} {quarter}");
}
