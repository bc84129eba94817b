//! Fields and what stands once beside them, together through a window, eqs. (field.21) and (field.22).
//!
//! Neither waits for the other: in each step the fields see what stands beside them as it is in the middle of the step, and that sees the means of
//! what fields sum up to where the step begins and ends. Steps are as long as their error allows, and are cut where events happen.

use super::beside::{Beside, PartSum, parts_of, sum};
use super::state::{FINEST, Fields};
use super::step::{Report, Stepping};
use super::system::FieldSystem;
use super::tables::Now;
use crate::equations::Range;
use crate::error::{Error, Result, short};
use crate::ode::{EventMemory, Eventful, OdeTrouble, Population, PopulationScratch};

/// How near the instant of an event is found, over the window.
const NEAR: f64 = 1e-9;
/// The shortest step, over the window.
const SHORTEST: f64 = 1e-12;
/// Executions of events at one instant after which they count as endless.
const MOST_AT_ONCE: u32 = 10_000;
/// Of what changes in a step at least this part of the whole counts, as in (field.14).
const LEAST_CHANGE: f64 = 0.01;
/// What differs from the mean by less of the whole is round-off.
const ROUND_OFF: f64 = 1e-9;

/// What stands beside fields while they are moved.
#[derive(Debug)]
pub struct Scene<'a> {
    /// How it is solved; its program and its events are those of [`FieldSystem::beside`].
    pub eventful: Eventful<'a>,
    /// A population of one.
    pub population: &'a mut Population,
    /// What it knows of its events; empty where it has none.
    pub memories: &'a mut [EventMemory],
    /// The pace of the last window, to be kept with the rest.
    pub pace: &'a mut ScenePace,
    /// What it works in.
    pub scratch: &'a mut SceneScratch,
}

/// The step that is tried next, and the last one of the fields in it, s; 0 where none is known.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ScenePace {
    /// The step of both together.
    pub step: f64,
    /// The step of the fields.
    pub inner: f64,
}

/// What fields and what stands beside them work in. It says nothing about either.
#[derive(Debug, Clone, Default)]
pub struct SceneScratch {
    solver: PopulationScratch,
    /// Where a step begins, what is tried, and where the step came to in one piece.
    before: Kept,
    trial: Kept,
    whole: Kept,
    /// The fields where half a step begins whose sums are looked at in its middle.
    middle: Vec<f64>,
    sums: Vec<PartSum>,
    totals: Vec<f64>,
    totals_after: Vec<f64>,
    set: Vec<f64>,
}

/// A state of both, or what there is of it.
#[derive(Debug, Clone, Default)]
struct Kept {
    population: Option<Population>,
    memories: Vec<EventMemory>,
    values: Vec<f64>,
    inputs: Vec<f64>,
    sizes: Vec<[f64; 2]>,
}

impl Kept {
    fn take(&mut self, population: &Population, memories: &[EventMemory]) {
        match &mut self.population {
            Some(kept) => kept.copy_from(population),
            None => self.population = Some(population.clone()),
        }
        if self.memories.len() != memories.len() {
            self.memories = memories.to_vec();
        }
        self.memories.iter_mut().zip(memories).for_each(|(to, from)| to.copy_from(from));
    }

    fn population(&self) -> &Population {
        self.population.as_ref().expect("it was taken")
    }
}

/// What happened in a step.
#[derive(Debug, Clone, Copy)]
struct Step {
    /// When the first event was executed, s; infinite where none was.
    event: f64,
    /// Whether one fires where it ends.
    fires: bool,
}

/// A window of both.
pub(super) struct Joint<'a, 's> {
    pub system: &'a FieldSystem,
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
        self.settle()?;
        while self.fields.time < end {
            let now = self.fields.time;
            let mut until = end.min(now + self.usual_step(window));
            if end - until < near {
                until = end;
            }
            let (mut at_event, mut cut) = (false, until < end && self.scene.pace.step == 0.0);
            if let Some((earliest, latest)) = coming.filter(|(_, latest)| *latest <= until) {
                at_event = latest - now <= 3.0 * near;
                let early = if earliest > now { earliest } else { 0.5 * (now + latest) };
                (until, cut) = (if at_event { latest } else { early }, true);
            }
            if until - now < SHORTEST * window {
                return Err(self.unreachable_tolerance(now));
            }
            self.keep();
            let step = self.step(until)?;
            let happens = step.event.is_finite() || step.fires;
            if happens && !at_event && until - now > 3.0 * near {
                coming = Some(match step.event > now && step.event.is_finite() {
                    true => ((step.event - near).max(now), (step.event + near).min(until)),
                    false => (0.5 * (now + until), until),
                });
                self.report.rejected += 1;
                self.restore(now);
                continue;
            }
            let accepted = at_event || happens || self.is_good(now, until, cut)?;
            if !accepted {
                continue;
            }
            if at_event || happens {
                coming = None;
            }
            self.report.steps += 1;
            self.fields.time = until;
            let before = self.scene.scratch.before.population.take();
            let before = before.expect("it was kept");
            let set = self.set_fields(&before);
            self.scene.scratch.before.population = Some(before);
            set?;
            self.settle()?;
        }
        self.fields.time = begin + window;
        Ok(self.report)
    }

    /// The step that is tried where nothing else cuts it.
    fn usual_step(&self, window: f64) -> f64 {
        match self.stepping {
            Stepping::Fixed(steps) => window / f64::from(steps.max(1)),
            Stepping::Adaptive { .. } if self.scene.pace.step > 0.0 => self.scene.pace.step,
            Stepping::Adaptive { .. } => window,
        }
    }

    /// Whether a step that was taken whole stands, by what it is in two halves, which are kept then.
    fn is_good(&mut self, now: f64, until: f64, cut: bool) -> Result<bool> {
        let Stepping::Adaptive { relative, absolute } = self.stepping else { return Ok(true) };
        self.report.checks += 1;
        let mut whole = std::mem::take(&mut self.scene.scratch.whole);
        whole.take(self.scene.population, self.scene.memories);
        self.sizes(&mut whole.sizes);
        if self.system.is_acted_on() {
            whole.values.clone_from(&self.fields.values);
        }
        self.scene.scratch.whole = whole;
        self.restore(now);
        let middle = 0.5 * (now + until);
        self.step(middle)?;
        self.fields.time = middle;
        self.step(until)?;
        let error = self.error([relative, absolute]);
        let length = until - now;
        let factor = (0.9 * error.powf(-1.0 / 3.0)).clamp(0.2, 4.0);
        if error.is_nan() || error > 1.0 {
            self.report.rejected += 1;
            self.scene.pace.step = length * if error.is_nan() { 0.2 } else { factor.min(0.5) };
            self.restore(now);
            return Ok(false);
        }
        self.report.error = self.report.error.max(error);
        self.extrapolate();
        let next = length * factor;
        // One that was cut by something else says nothing against a longer one.
        self.scene.pace.step = if cut { next.max(self.scene.pace.step) } else { next };
        Ok(true)
    }

    /// What a step in halves and one in one piece say of shorter ones, as in (field.15): of what stands beside, and of each field where that is below
    /// zero nowhere, or may be.
    fn extrapolate(&mut self) {
        let Self { fields, scene, .. } = self;
        let further = |fine: f64, whole: f64| fine + (fine - whole) / 3.0;
        for variable in 0..self.beside.program.size() {
            let [now, whole] =
                [&*scene.population, scene.scratch.whole.population()].map(|population| population.state(0, variable));
            scene.population.set_state(0, variable, further(now, whole));
        }
        let boxes = fields.grid.len();
        let values = fields.values.chunks_exact_mut(boxes).zip(scene.scratch.whole.values.chunks_exact(boxes));
        for ((values, whole), species) in values.zip(&fields.species).filter(|_| self.system.is_acted_on()) {
            let floor = if species.range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
            if values.iter().zip(whole).all(|(fine, whole)| further(*fine, *whole) >= floor) {
                values.iter_mut().zip(whole).for_each(|(fine, whole)| *fine = further(*fine, *whole));
            }
        }
    }

    /// A step to a time from the present one on, which leaves the clock of the fields where it was.
    fn step(&mut self, until: f64) -> Result<Step> {
        let now = self.fields.time;
        let seconds = self.system.seconds();
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
        let level =
            if inner > 0.0 { (length / inner * (1.0 - NEAR)).log2().ceil().clamp(0.0, f64::from(FINEST)) } else { 0.0 };
        self.fields.set_pace((level as u32, 0));
        let report = self.system.advance(self.fields, length, self.inputs, stepping)?;
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

    /// Lets each see the other as it is, and executes what is due now, until nothing more happens. Returns whether anything did.
    pub fn settle(&mut self) -> Result<bool> {
        let (time, mut any) = (self.fields.time, false);
        for _ in 0..MOST_AT_ONCE {
            self.look();
            if self.scene.memories.is_empty() {
                return Ok(false);
            }
            let mut before = std::mem::take(&mut self.scene.scratch.before);
            before.take(self.scene.population, self.scene.memories);
            let done = self.go_on((time, time));
            let set = if matches!(done, Ok(1..)) { self.set_fields(before.population()) } else { Ok(()) };
            self.scene.scratch.before = before;
            set?;
            if done? == 0 {
                return Ok(any);
            }
            any = true;
        }
        Err(Error::Numbers {
            message: format!(
                "{} has events that follow each other without end at t = {} s",
                self.system.name(),
                short(time)
            ),
            help: "let the events change what triggers them".into(),
            kept: None,
        })
    }

    /// Sets fields as the events say that have been executed since.
    fn set_fields(&mut self, before: &Population) -> Result<()> {
        for sets in &self.beside.sets {
            let times = self.scene.population.state(0, sets.count) - before.state(0, sets.count);
            for _ in 0..times.round() as u32 {
                self.look();
                let boxes = self.fields.grid.len();
                let mut set = std::mem::take(&mut self.scene.scratch.set);
                set.resize(sets.values.len() * boxes, 0.0);
                let now = now(self.system, self.fields, self.inputs);
                let scratch = &mut self.scene.scratch.sums;
                scratch.resize_with(parts_of(&self.fields.grid), PartSum::default);
                for ((_, table), to) in sets.values.iter().zip(set.chunks_exact_mut(boxes)) {
                    table.fill(&now, 0, to, scratch[0].file());
                }
                for ((species, _), from) in sets.values.iter().zip(set.chunks_exact(boxes)) {
                    let (species, name) = (*species, &self.fields.species[*species].name);
                    let floor =
                        if self.fields.species[species].range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
                    if let Some(at) = from.iter().position(|value| !(value.is_finite() && *value >= floor)) {
                        return Err(Error::Numbers {
                            message: format!(
                                "document '{}': the event '{}' sets field '{name}' to {} at {} µm and t = {} s",
                                self.system.name(),
                                sets.name,
                                from[at],
                                self.fields.grid.told(at),
                                short(self.fields.time)
                            ),
                            help: "a concentration is finite and not below 0; range=\"free\" allows what is negative"
                                .into(),
                            kept: None,
                        });
                    }
                    self.fields.values[species * boxes..(species + 1) * boxes].copy_from_slice(from);
                }
                self.scene.scratch.set = set;
            }
        }
        Ok(())
    }

    fn keep(&mut self) {
        let before = &mut self.scene.scratch.before;
        before.take(self.scene.population, self.scene.memories);
        before.values.clone_from(&self.fields.values);
        before.inputs.clear();
        before.inputs.extend_from_slice(self.inputs);
    }

    fn restore(&mut self, time: f64) {
        let before = &self.scene.scratch.before;
        self.scene.population.copy_from(before.population());
        self.scene.memories.iter_mut().zip(&before.memories).for_each(|(to, from)| to.copy_from(from));
        self.fields.values.copy_from_slice(&before.values);
        self.inputs.copy_from_slice(&before.inputs);
        self.fields.time = time;
    }

    /// Moves what stands beside from one time to another, s. Returns how many events were executed.
    fn go_on(&mut self, window: (f64, f64)) -> Result<u64> {
        let Scene { eventful, population, memories, scratch, .. } = &mut self.scene;
        let memories = (!memories.is_empty()).then_some(&mut **memories);
        go(eventful, population, memories, window, self.system.seconds(), &mut scratch.solver)
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
        go(eventful, population, memories, window, self.system.seconds(), &mut scratch.solver)
    }

    /// Works out all sums over the grid.
    fn sum(&mut self, to: &mut Vec<f64>) {
        let scratch = &mut self.scene.scratch.sums;
        scratch.resize_with(parts_of(&self.fields.grid), PartSum::default);
        self.beside.sum(&now(self.system, self.fields, self.inputs), scratch, to);
    }

    /// The mean of each field and how far its values are from it, as root mean square.
    fn sizes(&mut self, to: &mut Vec<[f64; 2]>) {
        to.clear();
        let Self { fields, scene, .. } = self;
        let (boxes, sums) = (fields.grid.len(), &mut scene.scratch.sums);
        sums.resize_with(parts_of(&fields.grid), PartSum::default);
        to.extend(fields.values.chunks_exact(boxes).map(|values| sizes(values, sums)));
    }

    /// The error of a step that was taken whole and in halves, in tolerances.
    fn error(&mut self, [relative, absolute]: [f64; 2]) -> f64 {
        let mut fine = std::mem::take(&mut self.scene.scratch.trial.sizes);
        self.sizes(&mut fine);
        let Scene { population, eventful, scratch, .. } = &mut self.scene;
        let mut worst: f64 = 0.0;
        let mut note = |error: f64| worst = if error.is_nan() { f64::NAN } else { worst.max(error) };
        let part = |apart: f64, change: f64, size: f64, least: f64| match 4.0 / 3.0 * apart {
            0.0 => 0.0,
            apart => apart / (relative * change.max(LEAST_CHANGE * size) + least),
        };
        for variable in 0..self.beside.program.size() {
            let [before, whole] = [&scratch.before, &scratch.whole].map(|kept| kept.population().state(0, variable));
            let now = population.state(0, variable);
            let size = now.abs().max(before.abs());
            let least = eventful.tolerances.absolute * self.beside.program.sizes[variable];
            note(part((now - whole).abs(), (now - before).abs(), size, least));
        }
        if self.system.is_acted_on() {
            let boxes = self.fields.grid.len();
            for (species, (fine, whole)) in fine.iter().zip(&scratch.whole.sizes).enumerate() {
                let before = sizes(&scratch.before.values[species * boxes..][..boxes], &mut scratch.sums);
                let all = fine[0].hypot(fine[1]);
                for kind in 0..2 {
                    let (change, size) = ((fine[kind] - before[kind]).abs(), fine[kind].abs().max(before[kind].abs()));
                    note(part((fine[kind] - whole[kind]).abs(), change, size, absolute + ROUND_OFF * all));
                }
            }
        }
        self.scene.scratch.trial.sizes = fine;
        worst
    }

    fn unreachable_tolerance(&self, time: f64) -> Error {
        Error::Numbers {
            message: format!(
                "document '{}': no step of the fields and what stands beside them meets the tolerance at t = {} s",
                self.system.name(),
                short(time)
            ),
            help: "check the rates for values that grow without bound, or raise the tolerance".into(),
            kept: None,
        }
    }
}

/// What tables are worked out from.
fn now<'a>(system: &'a FieldSystem, fields: &'a Fields, inputs: &'a [f64]) -> Now<'a> {
    let (scales, ranges) = (system.scales(), system.ranges());
    Now { grid: &fields.grid, scales, time: fields.time, inputs, values: &fields.values, ranges }
}

/// The mean of values and how far they are from it.
fn sizes(values: &[f64], sums: &mut [PartSum]) -> [f64; 2] {
    let boxes = values.len();
    let mean = sum(boxes, sums, |part, _| values[part].iter().sum()) / boxes as f64;
    let square = sum(boxes, sums, |part, _| values[part].iter().map(|value| (value - mean) * (value - mean)).sum());
    [mean, (square / boxes as f64).sqrt()]
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
