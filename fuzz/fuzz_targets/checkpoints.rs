//! Checkpoints: read, and gone on from for one step. Where only the state is edited this is done in memory; where the description is, too,
//! as `pseudopod resume` does, with a whole result beside it.
#![no_main]

use std::cell::RefCell;
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use pseudopod::output::{Header, checkpoint_path, frames_path, load_checkpoint};
use pseudopod::run::{Report, ResumeOptions, document_of, resume};
use pseudopod::simulation::{CancelToken, Simulation};
use pseudopod_fuzz::base::BASE;
use pseudopod_fuzz::commands::told;
use pseudopod_fuzz::folder::{FOLDER, write};
use pseudopod_fuzz::{edits, one_thread, sums};

thread_local! {
    /// The simulation of the run: to compile it takes longer than all else.
    static SIMULATION: RefCell<Option<Simulation>> = const { RefCell::new(None) };
}

/// Stops after a step.
struct OneStep(CancelToken);

impl Report for OneStep {
    fn notice(&mut self, _: &str) {}
    fn begin(&mut self, _: f64, _: f64) {}
    fn step(&mut self, _: f64, _: u64) {
        self.0.cancel();
    }
    fn end(&mut self) {}
}

/// Reads the checkpoint beside a result and makes a step.
fn go_on(result: &Path) {
    let checkpoint = match load_checkpoint(result) {
        Ok(checkpoint) => checkpoint.expect("it is there"),
        Err(error) => return told(&error),
    };
    SIMULATION.with_borrow_mut(|known| {
        let simulation = known.get_or_insert_with(|| compiled(&checkpoint.meta.header, result));
        match simulation.restore(&checkpoint.payload).and_then(|()| simulation.step().map(drop)) {
            Ok(()) => {}
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    });
}

fn compiled(header: &Header, result: &Path) -> Simulation {
    let document = document_of(header, result).expect("the description is whole");
    Simulation::from_document(&document).expect("the document is good")
}

fuzz_target!(init: { one_thread(); let _ = &*BASE; }, |data: &[u8]| {
    let (result, edits) = (FOLDER.join("run.h5"), edits::read(data));
    let checkpoint = sums::checkpoint(&BASE.checkpoint, &edits);
    std::fs::write(checkpoint_path(&result), checkpoint).expect("a file can be written");
    if edits.iter().all(|edit| sums::is_of_state(*edit)) {
        return go_on(&result);
    }
    write("run.h5", &BASE.running);
    std::fs::write(frames_path(&result), &BASE.log).expect("a file can be written");
    let options = ResumeOptions::default();
    if let Err(error) = resume(&result, &options, &mut OneStep(options.cancel.clone())) {
        told(&error);
    }
});
