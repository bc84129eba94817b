//! What is done to some atoms of a cell: holding, pulling, linking.

use super::values::{Axis, Course};
use crate::units::{Angle, Force, Length, LineStiffness};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Some atoms of a cell: give one of the three.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Selection {
    /// Atoms by number, from 0.
    Atoms(#[schemars(length(min = 1))] Vec<u32>),
    /// The atoms furthest along a direction.
    Cap(Cap),
    /// Every atom (`all = true`).
    All(#[schemars(extend("const" = true))] bool),
}

/// The atoms of a cell at rest that lie furthest along a direction from its centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Cap {
    /// The direction; its length does not matter.
    pub direction: [f64; 3],
    /// How many atoms.
    #[serde(flatten)]
    pub extent: CapExtent,
}

/// How large a cap is: give one of the three.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CapExtent {
    /// So many atoms.
    Number(#[schemars(range(min = 1, max = 4_294_967_295_u32))] u32),
    /// This fraction of the atoms, at least one.
    Fraction(#[schemars(range(max = 1.0), extend("exclusiveMinimum" = 0))] f64),
    /// The atoms seen from the centre within this angle of the direction.
    Angle(#[schemars(extend("x-exclusive-minimum" = 0, "x-maximum" = std::f64::consts::PI))] Angle),
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

/// How a force is shared by the atoms that it acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Spread {
    /// The same on every atom.
    #[default]
    Equal,
    /// In proportion to the area around every atom at rest: a constant traction.
    Area,
    /// As `area`, but fading with the height of the atom in its cap, from full at the top to nothing at the rim: no
    /// jump of traction at the rim, so that coarse meshes feel the same load as fine ones.
    Tapered,
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

/// Which atoms are linked: give one of the two.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Linked {
    /// Pairs of atoms by number, from 0.
    Pairs(#[schemars(length(min = 1))] Vec<[u32; 2]>),
    /// Pairs found by symmetry.
    Pattern(LinkPattern),
}

/// Pairs of atoms found by symmetry, in the mesh at rest before it is turned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum LinkPattern {
    /// Every atom to its mirror image through the z axis, at the same height.
    Horizontal,
    /// Every atom to the one opposite through the centre.
    Diagonal,
}
