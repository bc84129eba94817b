//! The files of a small run, which are damaged: a result, its log with frames that are not in it yet, a checkpoint.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use pseudopod::experiment::Document;
use pseudopod::output::{checkpoint_path, frames_path};
use pseudopod::run::{Quiet, Report, RunOptions, run};

use crate::apart::{Ended, apart};
use crate::folder::FOLDER;

/// The run: two cells that touch, stick, crawl and stand on a plane, with equations, a field and a load; one of them vanishes.
const DOCUMENT: &str = include_str!("../base.toml");
const CLOCK: &str = r#"<eml name="clock" level="cell"><input id="c" default="0"/><variable id="u" initial="1" rate="c - 0.5*u"/>
    <link from="field[c]" to="system.c"/><link from="system.u" to="cell.secretion[c]"/></eml>"#;
const FIELD: &str = r#"<eml name="field"><grid dimension="2" spacing="1" origin="-4 -4" size="8 8"/>
    <field id="c" diffusion="30" decay="0.1" initial="2 + 0.02*x"/></eml>"#;

/// What a run has written.
pub struct Files {
    /// The result as it is in the middle of the run.
    pub running: Vec<u8>,
    /// The log of frames beside it.
    pub log: Vec<u8>,
    /// The checkpoint beside it.
    pub checkpoint: Vec<u8>,
    /// The result when the run has ended.
    pub finished: Vec<u8>,
}

/// The files of the run. It is made in a process apart, because threads and HDF5's memory would not come along into others.
pub static BASE: LazyLock<Files> = LazyLock::new(|| {
    for (name, text) in [("base.toml", DOCUMENT), ("clock.eml", CLOCK), ("field.eml", FIELD)] {
        crate::folder::write(name, text.as_bytes());
    }
    let result = FOLDER.join("base.h5");
    assert_eq!(apart(|| make(&result)), Ended::Well, "the run is made");
    let read = |path: PathBuf| std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let aside = FOLDER.join("aside.h5");
    Files {
        running: read(aside.clone()),
        log: read(frames_path(&aside)),
        checkpoint: read(checkpoint_path(&aside)),
        finished: read(result),
    }
});

fn make(result: &Path) {
    let document = Document::read(&FOLDER.join("base.toml"), &[]).expect("the document is good");
    let mut aside = Aside { result: result.to_path_buf(), aside: FOLDER.join("aside.h5") };
    run(&document, &RunOptions { threads: Some(1), ..RunOptions::new(result) }, &mut aside).expect("it runs");
}

/// Puts the files aside as they are before the last step.
struct Aside {
    result: PathBuf,
    aside: PathBuf,
}

impl Report for Aside {
    fn notice(&mut self, _: &str) {}

    fn begin(&mut self, time: f64, until: f64) {
        Quiet.begin(time, until);
    }

    fn step(&mut self, _: f64, _: u64) {
        let log_size = |result: &Path| std::fs::metadata(frames_path(result)).map_or(0, |known| known.len());
        // The log is emptied now and then: the fullest one is kept.
        if log_size(&self.result) < log_size(&self.aside) || !checkpoint_path(&self.result).exists() {
            return;
        }
        for path in [Path::to_path_buf, frames_path, checkpoint_path] {
            let _ = std::fs::copy(path(&self.result), path(&self.aside));
        }
    }

    fn end(&mut self) {}
}
