//! Starts that are drawn at random.

use pseudopod::equations::eml::{self, Document};
use pseudopod::equations::program::Program;
use pseudopod::error::Source;
use pseudopod::ode::{Numbers, SolveOptions, Starts, solve};
use std::sync::Arc;

fn read(parts: &str) -> Document {
    let text = format!("<eml name=\"test\" level=\"cell\" time_unit=\"s\">{parts}</eml>");
    eml::read(Arc::new(Source { name: "test.eml".into(), text })).unwrap_or_else(|error| panic!("{error}"))
}

const PARTS: &str = "<parameter id=\"m\" value=\"3\" unit=\"uM\"/><parameter id=\"s\" value=\"0.2\" unit=\"1\"/>
    <variable id=\"u\" initial=\"uniform(m, 5 [uM])\" unit=\"uM\" rate=\"0\"/>
    <variable id=\"n\" initial=\"normal(m, 0.5 [uM]) + 1 [uM]\" unit=\"uM\" rate=\"0\"/>
    <variable id=\"l\" initial=\"lognormal(m, s)\" unit=\"uM\" rate=\"0\"/>
    <variable id=\"both\" initial=\"uniform(0, 1) + uniform(0, 1)\" unit=\"uM\" rate=\"0\"/>
    <variable id=\"same\" initial=\"2*u\" unit=\"uM\" rate=\"0\"/>";

/// The starts of so many cells, by variables.
fn starts(document: &Document, seed: u64, cells: u64) -> Vec<Vec<f64>> {
    let starts = Starts::new(&document.system).expect("something is drawn");
    let rows: Vec<Vec<f64>> = (0..cells).map(|cell| starts.values(Numbers { seed, system: "test" }, cell)).collect();
    (0..rows[0].len()).map(|variable| rows.iter().map(|row| row[variable]).collect()).collect()
}

fn moments(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (mean, values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count)
}

#[test]
fn starts_have_the_moments_of_their_distributions() {
    const CELLS: u64 = 20_000;
    let columns = starts(&read(PARTS), 4, CELLS);
    assert!(columns[0].iter().all(|u| (3.0..5.0).contains(u)));
    let variance = (0.04_f64.exp() - 1.0) * 0.04_f64.exp() * 9.0;
    for (what, values, mean, variance, kurtosis) in [
        ("uniform", &columns[0], 4.0, 4.0 / 12.0, 1.8),
        ("normal", &columns[1], 4.0, 0.25, 3.0),
        ("lognormal", &columns[2], 3.0 * 0.02_f64.exp(), variance, 3.7),
        ("sum", &columns[3], 1.0, 2.0 / 12.0, 2.4),
    ] {
        let (found_mean, found_variance) = moments(values);
        let error = 3.0 * (variance / CELLS as f64).sqrt();
        assert!((found_mean - mean).abs() < error, "{what}: {found_mean} for {mean}");
        let error = 3.0 * variance * ((kurtosis - 1.0_f64) / CELLS as f64).sqrt();
        assert!((found_variance - variance).abs() < error, "{what}: {found_variance} for {variance}");
    }
    assert!(
        columns[4].iter().zip(&columns[0]).all(|(same, u)| *same == 2.0 * u),
        "what uses a start uses what was drawn"
    );
    // One variable says nothing of another, nor one cell of the next.
    let correlation = |a: &[f64], b: &[f64]| {
        let ((mean_a, variance_a), (mean_b, variance_b)) = (moments(a), moments(b));
        let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b)).sum();
        sum / a.len() as f64 / (variance_a * variance_b).sqrt()
    };
    let error = 3.0 / (CELLS as f64).sqrt();
    assert!(correlation(&columns[0], &columns[1]).abs() < error && correlation(&columns[1], &columns[2]).abs() < error);
    assert!(correlation(&columns[0][1..], &columns[0][..CELLS as usize - 1]).abs() < error);
}

#[test]
fn starts_belong_to_seed_system_and_cell_and_single_solves_draw_the_first() {
    let document = read(PARTS);
    let (one, again, other) = (starts(&document, 1, 3), starts(&document, 1, 3), starts(&document, 2, 3));
    assert_eq!(one, again);
    assert!(one[0].iter().zip(&other[0]).all(|(a, b)| a != b) && one[0][0] != one[0][1]);
    let options = SolveOptions { seed: 1, ..SolveOptions::default() };
    let solution = solve(&document.system, 0.0, 1.0, &[1.0], &options).expect("a course");
    let number = document.system.find("u").expect("u") as usize;
    assert_eq!(solution.values[0][number], one[0][0]);
    // Undrawn it is in the middle.
    let program = Program::new(&document.system).expect("no circle");
    assert_eq!(program.initial[number], 4.0);
}

#[test]
fn what_is_drawn_is_written_as_it_was() {
    let document = read(PARTS);
    let text = eml::write(&document, "").text;
    let again = eml::read(Arc::new(Source { name: "again.eml".into(), text: text.clone() }));
    let again = again.unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(starts(&document, 7, 20), starts(&again, 7, 20), "{text}");
}
