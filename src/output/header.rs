//! Where a result comes from: the experiment's text, the program that ran it, and the numbers it was asked for.

use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::elementary::{FNV_START, fnv1a};

/// What identifies a run. It is written once, when the file is made, and is the same on every machine but for
/// [`Header::started`].
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Header {
    /// Name of the experiment document as the user gave it.
    pub document: String,
    /// Title of the experiment.
    pub title: String,
    /// The experiment document, verbatim.
    pub experiment: String,
    /// The settings of the command line (`a.b=value`), in their order.
    pub sets: Vec<String>,
    /// Documents of equations that the experiment names, and documents and tables that these name: the path as the experiment
    /// writes it and the text, verbatim.
    pub equations: Vec<(String, String)>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Commit the program was built from, or `unknown`.
    pub commit: String,
    /// When the run began, UTC, to the second: `2026-03-01T12:00:00Z`.
    pub started: String,
}

impl Header {
    /// A header for a run that begins now with this build of the program.
    pub fn now(document: &str, title: &str, experiment: &str, sets: &[String], seed: u64) -> Self {
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        Self {
            document: document.into(),
            title: title.into(),
            experiment: experiment.into(),
            sets: sets.to_vec(),
            equations: Vec::new(),
            seed,
            version: env!("CARGO_PKG_VERSION").into(),
            commit: env!("PSEUDOPOD_COMMIT").into(),
            started: utc_text(now.as_secs()),
        }
    }

    /// A number that differs between experiments: text, settings and seed, by FNV-1a in 64 bits. Equal on every
    /// machine and in every version.
    pub fn experiment_hash(&self) -> u64 {
        let seed = self.seed.to_le_bytes();
        let texts = std::iter::once(self.experiment.as_bytes()).chain(self.sets.iter().map(|set| set.as_bytes()));
        let texts = texts.chain(self.equations.iter().flat_map(|(path, text)| [path.as_bytes(), text.as_bytes()]));
        // 0xff never occurs in UTF-8, so it parts the texts without doubt.
        let parted = texts.chain([seed.as_slice()]).flat_map(|part| part.iter().copied().chain([0xff]));
        fnv1a(FNV_START, parted)
    }
}

/// Seconds since the beginning of 1970 as date and time, UTC: `2026-03-01T12:00:00Z`.
fn utc_text(seconds: u64) -> String {
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    // Years are counted from a 1st of March, so that the day that some have more is their last (Hinnant, "chrono-compatible
    // low-level date algorithms"); 719 468 days lie between that of the year 0 and 1970.
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    let year = year + 400 * era + next;
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// A scalar that the experiment declares, found at the end of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// Its name in the experiment and under `/summary`.
    pub name: String,
    /// Its value, in `unit`.
    pub value: f64,
    /// The unit, `1` for a pure number.
    pub unit: String,
    /// What it is, in a sentence.
    pub description: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (1_772_366_400, "2026-03-01T12:00:00Z"),
            (1_798_761_599, "2026-12-31T23:59:59Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ] {
            assert_eq!(utc_text(seconds), text);
        }
    }
}
