//! Reads tracks from a package in the layout of biotracks (CMSO): a folder with a description and tables of objects and links.

use super::assemble::{Spot, assemble};
use super::head::unit_sign;
use super::read::{Options, Read};
use crate::analysis::table::Table;
use crate::error::{Error, Fault, Result, Source};
use crate::output::biotracks::{
    DESCRIPTIONS, FRAME_ID, LINK_ID, LINKS_TABLE, OBJECT_ID, OBJECTS_TABLE, SPACE_UNIT, TIME, TIME_UNIT, X, Y, Z,
};
use crate::units::{Length, Time};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The description of a package: the path itself, or the file of that sort in the folder.
pub fn description(path: &Path) -> Option<PathBuf> {
    let is = |path: &Path| path.file_name().is_some_and(|name| DESCRIPTIONS.iter().any(|known| name == *known));
    if is(path) {
        return Some(path.to_path_buf());
    }
    DESCRIPTIONS.iter().map(|name| path.join(name)).find(|path| path.is_file())
}

/// Reads the links of a package, each as a track: a track of the package may be several links, where cells divide. Objects in no link are passed over.
///
/// # Errors
/// A description or table that cannot be read or lacks what the layout asks for, times that are not known, and as [`assemble`].
pub fn read(description: &Path, options: &Options) -> Result<Read> {
    let name = description.display().to_string();
    let text = crate::files::read_text(description)
        .map_err(|error| fault(format!("{name} cannot be read: {error}"), "give the folder of a biotracks package"))?;
    let package: Value = serde_json::from_str(&text).map_err(|error| {
        fault(format!("{name} is not JSON: {error}"), "give the description of a biotracks package")
    })?;
    let table = |wanted: &str| -> Result<Table> {
        let resources = package["resources"].as_array().map_or(&[][..], Vec::as_slice);
        let found =
            resources.iter().find(|resource| resource["name"] == wanted).and_then(|resource| resource["path"].as_str());
        let path = found.ok_or_else(|| {
            fault(
                format!("{name} has no resource \"{wanted}\" with a path"),
                "a biotracks package has cmso_objects_table and cmso_links_table",
            )
        })?;
        Table::read(&description.with_file_name(path))
    };
    let mut notes = Vec::new();
    let mut unit = |key: &str, option: &str, base: &str, known: Option<f64>, parse: &dyn Fn(&str) -> Option<f64>| match (
        known,
        package[key].as_str(),
    ) {
        (Some(known), _) => Ok(known),
        (None, Some(said)) => parse(&format!("1 {}", unit_sign(said))).ok_or_else(|| {
            fault(
                format!("{name} says that its {key} is \"{said}\""),
                &format!("say what that is with {option} \"{base}\" or the like"),
            )
        }),
        (None, None) => {
            notes.push(format!(
                "{key} is taken to be {}; if it is not, add {option}",
                base.trim_start_matches(|c: char| !c.is_alphabetic())
            ));
            Ok(1.0)
        }
    };
    let length_unit = unit(SPACE_UNIT, "--length-unit", "0.65 um", options.length_unit, &|text| {
        text.parse::<Length>().ok().map(Length::value)
    })?;
    let (objects, links) = (table(OBJECTS_TABLE)?, table(LINKS_TABLE)?);
    let times: Vec<f64> = match (options.interval, objects.names().iter().any(|known| known == TIME)) {
        (Some(interval), _) => objects.column(FRAME_ID)?.iter().map(|frame| frame * interval).collect(),
        (None, true) => {
            let time_unit = unit(TIME_UNIT, "--time-unit", "s", options.time_unit, &|text| {
                text.parse::<Time>().ok().map(Time::value)
            })?;
            objects.column(TIME)?.iter().map(|time| time * time_unit).collect()
        }
        (None, false) => {
            return Err(fault(
                format!("{name} numbers its frames, but does not say when they were"),
                "add --interval, as in --interval \"30 s\"",
            ));
        }
    };
    let link_of: BTreeMap<u64, f64> = links
        .column(OBJECT_ID)?
        .iter()
        .zip(links.column(LINK_ID)?)
        .map(|(object, link)| (object.to_bits(), *link))
        .collect();
    let (ids, frames) = (objects.column(OBJECT_ID)?, objects.column(FRAME_ID)?);
    let (x, y) = (objects.column(X)?, objects.column(Y)?);
    let z = if objects.names().iter().any(|known| known == Z) { Some(objects.column(Z)?) } else { None };
    let (mut spots, mut alone) = (Vec::new(), 0);
    for row in 0..objects.rows() {
        let Some(link) = link_of.get(&ids[row].to_bits()) else {
            alone += 1;
            continue;
        };
        let position = [x[row], y[row], z.map_or(f64::NAN, |z| z[row])].map(|part| part * length_unit);
        if position[0].is_nan() || position[1].is_nan() || times[row].is_nan() || frames[row].is_nan() {
            return Err(fault(
                format!("the object {} of {name} has no frame or position", ids[row]),
                "give each object its frame, x and y",
            ));
        }
        spots.push(Spot {
            track: link.to_string(),
            kind: String::new(),
            frame: Some(frames[row]),
            time: times[row],
            position,
            row: 0..0,
        });
    }
    if alone > 0 {
        notes.push(format!("{alone} objects belong to no link and are passed over"));
    }
    let source = Arc::new(Source { name, text });
    Ok(Read { tracks: assemble(&spots, &source)?, notes })
}

fn fault(found: String, help: &str) -> Error {
    Error::input(Fault::new(found).help(help))
}
