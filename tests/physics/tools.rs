//! Tools with exact surfaces: cells lie on them, between their atoms too, and are in balance with them.

use std::path::Path;

use pseudopod::Vec3;
use pseudopod::experiment::{Compiled, Document, compile};
use pseudopod::geometry::Topology;
use pseudopod::sim::contact::Law;
use pseudopod::sim::{Model, State, Workspace, step};

fn document(text: &str) -> Document {
    Document::parse("tools.toml", text, Path::new("."), &[]).expect("good")
}

/// Runs to the end and looks at each step.
fn run(text: &str, mut look: impl FnMut(&Model, &State)) -> (Model, State) {
    let Compiled { model, mut state, .. } = compile(&document(text)).expect("good");
    let mut ws = Workspace::new(&model);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).expect("a step");
        look(&model, &state);
    }
    (model, state)
}

/// The force of the cells on the tools, pN.
fn force(state: &State) -> Vec3 {
    state.kinds.iter().flat_map(|kind| &kind.balance).map(|atom| Vec3::from(atom.traction)).sum()
}

/// A shell of 642 atoms, 2 um wide, that lies on a tool; further keys of the cell, and how the tool goes.
fn on_tool(height: &str, surface: &str, cell: &str, goes: &str, until: &str) -> String {
    format!(
        "title = \"t\"\nrun = {{ until = \"{until}\", integrator = {{ tolerance = 1e-3 }} }}\n\
         [cells.shell]\nmesh = {{ shape = \"icosphere\", radius = \"2 um\", level = 3 }}\n\
         placement = {{ at = [[\"0 um\", \"0 um\", \"{height}\"]] }}\n\
         [cells.shell.mechanics]\ndrag = \"1 pN s/um\"\n\
         membrane = {{ law = \"neo_hookean\", shear = \"20 uN/m\", area = \"60 uN/m\", bending = \"5 pN um\" }}\n{cell}\n\
         [[tools]]\nname = \"tool\"\nsurface = {surface}\n{goes}\n"
    )
}

/// That on a ring in which it cannot slip aside.
fn on_ring(cell: &str, goes: &str, until: &str) -> String {
    let profile = "[[\"1 um\", 0], [\"1.6 um\", 0], [\"1.6 um\", \"0.6 um\"], [\"1 um\", \"0.6 um\"]]";
    let surface = format!("{{ shape = \"lathe\", profile = {profile}, rounding = \"0.2 um\" }}");
    on_tool("2.244 um", &surface, cell, goes, until)
}

/// The depth of the deepest of 20 points of each edge of all cells, µm.
fn deepest(model: &Model, state: &State) -> f64 {
    let mut deepest: f64 = 0.0;
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        let at = now.cell(kind, 0);
        for [a, b] in Topology::of(&kind.rest).edges {
            for part in 0..=20 {
                let share = f64::from(part) / 20.0;
                let x = (1.0 - share) * at[a as usize] + share * at[b as usize];
                let gaps = model.obstacles.iter().map(|obstacle| obstacle.beside(state.time, &x).gap);
                deepest = deepest.max(-gaps.fold(f64::INFINITY, f64::min));
            }
        }
    }
    deepest
}

#[test]
fn a_load_is_borne_by_the_ring_that_the_cell_is_pressed_on() {
    let load = "[[cells.shell.loads]]\nname = \"press\"\nall = true\ndirection = [0, 0, -1]\n\
                force = [[\"0 s\", \"0 pN\"], [\"1 s\", \"40 pN\"]]";
    let mut deep: f64 = 0.0;
    let (_, state) = run(&on_ring(load, "", "5 s"), |model, state| deep = deep.max(deepest(model, state)));
    // At rest: what bears the load has come to it within the tolerance.
    assert!((force(&state) - Vec3::new(0.0, 0.0, -40.0)).norm() < 0.04, "{}", force(&state));
    // Between the atoms, too: an edge of 0.3 µm over the rim would be 0.05 µm deep if only atoms were held.
    assert!(deep < 1e-6, "{deep}");
}

#[test]
fn a_ring_that_pushes_a_cell_bears_the_drag_of_its_atoms() {
    let goes = "displacement = [[\"0 s\", \"0 um\"], [\"2 s\", \"2 um\"]]";
    let (model, state) = run(&on_ring("", goes, "2 s"), |_, _| {});
    let drag = model.kinds[0].drag * 642.0 * 1.0;
    assert!((force(&state).z + drag).abs() < 1e-3 * drag, "{} {drag}", force(&state));
    assert!(force(&state).xy().norm() < 1e-3 * drag, "{}", force(&state));
    assert!(deepest(&model, &state) < 1e-6, "{}", deepest(&model, &state));
}

#[test]
fn a_ball_that_has_come_into_a_cell_ends_the_run() {
    // What is refused at the start of a run is not looked for here.
    let within = on_tool("0 um", "{ shape = \"ball\", radius = \"0.5 um\" }", "", "", "1 s");
    let Compiled { model, mut state, .. } = compile(&document(&within)).expect("good");
    let trouble = step(&model, &mut state, &mut Workspace::new(&model)).expect_err("it is within").to_string();
    let expected = "the tool `tool` has come through a facet of cell 0 of type `shell` at t = ";
    assert!(trouble.starts_with(expected), "{trouble}");
}

#[test]
fn a_step_may_lead_no_atom_past_a_tool() {
    let load = "[[cells.shell.loads]]\nname = \"press\"\nall = true\ndirection = [0, 0, 1]\nforce = \"10 pN\"";
    // Upwards, off the ring: in 0.1 s the cell goes 1 um, and a quarter of its radius of 1 um is safe there.
    let text = on_ring(load, "", "1 s").replace("tolerance = 1e-3", "step = \"0.1 s\"");
    let Compiled { model, mut state, .. } = compile(&document(&text)).expect("good");
    let trouble = step(&model, &mut state, &mut Workspace::new(&model)).expect_err("too far").to_string();
    assert!(trouble.contains("times as far as contacts or tools allow"), "{trouble}");
}

#[test]
fn a_type_sticks_to_a_tool_by_its_name() {
    let text = on_ring("", "", "1 s")
        + "[contact]\n[[contact.between]]\ntypes = [\"shell\", \"tool\"]\nstrength = \"2 pN/um^2\"\nenergy = \"1 pN/um\"\n";
    let Compiled { model, .. } = compile(&document(&text)).expect("good");
    let contact = model.contact.expect("contacts");
    assert_eq!(contact.obstacles.len(), 1);
    let Law::Cohesion(table) = &contact.law else { panic!("{:?}", contact.law) };
    assert_eq!((table.on_obstacles[0].strength, table.on_obstacles[0].work), (2.0, 1.0));
}
