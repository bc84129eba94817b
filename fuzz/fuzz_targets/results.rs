//! Results: everything in them is read, as `info`, `export`, `measure`, `plot` and `render` do. Most edits are made by HDF5, so that the
//! file says what no run has written; some are made to its bytes, in which HDF5 itself may crash.
#![no_main]

use std::sync::atomic::{AtomicUsize, Ordering};

use libfuzzer_sys::fuzz_target;
use pseudopod_fuzz::apart::{Ended, apart, share_counters};
use pseudopod_fuzz::base::BASE;
use pseudopod_fuzz::commands::command;
use pseudopod_fuzz::edits::Edit;
use pseudopod_fuzz::folder::{FOLDER, write};
use pseudopod_fuzz::{container, edits, one_thread};

/// What reads a result; `{}` is its path.
const COMMANDS: [&str; 14] = [
    "pseudopod info --json {}",
    "pseudopod export {} --force -o {}.csv",
    "pseudopod export {} --force -o {}.csv --table tracks",
    "pseudopod export {} --force -o {}.csv --table runs",
    "pseudopod export {} --force -o {}.csv --table contacts",
    "pseudopod export {} --force -o {}.csv --table aggregates",
    "pseudopod export {} --force -o {}.csv --table summary",
    "pseudopod export {} --force -o {}.obj --time first",
    "pseudopod export {} --force -o {}.vti",
    "pseudopod export {} --force -o {}.csv --field field",
    "pseudopod measure {} --json",
    "pseudopod plot {} --force",
    "pseudopod plot {} --force --kymograph field",
    "pseudopod render {} --force --loads --width 64 --height 48 --colour-by traction",
];

/// How often HDF5 has crashed.
static CRASHES: AtomicUsize = AtomicUsize::new(0);

/// Writes the result, edited: the first edit says whether it is the finished one.
fn damage(edits: &[Edit]) -> std::path::PathBuf {
    let base = if edits.first().is_some_and(|edit| edit.at % 4 == 0) { &BASE.running } else { &BASE.finished };
    let path = write("run.h5", base);
    let (of_content, raw): (Vec<&Edit>, Vec<&Edit>) = edits.iter().partition(|edit| edit.kind < 224);
    if let (false, Ok(file)) = (of_content.is_empty(), hdf5::File::open_rw(&path)) {
        // What HDF5 refuses to do is not done.
        of_content.iter().for_each(|edit| drop(container::apply(&file, **edit)));
    }
    if !raw.is_empty() {
        let mut bytes = std::fs::read(&path).expect("the file is there");
        raw.iter().for_each(|edit| edit.apply(&mut bytes));
        write("run.h5", &bytes);
    }
    path
}

fuzz_target!(init: { one_thread(); let _ = &*BASE; share_counters(); }, |data: &[u8]| {
    let edits = edits::read(data);
    let ended = apart(|| {
        let path = damage(&edits).display().to_string();
        let which = edits.last().map_or(0, |edit| edit.value as usize);
        command(&COMMANDS[which % COMMANDS.len()].replace("{}", &path));
    });
    if let Ended::Crashed(signal) = ended {
        let crashes = CRASHES.fetch_add(1, Ordering::Relaxed) + 1;
        if crashes.is_power_of_two() {
            eprintln!("HDF5 has crashed {crashes} times, here by signal {signal}; the program would end with exit 2");
        }
    }
    let _ = std::fs::remove_file(FOLDER.join("run.h5.frames"));
});
