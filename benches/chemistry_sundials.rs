//! Time to solution on the stiff reference problems against CVODE of SUNDIALS, at equal error.
//!
//! Optional: needs the library (`apt install libsundials-dev`), a C compiler and the reference solutions in `../shared/data`; without
//! them it says so and does nothing. `cargo bench --bench chemistry_sundials`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use pseudopod::ode::{Method, Scheme, SolveOptions, solve};
use serde_json::Value;

#[path = "../tests/support/ode_problems.rs"]
mod ode_problems;

const ROUNDS: usize = 15;

/// One solve: tolerance, error (largest relative one of all variables), seconds, steps.
struct Point {
    tolerance: f64,
    error: f64,
    seconds: f64,
    steps: u64,
}

fn main() {
    let Some(program) = compiled() else {
        println!("SUNDIALS was not found: install libsundials-dev and a C compiler to compare with it");
        return;
    };
    println!(
        "{:10} {:10} {:>22} {:>10} {:>10} {:>8}   {:>22} {:>10} {:>8} {:>7}",
        "problem", "method", "ours: tolerance", "error", "µs", "steps", "CVODE: tolerance", "µs", "steps", "ratio"
    );
    let runs = [
        ("vdpol", Method::Rosenbrock),
        ("rober", Method::Rosenbrock),
        ("pleiades", Method::Rk45),
        ("pleiades", Method::Rk65),
    ];
    for (name, method) in runs {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../shared/data/ivp-testset/{name}.json"));
        let Ok(text) = std::fs::read_to_string(path) else {
            println!("{name}: the reference solution in ../shared/data is not there");
            continue;
        };
        let data: Value = serde_json::from_str(&text).expect("the data is JSON");
        let theirs: Vec<Point> = tolerances().filter_map(|t| with_cvode(&program, name, &data, t)).collect();
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let ours = with_ours(name, method, &data, tolerance);
            // The loosest tolerance at which CVODE is at least as exact.
            let equal = theirs
                .iter()
                .filter(|point| point.error <= ours.error)
                .max_by(|a, b| a.tolerance.total_cmp(&b.tolerance));
            let Some(equal) = equal else { continue };
            println!(
                "{name:10} {:10} {tolerance:>22.0e} {:>10.1e} {:>10.0} {:>8}   {:>22.1e} {:>10.0} {:>8} {:>7.2}",
                format!("{method:?}"),
                ours.error,
                1e6 * ours.seconds,
                ours.steps,
                equal.tolerance,
                1e6 * equal.seconds,
                equal.steps,
                equal.seconds / ours.seconds
            );
        }
    }
}

/// Half powers of ten.
fn tolerances() -> impl Iterator<Item = f64> {
    (6..=25).map(|half| 10_f64.powf(-0.5 * f64::from(half)))
}

fn compiled() -> Option<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/sundials/stiff.c");
    let program = std::env::temp_dir().join(format!("pseudopod-cvode-{}", std::process::id()));
    let libraries = [
        "-lsundials_cvode",
        "-lsundials_nvecserial",
        "-lsundials_sunlinsoldense",
        "-lsundials_sunmatrixdense",
        "-lsundials_sunnonlinsolfixedpoint",
        "-lm",
    ];
    let made =
        Command::new("cc").arg("-O2").arg("-w").arg(&source).arg("-o").arg(&program).args(libraries).output().ok()?;
    made.status.success().then_some(program)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().filter_map(Value::as_f64).collect()
}

fn error(found: &[f64], data: &Value) -> f64 {
    numbers(&data["ref"]).iter().zip(found).map(|(wanted, found)| (found / wanted - 1.0).abs()).fold(0.0, f64::max)
}

/// The smallest answer that is followed for itself, 2e-8 in Robertson's problem, is above this by far.
fn absolute(tolerance: f64) -> f64 {
    1e-6 * tolerance
}

fn with_cvode(program: &Path, name: &str, data: &Value, tolerance: f64) -> Option<Point> {
    let numbers = [tolerance, absolute(tolerance), ROUNDS as f64].map(|number| number.to_string());
    let output = Command::new(program).arg(name).args(numbers).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let words: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [seconds, steps, found @ ..] = &words[..] else { return None };
    Some(Point { tolerance, error: error(found, data), seconds: *seconds, steps: *steps as u64 })
}

fn with_ours(name: &str, method: Method, data: &Value, tolerance: f64) -> Point {
    let names: Vec<&str> = data["vars"].as_array().expect("names").iter().filter_map(Value::as_str).collect();
    let (initial, times) = (numbers(&data["y0"]), numbers(&data["t"]));
    let rate = |name: &str| data["rhs"][name].as_str().expect("a rate for each variable");
    let variables: Vec<_> = names.iter().zip(&initial).map(|(name, start)| (*name, *start, rate(name))).collect();
    let parameters = data["par"].as_object().expect("parameters");
    let parameters: Vec<_> =
        parameters.iter().map(|(name, v)| (name.as_str(), v.as_f64().unwrap_or(f64::NAN))).collect();
    let system = ode_problems::system(name, &variables, &parameters);
    let options = SolveOptions {
        scheme: Scheme::OneStep(method),
        relative: tolerance,
        absolute: absolute(tolerance),
        ..SolveOptions::default()
    };
    let (mut seconds, mut steps, mut found) = (f64::INFINITY, 0, Vec::new());
    for _ in 0..ROUNDS {
        // Compiling the equations counts: CVODE's are compiled beforehand.
        let begin = Instant::now();
        let solution = solve(&system, times[0], times[1], &[times[1]], &options).expect("the problem can be solved");
        seconds = f64::min(seconds, begin.elapsed().as_secs_f64());
        (steps, found) = (solution.work.steps, solution.values[0][..names.len()].to_vec());
    }
    Point { tolerance, error: error(&found, data), seconds, steps }
}
