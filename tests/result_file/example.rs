//! A small scene whose numbers are easy to foretell.

use std::path::Path;

use pseudopod::output::{
    CellLayout, CellRecord, FieldLayout, Frame, Header, Layout, Overwrite, ResultWriter, SystemLayout, SystemScope,
    Touching,
};

/// Corners of an octahedron.
const CORNERS: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
const FACETS: [[u32; 3]; 8] = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];

/// Octahedral cells of two types, each with one internal link.
pub fn layout(cells: u32) -> Layout {
    let facets = (0..cells).flat_map(|cell| FACETS.map(|facet| facet.map(|atom| atom + 6 * cell)));
    Layout {
        types: vec!["round".into(), "lone".into()],
        cells: (0..cells)
            .map(|cell| CellLayout { kind: cell % 2, first_atom: 6 * cell, atoms: 6, first_facet: 8 * cell, facets: 8 })
            .collect(),
        facets: facets.collect(),
        links: (0..cells).map(|cell| [6 * cell, 6 * cell + 3]).collect(),
        scene_series: vec![("wall.height".into(), "um".into()), ("load.pull".into(), "pN".into())],
        planes: vec![("floor".into(), [0.0, 0.0, -2.0], [0.0, 0.0, 1.0])],
        contacts: true,
        ..Layout::default()
    }
}

/// The frame of this number: the cells drift along x and a motility run ends in every frame but the first. Of
/// neighbours two thirds touch, others in the next frame, and every second cell stands on the floor.
pub fn frame(layout: &Layout, number: usize) -> Frame {
    let time = 0.25 * number as f64;
    let cells = layout.cells.len();
    let centre = |cell: usize| [3.0 * cell as f64 + time, 0.1 * cell as f64, 0.0];
    let positions = (0..cells).flat_map(|cell| CORNERS.map(|corner| add(corner, centre(cell))));
    Frame {
        time,
        step: 10 * number as u64,
        positions: positions.collect(),
        forces: (0..6 * cells).map(|atom| [time, atom as f64, -1.5]).collect(),
        cells: (0..cells)
            .map(|cell| CellRecord {
                position: centre(cell),
                velocity: [3.0, 0.0, 4.0 * time],
                volume: 4.0 / 3.0,
                volume_error: 1e-12 * cell as f64,
                area: 48.0_f64.sqrt() + time,
                energy: number as f64,
                size: [2.0, 2.0, 2.5],
                principal: [2.5, 2.0, 1.0 + cell as f64],
                smallest_facet: 0.9,
                smallest_cosine: 0.8,
                contact_share: 0.25,
                aggregate: f64::from(cell as u32),
            })
            .collect(),
        scene: vec![10.0 - time, 2.0 * time],
        runs: if number == 0 { Vec::new() } else { vec![(number as u32 % cells as u32, time, 0.5 * time)] },
        pairs: (1..cells as u32)
            .filter(|cell| !(*cell as usize + number).is_multiple_of(3))
            .map(|cell| Touching { cell: cell - 1, other: cell, area: f64::from(cell) + time })
            .collect(),
        on_planes: (0..cells as u32)
            .filter(|cell| (*cell as usize + number).is_multiple_of(2))
            .map(|cell| Touching { cell, other: 0, area: 1.5 })
            .collect(),
        ..Frame::default()
    }
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn header() -> Header {
    let header =
        Header::now("walk.toml", "A walk", "title = \"A walk\"\nseed = 7\n", &["cells.round.count=3".into()], 7);
    Header { equations: vec![("own.eml".into(), "<eml name=\"own\"/>".into())], ..header }
}

/// Makes a file and appends frames `0..frames`.
pub fn write(path: &Path, layout: &Layout, frames: usize) -> ResultWriter {
    let mut writer = ResultWriter::create(path, &header(), layout, Overwrite::Refuse).unwrap();
    for number in 0..frames {
        writer.append(&frame(layout, number)).unwrap();
    }
    writer
}

/// The same cells with two fields, one of them on the substrate, a system in every other cell and one of the scene.
pub fn layout_with_fields(cells: u32) -> Layout {
    let named = |name: &str| (name.to_string(), "uM".to_string());
    let flat = FieldLayout {
        name: "attractant".into(),
        species: vec![named("attractant"), named("inhibitor")],
        cells: [6, 5, 1],
        spacing: [2.0, 2.0, 1.0],
        origin: [-3.0, -4.0, -1.5],
    };
    let block = FieldLayout {
        name: "medium".into(),
        species: vec![named("oxygen")],
        cells: [4, 4, 4],
        spacing: [3.0; 3],
        origin: [0.0; 3],
    };
    let brain = SystemLayout {
        name: "brain".into(),
        scope: SystemScope::Cells((0..cells).step_by(2).collect()),
        quantities: vec![named("U"), ("cells".into(), "1".into())],
    };
    let clock = SystemLayout { name: "clock".into(), scope: SystemScope::Scene, quantities: vec![named("tick")] };
    Layout { fields: vec![flat, block], systems: vec![brain, clock], ..layout(cells) }
}

/// The frame of this number with values that differ from place to place, from species to species and from frame to frame.
pub fn frame_with_fields(layout: &Layout, number: usize) -> Frame {
    let value = |species: usize, i: usize| ((number + 1) * (species + 2)) as f64 + 0.1 * i as f64;
    let of_field = |field: &FieldLayout| -> Vec<Vec<f64>> {
        (0..field.species.len()).map(|species| (0..field.len()).map(|i| value(species, i)).collect()).collect()
    };
    let of_system = |system: &SystemLayout| -> Vec<Vec<f64>> {
        let members = |quantity: usize| (0..system.members()).map(|i| value(quantity, i)).collect();
        (0..system.quantities.len()).map(members).collect()
    };
    Frame {
        fields: layout.fields.iter().map(of_field).collect(),
        systems: layout.systems.iter().map(of_system).collect(),
        ..frame(layout, number)
    }
}

/// Values of a field as the file keeps them.
pub fn stored(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value as f32)).collect()
}
