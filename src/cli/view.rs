//! `pseudopod view`: shows a result in the browser.

use super::how::{How, PageArgs, cancelled_saying, reporter};
use super::report::{After, Report, path_text};
use crate::error::{Error, Fault, Result, say};
use crate::run;
use crate::simulation::CancelToken;
use crate::view::{Live, Server, Watched};
use std::path::{Path, PathBuf};
use std::sync::Arc;
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

/// Runs the command.
///
/// # Errors
/// A result that is not there or damaged, a port that is taken.
pub fn run(args: &ViewArgs) -> Result<Report> {
    let server = Server::start(&args.result, args.page.port, None)?;
    tell(&server, &args.result, &args.page);
    say("Ctrl-C ends it");
    let token = cancelled_saying(None);
    while !token.is_cancelled() {
        std::thread::sleep(Duration::from_millis(50));
    }
    Ok(Report::default().fact("result", path_text(&args.result)).fact("address", server.address()))
}

/// A run that is watched in the browser, or is not.
pub struct Watch(Option<Watching>);

struct Watching {
    live: Arc<Live>,
    server: Server,
    cancel: CancelToken,
}

impl Watch {
    /// Serves the page of a run that is about to begin, where it is asked for.
    ///
    /// # Errors
    /// A port that is taken, or a page that is asked for in part.
    pub fn start(how: &How, result: &Path, cancel: &CancelToken) -> Result<Self> {
        if !how.view {
            let option = if how.page.open { "--open" } else { "--port" };
            if how.page.open || how.page.port != 0 {
                let fault = Fault::new(format!("{option} says how a run is shown, and it is not shown"));
                return Err(Error::input(fault.help("add --view, or leave it out")));
            }
            return Ok(Self(None));
        }
        let live = Arc::new(Live::new(cancel.clone()));
        let server = Server::start(result, how.page.port, Some(Arc::clone(&live)))?;
        tell(&server, result, &how.page);
        Ok(Self(Some(Watching { live, server, cancel: cancel.clone() })))
    }

    /// Who listens to the run.
    pub fn reporter(&self, quiet: bool) -> Box<dyn run::Report> {
        let other = reporter(quiet);
        match &self.0 {
            Some(Watching { live, .. }) => Box::new(Watched::new(Arc::clone(live), other)),
            None => other,
        }
    }

    /// The run has ended, and this is told of it. The page stays for as long as somebody has it open.
    ///
    /// # Errors
    /// That of `told`.
    pub fn end(self, told: Result<Report>) -> Result<Report> {
        let Some(Watching { live, server, cancel }) = self.0 else { return told };
        live.end();
        let told = told?;
        let stay = move || {
            if server.pages() > 0 {
                say("the page stays until it is closed, or Ctrl-C");
            }
            while server.pages() > 0 && !cancel.is_cancelled() {
                std::thread::sleep(Duration::from_millis(100));
            }
        };
        Ok(Report { after: After::new(stay), ..told })
    }
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
