//! Cells come and go between steps: what chemistry knows of each comes and goes with it, and stands in the order of the cells.

use super::super::controls::retain;
use super::model::{Chemistry, Members};
use super::state::{ChemistryState, admit_links};

impl ChemistryState {
    /// A cell comes: every system of its kind gets a member at the system's start, and no link has set anything of it. It stands before
    /// the cell with the number `local` among those of its kind; `cells` says how many each kind has without it.
    ///
    /// # Panics
    /// When there is no such kind, or it has fewer cells.
    pub fn insert_cell(&mut self, chemistry: &Chemistry, cells: &[usize], kind: usize, local: usize) {
        assert!(local <= cells[kind], "before cell {local} of {}", cells[kind]);
        for (number, reactor) in chemistry.reactors.iter().enumerate() {
            let Members::Kinds(kinds) = &reactor.members else { continue };
            let Some(at) = kinds.iter().position(|&other| other == kind) else { continue };
            let member = kinds[..at].iter().map(|&kind| cells[kind]).sum::<usize>() + local;
            self.populations[number].insert_default(&reactor.program, member);
            if !reactor.events.is_empty() {
                self.events[number].insert(member, reactor.events.before_start());
            }
        }
        self.controls.insert_cell(cells[..kind].iter().sum::<usize>() + local);
        admit_links(&mut self.controls, chemistry, cells.iter().sum::<usize>() + 1);
    }

    /// Cells go: those of which `keep` (of a kind, and a number among its cells) says no. `cells` says how many each kind has before.
    pub fn retain_cells(&mut self, chemistry: &Chemistry, cells: &[usize], keep: impl Fn(usize, usize) -> bool) {
        let all = |kind: usize| (0..cells[kind]).map(move |local| (kind, local));
        for (number, reactor) in chemistry.reactors.iter().enumerate() {
            let Members::Kinds(kinds) = &reactor.members else { continue };
            let stays: Vec<bool> = kinds.iter().flat_map(|&kind| all(kind)).map(|(kind, at)| keep(kind, at)).collect();
            self.populations[number].retain(|member| stays[member]);
            retain(&mut self.events[number], &stays);
        }
        let stays: Vec<bool> = (0..cells.len()).flat_map(all).map(|(kind, at)| keep(kind, at)).collect();
        self.controls.retain_cells(&stays);
    }
}
