//! Fields and what stands once beside them, together through a window, eqs. (field.21) and (field.22).
//!
//! Neither waits for the other: in each step the fields see what stands beside them as it is in the middle of the step, and that sees the means of
//! what fields sum up to where the step begins and ends. Steps are as long as their error allows, and are cut where events happen.

use super::beside::{Beside, PartSum, parts_of};
use super::pieces::halvings;
use super::scales::Scales;
use super::scene::{Kept, Scene};
use super::state::Fields;
use super::step::{Report, Stepping};
use super::tables::Now;
use crate::equations::Range;
use crate::error::Result;
use crate::ode::{EventMemory, Eventful, OdeTrouble, Population, PopulationScratch};

/// How near the instant of an event is found, over the window.
const NEAR: f64 = 1e-9;
/// The shortest step, over the window.
const SHORTEST: f64 = 1e-12;

/// How much shorter a step is tried after one that failed.
const SHORTER: f64 = 0.2;

/// What becomes of a step.
enum Outcome {
    /// It stands.
    Stands,
    /// Its error is too large; all is as before it.
    TooLong,
    /// An event happens in it: one was executed at this time, s, or, where that is infinite, one fires at its end.
    Happens(f64),
}

/// What happened in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// When the first event was executed, s; infinite where none was.
    event: f64,
    /// Whether one fires where it ends.
    fires: bool,
}

/// How fields move by a window of time, s, beside numbers that stand still.
pub(super) type Advance<'a> = dyn Fn(&mut Fields, f64, &[f64], Stepping) -> Result<Report> + 'a;

/// Fields by themselves.
pub(super) struct Alone<'a> {
    /// The document's name.
    pub name: &'a str,
    pub scales: Scales,
    /// Of each field, which values it may take.
    pub ranges: &'a [Range],
    /// Whether anything acts on them beside diffusion and decay.
    pub are_acted_on: bool,
    pub advance: &'a Advance<'a>,
}

/// A window of both.
pub(super) struct Joint<'a, 's> {
    pub alone: Alone<'a>,
    pub beside: &'a Beside,
    pub fields: &'a mut Fields,
    pub inputs: &'a mut [f64],
    pub scene: Scene<'s>,
    pub stepping: Stepping,
    pub report: Report,
}

impl Joint<'_, '_> {
    /// Goes through a window, s.
    pub fn run(&mut self, window: f64) -> Result<Report> {
        let (begin, end) = (self.fields.time, self.fields.time + window);
        let near = (NEAR * window).max(4.0 * f64::EPSILON * end.abs());
        // When an event is known to come, as far as is known: not before the first, surely by the second.
        let mut coming: Option<(f64, f64)> = None;
        let mut failed = None;
        self.settle()?;
        while self.fields.time < end {
            let now = self.fields.time;
            let mut until = end.min(now + self.usual_step(window));
            if end - until < near {
                until = end;
            }
            let (mut at_event, mut cut) = (false, until - now < self.scene.pace.step * (1.0 - NEAR));
            if let Some((earliest, latest)) = coming.filter(|(_, latest)| *latest <= until) {
                at_event = latest - now <= 3.0 * near;
                let early = if earliest > now { earliest } else { 0.5 * (now + latest) };
                (until, cut) = (if at_event { latest } else { early }, true);
            }
            if until - now < SHORTEST * window {
                return Err(failed.unwrap_or_else(|| self.unreachable_tolerance(now)));
            }
            let goes_through = at_event || until - now <= 3.0 * near;
            match self.attempt((now, until), (goes_through, cut)) {
                Ok(Outcome::Stands) => {
                    coming = coming.filter(|_| !at_event);
                    self.arrive(until)?;
                }
                Ok(Outcome::TooLong) => {}
                Ok(Outcome::Happens(event)) => {
                    coming = Some(match event > now && event.is_finite() {
                        true => ((event - near).max(now), (event + near).min(until)),
                        false => (0.5 * (now + until), until),
                    });
                    self.restore(now);
                    self.report.rejected += 1;
                }
                // What fails in a step that is too long may go well in a shorter one.
                Err(error) if matches!(self.stepping, Stepping::Adaptive { .. }) => {
                    failed = Some(error);
                    self.restore(now);
                    self.report.rejected += 1;
                    self.scene.pace.step = SHORTER * (until - now);
                }
                Err(error) => return Err(error),
            }
        }
        self.fields.time = begin + window;
        Ok(self.report)
    }

    /// Tries a step from one time to another; where it goes through an event it stands whatever its error. `cut` says that something cut it, so that
    /// it says nothing against a longer one.
    fn attempt(&mut self, (now, until): (f64, f64), (goes_through, cut): (bool, bool)) -> Result<Outcome> {
        self.keep();
        let step = self.step(until)?;
        let happens = step.event.is_finite() || step.fires;
        Ok(match (happens, goes_through) {
            (true, false) => Outcome::Happens(step.event),
            (_, true) => Outcome::Stands,
            (false, false) if self.is_good(now, until, cut)? => Outcome::Stands,
            (false, false) => Outcome::TooLong,
        })
    }

    /// Takes a step that stands: what its events set is set.
    fn arrive(&mut self, until: f64) -> Result<()> {
        self.report.steps += 1;
        self.fields.time = until;
        let before = self.scene.scratch.before.population.take().expect("it was kept");
        let set = self.set_fields(&before);
        self.scene.scratch.before.population = Some(before);
        set?;
        self.settle().map(|_| ())
    }

    /// The step that is tried where nothing else cuts it.
    fn usual_step(&self, window: f64) -> f64 {
        match self.stepping {
            Stepping::Fixed(steps) => window / f64::from(steps.max(1)),
            Stepping::Adaptive { .. } if self.scene.pace.step > 0.0 => self.scene.pace.step,
            Stepping::Adaptive { .. } => window,
        }
    }

    /// A step to a time from the present one on, which leaves the clock of the fields where it was.
    pub(super) fn step(&mut self, until: f64) -> Result<Step> {
        let now = self.fields.time;
        let seconds = self.alone.scales.seconds;
        // Where what stands beside is in the middle, by what it sees now.
        let mut trial = std::mem::take(&mut self.scene.scratch.trial);
        trial.take(self.scene.population, self.scene.memories);
        let ahead = self.go(trial.population.as_mut().expect("taken"), None, (now, 0.5 * (now + until)));
        if ahead.is_ok() {
            self.beside.feed(trial.population(), self.inputs);
        }
        self.scene.scratch.trial = trial;
        ahead?;
        let mut first = std::mem::take(&mut self.scene.scratch.totals);
        self.sum(&mut first);
        let moved = self.move_fields(now, until, &first);
        let mut last = std::mem::take(&mut self.scene.scratch.totals_after);
        self.sum(&mut last);
        first.iter_mut().zip(&last).for_each(|(first, last)| *first = 0.5 * (*first + last));
        self.beside.tell(&first, self.scene.population);
        (self.scene.scratch.totals, self.scene.scratch.totals_after) = (first, last);
        moved?;
        self.go_on((now, until))?;
        let event = self.scene.scratch.solver.first_event(0) * seconds;
        let event = if self.scene.memories.is_empty() { f64::INFINITY } else { event };
        self.fields.time = until;
        self.look();
        let mut fires = false;
        if !self.scene.memories.is_empty() {
            let mut trial = std::mem::take(&mut self.scene.scratch.trial);
            trial.take(self.scene.population, self.scene.memories);
            let Kept { population, memories, .. } = &mut trial;
            let population = population.as_mut().expect("taken");
            let done = self.go(population, Some(memories), (until, until));
            self.scene.scratch.trial = trial;
            fires = done? > 0;
        }
        self.fields.time = now;
        Ok(Step { event, fires })
    }

    /// Moves the fields to a time under what they were given; `sums` are those where they begin.
    fn move_fields(&mut self, now: f64, until: f64, sums: &[f64]) -> Result<()> {
        if self.beside.reads_totals {
            // What they themselves sum up to in the middle, by what it is now.
            self.give_totals(sums);
            let mut middle = std::mem::take(&mut self.scene.scratch.middle);
            middle.clear();
            middle.extend_from_slice(&self.fields.values);
            let moved = self.flow(0.5 * (until - now));
            let mut found = std::mem::take(&mut self.scene.scratch.totals_after);
            self.sum(&mut found);
            self.give_totals(&found);
            self.fields.values.copy_from_slice(&middle);
            (self.scene.scratch.middle, self.scene.scratch.totals_after) = (middle, found);
            self.fields.time = now;
            moved?;
        }
        self.flow(until - now)?;
        self.fields.time = until;
        Ok(())
    }

    fn give_totals(&mut self, sums: &[f64]) {
        self.beside.totals.iter().zip(sums).for_each(|(total, sum)| self.inputs[total.input] = *sum);
    }

    /// The fields by themselves, in steps of about the length that they had last.
    fn flow(&mut self, length: f64) -> Result<()> {
        let stepping = match self.stepping {
            Stepping::Fixed(_) => Stepping::Fixed(1),
            adaptive => adaptive,
        };
        let inner = self.scene.pace.inner;
        self.fields.set_pace((if inner > 0.0 { halvings(length, inner) } else { 0 }, 0));
        let report = (self.alone.advance)(self.fields, length, self.inputs, stepping)?;
        self.scene.pace.inner = length / f64::from(1_u32 << self.fields.level);
        self.report.checks += report.checks;
        self.report.rejected += report.rejected;
        Ok(())
    }

    /// Gives each what there is of the other.
    pub fn look(&mut self) {
        self.beside.feed(self.scene.population, self.inputs);
        let mut totals = std::mem::take(&mut self.scene.scratch.totals);
        self.sum(&mut totals);
        self.give_totals(&totals);
        self.beside.tell(&totals, self.scene.population);
        self.scene.scratch.totals = totals;
    }

    /// Moves what stands beside from one time to another, s. Returns how many events were executed.
    pub(super) fn go_on(&mut self, window: (f64, f64)) -> Result<u64> {
        let Scene { eventful, population, memories, scratch, .. } = &mut self.scene;
        let memories = (!memories.is_empty()).then_some(&mut **memories);
        go(eventful, population, memories, window, self.alone.scales.seconds, &mut scratch.solver)
    }

    /// The same of a copy; without memories none of its events happens.
    fn go(
        &mut self,
        population: &mut Population,
        memories: Option<&mut Vec<EventMemory>>,
        window: (f64, f64),
    ) -> Result<u64> {
        let Scene { eventful, scratch, .. } = &mut self.scene;
        let memories = memories.map(|memories| &mut memories[..]);
        go(eventful, population, memories, window, self.alone.scales.seconds, &mut scratch.solver)
    }

    /// Works out all sums over the grid.
    fn sum(&mut self, to: &mut Vec<f64>) {
        let scratch = &mut self.scene.scratch.sums;
        scratch.resize_with(parts_of(&self.fields.grid), PartSum::default);
        self.beside.sum(&now(&self.alone, self.fields, self.inputs), scratch, to);
    }
}

/// What tables are worked out from.
pub(super) fn now<'a>(alone: &Alone<'a>, fields: &'a Fields, inputs: &'a [f64]) -> Now<'a> {
    let Alone { scales, ranges, .. } = *alone;
    Now { grid: &fields.grid, scales, time: fields.time, inputs, values: &fields.values, ranges }
}

/// Moves a system of the scene from one time to another, s. Returns how many events were executed.
fn go(
    eventful: &Eventful,
    population: &mut Population,
    memories: Option<&mut [EventMemory]>,
    (from, until): (f64, f64),
    seconds: f64,
    scratch: &mut PopulationScratch,
) -> Result<u64> {
    let window = (from / seconds, until / seconds);
    let named = |trouble: OdeTrouble| OdeTrouble { cell: None, ..trouble };
    match memories {
        Some(memories) => {
            let done = eventful.advance(population, memories, std::iter::once(0), window, scratch);
            Ok(done.map_err(named)?.events)
        }
        None if until > from => {
            population.advance_by_clock(eventful.program, window, &eventful.tolerances, scratch).map_err(named)?;
            Ok(0)
        }
        None => Ok(0),
    }
}
