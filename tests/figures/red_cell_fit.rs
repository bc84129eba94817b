//! The fit that ships: the shear modulus of a red cell from its stretching, with its interval.

use pseudopod::simulation::CancelToken;
use pseudopod::study::Replaces;
use pseudopod::study::fit::{EvaluateOptions, FitDocument, Prepared, fit};
use std::path::Path;

#[test]
fn the_shear_modulus_of_a_red_cell_is_the_one_of_its_page_with_its_interval() {
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/red_cell_fit/fit.toml");
    let folder = tempfile::tempdir().unwrap();
    let prepared = Prepared::new(FitDocument::read(&document).unwrap(), folder.path(), None).unwrap();
    prepared.plan.write(Replaces::Nothing).unwrap();
    let tell = |words: &str| println!("{words}");
    let options = EvaluateOptions { jobs: 2, threads: 1, cancel: CancelToken::new(), memory: None, tell: &tell };
    let outcome = fit(&prepared, &options).unwrap();
    let found = &outcome.parameters[0];
    let [low, high] = found.profile.unwrap().map(Option::unwrap);
    println!("{} from {low} to {high}, by the covariance {:?}", found.value, found.covariance);
    // Within a tenth of the half of the interval: the search ends within a hundredth of a standard error, a profile within one of its distance.
    let near = |value: f64, page: f64| (value - page).abs() < 0.03;
    assert!(near(found.value, 2.945) && near(low, 2.261) && near(high, 3.852));
    assert!(found.covariance[0] < found.value && found.value < found.covariance[1]);
    assert!(outcome.converged && outcome.evaluations.len() <= 40, "{} evaluations", outcome.evaluations.len());
}
