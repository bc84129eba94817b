//! Tracks in the layout of biotracks (Cell Migration Standardisation Organisation; Gonzalez-Beltran et al. 2020): a folder with a description in
//! JSON, a Tabular Data Package, and tables of objects (a cell in a frame), links (a cell from frame to frame) and tracks (links of one descent).

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::container::machine_error;
use super::{ResultFile, write_text};
use crate::error::Result;

/// What the description may be called, that of biotracks first.
pub const DESCRIPTIONS: [&str; 2] = ["dp.json", "datapackage.json"];
/// The table of objects.
pub const OBJECTS_TABLE: &str = "cmso_objects_table";
/// The table of links.
pub const LINKS_TABLE: &str = "cmso_links_table";
/// The table of tracks.
pub const TRACKS_TABLE: &str = "cmso_tracks_table";
/// The id of an object.
pub const OBJECT_ID: &str = "cmso_object_id";
/// The number of a frame.
pub const FRAME_ID: &str = "cmso_frame_id";
/// Where along x.
pub const X: &str = "cmso_x_coord";
/// Where along y.
pub const Y: &str = "cmso_y_coord";
/// Where along z.
pub const Z: &str = "cmso_z_coord";
/// When, which the layout does not know: frames of a simulation need not be at equal intervals.
pub const TIME: &str = "time";
/// The id of a link.
pub const LINK_ID: &str = "cmso_link_id";
/// The id of a track.
pub const TRACK_ID: &str = "cmso_track_id";
/// The key with the unit of length.
pub const SPACE_UNIT: &str = "cmso_space_unit";
/// The key with the unit of time.
pub const TIME_UNIT: &str = "cmso_time_unit";

/// Writes the tracks of a result into a folder, which is made if it lacks: `dp.json`, `objects.csv`, `links.csv` and `tracks.csv`. Returns their paths.
///
/// # Errors
/// A damaged result; [`crate::error::Error::Machine`] when a file cannot be written.
pub fn write_biotracks(result: &ResultFile, folder: &Path) -> Result<Vec<PathBuf>> {
    std::fs::create_dir_all(folder).map_err(|error| machine_error(folder, "cannot be made", &error.to_string()))?;
    let title = result.header().title.clone();
    let texts = [
        (DESCRIPTIONS[0], format!("{:#}\n", describe(&title))),
        ("objects.csv", objects(result)?),
        ("links.csv", links(result)),
        ("tracks.csv", tracks(result)),
    ];
    let mut paths = Vec::new();
    for (name, text) in texts {
        let path = folder.join(name);
        write_text(&text, &path)?;
        paths.push(path);
    }
    Ok(paths)
}

/// The cells and the frames that each has, cell by cell: the order of objects.
fn spots(result: &ResultFile) -> impl Iterator<Item = (usize, usize)> + '_ {
    result
        .known_cells()
        .iter()
        .enumerate()
        .flat_map(|(column, known)| known.frames.clone().map(move |frame| (column, frame)))
}

fn objects(result: &ResultFile) -> Result<String> {
    let times = result.times()?;
    let axes = ["position_x", "position_y", "position_z"].map(|name| result.cell_series(name));
    let [x, y, z] = axes;
    let (x, y, z) = (x?, y?, z?);
    let mut text = format!("{OBJECT_ID},{FRAME_ID},{X},{Y},{Z},{TIME}\n");
    for (object, (column, frame)) in spots(result).enumerate() {
        let at = [frame, column];
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{object},{frame},{},{},{},{}", x[at], y[at], z[at], times[frame]);
    }
    Ok(text)
}

/// A link is a cell, and has its id.
fn links(result: &ResultFile) -> String {
    let mut text = format!("{LINK_ID},{OBJECT_ID}\n");
    for (object, (column, _)) in spots(result).enumerate() {
        let _ = writeln!(text, "{},{object}", result.known_cells()[column].cell.id);
    }
    text
}

/// A track is a cell that was there from the start, or put in, with all that are descended from it.
fn tracks(result: &ResultFile) -> String {
    let mut text = format!("{TRACK_ID},{LINK_ID}\n");
    let mut roots: BTreeMap<u64, u64> = BTreeMap::new();
    for known in result.known_cells() {
        // Cells have larger ids than their parents. One that was gone before the first frame stands for its descent all the same.
        let cell = known.cell;
        let root = cell.parent.map_or(cell.id, |parent| roots.get(&parent).copied().unwrap_or(parent));
        roots.insert(cell.id, root);
        let _ = writeln!(text, "{root},{}", cell.id);
    }
    text
}

/// The description of the package.
fn describe(title: &str) -> Value {
    let field = |name: &str, kind: &str, description: &str| json!({ "name": name, "type": kind, "format": "default", "title": "", "description": description });
    let key = |name: &str| json!({ "name": name, "type": "integer", "format": "default", "title": "", "description": "", "constraints": { "unique": true } });
    let refers = |fields: &str, resource: &str| json!({ "fields": fields, "reference": { "datapackage": "", "resource": resource, "fields": fields } });
    let id = |name: &str| field(name, "integer", "");
    let coordinate = |name: &str| field(name, "number", "centre of volume, um");
    json!({
        "name": "cmso_tracks",
        "title": title,
        SPACE_UNIT: "um",
        TIME_UNIT: "s",
        "resources": [
            { "name": OBJECTS_TABLE, "path": "objects.csv", "schema": {
                "fields": [key(OBJECT_ID), field(FRAME_ID, "integer", ""), coordinate(X), coordinate(Y), coordinate(Z), field(TIME, "number", "time of the frame, s")],
                "primaryKey": OBJECT_ID } },
            { "name": LINKS_TABLE, "path": "links.csv", "schema": {
                "fields": [id(LINK_ID), id(OBJECT_ID)],
                "foreignKeys": [refers(OBJECT_ID, OBJECTS_TABLE)] } },
            { "name": TRACKS_TABLE, "path": "tracks.csv", "schema": {
                "fields": [id(TRACK_ID), id(LINK_ID)],
                "foreignKeys": [refers(LINK_ID, LINKS_TABLE)] } },
        ],
    })
}
