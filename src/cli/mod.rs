//! The command line: one file per command. Names and exit codes are a contract.

pub mod chart_look;
pub mod check;
pub mod claims;
mod crash;
pub mod demo;
pub mod eml;
pub mod export;
pub mod files;
pub mod fit;
pub mod frames;
pub mod how;
pub mod info;
pub mod measure;
pub mod memory;
pub mod new;
pub mod own_fault;
pub mod plot;
pub mod progress;
pub mod reference;
pub mod render;
pub mod report;
pub mod resume;
pub mod run;
pub mod run_one;
pub mod schema;
pub mod shipped;
pub mod show;
pub mod sweep;
pub mod track_file;
pub mod verify;
pub mod view;

use crate::error::{Paint, Result, render, say};
use clap::{Parser, Subcommand};
use report::{Form, Report};
use std::io::IsTerminal;

/// Simulates populations of deformable cells.
#[derive(Debug, Parser)]
#[command(name = "pseudopod", version, about, max_term_width = 110)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Lists the experiments that ship, or copies one and runs it.
    Demo(demo::DemoArgs),
    /// Writes an experiment document to begin with.
    New(new::NewArgs),
    /// Runs an experiment.
    Run(run::RunArgs),
    /// Goes on with a run that was stopped or killed.
    Resume(resume::ResumeArgs),
    /// Checks experiment documents.
    Check(check::CheckArgs),
    /// Holds experiments, or results, to what is claimed of them.
    Verify(verify::VerifyArgs),
    /// Describes a result file.
    Info(info::InfoArgs),
    /// Shows a result in the browser, also one that is being written.
    View(view::ViewArgs),
    /// Makes pictures and movies of a result file.
    Render(render::RenderArgs),
    /// Makes charts of a result file.
    Plot(plot::PlotArgs),
    /// Measures tracks of cells: those of a result file, or measured ones.
    Measure(measure::MeasureArgs),
    /// Writes frames of a result file as meshes or fields for other programs, or its numbers as a table.
    Export(export::ExportArgs),
    /// Checks, solves and converts documents of equations: EML, and SBML models.
    Eml(eml::EmlArgs),
    /// Runs an experiment with many values of its parameters and collects what came out.
    Sweep(sweep::SweepArgs),
    /// Fits parameters of an experiment to data, with their intervals.
    Fit(fit::FitArgs),
    /// Prints the JSON schema of experiment documents.
    Schema(schema::SchemaArgs),
    /// Prints a page of the reference: every key, element or option.
    Reference(reference::ReferenceArgs),
}

impl Command {
    /// Its name on the command line, and how it tells what it did.
    fn manner(&self) -> (&'static str, Form) {
        let (name, json) = match self {
            Self::Demo(args) => ("demo", args.how.json),
            Self::New(args) => ("new", args.json),
            Self::Run(args) => ("run", args.how.json),
            Self::Resume(args) => ("resume", args.how.json),
            Self::Check(args) => ("check", args.json),
            Self::Verify(args) => ("verify", args.json),
            Self::Info(args) => ("info", args.json),
            Self::View(_) => ("view", false),
            Self::Render(args) => ("render", args.json),
            Self::Plot(args) => ("plot", args.json),
            Self::Measure(args) => ("measure", args.json),
            Self::Export(args) => ("export", args.json),
            Self::Eml(args) => args.command.manner(),
            Self::Sweep(args) => args.command.manner(),
            Self::Fit(args) => ("fit", args.json),
            Self::Schema(_) => ("schema", false),
            Self::Reference(_) => ("reference", false),
        };
        (name, if json { Form::Json } else { Form::Words })
    }
}

/// Does what the arguments say; returns the exit status.
pub fn main(arguments: Arguments) -> i32 {
    let (name, form) = arguments.command.manner();
    let work = || act(arguments.command, name, form).and_then(|report| report.print(name, form));
    let error = match own_fault::guarded(work).and_then(|outcome| outcome) {
        Ok(None) => return 0,
        // Its object is printed with the report.
        Ok(Some(error)) => error,
        Err(error) => {
            if form == Form::Json {
                // First of all, so that scripts get their object whatever becomes of the words; these tell the same.
                let _ = report::print_failure(name, &error);
            }
            error
        }
    };
    let paint = if std::io::stderr().is_terminal() { Paint::Coloured } else { Paint::Plain };
    let words = own_fault::guarded(|| render(&error, paint)).unwrap_or_else(|_| format!("{error}\n"));
    say(words.strip_suffix('\n').unwrap_or(&words));
    error.exit_code()
}

fn act(command: Command, name: &str, form: Form) -> Result<Report> {
    match command {
        Command::Demo(args) => demo::run(&args),
        Command::New(args) => new::run(&args),
        Command::Run(args) if args.plan.is_some() => run_one::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Resume(args) => resume::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Info(args) => crash::told_as_damage(name, form, &args.result, || info::run(&args)),
        Command::View(args) => crash::told_as_damage(name, form, &args.result, || view::run(&args)),
        Command::Render(args) => crash::told_as_damage(name, form, &args.result, || render::run(&args)),
        Command::Plot(args) => crash::told_as_damage(name, form, &args.result, || plot::run(&args)),
        Command::Measure(args) => crash::told_as_damage(name, form, &args.tracks.file, || measure::run(&args)),
        Command::Export(args) => crash::told_as_damage(name, form, &args.result, || export::run(&args)),
        Command::Eml(args) => eml::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Fit(args) => fit::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Reference(args) => reference::run(&args),
    }
}
