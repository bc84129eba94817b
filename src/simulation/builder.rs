//! How a simulation is made from what a user wrote.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::cancel::CancelToken;
use super::error::SimulationError;
use super::stepping::Simulation;
use crate::error::{Error, Fault, Result};
use crate::experiment::{
    Compiled, Document, Experiment, PushedApart, Schedule, Settling, compile, notices, prepare, settle_start_told,
};

/// What a simulation is made with: settings, a seed, threads, a token, texts of equations. Its last word says what from.
///
/// ```
/// # use pseudopod::simulation::{CancelToken, Simulation, EXAMPLE};
/// let simulation = Simulation::builder()
///     .set("run.until", "20 s")
///     .set("cells.pulled.loads[0].force", "8 pN")
///     .seed(7)
///     .threads(1)
///     .text("example", EXAMPLE)?;
/// assert_eq!(simulation.end(), 20.0);
/// # Ok::<(), pseudopod::simulation::SimulationError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Builder {
    sets: Vec<String>,
    equations: BTreeMap<String, String>,
    threads: Option<usize>,
    cancel: CancelToken,
}

/// A simulation that has not begun, and what a run needs to know besides.
pub(crate) struct Ready {
    pub simulation: Simulation,
    pub schedule: Schedule,
    pub pushed: PushedApart,
}

impl Simulation {
    /// What a simulation is made with, where the plain constructors do not do.
    pub fn builder() -> Builder {
        Builder::default()
    }

    /// A simulation of a checked document.
    ///
    /// # Errors
    /// [`SimulationError::Input`] with all faults, [`SimulationError::Trouble`] when links or events of the start fail.
    pub fn from_document(document: &Document) -> std::result::Result<Self, SimulationError> {
        Self::builder().document(document)
    }

    /// A simulation of an experiment in TOML; `name` stands in messages. Paths start from the working folder.
    ///
    /// # Errors
    /// As [`Simulation::from_document`].
    pub fn from_text(name: &str, text: &str) -> std::result::Result<Self, SimulationError> {
        Self::builder().text(name, text)
    }

    /// A simulation of a document in a file.
    ///
    /// # Errors
    /// As [`Simulation::from_document`].
    pub fn from_file(path: impl AsRef<Path>) -> std::result::Result<Self, SimulationError> {
        Self::builder().file(path)
    }

    /// A simulation of an experiment built in Rust.
    ///
    /// ```
    /// use pseudopod::experiment::{Cap, CapExtent, CellType, Course, Experiment, Load, Mechanics, Mesh, Selection};
    /// use pseudopod::experiment::{ShapeMemory, Spread};
    /// use pseudopod::simulation::Simulation;
    /// use pseudopod::units::{Drag, Force, Length, LineStiffness, Time};
    ///
    /// let mechanics = Mechanics {
    ///     drag: Some(Drag::new(20.0)),
    ///     shape_memory: Some(ShapeMemory::of_modulus(LineStiffness::new(5.0))),
    ///     ..Mechanics::default()
    /// };
    /// let mut cell = CellType::new(Mesh::Icosphere { radius: Length::new(5.0), level: 1, finest: None }, mechanics);
    /// cell.applied.loads.push(Load {
    ///     name: "pull".into(),
    ///     selection: Selection::Cap(Cap { direction: [1.0, 0.0, 0.0], extent: CapExtent::Number(3) }),
    ///     direction: [1.0, 0.0, 0.0],
    ///     force: Course::Constant(Force::new(10.0)),
    ///     spread: Spread::Equal,
    /// });
    /// let mut experiment = Experiment::new("A pulled cell", Time::new(30.0));
    /// experiment.cells.insert("white".into(), cell);
    /// let mut simulation = Simulation::from_experiment(experiment)?;
    /// simulation.run_until(1.0)?;
    /// assert!(simulation.series("position_x")?[0] > 0.0, "the cell follows the pull");
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Simulation::from_document`]; the locations of faults are in the text that the experiment is written as.
    pub fn from_experiment(experiment: Experiment) -> std::result::Result<Self, SimulationError> {
        Self::builder().experiment(experiment)
    }

    /// Makes steps with this many threads instead of those of the program. Results do not depend on it.
    ///
    /// # Errors
    /// [`SimulationError::Input`] for 0 threads, or more than the system starts.
    pub fn set_threads(&mut self, threads: usize) -> std::result::Result<(), SimulationError> {
        self.pool = Some(pool_of(threads)?);
        Ok(())
    }
}

impl Builder {
    /// Changes a key of the document, as `--set` does: `set("run.until", "10 s")`.
    pub fn set(mut self, key: &str, value: impl std::fmt::Display) -> Self {
        self.sets.push(format!("{key}={value}"));
        self
    }

    /// Another seed.
    pub fn seed(self, seed: u64) -> Self {
        self.set("seed", seed)
    }

    /// The text of a document of equations, in place of the file that the experiment names by this path.
    pub fn equations(mut self, path: &str, text: impl Into<String>) -> Self {
        self.equations.insert(path.to_owned(), text.into());
        self
    }

    /// Threads of its own; without, those of the program are used.
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = Some(threads);
        self
    }

    /// The same, where none stands for those of the program.
    pub(crate) fn threads_or_all(self, threads: Option<usize>) -> Self {
        Self { threads, ..self }
    }

    /// The token that stops it.
    pub fn cancel_token(mut self, token: CancelToken) -> Self {
        self.cancel = token;
        self
    }

    /// A simulation of an experiment in TOML; `name` stands in messages. Paths start from the working folder.
    ///
    /// # Errors
    /// As [`Simulation::from_document`].
    pub fn text(self, name: &str, text: &str) -> std::result::Result<Simulation, SimulationError> {
        let document = Document::parse_beside(name, text, &PathBuf::from("."), &self.sets, self.equations.clone())?;
        self.make(&document)
    }

    /// A simulation of a document in a file.
    ///
    /// # Errors
    /// As [`Simulation::from_document`].
    pub fn file(self, path: impl AsRef<Path>) -> std::result::Result<Simulation, SimulationError> {
        let document = Document::read(path.as_ref(), &[])?;
        self.document(&document)
    }

    /// A simulation of an experiment built in Rust.
    ///
    /// # Errors
    /// As [`Simulation::from_experiment`].
    pub fn experiment(self, experiment: Experiment) -> std::result::Result<Simulation, SimulationError> {
        let document = Document::from_experiment(experiment)?;
        self.document(&document)
    }

    /// A simulation of a checked document, with the settings of this builder after its own.
    ///
    /// # Errors
    /// As [`Simulation::from_document`].
    pub fn document(self, document: &Document) -> std::result::Result<Simulation, SimulationError> {
        if self.sets.is_empty() && self.equations.is_empty() {
            return self.make(document);
        }
        let sets = [document.sets.as_slice(), &self.sets].concat();
        let mut equations = document.equations.clone();
        equations.extend(self.equations.clone());
        let (source, folder) = (&document.source, &document.base_dir);
        let changed = Document::parse_beside(&source.name, &source.text, folder, &sets, equations)?;
        self.make(&changed)
    }

    fn make(&self, document: &Document) -> std::result::Result<Simulation, SimulationError> {
        let mut simulation = self.ready(document)?.simulation;
        simulation.begin()?;
        Ok(simulation)
    }

    /// Compiles a document and moves cells that overlap apart.
    pub(crate) fn ready(&self, document: &Document) -> Result<Ready> {
        self.ready_told(document, &|_| ())
    }

    /// The same, telling from time to time what is under way before the start.
    pub(crate) fn ready_told(&self, document: &Document, tell: &(dyn Fn(Settling) + Sync)) -> Result<Ready> {
        let pool = self.threads.map(pool_of).transpose()?;
        let prepared = prepare(document)?;
        let mut notices = notices(document, &prepared);
        let mut compiled = prepared.build();
        let pushed = settle_start_told(document, &mut compiled, tell)?;
        notices.extend(pushed.notice());
        let mut ready = self.assemble(compiled, pushed, pool);
        ready.simulation.notices = notices;
        Ok(ready)
    }

    /// The same for a state that will be restored: where cells start does not matter.
    pub(crate) fn ready_to_restore(&self, document: &Document) -> Result<Ready> {
        let pool = self.threads.map(pool_of).transpose()?;
        Ok(self.assemble(compile(document)?, PushedApart::default(), pool))
    }

    fn assemble(&self, compiled: Compiled, pushed: PushedApart, pool: Option<Arc<rayon::ThreadPool>>) -> Ready {
        let mut simulation = Simulation::assemble(compiled.model, compiled.state);
        (simulation.pool, simulation.cancel) = (pool, self.cancel.clone());
        Ready { simulation, schedule: compiled.schedule, pushed }
    }
}

/// Threads of a simulation.
fn pool_of(threads: usize) -> Result<Arc<rayon::ThreadPool>> {
    if threads == 0 {
        let fault =
            Fault::new("a run cannot be made by 0 threads").help("ask for 1 or more; leave it out for all cores");
        return Err(Error::input(fault));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| Error::Machine {
        message: format!("{threads} threads could not be started: {error}"),
        help: "ask for fewer with --threads".into(),
    })?;
    Ok(Arc::new(pool))
}
