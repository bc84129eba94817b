//! What the page in the browser is answered: that it is what the result holds, whole, and within 16 bits where it is told so.

use crate::example;
use pseudopod::output::ResultFile;
use pseudopod::view::{Answer, Film, Live, Scene, Server};
use std::io::{Read as _, Write as _};
use std::net::TcpStream;

fn number(bytes: &[u8], at: usize) -> f32 {
    f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn bytes(scene: &Scene, request: &str) -> Vec<u8> {
    match scene.answer(request).unwrap() {
        Some(Answer::Bytes(bytes)) => bytes,
        other => panic!("{request}: {other:?}"),
    }
}

fn json(scene: &Scene, request: &str) -> serde_json::Value {
    match scene.answer(request).unwrap() {
        Some(Answer::Text(text)) => serde_json::from_str(&text).unwrap(),
        other => panic!("{request}: {other:?}"),
    }
}

#[test]
fn positions_values_and_fields_are_those_of_the_result() {
    let folder = tempfile::tempdir().unwrap();
    let path = example::write(folder.path(), "");
    let (scene, result) = (Scene::open(&path).unwrap(), ResultFile::open(&path).unwrap());
    let frame = bytes(&scene, "frame/4");
    let u32_at = |at: usize| u32::from_le_bytes(frame[at..at + 4].try_into().unwrap()) as usize;
    let (cells, atoms) = (u32_at(0), u32_at(4));
    let positions = result.positions(4).unwrap();
    assert_eq!((cells, atoms), (3, positions.len()));
    for axis in 0..3 {
        let (low, side) = (f64::from(number(&frame, 8 + 4 * axis)), f64::from(number(&frame, 20 + 4 * axis)));
        for (atom, position) in positions.iter().enumerate() {
            let at = 32 + 12 * cells + 2 * (axis * atoms + atom);
            let part = f64::from(u16::from_le_bytes([frame[at], frame[at + 1]])) / 65_535.0;
            assert!((low + part * side - position[axis]).abs() < 0.51 * side / 65_535.0 + 1e-5, "{axis} {atom}");
        }
    }
    let volume = bytes(&scene, "values/4/volume");
    assert_eq!([0, 4, 8].map(|at| number(&volume, at)), [500.0, 501.0, 502.0]);
    assert_eq!(bytes(&scene, "values/4/height").len(), 4 * atoms);
    // Of a cell without the system there is no number.
    assert!(number(&bytes(&scene, "values/4/clock.U"), 8).is_nan());
    let told = bytes(&scene, "field/4/attractant.attractant");
    let values = result.field_frame("attractant", "attractant", 4).unwrap();
    let (low, high) = (f64::from(number(&told, 0)), f64::from(number(&told, 4)));
    for (value, part) in values.iter().zip(told[8..].chunks_exact(2)) {
        let part = f64::from(u16::from_le_bytes([part[0], part[1]])) / 65_534.0;
        assert!((low + part * (high - low) - value).abs() < 1e-5 * (high - low));
    }
    assert_eq!(json(&scene, "range/volume"), serde_json::json!([500.0, 502.0]));
    assert_eq!(json(&scene, "cell/4/1")["type"], "walker");
    assert_eq!(json(&scene, "curve/bath.level")["values"].as_array().unwrap().len(), example::FRAMES);
    for nothing in [
        "frame/11",
        "frame/x",
        "values/4/none",
        "field/4/none",
        "lines/4/fibres",
        "lines/4/knots",
        "cell/4/9",
        "curve/none",
        "chart/none",
        "",
        "x",
    ] {
        assert_eq!(scene.answer(nothing).unwrap(), None, "{nothing}");
    }
}

#[test]
fn the_scene_says_what_can_be_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scene::open(&example::write(folder.path(), "")).unwrap();
    let about = json(&scene, "scene");
    let list = |name: &str| about[name].as_array().unwrap().clone();
    for quantity in list("quantities") {
        let name = quantity["name"].as_str().unwrap();
        let count = if quantity["of"] == "cells" { 3 } else { 3 * 162 };
        assert_eq!(bytes(&scene, &format!("values/10/{name}")).len(), 4 * count, "{name}");
    }
    assert_eq!(list("types").len(), 2);
    assert_eq!(list("fields").len(), 2);
    for field in list("fields") {
        for species in field["species"].as_array().unwrap() {
            let name = format!("{}.{}", field["name"].as_str().unwrap(), species["name"].as_str().unwrap());
            assert!(bytes(&scene, &format!("field/0/{name}")).len() > 8, "{name}");
            assert!(json(&scene, &format!("range/{name}"))[1].is_number());
        }
    }
    assert_eq!(json(&scene, "course")["times"].as_array().unwrap().len(), example::FRAMES);
    assert!(about["experiment"].as_str().unwrap().contains("[cells.walker]"));
}

#[test]
fn a_film_has_no_more_than_it_may_and_its_first_and_last_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = example::write(folder.path(), "");
    let film = |limit| Film::of(&mut Scene::open(&path).unwrap(), &[], limit).unwrap();
    let whole = film(usize::MAX);
    assert_eq!((whole.frames, whole.of), (example::FRAMES, example::FRAMES));
    let size = pseudopod::view::page::self_contained(&whole).len()
        - pseudopod::view::page::self_contained(&Film::default()).len();
    let part = film(size / 4 * 3);
    assert!((2..example::FRAMES).contains(&part.frames), "{}", part.frames);
    let taken = pseudopod::view::page::self_contained(&part).len()
        - pseudopod::view::page::self_contained(&Film::default()).len();
    assert!(taken <= size / 4 * 3, "{taken} of {size}");
}

/// The answer to a request of HTTP, as a text.
fn answer(address: &str, request: &str, headers: &str) -> String {
    let rest = address.strip_prefix("http://").unwrap();
    let (host, key) = rest.split_once('/').unwrap();
    let mut stream = TcpStream::connect(host).unwrap();
    let (method, path) = request.split_once(' ').unwrap();
    let host = if headers.contains("Host:") { String::new() } else { format!("Host: {host}\r\n") };
    write!(stream, "{method} /{key}{path} HTTP/1.1\r\n{host}{headers}Connection: close\r\n\r\n").unwrap();
    let mut text = Vec::new();
    stream.read_to_end(&mut text).unwrap();
    String::from_utf8_lossy(&text).into_owned()
}

#[test]
fn the_server_answers_this_machine_alone() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&example::write(folder.path(), ""), 0, None).unwrap();
    let address = server.address();
    assert!(address.starts_with("http://127.0.0.1:"), "no other machine can ask: {address}");
    let status = |request: &str, headers: &str| answer(address, request, headers)[9..12].to_owned();
    assert_eq!(status("GET ", ""), "200");
    assert_eq!(status("GET data/course", ""), "200");
    assert_eq!(status("GET data/values/0/speed", ""), "200");
    assert_eq!(status("GET data/values/0/bath.level", ""), "404");
    assert_eq!(status("GET data/frame/99", ""), "404");
    assert_eq!(status("GET ", "Host: attacker.example\r\n"), "403");
    assert_eq!(status("GET ", "Origin: https://attacker.example\r\n"), "403");
    assert_eq!(status("GET now", ""), "204");
    assert_eq!(status("POST pause", ""), "404");
    assert_eq!(status("DELETE data/course", ""), "405");
    let elsewhere = format!("{}x/", &address[..address.len() - 1]);
    assert_eq!(&answer(&elsewhere, "GET ", "")[9..12], "404");
    assert!(answer(address, "GET ", "").contains("Content-Security-Policy: default-src 'self'"));
}

#[test]
fn a_port_that_is_taken_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = example::write(folder.path(), "");
    let first = Server::start(&path, 0, None).unwrap();
    let port = first.address().split([':', '/']).nth(4).unwrap().parse().unwrap();
    let error = Server::start(&path, port, None).err().expect("the port is taken").to_string();
    assert!(error.starts_with(&format!("nothing can be served at port {port} of 127.0.0.1")), "{error}");
}

/// A run that is paused makes no step; that it ends with the same bits is looked at in the browser (`viewer/tests`) and here.
#[test]
fn a_watched_run_has_the_same_bits() {
    use pseudopod::experiment::Document;
    use pseudopod::run::{Quiet, RunOptions, run};
    use pseudopod::view::{Phase, Watched, Wish};
    use std::sync::Arc;
    use std::time::Duration;
    let folder = tempfile::tempdir().unwrap();
    let text = example::TEXT.replace(
        "[cells.rester]",
        "motility = { brownian = { speed = \"20 um/min\", persistence = \"5 s\" } }\n[cells.rester]",
    );
    let text = format!("{text}\n[output]\nevery = \"1 s\"\n");
    let document = Document::parse("watched.toml", &text, folder.path(), &[]).unwrap();
    let alone = folder.path().join("alone.vtkhdf");
    run(&document, &RunOptions::new(&alone), &mut Quiet).unwrap();
    let path = folder.path().join("watched.vtkhdf");
    let options = RunOptions::new(&path);
    let live = Arc::new(Live::new(options.cancel.clone()));
    live.want(Wish::Pause);
    let watcher = Arc::clone(&live);
    let other = std::thread::spawn(move || {
        while watcher.told().phase != Phase::Paused {
            std::thread::sleep(Duration::from_millis(5));
        }
        let paused = watcher.told();
        std::thread::sleep(Duration::from_millis(150));
        assert_eq!(watcher.told().steps, paused.steps, "a run that waits makes no step");
        assert!(watcher.picture().is_some(), "what it waits at is seen");
        watcher.want(Wish::Go);
        while watcher.told().phase != Phase::Ended {
            watcher.picture();
            std::thread::sleep(Duration::from_millis(1));
        }
    });
    let outcome = run(&document, &options, &mut Watched::new(Arc::clone(&live), Box::new(Quiet))).unwrap();
    live.end();
    other.join().unwrap();
    assert!(outcome.steps > 0);
    let [alone, watched] = [&alone, &path].map(|path| ResultFile::open(path).unwrap());
    assert_eq!(alone.frames(), watched.frames());
    for frame in 0..alone.frames() {
        assert_eq!(alone.positions(frame).unwrap(), watched.positions(frame).unwrap());
    }
    assert_eq!(alone.steps().unwrap(), watched.steps().unwrap());
}
