//! When a run records.

use super::super::Document;
use super::steps::HUNDREDTH;

/// The part of a time that clocks which add many steps cannot tell from it.
const SLACK: f64 = 1e-12;

/// When the run records. It always does where it starts and where it ends.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Schedule {
    /// Simulated time between frames, s; none where frames have times of their own only.
    pub every: Option<f64>,
    /// Times of frames, s, rising.
    pub times: Vec<f64>,
    /// Simulated time between checkpoints, s.
    pub checkpoint: f64,
    /// Whether the force on every atom is recorded.
    pub forces: bool,
}

/// What a document asks for.
pub fn schedule(document: &Document) -> Schedule {
    let (output, until) = (&document.experiment.output, document.experiment.run.until.value());
    let mut times: Vec<f64> = output.times.iter().map(|time| time.value()).collect();
    times.sort_by(f64::total_cmp);
    let usual = times.is_empty().then_some(HUNDREDTH * until);
    let checkpoint = output.checkpoint.map_or(0.1 * until, |checkpoint| checkpoint.value());
    Schedule { every: output.every.map(|every| every.value()).or(usual), times, checkpoint, forces: output.forces }
}

impl Schedule {
    /// The times in (before, after] that have a frame, rising, those included that `after` misses by round-off alone. Nothing is allocated where
    /// there is none.
    pub fn due(&self, before: f64, after: f64) -> Vec<f64> {
        let mut due = Vec::new();
        if let Some(every) = self.every {
            let passed = |time: f64| (time / every * (1.0 + SLACK)).floor();
            let (mut number, last) = (passed(before) + 1.0, passed(after));
            while number <= last {
                due.push(number * every);
                number += 1.0;
            }
        }
        let later = |bound: f64| self.times.partition_point(|time| *time <= bound * (1.0 + SLACK));
        due.extend(&self.times[later(before)..later(after)]);
        due.sort_by(f64::total_cmp);
        due.dedup_by(|one, other| (*one - *other).abs() <= SLACK * after);
        due
    }

    /// Whether a time at which a frame is due is, but for round-off, the one at which a step ended.
    pub fn is_end(time: f64, after: f64) -> bool {
        time >= after * (1.0 - SLACK)
    }

    /// How many frames a run of this duration (s) has, its start and its end included.
    pub fn frames(&self, until: f64) -> f64 {
        let regular = self.every.map_or(0.0, |every| (until / every * (1.0 - SLACK)).floor());
        2.0 + regular + self.times.iter().filter(|time| **time > 0.0 && **time < until).count() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(every: Option<f64>, times: &[f64]) -> Schedule {
        Schedule { every, times: times.to_vec(), ..Schedule::default() }
    }

    #[test]
    fn frames_are_due_once_at_multiples_and_at_times_of_their_own() {
        let both = of(Some(0.5), &[0.2, 0.5, 0.7]);
        assert!(both.due(0.0, 0.19).is_empty());
        assert_eq!(both.due(0.19, 0.6), [0.2, 0.5]);
        assert_eq!(both.due(0.6, 1.75), [0.7, 1.0, 1.5], "a step may be longer than the time between frames");
        assert!(of(None, &[3.0]).due(0.0, 2.0).is_empty());
        assert_eq!(both.frames(1.0), 2.0 + 1.0 + 3.0, "the one at 0.5 s is counted twice: it is an estimate");
        assert_eq!(of(Some(0.5), &[]).frames(1.0), 3.0);
    }

    #[test]
    fn a_clock_that_adds_steps_has_each_frame_once_and_where_a_step_ends() {
        let (schedule, step) = (of(Some(0.1), &[]), 0.02);
        let (mut time, mut due) = (0.0, Vec::new());
        for _ in 0..50_000 {
            let before = time;
            time += step;
            for frame in schedule.due(before, time) {
                assert!(Schedule::is_end(frame, time), "no frame is within a step by round-off alone: {frame} {time}");
                due.push(frame);
            }
        }
        assert_eq!(due.len(), 10_000);
    }
}
