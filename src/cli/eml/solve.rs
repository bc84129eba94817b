//! `pseudopod eml solve`: solves the equations of a document, without any cells.

use super::columns::{Table, columns, set};
use super::draw::Drawing;
use super::options::{SolveArgs, options, points};
use super::read::{named_files, read};
use super::solve_fields;

use crate::cli::files::{Named, refuse_existing, refuse_read, refuse_same};
use crate::cli::report::{Report, path_text, paths};
use crate::error::{Error, Fault, Result, say};
use crate::ode::solve_each;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Runs the command.
///
/// # Errors
/// A document or option at fault, all told at once; a file that exists or cannot be written; [`Error::Numbers`] when the
/// numbers fail: the rows until then are kept.
pub fn run(args: &SolveArgs) -> Result<Report> {
    let mut read = read(&args.document)?;
    if read.document.membrane.is_some() {
        let fault = Fault::new(format!("{} is a document of membranes, which need surfaces", args.document.display()));
        return Err(Error::input(fault.help("give it to an experiment, under [chemistry.NAME], and run that")));
    }
    if let Some(noise) = read.document.noise.first() {
        let fault = Fault::new(format!("{} has noise, which single solves do not have", args.document.display()));
        let help = "give it to an experiment, under [chemistry.NAME], and run that; or take `noise` out";
        return Err(Error::input(fault.at(noise.location.clone()).help(help)));
    }
    if !read.document.fields.is_empty() {
        return solve_fields::run(args, read);
    }
    let mut faults = Vec::new();
    refuse_of_fields(args, &mut faults);
    let points = points(args, &mut faults);
    let columns = columns(&args.columns, &read, &mut faults);
    let (scheme, options) = options(args, &read.document, &mut faults);
    set(&args.sets, &mut read, &mut faults);
    let drawing = args.plot.as_ref().map(|path| Drawing::new(path, &columns, points.len()));
    let mut drawing = drawing.and_then(|drawing| drawing.map_err(|fault| faults.push(fault)).ok());
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    let outputs = || args.output.iter().chain(&args.plot).map(PathBuf::as_path);
    refuse_same(&std::iter::once(args.document.as_path()).chain(outputs()).collect::<Vec<&Path>>())?;
    refuse_read(&named_files(&args.document), outputs())?;
    for path in args.output.iter().chain(&args.plot) {
        refuse_existing(path, args.force, Named::ByUser)?;
    }
    if !args.json {
        tell(&read.notices);
    }
    let mut table = Table::new(&columns, args.output.as_deref())?;
    let system = &read.document.system;
    let solved = solve_each(system, args.from, args.until, &points, &options, &mut |time, values| {
        table.row(time, values);
        if let Some(drawing) = &mut drawing {
            drawing.row(time, values);
        }
    });
    let rows = table.finish()?;
    let mut files: Vec<PathBuf> = args.output.iter().cloned().collect();
    files.extend(drawing.map(|drawing| drawing.save(&read.document)).transpose()?);
    let work = solved.map_err(|trouble| match Error::from(trouble) {
        Error::Numbers { message, help, .. } => Error::Numbers { message, help, kept: args.output.clone() },
        other => other,
    })?;
    let words = if args.output.is_some() { paths(&files).join("\n") + "\n" } else { String::new() };
    let report = Report { words, ..Report::default() }.fact("result", path_text(&args.document));
    let report = report.fact("files", paths(&files)).fact("rows", rows).fact("scheme", scheme);
    Ok(report.fact("work", json!(work)).fact("notices", read.notices))
}

/// Tells options that only fields have a use for.
fn refuse_of_fields(args: &SolveArgs, faults: &mut Vec<Fault>) {
    let given =
        [("--last", args.last.is_some()), ("--size", !args.size.is_empty()), ("--origin", !args.origin.is_empty())];
    for (name, _) in given.into_iter().filter(|(_, given)| *given) {
        let fault = Fault::new(format!("{name} is for fields, and {} has none", args.document.display()));
        faults.push(fault.help(format!("leave {name} away; -o writes the table of a system")));
    }
}

/// Tells what the reader of a model should know, beside what goes to standard output.
pub(super) fn tell(notices: &[String]) {
    for notice in notices {
        say(&format!("note: {notice}"));
    }
}
