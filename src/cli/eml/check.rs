//! `pseudopod eml check`: finds all faults of documents of equations, or says what is in them.

use super::read::read;
use crate::cli::report::{Form, Report, path_text};
use crate::equations::Read;
use crate::equations::eml::{Level, SCHEMES, SURFACE};
use crate::equations::tree::{Quantity, Role};
use crate::error::{Error, Result};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// How many names of a kind are shown to people.
const MOST_NAMES: usize = 12;

/// Checks documents of equations and reports all their faults, or what is in them.
#[derive(Debug, Clone, clap::Args)]
pub struct CheckArgs {
    /// The documents: EML or SBML.
    #[arg(required = true, value_name = "FILE")]
    pub documents: Vec<PathBuf>,
    /// Prints what was found as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command: describes every good document; tells the faults of all others together.
///
/// # Errors
/// [`Error::Input`] with the faults of all documents.
pub fn run(args: &CheckArgs) -> Result<Report> {
    let (mut words, mut good, mut faults) = (String::new(), Vec::<Value>::new(), Vec::new());
    for path in &args.documents {
        match read(path) {
            Ok(read) => {
                words.push_str(&describe(path, &read));
                good.push(object(path, &read));
            }
            Err(Error::Input(found)) => faults.extend(found),
            Err(other) => return Err(other),
        }
    }
    let report = Report { words, ..Report::default() }.fact("documents", good);
    if faults.is_empty() {
        return Ok(report);
    }
    if !args.json {
        report.print("eml check", Form::Words)?;
    }
    Err(Error::Input(faults))
}

/// A document in some lines for people.
fn describe(path: &Path, read: &Read) -> String {
    let document = &read.document;
    let (language, whose) = (language(read), whose(document.level));
    let mut text = format!(
        "{}: good: \"{}\", {language}, {whose}, time in {}\n",
        path.display(),
        document.name,
        document.time_unit
    );
    for (kind, names) in kinds(read) {
        if names.is_empty() {
            continue;
        }
        let shown = names.iter().take(MOST_NAMES).copied().collect::<Vec<_>>().join(", ");
        let rest = if names.len() > MOST_NAMES { ", …" } else { "" };
        // Writing to a text cannot fail.
        let _ = writeln!(text, "  {kind} ({}): {shown}{rest}", names.len());
    }
    for link in &document.links {
        let _ = writeln!(text, "  link: {} -> {}", link.from.text, link.to.text);
    }
    let solver: Vec<String> =
        solver(read).into_iter().map(|(name, value)| format!("{name} {}", plain(&value))).collect();
    if !solver.is_empty() {
        let _ = writeln!(text, "  solver: {}", solver.join(", "));
    }
    for notice in &read.notices {
        let _ = writeln!(text, "  note: {notice}");
    }
    text
}

/// A document for scripts.
fn object(path: &Path, read: &Read) -> Value {
    let document = &read.document;
    let level = document.level.name();
    let mut object = json!({
        "path": path_text(path),
        "name": document.name,
        "language": language(read),
        "level": level,
        "time_unit": document.time_unit,
    });
    for (kind, names) in kinds(read) {
        object[kind] = names.into();
    }
    let link = |link: &crate::equations::eml::LinkDescription| json!({ "from": link.from.text, "to": link.to.text });
    object["links"] = document.links.iter().map(link).collect();
    object["solver"] = Value::Object(solver(read).into_iter().map(|(name, value)| (name.to_owned(), value)).collect());
    object["notices"] = read.notices.clone().into();
    object
}

fn language(read: &Read) -> &'static str {
    if read.sbml.is_some() { "SBML" } else { "EML" }
}

fn whose(level: Level) -> &'static str {
    match level {
        Level::Scene => "one system for the scene",
        Level::Cell => "one system for each cell",
        Level::Field => "fields",
        Level::Membrane => "one system on each membrane",
    }
}

/// The identifiers of a document by what they stand for.
fn kinds(read: &Read) -> Vec<(&'static str, Vec<&str>)> {
    let (system, fields) = (&read.document.system, &read.document.fields);
    let is_field = |quantity: &Quantity| fields.iter().any(|field| field.id == quantity.id);
    let id = |number: u32| system.quantities[number as usize].id.as_str();
    let (mut surface, mut sums) = (Vec::new(), Vec::new());
    if let Some(membrane) = &read.document.membrane {
        surface.extend(membrane.surface.iter().map(|variable| id(variable.quantity)));
        sums.extend(membrane.totals.iter().map(|total| id(total.quantity)));
    }
    let of = |wanted: &dyn Fn(&Quantity) -> bool| {
        system.quantities.iter().filter(|quantity| wanted(quantity)).map(|quantity| quantity.id.as_str()).collect()
    };
    // The position in a field is nobody's input, nor is what a membrane gives.
    let given: &[&str] = match read.document.level {
        Level::Field => &SURFACE[..3],
        Level::Membrane => &SURFACE,
        Level::Scene | Level::Cell => &[],
    };
    let position = |quantity: &Quantity| given.contains(&quantity.id.as_str()) || sums.contains(&quantity.id.as_str());
    let is_surface = |quantity: &Quantity| surface.contains(&quantity.id.as_str());
    let drawn: Vec<&str> =
        system.draws.iter().map(|draw| system.quantities[draw.quantity as usize].id.as_str()).collect();
    let is_drawn = |quantity: &Quantity| drawn.contains(&quantity.id.as_str());
    let mut kinds = vec![
        ("fields", fields.iter().map(|field| field.id.as_str()).collect()),
        (
            "variables",
            of(&|quantity| {
                matches!(quantity.role, Role::Variable { .. }) && !is_field(quantity) && !is_surface(quantity)
            }),
        ),
        ("parameters", of(&|quantity| matches!(quantity.role, Role::Parameter) && !is_drawn(quantity))),
        ("definitions", of(&|quantity| matches!(quantity.role, Role::Defined { .. }))),
        ("inputs", of(&|quantity| matches!(quantity.role, Role::Input) && !position(quantity))),
        ("events", system.events.iter().map(|event| event.id.as_str()).collect()),
    ];
    if read.document.membrane.is_some() {
        kinds.insert(0, ("membrane", surface));
        kinds.push(("sums", sums));
    }
    kinds
}

/// How the document asks to be solved.
fn solver(read: &Read) -> Vec<(&'static str, Value)> {
    let choice = &read.document.solver;
    let scheme = SCHEMES.iter().find(|(_, scheme)| choice.scheme == Some(*scheme)).map(|(name, _)| json!(name));
    let number = |value: Option<f64>| value.map(|value| json!(value));
    let all = [
        ("scheme", scheme),
        ("rtol", number(choice.rtol)),
        ("atol", number(choice.atol)),
        ("step", number(choice.step)),
        ("inner_step", number(choice.inner_step)),
        ("noise_step", number(choice.noise_step)),
    ];
    all.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
}

/// A word without quotes, or a number.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
