//! Commands of the program, as a user gives them.

use clap::Parser as _;
use pseudopod::cli::report::Report;
use pseudopod::cli::{Arguments, Command, export, info, measure, plot, render};
use pseudopod::error::{Error, Paint};

/// Does what a line says, and tells what is at fault as a terminal shows it. Lines have no quotes.
///
/// # Panics
/// If the line is none of the program.
pub fn command(line: &str) {
    let arguments = Arguments::try_parse_from(line.split(' ')).unwrap_or_else(|error| panic!("{line}: {error}"));
    tell(match &arguments.command {
        Command::Info(args) => info::run(args),
        Command::Export(args) => export::run(args),
        Command::Measure(args) => measure::run(args),
        Command::Plot(args) => plot::run(args),
        Command::Render(args) => render::run(args),
        other => panic!("{other:?} writes what is read, and is not for here"),
    });
}

/// Makes the words of an error: they point into texts.
pub fn tell(done: Result<Report, Error>) {
    if let Err(error) = done {
        told(&error);
    }
}

/// The words of an error are made, and say something.
pub fn told(error: &Error) {
    assert!(!pseudopod::error::render(error, Paint::Plain).is_empty());
}
