//! How what acts on some atoms is shared by them.

use super::compile::Builder;
use super::selection::Selection;
use crate::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

impl Spread {
    /// The chosen atoms of a cell and the share of each; heights in a cap are along `up`, `areas` are those around all atoms (µm²).
    pub(super) fn shares(
        self,
        path: &str,
        selection: &Selection,
        up: Vec3,
        areas: &[f64],
        to: &mut Builder,
    ) -> Vec<(u32, f64)> {
        let (atoms, heights) = to.atoms_and_heights(path, selection, up);
        let weight = |atom: u32| match self {
            Self::Equal => 1.0,
            Self::Area => areas[atom as usize],
            Self::Tapered => areas[atom as usize] * heights[atom as usize],
        };
        let total: f64 = atoms.iter().map(|&atom| weight(atom)).sum();
        atoms.into_iter().map(|atom| (atom, weight(atom) / total)).collect()
    }
}
