//! Pseudopods of a made-up run with known answers.

use super::super::{Finished, Measure};
use crate::analysis::recording::Recording;
use crate::output::{
    Cell, CellRecord, CellType, Frame, Header, Layout, Overwrite, PseudopodEvent, ResultFile, ResultWriter,
};
use std::path::Path;

/// Where pseudopods of two cells point, degrees: one that splits off by 60 to the left and the right in turns, but once to the left again,
/// and one that turns by 90 to the left.
const DIRECTIONS: [&[f64]; 2] = [&[0.0, 60.0, 0.0, 60.0, 120.0], &[0.0, 90.0, 180.0]];

fn recorded(path: &Path) -> ResultFile {
    let kind = |name: &str| CellType { name: name.into(), atoms: 1, ..CellType::default() };
    let layout = Layout { types: vec![kind("amoeba"), kind("rock")], ..Layout::default() };
    let header = Header::now("pods.toml", "Pods", "", &[], 0);
    let mut writer = ResultWriter::create(path, &header, &layout, Overwrite::Refuse).unwrap();
    for number in 0..=10_usize {
        let time = 10.0 * number as f64;
        let pod = |cell: usize| {
            let degrees = *number.checked_sub(1).and_then(|number| DIRECTIONS[cell].get(number))?;
            let before = number.checked_sub(2).map(|number| DIRECTIONS[cell][number]);
            Some(PseudopodEvent {
                cell: cell as u64,
                end: time - 1.0,
                lifetime: 4.0 + cell as f64,
                direction: [degrees.to_radians().cos(), degrees.to_radians().sin(), 0.0],
                turn: before.map_or(f64::NAN, |before| (degrees - before).abs()),
                side: before.map_or(0, |before| (degrees - before).signum() as i8),
                alone: number % 3 != 0,
                abandoned: number % 2 == 0,
            })
        };
        let frame = Frame {
            time,
            step: number as u64,
            cells: (0..3).map(|id| Cell { id, kind: u32::from(id == 2), parent: None }).collect(),
            positions: vec![[0.0; 3]; 3],
            records: vec![CellRecord::default(); 3],
            pseudopods: (0..2).filter_map(pod).collect(),
            ..Frame::default()
        };
        writer.append(&frame).unwrap();
    }
    writer.finish(1.0).unwrap();
    ResultFile::open(path).unwrap()
}

#[test]
fn pseudopods_are_counted_timed_and_turned_as_they_were_made() {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("pods.h5"));
    let taken = |keys: &str| {
        let measure: Measure = toml::from_str(&format!("kind = 'pseudopods'\n{}", keys.replace("; ", "\n"))).unwrap();
        let recording = Recording::read(&file, &measure.kind.series()).unwrap();
        let run = Finished { recording: &recording, file: Some(&file), resolve: &Path::to_path_buf };
        measure.kind.evaluate(&run).unwrap()
    };
    let expected = [
        ("cells = 'amoeba'", 8.0 / 200.0),
        // The rock is followed, too.
        ("", 8.0 / 300.0),
        ("cells = 'amoeba'; from = '20 s'; to = '40 s'", 4.0 / 40.0 - 1.0 / 40.0),
        ("cells = 'amoeba'; statistic = 'at_once'", (5.0 * 4.0 + 3.0 * 5.0) / 200.0),
        ("statistic = 'lifetime'", 4.0),
        ("statistic = 'angle'", 60.0),
        ("statistic = 'split_share'", 6.0 / 8.0),
        ("statistic = 'alternation'", 2.0 / 4.0),
        ("statistic = 'alone_share'", 6.0 / 8.0),
        ("statistic = 'abandoned_share'", 3.0 / 8.0),
        // Two, three or four heads of four coins.
        ("statistic = 'alternation_p'", 11.0 / 16.0),
    ];
    for (keys, value) in expected {
        let found = taken(keys);
        assert!((found - value).abs() < 1e-9, "{keys}: {found} instead of {value}");
    }
    assert!(taken("cells = 'rock'; statistic = 'angle'").is_nan());
    let first = &file.pseudopods().unwrap()[0];
    assert!(first.turn.is_nan() && (first.cell, first.side) == (0, 0));
}
