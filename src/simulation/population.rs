//! Cells that a program adds and removes between steps.

use super::error::SimulationError;
use super::id::CellId;
use super::stepping::Simulation;
use crate::Vec3;
use crate::sim;

/// A cell to be added.
#[derive(Debug, Clone, PartialEq)]
pub struct NewCell {
    shape: Shape,
    parent: Option<CellId>,
}

/// Where its atoms are.
#[derive(Debug, Clone, PartialEq)]
enum Shape {
    /// As in the mesh at rest, around this centre, µm.
    AtRest([f64; 3]),
    /// At these positions, µm.
    Atoms(Vec<[f64; 3]>),
}

impl NewCell {
    /// A cell at rest around a centre, µm.
    pub fn at(centre: [f64; 3]) -> Self {
        Self { shape: Shape::AtRest(centre), parent: None }
    }

    /// A cell whose atoms are at these positions, µm, in the order of the type's mesh.
    pub fn with_positions(positions: Vec<[f64; 3]>) -> Self {
        Self { shape: Shape::Atoms(positions), parent: None }
    }

    /// The same as a child of another cell, which results tell. The parent may have been removed.
    pub fn born_from(self, parent: CellId) -> Self {
        Self { parent: Some(parent), ..self }
    }

    fn compiled(&self, rest: &[Vec3]) -> sim::NewCell {
        let positions = match &self.shape {
            Shape::AtRest(centre) => rest.iter().map(|x| x + Vec3::from(*centre)).collect(),
            Shape::Atoms(positions) => positions.iter().map(|x| Vec3::from(*x)).collect(),
        };
        sim::NewCell { positions, parent: self.parent.map(CellId::number) }
    }
}

impl Simulation {
    /// Adds cells of a type, behind those that it has, and returns their ids, which no cell had before. What is not known of a new
    /// cell is as at the start of a run: its volume at rest, its walk, its systems.
    ///
    /// ```
    /// # use pseudopod::simulation::{NewCell, Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// simulation.run_until(1.0)?;
    /// let added = simulation.add_cells("squeezed", &[NewCell::at([0.0, 20.0, 0.0]), NewCell::at([20.0, 20.0, 0.0])])?;
    /// assert_eq!(simulation.cell_count(), 4);
    /// simulation.run_until(2.0)?;
    /// simulation.remove_cells(&added[..1])?;
    /// assert!(simulation.type_of(added[0]).is_err() && simulation.type_of(added[1]).is_ok());
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a type that is not there, [`SimulationError::Population`] for cells of another mesh and for those
    /// that would be in others or behind planes, where cells touch; the simulation is then as it was.
    pub fn add_cells(&mut self, kind: &str, cells: &[NewCell]) -> Result<Vec<CellId>, SimulationError> {
        let number = self.model.kinds.iter().position(|known| known.name == kind);
        let number = number.ok_or_else(|| SimulationError::Unknown {
            what: "type of cells",
            name: kind.to_owned(),
            known: self.types().map(|kind| kind.name().to_owned()).collect(),
        })?;
        let rest = &self.model.kinds[number].rest.positions;
        let cells: Vec<sim::NewCell> = cells.iter().map(|cell| cell.compiled(rest)).collect();
        let ids =
            self.within(|this| sim::add_cells(&this.model, &mut this.state, &mut this.scratch, number, &cells))?;
        Ok(ids.into_iter().map(CellId::new).collect())
    }

    /// Removes cells, with all that they carry. The others keep their ids and their order.
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`] with the first that is not there; the simulation is then as it was.
    pub fn remove_cells(&mut self, cells: &[CellId]) -> Result<(), SimulationError> {
        cells.iter().try_for_each(|cell| self.kind_and_number(*cell).map(|_| ()))?;
        let ids: Vec<u64> = cells.iter().map(|cell| cell.number()).collect();
        Ok(self.within(|this| sim::remove_cells(&this.model, &mut this.state, &mut this.scratch, &ids))?)
    }
}
