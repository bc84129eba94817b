//! What an experiment means: kinds of cells, forces and obstacles in µm, s and pN. Nothing here changes during a run.

use super::chemistry::Chemistry;
use super::contact::ContactModel;
use super::kind::{Kind, kinks};
use super::obstacle::Obstacle;
use crate::Vec3;
use crate::mechanics::integrator::Integrator;

/// The compiled experiment.
#[derive(Debug, Clone)]
pub struct Model {
    /// Seed of all random numbers.
    pub seed: u64,
    /// The kinds of cells, in the order of the document.
    pub kinds: Vec<Kind>,
    /// Rigid obstacles that no atom passes.
    pub obstacles: Vec<Obstacle>,
    /// Contacts between cells, with themselves and with obstacles; none where cells pass through each other.
    pub contact: Option<ContactModel>,
    /// Systems of equations, fields, and what joins them to cells.
    pub chemistry: Chemistry,
    /// Scheme and step.
    pub integrator: Integrator,
    /// End of the run, s.
    pub until: f64,
    /// The run ends before, once nothing more happens and the largest force out of balance on an atom is below this, pN.
    pub rest: Option<f64>,
    /// Times at which a course bends, rising; a step ends there.
    pub kinks: Vec<f64>,
    /// Cells that come and go at given times, in rising order of these; a step ends there.
    pub changes: Vec<PopulationChange>,
    /// Whether the state holds what cells did to what is around them in the last step.
    pub keeps_tractions: bool,
}

/// Cells of a kind that come or go between two steps.
#[derive(Debug, Clone, PartialEq)]
pub struct PopulationChange {
    /// When, s.
    pub time: f64,
    /// Number of the kind.
    pub kind: usize,
    /// What happens.
    pub change: Change,
}

/// What happens to the cells of a kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// Cells at rest are added around these centres, µm.
    Add(Vec<Vec3>),
    /// So many cells at rest are added at random points of a box, given by its lowest and highest corner, µm, clear of all others.
    Seed(usize, [Vec3; 2]),
    /// Cells are removed.
    Remove(Removal),
}

/// Which cells of a kind are removed. Those that are drawn depend on the seed, on their ids and on the number of the change alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Removal {
    /// All.
    All,
    /// This share of them, from 0 to 1, drawn at random and rounded to a whole number of cells.
    Share(f64),
    /// So many, drawn at random; all, where there are fewer.
    Number(usize),
}

impl Model {
    /// A model of these kinds alone: no obstacles, contacts or chemistry.
    pub fn of(kinds: Vec<Kind>, integrator: Integrator, until: f64) -> Self {
        Self {
            seed: 1,
            kinks: kinks(&kinds, &[]),
            kinds,
            obstacles: Vec::new(),
            contact: None,
            chemistry: Chemistry::default(),
            integrator,
            until,
            rest: None,
            changes: Vec::new(),
            keeps_tractions: false,
        }
    }

    /// Times at which something happens, s, in no order: a step ends there.
    pub fn instants(&self) -> impl Iterator<Item = f64> {
        let changes = self.changes.iter().map(|change| change.time);
        self.kinks.iter().copied().chain([self.until]).chain(changes)
    }

    /// Whether anything is still to happen after a time, s.
    pub fn is_awaited(&self, time: f64) -> bool {
        let after = time + self.clock_slack();
        self.kinks.iter().any(|kink| *kink > after) || self.changes.iter().any(|change| change.time > after)
    }

    /// What the clock cannot tell apart, s: the round-off of adding many steps.
    pub fn clock_slack(&self) -> f64 {
        1e-12 * self.until
    }
}
