//! The plan of a step: how long the next attempt is, how carefully it is made, and what became of those before.

use super::chemistry::next_exchange;
use super::contact::SweepRules;
use super::kind::Kind;
use super::model::Model;
use super::state::{KindState, State};
use super::trouble::Trouble;
use crate::contact::Travel;
use crate::mechanics::integrator::StepSize;

/// Attempts before a step is given up; each is at least 0.3 times the one before, so that 60 shrink it by 30 decades.
const ATTEMPTS: u32 = 60;

/// How often an attempt that its error allows is made again.
const REPEATS: u32 = 10;

/// What sweeps may leave when a step is made again, over what they might before: forces that sweeps leave unfound do work.
const TIGHTER: f64 = 0.1;

/// What atoms move over what contacts allow, below which what deepened was not moved in: a depth counts as deeper from a thousandth of an edge
/// on, and contacts allow a twentieth of one.
const STANDS: f64 = 1e-3;

/// The shortest part of a fixed step that is made shorter still, over the whole: where that does not do, it was chosen badly.
const SHORTEST: f64 = 0.01;

/// How many steps are told apart between one and its double, and how many where a step costs much more than what is factored for it.
const COARSE: f64 = 2.0;
const FINE: f64 = 4.0;

/// Cells of a kind over their atoms from which on that is so.
const MANY: f64 = 0.1;

/// What the next attempt of a step is to be.
#[derive(Debug, Clone)]
pub struct Plan {
    /// How long it is, s.
    pub dt: f64,
    /// What sweeps may leave, over what they may in the first attempt.
    tolerance_factor: f64,
    /// Energy where the step begins, pN·µm, where cells must not gain any.
    pub energy: Option<f64>,
    /// Where the step begins, s.
    time: f64,
    /// How many steps are told apart between one and its double.
    rungs: f64,
    /// The step planned before the first attempt, s.
    first: f64,
    /// The step wanted now, s; a bend of a course may cut it short.
    wanted: f64,
    /// The step to plan after this one, s.
    next: f64,
    /// Error of the last attempt over the mean edge, with what contacts say.
    error: f64,
    /// The farthest that an atom moved in the last attempt, over the safe travel.
    farthest: f64,
    /// Attempts that were refused.
    refused: u32,
    /// Attempts that were refused though their error allowed them.
    repeated: u32,
    /// Whether contacts made this step or the one planned after it shorter than the error would have.
    limited: bool,
}

/// What an attempt says about its step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Error over the mean edge.
    pub error: f64,
    /// How far bodies went.
    pub travel: Travel,
}

/// Why an attempt was not made to its end.
#[derive(Debug, Clone, PartialEq)]
pub enum Halt {
    /// Free motion alone misses the tolerance, by this error over the mean edge.
    Missed(f64),
    /// A stage failed.
    Failed(Trouble),
}

impl From<Trouble> for Halt {
    fn from(trouble: Trouble) -> Self {
        Self::Failed(trouble)
    }
}

impl Halt {
    /// What is known of the step; of one that was not made to its end not how far bodies went.
    fn estimate(self) -> Result<Estimate, Trouble> {
        match self {
            Self::Missed(error) => Ok(Estimate { error, travel: Travel::default() }),
            Self::Failed(trouble) => Err(trouble),
        }
    }
}

/// What may be wrong where an attempt ends, which its error does not tell.
#[derive(Debug, Clone, PartialEq)]
pub enum Flaw {
    /// Cells on which nothing acts have more energy than before.
    GainedEnergy,
    /// Cells met within the step and are deep in each other; with the trouble that this is where they are deeper than is promised.
    Deepened(Option<Trouble>),
}

/// What a step did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Its size, s.
    pub dt: f64,
    /// Attempts that were refused before it.
    pub refused: u32,
    /// Error estimate over the mean edge; 0 for schemes without one and steps of a fixed size.
    pub error: f64,
    /// Whether contacts made this step or the one planned after it shorter than the error estimate would have.
    pub limited: bool,
}

impl Plan {
    /// The plan of the first attempt; `energy` is that where the step begins, pN·µm, where cells must not gain any.
    pub fn new(model: &Model, state: &State, energy: Option<f64>) -> Self {
        let first = first_step(model, state);
        Self {
            dt: end_at_kinks(model, state.time, first),
            tolerance_factor: 1.0,
            energy,
            time: state.time,
            rungs: rungs(model, state),
            first,
            wanted: first,
            next: first,
            error: 0.0,
            farthest: 0.0,
            refused: 0,
            repeated: 0,
            limited: false,
        }
    }

    /// Whether the error of an attempt allows it; if not, the plan is that of the next one.
    ///
    /// # Errors
    /// The trouble of an attempt that no shorter one would mend.
    pub fn allows(&mut self, model: &Model, outcome: Result<Estimate, Halt>) -> Result<bool, Trouble> {
        let outcome = outcome.or_else(Halt::estimate);
        self.farthest = outcome.as_ref().map_or(f64::INFINITY, |estimate| estimate.travel.farthest);
        let (error, with_contacts) = match outcome.and_then(|estimate| self.with_contacts(model, estimate)) {
            Ok(errors) => errors,
            Err(trouble) if self.refused + 1 == ATTEMPTS || !self.may_be_mended(model, &trouble) => {
                return Err(trouble);
            }
            Err(Trouble::Contact { .. }) => (0.0, f64::INFINITY),
            Err(_) => (f64::INFINITY, f64::INFINITY),
        };
        let (allowed, next) = judge(model, self.dt, with_contacts, self.rungs);
        self.limited |= next < judge(model, self.dt, error, self.rungs).1;
        // What made an attempt too long is still there in the next step; one that was made again more exactly was not too long.
        let next = if allowed && self.refused > self.repeated { next.min(self.dt) } else { next };
        (self.error, self.next) = (with_contacts, next);
        if allowed { Ok(true) } else { self.retry(model, next) }
    }

    /// Whether an attempt that is allowed stands with what was found where it ends; if not, the plan is that of the next one.
    ///
    /// # Errors
    /// The trouble of cells that are deeper in each other than is promised, however short the step.
    pub fn accepts(&mut self, model: &Model, flaw: Option<Flaw>) -> Result<bool, Trouble> {
        let next = match flaw {
            None => return Ok(true),
            Some(Flaw::GainedEnergy) => {
                self.tolerance_factor *= TIGHTER;
                // At first without mending depths, which takes work however short a step is.
                if self.repeated == 0 { self.dt } else { 0.5 * self.dt }
            }
            // What is found deep though nothing moved, as where facets turn and edges count from now on, no shorter step keeps out: each would
            // end just before that instant, for ever.
            Some(Flaw::Deepened(_)) if self.may_repeat(model) && self.farthest > STANDS => 0.5 * self.dt,
            Some(Flaw::Deepened(None)) => return Ok(true),
            Some(Flaw::Deepened(Some(trouble))) => return Err(trouble),
        };
        self.limited |= next < self.dt;
        self.repeated += 1;
        self.retry(model, next)
    }

    /// Looks whether the error of free motion alone refuses an attempt.
    ///
    /// # Errors
    /// It does, and the attempt need not be made to its end.
    pub fn check_error(&self, model: &Model, error: f64) -> Result<(), Halt> {
        match model.integrator.size {
            StepSize::Adaptive { tolerance, .. } if error > tolerance => Err(Halt::Missed(error)),
            _ => Ok(()),
        }
    }

    /// How contacts are swept. Depths are mended in the first attempt only, since to push something out by moving it takes work.
    pub fn sweep_rules(&self) -> SweepRules {
        let (tolerance_factor, in_account) = (self.tolerance_factor, self.energy.is_some());
        SweepRules { tolerance_factor, mends: tolerance_factor == 1.0, in_account }
    }

    /// Whether an attempt that its error allows may still be made again.
    pub fn may_repeat(&self, model: &Model) -> bool {
        self.repeated < REPEATS && !is_shortest(model, self.dt)
    }

    /// The step to try first after the one that was accepted, s. A step cut short by a kink says nothing against the step planned before
    /// it; one of a fixed size that was made shorter is made up for. One that the error chooses is no longer than `longest`, s, allows.
    pub fn next_step(&self, model: &Model, longest: f64) -> f64 {
        match model.integrator.size {
            StepSize::Fixed(_) if self.wanted < self.first => self.first - self.dt,
            StepSize::Fixed(whole) => whole,
            StepSize::Adaptive { .. } if self.dt < self.wanted => self.wanted.max(self.next).min(longest),
            StepSize::Adaptive { .. } => self.next.min(longest),
        }
    }

    /// What the step did that was accepted.
    pub fn report(&self) -> StepReport {
        StepReport { dt: self.dt, refused: self.refused, error: self.error, limited: self.limited }
    }

    /// Plans another attempt; never says that this one stands.
    fn retry(&mut self, model: &Model, wanted: f64) -> Result<bool, Trouble> {
        self.refused += 1;
        if self.refused == ATTEMPTS {
            return Err(Trouble::StepTooSmall { time: self.time, dt: wanted });
        }
        (self.wanted, self.dt) = (wanted, end_at_kinks(model, self.time, wanted));
        Ok(false)
    }

    /// The error, and the same with what contacts say: a step in which an atom moves too far counts as one over the tolerance.
    fn with_contacts(
        &self,
        model: &Model,
        Estimate { error, travel: Travel { share, .. } }: Estimate,
    ) -> Result<(f64, f64), Trouble> {
        match model.integrator.size {
            StepSize::Adaptive { tolerance, .. } => Ok((error, error.max(tolerance * share * share))),
            StepSize::Fixed(_) if share > 1.0 => Err(Trouble::TooFast { time: self.time + self.dt, share }),
            StepSize::Fixed(_) => Ok((error, error)),
        }
    }

    /// Whether a shorter step may do where this one failed: an adaptive one always, a fixed one where contacts did not come to rest.
    fn may_be_mended(&self, model: &Model, trouble: &Trouble) -> bool {
        match model.integrator.size {
            StepSize::Adaptive { .. } => true,
            StepSize::Fixed(_) => matches!(trouble, Trouble::Contact { .. }) && !is_shortest(model, self.dt),
        }
    }
}

/// The step to try first, s.
fn first_step(model: &Model, state: &State) -> f64 {
    match model.integrator.size {
        // What is left of a fixed step that was made shorter.
        StepSize::Fixed(dt) if state.next_step > 0.0 => state.next_step.min(dt),
        StepSize::Fixed(dt) => dt,
        StepSize::Adaptive { largest, .. } if state.next_step > 0.0 => state.next_step.min(largest),
        StepSize::Adaptive { largest, .. } => {
            let relax = |kind: &Kind| kind.drag / kind.largest_stiffness.max(f64::MIN_POSITIVE);
            on_ladder(model.kinds.iter().map(relax).fold(largest, f64::min), COARSE).min(largest)
        }
    }
}

/// How many steps are told apart between one and its double.
fn rungs(model: &Model, state: &State) -> f64 {
    let are_many = |(kind, now): (&Kind, &KindState)| now.cells() as f64 >= MANY * kind.atoms() as f64;
    if model.kinds.iter().zip(&state.kinds).all(are_many) { FINE } else { COARSE }
}

/// Whether what is left of a step is too short to be made shorter still.
fn is_shortest(model: &Model, dt: f64) -> bool {
    matches!(model.integrator.size, StepSize::Fixed(whole) if dt < SHORTEST * whole)
}

/// A step never runs over a bend of a course, an exchange with chemistry or the end of the run.
fn end_at_kinks(model: &Model, time: f64, dt: f64) -> f64 {
    let slack = model.clock_slack();
    let ahead = model.instants().chain([next_exchange(model, time)]).filter(|&instant| instant > time + slack);
    let left = ahead.fold(f64::INFINITY, f64::min) - time;
    if dt >= left - slack { left } else { dt }
}

/// Whether the error allows the step, and the step to try next, s.
fn judge(model: &Model, dt: f64, error: f64, rungs: f64) -> (bool, f64) {
    let StepSize::Adaptive { tolerance, largest } = model.integrator.size else {
        return if error.is_finite() { (true, dt) } else { (false, 0.5 * dt) };
    };
    if error.is_nan() || error.is_infinite() {
        return (false, on_ladder(0.3 * dt, rungs));
    }
    // The estimate is of first order, so that the error grows with the square of the step.
    let ideal = dt * (0.9 * (tolerance / error.max(1e-300)).sqrt()).clamp(0.3, 4.0);
    (error <= tolerance, on_ladder(ideal, rungs).min(largest))
}

/// The step to which a step is rounded down, of which there are so many between one and its double: few different steps mean few
/// factorisations.
fn on_ladder(dt: f64, rungs: f64) -> f64 {
    ((rungs * dt.log2() + 1e-9).floor() / rungs).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::integrator::{Integrator, Method, Order};

    #[test]
    fn what_is_found_deep_though_nothing_moves_makes_no_step_shorter() {
        let size = StepSize::Adaptive { tolerance: 1e-3, largest: 0.1 };
        let method = Method::Implicit { order: Order::Second };
        let model = Model::of(Vec::new(), Integrator { method, size }, 10.0);
        let mut state = State::new(&model, &[]);
        state.next_step = 0.01;
        let halves = |farthest: f64| {
            let mut plan = Plan::new(&model, &state, None);
            assert_eq!(
                plan.allows(&model, Ok(Estimate { error: 0.0, travel: Travel { share: 0.0, farthest } })),
                Ok(true)
            );
            assert_eq!(plan.accepts(&model, Some(Flaw::Deepened(None))).map(|stands| !stands), Ok(farthest > STANDS));
            plan.dt
        };
        assert_eq!([0.5, 1e-2, 1e-4].map(halves), [0.005, 0.005, 0.01]);
    }
}
