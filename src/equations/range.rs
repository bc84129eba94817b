//! The values that a species of a field may take.

/// Which values a species may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Range {
    /// A concentration: never negative, and kept so.
    #[default]
    NonNegative,
    /// Any number, as the potential of FitzHugh and Nagumo.
    Free,
}
