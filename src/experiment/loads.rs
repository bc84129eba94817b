//! What is done to some atoms of a cell: holding, pulling, linking. What documents say of it, and what it means.

use super::compile::{Builder, course, unit};
use super::moved::Moved;
use super::plate::Plate;
use super::pressure::Pressure;
use super::rigid::Trap;
use super::selection::{Linked, Selection};
use super::semantics::Check;
use super::spread::Spread;
use super::torque::Torque;
use crate::geometry;
use crate::mechanics::fibres::Fibres;
use crate::mechanics::springs::{Spring, Springs};
use crate::mechanics::{self, load};
use crate::units::{Force, Length, LineStiffness};
use crate::values::{Axis, Course};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// What is done to some atoms of every cell of a type.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Applied {
    /// Atoms that are held where they start, along some axes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<Fixed>,
    /// Atoms that are moved on a course, whatever acts on them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub moved: Vec<Moved>,
    /// Forces applied to some atoms.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// Pressures on some facets, along their normals.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pressures: Vec<Pressure>,
    /// Torques on some atoms.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub torques: Vec<Torque>,
    /// Springs that draw the bodies of a rigid type to points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub traps: Vec<Trap>,
    /// Flexible plates that atoms are bonded to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plates: Vec<Plate>,
    /// A file of loads in LML, relative to the document, that act and hold besides. Its atoms are those of the PML file that the mesh is of, or the
    /// atoms of the mesh by number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "file"))]
    pub loads_file: Option<PathBuf>,
    /// Internal springs between atoms of the same cell.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<Link>,
    /// Contractile fibres between atoms of the same cell.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fibres: Vec<Fibre>,
}

/// Atoms that are held where they start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Fixed {
    /// Which atoms.
    #[serde(flatten)]
    pub selection: Selection,
    /// The axes along which they are held.
    #[serde(default = "all_axes")]
    #[schemars(length(min = 1))]
    pub axes: Vec<Axis>,
}

impl Fixed {
    /// These atoms, held along all axes.
    pub fn entirely(selection: Selection) -> Self {
        Self { selection, axes: all_axes() }
    }
}

fn all_axes() -> Vec<Axis> {
    vec![Axis::X, Axis::Y, Axis::Z]
}

/// A force on some atoms of every cell of the type.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Load {
    /// Names the series `load.NAME` in the result; `load.TYPE.NAME` where several types have loads of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// The atoms that are pulled.
    #[serde(flatten)]
    pub selection: Selection,
    /// The direction of the force; its length does not matter.
    pub direction: [f64; 3],
    /// The force in all, constant or in the course of time.
    pub force: Course<Force>,
    /// How the force is shared by the atoms.
    #[serde(default)]
    pub spread: Spread,
}

/// Springs between atoms of the same cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Link {
    /// Which atoms are linked.
    #[serde(flatten)]
    pub linked: Linked,
    /// Stiffness of each spring.
    #[schemars(extend("x-minimum" = 0))]
    pub stiffness: LineStiffness,
    /// Length at rest of each spring; the distance in the cell at rest when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub rest_length: Option<Length>,
    /// The same as a multiple of the distance in the cell at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub rest_ratio: Option<f64>,
}

/// Contractile fibres between atoms of the same cell: they draw their ends together, as far as they are active.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Fibre {
    /// The name by which chemistry sets the activation, `cell.fibre[NAME]`.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// Which atoms are at the ends.
    #[serde(flatten)]
    pub linked: Linked,
    /// Stiffness of each fibre at full activation: it pulls with that times its length.
    #[schemars(extend("x-minimum" = 0))]
    pub stiffness: LineStiffness,
    /// Activation from 0 to 1, constant or in the course of time; what chemistry sets takes its place.
    #[serde(default = "relaxed")]
    pub activation: Course<f64>,
}

fn relaxed() -> Course<f64> {
    Course::Constant(0.0)
}

/// The length at rest of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rest {
    /// A length of its own.
    Length(Length),
    /// A multiple of the distance in the cell at rest.
    Ratio(f64),
}

impl Link {
    /// The length at rest.
    pub fn rest(&self) -> Rest {
        match (self.rest_length, self.rest_ratio) {
            (Some(length), _) => Rest::Length(length),
            (None, ratio) => Rest::Ratio(ratio.unwrap_or(1.0)),
        }
    }
}

impl Applied {
    /// Adds the springs of all links; they are elastic.
    pub(super) fn add_links(&self, to: &mut Builder) {
        for (i, link) in self.links.iter().enumerate() {
            let pairs = to.pairs(&format!("links[{i}]"), &link.linked);
            let spring = |&[one, other]: &[u32; 2]| {
                let [from, end] = [one, other].map(|atom| to.plain().positions[atom as usize]);
                let rest_length = match link.rest() {
                    Rest::Length(length) => length.value(),
                    Rest::Ratio(ratio) => ratio * (from - end).norm(),
                };
                Spring { from: one, to: other, rest_length, stiffness: link.stiffness.value() }
            };
            let springs = pairs.iter().map(spring).collect();
            to.drawn.extend(pairs);
            to.forces.push(mechanics::Force::Springs(Springs::between(springs)));
        }
    }

    /// Adds what does work on cells.
    pub(super) fn add_driven(&self, to: &mut Builder) {
        let areas = geometry::atom_areas(to.rest());
        for (i, load) in self.loads.iter().enumerate() {
            let direction = unit(load.direction);
            let shares = load.spread.shares(&format!("loads[{i}]"), &load.selection, direction, &areas, to);
            let load = load::Load::new(&load.name, shares, direction, course(load.force.points()));
            to.forces.push(mechanics::Force::Load(load));
        }
        for (i, pressure) in self.pressures.iter().enumerate() {
            let force = pressure.compiled(&format!("pressures[{i}]"), to);
            to.forces.push(mechanics::Force::Pressure(force));
        }
        for (i, torque) in self.torques.iter().enumerate() {
            let force = torque.compiled(&format!("torques[{i}]"), to);
            to.forces.push(mechanics::Force::Torque(force));
        }
        to.forces.extend(self.traps.iter().map(|trap| mechanics::Force::Trap(trap.compiled())));
        for (i, plate) in self.plates.iter().enumerate() {
            let force = plate.compiled(&format!("plates[{i}]"), to);
            to.forces.push(mechanics::Force::Plate(force));
        }
        for (i, fibre) in self.fibres.iter().enumerate() {
            let pairs = to.pairs(&format!("fibres[{i}]"), &fibre.linked);
            to.drawn.extend(&pairs);
            let activation = course(fibre.activation.points());
            let fibres = Fibres::new(&fibre.name, pairs, fibre.stiffness.value(), activation);
            to.forces.push(mechanics::Force::Fibres(fibres));
        }
    }
}

impl Check<'_> {
    /// What must hold within what is done to the atoms of a type of cells.
    pub(super) fn applied(&mut self, path: &str, applied: &Applied) {
        self.links(path, applied);
        self.fibres(path, applied);
        self.moved(path, &applied.moved);
        self.pressures(path, &applied.pressures);
        self.loads(path, applied);
    }

    fn loads(&mut self, path: &str, applied: &Applied) {
        for (index, fixed) in applied.fixed.iter().enumerate() {
            self.selection(&format!("{path}.fixed[{index}]"), &fixed.selection);
        }
        for (index, load) in applied.loads.iter().enumerate() {
            let path = format!("{path}.loads[{index}]");
            self.selection(&path, &load.selection);
            self.direction(&format!("{path}.direction"), load.direction);
            self.course(&format!("{path}.force"), &load.force.points());
            if let Some(other) = applied.loads[..index].iter().position(|other| other.name == load.name) {
                let message = format!("`{path}.name` is the name of load {other} too");
                self.fault(&format!("{path}.name"), "taken", message, "names of loads differ within a type of cells");
            }
        }
    }

    fn fibres(&mut self, path: &str, applied: &Applied) {
        for (index, fibre) in applied.fibres.iter().enumerate() {
            let path = format!("{path}.fibres[{index}]");
            self.pairs(&path, &fibre.linked);
            let points = fibre.activation.points();
            self.course(&format!("{path}.activation"), &points);
            if let Some((time, value)) = points.iter().find(|(_, value)| !(0.0..=1.0).contains(value)) {
                let message = format!("`{path}.activation` is {value} at {time} s");
                let help = "an activation is a number from 0 (relaxed) to 1 (all that the stiffness gives)";
                self.fault(&format!("{path}.activation"), "not from 0 to 1", message, help);
            }
            if let Some(other) = applied.fibres[..index].iter().position(|other| other.name == fibre.name) {
                let message = format!("`{path}.name` is the name of fibres {other} too");
                self.fault(&format!("{path}.name"), "taken", message, "names of fibres differ within a type of cells");
            }
        }
    }

    fn links(&mut self, path: &str, applied: &Applied) {
        for (index, link) in applied.links.iter().enumerate() {
            let path = format!("{path}.links[{index}]");
            self.pairs(&path, &link.linked);
            if link.rest_length.is_some() && link.rest_ratio.is_some() {
                let message = format!("`{path}` has both `rest_length` and `rest_ratio`");
                self.fault(
                    &format!("{path}.rest_ratio"),
                    "only one of them may be given",
                    message,
                    "remove one of them",
                );
            }
        }
    }
}
