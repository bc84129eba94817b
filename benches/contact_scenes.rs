//! The whole step and its contacts in the five scenes of Carra, Martiel and Promayon 2007, as the experiments of this
//! repository have them: milliseconds a step on one thread, from a state in which the cells touch, by the law of surfaces that
//! the documents have and by the strengths of atoms that earlier versions had.

use std::path::Path;
use std::time::Instant;

use pseudopod::experiment::{Compiled, Document, compile, settle_start};
use pseudopod::mechanics::integrator::StepSize;
use pseudopod::sim::{Model, State, Workspace, begin_chemistry, step};

/// Steps that are timed.
const STEPS: u32 = 300;

/// How often each is made.
const PASSES: u32 = 7;

/// An experiment, the simulated time from which steps are timed, s, and what the paper's contacts took, ms a step.
const SCENES: [(&str, &str, f64, &str); 5] = [
    ("falling_spheres", "figure 2", 100.0, "549"),
    ("sticky_pair", "figure 3", 10.0, "10 and 2"),
    ("rolling_ball", "figure 4", 60.0, "33"),
    ("four_bunnies", "figure 5", 50.0, "576"),
    ("aggregation", "figure 6", 200.0, "777"),
];

/// A step that was made: the state before it and its size, s.
type Made = (State, f64);

/// Makes these steps again, each from the state before it, and tells the seconds of each: the least of some passes, for
/// what else the machine does only slows a step.
fn time_steps(model: &Model, made: &[Made]) -> Vec<f64> {
    let (mut model, mut least) = (model.clone(), vec![f64::INFINITY; made.len()]);
    for _ in 0..PASSES {
        let mut ws = Workspace::new(&model);
        for ((before, dt), least) in made.iter().zip(&mut least) {
            let mut state = before.clone();
            model.integrator.size = StepSize::Fixed(*dt);
            let began = Instant::now();
            step(&model, &mut state, &mut ws).expect("a step that was made before");
            *least = began.elapsed().as_secs_f64().min(*least);
        }
    }
    least
}

/// What differs from the document, and how a law is called in the table.
const LAWS: [(&[&str], &str); 2] = [(&[], "surfaces"), (&["contact.model=adhesives"], "atoms")];

fn measure((name, figure, from, then): (&str, &str, f64, &str), (set, law): (&[&str], &str)) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments").join(name).join("experiment.toml");
    let set: Vec<String> = set.iter().map(|&set| set.to_owned()).collect();
    let document = Document::read(&path, &set).expect("a good document").with_equations();
    let mut compiled = compile(&document).expect("a good experiment");
    settle_start(&document, &mut compiled).expect("a good start");
    let Compiled { model, mut state, .. } = compiled;
    let mut ws = Workspace::new(&model);
    begin_chemistry(&model, &mut state, &mut ws).expect("a start");
    while state.time < from {
        step(&model, &mut state, &mut ws).expect("a step");
    }
    let (mut made, mut tries, mut sweeps, mut rows) = (Vec::<Made>::new(), 0, 0, 0);
    for _ in 0..STEPS {
        let before = state.clone();
        let done = step(&model, &mut state, &mut ws).expect("a step");
        made.push((before, done.dt));
        tries += 1 + done.refused;
        sweeps += ws.contact.sweeps;
        rows += ws.contact.rows.len();
    }
    let with: f64 = time_steps(&model, &made).iter().sum();
    // The same steps as if the cells passed through each other: the rest of the step.
    let without: f64 = time_steps(&Model { contact: None, ..model.clone() }, &made).iter().sum();
    let each = |sum: f64| sum / f64::from(STEPS);
    let tries = each(f64::from(tries));
    let simulated: f64 = made.iter().map(|(_, dt)| dt).sum();
    println!(
        "{name:16} {figure:9} {law:9} {:6} {:8.0} {:10.2} {tries:10.2} {:10.3} {:8.1} {:12.1} {then:>9}",
        state.atoms(&model),
        each(rows as f64),
        1e3 * each(with) * tries,
        1e3 * each(with - without),
        each(f64::from(sweeps)),
        1e3 * with * tries / simulated,
    );
}

fn main() {
    println!(
        "{:16} {:9} {:9} {:>6} {:>8} {:>10} {:>10} {:>10} {:>8} {:>12} {:>9}",
        "scene",
        "paper",
        "law",
        "atoms",
        "contacts",
        "ms a step",
        "tries",
        "contact ms",
        "sweeps",
        "ms a second",
        "2007, ms"
    );
    let only = std::env::args().skip(1).find(|name| !name.starts_with('-'));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for scene in SCENES {
        if only.as_deref().is_none_or(|only| only == scene.0) {
            pool.install(|| LAWS.iter().for_each(|law| measure(scene, *law)));
        }
    }
}
