//! How long it takes to read documents of equations and to compile them: `cargo bench --bench chemistry_document`.
//!
//! Prints milliseconds for each document of `eml/` and, where `../shared/data/biomodels` is there, each model of it:
//! the median of some readings, and the size of the system.

use pseudopod::equations::program::Program;
use pseudopod::equations::{self, Read};
use pseudopod::error::Source;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Readings of each document.
const READINGS: usize = 15;

/// The files below a folder that end in one way, in order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    let mut found = Vec::new();
    for path in entries {
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.extension().is_some_and(|end| end == ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut documents = files(&root.join("eml"), "eml");
    documents.extend(files(&root.join("../shared/data/biomodels"), "xml"));
    println!("{:28} {:>9} {:>10} {:>9} {:>11}", "document", "read (ms)", "and compile", "variables", "quantities");
    let mut slowest: (f64, String) = (0.0, String::new());
    for path in documents {
        let (mut reads, mut wholes, mut size) = (Vec::new(), Vec::new(), (0, 0));
        for _ in 0..READINGS {
            let start = Instant::now();
            let text = std::fs::read_to_string(&path).expect("a text");
            let source = Source { name: path.display().to_string(), text };
            let Read { document, .. } = equations::read(Arc::new(source)).expect("a good document");
            reads.push(start.elapsed().as_secs_f64() * 1e3);
            let program = Program::new(&document.system).expect("no circle");
            wholes.push(start.elapsed().as_secs_f64() * 1e3);
            size = (program.size(), document.system.quantities.len());
        }
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let (read, whole) = (median(reads), median(wholes));
        println!("{name:28} {read:9.3} {whole:11.3} {:9} {:11}", size.0, size.1);
        if whole > slowest.0 {
            slowest = (whole, name);
        }
    }
    println!("slowest: {} with {:.3} ms", slowest.1, slowest.0);
}
