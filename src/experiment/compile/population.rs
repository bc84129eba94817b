//! Cells that come and go during a run, in the order of time.

use super::super::{Added, Experiment, Placement, Removed};
use super::numbers::vector;
use super::positions::positions_of;
use crate::sim::{Change, Kind, PopulationChange, Removal};

/// The changes of a document; those of one instant in its order, by type, first the cells that come.
pub fn changes(experiment: &Experiment, kinds: &[Kind]) -> Vec<PopulationChange> {
    let mut changes = Vec::new();
    for (number, (cell, kind)) in experiment.cells.values().zip(kinds).enumerate() {
        let change = |time: f64, change| PopulationChange { time, kind: number, change };
        changes.extend(cell.added.iter().map(|added| change(added.time.value(), coming(added, kind))));
        changes.extend(cell.removed.iter().map(|removed| change(removed.time.value(), Change::Remove(going(removed)))));
    }
    changes.sort_by(|one, other| one.time.total_cmp(&other.time));
    changes
}

fn coming(added: &Added, kind: &Kind) -> Change {
    match &added.placement {
        Placement::Random { random_from, random_to } => {
            Change::Seed(added.count(), [random_from, random_to].map(|corner| vector(corner.map(|x| x.value()))))
        }
        placement => Change::Add(positions_of(Some(placement), added.count(), kind)),
    }
}

fn going(removed: &Removed) -> Removal {
    match (removed.share, removed.number) {
        (Some(share), _) => Removal::Share(share),
        (None, Some(number)) => Removal::Number(number as usize),
        (None, None) => Removal::All,
    }
}
