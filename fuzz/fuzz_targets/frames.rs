//! The log of frames beside a result: taken into it when it is opened, and what is in it then is read.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pseudopod::output::frames_path;
use pseudopod_fuzz::base::BASE;
use pseudopod_fuzz::commands::command;
use pseudopod_fuzz::folder::{FOLDER, write};
use pseudopod_fuzz::{edits, one_thread, sums};

fuzz_target!(init: { one_thread(); let _ = &*BASE; }, |data: &[u8]| {
    let result = FOLDER.join("run.h5");
    write("run.h5", &BASE.running);
    std::fs::write(frames_path(&result), sums::log(&BASE.log, &edits::read(data))).expect("a file can be written");
    command(&format!("pseudopod export {} -o {} --force", result.display(), FOLDER.join("x.csv").display()));
});
