//! A simulation: what it holds, and how it makes steps.

use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use super::cancel::CancelToken;
use super::error::SimulationError;
use super::fits::check_fits;
use super::history::History;
use super::record::Recorder;
use crate::output::Frame;
use crate::sim::contact::check_passed;
use crate::sim::{
    Model, State, StepReport, Trouble, Workspace, apply_due_changes, begin_chemistry, state_within, step,
};

/// A simulation in memory.
///
/// It can be sent to another thread. Results do not depend on the number of threads, nor on how often one looks.
pub struct Simulation {
    pub(super) model: Model,
    pub(super) state: State,
    pub(super) scratch: Workspace,
    /// Size of the step made last, s; 0 before the first.
    pub(super) last_step: f64,
    pub(super) cancel: CancelToken,
    /// Threads of its own; those of the program where there are none.
    pub(super) pool: Option<Arc<rayon::ThreadPool>>,
    pub(super) notices: Vec<String>,
    pub(super) history: History,
    pub(super) fingerprint: OnceLock<u64>,
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let (time, steps, cells) = (self.state.time, self.state.step, self.state.cells());
        f.debug_struct("Simulation").field("time", &time).field("steps", &steps).field("cells", &cells).finish()
    }
}

impl Simulation {
    /// A simulation of a model from a state, for programs that make both themselves; others begin with
    /// [`Simulation::from_text`] or its like. Links and events of the start are carried out.
    ///
    /// ```
    /// use pseudopod::geometry::icosphere;
    /// use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
    /// use pseudopod::sim::{Kind, Model, State};
    /// use pseudopod::simulation::Simulation;
    ///
    /// let mut kind = Kind::new("limp", icosphere(5.0, 1), Vec::new());
    /// kind.drag = 2.0;
    /// kind.bound_stiffness();
    /// let start = vec![vec![kind.rest.positions.clone()]];
    /// let integrator = Integrator { method: Method::Implicit { order: Order::First }, size: StepSize::Fixed(0.1) };
    /// let model = Model::of(vec![kind], integrator, 1.0);
    /// let state = State::new(&model, &start);
    /// let mut simulation = Simulation::new(model, state)?;
    /// simulation.step()?;
    /// assert_eq!(simulation.time(), 0.1);
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Mismatch`] for a state of another model, [`SimulationError::Trouble`] when what happens at the
    /// start fails.
    pub fn new(model: Model, state: State) -> Result<Self, SimulationError> {
        check_fits(&model, &state)?;
        let mut simulation = Self::assemble(model, state);
        simulation.begin()?;
        Ok(simulation)
    }

    /// A simulation that has not begun.
    pub(crate) fn assemble(model: Model, state: State) -> Self {
        let scratch = Workspace::new(&model);
        Self {
            model,
            state,
            scratch,
            last_step: 0.0,
            cancel: CancelToken::new(),
            pool: None,
            notices: Vec::new(),
            history: History::default(),
            fingerprint: OnceLock::new(),
        }
    }

    /// Carries out the links and events of the start, where that has not been done.
    pub(crate) fn begin(&mut self) -> Result<(), Trouble> {
        self.within(|this| begin_chemistry(&this.model, &mut this.state, &mut this.scratch))
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Steps made since the start of the experiment.
    pub fn steps(&self) -> u64 {
        self.state.step
    }

    /// The end of the experiment as the document has it, s. A simulation may go on beyond it.
    pub fn end(&self) -> f64 {
        self.model.until
    }

    /// What there is to know about the start, in sentences: cells that were pushed apart, that pass through each other, or that
    /// have an unlikely size.
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// How far the cells were from mechanical equilibrium in the step made last: the largest force on an atom that its drag, and what is viscous,
    /// answered, pN, (step.15); none before the first step, and where the experiment does not ask for an equilibrium.
    pub fn out_of_balance(&self) -> Option<f64> {
        self.state.out_of_balance
    }

    /// Whether the cells are in the equilibrium that the experiment asks for, with nothing more to come. A recorded run ends there.
    pub fn is_at_rest(&self) -> bool {
        let is_below = |rest: f64| self.out_of_balance().is_some_and(|force| force < rest);
        self.model.rest.is_some_and(is_below) && !self.model.is_awaited(self.state.time)
    }

    /// The compiled experiment, in µm, s and pN.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// All that changes in a step.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Takes the simulation apart, so that its state may go on under another model of the same cells.
    pub fn into_parts(self) -> (Model, State) {
        (self.model, self.state)
    }

    /// The token that stops this simulation; cancel a clone of it from wherever you are.
    pub fn cancel_token(&self) -> CancelToken {
        self.cancel.clone()
    }

    /// Takes another token: to be stopped along with others, or to go on after a stop.
    pub fn set_cancel_token(&mut self, token: CancelToken) {
        self.cancel = token;
    }

    /// Makes one step, whose size the experiment's integrator chooses. Before it, cells come and go as the document has it for
    /// this time.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// // A stop rule of one's own needs no more than a loop.
    /// while simulation.time() < simulation.end() && simulation.series("energy")?[0] < 1.0 {
    ///     let made = simulation.step()?;
    ///     assert!(made.dt > 0.0);
    /// }
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Trouble`] when the numbers fail, [`SimulationError::Population`] when cells that are due cannot come,
    /// [`SimulationError::Cancelled`] once the token is cancelled; the state is then the one before the step.
    pub fn step(&mut self) -> Result<StepReport, SimulationError> {
        let before = self.state.time;
        if self.cancel.is_cancelled() {
            return Err(SimulationError::Cancelled { time: before });
        }
        // After a failure nothing is known of a step.
        self.last_step = 0.0;
        let made = self.within(|this| -> Result<StepReport, SimulationError> {
            apply_due_changes(&this.model, &mut this.state, &mut this.scratch)?;
            Ok(step(&this.model, &mut this.state, &mut this.scratch)?)
        })?;
        self.last_step = made.dt;
        self.keep_if_due(before);
        Ok(made)
    }

    /// Makes steps until a time, s, at which the last one ends exactly. Nothing happens when it is past.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn run_until(&mut self, time: f64) -> Result<(), SimulationError> {
        self.run_with(time, |_, _| ControlFlow::<()>::Continue(())).map(|_| ())
    }

    /// As [`Simulation::run_until`], with a look after every step: to show progress, to record, to change what cells do, or to
    /// stop with a reason of one's own.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// use std::ops::ControlFlow;
    ///
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// let stopped = simulation.run_with(10.0, |simulation, _| match simulation.series("size_x") {
    ///     Ok(lengths) if lengths[0] > 9.55 => ControlFlow::Break(simulation.time()),
    ///     _ => ControlFlow::Continue(()),
    /// })?;
    /// assert!(stopped.is_break(), "the pulled cell becomes longer than 9.55 um");
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn run_with<B: Send>(
        &mut self,
        until: f64,
        observe: impl FnMut(&mut Self, &StepReport) -> ControlFlow<B> + Send,
    ) -> Result<ControlFlow<B>, SimulationError> {
        // Steps end where a course bends, and here.
        let at = self.model.kinks.partition_point(|kink| *kink < until);
        let is_new = until.is_finite() && until != self.model.until && self.model.kinks.get(at) != Some(&until);
        if is_new {
            self.model.kinks.insert(at, until);
        }
        let result = self.within(|this| this.advance(until, observe));
        if is_new {
            self.model.kinks.remove(at);
        }
        result
    }

    fn advance<B>(
        &mut self,
        until: f64,
        mut observe: impl FnMut(&mut Self, &StepReport) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, SimulationError> {
        // Less than this cannot be told from the end by a clock that adds many steps.
        let slack = 1e-12 * self.model.until;
        while self.state.time < until - slack {
            let made = self.step()?;
            if let ControlFlow::Break(reason) = observe(self, &made) {
                return Ok(ControlFlow::Break(reason));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Looks whether cells have passed through each other, which steps look for atom by atom and not edge by edge; a run looks
    /// before it records.
    ///
    /// # Errors
    /// [`SimulationError::Trouble`] that names the cells.
    pub fn check_contacts(&self) -> Result<(), SimulationError> {
        Ok(check_passed(&self.model, &self.state)?)
    }

    /// Works with the threads of this simulation.
    pub(crate) fn within<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> T + Send) -> T {
        match self.pool.clone() {
            Some(pool) => pool.install(|| work(self)),
            None => work(self),
        }
    }

    /// The frame of this instant, with the runs that ended since the last one.
    pub(crate) fn record(&mut self, recorder: &mut Recorder) -> Frame {
        recorder.record(&self.model, &mut self.state, &mut self.scratch, self.last_step)
    }

    /// The frame of an instant within the step made last, after which nothing else was done, with the runs that had ended by then.
    ///
    /// # Errors
    /// A volume that could not be made exact.
    pub(crate) fn record_within(&mut self, recorder: &mut Recorder, time: f64) -> Result<Frame, Trouble> {
        let mut within = state_within(&self.model, &mut self.state, time, &mut self.scratch)?;
        let frame = recorder.record(&self.model, &mut within, &mut self.scratch, self.last_step);
        Ok(Frame { interpolated: true, ..frame })
    }
}
