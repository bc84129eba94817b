//! Which contacts are those of a cell.

use super::super::kind::Kind;
use super::super::state::KindState;
use crate::contact::AtomContact;

/// The number of the first atom of a cell among all, and the contacts of its atoms.
pub fn near_cell<'a>(kind: &Kind, now: &KindState, found: &'a [AtomContact], cell: usize) -> (u32, &'a [AtomContact]) {
    let begin = |cell: usize| (now.first_atom + cell * kind.atoms()) as u32;
    let of_cell = [begin(cell), begin(cell + 1)].map(|atom| found.partition_point(|contact| contact.atom < atom));
    (begin(cell), &found[of_cell[0]..of_cell[1]])
}
