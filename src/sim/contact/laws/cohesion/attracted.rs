//! What attracts a point, and how much.

use super::patch::{Partner, width_of_well};

/// What attracts a point.
#[derive(Debug, Clone, Copy)]
pub struct Attracted {
    /// What it releases to open there, over half of the area, pN/µm.
    pub released: f64,
    /// How far it is open, µm.
    pub width: f64,
    /// Of facets and then obstacles, numbered through all.
    pub number: u32,
    /// Of the point's side, pN/µm².
    pub strength: f64,
    /// µm.
    pub range: f64,
    pub partner: Partner,
}

impl Attracted {
    /// Whether it attracts the point more than another one does; of two that do so alike the nearer one, then the one with the lesser
    /// number counts, whatever is looked at first.
    pub fn is_more_than(&self, other: &Self) -> bool {
        let rest = || self.width < other.width || self.width == other.width && self.number < other.number;
        self.released > other.released || self.released == other.released && rest()
    }
}

/// The more attracting of both.
pub fn more(one: Option<Attracted>, other: Option<Attracted>) -> Option<Attracted> {
    match (one, other) {
        (Some(a), Some(b)) => Some(if b.is_more_than(&a) { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// A body whose facets may attract points of a facet.
#[derive(Debug, Clone, Copy, Default)]
pub struct Attracting {
    pub body: u32,
    /// Of the point's side, pN/µm².
    pub strength: f64,
    /// µm.
    pub range: f64,
}

impl Attracting {
    /// How far open what attracts a point more than this releases can be, and a little more, µm.
    pub fn widest(&self, released: f64) -> f64 {
        let whole = self.strength * self.range;
        match whole > 0.0 && released <= whole {
            // Near nothing a width is known to no more than the root of the rounding error of what it releases.
            true => self.range * (width_of_well(released / whole) + 1e-6).min(1.0),
            false => 0.0,
        }
    }
}
