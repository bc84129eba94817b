//! Bodies that are filled: tetrahedra, and the surface around them. They are made of cells (tetrahedra, pyramids, wedges, hexahedra) that are
//! cut so that neighbours agree.

mod block;
mod check;
mod cut;
mod rod;
#[cfg(test)]
mod tests;

pub use block::{Grading, block, graded_block};
pub use check::{LEAST_TETRAHEDRON_QUALITY, SolidFault};
pub use rod::rod;

use super::Surface;
use crate::Vec3;
use std::collections::HashMap;

/// A filled body. Its atoms on the surface come first, those inside after them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Solid {
    /// The positions of all atoms, µm, and the facets of the surface, turned outwards.
    pub surface: Surface,
    /// The four atoms of each tetrahedron a, b, c, d, with (b − a) × (c − a) · (d − a) > 0; those that were cut from one cell in a row.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Where the tetrahedra of each cell begin, and at the end how many there are.
    pub cells: Vec<u32>,
    /// The edges of the cells as they were before they were cut, smaller atom first, sorted.
    pub edges: Vec<[u32; 2]>,
}

/// A cell of a body, by the numbers of its atoms in the order of VTK: the base first, then what is above it.
#[derive(Debug, Clone, PartialEq)]
pub enum SolidCell {
    /// A tetrahedron.
    Tetrahedron([u32; 4]),
    /// Four atoms around the base, and the apex.
    Pyramid([u32; 5]),
    /// Three atoms around the base, and those above each.
    Wedge([u32; 6]),
    /// Four atoms around the base, and those above each.
    Hexahedron([u32; 8]),
}

impl SolidCell {
    /// Its atoms.
    pub fn atoms(&self) -> &[u32] {
        match self {
            Self::Tetrahedron(atoms) => atoms,
            Self::Pyramid(atoms) => atoms,
            Self::Wedge(atoms) => atoms,
            Self::Hexahedron(atoms) => atoms,
        }
    }

    /// The same cell of atoms with other numbers.
    pub fn renumbered(&self, number: impl Fn(u32) -> u32) -> Self {
        match self {
            Self::Tetrahedron(atoms) => Self::Tetrahedron(atoms.map(number)),
            Self::Pyramid(atoms) => Self::Pyramid(atoms.map(number)),
            Self::Wedge(atoms) => Self::Wedge(atoms.map(number)),
            Self::Hexahedron(atoms) => Self::Hexahedron(atoms.map(number)),
        }
    }
}

impl Solid {
    /// The body that is made of these cells, with the new number of each atom of `positions` (µm), or none for atoms that no cell has.
    ///
    /// Hexahedra are cut into five tetrahedra, each a mirror of its neighbours, where their edges let them; else, as all other cells, from their
    /// atom of the lowest number (after Dompierre et al. 1999).
    ///
    /// # Errors
    /// All faults found: atoms that do not exist or are named twice, cells that are flat or turned inside out, faces that more than two
    /// cells have, pieces that do not hang together.
    pub fn of_cells(positions: &[Vec3], cells: &[SolidCell]) -> Result<(Self, Vec<Option<u32>>), Vec<SolidFault>> {
        check::names(positions, cells)?;
        let (tetrahedra, starts) = check::turned(positions, cut::all(cells))?;
        let outside = check::outside(&tetrahedra)?;
        check::pieces(positions.len(), &tetrahedra)?;
        let numbers = renumbered(positions.len(), &outside, &tetrahedra);
        let number = |atom: u32| numbers[atom as usize].expect("atoms of cells have a number");
        let mut order: Vec<(u32, usize)> =
            numbers.iter().zip(0..).filter_map(|(number, atom)| number.map(|number| (number, atom))).collect();
        order.sort_unstable();
        let surface = Surface {
            positions: order.iter().map(|&(_, atom)| positions[atom]).collect(),
            facets: outside.iter().map(|facet| facet.map(number)).collect(),
        };
        let tetrahedra = tetrahedra.iter().map(|atoms| atoms.map(number)).collect();
        let mut edges: Vec<[u32; 2]> =
            cells.iter().flat_map(cut::edges).map(|edge| edge.map(number)).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        Ok((Self { surface, tetrahedra, cells: starts, edges }, numbers))
    }

    /// How many atoms are on the surface: they are the first.
    pub fn outer_atoms(&self) -> usize {
        self.surface.facets.iter().flatten().max().map_or(0, |last| *last as usize + 1)
    }

    /// Volumes of the tetrahedra, µm³.
    pub fn volumes(&self) -> impl Iterator<Item = f64> + '_ {
        self.tetrahedra.iter().map(|&atoms| tetrahedron_volume(atoms.map(|atom| self.surface.positions[atom as usize])))
    }
}

/// All pairs of atoms that a cell has, smaller first, sorted: Moore's neighbourhood where cells are hexahedra. Cell `k` has the tetrahedra from
/// `cells[k]` to before `cells[k + 1]`.
pub fn pairs_within(tetrahedra: &[[u32; 4]], cells: &[u32]) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for range in cells.windows(2) {
        let mut atoms = tetrahedra[range[0] as usize..range[1] as usize].concat();
        atoms.sort_unstable();
        atoms.dedup();
        for (k, &a) in atoms.iter().enumerate() {
            pairs.extend(atoms[k + 1..].iter().map(|&b| [a, b]));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The volume of a tetrahedron, µm³; negative where it is turned inside out.
pub fn tetrahedron_volume([a, b, c, d]: [Vec3; 4]) -> f64 {
    (b - a).cross(&(c - a)).dot(&(d - a)) / 6.0
}

/// The faces of a tetrahedron, seen from outside.
pub fn faces([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[a, c, b], [a, b, d], [a, d, c], [b, c, d]]
}

/// A new number for each atom of the tetrahedra, those on the surface first, else in the order that they have.
fn renumbered(atoms: usize, outside: &[[u32; 3]], tetrahedra: &[[u32; 4]]) -> Vec<Option<u32>> {
    let (mut is_outer, mut is_used) = (vec![false; atoms], vec![false; atoms]);
    outside.iter().flatten().for_each(|&atom| is_outer[atom as usize] = true);
    tetrahedra.iter().flatten().for_each(|&atom| is_used[atom as usize] = true);
    let outer = (0..atoms).filter(|&atom| is_outer[atom]);
    let inner = (0..atoms).filter(|&atom| is_used[atom] && !is_outer[atom]);
    let mut numbers = vec![None; atoms];
    outer.chain(inner).zip(0..).for_each(|(atom, number)| numbers[atom] = Some(number));
    numbers
}

/// A face of tetrahedra.
struct Face {
    /// How many have it.
    count: u32,
    /// As the first of them sees it from outside.
    seen: [u32; 3],
}

/// The faces of tetrahedra by their atoms in rising order.
fn count_faces(tetrahedra: &[[u32; 4]]) -> HashMap<[u32; 3], Face> {
    let mut known: HashMap<[u32; 3], Face> = HashMap::new();
    for seen in tetrahedra.iter().flat_map(|&atoms| faces(atoms)) {
        let mut sorted = seen;
        sorted.sort_unstable();
        known.entry(sorted).or_insert(Face { count: 0, seen }).count += 1;
    }
    known
}
