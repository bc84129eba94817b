//! One system from one time to another: its steps, cut where a trigger turns true or the clock switches.

use super::OdeTrouble;
use super::events::{Events, TRIGGERS};
use super::stepper::Stepper;
use super::switches::{Ahead, Switch, Switches, after};

/// Points within a step at which triggers are looked at.
const SAMPLES: usize = 8;
/// With events no step is longer than this share of the whole time.
pub const LONGEST_SHARE: f64 = 0.02;

/// A course from the stepper's present until a time.
pub struct Course<'c, 'a> {
    stepper: &'c mut Stepper<'a>,
    events: &'c mut Events<'a>,
    points: &'c [f64],
    /// How many points have been handed over.
    written: usize,
    each: &'c mut dyn FnMut(f64, &[f64]),
    until: f64,
    buffers: &'c mut CourseBuffers,
}

/// What a [`Course`] works in.
#[derive(Debug, Default)]
pub struct CourseBuffers {
    /// The state within a step, and the triggers there.
    within: Vec<f64>,
    now: Vec<f64>,
    switches: Switches,
    /// The largest that any variable has been, without its sign.
    pub largest: f64,
}

impl<'c, 'a> Course<'c, 'a> {
    /// The course until a time, with the values of all quantities handed to `each` at the points. It is looked so often at what the clock
    /// switches and does not run evenly.
    pub fn new(
        stepper: &'c mut Stepper<'a>,
        events: &'c mut Events<'a>,
        (until, looks): (f64, usize),
        points: &'c [f64],
        each: &'c mut dyn FnMut(f64, &[f64]),
        buffers: &'c mut CourseBuffers,
    ) -> Self {
        buffers.within.resize(stepper.program.size(), 0.0);
        buffers.largest = 0.0;
        buffers.switches.begin(stepper, until, looks);
        Self { stepper, events, points, written: 0, each, until, buffers }
    }

    /// Goes to its end. What is triggered at its begin or exactly at its end is executed.
    ///
    /// # Errors
    /// When the numbers fail, or events follow each other without end.
    pub fn run(mut self) -> Result<(), OdeTrouble> {
        let fixed = self.stepper.has_fixed_steps();
        self.arrive()?;
        if self.buffers.switches.are_at_present(self.stepper) {
            self.pass_to(after(self.stepper.time, self.until))?;
        }
        while self.stepper.time < self.until {
            let Ahead { switch: Switch { before, at: stop, after }, seen } = self.buffers.switches.next(self.stepper);
            let mark = self.stepper.next_mark();
            let mut limit = self.until.min(self.events.next()).min(stop).min(seen).min(mark);
            if let Some(&point) = self.points.get(self.written).filter(|_| fixed) {
                limit = limit.min(point);
            }
            // Everything within the step happens before the stop; the stop itself is then met without a step.
            let end = if limit == stop { before } else { limit };
            if end > self.stepper.time {
                let fired = self.one_step(end)?;
                if fired || self.stepper.time < end {
                    continue;
                }
            }
            self.stepper.time = limit;
            if limit == stop {
                self.stepper.mark(true);
            }
            if limit == mark {
                self.stepper.mark(false);
            }
            self.arrive()?;
            if limit == stop {
                self.pass_to(after)?;
            }
        }
        Ok(())
    }

    /// Goes on right after a switch, so that rates are those of the time that follows, be they at the instant itself those of the time before. What
    /// looks back must find the instant itself.
    fn pass_to(&mut self, after: f64) -> Result<(), OdeTrouble> {
        if after < self.until && self.stepper.program.delays.is_empty() {
            self.stepper.time = after;
            self.stepper.forget_rates();
            self.arrive()?;
        }
        Ok(())
    }

    /// What happens at the present time: triggers, executions, values asked for.
    fn arrive(&mut self) -> Result<(), OdeTrouble> {
        self.note_largest();
        self.events.update(self.stepper);
        if self.events.execute(self.stepper)? {
            self.buffers.switches.forget();
        }
        self.write_present();
        self.stepper.check_delays()
    }

    /// One step, cut short where a trigger turns true. Returns whether one did.
    fn one_step(&mut self, end: f64) -> Result<bool, OdeTrouble> {
        let begin = self.stepper.time;
        let step = self.stepper.step(end)?;
        let reached = if step >= end - begin { end } else { begin + step };
        if !self.events.is_empty() {
            let mut low = 0.0;
            for sample in 1..=SAMPLES {
                let high = sample as f64 / SAMPLES as f64;
                if self.turns_true(begin, reached, high) {
                    let share = self.find(begin, reached, (low, high));
                    let time = if share >= 1.0 { reached } else { begin + share * (reached - begin) };
                    self.write_between(begin, reached, time);
                    self.stepper.between(share, &mut self.buffers.within);
                    self.stepper.commit_between(time, &self.buffers.within);
                    self.arrive()?;
                    return Ok(true);
                }
                low = high;
            }
        }
        self.write_between(begin, reached, reached);
        self.stepper.commit(reached);
        self.note_largest();
        if reached < end {
            self.write_present();
        }
        self.stepper.check_delays()?;
        Ok(false)
    }

    /// Takes note of the present state's size.
    fn note_largest(&mut self) {
        let sizes = (0..self.stepper.program.size()).map(|v| self.stepper.state(v).abs());
        self.buffers.largest = sizes.fold(self.buffers.largest, f64::max);
    }

    /// Whether a trigger that did not hold does at a share of the step. Takes note of triggers that no longer hold.
    fn turns_true(&mut self, begin: f64, reached: f64, share: f64) -> bool {
        self.look(begin, reached, share);
        let turned = self.events.turns_true(&self.buffers.now);
        if !turned {
            self.events.note_falling(&self.buffers.now);
        }
        turned
    }

    /// Works out the triggers at a share of the step.
    fn look(&mut self, begin: f64, reached: f64, share: f64) {
        let CourseBuffers { within, now, .. } = &mut *self.buffers;
        self.stepper.between(share, within);
        let program = self.stepper.program;
        let time = if share >= 1.0 { reached } else { begin + share * (reached - begin) };
        self.stepper.evaluate(&program.further[TRIGGERS], time, within, now);
    }

    /// The smallest share, to the last bit of the time, at which a trigger that did not hold does.
    fn find(&mut self, begin: f64, reached: f64, (mut low, mut high): (f64, f64)) -> f64 {
        let close = f64::EPSILON.max(f64::EPSILON * reached.abs() / (reached - begin));
        while high - low > close {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            self.look(begin, reached, middle);
            (low, high) = if self.events.turns_true(&self.buffers.now) { (low, middle) } else { (middle, high) };
        }
        high
    }

    /// Writes the points before a time, from within the step.
    fn write_between(&mut self, begin: f64, reached: f64, time: f64) {
        while let Some(&point) = self.points.get(self.written).filter(|point| **point < time) {
            let mut state = vec![0.0; self.stepper.program.size()];
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
        // What looks ahead has no value; that is told at once.
        if !self.stepper.looks_ahead() {
            (self.each)(point, &values);
        }
    }
}
