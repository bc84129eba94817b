//! A simulation for Python: what its class is made of.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Mutex;

use pseudopod::simulation::{Builder, CellId, NewCell, SeriesScope, StepReport};
use pseudopod::{Simulation, SimulationError};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use super::block::Block;
use super::errors::exception;
use super::held::Held;

/// What a step did: its size (s), attempts that were refused, error over the mean edge, whether contacts made it shorter.
type Made = (f64, u32, f64, bool);

/// A type of cells: name, atoms, facets (three numbers of 32 bits each), whether it is closed, loads, fibres, cells.
type TypeFacts<'py> = (String, usize, Bound<'py, PyBytes>, bool, Vec<String>, Vec<String>, Vec<u64>);

/// A document of fields: time, species and their units, size of a box, corner of the first one, values.
type FieldFacts = (f64, Vec<(String, String)>, [f64; 3], [f64; 3], Block);

/// A simulation behind a lock. Whoever waits for the lock, or works behind it, lets other threads of Python go on.
#[pyclass(frozen, module = "pseudopod_stepping._native")]
pub struct Core(Mutex<Held>);

impl Core {
    fn of(py: Python, made: Result<Simulation, SimulationError>) -> PyResult<Self> {
        made.map(|simulation| Self(Mutex::new(Held::new(simulation)))).map_err(|error| exception(py, &error))
    }

    /// Does something with the simulation.
    fn with<T: Send>(
        &self,
        py: Python,
        work: impl FnOnce(&mut Held) -> Result<T, SimulationError> + Send,
    ) -> PyResult<T> {
        let done = py.detach(|| self.0.lock().ok().map(|mut held| work(&mut held)));
        match done {
            Some(done) => done.map_err(|error| exception(py, &error)),
            // The one who held the lock panicked, and Python was told so.
            None => Err(PyRuntimeError::new_err("the simulation broke off in an earlier call: make another one")),
        }
    }
}

/// What a simulation is made with.
fn builder(sets: Vec<(String, String)>, seed: Option<u64>, threads: Option<usize>) -> Builder {
    let builder = sets.into_iter().fold(Simulation::builder(), |builder, (key, value)| builder.set(&key, value));
    let builder = seed.into_iter().fold(builder, Builder::seed);
    threads.into_iter().fold(builder, Builder::threads)
}

fn facts(made: &StepReport) -> Made {
    (made.dt, made.refused, made.error, made.limited)
}

#[pymethods]
impl Core {
    #[staticmethod]
    fn from_file(
        py: Python,
        path: String,
        sets: Vec<(String, String)>,
        seed: Option<u64>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let made = py.detach(|| builder(sets, seed, threads).file(path));
        Self::of(py, made)
    }

    #[staticmethod]
    fn from_text(
        py: Python,
        name: String,
        text: String,
        equations: BTreeMap<String, String>,
        sets: Vec<(String, String)>,
        seed: Option<u64>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let made = py.detach(|| {
            let builder = builder(sets, seed, threads);
            let builder = equations.into_iter().fold(builder, |builder, (path, text)| builder.equations(&path, text));
            builder.text(&name, &text)
        });
        Self::of(py, made)
    }

    /// One step.
    fn step(&self, py: Python) -> PyResult<Made> {
        self.with(py, |held| held.moved().step().map(|made| facts(&made)))
    }

    /// One step that ends at a time at the latest; none where it is reached.
    fn step_towards(&self, py: Python, until: f64) -> PyResult<Option<Made>> {
        let step = |simulation: &mut Simulation| {
            let made = simulation.run_with(until, |_, made| ControlFlow::Break(facts(made)))?;
            Ok(made.break_value())
        };
        self.with(py, |held| step(held.moved()))
    }

    fn time(&self, py: Python) -> PyResult<f64> {
        self.with(py, |held| Ok(held.simulation.time()))
    }

    fn steps(&self, py: Python) -> PyResult<u64> {
        self.with(py, |held| Ok(held.simulation.steps()))
    }

    fn end(&self, py: Python) -> PyResult<f64> {
        self.with(py, |held| Ok(held.simulation.end()))
    }

    fn notices(&self, py: Python) -> PyResult<Vec<String>> {
        self.with(py, |held| Ok(held.simulation.notices().to_vec()))
    }

    fn cells(&self, py: Python) -> PyResult<Vec<u64>> {
        self.with(py, |held| Ok(held.simulation.cells().map(CellId::number).collect()))
    }

    fn types<'py>(&self, py: Python<'py>) -> PyResult<Vec<TypeFacts<'py>>> {
        let known = self.with(py, |held| {
            let of_type = held.simulation.types().map(|kind| {
                let facets: Vec<u8> = kind.facets().iter().flatten().flat_map(|atom| atom.to_ne_bytes()).collect();
                let loads = kind.loads().map(str::to_owned).collect();
                let fibres = kind.fibres().map(str::to_owned).collect();
                let cells = kind.cells().map(CellId::number).collect();
                (kind.name().to_owned(), kind.atom_count(), facets, kind.is_closed(), loads, fibres, cells)
            });
            Ok(of_type.collect::<Vec<_>>())
        })?;
        let told = |(name, atoms, facets, closed, loads, fibres, cells): (_, _, Vec<u8>, _, _, _, _)| {
            (name, atoms, PyBytes::new(py, &facets), closed, loads, fibres, cells)
        };
        Ok(known.into_iter().map(told).collect())
    }

    /// The positions of all atoms.
    fn positions(&self, py: Python) -> PyResult<Block> {
        self.with(py, Held::positions).map(Block::positions)
    }

    /// The positions of all atoms, and which of them are those of a cell: the first, and how many.
    fn positions_of(&self, py: Python, cell: u64) -> PyResult<(Block, usize, usize)> {
        let found = self.with(py, |held| {
            let cell = CellId::new(cell);
            let own = held.simulation.type_of(cell)?;
            let mut first = 0;
            for kind in held.simulation.types() {
                if kind.name() == own.name() {
                    first += kind.cells().take_while(|other| *other != cell).count() * kind.atom_count();
                    break;
                }
                first += kind.cells().len() * kind.atom_count();
            }
            let atoms = own.atom_count();
            Ok((held.positions()?, first, atoms))
        })?;
        Ok((Block::positions(found.0), found.1, found.2))
    }

    /// The series that there are: names, units, whether they have a number for each cell.
    fn series_infos(&self, py: Python) -> PyResult<Vec<(String, String, bool)>> {
        self.with(py, |held| {
            let infos = held.simulation.series_infos().into_iter();
            Ok(infos.map(|info| (info.name, info.unit, info.scope == SeriesScope::Cells)).collect())
        })
    }

    fn series(&self, py: Python, name: &str) -> PyResult<Block> {
        self.with(py, |held| held.simulation.series(name)).map(Block::row)
    }

    fn fields(&self, py: Python) -> PyResult<Vec<String>> {
        self.with(py, |held| Ok(held.simulation.fields().map(|field| field.name().to_owned()).collect()))
    }

    fn field(&self, py: Python, name: &str) -> PyResult<FieldFacts> {
        let (time, species, spacing, origin, values, boxes) = self.with(py, |held| {
            let field = held.simulation.field(name)?;
            let unit = |name: &str| field.unit(name).map(|unit| (name.to_owned(), unit.to_owned()));
            let species = field.species().map(unit).collect::<Result<Vec<_>, _>>()?;
            let time = held.simulation.time();
            Ok((time, species, field.spacing(), field.origin(), field.share(), field.boxes()))
        })?;
        Ok((time, species, spacing, origin, Block::fields(values, boxes)))
    }

    fn set(&self, py: Python, cell: u64, what: &str, value: f64) -> PyResult<()> {
        self.with(py, |held| held.simulation.set(CellId::new(cell), what, value))
    }

    fn set_force(&self, py: Python, cell: u64, force: [f64; 3]) -> PyResult<()> {
        self.with(py, |held| held.simulation.set_force(CellId::new(cell), force))
    }

    /// Forces as three numbers of 64 bits each.
    fn set_atom_forces(&self, py: Python, cell: u64, forces: &[u8]) -> PyResult<()> {
        let (numbers, _) = forces.as_chunks::<8>();
        let numbers: Vec<f64> = numbers.iter().map(|bytes| f64::from_ne_bytes(*bytes)).collect();
        let (forces, _) = numbers.as_chunks::<3>();
        self.with(py, |held| held.simulation.set_atom_forces(CellId::new(cell), forces))
    }

    fn clear_forces(&self, py: Python) -> PyResult<()> {
        self.with(py, |held| {
            held.simulation.clear_forces();
            Ok(())
        })
    }

    /// Adds cells at rest around centres (one position each) or with positions of all atoms.
    fn add_cells(
        &self,
        py: Python,
        kind: &str,
        at_rest: bool,
        cells: Vec<Vec<[f64; 3]>>,
        parents: Vec<Option<u64>>,
    ) -> PyResult<Vec<u64>> {
        let of = |(positions, parent): (Vec<[f64; 3]>, Option<u64>)| {
            let new = match positions.as_slice() {
                [centre] if at_rest => NewCell::at(*centre),
                _ => NewCell::with_positions(positions),
            };
            parent.into_iter().fold(new, |new, parent| new.born_from(CellId::new(parent)))
        };
        let new: Vec<NewCell> = cells.into_iter().zip(parents).map(of).collect();
        let ids = self.with(py, |held| held.moved().add_cells(kind, &new))?;
        Ok(ids.into_iter().map(CellId::number).collect())
    }

    fn remove_cells(&self, py: Python, cells: Vec<u64>) -> PyResult<()> {
        let cells: Vec<CellId> = cells.into_iter().map(CellId::new).collect();
        self.with(py, |held| held.moved().remove_cells(&cells))
    }

    fn checkpoint<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(py, |held| Ok(held.simulation.checkpoint()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn restore(&self, py: Python, checkpoint: &[u8]) -> PyResult<()> {
        self.with(py, |held| held.moved().restore(checkpoint))
    }
}
