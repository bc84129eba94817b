//! What a picture may colour the atoms by: what the result stores of them, and what follows from their places.

use crate::Vec3;
use crate::error::Result;
use crate::geometry::{self, Surface};
use crate::output::ResultFile;

/// A quantity with one number for every atom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AtomQuantity {
    /// Length of the force on the atom, pN; there where the experiment says `output.forces = true`.
    Force,
    /// z of the atom, µm.
    Height,
    /// Distance from where the atom was in the first frame, µm.
    Displacement,
    /// Mean curvature of the surface, 1/µm, positive where it bulges outwards.
    Curvature,
}

/// Their names in documents and on the command line, and the labels of their colour bars.
const NAMES: [(&str, AtomQuantity, &str); 4] = [
    ("force", AtomQuantity::Force, "force on the atoms (pN)"),
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
        Ok(self != Self::Force || (result.frames() > 0 && result.forces(0)?.is_some()))
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
            Self::Height => positions.iter().map(|place| place[2]).collect(),
            Self::Displacement => {
                let start = result.positions(0)?;
                positions.iter().zip(start).map(|(now, then)| (Vec3::from(*now) - Vec3::from(then)).norm()).collect()
            }
            Self::Curvature => curvature(result, positions),
        })
    }
}

/// Mean curvature, cell by cell.
fn curvature(result: &ResultFile, positions: &[[f64; 3]]) -> Vec<f64> {
    let layout = result.layout();
    let mut all = Vec::with_capacity(positions.len());
    for cell in &layout.cells {
        let atoms = cell.first_atom as usize..(cell.first_atom + cell.atoms) as usize;
        let facets = &layout.facets[cell.first_facet as usize..(cell.first_facet + cell.facets) as usize];
        let surface = Surface {
            positions: positions[atoms].iter().map(|place| Vec3::from(*place)).collect(),
            facets: facets.iter().map(|facet| facet.map(|atom| atom - cell.first_atom)).collect(),
        };
        all.extend(geometry::mean_curvature(&surface));
    }
    all
}
