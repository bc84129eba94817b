//! What is seen of a recorded instant.

use super::*;
use crate::output::{Cell, Layout, Obstacle};
use crate::picture::ColourMap;
use crate::picture::joined::Joint;
use crate::picture::render::Insets;

const CELLS: [Cell; 2] = [Cell { id: 0, kind: 0, parent: None }, Cell { id: 1, kind: 1, parent: None }];

fn two_cells() -> (Layout, Vec<[f64; 3]>) {
    let (mut layout, mut positions) = (Layout::default(), Vec::new());
    for (kind, name) in [(0_u32, "round"), (1, "square")] {
        let cell = crate::picture::render::tests::sphere([12.0 * f64::from(kind), 0.0, 5.0], 5.0, 2);
        let (atoms, facets) = (cell.positions.len() as u32, cell.facets);
        layout.types.push(CellType { name: name.into(), atoms, facets, links: Vec::new() });
        positions.extend(cell.positions);
    }
    let plane = |name: &str, height: f64, up: f64| Obstacle {
        name: name.into(),
        point: [0.0, 0.0, height],
        normal: [0.0, 0.0, up],
        ..Obstacle::default()
    };
    layout.obstacles = vec![plane("ground", 0.0, 1.0), plane("lid", 10.0, -1.0)];
    (layout, positions)
}

/// An instant with these positions: the colours of types, and nothing besides.
fn instant<'a>(layout: &'a Layout, positions: &'a [[f64; 3]]) -> Snapshot<'a> {
    Snapshot {
        layout,
        cells: &CELLS,
        positions,
        time: 0.0,
        values: Values::Type,
        arrows: &[],
        fibres: None,
        links: None,
        field: None,
        rest: &[],
        gone: &[],
    }
}

#[test]
fn types_and_numbers_colour_the_cells() {
    let (layout, positions) = two_cells();
    let mut snapshot = Snapshot { time: 3.0, ..instant(&layout, &positions) };
    let look = Look::default();
    let mut framing = Framing::new(&look);
    framing.include(&snapshot);
    let scene = scene_of(&snapshot, &look, &framing);
    assert_eq!(scene.surfaces[1].colour, SurfaceColour::Uniform(Colour::of_palette(1)));
    assert!(scene.floor.is_some() && scene.panes.len() == 1);
    assert!(matches!(overlay_of(&snapshot, &look, &framing).key, Key::Names(names) if names.len() == 2));
    snapshot.values = Values::Cells(&[-1.0, 4.0]);
    framing.include(&snapshot);
    let scene = scene_of(&snapshot, &look, &framing);
    assert_eq!(scene.surfaces[0].colour, SurfaceColour::Uniform(ColourMap::Viridis.at(0.0)));
    assert_eq!(scene.surfaces[1].colour, SurfaceColour::Uniform(ColourMap::Viridis.at(1.0)));
    let key = overlay_of(&snapshot, &look, &framing).key;
    assert!(matches!(key, Key::Bar { low, high, .. } if low == -1.0 && high == 4.0));
    // Exact volumes differ by round-off, which is neither a range nor two colours.
    snapshot.values = Values::Cells(&[523.598_775_598_3, 523.598_775_598_2]);
    let mut framing = Framing::new(&look);
    framing.include(&snapshot);
    let scene = scene_of(&snapshot, &look, &framing);
    assert_eq!(scene.surfaces[0].colour, scene.surfaces[1].colour);
    let key = overlay_of(&snapshot, &look, &framing).key;
    assert!(matches!(key, Key::Bar { low, high, .. } if low == high));
}

#[test]
fn every_frame_of_a_run_has_its_time_in_the_same_unit() {
    let (layout, positions) = two_cells();
    let look = Look::default();
    let stamp = |time: f64| {
        let snapshot = Snapshot { time, ..instant(&layout, &positions) };
        // A picture of one frame alone: the others have not been seen.
        let mut framing = Framing::new(&look).lasting(600.0);
        framing.include(&snapshot);
        overlay_of(&snapshot, &look, &framing).time
    };
    let stamps = [0.0, 1.5, 600.0].map(stamp);
    assert!(stamps.iter().all(|stamp| stamp.ends_with(" min")), "{stamps:?}");
}

#[test]
fn the_camera_shows_all_frames() {
    let (layout, positions) = two_cells();
    let moved: Vec<[f64; 3]> = positions.iter().map(|p| [p[0] + 40.0, p[1], p[2]]).collect();
    let look = Look::default();
    let (mut one, mut both) = (Framing::new(&look), Framing::new(&look));
    one.include(&instant(&layout, &positions));
    both.include(&instant(&layout, &positions));
    both.include(&instant(&layout, &moved));
    let across =
        |framing: &Framing| 720.0 / framing.camera(&look, 16.0 / 9.0, Insets::default()).pixels_per_micron(720);
    assert!(across(&both) > 2.0 * across(&one), "{} {}", across(&both), across(&one));
}

#[test]
fn a_marked_body_is_seen_to_turn_by_eighths_of_it() {
    let (layout, positions) = two_cells();
    let half = positions.len() / 2;
    let rest = [positions[..half].to_vec(), positions[half..].to_vec()];
    // A quarter turn about y, through the middle of the first cell.
    let turned: Vec<[f64; 3]> = positions.iter().map(|p| [p[2] - 5.0, p[1], 5.0 - p[0]]).collect();
    let look = Look::default();
    let seen = |positions: &[[f64; 3]], marked: &[usize]| {
        let snapshot = Snapshot { rest: &rest, ..instant(&layout, positions) };
        let look = Look { marked: marked.to_vec(), ..look.clone() };
        let scene = scene_of(&snapshot, &look, &Framing::new(&look));
        let camera = crate::picture::Camera {
            eye: [0.0, -60.0, 5.0],
            target: [0.0, 0.0, 5.0],
            up: [0.0, 0.0, 1.0],
            projection: crate::picture::render::Projection::Orthographic { height: 12.0 },
            shift: [0.0; 2],
        };
        let image = draw(&scene, &camera, &Overlay::default(), 240, 240);
        // 20 pixels a µm: 2 µm above and below the middle, on the right.
        [image.pixel(160, 80), image.pixel(160, 160)]
    };
    let plain = seen(&positions, &[]);
    let [[up, down], turned_plain, [turned_up, turned_down]] =
        [seen(&positions, &[0]), seen(&turned, &[]), seen(&turned, &[0])];
    assert!(up != plain[0] && down == plain[1], "{up:?} {down:?} {plain:?}");
    assert!(turned_up == turned_plain[0] && turned_down != turned_plain[1]);
    assert_eq!(seen(&positions, &[1]), plain, "the other type is marked alone");
}

#[test]
fn links_are_lines_from_centre_to_centre() {
    let (layout, positions) = two_cells();
    let look = Look { opacity: Some(0.35), ..Look::default() };
    let (from, to) = ([0.0, 0.0, 5.0], [12.0, 0.0, 5.0]);
    let tubes = |numbers: &[f64]| {
        let links: Vec<Joint> = numbers.iter().map(|number| ([from, to], *number)).collect();
        let snapshot = Snapshot { links: Some(&links), ..instant(&layout, &positions) };
        let mut framing = Framing::new(&look);
        framing.include(&snapshot);
        scene_of(&snapshot, &look, &framing).strokes.positions
    };
    assert!(tubes(&[]).is_empty());
    let most = tubes(&[4.0]);
    let ends = most.iter().map(|p| p[0]).fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)]);
    assert!((ends[0] - from[0]).abs() < 1e-9 && (ends[1] - to[0]).abs() < 1e-9, "{ends:?}");
    // The radius goes with the root of the number.
    let radius = |tube: &[[f64; 3]]| (Vec3::from(tube[0]) - Vec3::from(from)).norm();
    let both = tubes(&[1.0, 4.0]);
    let (few, many) = both.split_at(most.len());
    assert_eq!(many, most);
    assert!(radius(few) < 0.8 * radius(many) && radius(few) > 0.5 * radius(many), "{} {}", radius(few), radius(many));
}

#[test]
#[ignore = "gallery: writes pictures for a person to judge into PICTURES or the temporary folder"]
fn gallery_of_frames() {
    let folder = std::env::var_os("PICTURES").map_or_else(std::env::temp_dir, std::path::PathBuf::from);
    let (layout, positions) = two_cells();
    let look = Look { title: "Two cells approach".into(), label: "height (µm)".into(), ..Look::default() };
    let frames: Vec<Vec<[f64; 3]>> = (0..20)
        .map(|k| positions.iter().map(|p| [p[0] + 0.2 * f64::from(k) * (6.0 - p[0]).signum(), p[1], p[2]]).collect())
        .collect();
    let heights: Vec<f64> = positions.iter().map(|p| p[2]).collect();
    let snapshot =
        |k: usize| Snapshot { time: k as f64, values: Values::Atoms(&heights), ..instant(&layout, &frames[k]) };
    let mut framing = Framing::new(&look);
    (0..20).for_each(|k| framing.include(&snapshot(k)));
    let mut movie = crate::picture::Movie::create(&folder.join("approach.gif"), 10.0).unwrap();
    let start = std::time::Instant::now();
    for k in 0..20 {
        let image = picture_of(&snapshot(k), &look, &framing, 960, 540);
        if k == 12 {
            image.save_png(&folder.join("approach.png")).unwrap();
        }
        movie.add(&image).unwrap();
    }
    let written = movie.finish().unwrap();
    let (shown, _) = crate::picture::movie::tests::played(&written.path);
    shown[12].save_png(&folder.join("approach_from_gif.png")).unwrap();
    println!("{:?} in {:?}, {} bytes", written, start.elapsed(), written.path.metadata().unwrap().len());
}
