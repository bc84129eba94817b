//! `pseudopod eml`: documents of equations, EML and SBML, by themselves: checked, solved, converted.

pub mod check;
mod columns;
mod draw;
pub mod from_sbml;
mod last_values;
mod options;
mod read;
pub mod solve;
mod solve_fields;
pub mod to_sbml;
mod written;

use super::report::Report;
use crate::error::Result;
use clap::Subcommand;

/// Checks, solves and converts documents of equations: EML, and SBML models.
#[derive(Debug, Clone, clap::Args)]
pub struct EmlArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: EmlCommand,
}

/// What can be done with documents of equations.
#[derive(Debug, Clone, Subcommand)]
pub enum EmlCommand {
    /// Checks documents and says what is in them.
    Check(check::CheckArgs),
    /// Solves the equations of a document, without any cells.
    Solve(Box<options::SolveArgs>),
    /// Writes an SBML model as an EML document.
    FromSbml(from_sbml::FromSbmlArgs),
    /// Writes an EML document as an SBML model.
    ToSbml(to_sbml::ToSbmlArgs),
}

impl EmlCommand {
    /// Its name on the command line, and whether it reports as JSON.
    pub(super) fn manner(&self) -> (&'static str, bool) {
        match self {
            Self::Check(args) => ("eml check", args.json),
            Self::Solve(args) => ("eml solve", args.json),
            Self::FromSbml(args) => ("eml from-sbml", args.target.json),
            Self::ToSbml(args) => ("eml to-sbml", args.target.json),
        }
    }
}

/// Runs the command.
///
/// # Errors
/// As each of the commands.
pub fn run(args: &EmlArgs) -> Result<Report> {
    match &args.command {
        EmlCommand::Check(args) => check::run(args),
        EmlCommand::Solve(args) => solve::run(args),
        EmlCommand::FromSbml(args) => from_sbml::run(args),
        EmlCommand::ToSbml(args) => to_sbml::run(args),
    }
}
