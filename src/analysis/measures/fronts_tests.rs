//! Fronts of a made-up run with known answers.

use super::super::{Finished, Measure};
use crate::Vec3;
use crate::analysis::recording::Recording;
use crate::geometry::icosphere;
use crate::output::{
    Cell, CellRecord, CellType, Frame, Header, Layout, MembraneLayout, Overwrite, ResultFile, ResultWriter,
};
use std::path::Path;

/// Where there are fronts in each frame of a second, degrees around z: five, one after the other, of 4 s each with a second between
/// them; the last is split off from the fourth, which goes on.
fn fronts_at(frame: usize) -> Vec<f64> {
    match frame {
        1..=4 => vec![0.0],
        6..=9 => vec![60.0],
        11..=14 => vec![0.0],
        16..=19 => vec![60.0],
        20..=23 => vec![35.0, 110.0],
        _ => vec![],
    }
}

fn recorded(path: &Path) -> ResultFile {
    let ball = icosphere(5.0, 3);
    let (atoms, facets) = (ball.positions.len(), ball.facets.clone());
    let layout = Layout {
        types: vec![CellType { name: "amoeba".into(), atoms: atoms as u32, facets, ..CellType::default() }],
        membranes: vec![MembraneLayout { name: "pods.a".into(), unit: "1/um^2".into() }],
        ..Layout::default()
    };
    let mut writer =
        ResultWriter::create(path, &Header::now("pods.toml", "Pods", "", &[], 0), &layout, Overwrite::Refuse).unwrap();
    for frame in 0..=25 {
        let axes: Vec<Vec3> = fronts_at(frame)
            .into_iter()
            .map(|degrees| Vec3::new(degrees.to_radians().cos(), degrees.to_radians().sin(), 0.0))
            .collect();
        let density = |x: &Vec3| if axes.iter().any(|axis| x.normalize().dot(axis) > 0.85) { 3.0 } else { 1.0 };
        let frame = Frame {
            time: frame as f64,
            step: frame as u64,
            cells: vec![Cell { id: 0, kind: 0, parent: None }],
            positions: ball.positions.iter().map(|x| [x.x + frame as f64, x.y, x.z]).collect(),
            membranes: vec![ball.positions.iter().map(density).collect()],
            records: vec![CellRecord::default()],
            ..Frame::default()
        };
        writer.append(&frame).unwrap();
    }
    writer.finish(1.0).unwrap();
    ResultFile::open(path).unwrap()
}

fn taken(file: &ResultFile, keys: &str) -> Result<f64, String> {
    let keys = format!("kind = 'fronts'\nof = 'pods.a'\nabove = 2\n{}", keys.replace("; ", "\n"));
    let measure: Measure = toml::from_str(&keys).map_err(|error| error.to_string())?;
    let recording = Recording::read(file, &measure.kind.series()).map_err(|error| error.to_string())?;
    measure
        .kind
        .evaluate(&Finished { recording: &recording, file: Some(file), resolve: &Path::to_path_buf })
        .map_err(|error| error.to_string())
}

#[test]
fn fronts_are_counted_timed_and_turned_as_they_were_made() {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("pods.h5"));
    let expected = [
        ("", 5.0 / 25.0, 1e-12),
        ("statistic = 'at_once'", (3.0 * 4.0 + 8.0 + 4.0) / 25.0, 1e-12),
        // 4, 4, 4, 4 and 8 s.
        ("statistic = 'lifetime'", 4.0, 1e-12),
        // Turns of 60, −60, 60 and 75 degrees; atoms of 9° apart tell the middle of a front of some 50 to 2°.
        ("statistic = 'angle'", 60.0, 2.0),
        ("statistic = 'split_share'", 1.0 / 5.0, 1e-12),
        ("statistic = 'alternation'", 2.0 / 3.0, 1e-12),
        // Two or three heads of three coins.
        ("statistic = 'alternation_p'", 0.5, 1e-12),
        ("lasting = '5 s'", 1.0 / 25.0, 1e-12),
        ("from = '5 s'; to = '15 s'", 2.0 / 10.0, 1e-12),
    ];
    for (keys, value, tolerance) in expected {
        let found = taken(&file, keys).unwrap_or_else(|fault| panic!("{keys}: {fault}"));
        assert!((found - value).abs() <= tolerance, "{keys}: {found} instead of {value}");
    }
    assert!(taken(&file, "statistic = 'angle'; from = '24 s'").unwrap().is_nan(), "none is no angle");
}

#[test]
fn an_unknown_substance_is_told_with_those_that_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let file = recorded(&folder.path().join("pods.h5"));
    let measure: Measure = toml::from_str("kind = 'fronts'\nof = 'pods.b'\nabove = 2").unwrap();
    let recording = Recording::read(&file, &measure.kind.series()).unwrap();
    let run = Finished { recording: &recording, file: Some(&file), resolve: &Path::to_path_buf };
    let told = measure.kind.evaluate(&run).unwrap_err().to_string();
    assert!(told.contains("there is no substance \"pods.b\" on membranes in this run"), "{told}");
}
