//! A made-up result file with known answers, on which measures of fields and of chemistry are tested.

use super::{Finished, Measure};
use crate::analysis::recording::Recording;
use crate::output::{
    Cell, CellRecord, CellType, FieldLayout, Frame, Header, Layout, Overwrite, ResultFile, ResultWriter, SystemLayout,
    SystemScope,
};
use std::f64::consts::TAU;
use std::path::Path;

/// Where a cell is at a time. Amoebae begin at 10, 20, … µm from the origin along x and go to it at 0.1 µm/s, the odd ones
/// in zigzag, so that they come 3 µm nearer on a path of 5 µm; rocks stand still.
fn position_of(cell: usize, frame: usize) -> [f64; 3] {
    let begin = 10.0 * (cell + 1) as f64;
    match cell {
        6.. => [begin, 0.0, 1.0],
        _ if cell.is_multiple_of(2) => [begin - 0.1 * frame as f64, 0.0, 1.0],
        _ => [begin - 0.06 * frame as f64, if frame.is_multiple_of(2) { 0.0 } else { 0.08 }, 1.0],
    }
}

/// The concentration in an amoeba: a wave of 30 s from the origin at 4 µm/s, at the points where the cells began.
pub fn inside(cell: usize, time: f64) -> f64 {
    5.0 - (TAU * (time - 2.5 * (cell + 1) as f64) / 30.0).cos()
}

/// A front that leaves x = 5, y = 4 in circles at 0.25 µm/s, in boxes of 1 × 0.5 µm.
fn front(layout: &FieldLayout, time: f64) -> Vec<f64> {
    let away = |at: usize| {
        let (x, y) = (at % layout.cells[0], at / layout.cells[0]);
        ((x as f64 + 0.5 - 5.0).powi(2) + (0.5 * (y as f64 + 0.5) - 4.0).powi(2)).sqrt()
    };
    (0..layout.len()).map(|at| 2.0 / (1.0 + (1.5 * (away(at) - 0.25 * time)).exp())).collect()
}

/// A hundred and one frames, a second apart.
fn recorded(path: &Path) -> ResultFile {
    let cell = |number: u32| Cell { id: u64::from(number), kind: number / 6, parent: None };
    let kind = |name: &str| CellType { name: name.into(), atoms: 1, ..CellType::default() };
    let species = |names: &[&str]| names.iter().map(|name| (name.to_string(), "uM".to_owned())).collect::<Vec<_>>();
    let field = |name: &str, names: &[&str], cells, spacing| FieldLayout {
        name: name.into(),
        species: species(names),
        cells,
        spacing,
        origin: [0.0; 3],
    };
    let systems = [("oscillator", SystemScope::Cells, "cAMP"), ("clock", SystemScope::Scene, "tick")];
    let layout = Layout {
        types: vec![kind("amoeba"), kind("rock")],
        fields: vec![
            field("front", &["front", "back"], [30, 20, 1], [1.0, 0.5, 1.0]),
            field("medium", &["attractant"], [4, 3, 2], [2.0, 1.0, 3.0]),
        ],
        systems: systems
            .into_iter()
            .map(|(name, scope, quantity)| SystemLayout { name: name.into(), scope, quantities: species(&[quantity]) })
            .collect(),
        ..Layout::default()
    };
    let header = Header::now("amoebae.toml", "Amoebae", "", &[], 0);
    let mut writer = ResultWriter::create(path, &header, &layout, Overwrite::Refuse).unwrap();
    for frame in 0..=100 {
        let time = frame as f64;
        let stripes = |at: usize| (TAU * (at % 30) as f64 / 5.0).cos();
        let record = |cell: usize| CellRecord { position: position_of(cell, frame), ..CellRecord::default() };
        let frame = Frame {
            time,
            step: frame as u64,
            positions: vec![[0.0; 3]; 8],
            cells: (0..8).map(cell).collect(),
            records: (0..8).map(record).collect(),
            fields: vec![
                vec![front(&layout.fields[0], time), (0..600).map(stripes).collect()],
                vec![(0..24).map(|at| at as f64 + time).collect()],
            ],
            systems: vec![
                vec![(0..8).map(|cell| if cell < 6 { inside(cell, time) } else { f64::NAN }).collect()],
                vec![vec![(TAU * time / 12.5).sin() * (1.0 + time)]],
            ],
            ..Frame::default()
        };
        writer.append(&frame).unwrap();
    }
    writer.finish(1.0).unwrap();
    ResultFile::open(path).unwrap()
}

/// Takes one measure, written as in a document.
pub fn measured(keys: &str) -> Result<f64, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("amoebae.h5"));
    taken(&file, keys)
}

fn taken(file: &ResultFile, keys: &str) -> Result<f64, String> {
    let measure: Measure = toml::from_str(&keys.replace("; ", "\n")).map_err(|error| error.to_string())?;
    let recording = Recording::read(file, &measure.kind.series()).map_err(|error| error.to_string())?;
    let run = Finished { recording: &recording, file: Some(file), resolve: &Path::to_path_buf };
    measure.kind.evaluate(&run).map_err(|error| error.to_string())
}

/// Takes measures of one file and holds each against its value.
pub fn all_are(expected: &[(&str, f64, f64)]) {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("amoebae.h5"));
    for (keys, value, tolerance) in expected {
        let found = taken(&file, keys).unwrap_or_else(|fault| panic!("{keys}: {fault}"));
        assert!((found - value).abs() <= *tolerance, "{keys}: {found} instead of {value}");
    }
}
