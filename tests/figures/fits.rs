//! The fits that ship: the shear modulus of a red cell from its stretching, modulus and viscosity of a cell in an optical stretcher, with their intervals.

use pseudopod::simulation::CancelToken;
use pseudopod::study::Replaces;
use pseudopod::study::fit::{EvaluateOptions, FitDocument, Outcome, Prepared, fit};
use std::path::Path;

/// Makes a fit that ships, with two jobs.
fn made(document: &str) -> Outcome {
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments").join(document);
    let folder = tempfile::tempdir().unwrap();
    let prepared = Prepared::new(FitDocument::read(&document).unwrap(), folder.path(), None).unwrap();
    prepared.plan.write(Replaces::Nothing).unwrap();
    let tell = |words: &str| println!("{words}");
    let options = EvaluateOptions { jobs: 2, threads: 1, cancel: CancelToken::new(), memory: None, tell: &tell };
    fit(&prepared, &options).unwrap()
}

#[test]
fn the_shear_modulus_of_a_red_cell_is_the_one_of_its_page_with_its_interval() {
    let outcome = made("red_cell_fit/fit.toml");
    let found = &outcome.parameters[0];
    let [low, high] = found.profile.unwrap().map(Option::unwrap);
    println!("{} from {low} to {high}, by the covariance {:?}", found.value, found.covariance);
    // Within a tenth of the half of the interval: the search ends within a hundredth of a standard error, a profile within one of its distance.
    let near = |value: f64, page: f64| (value - page).abs() < 0.03;
    assert!(near(found.value, 2.945) && near(low, 2.261) && near(high, 3.852));
    assert!(found.covariance[0] < found.value && found.value < found.covariance[1]);
    assert!(outcome.converged && outcome.evaluations.len() <= 40, "{} evaluations", outcome.evaluations.len());
}

#[test]
#[ignore = "slow: a minute of two cores"]
fn modulus_and_viscosity_of_a_cell_in_an_optical_stretcher_are_those_of_its_page_with_their_intervals() {
    let outcome = made("optical_stretcher/fit.toml");
    let page = [[248.9, 115.6, 355.3], [1059.0, 912.6, 1233.0]];
    for (found, [value, low, high]) in outcome.parameters.iter().zip(page) {
        let [least, most] = found.profile.unwrap().map(Option::unwrap);
        println!("{} from {least} to {most}", found.value);
        // A tenth of the half of the interval.
        let near = |found: f64, page: f64| (found - page).abs() < 0.05 * (high - low);
        assert!(near(found.value, value) && near(least, low) && near(most, high), "{} {least} {most}", found.value);
    }
    assert!(outcome.converged);
}
