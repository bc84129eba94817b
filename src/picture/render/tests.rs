//! What a picture promises, and a gallery for a person to judge.

use super::*;
use crate::picture::colour::{Colour, ColourMap};

/// A sphere of 20 · 4^`splits` facets.
pub(crate) fn sphere(centre: [f64; 3], radius: f64, splits: usize) -> Surface {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let corner = |x: f64, y: f64, z: f64| crate::Vec3::new(x, y, z).normalize();
    let mut points: Vec<crate::Vec3> = [(0.0, 1.0, g), (0.0, -1.0, g), (0.0, 1.0, -g), (0.0, -1.0, -g)]
        .into_iter()
        .flat_map(|(a, b, c)| [corner(a, b, c), corner(b, c, a), corner(c, a, b)])
        .collect();
    // Corners of the icosahedron are neighbours at the distance of its edge, 2/√(1+g²) on the unit sphere.
    let edge = 2.0 / (1.0 + g * g).sqrt() * 1.01;
    let near = |points: &[crate::Vec3], i: usize, j: usize| (points[i] - points[j]).norm() < edge;
    let mut facets: Vec<[u32; 3]> = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(&points, i, j) && near(&points, j, k) && near(&points, i, k) {
                    let outward = (points[j] - points[i]).cross(&(points[k] - points[i])).dot(&points[i]) > 0.0;
                    facets.push(if outward { [i, j, k] } else { [i, k, j] }.map(|n| n as u32));
                }
            }
        }
    }
    for _ in 0..splits {
        let mut middles = std::collections::HashMap::new();
        let old = std::mem::take(&mut facets);
        for [a, b, c] in old {
            let mut middle = |p: u32, q: u32| {
                *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    points.push((points[p as usize] + points[q as usize]).normalize());
                    points.len() as u32 - 1
                })
            };
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            facets.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
    }
    let positions = points.iter().map(|p| (p * radius + crate::Vec3::from(centre)).into()).collect();
    Surface::new(positions, facets, Colour([0x80; 3]))
}

/// The biconcave shape of Evans and Fung (1972), 7.82 µm across.
fn red_cell(centre: [f64; 3], splits: usize) -> Surface {
    let mut surface = sphere([0.0; 3], 1.0, splits);
    let r0 = 3.91;
    for p in &mut surface.positions {
        let rho = p[0].hypot(p[1]).min(1.0);
        let thickness = (1.0 - rho * rho).sqrt() * (0.81 + 7.83 * rho * rho - 4.39 * rho.powi(4)) / 2.0;
        let z = thickness * p[2].signum() * if p[2].abs() < 1e-12 { 0.0 } else { 1.0 };
        *p = [centre[0] + r0 * p[0], centre[1] + r0 * p[1], centre[2] + z];
    }
    surface
}

pub(crate) fn front() -> Camera {
    Camera {
        eye: [0.0, -50.0, 0.0],
        target: [0.0; 3],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Orthographic { height: 20.0 },
        shift: [0.0; 2],
    }
}

fn bare() -> Overlay {
    Overlay { scale_bar: ScaleBar::Hidden, ..Overlay::default() }
}

/// A patch of cells on a floor that grows from 0 to 1 in colour.
fn crowd(splits: usize) -> Scene {
    let mut scene = Scene::default();
    for n in 0..25usize {
        let (i, j) = (n % 5, n / 5);
        let (x, y) = (10.4 * i as f64 + 3.0 * (j % 2) as f64, 9.6 * j as f64);
        let mut cell = sphere([x, y, 4.6], 5.0, splits);
        for (k, p) in cell.positions.iter_mut().enumerate() {
            // Flattened below and a little irregular, as cells on glass are.
            let wave = 1.0 + 0.05 * (0.9 * p[0] + n as f64).sin() * (1.1 * p[1] + 2.0 * n as f64).cos();
            *p = [x + (p[0] - x) * wave, y + (p[1] - y) * wave, p[2].max(0.02 * (k % 2) as f64)];
        }
        cell.colour = SurfaceColour::Uniform(Colour::of_palette(if n % 3 == 0 { 3 } else { n % 2 }));
        scene.surfaces.push(cell);
    }
    scene.floor = Some(Floor { point: [22.0, 20.0, 0.0], normal: [0.0, 0.0, 1.0], grid: 10.0, radius: 110.0 });
    scene
}

fn view_of(scene: &Scene, overlay: &Overlay, direction: [f64; 3], projection: Projection) -> Camera {
    let points: Vec<[f64; 3]> =
        scene.surfaces.iter().chain([&scene.strokes]).flat_map(|s| s.positions.iter().copied()).collect();
    Camera::fit(&points, direction, [0.0, 0.0, 1.0], projection, 1280.0 / 720.0, overlay.insets())
}

#[test]
fn a_picture_is_the_same_for_one_and_two_threads() {
    let scene = crowd(2);
    let overlay = Overlay { title: "cells".into(), ..Overlay::default() };
    let camera = view_of(&scene, &overlay, [0.3, -1.0, 0.8], Projection::Perspective { angle: 0.4 });
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| draw(&scene, &camera, &overlay, 320, 181))
    };
    assert!(with(1) == with(2));
}

#[test]
fn a_sphere_covers_the_disc_it_should() {
    let white = Colour([255; 3]);
    let scene =
        Scene { surfaces: vec![sphere([0.0; 3], 5.0, 4)], background: Background::plain(white), ..Scene::default() };
    let image = draw(&scene, &front(), &bare(), 400, 400);
    let covered = (0..400 * 400).filter(|n| image.pixel(n % 400, n / 400).0[0] < 200).count() as f64;
    // 20 pixels per µm. The mesh of 5 120 flat facets lies inside the sphere, less than 0.2 % in radius, and the rim
    // of half-covered pixels is counted to within a fraction of a pixel.
    let radius = (covered / std::f64::consts::PI).sqrt();
    assert!((radius - 100.0).abs() < 0.7, "{radius} px");
    for (x, y) in [(102, 200), (298, 200), (200, 102), (200, 298)] {
        assert_ne!(image.pixel(x, y), white, "({x}, {y}) should be inside");
    }
    for (x, y) in [(98, 200), (302, 200), (200, 98), (200, 302)] {
        assert_eq!(image.pixel(x, y), white, "({x}, {y}) should be outside");
    }
}

#[test]
fn solids_that_are_cut_show_flat_faces_of_their_size() {
    let white = Colour([255; 3]);
    let solid = |x: f64, colour: Colour| Surface {
        colour: SurfaceColour::Uniform(colour),
        is_solid: true,
        ..sphere([x, 0.0, 0.0], 4.0, 4)
    };
    // A little inside each other, as cells that press on each other may be, and one more behind both.
    let surfaces = vec![
        solid(-3.98, Colour([200, 0, 0])),
        solid(3.98, Colour([0, 0, 200])),
        Surface { positions: sphere([0.0, 9.0, 0.0], 4.0, 4).positions, ..solid(0.0, Colour([0, 200, 0])) },
    ];
    // Half a radius behind the middles of the first two: their faces have radius √12.
    let scene =
        Scene { surfaces, cut: Some([0.0, 2.0, 0.0]), background: Background::plain(white), ..Scene::default() };
    for projection in [front().projection, Projection::Perspective { angle: 0.05 }] {
        let camera = Camera { projection, eye: [0.0, -400.0, 0.0], ..front() };
        let image = draw(&scene, &camera, &bare(), 400, 400);
        let [red, blue] = [119, 281].map(|x| image.pixel(x, 200));
        assert!(red.0[0] > red.0[2] && blue.0[2] > blue.0[0], "{red:?} {blue:?}");
        // The cut is 402 µm from the eye and the target 400.
        let smaller = if projection == front().projection { 1.0 } else { 400.0 / 402.0 };
        let scale = camera.pixels_per_micron(400) * smaller;
        for face in [red, blue] {
            let count = (0..400 * 400).filter(|n| image.pixel(n % 400, n / 400) == face).count() as f64;
            let radius = (count / std::f64::consts::PI).sqrt() / scale;
            // Pixels of the rim, a twentieth of a µm wide, are of two colours and do not count; the mesh lies 0.2 % inside the sphere.
            assert!((radius - 12f64.sqrt()).abs() < 0.06, "{radius} µm");
        }
    }
}

#[test]
fn cells_of_one_colour_have_a_line_between_them() {
    let cell = |x: f64, z: f64| Surface { is_outlined: true, ..sphere([x, 0.0, z], 5.0, 4) };
    let lines = |surfaces: Vec<Surface>| {
        let plain = Scene { surfaces, background: Background::plain(Colour([255; 3])), ..Scene::default() };
        let mut bare_scene = plain.clone();
        bare_scene.surfaces.iter_mut().for_each(|surface| surface.is_outlined = false);
        let [with, without] = [plain, bare_scene].map(|scene| draw(&scene, &front(), &bare(), 400, 400));
        (0..400 * 400)
            .map(|n| (n % 400, n / 400))
            .filter(|(x, y)| with.pixel(*x, *y) != without.pixel(*x, *y))
            .collect()
    };
    // 20 pixels per µm: they meet in a line of 8 µm, upright or level; a pixel or two wide, without a gap between bands of rows.
    let upright: Vec<(usize, usize)> = lines(vec![cell(-3.0, 0.0), cell(3.0, 0.0)]);
    assert!((125..=161).all(|y| upright.iter().any(|at| at.1 == y)), "{upright:?}");
    assert!(upright.len() < 2 * 165 && upright.iter().all(|(x, _)| x.abs_diff(200) < 3), "{}", upright.len());
    let level: Vec<(usize, usize)> = lines(vec![cell(0.0, -3.0), cell(0.0, 3.0)]);
    assert!((125..=275).all(|x| level.iter().any(|at| at.0 == x)) && level.len() < 2 * 165, "{}", level.len());
    assert!(lines(vec![cell(0.0, 0.0)]).is_empty(), "one cell has no line");
}

#[test]
fn near_things_hide_far_ones() {
    let red = Surface { colour: SurfaceColour::Uniform(Colour([255, 0, 0])), ..sphere([0.0, -8.0, 0.0], 3.0, 2) };
    let blue = Surface { colour: SurfaceColour::Uniform(Colour([0, 0, 255])), ..sphere([0.0; 3], 5.0, 2) };
    for (projection, surfaces) in [
        (front().projection, vec![red.clone(), blue.clone()]),
        (Projection::Perspective { angle: 0.4 }, vec![blue, red]),
    ] {
        let scene = Scene { surfaces, ..Scene::default() };
        let image = draw(&scene, &Camera { projection, ..front() }, &bare(), 200, 200);
        let [r, _, b] = image.pixel(100, 100).0;
        assert!(r > b, "the red sphere is nearer");
        let [r, _, b] = image.pixel(100, 58).0;
        assert!(b > r, "the blue sphere is larger");
    }
}

#[test]
fn the_scale_bar_has_the_length_it_says() {
    let overlay = Overlay { scale_bar: ScaleBar::Length(5.0), ..Overlay::default() };
    let scene = Scene { background: Background::plain(Colour([255; 3])), ..Scene::default() };
    let image = draw(&scene, &front(), &overlay, 800, 400);
    let longest = (0..400).map(|y| (0..800).filter(|x| image.pixel(*x, y).0[0] < 60).count()).max().unwrap();
    // 20 pixels per µm; an end may fall inside a pixel.
    assert!((99..=101).contains(&longest), "{longest} px");
    let auto = Overlay::default().to_svg(1280, 720, 20.0, None);
    assert!(auto.contains("10 µm") && auto.contains(r#"width="200.000""#), "{auto}");
}

#[test]
fn axes_stand_between_scale_bar_and_key_and_are_left_out_where_there_is_no_space() {
    let axes = |overlay: &Overlay, width: usize| {
        let tripod = super::tripod::Tripod::of(&front());
        overlay.to_svg(width, 720, 20.0, Some(&tripod)).matches("class=\"axis\"").count()
    };
    let names = |count: usize| Key::Names((0..count).map(|k| (format!("population {k}"), Colour([0; 3]))).collect());
    let bar = |label: &str| Key::Bar { map: ColourMap::Viridis, low: 0.0, high: 1.0, label: label.into() };
    let overlay = |key: Key| Overlay { key, axes: true, ..Overlay::default() };
    // Each of three lines twice: with its rim.
    for key in [Key::None, names(2), names(9), bar("volume (fL)")] {
        assert_eq!(axes(&overlay(key.clone()), 1280), 6, "{key:?}");
    }
    assert_eq!(axes(&overlay(bar("a label that goes on and on and on and on and on and on and on")), 720), 0);
    let drawn = |axes: bool, width: usize| {
        let scene = Scene { background: Background::plain(Colour([255; 3])), ..Scene::default() };
        let image =
            draw(&scene, &front(), &Overlay { axes, scale_bar: ScaleBar::Hidden, ..Overlay::default() }, width, 360);
        let is_inked = |x: usize, y: usize| image.pixel(x, y) != Colour([255; 3]);
        let all = (0..width).flat_map(|x| (0..360).map(move |y| (x, y))).filter(|(x, y)| is_inked(*x, *y));
        all.collect::<Vec<_>>()
    };
    assert!(drawn(false, 640).is_empty());
    let inked = drawn(true, 640);
    // Within the band below the scene that is kept free.
    assert!(inked.len() > 60 && inked.iter().all(|(x, y)| *x < 80 && *y > 360 - 35), "{:?}", inked.first());
}

#[test]
fn a_fitted_camera_shows_everything_within_the_insets() {
    let scene = crowd(1);
    let overlay = Overlay { title: "t".into(), ..Overlay::default() };
    for projection in [Projection::Orthographic { height: 1.0 }, Projection::Perspective { angle: 0.5 }] {
        for direction in [[0.0, 0.0, 1.0], [0.0, -1.0, 0.3], [1.0, 2.0, 0.7]] {
            let camera = view_of(&scene, &overlay, direction, projection);
            let view = View::new(&camera, 1280, 720);
            let inside = overlay.insets();
            let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
            for p in scene.surfaces.iter().flat_map(|s| &s.positions) {
                let (at, _) = view.project(&(crate::Vec3::from(*p) - view.target)).unwrap();
                for k in 0..2 {
                    low[k] = low[k].min(at[k]);
                    high[k] = high[k].max(at[k]);
                }
            }
            // The fit of a perspective camera is iterated to about a pixel.
            let slack = 3.0;
            assert!(f64::from(low[1]) > 720.0 * inside.top - slack, "{direction:?} {low:?}");
            assert!(f64::from(high[1]) < 720.0 * (1.0 - inside.bottom) + slack, "{direction:?} {high:?}");
            assert!(f64::from(low[0]) > 720.0 * inside.sides - slack && high[0] < 1280.0 - 32.0 + slack as f32);
            let fills = (high[1] - low[1]) / 720.0 > 0.6 || (high[0] - low[0]) / 1280.0 > 0.6;
            assert!(fills, "{direction:?} {low:?} {high:?}");
        }
    }
}

#[test]
fn broken_input_is_left_out() {
    let mut surface = sphere([0.0; 3], 5.0, 1);
    surface.positions[3] = [f64::NAN, 0.0, 0.0];
    surface.facets.push([0, 1, 9999]);
    surface.colour = SurfaceColour::PerAtom(vec![]);
    let mut scene = Scene { surfaces: vec![surface, Surface::default()], ..Scene::default() };
    scene.add_arrow([0.0; 3], [0.0; 3], 1.0, Colour([0; 3]));
    scene.add_line([f64::NAN; 3], [0.0; 3], 1.0, Colour([0; 3]));
    scene.floor = Some(Floor { point: [0.0; 3], normal: [0.0; 3], grid: 1.0, radius: 10.0 });
    assert_eq!(draw(&scene, &front(), &Overlay::default(), 1, 1).rgb.len(), 3);
    assert_eq!(draw(&scene, &front(), &Overlay::default(), 90, 70).rgb.len(), 3 * 90 * 70);
}

#[test]
fn times_are_written_in_one_unit_for_the_whole_movie() {
    assert_eq!(time_text(0.0, 12.0, None), "t = 0.0 s");
    assert_eq!(time_text(12.0, 12.0, None), "t = 12.0 s");
    assert_eq!(time_text(90.0, 1200.0, None), "t = 1.5 min");
    assert_eq!(time_text(0.0, 0.0, None), "t = 0.0 µs");
    // A document of 8 min is told in minutes, one of 0.001 h is not told in hours.
    assert_eq!(time_text(90.0, 480.0, ClockUnit::named("min", 480.0)), "t = 1.50 min");
    assert_eq!(time_text(2.0, 3.6, ClockUnit::named("h", 3.6)), "t = 2.00 s");
    assert_eq!(ClockUnit::named("fortnight", 1e9), None);
}

#[test]
#[ignore = "gallery: writes pictures for a person to judge into PICTURES or the temporary folder"]
fn gallery_of_scenes() {
    let folder = std::env::var_os("PICTURES").map_or_else(std::env::temp_dir, std::path::PathBuf::from);
    let save = |name: &str, scene: &Scene, camera: &Camera, overlay: &Overlay| {
        let mut best = f64::INFINITY;
        for _ in 0..8 {
            let start = std::time::Instant::now();
            std::hint::black_box(draw(scene, camera, overlay, 1280, 720));
            best = best.min(1e3 * start.elapsed().as_secs_f64());
        }
        let path = folder.join(name);
        draw(scene, camera, overlay, 1280, 720).save_png(&path).unwrap();
        println!("{name}: drawn in {best:.0} ms (best of 8), {} bytes", path.metadata().unwrap().len());
    };
    let ortho = Projection::Orthographic { height: 1.0 };
    let scene = crowd(3);
    let overlay = Overlay {
        title: "Two populations on glass".into(),
        time: time_text(754.0, 1200.0, None),
        key: Key::Names(vec![
            ("epithelial".into(), Colour::of_palette(0)),
            ("mesenchymal".into(), Colour::of_palette(1)),
            ("leader".into(), Colour::of_palette(3)),
        ]),
        ..Overlay::default()
    };
    let camera = view_of(&scene, &overlay, [0.25, -1.0, 0.75], ortho);
    save("crowd.png", &scene, &camera, &overlay);

    let mut scene = Scene::default();
    let mut cell = red_cell([0.0, 0.0, 0.0], 4);
    cell.positions.iter_mut().for_each(|p| *p = [1.35 * p[0], 0.8 * p[1], p[2]]);
    let strain = |p: &[f64; 3]| (p[0] / 5.3).powi(2);
    cell.colour = SurfaceColour::PerAtom(cell.positions.iter().map(|p| ColourMap::Viridis.at(strain(p))).collect());
    cell.edges = Edges::Thin;
    scene.surfaces.push(cell);
    let dark = Colour([0x3c, 0x40, 0x48]);
    scene.add_arrow([5.4, 0.0, 0.0], [8.0, 0.0, 0.0], 0.12, dark);
    scene.add_arrow([-5.4, 0.0, 0.0], [-8.0, 0.0, 0.0], 0.12, dark);
    let overlay = Overlay {
        title: "Red cell pulled with 88 pN".into(),
        time: time_text(2.0, 2.0, None),
        key: Key::Bar { map: ColourMap::Viridis, low: 0.0, high: 0.45, label: "stretch of facets".into() },
        ..Overlay::default()
    };
    let camera = view_of(&scene, &overlay, [0.25, -0.8, 0.65], ortho);
    save("red_cell.png", &scene, &camera, &overlay);

    let mut scene = Scene::default();
    let mut cell = sphere([0.0, 0.0, 2.6], 3.2, 1);
    cell.positions.iter_mut().for_each(|p| p[2] = 2.6 + 0.81 * (p[2] - 2.6));
    cell.edges = Edges::Thin;
    cell.colour = SurfaceColour::Uniform(Colour::of_palette(2));
    cell.opacity = 0.3;
    for facet in &cell.facets.clone() {
        let at = |k: usize| cell.positions[facet[k] as usize];
        scene.add_line(at(0), [0.0, 0.0, 2.6], 0.03, dark);
    }
    scene.surfaces.push(cell);
    scene.floor = Some(Floor { point: [0.0; 3], normal: [0.0, 0.0, 1.0], grid: 1.0, radius: 12.0 });
    scene.panes.push(Pane {
        centre: [0.0, 0.0, 5.2],
        half_u: [5.0, 0.0, 0.0],
        half_v: [0.0, 5.0, 0.0],
        colour: Colour([0x7f, 0x98, 0xb0]),
    });
    let overlay = Overlay { title: "Compression between plates".into(), ..Overlay::default() };
    let camera = view_of(&scene, &overlay, [0.3, -1.0, 0.35], Projection::Perspective { angle: 0.45 });
    save("plates.png", &scene, &camera, &overlay);
}

#[test]
fn what_is_asked_to_be_up_is_up() {
    let points = [[0.0; 3], [10.0, 0.0, 0.0], [0.0, 2.0, 1.0]];
    let fit = |up| {
        Camera::fit(&points, [0.0, 0.0, 1.0], up, Projection::Orthographic { height: 1.0 }, 1.0, Insets::default())
    };
    let (along_y, along_x) = (fit([0.0, 1.0, 0.0]), fit([1.0, 0.0, 0.3]));
    assert_eq!(along_y.up, [0.0, 1.0, 0.0]);
    // At a right angle to the view.
    assert_eq!(along_x.up, [1.0, 0.0, 0.0]);
}
