//! Reads PML.

use super::super::cursor::{Cursor, Tag, shown};
use super::super::page::{Language, Page};
use super::super::{Foreign, Read, Warnings};
use super::references::check_references;
use super::{
    Atom, Beyond, Cell, CellType, Colour, Component, Mode, MultiComponent, PhysicalModel, References,
    StructuralComponent,
};
use crate::error::{Error, Fault, Result, words};
use std::collections::{HashMap, HashSet};
use std::path::Path;

pub(super) const LANGUAGE: Language = Language { name: "PML", roots: &["physicalModel"] };

/// What is counted and looked up while a document is read.
#[derive(Default)]
pub(super) struct Seen {
    /// The indices of atoms, and the bytes where they stand.
    pub atoms: HashMap<u32, u32>,
    /// The indices of cells.
    cells: HashSet<i64>,
    /// Cells in all.
    count: u64,
}

impl PhysicalModel {
    /// Reads a file.
    ///
    /// # Errors
    /// As [`Self::read`], and [`Error::Input`] for a file that cannot be read.
    pub fn open(path: &Path) -> Result<Read<Self>> {
        let name = path.display().to_string();
        let bytes = crate::files::read(path).map_err(|failure| {
            let fault = Fault::new(format!("PML file `{name}` cannot be read: {failure}"));
            Error::input(fault.help("give a file that exists and that you may read"))
        })?;
        Self::read(&name, bytes)
    }

    /// Reads the bytes of a file called `name`.
    ///
    /// # Errors
    /// [`Error::Input`] with line and column: the text is no XML or no PML, declares a document type, goes beyond the
    /// limits (1 GiB, elements 200 deep), has no atoms, an atom twice or a number that is none, or names atoms that it
    /// does not have.
    pub fn read(name: &str, bytes: Vec<u8>) -> Result<Read<Self>> {
        let mut warnings = Warnings::default();
        let page = Page::new(name, bytes, &LANGUAGE, &mut warnings);
        let (mut cursor, root) = Cursor::at_root(&page, warnings)?;
        let mut seen = Seen::default();
        let mut model = Self { name: cursor.take_text("name"), ..Self::default() };
        let counts = ["nrOfAtoms", "nrOfCells"].map(|key| cursor.count(key));
        for key in ["nrOfExclusiveComponents", "nrOfInformativeComponents"] {
            cursor.count(key);
        }
        model.properties = cursor.rest();
        let mut has_exclusive = false;
        cursor.each(|cursor, tag| {
            match tag.name {
                "atoms" => lists_of_atoms(cursor, tag, &mut model, &mut seen)?,
                "exclusiveComponents" => {
                    has_exclusive = true;
                    part(cursor, tag, &mut model.exclusive, &mut seen)?;
                }
                "informativeComponents" => {
                    part(cursor, tag, model.informative.get_or_insert_default(), &mut seen)?;
                }
                _ => model.foreign.push(cursor.unknown(tag, "physicalModel")?),
            }
            Ok(())
        })?;
        if seen.atoms.is_empty() {
            let help =
                "PML lists all atoms first: <atoms><structuralComponent><atom><atomProperties index=\"0\" …/></atom>";
            return Err(page.fault(root.name_at, "the model has no atoms", "no atoms in it", help));
        }
        if !has_exclusive {
            cursor.warn(root.start, || ("there are no <exclusiveComponents>".into(), "an empty part was taken for it"));
        }
        for ((told, found), what) in
            counts.into_iter().zip([seen.atoms.len() as u64, seen.count]).zip(["atoms", "cells"])
        {
            if let Some(told) = told.filter(|told| *told != found) {
                cursor.warn(root.start, || (format!("{told} {what} are told, {found} are there"), "those were taken"));
            }
        }
        let warnings = cursor.finish()?;
        check_references(&page, &model, &seen)?;
        Ok(Read { document: model, warnings })
    }
}

/// The element around all atoms.
fn lists_of_atoms(cursor: &mut Cursor, tag: Tag, model: &mut PhysicalModel, seen: &mut Seen) -> Result<()> {
    cursor.no_more(&tag);
    let mut loose = StructuralComponent::default();
    cursor.each(|cursor, tag| {
        match tag.name {
            "structuralComponent" => model.atoms.push(structural(cursor, tag, true, seen)?),
            "atom" => {
                cursor.warn(tag.start, || ("an atom stands in no component".into(), "it was put into one"));
                loose.atoms.push(atom(cursor, tag, seen)?);
            }
            _ => model.beside_atoms.push(cursor.unknown(tag, "atoms")?),
        }
        Ok(())
    })?;
    if !loose.atoms.is_empty() {
        model.atoms.push(loose);
    }
    if model.atoms.len() > 1 {
        cursor.warn(tag.start, || ("atoms are in more than one list".into(), "all lists are kept"));
    }
    Ok(())
}

/// The exclusive or the informative components.
fn part(cursor: &mut Cursor, tag: Tag, components: &mut Vec<Component>, seen: &mut Seen) -> Result<()> {
    cursor.no_more(&tag);
    add_components(cursor, tag.name == "exclusiveComponents", components, seen)?;
    if !matches!(components.as_slice(), [Component::Multi(_)]) {
        let found = || format!("<{}> has not exactly one multiComponent", tag.name);
        cursor.warn(tag.start, || (found(), "what is in it is kept"));
    }
    Ok(())
}

fn add_components(
    cursor: &mut Cursor,
    exclusive: bool,
    components: &mut Vec<Component>,
    seen: &mut Seen,
) -> Result<()> {
    cursor.each(|cursor, tag| {
        components.push(match tag.name {
            "multiComponent" => {
                let (name, properties) = (cursor.take_text("name"), cursor.rest());
                let mut multi = MultiComponent { name, properties, components: Vec::new() };
                add_components(cursor, exclusive, &mut multi.components, seen)?;
                Component::Multi(multi)
            }
            "structuralComponent" => Component::Structural(structural(cursor, tag, false, seen)?),
            _ => Component::Foreign(cursor.unknown(tag, "multiComponent")?),
        });
        Ok(())
    })
}

/// A structural component; `defines` where its atoms are defined.
fn structural(cursor: &mut Cursor, tag: Tag, defines: bool, seen: &mut Seen) -> Result<StructuralComponent> {
    let mut component = StructuralComponent {
        name: cursor.take_text("name"),
        mode: cursor.take("mode").map(|word| {
            let mode = Mode::of(&word.text);
            if matches!(mode, Mode::Other(_)) {
                let found = || format!("`mode` is \"{}\", which PML has not", shown(&word.text));
                cursor.warn(word.at.start, || (found(), "it is kept as it is"));
            }
            mode
        }),
        properties: cursor.rest(),
        ..StructuralComponent::default()
    };
    let mut references = Listed::default();
    let mut told = None;
    cursor.each(|cursor, child| {
        match child.name {
            "color" => component.colour = Some(colour(cursor, child)?),
            "nrOfStructures" => told = number_of_structures(cursor, child)?,
            "atom" if defines => component.atoms.push(atom(cursor, child, seen)?),
            "cell" => component.cells.push(cell(cursor, child, seen)?),
            "atomRef" => references.add(cursor, child)?,
            _ => component.foreign.push(cursor.unknown(child, "structuralComponent")?),
        }
        Ok(())
    })?;
    component.references = references.into_references();
    let lists = [component.atoms.len(), component.cells.len(), component.references.atoms.len()];
    check_number(cursor, &tag, told, lists.iter().sum());
    if lists.iter().filter(|length| **length > 0).count() > 1 {
        cursor.warn(tag.start, || ("a component has cells and atoms side by side".into(), "both are kept"));
    }
    Ok(component)
}

fn atom(cursor: &mut Cursor, tag: Tag, seen: &mut Seen) -> Result<Atom> {
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

fn cell(cursor: &mut Cursor, tag: Tag, seen: &mut Seen) -> Result<Cell> {
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
struct Listed {
    atoms: Vec<u32>,
    properties: Vec<(u32, super::Attributes)>,
}

impl Listed {
    fn add(&mut self, cursor: &mut Cursor, tag: Tag) -> Result<()> {
        let (index, _) = cursor.index(&tag, "index")?;
        let properties = cursor.rest();
        if !properties.is_empty() {
            self.properties.push((self.atoms.len() as u32, properties));
        }
        self.atoms.push(index);
        cursor.skip(&tag)
    }

    fn into_references(self) -> References {
        References { atoms: self.atoms.into(), properties: self.properties.into() }
    }
}

fn colour(cursor: &mut Cursor, tag: Tag) -> Result<Colour> {
    let [r, g, b] = [cursor.number(&tag, "r")?, cursor.number(&tag, "g")?, cursor.number(&tag, "b")?];
    let a = cursor.optional_number("a")?;
    if a.is_none() {
        cursor.warn(tag.start, || ("a colour has no `a`".into(), "it was taken for opaque"));
    }
    cursor.no_more(&tag);
    cursor.skip(&tag)?;
    Ok(Colour { rgba: [r, g, b, a.unwrap_or(1.0)] })
}

fn number_of_structures(cursor: &mut Cursor, tag: Tag) -> Result<Option<u64>> {
    let told = cursor.count("value");
    cursor.no_more(&tag);
    cursor.skip(&tag)?;
    Ok(told)
}

/// Tells of a number of structures that is not the one that is there.
fn check_number(cursor: &mut Cursor, tag: &Tag, told: Option<u64>, found: usize) {
    if let Some(told) = told.filter(|told| *told != found as u64) {
        cursor.warn(tag.start, || (format!("{told} structures are told, {found} are there"), "those were taken"));
    }
}
