//! Says what a result file holds, for people and for programs.

use std::fmt::Write as _;

use hdf5::Group;
use serde_json::{Map, Value, json};

use super::field_layout::FieldLayout;
use super::reader::ResultFile;
use super::systems::{SystemLayout, SystemScope};
use super::texts::text;
use super::{Cell, Layout, Part, Population};
use crate::error::Result;

/// A page for people: what was simulated, how far it came, what was measured.
///
/// # Errors
/// A damaged file.
pub fn describe(result: &ResultFile) -> Result<String> {
    let (header, layout, ending) = (result.header(), result.layout(), result.ending());
    let (times, steps) = (result.times()?, result.steps()?);
    let mut page = String::new();
    let mut line = |name: &str, value: String| {
        // Writing to a text cannot fail.
        let _ = writeln!(page, "{name:<12}{value}");
    };
    line("title", header.title.clone());
    line("experiment", format!("{} (seed {})", header.document, header.seed));
    for set in &header.sets {
        line("  --set", set.clone());
    }
    let (cells, population) = (last_cells(result), last_population(result));
    let types = count_types(layout, &cells).into_iter().map(|(name, count)| format!("{count} {name}"));
    let types = types.collect::<Vec<_>>().join(", ");
    line(
        "cells",
        match result.has_one_population() {
            true => format!("{} ({types})", cells.len()),
            false => format!("{} ({types}) in the last frame, {} in all", cells.len(), result.known_cells().len()),
        },
    );
    let [atoms, facets, links] = [Part::Atoms, Part::Facets, Part::Links].map(|part| population.count(part));
    line("mesh", format!("{atoms} atoms, {facets} facets, {links} links"));
    for field in &layout.fields {
        line("field", describe_field(field));
    }
    for system in &layout.systems {
        let whose = match members(result, system)? {
            None => "the scene".to_owned(),
            Some(cells) => format!("{cells} cells"),
        };
        line("chemistry", format!("{} of {whose}: {}", system.name, described(&system.quantities)));
    }
    if !layout.membranes.is_empty() {
        let named: Vec<(String, String)> = layout.membranes.iter().map(|m| (m.name.clone(), m.unit.clone())).collect();
        line("membranes", described(&named));
    }
    line(
        "frames",
        format!(
            "{}, from {} s to {} s, {} of them within steps (step {} to {})",
            result.frames(),
            times[0],
            times[times.len() - 1],
            within(result)?,
            steps[0],
            steps[steps.len() - 1]
        ),
    );
    let last = |name: &str| -> Result<Option<f64>> {
        let there = layout.scene_series.iter().any(|(known, _)| known == name);
        Ok(if there { result.scene_series(name)?.last().copied() } else { None })
    };
    if let (Some(aggregates), Some(largest), Some(deepest)) =
        (last("aggregates")?, last("largest_aggregate")?, last("contact.deepest")?)
    {
        let number = if aggregates == 1.0 { "1 aggregate".to_owned() } else { format!("{aggregates} aggregates") };
        let depth = format!("deepest {:.2} % of an edge", 100.0 * deepest);
        line("contacts", format!("{number} in the last frame, the largest of {largest}; {depth}"));
    }
    let state = match (ending.finished, ending.wall_time) {
        (true, Some(seconds)) => format!("finished in {seconds:.1} s"),
        (true, None) => "finished".into(),
        (false, _) if ending.running => "being run; what was recorded up to a moment ago".into(),
        (false, _) => "interrupted; `pseudopod resume` goes on from its checkpoint".into(),
    };
    let resumed = if ending.resumed > 0 { format!(", resumed {} times", ending.resumed) } else { String::new() };
    line("state", state + &resumed);
    line("started", header.started.clone());
    line("program", format!("pseudopod {} (commit {})", header.version, header.commit));
    line("file size", readable_size(bytes(result)));
    for measure in result.summary()? {
        let unit = if measure.unit == "1" { String::new() } else { format!(" {}", measure.unit) };
        line("measure", format!("{} = {}{unit}  {}", measure.name, measure.value, measure.description));
    }
    Ok(page)
}

/// How many frames lie within steps.
fn within(result: &ResultFile) -> Result<usize> {
    Ok(result.interpolated()?.into_iter().filter(|within| *within).count())
}

/// Everything in the file but the arrays.
///
/// # Errors
/// A damaged file.
pub fn to_json(result: &ResultFile) -> Result<Value> {
    let (header, layout, ending) = (result.header(), result.layout(), result.ending());
    let (times, steps) = (result.times()?, result.steps()?);
    let summary: Map<String, Value> = result
        .summary()?
        .into_iter()
        .map(|m| (m.name, json!({ "value": m.value, "unit": m.unit, "description": m.description })))
        .collect();
    let (cells, population) = (last_cells(result), last_population(result));
    let types: Vec<Value> =
        count_types(layout, &cells).into_iter().map(|(name, count)| json!({ "name": name, "cells": count })).collect();
    let systems: Vec<Value> = layout.systems.iter().map(|system| system_json(result, system)).collect::<Result<_>>()?;
    let mut datasets = Vec::new();
    list_datasets(result.file(), "", &mut datasets)
        .map_err(|error| super::container::damaged(result.path(), &error.to_string()))?;
    Ok(json!({
        "path": result.path().display().to_string(),
        "bytes": bytes(result),
        "header": header,
        "finished": ending.finished,
        "running": ending.running,
        "wall_time": ending.wall_time,
        "resumed": ending.resumed,
        "cells": cells.len(),
        "cells_in_all": result.known_cells().len(),
        "types": types,
        "atoms": population.count(Part::Atoms),
        "facets": population.count(Part::Facets),
        "links": population.count(Part::Links),
        "fields": layout.fields.iter().map(field_json).collect::<Vec<_>>(),
        "chemistry": systems,
        "membranes": layout.membranes.iter().map(|m| json!({ "name": m.name, "unit": m.unit })).collect::<Vec<_>>(),
        "planes": layout.obstacles.iter().map(|obstacle| &obstacle.name).collect::<Vec<_>>(),
        "frames": result.frames(),
        "frames_within_steps": within(result)?,
        "time": { "first": times[0], "last": times[times.len() - 1], "unit": "s" },
        "step": { "first": steps[0], "last": steps[steps.len() - 1] },
        "summary": summary,
        "datasets": datasets,
    }))
}

/// Names with their units.
fn described(named: &[(String, String)]) -> String {
    let one = |(name, unit): &(String, String)| match unit.as_str() {
        "" | "1" => name.clone(),
        unit => format!("{name} ({unit})"),
    };
    named.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn describe_field(field: &FieldLayout) -> String {
    let shown = |numbers: [String; 3]| if field.is_flat() { numbers[..2].join(" x ") } else { numbers.join(" x ") };
    let boxes = shown(field.cells.map(|n| n.to_string()));
    let sizes = shown(field.spacing.map(|h| crate::error::short(h).to_string()));
    format!("{}: {}; {boxes} boxes of {sizes} um", field.name, described(&field.species))
}

fn named_json(named: &[(String, String)]) -> Vec<Value> {
    named.iter().map(|(name, unit)| json!({ "name": name, "unit": unit })).collect()
}

fn field_json(field: &FieldLayout) -> Value {
    json!({
        "name": field.name,
        "species": named_json(&field.species),
        "boxes": field.cells,
        "spacing": field.spacing,
        "origin": field.origin,
        "length_unit": "um",
    })
}

fn system_json(result: &ResultFile, system: &SystemLayout) -> Result<Value> {
    let quantities = named_json(&system.quantities);
    Ok(json!({ "name": system.name, "cells": members(result, system)?, "quantities": quantities }))
}

/// Cells that have a system in the last frame; none for a system of the scene. One without quantities leaves no trace.
fn members(result: &ResultFile, system: &SystemLayout) -> Result<Option<usize>> {
    if system.scope == SystemScope::Scene {
        return Ok(None);
    }
    let Some((quantity, _)) = system.quantities.first() else { return Ok(Some(0)) };
    let values = result.cell_values(&format!("{}.{quantity}", system.name), result.frames() - 1)?;
    Ok(Some(values.iter().filter(|value| !value.is_nan()).count()))
}

/// The cells of the last frame.
fn last_cells(result: &ResultFile) -> Vec<Cell> {
    result.cells(result.frames() - 1)
}

fn last_population(result: &ResultFile) -> Population {
    Population::of(result.layout(), &last_cells(result))
}

/// Cells of every type.
fn count_types(layout: &Layout, cells: &[Cell]) -> Vec<(String, usize)> {
    let count = |kind: usize| cells.iter().filter(|cell| cell.kind as usize == kind).count();
    layout.types.iter().enumerate().map(|(number, kind)| (kind.name.clone(), count(number))).collect()
}

/// Size of the file; 0 if the system does not say.
fn bytes(result: &ResultFile) -> u64 {
    std::fs::metadata(result.path()).map_or(0, |known| known.len())
}

fn readable_size(bytes: u64) -> String {
    let (mut size, mut units) = (bytes as f64, ["B", "kB", "MB", "GB", "TB"].into_iter());
    let mut unit = units.next().unwrap_or("B");
    while size >= 1000.0
        && let Some(next) = units.next()
    {
        (size, unit) = (size / 1000.0, next);
    }
    if unit == "B" { format!("{bytes} B") } else { format!("{size:.1} {unit}") }
}

/// All datasets below a group, by path.
fn list_datasets(group: &Group, path: &str, into: &mut Vec<Value>) -> hdf5::Result<()> {
    for name in group.member_names()? {
        let path = format!("{path}/{name}");
        let Ok(dataset) = group.dataset(&name) else {
            list_datasets(&group.group(&name)?, &path, into)?;
            continue;
        };
        into.push(json!({
            "path": path,
            "shape": dataset.get_shape()?,
            "dtype": dataset.dtype()?.to_descriptor()?.to_string(),
            "unit": text(&dataset, "unit").unwrap_or_default(),
            "description": text(&dataset, "description").unwrap_or_default(),
        }));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::readable_size;

    #[test]
    fn sizes_are_readable() {
        assert_eq!(readable_size(999), "999 B");
        assert_eq!(readable_size(1_250_000), "1.2 MB");
    }
}
