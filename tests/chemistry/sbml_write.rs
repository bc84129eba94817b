//! What is written as SBML is read as the same system: models of the SBML test suite go through EML and back.

use crate::sbml_suite::{Case, Solved, all_cases, suite};
use pseudopod::equations::{self, Read, eml, sbml};
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{SolveOptions, solve};
use std::path::Path;
use std::sync::Arc;

fn read(name: &str, text: String) -> Result<Read, String> {
    let source = Arc::new(Source { name: name.to_owned(), text });
    equations::read(source).map_err(|error| render(&error, Paint::Plain))
}

fn good(text: &str) -> Read {
    read("text", text.to_owned()).unwrap_or_else(|error| panic!("{error}"))
}

/// The SBML that is written of the EML that is written of a model.
fn there_and_back(file: &Path) -> Result<(eml::Document, Read), String> {
    let text = std::fs::read_to_string(file).expect("a model");
    let first = read(&file.display().to_string(), text)?;
    let second = read("EML", eml::write(&first.document, "").text)?.document;
    let written = sbml::write(&second).map_err(|error| render(&error, Paint::Plain))?;
    Ok((second, read("SBML again", written.text)?))
}

/// A case of the suite, solved as SBML that was EML.
fn rewritten(case: &Case) -> Solved {
    let (document, again) = there_and_back(&case.file)?;
    let quantities = &document.system.quantities;
    assert_eq!(quantities.len(), case.model.system.quantities.len(), "EML has the quantities in the same order");
    let found = quantities.iter().map(|quantity| again.document.system.find(&quantity.id));
    let columns: Vec<u32> = found.collect::<Option<_>>().ok_or("a quantity is lost")?;
    let (times, last) = (&case.times, case.times.len() - 1);
    let options = SolveOptions { relative: 1e-8, absolute: 1e-6 * case.absolute.min(1e-6), ..SolveOptions::default() };
    let solution = solve(&again.document.system, times[0], times[last], times, &options);
    let values = solution.map_err(|trouble| trouble.to_string())?.values;
    Ok(values.iter().map(|row| columns.iter().map(|column| row[*column as usize]).collect()).collect())
}

#[test]
fn the_suites_time_courses_come_through_eml_and_back() {
    suite("ode", 40, &rewritten);
}

#[test]
fn the_suites_events_come_through_eml_and_back() {
    suite("events", 10, &rewritten);
}

/// `git clone https://github.com/sbmlteam/sbml-test-suite`, then
/// `PSEUDOPOD_SBML_SUITE=sbml-test-suite/cases/semantic cargo test --release --test chemistry sbml_write -- --ignored --nocapture`.
#[test]
#[ignore = "slow: reads and solves all 1 821 cases of the SBML test suite twice, in the folder that PSEUDOPOD_SBML_SUITE names (5 min)"]
fn the_whole_suite_comes_through_eml_and_back() {
    let Some(folder) = std::env::var_os("PSEUDOPOD_SBML_SUITE") else {
        panic!("name the folder cases/semantic of the suite in the variable PSEUDOPOD_SBML_SUITE");
    };
    let (plain, again) = all_cases(Path::new(&folder), &crate::sbml::alone, &rewritten);
    println!("{} files agree as they are, {} of them after EML and back", plain, plain - again.len());
    assert!(plain >= 1600, "{plain} files agree as they are");
    assert!(again.is_empty(), "{} files differ after EML and back:\n{}", again.len(), again.join("\n"));
}
