//! What the page must know of a result before its first frame, and what grows with it.

use serde_json::{Value, json};

use super::pack::Box3;
use crate::Vec3;
use crate::error::Result;
use crate::experiment::Document;
use crate::output::{FieldLayout, Obstacle, ResultFile};
use crate::picture::ColourMap;
use crate::picture::documented::{clock_of, type_colours};
use crate::picture::field_view::species_label;
use crate::picture::plots::label_of;
use crate::picture::render::{AXES, ClockUnit};
use crate::picture::shown::{Of, Shown};
use crate::picture::tools::gone;

/// Parts of a scale of colours.
const COLOURS: usize = 64;

/// What does not change: types, obstacles, fields, what can be shown, the look that the document asks for.
///
/// # Errors
/// A damaged file.
pub fn scene(result: &ResultFile, document: &Document) -> Result<Value> {
    let (header, layout) = (result.header(), result.layout());
    let colours = type_colours(result, document);
    let types = layout.types.iter().zip(&colours).map(|(kind, colour)| {
        json!({ "name": kind.name, "colour": colour.hex(), "atoms": kind.atoms, "facets": kind.facets, "links": kind.links })
    });
    let picture = &document.experiment.picture;
    let charts =
        document.experiment.plot.iter().map(
            |plot| json!({ "name": plot.name, "title": plot.title.as_ref().unwrap_or(&document.experiment.title) }),
        );
    let mut lines = Vec::new();
    lines.extend(layout.fibres.then_some("fibres"));
    lines.extend(layout.linked.then_some("linked"));
    lines.extend(layout.contacts.then_some("contacts"));
    lines.extend(layout.tractions.then_some("traction"));
    let has_loads = document.experiment.cells.values().any(|cell| !cell.applied.loads.is_empty());
    lines.extend(has_loads.then_some("loads"));
    let first = Box3::around(&result.positions(0)?);
    Ok(json!({
        "title": header.title,
        "document": header.document,
        "experiment": header.experiment,
        "sets": header.sets,
        "equations": header.equations,
        "seed": header.seed.to_string(),
        "version": header.version,
        "commit": header.commit,
        "started": header.started,
        "until": document.experiment.run.until.value(),
        "clock": clock_of(document).map(|ClockUnit(size, name)| json!([size, name])),
        "box": { "low": first.low, "sides": first.sides },
        "types": types.collect::<Vec<_>>(),
        "obstacles": layout.obstacles.iter().map(obstacle).collect::<Vec<_>>(),
        "fields": layout.fields.iter().filter(|field| !field.is_empty()).map(field).collect::<Vec<_>>(),
        "quantities": quantities(result)?,
        "series": result.scene_names().iter().map(|name| json!({ "name": name, "label": label_of(result, name) })).collect::<Vec<_>>(),
        "lines": lines,
        "charts": charts.collect::<Vec<_>>(),
        "look": {
            "colour_by": picture.colour_by,
            "range": picture.colour_range,
            "field": picture.field,
            "field_range": picture.field_range,
            "field_log": picture.field_log,
            "fibres": picture.fibres,
            "links": picture.links,
            "marks": picture.marks,
            "loads": picture.loads,
            "from": picture.view.from,
            "up": picture.view.up,
        },
        "axes": AXES.map(|(name, colour)| json!({ "name": name, "colour": colour.hex() })),
        "maps": { "values": map(ColourMap::Viridis), "field": map(ColourMap::Ink) },
    }))
}

/// What colours can show.
fn quantities(result: &ResultFile) -> Result<Vec<Value>> {
    let one = |name: &String| {
        let shown = Shown::named(result, name)?;
        let of = match shown.of() {
            Of::Types => return Ok(None),
            Of::Cells => "cells",
            Of::Atoms => "atoms",
        };
        Ok(Some(json!({ "name": name, "label": shown.label(result), "of": of })))
    };
    Shown::names(result).iter().filter_map(|name| one(name).transpose()).collect()
}

fn obstacle(obstacle: &Obstacle) -> Value {
    json!({
        "name": obstacle.name,
        "point": obstacle.point,
        "normal": obstacle.normal,
        "profile": obstacle.profile,
    })
}

fn field(field: &FieldLayout) -> Value {
    let species = field.species.iter().enumerate();
    let species = species.map(|(number, (name, _))| json!({ "name": name, "label": species_label(field, number) }));
    json!({
        "name": field.name,
        "species": species.collect::<Vec<_>>(),
        "cells": field.cells,
        "spacing": field.spacing,
        "origin": field.origin,
    })
}

fn map(map: ColourMap) -> Vec<[u8; 3]> {
    (0..COLOURS).map(|part| map.at(part as f64 / (COLOURS - 1) as f64).0).collect()
}

/// What grows with the result: times, how far tools have gone, whether more will come.
///
/// # Errors
/// A damaged file.
pub fn course(result: &ResultFile) -> Result<Value> {
    let ending = result.ending();
    // Null of what stands.
    let told = |gone: Vec<Vec3>| {
        let each: Vec<[f64; 3]> = gone.into_iter().map(Into::into).collect();
        if each.is_empty() { Value::Null } else { json!(each) }
    };
    let obstacles = result.layout().obstacles.iter();
    Ok(json!({
        "times": result.times()?,
        "gone": obstacles.map(|obstacle| gone(result, obstacle).map(told)).collect::<Result<Vec<_>>>()?,
        "finished": ending.finished,
        "running": ending.running,
    }))
}
