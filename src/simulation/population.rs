//! Cells that come and go while a simulation runs.

use super::error::SimulationError;
use super::id::CellId;
use super::stepping::Simulation;
use crate::Vec3;
use crate::sim::{NewCell, add_cells, remove_cells};

impl Simulation {
    /// Adds cells of a type at rest around these centres, µm, behind those that the type has; returns who they are. Nobody ever
    /// gets the id of a cell again that was removed.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// let added = simulation.add_cells("pulled", &[[0.0, 40.0, 0.0], [0.0, 80.0, 0.0]])?;
    /// simulation.run_until(0.2)?;
    /// simulation.remove_cells(&added[..1])?;
    /// simulation.run_until(0.4)?;
    /// assert!(simulation.position_of(added[0]).is_err() && simulation.position_of(added[1]).is_ok());
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Unknown`] for a type that is not there, [`SimulationError::Population`] for cells that would overlap others
    /// or be behind planes where the experiment has contacts. Nothing has changed then.
    pub fn add_cells(&mut self, of_type: &str, centres: &[[f64; 3]]) -> Result<Vec<CellId>, SimulationError> {
        let kind = self.type_number(of_type)?;
        let rest = &self.model.kinds[kind].rest.positions;
        let around = |centre: &[f64; 3]| rest.iter().map(|x| x + Vec3::from(*centre)).collect();
        let cells: Vec<NewCell> =
            centres.iter().map(|centre| NewCell { positions: around(centre), parent: None }).collect();
        self.add(kind, &cells)
    }

    /// Adds a cell of a type whose atoms stand at these positions, µm, born from another where a parent is given.
    ///
    /// # Errors
    /// As [`Simulation::add_cells`]; [`SimulationError::Population`] for another number of atoms than the type has, too.
    pub fn add_cell(
        &mut self,
        of_type: &str,
        positions: &[[f64; 3]],
        parent: Option<CellId>,
    ) -> Result<CellId, SimulationError> {
        let kind = self.type_number(of_type)?;
        let positions = positions.iter().map(|x| Vec3::from(*x)).collect();
        let cell = NewCell { positions, parent: parent.map(CellId::number) };
        Ok(self.add(kind, &[cell])?[0])
    }

    /// Removes cells, and with them all that joins them to others.
    ///
    /// # Errors
    /// [`SimulationError::Population`] with the first cell that is not there; nothing has changed then.
    pub fn remove_cells(&mut self, cells: &[CellId]) -> Result<(), SimulationError> {
        let ids: Vec<u64> = cells.iter().map(|cell| cell.number()).collect();
        Ok(remove_cells(&self.model, &mut self.state, &mut self.scratch, &ids)?)
    }

    fn add(&mut self, kind: usize, cells: &[NewCell]) -> Result<Vec<CellId>, SimulationError> {
        let ids = add_cells(&self.model, &mut self.state, &mut self.scratch, kind, cells)?;
        Ok(ids.into_iter().map(CellId::new).collect())
    }

    fn type_number(&self, name: &str) -> Result<usize, SimulationError> {
        let names = || self.model.kinds.iter().map(|kind| kind.name.as_str());
        names().position(|kind| kind == name).ok_or_else(|| SimulationError::Unknown {
            what: "type of cells",
            name: name.to_owned(),
            known: names().map(str::to_owned).collect(),
        })
    }
}
