//! Pseudopods: what a cell does to itself moves it only where it grips.

use pseudopod::Vec3;
use pseudopod::simulation::Simulation;

/// A round cell that pushes and draws, with more of a document; ten cycles take 80 s.
fn pushing(more: &str) -> Simulation {
    pushing_and_drawn_by("contraction = \"60 pN\"", more)
}

/// The same, drawn after by what the line of its pseudopods says.
pub fn pushing_and_drawn_by(line: &str, more: &str) -> Simulation {
    let text = format!(
        "title = \"A cell pushes\"\nseed = 3\n[run]\nuntil = \"100 s\"\nintegrator = {{ max_step = \"0.5 s\" }}\n[[planes]]\nname = \"glass\"\n\
         point = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.cell]\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [[\"0 um\", \"0 um\", \"5.05 um\"]] }}\n\
         [cells.cell.mechanics]\ndrag = \"500 pN s/um\"\n\
         membrane = {{ law = \"skalak\", shear = \"5 pN/um\", area = \"10 pN/um\", bending = \"2 pN um\", tension = \"10 pN/um\" }}\n\
         [cells.cell.pseudopods]\npressure = \"15 Pa\"\n{line}\npause = \"1 s\"\nprotrusion = \"4 s\"\nretraction = \"3 s\"\n\
         split = 1\nangle = \"10 deg\"\nspread = \"0 deg\"\n{more}"
    );
    Simulation::from_text("pseudopods.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Mean of the atoms, µm: what forces within a cell never move.
fn middle(simulation: &Simulation) -> Vec3 {
    let mut positions = vec![[0.0; 3]; simulation.atom_count()];
    simulation.positions_into(&mut positions).unwrap_or_else(|error| panic!("{error}"));
    positions.iter().map(|x| Vec3::from(*x)).sum::<Vec3>() / positions.len() as f64
}

/// How far the middle goes in ten cycles along the plane, and how far the centre goes at most meanwhile, µm.
fn advance(mut simulation: Simulation) -> [f64; 2] {
    let start = middle(&simulation);
    let mut most: f64 = 0.0;
    while simulation.time() < 90.0 {
        simulation.step().unwrap_or_else(|error| panic!("{error}"));
        let [x, y] = ["position_x", "position_y"]
            .map(|name| simulation.series(name).unwrap_or_else(|error| panic!("{error}"))[0]);
        most = most.max(x.hypot(y));
    }
    let went = middle(&simulation) - start;
    [went.x.hypot(went.y), most]
}

#[test]
fn a_cell_that_grips_nothing_does_not_advance() {
    let [went, most] = advance(pushing(""));
    assert!(went < 1e-3 * 5.0, "{went} um in ten cycles");
    assert!(most > 0.2, "it changes its shape: its centre goes {most} um to and fro");
}

#[test]
fn a_cell_with_several_pseudopods_that_grips_nothing_does_not_advance() {
    let several = "most = 3\nbeside = \"0.3 /s\"\nabandon = 0.3\n";
    let [went, most] = advance(pushing(several));
    assert!(went < 1e-3 * 5.0, "{went} um in ten cycles");
    assert!(most > 0.1, "it changes its shape: its centre goes {most} um to and fro");
    let mut simulation = pushing(several);
    simulation.run_until(90.0).unwrap_or_else(|error| panic!("{error}"));
    let pods = simulation.take_ended_pseudopods();
    assert!(pods.iter().any(|pod| pod.alone) && pods.iter().any(|pod| !pod.alone));
    assert!(pods.iter().any(|pod| pod.abandoned) && pods.iter().any(|pod| !pod.abandoned));
}

#[test]
fn a_cell_that_sticks_to_a_plane_without_friction_does_not_advance() {
    let plane = "[contact]\n[[contact.between]]\ntypes = [\"cell\", \"glass\"]\nenergy = \"10 pN/um\"\nrange = \"1.5 um\"\nshear_strength = \"0 Pa\"\n";
    let mut sticking = pushing(plane);
    sticking.run_until(5.0).unwrap_or_else(|error| panic!("{error}"));
    let area = sticking.series("contact.area.cell.glass").unwrap_or_else(|error| panic!("{error}"))[0];
    assert!(area > 10.0, "it sticks: {area} um^2");
    let [went, most] = advance(sticking);
    assert!(went < 1e-3 * 5.0, "{went} um in ten cycles");
    assert!(most > 0.2, "it changes its shape: its centre goes {most} um to and fro");
}

#[test]
fn a_cell_that_grips_advances() {
    let plane = "[contact]\n[[contact.between]]\ntypes = [\"cell\", \"glass\"]\nenergy = \"10 pN/um\"\nrange = \"1.5 um\"\nshear_strength = \"100 Pa\"\n";
    let [went, _] = advance(pushing(plane));
    // Two hundred times what one may go that does not grip.
    assert!(went > 1.0, "{went} um in ten cycles");
}
