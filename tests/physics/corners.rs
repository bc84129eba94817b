//! Corners of soft cells on edges.

use pseudopod::Simulation;

/// A drop of 162 atoms that is pressed onto two rails, each an edge of 122° along x.
const SCENE: &str = r#"title = "A drop on two rails"
[run]
until = "3 s"

[cells.drop]
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
placement = { at = [["0 um", "0 um", "4.6 um"]] }
mechanics = { drag = "20 pN s/um", membrane = { law = "neo_hookean", shear = "0 pN/um", area = "0 pN/um", tension = "100 pN/um", ordering = "2 pN/um" } }
loads = [{ name = "weight", all = true, direction = [0, 0, -1], force = "300 pN" }]

[cells.rail]
mesh = { shape = "file", path = "rail.obj" }
placement = { at = [["0 um", "-2 um", "0 um"], ["0 um", "2 um", "0 um"]] }
mechanics = { drag = "1 pN s/um", volume = { rule = "free" } }
fixed = [{ all = true }]

[contact]
"#;

const RAIL: &str = "v -8 -1.8 -1\nv -8 1.8 -1\nv -8 0 0\nv 8 -1.8 -1\nv 8 1.8 -1\nv 8 0 0\n\
    f 1 3 2\nf 4 5 6\nf 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\nf 3 1 4\nf 3 4 6\n";

/// Which edges of the drop cross a rail changes with every tremor. Where each of them began as if it had just met the rail, what a corner bears
/// was missing in the free motion, and its error made steps six times as many (2 044 for 357).
#[test]
fn a_corner_on_an_edge_bears_what_it_bore_whichever_of_its_edges_cross_it() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("rail.obj"), RAIL).expect("a file");
    let document = folder.path().join("rails.toml");
    std::fs::write(&document, SCENE).expect("a file");
    let mut simulation = Simulation::from_file(&document).unwrap_or_else(|error| panic!("{error}"));
    simulation.run_until(3.0).unwrap_or_else(|error| panic!("{error}"));
    println!("{} steps", simulation.steps());
    // Twice what it takes, a third of what it took.
    assert!(simulation.steps() < 700, "{} steps", simulation.steps());
}
