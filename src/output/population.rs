//! The cells of a frame as VTK sees them: which cell every atom, link and facet belongs to, and what they join. All
//! frames between two changes of the population share one block of these numbers in the file.

use super::{Cell, Layout};

/// What a cell is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Atoms.
    Atoms,
    /// Internal links.
    Links,
    /// Facets.
    Facets,
}

/// The cells of one or several frames, and where the parts of each begin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Population {
    ids: Vec<u64>,
    kinds: Vec<u32>,
    /// For each [`Part`], where those of each cell begin, and their number.
    firsts: [Vec<usize>; 3],
}

impl Population {
    /// The population of these cells.
    ///
    /// # Panics
    /// If a cell is of no type of the layout.
    pub(super) fn of(layout: &Layout, cells: &[Cell]) -> Self {
        let parts = |cell: &Cell| {
            let kind = &layout.types[cell.kind as usize];
            [kind.atoms as usize, kind.links.len(), kind.facets.len()]
        };
        let firsts = [Part::Atoms, Part::Links, Part::Facets].map(|part| {
            let mut end = 0;
            let ends = cells.iter().map(|cell| {
                end += parts(cell)[part as usize];
                end
            });
            [0].into_iter().chain(ends).collect()
        });
        Self {
            ids: cells.iter().map(|cell| cell.id).collect(),
            kinds: cells.iter().map(|cell| cell.kind).collect(),
            firsts,
        }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.ids.len()
    }

    /// Number of parts of all cells.
    pub fn count(&self, part: Part) -> usize {
        self.firsts[part as usize].last().copied().unwrap_or(0)
    }

    /// Whether these are the same cells in the same order.
    pub(super) fn is(&self, cells: &[Cell]) -> bool {
        self.ids.iter().zip(&self.kinds).eq(cells.iter().map(|cell| (&cell.id, &cell.kind)))
    }

    /// Finds the cells that parts with ascending numbers belong to, the first of them that of this number.
    fn owners(&self, part: Part, first: usize) -> Owners<'_> {
        let firsts = &self.firsts[part as usize];
        Owners { firsts, cell: firsts.partition_point(|start| *start <= first).saturating_sub(1) }
    }
}

/// See [`Population::owners`].
struct Owners<'a> {
    firsts: &'a [usize],
    cell: usize,
}

impl Owners<'_> {
    /// The cell of a part, by its index, and the number of the part in the cell.
    fn of(&mut self, part: usize) -> (usize, usize) {
        while self.firsts[self.cell + 1] <= part {
            self.cell += 1;
        }
        (self.cell, part - self.firsts[self.cell])
    }
}

/// A dataset with a block of numbers for each population.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shared {
    /// Id of the cell of an atom.
    PointCell,
    /// Type of the cell of an atom.
    PointType,
    /// Id of the cell of a link or facet.
    DrawnCell,
    /// Type of the cell of a link or facet.
    DrawnType,
    /// Where a link begins among the atoms of links.
    LinkOffsets,
    /// The atoms of links.
    LinkAtoms,
    /// Where a facet begins among the atoms of facets.
    FacetOffsets,
    /// The atoms of facets.
    FacetAtoms,
}

/// A number for each [`Shared`]: where a block begins, say.
pub(super) type OfShared = [usize; Shared::ALL.len()];

impl Shared {
    /// All of them, each at its number.
    pub const ALL: [Self; 8] = [
        Self::PointCell,
        Self::PointType,
        Self::DrawnCell,
        Self::DrawnType,
        Self::LinkOffsets,
        Self::LinkAtoms,
        Self::FacetOffsets,
        Self::FacetAtoms,
    ];

    /// Numbers in the block of a population.
    pub fn length(self, of: &Population) -> usize {
        match self {
            Self::PointCell | Self::PointType => of.count(Part::Atoms),
            Self::DrawnCell | Self::DrawnType => of.count(Part::Links) + of.count(Part::Facets),
            Self::LinkOffsets => of.count(Part::Links) + 1,
            Self::LinkAtoms => 2 * of.count(Part::Links),
            Self::FacetOffsets => of.count(Part::Facets) + 1,
            Self::FacetAtoms => 3 * of.count(Part::Facets),
        }
    }

    /// Fills in numbers of the block of a population, from the one with this index on.
    pub(super) fn fill(self, layout: &Layout, of: &Population, first: usize, numbers: &mut [i64]) {
        let id = |cell: usize| of.ids[cell].cast_signed();
        let kind = |cell: usize| i64::from(of.kinds[cell]);
        match self {
            Self::PointCell => of_owners(of, Part::Atoms, first, numbers, &id),
            Self::PointType => of_owners(of, Part::Atoms, first, numbers, &kind),
            Self::DrawnCell => of_drawn(of, first, numbers, &id),
            Self::DrawnType => of_drawn(of, first, numbers, &kind),
            Self::LinkOffsets => (first..).zip(numbers).for_each(|(index, number)| *number = 2 * index as i64),
            Self::FacetOffsets => (first..).zip(numbers).for_each(|(index, number)| *number = 3 * index as i64),
            Self::LinkAtoms => {
                corners(of, Part::Links, first, numbers, |kind, link| layout.types[kind].links[link]);
            }
            Self::FacetAtoms => {
                corners(of, Part::Facets, first, numbers, |kind, facet| layout.types[kind].facets[facet]);
            }
        }
    }
}

/// What is said of the cell of each part.
fn of_owners(of: &Population, part: Part, first: usize, numbers: &mut [i64], say: &dyn Fn(usize) -> i64) {
    let mut owners = of.owners(part, first);
    (first..).zip(numbers).for_each(|(index, number)| *number = say(owners.of(index).0));
}

/// The same for links, then facets.
fn of_drawn(of: &Population, first: usize, numbers: &mut [i64], say: &dyn Fn(usize) -> i64) {
    let links = of.count(Part::Links);
    let (of_links, of_facets) = numbers.split_at_mut(links.saturating_sub(first).min(numbers.len()));
    of_owners(of, Part::Links, first, of_links, say);
    of_owners(of, Part::Facets, first.max(links) - links, of_facets, say);
}

/// The atoms that parts join, by their numbers in the frame.
fn corners<const N: usize>(
    of: &Population,
    part: Part,
    first: usize,
    numbers: &mut [i64],
    joined: impl Fn(usize, usize) -> [u32; N],
) {
    let (mut owners, atoms) = (of.owners(part, first / N), &of.firsts[Part::Atoms as usize]);
    for (index, number) in (first..).zip(numbers) {
        let (cell, own) = owners.of(index / N);
        *number = atoms[cell] as i64 + i64::from(joined(of.kinds[cell] as usize, own)[index % N]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::CellType;

    /// A cell with a link, one of another type without, and one of a type without anything.
    fn example() -> (Layout, Population) {
        let kind = |atoms, facets: &[[u32; 3]], links: &[[u32; 2]]| CellType {
            name: String::new(),
            atoms,
            facets: facets.to_vec(),
            links: links.to_vec(),
        };
        let types = vec![kind(3, &[[0, 1, 2]], &[[0, 2]]), kind(4, &[[0, 1, 2], [1, 2, 3]], &[]), kind(0, &[], &[])];
        let layout = Layout { types, ..Layout::default() };
        let cell = |id, kind| Cell { id, kind, parent: None };
        let cells = [cell(7, 1), cell(8, 2), cell(2, 0), cell(9, 0)];
        let population = Population::of(&layout, &cells);
        assert!(population.is(&cells) && !population.is(&cells[..3]));
        (layout, population)
    }

    #[test]
    fn blocks_say_whose_parts_are_and_what_they_join() {
        let (layout, population) = example();
        let block = |shared: Shared| {
            let mut numbers = vec![-1; shared.length(&population)];
            shared.fill(&layout, &population, 0, &mut numbers);
            numbers
        };
        assert_eq!(block(Shared::PointCell), [7, 7, 7, 7, 2, 2, 2, 9, 9, 9]);
        assert_eq!(block(Shared::PointType), [1, 1, 1, 1, 0, 0, 0, 0, 0, 0]);
        assert_eq!(block(Shared::DrawnCell), [2, 9, 7, 7, 2, 9]);
        assert_eq!(block(Shared::LinkOffsets), [0, 2, 4]);
        assert_eq!(block(Shared::LinkAtoms), [4, 6, 7, 9]);
        assert_eq!(block(Shared::FacetOffsets), [0, 3, 6, 9, 12]);
        assert_eq!(block(Shared::FacetAtoms), [0, 1, 2, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
    }

    #[test]
    fn a_block_is_the_same_in_pieces_of_any_size() {
        let (layout, population) = example();
        for shared in Shared::ALL {
            let mut whole = vec![-1; shared.length(&population)];
            shared.fill(&layout, &population, 0, &mut whole);
            for size in 1..5 {
                let mut pieces = vec![-1; whole.len()];
                let filled = pieces.chunks_mut(size).enumerate();
                filled.for_each(|(index, piece)| shared.fill(&layout, &population, index * size, piece));
                assert_eq!(pieces, whole, "{shared:?} in pieces of {size}");
            }
        }
    }
}
