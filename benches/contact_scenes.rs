//! The whole step and its contacts in the five scenes of Carra, Martiel and Promayon 2007, as the experiments of this
//! repository have them: milliseconds of processor time a step on one thread, from a state in which the cells touch.

use std::path::Path;
use std::time::Instant;

use pseudopod::experiment::{Compiled, Document, compile, settle_start};
use pseudopod::sim::contact::find_contacts;
use pseudopod::sim::{Model, State, Workspace, begin_chemistry, step};

/// Steps that are timed.
const STEPS: u32 = 200;

/// An experiment, the simulated time from which steps are timed, s, and what the paper's contacts took, ms a step.
const SCENES: [(&str, &str, f64, &str); 5] = [
    ("falling_spheres", "figure 2", 100.0, "549"),
    ("sticky_pair", "figure 3", 10.0, "10 and 2"),
    ("rolling_ball", "figure 4", 60.0, "33"),
    ("four_bunnies", "figure 5", 50.0, "576"),
    ("aggregation", "figure 6", 200.0, "777"),
];

/// Seconds that this thread has had the processor, where the system tells, so that other programs do not count; or else
/// seconds on the clock.
fn seconds(since: &Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|told| told.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |n| 1e-9 * n)
}

/// What some steps cost.
struct Cost {
    seconds: f64,
    tries: u32,
    sweeps: u32,
    rows: usize,
}

/// Makes the steps that are timed.
fn time_steps(model: &Model, state: &mut State, ws: &mut Workspace) -> Cost {
    let (mut tries, mut sweeps, mut rows) = (0, 0, 0);
    let clock = Instant::now();
    let began = seconds(&clock);
    for _ in 0..STEPS {
        tries += 1 + step(model, state, ws).expect("a step").refused;
        sweeps += ws.contact.sweeps;
        rows += ws.contact.rows.len();
    }
    Cost { seconds: seconds(&clock) - began, tries, sweeps, rows }
}

fn measure(name: &str, figure: &str, from: f64, then: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments").join(name).join("experiment.toml");
    let document = Document::read(&path, &[]).expect("a good document").with_equations();
    let mut compiled = compile(&document).expect("a good experiment");
    settle_start(&document, &mut compiled).expect("a good start");
    let Compiled { model, mut state, .. } = compiled;
    let mut ws = Workspace::new(&model);
    begin_chemistry(&model, &mut state, &mut ws).expect("a start");
    while state.time < from {
        step(&model, &mut state, &mut ws).expect("a step");
    }
    // The same cells as if they passed through each other: the rest of the step.
    let (alone, mut trial) = (Model { contact: None, ..model.clone() }, state.clone());
    let mut spare = Workspace::new(&alone);
    step(&alone, &mut trial, &mut spare).expect("a step");
    let without = time_steps(&alone, &mut trial, &mut spare);
    let with = time_steps(&model, &mut state, &mut ws);
    let (clock, mut finding) = (Instant::now(), 0.0);
    for _ in 0..STEPS / 4 {
        step(&model, &mut state, &mut ws).expect("a step");
        let began = seconds(&clock);
        find_contacts(&model, &state, &mut ws);
        finding += seconds(&clock) - began;
    }
    let each = |seconds: f64, count: u32| 1e3 * seconds / f64::from(count);
    println!(
        "{name:16} {figure:9} {:6} {:8.0} {:10.2} {:10.2} {:10.2} {:10.2} {:8.1} {then:>9}",
        model.atoms(),
        with.rows as f64 / f64::from(STEPS),
        each(with.seconds, STEPS),
        f64::from(with.tries) / f64::from(STEPS),
        each(with.seconds, with.tries) - each(without.seconds, without.tries),
        each(finding, STEPS / 4),
        f64::from(with.sweeps) / f64::from(STEPS),
    );
}

fn main() {
    println!(
        "{:16} {:9} {:>6} {:>8} {:>10} {:>10} {:>10} {:>10} {:>8} {:>9}",
        "scene", "paper", "atoms", "contacts", "ms a step", "tries", "contact ms", "find ms", "sweeps", "2007, ms"
    );
    let only = std::env::args().nth(1).filter(|name| !name.starts_with('-'));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (name, figure, from, then) in SCENES {
        if only.as_deref().is_none_or(|only| only == name) {
            pool.install(|| measure(name, figure, from, then));
        }
    }
}
