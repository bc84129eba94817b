//! LML, the load markup language: what is done to a physical model in the course of time.
//!
//! A load acts on atoms or components by a value that has a course: straight between its events, 0 before the first and
//! constant after the last. Its direction is not a unit vector: the value is multiplied by it as it stands. A component of
//! the direction is a number, is held at zero, or is left free.

mod read;
mod targets;
mod units;
mod write;

pub use targets::Target;

use super::words::{meaning, word_for};
use super::{Attributes, Foreign};

/// The namespace of the language.
pub const NAMESPACE: &str = "http://www-timc.imag.fr/load";

/// A document of loads.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Loads {
    /// Attributes of the root beyond the language.
    pub properties: Attributes,
    /// The loads, in the order of the document.
    pub loads: Vec<Load>,
    /// Elements beside the loads.
    pub foreign: Vec<Foreign>,
}

/// A load.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// What kind it is.
    pub kind: LoadKind,
    /// What it acts on.
    pub applied_to: Vec<Target>,
    /// Its direction, if it has one.
    pub direction: Option<Direction>,
    /// Its course, in the order of the document.
    pub events: Vec<ValueEvent>,
    /// The unit of its value, as it is written.
    pub unit: Option<Box<str>>,
    /// Attributes beyond the language.
    pub properties: Attributes,
    /// Elements beyond the language.
    pub foreign: Vec<Foreign>,
    /// The line of the document where it begins, from 1; 0 for a load that was not read. It is not compared.
    pub line: Line,
}

/// A line of a document, which says where something was found and not what it is: all are equal.
#[derive(Debug, Clone, Copy, Default)]
pub struct Line(pub usize);

impl PartialEq for Line {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// What a load does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LoadKind {
    /// A displacement from rest.
    Translation,
    /// A turn from rest.
    Rotation,
    /// A force.
    Force,
    /// A pressure.
    Pressure,
    /// An acceleration.
    Acceleration,
    /// A word that the language has not.
    Other(Box<str>),
}

/// The words of the language for loads.
const KINDS: [(&str, LoadKind); 5] = [
    ("Translation", LoadKind::Translation),
    ("Rotation", LoadKind::Rotation),
    ("Force", LoadKind::Force),
    ("Pressure", LoadKind::Pressure),
    ("Acceleration", LoadKind::Acceleration),
];

impl LoadKind {
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

/// Where a load acts to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Direction {
    /// Along x, y and z.
    pub components: [Component; 3],
    /// The atom that it points to from each atom that is loaded, wherever both are.
    pub toward: Option<Target>,
    /// Attributes beyond the language.
    pub properties: Attributes,
}

/// A component of a direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Component {
    /// Absent: nothing is done along this axis.
    #[default]
    Free,
    /// `NULL`: held at zero along this axis.
    Null,
    /// The value times this.
    Number(f64),
}

/// A point of a course.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueEvent {
    /// When, s.
    pub date: f64,
    /// The value, in the unit of the load.
    pub value: f64,
    /// Attributes beyond these, `transition` among them, which nothing makes use of.
    pub properties: Attributes,
}

impl Load {
    /// The events by their dates.
    pub fn course(&self) -> Vec<(f64, f64)> {
        let mut points: Vec<(f64, f64)> = self.events.iter().map(|event| (event.date, event.value)).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        points
    }

    /// The value at a time (s), in the unit of the load.
    pub fn value_at(&self, time: f64) -> f64 {
        let points = self.course();
        let next = points.partition_point(|(date, _)| *date <= time);
        match (next.checked_sub(1).map(|last| points[last]), points.get(next)) {
            (None, _) => 0.0,
            (Some((_, value)), None) => value,
            (Some((before, from)), Some((after, to))) => from + (to - from) * (time - before) / (after - before),
        }
    }

    /// What one unit of the value is in the units of the simulator (µm, s, pN; radians); none where the unit is missing or
    /// is not one of this kind of load.
    pub fn unit_value(&self) -> Option<f64> {
        units::value(&self.kind, self.unit.as_deref()?.trim())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(kind: LoadKind, unit: &str, events: &[(f64, f64)]) -> Load {
        let events = events.iter().map(|&(date, value)| ValueEvent { date, value, properties: Attributes::default() });
        Load {
            kind,
            applied_to: vec![Target::Index(0)],
            direction: None,
            events: events.collect(),
            unit: Some(unit.into()),
            properties: Attributes::default(),
            foreign: Vec::new(),
            line: Line::default(),
        }
    }

    #[test]
    fn a_value_is_nothing_before_its_first_event_straight_between_two_and_stays_after_the_last() {
        let course = load(LoadKind::Force, "N", &[(2.0, 10.0), (1.0, 4.0), (4.0, 0.0)]);
        for (time, value) in [(0.5, 0.0), (1.0, 4.0), (1.5, 7.0), (2.0, 10.0), (3.0, 5.0), (4.0, 0.0), (9.0, 0.0)] {
            assert_eq!(course.value_at(time), value, "at {time} s");
        }
        let jump = load(LoadKind::Force, "N", &[(1.0, 1.0), (1.0, 3.0)]);
        assert_eq!([0.9, 1.0, 1.1].map(|time| jump.value_at(time)), [0.0, 3.0, 3.0]);
    }

    #[test]
    fn units_of_the_schema_and_of_the_reference_reader_are_known_to_their_kind_alone() {
        let value = |kind, unit| load(kind, unit, &[]).unit_value();
        for (unit, length) in [("mm", 1e3), ("micron", 1.0), ("microm", 1.0), ("nm", 1e-3), ("m", 1e6)] {
            assert_eq!(value(LoadKind::Translation, unit), Some(length), "{unit}");
        }
        for (unit, force) in [("pN", 1.0), ("N", 1e12), ("kN", 1e15)] {
            assert_eq!(value(LoadKind::Force, unit), Some(force), "{unit}");
        }
        for (unit, pressure) in [("Pa", 1.0), ("kPa", 1e3), ("mmHg", 133.322_387_415)] {
            assert_eq!(value(LoadKind::Pressure, unit), Some(pressure), "{unit}");
        }
        for unit in ["radian", "radians"] {
            assert_eq!(value(LoadKind::Rotation, unit), Some(1.0));
        }
        for unit in ["degree", "degrees"] {
            assert_eq!(value(LoadKind::Rotation, unit), Some(std::f64::consts::PI / 180.0));
        }
        assert_eq!(value(LoadKind::Acceleration, "cm/s^2"), Some(1e4));
        assert_eq!(value(LoadKind::Force, "mm"), None);
        assert_eq!(value(LoadKind::Pressure, "bar"), None);
    }
}
