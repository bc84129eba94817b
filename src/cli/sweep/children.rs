//! Runs of a study as processes of their own, so many at a time.

use crate::error::{Error, Result};
use crate::study::{Files, Plan, Run};
use std::fs::File;
use std::process::{Child, Command, Stdio};

/// A run that goes on in a process of its own.
pub struct Running {
    /// Its number.
    pub number: u32,
    child: Child,
}

/// Starts a run of a plan. What it says goes to its log.
///
/// # Errors
/// [`Error::Machine`] if the log cannot be made or no process be started.
pub fn start(plan: &Plan, run: &Run, threads: usize) -> Result<Running> {
    let log = Files::of(plan, run).log;
    let opened = File::create(&log).and_then(|file| Ok((file.try_clone()?, file)));
    let (out, err) = opened.map_err(|error| crate::study::refused(&log, &error))?;
    let table = plan.folder.join(crate::study::RUNS_FILE);
    let program = std::env::current_exe().map_err(|error| not_started(&error))?;
    let mut command = Command::new(program);
    command.arg("run").arg("--plan").arg(table).args(["--row", &run.number.to_string(), "--skip-complete"]);
    command.args(["--quiet", "--no-pictures", "--threads", &threads.to_string()]);
    command.stdin(Stdio::null()).stdout(out).stderr(err);
    unix_only::detach(&mut command);
    let child = command.spawn().map_err(|error| not_started(&error))?;
    Ok(Running { number: run.number, child })
}

fn not_started(error: &std::io::Error) -> Error {
    Error::Machine {
        message: format!("a run could not be started: {error}"),
        help: "ask for fewer at a time with -j".into(),
    }
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// It is complete.
    Well,
    /// It stopped at a checkpoint.
    Stopped,
    /// With an error, or by a signal.
    Badly,
}

impl Running {
    /// How it ended; none while it goes on.
    pub fn ended(&mut self) -> Option<Ended> {
        match self.child.try_wait() {
            Ok(None) => None,
            Ok(Some(status)) if status.success() => Some(Ended::Well),
            Ok(Some(status)) if status.code() == Some(130) => Some(Ended::Stopped),
            Ok(Some(_)) | Err(_) => Some(Ended::Badly),
        }
    }

    /// Asks it to stop after its step, with a checkpoint.
    pub fn stop(&mut self) {
        unix_only::interrupt(&mut self.child);
    }
}

#[cfg(unix)]
mod unix_only {
    use std::os::unix::process::CommandExt as _;
    use std::process::{Child, Command};

    /// Lets a process hear of Ctrl-C by us alone, once, since the second time it would not wait for its step; and where the system can,
    /// lets it stop when this program is killed.
    pub fn detach(command: &mut Command) {
        command.process_group(0);
        #[cfg(target_os = "linux")]
        // SAFETY: between fork and exec only a system call is made, which touches no memory.
        unsafe {
            command.pre_exec(|| {
                libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGINT);
                Ok(())
            });
        }
    }

    pub fn interrupt(child: &mut Child) {
        if let Ok(id) = libc::pid_t::try_from(child.id()) {
            // SAFETY: the child is ours and was not waited for, so its id is its own.
            unsafe { libc::kill(id, libc::SIGINT) };
        }
    }
}

#[cfg(not(unix))]
mod unix_only {
    use std::process::{Child, Command};

    pub fn detach(_: &mut Command) {}

    /// Elsewhere there is no gentle signal: the run goes on from its last checkpoint.
    pub fn interrupt(child: &mut Child) {
        let _ = child.kill();
    }
}
