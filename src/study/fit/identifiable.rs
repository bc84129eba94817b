//! What data tell of parameters, in words.

use super::outcome::{Estimated, Outcome};
use super::space::{Axis, four_digits};

/// Correlations from which on two parameters are told as hard to tell apart.
const STRONG: f64 = 0.95;
/// A parameter within this share of its range of a bound lies at it.
const AT_BOUND: f64 = 1e-6;

/// What has to be known of a fit beside its numbers: which parameters the data do not determine, and why, and whether residuals are as
/// large as errors. Nothing where all is well.
pub fn verdicts(outcome: &Outcome) -> Vec<String> {
    let mut told: Vec<String> = outcome.each().filter_map(|(axis, found)| of_parameter(outcome, axis, found)).collect();
    let names: Vec<&str> = outcome.space.axes.iter().map(|axis| axis.column.name.as_str()).collect();
    for (one, name) in names.iter().enumerate() {
        for (other, second) in names.iter().enumerate().skip(one + 1) {
            let correlation = outcome.correlations[(one, other)];
            if correlation.abs() >= STRONG {
                let (how, what) =
                    if correlation > 0.0 { ("rises", "ratio or difference") } else { ("falls", "sum or product") };
                told.push(format!(
                    "{name} and {second} are hardly told apart (correlation {correlation:.3}): where one rises the other {how}, and the data say more of their {what} than of each"
                ));
            }
        }
    }
    told.extend(of_residuals(outcome));
    if !outcome.converged {
        told.push("the search did not come to an end: what was found is the best point that was met".to_owned());
    }
    if outcome.starts.len() > 1 {
        let (agree, all) = (outcome.starts_that_agree(), outcome.starts.len());
        if agree < all {
            told.push(format!("{agree} of {all} starts led to this χ²; evaluations.csv has the others"));
        }
    }
    told
}

fn of_parameter(outcome: &Outcome, axis: &Axis, found: &Estimated) -> Option<String> {
    let name = &axis.column.name;
    let (from, to) = (axis.with_unit(axis.range.from), axis.with_unit(axis.range.to));
    let most = found.points.iter().map(|point| point[1] - outcome.chi2).fold(0.0, f64::max);
    match found.profile {
        Some([None, None]) => Some(format!(
            "{name} is not identifiable from these data: between its bounds, {from} and {to}, χ² rises by {} at most, and an interval of {} % ends at {}",
            four_digits(most),
            percent(outcome.confidence),
            four_digits(outcome.rise)
        )),
        Some([None, Some(_)]) => Some(format!("{name} has no lower limit from these data down to its bound, {from}")),
        Some([Some(_), None]) => Some(format!("{name} has no upper limit from these data up to its bound, {to}")),
        _ if found.share < AT_BOUND => Some(format!("{name} lies at its lower bound, {from}: the data ask for less")),
        _ if found.share > 1.0 - AT_BOUND => {
            Some(format!("{name} lies at its upper bound, {to}: the data ask for more"))
        }
        None if !found.covariance.iter().all(|end| end.is_finite()) => {
            Some(format!("{name} is not identifiable from these data: near its best value it changes nothing"))
        }
        _ => None,
    }
}

/// Whether χ² is as large as its degrees of freedom: beyond three standard deviations it is told, eq. (fit.9).
fn of_residuals(outcome: &Outcome) -> Option<String> {
    if outcome.errors == super::document::Errors::Estimated || outcome.freedom == 0 {
        return None;
    }
    let (reduced, spread) = (outcome.reduced(), 3.0 * (2.0 / outcome.freedom as f64).sqrt());
    if reduced > 1.0 + spread {
        Some(format!(
            "residuals are larger than errors (χ² over degrees of freedom is {reduced:.2}): the experiment does not describe these data, or their errors are too small, and intervals are too narrow"
        ))
    } else if reduced < 1.0 - spread {
        Some(format!(
            "residuals are smaller than errors (χ² over degrees of freedom is {reduced:.2}): errors are shared by the data or too large, and intervals are too wide if so; errors = \"estimated\" takes them from the residuals"
        ))
    } else {
        None
    }
}

/// A share as per cent: 0.95 as 95.
pub fn percent(share: f64) -> String {
    crate::error::short((1e4 * share).round() / 100.0)
}
