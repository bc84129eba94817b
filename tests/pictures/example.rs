//! A result with made-up fields and chemistry: three round cells of two types on a substrate with a pattern, in a
//! medium that fades upwards, each with a clock inside.

use std::path::{Path, PathBuf};

use pseudopod::geometry::icosphere;
use pseudopod::output::{
    Cell, CellRecord, CellType, FieldLayout, Frame, Header, Layout, Measure, Obstacle, Overwrite, ResultWriter,
    SystemLayout, SystemScope,
};

pub const TEXT: &str = r#"
title = "Cells on a patterned substrate"
[run]
until = "10 s"
[cells.walker]
number = 2
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
mechanics = { drag = "2 pN s/um" }
[cells.rester]
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
mechanics = { drag = "2 pN s/um" }
"#;

/// Frames of the example, one a second.
pub const FRAMES: usize = 11;

const CENTRES: [[f64; 3]; 3] = [[12.0, 12.0, 5.0], [27.0, 33.0, 5.0], [45.0, 16.0, 5.0]];

fn layout() -> Layout {
    let sphere = icosphere(5.0, 2);
    let kind = |name: &str| CellType {
        name: name.into(),
        atoms: sphere.positions.len() as u32,
        facets: sphere.facets.clone(),
        links: Vec::new(),
    };
    let named = |name: &str, unit: &str| (name.to_string(), unit.to_string());
    Layout {
        types: vec![kind("walker"), kind("rester")],
        obstacles: vec![Obstacle { name: "ground".into(), normal: [0.0, 0.0, 1.0], ..Obstacle::default() }],
        fields: vec![
            FieldLayout {
                name: "attractant".into(),
                species: vec![named("attractant", "uM"), named("inhibitor", "1/um^2")],
                cells: [30, 22, 1],
                spacing: [2.0, 2.0, 1.0],
                origin: [0.0; 3],
            },
            FieldLayout {
                name: "medium".into(),
                species: vec![named("oxygen", "nM")],
                cells: [15, 11, 6],
                spacing: [4.0, 4.0, 3.0],
                origin: [0.0; 3],
            },
        ],
        systems: vec![
            SystemLayout {
                name: "clock".into(),
                scope: SystemScope::Cells,
                quantities: vec![named("U", "uM"), named("V", "1")],
            },
            SystemLayout { name: "bath".into(), scope: SystemScope::Scene, quantities: vec![named("level", "1")] },
        ],
        ..Layout::default()
    }
}

/// A front that moves along x with a spot on it.
pub fn attractant(x: f64, y: f64, time: f64) -> f64 {
    let front = 1.0 / (1.0 + ((x - 10.0 - 4.0 * time) / 4.0).exp());
    front + 0.8 * (-((x - 40.0).powi(2) + (y - 28.0).powi(2)) / 50.0).exp()
}

fn frame(layout: &Layout, number: usize) -> Frame {
    let time = number as f64;
    let sphere = icosphere(5.0, 2);
    let centre = |n: usize| [CENTRES[n][0] + 0.3 * time, CENTRES[n][1], CENTRES[n][2]];
    let position = |field: &FieldLayout, at: usize| {
        let [nx, ny, _] = field.cells;
        let index = [at % nx, at / nx % ny, at / (nx * ny)];
        let along = |k: usize| field.origin[k] + (index[k] as f64 + 0.5) * field.spacing[k];
        [along(0), along(1), along(2)]
    };
    let values = |field: &FieldLayout, value: &dyn Fn([f64; 3]) -> f64| -> Vec<f64> {
        (0..field.len()).map(|at| value(position(field, at))).collect()
    };
    let (flat, medium) = (&layout.fields[0], &layout.fields[1]);
    let clock = |phase: f64| vec![(time + phase).sin(), (time + phase + 1.0).sin(), f64::NAN];
    Frame {
        time,
        step: 10 * number as u64,
        positions: (0..3)
            .flat_map(|n| {
                sphere
                    .positions
                    .iter()
                    .map(move |p| [p.x + centre(n)[0], p.y + centre(n)[1], p.z + centre(n)[2]])
                    .collect::<Vec<_>>()
            })
            .collect(),
        cells: (0..3).map(|n| Cell { id: n, kind: n as u32 / 2, parent: None }).collect(),
        records: (0..3)
            .map(|n| CellRecord { position: centre(n), volume: 500.0 + n as f64, ..CellRecord::default() })
            .collect(),
        fields: vec![
            vec![values(flat, &|[x, y, _]| attractant(x, y, time)), values(flat, &|[x, _, _]| 1.0 + (0.2 * x).sin())],
            vec![values(medium, &|[x, y, z]| {
                200.0 * (-z / 8.0).exp() * (1.0 + 0.5 * (0.2 * x).sin() * (0.3 * y).cos())
            })],
        ],
        systems: vec![vec![clock(0.0), clock(0.5)], vec![vec![0.1 * time]]],
        ..Frame::default()
    }
}

/// Writes the result into a folder.
pub fn write(folder: &Path, extra: &str) -> PathBuf {
    write_measured(folder, extra, &[])
}

/// Writes the result with these measures.
pub fn write_measured(folder: &Path, extra: &str, measures: &[Measure]) -> PathBuf {
    let path = folder.join("made_up.vtkhdf");
    let layout = layout();
    let text = format!("{TEXT}{extra}");
    let header = Header::now("made_up.toml", "Cells on a patterned substrate", &text, &[], 1);
    let mut writer = ResultWriter::create(&path, &header, &layout, Overwrite::Replace).unwrap();
    (0..FRAMES).for_each(|number| writer.append(&frame(&layout, number)).unwrap());
    writer.write_summary(measures);
    writer.finish(1.0).unwrap();
    path
}
