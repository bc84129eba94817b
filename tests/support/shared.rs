//! Data that are not part of the repository: the folder `shared/data` beside it, which a user's clone does not have.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A file or folder of the shared data. Where it is not there, the test that asks for it is noted as skipped: on its output and, since
/// the output of tests that pass is not shown, in the file that `PSEUDOPOD_SKIPPED` names.
pub fn shared(path: &str) -> Option<PathBuf> {
    let found = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(path);
    if found.exists() {
        return Some(found);
    }
    let line = format!("SKIPPED: needs ../shared/data/{path}");
    println!("{line}");
    if let Some(list) = std::env::var_os("PSEUDOPOD_SKIPPED") {
        let file = std::fs::OpenOptions::new().append(true).create(true).open(list);
        file.and_then(|mut file| writeln!(file, "{line}")).expect("the list of skipped tests");
    }
    None
}
