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
    /// The times in (before, after] that have a frame, rising, those included that `after` misses by round-off alone. None is held beside the next:
    /// a step may have millions.
    pub fn due(&self, before: f64, after: f64) -> impl Iterator<Item = f64> + '_ {
        let every = self.every.unwrap_or(f64::INFINITY);
        let passed = |time: f64| (time / every * (1.0 + SLACK)).floor();
        let (mut number, last) = (passed(before) + 1.0, passed(after));
        let later = |bound: f64| self.times.partition_point(|time| *time <= bound * (1.0 + SLACK));
        let mut own = self.times[later(before)..later(after)].iter().copied().peekable();
        let mut told = f64::NEG_INFINITY;
        let next = move || {
            let regular = (number <= last).then_some(number * every);
            let is_own = own.peek().is_some_and(|own| regular.is_none_or(|regular| *own < regular));
            if is_own {
                return own.next();
            }
            number += 1.0;
            regular
        };
        std::iter::from_fn(next).filter(move |time| {
            let is_new = *time - told > SLACK * after;
            told = if is_new { *time } else { told };
            is_new
        })
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
        let due = |schedule: &Schedule, before: f64, after: f64| schedule.due(before, after).collect::<Vec<f64>>();
        assert!(due(&both, 0.0, 0.19).is_empty());
        assert_eq!(due(&both, 0.19, 0.6), [0.2, 0.5]);
        assert_eq!(due(&both, 0.6, 1.75), [0.7, 1.0, 1.5], "a step may be longer than the time between frames");
        assert!(due(&of(None, &[3.0]), 0.0, 2.0).is_empty());
        assert_eq!(due(&of(None, &[1.0, 1.0, 2.0]), 0.0, 3.0), [1.0, 2.0], "a time that is given twice has one frame");
        let first: Vec<f64> = of(Some(1e-9), &[0.5]).due(0.0, 1.0).take(3).collect();
        assert_eq!(first, [1e-9, 2.0 * 1e-9, 3.0 * 1e-9], "of a thousand million");
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
