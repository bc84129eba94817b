//! What a step of crawling cells takes, and what of it their chemistry takes: fields, oscillators and the chemistry of their membranes.
//! Mechanics is that of the same cells, pseudopods included, where nothing touches; contacts are what touching adds, chemistry what it
//! adds to both. Pseudopods cannot be left out alone, as cells that do not push have other contacts to solve; in a profile their own
//! functions take a hundredth. Receptors with noise on every atom read a field that diffuses, and choose pseudopods; two oscillators in each cell
//! say when these are pushed and drawn in; bonds hold the cells on glass, and cells touch each other.

use std::path::Path;
use std::time::Instant;

use pseudopod::experiment::{Compiled, Document, compile, settle_start};
use pseudopod::mechanics::integrator::StepSize;
use pseudopod::sim::{Model, State, Workspace, begin_chemistry, step};

/// Number of cells, simulated time from which on steps are timed, s, and steps that are timed.
const SCENES: [(usize, f64, usize); 2] = [(100, 60.0, 60), (10_000, 20.0, 6)];

/// How often each step is made.
const PASSES: usize = 5;

/// A field that spreads and fades, which the cells release.
const FIELD: &str = r#"<eml name="signal" time_unit="s">
  <grid dimension="2" spacing="5" unit="um"/>
  <field id="attractant" unit="nM" diffusion="100" decay="0.01" initial="500"/>
</eml>"#;

/// Cells side by side on glass.
fn text(cells: usize) -> String {
    let side = (cells as f64).sqrt().ceil() as usize;
    let size = 12.0 * side as f64 + 40.0;
    format!(
        r#"
title = "Cells crawl"
[run]
until = "1 h"
integrator = {{ max_step = "2 s", tolerance = 0.1 }}
[cells.amoeba]
number = {cells}
mesh = {{ shape = "icosphere", radius = "5 um", level = 1 }}
placement = {{ grid = [{side}, {side}, 1], spacing = "12 um" }}
chemistry = ["receptors", "cycle"]
[cells.amoeba.mechanics]
drag = "2000 pN s/um"
shape_memory = {{ shape_modulus = "60 pN/um" }}
[cells.amoeba.pseudopods]
pressure = "30 Pa"
contraction = "100 pN"
pause = "4 s"
protrusion = "12 s"
retraction = "10 s"
[chemistry.signal]
document = "signal.eml"
size = ["{size} um", "{size} um", "0 um"]
[chemistry.receptors]
document = "receptors.eml"
links = [{{ from = "cell.atoms.field[attractant]", to = "system.c" }}]
[chemistry.cycle]
document = "cycle.eml"
links = [{{ from = "system.protrusion", to = "cell.secretion[attractant]", gain = 100 }}]
[[planes]]
name = "glass"
point = ["0 um", "0 um", "-5.05 um"]
normal = [0, 0, 1]
[contact]
proximity = "1.4 um"
strength = "0 Pa"
[[contact.between]]
types = ["amoeba", "glass"]
energy = "50 pN/um"
range = "1.5 um"
shear_strength = "100 Pa"
bonds = {{ density = "20 /um^2", on = "0.05 /s", off = "0.001 /s", force = "10 pN", start = 1 }}
"#
    )
}

/// A scene and its start.
fn scene(cells: usize) -> (Model, State) {
    let (folder, root) = (tempfile::tempdir().expect("a folder"), Path::new(env!("CARGO_MANIFEST_DIR")));
    std::fs::write(folder.path().join("signal.eml"), FIELD).expect("a document");
    for (from, to) in [("eml/receptors.eml", "receptors.eml"), ("experiments/motility/cycle.eml", "cycle.eml")] {
        std::fs::copy(root.join(from), folder.path().join(to)).expect("a document of the repository");
    }
    let document = Document::parse("crawling.toml", &text(cells), folder.path(), &[]);
    let document = document.unwrap_or_else(|error| panic!("{error}")).with_equations();
    let mut compiled = compile(&document).unwrap_or_else(|error| panic!("{error}"));
    settle_start(&document, &mut compiled).unwrap_or_else(|error| panic!("{error}"));
    let Compiled { model, state, .. } = compiled;
    (model, state)
}

/// A step that was made: the state before it and its size, s.
type Made = (State, f64);

/// Seconds that a model takes for these steps, each from the state before it: the least of some passes.
fn time_steps(model: &Model, made: &[Made]) -> f64 {
    let (mut model, mut least) = (model.clone(), vec![f64::INFINITY; made.len()]);
    let mut ws = Workspace::new(&model);
    for _ in 0..PASSES {
        for ((before, dt), least) in made.iter().zip(&mut least) {
            let mut state = before.clone();
            model.integrator.size = StepSize::Fixed(*dt);
            let began = Instant::now();
            step(&model, &mut state, &mut ws).expect("a step that was made before");
            *least = began.elapsed().as_secs_f64().min(*least);
        }
    }
    least.iter().sum()
}

/// The same without some of its systems and fields, and the links that go with them.
fn without(model: &Model, change: impl Fn(&mut Model)) -> Model {
    let mut model = model.clone();
    change(&mut model);
    model
}

fn measure(cells: usize, from: f64, steps: usize) {
    let (model, mut state) = scene(cells);
    let mut ws = Workspace::new(&model);
    begin_chemistry(&model, &mut state, &mut ws).expect("a start");
    while state.time < from {
        step(&model, &mut state, &mut ws).expect("a step");
    }
    let (start, mut made) = (state.time, Vec::<Made>::new());
    for _ in 0..steps {
        let before = state.clone();
        let done = step(&model, &mut state, &mut ws).expect("a step");
        made.push((before, done.dt));
    }
    let dt = (state.time - start) / steps as f64;
    let whole = time_steps(&model, &made);
    let inert = without(&model, |model| model.chemistry = Default::default());
    let without_chemistry = time_steps(&inert, &made);
    let bodies = time_steps(&without(&inert, |model| model.contact = None), &made);
    let each = |seconds: f64| 1e3 * seconds / steps as f64;
    println!(
        "{cells:6} {dt:8.2} {:10.2} {:10.2} {:10.2} {:10.2} {:8.0} %",
        each(whole),
        each(bodies),
        each(without_chemistry - bodies),
        each(whole - without_chemistry),
        100.0 * (whole - without_chemistry) / without_chemistry,
    );
}

fn main() {
    println!(
        "{:>6} {:>8} {:>10} {:>10} {:>10} {:>10} {:>10}",
        "cells", "step, s", "ms a step", "mechanics", "contacts", "chemistry", "over rest"
    );
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (cells, from, steps) in SCENES {
        pool.install(|| measure(cells, from, steps));
    }
}
