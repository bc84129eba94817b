//! Tables for spreadsheets say what the file says, to the last digit.

use super::example::{cells, frame, write};
use pseudopod::output::{ResultFile, Table, table_text};

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
    let found: Vec<f64> = tracks.last().unwrap()[4..].iter().map(|field| field.parse().unwrap()).collect();
    assert_eq!(found, wanted);
    let runs = rows(&Table::Runs);
    assert_eq!(runs[1], ["1", "0.25", "0.125"]);
    assert_eq!(runs.len(), 4, "a run ended in every frame but the first");
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
