//! Fits in the layout of PEtab, version 2: a problem in YAML that names tables of parameters, observables, measurements and names.
//!
//! The model of such a problem is an experiment document (`language: pseudopod`), which PEtab's own library, made for SBML, does not read.
//! What PEtab has no column for stands in columns of ours: the unit and scale of parameters, and what an observable is.

use super::document::{Data, Fit};
use super::observed::{Beside, Observed};
use super::space::Space;
use crate::error::Result;
use crate::study::document::Spacing;
use crate::study::paths::{refused, write_all};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The file that names all others.
pub const PROBLEM: &str = "problem.yaml";
/// Tables: parameters, observables, measurements, and the names of both in the experiment.
pub const TABLES: [&str; 4] = ["parameters.tsv", "observables.tsv", "measurements.tsv", "mapping.tsv"];

/// Writes a fit as a PEtab problem into a folder. `experiment` is its document as seen from there.
///
/// # Errors
/// [`Error::Machine`](crate::error::Error::Machine) when the disk refuses.
pub fn write_petab(
    fit: &Fit,
    space: &Space,
    observed: &[Observed],
    experiment: &Path,
    folder: &Path,
) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder).map_err(|error| refused(folder, &error))?;
    let mut ids = Ids::default();
    let parameter_ids: Vec<String> = space.axes.iter().map(|axis| ids.of(&axis.column.name)).collect();
    let observable_ids: Vec<String> = observed.iter().map(|one| ids.of(&one.name)).collect();
    let [parameters, observables, measurements, mapping] = TABLES;
    let problem = format!(
        "format_version: 2.0.0\nparameter_files:\n  - {parameters}\nmodel_files:\n  experiment:\n    location: {}\n    language: pseudopod\n\
         observable_files:\n  - {observables}\nmeasurement_files:\n  - {measurements}\nmapping_files:\n  - {mapping}\n",
        experiment.to_string_lossy().replace('\\', "/")
    );
    let mut names = vec![vec!["petabEntityId".to_owned(), "modelEntityId".to_owned()]];
    names.extend(parameter_ids.iter().zip(&space.axes).map(|(id, axis)| vec![id.clone(), axis.column.key.clone()]));
    let texts = [
        (PROBLEM, problem),
        (parameters, table(&parameter_rows(space, &parameter_ids))),
        (observables, table(&observable_rows(fit, observed, &observable_ids, &mut ids, &mut names))),
        (measurements, table(&measurement_rows(observed, &observable_ids))),
        (mapping, table(&names)),
    ];
    write_all(texts, folder)
}

/// Names as PEtab takes them, each once: letters, digits and underscores, no digit first.
#[derive(Default)]
struct Ids {
    taken: BTreeSet<String>,
}

impl Ids {
    fn of(&mut self, name: &str) -> String {
        let mut id: String = name.chars().map(|sign| if sign.is_ascii_alphanumeric() { sign } else { '_' }).collect();
        if id.is_empty() || id.starts_with(|sign: char| sign.is_ascii_digit()) {
            id.insert(0, '_');
        }
        while !self.taken.insert(id.clone()) {
            id.push('_');
        }
        id
    }
}

/// Rows of cells parted by tabs, of which there is none in a cell.
fn table(rows: &[Vec<String>]) -> String {
    rows.iter()
        .map(|row| row.iter().map(|cell| cell.replace(['\t', '\n'], " ")).collect::<Vec<_>>().join("\t") + "\n")
        .collect()
}

fn owned<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

fn parameter_rows(space: &Space, ids: &[String]) -> Vec<Vec<String>> {
    let titles =
        ["parameterId", "parameterName", "lowerBound", "upperBound", "nominalValue", "estimate", "unit", "scale"];
    let rows = ids.iter().zip(&space.axes).map(|(id, axis)| {
        let scale = if axis.range.scale == Spacing::Log { "log" } else { "linear" };
        let ends = [axis.range.from, axis.range.to].map(|end| end.to_string());
        let (start, unit) = (axis.range.at(axis.start), axis.column.kind.unit().unwrap_or_default());
        owned([id, &axis.column.name, &ends[0], &ends[1], &start, "true", unit, scale])
    });
    [owned(titles)].into_iter().chain(rows).collect()
}

fn observable_rows(
    fit: &Fit,
    observed: &[Observed],
    ids: &[String],
    all: &mut Ids,
    names: &mut Vec<Vec<String>>,
) -> Vec<Vec<String>> {
    let titles = [
        "observableId",
        "observableName",
        "observableFormula",
        "noiseFormula",
        "noisePlaceholders",
        "noiseDistribution",
        "kind",
        "abscissa",
        "cells",
        "unit",
    ];
    let mut rows = vec![owned(titles)];
    for ((id, one), data) in ids.iter().zip(observed).zip(&fit.data) {
        let (entity, kind, abscissa) = match &one.beside {
            Beside::Curve { x, y, .. } => (y, "series", x.as_str()),
            Beside::Measure(name) => (name, "measure", ""),
        };
        let (entity_id, noise) = (all.of(entity), all.of(&format!("sd_{id}")));
        names.push(vec![entity_id.clone(), entity.clone()]);
        let Data { cells, .. } = data;
        let cells = cells.as_deref().unwrap_or_default();
        rows.push(owned([id, &one.name, &entity_id, &noise, &noise, "normal", kind, abscissa, cells, &one.units[1]]));
    }
    rows
}

fn measurement_rows(observed: &[Observed], ids: &[String]) -> Vec<Vec<String>> {
    let rows = ids.iter().zip(observed).flat_map(|(id, one)| {
        one.data.iter().map(move |datum| {
            // What has no instant is taken at the end of a run.
            let time = if matches!(one.beside, Beside::Measure(_)) { "inf".to_owned() } else { datum.x.to_string() };
            owned([id, "", &datum.y.to_string(), &time, &datum.error.to_string()])
        })
    });
    [owned(["observableId", "experimentId", "measurement", "time", "noiseParameters"])]
        .into_iter()
        .chain(rows)
        .collect()
}
