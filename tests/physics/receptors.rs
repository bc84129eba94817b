//! Receptors of a membrane are bound with the noise of single molecules, and what a cell reads of a gradient is as uncertain as they make it.

use crate::coupled_scene::{Scene, scene};
use pseudopod::analysis::sensing::{Messenger, Receptors};
use pseudopod::analysis::statistics::{mean, standard_error};

/// Those of the document that ships.
const RECEPTORS: Receptors = Receptors { number: 25_000.0, dissociation: 1_000.0, length: 10.0 };
/// Its rate of leaving, per s.
const OFF: f64 = 0.3;
/// Radius of the cells, µm.
const RADIUS: f64 = 5.0;

/// The document that ships, without its links to pseudopods, with moments of what is bound.
fn document(changes: &[(&str, &str)]) -> String {
    let text = include_str!("../../eml/receptors.eml");
    let mut text: String = text.lines().filter(|line| !line.contains("<link")).collect();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let moments =
        ["x", "y", "z"].map(|axis| format!("<integral id=\"bound_{axis}\" unit=\"um\">bound*{axis}</integral>"));
    text.replace(
        "</eml>",
        &format!("<integral id=\"messengers_z\" unit=\"um\">messenger*z</integral>{}</eml>", moments.concat()),
    )
}

/// Cells at rest where x is 0, in a gradient of so many nM a µm with `c` nM in their middle.
fn cells(number: usize, level: usize, (c, gradient): (f64, f64), own: &str) -> Scene {
    let field = format!(
        "<eml name=\"gradient\"><grid dimension=\"2\" spacing=\"4\" origin=\"-20 -40\" size=\"40 2000\"/>\
         <field id=\"attractant\" initial=\"{c} + {gradient}*x\"/></eml>"
    );
    let at: Vec<String> = (0..number).map(|cell| format!("[\"0 um\", \"{} um\", \"0 um\"]", 20 * cell)).collect();
    let text = format!(
        r#"
seed = 7
[run]
until = "1 h"
integrator = {{ step = "1 s" }}
[output]
every = "1 h"
[cells.cell]
mesh = {{ shape = "icosphere", radius = "{RADIUS} um", level = {level} }}
placement = {{ at = [{}] }}
mechanics = {{ drag = "20 pN s/um", shape_memory = {{ shape_modulus = "10 pN/um" }} }}
chemistry = ["own"]
[chemistry.own]
document = "own.eml"
links = [{{ from = "cell.atoms.field[attractant]", to = "system.c" }}]
"#,
        at.join(", ")
    );
    scene(&[("own", own), ("gradient", &field)], &text)
}

/// A number of each cell.
fn of_cells(scene: &Scene, quantity: &str, number: usize) -> Vec<f64> {
    (0..number).map(|cell| scene.value(0, quantity, cell)).collect()
}

#[test]
fn more_is_bound_in_front_by_a_sixth_of_the_difference_whatever_the_mesh() {
    let still = document(&[
        (" noise=\"sqrt(2*off*in_balance)\"", ""),
        (" noise=\"sqrt(2*made*in_balance)\"", ""),
        ("<solver noise_step=\"0.5\"/>", ""),
    ]);
    for level in [1, 2, 3] {
        for (c, gradient) in [(50.0, 0.05), (1_000.0, 1.0), (9_000.0, 9.0)] {
            let mut scene = cells(1, level, (c, gradient), &still);
            for _ in 0..150 {
                scene.step().unwrap();
            }
            let bound = RECEPTORS.number * RECEPTORS.occupied(c);
            let front = scene.value(0, "bound_x", 0) / RADIUS;
            let expected = RECEPTORS.difference(c, gradient) / 6.0;
            println!(
                "level {level}, {c} nM: {} of {bound} bound, front {front} of {expected}",
                scene.value(0, "all_bound", 0)
            );
            // What bends the curve of occupancy is (gR/c)² = 2.5e-5 of the difference and of what is bound.
            assert!((scene.value(0, "all_bound", 0) / bound - 1.0).abs() < 1e-4);
            assert!((front / expected - 1.0).abs() < 1e-4, "{front}, not {expected}");
            // The messenger follows what is bound: 20 of it for each.
            assert!((scene.value(0, "messengers_x", 0) / RADIUS / (20.0 * expected) - 1.0).abs() < 1e-4);
            assert!(scene.value(0, "bound_y", 0).abs() < 1e-6 * bound);
            assert!((scene.value(0, "cue_x", 0) - 1.25).abs() < 1e-6, "the compass is as long as is said");
        }
    }
}

/// Whether the mean of squares is within three standard errors of what is expected.
fn check_squares(what: &str, values: &[f64], expected: f64) {
    let squares: Vec<f64> = values.iter().map(|value| value * value).collect();
    let (found, error) = (mean(&squares), standard_error(&squares));
    println!(
        "{what}: {found:.5e} ± {error:.1e}, expected {expected:.5e}: {:.2} standard errors",
        (found - expected) / error
    );
    assert!((found - expected).abs() < 3.0 * error, "{what}: {found} ± {error}, not {expected}");
}

#[test]
fn binding_has_the_mean_variance_and_correlation_of_single_molecules_on_any_mesh() {
    for (level, number, c) in [(1, 64, 1_000.0), (2, 48, 200.0), (3, 16, 3_000.0)] {
        let (gradient, h, rate) = (0.002 * c, 0.1, OFF * (1.0 + c / RECEPTORS.dissociation));
        let own = document(&[("noise_step=\"0.5\"", "noise_step=\"0.1\"")]);
        let mut scene = cells(number, level, (c, gradient), &own);
        let occupied = RECEPTORS.occupied(c);
        let single = RECEPTORS.number * occupied * (1.0 - occupied);
        // Kicks at the begin of spans leave this of the variance at their end, eq. (noise.2).
        let kicked = 2.0 * rate * h / (f64::exp(2.0 * rate * h) - 1.0);
        let gap = (4.0 / rate).ceil() as usize;
        let (mut deviations, mut later, mut fronts, mut sides) = (vec![], vec![], vec![], vec![]);
        for step in 0..25 * gap {
            scene.step().unwrap();
            let settled = step >= 5 * gap;
            let numbers = || of_cells(&scene, "all_bound", number).into_iter().map(|n| n - RECEPTORS.number * occupied);
            // Samples that hardly know of each other, e⁻⁴, each with what is a second later.
            if settled && step % gap == 0 {
                deviations.extend(numbers());
                fronts.extend(of_cells(&scene, "bound_x", number).into_iter().map(|moment| moment / RADIUS));
                for axis in ["bound_y", "bound_z"] {
                    sides.extend(of_cells(&scene, axis, number).into_iter().map(|moment| moment / RADIUS));
                }
            } else if settled && step % gap == 1 {
                later.extend(numbers());
            }
        }
        println!("level {level}, {c} nM, {} samples", deviations.len());
        let (found, error) = (mean(&deviations), standard_error(&deviations));
        assert!(found.abs() < 3.0 * error, "bound: off by {found} ± {error}");
        check_squares("number bound", &deviations, single * kicked);
        // A third of the receptors counts along each axis: the mean of (x/R)² over a sphere.
        check_squares("moment", &sides, single * kicked / 3.0);
        let products: Vec<f64> =
            deviations.iter().zip(&later).map(|(one, other)| one * other / (single * kicked)).collect();
        let (found, error, expected) = (mean(&products), standard_error(&products), f64::exp(-rate));
        println!("correlation after 1 s: {found:.4} ± {error:.4}, expected {expected:.4}");
        assert!((found - expected).abs() < 3.0 * error);
        let (found, error) = (mean(&fronts), standard_error(&fronts));
        let expected = RECEPTORS.difference(c, gradient) / 6.0;
        println!("front: {found:.3} ± {error:.3}, expected {expected:.3}");
        assert!((found - expected).abs() < 3.0 * error && found > 3.0 * error);
    }
}

#[test]
fn a_messenger_averages_binding_over_its_life_and_adds_a_noise_of_its_own() {
    let (number, c, h) = (64, 1_000.0, 0.1);
    let (made, life) = (2.0, 3.0);
    let own = document(&[
        ("noise_step=\"0.5\"", "noise_step=\"0.1\""),
        ("id=\"life\" value=\"10\"", "id=\"life\" value=\"3\""),
    ]);
    let mut scene = cells(number, 1, (c, 0.0), &own);
    let mut moments = vec![];
    for step in 0..400 {
        scene.step().unwrap();
        if step >= 40 && step % 15 == 0 {
            for axis in ["messengers_x", "messengers_y", "messengers_z"] {
                moments
                    .extend(of_cells(&scene, axis, number).into_iter().map(|moment| moment / RADIUS / (made * life)));
            }
        }
    }
    let messenger = Messenger { off: OFF, made, life };
    let expected = RECEPTORS.reading_variance(&messenger, c);
    // Kicks leave 0.967 of the messenger's own noise and less than 0.2 % more or less of what it averages.
    let own = RECEPTORS.number * RECEPTORS.occupied(c) / (3.0 * made * life);
    let left = (2.0 * h / life) / (f64::exp(2.0 * h / life) - 1.0);
    check_squares("reading", &moments, expected - own * (1.0 - left));
}
