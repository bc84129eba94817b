//! When a simulation stops.

use super::super::words::{meaning, word_for};
use super::super::{Attributes, Foreign};

/// When to stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Criterion {
    /// By one quantity.
    Single(Box<SingleCriterion>),
    /// By several criteria together.
    Multiple {
        /// How they are joined.
        operator: Operator,
        /// Two or more.
        list: Vec<Criterion>,
        /// Attributes beyond the language.
        properties: Attributes,
        /// Elements beyond the language.
        foreign: Vec<Foreign>,
    },
}

/// How criteria are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// All must hold.
    And,
    /// One must hold.
    Or,
}

impl Operator {
    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::And => "And",
            Self::Or => "Or",
        }
    }
}

/// A criterion about one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct SingleCriterion {
    /// The quantity.
    pub kind: CriterionKind,
    /// Its unit, as it is written.
    pub unit: Option<Box<str>>,
    /// The component of the physical model that is meant; all of it when absent.
    pub target: Option<Box<str>>,
    /// How it decides.
    pub method: Method,
    /// What was found, as it is written.
    pub data: Option<Box<str>>,
    /// Attributes beyond the language.
    pub properties: Attributes,
    /// Elements beyond the language.
    pub foreign: Vec<Foreign>,
}

/// What a criterion looks at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CriterionKind {
    /// The kinetic energy.
    KineticEnergy,
    /// Speeds of atoms.
    Speed,
    /// Changes of positions of atoms from one look to the next.
    Position,
    /// The simulated time.
    Time,
    /// Forces on atoms.
    Force,
    /// A word that the language has not.
    Other(Box<str>),
}

pub(super) const KINDS: [(&str, CriterionKind); 5] = [
    ("KineticEnergy", CriterionKind::KineticEnergy),
    ("Speed", CriterionKind::Speed),
    ("Position", CriterionKind::Position),
    ("Time", CriterionKind::Time),
    ("Force", CriterionKind::Force),
];

impl CriterionKind {
    /// What a word means.
    pub fn of(word: &str) -> Self {
        meaning(&KINDS, word).unwrap_or_else(|| Self::Other(word.into()))
    }

    /// Its word.
    pub fn word(&self) -> &str {
        match self {
            Self::Other(word) => word,
            known => word_for(&KINDS, known),
        }
    }
}

/// How a criterion decides.
#[derive(Debug, Clone, PartialEq)]
pub struct Method {
    /// By what rule.
    pub kind: MethodKind,
    /// Which of many values count.
    pub scope: Option<Scope>,
    /// Attributes beyond the language.
    pub properties: Attributes,
}

/// The rule of a criterion; values are in the unit of the criterion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MethodKind {
    /// Below a value.
    Threshold {
        /// The value.
        max: f64,
    },
    /// Above a value.
    MinThreshold {
        /// The value.
        min: f64,
    },
    /// Below a value for some looks in a row.
    TimePeriodThreshold {
        /// The value.
        min: f64,
        /// How many.
        iterations: u32,
    },
}

/// Which of the values of many atoms count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Each one.
    Any,
    /// Their mean.
    Average,
    /// Their sum.
    Sum,
}

pub(super) const SCOPES: [(&str, Scope); 3] = [("Any", Scope::Any), ("Average", Scope::Average), ("Sum", Scope::Sum)];

impl Scope {
    /// Its word.
    pub fn word(self) -> &'static str {
        word_for(&SCOPES, &self)
    }
}
