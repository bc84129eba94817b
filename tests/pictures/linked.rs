//! Cells that dynamic links join: recorded, drawn and told to the page.

use pseudopod::experiment::{Document, OneOrMany, Picture};
use pseudopod::output::ResultFile;
use pseudopod::picture::from_file::still;
use pseudopod::run::{Quiet, RunOptions, run};
use pseudopod::view::{Answer, Scene};

const TEXT: &str = r#"
title = "linked cells"
[run]
until = "20 s"
integrator = { max_step = "1 s" }
[output]
every = "2 s"
[cells.a]
mesh = { shape = "icosphere", radius = "5 um", level = 0 }
placement = { at = [["-6 um", "0 um", "0 um"], ["6 um", "0 um", "0 um"], ["0 um", "80 um", "0 um"]] }
[cells.a.mechanics]
drag = "20 pN s/um"
shape_memory = { stiffness = "6 pN/um" }
[cells.a.motility]
attraction = { to = ["0 um", "0 um", "0 um"], stiffness = "0.1 pN/um" }
[contact]
model = "links"
[[contact.between]]
types = ["a", "a"]
link = "2 pN/um"
"#;

#[test]
fn cells_that_are_linked_are_recorded_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let document = Document::parse("linked.toml", TEXT, folder.path(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let path = folder.path().join("linked.h5");
    run(&document, &RunOptions::new(&path), &mut Quiet).unwrap();
    let result = ResultFile::open(&path).unwrap();
    let counts = result.scene_series("contact.links").unwrap();
    for (frame, count) in counts.iter().enumerate() {
        let pairs = result.linked(frame).unwrap();
        assert_eq!(f64::from(pairs.iter().map(|pair| pair.number).sum::<u32>()), *count, "frame {frame}");
        assert!(pairs.iter().all(|pair| (pair.cell, pair.other) == (0, 1)), "{pairs:?}");
    }
    assert!(counts[0] == 0.0 && counts[counts.len() - 1] > 0.0, "{counts:?}");
    let picture = |links, marks: Option<&str>| {
        let marks = marks.map(|name| OneOrMany::One(name.to_owned()));
        let mut picture = Picture { links, marks, width: 320, height: 240, ..Picture::default() };
        picture.view.from = [0.0, 0.0, 1.0];
        still(&result, &document, &picture)
    };
    let without = picture(false, None).unwrap();
    assert!(picture(true, None).unwrap() != without);
    assert!(picture(false, Some("a")).unwrap() != without);
    let fault = picture(false, Some("b")).unwrap_err().to_string();
    assert!(fault.contains("no cells are of the type `b`"), "{fault}");
    // The page is told of a line from centre to centre.
    let scene = Scene::open(&path).unwrap();
    let last = counts.len() - 1;
    let Some(Answer::Bytes(bytes)) = scene.answer(&format!("lines/{last}/linked")).unwrap() else { panic!("no lines") };
    assert_eq!(bytes.len(), 4 + 4 * 7, "how many, and seven numbers for each");
}
