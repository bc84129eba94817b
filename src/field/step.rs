//! Moves fields through a window of time: reactions for half a step, diffusion and decay for a step, reactions for
//! half a step, eq. (field.1), with steps as small as the splitting asks.

use super::carry::{Carrying, MOST_IN_WINDOW};
use super::error::{error_of_rates, error_of_size};
use super::react::{React, react};
use super::state::{FINEST, Fields};
use super::transport::Transport;
use crate::equations::Range;
use crate::error::{Error, Result, short};

/// How a window is cut into steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stepping {
    /// Into so many equal steps, at least one.
    Fixed(u32),
    /// Into 1, 2, 4, … parts, so that the error of a step, eqs. (field.7) and (field.14), stays below the tolerance.
    Adaptive {
        /// Part of the size of a species, and of what reactions change, that a step may be wrong by, e.g. 3e-3.
        relative: f64,
        /// Value that a step may be wrong by whatever the size, e.g. 1e-6 of a usual concentration.
        absolute: f64,
    },
}

/// What a window took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Report {
    /// Steps that count.
    pub steps: u32,
    /// Steps whose error was measured.
    pub checks: u32,
    /// Steps that were too long and taken again.
    pub rejected: u32,
    /// Largest error of an accepted step, in tolerances.
    pub error: f64,
}

impl Report {
    /// Adds what another window took.
    pub(super) fn add(&mut self, other: Self) {
        self.steps += other.steps;
        self.checks += other.checks;
        self.rejected += other.rejected;
        self.error = self.error.max(other.error);
    }
}

/// What acts on fields beside diffusion and decay.
#[derive(Clone, Copy, Default)]
pub(super) struct Acts<'a> {
    pub reactions: Option<&'a React<'a>>,
    pub carrying: Option<Carrying<'a>>,
}

impl Acts<'_> {
    fn any(&self) -> bool {
        self.reactions.is_some() || self.carrying.is_some()
    }
}

/// Of so many steps one is checked, while nothing speaks for a change of the step.
const CHECK_EVERY: u32 = 4;
/// Below this error the step is doubled: the error of a doubled step is 8 times as large, and some slack is left.
const CALM: f64 = 0.08;
/// Above this error the next step is checked too.
const WATCH: f64 = 0.5;

/// What to do about values that are not finite after a step.
const UNBOUND: &str = "its reactions grow without bound; check their signs and rates, or take smaller steps";

/// Whether a step with this error, in tolerances, must be taken again; one that is not a number must.
fn too_large(error: f64) -> bool {
    error.is_nan() || error > 1.0
}

impl Fields {
    /// Moves all species by a window of time, s.
    ///
    /// # Errors
    /// Values that are not finite, or a tolerance that no step meets; the fields are then as they were before.
    pub fn advance(&mut self, window: f64, stepping: Stepping, reactions: Option<&React>) -> Result<Report> {
        self.advance_all(window, stepping, Acts { reactions, carrying: None })
    }

    /// The same with what a document does to fields beside diffusion and decay.
    pub(super) fn advance_all(&mut self, window: f64, stepping: Stepping, acts: Acts) -> Result<Report> {
        if window == 0.0 {
            return Ok(Report::default());
        }
        let (began, pace) = (self.time, self.pace());
        // Diffusion and decay alone cannot fail.
        if let (Stepping::Fixed(steps), false) = (stepping, acts.any()) {
            self.strang(window / f64::from(steps.max(1)), steps.max(1), Acts::default());
            self.time = began + window;
            return Ok(Report { steps: steps.max(1), ..Report::default() });
        }
        let mut start = std::mem::take(&mut self.work.start);
        start.copy_from_slice(&self.values);
        let report = match stepping {
            Stepping::Fixed(steps) => {
                let steps = steps.max(1);
                self.strang(window / f64::from(steps), steps, acts);
                Ok(Report { steps, ..Report::default() })
            }
            Stepping::Adaptive { relative, absolute } => self.adapt(window, [relative, absolute], acts),
        };
        let report = match self.work.carrying.too_fast.take() {
            Some(speed) => Err(too_fast(speed, (began, window))),
            None => report.and_then(|report| self.check_finite(UNBOUND).map(|()| report)),
        };
        if report.is_err() {
            self.values.copy_from_slice(&start);
            self.set_pace(pace);
        }
        self.time = if report.is_ok() { began + window } else { began };
        self.work.start = start;
        report
    }

    /// Equal steps, with the half steps of reactions between them joined.
    fn strang(&mut self, dt: f64, steps: u32, acts: Acts) {
        let began = self.time;
        self.react(0.5 * dt, acts.reactions);
        for step in 1..=steps {
            self.move_on(began + f64::from(step - 1) * dt, dt, acts);
            self.time = began + (f64::from(step) - 0.5) * dt;
            self.react(if step == steps { 0.5 * dt } else { dt }, acts.reactions);
        }
        self.time = began + f64::from(steps) * dt;
    }

    /// Diffusion and decay for a step from a time on, with transport in its middle.
    fn move_on(&mut self, from: f64, dt: f64, acts: Acts) {
        let Some(carrying) = acts.carrying else { return self.diffuse(dt) };
        self.diffuse(0.5 * dt);
        let Self { grid, values, work, .. } = self;
        carrying.advance(grid, &mut work.carrying, values, from, dt);
        self.diffuse(0.5 * dt);
    }

    fn react(&mut self, dt: f64, reactions: Option<&React>) {
        let Some(function) = reactions else { return };
        let Self { grid, species, values, work, time, .. } = self;
        react(grid, species, function, (*time, dt), values, &mut work.reacting);
    }

    /// Steps of a window / 2^level. A step that is checked is taken whole and in halves; the halves are kept, or, where there are
    /// reactions, what both say of steps that are shorter still. With reactions all are checked.
    fn adapt(&mut self, window: f64, tolerance: [f64; 2], acts: Acts) -> Result<Report> {
        let (mut report, mut done, began) = (Report::default(), 0_u32, self.time);
        while done < 1 << FINEST {
            let dt = window / f64::from(1_u32 << self.level);
            self.time = began + window * (f64::from(done) / f64::from(1_u32 << FINEST));
            if self.unchecked == 0 {
                let error = self.checked(dt, tolerance, acts);
                report.checks += 1;
                if too_large(error) {
                    report.rejected += 1;
                    self.level += 1;
                    if self.level > FINEST || self.work.carrying.too_fast.is_some() {
                        return Err(self.unreachable_tolerance(dt));
                    }
                    continue;
                }
                report.error = report.error.max(error);
                self.unchecked = if error > WATCH || acts.any() { 0 } else { CHECK_EVERY - 1 };
                done += 1 << (FINEST - self.level);
                if error < CALM && self.level > 0 && done.is_multiple_of(1 << (FINEST + 1 - self.level)) {
                    self.level -= 1;
                    self.unchecked = 0;
                }
            } else {
                self.strang(dt, 1, acts);
                self.unchecked -= 1;
                done += 1 << (FINEST - self.level);
            }
            report.steps += 1;
        }
        Ok(report)
    }

    /// A step, and its error; if that is above 1 the values are as before.
    fn checked(&mut self, dt: f64, tolerance: [f64; 2], acts: Acts) -> f64 {
        let began = self.time;
        self.work.before.copy_from_slice(&self.values);
        self.whole(dt, acts);
        std::mem::swap(&mut self.values, &mut self.work.whole);
        self.values.copy_from_slice(&self.work.before);
        self.time = began;
        self.strang(0.5 * dt, 2, acts);
        let error = self.error(dt, tolerance, acts.any());
        if too_large(error) {
            std::mem::swap(&mut self.values, &mut self.work.before);
            self.time = began;
        } else if acts.any() {
            self.extrapolate(acts.carrying.map(|carrying| carrying.transport));
        }
        error
    }

    /// A step in one piece. Where there are reactions what diffusion and decay changed in it is kept.
    fn whole(&mut self, dt: f64, acts: Acts) {
        if !acts.any() {
            return self.strang(dt, 1, acts);
        }
        let (began, reactions) = (self.time, acts.reactions);
        self.react(0.5 * dt, reactions);
        self.work.spread.copy_from_slice(&self.values);
        self.move_on(began, dt, acts);
        for (before, after) in self.work.spread.iter_mut().zip(&self.values) {
            *before = after - *before;
        }
        // What is carried changes as by a reaction: nothing of it dies by spreading before it adds up.
        let len = self.grid.len();
        for carried in acts.carrying.iter().flat_map(|carrying| &carrying.transport.carried) {
            self.work.spread[carried.species * len..(carried.species + 1) * len].fill(0.0);
        }
        self.time = began + 0.5 * dt;
        self.react(0.5 * dt, reactions);
        self.time = began + dt;
    }

    /// The error of the step that was taken whole and in halves, in tolerances.
    fn error(&mut self, dt: f64, tolerance: [f64; 2], reacts: bool) -> f64 {
        let Self { grid, species, values, work, level, .. } = self;
        let steps = f64::from(1_u32 << *level);
        let begun = reacts.then_some((&*work.before, steps));
        let of_size = error_of_size(grid.len(), values, &work.whole, tolerance, begun);
        if !reacts || too_large(of_size) {
            return of_size;
        }
        work.change.take(grid.len(), values, [&work.before, &work.whole, &work.spread], steps);
        if work.change.share == 0.0 {
            return of_size;
        }
        for ((error, fine), whole) in work.spread.iter_mut().zip(&*values).zip(&work.whole) {
            *error = 4.0 / 3.0 * (fine - whole);
        }
        work.spread_out(grid, species, dt / work.change.share);
        let of_rates = error_of_rates(&work.spread, &work.change, tolerance);
        if of_rates.is_nan() { of_rates } else { of_size.max(of_rates) }
    }

    /// What a step in halves and one in one piece say of shorter ones, eq. (field.15); where that is below zero and may not be, the halves
    /// stand: for that box, or, so that nothing is lost of what is carried, for all of that species.
    fn extrapolate(&mut self, transport: Option<&Transport>) {
        let len = self.grid.len();
        for (s, species) in self.species.iter().enumerate() {
            let floor = if species.range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
            let whole = &self.work.whole[s * len..(s + 1) * len];
            let further = |(fine, whole): (&f64, &f64)| *fine + (*fine - whole) / 3.0;
            if transport.is_some_and(|transport| transport.carries(s))
                && self.values[s * len..(s + 1) * len].iter().zip(whole).any(|pair| further(pair) < floor)
            {
                continue;
            }
            for (fine, whole) in self.values[s * len..(s + 1) * len].iter_mut().zip(whole) {
                let further = *fine + (*fine - whole) / 3.0;
                if further >= floor {
                    *fine = further;
                }
            }
        }
    }

    /// The box that is worst is told; its values in halves and whole stand where a refused step leaves them.
    fn unreachable_tolerance(&self, dt: f64) -> Error {
        let apart = |at: &usize| (self.work.before[*at] - self.work.whole[*at]).abs();
        let apart = |at: &usize| if apart(at).is_nan() { f64::INFINITY } else { apart(at) };
        // Of equals the first.
        let worst = (0..self.values.len()).rev().max_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(0);
        let (name, point) = self.told(worst);
        Error::Numbers {
            message: format!(
                "no step meets the tolerance of field '{name}' at t = {} s, down to {} s; it is worst at {point} µm",
                short(self.time),
                short(dt)
            ),
            help: "check the reactions for values that grow without bound, or raise the tolerance".into(),
            kept: None,
        }
    }

    /// The species and the position of a value, for messages.
    fn told(&self, value: usize) -> (&str, String) {
        let len = self.grid.len();
        (&self.species[value / len].name, self.grid.told(value % len))
    }

    fn is_finite(&self) -> bool {
        // Written so that lanes of values are looked at side by side.
        self.values.iter().fold(true, |fine, value| fine & (value.abs() < f64::INFINITY))
    }

    /// Tells the first value that is not finite, with what to do.
    pub(super) fn check_finite(&self, help: &str) -> Result<()> {
        let bad = if self.is_finite() { None } else { self.values.iter().position(|value| !value.is_finite()) };
        let Some(at) = bad else { return Ok(()) };
        let (name, point) = self.told(at);
        Err(Error::Numbers {
            message: format!("field '{name}' is {} at {point} µm and t = {} s", self.values[at], short(self.time)),
            help: help.into(),
            kept: None,
        })
    }
}

/// The fault of a flow that passes so many boxes in a second, in a window that begins at a time and is so long, s.
fn too_fast(speed: f64, (time, window): (f64, f64)) -> Error {
    let (speed, time, window) = (short(speed), short(time), short(window));
    Error::Numbers {
        message: format!(
            "a flow passes {speed} boxes in a second at t = {time} s; the next {window} s would take more than {MOST_IN_WINDOW:e} steps"
        ),
        help: "check the unit of the velocity or of the sensitivity, or take larger boxes".into(),
        kept: None,
    }
}
