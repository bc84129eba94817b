//! Lines from centre to centre of cells: of those that dynamic links join, and of those that touch.

use std::collections::HashMap;

use crate::Vec3;
use crate::error::Result;
use crate::output::{Cell, Layout, ResultFile};

/// A line between two centres, µm, and how strong what it stands for is.
pub type Joint = ([[f64; 3]; 2], f64);

/// The cells that dynamic links join in a frame, with the number of links of each two; of the cells that are shown.
///
/// # Errors
/// A damaged file.
pub fn linked(result: &ResultFile, frame: usize, cells: &[Cell], positions: &[[f64; 3]]) -> Result<Vec<Joint>> {
    let pairs = result.linked(frame)?.into_iter().map(|pair| ([pair.cell, pair.other], f64::from(pair.number)));
    Ok(between_centres(pairs, result.layout(), cells, positions))
}

/// The cells that touch in a frame, with their areas, µm²; of the cells that are shown.
///
/// # Errors
/// A damaged file, or a result without contacts.
// Pictures draw none: only the page does.
#[cfg(feature = "view")]
pub fn touching(result: &ResultFile, frame: usize, cells: &[Cell], positions: &[[f64; 3]]) -> Result<Vec<Joint>> {
    let pairs = result.pairs(frame)?.into_iter().map(|pair| ([pair.cell, pair.other], pair.area));
    Ok(between_centres(pairs, result.layout(), cells, positions))
}

fn between_centres(
    pairs: impl Iterator<Item = ([u64; 2], f64)>,
    layout: &Layout,
    cells: &[Cell],
    positions: &[[f64; 3]],
) -> Vec<Joint> {
    let centre = |atoms: std::ops::Range<usize>| {
        let (sum, count) = (positions[atoms.clone()].iter().map(|at| Vec3::from(*at)).sum::<Vec3>(), atoms.len());
        <[f64; 3]>::from(sum / count.max(1) as f64)
    };
    let centres = cells.iter().zip(layout.atoms_of(cells)).map(|(cell, atoms)| (cell.id, centre(atoms)));
    let centres: HashMap<u64, [f64; 3]> = centres.collect();
    let ends =
        |([one, other], strength): ([u64; 2], f64)| Some(([*centres.get(&one)?, *centres.get(&other)?], strength));
    pairs.filter_map(ends).collect()
}
