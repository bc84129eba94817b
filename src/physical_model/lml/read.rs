//! Reads LML.

use super::super::cursor::{Cursor, INSTANCE, Tag, shown};
use super::super::page::{Language, Page};
use super::super::{Attributes, Read, Warnings};
use super::{Component, Direction, KINDS, Line, Load, LoadKind, Loads, NAMESPACE, Target, ValueEvent, units};
use crate::error::{Result, words};
use std::path::Path;

const LANGUAGE: Language = Language { name: "LML", roots: &["loads"] };

impl Loads {
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
    /// [`Error::Input`](crate::error::Error::Input) with line and column: the text is no XML or no LML, declares a document type, goes beyond the
    /// limits, or has a load without a type, without anything that it acts on or without an event, or a number that is none.
    pub fn read(name: &str, bytes: Vec<u8>) -> Result<Read<Self>> {
        let mut warnings = Warnings::default();
        let page = Page::new(name, bytes, &LANGUAGE, &mut warnings);
        let (mut cursor, root) = Cursor::at_root(&page, warnings)?;
        let standard = [("xmlns", NAMESPACE), ("xmlns:xsi", INSTANCE)];
        let given = cursor.rest();
        if given.get("xmlns") != Some(NAMESPACE) {
            let found = || (format!("<loads> is not in the namespace {NAMESPACE}"), "it was taken for LML");
            cursor.warn(root.start, found);
        }
        let mut document =
            Self { properties: given.iter().filter(|own| !standard.contains(own)).collect(), ..Self::default() };
        cursor.each(|cursor, tag| {
            match tag.name {
                "load" => document.loads.push(load(cursor, &tag)?),
                _ => document.foreign.push(cursor.unknown(tag, "loads")?),
            }
            Ok(())
        })?;
        if document.loads.is_empty() {
            cursor.warn(root.start, || ("the document has no loads".into(), "nothing is done"));
        }
        let warnings = cursor.finish()?;
        Ok(Read { document, warnings })
    }
}

fn load(cursor: &mut Cursor, tag: &Tag) -> Result<Load> {
    let kind = kind(cursor, tag)?;
    let mut load = Load {
        kind,
        applied_to: Vec::new(),
        direction: None,
        events: Vec::new(),
        unit: None,
        properties: cursor.rest(),
        foreign: Vec::new(),
        line: Line(cursor.line(tag.start)),
    };
    cursor.each(|cursor, child| {
        match child.name {
            "appliedTo" => targets(cursor, &child, &mut load.applied_to)?,
            "direction" => load.direction = Some(direction(cursor, &child)?),
            "valueEvent" => load.events.push(event(cursor, &child)?),
            "unit" => load.unit = Some(unit(cursor, &child, &load.kind)?),
            _ => load.foreign.push(cursor.unknown(child, "load")?),
        }
        Ok(())
    })?;
    let missing = |what: &str, example: &str| {
        let message = format!("the load has no <{what}>");
        Err(cursor.page.fault(tag.name_at.clone(), message, "incomplete", format!("write {example} in it")))
    };
    if load.applied_to.is_empty() {
        return missing("appliedTo", "<appliedTo>0-3,7</appliedTo>, or names of components,");
    }
    if load.events.is_empty() {
        return missing("valueEvent", "<valueEvent date=\"0\" value=\"1\"/>");
    }
    if load.unit.is_none() {
        cursor.warn(tag.start, || ("the load has no <unit>".into(), "it is kept without one"));
    }
    if load.direction.is_none() && load.kind != LoadKind::Pressure {
        cursor.warn(tag.start, || ("the load has no <direction>".into(), "it is free along all axes"));
    }
    Ok(load)
}

fn kind(cursor: &mut Cursor, tag: &Tag) -> Result<LoadKind> {
    let known = || words::any_of(KINDS.iter().map(|(word, _)| *word));
    let Some(value) = cursor.take_type() else {
        let help = format!("write <load xsi:type=\"Force\">; loads are {}", known());
        return Err(cursor.page.fault(tag.name_at.clone(), "the load has no `xsi:type`", "incomplete", help));
    };
    // A type may be written with the prefix of the namespace.
    let kind = LoadKind::of(value.text.trim().rsplit(':').next().unwrap_or_default());
    if let LoadKind::Other(word) = &kind {
        let found = || format!("`xsi:type` is \"{}\", which LML has not ({})", shown(word), known());
        cursor.warn(value.at.start, || (found(), "it is kept as it is"));
    }
    Ok(kind)
}

fn targets(cursor: &mut Cursor, tag: &Tag, list: &mut Vec<Target>) -> Result<()> {
    cursor.no_more(tag);
    if !list.is_empty() {
        cursor.warn(tag.start, || ("a load has <appliedTo> twice".into(), "it acts on all of both"));
    }
    let (text, at) = cursor.text(tag)?;
    if text.trim().is_empty() {
        let help = "write indices of atoms, ranges of them, or names of components: 1-10,19,24";
        return Err(cursor.page.fault(tag.name_at.clone(), "<appliedTo> says nothing", "empty", help));
    }
    for part in text.split(',') {
        list.push(Target::of(part).map_err(|why| {
            let message = format!("a load cannot be applied to \"{}\": {why}", shown(part.trim()));
            let help =
                "write indices of atoms, ranges of them, or names of components, which begin with no digit: 1-10,19,24";
            cursor.page.fault(at.clone(), message, "expected atoms or names", help)
        })?);
    }
    Ok(())
}

fn direction(cursor: &mut Cursor, tag: &Tag) -> Result<Direction> {
    let mut components = [Component::Free; 3];
    for (component, name) in components.iter_mut().zip(["x", "y", "z"]) {
        let Some(value) = cursor.take(name) else { continue };
        *component = match value.text.trim() {
            word if word.eq_ignore_ascii_case("NULL") => Component::Null,
            text => match super::super::number::finite(text) {
                Some(number) => Component::Number(number),
                None => {
                    let message = format!("`{name}` is \"{}\", which is neither a finite number nor NULL", shown(text));
                    let help =
                        "write a number, NULL for what is held at zero, or leave the attribute out for what is free";
                    return Err(cursor.page.fault(value.at, message, "expected a number or NULL", help));
                }
            },
        };
    }
    let toward = match cursor.take("toward") {
        None => None,
        Some(value) => {
            Some(Target::of(&value.text).ok().filter(|to| !matches!(to, Target::Range(..))).ok_or_else(|| {
                let message = format!("`toward` is \"{}\", which is no atom", shown(&value.text));
                cursor.page.fault(value.at, message, "expected an atom", "write the index of an atom, or its name")
            })?)
        }
    };
    if toward.is_some() && components != [Component::Free; 3] {
        cursor.warn(tag.start, || ("a direction has `toward` and components".into(), "both are kept"));
    }
    let properties = cursor.rest();
    cursor.skip(tag)?;
    Ok(Direction { components, toward, properties })
}

fn event(cursor: &mut Cursor, tag: &Tag) -> Result<ValueEvent> {
    let (date, value) = (cursor.number(tag, "date")?, cursor.number(tag, "value")?);
    let properties: Attributes = cursor.rest();
    cursor.skip(tag)?;
    Ok(ValueEvent { date, value, properties })
}

fn unit(cursor: &mut Cursor, tag: &Tag, kind: &LoadKind) -> Result<Box<str>> {
    cursor.no_more(tag);
    let (text, at) = cursor.text(tag)?;
    let unit = text.trim();
    if !matches!(kind, LoadKind::Other(_)) && units::value(kind, unit).is_none() {
        let known = || words::any_of(units::names(kind));
        let found = || format!("\"{}\" is no unit of a {} ({})", shown(unit), kind.word(), known());
        cursor.warn(at.start, || (found(), "it is kept as it is"));
    }
    Ok(unit.into())
}
