//! What a run does after each step of its simulation: records, saves, reports.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use super::progress::Report;
use crate::error::{Error, Result};
use crate::experiment::Schedule;
use crate::output::{Frame, ResultWriter};
use crate::sim::contact::{check_passed, help_at};
use crate::sim::{State, StepReport, Trouble};
use crate::simulation::{Recorder, Simulation, SimulationError, passed};
use crate::units::{Dimension, pretty};

/// Looks on while a simulation goes.
pub struct Recording<'a> {
    pub writer: ResultWriter,
    recorder: Recorder,
    schedule: Arc<Schedule>,
    result: &'a Path,
    pub report: &'a mut dyn Report,
    /// Time at the end of the step before, s.
    time: f64,
    /// Steps made when a frame was recorded last.
    recorded: u64,
    /// Steps that contacts shortened.
    pub limited: u64,
    /// Where cells were last known to be outside each other; none where they cannot touch.
    good: Option<State>,
}

/// Why a run ended before its end, though its steps could be made.
pub enum Stop {
    /// The cells are in the equilibrium that was asked for.
    AtRest,
    /// The file could not be written.
    Machine(Error),
    /// Cells have passed through each other since they were looked at last.
    Passed(Trouble),
    /// There is no good state at an instant within a step.
    Within(Trouble),
}

impl<'a> Recording<'a> {
    pub fn new(
        simulation: &Simulation,
        writer: ResultWriter,
        schedule: Schedule,
        result: &'a Path,
        report: &'a mut dyn Report,
    ) -> Self {
        let recorder = Recorder::new(simulation.model());
        Self {
            writer,
            recorder: if schedule.forces { recorder.with_forces(simulation.model()) } else { recorder },
            schedule: Arc::new(schedule),
            result,
            report,
            time: simulation.time(),
            recorded: simulation.steps(),
            limited: 0,
            good: None,
        }
    }

    /// Records the start.
    pub fn record_start(&mut self, simulation: &mut Simulation) -> Result<()> {
        self.writer.append(&simulation.record(&mut self.recorder))?;
        self.save(simulation)
    }

    /// Steps begin.
    pub fn begin(&mut self, simulation: &Simulation) {
        self.remember_good(simulation);
        self.report.begin(simulation.time(), simulation.end());
    }

    /// After a step.
    pub fn look(&mut self, simulation: &mut Simulation, made: &StepReport) -> ControlFlow<Stop> {
        let (before, after) = (std::mem::replace(&mut self.time, simulation.time()), simulation.time());
        let rests = simulation.is_at_rest();
        let last = rests || after >= simulation.end();
        self.limited += u64::from(made.limited);
        let schedule = Arc::clone(&self.schedule);
        let mut due = schedule.due(before, after).peekable();
        if last || due.peek().is_some() {
            if let Err(trouble) = check_passed(simulation.model(), simulation.state()) {
                return ControlFlow::Break(Stop::Passed(trouble));
            }
            self.remember_good(simulation);
        }
        let mut ends = None;
        for time in due {
            match Schedule::is_end(time, after) {
                true => ends = Some(time),
                false => self.record_within(simulation, time)?,
            }
        }
        if let Some(time) = ends.or(last.then_some(after)) {
            // As the time was asked for, without the round-off of the clock.
            or_stop(self.writer.append(&Frame { time, ..simulation.record(&mut self.recorder) }))?;
            self.recorded = simulation.steps();
        }
        if passed(before, after, self.schedule.checkpoint) && !last {
            or_stop(self.save(simulation))?;
        }
        self.report.look(simulation);
        self.report.step(after, simulation.steps());
        if rests { ControlFlow::Break(Stop::AtRest) } else { ControlFlow::Continue(()) }
    }

    /// Records an instant within the step.
    fn record_within(&mut self, simulation: &mut Simulation, time: f64) -> ControlFlow<Stop> {
        match simulation.record_within(&mut self.recorder, time) {
            Ok(frame) => or_stop(self.writer.append(&frame)),
            Err(trouble) => ControlFlow::Break(Stop::Within(trouble)),
        }
    }

    /// Says how far from equilibrium a run ended that asks for it.
    pub fn tell_rest(&mut self, simulation: &Simulation) {
        let (Some(asked), Some(found)) = (simulation.model().rest, simulation.out_of_balance()) else { return };
        let [asked, found] = [asked, found].map(|force| pretty(force, Dimension::FORCE));
        let time = pretty(simulation.time(), Dimension::TIME);
        self.report.notice(&match simulation.is_at_rest() {
            true => format!("in equilibrium after {time}: no force on an atom is more than {found} out of balance"),
            false => format!("not in equilibrium after {time}: a force on an atom is {found} out of balance, and {asked} is asked for: let it go on longer, with a later `until`"),
        });
    }

    /// No more steps are made.
    pub fn end(&mut self) {
        self.report.end();
    }

    /// Saves the state to resume from.
    pub fn save(&mut self, simulation: &Simulation) -> Result<()> {
        self.writer.save_checkpoint(simulation.steps(), simulation.time(), &simulation.checkpoint())
    }

    /// Keeps the last good state, as a frame and to resume from: it is what the user wants to look at. Where cells have come
    /// into each other since they were looked at last it is the one of then.
    pub fn keep_last(&mut self, trouble: impl Into<SimulationError>, simulation: &mut Simulation) -> Error {
        if check_passed(simulation.model(), simulation.state()).is_err() {
            return self.keep_good(trouble, simulation);
        }
        let unseen = simulation.steps() > self.recorded;
        let frame = if unseen { self.writer.append(&simulation.record(&mut self.recorder)) } else { Ok(()) };
        let kept = frame.and_then(|()| self.save(simulation));
        self.failed(&trouble.into(), simulation, kept)
    }

    /// Keeps the state in which cells were last outside each other, to resume from.
    pub fn keep_good(&mut self, trouble: impl Into<SimulationError>, simulation: &Simulation) -> Error {
        let good = self.good.as_ref().unwrap_or(simulation.state());
        let kept = self.writer.save_checkpoint(good.step, good.time, &simulation.checkpoint_of(good));
        self.failed(&trouble.into(), simulation, kept)
    }

    fn failed(&self, trouble: &SimulationError, simulation: &Simulation, kept: Result<()>) -> Error {
        let kept = kept.is_ok().then(|| self.result.to_path_buf());
        let help = match trouble {
            SimulationError::Trouble(trouble) => help_at(trouble, simulation.model(), simulation.state()).to_owned(),
            other => other.help().unwrap_or_default(),
        };
        Error::Numbers { message: trouble.to_string(), help, kept }
    }

    fn remember_good(&mut self, simulation: &Simulation) {
        // The one before goes first: two of a large population take much memory.
        self.good = None;
        self.good = simulation.model().contact.is_some().then(|| simulation.state().clone());
    }
}

fn or_stop(written: Result<()>) -> ControlFlow<Stop> {
    written.map_or_else(|error| ControlFlow::Break(Stop::Machine(error)), ControlFlow::Continue)
}
