//! A folder for the files of a fuzzer: in `TMPDIR`, which `fuzz/run` sets to a place in memory where the system has one.

use std::path::PathBuf;
use std::sync::LazyLock;

/// The folder of this fuzzer: files in it are written anew for each input.
pub static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("pseudopod-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for files can be made");
    folder
});

/// Writes a file into the folder.
pub fn write(name: &str, bytes: &[u8]) -> PathBuf {
    let path = FOLDER.join(name);
    std::fs::write(&path, bytes).expect("a file can be written");
    path
}
