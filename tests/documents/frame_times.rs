//! Frames are at the times that are asked for, wherever steps end; eq. (step.11).

use std::collections::BTreeMap;
use std::path::Path;

use pseudopod::experiment::Document;
use pseudopod::output::{ResultFile, load_checkpoint};
use pseudopod::run::{Quiet, RunOptions, run};

/// Cells that walk, stick and come and go on a floor, beat by themselves and release something.
const DISH: &str = r#"
title = "A dish"
seed = 5
[run]
until = "12 s"
[cells.white]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { grid = [3, 3, 1], spacing = "10.2 um", origin = ["-10 um", "-10 um", "5.1 um"] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
chemistry = ["clock"]
motility = { brownian = { speed = "1 um/s", persistence = "2 s" }, attraction = { to = ["0 um", "0 um", "0 um"], stiffness = "0.02 pN/um" } }
[[cells.white.added]]
time = "4 s"
placement = { at = [["30 um", "0 um", "5.1 um"]] }
[[planes]]
name = "floor"
point = ["0 um", "0 um", "0 um"]
normal = [0, 0, 1]
[contact]
strength = "2 Pa"
[chemistry.clock]
document = "clock.eml"
[chemistry.field]
document = "field.eml"
"#;

const CLOCK: &str = r#"<eml name="clock" level="cell"><variable id="U" initial="1" rate="V"/><variable id="V" initial="0" rate="-U"/>
    <link from="system.U" to="cell.rest_volume_ratio" transfer="1+0.02*value"/><link from="system.U" to="cell.secretion[c]" transfer="1+value"/></eml>"#;
const FIELD: &str = r#"<eml name="field"><grid dimension="2" spacing="4" origin="-60 -60" size="120 120"/>
    <field id="c" diffusion="30" decay="0.2" initial="0"/></eml>"#;

fn dish(output: &str) -> (tempfile::TempDir, ResultFile) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dish.h5");
    let text = format!("{DISH}[output]\ncheckpoint = \"3 s\"\n{output}\n");
    let equations = [("clock.eml", CLOCK), ("field.eml", FIELD)].map(|(name, text)| (name.to_owned(), text.to_owned()));
    let document = Document::parse_beside("dish.toml", &text, Path::new("."), &[], BTreeMap::from(equations));
    let document = document.unwrap_or_else(|error| panic!("{error:?}"));
    run(&document, &RunOptions::new(&path), &mut Quiet).unwrap_or_else(|error| panic!("{error:?}"));
    let result = ResultFile::open(&path).unwrap();
    (folder, result)
}

#[test]
fn frames_are_at_the_times_asked_for_with_exact_volumes_and_change_nothing() {
    let (_kept, result) = dish("every = \"0.07 s\"\ntimes = [\"0.5 s\", \"3.3333 s\"]");
    let (times, within) = (result.times().unwrap(), result.interpolated().unwrap());
    let mut asked: Vec<f64> = (0..=171).map(|number| f64::from(number) * 0.07).collect();
    asked.extend([0.5, 3.3333, 12.0]);
    asked.sort_by(f64::total_cmp);
    assert_eq!(times.len(), asked.len());
    for (time, asked) in times.iter().zip(&asked) {
        assert!((time - asked).abs() <= 1e-12 * asked, "{time} for {asked}");
    }
    let interpolated = within.iter().filter(|within| **within).count();
    assert!(interpolated > 150, "steps end elsewhere: {interpolated}");
    assert!(!within[0] && !within[within.len() - 1], "the start and the end are states of the run");

    let errors = result.cell_series("volume_error").unwrap();
    for (frame, within) in within.iter().enumerate().filter(|(_, within)| **within) {
        let worst = errors.row(frame).iter().filter(|error| !error.is_nan()).fold(0.0f64, |most, e| most.max(e.abs()));
        assert!(worst < 1e-10, "volume of frame {frame} ({within}): {worst}");
        let lowest = result.positions(frame).unwrap().iter().map(|p| p[2]).fold(f64::INFINITY, f64::min);
        assert!(lowest > -1e-10, "an atom is {lowest} um below the floor in frame {frame}");
    }
    // Cells come at 4 s; what is asked for within a step has the cells of the step.
    let cells: Vec<usize> = (0..times.len()).map(|frame| result.cells(frame).len()).collect();
    times.iter().zip(&cells).for_each(|(time, cells)| assert_eq!(*cells, if *time > 4.0 { 10 } else { 9 }, "{time} s"));

    let (_other, alone) = dish("every = \"12 s\"");
    assert_eq!(alone.times().unwrap(), [0.0, 12.0]);
    let end = |result: &ResultFile| load_checkpoint(result.path()).unwrap().unwrap();
    let (seen, unseen) = (end(&result), end(&alone));
    assert_eq!(seen.payload, unseen.payload, "looking within steps changes no bit of the run");
}

#[test]
fn cells_that_press_on_each_other_are_hardly_deeper_within_steps() {
    let (_kept, result) = dish("every = \"0.05 s\"");
    let (depths, within) = (result.scene_series("contact.deepest").unwrap(), result.interpolated().unwrap());
    let deepest = |wanted: bool| {
        depths.iter().zip(&within).filter(|(_, within)| **within == wanted).map(|(depth, _)| *depth).fold(0.0, f64::max)
    };
    let steps = result.steps().unwrap().last().copied().unwrap();
    println!("{steps} steps in 12 s, deepest at ends {}, within {}", deepest(false), deepest(true));
    // Of an edge: a fifth of the 2 % that cells keep to. Chords of paths that bend were measured to cut by 0.2 %.
    assert!(deepest(true) < 0.004, "{} of an edge", deepest(true));
}

#[test]
fn what_is_between_converges_with_the_square_of_the_step() {
    // A pulled cell: frames at 0.35, 0.45, … s, in the middle of steps of 0.1 s and elsewhere within shorter ones.
    let lengths = |step: &str| {
        let times: Vec<String> = (3..20).map(|number| format!("\"{} s\"", f64::from(2 * number + 1) / 20.0)).collect();
        let text = format!(
            r#"
title = "Pulled"
[run]
until = "2 s"
integrator = {{ step = "{step}" }}
[cells.white]
mesh = {{ shape = "icosphere", radius = "5 um", level = 1 }}
mechanics = {{ drag = "20 pN s/um", shape_memory = {{ shape_modulus = "4 pN/um" }} }}
fixed = [{{ cap = {{ direction = [-1, 0, 0], number = 3 }} }}]
loads = [{{ name = "pull", cap = {{ direction = [1, 0, 0], number = 3 }}, direction = [1, 0, 0], force = "10 pN" }}]
[output]
times = [{}]
"#,
            times.join(", ")
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pulled.h5");
        let document = Document::parse("pulled.toml", &text, Path::new("."), &[]).unwrap();
        run(&document, &RunOptions::new(&path), &mut Quiet).unwrap_or_else(|error| panic!("{error:?}"));
        let result = ResultFile::open(&path).unwrap();
        let within = result.interpolated().unwrap();
        assert!(within[1..within.len() - 1].iter().all(|within| *within), "all of these are within steps");
        result.cell_series("size_x").unwrap()
    };
    // Its steps end nowhere near the frames either, and leave a sixtieth of the error.
    let fine = lengths("4.1 ms");
    let error = |step: &str| {
        let coarse = lengths(step);
        (1..18).map(|frame| (coarse[[frame, 0]] - fine[[frame, 0]]).abs()).fold(0.0, f64::max)
    };
    let [whole, half, quarter] = ["0.1 s", "0.0666666666667 s", "0.0333333333333 s"].map(error);
    let orders = [(whole / half).ln() / 1.5f64.ln(), (half / quarter).log2()];
    println!("errors {whole}, {half}, {quarter} um: orders {orders:?}");
    // Frames lie at other places of steps of other lengths, so that the order is seen through some scatter.
    assert!(orders.iter().all(|order| (1.6..2.4).contains(order)), "{orders:?}");
}

#[test]
fn frames_at_given_times_only() {
    let (_kept, result) = dish("times = [\"1 s\", \"10 s\", \"2.5 s\"]");
    assert_eq!(result.times().unwrap(), [0.0, 1.0, 2.5, 10.0, 12.0]);
}

#[test]
fn walks_that_nothing_stops_and_systems_are_where_they_are_at_that_time() {
    let positions = |step: &str| {
        let text = format!(
            r#"
title = "Free"
seed = 3
[run]
until = "140 s"
integrator = {{ step = "{step}" }}
[cells.walker]
number = 20
mesh = {{ shape = "icosphere", radius = "5 um", level = 0 }}
mechanics = {{ drag = "20 pN s/um", shape_memory = {{ shape_modulus = "10 pN/um" }} }}
motility = {{ brownian = {{ speed = "5 um/min", persistence = "30 s" }} }}
chemistry = ["decay"]
[chemistry.decay]
document = "decay.eml"
[output]
every = "7 s"
"#
        );
        let decay = r#"<eml name="decay" level="cell"><parameter id="k" value="0.05"/><variable id="U" initial="1" rate="-k*U"/>
            <solver scheme="rk45" rtol="1e-10" atol="1e-12"/></eml>"#;
        let equations = BTreeMap::from([("decay.eml".to_owned(), decay.to_owned())]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("free.h5");
        let document = Document::parse_beside("free.toml", &text, Path::new("."), &[], equations).unwrap();
        run(&document, &RunOptions::new(&path), &mut Quiet).unwrap_or_else(|error| panic!("{error:?}"));
        let result = ResultFile::open(&path).unwrap();
        let series = ["position_x", "position_y", "decay.U"].map(|name| result.cell_series(name).unwrap());
        (series, result.interpolated().unwrap(), result.times().unwrap())
    };
    let (ends, none, _) = positions("7 s");
    assert!(none.iter().all(|within| !within));
    let (within, some, times) = positions("20 s");
    assert!(some[1..20].iter().all(|within| *within), "{some:?}");
    for (one, other) in ends[..2].iter().zip(&within[..2]) {
        one.iter().zip(other).for_each(|(one, other)| assert!((one - other).abs() < 1e-9, "{one} {other}"));
    }
    for (frame, time) in times.iter().enumerate() {
        let exact = (-0.05 * time).exp();
        within[2].row(frame).iter().for_each(|found| assert!((found - exact).abs() < 1e-8, "{found} {exact}"));
    }
}

#[test]
fn what_a_system_is_told_within_a_step_is_what_it_was_told_in_the_step() {
    let own = r#"<eml name="own" level="cell"><input id="t" default="0"/><variable id="U" initial="0" rate="t"/>
        <link from="scene.time" to="system.t"/></eml>"#;
    let text = r#"
title = "Told"
[run]
until = "10 s"
integrator = { step = "2 s" }
[cells.still]
mesh = { shape = "icosphere", radius = "5 um", level = 0 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
chemistry = ["own"]
[chemistry.own]
document = "own.eml"
[output]
times = ["7.999999 s", "9.999999 s"]
"#;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("told.h5");
    let equations = BTreeMap::from([("own.eml".to_owned(), own.to_owned())]);
    let document = Document::parse_beside("told.toml", text, Path::new("."), &[], equations).unwrap();
    run(&document, &RunOptions::new(&path), &mut Quiet).unwrap_or_else(|error| panic!("{error:?}"));
    let result = ResultFile::open(&path).unwrap();
    assert_eq!(result.interpolated().unwrap(), [false, true, true, false]);
    let found: Vec<f64> = result.cell_series("own.U").unwrap().iter().copied().collect();
    // t²/2, as far as a microsecond before the end of a step may be off; told what was at the begin of the steps it would be 30 and 48.
    for (found, exact) in found.iter().zip([0.0, 32.0, 50.0, 50.0]) {
        assert!((found - exact).abs() < 2e-5, "{found} for {exact}");
    }
}
