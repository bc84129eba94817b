//! When noise kicks: a window of time is cut where it does, eq. (noise.2).

/// How often noise kicks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// Never: there is no noise.
    Never,
    /// At the begin of every window, for all of it.
    EachWindow,
    /// At 0, at this time, at twice this time and so on, wherever windows begin and end.
    Every(f64),
}

/// A kick of noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kick {
    /// How many there were before.
    pub number: u64,
    /// The time that it stands for.
    pub span: f64,
}

/// A part of a window: a kick where there is one, and then the equations without noise to the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Substep {
    /// When it begins.
    pub begin: f64,
    /// When it ends.
    pub end: f64,
    /// How long it is; 0 where there is a kick alone.
    pub length: f64,
    /// The kick at its begin.
    pub kick: Option<Kick>,
}

/// The parts of a window, one after the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Substeps {
    pace: Pace,
    kicks: u64,
    from: f64,
    at: f64,
    until: f64,
    length: f64,
}

/// A kick is due at a time, and a part of a window ends with it, when they are apart by less than this part of the pace.
const SLACK: f64 = 1e-6;

impl Substeps {
    /// A window that begins at a time, after so many kicks.
    pub fn new(pace: Pace, kicks: u64, from: f64, length: f64) -> Self {
        Self { pace, kicks, from, at: from, until: from + length, length }
    }

    /// A window from one time to another, after so many kicks.
    pub fn between(pace: Pace, kicks: u64, from: f64, until: f64) -> Self {
        Self { pace, kicks, from, at: from, until, length: until - from }
    }

    /// How many kicks there have been.
    pub fn kicks(&self) -> u64 {
        self.kicks
    }

    /// When the window begins.
    pub fn from(&self) -> f64 {
        self.from
    }

    /// When the window ends.
    pub fn until(&self) -> f64 {
        self.until
    }

    /// How many kicks there have been at the end of the window.
    pub fn kicks_at_end(mut self) -> u64 {
        while self.next().is_some() {}
        self.kicks
    }

    /// Whether a kick is due, and when the part ends.
    fn cut(&self) -> (Option<Kick>, f64) {
        match self.pace {
            Pace::Never => (None, self.until),
            Pace::EachWindow => (Some(Kick { number: self.kicks, span: self.length }), self.until),
            Pace::Every(span) => {
                let (slack, at) = (SLACK * span, |number: u64| number as f64 * span);
                let is_due = at(self.kicks) <= self.at + slack;
                let next = at(self.kicks + u64::from(is_due)).max(self.at);
                let end = if next < self.until - slack { next } else { self.until };
                (is_due.then_some(Kick { number: self.kicks, span }), end)
            }
        }
    }
}

impl Iterator for Substeps {
    type Item = Substep;

    fn next(&mut self) -> Option<Substep> {
        if self.at >= self.until {
            return None;
        }
        let (begin, (kick, end)) = (self.at, self.cut());
        let length = match (self.pace, kick) {
            // As it was given, so that round-off of the times does not matter.
            _ if begin == self.from && end == self.until => self.length,
            (Pace::Every(span), Some(_)) if (end - begin - span).abs() <= 2.0 * SLACK * span => span,
            _ => end - begin,
        };
        self.kicks += u64::from(kick.is_some());
        self.at = end;
        Some(Substep { begin, end, length, kick })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kicks_lie_on_one_grid_however_time_is_cut_into_windows() {
        let (span, until) = (0.1, 10.0);
        for lengths in [&[0.25][..], &[0.1], &[0.03, 0.4, 0.0701], &[10.0], &[0.2]] {
            let (mut time, mut kicks, mut found) = (0.0, 0, Vec::new());
            for length in lengths.iter().cycle() {
                let length = f64::min(*length, until - time);
                let mut parts = Substeps::new(Pace::Every(span), kicks, time, length);
                let mut whole = 0.0;
                for part in parts.by_ref() {
                    assert!(part.length > 0.0 && part.length <= span * (1.0 + 1e-9), "{part:?}");
                    whole += part.length;
                    found.extend(part.kick.map(|kick| (kick, part.begin)));
                }
                assert!((whole - length).abs() < 1e-12, "the parts make the window");
                kicks = parts.kicks();
                assert_eq!(Substeps::new(Pace::Every(span), found.len() as u64, time + length, 0.0).kicks(), kicks);
                time += length;
                if until - time < 1e-9 {
                    break;
                }
            }
            assert_eq!(found.len(), 100, "{lengths:?}");
            for (number, (kick, time)) in found.iter().enumerate() {
                assert_eq!(*kick, Kick { number: number as u64, span });
                assert!((time - span * number as f64).abs() < 1e-6 * span);
            }
        }
    }

    #[test]
    fn without_a_grid_each_window_has_a_kick_or_none() {
        let one = |pace| Substeps::new(pace, 4, 3.0, 0.7).collect::<Vec<_>>();
        let whole = Substep { begin: 3.0, end: 3.7, length: 0.7, kick: None };
        assert_eq!(one(Pace::Never), [whole]);
        assert_eq!(one(Pace::EachWindow), [Substep { kick: Some(Kick { number: 4, span: 0.7 }), ..whole }]);
        assert_eq!(Substeps::new(Pace::EachWindow, 4, 3.0, 0.7).kicks_at_end(), 5);
    }
}
