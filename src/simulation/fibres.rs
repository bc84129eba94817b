//! Fibres that a program makes and removes while a cell runs.

use super::error::SimulationError;
use super::fibre_fault::FibreFault;
use super::id::CellId;
use super::stepping::Simulation;
use crate::mechanics::fibres::Fibre;
use crate::sim::Kind;
use crate::sim::fibre_state::MadeFibre;

/// A fibre of a cell that was made at run time, by the number that no other fibre of this cell ever has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FibreId {
    cell: CellId,
    number: u64,
}

impl FibreId {
    /// Its cell.
    pub fn cell(self) -> CellId {
        self.cell
    }

    /// Its number among the fibres of its cell, from 0.
    pub fn number(self) -> u64 {
        self.number
    }
}

/// A fibre at this instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FibreView {
    /// Which it is.
    pub id: FibreId,
    /// The atoms at its ends, numbered from 0 within the cell: of a pseudopod's the one in front comes first.
    pub atoms: [u32; 2],
    /// Stiffness at full activation, pN/µm.
    pub stiffness: f64,
    /// Activation from 0 to 1; of a pseudopod's fibre in the mean over the last step.
    pub activation: f64,
    /// When it was made, s.
    pub since: f64,
    /// Whether a pseudopod made it, which removes it, too.
    pub is_of_pseudopod: bool,
    /// Length, µm.
    pub length: f64,
    /// What it pulls with, pN, eq. (fibres.1).
    pub tension: f64,
}

impl Simulation {
    /// Makes a fibre between two atoms of a cell, fully active from the next step on until it is removed: it pulls with its stiffness (pN/µm)
    /// times its length, eq. (fibres.1).
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let text = EXAMPLE.replace("[cells.squeezed]", "[cells.squeezed]\nfibre_budget = 2");
    /// let mut simulation = Simulation::from_text("example", &text)?;
    /// let cell = simulation.types().nth(1).unwrap().cells().next().unwrap();
    /// let fibre = simulation.add_fibre(cell, [0, 3], 0.2)?;
    /// let before = simulation.fibres(cell)?[0].length;
    /// simulation.run_until(2.0)?;
    /// assert!(simulation.fibres(cell)?[0].length < before);
    /// simulation.remove_fibre(fibre)?;
    /// assert!(simulation.remove_fibre(fibre).is_err());
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`], [`SimulationError::Value`] for a stiffness that is none, [`SimulationError::Fibre`] for ends that
    /// cannot be, for a budget that is used up, and for more stiffness at an atom than steps bear. Nothing has changed then.
    pub fn add_fibre(&mut self, cell: CellId, atoms: [u32; 2], stiffness: f64) -> Result<FibreId, SimulationError> {
        let (number, local) = self.kind_and_number(cell)?;
        let kind = &self.model.kinds[number];
        if !(stiffness > 0.0 && stiffness.is_finite()) {
            let what = format!("the stiffness of a fibre of cell {cell}");
            return Err(SimulationError::Value { what, value: stiffness, expected: "a number above 0, in pN/um," });
        }
        if kind.fibre_budget == 0 {
            return Err(FibreFault::NoBudget { kind: kind.name.clone() }.into());
        }
        let now = &mut self.state.kinds[number];
        check_ends(kind, cell, atoms)?;
        for atom in atoms {
            let own = now.fibres.of_cell(kind, local).filter(|made| made.pod.is_none());
            let there: f64 = own.filter(|made| made.fibre.atoms.contains(&atom)).map(|made| made.fibre.stiffness).sum();
            let (found, limit) = (there + stiffness + kind.pod_fibre_stiffness(), kind.fibre_limit);
            if found > limit {
                return Err(FibreFault::TooStiff { cell, atom, found, limit }.into());
            }
        }
        let fibre = Fibre { atoms, stiffness, activation: 1.0 };
        match now.fibres.add(kind, local, self.state.time, None, fibre) {
            Some(number) => Ok(FibreId { cell, number }),
            None => Err(FibreFault::Full { cell, budget: kind.fibre_budget }.into()),
        }
    }

    /// Sets how active a fibre is that a program made, from 0 to 1.
    ///
    /// # Errors
    /// As [`Simulation::remove_fibre`], and [`SimulationError::Value`] for a number that is no activation.
    pub fn activate_fibre(&mut self, fibre: FibreId, activation: f64) -> Result<(), SimulationError> {
        if !(0.0..=1.0).contains(&activation) {
            let what = format!("the activation of fibre {} of cell {}", fibre.number, fibre.cell);
            return Err(SimulationError::Value { what, value: activation, expected: "a number from 0 to 1" });
        }
        let slot = self.fibre(fibre)?;
        slot.iter_mut().for_each(|made| made.fibre.activation = activation);
        Ok(())
    }

    /// Removes a fibre that a program made.
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`], and [`SimulationError::Fibre`] for a fibre that is not there any more, or is that of a pseudopod.
    pub fn remove_fibre(&mut self, fibre: FibreId) -> Result<(), SimulationError> {
        *self.fibre(fibre)? = None;
        Ok(())
    }

    /// The fibres of a cell that were made at run time.
    ///
    /// # Errors
    /// [`SimulationError::NoSuchCell`].
    pub fn fibres(&self, cell: CellId) -> Result<Vec<FibreView>, SimulationError> {
        let (number, local) = self.kind_and_number(cell)?;
        let (kind, now) = (&self.model.kinds[number], &self.state.kinds[number]);
        let view = |made: &MadeFibre| {
            let [a, b] = made.fibre.atoms.map(|atom| now.position(kind, local, atom as usize));
            FibreView {
                id: FibreId { cell, number: made.number },
                atoms: made.fibre.atoms,
                stiffness: made.fibre.stiffness,
                activation: made.fibre.activation,
                since: made.since,
                is_of_pseudopod: made.pod.is_some(),
                length: (b - a).norm(),
                tension: made.fibre.pull(b - a).0.norm(),
            }
        };
        Ok(now.fibres.of_cell(kind, local).map(view).collect())
    }

    /// The slot of a fibre that a program made.
    fn fibre(&mut self, id: FibreId) -> Result<&mut Option<MadeFibre>, SimulationError> {
        let FibreId { cell, number } = id;
        let (kind, local) = self.kind_and_number(cell)?;
        let found = self.state.kinds[kind].fibres.find(&self.model.kinds[kind], local, number);
        match found {
            Some(slot) if slot.is_some_and(|made| made.pod.is_some()) => {
                Err(FibreFault::OfPseudopod { cell, number }.into())
            }
            found => found.ok_or_else(|| FibreFault::NoSuchFibre { cell, number }.into()),
        }
    }
}

/// Ends are two atoms that there are.
fn check_ends(kind: &Kind, cell: CellId, atoms: [u32; 2]) -> Result<(), FibreFault> {
    if let Some(&atom) = atoms.iter().find(|atom| **atom as usize >= kind.atoms()) {
        return Err(FibreFault::NoSuchAtom { cell, atom, atoms: kind.atoms() });
    }
    match atoms {
        [a, b] if a == b => Err(FibreFault::NoLength { cell, atom: a }),
        _ => Ok(()),
    }
}
