//! What commands tell of claims.

use super::report::Report;
use crate::analysis::claims::{ClaimResult, check_claims};
use crate::error::Error;
use crate::output::{Measure, ResultFile};
use crate::verify::{CLAIMS, claims_of_run, in_a_line};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// What became of the claims about a run.
pub enum Claims {
    /// Each with what was found; none where nothing is claimed.
    Held(Vec<ClaimResult>),
    /// They cannot be read, which the run has not to answer for.
    Unread(Error),
}

impl Claims {
    /// Holds the claims beside the document of a finished run against what it measured.
    pub fn of(file: &ResultFile, summary: &[Measure]) -> Self {
        claims_of_run(file).map_or_else(Self::Unread, |claims| Self::Held(check_claims(&claims, summary)))
    }

    /// Adds a line, where anything is claimed.
    pub fn add_words(&self, words: &mut String) {
        // Writing to a text cannot fail.
        let _ = match self {
            Self::Held(results) if results.is_empty() => Ok(()),
            Self::Held(results) => writeln!(words, "{}", in_a_line(results, CLAIMS)),
            Self::Unread(error) => writeln!(words, "{CLAIMS} cannot be read, see pseudopod verify: {error}"),
        };
    }

    /// The same for scripts.
    pub fn add_facts(&self, report: Report) -> Report {
        match self {
            Self::Held(results) if results.is_empty() => report,
            Self::Held(results) => report.fact("claims", results.iter().map(claim_object).collect::<Vec<_>>()),
            Self::Unread(error) => report.fact("claims_unread", error.to_string()),
        }
    }
}

/// A claim for scripts.
pub fn claim_object(result: &ClaimResult) -> Value {
    let claim = &result.claim;
    json!({
        "measure": claim.measure,
        "source": claim.source,
        "reason": claim.reason,
        "expected": claim.bound.to_string(),
        "found": result.found.as_ref().map(|found| found.value),
        "unit": result.found.as_ref().map(|found| found.unit.clone()),
        "verdict": result.verdict().to_string(),
    })
}
