//! Checkpoints: read, and gone on from for one step, as `pseudopod resume` does. The result beside them is whole.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pseudopod::output::{checkpoint_path, frames_path};
use pseudopod::run::{Report, resume};
use pseudopod::simulation::CancelToken;
use pseudopod_fuzz::base::BASE;
use pseudopod_fuzz::commands::told;
use pseudopod_fuzz::folder::{FOLDER, write};
use pseudopod_fuzz::{edits, one_thread, sums};

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

fuzz_target!(init: { one_thread(); let _ = &*BASE; }, |data: &[u8]| {
    let result = FOLDER.join("run.h5");
    write("run.h5", &BASE.running);
    std::fs::write(frames_path(&result), &BASE.log).expect("a file can be written");
    let checkpoint = sums::checkpoint(&BASE.checkpoint, &edits::read(data));
    std::fs::write(checkpoint_path(&result), checkpoint).expect("a file can be written");
    let cancel = CancelToken::new();
    if let Err(error) = resume(&result, None, &cancel.clone(), &mut OneStep(cancel)) {
        told(&error);
    }
});
