//! When something happened at once, and when that is met again by looking back at it.
//!
//! Where a variable or its rate jumps, a delay τ later what looks back at it does, its rate another τ later, and so on: each time one
//! derivative higher. Steps end exactly at these times, until the method no longer sees it, eq. (ode.7).

use std::collections::VecDeque;

/// Times closer than this share of them are one.
const NEAR: f64 = 16.0 * f64::EPSILON;

/// The times that steps must not cross.
#[derive(Debug, Default)]
pub struct Marks {
    /// The constant delays by which rates and triggers look back.
    lags: Vec<f64>,
    /// How many delays later a jump is still met.
    most: u32,
    /// The start, jumps and what followed from them, ascending.
    passed: VecDeque<f64>,
    /// What is still to be met, ascending, with the number of delays since the jump.
    coming: VecDeque<(f64, u32)>,
    /// Whether anything looks back.
    is_used: bool,
}

impl Marks {
    /// No marks yet, for delays and a method of an order.
    pub fn new(lags: Vec<f64>, order: u32) -> Self {
        Self { lags, most: order + 1, is_used: true, ..Self::default() }
    }

    /// Begins anew at the start, which is a mark itself.
    pub fn start(&mut self, time: f64) {
        self.passed.clear();
        self.coming.clear();
        self.jump(time);
    }

    /// The next time to be met exactly; infinite where there is none.
    pub fn next(&self) -> f64 {
        self.coming.front().map_or(f64::INFINITY, |(time, _)| *time)
    }

    /// Something happens at once.
    pub fn jump(&mut self, time: f64) {
        if self.is_used {
            self.reach(time);
            self.add(time, 0);
        }
    }

    /// A mark is met.
    pub fn pass(&mut self, time: f64) {
        if let Some(level) = self.reach(time) {
            self.add(time, level);
        }
    }

    /// Whether a time is a mark that has been met.
    pub fn is_at(&self, time: f64) -> bool {
        self.passed.back().is_some_and(|last| *last == time)
    }

    /// Forgets marks before a time.
    pub fn forget_before(&mut self, time: f64) {
        while self.passed.get(1).is_some_and(|second| *second <= time) {
            self.passed.pop_front();
        }
    }

    /// An earlier time on the right side of marks that are within round-off: before and after these things differ. `middle` lies in the
    /// middle of what is looked back at within a step; without a step a mark has been met.
    pub fn settled(&self, time: f64, middle: Option<f64>, now: f64) -> f64 {
        let near = NEAR * now.abs().max(time.abs());
        let after = self.passed.partition_point(|mark| *mark <= middle.unwrap_or(time + near));
        let (lower, upper) = (after.checked_sub(1).and_then(|at| self.passed.get(at)), self.passed.get(after));
        match (lower, upper) {
            (Some(&lower), _) if time < lower && lower - time <= near => lower,
            (_, Some(&upper)) if time >= upper && time - upper <= near => upper.next_down(),
            _ => time,
        }
    }

    /// Takes away what is met by a time; returns the smallest number of delays since its jump.
    fn reach(&mut self, time: f64) -> Option<u32> {
        let mut met = None;
        while self.coming.front().is_some_and(|(next, _)| *next <= time + NEAR * time.abs()) {
            let level = self.coming.pop_front().map(|(_, level)| level);
            met = met.map_or(level, |known: u32| level.map(|level| level.min(known)));
        }
        met
    }

    fn add(&mut self, time: f64, level: u32) {
        if !self.is_at(time) {
            self.passed.push_back(time);
        }
        if level >= self.most {
            return;
        }
        for lag in 0..self.lags.len() {
            let (then, level) = (time + self.lags[lag], level + 1);
            let at = self.coming.partition_point(|(known, _)| *known < then);
            let near = NEAR * then.abs().max(time.abs());
            let same = [at.checked_sub(1), Some(at)].into_iter().flatten();
            let mut same =
                same.filter(|&at| self.coming.get(at).is_some_and(|(known, _)| (known - then).abs() <= near));
            match same.next() {
                Some(known) => self.coming[known].1 = self.coming[known].1.min(level),
                None => self.coming.insert(at, (then, level)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_is_met_again_after_each_delay_until_the_method_no_longer_sees_it() {
        let mut marks = Marks::new(vec![1.0, 2.5], 1);
        marks.start(0.0);
        let mut met = Vec::new();
        while marks.next().is_finite() {
            met.push(marks.next());
            marks.pass(marks.next());
        }
        assert_eq!(met, [1.0, 2.0, 2.5, 3.5, 5.0]);
    }

    #[test]
    fn round_off_does_not_change_sides() {
        let mut marks = Marks::new(vec![0.1], 4);
        marks.start(0.3);
        // 0.4 − 0.1 is above 0.3 in the last place, 0.3 + 0.1 − 0.1 may be below.
        let (begin, end) = (0.3_f64 + 0.1 - 0.1, 0.3_f64.next_down());
        assert_eq!(marks.settled(begin.min(end), Some(0.31), 0.4), 0.3);
        assert!(marks.settled(0.3, Some(0.29), 0.4) < 0.3);
        assert_eq!(marks.settled(0.3_f64.next_down(), None, 0.4), 0.3);
        assert_eq!(marks.settled(0.2, Some(0.31), 0.4), 0.2, "what is not near stays");
    }
}
