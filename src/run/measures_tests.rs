//! What the way from a result file to its measures promises.

use super::measure_result;
use crate::analysis::{check_result, claims};
use crate::experiment::Document;
use crate::output::{Cell, CellRecord, CellType, Frame, Header, Layout, Measure, Overwrite, ResultFile, ResultWriter};
use std::path::Path;

const EXPERIMENT: &str = r#"
title = "Two cells pulled"
[run]
until = "10 s"
[cells.red]
number = 2
mesh = { shape = "icosphere", radius = "5 um", level = 0 }
[cells.red.mechanics]
drag = "20 pN s/um"
shape_memory = { stiffness = "10 pN/um" }
[[cells.red.loads]]
name = "pull"
cap = { direction = [1, 0, 0], fraction = 0.1 }
direction = [1, 0, 0]
force = [["0 s", "0 pN"], ["3 s", "6 pN"]]
[measure.stretch]
kind = "slope"
x = "load.pull"
y = "size_x"
scale = 1000
unit = "nm/pN"
description = "how far a pN stretches"
[measure.late]
kind = "value"
series = "volume"
time = "5 s"
description = "volume half-way"
"#;

/// Two cells of one atom whose extents along x are 4 + t and 6 + t/2 while 2t pN pull, from 0 to 3 s.
fn recorded(path: &Path) -> ResultFile {
    let cell = |id| Cell { id, ..Cell::default() };
    let layout = Layout {
        types: vec![CellType { name: "red".into(), atoms: 1, ..CellType::default() }],
        scene_series: vec![("load.pull".into(), "pN".into())],
        ..Layout::default()
    };
    let header = Header::now("pull.toml", "Two cells pulled", EXPERIMENT, &[], 0);
    let mut writer = ResultWriter::create(path, &header, &layout, Overwrite::Refuse).unwrap();
    for step in 0..4_u32 {
        let time = f64::from(step);
        let record = |length: f64| CellRecord { size: [length, 1.0, 1.0], ..CellRecord::default() };
        let frame = Frame {
            time,
            step: u64::from(step),
            positions: vec![[0.0; 3]; 2],
            cells: vec![cell(0), cell(1)],
            records: vec![record(4.0 + time), record(6.0 + time / 2.0)],
            scene: vec![2.0 * time],
            ..Frame::default()
        };
        writer.append(&frame).unwrap();
    }
    let stretch = Measure { name: "stretch".into(), value: 375.0, unit: "nm/pN".into(), description: String::new() };
    writer.write_summary(&[stretch]);
    writer.renew().unwrap();
    drop(writer);
    ResultFile::open(path).unwrap()
}

#[test]
fn measures_come_from_the_file_with_scale_and_unit() {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("pull.h5"));
    let document = Document::parse("pull.toml", EXPERIMENT, folder.path(), &[]).unwrap();
    let (measures, _) = measure_result(&file, &document).unwrap();
    assert_eq!(measures[0].name, "stretch");
    // The mean extent grows by 0.75 µm a second and the load by 2 pN.
    assert!((measures[0].value - 375.0).abs() < 1e-9, "{:?}", measures[0]);
    assert_eq!(measures[0].unit, "nm/pN");
    assert_eq!(measures[0].description, "how far a pN stretches");
}

#[test]
fn a_measure_that_cannot_be_taken_costs_no_other_and_says_where_it_stands() {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("pull.h5"));
    let document = Document::parse("pull.toml", EXPERIMENT, folder.path(), &[]).unwrap();
    let (measures, faults) = measure_result(&file, &document).unwrap();
    assert_eq!((measures.len(), faults.len()), (1, 1));
    assert_eq!(faults[0].message, "the measure `late` cannot be computed: nothing was recorded at 5 s");
    let location = faults[0].location.as_ref().unwrap();
    assert_eq!(&EXPERIMENT[location.start..location.start + location.length], "late");
}

#[test]
fn claims_are_held_against_what_the_file_stores() {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("pull.h5"));
    let text = "[[claim]]\nmeasure = \"stretch\"\nat_least = 370\nat_most = 380\nsource = \"by hand\"\n\
                [[claim]]\nmeasure = \"late\"\nat_most = 1\nsource = \"by hand\"\n";
    let results = check_result(&file, &claims::parse("expected.toml", text).unwrap()).unwrap();
    let lines: Vec<String> = results.iter().map(ToString::to_string).collect();
    assert_eq!(lines[0], "stretch = 375 nm/pN (from 370 to 380)");
    assert_eq!(lines[1], "late is not measured (at most 1)");
    assert_eq!(results.iter().map(claims::ClaimResult::holds).collect::<Vec<_>>(), [true, false]);
}
