//! SBML models mean what the SBML test suite and other simulators take them to mean.

use crate::sbml_suite::{Case, Solved, folders, load, suite, table};
use crate::shared::shared;
use pseudopod::ode::{SolveOptions, solve};
use std::path::Path;

/// A case of the suite, solved by itself.
fn alone(case: &Case) -> Solved {
    let (times, last) = (&case.times, case.times.len() - 1);
    let options = SolveOptions { relative: 1e-8, absolute: 1e-6 * case.absolute.min(1e-6), ..SolveOptions::default() };
    let solution = solve(&case.model.system, times[0], times[last], times, &options);
    Ok(solution.map_err(|trouble| trouble.to_string())?.values)
}

#[test]
fn the_suites_time_courses_agree_by_its_own_rule() {
    suite("ode", 40, &alone);
}

#[test]
fn the_suites_events_agree_by_its_own_rule() {
    suite("events", 10, &alone);
}

/// How far a model is from its reference, over the largest value of each column.
fn distance(folder: &Path) -> Result<f64, String> {
    let name = folder.file_name().expect("a number").to_string_lossy().into_owned();
    let (names, rows) = table(&folder.join("reference.csv"));
    let model = load(&folder.join(format!("{name}.xml"))).map_err(|error| error.to_string())?;
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let columns = names[1..].iter().map(|name| model.column(name).ok_or(format!("there is no `{name}`")));
    let columns: Vec<u32> = columns.collect::<Result<_, _>>()?;
    let options = SolveOptions { relative: 1e-9, absolute: 1e-14, ..SolveOptions::default() };
    let solution = solve(&model.system, times[0], times[times.len() - 1], &times, &options);
    let solved = solution.map_err(|trouble| trouble.to_string())?.values;
    let mut worst: f64 = 0.0;
    for (index, column) in columns.iter().enumerate() {
        let largest = rows.iter().map(|row| row[index + 1].abs()).fold(0.0, f64::max);
        for (row, values) in rows.iter().zip(&solved) {
            let off = (row[index + 1] - values[*column as usize]).abs();
            worst = worst.max(if off == 0.0 { 0.0 } else { off / largest });
        }
    }
    Ok(worst)
}

#[test]
fn published_models_agree_with_another_simulator() {
    let Some(folder) = shared("biomodels") else { return };
    let models = folders(&folder);
    assert_eq!(models.len(), 12);
    let mut bad = Vec::new();
    for model in models {
        match distance(&model) {
            Ok(worst) if worst <= 1e-4 => println!("{}: {worst:.1e}", model.display()),
            Ok(worst) => bad.push(format!("{}: {worst:e} of the maximum", model.display())),
            Err(why) => bad.push(format!("{}: {why}", model.display())),
        }
    }
    assert!(bad.is_empty(), "models differ:\n{}", bad.join("\n"));
}
