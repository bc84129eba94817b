//! `pseudopod eml solve` for a document of fields: its course without any cells, as a table of what a field is as a whole, and its last values.

use super::columns::{Column, Table, set};
use super::draw::Drawing;
use super::last_values::Last;
use super::options::{SolveArgs, points, wished_scheme};
use super::read::named_files;

use crate::cli::files::{Named, refuse_existing, refuse_read, refuse_same};
use crate::cli::report::{Report, path_text, paths};
use crate::equations::Read;
use crate::equations::eml::{Document, FieldDescription, Profile};
use crate::equations::tree::{Expr, QuantityId};
use crate::error::words::{any_of, meant};
use crate::error::{Error, Fault, Result};
use crate::experiment::load_profile;
use crate::field::{FieldSystem, Fields, Grid, Placing, Report as Work, SceneCourse, Stepping};
use crate::ode::Numbers;
use serde_json::json;
use std::path::{Path, PathBuf};

/// What a table holds of each field.
const WHOLES: [&str; 4] = ["mean", "min", "max", "total"];

/// Runs the command for a document of fields.
///
/// # Errors
/// As `eml solve`.
pub(super) fn run(args: &SolveArgs, mut read: Read) -> Result<Report> {
    let mut faults = Vec::new();
    let points = points(args, &mut faults);
    let known = known(&read.document);
    let columns = columns(&args.columns, &read.document.name, &known, &mut faults);
    refuse_idle(args, &mut faults);
    set(&args.sets, &mut read, &mut faults);
    set_starts(args, &mut read.document);
    if let Some(scheme) = wished_scheme(args, &mut faults) {
        read.document.solver.scheme = Some(scheme);
    }
    let placing = placing(args, &read.document, &mut faults);
    let drawing = args.plot.as_ref().map(|path| Drawing::new(path, &columns, points.len()));
    let mut drawing = drawing.and_then(|drawing| drawing.map_err(|fault| faults.push(fault)).ok());
    let last = args.last.as_ref().map(|path| Last::new(path));
    let last = last.and_then(|last| last.map_err(|fault| faults.push(fault)).ok());
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    let outputs = || args.output.iter().chain(&args.plot).chain(&args.last);
    refuse_same(&std::iter::once(&args.document).chain(outputs()).map(PathBuf::as_path).collect::<Vec<&Path>>())?;
    refuse_read(&named_files(&args.document), outputs().map(PathBuf::as_path))?;
    for path in outputs() {
        refuse_existing(path, args.force, Named::ByUser)?;
    }
    let document = &read.document;
    let system = FieldSystem::new(document, placing.as_ref())?;
    let load = |profile: &Profile, grid: &Grid| load_profile(&args.document, profile, grid);
    let mut fields = system.start(&load)?;
    let mut table = Table::new(&columns, args.output.as_deref())?;
    let solved = solve(args, document, &system, &mut fields, &points, &mut |time, values| {
        table.row(time, values);
        if let Some(drawing) = &mut drawing {
            drawing.row(time, values);
        }
    });
    let rows = table.finish()?;
    let mut files: Vec<PathBuf> = args.output.iter().cloned().collect();
    files.extend(drawing.map(|drawing| drawing.save(document)).transpose()?);
    let work = solved.map_err(|error| match error {
        Error::Numbers { message, help, .. } => Error::Numbers { message, help, kept: args.output.clone() },
        other => other,
    })?;
    if let Some(last) = last {
        files.push(last.save(document, &system, &fields)?);
    }
    let words = if args.output.is_some() { paths(&files).join("\n") + "\n" } else { String::new() };
    let report = Report { words, ..Report::default() }.fact("result", path_text(&args.document));
    let report = report.fact("files", paths(&files)).fact("rows", rows);
    let work = json!({ "steps": work.steps, "checks": work.checks, "rejected": work.rejected });
    Ok(report.fact("work", work).fact("notices", read.notices))
}

/// Moves the fields from row to row and tells each.
fn solve(
    args: &SolveArgs,
    document: &Document,
    system: &FieldSystem,
    fields: &mut Fields,
    points: &[f64],
    row: &mut dyn FnMut(f64, &[f64]),
) -> Result<Work> {
    let usual = system.usual_tolerance();
    let adaptive = Stepping::Adaptive {
        relative: args.rtol.or(document.solver.rtol).unwrap_or(usual.0),
        absolute: args.atol.or(document.solver.atol).unwrap_or(usual.1),
    };
    let mut inputs: Vec<f64> = system.inputs().iter().map(|(_, value)| *value).collect();
    let mut whole = Work::default();
    fields.set_time(points[0] * document.seconds);
    let span = points[points.len() - 1] - points[0];
    let mut scene = system.beside().map(|beside| {
        let numbers = Numbers { seed: args.seed, system: &document.name };
        SceneCourse::new(beside, (points[0], span), numbers)
    });
    if let Some(scene) = &mut scene {
        system.settle(fields, &mut inputs, scene.now())?;
    }
    let values = |fields: &Fields, scene: &Option<SceneCourse>, time: f64| {
        let mut values = wholes(document, fields);
        scene.iter().for_each(|scene| scene.values(time, &mut values));
        values
    };
    row(points[0], &values(fields, &scene, points[0]));
    for pair in points.windows(2) {
        let window = pair[1] - pair[0];
        let stepping = match args.inner_step {
            Some(step) => Stepping::Fixed((window / step * (1.0 - 1e-12)).ceil().max(1.0) as u32),
            None => adaptive,
        };
        let seconds = window * document.seconds;
        let report = match &mut scene {
            Some(scene) => system.advance_with(fields, seconds, &mut inputs, stepping, scene.now())?,
            None => system.advance(fields, seconds, &inputs, stepping)?,
        };
        // The sum of windows is not the time of the row to the last bit.
        fields.set_time(pair[1] * document.seconds);
        whole.steps += report.steps;
        whole.checks += report.checks;
        whole.rejected += report.rejected;
        row(pair[1], &values(fields, &scene, pair[1]));
    }
    Ok(whole)
}

/// Mean, least, largest value and total of each field; the total in the document's unit of length.
fn wholes(document: &Document, fields: &Fields) -> Vec<f64> {
    let length = document.grid.as_ref().map_or(1.0, |grid| grid.micrometres);
    let measure = length.powi(fields.grid().dimension() as i32);
    let mut found = Vec::with_capacity(WHOLES.len() * fields.species().len());
    for s in 0..fields.species().len() {
        let values = fields.values(s);
        let amount = fields.amount(s);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        found.extend([amount / (fields.grid().measure() * values.len() as f64), least, most, amount / measure]);
    }
    found
}

/// What there is to be shown, with its unit: what fields are as a whole, and what stands beside them.
fn known(document: &Document) -> Vec<(String, String)> {
    let length = document.grid.as_ref().map_or("um", |grid| grid.unit.as_str());
    let dimension = document.grid.as_ref().map_or(2, |grid| grid.dimension);
    let power = if dimension == 1 { String::new() } else { format!("^{dimension}") };
    let of_field = |field: &FieldDescription| {
        let unit = document.system.quantities[field.quantity as usize].unit.clone();
        let total = if unit.is_empty() { String::new() } else { format!("{unit}*{length}{power}") };
        let units = [unit.clone(), unit.clone(), unit, total];
        WHOLES.into_iter().zip(units).map(|(whole, unit)| (format!("{}.{whole}", field.id), unit)).collect::<Vec<_>>()
    };
    let mut known: Vec<(String, String)> = document.fields.iter().flat_map(of_field).collect();
    known.extend(document.quantities_beside().into_iter().map(|number| {
        let quantity = &document.system.quantities[number as usize];
        (quantity.id.clone(), quantity.unit.clone())
    }));
    known
}

/// The columns with some names, `FIELD.mean` and the like; without any the time and all.
fn columns(names: &[String], document: &str, known: &[(String, String)], faults: &mut Vec<Fault>) -> Vec<Column> {
    let all = || std::iter::once("time").chain(known.iter().map(|(title, _)| title.as_str()));
    let column = |title: &str| {
        let number = known.iter().position(|(known, _)| known == title);
        let unit = number.map_or(String::new(), |number| known[number].1.clone());
        Column { quantity: number.map(|number| number as QuantityId), title: title.to_owned(), unit }
    };
    if names.is_empty() {
        return all().map(column).collect();
    }
    let mut found = Vec::new();
    for name in names {
        let title = name.trim();
        if all().any(|known| known == title) {
            found.push(column(title));
            continue;
        }
        let near = meant(title, all()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let fault = Fault::new(format!("{document} has no column `{title}`"));
        faults.push(fault.help(format!("{near}there are: {}", any_of(all()).replace(" or ", ", "))));
    }
    found
}

/// Tells options that fields have no use for, and numbers without meaning.
fn refuse_idle(args: &SolveArgs, faults: &mut Vec<Fault>) {
    let idle = [
        ("--max-step", args.max_step.is_some(), "let --inner-step be the length of all steps, or --rtol smaller"),
        ("--max-steps", args.max_steps.is_some(), "give a --rtol, or steps of --inner-step"),
    ];
    for (name, _, help) in idle.into_iter().filter(|(_, given, _)| *given) {
        faults.push(Fault::new(format!("{name} has no meaning for fields")).help(help));
    }
    for (name, value) in [("--rtol", args.rtol), ("--inner-step", args.inner_step)] {
        if value.is_some_and(|value| !(value.is_finite() && value > 0.0)) {
            let fault = Fault::new(format!("{name} {} is not above 0", value.unwrap_or(f64::NAN)));
            faults.push(fault.help("give a number such as 1e-3"));
        }
    }
    if args.atol.is_some_and(|value| !(value.is_finite() && value >= 0.0)) {
        let fault = Fault::new(format!("--atol {} is not 0 or more", args.atol.unwrap_or(f64::NAN)));
        faults.push(fault.help("give a number such as 1e-6"));
    }
    if args.inner_step.is_some() && (args.rtol.is_some() || args.atol.is_some()) {
        let fault = Fault::new("--inner-step takes steps of one length, which no tolerance chooses");
        faults.push(fault.help("leave --rtol and --atol, or --inner-step, away"));
    }
}

/// A field that is set starts at the same value everywhere.
fn set_starts(args: &SolveArgs, document: &mut Document) {
    let named = |id: &str| args.sets.iter().any(|set| set.split('=').next().is_some_and(|name| name.trim() == id));
    for field in document.fields.iter_mut().filter(|field| named(&field.id)) {
        let initial = &document.system.quantities[field.quantity as usize].initial;
        if matches!(initial, Expr::Number(_)) {
            field.initial = Profile::Expression(initial.clone());
        }
    }
}

/// Where the grid lies, as far as the document leaves it open: `--size` and `--origin`, in the grid's unit of length.
fn placing(args: &SolveArgs, document: &Document, faults: &mut Vec<Fault>) -> Option<Placing> {
    let grid = document.grid.as_ref()?;
    let numbers = |name: &str, given: &[f64], faults: &mut Vec<Fault>| {
        let fine = given.len() == grid.dimension && given.iter().all(|number| number.is_finite());
        if !fine {
            let message = format!("{name} has {} numbers; {} were expected", given.len(), grid.dimension);
            let help = format!(
                "give one for each axis, with commas between: {name} {}",
                ["100"; 3][..grid.dimension].join(",")
            );
            faults.push(Fault::new(message).help(help));
        }
        let mut found = [0.0; 3];
        found.iter_mut().zip(given).for_each(|(to, from)| *to = from * grid.micrometres);
        fine.then_some(found)
    };
    let own = |given: Option<[f64; 3]>| given.map(|numbers| numbers.map(|number| number * grid.micrometres));
    for (name, given, known) in [("size", &args.size, grid.size), ("origin", &args.origin, grid.origin)] {
        if !given.is_empty() && known.is_some() {
            let fault = Fault::new(format!("--{name} is given, and the grid of {} has its own", document.name));
            faults.push(fault.help(format!("leave --{name} away, or `{name}` of <grid>")));
        }
    }
    if args.size.is_empty() && grid.size.is_none() {
        // What places the grid is told with its line.
        return None;
    }
    let size = own(grid.size).or_else(|| numbers("--size", &args.size, faults))?;
    // As in an experiment: around the origin, the floor at z = 0.
    let middle = [-0.5 * size[0], -0.5 * size[1], 0.0];
    let origin = if args.origin.is_empty() { middle } else { numbers("--origin", &args.origin, faults)? };
    Some(Placing { origin, size })
}
