//! Forces that a program exerts on cells.

use super::error::SimulationError;
use super::id::CellId;
use super::stepping::Simulation;
use crate::Vec3;

impl Simulation {
    /// Exerts a force on a cell, pN, spread evenly over its atoms, from the next step on until it is set again: in place of what was exerted on the
    /// cell before, and beside its loads. Like a load it acts where an atom is, and does not turn with the cell. `[0.0; 3]` ends it.
    ///
    /// It is part of the state and of checkpoints. It has no energy, like a load, and is among the forces from outside (`outer`) of what
    /// `output.tractions` keeps. Atoms that are held do not move by it.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// let cell = simulation.types().nth(1).unwrap().cells().next().unwrap();
    /// let before = simulation.series("position_y")?[1];
    /// simulation.set_force(cell, [0.0, 40.0, 0.0])?;
    /// simulation.run_until(3.0)?;
    /// // Force over drag is its speed: 40 pN over 20 pN s/um.
    /// assert!((simulation.series("position_y")?[1] - before - 3.0 * 2.0).abs() < 1e-9);
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`], [`SimulationError::Value`] for a number that is not finite. Nothing has changed then.
    pub fn set_force(&mut self, cell: CellId, force: [f64; 3]) -> Result<(), SimulationError> {
        let atoms = self.type_of(cell)?.atom_count();
        check_finite(cell, force)?;
        self.put_forces(cell, |_| Vec3::from(force) / atoms as f64)
    }

    /// Exerts a force on each atom of a cell, pN, in the order of [`Simulation::cell_positions_into`]; all else is as with
    /// [`Simulation::set_force`].
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// let cell = simulation.types().nth(1).unwrap().cells().next().unwrap();
    /// let mut positions = [[0.0; 3]; 42];
    /// let before = simulation.series("size_z")?[1];
    /// while simulation.time() < 3.0 {
    ///     simulation.cell_positions_into(cell, &mut positions)?;
    ///     // Two halves are pulled apart, whatever the cell does.
    ///     simulation.set_atom_forces(cell, &positions.map(|[_, _, z]| [0.0, 0.0, 0.2 * z.signum()]))?;
    ///     simulation.step()?;
    /// }
    /// assert!(simulation.series("size_z")?[1] > before);
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Simulation::set_force`], and [`SimulationError::Forces`] unless there is a force for each atom.
    pub fn set_atom_forces(&mut self, cell: CellId, forces: &[[f64; 3]]) -> Result<(), SimulationError> {
        let (expected, found) = (self.type_of(cell)?.atom_count(), forces.len());
        if found != expected {
            return Err(SimulationError::Forces { cell, expected, found });
        }
        forces.iter().try_for_each(|force| check_finite(cell, *force))?;
        self.put_forces(cell, |atom| Vec3::from(forces[atom]))
    }

    /// Ends all forces that [`Simulation::set_force`] and [`Simulation::set_atom_forces`] exert, on all cells.
    pub fn clear_forces(&mut self) {
        self.state.chemistry.controls.atom_forces.clear();
    }

    /// Writes the forces on the atoms of a cell.
    fn put_forces(&mut self, cell: CellId, force: impl Fn(usize) -> Vec3) -> Result<(), SimulationError> {
        let (number, local) = self.kind_and_number(cell)?;
        let (atoms, all) = (self.model.kinds[number].atoms(), self.atom_count());
        let first = self.state.kinds[number].first_atom + local * atoms;
        let forces = &mut self.state.chemistry.controls.atom_forces;
        forces.resize(all, Vec3::zeros());
        forces[first..first + atoms].iter_mut().enumerate().for_each(|(atom, slot)| *slot = force(atom));
        // Where nothing is exerted the course is, to the last bit, the one without.
        if forces.iter().all(|force| *force == Vec3::zeros()) {
            forces.clear();
        }
        Ok(())
    }
}

fn check_finite(cell: CellId, force: [f64; 3]) -> Result<(), SimulationError> {
    match force.into_iter().find(|part| !part.is_finite()) {
        Some(value) => {
            let what = format!("the force on cell {cell}");
            Err(SimulationError::Value { what, value, expected: "a finite number, in pN," })
        }
        None => Ok(()),
    }
}
