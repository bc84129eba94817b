//! The experiment document: what a user wants to see happen, described, read, checked as a whole, compiled.
//!
//! The types here are the only definition of the document: `serde` reads and writes them, their doc comments and
//! attributes become the JSON schema ([`schema()`]), and the schema drives the checker that finds every fault of a
//! text at once ([`Document::read`]). Library users build the same [`Experiment`] without a file:
//!
//! ```
//! use pseudopod::experiment::*;
//! use pseudopod::units::{Drag, Force, Length, LineStiffness, Time};
//!
//! let mechanics = Mechanics {
//!     drag: Some(Drag::new(20.0)),
//!     shape_memory: Some(ShapeMemory::of_modulus(LineStiffness::new(5.0))),
//!     ..Mechanics::default()
//! };
//! let mut cell = CellType::new(Mesh::Icosphere { radius: Length::new(5.0), level: 2, finest: None }, mechanics);
//! cell.applied.loads.push(Load {
//!     name: "pull".into(),
//!     selection: Selection::Cap(Cap { direction: [1.0, 0.0, 0.0], extent: CapExtent::Number(5) }),
//!     direction: [1.0, 0.0, 0.0],
//!     force: Course::Constant(Force::new(10.0)),
//!     spread: Spread::Equal,
//! });
//! let mut experiment = Experiment::new("A pulled cell", Time::new(30.0));
//! experiment.cells.insert("white".into(), cell);
//!
//! // The same checks as for a file; the document carries its text into the result.
//! let document = Document::from_experiment(experiment)?;
//! assert!(document.source.text.contains("[[cells.white.loads]]"));
//! # Ok::<(), pseudopod::error::Error>(())
//! ```

mod along;
mod as_lml;
mod cells;
mod check;
mod chemistry;
mod compile;
mod contact;
mod cut_short;
mod document;
mod loads;
mod mechanics;
mod membrane;
mod motility;
mod moved;
mod pictures;
mod placement;
mod plate;
mod population;
mod pressure;
mod pseudopods;
mod read;
mod region;
mod rigid;
mod scene;
mod schema;
mod selection;
mod semantics;
mod solid;
mod spread;
mod tool;
mod torque;
mod tree;
mod viscosity;
mod volume;

pub use crate::analysis::measures::{self, Measure, MeasureKind};
pub use crate::values::{Axis, Colour, Course, LengthUnit, OneOrMany, When};
pub use along::Checked;
pub use as_lml::loads_as_lml;
pub use cells::{CellType, Finest, Mesh, Orientation};
pub use chemistry::{Chemistry, ChemistryLink, Scheme};
pub use compile::{
    Compiled, Prepared, PushedApart, Schedule, Settling, Size, compile, load_profile, notices, prepare, settle_start,
    settle_start_told,
};
pub use contact::{Between, Bonds, Catch, Contact, ContactModel, Zones};
pub use document::Document;
#[cfg(feature = "cli")]
pub(crate) use document::near_file;
pub use loads::{Applied, Fibre, Fixed, Link, Load, Rest};
pub use mechanics::{Barrier, Form, Mechanics, Reaction, ShapeMemory, ShapeStrength, Springs};
pub use membrane::{BendingRest, Law, Membrane};
pub use motility::{Attraction, Brownian, Motility, Space};
pub use moved::{Moved, Rotation};
pub use pictures::{FieldLine, MeasureCurve, Picture, Plot, PlotKind, PlotTable, View};
pub use placement::Placement;
pub use plate::Plate;
pub use population::{Added, Removed};
pub use pressure::{Beyond, Pressure, Profile};
pub use pseudopods::{ContactInhibition, InhibitedBy, PodFibres, Pseudopods};
pub use region::Region;
pub use rigid::{Rigid, Trap};
pub use scene::{Environment, Equilibrium, Integrator, Method, Output, Plane, Run};
pub use schema::{schema, schema_of};
pub use selection::{Cap, CapExtent, LinkPattern, Linked, Selection};
pub use solid::{Material, Neighbours, Solid, VolumeOver};
pub use spread::Spread;
pub use tool::{Tool, ToolSurface};
pub use viscosity::Viscosity;
pub use volume::{VolumeControl, VolumeRule};

use crate::recorded::{
    Motion, NAMED, OnDemand, names_by_type, series_of_moved, series_of_plates, series_of_pressures, series_of_tool,
    series_of_torques, series_of_traps,
};
use crate::units::Time;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An experiment of Pseudopod: cells, what they are made of, what is done to them, what is recorded and measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Pseudopod experiment")]
pub struct Experiment {
    /// One line that names the experiment.
    pub title: String,
    /// What the experiment shows, in a few sentences.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The publication that the experiment follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
    /// Everything random follows from this number.
    #[serde(default)]
    #[schemars(range(max = 9_223_372_036_854_775_807_u64))]
    pub seed: u64,
    /// How long and with which integrator to run.
    pub run: Run,
    /// The types of cells, by name.
    #[serde(default)]
    pub cells: IndexMap<String, CellType>,
    /// Equations and fields that take part, by name.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub chemistry: IndexMap<String, Chemistry>,
    /// What acts everywhere.
    #[serde(default)]
    pub environment: Environment,
    /// Rigid planes that no cell passes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub planes: Vec<Plane>,
    /// Rigid bodies with exact surfaces that no cell passes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tools: Vec<Tool>,
    /// Contacts between cells; without it they pass through each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// What is recorded, and how often.
    #[serde(default)]
    pub output: Output,
    /// Numbers computed from the finished run, by name; they are stored in the result.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub measure: IndexMap<String, Measure>,
    /// The picture made at the end of a run.
    #[serde(default)]
    pub picture: Picture,
    /// Charts made at the end of a run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plot: Vec<Plot>,
}

impl Experiment {
    /// The names of all that cells cannot pass: planes, then tools.
    pub(crate) fn obstacles(&self) -> impl Iterator<Item = &str> {
        let planes = self.planes.iter().map(|plane| plane.name.as_str());
        planes.chain(self.tools.iter().map(|tool| tool.name.as_str()))
    }

    /// What is recorded of cells that not all runs have.
    pub(crate) fn on_demand(&self) -> OnDemand {
        let fibres = self.cells.values().any(|cell| cell.fibre_budget() > 0);
        let viscosity = self.cells.values().any(|cell| cell.mechanics.is_viscous());
        OnDemand { tractions: self.keeps_tractions(), fibres, viscosity }
    }

    /// Whether tractions are recorded: where they are asked for, and where atoms are moved or there are tools, whose forces are among them.
    pub(crate) fn keeps_tractions(&self) -> bool {
        self.output.tractions
            || !self.tools.is_empty()
            || self.cells.values().any(|cell| !cell.applied.moved.is_empty())
    }

    /// Whether a series is of what is moved, of a trap, a pressure or a torque, or may be of a load in a file.
    pub(super) fn is_of_what_is_moved(&self, series: &str) -> bool {
        let of_cells = [self.series_of_moved(), self.series_of_traps(), self.series_of_plates()].concat();
        let own = [of_cells, self.series_of_tools(), self.series_of_pressures(), self.series_of_torques()].concat();
        self.may_be_of_load_file(series) || own.iter().any(|name| name == series)
    }

    /// Whether a series may be of a load in a file, which is read later: `load.lml1` and its like.
    pub(super) fn may_be_of_load_file(&self, series: &str) -> bool {
        let (word, name) = series.split_once('.').unwrap_or_default();
        // With the name of the type before it where several types have such files.
        let number = name.rsplit('.').next().and_then(|name| name.strip_prefix("lml"));
        NAMED.iter().any(|known| known.0 == word)
            && number.is_some_and(|number| number.parse::<u32>().is_ok())
            && self.cells.values().any(|cell| cell.applied.loads_file.is_some())
    }

    /// Names of the series of what is moved.
    pub(super) fn series_of_moved(&self) -> Vec<String> {
        let own = |cell: &CellType| cell.applied.moved.iter().map(Moved::motion).collect();
        let types: Vec<(&str, Vec<Motion>)> =
            self.cells.iter().map(|(kind, cell)| (kind.as_str(), own(cell))).collect();
        series_of_moved(&types).into_iter().map(|(name, _)| name).collect()
    }

    /// Names of the series of traps.
    pub(super) fn series_of_traps(&self) -> Vec<String> {
        let own = |cell: &CellType| cell.applied.traps.iter().map(|trap| trap.name.clone()).collect();
        let types: Vec<(&str, Vec<String>)> =
            self.cells.iter().map(|(kind, cell)| (kind.as_str(), own(cell))).collect();
        series_of_traps(&types)
    }

    /// Names of the series of flexible plates.
    pub(super) fn series_of_plates(&self) -> Vec<String> {
        let own = |cell: &CellType| cell.applied.plates.iter().map(|plate| plate.name.clone()).collect();
        let types: Vec<(&str, Vec<String>)> =
            self.cells.iter().map(|(kind, cell)| (kind.as_str(), own(cell))).collect();
        series_of_plates(&types).into_iter().map(|(name, _)| name).collect()
    }

    /// Names of the series of tools.
    pub(super) fn series_of_tools(&self) -> Vec<String> {
        let own = |tool: &Tool| series_of_tool(&tool.name, tool.displacement.is_some());
        self.tools.iter().flat_map(own).map(|(name, _)| name).collect()
    }

    /// Names of the series of pressures.
    pub(super) fn series_of_pressures(&self) -> Vec<String> {
        let own = |cell: &CellType| cell.applied.pressures.iter().map(|own| own.name.clone()).collect();
        let types: Vec<(&str, Vec<String>)> =
            self.cells.iter().map(|(kind, cell)| (kind.as_str(), own(cell))).collect();
        series_of_pressures(&types)
    }

    /// Names of the series of torques.
    pub(super) fn series_of_torques(&self) -> Vec<String> {
        let own = |cell: &CellType| cell.applied.torques.iter().map(|own| own.name.clone()).collect();
        let types: Vec<(&str, Vec<String>)> =
            self.cells.iter().map(|(kind, cell)| (kind.as_str(), own(cell))).collect();
        series_of_torques(&types).into_iter().map(|(name, _)| name).collect()
    }

    /// Names of the series of loads.
    pub(super) fn series_of_loads(&self) -> Vec<String> {
        let own = |cell: &CellType| cell.applied.loads.iter().map(|load| load.name.clone()).collect();
        let types: Vec<(&str, Vec<String>)> =
            self.cells.iter().map(|(kind, cell)| (kind.as_str(), own(cell))).collect();
        names_by_type(&types).into_iter().map(|name| format!("load.{name}")).collect()
    }

    /// An experiment that lasts `until`, still without cells, with the defaults everywhere else.
    pub fn new(title: impl Into<String>, until: Time) -> Self {
        Self {
            title: title.into(),
            description: None,
            reference: None,
            seed: 0,
            run: Run { until, equilibrium: None, integrator: Integrator::default() },
            cells: IndexMap::new(),
            chemistry: IndexMap::new(),
            environment: Environment::default(),
            planes: Vec::new(),
            tools: Vec::new(),
            contact: None,
            output: Output::default(),
            measure: IndexMap::new(),
            picture: Picture::default(),
            plot: Vec::new(),
        }
    }
}
