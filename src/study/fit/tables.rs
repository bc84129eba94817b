//! What a fit found, as tables and as JSON. Nothing in them depends on threads, or on how often the fit was stopped.

use super::identifiable::verdicts;
use super::observed::Beside;
use super::outcome::{Compared, Outcome};
use crate::error::Result;
use crate::study::paths::write_all;
use crate::study::table::{Cells, TableColumn, csv_text};
use crate::study::variation::titled;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Writes the tables of a fit into its folder: parameters.csv, residuals.csv, profiles.csv, evaluations.csv and fit.json.
///
/// # Errors
/// [`Error::Machine`](crate::error::Error::Machine) when the disk refuses.
pub fn write_tables(outcome: &Outcome, folder: &Path) -> Result<Vec<PathBuf>> {
    let mut texts = vec![
        ("fit.json", format!("{:#}\n", facts(outcome))),
        ("parameters.csv", csv_text(&parameters(outcome))),
        ("residuals.csv", csv_text(&residuals(outcome))),
        ("evaluations.csv", csv_text(&evaluations(outcome))),
    ];
    if outcome.parameters.iter().any(|one| one.profile.is_some()) {
        texts.push(("profiles.csv", csv_text(&profiles(outcome))));
    }
    write_all(texts, folder)
}

/// What was found, for programs.
pub fn facts(outcome: &Outcome) -> Value {
    let interval = |ends: [Option<f64>; 2]| json!(ends);
    let finite = |end: f64| end.is_finite().then_some(end);
    let parameters = outcome.each().map(|(axis, found)| {
        json!({
            "name": axis.column.name,
            "key": axis.column.key,
            "unit": axis.column.kind.unit().unwrap_or("1"),
            "value": found.value,
            "covariance_interval": interval(found.covariance.map(finite)),
            "profile_interval": found.profile.map(interval),
        })
    });
    let rows = outcome.correlations.row_iter().map(|row| row.iter().map(|one| finite(*one)).collect::<Vec<_>>());
    json!({
        "parameters": parameters.collect::<Vec<_>>(),
        "correlations": rows.collect::<Vec<_>>(),
        "chi2": outcome.chi2,
        "degrees_of_freedom": outcome.freedom,
        "reduced_chi2": finite(outcome.reduced()),
        "errors": outcome.errors,
        "confidence": outcome.confidence,
        "converged": outcome.converged,
        "starts": outcome.starts.len(),
        "starts_that_agree": outcome.starts_that_agree(),
        "evaluations": outcome.evaluations.len(),
        "notes": verdicts(outcome),
    })
}

fn column(title: &str, cells: Cells) -> TableColumn {
    TableColumn { title: title.to_owned(), cells }
}

fn numbers(title: &str, numbers: impl IntoIterator<Item = Option<f64>>) -> TableColumn {
    column(title, Cells::Numbers(numbers.into_iter().map(|one| one.filter(|one| one.is_finite())).collect()))
}

fn words(title: &str, words: impl IntoIterator<Item = String>) -> TableColumn {
    column(title, Cells::Words(words.into_iter().map(Some).collect()))
}

fn parameters(outcome: &Outcome) -> Vec<TableColumn> {
    let of = |number: fn(&super::outcome::Estimated) -> Option<f64>| outcome.parameters.iter().map(number);
    vec![
        words("parameter", outcome.space.axes.iter().map(|axis| axis.column.name.clone())),
        words("key", outcome.space.axes.iter().map(|axis| axis.column.key.clone())),
        words("unit", outcome.space.axes.iter().map(|axis| axis.column.kind.unit().unwrap_or("1").to_owned())),
        numbers("value", of(|one| Some(one.value))),
        numbers("covariance_low", of(|one| Some(one.covariance[0]))),
        numbers("covariance_high", of(|one| Some(one.covariance[1]))),
        numbers("profile_low", of(|one| one.profile.and_then(|ends| ends[0]))),
        numbers("profile_high", of(|one| one.profile.and_then(|ends| ends[1]))),
        numbers("lower_bound", outcome.space.axes.iter().map(|axis| Some(axis.range.from))),
        numbers("upper_bound", outcome.space.axes.iter().map(|axis| Some(axis.range.to))),
    ]
}

fn residuals(outcome: &Outcome) -> Vec<TableColumn> {
    let each = || outcome.compared.iter().flat_map(|one| one.observed.data.iter().map(move |datum| (one, datum)));
    let beside = |one: &Compared| match &one.observed.beside {
        Beside::Curve { y, .. } => y.clone(),
        Beside::Measure(name) => name.clone(),
    };
    vec![
        words("data", each().map(|(one, _)| one.observed.name.clone())),
        words("observable", each().map(|(one, _)| beside(one))),
        words("unit", each().map(|(one, _)| one.observed.units[1].clone())),
        numbers("x", each().map(|(_, datum)| Some(datum.x))),
        numbers("measured", each().map(|(_, datum)| Some(datum.y))),
        numbers("error", each().map(|(_, datum)| Some(datum.error))),
        numbers("fitted", outcome.compared.iter().flat_map(|one| &one.predicted).map(|one| Some(*one))),
        numbers("residual_over_error", outcome.compared.iter().flat_map(Compared::residuals).map(Some)),
    ]
}

fn profiles(outcome: &Outcome) -> Vec<TableColumn> {
    let each = || outcome.each().flat_map(|(axis, found)| found.points.iter().map(move |point| (axis, point)));
    vec![
        words("parameter", each().map(|(axis, _)| axis.column.name.clone())),
        words("unit", each().map(|(axis, _)| axis.column.kind.unit().unwrap_or("1").to_owned())),
        numbers("value", each().map(|(_, point)| Some(point[0]))),
        numbers("chi2", each().map(|(_, point)| Some(point[1]))),
    ]
}

fn evaluations(outcome: &Outcome) -> Vec<TableColumn> {
    let mut columns: Vec<TableColumn> = outcome
        .space
        .axes
        .iter()
        .enumerate()
        .map(|(index, axis)| {
            let title = titled(&axis.column.name, axis.column.kind.unit());
            numbers(&title, outcome.evaluations.iter().map(|one| one.cells[index].parse().ok()))
        })
        .collect();
    columns.push(numbers("chi2", outcome.evaluations.iter().map(|one| one.chi2)));
    let path = |path: &Path| path.to_string_lossy().replace('\\', "/");
    columns.push(words("result", outcome.evaluations.iter().map(|one| path(&one.result))));
    columns
}
