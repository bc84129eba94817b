//! A single system from one time to another, with events and values wherever they are asked for.

use serde::{Deserialize, Serialize};

use super::control::Tolerances;
use super::events::{self, Events, STOPS, TRIGGERS};
use super::multistep;
use super::stepper::Stepper;
use super::{Method, OdeTrouble, Reason, Work};
use crate::chemistry::program::Program;
use crate::chemistry::tree::System;

/// Places within a step at which triggers are looked at.
const SAMPLES: usize = 8;
/// With events no step is longer than this share of the whole time.
const LONGEST_SHARE: f64 = 0.02;

/// How a single system is solved.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Scheme {
    /// One of our one-step methods.
    OneStep(Method),
    /// Backward differentiation of variable order, by diffsol; for systems without events.
    Bdf,
    /// A singly diagonally implicit Runge–Kutta method of order 4(3), by diffsol; for systems without events.
    Esdirk34,
    /// The pair of trapezoidal rule and BDF2, by diffsol; for systems without events.
    TrBdf2,
    /// The explicit pair of Tsitouras, by diffsol; for systems without events.
    Tsit45,
}

impl Scheme {
    /// The scheme of a name: `rk45`, `rosenbrock`, `bdf`, `esdirk34`, `tr-bdf2`, `tsit45`, and with an inner step `rk4`
    /// and `euler`.
    pub fn named(name: &str, inner_step: Option<f64>) -> Option<Self> {
        let positive = inner_step.filter(|step| *step > 0.0);
        match name {
            "rk45" => Some(Self::OneStep(Method::Rk45)),
            "rosenbrock" => Some(Self::OneStep(Method::Rosenbrock)),
            "rk4" => positive.map(|step| Self::OneStep(Method::Rk4 { step })),
            "euler" => positive.map(|step| Self::OneStep(Method::Euler { step })),
            "bdf" => Some(Self::Bdf),
            "esdirk34" => Some(Self::Esdirk34),
            "tr-bdf2" => Some(Self::TrBdf2),
            "tsit45" => Some(Self::Tsit45),
            _ => None,
        }
    }
}

/// Scheme and tolerances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SolveOptions {
    /// How to solve.
    pub scheme: Scheme,
    /// Error of a step relative to the size of each variable.
    pub relative: f64,
    /// Error of a step in the unit of each variable.
    pub absolute: f64,
    /// Most steps in all.
    pub max_steps: u32,
}

impl Default for SolveOptions {
    /// The Rosenbrock method, which takes stiff and other systems, with and without events.
    fn default() -> Self {
        let scheme = Scheme::OneStep(Method::Rosenbrock);
        Self { scheme, relative: 1e-7, absolute: 1e-14, max_steps: 2_000_000 }
    }
}

/// Values at the times asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The times, as asked.
    pub times: Vec<f64>,
    /// Of each time the values of all quantities, defined ones included.
    pub values: Vec<Vec<f64>>,
    /// Work done.
    pub work: Work,
}

/// Solves a system from its initial values at `from`, until `until`, with values at `points` (ascending, within that
/// time). Comparisons of time with what does not vary are met exactly, so that what is switched by the clock costs no
/// accuracy. Where an event is executed at a point the values are those after it.
///
/// # Errors
/// When the numbers fail, or the system has circles or events that the scheme cannot take.
///
/// # Panics
/// When the points do not ascend within the time.
pub fn solve(
    system: &System,
    from: f64,
    until: f64,
    points: &[f64],
    options: &SolveOptions,
) -> Result<Solution, OdeTrouble> {
    let mut solution = Solution { times: Vec::new(), values: Vec::new(), work: Work::default() };
    let (times, rows) = (&mut solution.times, &mut solution.values);
    solution.work = solve_each(system, from, until, points, options, &mut |time, values| {
        times.push(time);
        rows.push(values.to_vec());
    })?;
    Ok(solution)
}

/// As [`solve()`]; hands the values of all quantities over, point by point, as soon as they are known. When the numbers
/// fail, those of all points before have been handed over.
///
/// # Errors
/// As [`solve()`].
///
/// # Panics
/// As [`solve()`].
pub fn solve_each(
    system: &System,
    from: f64,
    until: f64,
    points: &[f64],
    options: &SolveOptions,
    each: &mut dyn FnMut(f64, &[f64]),
) -> Result<Work, OdeTrouble> {
    assert!(points.is_sorted(), "points ascend");
    assert!(points.iter().all(|point| (from..=until).contains(point)), "points from {from} until {until}");
    let trouble = |detail: String| OdeTrouble {
        system: system.name.clone(),
        cell: None,
        time: from,
        variable: None,
        reason: Reason::Solver,
        detail,
    };
    let compiled = Program::with(system, from, &events::assigned_parameters(system), &events::groups(system));
    let program = compiled.map_err(|circle| trouble(format!("a circle of {}", circle.join(", "))))?;
    let tolerances =
        Tolerances { relative: options.relative, absolute: options.absolute, max_steps: options.max_steps };
    match options.scheme {
        Scheme::OneStep(method) => {
            let stepper = Stepper::new(&program, method, tolerances, from);
            let events = Events::new(system, &program);
            Course { stepper, events, points, written: 0, each, until }.run(method, until - from)
        }
        _ if program.size() == 0 => {
            let options = SolveOptions { scheme: SolveOptions::default().scheme, ..*options };
            solve_each(system, from, until, points, &options, each)
        }
        _ if !system.events.is_empty() => {
            Err(trouble("this scheme takes no events: use rosenbrock, rk45, rk4 or euler".into()))
        }
        scheme => multistep::solve(&program, scheme, from, until, points, &tolerances, each),
    }
}

/// A solution in the making.
struct Course<'a> {
    stepper: Stepper<'a>,
    events: Events<'a>,
    points: &'a [f64],
    /// How many points have been handed over.
    written: usize,
    each: &'a mut dyn FnMut(f64, &[f64]),
    until: f64,
}

impl Course<'_> {
    fn run(mut self, method: Method, span: f64) -> Result<Work, OdeTrouble> {
        let fixed = matches!(method, Method::Rk4 { .. } | Method::Euler { .. });
        if !self.events.is_empty() {
            self.stepper.longest = LONGEST_SHARE * span;
        }
        self.events.update(&mut self.stepper);
        self.events.execute(&mut self.stepper)?;
        self.write_present();
        while self.stepper.time < self.until {
            let stop = self.next_stop();
            let mut limit = self.until.min(self.events.next()).min(stop);
            if let Some(&point) = self.points.get(self.written).filter(|_| fixed) {
                limit = limit.min(point);
            }
            // Everything within the step happens before the stop; the stop itself is then met without a step.
            let end = if limit == stop { before(limit) } else { limit };
            if end > self.stepper.time {
                let fired = self.one_step(end)?;
                if fired || self.stepper.time < end {
                    continue;
                }
            }
            self.stepper.time = limit;
            if limit == stop {
                self.stepper.forget_rates();
            }
            self.arrive()?;
        }
        Ok(self.stepper.work)
    }

    /// What happens at the present time: triggers, executions, values asked for.
    fn arrive(&mut self) -> Result<(), OdeTrouble> {
        self.events.update(&mut self.stepper);
        self.events.execute(&mut self.stepper)?;
        self.write_present();
        Ok(())
    }

    /// One step, cut short where a trigger turns true. Returns whether one did.
    fn one_step(&mut self, end: f64) -> Result<bool, OdeTrouble> {
        let begin = self.stepper.time;
        let step = self.stepper.step(end)?;
        let reached = if step >= end - begin { end } else { begin + step };
        let mut state = vec![0.0; self.stepper.program.size()];
        if !self.events.is_empty() {
            let mut low = 0.0;
            for sample in 1..=SAMPLES {
                let high = sample as f64 / SAMPLES as f64;
                if self.turns_true(begin, reached, high, &mut state) {
                    let share = self.find(begin, reached, (low, high), &mut state);
                    let time = if share >= 1.0 { reached } else { begin + share * (reached - begin) };
                    self.write_between(begin, reached, time);
                    self.stepper.between(share, &mut state);
                    self.stepper.commit_between(time, &state);
                    self.arrive()?;
                    return Ok(true);
                }
                low = high;
            }
        }
        self.write_between(begin, reached, reached);
        self.stepper.commit(reached);
        if reached < end {
            self.write_present();
        }
        Ok(false)
    }

    /// Whether a trigger that did not hold does at a share of the step. Takes note of triggers that no longer hold.
    fn turns_true(&mut self, begin: f64, reached: f64, share: f64, state: &mut [f64]) -> bool {
        let now = self.triggers(begin, reached, share, state);
        let turned = now.iter().zip(&self.events.holds).any(|(now, held)| *now != 0.0 && !held);
        if !turned {
            self.events.note_falling(&now);
        }
        turned
    }

    fn triggers(&mut self, begin: f64, reached: f64, share: f64, state: &mut [f64]) -> Vec<f64> {
        let mut now = Vec::new();
        self.stepper.between(share, state);
        let program = self.stepper.program;
        let time = if share >= 1.0 { reached } else { begin + share * (reached - begin) };
        self.stepper.evaluate(&program.further[TRIGGERS], time, state, &mut now);
        now
    }

    /// The smallest share, to the last bit of the time, at which a trigger that did not hold does.
    fn find(&mut self, begin: f64, reached: f64, (mut low, mut high): (f64, f64), state: &mut [f64]) -> f64 {
        let close = f64::EPSILON.max(f64::EPSILON * reached.abs() / (reached - begin));
        while high - low > close {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            let now = self.triggers(begin, reached, middle, state);
            let turned = now.iter().zip(&self.events.holds).any(|(now, held)| *now != 0.0 && !held);
            (low, high) = if turned { (low, middle) } else { (middle, high) };
        }
        high
    }

    /// The next time at which a comparison with the clock changes, if it runs evenly.
    fn next_stop(&mut self) -> f64 {
        let program = self.stepper.program;
        let code = &program.further[STOPS];
        if code.outputs.is_empty() {
            return f64::INFINITY;
        }
        let time = self.stepper.time;
        let state: Vec<f64> = (0..program.size()).map(|v| self.stepper.state(v)).collect();
        let length = (self.until - time).max(1e-3 * self.until.abs());
        let mut at = |time: f64| {
            let mut results = Vec::new();
            self.stepper.evaluate(code, time, &state, &mut results);
            results
        };
        let (now, half, whole) = (at(time), at(time + 0.5 * length), at(time + length));
        let mut next = f64::INFINITY;
        for ((now, half), whole) in now.iter().zip(&half).zip(&whole) {
            let (slope, size) = ((whole - now) / length, now.abs().max(whole.abs()));
            let even = (half - 0.5 * (now + whole)).abs() <= 1e-12 * size;
            let root = time - now / slope;
            if even && slope != 0.0 && root > time + 16.0 * f64::EPSILON * time.abs() {
                next = next.min(nice(root));
            }
        }
        next
    }

    /// Writes the points before a time, from within the step.
    fn write_between(&mut self, begin: f64, reached: f64, time: f64) {
        let mut state = vec![0.0; self.stepper.program.size()];
        while let Some(&point) = self.points.get(self.written).filter(|point| **point < time) {
            self.stepper.between((point - begin) / (reached - begin), &mut state);
            self.write(point, &state);
        }
    }

    /// Writes the points at the present time.
    fn write_present(&mut self) {
        while let Some(&point) = self.points.get(self.written).filter(|point| **point <= self.stepper.time) {
            let state: Vec<f64> = (0..self.stepper.program.size()).map(|v| self.stepper.state(v)).collect();
            self.write(point, &state);
        }
    }

    fn write(&mut self, point: f64, state: &[f64]) {
        let mut values = Vec::new();
        let program = self.stepper.program;
        self.stepper.evaluate(&program.observe, point, state, &mut values);
        self.written += 1;
        (self.each)(point, &values);
    }
}

/// A time a few units in the last place before another.
fn before(time: f64) -> f64 {
    time - 4.0 * f64::EPSILON * time.abs()
}

/// The number of few digits within round-off of a time, if there is one: 0.3 for 0.30000000000000004.
fn nice(time: f64) -> f64 {
    let scale = 10_f64.powi(12 - time.abs().log10().ceil() as i32);
    let rounded = (time * scale).round() / scale;
    if (rounded - time).abs() <= 8.0 * f64::EPSILON * time.abs() { rounded } else { time }
}
