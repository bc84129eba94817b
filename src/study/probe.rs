//! How long runs will take, from a few seconds of some.

use crate::error::Result;
use crate::experiment::Document;
use crate::simulation::{Simulation, SimulationError};
use std::time::{Duration, Instant};

/// What a probe found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Seconds that a whole run takes on one thread in the mean, if they go on as they began.
    pub seconds: f64,
    /// The share of these runs that was made.
    pub share: f64,
}

/// Runs some experiments in memory, on one thread, together for about as long as `limit`. Nothing is written.
///
/// # Errors
/// As [`Simulation::from_document`], and when a step fails.
pub fn probe(documents: &[Document], limit: Duration) -> Result<Probe> {
    let number = documents.len().max(1) as u32;
    let each = documents.iter().map(|document| probe_one(document, limit / number)).collect::<Result<Vec<_>>>()?;
    let mean = |of: fn(&Probe) -> f64| each.iter().map(of).sum::<f64>() / f64::from(number);
    Ok(Probe { seconds: mean(|one| one.seconds), share: mean(|one| one.share) })
}

fn probe_one(document: &Document, limit: Duration) -> Result<Probe> {
    let began = Instant::now();
    let failed = |error: SimulationError| crate::error::Error::from(error);
    let mut simulation = Simulation::builder().threads(1).document(document).map_err(failed)?;
    let built = began.elapsed().as_secs_f64();
    let (start, end) = (simulation.time(), simulation.end());
    let began = Instant::now();
    while simulation.time() < end && began.elapsed() < limit {
        simulation.step().map_err(failed)?;
    }
    let share = ((simulation.time() - start) / (end - start)).clamp(1e-12, 1.0);
    Ok(Probe { seconds: built + began.elapsed().as_secs_f64() / share, share })
}

/// A duration for people: `40 s`, `12 min`, `3.5 h`, `2.1 days`.
pub fn told(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "less than 1 s".to_owned(),
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 5_400.0 => format!("{:.0} min", s / 60.0),
        s if s < 129_600.0 => format!("{:.1} h", s / 3_600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::told;

    #[test]
    fn durations_are_told_in_the_unit_that_suits_them() {
        assert_eq!(
            [0.2, 40.0, 720.0, 12_600.0, 181_440.0].map(told),
            ["less than 1 s", "40 s", "12 min", "3.5 h", "2.1 days"]
        );
    }
}
