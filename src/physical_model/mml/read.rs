//! Reads MML.

use super::super::cursor::{Cursor, INSTANCE, Tag, Value, shown};
use super::super::page::{Language, Page};
use super::super::{Read, Warnings};
use super::criteria::{KINDS, SCOPES};
use super::{
    Criterion, CriterionKind, MONITOR_TYPES, Method, MethodKind, Monitor, Monitoring, MonitoringIn, MonitoringOut,
    Operator, Reference, SingleCriterion, TIME_UNITS, TimeParameter, TimeStep,
};
use crate::error::{Error, Result, words};
use std::path::Path;

const LANGUAGE: Language = Language { name: "MML", roots: &["monitoringIn", "monitoringOut"] };

impl Monitoring {
    /// Reads a file.
    ///
    /// # Errors
    /// As [`Self::read`], and [`Error::Input`] for a file that cannot be read.
    pub fn open(path: &Path) -> Result<Read<Self>> {
        let (name, bytes) = LANGUAGE.open(path)?;
        Self::read(&name, bytes)
    }

    /// Reads the bytes of a file called `name`.
    ///
    /// # Errors
    /// [`Error::Input`] with line and column: the text is no XML or no MML, declares a document type, goes beyond the
    /// limits, or has a criterion or a monitor without what it needs, or a number that is none.
    pub fn read(name: &str, bytes: Vec<u8>) -> Result<Read<Self>> {
        let mut warnings = Warnings::default();
        let page = Page::new(name, bytes, &LANGUAGE, &mut warnings);
        let (mut cursor, root) = Cursor::at_root(&page, warnings)?;
        let given = cursor.rest();
        let properties = given.iter().filter(|own| *own != ("xmlns:xsi", INSTANCE)).collect();
        let document = match root.name {
            "monitoringIn" => {
                let mut document = MonitoringIn { properties, ..MonitoringIn::default() };
                monitoring_in(&mut cursor, &mut document)?;
                let needed = [("dt", document.dt.is_none()), ("refresh", document.refresh.is_none())];
                for (what, _) in needed.into_iter().filter(|(_, missing)| *missing) {
                    cursor.warn(root.start, || (format!("there is no <{what}>"), "none was taken for it"));
                }
                Self::In(Box::new(document))
            }
            _ => {
                let mut document = MonitoringOut { properties, ..MonitoringOut::default() };
                cursor.each(|cursor, tag| {
                    match tag.name {
                        "pmlFile" => document.pml_file = Some(text(cursor, &tag)?),
                        "time" => document.times.push(time_step(cursor, &tag)?),
                        _ => document.foreign.push(cursor.unknown(tag, "monitoringOut")?),
                    }
                    Ok(())
                })?;
                Self::Out(document)
            }
        };
        let warnings = cursor.finish()?;
        Ok(Read { document, warnings })
    }
}

fn monitoring_in(cursor: &mut Cursor, document: &mut MonitoringIn) -> Result<()> {
    cursor.each(|cursor, tag| {
        match tag.name {
            "dt" => document.dt = Some(time(cursor, &tag)?),
            "refresh" => document.refresh = Some(time(cursor, &tag)?),
            "pmlFile" => document.pml_file = Some(text(cursor, &tag)?),
            "simulatorFile" => document.simulator_file = Some(text(cursor, &tag)?),
            "lmlFile" => document.lml_file = Some(text(cursor, &tag)?),
            "simulator" => document.simulator = Some(text(cursor, &tag)?),
            "stoppingCriteria" => document.stop = stopping_criteria(cursor, &tag)?,
            "monitors" => {
                cursor.no_more(&tag);
                cursor.each(|cursor, tag| {
                    match tag.name {
                        "monitor" => document.monitors.push(monitor(cursor, &tag)?),
                        _ => document.beside_monitors.push(cursor.unknown(tag, "monitors")?),
                    }
                    Ok(())
                })?;
            }
            _ => document.foreign.push(cursor.unknown(tag, "monitoringIn")?),
        }
        Ok(())
    })
}

fn text(cursor: &mut Cursor, tag: &Tag) -> Result<Box<str>> {
    cursor.no_more(tag);
    cursor.text(tag).map(|(text, _)| text.trim().into())
}

/// A time as the attributes of an element.
fn time_of(cursor: &mut Cursor, tag: &Tag) -> Result<TimeParameter> {
    let value = cursor.number(tag, "value")?;
    let unit = cursor.required(tag, "unit")?;
    if !TIME_UNITS.iter().any(|(known, _)| *known == unit.text.trim()) {
        let known = || words::any_of(TIME_UNITS.iter().map(|(unit, _)| *unit));
        let found = || format!("\"{}\" is no unit of time ({})", shown(&unit.text), known());
        cursor.warn(unit.at.start, || (found(), "it is kept as it is"));
    }
    Ok(TimeParameter { value, unit: unit.text.into(), properties: cursor.rest() })
}

fn time(cursor: &mut Cursor, tag: &Tag) -> Result<TimeParameter> {
    let time = time_of(cursor, tag)?;
    cursor.skip(tag)?;
    Ok(time)
}

fn time_step(cursor: &mut Cursor, tag: &Tag) -> Result<TimeStep> {
    let mut step = TimeStep { time: time_of(cursor, tag)?, stop: None, monitors: Vec::new(), foreign: Vec::new() };
    cursor.each(|cursor, tag| {
        match tag.name {
            "stoppingCriteria" => step.stop = stopping_criteria(cursor, &tag)?,
            "monitor" => step.monitors.push(monitor(cursor, &tag)?),
            _ => step.foreign.push(cursor.unknown(tag, "time")?),
        }
        Ok(())
    })?;
    Ok(step)
}

/// The criterion in the element; of several all must hold.
fn stopping_criteria(cursor: &mut Cursor, tag: &Tag) -> Result<Option<Criterion>> {
    cursor.no_more(tag);
    let (mut list, mut foreign) = (Vec::new(), Vec::new());
    cursor.each(|cursor, child| {
        match child.name {
            "criteria" | "multipleCriteria" => list.push(criterion(cursor, &child)?),
            _ => foreign.push(cursor.unknown(child, "stoppingCriteria")?),
        }
        Ok(())
    })?;
    if list.len() > 1 || !foreign.is_empty() {
        cursor.warn(tag.start, || ("<stoppingCriteria> has more than one criterion".into(), "all of them must hold"));
        let properties = super::super::Attributes::default();
        return Ok(Some(Criterion::Multiple { operator: Operator::And, list, properties, foreign }));
    }
    Ok(list.pop())
}

fn criterion(cursor: &mut Cursor, tag: &Tag) -> Result<Criterion> {
    if tag.name == "criteria" {
        return single(cursor, tag).map(|single| Criterion::Single(Box::new(single)));
    }
    let word = cursor.required(tag, "op")?;
    let operator = match word.text.trim() {
        "And" => Operator::And,
        "Or" => Operator::Or,
        _ => return Err(not_one_of(cursor, &word, "op", ["And", "Or"])),
    };
    let properties = cursor.rest();
    let (mut list, mut foreign) = (Vec::new(), Vec::new());
    cursor.each(|cursor, child| {
        match child.name {
            "criteria" | "multipleCriteria" => list.push(criterion(cursor, &child)?),
            _ => foreign.push(cursor.unknown(child, "multipleCriteria")?),
        }
        Ok(())
    })?;
    if list.len() < 2 {
        let found = || format!("<multipleCriteria> has {} criteria", list.len());
        cursor.warn(tag.start, || (found(), "it is kept as it is"));
    }
    Ok(Criterion::Multiple { operator, list, properties, foreign })
}

fn single(cursor: &mut Cursor, tag: &Tag) -> Result<SingleCriterion> {
    let value = typed(cursor, tag, "Position")?;
    let kind = CriterionKind::of(local(&value));
    if let CriterionKind::Other(word) = &kind {
        let known = || words::any_of(KINDS.iter().map(|(word, _)| *word));
        let found = || format!("`xsi:type` is \"{}\", which MML has not ({})", shown(word), known());
        cursor.warn(value.at.start, || (found(), "it is kept as it is"));
    }
    let (unit, target) = (cursor.take_text("unit"), cursor.take_text("target"));
    let properties = cursor.rest();
    let (mut found, mut data, mut foreign) = (None, None, Vec::new());
    cursor.each(|cursor, child| {
        match child.name {
            "method" => found = Some(method(cursor, &child)?),
            "data" => data = Some(text(cursor, &child)?),
            _ => foreign.push(cursor.unknown(child, "criteria")?),
        }
        Ok(())
    })?;
    let Some(method) = found else {
        let help = "write <method xsi:type=\"Threshold\" maxValue=\"0.1\"/> in it";
        return Err(cursor.page.fault(tag.name_at.clone(), "the criterion has no <method>", "incomplete", help));
    };
    Ok(SingleCriterion { kind, unit, target, method, data, properties, foreign })
}

fn method(cursor: &mut Cursor, tag: &Tag) -> Result<Method> {
    let value = typed(cursor, tag, "Threshold")?;
    let kind = match local(&value) {
        "Threshold" => MethodKind::Threshold { max: cursor.number(tag, "maxValue")? },
        "MinThreshold" => MethodKind::MinThreshold { min: cursor.number(tag, "minValue")? },
        "TimePeriodThreshold" => {
            let min = cursor.number(tag, "minValue")?;
            MethodKind::TimePeriodThreshold { min, iterations: cursor.index(tag, "iterations")?.0 }
        }
        _ => return Err(not_one_of(cursor, &value, "xsi:type", ["Threshold", "MinThreshold", "TimePeriodThreshold"])),
    };
    let scope = match cursor.take("scope") {
        None => None,
        Some(word) => match SCOPES.iter().find(|(known, _)| *known == word.text.trim()) {
            Some((_, scope)) => Some(*scope),
            None => return Err(not_one_of(cursor, &word, "scope", SCOPES.map(|(word, _)| word))),
        },
    };
    let properties = cursor.rest();
    cursor.skip(tag)?;
    Ok(Method { kind, scope, properties })
}

fn typed<'a>(cursor: &mut Cursor<'a>, tag: &Tag, example: &str) -> Result<Value<'a>> {
    cursor.take_type().ok_or_else(|| {
        let message = format!("<{}> has no `xsi:type`", tag.name);
        cursor.page.fault(tag.name_at.clone(), message, "incomplete", format!("write xsi:type=\"{example}\" in it"))
    })
}

/// A type without the prefix of a namespace.
fn local<'a>(value: &'a Value) -> &'a str {
    value.text.trim().rsplit(':').next().unwrap_or_default()
}

fn not_one_of<const N: usize>(cursor: &Cursor, value: &Value, key: &str, known: [&str; N]) -> Error {
    let message = format!("`{key}` is \"{}\"", shown(&value.text));
    let label = format!("expected {}", words::any_of(known));
    cursor.page.fault(value.at.clone(), message, &label, "write one of them")
}

fn monitor(cursor: &mut Cursor, tag: &Tag) -> Result<Monitor> {
    let word = cursor.required(tag, "type")?;
    if !MONITOR_TYPES.contains(&word.text.trim()) {
        let found = || format!("`type` is \"{}\", which MML has not", shown(&word.text));
        cursor.warn(word.at.start, || (found(), "it is kept as it is"));
    }
    let mut monitor = Monitor {
        kind: word.text.trim().into(),
        index: cursor.index(tag, "index")?.0,
        target: cursor.required(tag, "target")?.text.into(),
        offset: [cursor.optional_number("dx")?, cursor.optional_number("dy")?, cursor.optional_number("dz")?],
        start: None,
        stop: None,
        references: Vec::new(),
        indexes: None,
        data: None,
        properties: cursor.rest(),
        foreign: Vec::new(),
    };
    cursor.each(|cursor, child| {
        match child.name {
            "startAt" => monitor.start = Some(time(cursor, &child)?),
            "stopAt" => monitor.stop = Some(time(cursor, &child)?),
            "reference" => monitor.references.push(reference(cursor, &child)?),
            "indexes" => monitor.indexes = Some(text(cursor, &child)?),
            "data" => monitor.data = Some(text(cursor, &child)?),
            _ => monitor.foreign.push(cursor.unknown(child, "monitor")?),
        }
        Ok(())
    })?;
    if monitor.data.is_some() && monitor.numbers().is_none() {
        cursor.warn(tag.start, || ("<data> is not a list of numbers".into(), "it is kept as it is"));
    }
    Ok(monitor)
}

fn reference(cursor: &mut Cursor, tag: &Tag) -> Result<Reference> {
    let document = cursor.required(tag, "document")?.text.into();
    let monitor_index = match cursor.take("monitorIndex") {
        None => None,
        Some(value) => Some(value.text.trim().parse().map_err(|_| {
            let message = format!("`monitorIndex` is \"{}\", which is no index", shown(&value.text));
            cursor.page.fault(value.at.clone(), message, "expected an index", "indices are whole numbers from 0 on")
        })?),
    };
    let (target, properties) = (cursor.take_text("target"), cursor.rest());
    cursor.skip(tag)?;
    Ok(Reference { document, monitor_index, target, properties })
}
