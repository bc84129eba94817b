//! Scratch of links: what has been observed in an exchange.

use super::links::{Observations, Source};

/// What has been observed in an exchange, in the order of [`Observations`].
#[derive(Debug, Clone, Default)]
pub(super) struct Observed {
    /// `[quantity][member]`, where known.
    pub quantities: Vec<Vec<f64>>,
    pub known: Vec<bool>,
    /// Numbers that are the same for all members, where known.
    pub shared: Vec<Option<f64>>,
    /// Sums over pieces of a field.
    pub sums: Vec<f64>,
    /// Blocks of cells whose equations were evaluated, ever.
    pub blocks: u64,
}

impl Observed {
    /// Forgets everything: an exchange begins.
    pub fn forget(&mut self, observations: &Observations) {
        self.quantities.resize_with(observations.quantities.len(), Vec::new);
        self.known.clear();
        self.known.resize(observations.quantities.len(), false);
        self.shared.clear();
        self.shared.resize(observations.shared.len(), None);
    }

    /// Forgets what depends on where atoms are, after a link has moved one. Positions themselves are read after they are set: the
    /// order of links sees to that.
    pub fn forget_at_atoms(&mut self, observations: &Observations) {
        for (source, value) in observations.shared.iter().zip(&mut self.shared) {
            if matches!(source, Source::AtAtom(..)) {
                *value = None;
            }
        }
    }

    /// An observed quantity of a member.
    pub fn quantity(&self, slot: usize, member: usize) -> f64 {
        self.quantities[slot][member]
    }

    /// An observed number that is the same for all members.
    pub fn shared(&self, slot: usize) -> f64 {
        self.shared[slot].unwrap_or(f64::NAN)
    }
}
