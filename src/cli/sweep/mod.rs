//! `pseudopod sweep`: studies of an experiment with many values of its parameters: planned, run, collected.

mod children;
pub mod collect;
pub mod plan;
pub mod run;
mod runs_told;

use super::report::Report;
use crate::error::Result;
use clap::Subcommand;

/// Runs an experiment with many values of its parameters and collects what came out.
#[derive(Debug, Clone, clap::Args)]
pub struct SweepArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: SweepCommand,
}

/// What can be done with studies.
#[derive(Debug, Clone, Subcommand)]
pub enum SweepCommand {
    /// Lists the runs of a study, once the experiment was tried with their values.
    Plan(plan::PlanArgs),
    /// Makes the runs that are not complete, several at a time.
    Run(run::SweepRunArgs),
    /// Collects what the runs measured: a table, and a chart of each measure.
    Collect(collect::CollectArgs),
}

impl SweepCommand {
    /// Its name on the command line, and whether it reports as JSON.
    pub(super) fn manner(&self) -> (&'static str, bool) {
        match self {
            Self::Plan(args) => ("sweep plan", args.json),
            Self::Run(args) => ("sweep run", args.json),
            Self::Collect(args) => ("sweep collect", args.json),
        }
    }
}

/// Runs the command.
///
/// # Errors
/// As each of the commands.
pub fn run(args: &SweepArgs) -> Result<Report> {
    match &args.command {
        SweepCommand::Plan(args) => plan::run(args),
        SweepCommand::Run(args) => run::run(args),
        SweepCommand::Collect(args) => collect::run(args),
    }
}
