//! MML, the monitoring markup language: what is watched while a model is simulated, and when to stop (`monitoringIn`); and
//! what was found (`monitoringOut`).

mod criteria;
mod read;
mod write;

pub use criteria::{Criterion, CriterionKind, Method, MethodKind, Operator, Scope, SingleCriterion};

use super::{Attributes, Foreign};

/// A document of the language.
#[derive(Debug, Clone, PartialEq)]
pub enum Monitoring {
    /// What is to be watched.
    In(Box<MonitoringIn>),
    /// What was found.
    Out(MonitoringOut),
}

/// What is to be watched, and when to stop.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MonitoringIn {
    /// Attributes of the root beyond the language.
    pub properties: Attributes,
    /// The time step.
    pub dt: Option<TimeParameter>,
    /// The time between two looks at the simulation.
    pub refresh: Option<TimeParameter>,
    /// The physical model, relative to the document.
    pub pml_file: Option<Box<str>>,
    /// What the simulator reads in place of it.
    pub simulator_file: Option<Box<str>>,
    /// The loads, relative to the document.
    pub lml_file: Option<Box<str>>,
    /// The simulator.
    pub simulator: Option<Box<str>>,
    /// When to stop.
    pub stop: Option<Criterion>,
    /// What is watched.
    pub monitors: Vec<Monitor>,
    /// Elements beside the monitors.
    pub beside_monitors: Vec<Foreign>,
    /// Elements beyond the language.
    pub foreign: Vec<Foreign>,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MonitoringOut {
    /// Attributes of the root beyond the language.
    pub properties: Attributes,
    /// The physical model, relative to the document.
    pub pml_file: Option<Box<str>>,
    /// The instants, in the order of the document.
    pub times: Vec<TimeStep>,
    /// Elements beyond the language.
    pub foreign: Vec<Foreign>,
}

/// What was found at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeStep {
    /// When.
    pub time: TimeParameter,
    /// How far the simulation was from its end.
    pub stop: Option<Criterion>,
    /// What was watched.
    pub monitors: Vec<Monitor>,
    /// Elements beyond the language.
    pub foreign: Vec<Foreign>,
}

/// A time with its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeParameter {
    /// The number.
    pub value: f64,
    /// Its unit, as it is written: "ms", "s" or "min".
    pub unit: Box<str>,
    /// Attributes beyond these.
    pub properties: Attributes,
}

/// Units of time, s.
const TIME_UNITS: [(&str, f64); 3] = [("ms", 1e-3), ("s", 1.0), ("min", 60.0)];

impl TimeParameter {
    /// The time, s; none where the unit is not known.
    pub fn seconds(&self) -> Option<f64> {
        TIME_UNITS.iter().find(|(unit, _)| *unit == self.unit.trim()).map(|(_, seconds)| self.value * seconds)
    }
}

/// Something that is watched.
#[derive(Debug, Clone, PartialEq)]
pub struct Monitor {
    /// What is measured: one of [`MONITOR_TYPES`], or a word that the language has not.
    pub kind: Box<str>,
    /// Its number, unique in the document.
    pub index: u32,
    /// The component of the physical model that is watched.
    pub target: Box<str>,
    /// Shifts along x, y and z.
    pub offset: [Option<f64>; 3],
    /// From when.
    pub start: Option<TimeParameter>,
    /// Until when.
    pub stop: Option<TimeParameter>,
    /// What it is compared with.
    pub references: Vec<Reference>,
    /// The atoms that the numbers belong to, as they are written.
    pub indexes: Option<Box<str>>,
    /// The numbers, as they are written.
    pub data: Option<Box<str>>,
    /// Attributes beyond the language.
    pub properties: Attributes,
    /// Elements beyond the language.
    pub foreign: Vec<Foreign>,
}

/// What monitors measure.
pub const MONITOR_TYPES: [&str; 15] = [
    "Position",
    "REN",
    "GeomDeviation",
    "Force",
    "PointSetDistance",
    "PointFinalSetDistance",
    "Volume",
    "Surface",
    "Displacement",
    "NormDisplacement",
    "DistanceToTriangularMeshFinal",
    "ComputingTime",
    "DistanceX",
    "DistanceY",
    "DistanceZ",
];

impl Monitor {
    /// Its numbers, parted by blanks, commas or semicolons; none where there are none or one of them is not a number.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let parts = self.data.as_deref()?.split(|c: char| c.is_whitespace() || c == ',' || c == ';');
        parts.filter(|part| !part.is_empty()).map(super::number::finite).collect()
    }
}

/// What a monitor is compared with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reference {
    /// A document of this language, relative to this one.
    pub document: Box<str>,
    /// Which of its monitors.
    pub monitor_index: Option<u32>,
    /// A component of its model.
    pub target: Option<Box<str>>,
    /// Attributes beyond these.
    pub properties: Attributes,
}
