//! Contact inhibition of locomotion: a front that meets another cell is given up, and the next ones lead away.
//!
//! What the front of a pseudopod and the cell as a whole touch is noted where a step ends, and heeded in the next.

use super::pods::{PodState, Told};
use crate::Vec3;

/// What a cell makes of meeting others, eqs (pseudopods.11) and (pseudopods.12).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inhibition {
    /// Share of a front that touches others at which it is given up.
    pub share: f64,
    /// How much directions away from where the cell is touched are likelier.
    pub turn: f64,
    /// Whose touch counts.
    pub by: Touch,
}

/// Whose touch counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// That of every other cell.
    All,
    /// That of other cells of the own type.
    Own,
    /// That of cells of other types.
    Others,
}

impl Touch {
    /// Whether the touch of a cell of another kind, or of the own, counts.
    pub fn counts(self, is_own: bool) -> bool {
        match self {
            Self::All => true,
            Self::Own => is_own,
            Self::Others => !is_own,
        }
    }
}

impl Inhibition {
    /// What a cell is told, with what it makes of being touched, eq. (pseudopods.11).
    pub(super) fn heed(&self, told: &Told, state: &PodState) -> Told {
        let cue = Vec3::from(told.cue) - self.turn * Vec3::from(state.touched);
        Told { cue: cue.into(), ..*told }
    }
}

impl PodState {
    /// Notes where the cell is touched: `touched` is the mean of the directions to atoms that touch others (0 where none does), and
    /// `met` the share of the front of a pseudopod with this direction that touches others.
    pub fn note_touch(&mut self, touched: Vec3, met: impl Fn(&Vec3) -> f64) {
        self.touched = touched.into();
        for pod in [&mut self.pod].into_iter().chain(self.beside.iter_mut().flatten()) {
            pod.met = met(&pod.direction.into());
        }
    }
}
