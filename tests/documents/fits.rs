//! Fits of a substance that decays: what is known comes out again, and nothing is run twice.

use crate::chance::Chance;
use pseudopod::simulation::CancelToken;
use pseudopod::study::Replaces;
use pseudopod::study::fit::{
    EvaluateOptions, FitDocument, Outcome, Prepared, facts, fit, read_petab, verdicts, write_petab, write_tables,
};
use std::path::Path;
use std::sync::Mutex;

const EXPERIMENT: &str = r#"
title = "A substance decays"
[run]
until = "10 s"
integrator = { step = "1 s" }
[chemistry.decay]
document = "decay.eml"
[output]
every = "1 s"
[measure.end]
kind = "value"
series = "decay.U"
description = "how much is left"
"#;
/// What decays at a rate of two factors, which no data tell apart.
const DECAY: &str = r#"<eml name="decay" level="scene" time_unit="s">
<parameter id="k" value="0.3"/><parameter id="factor" value="1"/>
<variable id="U" initial="1" rate="-k*factor*U"/></eml>"#;

/// The rate and the height with which data are made.
const TRUTH: [f64; 2] = [0.4, 3.0];

const PARAMETERS: &str = r#"
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
"#;

const DATA: &str = r#"
[[data]]
name = "substance"
table = "data.csv"
x_column = "t"
y_column = "U"
error_column = "error"
y = "decay.U"
"#;

/// Writes the experiment, data with an error of 0.1 at eleven instants, and a fit of some parameters to them.
fn write(folder: &Path, parameters: &str, more: &str, trial: u32) {
    let mut chance = Chance::new(trial, 7);
    let mut table = "t,U,error\n".to_owned();
    for t in 0..=10 {
        // Box and Muller.
        let normal = (-2.0 * (1.0 - chance.share()).ln()).sqrt() * (std::f64::consts::TAU * chance.share()).cos();
        let [rate, height] = TRUTH;
        table += &format!("{t},{},0.1\n", height * (-rate * f64::from(t)).exp() + 0.1 * normal);
    }
    let text = format!("title = \"Decay\"\nexperiment = \"cells.toml\"\n{more}\n{parameters}\n{DATA}");
    for (name, text) in [("cells.toml", EXPERIMENT), ("decay.eml", DECAY), ("data.csv", &table), ("fit.toml", &text)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
}

fn prepared(folder: &Path, output: &str) -> Prepared {
    let document = FitDocument::read(&folder.join("fit.toml")).unwrap_or_else(|error| panic!("{error}"));
    let prepared = Prepared::new(document, &folder.join(output), None).unwrap_or_else(|error| panic!("{error}"));
    prepared.plan.write(Replaces::Nothing).unwrap();
    prepared
}

fn options(jobs: usize, tell: &(dyn Fn(&str) + Sync), cancel: CancelToken) -> EvaluateOptions<'_> {
    EvaluateOptions { jobs, threads: 1, cancel, memory: None, tell }
}

fn found(folder: &Path, output: &str, jobs: usize) -> Outcome {
    fit(&prepared(folder, output), &options(jobs, &|_| (), CancelToken::new()))
        .unwrap_or_else(|error| panic!("{error}"))
}

/// How many of the intervals of so many trials hold the truth, by profile and by covariance, of both parameters together.
fn holding(trials: u32) -> [usize; 2] {
    let mut within = [0; 2];
    for trial in 0..trials {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), PARAMETERS, "", trial);
        let outcome = found(folder.path(), "out", 2);
        for (index, one) in outcome.parameters.iter().enumerate() {
            let [low, high] = one.profile.expect("a profile was asked for").map(|end| end.expect("an end"));
            within[0] += usize::from((low..=high).contains(&TRUTH[index]));
            within[1] += usize::from((one.covariance[0]..=one.covariance[1]).contains(&TRUTH[index]));
        }
    }
    within
}

#[test]
fn known_parameters_are_within_their_own_intervals() {
    // Of four intervals that hold a truth in 95 of 100 trials three do in all but one of 70.
    assert!(holding(2).iter().all(|times| *times >= 3), "of 4 intervals");
}

#[test]
#[ignore = "slow: some hundred runs a trial, two to five minutes"]
fn known_parameters_are_within_their_own_intervals_in_nineteen_of_twenty_trials() {
    let within = holding(20);
    // Two parameters in twenty trials: that so many intervals in the long run hold the truth is held by `coverage_tests.rs` with a thousand.
    assert!(within.iter().all(|times| *times >= 38), "of 40 intervals, by profile and covariance: {within:?}");
}

#[test]
fn a_fit_that_was_stopped_goes_on_without_running_anything_twice_and_has_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, PARAMETERS, "starts = 3", 1);
    let whole = found(folder, "whole", 1);
    let runs = |output: &str| {
        let entries = std::fs::read_dir(folder.join(output).join("runs")).unwrap();
        entries.filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|kind| kind == "vtkhdf")).count()
    };
    assert_eq!(whole.made, runs("whole"), "each run has a file");
    assert_eq!(whole.made, whole.evaluations.len(), "each evaluation is one run");

    // Stopped at the fourth and at the twelfth thing that is told, with other numbers of jobs.
    let mut made = 0;
    for last in [4, 12] {
        let (cancel, told) = (CancelToken::new(), Mutex::new(0));
        let tell = |_: &str| {
            let mut told = told.lock().unwrap();
            *told += 1;
            if *told == last {
                cancel.cancel();
            }
        };
        let stopped = fit(&prepared(folder, "parts"), &options(3, &tell, cancel.clone())).unwrap_err();
        assert_eq!(stopped.exit_code(), 130, "{stopped}");
        assert!(runs("parts") > made, "runs are kept");
        made = runs("parts");
    }
    let rest = found(folder, "parts", 4);
    assert_eq!(rest.made + made, whole.made, "nothing was run twice");
    let again = found(folder, "parts", 2);
    assert_eq!(again.made, 0, "nothing is left to run");
    for outcome in [rest, again] {
        assert_eq!(facts(&outcome).to_string(), facts(&whole).to_string());
        assert_eq!(outcome.compared, whole.compared);
        assert_eq!(outcome.evaluations, whole.evaluations);
    }
    write_tables(&whole, &folder.join("whole")).unwrap();
    let table = std::fs::read_to_string(folder.join("whole/residuals.csv")).unwrap();
    assert_eq!(table.lines().count(), 12, "{table}");
}

#[test]
fn parameters_that_data_do_not_tell_apart_are_told_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let factor =
        "[[parameter]]\nkey = \"chemistry.decay.set.factor\"\nname = \"factor\"\nfrom = 0.5\nto = 2\nscale = \"log\"\n";
    write(folder.path(), &format!("{PARAMETERS}{factor}"), "", 2);
    let told = verdicts(&found(folder.path(), "out", 2)).join("\n");
    assert!(told.contains("factor is not identifiable from these data: between its bounds, 0.5 and 2"), "{told}");
    assert!(told.contains("rate and factor are hardly told apart"), "{told}");
    assert!(!told.contains("height"), "{told}");
}

#[test]
fn errors_that_are_only_relative_are_estimated_from_the_residuals() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, PARAMETERS, "errors = \"estimated\"", 3);
    let right = found(folder, "right", 2);
    let table = std::fs::read_to_string(folder.join("data.csv")).unwrap();
    std::fs::write(folder.join("data.csv"), table.replace(",0.1\n", ",0.7\n")).unwrap();
    let wrong = found(folder, "wrong", 2);
    for (one, other) in right.parameters.iter().zip(&wrong.parameters) {
        // χ² of the search ends to 1e-4, of which seven times larger errors leave seven times as much of a standard error.
        let width = one.covariance[1] - one.covariance[0];
        let apart = |k: usize| (one.covariance[k] - other.covariance[k]).abs();
        assert!(apart(0) < 0.05 * width && apart(1) < 0.05 * width, "{one:?}\n{other:?}");
    }
    assert!((right.chi2 / wrong.chi2 - 49.0).abs() < 0.5, "{} and {}", right.chi2, wrong.chi2);
}

#[test]
fn a_fit_survives_being_written_as_tables_of_petab_and_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let measured = "\n[[data]]\nname = \"the end\"\nmeasure = \"end\"\nvalue = 0.05\nerror = 0.02\n";
    write(folder, &format!("{PARAMETERS}{measured}"), "", 4);
    let before = prepared(folder, "out");
    let petab = folder.join("petab");
    let fit = &before.document.fit;
    let files = write_petab(fit, &before.space, &before.observed, Path::new("../cells.toml"), &petab).unwrap();
    assert_eq!(files.len(), 5);
    let problem = std::fs::read_to_string(&files[0]).unwrap();
    assert!(problem.contains("format_version: 2.0.0") && problem.contains("language: pseudopod"), "{problem}");
    let written = read_petab(&files[0], &folder.join("back")).unwrap();
    let document = FitDocument::read(&written[0]).unwrap_or_else(|error| panic!("{error}"));
    let after = Prepared::new(document, &folder.join("again"), None).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(after.observed, before.observed);
    let said = |prepared: &Prepared| {
        let axes = prepared.space.axes.iter();
        axes.map(|axis| (axis.column.clone(), axis.range, (1e9 * axis.start).round())).collect::<Vec<_>>()
    };
    assert_eq!(said(&after), said(&before));
}

#[test]
fn the_schema_of_fits_is_the_one_of_the_types() {
    let path = "docs/fit.schema.json";
    let now = pseudopod::cli::schema::fit_text();
    if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
        std::fs::write(path, &now).expect("the schema can be written");
    }
    let kept = std::fs::read_to_string(path).unwrap_or_default();
    assert!(kept == now, "{path} is not current; run: pseudopod schema --fit --force -o {path}");
}

#[test]
fn the_fit_that_ships_and_the_one_of_the_book_are_good() {
    let page = std::fs::read_to_string("docs/src/howto_fit.md").expect("the page");
    let text = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("the fit of the page");
    let folder = Path::new("experiments/red_cell_fit");
    let shipped = FitDocument::read(&folder.join("fit.toml")).unwrap_or_else(|error| panic!("{error}"));
    let shown = FitDocument::parse("howto_fit.md", text, folder).unwrap_or_else(|error| panic!("{error}"));
    for (document, data) in [(shipped, 26), (shown, 13)] {
        let prepared = Prepared::new(document, Path::new("nowhere"), None).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(prepared.observed.iter().map(|one| one.data.len()).sum::<usize>(), data);
    }
}
