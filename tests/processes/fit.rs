//! Fits as their users run them: killed, run again, looked at.

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::turns::take_turn;

const EXPERIMENT: &str = r#"
title = "A substance decays"
[run]
until = "10 s"
integrator = { step = "0.02 s" }
[chemistry.decay]
document = "decay.eml"
[output]
every = "1 s"
"#;
const DECAY: &str = r#"<eml name="decay" level="scene" time_unit="s">
<parameter id="k" value="0.3"/><variable id="U" initial="1" rate="-k*U"/></eml>"#;
const FIT: &str = r#"
title = "Decay"
experiment = "cells.toml"
[[parameter]]
key = "chemistry.decay.set.k"
name = "rate"
from = 0.05
to = 5
scale = "log"
[[parameter]]
key = "chemistry.decay.set.U"
name = "height"
from = 0.5
to = 10
[[data]]
name = "substance"
table = "data.csv"
x_column = "t"
y_column = "U"
error_column = "error"
y = "decay.U"
"#;

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pseudopod"));
    command.args(arguments).current_dir(folder);
    command
}

fn says(folder: &Path, code: i32, arguments: &[&str]) -> String {
    let Output { status, stdout, stderr } = command(folder, arguments).output().unwrap();
    let words = String::from_utf8_lossy(&stdout).into_owned() + &String::from_utf8_lossy(&stderr);
    assert_eq!(status.code(), Some(code), "{arguments:?}\n{words}");
    words
}

/// Complete runs of a fit.
fn runs(folder: &Path, output: &str) -> usize {
    let Ok(entries) = std::fs::read_dir(folder.join(output).join("runs")) else { return 0 };
    let complete = |path: &Path| path.extension().is_some_and(|ending| ending == "vtkhdf");
    entries.filter(|entry| complete(&entry.as_ref().unwrap().path())).count()
}

#[test]
fn a_killed_fit_goes_on_and_ends_as_one_that_was_not() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let data = "t,U,error\n0,3.05,0.1\n1,1.98,0.1\n2,1.41,0.1\n4,0.55,0.1\n7,0.21,0.1\n10,0.02,0.1\n";
    for (name, text) in [("cells.toml", EXPERIMENT), ("decay.eml", DECAY), ("fit.toml", FIT), ("data.csv", data)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let said = says(folder, 0, &["fit", "fit.toml", "-o", "whole", "-j", "2"]);
    for part in
        ["rate = 0.4", "95 % by the profile likelihood", "95 % by the covariance", "degrees of freedom", "fit.png"]
    {
        assert!(said.contains(part), "{part} in\n{said}");
    }
    let whole = runs(folder, "whole");

    let mut made = 0;
    for wanted in [4, 15] {
        let mut child = command(folder, &["fit", "fit.toml", "-o", "parts", "-j", "2", "--quiet"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let began = Instant::now();
        while runs(folder, "parts") < wanted && began.elapsed() < Duration::from_secs(120) {
            std::thread::sleep(Duration::from_millis(2));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(runs(folder, "parts") >= wanted.max(made), "the fit was killed before it had made {wanted} runs");
        made = runs(folder, "parts");
    }
    assert!(made < whole, "the fit was killed on its way");
    let said = says(folder, 0, &["fit", "fit.toml", "-o", "parts", "-j", "1", "--json", "--quiet"]);
    let report: serde_json::Value = serde_json::from_str(&said).unwrap_or_else(|error| panic!("{error}:\n{said}"));
    assert_eq!(report["runs_made"].as_u64().map(|made| made as usize), Some(whole - made), "nothing was run twice");
    for name in ["fit.json", "parameters.csv", "residuals.csv", "profiles.csv", "evaluations.csv", "figures/fit.svg"] {
        let of = |output: &str| std::fs::read(folder.join(output).join(name)).unwrap();
        assert!(of("whole") == of("parts"), "{name} has other numbers");
    }

    // A folder of another fit is left alone.
    std::fs::write(folder.join("fit.toml"), FIT.replace("to = 10", "to = 20")).unwrap();
    assert!(says(folder, 2, &["fit", "fit.toml", "-o", "whole"]).contains("--force"));
    says(folder, 0, &["fit", "fit.toml", "-o", "whole", "--force", "--no-pictures", "--quiet"]);
}

#[test]
fn a_fit_is_written_for_petab_and_read_from_it() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let data = "t,U,error\n0,3.05,0.1\n1,1.98,0.1\n2,1.41,0.1\n";
    for (name, text) in [("cells.toml", EXPERIMENT), ("decay.eml", DECAY), ("fit.toml", FIT), ("data.csv", data)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    says(folder, 0, &["fit", "fit.toml", "--petab", "tables"]);
    assert_eq!(runs(folder, "tables"), 0, "nothing was run");
    let said = says(folder, 0, &["fit", "tables/problem.yaml", "-o", "back"]);
    assert!(said.contains("next: pseudopod fit"), "{said}");
    says(folder, 0, &["fit", "back/fit.toml", "-o", "out", "--quiet", "--no-pictures"]);
    let problem = std::fs::read_to_string(folder.join("tables/problem.yaml")).unwrap();
    std::fs::write(folder.join("tables/problem.yaml"), problem.replace("language: pseudopod", "language: sbml"))
        .unwrap();
    assert!(says(folder, 2, &["fit", "tables/problem.yaml", "-o", "other"]).contains("language: pseudopod"));
}
