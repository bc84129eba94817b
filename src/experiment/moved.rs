//! Atoms that go on a course, whatever acts on them. What documents say of it, and what it means.

use super::compile::{course, unit};
use super::selection::Selection;
use super::semantics::Check;
use crate::mechanics::moved;
use crate::units::Length;
use crate::values::{Axis, Course};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Atoms that are moved on a course, as by a grip, or as all of a rigid tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Moved {
    /// Names the series `displacement.NAME` and `force.NAME` in the result; with the name of the type in between where several types have
    /// one of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// The atoms that are moved.
    #[serde(flatten)]
    pub selection: Selection,
    /// The direction in which they go; its length does not matter.
    pub direction: [f64; 3],
    /// How far they are from where they began, in the course of time: 0 at the start.
    pub displacement: Course<Length>,
    /// The axes along which nothing else moves them; along others they are free.
    #[serde(default = "all_axes")]
    #[schemars(length(min = 1))]
    pub axes: Vec<Axis>,
}

fn all_axes() -> Vec<Axis> {
    vec![Axis::X, Axis::Y, Axis::Z]
}

impl Moved {
    /// What it means for these atoms.
    pub(super) fn of_atoms(&self, mut atoms: Vec<u32>) -> moved::Moved {
        atoms.sort_unstable();
        let (direction, displacement) = (unit(self.direction), course(self.displacement.points()));
        moved::Moved { name: self.name.clone(), atoms, direction, displacement }
    }
}

impl Check<'_> {
    /// What must hold of what is moved of a type.
    pub(super) fn moved(&mut self, path: &str, list: &[Moved]) {
        for (index, moved) in list.iter().enumerate() {
            let path = format!("{path}.moved[{index}]");
            self.selection(&path, &moved.selection);
            self.direction(&format!("{path}.direction"), moved.direction);
            let (key, points) = (format!("{path}.displacement"), moved.displacement.points());
            self.course(&key, &points);
            self.along_axes(&path, moved);
            let begins = points.first().map_or(0.0, |_| course(points.clone()).at(0.0));
            if begins != 0.0 {
                let message = format!("`{key}` is {begins} um at 0 s");
                let help = "atoms begin where they are: let it begin with [\"0 s\", \"0 um\"]";
                self.fault(&key, "not 0 at the start", message, help);
            }
            if let Some(other) = list[..index].iter().position(|other| other.name == moved.name) {
                let message = format!("`{path}.name` is the name of moved atoms {other} too");
                let help = "names of moved atoms differ within a type of cells";
                self.fault(&format!("{path}.name"), "taken", message, help);
            }
        }
    }

    /// What is free along an axis cannot be moved along it.
    fn along_axes(&mut self, path: &str, moved: &Moved) {
        for (axis, name) in [(Axis::X, "x"), (Axis::Y, "y"), (Axis::Z, "z")] {
            if moved.direction[axis as usize] != 0.0 && !moved.axes.contains(&axis) {
                let message = format!("`{path}.direction` goes along {name}, along which `axes` leaves the atoms free");
                let help = format!("add \"{name}\" to the axes, or let the direction be 0 along it");
                self.fault(&format!("{path}.axes"), "lacks an axis", message, help);
            }
        }
    }
}
