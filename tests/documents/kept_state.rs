//! What is kept of a run that cannot go on is a state in which cells are outside each other.

use std::path::Path;

use pseudopod::Simulation;
use pseudopod::error::Error;
use pseudopod::experiment::Document;
use pseudopod::output::{ResultFile, load_checkpoint};
use pseudopod::run::{Quiet, RunOptions, run};
use pseudopod::sim::contact::check_passed;

/// Cells that their fibres fold within two seconds. In the state that its last step began from, two of them were 43 % of an edge in
/// each other, which the depth that contacts tell of (of atoms near facets) did not show.
const DOCUMENT: &str = r#"
title = "Cells too soft for their fibres"
seed = 1147897471
[run]
until = "30 s"
integrator = { max_step = "1 s" }
[cells.a]
number = 2
mesh = { shape = "icosphere", radius = "3 um", level = 2 }
placement = { grid = [2, 2, 2], spacing = "6.3 um", origin = ["-8 um", "0 um", "5 um"] }
[cells.a.mechanics]
drag = "0.2963 pN s/um"
springs = { stiffness = "0.01211 pN/um" }
[[cells.a.fixed]]
cap = { direction = [0, 0, -1], number = 3 }
[[cells.a.fibres]]
name = "f"
pattern = "diagonal"
stiffness = "0.001211 pN/um"
activation = [["0 s", 0.0], ["1 s", 1.0]]
[cells.b]
number = 2
mesh = { shape = "box", size = ["4 um", "2 um", "4 um"], divisions = [1, 2, 2] }
placement = { random_from = ["-20 um", "-20 um", "-12 um"], random_to = ["20 um", "20 um", "20 um"] }
[cells.b.mechanics]
drag = "0.7972 pN s/um"
shape_memory = { shape_modulus = "0.2006 pN/um" }
[cells.b.motility]
brownian = { speed = "6.315 um/min", persistence = "1 s", space = "volume" }
attraction = { to = ["0 um", "0 um", "0 um"], stiffness = "0.02006 pN/um" }
[contact]
strength = "0 pN/um^2"
[output]
every = "3.0 s"
"#;

#[test]
fn the_state_that_is_kept_after_trouble_is_a_good_one() {
    let folder = tempfile::tempdir().unwrap();
    let result = folder.path().join("soft.h5");
    let document = Document::parse("soft.toml", DOCUMENT, Path::new("."), &[]).unwrap();
    match run(&document, &RunOptions::new(&result), &mut Quiet) {
        Err(Error::Numbers { kept: Some(kept), .. }) => assert_eq!(kept, result),
        other => panic!("these cells fold, and the run says so: {other:?}"),
    }
    let checkpoint = load_checkpoint(&result).unwrap().expect("it can be gone on from");
    let mut simulation = Simulation::from_document(&document).unwrap();
    simulation.restore(&checkpoint.payload).unwrap();
    assert!(check_passed(simulation.model(), simulation.state()).is_ok(), "cells are in each other in what is kept");
    let file = ResultFile::open(&result).unwrap();
    let last = file.frames() - 1;
    assert_eq!(checkpoint.meta.frames, file.frames());
    assert!(file.times().unwrap()[last] <= simulation.time(), "no frame is later than what is kept");
}
