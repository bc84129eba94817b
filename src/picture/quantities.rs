//! What a picture may colour the atoms by: what the result stores of them, and what follows from their positions.

use crate::Vec3;
use crate::error::Result;
use crate::geometry::{self, Surface};
use crate::output::ResultFile;
use std::collections::HashMap;
use std::ops::Range;

/// A quantity with one number for every atom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtomQuantity {
    /// Length of the force on the atom, pN; there where the experiment says `output.forces = true`.
    Force,
    /// Length of the force of the atom on planes, pN; there where the experiment says `output.tractions = true`.
    Traction,
    /// z of the atom, µm.
    Height,
    /// Distance from where the atom was in the first frame with its cell, µm.
    Displacement,
    /// Mean curvature of the surface, 1/µm, positive where it bulges outwards.
    Curvature,
}

/// A difference of a quantity, in its unit, that is round-off: far below the size of a molecule, and of what solvers of forces leave.
pub const LEAST: f64 = 1e-9;

/// Their names in documents and on the command line, and the labels of their colour bars.
const NAMES: [(&str, AtomQuantity, &str); 5] = [
    ("force", AtomQuantity::Force, "force on the atoms (pN)"),
    ("traction", AtomQuantity::Traction, "traction of the atoms (pN)"),
    ("height", AtomQuantity::Height, "height (µm)"),
    ("displacement", AtomQuantity::Displacement, "displacement (µm)"),
    ("curvature", AtomQuantity::Curvature, "mean curvature (1/µm)"),
];

impl AtomQuantity {
    /// The quantity with this name.
    pub fn named(name: &str) -> Option<Self> {
        NAMES.iter().find(|(known, ..)| *known == name).map(|(_, quantity, _)| *quantity)
    }

    /// All names.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMES.iter().map(|(name, ..)| *name)
    }

    /// What is written beside the colour bar.
    pub fn label(self) -> &'static str {
        NAMES.iter().find(|(_, quantity, _)| *quantity == self).map_or("", |(.., label)| label)
    }

    /// Whether a result has it.
    ///
    /// # Errors
    /// A damaged file.
    pub fn is_in(self, result: &ResultFile) -> Result<bool> {
        Ok(match self {
            Self::Force => result.frames() > 0 && result.forces(0)?.is_some(),
            Self::Traction => result.frames() > 0 && result.tractions(0)?.is_some(),
            Self::Height | Self::Displacement | Self::Curvature => true,
        })
    }

    /// Its value for every atom of a frame; NaN where there is none.
    ///
    /// # Errors
    /// A damaged file.
    pub fn of_frame(self, result: &ResultFile, frame: usize, positions: &[[f64; 3]]) -> Result<Vec<f64>> {
        Ok(match self {
            Self::Force => match result.forces(frame)? {
                Some(forces) => forces.into_iter().map(|force| Vec3::from(force).norm()).collect(),
                None => vec![f64::NAN; positions.len()],
            },
            Self::Traction => match result.tractions(frame)? {
                Some(all) => all.traction.into_iter().map(|force| Vec3::from(force).norm()).collect(),
                None => vec![f64::NAN; positions.len()],
            },
            Self::Height => positions.iter().map(|position| position[2]).collect(),
            Self::Displacement => {
                let start = first_positions(result, frame)?;
                positions.iter().zip(start).map(|(now, then)| (Vec3::from(*now) - Vec3::from(then)).norm()).collect()
            }
            Self::Curvature => curvature(result, frame, positions),
        })
    }
}

/// Where the atoms of a frame were in the first frame with their cell, µm.
fn first_positions(result: &ResultFile, frame: usize) -> Result<Vec<[f64; 3]>> {
    let (layout, cells) = (result.layout(), result.cells(frame));
    let born: Vec<usize> =
        result.columns(frame).iter().map(|column| result.known_cells()[*column as usize].frames.start).collect();
    let mut starts = born.clone();
    starts.sort_unstable();
    starts.dedup();
    let mut first = vec![[f64::NAN; 3]; layout.atoms(&cells)];
    for start in starts {
        let (then, known) = (result.positions(start)?, result.cells(start));
        let by_id: HashMap<u64, Range<usize>> = known.iter().map(|cell| cell.id).zip(layout.atoms_of(&known)).collect();
        let own = cells.iter().zip(layout.atoms_of(&cells)).zip(&born).filter(|(_, born)| **born == start);
        for ((cell, atoms), _) in own {
            first[atoms].copy_from_slice(&then[by_id[&cell.id].clone()]);
        }
    }
    Ok(first)
}

/// Mean curvature, cell by cell.
fn curvature(result: &ResultFile, frame: usize, positions: &[[f64; 3]]) -> Vec<f64> {
    let (layout, cells) = (result.layout(), result.cells(frame));
    let mut all = Vec::with_capacity(positions.len());
    for (cell, atoms) in cells.iter().zip(layout.atoms_of(&cells)) {
        let surface = Surface {
            positions: positions[atoms].iter().map(|position| Vec3::from(*position)).collect(),
            facets: layout.types[cell.kind as usize].facets.clone(),
        };
        all.extend(geometry::mean_curvature(&surface));
    }
    all
}
