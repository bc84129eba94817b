//! Experiments with chemistry whose documents are given with them, step by step.
#![allow(dead_code)]

use pseudopod::experiment::{Compiled, Document, compile};
use pseudopod::sim::{State, StepReport, Trouble, Workspace, begin_chemistry, step};

/// A run of an experiment whose documents of equations are given with it.
pub struct Scene {
    pub compiled: Compiled,
    pub ws: Workspace,
}

/// `documents` are pairs of a name and the text of its document; `text` is the rest of the experiment.
pub fn scene(documents: &[(&str, &str)], text: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let mut text = text.to_owned();
    for (name, eml) in documents {
        std::fs::write(folder.path().join(format!("{name}.eml")), eml).unwrap();
        if !text.contains(&format!("[chemistry.{name}]")) {
            text += &format!("\n[chemistry.{name}]\ndocument = \"{name}.eml\"\n");
        }
    }
    let text = format!("title = \"coupling\"\n{text}");
    let document = Document::parse("test.toml", &text, folder.path(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let compiled = compile(&document).unwrap_or_else(|error| panic!("{error}"));
    let ws = Workspace::new(&compiled.model);
    Scene { compiled, ws }
}

impl Scene {
    /// One step.
    pub fn step(&mut self) -> Result<StepReport, Trouble> {
        step(&self.compiled.model, &mut self.compiled.state, &mut self.ws)
    }

    /// What links and events do at the start.
    pub fn begin(&mut self) {
        begin_chemistry(&self.compiled.model, &mut self.compiled.state, &mut self.ws).unwrap();
    }

    /// All steps to the end of the run.
    pub fn run(&mut self) {
        while self.compiled.state.time < self.compiled.model.until {
            self.step().unwrap();
        }
    }

    /// Steps until a time, with what is asked of the run after each: (time in s, answer).
    pub fn rows_until<T>(&mut self, until: f64, row: impl Fn(&Self) -> T) -> Vec<(f64, T)> {
        let mut rows = Vec::new();
        while self.state().time < until {
            self.step().unwrap();
            rows.push((self.state().time, row(self)));
        }
        rows
    }

    /// Steps until one fails, which must leave the state as it was.
    pub fn until_trouble(&mut self) -> Trouble {
        loop {
            let before = self.state().clone();
            if let Err(trouble) = self.step() {
                assert_eq!(*self.state(), before, "the state is the one before the step");
                return trouble;
            }
        }
    }

    /// Where the run is.
    pub fn state(&self) -> &State {
        &self.compiled.state
    }

    /// The run as it would be if it were stopped now and resumed from its checkpoint.
    pub fn stop_and_resume(&mut self) {
        let bytes = postcard::to_stdvec(self.state()).unwrap();
        self.compiled.state = postcard::from_bytes(&bytes).unwrap();
        self.ws = Workspace::new(&self.compiled.model);
    }

    /// The mean of a cell's atoms along an axis.
    pub fn position(&self, cell: usize, axis: usize) -> f64 {
        let kind = &self.compiled.model.kinds[0];
        let atoms = self.state().kinds[0].cell(kind, cell);
        atoms.iter().map(|p| p[axis]).sum::<f64>() / atoms.len() as f64
    }

    /// The value of a quantity of a system for one of its members.
    pub fn value(&self, system: usize, quantity: &str, member: usize) -> f64 {
        let reactor = &self.compiled.model.chemistry.reactors[system];
        let number = reactor.program.names.iter().position(|name| name == quantity).unwrap();
        let population = &self.state().chemistry.populations[system];
        let mut values = vec![0.0; population.cells()];
        let time = self.state().chemistry.times[system] / reactor.seconds;
        population.observe(&reactor.program, number as u32, time, &mut values);
        values[member]
    }
}

/// A sphere of 42 atoms that has the system `own`; steps of a fixed size.
pub fn one_cell(until: &str, step: &str) -> String {
    sphere(1, until, step)
}

/// A sphere of radius 5 µm, of a level of the icosphere, that has the system `own`; steps of a fixed size.
pub fn sphere(level: usize, until: &str, step: &str) -> String {
    format!(
        r#"
[run]
until = "{until}"
integrator = {{ step = "{step}" }}
[output]
every = "{until}"
[cells.cell]
mesh = {{ shape = "icosphere", radius = "5 um", level = {level} }}
mechanics = {{ drag = "20 pN s/um", shape_memory = {{ shape_modulus = "10 pN/um" }} }}
chemistry = ["own"]
"#
    )
}

/// Cells that wander, each with the system `own`.
const CROWD: &str = r#"
seed = 4
[run]
until = "40 s"
integrator = { max_step = "1 s" }
[output]
every = "10 s"
[cells.cell]
number = 37
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { random_from = ["-50 um", "-50 um", "0 um"], random_to = ["50 um", "50 um", "0 um"] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
motility = { brownian = { speed = "5 um/min", persistence = "5 s" } }
chemistry = ["own"]
"#;

/// A crowd of 37 cells after some steps on some threads; before each step something may be done to it.
pub fn crowd(threads: usize, documents: &[(&str, &str)], steps: usize, before: impl Fn(&mut Scene) + Sync) -> Scene {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut scene = scene(documents, CROWD);
        for _ in 0..steps {
            before(&mut scene);
            scene.step().unwrap();
        }
        scene
    })
}
