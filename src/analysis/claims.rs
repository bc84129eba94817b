//! What an experiment claims to reproduce, as its `expected.toml` says it, and whether a run keeps the word.

use crate::error::{Error, Fault, Location, Result, Source};
use crate::output::Measure;
use serde::Deserialize;
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use toml::Spanned;

/// One claim about one measure.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// The experiment document of the folder that it is about; all of them when absent.
    pub document: Option<String>,
    /// Name of the measure, as the experiment declares it.
    pub measure: String,
    /// Where its value has to lie.
    pub bound: Bound,
    /// Where the expectation comes from.
    pub source: String,
    /// Why the tolerance is what it is.
    pub reason: Option<String>,
    /// Where the name of the measure stands.
    pub measure_location: Location,
    /// Where the name of the document stands; that of the measure when there is none.
    pub document_location: Location,
}

/// Where a value has to lie, ends included, in the unit of the measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// At most this.
    AtMost(f64),
    /// At least this.
    AtLeast(f64),
    /// From the first to the second.
    Between(f64, f64),
    /// Within a share of a value: |found/value − 1| ≤ share.
    NearRelative(f64, f64),
    /// Within a distance of a value: |found − value| ≤ distance.
    NearAbsolute(f64, f64),
}

impl Claim {
    /// Whether the claim is about the document with this file name.
    pub fn is_about(&self, document: &str) -> bool {
        self.document.as_deref().is_none_or(|own| own == document)
    }
}

impl Bound {
    /// Whether a value lies where it has to; never for NaN.
    pub fn holds(&self, found: f64) -> bool {
        match *self {
            Self::AtMost(most) => found <= most,
            Self::AtLeast(least) => found >= least,
            Self::Between(least, most) => least <= found && found <= most,
            Self::NearRelative(value, share) => (found - value).abs() <= share * value.abs(),
            Self::NearAbsolute(value, distance) => (found - value).abs() <= distance,
        }
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::AtMost(most) => write!(f, "at most {}", exact(most)),
            Self::AtLeast(least) => write!(f, "at least {}", exact(least)),
            Self::Between(least, most) => write!(f, "from {} to {}", exact(least), exact(most)),
            Self::NearRelative(value, share) => {
                write!(f, "{} within {} %", exact(value), exact(rounded(100.0 * share)))
            }
            Self::NearAbsolute(value, distance) => write!(f, "{} within ±{}", exact(value), exact(distance)),
        }
    }
}

/// All digits of a number; with a power of ten where there would be a row of zeros.
fn exact(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{value:e}") } else { value.to_string() }
}

/// Six digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// A claim as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    document: Option<Spanned<String>>,
    measure: Spanned<String>,
    at_most: Option<f64>,
    at_least: Option<f64>,
    equals: Option<f64>,
    within: Option<f64>,
    within_absolute: Option<f64>,
    source: String,
    reason: Option<String>,
}

/// The whole document as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default, rename = "claim")]
    claims: Vec<Spanned<Written>>,
}

/// Reads the claims of a file, see [`parse`].
///
/// # Errors
/// When the file cannot be read, and as [`parse`].
pub fn read(path: &Path) -> Result<Vec<Claim>> {
    let text = crate::files::read_text(path).map_err(|error| {
        let found = format!("the claims {} cannot be read: {error}", path.display());
        Error::input(Fault::new(found).help("give the path of a TOML file with [[claim]] tables"))
    })?;
    parse(&path.display().to_string(), &text)
}

/// Reads claims from TOML text: a `[[claim]]` table for each.
///
/// A claim names its `measure` and its `source`, and bounds the value by `at_most`, `at_least` or both, or by `equals`
/// with `within` (a share) or `within_absolute` (in the unit of the measure). `document` names the document of the folder that it is about, where there are several. A tolerance says its `reason`.
///
/// # Errors
/// When the text is not TOML, a key is unknown or missing, bounds contradict each other, or there is no claim at all.
pub fn parse(name: &str, text: &str) -> Result<Vec<Claim>> {
    let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
    let document: Document = toml::from_str(text).map_err(|error| {
        let fault = Fault::new(error.message().to_owned());
        let fault = match error.span() {
            Some(span) => fault.at(location(&source, span, "here")),
            None => fault,
        };
        Error::input(fault.help("a [[claim]] has measure, source, and at_most, at_least or equals"))
    })?;
    if document.claims.is_empty() {
        let fault = Fault::new(format!("{name} claims nothing")).at(location(&source, 0..0, "no [[claim]] here"));
        return Err(Error::input(fault.help("add a [[claim]] with measure, source, and at_most, at_least or equals")));
    }
    let (mut claims, mut faults) = (Vec::new(), Vec::new());
    for written in document.claims {
        let span = written.span();
        match understand(written.into_inner(), &source) {
            Ok(claim) => claims.push(claim),
            Err(fault) => faults.push(fault.at(location(&source, span, "this claim"))),
        }
    }
    if faults.is_empty() { Ok(claims) } else { Err(Error::Input(faults)) }
}

fn location(source: &Arc<Source>, span: Range<usize>, label: &str) -> Location {
    Location { source: source.clone(), start: span.start, length: span.len(), label: label.to_owned() }
}

/// Makes one bound of the keys that were written.
fn understand(written: Written, source: &Arc<Source>) -> std::result::Result<Claim, Fault> {
    let bound = bound(&written)?;
    let measure_location = location(source, written.measure.span(), "this measure");
    let document_location = written.document.as_ref().map(|name| location(source, name.span(), "this document"));
    Ok(Claim {
        document: written.document.map(Spanned::into_inner),
        measure: written.measure.into_inner(),
        bound,
        source: written.source,
        reason: written.reason,
        document_location: document_location.unwrap_or_else(|| measure_location.clone()),
        measure_location,
    })
}

fn bound(written: &Written) -> std::result::Result<Bound, Fault> {
    let name = written.measure.get_ref();
    let numbers = [written.at_most, written.at_least, written.equals, written.within, written.within_absolute];
    if numbers.iter().flatten().any(|number| !number.is_finite()) {
        return Err(Fault::new(format!("the claim about {name} has a bound that is not finite")).help("give a number"));
    }
    let bound = match numbers {
        [Some(most), None, None, None, None] => Bound::AtMost(most),
        [None, Some(least), None, None, None] => Bound::AtLeast(least),
        [Some(most), Some(least), None, None, None] if least <= most => Bound::Between(least, most),
        [None, None, Some(value), Some(share), None] if share >= 0.0 => Bound::NearRelative(value, share),
        [None, None, Some(value), None, Some(distance)] if distance >= 0.0 => Bound::NearAbsolute(value, distance),
        [None, None, Some(value), None, None] => {
            let fault = Fault::new(format!("the claim about {name} equals {value} without a tolerance"));
            let help = "add within (a share of the value) or within_absolute (in the unit of the measure), and reason";
            return Err(fault.help(help));
        }
        _ => {
            let help = "give at_most, at_least or both in order, or equals with one tolerance that is not negative: \
                        within (a share) or within_absolute";
            return Err(Fault::new(format!("the claim about {name} has no single bound")).help(help));
        }
    };
    if matches!(bound, Bound::NearRelative(..) | Bound::NearAbsolute(..)) && written.reason.is_none() {
        let fault = Fault::new(format!("the claim about {name} has a tolerance without a reason"));
        return Err(fault.help("add reason = \"why this tolerance\""));
    }
    Ok(bound)
}

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The value lies where it has to.
    Holds,
    /// It does not.
    Fails,
    /// There is no such value.
    NotMeasured,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Holds => "holds",
            Self::Fails => "fails",
            Self::NotMeasured => "not measured",
        })
    }
}

/// Whether one claim holds.
#[derive(Debug, Clone, PartialEq)]
pub struct ClaimResult {
    /// The claim.
    pub claim: Claim,
    /// What was measured; none when the run has no such measure.
    pub found: Option<Measure>,
}

impl ClaimResult {
    /// What became of the claim.
    pub fn verdict(&self) -> Verdict {
        match &self.found {
            None => Verdict::NotMeasured,
            Some(found) if self.claim.bound.holds(found.value) => Verdict::Holds,
            Some(_) => Verdict::Fails,
        }
    }

    /// Whether the claim holds. One about a measure that is not there does not.
    pub fn holds(&self) -> bool {
        self.verdict() == Verdict::Holds
    }

    /// What was measured, with its unit; `-` for nothing.
    pub fn found_text(&self) -> String {
        match &self.found {
            None => "-".to_owned(),
            Some(Measure { value, unit, .. }) if unit == "1" => exact(rounded(*value)),
            Some(Measure { value, unit, .. }) => format!("{} {unit}", exact(rounded(*value))),
        }
    }
}

/// In a sentence: `arrived = 5.9 nM (at least 6)`.
impl fmt::Display for ClaimResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Claim { measure, bound, .. } = &self.claim;
        match self.verdict() {
            Verdict::NotMeasured => write!(f, "{measure} is not measured ({bound})"),
            _ => write!(f, "{measure} = {} ({bound})", self.found_text()),
        }
    }
}

/// Holds claims against the measures of a run.
pub fn check_claims(claims: &[Claim], measures: &[Measure]) -> Vec<ClaimResult> {
    let found = |claim: &Claim| measures.iter().find(|measure| measure.name == claim.measure).cloned();
    claims.iter().map(|claim| ClaimResult { claim: claim.clone(), found: found(claim) }).collect()
}

#[cfg(test)]
#[path = "claims_tests.rs"]
mod tests;
