//! Pressures on facets. What documents say of them, and what it means.

use super::compile::{Builder, course, unit};
use super::selection::Selection;
use super::semantics::Check;
use crate::Vec3;
use crate::analysis::table::Table;
use crate::error::{Error, Fault, Result};
use crate::mechanics::pressure;
use crate::units::{Length, Stress};
use crate::values::Course;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A pressure on facets of every cell of the type, along their normals wherever these are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Pressure {
    /// Names the series `pressure.NAME` in the result; `pressure.TYPE.NAME` where several types have pressures of this name.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// The atoms of the facets on which it acts: all three of a facet are among them.
    #[serde(flatten)]
    pub selection: Selection,
    /// How much higher it is outside, constant or in the course of time: it pushes facets in, or draws them out where it is negative, as suction
    /// does.
    pub pressure: Course<Stress>,
    /// Where it acts; everywhere when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond: Option<Beyond>,
    /// How it differs over the surface; alike everywhere when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<Profile>,
}

/// A pressure that differs with the angle from an axis, as that of light on a cell in a beam.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// The axis in space; its length does not matter.
    pub axis: [f64; 3],
    /// The table (CSV with a line of column names), relative to the document.
    #[schemars(extend("x-text" = "file"))]
    pub table: PathBuf,
    /// Its column of angles between the axis and the direction in which a facet lies from the mean of the atoms of its cell, degrees, rising from 0 to 180.
    pub angle_column: String,
    /// Its column of what the pressure is multiplied by there.
    pub factor_column: String,
}

/// What is beyond a plane, as within the mouth of a pipette.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Beyond {
    /// A point of the plane.
    pub point: [Length; 3],
    /// The direction, at right angles to the plane, in which what is beyond lies; its length does not matter.
    pub direction: [f64; 3],
    /// How far from the axis through the point, along the direction, it acts: some radius within the wall of a pipette. Everywhere beyond the plane
    /// when absent.
    #[schemars(extend("x-exclusive-minimum" = 0, "x-maximum" = 1e6))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<Length>,
}

impl Pressure {
    /// What it means; it stands at this key of its type.
    pub(super) fn compiled(&self, path: &str, to: &mut Builder) -> pressure::Pressure {
        let atoms = to.atoms(path, &self.selection);
        let chosen = |facet: &&[u32; 3]| facet.iter().all(|atom| atoms.binary_search(atom).is_ok());
        let facets: Vec<[u32; 3]> = to.rest().facets.iter().filter(chosen).copied().collect();
        if facets.is_empty() && !atoms.is_empty() {
            let found = "no facet of the mesh has all three of its atoms among those that are chosen";
            to.fault(path, "acts on no facet", found, "choose more atoms: a wider cap, or all = true");
        }
        let beyond = self.beyond.as_ref().map(|beyond| pressure::Beyond {
            point: Vec3::from(beyond.point.map(|length| length.value())),
            direction: unit(beyond.direction),
            radius: beyond.radius.map(|radius| radius.value()),
        });
        let pressure = course(self.pressure.points());
        let profile = self.profile.as_ref().and_then(|profile| {
            let told = profile
                .compiled(to)
                .map_err(|error| to.faults_at(&format!("{path}.profile.table"), "this table", error));
            told.ok()
        });
        pressure::Pressure { name: self.name.clone(), facets, pressure, beyond, profile }
    }
}

impl Profile {
    /// What it means.
    ///
    /// # Errors
    /// A table that cannot be read, lacks a column, or does not rise from 0 to 180 degrees.
    fn compiled(&self, to: &Builder) -> Result<pressure::Profile> {
        let table = Table::read(&to.resolve(&self.table))?;
        let (angles, factors) = (table.column(&self.angle_column)?, table.column(&self.factor_column)?);
        let reach = angles.first() == Some(&0.0) && angles.last() == Some(&180.0);
        if !reach || !angles.is_sorted_by(|one, other| one < other) || factors.iter().any(|factor| !factor.is_finite())
        {
            let found =
                "the angles of a profile rise from 0 in the first row to 180 in the last, and each has its factor";
            let help =
                "order the rows by the angle, add those of 0 and 180 degrees, and leave out those without a number";
            return Err(Error::input(Fault::new(found).help(help)));
        }
        let cosines = angles.iter().rev().map(|angle| angle.to_radians().cos()).collect();
        let factors = factors.iter().rev().copied().collect();
        Ok(pressure::Profile { axis: unit(self.axis), cosines, factors, atoms: to.rest().positions.len() })
    }
}

impl Check<'_> {
    /// What must hold of the pressures on a type of cells.
    pub(super) fn pressures(&mut self, path: &str, pressures: &[Pressure]) {
        for (index, pressure) in pressures.iter().enumerate() {
            let path = format!("{path}.pressures[{index}]");
            self.selection(&path, &pressure.selection);
            self.course(&format!("{path}.pressure"), &pressure.pressure.points());
            if let Some(beyond) = &pressure.beyond {
                self.direction(&format!("{path}.beyond.direction"), beyond.direction);
            }
            if let Some(profile) = &pressure.profile {
                self.direction(&format!("{path}.profile.axis"), profile.axis);
            }
            if let Some(other) = pressures[..index].iter().position(|other| other.name == pressure.name) {
                let message = format!("`{path}.name` is the name of pressure {other} too");
                let help = "names of pressures differ within a type of cells";
                self.fault(&format!("{path}.name"), "taken", message, help);
            }
        }
    }
}
