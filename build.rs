//! Notes the commit that the program is built from, so that every result file can name it. Who builds without git, or does
//! not want to compile anew after each commit, names it in the variable PSEUDOPOD_COMMIT.
//!
//! Lists the files of the experiments that ship, which the program carries for `pseudopod demo`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Endings of what runs read: documents and claims, equations, tables, meshes and bodies. A document that names a file of
/// another ending does not pass the check once it is copied, which the tests of what ships hold.
const SHIPPED: [&str; 5] = ["toml", "eml", "csv", "obj", "pml"];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    list_experiments();
    note_commit();
}

/// Writes `experiments.rs`: pairs of a path below `experiments` and the bytes of the file, in order.
fn list_experiments() {
    println!("cargo:rerun-if-changed=experiments");
    let variable = |name: &str| PathBuf::from(std::env::var_os(name).unwrap_or_else(|| panic!("cargo sets {name}")));
    let root = variable("CARGO_MANIFEST_DIR").join("experiments");
    let mut files = Vec::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("a folder of experiments");
        let paths = entries.map(|entry| entry.expect("an entry that can be read").path());
        let (more, plain): (Vec<PathBuf>, Vec<PathBuf>) = paths.partition(|path| path.is_dir());
        folders.extend(more);
        let ending = |path: &Path| path.extension().and_then(|ending| ending.to_str()).map(str::to_owned);
        files.extend(plain.into_iter().filter(|path| ending(path).is_some_and(|end| SHIPPED.contains(&end.as_str()))));
    }
    files.sort();
    let mut code = String::from("&[\n");
    for path in &files {
        let below = path.strip_prefix(&root).expect("a file below").to_string_lossy().replace('\\', "/");
        // Writing to a text cannot fail.
        let _ = writeln!(code, "    ({below:?}, include_bytes!({:?})),", path.display().to_string());
    }
    code.push_str("]\n");
    std::fs::write(variable("OUT_DIR").join("experiments.rs"), code).expect("the list of experiments can be written");
}

fn note_commit() {
    println!("cargo:rerun-if-env-changed=PSEUDOPOD_COMMIT");
    if let Ok(named) = std::env::var("PSEUDOPOD_COMMIT") {
        println!("cargo:rustc-env=PSEUDOPOD_COMMIT={named}");
        return;
    }
    for name in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["rev-parse", "--git-path", name])
            && std::path::Path::new(&path).exists()
        {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    println!("cargo:rustc-env=PSEUDOPOD_COMMIT={}", commit().unwrap_or_else(|| "unknown".into()));
}

/// The short name of the commit, unless this is not a checkout of the project itself (a published crate unpacked
/// inside somebody else's repository must not carry that repository's commit).
fn commit() -> Option<String> {
    let prefix = git(&["rev-parse", "--show-prefix"])?;
    prefix.is_empty().then(|| git(&["rev-parse", "--short=12", "HEAD"])).flatten()
}

/// What git answers, `None` without git or without a repository.
fn git(arguments: &[&str]) -> Option<String> {
    let answer = Command::new("git").args(arguments).output().ok()?;
    answer.status.success().then(|| String::from_utf8_lossy(&answer.stdout).trim().to_string())
}
