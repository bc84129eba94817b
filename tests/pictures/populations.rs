//! Pictures, movies and tracks of a run in which cells come and go.

use std::path::Path;

use pseudopod::analysis::tracks::motion::Quantity;
use pseudopod::experiment::{Document, Picture, Plot, PlotKind, When};
use pseudopod::geometry::icosphere;
use pseudopod::output::{Cell, CellRecord, CellType, Frame, Header, Layout, Overwrite, ResultFile, ResultWriter};
use pseudopod::picture::chart::{Series, to_svg};
use pseudopod::picture::from_file::{film, still};
use pseudopod::picture::plots::chart_of;
use pseudopod::picture::quantities::AtomQuantity;

/// The cells of each frame: one that divides, and whose daughters lose their mother.
const IDS: [&[(u64, u32)]; 4] = [&[(0, 0)], &[(0, 0), (1, 1)], &[(0, 0), (1, 1), (2, 0)], &[(2, 0), (1, 1)]];

fn record(folder: &Path) -> (ResultFile, Document) {
    let document = Document::parse("made_up.toml", super::example::TEXT, folder, &[]).unwrap();
    let (path, sphere) = (folder.join("lineage.vtkhdf"), icosphere(5.0, 2));
    let kind = |name: &str| CellType {
        name: name.into(),
        atoms: sphere.positions.len() as u32,
        facets: sphere.facets.clone(),
        links: Vec::new(),
    };
    let layout = Layout { types: vec![kind("walker"), kind("rester")], ..Layout::default() };
    let header = Header::now("made_up.toml", "Cells that come and go", super::example::TEXT, &[], 1);
    let mut writer = ResultWriter::create(&path, &header, &layout, Overwrite::Replace).unwrap();
    for (number, ids) in IDS.iter().enumerate() {
        let centre = |id: u64| [12.0 * id as f64, 2.0 * number as f64, 5.0];
        let cells: Vec<Cell> = ids.iter().map(|&(id, kind)| Cell { id, kind, parent: (id > 0).then_some(0) }).collect();
        let moved = |id: u64| sphere.positions.iter().map(move |p| std::array::from_fn(|k| p[k] + centre(id)[k]));
        let frame = Frame {
            time: number as f64,
            step: number as u64,
            positions: cells.iter().flat_map(|cell| moved(cell.id).collect::<Vec<[f64; 3]>>()).collect(),
            records: cells
                .iter()
                .map(|cell| CellRecord { position: centre(cell.id), volume: cell.id as f64, ..CellRecord::default() })
                .collect(),
            cells,
            ..Frame::default()
        };
        writer.append(&frame).unwrap();
    }
    writer.finish(1.0).unwrap();
    (ResultFile::open(&path).unwrap(), document)
}

#[test]
fn atoms_move_from_where_their_cell_was_first_seen() {
    let folder = tempfile::tempdir().unwrap();
    let (result, _) = record(folder.path());
    let moved = AtomQuantity::Displacement.of_frame(&result, 3, &result.positions(3).unwrap()).unwrap();
    // The frame has the cells 2 and 1, seen first in frames 2 and 1; all go 2 µm a frame.
    let (of_two, of_one) = moved.split_at(moved.len() / 2);
    assert!(
        of_two.iter().all(|travelled| (travelled - 2.0).abs() < 1e-12)
            && of_one.iter().all(|travelled| (travelled - 4.0).abs() < 1e-12)
    );
    let curvature = AtomQuantity::Curvature.of_frame(&result, 3, &result.positions(3).unwrap()).unwrap();
    assert!(curvature.iter().all(|h| (h - 0.2).abs() < 0.02));
}

#[test]
fn a_film_shows_the_cells_of_each_frame() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = record(folder.path());
    let keep = std::env::var_os("PICTURES").map(std::path::PathBuf::from);
    for colour in ["type", "volume", "displacement"] {
        let picture = Picture { colour_by: colour.into(), width: 320, height: 180, ..Picture::default() };
        // How much of each picture is not background.
        let mut covered = Vec::new();
        film(&result, &document, &picture, &[0, 1, 2, 3], |image| {
            let background = image.pixel(2, 100);
            let pixels = (0..320).flat_map(|x| (30..150).map(move |y| (x, y)));
            covered.push(pixels.filter(|(x, y)| image.pixel(*x, *y) != background).count());
            if let Some(folder) = &keep {
                image.save_png(&folder.join(format!("lineage_{colour}_{}.png", covered.len())))?;
            }
            Ok(())
        })
        .unwrap();
        let [one, two, three, last] = covered[..] else { panic!("{covered:?}") };
        assert!(one < two && two < three && last < three, "{colour}: {covered:?}");
    }
    let picture = Picture { time: When::First, width: 160, height: 90, ..Picture::default() };
    still(&result, &document, &picture).unwrap();
}

#[test]
fn a_track_is_where_its_cell_is() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = record(folder.path());
    let (name, kind, cells) = ("tracks".to_owned(), PlotKind::Tracks, Some("walker".to_owned()));
    let plot = Plot { name, kind, cells, table: None, title: None, x_label: None, y_label: None };
    let chart = chart_of(&result, &document, &plot).unwrap();
    let [Series::Tracks { tracks, .. }] = &chart.series[..] else { panic!("one series of tracks") };
    let expected: [&[[f64; 2]]; 2] = [&[[0.0, 0.0], [0.0, 2.0], [0.0, 4.0]], &[[24.0, 4.0], [24.0, 6.0]]];
    assert_eq!(tracks.iter().map(Vec::as_slice).collect::<Vec<_>>(), expected);
}

fn plot_of(kind: PlotKind) -> Plot {
    Plot {
        name: "chart".to_owned(),
        kind,
        cells: Some("walker".to_owned()),
        table: None,
        title: None,
        x_label: None,
        y_label: None,
    }
}

#[test]
fn a_rose_counts_directions_and_a_histogram_tracks() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = record(folder.path());
    // Both walkers go straight along y, at 2 µm a frame.
    let rose = chart_of(&result, &document, &plot_of(PlotKind::Rose { sectors: Some(4) })).unwrap();
    let [Series::Areas { outlines, .. }, Series::Line { points, label, .. }] = &rose.series[..] else {
        panic!("{rose:?}")
    };
    assert_eq!(outlines.len(), 1, "one sector has both");
    let farthest = outlines[0].iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
    assert!(
        (farthest - 2.0).abs() < 1e-12 && outlines[0].iter().all(|[x, y]| *y >= x.abs() - 1e-12),
        "about the y axis"
    );
    assert!(points[1][0].abs() < 1e-12 && (points[1][1] - 2.0).abs() < 1e-12, "a resultant of 1 ends at the rim");
    assert!(label.starts_with("mean of 2: R = 1, p = "), "{label}");
    let kind = PlotKind::Histogram { quantity: Quantity::Directness, bins: Some(5) };
    let histogram = chart_of(&result, &document, &plot_of(kind)).unwrap();
    let [Series::Areas { outlines, .. }, _] = &histogram.series[..] else { panic!("{histogram:?}") };
    assert_eq!(outlines.len(), 1);
    assert!(outlines[0].iter().all(|[x, y]| *x >= 0.8 - 1e-12 && *x <= 1.0 + 1e-12 && (*y == 0.0 || *y == 2.0)));
    for chart in [rose, histogram] {
        roxmltree::Document::parse(&to_svg(&chart, 600.0, 600.0)).unwrap();
    }
}

#[test]
fn displacements_have_a_band_and_a_line_of_one_name() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = record(folder.path());
    let chart = chart_of(&result, &document, &plot_of(PlotKind::Msd { speed: None, persistence: None })).unwrap();
    let [Series::Band { points: band, label, .. }, Series::Line { points, label: name, .. }] = &chart.series[..] else {
        panic!("{chart:?}")
    };
    assert_eq!(label, name);
    // Steps of 2 µm alike: the interval is the point.
    assert!(
        band.iter()
            .zip(points)
            .all(|(band, point)| (band[1] - point[1]).abs() < 1e-12 && (band[2] - point[1]).abs() < 1e-12)
    );
    assert!((points[0][1] - 4.0).abs() < 1e-12);
}
