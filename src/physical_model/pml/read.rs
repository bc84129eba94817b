//! Reads PML.

use super::super::cursor::{Cursor, Tag, shown};
use super::super::page::{Language, Page};
use super::super::{Read, Warnings};
use super::read_structures::{Listed, atom, cell, check_number, colour, number_of_structures};
use super::references::check_references;
use super::seen::Seen;
use super::{Component, Mode, MultiComponent, PhysicalModel, StructuralComponent};
use crate::error::Result;
use std::path::Path;

pub(super) const LANGUAGE: Language = Language { name: "PML", roots: &["physicalModel"] };

impl PhysicalModel {
    /// Reads a file.
    ///
    /// # Errors
    /// As [`Self::read`], and [`Error::Input`](crate::error::Error::Input) for a file that cannot be read.
    pub fn open(path: &Path) -> Result<Read<Self>> {
        let (name, bytes) = LANGUAGE.open(path)?;
        Self::read(&name, bytes)
    }

    /// Reads the bytes of a file called `name`.
    ///
    /// # Errors
    /// [`Error::Input`](crate::error::Error::Input) with line and column: the text is no XML or no PML, declares a document type, goes beyond the
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
    add_components(cursor, components, seen)?;
    if !matches!(components.as_slice(), [Component::Multi(_)]) {
        let found = || format!("<{}> has not exactly one multiComponent", tag.name);
        cursor.warn(tag.start, || (found(), "what is in it is kept"));
    }
    Ok(())
}

fn add_components(cursor: &mut Cursor, components: &mut Vec<Component>, seen: &mut Seen) -> Result<()> {
    cursor.each(|cursor, tag| {
        components.push(match tag.name {
            "multiComponent" => {
                let (name, properties) = (cursor.take_text("name"), cursor.rest());
                let mut multi = MultiComponent { name, properties, components: Vec::new() };
                add_components(cursor, &mut multi.components, seen)?;
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
