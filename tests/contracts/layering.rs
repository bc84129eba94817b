//! The layers of the code, held by what each module imports. The table is that of docs/architecture.md.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module and the modules that it may use. Every module may use itself and those that see nothing else: `error`, `units`, `files`,
/// `elementary`, `random`, `recorded`, and the crate's own `Vec3`.
const TABLE: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("units", &[]),
    ("files", &[]),
    ("elementary", &[]),
    ("random", &["elementary"]),
    ("recorded", &[]),
    ("values", &[]),
    ("xml", &[]),
    ("geometry", &[]),
    ("physical_model", &["xml", "geometry"]),
    ("mechanics", &["geometry"]),
    ("equations", &["xml"]),
    ("ode", &["equations"]),
    ("field", &["equations", "ode"]),
    ("membrane", &["equations", "ode", "geometry"]),
    ("contact", &["geometry"]),
    ("cell", &["mechanics", "equations", "ode", "field", "geometry"]),
    ("sim", &["cell", "mechanics", "equations", "ode", "field", "membrane", "contact", "geometry"]),
    // The result file knows no simulator: it is given frames.
    ("output", &[]),
    // Numbers come from a finished file; what documents say of a measure stands beside how it is computed.
    ("analysis", &["values", "output", "cell", "contact", "geometry"]),
    (
        "experiment",
        &[
            "values",
            "analysis",
            "sim",
            "cell",
            "physical_model",
            "mechanics",
            "equations",
            "ode",
            "field",
            "membrane",
            "contact",
            "geometry",
        ],
    ),
    ("picture", &["xml", "output", "experiment", "analysis", "cell", "geometry", "run"]),
    // The door for programs: it records frames, and writes none.
    ("simulation", &["experiment", "sim", "output", "cell", "mechanics", "equations", "contact", "geometry"]),
    ("run", &["simulation", "experiment", "sim", "output", "analysis"]),
    // Claims are held against the measures of a run.
    ("verify", &["run", "experiment", "output", "analysis"]),
    // Studies make runs, and charts of what these measured.
    ("study", &["picture", "run", "simulation", "experiment", "output", "analysis"]),
    // The page asks for what pictures know.
    ("view", &["picture", "run", "simulation", "experiment", "output", "analysis"]),
    (
        "cli",
        &[
            "view",
            "study",
            "verify",
            "run",
            "simulation",
            "experiment",
            "equations",
            "ode",
            "field",
            "sim",
            "output",
            "analysis",
            "picture",
            "physical_model",
            "geometry",
        ],
    ),
];

/// What every module may use.
const GROUND: [&str; 6] = ["error", "units", "files", "elementary", "random", "recorded"];

/// Modules that must not touch files or clocks, and the words that would show it.
const PURE: [&str; 8] = ["geometry", "mechanics", "contact", "cell", "sim", "units", "elementary", "random"];
const WORLD: [&str; 4] = ["std::fs", "std::time", "hdf5", "std::env"];
/// The two pages of geometry that are about files.
const FILES_OF_GEOMETRY: [&str; 2] = ["geometry/import", "geometry/export"];

fn sources() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("src can be read") {
            let path = entry.expect("an entry that can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The path of a file below src, with `/` everywhere.
fn name(path: &Path) -> String {
    let below = path.strip_prefix(Path::new(env!("CARGO_MANIFEST_DIR")).join("src")).expect("a file of src");
    below.to_string_lossy().replace('\\', "/")
}

/// The module of a file: the first part of its path.
fn module(name: &str) -> &str {
    name.split('/').next().unwrap_or_default().trim_end_matches(".rs")
}

/// The code of a file: without comments, and without the tests at its end, which may use what they like.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a source can be read");
    let body = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    body.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// The modules that a code names by `crate::module` or `crate::{module, …}`.
fn used(code: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String { text.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect() };
    let mut modules = BTreeSet::new();
    for rest in code.split("crate::").skip(1) {
        match rest.strip_prefix('{') {
            None => {
                modules.insert(word(rest));
            }
            Some(list) => {
                // Names at the first level of the braces.
                let (mut depth, mut fresh) = (0, true);
                for (at, sign) in list.char_indices() {
                    match sign {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        ',' if depth == 0 => fresh = true,
                        _ if fresh && depth == 0 && !sign.is_whitespace() => {
                            modules.insert(word(&list[at..]));
                            fresh = false;
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    modules
}

#[test]
fn imports_are_found_in_all_their_forms() {
    let code = "use crate::sim::{Model, State};\nuse crate::{cell::Walk, Vec3, run::{a, b}};\nlet x = crate::units::X;";
    let wanted: BTreeSet<String> = ["sim", "cell", "Vec3", "run", "units"].map(String::from).into();
    assert_eq!(used(code), wanted);
}

#[test]
fn every_module_uses_only_what_stands_below_it() {
    let table: BTreeMap<&str, &[&str]> = TABLE.iter().copied().collect();
    let mut faults = Vec::new();
    for path in sources() {
        let name = name(&path);
        let own = module(&name);
        if ["main", "lib"].contains(&own) {
            continue;
        }
        let Some(allowed) = table.get(own) else {
            faults.push(format!("src/{name}: the module `{own}` is not in the table of this test"));
            continue;
        };
        for other in used(&code(&path)).iter().filter(|other| table.contains_key(other.as_str()) && *other != own) {
            if !allowed.contains(&other.as_str()) && !GROUND.contains(&other.as_str()) {
                faults.push(format!("src/{name}: `{own}` must not use `{other}`"));
            }
        }
    }
    assert!(faults.is_empty(), "see docs/architecture.md:\n{}", faults.join("\n"));
}

#[test]
fn the_ground_sees_nothing_else() {
    for path in sources() {
        let name = name(&path);
        let own = module(&name);
        if GROUND.contains(&own) {
            let others: Vec<String> = used(&code(&path)).into_iter().filter(|other| other != own).collect();
            let lowest = ["Vec3", "error", "elementary"];
            assert!(others.iter().all(|other| lowest.contains(&other.as_str())), "src/{name} uses {others:?}");
        }
    }
}

#[test]
fn the_simulator_knows_no_files_formats_or_clocks() {
    for path in sources() {
        let name = name(&path);
        if PURE.contains(&module(&name)) && !FILES_OF_GEOMETRY.iter().any(|file| name.starts_with(file)) {
            let code = code(&path);
            for word in WORLD {
                assert!(!code.contains(word), "src/{name} uses {word}");
            }
        }
    }
}

#[test]
fn the_table_has_no_circle_but_the_pictures_that_a_run_makes() {
    let order: Vec<&str> = TABLE.iter().map(|(module, _)| *module).collect();
    let position = |module: &str| order.iter().position(|other| *other == module).expect("a module of the table");
    for (module, allowed) in TABLE {
        for other in *allowed {
            let exception = *module == "picture" && *other == "run";
            assert!(exception || position(other) < position(module), "{module} uses {other}, which stands above it");
        }
    }
}
