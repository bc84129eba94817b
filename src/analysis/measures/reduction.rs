//! How the values at several instants become one.

use super::declared::Declared;
use crate::analysis::statistics;
use crate::error::{Error, Fault, Result};
use crate::units::{Time, UnitError, Written};
use crate::values::words_or_time;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Two times are the same when they differ by at most this share: the round-off of millions of steps.
const ROUND_OFF: f64 = 1e-9;

/// How the values at several instants become one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "String")]
pub enum Reduction {
    /// The value in the last frame.
    #[default]
    Last,
    /// The value in the first frame.
    First,
    /// The mean over all frames.
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The largest less the smallest.
    Range,
    /// The value at this time, between frames on a straight line.
    At(Time),
}

const REDUCTIONS: [(&str, Reduction); 6] = [
    ("last", Reduction::Last),
    ("first", Reduction::First),
    ("mean", Reduction::Mean),
    ("min", Reduction::Min),
    ("max", Reduction::Max),
    ("range", Reduction::Range),
];

impl Reduction {
    /// Notes a fault if the instant lies outside of the run.
    pub(super) fn check(self, at: &mut dyn Declared) {
        if let Self::At(time) = self {
            at.instant("time", time);
        }
    }

    /// Makes one of the values at several times (s).
    ///
    /// # Errors
    /// When there is no value, or the instant lies outside of the times.
    pub fn reduce(self, times: &[f64], values: &[f64]) -> Result<f64> {
        let (Some(first), Some(last)) = (values.first(), values.last()) else {
            let fault = Fault::new("the run has no frames to measure");
            return Err(Error::input(fault.help("let the run record at least one frame")));
        };
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        match self {
            Self::Last => Ok(*last),
            Self::First => Ok(*first),
            Self::Mean => Ok(statistics::mean(values)),
            Self::Min => Ok(least),
            Self::Max => Ok(most),
            Self::Range => Ok(most - least),
            Self::At(time) => at(time, times, values),
        }
    }

    /// The frames that it looks at, so that no others need be read.
    ///
    /// # Errors
    /// When the instant lies outside of the times.
    pub fn frames(self, times: &[f64]) -> Result<Range<usize>> {
        let last = times.len().saturating_sub(1);
        Ok(match self {
            Self::First => 0..times.len().min(1),
            Self::Last => last..times.len(),
            Self::At(wanted) if !times.is_empty() => {
                let near = at(wanted, times, times)?;
                let after = times.partition_point(|time| *time < near).min(last);
                // A frame more on either side: the time may be meant to be that of a frame.
                after.saturating_sub(1)..(after + 2).min(times.len())
            }
            _ => 0..times.len(),
        })
    }
}

/// The value at a time, between frames on a straight line.
fn at(time: Time, times: &[f64], values: &[f64]) -> Result<f64> {
    let (from, to) = (times[0], times[times.len() - 1]);
    // Steps add up to a duration only to some digits: a time that is meant to be that of the last frame is.
    let slack = ROUND_OFF * from.abs().max(to.abs());
    let wanted = time.value();
    let near = if from - slack <= wanted && wanted <= to + slack { wanted.clamp(from, to) } else { wanted };
    statistics::interpolate(times, values, near).ok_or_else(|| {
        let fault = Fault::new(format!("nothing was recorded at {time}"));
        Error::input(fault.help(format!("give a time from {from} s to {to} s")))
    })
}

impl FromStr for Reduction {
    type Err = UnitError;
    fn from_str(text: &str) -> std::result::Result<Self, UnitError> {
        let word = REDUCTIONS.iter().find(|(word, _)| *word == text);
        word.map_or_else(|| text.parse().map(Self::At), |(_, reduction)| Ok(*reduction))
    }
}

impl fmt::Display for Reduction {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self, REDUCTIONS.iter().find(|(_, reduction)| reduction == self)) {
            (Self::At(time), _) => time.fmt(f),
            (_, word) => f.write_str(word.map_or("last", |(word, _)| word)),
        }
    }
}

impl TryFrom<Written> for Reduction {
    type Error = UnitError;
    fn try_from(written: Written) -> std::result::Result<Self, UnitError> {
        written.0.parse()
    }
}

impl From<Reduction> for String {
    fn from(reduction: Reduction) -> Self {
        reduction.to_string()
    }
}

impl JsonSchema for Reduction {
    fn schema_name() -> Cow<'static, str> {
        "reduction".into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        words_or_time(&REDUCTIONS.map(|(word, _)| word))
    }
}
