//! Tips that go slowly into shells.

use pseudopod::Simulation;

/// A shell of 642 atoms, whose lower half is fixed, under a tip that goes down by 0.25 µm in 20 s and has 0.05 µm to go until it touches.
const SCENE: &str = r#"title = "A tip in a shell"
[run]
until = "24 s"

[cells.shell]
mesh = { shape = "icosphere", radius = "5 um", level = 3 }
mechanics = { drag = "20 pN s/um", membrane = { law = "neo_hookean", shear = "112.5 pN/um", area = "225 pN/um", bending = "12 pN um" }, volume = { rule = "free" } }
fixed = [{ cap = { direction = [0, 0, -1], angle = "90 deg" } }]

[cells.tip]
mesh = { shape = "box", size = ["0.3 um", "0.3 um", "0.6 um"], divisions = [1, 1, 1] }
placement = { at = [["0 um", "0 um", "5.35 um"]] }
mechanics = { drag = "1 pN s/um" }
moved = [{ name = "tip", all = true, direction = [0, 0, -1], displacement = [["0 s", "0 um"], ["20 s", "0.25 um"]] }]

[contact]
"#;

/// A shell bends far more easily than it is stretched. Where contacts pushed an atom of it and its neighbours followed over several steps,
/// the force was too large by a tenth for as long as the tip went on, at any tolerance from 3e-3 to 1e-4.
#[test]
fn a_tip_that_goes_on_feels_what_one_feels_that_has_stopped() {
    let mut simulation = Simulation::builder().text("tip.toml", SCENE).unwrap_or_else(|error| panic!("{error}"));
    let mut force_at = |time: f64| {
        simulation.run_until(time).unwrap_or_else(|error| panic!("{error}"));
        (simulation.series("force.tip").unwrap_or_else(|error| panic!("{error}"))[0], simulation.steps())
    };
    let (going, steps) = force_at(20.0);
    let (stopped, _) = force_at(24.0);
    println!("{going} pN going, {stopped} pN stopped, {steps} steps");
    assert!(stopped > 14.0 && steps < 200, "{stopped} {steps}");
    // Drag on the shell adds 0.7 %, as steps of 0.01 s say; steps of 0.25 s leave it out.
    assert!((going / stopped - 1.0).abs() < 0.015, "{going} {stopped}");
}

/// A ball on a gel 5 µm thick that is held below, 0.5 µm deep: what surfaces of filled bodies do in contact.
const GEL: &str = r#"title = "A ball on a gel"
[run]
until = "8 s"
integrator = { tolerance = 1e-2 }

[cells.gel]
mesh = { shape = "block", size = ["10 um", "10 um", "5 um"], divisions = [8, 8, 4] }
placement = { at = [["0 um", "0 um", "-2.5 um"]] }
mechanics = { drag = "1 pN s/um", barrier = { active = false }, solid = { law = "neo_hookean", young = "1 kPa", poisson = 0.45 } }
moved = [{ name = "ground", cap = { direction = [0, 0, -1], depth = "0.01 um" }, direction = [0, 0, 1], displacement = "0 um" }]

[cells.ball]
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
placement = { at = [["0 um", "0 um", "5.1 um"]] }
mechanics = { drag = "1 pN s/um" }
moved = [{ name = "ball", all = true, direction = [0, 0, -1], displacement = [["0 s", "0 um"], ["5 s", "0.6 um"]] }]

[contact]
"#;

/// The ball feels more than on a half space (Hertz: 1.32 nN), as the gel is thin, and less than on a thin layer without sides that keeps its volume
/// (Dimitriadis et al. 2002: 2.12 nN); and the ground feels what it does. An atom inside that touched anything would bear a part of it.
#[test]
fn a_gel_hands_on_what_a_ball_does_to_it() {
    let mut simulation = Simulation::builder().text("gel.toml", GEL).unwrap_or_else(|error| panic!("{error}"));
    simulation.run_until(8.0).unwrap_or_else(|error| panic!("{error}"));
    let force = |name: &str| simulation.series(name).unwrap_or_else(|error| panic!("{error}"))[0];
    let (ball, ground) = (force("force.ball"), force("force.ground"));
    println!("{ball} pN on the gel, {ground} pN below it, {} steps", simulation.steps());
    assert!((1322.0..2125.0).contains(&ball), "{ball}");
    // What drag and the last sweeps leave at rest.
    assert!((ground / ball - 1.0).abs() < 1e-5, "{ground} below {ball}");
}
