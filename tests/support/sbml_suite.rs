//! Models of SBML with known results, and the rule by which the SBML test suite compares.
#![allow(dead_code)]

use pseudopod::equations::sbml::{self, Model};
use pseudopod::error::{Error, Source};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::shared::shared;

pub fn folders(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.is_dir()).collect();
    found.sort();
    found
}

pub fn load(path: &Path) -> Result<Model, Error> {
    let text = std::fs::read_to_string(path).expect("a model");
    sbml::read(&Arc::new(Source { name: path.display().to_string(), text }))
}

/// The names and the rows of a table.
pub fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(path).expect("a table");
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let names = lines.next().expect("a head").split(',').map(|name| name.trim().trim_matches('"').to_owned()).collect();
    let number = |text: &str| match text.trim() {
        "INF" => f64::INFINITY,
        "-INF" => f64::NEG_INFINITY,
        text => text.parse().unwrap_or(f64::NAN),
    };
    (names, lines.map(|line| line.split(',').map(number).collect()).collect())
}

/// One setting of a case of the suite.
fn setting<'t>(text: &'t str, name: &str) -> &'t str {
    text.lines().find_map(|line| line.strip_prefix(name)?.trim_start().strip_prefix(':')).unwrap_or_default().trim()
}

/// A case of the suite that is to be solved.
pub struct Case {
    /// The file of the model.
    pub file: PathBuf,
    /// The model.
    pub model: Model,
    /// When values are asked for.
    pub times: Vec<f64>,
    /// The absolute error that the suite allows.
    pub absolute: f64,
}

/// The values of all quantities at the times of a case, or why there are none.
pub type Solved = Result<Vec<Vec<f64>>, String>;

/// Nothing when a model of a case agrees with its results, or else why not.
fn case(folder: &Path, file: &Path, solve: &dyn Fn(&Case) -> Solved) -> Result<(), String> {
    let name = folder.file_name().expect("a number").to_string_lossy().into_owned();
    let settings = std::fs::read_to_string(folder.join(format!("{name}-settings.txt"))).expect("settings");
    let (names, rows) = table(&folder.join(format!("{name}-results.csv")));
    let model = load(file).map_err(|error| error.to_string())?;
    let amounts: Vec<&str> = setting(&settings, "amount").split(',').map(str::trim).collect();
    let columns = names[1..].iter().map(|name| {
        let is_species = model.species.iter().any(|species| species.id == *name);
        let column = if is_species && !amounts.contains(&name.as_str()) { format!("[{name}]") } else { name.clone() };
        model.column(&column).ok_or(format!("there is no `{column}`"))
    });
    let columns: Vec<u32> = columns.collect::<Result<_, _>>()?;
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let tolerance = |name: &str| setting(&settings, name).parse::<f64>().expect("a number");
    let (absolute, relative) = (tolerance("absolute"), tolerance("relative"));
    let solved = solve(&Case { file: file.to_owned(), model, times, absolute })?;
    for (row, values) in rows.iter().zip(&solved) {
        for (index, column) in columns.iter().enumerate() {
            let (expected, got) = (row[index + 1], values[*column as usize]);
            let same = expected == got || (expected.is_nan() && got.is_nan());
            let near = (expected - got).abs() <= absolute + relative * expected.abs();
            if !same && !near {
                return Err(format!("{} at {}: {got} instead of {expected}", names[index + 1], row[0]));
            }
        }
    }
    Ok(())
}

/// All cases of a part of the suite, in both levels, solved in some way, agree with their results by the suite's rule.
pub fn suite(part: &str, count: usize, solve: &dyn Fn(&Case) -> Solved) {
    let Some(folder) = shared(&format!("sbml-suite/{part}")) else { return };
    let mut bad = Vec::new();
    let cases = folders(&folder);
    assert_eq!(cases.len(), count);
    for case_folder in cases {
        let files = std::fs::read_dir(&case_folder).expect("a case").map(|entry| entry.expect("a file").path());
        let models: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end == "xml")).collect();
        assert!(!models.is_empty());
        for file in models {
            if let Err(why) = case(&case_folder, &file, solve) {
                bad.push(format!("{}: {why}", file.file_name().expect("a name").to_string_lossy()));
            }
        }
    }
    assert!(bad.is_empty(), "{} cases differ:\n{}", bad.len(), bad.join("\n"));
}

/// How many files of a folder of cases agree with their results when they are solved in one way, and which of these do not in another,
/// with the reasons. Of each case the file of the newest level is taken.
pub fn all_cases(
    folder: &Path,
    first: &dyn Fn(&Case) -> Solved,
    second: &dyn Fn(&Case) -> Solved,
) -> (usize, Vec<String>) {
    let (mut agree, mut bad) = (0, Vec::new());
    for case_folder in folders(folder) {
        let name = case_folder.file_name().expect("a number").to_string_lossy().into_owned();
        let levels = ["l3v2", "l3v1", "l2v5", "l2v4", "l2v3", "l2v2", "l2v1"];
        let files = levels.map(|level| case_folder.join(format!("{name}-sbml-{level}.xml")));
        let Some(file) = files.iter().find(|file| file.exists()) else { continue };
        // Cases without times are not of this kind.
        let settings = std::fs::read_to_string(case_folder.join(format!("{name}-settings.txt"))).expect("settings");
        if setting(&settings, "duration").is_empty() {
            continue;
        }
        if let Err(why) = case(&case_folder, file, first) {
            println!("{name} in the first of two: {}", why.lines().next().unwrap_or_default());
            continue;
        }
        agree += 1;
        if let Err(why) = case(&case_folder, file, second) {
            println!("{name}: {why}");
            bad.push(format!("{name}: {why}"));
        }
    }
    (agree, bad)
}
