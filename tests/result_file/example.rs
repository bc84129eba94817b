//! A small scene whose numbers are easy to foretell.

use std::path::Path;

use pseudopod::output::{
    Cell, CellRecord, CellType, FieldLayout, Frame, Header, Layout, MembraneLayout, Obstacle, Overwrite, ResultWriter,
    SystemLayout, SystemScope, Touching, Tractions,
};
use pseudopod::recorded::TractionRecord;

/// Corners of an octahedron.
const CORNERS: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
const FACETS: [[u32; 3]; 8] = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];

/// Octahedral cells of two types, each with one internal link.
pub fn layout() -> Layout {
    let kind = |name: &str| CellType { name: name.into(), atoms: 6, facets: FACETS.to_vec(), links: vec![[0, 3]] };
    Layout {
        types: vec![kind("round"), kind("lone")],
        scene_series: vec![("wall.height".into(), "um".into()), ("load.pull".into(), "pN".into())],
        obstacles: vec![Obstacle {
            name: "floor".into(),
            point: [0.0, 0.0, -2.0],
            normal: [0.0, 0.0, 1.0],
            ..Obstacle::default()
        }],
        contacts: true,
        ..Layout::default()
    }
}

/// So many cells that were there from the beginning, of both types by turns.
pub fn cells(number: u32) -> Vec<Cell> {
    (0..number).map(|cell| Cell { id: u64::from(cell), kind: cell % 2, parent: None }).collect()
}

/// The frame of this number with these cells: they drift along x and a motility run ends in every frame but the first.
/// Of neighbours two thirds touch, others in the next frame, and every second cell stands on the floor.
pub fn frame(cells: &[Cell], number: usize) -> Frame {
    let time = 0.25 * number as f64;
    let centre = |cell: &Cell| [3.0 * cell.id as f64 + time, 0.1 * cell.id as f64, 0.0];
    let positions = cells.iter().flat_map(|cell| CORNERS.map(|corner| add(corner, centre(cell))));
    let record = |cell: &Cell| CellRecord {
        position: centre(cell),
        velocity: [3.0, 0.0, 4.0 * time],
        volume: 4.0 / 3.0,
        volume_error: 1e-12 * cell.id as f64,
        area: 48.0_f64.sqrt() + time,
        energy: number as f64,
        size: [2.0, 2.0, 2.5],
        principal: [2.5, 2.0, 1.0 + cell.id as f64],
        smallest_facet: 0.9,
        smallest_cosine: 0.8,
        contact_share: 0.25,
        aggregate: cell.id as f64,
        ..CellRecord::default()
    };
    let mut ids: Vec<u64> = cells.iter().map(|cell| cell.id).collect();
    ids.sort_unstable();
    Frame {
        time,
        step: 10 * number as u64,
        cells: cells.to_vec(),
        positions: positions.collect(),
        forces: (0..6 * cells.len()).map(|atom| [time, atom as f64, -1.5]).collect(),
        records: cells.iter().map(record).collect(),
        scene: vec![10.0 - time, 2.0 * time],
        runs: match (number, ids.len()) {
            (0, _) | (_, 0) => Vec::new(),
            (_, some) => vec![(ids[number % some], time, 0.5 * time)],
        },
        pairs: ids
            .windows(2)
            .filter(|pair| !(pair[1] as usize + number).is_multiple_of(3))
            .map(|pair| Touching { cell: pair[0], other: pair[1], area: pair[1] as f64 + time })
            .collect(),
        on_planes: ids
            .iter()
            .filter(|id| (**id as usize + number).is_multiple_of(2))
            .map(|id| Touching { cell: *id, other: 0, area: 1.5 })
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

/// Makes a file of this many cells and appends frames `0..frames`.
pub fn write(path: &Path, number: u32, frames: usize) -> ResultWriter {
    let mut writer = ResultWriter::create(path, &header(), &layout(), Overwrite::Refuse).unwrap();
    (0..frames).for_each(|index| writer.append(&frame(&cells(number), index)).unwrap());
    writer
}

/// The cells of the frames of a run in which their number changes: two of different types, then a daughter of each, in
/// the order of types; the first is washed out with its neighbour and the last, and comes back in nobody; at the end all
/// are gone and a new one is seeded.
pub fn lineage() -> Vec<Vec<Cell>> {
    let cell = |id, kind, parent| Cell { id, kind, parent };
    let (first, second) = (cell(0, 0, None), cell(1, 1, None));
    let (daughter, other) = (cell(2, 0, Some(0)), cell(3, 1, Some(1)));
    let seeded = cell(4, 1, None);
    vec![
        vec![first, second],
        vec![first, daughter, second, other],
        vec![first, daughter, second, other],
        vec![daughter],
        vec![],
        vec![seeded],
    ]
}

/// The same cells with two fields, one of them on the substrate, a system in the cells of the first type, two substances on their
/// membranes, a system of the scene, and tractions.
pub fn layout_with_fields() -> Layout {
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
        scope: SystemScope::Cells,
        quantities: vec![named("U"), ("cells".into(), "1".into())],
    };
    let clock = SystemLayout { name: "clock".into(), scope: SystemScope::Scene, quantities: vec![named("tick")] };
    let on_membrane = |name: &str| MembraneLayout { name: format!("brain.{name}"), unit: "1/um^2".into() };
    let membranes = vec![on_membrane("b"), on_membrane("a")];
    Layout { membranes, fields: vec![flat, block], systems: vec![brain, clock], tractions: true, ..layout() }
}

/// The frame of this number with values that differ from place to place, from species to species and from frame to frame.
pub fn frame_with_fields(cells: &[Cell], number: usize) -> Frame {
    let layout = layout_with_fields();
    let value = |species: usize, i: usize| ((number + 1) * (species + 2)) as f64 + 0.1 * i as f64;
    let of_field = |field: &FieldLayout| -> Vec<Vec<f64>> {
        (0..field.species.len()).map(|species| (0..field.len()).map(|i| value(species, i)).collect()).collect()
    };
    let of_system = |system: &SystemLayout| -> Vec<Vec<f64>> {
        let in_cell = |quantity: usize, cell: &Cell| match cell.kind {
            0 => value(quantity, cell.id as usize),
            _ => f64::NAN,
        };
        let in_all = |quantity: usize| match system.scope {
            SystemScope::Scene => vec![value(quantity, 0)],
            SystemScope::Cells => cells.iter().map(|cell| in_cell(quantity, cell)).collect(),
        };
        (0..system.quantities.len()).map(in_all).collect()
    };
    let of_membrane = |variable: usize| -> Vec<f64> {
        let of_cell = |cell: &Cell| {
            let (own, id) = (cell.kind == 0, cell.id as usize);
            (0..6).map(move |atom| if own { value(variable, 10 * id + atom) } else { f64::NAN })
        };
        cells.iter().flat_map(of_cell).collect()
    };
    let of_atoms =
        |first: f64| (0..6 * cells.len()).map(|atom| [first, atom as f64, number as f64]).collect::<Vec<[f64; 3]>>();
    let mut plain = frame(cells, number);
    for (record, cell) in plain.records.iter_mut().zip(cells) {
        let (total, dipole) = (10.0 + number as f64, -(cell.id as f64));
        record.traction = TractionRecord { total, dipole, moment: [dipole, 0.0, 1.0], ..TractionRecord::default() };
    }
    Frame {
        tractions: Tractions {
            traction: of_atoms(1.0),
            of_cells: of_atoms(2.0),
            drag: of_atoms(3.0),
            outer: of_atoms(4.0),
            inertia: of_atoms(5.0),
            held: of_atoms(6.0),
        },
        membranes: (0..layout.membranes.len()).map(of_membrane).collect(),
        fields: layout.fields.iter().map(of_field).collect(),
        systems: layout.systems.iter().map(of_system).collect(),
        ..plain
    }
}

/// Values of a field as the file keeps them.
pub fn stored(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value as f32)).collect()
}
