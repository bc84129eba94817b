//! Whether durations of runs of motility are those of an exponential law.

use crate::analysis::recording::Recording;
use crate::analysis::statistics;
use crate::error::{Error, Fault, Result};
use crate::units::Time;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whether durations of runs of motility are those of an exponential law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct RunLength {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Mean duration of a run.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub persistence: Time,
}

impl RunLength {
    /// Probability of durations of runs at least as unlike the exponential law as these, eq. (analysis.9).
    ///
    /// Runs that begin near the end of a recording are seen only when they are short. So only those are taken that begin
    /// earlier than the longest duration kept before the end, and they are held against the law cut at that duration.
    ///
    /// # Errors
    /// When there is no such type or cell, or no run ended.
    pub(super) fn evaluate(&self, recording: &Recording) -> Result<f64> {
        let persistence = self.persistence.value();
        let cells = recording.cells_of(self.cells.as_deref())?;
        let (first, last) = match (recording.times.first(), recording.times.last()) {
            (Some(first), Some(last)) => (*first, *last),
            _ => (0.0, 0.0),
        };
        let longest = (10.0 * persistence).min(0.5 * (last - first));
        let durations: Vec<f64> = recording
            .runs
            .iter()
            .filter(|(cell, end, duration)| {
                cells.binary_search(cell).is_ok() && *duration <= longest && end - duration <= last - longest
            })
            .map(|(_, _, duration)| *duration)
            .collect();
        if durations.is_empty() {
            let fault = Fault::new("no run of motility ended that could be compared with the exponential law");
            return Err(Error::input(
                fault.help("give the cells motility and let them wander for several persistence times"),
            ));
        }
        let whole = -(-longest / persistence).exp_m1();
        let law = |duration: f64| -(-duration / persistence).exp_m1() / whole;
        Ok(statistics::kolmogorov_smirnov(&durations, law)?.p_value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::measures::MeasureKind;
    use crate::analysis::measures::test_recordings::{PERSISTENCE, evaluate, walkers};

    #[test]
    fn runs_cut_by_the_end_do_not_bias_their_law() {
        // A short recording, of which the plain comparison of all runs that ended would be wrong.
        let mut recording = walkers(2_000);
        recording.times.truncate(17);
        let last = recording.times[16];
        recording.runs.retain(|(_, end, _)| *end <= last);
        let p = |persistence| {
            let persistence = Time::new(persistence);
            evaluate(&MeasureKind::RunLengthP(RunLength { cells: None, persistence }), &recording).unwrap()
        };
        assert!(p(PERSISTENCE) > 0.01);
        assert!(p(1.2 * PERSISTENCE) < 1e-4);
        let all: Vec<f64> = recording.runs.iter().map(|run| run.2).collect();
        let plain = statistics::kolmogorov_smirnov(&all, |duration| -(-duration / PERSISTENCE).exp_m1()).unwrap();
        assert!(plain.p_value < 1e-4, "{plain:?}");
    }
}
