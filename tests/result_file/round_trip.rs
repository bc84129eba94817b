//! What was written is read.

use pseudopod::output::{Frame, Layout, Measure, ResultFile, ResultWriter, catalogue, describe, to_json};
use pseudopod::recorded::OnDemand;

use crate::example::{cells, frame, header, layout, write};

/// Every number of every frame, exactly.
pub fn assert_holds(result: &ResultFile, frames: &[Frame]) {
    assert_eq!(result.frames(), frames.len());
    assert_eq!(*result.layout(), layout());
    let number = |name: &str| result.cell_series(name).unwrap();
    let (x, size, principal) = (number("position_x"), number("size_z"), number("principal_3"));
    let (volume, energy, speed) = (number("volume"), number("energy"), number("speed"));
    let (wall, pull) = (result.scene_series("wall.height").unwrap(), result.scene_series("load.pull").unwrap());
    let (times, steps) = (result.times().unwrap(), result.steps().unwrap());
    for (i, frame) in frames.iter().enumerate() {
        assert_eq!((times[i], steps[i]), (frame.time, frame.step));
        assert_eq!(result.cells(i), frame.cells, "cells of frame {i}");
        assert_eq!(result.positions(i).unwrap(), frame.positions, "positions of frame {i}");
        assert_eq!(result.forces(i).unwrap().unwrap_or_default(), frame.forces, "forces of frame {i}");
        assert_eq!([wall[i], pull[i]], frame.scene[..]);
        assert_eq!(result.pairs(i).unwrap(), frame.pairs, "pairs of frame {i}");
        assert_eq!(result.on_planes(i).unwrap(), frame.on_planes, "cells on planes in frame {i}");
        let volumes: Vec<f64> = frame.records.iter().map(|cell| cell.volume).collect();
        assert_eq!(result.cell_values("volume", i).unwrap(), volumes, "volumes of frame {i}");
        for ((cell, record), column) in frame.cells.iter().zip(&frame.records).zip(result.columns(i)) {
            let c = *column as usize;
            assert_eq!(result.known_cells()[c].cell, *cell);
            assert_eq!((x[[i, c]], size[[i, c]]), (record.position[0], record.size[2]));
            assert_eq!((volume[[i, c]], energy[[i, c]]), (record.volume, record.energy));
            assert_eq!(principal[[i, c]], record.principal[2]);
            let [u, v, w] = record.velocity;
            assert_eq!(speed[[i, c]], (u * u + v * v + w * w).sqrt());
        }
        let there = x.row(i).iter().filter(|x| !x.is_nan()).count();
        assert_eq!(there, frame.cells.len(), "cells that are not there have no numbers");
    }
    let runs: Vec<(u64, f64, f64)> = frames.iter().flat_map(|frame| frame.runs.clone()).collect();
    assert_eq!(result.runs().unwrap(), runs);
}

#[test]
fn a_finished_run_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    // 3 cells gather many frames in a piece; 1 500 cells take a compressed piece per frame. 600 frames fill several
    // pieces of 256 rows.
    for (number, frames) in [(3, 600), (1500, 3)] {
        let path = folder.path().join(format!("{number}.h5"));
        let mut writer = write(&path, number, frames);
        let measure =
            |name: &str, value| Measure { name: name.into(), value, unit: "um".into(), description: "How far.".into() };
        writer.write_summary(&[measure("reach", 1.0), measure("drift", 0.5)]);
        writer.write_summary(&[measure("reach", 2.5)]);
        writer.finish(12.5).unwrap();

        let result = ResultFile::open(&path).unwrap();
        let expected: Vec<Frame> = (0..frames).map(|index| frame(&cells(number), index)).collect();
        assert_holds(&result, &expected);
        assert_eq!(result.header().experiment, header().experiment);
        assert_eq!((result.ending().finished, result.ending().wall_time), (true, Some(12.5)));
        assert_eq!(result.summary().unwrap(), [measure("drift", 0.5), measure("reach", 2.5)]);
    }
}

#[test]
fn a_run_without_forces_has_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let frames: Vec<Frame> = (0..4).map(|number| Frame { forces: Vec::new(), ..frame(&cells(2), number) }).collect();
    let mut writer = write(&path, 2, 0);
    frames.iter().for_each(|frame| writer.append(frame).unwrap());
    writer.finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    assert_holds(&result, &frames);
    assert_eq!(result.forces(0).unwrap(), None);
}

#[test]
fn a_run_that_was_dropped_is_read_and_said_to_be_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    drop(write(&path, 2, 9));
    let result = ResultFile::open(&path).unwrap();
    assert_holds(&result, &(0..9).map(|number| frame(&cells(2), number)).collect::<Vec<_>>());
    assert!(!result.ending().finished);
    let page = describe(&result).unwrap();
    for words in ["A walk", "2 (1 round, 1 lone)", "12 atoms, 16 facets, 2 links", "9, from 0 s to 2 s", "interrupted"]
    {
        assert!(page.contains(words), "`{words}` is missing from\n{page}");
    }
}

#[test]
fn a_run_can_be_read_while_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let frames: Vec<Frame> = (0..8).map(|number| frame(&cells(2), number)).collect();
    let mut writer = write(&path, 2, 5);
    assert_holds(&writer.read().unwrap(), &frames[..5]);
    frames[5..].iter().for_each(|frame| writer.append(frame).unwrap());
    assert_holds(&writer.read().unwrap(), &frames);
    writer.finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    assert_holds(&result, &frames);
    assert_eq!(result.ending().resumed, 0);
}

#[test]
fn series_have_units_and_wrong_names_a_suggestion() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    write(&path, 1, 1).finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    let unit = |name: &str| result.units(name).unwrap();
    assert_eq!([unit("time"), unit("position_y"), unit("speed"), unit("volume")], ["s", "um", "um/s", "um^3"]);
    assert_eq!([unit("energy"), unit("load.pull"), unit("volume_error")], ["pN um", "pN", "1"]);
    for name in result.series_names() {
        assert_eq!(result.cell_series(&name).unwrap().dim(), (1, 1), "{name}");
    }
    let pseudopod::error::Error::Input(faults) = result.cell_series("position_w").unwrap_err() else {
        panic!("a wrong name is bad input")
    };
    assert!(faults[0].help.as_ref().unwrap().starts_with("did you mean `position_"), "{faults:?}");
    assert!(result.scene_series("volume").is_err());
}

#[test]
fn json_tells_all_but_the_arrays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let mut writer: ResultWriter = write(&path, 2, 5);
    let measure = Measure { name: "reach".into(), value: 2.0, unit: "um".into(), description: "How far.".into() };
    writer.write_summary(&[measure]);
    writer.save_checkpoint(40, 1.0, b"state").unwrap();
    writer.finish(1.0).unwrap();
    let json = to_json(&ResultFile::open(&path).unwrap()).unwrap();
    assert_eq!(json["summary"]["reach"]["value"], 2.0);
    assert_eq!(json["header"]["seed"], 7);
    assert_eq!((&json["frames"], &json["time"]["last"], &json["atoms"]), (&5.into(), &1.0.into(), &12.into()));
    let datasets = json["datasets"].as_array().unwrap();
    let listed = |path: &str| datasets.iter().find(|dataset| dataset["path"] == path);
    assert_eq!(listed("/cells/volume").unwrap()["unit"], "um^3");
    assert_eq!(listed("/cells/position").unwrap()["shape"], serde_json::json!([10, 3]));
    // Every dataset of the file has a unit and a description, and every row of the catalogue is in the file.
    for dataset in datasets {
        assert!(dataset["unit"] != "" && dataset["description"] != "", "{dataset}");
    }
    let of_cells: Vec<catalogue::Entry> = catalogue::cell_entries(OnDemand::default()).collect();
    let rows = catalogue::CATALOGUE.iter().chain(catalogue::CONTACT).chain(&of_cells);
    for entry in rows.filter(|entry| !entry.path.contains('<')) {
        assert!(listed(entry.path).is_some(), "{} is missing from the file", entry.path);
    }
}

#[test]
fn areas_between_types_follow_from_the_pairs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    write(&path, 7, 4).finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    let series = |name: &str| result.scene_series(name).unwrap();
    // Neighbours are of different types, `round` and `lone` by turns.
    for number in 0..4 {
        let frame = frame(&cells(7), number);
        let area: f64 = frame.pairs.iter().map(|pair| pair.area).sum();
        assert_eq!(series("contact.area.round.lone")[number], area);
        assert_eq!(series("contact.pairs.round.lone")[number], frame.pairs.len() as f64);
        // Cells 0, 2, 4, 6 are round and stand on the floor in even frames, the others in odd ones.
        assert_eq!(series("contact.area.round.floor")[number], if number % 2 == 0 { 6.0 } else { 0.0 });
    }
    assert_eq!(series("contact.heterotypic_share"), [1.0; 4]);
    assert_eq!(series("contact.clusters.lone"), [3.0; 4]);
    assert_eq!(result.units("contact.area.round.lone").unwrap(), "um^2");
    assert!(result.scene_names().iter().all(|name| result.scene_series(name).unwrap().len() == 4));
}

#[test]
fn a_run_without_contacts_says_so_when_it_is_asked_who_touches_whom() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let layout = Layout { contacts: false, ..layout() };
    let mut writer = ResultWriter::create(&path, &header(), &layout, pseudopod::output::Overwrite::Refuse).unwrap();
    writer.append(&frame(&cells(3), 0)).unwrap();
    writer.finish(1.0).unwrap();
    let result = ResultFile::open(&path).unwrap();
    assert!(result.pairs(0).unwrap_err().to_string().ends_with("does not say who touches whom"));
    assert!(!result.scene_names().iter().any(|name| name.starts_with("contact")));
    assert!(!result.layout().contacts);
}
