//! Cuts cells into tetrahedra so that neighbours cut the faces that they share alike.

use super::SolidCell;
use std::collections::HashMap;

/// The tetrahedra of all cells, cell by cell, as the cells turn them.
pub fn all(cells: &[SolidCell]) -> Vec<Vec<[u32; 4]>> {
    let sides = two_colours(cells);
    let cut = |cell: &SolidCell| match (cell, &sides) {
        (SolidCell::Tetrahedron(atoms), _) => vec![*atoms],
        (SolidCell::Hexahedron(atoms), Some(sides)) => five(*atoms, sides[&atoms[0]]).to_vec(),
        _ => from_lowest(cell),
    };
    cells.iter().map(cut).collect()
}

/// One of two colours for each atom of a body of hexahedra, so that both ends of each edge differ; none where there is no such colouring, or
/// where there are other cells, whose faces are cut by numbers alone.
fn two_colours(cells: &[SolidCell]) -> Option<HashMap<u32, bool>> {
    const EDGES: [[usize; 2]; 12] =
        [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
    let mut near: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut atoms = Vec::new();
    for cell in cells {
        let SolidCell::Hexahedron(corners) = cell else { return None };
        for [one, other] in EDGES.map(|edge| edge.map(|corner| corners[corner])) {
            near.entry(one).or_default().push(other);
            near.entry(other).or_default().push(one);
        }
        atoms.extend(corners);
    }
    let mut colours: HashMap<u32, bool> = HashMap::new();
    for first in atoms {
        if colours.contains_key(&first) {
            continue;
        }
        colours.insert(first, false);
        let mut next = vec![first];
        while let Some(atom) = next.pop() {
            let own = colours[&atom];
            for &other in &near[&atom] {
                match colours.insert(other, !own) {
                    None => next.push(other),
                    Some(before) if before == own => return None,
                    Some(_) => {}
                }
            }
        }
    }
    Some(colours)
}

/// The edges of a cell.
pub fn edges(cell: &SolidCell) -> Vec<[u32; 2]> {
    let faces = faces(cell);
    faces.iter().flat_map(|face| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]])).collect()
}

/// Five tetrahedra of a hexahedron: one of every other corner, and what is left at the four corners between. `odd` says that the corners of
/// the large one are those beside the first.
fn five([a, b, c, d, e, f, g, h]: [u32; 8], odd: bool) -> [[u32; 4]; 5] {
    if odd {
        [[b, d, e, g], [a, b, d, e], [c, d, b, g], [f, e, g, b], [h, g, e, d]]
    } else {
        [[a, c, h, f], [b, c, a, f], [d, a, c, h], [e, h, f, a], [g, f, h, c]]
    }
}

/// The faces of a cell, triangles or quadrilaterals, all seen from outside where the cell is not inside out.
fn faces(cell: &SolidCell) -> Vec<Vec<u32>> {
    let of = |atoms: &[u32], faces: &[&[usize]]| -> Vec<Vec<u32>> {
        faces.iter().map(|face| face.iter().map(|&corner| atoms[corner]).collect()).collect()
    };
    match cell {
        SolidCell::Tetrahedron(atoms) => of(atoms, &[&[0, 2, 1], &[0, 1, 3], &[0, 3, 2], &[1, 2, 3]]),
        SolidCell::Pyramid(atoms) => of(atoms, &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]]),
        SolidCell::Wedge(atoms) => of(atoms, &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]]),
        SolidCell::Hexahedron(atoms) => {
            of(atoms, &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]])
        }
    }
}

/// The tetrahedra between the atom of the lowest number and all faces that it is not on, each cut from its own atom of the lowest number: on
/// the faces that it is on, it is that one.
fn from_lowest(cell: &SolidCell) -> Vec<[u32; 4]> {
    let faces = faces(cell);
    let lowest = *faces.iter().flatten().min().expect("a cell has atoms");
    let opposite = faces.iter().filter(|face| !face.contains(&lowest));
    opposite
        .flat_map(|face| {
            let first = (0..face.len()).min_by_key(|corner| face[*corner]).unwrap_or_default();
            let corner = move |step: usize| face[(first + step) % face.len()];
            // Seen from outside a face runs counter-clockwise, so that the lowest, behind it, comes last when two are swapped.
            (2..face.len()).map(move |last| [corner(0), corner(last), corner(last - 1), lowest])
        })
        .collect()
}
