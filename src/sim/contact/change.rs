//! What a sweep changed.

/// What a sweep changed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Change {
    /// The largest correction, µm.
    pub largest: f64,
    /// The row with the largest correction of a contact.
    pub worst: usize,
    /// The work of all corrections, pN·µm.
    pub work: f64,
}

impl Change {
    /// Adds what was changed after this.
    pub fn add(&mut self, next: &Self) {
        if next.largest > self.largest {
            (self.largest, self.worst) = (next.largest, next.worst);
        }
        self.work += next.work;
    }

    /// With what was changed after this.
    pub fn and(mut self, next: &Self) -> Self {
        self.add(next);
        self
    }
}
