//! What the colours of a picture show: the type of a cell, a series of the cells, or a quantity of the atoms.

use super::field_view::with_unit;
use super::plots;
use super::quantities::AtomQuantity;
use crate::error::{Error, Fault, Result};
use crate::output::ResultFile;

/// What colours show.
#[derive(Debug, Clone, PartialEq)]
pub enum Shown {
    /// The type of the cell.
    Type,
    /// What the result stores of the atoms, or what follows from where they are.
    Atoms(AtomQuantity),
    /// A substance on membranes, `SYSTEM.VARIABLE`.
    Membrane(String),
    /// A series of the cells.
    Cells(String),
}

/// What has a number each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// Nothing: colours are those of types.
    Types,
    /// Cells.
    Cells,
    /// Atoms.
    Atoms,
}

impl Shown {
    /// What `name` means for this result: `type`, a quantity of atoms or a series of cells.
    ///
    /// # Errors
    /// [`Error::Input`] that lists what there is.
    pub fn named(result: &ResultFile, name: &str) -> Result<Self> {
        if name == "type" {
            return Ok(Self::Type);
        }
        if result.series_names().iter().any(|known| known == name) {
            return Ok(Self::Cells(name.to_owned()));
        }
        if result.layout().membranes.iter().any(|membrane| membrane.name == name) {
            return Ok(Self::Membrane(name.to_owned()));
        }
        match AtomQuantity::named(name) {
            Some(quantity) if quantity.is_in(result)? => Ok(Self::Atoms(quantity)),
            Some(quantity) => {
                let (what, key) = match quantity {
                    AtomQuantity::Traction => ("tractions of", "tractions"),
                    _ => ("forces on", "forces"),
                };
                let fault = Fault::new(format!("{} holds no {what} atoms", result.path().display()));
                let help = format!("run the experiment with output.{key} = true, or colour by something else");
                Err(Error::input(fault.help(help)))
            }
            None => {
                let names = Self::names(result);
                let fault = Fault::new(format!("nothing in {} is called `{name}`", result.path().display()));
                let near = names.iter().map(|other| (strsim::damerau_levenshtein(name, other), other)).min();
                let meant = near.filter(|(apart, _)| *apart <= 2).map(|(_, other)| format!("did you mean `{other}`? "));
                Err(Error::input(fault.help(format!("{}there are: {}", meant.unwrap_or_default(), names.join(", ")))))
            }
        }
    }

    /// All names that [`Shown::named`] knows for this result.
    pub fn names(result: &ResultFile) -> Vec<String> {
        let is_there =
            |name: &&str| AtomQuantity::named(name).is_some_and(|known| known.is_in(result).unwrap_or(false));
        let mut names: Vec<String> = ["type".to_owned()].into();
        names.extend(AtomQuantity::names().filter(is_there).map(str::to_owned));
        names.extend(result.layout().membranes.iter().map(|membrane| membrane.name.clone()));
        names.extend(result.series_names());
        names
    }

    /// What has a number each.
    pub fn of(&self) -> Of {
        match self {
            Self::Type => Of::Types,
            Self::Atoms(_) | Self::Membrane(_) => Of::Atoms,
            Self::Cells(_) => Of::Cells,
        }
    }

    /// The numbers of a frame, whose atoms are at these positions (µm); NaN where there is none.
    ///
    /// # Errors
    /// A damaged file.
    pub fn values(&self, result: &ResultFile, frame: usize, positions: &[[f64; 3]]) -> Result<Vec<f64>> {
        Ok(match self {
            Self::Type => Vec::new(),
            Self::Atoms(quantity) => quantity.of_frame(result, frame, positions)?,
            Self::Membrane(name) => result.membrane(name, frame)?.unwrap_or_else(|| vec![f64::NAN; positions.len()]),
            Self::Cells(name) => result.cell_values(name, frame)?,
        })
    }

    /// Its name with its unit, as beside a colour bar; empty for types.
    pub fn label(&self, result: &ResultFile) -> String {
        match self {
            Self::Type => String::new(),
            Self::Atoms(quantity) => quantity.label().to_owned(),
            Self::Membrane(name) => {
                let known = result.layout().membranes.iter().find(|membrane| membrane.name == *name);
                known.map_or_else(|| name.clone(), |membrane| with_unit(name, &membrane.unit))
            }
            Self::Cells(name) => plots::label_of(result, name),
        }
    }
}
