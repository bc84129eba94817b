//! What pictures of a result show: quantities of atoms, loads as arrows; and what the result calls the loads.

use pseudopod::experiment::{Document, Picture, When};
use pseudopod::output::{Overwrite, ResultFile};
use pseudopod::picture::Display;
use pseudopod::picture::arrows::LoadArrows;
use pseudopod::picture::from_file::{check_colour, cut_out, still, still_as};
use pseudopod::picture::quantities::AtomQuantity;
use pseudopod::run::{Quiet, RunOptions, run};
use std::path::Path;

const TEXT: &str = r#"
title = "two pulled spheres"
[run]
until = "4 s"
[output]
every = "1 s"
[cells.soft]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
mechanics = { drag = "2 pN s/um", shape_memory = { shape_modulus = "2 pN/um" } }
loads = [{ name = "pull", cap = { direction = [0, 0, 1], number = 1 }, direction = [0, 0, 1], force = [["0 s", "0 pN"], ["4 s", "4 pN"]] }]
[cells.stiff]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["20 um", "0 um", "0 um"]] }
mechanics = { drag = "2 pN s/um", shape_memory = { shape_modulus = "9 pN/um" } }
loads = [
    { name = "pull", cap = { direction = [0, 0, 1], number = 1 }, direction = [0, 0, 1], force = "2 pN" },
    { name = "push", cap = { direction = [0, 0, -1], number = 1 }, direction = [0, 0, 1], force = "2 pN" },
]
"#;

fn result(folder: &Path, extra: &str) -> (ResultFile, Document) {
    let text = TEXT.replace("every = \"1 s\"", &format!("every = \"1 s\"\n{extra}"));
    let document = Document::parse("pulled.toml", &text, folder, &[]).unwrap_or_else(|error| panic!("{error}"));
    let path = folder.join("result.vtkhdf");
    run(&document, &RunOptions { overwrite: Overwrite::Replace, ..RunOptions::new(&path) }, &mut Quiet).unwrap();
    (ResultFile::open(&path).unwrap(), document)
}

#[test]
fn loads_that_share_a_name_are_recorded_apart() {
    let folder = tempfile::tempdir().unwrap();
    let (result, _) = result(folder.path(), "");
    let (times, soft) = (result.times().unwrap(), result.scene_series("load.soft.pull").unwrap());
    // A frame is taken at the end of the step in which it is due; the load rises by 1 pN a second.
    assert!(times.iter().zip(&soft).all(|(time, force)| (time - force).abs() < 1e-12), "{times:?} {soft:?}");
    assert_eq!(result.scene_series("load.stiff.pull").unwrap(), [2.0; 5]);
    assert_eq!(result.scene_series("load.push").unwrap(), [2.0; 5]);
}

#[test]
fn arrows_stand_outside_the_cell_and_are_as_long_as_the_force_is_strong() {
    let folder = tempfile::tempdir().unwrap();
    let (result, document) = result(folder.path(), "");
    let arrows = LoadArrows::of(&document).unwrap();
    let (cells, positions) = (result.cells(0), result.positions(0).unwrap());
    let at = |time: f64| arrows.at(time, result.layout(), &cells, &positions);
    assert_eq!(at(0.0).len(), 2, "a load of nothing shows nothing");
    let [soft, pull, push] = at(2.0)[..] else { panic!("three loads") };
    let length = |[tail, tip]: [[f64; 3]; 2]| (0..3).map(|k| (tip[k] - tail[k]).powi(2)).sum::<f64>().sqrt();
    assert!((length(soft) - length(pull)).abs() < 1e-12, "2 pN each");
    // The pull starts at the top of the sphere, the push ends at its bottom; the outermost atoms stand at 5 µm or less.
    assert!(pull[0][2] > 4.0 && pull[1][2] > pull[0][2], "{pull:?}");
    assert!(push[1][2] < -4.0 && push[0][2] < push[1][2], "{push:?}");
}

#[test]
fn pictures_colour_by_what_the_atoms_have() {
    let folder = tempfile::tempdir().unwrap();
    let (file, document) = result(folder.path(), "forces = true");
    for name in ["type", "volume", "speed", "height", "displacement", "curvature", "force"] {
        check_colour(&file, name).unwrap();
        let picture = Picture { colour_by: name.into(), width: 160, height: 90, loads: true, ..Picture::default() };
        still(&file, &document, &picture).unwrap();
    }
    let positions = file.positions(0).unwrap();
    let curvature = AtomQuantity::Curvature.of_frame(&file, 0, &positions).unwrap();
    // A sphere of 5 µm; 42 atoms know its curvature to a few percent.
    assert!(curvature.iter().all(|h| (h - 0.2).abs() < 0.02), "{curvature:?}");
    let moved = AtomQuantity::Displacement.of_frame(&file, 4, &file.positions(4).unwrap()).unwrap();
    let largest = moved.iter().copied().fold(0.0, f64::max);
    assert!(largest > 0.1 && largest < 20.0, "{largest}");
    let picture =
        Picture { time: When::First, colour_by: "height".into(), width: 160, height: 90, ..Picture::default() };
    let (top, bottom) = {
        let image = still(&file, &document, &picture).unwrap();
        (image.pixel(48, 30), image.pixel(48, 60))
    };
    assert_ne!(top, bottom, "the top of a sphere has another colour than its bottom");
}

#[test]
fn forces_that_were_not_recorded_cannot_be_shown() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = result(folder.path(), "");
    let text = |name: &str| check_colour(&file, name).unwrap_err().to_string();
    assert!(text("force").contains("no forces"), "{}", text("force"));
    assert!(text("colour").contains("nothing in"), "{}", text("colour"));
}

#[test]
fn a_picture_has_up_what_its_document_says() {
    let folder = tempfile::tempdir().unwrap();
    let (file, document) = result(folder.path(), "");
    let seen = |up: [f64; 3]| {
        let mut picture = Picture { width: 160, height: 90, ..Picture::default() };
        (picture.view.from, picture.view.up) = ([0.0, -1.0, 0.0], up);
        let image = still(&file, &document, &picture).unwrap();
        (0..160).flat_map(|x| (0..90).map(move |y| (x, y))).map(|(x, y)| image.pixel(x, y)).collect::<Vec<_>>()
    };
    // Two cells side by side, or one above the other.
    assert!(seen([0.0, 0.0, 1.0]) != seen([1.0, 0.0, 0.0]));
}

/// How many pixels of a picture are blue or vermilion, the colours of the first and the second type.
fn blue_and_red(image: &pseudopod::picture::Image) -> [usize; 2] {
    let count = |strong: usize, weak: usize| {
        image.rgb.chunks_exact(3).filter(|p| i32::from(p[strong]) - i32::from(p[weak]) > 60).count()
    };
    [count(2, 0), count(0, 2)]
}

#[test]
fn what_is_hidden_is_neither_seen_nor_named_nor_makes_space() {
    let folder = tempfile::tempdir().unwrap();
    let (file, document) = result(folder.path(), "");
    let picture = Picture { width: 320, height: 180, loads: true, ..Picture::default() };
    let seen = |hidden: &[&str], colour_by: &str| {
        let hidden = hidden.iter().map(ToString::to_string).collect();
        let picture = Picture { colour_by: colour_by.into(), ..picture.clone() };
        still_as(&file, &document, &picture, &Display { hidden, axes: false, ..Display::default() })
    };
    let [both, one] = [&[][..], &["stiff"]].map(|hidden| blue_and_red(&seen(hidden, "type").unwrap()));
    assert!(both[0] > 1000 && both[1] > 1000, "{both:?}");
    assert!(4 * one[0] > 5 * both[0] && one[1] == 0, "{both:?} {one:?}");
    for colour_by in ["volume", "height"] {
        assert!(seen(&["soft"], colour_by).is_ok());
    }
    let fault = seen(&["stif"], "type").unwrap_err().to_string();
    assert!(fault.contains("stif"), "{fault}");
}

#[test]
fn a_zoom_of_two_shows_everything_twice_as_large() {
    let folder = tempfile::tempdir().unwrap();
    let (file, document) = result(folder.path(), "");
    let picture = Picture { width: 320, height: 180, ..Picture::default() };
    let bare = Display { title: Some(String::new()), scale_bar: false, time: false, axes: false, ..Display::default() };
    let blue = |zoom: f64| {
        let display = Display { zoom, hidden: vec!["stiff".into()], ..bare.clone() };
        blue_and_red(&still_as(&file, &document, &picture, &display).unwrap())[0] as f64
    };
    let ratio = blue(0.5) / blue(0.25);
    assert!((ratio - 4.0).abs() < 0.15, "{ratio}");
}

#[test]
fn a_cut_out_has_nothing_behind_the_cells_and_no_words_that_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let (file, document) = result(folder.path(), "");
    let picture = Picture { width: 320, height: 180, ..Picture::default() };
    let bare = Display { title: Some(String::new()), scale_bar: false, time: false, axes: false, ..Display::default() };
    let cut = |display: &Display| cut_out(&file, &document, &picture, display).unwrap();
    let opacity = |cut: &pseudopod::picture::image::CutOut, x: usize, y: usize| cut.rgba[4 * (320 * y + x) + 3];
    let [plain, worded] = [cut(&bare), cut(&Display::default())];
    assert_eq!(opacity(&plain, 0, 0), 0);
    assert!(plain.rgba.iter().skip(3).step_by(4).any(|opacity| *opacity == 255));
    let marked = |cut: &pseudopod::picture::image::CutOut| {
        (0..320).flat_map(|x| (0..20).map(move |y| (x, y))).filter(|(x, y)| opacity(cut, *x, *y) > 64).count()
    };
    assert!(marked(&plain) == 0 && marked(&worded) > 8, "{} {}", marked(&plain), marked(&worded));
}
