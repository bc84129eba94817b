//! Claims about walks, through the whole program: a document in, a result file, measures out.

use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, run};
use std::path::Path;

/// Cells of 12 atoms: nothing hinders their walk, so their shape does not matter.
fn document(space: &str) -> String {
    format!(
        r#"
title = "Walkers"
seed = 3
[run]
until = "24 min"
[cells.amoeba]
number = 2000
mesh = {{ shape = "icosphere", radius = "5 um", level = 0 }}
placement = {{ grid = [50, 40, 1], spacing = "20 um" }}
[cells.amoeba.mechanics]
drag = "20 pN s/um"
shape_memory = {{ shape_modulus = "5 pN/um" }}
[cells.amoeba.motility]
brownian = {{ speed = "5 um/min", persistence = "2 min", space = "{space}" }}
[output]
every = "30 s"
[measure.msd_deviation]
kind = "msd_deviation"
speed = "5 um/min"
persistence = "2 min"
lag_from = "30 s"
lag_to = "20 min"
[measure.run_length_p]
kind = "run_length_p"
persistence = "2 min"
"#
    )
}

#[test]
fn walkers_agree_with_fuerth_and_their_runs_are_exponential() {
    for space in ["plane", "volume"] {
        let folder = tempfile::tempdir().unwrap();
        let document = Document::parse("walk.toml", &document(space), Path::new("."), &[]).unwrap();
        let result = folder.path().join("walk.h5");
        let options = RunOptions::new(&result);
        run(&document, &options, &mut Quiet).unwrap();
        let summary = ResultFile::open(&result).unwrap().summary().unwrap();
        let value = |name: &str| summary.iter().find(|measure| measure.name == name).unwrap().value;
        println!("{space}: {} standard errors, p = {}", value("msd_deviation"), value("run_length_p"));
        assert!(value("msd_deviation") < 3.0, "{space}: {} standard errors", value("msd_deviation"));
        assert!(value("run_length_p") > 0.01, "{space}: {}", value("run_length_p"));
    }
}
