//! `pseudopod new`: documents to begin with, commented, which run as they are.

use super::files::{Named, refuse_existing, refuse_same};
use super::report::{Report, path_text, paths};
use crate::error::{Error, Fault, Result};
use crate::output::write_text;
use serde_json::json;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Writes an experiment document to begin with, with comments, which runs as it is.
#[derive(Debug, Clone, clap::Args)]
pub struct NewArgs {
    /// What to begin with; all are listed when absent.
    pub template: Option<String>,
    /// The document; by default the name of the template in the working folder. Documents that it refers to are written beside it.
    #[arg(short, long, value_name = "FILE", requires = "template")]
    pub output: Option<PathBuf>,
    /// Replaces files that are there.
    #[arg(long)]
    pub force: bool,
    /// Prints what was written as JSON.
    #[arg(long)]
    pub json: bool,
}

/// A document to begin with.
struct Template {
    name: &'static str,
    shows: &'static str,
    /// The document: its name where no other is wanted, and its text.
    document: (&'static str, &'static str),
    /// What it refers to, by the names that it uses.
    beside: &'static [(&'static str, &'static str)],
    /// What to do with it.
    next: &'static str,
}

macro_rules! text {
    ($name:literal) => {
        ($name, include_str!(concat!("../../templates/", $name)))
    };
}

/// All of them.
const TEMPLATES: [Template; 6] = [
    Template {
        name: "dish",
        shows: "two types of cells wander in a dish, meet, and stick to their own type",
        document: text!("dish.toml"),
        beside: &[],
        next: "run",
    },
    Template {
        name: "aggregate",
        shows: "cells are drawn together, stick and flatten against each other",
        document: text!("aggregate.toml"),
        beside: &[],
        next: "run",
    },
    Template {
        name: "pull",
        shows: "a red cell is stretched between two points, as by optical tweezers",
        document: text!("pull.toml"),
        beside: &[],
        next: "run",
    },
    Template {
        name: "squeeze",
        shows: "a cell is pressed flat between two plates",
        document: text!("squeeze.toml"),
        beside: &[],
        next: "run",
    },
    Template {
        name: "chemotaxis",
        shows: "cells sense an attractant that spreads from a source, and crawl to it",
        document: text!("chemotaxis.toml"),
        beside: &[text!("attractant.eml"), text!("compass.eml")],
        next: "run",
    },
    Template {
        name: "sweep",
        shows: "a study: one experiment with many values of its parameters",
        document: text!("study.toml"),
        beside: &[text!("cells.toml")],
        next: "sweep plan",
    },
];

/// Runs the command.
///
/// # Errors
/// There is no such template, or a file exists or cannot be written.
pub fn run(args: &NewArgs) -> Result<Report> {
    let Some(name) = &args.template else { return Ok(list()) };
    let Some(template) = TEMPLATES.iter().find(|template| template.name == name) else { return Err(unknown(name)) };
    let document = args.output.clone().unwrap_or_else(|| PathBuf::from(template.document.0));
    let beside = template.beside.iter().map(|(name, text)| (document.with_file_name(name), *text));
    let files: Vec<(PathBuf, &str)> = std::iter::once((document.clone(), template.document.1)).chain(beside).collect();
    let names: Vec<&Path> = files.iter().map(|(path, _)| path.as_path()).collect();
    refuse_same(&names)?;
    for path in &names {
        refuse_existing(path, args.force, Named::ByUser)?;
    }
    for (path, text) in &files {
        write_text(text, path)?;
    }
    let names: Vec<PathBuf> = files.into_iter().map(|(path, _)| path).collect();
    let mut words: String = names.iter().map(|path| format!("{}\n", path.display())).collect();
    // Writing to a text cannot fail.
    let _ = writeln!(words, "read it, change it, and: pseudopod {} {}", template.next, document.display());
    Ok(Report { words, ..Report::default() }.fact("document", path_text(&document)).fact("files", paths(&names)))
}

fn unknown(name: &str) -> Error {
    let names = || TEMPLATES.iter().map(|template| template.name);
    let help = match crate::error::words::meant(name, names()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("there are: {}", names().collect::<Vec<_>>().join(", ")),
    };
    Error::input(Fault::new(format!("no template is named `{name}`")).help(help))
}

fn list() -> Report {
    let mut words = String::new();
    for template in &TEMPLATES {
        // Writing to a text cannot fail.
        let _ = writeln!(words, "{:10}  {}", template.name, template.shows);
    }
    words.push_str("\npseudopod new NAME writes NAME.toml (sweep: study.toml), which runs as it is\n");
    let object = |template: &Template| json!({ "name": template.name, "shows": template.shows });
    Report { words, ..Report::default() }.fact("templates", TEMPLATES.iter().map(object).collect::<Vec<_>>())
}
