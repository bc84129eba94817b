//! Which atoms of a surface are on one side of another: those that edges join which do not pass through it.

/// Atoms joined to parts; each part is known by one of its atoms.
pub(super) struct Parts(Vec<u32>);

impl Parts {
    /// Every atom is a part.
    pub fn new(atoms: usize) -> Self {
        Self((0..atoms as u32).collect())
    }

    /// The atom by which the part of an atom is known.
    pub fn root(&self, mut atom: u32) -> u32 {
        while self.0[atom as usize] != atom {
            atom = self.0[atom as usize];
        }
        atom
    }

    /// Joins the parts of two atoms.
    pub fn join(&mut self, one: u32, other: u32) {
        let [one, other] = [one, other].map(|atom| self.root(atom));
        let (root, below) = (one.min(other), one.max(other));
        self.0[below as usize] = root;
    }
}
