//! Reads what components are made of: atoms, cells and colours.

use super::super::Foreign;
use super::super::cursor::{Cursor, Tag, shown};
use super::seen::Seen;
use super::{Atom, Beyond, Cell, CellType, Colour, References};
use crate::error::{Error, Result, words};

/// An atom, which must be the first of its index.
pub(super) fn atom(cursor: &mut Cursor, tag: Tag, seen: &mut Seen) -> Result<Atom> {
    let around = cursor.rest();
    let mut foreign = Vec::new();
    let mut found = None;
    cursor.each(|cursor, child| match child.name {
        "atomProperties" if found.is_none() => {
            let (index, at) = cursor.index(&child, "index")?;
            if let Some(first) = seen.atoms.insert(index, at.start as u32) {
                let line = 1 + cursor.page.text()[..first as usize].matches('\n').count();
                let message = format!("atom {index} is defined twice, first at line {line}");
                return Err(cursor.page.fault(at, message, "again", "give each atom an index of its own"));
            }
            let position = [cursor.number(&child, "x")?, cursor.number(&child, "y")?, cursor.number(&child, "z")?];
            let name = cursor.take_text("name");
            found = Some((index, position, name, cursor.rest()));
            cursor.skip(&child)
        }
        _ => {
            foreign.push(cursor.unknown(child, "atom")?);
            Ok(())
        }
    })?;
    let Some((index, position, name, properties)) = found else {
        return Err(no_properties(cursor, &tag, "atomProperties index=\"0\" x=\"0\" y=\"0\" z=\"0\""));
    };
    Ok(Atom { index, position, name, properties, beyond: Beyond::new(around, foreign) })
}

/// A cell.
pub(super) fn cell(cursor: &mut Cursor, tag: Tag, seen: &mut Seen) -> Result<Cell> {
    seen.count += 1;
    let around = cursor.rest();
    let (mut foreign, mut colour_of, mut told) = (Vec::<Foreign>::new(), None, None);
    let mut references = Listed::default();
    let mut found = None;
    cursor.each(|cursor, child| {
        match child.name {
            "cellProperties" if found.is_none() => {
                found = Some(cell_properties(cursor, &child, seen)?);
                cursor.skip(&child)?;
            }
            "color" => colour_of = Some(Box::new(colour(cursor, child)?)),
            "nrOfStructures" => told = number_of_structures(cursor, child)?,
            "atomRef" => references.add(cursor, child)?,
            _ => foreign.push(cursor.unknown(child, "cell")?),
        }
        Ok(())
    })?;
    let Some(mut cell) = found else {
        return Err(no_properties(cursor, &tag, "cellProperties type=\"TRIANGLE\""));
    };
    cell.references = references.into_references();
    cell.colour = colour_of;
    cell.beyond = Beyond::new(around, foreign);
    let count = cell.references.atoms.len();
    check_number(cursor, &tag, told, count);
    if count == 0 || cell.kind.atoms().is_some_and(|atoms| atoms != count) {
        let found = || format!("a cell of type {} has {count} atoms", shown(cell.kind.word()));
        cursor.warn(tag.start, || (found(), "it is kept as it is"));
    }
    Ok(cell)
}

fn no_properties(cursor: &Cursor, tag: &Tag, example: &str) -> Error {
    let needed = example.split(' ').next().unwrap_or_default();
    let message = format!("<{}> has no <{needed}>", tag.name);
    cursor.page.fault(tag.name_at.clone(), message, "incomplete", format!("write <{example}/> in it"))
}

fn cell_properties(cursor: &mut Cursor, tag: &Tag, seen: &mut Seen) -> Result<Cell> {
    let word = cursor.required(tag, "type")?;
    let kind = CellType::of(word.text.trim());
    if matches!(kind, CellType::Other(_)) {
        let meant = words::meant(&word.text, CellType::words()).map_or(String::new(), |meant| format!(" ({meant}?)"));
        let found = || format!("`type` is \"{}\", which PML has not{meant}", shown(&word.text));
        cursor.warn(word.at.start, || (found(), "it is kept as it is"));
    }
    let index = match cursor.take("index") {
        None => None,
        Some(value) => match value.text.trim().parse::<i64>() {
            Ok(index) => Some(index),
            Err(_) => {
                let message = format!("`index` is \"{}\", which is no index", shown(&value.text));
                let help = "the index of a cell is a whole number; it may be left out";
                return Err(cursor.page.fault(value.at, message, "expected an index", help));
            }
        },
    };
    if let Some(index) = index
        && !seen.cells.insert(index)
    {
        cursor.warn(tag.start, || (format!("cell {index} is there already"), "both are kept"));
    }
    let name = cursor.take_text("name");
    let properties = cursor.rest();
    Ok(Cell { name, properties, ..Cell::new(index, kind, []) })
}

/// Atoms that are named, as they come.
#[derive(Default)]
pub(super) struct Listed {
    atoms: Vec<u32>,
    properties: Vec<(u32, super::super::Attributes)>,
}

impl Listed {
    pub fn add(&mut self, cursor: &mut Cursor, tag: Tag) -> Result<()> {
        let (index, _) = cursor.index(&tag, "index")?;
        let properties = cursor.rest();
        if !properties.is_empty() {
            self.properties.push((self.atoms.len() as u32, properties));
        }
        self.atoms.push(index);
        cursor.skip(&tag)
    }

    pub fn into_references(self) -> References {
        References { atoms: self.atoms.into(), properties: self.properties.into() }
    }
}

/// A colour.
pub(super) fn colour(cursor: &mut Cursor, tag: Tag) -> Result<Colour> {
    let [r, g, b] = [cursor.number(&tag, "r")?, cursor.number(&tag, "g")?, cursor.number(&tag, "b")?];
    let a = cursor.optional_number("a")?;
    if a.is_none() {
        cursor.warn(tag.start, || ("a colour has no `a`".into(), "it was taken for opaque"));
    }
    cursor.no_more(&tag);
    cursor.skip(&tag)?;
    Ok(Colour { rgba: [r, g, b, a.unwrap_or(1.0)] })
}

/// How many structures are told.
pub(super) fn number_of_structures(cursor: &mut Cursor, tag: Tag) -> Result<Option<u64>> {
    let told = cursor.count("value");
    cursor.no_more(&tag);
    cursor.skip(&tag)?;
    Ok(told)
}

/// Tells of a number of structures that is not the one that is there.
pub(super) fn check_number(cursor: &mut Cursor, tag: &Tag, told: Option<u64>, found: usize) {
    if let Some(told) = told.filter(|told| *told != found as u64) {
        cursor.warn(tag.start, || (format!("{told} structures are told, {found} are there"), "those were taken"));
    }
}
