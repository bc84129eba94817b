//! Who has a system, and which cells an end of a link names: found from the cells that there are.

use std::ops::Range;

use super::super::model::{Kind, Model};
use super::links::Whose;
use super::model::Members;

/// The numbers of the cells of a kind, in the order of all cells.
fn cells_of_kind(kind: &Kind) -> Range<usize> {
    kind.first_cell..kind.first_cell + kind.cells
}

/// The cells that have a copy of a system, in the order of its copies; none for the scene.
pub fn member_cells(model: &Model, members: &Members) -> impl Iterator<Item = usize> {
    let kinds = match members {
        Members::Scene => &[],
        Members::Kinds(kinds) => &kinds[..],
    };
    kinds.iter().flat_map(|&kind| cells_of_kind(&model.kinds[kind]))
}

/// The cell that has a copy of a system; none for the scene.
pub(super) fn cell_of_member(model: &Model, members: &Members, mut member: usize) -> Option<usize> {
    let Members::Kinds(kinds) = members else { return None };
    for kind in kinds.iter().map(|&kind| &model.kinds[kind]) {
        if member < kind.cells {
            return Some(kind.first_cell + member);
        }
        member -= kind.cells;
    }
    None
}

/// Which copy of a system a cell has.
pub(super) fn member_of_cell(model: &Model, members: &Members, cell: usize) -> Option<usize> {
    let Members::Kinds(kinds) = members else { return None };
    let mut before = 0;
    for kind in kinds.iter().map(|&kind| &model.kinds[kind]) {
        if cells_of_kind(kind).contains(&cell) {
            return Some(before + cell - kind.first_cell);
        }
        before += kind.cells;
    }
    None
}

/// The cells that an end names: one or a range of them.
pub(super) fn cells_of(model: &Model, whose: Whose, own: Option<usize>) -> Range<usize> {
    match whose {
        Whose::Own => own.map_or(0..0, |cell| cell..cell + 1),
        Whose::Cell(cell) => cell..cell + 1,
        Whose::Kind(kind) => cells_of_kind(&model.kinds[kind]),
    }
}
