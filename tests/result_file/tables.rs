//! Tables for spreadsheets say what the file says, to the last digit.

use super::example::{cells, frame, write};
use pseudopod::analysis::recording::{POSITION, Recording};
use pseudopod::analysis::tracks::read::Options;
use pseudopod::analysis::tracks::{Tracks, package, read};
use pseudopod::output::biotracks::write_biotracks;
use pseudopod::output::{ResultFile, Table, table_text};
use std::collections::BTreeSet;

/// A table of a result with three cells and four frames, as rows of fields.
fn rows(table: &Table) -> Vec<Vec<String>> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    drop(write(&path, 3, 4));
    let text = table_text(&ResultFile::open(&path).unwrap(), table).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn a_table_of_series_has_a_row_per_frame_and_cell_with_every_digit() {
    let names = ["area", "load.pull", "principal_3"].map(str::to_owned).to_vec();
    let rows = rows(&Table::Series(names));
    let titles = ["frame", "time (s)", "cell", "type", "area (um^2)", "load.pull (pN)", "principal_3 (um)"];
    assert_eq!(rows[0], titles);
    assert_eq!(rows.len(), 1 + 4 * 3);
    let (wanted, row) = (frame(&cells(3), 2), &rows[1 + 2 * 3 + 1]);
    assert_eq!(row[..4], ["2", "0.5", "1", "lone"]);
    let numbers: Vec<f64> = row[4..].iter().map(|field| field.parse().unwrap()).collect();
    assert_eq!(numbers, [wanted.records[1].area, wanted.scene[1], wanted.records[1].principal[2]]);
}

#[test]
fn a_table_without_names_has_all_series_in_columns_of_equal_number() {
    let rows = rows(&Table::Series(Vec::new()));
    assert!(
        ["volume (um^3)", "speed (um/s)", "wall.height (um)"].iter().all(|title| rows[0].iter().any(|t| t == title))
    );
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
}

#[test]
fn tracks_and_runs_are_those_that_were_recorded() {
    let tracks = rows(&Table::Tracks);
    let wanted = frame(&cells(3), 3).records[2].position;
    assert_eq!(tracks[0].join(","), "TRACK_ID,FRAME,POSITION_T,POSITION_X,POSITION_Y,POSITION_Z,TYPE");
    let last = tracks.last().unwrap();
    assert_eq!((last[..3].join(","), last[6].as_str()), ("2,3,0.75".to_owned(), "round"));
    let found: Vec<f64> = last[3..6].iter().map(|field| field.parse().unwrap()).collect();
    assert_eq!(found, wanted);
    // Track by track, and each from its first frame to its last.
    let order: Vec<String> = tracks[1..].iter().map(|row| row[..2].join(",")).collect();
    assert_eq!(order[..5], ["0,0", "0,1", "0,2", "0,3", "1,0"]);
    let runs = rows(&Table::Runs);
    assert_eq!(runs[1], ["1", "0.25", "0.125"]);
    assert_eq!(runs.len(), 4, "a run ended in every frame but the first");
}

#[test]
fn tracks_are_read_back_from_both_layouts_as_they_were_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    drop(write(&path, 3, 4));
    let result = ResultFile::open(&path).unwrap();
    let recorded = Tracks::of(&Recording::read(&result, &POSITION).unwrap(), None).unwrap();
    let csv = read::parse("tracks.csv", &table_text(&result, &Table::Tracks).unwrap(), &Options::default()).unwrap();
    assert_eq!(csv.tracks, recorded);
    let files = write_biotracks(&result, &folder.path().join("dp")).unwrap();
    assert_eq!(files.len(), 4);
    let description = package::description(&folder.path().join("dp")).unwrap();
    let back = package::read(&description, &Options::default()).unwrap();
    assert_eq!(
        (&back.tracks.positions, &back.tracks.times, &back.tracks.names),
        (&recorded.positions, &recorded.times, &recorded.names)
    );
    assert!(back.notes.is_empty(), "{:?}", back.notes);
    // What the layout asks for: objects are unique, and every link and track names something that is there.
    let lines = |name: &str| -> Vec<Vec<String>> {
        let text = std::fs::read_to_string(folder.path().join("dp").join(name)).unwrap();
        text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
    };
    let (objects, links, tracks) = (lines("objects.csv"), lines("links.csv"), lines("tracks.csv"));
    assert_eq!(objects[0][..5], ["cmso_object_id", "cmso_frame_id", "cmso_x_coord", "cmso_y_coord", "cmso_z_coord"]);
    assert_eq!(
        (links[0].join(","), tracks[0].join(",")),
        ("cmso_link_id,cmso_object_id".into(), "cmso_track_id,cmso_link_id".into())
    );
    let ids: BTreeSet<&str> = objects[1..].iter().map(|row| row[0].as_str()).collect();
    assert_eq!(ids.len(), objects.len() - 1);
    assert!(links[1..].iter().all(|row| ids.contains(row[1].as_str())));
    let of_links: BTreeSet<&str> = links[1..].iter().map(|row| row[0].as_str()).collect();
    assert!(tracks[1..].iter().all(|row| of_links.contains(row[1].as_str())));
}

#[test]
fn a_table_of_contacts_names_both_sides_and_the_plane() {
    let rows = rows(&Table::Contacts);
    assert_eq!(rows[0], ["frame", "time (s)", "cell", "type", "other", "type or plane", "area (um^2)"]);
    let frames: Vec<_> = (0..4).map(|number| frame(&cells(3), number)).collect();
    let number: usize = frames.iter().map(|frame| frame.pairs.len() + frame.on_planes.len()).sum();
    assert_eq!(rows.len(), 1 + number);
    assert_eq!(rows[1], ["0", "0", "0", "round", "1", "lone", "1"]);
    assert_eq!(rows.last().unwrap()[..], ["3", "0.75", "1", "lone", "", "floor", "1.5"]);
}
