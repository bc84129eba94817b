//! Atoms that are held, and those that are moved on courses.

use super::super::{CellType, Document};
use super::select;
use crate::error::Fault;
use crate::geometry::Surface;
use crate::mechanics::moved::Moved;

/// What a file of loads holds, atoms and axes, and what it moves, with the axes along which nothing else does.
type FromFile<'a> = (&'a [(u32, usize)], Vec<(Moved, Vec<usize>)>);

/// Factors of the atoms of a type, 0 held or moved, 1 free, empty when all are free; and what is moved.
pub fn held(
    document: &Document,
    key: &str,
    cell: &CellType,
    rest: &Surface,
    (held_by_file, moved_by_file): FromFile,
    faults: &mut Vec<Fault>,
) -> (Vec<f64>, Vec<Moved>) {
    let mut held = Held { factors: vec![1.0; 3 * rest.positions.len()], moved: Vec::new() };
    held_by_file.iter().for_each(|&(atom, axis)| held.factors[3 * atom as usize + axis] = 0.0);
    for (i, fixed) in cell.applied.fixed.iter().enumerate() {
        let atoms = select::atoms(document, &format!("{key}.fixed[{i}]"), &fixed.selection, rest, faults);
        for atom in atoms {
            fixed.axes.iter().for_each(|axis| held.factors[3 * atom as usize + *axis as usize] = 0.0);
        }
    }
    for (i, moved) in cell.applied.moved.iter().enumerate() {
        let path = format!("{key}.moved[{i}]");
        let atoms = select::atoms(document, &path, &moved.selection, rest, faults);
        let axes: Vec<usize> = moved.axes.iter().map(|axis| *axis as usize).collect();
        held.take(document, key, &path, (moved.of_atoms(atoms), &axes), faults);
    }
    for (moved, axes) in moved_by_file {
        held.take(document, key, &format!("{key}.loads_file"), (moved, &axes), faults);
    }
    let is_free = held.factors.iter().all(|factor| *factor == 1.0);
    (if is_free { Vec::new() } else { held.factors }, held.moved)
}

struct Held {
    factors: Vec<f64>,
    moved: Vec<Moved>,
}

impl Held {
    /// Takes up what is moved, unless it is held by others already.
    fn take(
        &mut self,
        document: &Document,
        key: &str,
        path: &str,
        (moved, axes): (Moved, &[usize]),
        faults: &mut Vec<Fault>,
    ) {
        let numbers = |atom: u32| axes.iter().map(move |axis| 3 * atom as usize + axis);
        if let Some(atom) = moved.atoms.iter().find(|atom| numbers(**atom).any(|number| self.factors[number] == 0.0)) {
            let fault = Fault::new(format!("`{path}` moves atom {atom}, which `{key}` holds or moves already"))
                .help("let what is fixed and what is moved be different atoms, or other axes of them");
            faults.push(document.location(path, "has atoms of others").into_iter().fold(fault, Fault::at));
        }
        moved.atoms.iter().for_each(|atom| numbers(*atom).for_each(|number| self.factors[number] = 0.0));
        self.moved.push(moved);
    }
}
