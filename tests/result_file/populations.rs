//! Cells come and go: every frame has its own, and a series has numbers of a cell where it is.

use std::path::Path;

use pseudopod::output::{Cell, Frame, Kept, ResultFile, ResultWriter, Table, describe, table_text, to_json};

use crate::example::{cells, frame, header, layout, lineage, write};
use crate::fields;
use crate::round_trip::assert_holds;

fn frames() -> Vec<Frame> {
    lineage().iter().enumerate().map(|(number, cells)| frame(cells, number)).collect()
}

fn write_lineage(path: &Path) -> ResultFile {
    let mut writer = write(path, 0, 0);
    frames().iter().for_each(|frame| writer.append(frame).unwrap());
    writer.finish(1.0).unwrap();
    ResultFile::open(path).unwrap()
}

#[test]
fn frames_with_different_cells_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let result = write_lineage(&folder.path().join("run.h5"));
    assert_holds(&result, &frames());
    assert!(!result.has_one_population());
    let lives: Vec<_> = result.known_cells().iter().map(|known| (known.cell.id, known.frames.clone())).collect();
    assert_eq!(lives, [(0, 0..3), (1, 0..3), (2, 1..4), (3, 1..3), (4, 5..6)]);
    assert_eq!(result.known_cells()[2].cell, Cell { id: 2, kind: 0, parent: Some(0) });
}

#[test]
fn frames_with_the_same_cells_share_what_they_are_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    drop(write_lineage(&path));
    let numbers = |path: &Path, dataset: &str| {
        hdf5::File::open(path).unwrap().dataset(dataset).unwrap().read_raw::<i64>().unwrap()
    };
    assert_eq!(numbers(&path, "/VTKHDF/Steps/PartOffsets"), [0, 1, 1, 2, 3, 4]);
    assert_eq!(numbers(&path, "/VTKHDF/NumberOfPoints"), [12, 24, 6, 0, 6]);
    let constant = folder.path().join("constant.h5");
    write(&constant, 7, 20).finish(1.0).unwrap();
    assert_eq!(numbers(&constant, "/VTKHDF/NumberOfPoints"), [42]);
    assert_eq!(numbers(&constant, "/VTKHDF/Polygons/Connectivity").len(), 7 * 8 * 3);
    assert_eq!(numbers(&constant, "/cells/id").len(), 7 * 20);
}

#[test]
fn a_run_that_grows_or_shrinks_beyond_the_pieces_of_its_first_frame_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    for (name, numbers) in
        [("grows", [1, 3, 2000, 2000, 1500]), ("shrinks", [2000, 1500, 1500, 2, 0]), ("seeded", [0, 0, 5, 1200, 1200])]
    {
        let path = folder.path().join(name);
        let frames: Vec<Frame> =
            numbers.iter().enumerate().map(|(index, number)| frame(&cells(*number), index)).collect();
        let mut writer = write(&path, 0, 0);
        frames[..4].iter().for_each(|frame| writer.append(frame).unwrap());
        drop(writer);
        let result = ResultFile::open(&path).unwrap();
        assert_holds(&result, &frames[..4]);
        drop(result);
        // Goes on after the third frame.
        let mut writer = ResultWriter::reopen(&path, &header(), &layout(), Kept::until(20)).unwrap();
        assert_eq!(writer.frames(), 3, "{name}");
        frames[3..].iter().for_each(|frame| writer.append(frame).unwrap());
        drop(writer);
        assert_holds(&ResultFile::open(&path).unwrap(), &frames);
    }
}

#[test]
fn a_run_resumed_anywhere_in_a_lineage_leaves_the_file_of_one_that_never_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let (path, frames) = (folder.path().join("run.h5"), frames());
    for kept in 1..frames.len() {
        let _ = std::fs::remove_file(&path);
        drop(write_lineage(&path));
        let mut writer =
            ResultWriter::reopen(&path, &header(), &layout(), Kept::until(10 * (kept as u64 - 1))).unwrap();
        assert_eq!(writer.frames(), kept);
        frames[kept..].iter().for_each(|frame| writer.append(frame).unwrap());
        writer.finish(1.0).unwrap();
        assert_holds(&ResultFile::open(&path).unwrap(), &frames);
        let file = hdf5::File::open(&path).unwrap();
        let points = file.dataset("/VTKHDF/NumberOfPoints").unwrap().read_raw::<i64>().unwrap();
        assert_eq!(points, [12, 24, 6, 0, 6], "resumed after {kept}");
    }
}

#[test]
fn systems_inside_cells_follow_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let create = pseudopod::output::Overwrite::Refuse;
    let mut writer = ResultWriter::create(&path, &header(), &fields::layout(), create).unwrap();
    let frames: Vec<Frame> = lineage().iter().enumerate().map(|(number, cells)| fields::frame(cells, number)).collect();
    frames.iter().for_each(|frame| writer.append(frame).unwrap());
    drop(writer);
    let result = ResultFile::open(&path).unwrap();
    let series = result.cell_series("brain.U").unwrap();
    for (number, frame) in frames.iter().enumerate() {
        for ((column, cell), value) in result.columns(number).iter().zip(&frame.cells).zip(&frame.systems[0][0]) {
            let found = series[[number, *column as usize]];
            assert_eq!(found.is_nan(), cell.kind == 1, "cells of the second type have no brain");
            assert!(found.is_nan() || found == *value);
        }
    }
}

#[test]
fn tables_and_pages_tell_of_the_cells_that_are_there() {
    let folder = tempfile::tempdir().unwrap();
    let result = write_lineage(&folder.path().join("run.h5"));
    let text = table_text(&result, &Table::Series(vec!["position_x".into()])).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows.len(), 1 + 2 + 4 + 4 + 1 + 1);
    assert_eq!(rows[4], "1,0.25,2,round,6.25");
    assert_eq!(rows.last(), Some(&"5,1.25,4,lone,13.25"));
    let page = describe(&result).unwrap();
    assert!(page.contains("1 (0 round, 1 lone) in the last frame, 5 in all"), "{page}");
    let json = to_json(&result).unwrap();
    assert_eq!((&json["cells"], &json["cells_in_all"], &json["atoms"]), (&1.into(), &5.into(), &6.into()));
    assert_eq!(result.scene_series("contact.pairs.round.lone").unwrap()[1..4], [2.0, 2.0, 0.0]);
}
