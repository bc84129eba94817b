//! Atoms that are named but not defined.

use super::super::Warnings;
use super::super::cursor::{Cursor, faults_of};
use super::super::page::Page;
use super::seen::Seen;
use super::{Component, PhysicalModel, References};
use crate::error::{Error, Result};

/// So many of them are told.
const MOST_FAULTS: usize = 5;

/// Makes sure that all atoms that are named are there.
pub(super) fn check_references(page: &Page, model: &PhysicalModel, seen: &Seen) -> Result<()> {
    let known = |references: &References| references.atoms.iter().all(|atom| seen.atoms.contains_key(atom));
    let good = model.all_components().iter().all(|component| match component {
        Component::Structural(own) => known(&own.references) && own.cells.iter().all(|cell| known(&cell.references)),
        _ => true,
    });
    if good { Ok(()) } else { locate(page, seen) }
}

/// Goes through the text once more: where atoms are named is not kept, since it is needed so rarely.
fn locate(page: &Page, seen: &Seen) -> Result<()> {
    let (mut cursor, _) = Cursor::at_root(page, Warnings::default())?;
    let mut faults = Vec::new();
    let outcome = visit(&mut cursor, &mut |cursor| {
        if let Some(value) = cursor.take("index")
            && let Ok(atom) = value.text.trim().parse::<u32>()
            && !seen.atoms.contains_key(&atom)
            && faults.len() < MOST_FAULTS
        {
            let message = format!("there is no atom {atom}");
            let help = format!("the model defines {} atoms, each by an <atom> in <atoms>", seen.atoms.len());
            faults.push(page.told(value.at, message, "not defined", help));
        }
    });
    if let Err(error) = outcome {
        faults.extend(faults_of(error));
    }
    Err(Error::Input(faults))
}

/// Calls for every reference to an atom.
fn visit(cursor: &mut Cursor, found: &mut impl FnMut(&mut Cursor)) -> Result<()> {
    cursor.each(|cursor, tag| {
        if tag.name == "atomRef" {
            found(cursor);
        }
        visit(cursor, found)
    })
}
