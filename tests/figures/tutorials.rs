//! What a tutorial tells its reader to do can be done, prints what the page says, and makes the pictures that it shows.
//!
//! A page is read from top to bottom. A document goes into the file that the text before it names last (`experiment.toml`
//! when none); tables without `[run]` are added to an experiment that is there. Commands run in that folder, and each line of
//! a block of text is one of the lines that the commands before it print. A picture of `docs/pictures/tutorials` is the file of
//! the same path in the folder. Blocks with a command whose comment tells of minutes run in the slow test.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A block of a page, with the text between it and the block before.
struct Block<'a> {
    before: &'a str,
    language: &'a str,
    body: &'a str,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let parts: Vec<&str> = page.split("```").collect();
    let pairs =
        parts.chunks_exact(2).map(|pair| (pair[0], pair[1].split_once('\n').expect("a block has a first line")));
    pairs.map(|(before, (language, body))| Block { before, language, body }).collect()
}

/// The file that a block is to be put into: the last one that the text before it names.
fn named<'a>(block: &Block<'a>) -> &'a str {
    let endings = [".toml", ".eml", ".csv"];
    let names = block.before.split('`').skip(1).step_by(2);
    let files = names.filter(|name| endings.iter().any(|end| name.ends_with(end)) && !name.contains([' ', '/']));
    files.last().unwrap_or("experiment.toml")
}

/// Adds the tables of a text to a document: what it has is kept or replaced, lists of tables become longer.
fn add(document: &mut toml::Table, other: toml::Table) {
    for (key, value) in other {
        match (document.get_mut(&key), value) {
            (Some(toml::Value::Table(there)), toml::Value::Table(more)) => add(there, more),
            (Some(toml::Value::Array(there)), toml::Value::Array(more)) if more.iter().all(toml::Value::is_table) => {
                there.extend(more);
            }
            (_, value) => {
                document.insert(key, value);
            }
        }
    }
}

fn write(folder: &Path, block: &Block<'_>) {
    let file = folder.join(named(block));
    let begins = block.body.contains("[run]") || block.body.contains("experiment = ") || block.language != "toml";
    if begins || !file.exists() {
        return std::fs::write(file, block.body).unwrap();
    }
    let mut document: toml::Table = std::fs::read_to_string(&file).unwrap().parse().unwrap();
    add(&mut document, block.body.parse().unwrap());
    std::fs::write(file, document.to_string()).unwrap();
}

/// What the commands of a block print, standard output and error.
fn run(folder: &Path, commands: &str) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_pseudopod")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let mut said = String::new();
    for line in commands.lines() {
        let out = Command::new("sh").args(["-c", line]).current_dir(folder).env("PATH", &path).output().unwrap();
        let text = [out.stdout, out.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
        assert!(out.status.success(), "{line}\n{text}");
        said.push_str(&text);
    }
    said
}

/// Whether two lines are the same, their numbers within a thousandth: other processors may round last digits otherwise.
fn alike(one: &str, other: &str) -> bool {
    let (one, other): (Vec<&str>, Vec<&str>) = (one.split_whitespace().collect(), other.split_whitespace().collect());
    let same = |(one, other): (&&str, &&str)| match (one.parse::<f64>(), other.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 1e-3 * a.abs(),
        _ => one == other,
    };
    one.len() == other.len() && one.iter().zip(&other).all(same)
}

/// Follows a tutorial in a folder of its own.
fn follow(name: &str, slow: bool) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/src").join(name)).unwrap();
    let scratch = tempfile::tempdir().unwrap();
    let (mut said, mut skipped, mut lines, mut pictures) = (String::new(), false, 0, 0);
    for block in blocks(&page) {
        match block.language {
            "toml" | "xml" | "csv" => write(scratch.path(), &block),
            "sh" => {
                skipped =
                    !slow && block.body.lines().any(|line| line.split(" #").skip(1).any(|c| c.contains("minute")));
                said = if skipped { String::new() } else { run(scratch.path(), block.body) };
            }
            "text" if !skipped => {
                for line in block.body.lines() {
                    assert!(
                        said.lines().any(|found| alike(line, found)),
                        "{name} says\n{line}\nand printed was\n{said}"
                    );
                    lines += 1;
                }
            }
            _ => {}
        }
    }
    for shown in page.split("](../pictures/tutorials/").skip(1).filter_map(|rest| rest.split(')').next()) {
        let made: PathBuf = scratch.path().join(shown);
        if slow || made.exists() {
            let kept = root.join("docs/pictures/tutorials").join(shown);
            if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
                std::fs::copy(&made, &kept).unwrap();
            }
            let apart = super::experiments::mean_difference(&made, &kept);
            assert!(apart < 0.5, "{name}: {shown} is not what the commands make: levels {apart:.2} apart");
            pictures += 1;
        }
    }
    assert!(lines > 1 && pictures > 1, "{name}: {lines} lines and {pictures} pictures were compared");
}

#[test]
fn a_red_cell_is_pulled_and_its_modulus_read() {
    follow("tutorial_red_cell.md", false);
}

#[test]
fn cells_wander_and_follow_a_gradient() {
    follow("tutorial_migration.md", false);
}

#[test]
fn a_study_is_planned_run_and_collected() {
    follow("tutorial_study.md", false);
}

#[test]
#[ignore = "slow: half a minute, eight runs of a packed tissue"]
fn a_tissue_is_pressed_grows_and_is_thinned() {
    follow("tutorial_tissue.md", true);
}

#[test]
#[ignore = "slow: a minute, seven runs of two types that sort"]
fn two_types_sort() {
    follow("tutorial_sorting.md", true);
}

#[test]
#[ignore = "slow: five minutes, 468 runs of half a second"]
fn all_studies_of_the_tutorial_are_run() {
    follow("tutorial_study.md", true);
}
