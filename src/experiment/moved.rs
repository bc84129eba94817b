//! Atoms that go on a course, whatever acts on them. What documents say of it, and what it means.

use super::compile::{course, unit};
use super::selection::Selection;
use super::semantics::Check;
use crate::Vec3;
use crate::mechanics::moved;
use crate::recorded::Motion;
use crate::units::{Angle, Length};
use crate::values::{Axis, Course};
use nalgebra::Unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Atoms that are moved on a course, as by a grip, or as all of a rigid tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Moved {
    /// Names the series `displacement.NAME` and `force.NAME` (`angle.NAME` and `torque.NAME`) in the result; with the name of the type in between where several types have
    /// one of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// The atoms that are moved.
    #[serde(flatten)]
    pub selection: Selection,
    /// The direction in which they go; its length does not matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// How far they are from where they began, in the course of time: 0 at the start. None where they only turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub displacement: Option<Course<Length>>,
    /// How they turn about an axis meanwhile; the series are `angle.NAME` and `torque.NAME`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
    /// The axes along which nothing else moves them; along others they are free.
    #[serde(default = "all_axes")]
    #[schemars(length(min = 1))]
    pub axes: Vec<Axis>,
}

/// A turn about an axis, which goes where the atoms go.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// The axis; its length does not matter.
    pub axis: [f64; 3],
    /// A point of the scene that the axis goes through at the start.
    pub through: [Length; 3],
    /// By how much they have turned, right-handed, in the course of time: 0 at the start.
    pub angle: Course<Angle>,
}

fn all_axes() -> Vec<Axis> {
    vec![Axis::X, Axis::Y, Axis::Z]
}

impl Moved {
    /// What it means for these atoms.
    pub(super) fn of_atoms(&self, mut atoms: Vec<u32>) -> moved::Moved {
        atoms.sort_unstable();
        let translation = self.direction.zip(self.displacement.as_ref()).map(|(along, displacement)| {
            moved::Translation { direction: unit(along), displacement: course(displacement.points()) }
        });
        let rotation = self.rotation.as_ref().map(|turn| moved::Rotation {
            axis: Unit::new_normalize(unit(turn.axis)),
            through: Vec3::from(turn.through.map(|length| length.value())),
            angle: course(turn.angle.points()),
        });
        moved::Moved { name: self.name.clone(), atoms, translation, rotation }
    }

    /// What of it is recorded.
    pub(super) fn motion(&self) -> Motion {
        Motion { name: self.name.clone(), goes: self.displacement.is_some(), turns: self.rotation.is_some() }
    }
}

impl Check<'_> {
    /// What must hold of what is moved of a type.
    pub(super) fn moved(&mut self, path: &str, list: &[Moved]) {
        for (index, moved) in list.iter().enumerate() {
            let path = format!("{path}.moved[{index}]");
            self.selection(&path, &moved.selection);
            self.goes(&path, moved);
            if let Some(turn) = &moved.rotation {
                self.turns(&path, moved, turn);
            }
            if let Some(other) = list[..index].iter().position(|other| other.name == moved.name) {
                let message = format!("`{path}.name` is the name of moved atoms {other} too");
                let help = "names of moved atoms differ within a type of cells";
                self.fault(&format!("{path}.name"), "taken", message, help);
            }
        }
    }

    /// What goes has a direction and a course, and what has neither turns.
    fn goes(&mut self, path: &str, moved: &Moved) {
        match (moved.direction, &moved.displacement) {
            (Some(along), Some(displacement)) => {
                self.direction(&format!("{path}.direction"), along);
                self.along_axes(path, moved, along);
                self.begins_at_zero(&format!("{path}.displacement"), displacement.points(), "um");
            }
            (None, None) if moved.rotation.is_some() => {}
            (None, None) => {
                let message = format!("`{path}` neither goes nor turns");
                let help = "give `direction` and `displacement`, or `rotation`; atoms that rest are `fixed`";
                self.fault(path, "moves nothing", message, help);
            }
            (along, displacement) => {
                self.both(path, [("direction", along.is_some()), ("displacement", displacement.is_some())]);
            }
        }
    }

    fn turns(&mut self, path: &str, moved: &Moved, turn: &Rotation) {
        self.direction(&format!("{path}.rotation.axis"), turn.axis);
        self.begins_at_zero(&format!("{path}.rotation.angle"), turn.angle.points(), "rad");
        if all_axes().iter().any(|axis| !moved.axes.contains(axis)) {
            let message = format!("`{path}` turns atoms that `axes` leaves free along an axis");
            let help = "leave `axes` out: what turns is moved along all of them";
            self.fault(&format!("{path}.axes"), "lacks an axis", message, help);
        }
    }

    pub(in crate::experiment) fn begins_at_zero(&mut self, key: &str, points: Vec<(f64, f64)>, unit: &str) {
        self.course(key, &points);
        let begins = points.first().map_or(0.0, |_| course(points.clone()).at(0.0));
        if begins != 0.0 {
            let message = format!("`{key}` is {begins} {unit} at 0 s");
            let help = format!("atoms begin where they are: let it begin with [\"0 s\", \"0 {unit}\"]");
            self.fault(key, "not 0 at the start", message, &help);
        }
    }

    /// What is free along an axis cannot be moved along it.
    fn along_axes(&mut self, path: &str, moved: &Moved, along: [f64; 3]) {
        for (axis, name) in [(Axis::X, "x"), (Axis::Y, "y"), (Axis::Z, "z")] {
            if along[axis as usize] != 0.0 && !moved.axes.contains(&axis) {
                let message = format!("`{path}.direction` goes along {name}, along which `axes` leaves the atoms free");
                let help = format!("add \"{name}\" to the axes, or let the direction be 0 along it");
                self.fault(&format!("{path}.axes"), "lacks an axis", message, help);
            }
        }
    }
}
