//! Where a result comes from: the experiment's text, the program that ran it, and the numbers it was asked for.

use serde::{Deserialize, Serialize};

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
    /// Documents of equations that the experiment names: the path it writes and the text, verbatim.
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
        let now = jiff::Timestamp::now().round(jiff::Unit::Second).unwrap_or_else(|_| jiff::Timestamp::now());
        Self {
            document: document.into(),
            title: title.into(),
            experiment: experiment.into(),
            sets: sets.to_vec(),
            equations: Vec::new(),
            seed,
            version: env!("CARGO_PKG_VERSION").into(),
            commit: env!("PSEUDOPOD_COMMIT").into(),
            started: now.to_string(),
        }
    }

    /// A number that differs between experiments: text, settings and seed, by FNV-1a in 64 bits. Equal on every
    /// machine and in every version.
    pub fn experiment_hash(&self) -> u64 {
        let seed = self.seed.to_le_bytes();
        let texts = std::iter::once(self.experiment.as_bytes()).chain(self.sets.iter().map(|set| set.as_bytes()));
        let texts = texts.chain(self.equations.iter().flat_map(|(path, text)| [path.as_bytes(), text.as_bytes()]));
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for part in texts.chain([seed.as_slice()]) {
            // 0xff never occurs in UTF-8, so it parts the texts without doubt.
            for byte in part.iter().chain(&[0xff]) {
                hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
        hash
    }
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
