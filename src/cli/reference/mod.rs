//! `pseudopod reference`: the reference pages of the book, made from what reads documents, equations and the command line.

mod commands;
mod documents;
mod equations;

use super::report::Report;
use crate::error::Result;
use clap::{CommandFactory, ValueEnum};
use std::path::PathBuf;

/// Prints a page of the reference, in Markdown: every word that a document, a document of equations or the command line may have.
#[derive(Debug, Clone, clap::Args)]
pub struct ReferenceArgs {
    /// Which page.
    #[arg(value_name = "PAGE")]
    pub page: Page,
    /// Writes to this file instead of the terminal.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replaces a file that is there.
    #[arg(long)]
    pub force: bool,
}

/// The pages of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Page {
    /// Documents of experiments.
    Experiment,
    /// Documents of studies.
    Study,
    /// Documents of fits.
    Fit,
    /// Documents of equations.
    Eml,
    /// The command line.
    Commands,
}

/// A page as text, the same as in `docs/src/reference_NAME.md`.
pub fn text(page: Page) -> String {
    let made = "This page is made from what reads it, `pseudopod reference";
    match page {
        Page::Experiment => {
            let introduction = format!(
                "Every key of an experiment, table by table: what it holds, what is so when it is absent, and what it means. {made} experiment`; \
                 [Documents](documents.md) is the map. `cells.NAME` stands for a table with a name of your own, `loads[]` for each of a list, \
                 in TOML `[[cells.NAME.loads]]`. Quantities are texts with [units](units.md), those that are 0 also the number; paths are from the folder of the document."
            );
            documents::page("Keys of experiments", &introduction, &crate::experiment::schema())
        }
        Page::Study => {
            let introduction = format!("Every key of a [study](howto_sweep.md), table by table. {made} study`.");
            documents::page("Keys of studies", &introduction, &crate::study::schema())
        }
        Page::Fit => {
            let introduction = format!("Every key of a [fit](howto_fit.md), table by table. {made} fit`.");
            documents::page("Keys of fits", &introduction, &crate::study::fit::schema())
        }
        Page::Eml => equations::page(&format!(
            "Every element of [EML](eml.md) with its attributes, every function of its expressions, every scheme. {made} eml`. Which numbers of \
             cells and fields links read and set is in [Chemistry and cells](coupling.md)."
        )),
        Page::Commands => {
            let introduction = format!("Every command with its options, as `--help` tells them. {made} commands`.");
            commands::page(&introduction, &super::Arguments::command())
        }
    }
}

/// Runs the command.
///
/// # Errors
/// The file exists or cannot be written.
pub fn run(args: &ReferenceArgs) -> Result<Report> {
    super::schema::printed(text(args.page), args.output.as_deref(), args.force)
}
