//! What chemistry may set of a force, by the name that the force has in the document.

/// A kind of force that chemistry may set, as `cell.load[NAME]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Handle {
    /// Its word, `load`.
    pub word: &'static str,
    /// The key of documents that lists such forces, `loads`.
    pub key: &'static str,
    /// The least and the most that may be set.
    pub range: [f64; 2],
    /// What may be set, in words.
    pub expected: &'static str,
}

impl Handle {
    /// Whether a number may be set.
    pub fn allows(&self, value: f64) -> bool {
        (self.range[0]..=self.range[1]).contains(&value)
    }
}
