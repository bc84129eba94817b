//! Which atoms of a cell are meant: some of them, or pairs.

use crate::units::{Angle, Length};
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

/// How large a cap is: give one of the four.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CapExtent {
    /// So many atoms.
    Number(#[schemars(range(min = 1, max = 4_294_967_295_u32))] u32),
    /// This fraction of the atoms, at least one.
    Fraction(#[schemars(range(max = 1.0), extend("exclusiveMinimum" = 0))] f64),
    /// The atoms seen from the centre within this angle of the direction.
    Angle(#[schemars(extend("x-exclusive-minimum" = 0, "x-maximum" = std::f64::consts::PI))] Angle),
    /// The atoms that lie no farther than this below the furthest one, along the direction: a side of a block.
    Depth(#[schemars(extend("x-exclusive-minimum" = 0, "x-maximum" = 1e6))] Length),
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
