//! The cells of a simulation: who they are, of which type, and where their atoms are.

use super::error::SimulationError;
use super::id::CellId;
use super::stepping::Simulation;
use crate::sim::state::index;
use crate::sim::{Kind, KindState};

/// A type of cells: what all of them share.
#[derive(Debug, Clone, Copy)]
pub struct TypeView<'a> {
    kind: &'a Kind,
    cells: &'a KindState,
}

impl<'a> TypeView<'a> {
    /// Its name in the document.
    pub fn name(&self) -> &'a str {
        &self.kind.name
    }

    /// Atoms (vertices of the mesh) of one cell.
    pub fn atom_count(&self) -> usize {
        self.kind.atoms()
    }

    /// Facets of one cell: three atoms each, numbered from 0 within the cell, outward.
    pub fn facets(&self) -> &'a [[u32; 3]] {
        &self.kind.rest.facets
    }

    /// Pairs of atoms that links and fibres join, to be drawn.
    pub fn links(&self) -> &'a [[u32; 2]] {
        &self.kind.drawn_links
    }

    /// Whether the surface encloses a volume.
    pub fn is_closed(&self) -> bool {
        self.kind.closed
    }

    /// Positions of the atoms at rest, around the cell's own origin, µm.
    pub fn rest_positions(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + use<'a> {
        self.kind.rest.positions.iter().map(|p| (*p).into())
    }

    /// Names of its loads.
    pub fn loads(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.kind.loads().map(|load| load.name.as_str())
    }

    /// Names of its fibres.
    pub fn fibres(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.kind.fibres().map(|fibres| fibres.name.as_str())
    }

    /// Its cells, in order.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = CellId> + use<'a> {
        self.cells.ids.iter().map(|id| CellId::new(*id))
    }
}

impl Simulation {
    /// The types of cells, in the order of the document.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let simulation = Simulation::from_text("example", EXAMPLE)?;
    /// let names: Vec<&str> = simulation.types().map(|kind| kind.name()).collect();
    /// assert_eq!(names, ["pulled", "squeezed"]);
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    pub fn types(&self) -> impl ExactSizeIterator<Item = TypeView<'_>> {
        self.model.kinds.iter().zip(&self.state.kinds).map(|(kind, cells)| TypeView { kind, cells })
    }

    /// The type of a cell.
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`].
    pub fn type_of(&self, cell: CellId) -> Result<TypeView<'_>, SimulationError> {
        let (kind, _) = self.kind_and_number(cell)?;
        Ok(TypeView { kind: &self.model.kinds[kind], cells: &self.state.kinds[kind] })
    }

    /// All cells, in the order of [`Simulation::positions_into`], of series and of results: type after type.
    pub fn cells(&self) -> impl Iterator<Item = CellId> + '_ {
        self.types().flat_map(|kind| kind.cells())
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.state.cells()
    }

    /// Number of atoms of all cells.
    pub fn atom_count(&self) -> usize {
        self.state.atoms(&self.model)
    }

    /// Writes the positions of all atoms, µm, cell after cell.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// let mut positions = vec![[0.0; 3]; simulation.atom_count()];
    /// for n in 1..=3 {
    ///     simulation.run_until(0.1 * f64::from(n))?;
    ///     simulation.positions_into(&mut positions)?; // The same buffer again and again.
    /// }
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::Length`] unless the buffer holds as many positions as there are atoms.
    pub fn positions_into(&self, positions: &mut [[f64; 3]]) -> Result<(), SimulationError> {
        check_length(self.atom_count(), positions.len())?;
        let mut rest = positions;
        for (kind, now) in self.model.kinds.iter().zip(&self.state.kinds) {
            for cell in 0..now.cells() {
                let (own, others) = rest.split_at_mut(kind.atoms());
                copy_positions(kind, now, cell, own);
                rest = others;
            }
        }
        Ok(())
    }

    /// Writes the positions of the atoms of one cell, µm.
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`], [`SimulationError::Length`] unless the buffer holds as many
    /// positions as the cell has atoms.
    pub fn cell_positions_into(&self, cell: CellId, positions: &mut [[f64; 3]]) -> Result<(), SimulationError> {
        let (number, local) = self.kind_and_number(cell)?;
        let kind = &self.model.kinds[number];
        check_length(kind.atoms(), positions.len())?;
        copy_positions(kind, &self.state.kinds[number], local, positions);
        Ok(())
    }

    /// The number of a cell among all, which is its position in series.
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`].
    pub fn position_of(&self, cell: CellId) -> Result<usize, SimulationError> {
        let (kind, local) = self.kind_and_number(cell)?;
        Ok(self.state.kinds[kind].first_cell + local)
    }

    /// The number of a cell's kind, and its own within that.
    pub(super) fn kind_and_number(&self, cell: CellId) -> Result<(usize, usize), SimulationError> {
        self.state.find(cell.number()).ok_or(SimulationError::NoSuchCell { cell })
    }
}

fn check_length(expected: usize, found: usize) -> Result<(), SimulationError> {
    if found == expected { Ok(()) } else { Err(SimulationError::Length { expected, found }) }
}

fn copy_positions(kind: &Kind, now: &KindState, cell: usize, positions: &mut [[f64; 3]]) {
    for (atom, position) in positions.iter_mut().enumerate() {
        for (axis, x) in position.iter_mut().enumerate() {
            *x = now.positions[index(kind, cell, atom, axis)];
        }
    }
}
