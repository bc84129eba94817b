//! When the clock next switches something, eq. (ode.9): steps end before that and begin after it.

use super::events::{COUNTS, DIFFERENCES};
use super::stepper::Stepper;

/// A time at which the clock switches something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Switch {
    /// The last time at which all is as before.
    pub before: f64,
    /// The time itself.
    pub at: f64,
    /// The first time at which all is as after it.
    pub after: f64,
}

/// What is known of what comes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead {
    /// The next switch; at no time if none is known.
    pub switch: Switch,
    /// Until when there is no other one; after that it is to be asked again.
    pub seen: f64,
}

impl Switch {
    const NEVER: Self = Self { before: f64::INFINITY, at: f64::INFINITY, after: f64::INFINITY };
}

/// How often it is looked in a single solve at what does not run evenly.
pub const LOOKS_IN_SOLVE: usize = 4096;
/// The same in a window of a run.
pub const LOOKS_IN_WINDOW: usize = 64;
/// It is looked ahead for so many of these at once.
const AHEAD: usize = 64;
/// By how many of its last bits a time is passed on either side.
const LAST_BITS: f64 = 4.0;

/// What is found of the switches of a course.
#[derive(Debug, Default)]
pub struct Switches {
    until: f64,
    /// Between two looks at what does not run evenly.
    spacing: f64,
    /// Until when that was looked at, and the switch that was found there.
    seen: f64,
    uneven: Option<Switch>,
    /// When the switch is that was told last, and that of them which has been passed.
    told: f64,
    passed: f64,
    /// The state, and what switches at three times.
    present: Vec<f64>,
    values: [Vec<f64>; 3],
    /// Which differences, and then which counts, do not run evenly, and how those stand at two times.
    are_uneven: Vec<bool>,
    stands: [Vec<f64>; 2],
    read: Vec<f64>,
}

impl Switches {
    /// Begins a course of a stepper until a time, in which it is looked so often at what does not run evenly.
    pub fn begin(&mut self, stepper: &Stepper, until: f64, looks: usize) {
        let groups = [DIFFERENCES, COUNTS].map(|group| stepper.program.further[group].outputs.len());
        self.are_uneven.clear();
        self.are_uneven.resize(groups[0] + groups[1], false);
        (self.until, self.seen, self.uneven) = (until, f64::NEG_INFINITY, None);
        (self.told, self.passed) = (f64::INFINITY, f64::NEG_INFINITY);
        self.spacing = (until - stepper.time) / looks as f64;
    }

    /// Whether the clock may switch anything at all.
    pub fn are_any(&self) -> bool {
        !self.are_uneven.is_empty()
    }

    /// Whether something switches at the stepper's present itself: whether all stands a little later as it does now.
    pub fn are_at_present(&mut self, stepper: &mut Stepper) -> bool {
        if !self.are_any() {
            return false;
        }
        stepper.state_into(&mut self.present);
        self.are_uneven.fill(true);
        let times = [stepper.time, after(stepper.time, self.until)];
        times.into_iter().zip(0..).for_each(|(time, which)| self.stand_at(stepper, time, which));
        self.stands[0] != self.stands[1]
    }

    /// Forgets what was found, since parameters have been set.
    pub fn forget(&mut self) {
        (self.seen, self.uneven) = (f64::NEG_INFINITY, None);
    }

    /// The next after the stepper's present.
    pub fn next(&mut self, stepper: &mut Stepper) -> Ahead {
        if !self.are_any() {
            return Ahead { switch: Switch::NEVER, seen: f64::INFINITY };
        }
        let time = stepper.time;
        if time >= self.told {
            self.passed = self.told;
        }
        let whole = (self.until - time).max(1e-3 * self.until.abs());
        stepper.state_into(&mut self.present);
        // Where counts jump, differences may.
        let counted = self.next_even(stepper, COUNTS, (time, whole));
        let piece = if counted < time + whole { before(counted) - time } else { whole };
        let next = counted.min(self.next_even(stepper, DIFFERENCES, (time, piece)));
        let switch = Switch { before: before(next), at: next, after: after(next, self.until) };
        let ahead = match self.are_uneven.contains(&true) {
            true => self.look_ahead(stepper, switch),
            false => Ahead { switch, seen: f64::INFINITY },
        };
        self.told = ahead.switch.at;
        ahead
    }

    /// The next of a group that runs evenly in a time of some length: where a difference is nothing, or a count a whole number. Takes note of
    /// which do not.
    fn next_even(&mut self, stepper: &mut Stepper, group: usize, (time, length): (f64, f64)) -> f64 {
        let code = &stepper.program.further[group];
        let first = if group == COUNTS { stepper.program.further[DIFFERENCES].outputs.len() } else { 0 };
        if code.outputs.is_empty() {
            return f64::INFINITY;
        }
        for (share, values) in [0.0, 0.5, 1.0].into_iter().zip(&mut self.values) {
            stepper.evaluate(code, time + share * length, &self.present, values);
        }
        let [now, half, end] = &self.values;
        // The one that has been passed comes out again a little later by round-off.
        let is_new = |root: f64| root > time && (root - self.passed).abs() > 16.0 * f64::EPSILON * root.abs();
        let mut next = f64::INFINITY;
        for (number, ((&now, &half), &end)) in now.iter().zip(half).zip(end).enumerate() {
            let (slope, size) = ((end - now) / length, now.abs().max(end.abs()));
            // What time itself is rounded by may be more than what it is of a difference.
            let rounding = 16.0 * f64::EPSILON * (time + length).abs().max(time.abs()) * slope.abs();
            let is_even = (half - 0.5 * (now + end)).abs() <= 1e-12 * size + rounding;
            self.are_uneven[first + number] = !is_even;
            if !is_even || slope == 0.0 {
                continue;
            }
            let root = |value: f64| time + (value - now) / slope;
            let root = match group {
                // One that is passed may be a whole number but for round-off.
                COUNTS if slope > 0.0 => [1.0, 2.0].map(|more| root(now.floor() + more)),
                COUNTS => [1.0, 2.0].map(|less| root(now.ceil() - less)),
                _ => [root(0.0), f64::INFINITY],
            };
            let is_seen = |root: &f64| is_new(*root) && (group == COUNTS || *root <= time + length * (1.0 + 1e-12));
            next = root.into_iter().filter(is_seen).map(nice).fold(next, f64::min);
        }
        next
    }

    /// Looks for a switch of what does not run evenly, as far as the next of what does, and some way ahead.
    fn look_ahead(&mut self, stepper: &mut Stepper, other: Switch) -> Ahead {
        let time = stepper.time;
        let end = (time + AHEAD as f64 * self.spacing).min(self.until).min(other.before);
        if self.uneven.is_none_or(|known| known.before <= time) && self.seen < end {
            let mut high = time;
            self.uneven = None;
            self.stand_at(stepper, time, 0);
            while high < end && self.uneven.is_none() {
                let low = high;
                high = (low + self.spacing).min(end);
                self.stand_at(stepper, high, 1);
                if self.stands[0] != self.stands[1] {
                    self.uneven = Some(self.close_in(stepper, low, high));
                }
            }
            self.seen = high;
        }
        match self.uneven.filter(|known| time < known.before && known.at < other.at) {
            Some(switch) => Ahead { switch, seen: self.seen },
            None if self.seen >= other.before => Ahead { switch: other, seen: f64::INFINITY },
            None => Ahead { switch: other, seen: self.seen.max(time + self.spacing).min(other.at) },
        }
    }

    /// The switch between two times, the first of which stands as 0.
    fn close_in(&mut self, stepper: &mut Stepper, mut low: f64, mut high: f64) -> Switch {
        let close = |high: f64| LAST_BITS * f64::EPSILON * high.abs();
        while high - low > close(high) {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            self.stand_at(stepper, middle, 1);
            if self.stands[0] == self.stands[1] {
                low = middle;
            } else {
                high = middle;
            }
        }
        Switch { before: low, at: high, after: after(high, self.until) }
    }

    /// How what does not run evenly stands at a time: the signs of differences and the whole numbers around counts.
    fn stand_at(&mut self, stepper: &mut Stepper, time: f64, which: usize) {
        let Self { present, read, are_uneven, stands, .. } = self;
        let (stands, mut uneven) = (&mut stands[which], are_uneven.iter());
        stands.clear();
        for group in [DIFFERENCES, COUNTS] {
            stepper.evaluate(&stepper.program.further[group], time, present, read);
            let read = read.iter().zip(uneven.by_ref()).filter(|(_, uneven)| **uneven).map(|(value, _)| *value);
            let sign = |value: f64| if value == 0.0 { 0.0 } else { value.signum() };
            match group {
                COUNTS => stands.extend(read.map(|value| value.floor() + value.ceil())),
                _ => stands.extend(read.map(sign)),
            }
        }
    }
}

/// A time a few last bits before another.
fn before(time: f64) -> f64 {
    time - LAST_BITS * f64::EPSILON * time.abs()
}

/// A time a few last bits after another, in a course that ends at a time.
pub fn after(time: f64, until: f64) -> f64 {
    time + 2.0 * LAST_BITS * f64::EPSILON * time.abs().max(1e-3 * until.abs())
}

/// The number of few digits within round-off of a time, if there is one: 0.3 for 0.30000000000000004.
fn nice(time: f64) -> f64 {
    let scale = 10_f64.powi(12 - time.abs().log10().ceil() as i32);
    let rounded = (time * scale).round() / scale;
    if (rounded - time).abs() <= 8.0 * f64::EPSILON * time.abs() { rounded } else { time }
}
