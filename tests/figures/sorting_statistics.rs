//! Twenty seeds of the experiment `sorting`: types that stick to themselves only are segregated, beyond what chance makes of
//! the same contacts, and types that stick alike are not.

use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, run};
use std::path::Path;

const SEEDS: std::ops::RangeInclusive<u32> = 1..=20;

/// Index and p value at the end of one run.
fn segregation(seed: u32, sets: &[&str]) -> [f64; 2] {
    // Only the end counts here.
    let sets: Vec<&str> = sets.iter().copied().chain(["output.every=60 s"]).collect();
    measured("experiment.toml", seed, &sets, ["segregation", "p_value"])
}

/// Measures of one run of a document.
fn measured<const N: usize>(document: &str, seed: u32, sets: &[&str], names: [&str; N]) -> [f64; N] {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/sorting").join(document);
    let seed_set = format!("seed={seed}");
    let sets: Vec<String> = sets.iter().copied().chain([seed_set.as_str()]).map(str::to_owned).collect();
    let document = Document::read(&path, &sets).expect("a good document");
    let scratch = tempfile::tempdir().expect("a folder");
    let result = scratch.path().join("result.h5");
    let options = RunOptions::new(&result);
    run(&document, &options, &mut Quiet).expect("a run");
    let measures = ResultFile::open(&result).expect("a result").summary().expect("measures");
    names.map(|name| measures.iter().find(|measure| measure.name == name).expect("a measure").value)
}

/// The probability that the product of as many independent p values is as small by chance (Fisher 1925): −2 Σ ln p is
/// distributed as χ² with two degrees of freedom for each.
fn together(p_values: &[f64]) -> f64 {
    let half = -p_values.iter().map(|p| p.ln()).sum::<f64>();
    let mut term = (-half).exp();
    let mut sum = term;
    for k in 1..p_values.len() {
        term *= half / k as f64;
        sum += term;
    }
    sum
}

/// All seeds; prints each, and returns the mean index and the probability of all together.
fn all_seeds(sets: &[&str]) -> (f64, f64) {
    let found: Vec<[f64; 2]> = SEEDS.map(|seed| segregation(seed, sets)).collect();
    for (run, [index, p]) in (1..).zip(&found) {
        println!("run {run}: segregation {index:.3}, p {p:.4}");
    }
    let mean = found.iter().map(|[index, _]| index).sum::<f64>() / found.len() as f64;
    let p = together(&found.iter().map(|[_, p]| *p).collect::<Vec<_>>());
    println!("mean segregation {mean:.3}, all together p = {p:.2e}");
    (mean, p)
}

#[test]
fn fishers_probability_is_that_of_chi_squared() {
    assert!((together(&[0.05]) - 0.05).abs() < 1e-15);
    // 1 − F(−2 ln 0.01; 4) by hand: 0.01 (1 − ln 0.01).
    assert!((together(&[0.1, 0.1]) - 0.01 * (1.0 - 0.01_f64.ln())).abs() < 1e-15);
}

#[test]
#[ignore = "slow: twenty runs of 10 to 20 s each"]
fn types_that_stick_to_themselves_only_are_segregated() {
    let (mean, p) = all_seeds(&[]);
    assert!(mean > 0.0 && p < 1e-3);
}

#[test]
#[ignore = "slow: twenty runs of 10 to 20 s each"]
fn types_that_stick_alike_are_mixed_at_random() {
    let (_, p) = all_seeds(&["contact.between[2].strength=0.3 pN/um^2"]);
    // Types are exchangeable here, so that one in twenty sets of seeds would be below by chance.
    assert!(p > 0.05);
}

#[test]
#[ignore = "slow: ten runs of some seven minutes each"]
fn two_hundred_cells_sort_over_ten_seeds() {
    let names = ["order_start", "order_3000", "relative_start", "relative_2500", "relative_3000", "relative"];
    let found: Vec<[f64; 6]> = (1..=10).map(|seed| measured("two_hundred.toml", seed, &[], names)).collect();
    for (seed, [start, end, relative @ ..]) in (1..).zip(&found) {
        println!("seed {seed}: order {start:.3} at 100 s, {end:.3} at 3 000 s; relative segregation {relative:.3?}");
    }
    let mean = |measure: usize| found.iter().map(|values| values[measure]).sum::<f64>() / found.len() as f64;
    // Found were 0.86 (deviation 0.04) in the mean, 0.77 at least, and 0.26 at most at the start; runs part like seeds where steps differ.
    assert!(mean(1) > 0.8, "{}", mean(1));
    assert!(found.iter().all(|[start, end, ..]| *start < 0.3 && *end > 0.66), "{found:?}");
    // Found were 0.30, then 0.82, 0.83 and 0.82 with deviations of 0.07, 0.05 and 0.07: two standard errors of the mean are 0.04.
    assert!(mean(2) < 0.5, "{}", mean(2));
    (3..6).for_each(|measure| assert!(mean(measure) > 0.78, "{}: {}", names[measure], mean(measure)));
}

/// The index and the p value of ten seeds of two hundred cells that wander for 1 500 s and then calm down, with these works of separation between
/// red and red, red and white, white and white, pN/µm.
fn two_hundred_with(works: [&str; 3]) -> Vec<[f64; 2]> {
    let mut sets: Vec<String> =
        (0..).zip(works).map(|(row, work)| format!("contact.between[{row}].energy={work} pN/um")).collect();
    sets.extend(["red", "white"].map(|name| format!("chemistry.{name}.set.calm_from=1500")));
    sets.push("run.until=1900 s".into());
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let found: Vec<[f64; 2]> =
        (1..=10).map(|seed| measured("two_hundred.toml", seed, &sets, ["segregation", "p_value"])).collect();
    for (seed, [index, p]) in (1..).zip(&found) {
        println!("seed {seed}: segregation {index:.3}, p {p:.4}");
    }
    found
}

#[test]
#[ignore = "slow: ten runs of some four minutes each"]
fn two_hundred_cells_that_stick_to_the_other_type_alternate_over_ten_seeds() {
    let found = two_hundred_with(["0.2", "1.5", "0.2"]);
    // Found were −0.30 to −0.21, and of 10 000 deals of the types to the same contacts none was as regular; runs part like seeds where steps differ.
    assert!(found.iter().all(|[index, p]| *index < -0.15 && *p > 0.999), "{found:?}");
}

#[test]
#[ignore = "slow: ten runs of some four minutes each"]
fn two_hundred_cells_that_stick_to_their_own_type_alone_part_over_ten_seeds() {
    let found = two_hundred_with(["1.5", "0", "1.5"]);
    // Found were 0.53 to 0.75, and of 10 000 deals none was as segregated.
    assert!(found.iter().all(|[index, p]| *index > 0.45 && *p < 0.001), "{found:?}");
}
