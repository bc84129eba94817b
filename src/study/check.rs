//! Looks at every point of a study before anything runs: whether the experiment takes its values, and can be built with them.

use super::design::Points;
use super::document::{Anything, Parameter, StudyDocument};
use super::facts::{sets, told_cells};
use crate::error::{Error, Fault, Location, Result};
use crate::experiment::{Document, prepare};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Most points whose documents are read; of more, as many that are evenly spread.
const MOST_READ: usize = 5_000;
/// How long points are built; meshes and stiffnesses of some take seconds.
const LONGEST: Duration = Duration::from_secs(10);
/// Most faults that are told: those of a parameter that fits nowhere would be one for each point.
const MOST_FAULTS: usize = 20;

/// What was found out about the points.
#[derive(Debug, Clone)]
pub struct Looked {
    /// The experiment with the values of the first point, of the last and of one between, if there are so many: one alone does not tell
    /// how long runs take, as what is varied makes some longer.
    pub some: Vec<Document>,
    /// The files that runs read.
    pub files: Vec<PathBuf>,
    /// Points whose documents were read.
    pub read: usize,
    /// Points that were built as well.
    pub built: usize,
}

/// Reads the experiment with the values of the points, and builds as many as there is time for, the first and the last before all others.
///
/// * `memory` – bytes that a run may take, by an estimate; any number when absent
///
/// # Errors
/// [`Error::Input`] with what is wrong with which value, where the study has it, or with which point.
pub fn look_over(study: &StudyDocument, points: &Points, memory: Option<u64>) -> Result<Looked> {
    let said = &study.study;
    Document::read(&study.experiment(), &said.set).map_err(|error| of_the_study(error, study, None))?;
    let (mut faults, mut files, mut documents) = (Vec::<Fault>::new(), BTreeSet::new(), Vec::new());
    for number in spread(points.rows.len(), MOST_READ) {
        let row = &points.rows[number];
        let changes: Vec<String> = said.set.iter().cloned().chain(sets(&points.columns, row)).collect();
        match Document::read(&study.experiment(), &changes) {
            Ok(mut document) => {
                document.memory = memory;
                files.extend(document.files());
                documents.push((number, document));
            }
            Err(error) => add(&mut faults, of_the_study(error, study, Some((points, number)))),
        }
        if faults.len() >= MOST_FAULTS {
            break;
        }
    }
    if let Some((_, document)) = documents.first() {
        faults.extend(names_of_measures(study, document));
    }
    if !faults.is_empty() {
        return Err(Error::Input(in_order(faults, study)));
    }
    let read = documents.len();
    // What is wrong with a large or a small value shows at the ends.
    if read > 2 {
        documents.swap(1, read - 1);
        documents.swap(2, read / 2);
    }
    let (began, mut built, mut some) = (Instant::now(), 0, Vec::new());
    for (number, document) in documents {
        if built > 2 && began.elapsed() > LONGEST {
            break;
        }
        if let Err(error) = prepare(&document) {
            add(&mut faults, of_the_study(error, study, Some((points, number))));
        }
        built += 1;
        if some.len() < 3 {
            some.push(document);
        }
        if faults.len() >= MOST_FAULTS {
            break;
        }
    }
    match faults.is_empty() {
        true => Ok(Looked { some, files: files.into_iter().collect(), read, built }),
        false => Err(Error::Input(in_order(faults, study))),
    }
}

/// Faults in the order of the study. Of a range whose ends are at fault, what is between them is not told.
fn in_order(mut faults: Vec<Fault>, study: &StudyDocument) -> Vec<Fault> {
    let start = |fault: &Fault| fault.location.as_ref().map(|location| location.start);
    for (number, parameter) in study.study.parameter.iter().enumerate().filter(|(_, one)| one.from.is_some()) {
        let at = |key: &str| Some(study.location(&format!("parameter[{number}].{key}"), "").start);
        let (key, ends) = (at("key"), [at("from"), at("to")]);
        // Only a fault of the value itself stands there: that the key is unknown is told at the key.
        if parameter.values.is_none() && faults.iter().any(|fault| ends.contains(&start(fault))) {
            faults.retain(|fault| start(fault) != key);
        }
    }
    faults.sort_by_key(start);
    faults
}

/// Parameters that are named as measures are: both are columns of one table.
fn names_of_measures(study: &StudyDocument, document: &Document) -> Vec<Fault> {
    let named = study.study.parameter.iter().enumerate();
    let alike = named.filter(|(_, parameter)| document.experiment.measure.contains_key(parameter.label()));
    let fault = |(number, parameter): (usize, &Parameter)| {
        let which = if parameter.name.is_some() { "name" } else { "key" };
        let fault = Fault::new(format!("the experiment measures something that is named `{}`, too", parameter.label()));
        let location = study.location(&format!("parameter[{number}].{which}"), "taken by a measure");
        fault.at(location).help("choose another `name` for the parameter")
    };
    alike.map(fault).collect()
}

/// Numbers below `all`, evenly spread, the first and the last among them, `most` at most.
fn spread(all: usize, most: usize) -> Vec<usize> {
    if all <= most {
        return (0..all).collect();
    }
    (0..most).map(|k| k * (all - 1) / (most - 1)).collect()
}

/// Adds faults that are not told yet.
fn add(faults: &mut Vec<Fault>, error: Error) {
    match error {
        Error::Input(found) => found.into_iter().for_each(|fault| {
            let is_known =
                |known: &Fault| *known == fault || known.location.is_some() && known.location == fault.location;
            if !faults.iter().any(is_known) {
                faults.push(fault);
            }
        }),
        other => faults.push(Fault::new(other.to_string()).help(
            "leave these values out, or try them by themselves: pseudopod run, with the values as --set KEY=VALUE",
        )),
    }
}

/// A fault of the experiment with some values, told where the study has the value, or with the values of the point.
fn of_the_study(error: Error, study: &StudyDocument, point: Option<(&Points, usize)>) -> Error {
    let Error::Input(faults) = error else { return error };
    Error::Input(faults.into_iter().map(|fault| moved(fault, study, point)).collect())
}

fn moved(mut fault: Fault, study: &StudyDocument, point: Option<(&Points, usize)>) -> Fault {
    let set = fault.location.as_ref().and_then(|location| {
        let key = location.source.name.strip_prefix("--set ")?.strip_suffix("=…")?;
        Some((key.to_owned(), location.label.clone()))
    });
    let Some((key, label)) = set else {
        if fault.location.is_none() && point.is_none() {
            return fault.at(study.location("experiment", "this document"));
        }
        if let Some((points, number)) = point {
            let told = told_cells(&points.columns, &points.rows[number]);
            fault.message = format!("with {told}: {}", fault.message);
        }
        return fault;
    };
    fault.location = Some(location_of(study, point, &key, &label));
    fault
}

/// Where the study has a value that is set.
fn location_of(study: &StudyDocument, point: Option<(&Points, usize)>, key: &str, label: &str) -> Location {
    let said = &study.study;
    if let Some(number) = said.parameter.iter().position(|parameter| parameter.key == key) {
        let at = format!("parameter[{number}]");
        let values = said.parameter[number].values.as_ref();
        let cell = point.map(|(points, row)| &points.rows[row][number]);
        let index = values.zip(cell).and_then(|(values, cell)| {
            let shown = |value: &Anything| super::value::shown(&value.0).1;
            values.iter().position(|value| shown(value) == *cell)
        });
        // That there is no such key is told at the key.
        let of_the_key = label.starts_with("did you mean") || label == "unknown key";
        let end = point.and_then(|(points, row)| {
            let (cell, shown) = (&points.rows[row][number], |end: &Anything| super::value::shown(&end.0).1);
            let is_end = |end: &Option<Anything>| end.as_ref().is_some_and(|end| shown(end) == *cell);
            let parameter = &said.parameter[number];
            let ends = [("from", is_end(&parameter.from)), ("to", is_end(&parameter.to))];
            ends.into_iter().find(|(_, is_end)| *is_end).map(|(end, _)| end)
        });
        return match (index, end) {
            _ if of_the_key => study.location(&format!("{at}.key"), label),
            (Some(index), _) => study.location(&format!("{at}.values[{index}]"), label),
            (_, Some(end)) => study.location(&format!("{at}.{end}"), label),
            _ => study.location(&format!("{at}.key"), label),
        };
    }
    let set = said.set.iter().position(|set| set.split('=').next() == Some(key));
    set.map_or_else(|| study.location("experiment", label), |index| study.location(&format!("set[{index}]"), label))
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn the_first_and_the_last_point_are_always_looked_at() {
        assert_eq!(spread(3, 10), [0, 1, 2]);
        let many = spread(100_000, 50);
        assert_eq!((many.len(), many[0], many[49]), (50, 0, 99_999));
    }
}
