//! `pseudopod sweep run`: makes the runs of a plan.

use super::children::{Ended, Running, start};
use super::runs_told::RunsTold;
use crate::cli::how::cancelled_by_signals;
use crate::cli::report::{Report, path_text};
use crate::error::{Error, Result};
use crate::simulation::CancelToken;
use crate::study::{Collected, Files, Plan, Run, Status, collect, refused};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::Duration;

/// Makes the runs of a plan that are not complete. What is begun goes on from its checkpoint, failures are kept while others go on.
#[derive(Debug, Clone, clap::Args)]
pub struct SweepRunArgs {
    /// The folder of the plan.
    pub folder: PathBuf,
    /// Runs at a time; by default as many as there are cores.
    #[arg(short, long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub jobs: Option<u32>,
    /// Threads of each run; by default the cores divided among the runs. Results do not depend on it.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,
    /// Says nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
    /// Prints what was done as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Time between two looks at the processes.
const LOOK: Duration = Duration::from_millis(20);

/// Runs the command.
///
/// # Errors
/// [`Error::Input`] for a folder without a plan, or one that changed; [`Error::Numbers`] when runs failed, once all others are complete;
/// [`Error::Stopped`] after Ctrl-C.
pub fn run(args: &SweepRunArgs) -> Result<Report> {
    let plan = Plan::read(&args.folder)?;
    plan.check_files()?;
    let _alone = plan.claim("sweep run")?;
    let logs = args.folder.join("logs");
    std::fs::create_dir_all(&logs).map_err(|error| refused(&logs, &error))?;
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let jobs = args.jobs.map_or(cores, |jobs| jobs as usize);
    let threads = args.threads.map_or((cores / jobs).max(1), |threads| threads as usize);
    let waiting: VecDeque<&Run> = plan.runs.iter().filter(|run| !Files::of(&plan, run).result.exists()).collect();
    let (all, skipped) = (plan.runs.len(), plan.runs.len() - waiting.len());
    let mut pool = Pool { plan: &plan, waiting, running: Vec::new(), jobs, threads, failed: Vec::new(), ended: 0 };
    let stopped = pool.work(&cancelled_by_signals(), args.quiet)?;
    let (ended, went_wrong) = (pool.ended, pool.failed.len());
    let collected = collect(plan.clone());
    if stopped {
        let complete = collected.rows.iter().filter(|row| row.status == Status::Complete).count();
        let message = format!("the study was interrupted: {complete} of {all} runs are complete");
        return Err(Error::Stopped {
            message,
            help: "the same command goes on, begun runs from their checkpoints".into(),
        });
    }
    tell_failures(&collected)?;
    let made = ended - went_wrong;
    let before = if skipped > 0 { format!(", {skipped} were complete before") } else { String::new() };
    let words = match args.quiet {
        true => String::new(),
        false => format!("{made} runs made{before}\nnext: pseudopod sweep collect {}\n", args.folder.display()),
    };
    let report = Report { words, ..Report::default() }.fact("folder", path_text(&args.folder));
    Ok(report.fact("runs", all).fact("made", made).fact("complete_before", skipped))
}

/// Says which runs are not complete though all ended, and why.
fn tell_failures(collected: &Collected) -> Result<()> {
    let incomplete = collected.rows.iter().enumerate().filter(|(_, row)| row.status != Status::Complete);
    let failed: Vec<usize> = incomplete.map(|(index, _)| index).collect();
    if failed.is_empty() {
        return Ok(());
    }
    let plan = &collected.plan;
    let lines = failed.iter().take(20).map(|&index| {
        let (run, row) = (&plan.runs[index], &collected.rows[index]);
        let log = Files::of(plan, run).log;
        let known = match row.status {
            Status::Failed => row.note.clone(),
            Status::Differs => {
                row.note.as_ref().map(|what| format!("its result was made from other inputs: {what}; move it away"))
            }
            _ => None,
        };
        let why = known.or_else(|| first_words(&log));
        let why = why.unwrap_or_else(|| "it ended without a word".into());
        let first = why.lines().next().unwrap_or_default().to_owned();
        format!("{}: {first} ({})", run.told(&plan.facts.parameters), log.display())
    });
    let mut lines: Vec<String> = lines.collect();
    if failed.len() > lines.len() {
        lines.push(format!("and {} more", failed.len() - lines.len()));
    }
    Err(Error::Numbers {
        message: format!("{} of {} runs failed\n{}", failed.len(), plan.runs.len(), lines.join("\n")),
        help: "all others are complete; the same command tries these again, and `sweep collect` takes what there is"
            .into(),
        kept: None,
    })
}

/// The message of an error in a log.
fn first_words(log: &std::path::Path) -> Option<String> {
    let text = std::fs::read_to_string(log).ok()?;
    let line = text.lines().find_map(|line| line.trim_start().strip_prefix("× "))?;
    Some(line.to_owned())
}

struct Pool<'a> {
    plan: &'a Plan,
    waiting: VecDeque<&'a Run>,
    running: Vec<Running>,
    jobs: usize,
    threads: usize,
    failed: Vec<u32>,
    /// Runs that ended, well or badly.
    ended: usize,
}

impl Pool<'_> {
    /// Works until no run is left or it is told to stop; whether it was.
    fn work(&mut self, cancel: &CancelToken, quiet: bool) -> Result<bool> {
        let mut told = RunsTold::new(self.waiting.len(), quiet);
        let mut passed_on = false;
        while !self.running.is_empty() || !self.waiting.is_empty() && !cancel.is_cancelled() {
            if cancel.is_cancelled() && !passed_on {
                self.running.iter_mut().for_each(Running::stop);
                passed_on = true;
            }
            while !passed_on && !cancel.is_cancelled() && self.running.len() < self.jobs {
                let Some(run) = self.waiting.pop_front() else { break };
                match start(self.plan, run, self.threads) {
                    Ok(running) => self.running.push(running),
                    Err(error) => {
                        self.finish_those_that_run();
                        return Err(error);
                    }
                }
            }
            let failed = self.failed.len();
            self.look();
            self.failed[failed..].iter().for_each(|number| told.line(&format!("run {number} failed")));
            told.tell(self.ended, self.failed.len(), self.running.len());
            std::thread::sleep(LOOK);
        }
        told.end();
        Ok(cancel.is_cancelled() && (passed_on || !self.waiting.is_empty()))
    }

    /// Notes which runs have ended.
    fn look(&mut self) {
        let (failed, ended) = (&mut self.failed, &mut self.ended);
        self.running.retain_mut(|running| match running.ended() {
            None => true,
            Some(how) => {
                *ended += usize::from(how != Ended::Stopped);
                if how == Ended::Badly {
                    failed.push(running.number);
                }
                false
            }
        });
    }

    /// Lets the runs stop at their checkpoints, when no more can be started.
    fn finish_those_that_run(&mut self) {
        self.running.iter_mut().for_each(Running::stop);
        while !self.running.is_empty() {
            self.look();
            std::thread::sleep(LOOK);
        }
    }
}
