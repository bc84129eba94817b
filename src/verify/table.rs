//! What became of claims, as text.

use crate::analysis::claims::ClaimResult;
use std::fmt::Write as _;

/// A table with a row for each claim: what became of it, the measure, what was found, what is expected, and the source. What is
/// expected is in the unit of what was found.
pub fn table(results: &[ClaimResult]) -> String {
    let heads = ["verdict", "claim", "found", "expected", "source"].map(str::to_owned);
    let row = |result: &ClaimResult| {
        let claim = &result.claim;
        let [verdict, bound] = [result.verdict().to_string(), claim.bound.to_string()];
        [verdict, claim.measure.clone(), result.found_text(), bound, claim.source.clone()]
    };
    let rows: Vec<[String; 5]> = std::iter::once(heads).chain(results.iter().map(row)).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3].map(width);
    let mut text = String::new();
    for [verdict, claim, found, expected, source] in &rows {
        let [a, b, c, d] = widths;
        // Writing to a text cannot fail.
        let _ = writeln!(text, "  {verdict:a$}  {claim:b$}  {found:c$}  {expected:d$}  {source}");
    }
    text
}

/// How many claims hold, and which do not: `2 of 3 claims of expected.toml hold, not: arrived = 5.9 nM (at least 6)`.
pub fn in_a_line(results: &[ClaimResult], file: &str) -> String {
    let missed: Vec<String> = results.iter().filter(|result| !result.holds()).map(ToString::to_string).collect();
    let held = results.len() - missed.len();
    let line = format!("{held} of {} claims of {file} hold", results.len());
    if missed.is_empty() { line } else { format!("{line}, not: {}", missed.join("; ")) }
}
