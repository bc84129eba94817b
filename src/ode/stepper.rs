//! One system, step by step, with its state at any time within the last step.

use pulp::Scalar;

use super::adaptive::{Adaptive, Rodas, Tsitouras, Verner};
use super::control::{self, NEAR, Tolerances};
use super::lookback::Lookback;
use super::scratch::{LooksBack, Scratch};
use super::{Method, OdeTrouble, Reason, Work, explicit, lost, rosenbrock};
use crate::equations::program::code::Code;
use crate::equations::program::{Program, run};

/// How long the step is that passes a jump of the rates, over the shortest that the clock can tell.
const PASSED: f64 = 8.0;

/// How far two such jumps are apart, over the same: what is driven to one again and again slides along it.
const APART: f64 = 1e4;

/// A system while it is solved.
pub struct Stepper<'a> {
    /// Its program.
    pub program: &'a Program,
    method: Method,
    pub(super) tolerances: Tolerances,
    pub(super) s: Scratch<1, Lookback>,
    /// Values of the open quantities.
    pub open: Vec<f64>,
    /// Present time: the end of the last step that was committed.
    pub time: f64,
    step: f64,
    error: f64,
    fresh: bool,
    /// When a jump was passed last that no step was short enough for.
    jumped: f64,
    pub(super) taken: f64,
    /// The state in the middle of the last step, for methods that need it for values between and once it was asked for.
    pub(super) middle: Vec<f64>,
    /// Work so far.
    pub work: Work,
    /// When the first event was executed since it began or went on; infinite before.
    pub first_event: f64,
    /// Longest step allowed.
    pub longest: f64,
}

/// What a stepper works in, which may be handed from one to the next of a program.
#[derive(Debug)]
pub struct StepperBuffers {
    s: Scratch<1, Lookback>,
    open: Vec<f64>,
    middle: Vec<f64>,
}

impl StepperBuffers {
    /// Buffers for a program; `stiff` methods need matrices.
    pub fn new(program: &Program, stiff: bool) -> Self {
        let s = Scratch::with(program, stiff, Lookback::default());
        Self { s, open: vec![0.0; program.open.len()], middle: Vec::new() }
    }
}

impl<'a> Stepper<'a> {
    /// A system at its initial values.
    pub fn new(program: &'a Program, method: Method, tolerances: Tolerances, time: f64) -> Self {
        let mut stepper = Self::within(StepperBuffers::new(program, method.is_implicit()), program, method, tolerances);
        let at = |quantity: &u32| program.initial[*quantity as usize];
        stepper.resume(time, program.variables.iter().map(at), program.open.iter().map(at), (0.0, 1.0));
        stepper
    }

    /// A system that works in these buffers; [`Self::resume`] must follow.
    pub fn within(buffers: StepperBuffers, program: &'a Program, method: Method, tolerances: Tolerances) -> Self {
        let StepperBuffers { s, open, middle } = buffers;
        let (work, longest) = (Work::default(), f64::INFINITY);
        // What was is no scratch: it begins anew.
        let s = Scratch { past: Lookback::new(program, method), ..s };
        Self {
            program,
            method,
            tolerances,
            s,
            open,
            time: f64::NAN,
            step: 0.0,
            error: 1.0,
            fresh: true,
            jumped: f64::NEG_INFINITY,
            taken: 0.0,
            middle,
            work,
            first_event: f64::INFINITY,
            longest,
        }
    }

    /// The buffers, for the next stepper.
    pub fn into_buffers(self) -> StepperBuffers {
        StepperBuffers { s: self.s, open: self.open, middle: self.middle }
    }

    /// Goes on from a time with a state, values of the open quantities, and the next step with the error of the last.
    pub fn resume(
        &mut self,
        time: f64,
        state: impl Iterator<Item = f64>,
        open: impl Iterator<Item = f64>,
        pace: (f64, f64),
    ) {
        self.s.state.iter_mut().zip(state).for_each(|(to, from)| *to = [from]);
        self.open.iter_mut().zip(open).for_each(|(to, from)| *to = from);
        (self.step, self.error) = pace;
        (self.time, self.taken, self.fresh, self.work) = (time, 0.0, true, Work::default());
        (self.jumped, self.first_event) = (f64::NEG_INFINITY, f64::INFINITY);
        self.s.past.start(time);
    }

    /// The next step to try and the error of the last.
    pub fn pace(&self) -> (f64, f64) {
        (self.step, self.error)
    }

    /// Whether steps are all of a length that is given.
    pub fn has_fixed_steps(&self) -> bool {
        matches!(self.method, Method::Rk4 { .. } | Method::Euler { .. })
    }

    /// A variable, by its position in the state.
    pub fn state(&self, variable: usize) -> f64 {
        self.s.state[variable][0]
    }

    /// Writes all variables to a list.
    pub fn state_into(&self, state: &mut Vec<f64>) {
        state.clear();
        state.extend(self.s.state.iter().map(|value| value[0]));
    }

    /// Sets a variable; [`Self::restart`] must follow.
    pub fn set_state(&mut self, variable: usize, value: f64) {
        self.s.state[variable] = [value];
    }

    /// Forgets what was known of the solution's course, after it jumped.
    pub fn restart(&mut self) {
        (self.step, self.error, self.fresh) = (0.0, 1.0, true);
        self.s.past.marks.jump(self.time);
    }

    /// Forgets the rates at the present, after the clock switched something.
    pub fn forget_rates(&mut self) {
        self.fresh = true;
    }

    /// Results of code at a time and state.
    pub fn evaluate(&mut self, code: &Code, time: f64, state: &[f64], results: &mut Vec<f64>) {
        self.load(time);
        for (register, &value) in self.s.file[1..].iter_mut().zip(state) {
            *register = [value];
        }
        self.s.past.fill(self.program, code, &mut self.s.file);
        run(code, &mut self.s.file);
        results.clear();
        results.extend(code.outputs.iter().map(|&register| self.s.file[register as usize][0]));
    }

    fn load(&mut self, time: f64) {
        self.s.file[0] = [time];
        let first = self.program.first_open();
        for (register, &value) in self.s.file[first..].iter_mut().zip(&self.open) {
            *register = [value];
        }
    }

    /// Takes one step that ends at `limit` at the latest, without committing it. Returns its length.
    ///
    /// # Errors
    /// When no step is short enough, or too many were taken.
    pub fn step(&mut self, limit: f64) -> Result<f64, OdeTrouble> {
        self.load(self.time);
        self.s.past.begin(self.time, &self.s.state, &self.open);
        self.taken = match self.method {
            Method::Rk45 => self.adaptive_step::<Tsitouras>(limit)?,
            Method::Rk65 => self.adaptive_step::<Verner>(limit)?,
            Method::Rosenbrock => self.adaptive_step::<Rodas>(limit)?,
            Method::Rk4 { step } | Method::Euler { step } => self.fixed_step(limit, step)?,
        };
        self.work.steps += 1;
        self.sketch(self.taken);
        if self.work.steps >= u64::from(self.tolerances.max_steps) {
            return Err(self.trouble(Reason::TooManySteps));
        }
        Ok(self.taken)
    }

    fn fixed_step(&mut self, limit: f64, longest: f64) -> Result<f64, OdeTrouble> {
        let step = (limit - self.time) / ((limit - self.time) / longest - 1e-9).ceil().max(1.0);
        let euler = matches!(self.method, Method::Euler { .. });
        let known = self.attempt(step, |stepper| {
            if euler {
                explicit::euler(Scalar, stepper.program, &mut stepper.s, [stepper.time], [step]);
                stepper.work.rates += 1;
                return;
            }
            explicit::classical(Scalar, stepper.program, &mut stepper.s, [stepper.time], [step]);
            // The rates at the end, for the values between.
            let n = stepper.s.state.len();
            stepper.s.file[1..=n].copy_from_slice(&stepper.s.proposal);
            stepper.s.rates_into(Scalar, stepper.program, 6);
            stepper.work.rates += 5;
        });
        self.check_delays()?;
        if !known {
            let detail = format!("a delay is shorter than the step of {step}");
            return Err(OdeTrouble { detail, ..self.trouble(Reason::Solver) });
        }
        let good = self.s.proposal.iter().all(|value| value[0].is_finite());
        if good { Ok(step) } else { Err(self.trouble(Reason::NotFinite)) }
    }

    fn adaptive_step<M: Adaptive>(&mut self, limit: f64) -> Result<f64, OdeTrouble> {
        let n = self.s.state.len();
        self.middle.clear();
        if self.fresh {
            self.s.rates_at_state(Scalar, self.program, [self.time]);
            self.work.rates += 1;
            self.fresh = false;
        }
        if self.step <= 0.0 {
            let window = limit - self.time;
            self.step =
                control::first_step(&self.s.state, &self.s.stages[..n], &self.program.sizes, window, &self.tolerances)
                    [0];
        }
        // Where time is near nothing the clock tells much shorter steps apart than at the end.
        let shortest = control::shortest(self.time, 1e-9 * limit);
        let mut most = M::CONTROLLER.most;
        loop {
            let rest = limit - self.time;
            let wanted = self.step.min(self.longest);
            let last = wanted >= rest * NEAR;
            let cut = wanted > 0.5 * rest;
            let step = match (last, cut) {
                (true, _) => rest,
                (false, true) => 0.5 * rest,
                (false, false) => wanted,
            };
            self.s.keeps_side = false;
            let mut error = self.error_of_attempt::<M>(step);
            if M::KEEPS_SIDE && error.is_nan() && self.s.keep_sides(&[error], &self.program.sizes, &self.tolerances) {
                error = self.error_of_attempt::<M>(step);
            }
            let factor = M::CONTROLLER.factor(error, self.error);
            if error <= 1.0 && self.s.past.ahead.is_none() {
                self.step = control::after_good(step, (self.step, cut), factor, most);
                self.error = error;
                return Ok(step);
            }
            self.work.rejected += 1;
            self.step = control::after_refused(step, error, factor);
            most = 1.0;
            if self.step <= shortest {
                self.check_delays()?;
                let step = rest.min(PASSED * shortest);
                let is_first = self.time - self.jumped > APART * shortest;
                if error.is_finite() && is_first && self.passes_jump(step) {
                    (self.step, self.error, self.jumped) = (0.0, 1.0, self.time);
                    return Ok(step);
                }
                return Err(self.trouble(if error.is_finite() { Reason::StepUnderflow } else { Reason::NotFinite }));
            }
        }
    }

    /// Tries a step, and returns its error in tolerances.
    fn error_of_attempt<M: Adaptive>(&mut self, step: f64) -> f64 {
        let known = self.attempt(step, |stepper| {
            M::step(Scalar, stepper.program, &mut stepper.s, &[stepper.time], &[step]);
            stepper.work.jacobians += M::JACOBIANS;
            stepper.work.rates += M::RATES;
        });
        let [error] =
            control::norm(&self.s.error, &self.s.state, &self.s.proposal, &self.program.sizes, &self.tolerances);
        if known { error } else { f64::INFINITY }
    }

    /// The state at a share of the step that is not yet committed.
    pub fn between(&mut self, share: f64, state: &mut [f64]) {
        let n = state.len();
        if share >= 1.0 {
            state.iter_mut().zip(&self.s.proposal).for_each(|(value, end)| *value = end[0]);
            return;
        }
        match self.method {
            Method::Rk45 => explicit::tsitouras_between(&self.s, self.taken, share, state),
            Method::Rk65 => {
                if self.middle.is_empty() {
                    explicit::verner_middle(self.program, &mut self.s, self.time, self.taken, &mut self.middle);
                    self.work.rates += 1;
                }
                explicit::verner_between(&self.s, self.taken, share, &self.middle, state);
            }
            Method::Rosenbrock => rosenbrock::between(&self.s, share, state),
            Method::Euler { .. } => {
                for (v, value) in state.iter_mut().enumerate() {
                    *value = self.s.state[v][0] + share * (self.s.proposal[v][0] - self.s.state[v][0]);
                }
            }
            Method::Rk4 { .. } => {
                for (v, value) in state.iter_mut().enumerate() {
                    let (begin, change) = (self.s.state[v][0], self.s.proposal[v][0] - self.s.state[v][0]);
                    let first = self.taken * self.s.stages[v][0] - change;
                    let last = self.taken * self.s.stages[6 * n + v][0] - change;
                    let rest = 1.0 - share;
                    *value = begin + share * (change + rest * (rest * first - share * last));
                }
            }
        }
    }

    /// Makes the end of the step the present.
    pub fn commit(&mut self, time: f64) {
        self.s.past.keep(time);
        self.time = time;
        self.s.state.copy_from_slice(&self.s.proposal);
        let last = match self.method {
            Method::Rk45 => Tsitouras::LAST,
            Method::Rk65 => Verner::LAST,
            _ => None,
        };
        if let Some(last) = last {
            let n = self.s.state.len();
            self.s.stages.copy_within(last * n..(last + 1) * n, 0);
        }
    }

    /// Makes a state within the step the present.
    pub fn commit_between(&mut self, time: f64, state: &[f64]) {
        self.s.past.keep(time);
        self.time = time;
        self.s.state.iter_mut().zip(state).for_each(|(to, &from)| *to = [from]);
        self.fresh = true;
    }

    /// What went wrong here and now.
    pub fn trouble(&mut self, reason: Reason) -> OdeTrouble {
        self.load(self.time);
        let (worst, finite) = self.s.worst_variable(self.program, [self.time], 0);
        let lacks_steps = matches!(reason, Reason::StepUnderflow | Reason::NotFinite);
        let searched = lacks_steps && !self.program.searched.is_empty();
        let unknown = if searched { self.s.lost_unknown(self.program, [self.time], 0) } else { None };
        self.fresh = true;
        OdeTrouble {
            system: self.program.name.clone(),
            cell: None,
            time: self.time,
            variable: worst.map(|v| self.program.names[self.program.variables[v] as usize].clone()),
            reason: if reason == Reason::StepUnderflow && !finite { Reason::NotFinite } else { reason },
            detail: lost(self.program, unknown),
        }
    }
}
