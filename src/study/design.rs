//! The points of a study: which values its parameters have together. They depend on the study and its seed alone.

use super::document::{Design, StudyDocument};
use super::variation::{Column, Values, Variation, variations};
use super::{saltelli, sobol};
use crate::error::{Error, Fault, Result};
use crate::random::{Purpose, Stream};

/// Most runs of a study: tables of more are read by nobody, and folders with more files by few systems.
pub const MOST_RUNS: u64 = 100_000;

/// The points of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Its parameters.
    pub columns: Vec<Column>,
    /// The values of each point, one for each column, as tables show them.
    pub rows: Vec<Vec<String>>,
}

/// The points of a study.
///
/// # Errors
/// [`Error::Input`] for parameters that do not go with each other or with the design, and for too many runs.
pub fn points(document: &StudyDocument) -> Result<Points> {
    let varied = variations(document)?;
    let study = &document.study;
    let number = check_size(document, &varied)?;
    let rows = match study.design {
        Design::Grid => grid(&varied),
        Design::List => list(&varied),
        Design::LatinHypercube { .. } => sampled(&varied, &latin_hypercube(number, varied.len(), study.seed)),
        Design::Sobol { .. } => sampled(&varied, &sobol::points(number, varied.len(), study.seed)),
        Design::Saltelli { number } => sampled(&varied, &saltelli::points(number, varied.len(), study.seed)),
    };
    Ok(Points { columns: varied.into_iter().map(|one| one.column).collect(), rows })
}

/// How many points there are, once it is known that they can be made.
fn check_size(document: &StudyDocument, varied: &[Variation]) -> Result<u32> {
    let study = &document.study;
    let lengths: Vec<u64> = varied.iter().map(|one| listed(one).len() as u64).collect();
    let number = match study.design {
        Design::Grid => lengths.iter().fold(1, |product: u64, length| product.saturating_mul(*length)),
        Design::List => {
            if let Some(odd) = lengths.iter().position(|length| *length != lengths[0]) {
                let (first, key) = (&study.parameter[0].key, &study.parameter[odd].key);
                let message = format!("`{first}` has {} values and `{key}` has {}", lengths[0], lengths[odd]);
                let which = if study.parameter[odd].values.is_some() { "values" } else { "number" };
                let location = document.key_location(&format!("parameter[{odd}].{which}"), "unlike the first");
                let help = "in a list the first values go together, then the second ones: give all parameters as many; or take a grid";
                return Err(Error::input(Fault::new(message).at(location).help(help)));
            }
            lengths.first().copied().unwrap_or(0)
        }
        Design::LatinHypercube { number } | Design::Sobol { number } => u64::from(number),
        Design::Saltelli { number } => u64::from(number) * saltelli::each(varied.len()) as u64,
    };
    check_dimensions(document, varied.len())?;
    let runs = number.saturating_mul(u64::from(study.replicates));
    if runs > MOST_RUNS {
        let product = lengths.iter().map(u64::to_string).collect::<Vec<_>>().join(" × ");
        let points = match study.design {
            Design::Grid => format!("{product} values"),
            Design::Saltelli { number } => {
                format!("{number} base points with {} points each,", saltelli::each(varied.len()))
            }
            _ => format!("{number} points"),
        };
        let message =
            format!("{points} with {} replicates are {runs} runs; at most {MOST_RUNS} are made", study.replicates);
        let location = document.location("parameter", "too many runs");
        let help = match study.design {
            Design::Saltelli { .. } => "take fewer base points, parameters or replicates",
            _ => "take fewer values or replicates, or `kind = \"sobol\"` with a `number` of points",
        };
        return Err(Error::input(Fault::new(message).at(location).help(help)));
    }
    Ok(number as u32)
}

/// Whether a Sobol sequence has a coordinate for each parameter, or two where each point needs two.
fn check_dimensions(document: &StudyDocument, parameters: usize) -> Result<()> {
    let most = sobol::MOST_DIMENSIONS;
    let (message, help) = match document.study.design {
        Design::Sobol { .. } if parameters > most => (
            format!("{parameters} parameters are varied; a Sobol sequence has at most {most} here"),
            "take `kind = \"latin_hypercube\"`, or fewer parameters",
        ),
        Design::Saltelli { .. } if parameters > most / 2 => (
            format!("{parameters} parameters are varied; Saltelli's points are for at most {} here", most / 2),
            "vary those only that matter, which a Latin hypercube with some hundred points finds",
        ),
        _ => return Ok(()),
    };
    let location = document.location("design.kind", "too many parameters for it");
    Err(Error::input(Fault::new(message).at(location).help(help)))
}

fn listed(one: &Variation) -> &[String] {
    match &one.source {
        Values::Listed(cells) => cells,
        Values::Range(_) => &[],
    }
}

/// Each value with each other, the last parameter fastest.
fn grid(varied: &[Variation]) -> Vec<Vec<String>> {
    varied.iter().fold(vec![Vec::new()], |rows, one| {
        let longer = |row: &Vec<String>, cell: &String| row.iter().chain([cell]).cloned().collect();
        rows.iter().flat_map(|row| listed(one).iter().map(move |cell| longer(row, cell))).collect()
    })
}

/// The first values of all, then the second ones.
fn list(varied: &[Variation]) -> Vec<Vec<String>> {
    let number = varied.first().map_or(0, |one| listed(one).len());
    (0..number).map(|row| varied.iter().map(|one| listed(one)[row].clone()).collect()).collect()
}

/// The values at the shares of their ranges.
fn sampled(varied: &[Variation], shares: &[Vec<f64>]) -> Vec<Vec<String>> {
    let at = |one: &Variation, share: f64| match &one.source {
        Values::Range(range) => range.at(share),
        Values::Listed(cells) => cells[((share * cells.len() as f64) as usize).min(cells.len() - 1)].clone(),
    };
    shares.iter().map(|point| varied.iter().zip(point).map(|(one, share)| at(one, *share)).collect()).collect()
}

/// Points of a Latin hypercube in (0, 1): along each axis one in each of `number` equal parts, at random in it.
pub fn latin_hypercube(number: u32, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let axes: Vec<Vec<f64>> = (0..dimensions as u32).map(|axis| strata(number, axis, seed)).collect();
    (0..number as usize).map(|row| axes.iter().map(|axis| axis[row]).collect()).collect()
}

/// A share in each part of an axis, in random order.
fn strata(number: u32, axis: u32, seed: u64) -> Vec<f64> {
    let mut parts: Vec<u32> = (0..number).collect();
    let draws: Vec<[f64; 2]> = {
        let mut stream = Stream::new(seed, Purpose::Design, axis, 0);
        (0..number).map(|_| stream.uniform_pair()).collect()
    };
    // Fisher and Yates: each of the orders is as likely as any other.
    for last in (1..parts.len()).rev() {
        parts.swap(last, ((draws[last][0] * (last + 1) as f64) as usize).min(last));
    }
    parts.iter().zip(draws).map(|(part, [_, within])| (f64::from(*part) + within) / f64::from(number)).collect()
}

/// The seed of a run: of the seed of the study, the point and the replicate, and of nothing else; below 2^63, as documents write it.
pub fn run_seed(study: u64, point: u32, replicate: u32) -> u64 {
    let counter = [point, 0, replicate, Purpose::Replicate as u32];
    let [low, high, ..] = crate::random::philox(counter, [study as u32, (study >> 32) as u32]);
    (u64::from(high) << 32 | u64::from(low)) >> 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_every_axis_of_a_latin_hypercube_has_one_point() {
        for seed in [0, 9, u64::MAX] {
            let points = latin_hypercube(40, 5, seed);
            for axis in 0..5 {
                let mut parts: Vec<usize> = points.iter().map(|point| (40.0 * point[axis]) as usize).collect();
                parts.sort_unstable();
                assert_eq!(parts, (0..40).collect::<Vec<_>>());
            }
        }
        assert_ne!(latin_hypercube(40, 5, 1), latin_hypercube(40, 5, 2));
    }

    #[test]
    fn axes_of_a_latin_hypercube_are_independent_of_each_other() {
        // The correlation of 400 pairs of independent ranks has a standard deviation of 0.05; four of them.
        let points = latin_hypercube(400, 6, 3);
        for (one, other) in [(0, 1), (2, 3), (4, 5), (0, 5)] {
            let product: f64 = points.iter().map(|point| (point[one] - 0.5) * (point[other] - 0.5)).sum();
            assert!((12.0 * product / 400.0).abs() < 0.2, "{one} and {other}: {}", 12.0 * product / 400.0);
        }
    }

    #[test]
    fn seeds_of_runs_stay_when_replicates_and_points_are_added_and_never_come_twice() {
        let seeds = |points: u32, replicates: u32| -> Vec<u64> {
            (0..points).flat_map(|point| (0..replicates).map(move |one| run_seed(7, point, one))).collect()
        };
        let many = seeds(300, 40);
        assert_eq!(seeds(300, 1), many.iter().copied().step_by(40).collect::<Vec<_>>());
        assert_eq!(seeds(20, 40), many[..800]);
        let mut sorted = many.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), many.len());
        assert!(many.iter().all(|seed| i64::try_from(*seed).is_ok()));
        assert_ne!(run_seed(7, 0, 0), run_seed(8, 0, 0));
    }
}
