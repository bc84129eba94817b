//! Writing a frame: cells of 42 atoms with forces, positions as noisy as those of a simulation.

use divan::Bencher;
use divan::counter::BytesCount;
use pseudopod::output::{Cell, CellRecord, CellType, FieldLayout, Frame, Header, Layout, Overwrite, ResultWriter};

const ATOMS: usize = 42;
const FACETS: usize = 80;

fn main() {
    divan::main();
}

fn layout() -> Layout {
    let facet = |facet: usize| [facet % ATOMS, (facet + 1) % ATOMS, (facet + 7) % ATOMS].map(|atom| atom as u32);
    let facets = (0..FACETS).map(facet).collect();
    let kind = CellType { name: "cell".into(), atoms: ATOMS as u32, facets, links: Vec::new() };
    Layout { types: vec![kind], ..Layout::default() }
}

fn frame(cells: usize) -> Frame {
    // Sines of large numbers are as hard to compress as the digits of a simulation.
    let noise = |seed: usize| (seed as f64 * 12.9898).sin();
    let vectors = |scale: f64| (0..cells * ATOMS).map(move |i| [3 * i, 3 * i + 1, 3 * i + 2].map(|j| scale * noise(j)));
    let record = |i: usize| CellRecord {
        position: [noise(i), noise(i + 1), noise(i + 2)],
        velocity: [noise(i + 3), noise(i + 4), noise(i + 5)],
        volume: 4.0 + 1e-10 * noise(i),
        volume_error: 1e-12 * noise(i),
        area: 12.0 + noise(i),
        energy: noise(i),
        size: [2.0, 2.0 + noise(i), 2.0],
        principal: [2.0, 2.0 + noise(i), 2.0],
        smallest_facet: 0.9,
        smallest_cosine: 0.8,
        contact_share: 0.3,
        aggregate: 0.0,
        ..CellRecord::default()
    };
    Frame {
        positions: vectors(10.0).collect(),
        forces: vectors(0.1).collect(),
        cells: (0..cells as u64).map(|id| Cell { id, ..Cell::default() }).collect(),
        records: (0..cells).map(record).collect(),
        ..Frame::default()
    }
}

#[divan::bench(args = [1, 1_000, 10_000], min_time = 1, max_time = 4)]
fn append(bencher: Bencher, cells: usize) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let header = Header::now("bench.toml", "Bench", "", &[], 1);
    let mut writer = ResultWriter::create(&path, &header, &layout(), Overwrite::Refuse).unwrap();
    let mut frame = frame(cells);
    bencher.counter(BytesCount::new(cells * (2 * ATOMS * 24 + std::mem::size_of::<CellRecord>()))).bench_local(|| {
        frame.step += 1;
        frame.time += 0.5;
        writer.append(&frame).unwrap();
    });
    writer.renew().unwrap();
    let frames = writer.frames() as u64;
    drop(writer);
    let bytes = std::fs::metadata(&path).unwrap().len();
    eprintln!("{cells} cells: {} bytes a frame on disk", bytes / frames);
}

/// A frame of one cell with a field of two species on this many boxes along each side of the substrate.
#[divan::bench(args = [100, 400, 1_000], min_time = 1, max_time = 4)]
fn append_field(bencher: Bencher, side: usize) {
    let folder = tempfile::tempdir().unwrap();
    let header = Header::now("bench.toml", "", "", &[], 0);
    let species = ["U", "V"].map(|name| (name.to_owned(), "uM".to_owned())).to_vec();
    let grid =
        FieldLayout { name: "field".into(), species, cells: [side, side, 1], spacing: [1.0; 3], origin: [0.0; 3] };
    let layout = Layout { fields: vec![grid], ..layout() };
    let path = folder.path().join("run.vtkhdf");
    let mut writer = ResultWriter::create(&path, &header, &layout, Overwrite::Refuse).unwrap();
    let value = |i: usize| 1.0 + (0.01 * (i % side) as f64).sin() * (0.02 * (i / side) as f64).cos();
    let values: Vec<f64> = (0..side * side).map(value).collect();
    let mut frame = Frame { fields: vec![vec![values.clone(), values]], ..frame(1) };
    bencher.bench_local(|| {
        frame.step += 1;
        writer.append(&frame).unwrap();
    });
    writer.renew().unwrap();
    let bytes = std::fs::metadata(&path).unwrap().len();
    eprintln!("{side}: {} bytes a frame for {} of numbers", bytes / frame.step, 16 * side * side);
}
