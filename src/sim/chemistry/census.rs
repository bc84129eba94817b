//! Who has a system, and which cells an end of a link names: found from the cells that there are.

use std::ops::Range;

use super::super::state::{KindState, State};
use super::links::Whose;
use super::model::Members;

/// The cells that have a copy of a system, in the order of its copies; none for the scene.
pub fn member_cells(cells: &[KindState], members: &Members) -> impl Iterator<Item = usize> {
    let kinds = match members {
        Members::Scene => &[],
        Members::Kinds(kinds) => &kinds[..],
    };
    kinds.iter().flat_map(|&kind| cells[kind].numbers())
}

/// The cell that has a copy of a system; none for the scene.
pub(super) fn cell_of_member(cells: &[KindState], members: &Members, mut member: usize) -> Option<usize> {
    let Members::Kinds(kinds) = members else { return None };
    for now in kinds.iter().map(|&kind| &cells[kind]) {
        if member < now.cells() {
            return Some(now.first_cell + member);
        }
        member -= now.cells();
    }
    None
}

/// Which copy of a system a cell has.
pub(super) fn member_of_cell(cells: &[KindState], members: &Members, cell: usize) -> Option<usize> {
    let Members::Kinds(kinds) = members else { return None };
    let mut before = 0;
    for now in kinds.iter().map(|&kind| &cells[kind]) {
        if now.numbers().contains(&cell) {
            return Some(before + cell - now.first_cell);
        }
        before += now.cells();
    }
    None
}

/// Whether an end names cells of which there are none.
pub(super) fn names_nobody(state: &State, whose: Whose) -> bool {
    whose != Whose::Own && cells_of(state, whose, None).is_empty()
}

/// The cells that an end names: one, a range of them, or none where they are no more.
pub(super) fn cells_of(state: &State, whose: Whose, own: Option<usize>) -> Range<usize> {
    let one = |cell: Option<usize>| cell.map_or(0..0, |cell| cell..cell + 1);
    match whose {
        Whose::Own => one(own),
        Whose::Cell(id) => one(state.find(id).map(|(kind, cell)| state.kinds[kind].first_cell + cell)),
        Whose::Kind(kind) => state.kinds[kind].numbers(),
    }
}
