//! `pseudopod view`: shows a result in the browser.

use super::report::{Report, path_text};
use super::run::cancelled_by_signals;
use crate::error::{Result, say};
use crate::view::Server;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Shows a result in the browser, also one that is being written.
#[derive(Debug, Clone, clap::Args)]
pub struct ViewArgs {
    /// The result file.
    pub result: PathBuf,
    /// How the page is served.
    #[command(flatten)]
    pub page: PageArgs,
}

/// How a page is served; `view` and runs share it.
#[derive(Debug, Clone, clap::Args)]
pub struct PageArgs {
    /// The port at which the page is served, on this machine alone; a free one when absent.
    #[arg(long, value_name = "NUMBER", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Opens the page in the browser.
    #[arg(long)]
    pub open: bool,
}

/// Runs the command.
///
/// # Errors
/// A result that is not there or damaged, a port that is taken.
pub fn run(args: &ViewArgs) -> Result<Report> {
    let server = Server::start(&args.result, args.page.port, None)?;
    tell(&server, &args.result, &args.page);
    say("Ctrl-C ends it");
    let token = cancelled_by_signals();
    while !token.is_cancelled() {
        std::thread::sleep(Duration::from_millis(50));
    }
    Ok(Report::default().fact("result", path_text(&args.result)).fact("address", server.address()))
}

/// Says where a page is, and opens it where that is wanted.
pub fn tell(server: &Server, result: &Path, args: &PageArgs) {
    say(&format!("{} is shown at {}", result.display(), server.address()));
    if args.open {
        open(server.address());
    }
}

/// Asks the system to open an address; where it cannot, the address has been told.
fn open(address: &str) {
    let (program, before): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let mut command = std::process::Command::new(program);
    let quiet = || std::process::Stdio::null();
    let started = command.args(before).arg(address).stdin(quiet()).stdout(quiet()).stderr(quiet()).spawn();
    if started.is_err() {
        say(&format!("{program} could not be started: open the address in a browser"));
    }
}
