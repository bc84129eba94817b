//! The bodies in a model that are filled: its cells of three dimensions.

use super::surface::{Sought, Wanted};
use super::{Atom, Cell, CellType, PhysicalModel, StructuralComponent};
use crate::Vec3;
use crate::error::Fault;
use crate::geometry::SolidCell;
use std::collections::HashMap;

/// Cells that fill a body, and the indices that its atoms have in the model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelSolid {
    /// The positions of the atoms of the cells, in the unit of the model and in the order of the document.
    pub positions: Vec<Vec3>,
    /// The cells, by numbers in `positions`.
    pub cells: Vec<SolidCell>,
    /// The index of each atom.
    pub indices: Vec<u32>,
}

const FILLING: Sought = Sought {
    words: "cells that fill a body",
    is_in: |component| component.cells.iter().any(|cell| filling(cell).is_some()),
    listed: |all| {
        let count = |component: &StructuralComponent| component.cells.iter().filter_map(filling).count();
        let named = all.iter().filter(|component| count(component) > 0).map(|component| {
            let name = component.name.as_deref().map_or("(no name)".to_owned(), |name| format!("`{}`", name.trim()));
            match count(component) {
                1 => format!("{name} (1 cell)"),
                count => format!("{name} ({count} cells)"),
            }
        });
        named.collect::<Vec<_>>().join(", ")
    },
    made_of: "a filled body is made of cells of type TETRAHEDRON, PYRAMID, WEDGE or HEXAHEDRON",
};

impl PhysicalModel {
    /// The cells of some components of the model of a file that fill a body, or of all of them.
    ///
    /// # Errors
    /// No component has the name or has such cells; then the message lists those that have.
    pub fn solid(&self, file: &str, wanted: Wanted) -> Result<ModelSolid, Fault> {
        let chosen = match wanted {
            Wanted::TheOnly => self.structural_components(),
            Wanted::Named(names) => self.named(file, names, &FILLING)?,
        };
        let found: Vec<SolidCell> =
            chosen.iter().flat_map(|component| component.cells.iter().filter_map(filling)).collect();
        if found.is_empty() {
            return Err(self.none_of(&FILLING, format!("PML file `{file}` has no {}", FILLING.words)));
        }
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        numbers.extend(found.iter().flat_map(SolidCell::atoms).map(|atom| (*atom, 0)));
        let atoms: Vec<&Atom> = self.all_atoms().filter(|atom| numbers.contains_key(&atom.index)).collect();
        numbers.extend(atoms.iter().zip(0..).map(|(atom, number)| (atom.index, number)));
        Ok(ModelSolid {
            positions: atoms.iter().map(|atom| Vec3::from(atom.position)).collect(),
            cells: found.iter().map(|cell| cell.renumbered(|atom| numbers[&atom])).collect(),
            indices: atoms.iter().map(|atom| atom.index).collect(),
        })
    }
}

/// A cell of three dimensions as geometry has it; those with another number of atoms than their type has are none.
fn filling(cell: &Cell) -> Option<SolidCell> {
    let atoms: &[u32] = &cell.references.atoms;
    match cell.kind {
        CellType::Tetrahedron => atoms.try_into().ok().map(SolidCell::Tetrahedron),
        CellType::Pyramid => atoms.try_into().ok().map(SolidCell::Pyramid),
        CellType::Wedge => atoms.try_into().ok().map(SolidCell::Wedge),
        CellType::Hexahedron => atoms.try_into().ok().map(SolidCell::Hexahedron),
        _ => None,
    }
}
