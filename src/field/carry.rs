//! A step of transport: Runge and Kutta's of order 3 that keeps values from going below zero, or one of order 2 whose stages reach far where
//! much spreads (Meyer, Balsara and Aslam 2014).

use super::fluxes::{PARTS, PartOfFluxes, Speeds, rates};
use super::grid::Grid;
use super::tables::Now;
use super::transport::Transport;
use crate::equations::Range;

/// Part of a box that flows pass at most in a step of many stages, which lie close to the axis of what spreads.
const COURANT: f64 = 0.4;
/// Part of the longest step that leaves nothing below zero that is taken: flows may become faster within it.
const SLACK: f64 = 0.8;
/// Parts of the largest value below zero that count as round-off.
const SPECK: f64 = 1e-20;
/// Most steps of transport within a step of the splitting: more say that something grows without bound.
const MOST: u32 = 200_000;
/// Most steps within a window, by the speed at its begin: more take hours on any grid.
pub const MOST_IN_WINDOW: f64 = 1e8;
/// Most stages of a step.
const MOST_STAGES: f64 = 400.0;

/// What transport works in: it says nothing about the fields.
#[derive(Debug, Clone, Default)]
pub struct CarryScratch {
    tables: Vec<Vec<f64>>,
    parts: Vec<PartOfFluxes>,
    /// The values at the start of a step and those of earlier stages; the rates at the start and of a stage.
    start: Vec<f64>,
    before: Vec<f64>,
    stage: Vec<f64>,
    first_rates: Vec<f64>,
    rates: Vec<f64>,
    /// How many boxes a flow passes in a second, or shares of what boxes hold leave them, where that is too fast for the window.
    pub too_fast: Option<f64>,
}

impl CarryScratch {
    /// Makes it fit, once.
    fn suit(&mut self, transport: &Transport, len: usize) {
        if self.start.len() != len {
            self.tables = transport.still.clone();
            self.parts = vec![PartOfFluxes::default(); PARTS];
            for list in [&mut self.start, &mut self.before, &mut self.stage, &mut self.first_rates, &mut self.rates] {
                *list = vec![0.0; len];
            }
        }
    }

    /// Forgets everything.
    pub fn poison(&mut self) {
        *self = Self::default();
    }
}

/// Transport with the inputs that stand still within a window.
#[derive(Clone, Copy)]
pub struct Carrying<'a> {
    pub transport: &'a Transport,
    pub inputs: &'a [f64],
    /// How long the window is, s.
    pub window: f64,
}

impl Carrying<'_> {
    /// Moves the carried species by a step from a time on, s. Values that fail become NaN, to be found.
    pub fn advance(&self, grid: &Grid, scratch: &mut CarryScratch, values: &mut [f64], time: f64, step: f64) {
        scratch.suit(self.transport, values.len());
        let mut course = Course { carrying: *self, grid, scratch, values };
        let mut done = 0.0;
        for _ in 0..MOST {
            let left = step - done;
            let speeds = course.first(time + done);
            let small = SLACK / speeds.losing.max(f64::MIN_POSITIVE);
            if !(small.is_finite() || speeds.losing == 0.0) || speeds.losing.is_nan() {
                break;
            }
            let longest = small.max(COURANT / speeds.passing.max(f64::MIN_POSITIVE));
            if self.window > MOST_IN_WINDOW * longest {
                course.scratch.too_fast = Some(speeds.losing.min(speeds.passing));
                break;
            }
            // In pieces of one length, so that a little is not left at the end.
            let equal = |longest: f64| if left <= longest { left } else { left / (left / longest).ceil() };
            let far = equal(COURANT / speeds.passing.max(f64::MIN_POSITIVE));
            let reach = |step: f64| 0.5 * ((9.0 + 8.0 * step * (speeds.spreading + 2.0 * speeds.passing)).sqrt() - 1.0);
            let far = if reach(far) > MOST_STAGES { far * (MOST_STAGES / reach(far)).powi(2) } else { far };
            let stages = reach(far).ceil().max(3.0);
            let near = equal(small);
            // The one that works out fewer rates on the same path.
            let length = if 3.0 / near <= stages / far {
                course.three(time + done, near);
                near
            } else if course.many(time + done, far, stages as u32) {
                far
            } else {
                let mut gone = 0.0;
                course.values.copy_from_slice(&course.scratch.start);
                let mut speeds = course.first(time + done);
                for _ in 0..MOST {
                    let left = far - gone;
                    let longest = SLACK / speeds.losing;
                    if longest.is_nan() || left <= longest {
                        course.three(time + done + gone, left);
                        break;
                    }
                    let length = left / (left / longest).ceil();
                    course.three(time + done + gone, length);
                    gone += length;
                    speeds = course.first(time + done + gone);
                }
                far
            };
            done += length;
            if length >= left {
                return;
            }
        }
        values.fill(f64::NAN);
    }
}

/// A step of transport under way.
struct Course<'a> {
    carrying: Carrying<'a>,
    grid: &'a Grid,
    scratch: &'a mut CarryScratch,
    values: &'a mut [f64],
}

impl Course<'_> {
    /// Works out the rates at the values.
    fn first(&mut self, time: f64) -> Speeds {
        let Self { carrying: Carrying { transport, inputs, .. }, grid, scratch, values } = self;
        let CarryScratch { tables, parts, start, first_rates, .. } = &mut **scratch;
        start.copy_from_slice(values);
        let now = Now { grid, scales: transport.scales, time, inputs, values: start, ranges: &transport.ranges };
        rates(transport, &now, tables, parts, first_rates)
    }

    /// Works out the rates at the values within a step.
    fn again(&mut self, time: f64) {
        let Self { carrying: Carrying { transport, inputs, .. }, grid, scratch, values } = self;
        let CarryScratch { tables, parts, rates: to, .. } = &mut **scratch;
        let now = Now { grid, scales: transport.scales, time, inputs, values, ranges: &transport.ranges };
        rates(transport, &now, tables, parts, to);
    }

    /// Sets the values of all carried boxes by a rule for their numbers.
    fn each(&mut self, rule: impl Fn(&CarryScratch, usize, f64) -> f64) {
        let len = self.grid.len();
        for carried in &self.carrying.transport.carried {
            for at in carried.species * len..(carried.species + 1) * len {
                self.values[at] = rule(self.scratch, at, self.values[at]);
            }
        }
    }

    /// A step of Shu and Osher's method of order 3, whose stages are means of steps of Euler's rule, from the rates at its start. What falls below
    /// zero at a sink that takes more than there is becomes zero.
    fn three(&mut self, time: f64, step: f64) {
        let floors = |course: &mut Self| course.floors(f64::NEG_INFINITY);
        self.each(|s, at, _| s.start[at] + step * s.first_rates[at]);
        floors(self);
        self.again(time + step);
        self.each(|s, at, value| 0.75 * s.start[at] + 0.25 * (value + step * s.rates[at]));
        floors(self);
        self.again(time + 0.5 * step);
        self.each(|s, at, value| (s.start[at] + 2.0 * (value + step * s.rates[at])) / 3.0);
        floors(self);
    }

    /// A step of so many stages from the rates at its start, eq. (field.20). Whether no value is below zero that may not be.
    fn many(&mut self, time: f64, step: f64, stages: u32) -> bool {
        let of = |j: u32| if j < 2 { 1.0 / 3.0 } else { f64::from(j * j + j - 2) / f64::from(2 * j * (j + 1)) };
        let scale = 4.0 / f64::from(stages * stages + stages - 2);
        self.scratch.before.copy_from_slice(&self.scratch.start);
        let first = of(1) * scale;
        self.each(|s, at, _| s.start[at] + first * step * s.first_rates[at]);
        for j in 2..=stages {
            let reached = if j == 2 {
                first
            } else {
                f64::from((j - 1) * (j - 1) + j - 3) / f64::from(stages * stages + stages - 2)
            };
            self.again(time + reached * step);
            let index = f64::from(j);
            let a = (2.0 * index - 1.0) / index * of(j) / of(j - 1);
            let b = -(index - 1.0) / index * of(j) / of(j - 2);
            let (rate, begin) = (a * scale, -(1.0 - of(j - 1)) * a * scale);
            self.scratch.stage.copy_from_slice(self.values);
            self.each(|s, at, value| {
                // Differences from the start, so that what stands still stays to the last bit.
                let start = s.start[at];
                start
                    + (a * (value - start) + b * (s.before[at] - start))
                    + step * (rate * s.rates[at] + begin * s.first_rates[at])
            });
            let CarryScratch { before, stage, .. } = &mut *self.scratch;
            std::mem::swap(before, stage);
        }
        self.floors(SPECK)
    }

    /// Sets values below zero that may not be to zero, where they are no larger than a part of the largest value; whether none is left.
    fn floors(&mut self, part: f64) -> bool {
        let (len, mut fine) = (self.grid.len(), true);
        let transport = self.carrying.transport;
        for carried in transport.carried.iter().filter(|c| transport.ranges[c.species] == Range::NonNegative) {
            let values = &mut self.values[carried.species * len..(carried.species + 1) * len];
            let least = values.iter().copied().fold(0.0, f64::min);
            if least >= 0.0 {
                continue;
            }
            let most = values.iter().copied().fold(0.0, f64::max);
            if part != f64::NEG_INFINITY && least < -part * most {
                fine = false;
                continue;
            }
            values.iter_mut().filter(|value| **value < 0.0).for_each(|value| *value = 0.0);
        }
        fine
    }
}
