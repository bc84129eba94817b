//! How runs are made: the options that commands share, who listens, and what a signal does.

use super::progress::Progress;
use crate::error::say;
use crate::run::{self, Quiet};
use crate::simulation::CancelToken;

/// Options that `run` and `resume` share.
#[derive(Debug, Clone, clap::Args)]
pub struct How {
    /// Threads; the result does not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// Says nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
    /// Prints what was done as JSON.
    #[arg(long)]
    pub json: bool,
    /// Makes no picture and no charts.
    #[arg(long)]
    pub no_pictures: bool,
    /// Shows the run in the browser as it goes on, where it can be paused and stopped.
    #[arg(long)]
    pub view: bool,
    /// How the page is served.
    #[command(flatten)]
    pub page: PageArgs,
}

/// How a page is served; `view` and runs share it.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct PageArgs {
    /// The port at which the page is served, to this machine alone; a free one when absent.
    #[arg(long, value_name = "NUMBER", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Opens the page in the browser.
    #[arg(long)]
    pub open: bool,
}

/// A token that the first signal cancels, so that the run stops after its step; a second signal ends the program at once.
pub fn cancelled_by_signals() -> CancelToken {
    cancelled_saying(Some("stopping after this step; once more to stop at once"))
}

/// The same for what stops at once, or says something else.
pub fn cancelled_saying(words: Option<&'static str>) -> CancelToken {
    let token = CancelToken::new();
    let heard = token.clone();
    let listening = ctrlc::set_handler(move || {
        if heard.is_cancelled() {
            std::process::exit(130);
        }
        heard.cancel();
        words.iter().for_each(|words| say(words));
    });
    // A program that has a handler of its own stops as that one says.
    drop(listening);
    token
}

/// Who listens to a run: nobody where it shall be quiet.
pub fn reporter(quiet: bool) -> Box<dyn run::Report> {
    if quiet { Box::new(Quiet) } else { Box::new(Progress::default()) }
}
