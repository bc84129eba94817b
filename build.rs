//! Notes the commit that the program is built from, so that every result file can name it. Who builds without git, or does
//! not want to compile anew after each commit, names it in the variable PSEUDOPOD_COMMIT.

use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
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
