//! What the measures of fields and of chemistry promise, on made-up result files with known answers.

use super::super::measure_result;
use crate::experiment::Document;
use crate::output::{
    Cell, CellRecord, CellType, FieldLayout, Frame, Header, Layout, Overwrite, ResultFile, ResultWriter, SystemLayout,
    SystemScope,
};
use std::f64::consts::TAU;
use std::path::Path;

const CELLS: &str = r#"
title = "Two kinds of amoebae"
[run]
until = "100 s"
[cells.amoeba]
number = 6
mesh = { shape = "icosphere", radius = "5 um", level = 0 }
mechanics = { drag = "20 pN s/um" }
[cells.rock]
number = 2
mesh = { shape = "icosphere", radius = "5 um", level = 0 }
mechanics = { drag = "20 pN s/um" }
"#;

/// Where a cell is at a time. Amoebae begin at 10, 20, … µm from the origin along x and go to it at 0.1 µm/s, the odd ones
/// in zigzag, so that they come 3 µm nearer on a way of 5 µm; rocks stand still.
fn position(cell: usize, frame: usize) -> [f64; 3] {
    let begin = 10.0 * (cell + 1) as f64;
    match cell {
        6.. => [begin, 0.0, 1.0],
        _ if cell.is_multiple_of(2) => [begin - 0.1 * frame as f64, 0.0, 1.0],
        _ => [begin - 0.06 * frame as f64, if frame.is_multiple_of(2) { 0.0 } else { 0.08 }, 1.0],
    }
}

/// The concentration in an amoeba: a wave of 30 s from the origin at 4 µm/s, at the places where the cells began.
fn inside(cell: usize, time: f64) -> f64 {
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
    let header = Header::now("amoebae.toml", "Amoebae", CELLS, &[], 0);
    let mut writer = ResultWriter::create(path, &header, &layout, Overwrite::Refuse).unwrap();
    for frame in 0..=100 {
        let time = frame as f64;
        let stripes = |at: usize| (TAU * (at % 30) as f64 / 5.0).cos();
        let record = |cell: usize| CellRecord { position: position(cell, frame), ..CellRecord::default() };
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
fn measured(keys: &str) -> Result<f64, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("amoebae.h5"));
    taken(&file, keys)
}

fn taken(file: &ResultFile, keys: &str) -> Result<f64, String> {
    let text = format!("{CELLS}[measure.it]\n{}", keys.replace("; ", "\n"));
    let document = Document::parse("amoebae.toml", &text, Path::new("."), &[]).map_err(|error| error.to_string())?;
    let (measures, faults) = measure_result(file, &document).unwrap();
    match faults.as_slice() {
        [] => Ok(measures[0].value),
        [fault, ..] => Err(format!("{}; {}", fault.message, fault.help.clone().unwrap_or_default())),
    }
}

/// Takes measures of one file and holds each against its value.
fn all_are(expected: &[(&str, f64, f64)]) {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("amoebae.h5"));
    for (keys, value, tolerance) in expected {
        let found = taken(&file, keys).unwrap_or_else(|fault| panic!("{keys}: {fault}"));
        assert!((found - value).abs() <= *tolerance, "{keys}: {found} instead of {value}");
    }
}

#[test]
fn series_of_chemistry_are_reduced_like_others_over_the_cells_that_have_them() {
    let mean = (0..6).map(|cell| inside(cell, 20.0)).sum::<f64>() / 6.0;
    let swing = "kind = 'value'; series = 'chemistry.oscillator.cAMP'; time = '20 s'";
    all_are(&[
        (swing, mean, 1e-12),
        (&format!("{swing}; cells = 'amoeba'; over = 'first'"), inside(0, 20.0), 1e-12),
        ("kind = 'value'; series = 'oscillator.cAMP'; time = '20 s'", mean, 1e-12),
        ("kind = 'value'; series = 'chemistry.clock.tick'; time = '25 s'", 0.0, 1e-12),
        ("kind = 'slope'; x = 'chemistry.clock.tick'; y = 'chemistry.clock.tick'", 1.0, 1e-12),
    ]);
}

#[test]
fn fields_are_read_at_points_and_over_all_boxes() {
    // Boxes of the medium are numbered x fastest; a step along x, y, z adds 1, 4, 12; a second adds 1.
    let medium = |rest: &str| format!("kind = 'field_value'; field = 'medium'; {rest}");
    all_are(&[
        (&medium("at = ['1 um', '0.5 um', '1.5 um']; time = 'first'"), 0.0, 0.0),
        (&medium("at = ['2 um', '1.25 um', '3 um']; time = '10 s'"), 0.5 + 3.0 + 6.0 + 10.0, 1e-6),
        (&medium("at = ['2 um', '1.25 um', '3 um']; time = '10.5 s'"), 0.5 + 3.0 + 6.0 + 10.5, 1e-6),
        (&medium("time = 'mean'"), 11.5 + 50.0, 1e-5),
        (&medium("over = 'min'"), 100.0, 0.0),
        (&medium("over = 'max'; time = 'range'"), 100.0, 0.0),
        (&medium("over = 'amount'; time = 'first'"), 11.5 * 24.0 * 6.0, 1e-9),
        ("kind = 'field_value'; field = 'medium.attractant'; over = 'max'; time = '100 s'", 123.0, 0.0),
        ("kind = 'field_value'; field = 'front'; at = ['5.5 um', '4.25 um', '9 um']", 2.0, 1e-5),
    ]);
}

#[test]
fn chemotactic_indices_are_one_for_straight_paths_and_the_cosine_for_zigzags() {
    let index = |rest: &str| format!("kind = 'chemotactic_index'; towards = ['0 um', '0 um', '0 um']; {rest}");
    // Three cells go straight; three come 0.06 µm nearer on each step of 0.1 µm.
    let error = 0.2 * (6.0_f64 / 5.0 / 6.0).sqrt();
    all_are(&[
        (&index("cells = 'amoeba'"), 0.8, 1e-12),
        // Rocks have no way and do not count; an even number of frames leaves no zigzag.
        (&index("from = '10 s'; to = '60 s'"), 0.8, 1e-12),
        (&index("statistic = 'standard_error'"), error, 1e-12),
        (&index("statistic = 'standard_deviation'"), error * 6.0_f64.sqrt(), 1e-12),
        ("kind = 'chemotactic_index'; towards = ['1 km', '0 um', '0 um']; space = 'volume'", -0.8, 1e-6),
    ]);
}

#[test]
fn periods_are_found_in_cells_and_in_the_scene() {
    let period = |rest: &str| format!("kind = 'period'; series = 'chemistry.{rest}");
    all_are(&[
        (&period("oscillator.cAMP'"), 30.0, 1e-2),
        (&period("oscillator.cAMP'; cell = 3"), 30.0, 1e-2),
        (&period("oscillator.cAMP'; cells = 'amoeba'; statistic = 'standard_error'"), 0.0, 1e-2),
        // A growing swing has its middle elsewhere than its zeros, which all periods share but the first.
        (&period("clock.tick'; from = '30 s'"), 12.5, 0.3),
    ]);
}

#[test]
fn waves_have_their_speed_in_cells_and_in_fields() {
    let cells = |rest: &str| {
        format!("kind = 'wave_speed'; centre = ['0 um', '0 um', '0 um']; series = 'chemistry.oscillator.cAMP'; {rest}")
    };
    let field = |rest: &str| {
        format!("kind = 'wave_speed'; centre = ['5 um', '4 um', '0 um']; field = 'front'; level = 1; {rest}")
    };
    all_are(&[
        // The wave passes places 10 µm apart every 2.5 s; the cells have meanwhile come nearer by less than 3 µm.
        (&cells("from = '8 s'"), 4.0, 0.2),
        (&cells("from = '8 s'; statistic = 'r_squared'"), 1.0, 1e-3),
        (&field(""), 0.25, 1e-3),
        (&field("direction = [1, 0, 0]; distance_from = '2 um'"), 0.25, 2e-3),
        (&field("direction = [-1, 1, 0]; distance_from = '2 um'"), 0.25, 5e-3),
        (&field("from = '20 s'; distance_to = '20 um'"), 0.25, 1e-3),
        (&field("statistic = 'r_squared'"), 1.0, 1e-4),
        (&field("statistic = 'standard_error'"), 0.0, 1e-3),
    ]);
}

#[test]
fn the_wavelength_is_that_of_the_species_asked_for() {
    let found = measured("kind = 'wavelength'; field = 'front.back'; time = '50 s'").unwrap();
    // The shorter side holds no more than two of them.
    assert!((found / 5.0 - 1.0).abs() < 3e-3, "{found}");
}

#[test]
fn a_field_that_was_not_recorded_is_not_measured() {
    let fault = super::super::fields::Fields::default().field("front").err().unwrap();
    assert_eq!(fault.to_string(), "there is no field \"front\" in this run");
}
