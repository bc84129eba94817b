//! The library that is put before the system's, compiled where it is needed.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Compiles the library into a folder.
pub fn shim(folder: &Path) -> PathBuf {
    let (source, library) = ("tests/support/stop_shim.rs", folder.join("libstop.so"));
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let arguments = ["--edition", "2024", "--crate-type", "cdylib", "-C", "panic=abort", "-C", "opt-level=1", "-o"];
    let made = Command::new(rustc)
        .args(arguments)
        .arg(&library)
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join(source))
        .status();
    assert!(made.expect("rustc starts").success(), "{source} must compile");
    library
}
