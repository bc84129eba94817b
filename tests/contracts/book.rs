//! The book and the code say the same: equation numbers exist on both sides, every page is in the summary, links lead
//! somewhere, and the documents shown to users are right.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The files below a folder with an extension, sorted.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
            let path = entry.expect("an entry that can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn book() -> PathBuf {
    root().join("docs/src")
}

/// Whether a text is an equation number such as `step.3`.
fn is_label(text: &str) -> bool {
    text.split_once('.').is_some_and(|(name, number)| {
        let word = |text: &str, fits: fn(&char) -> bool| !text.is_empty() && text.chars().all(|c| fits(&c));
        word(name, |c| c.is_ascii_lowercase() || *c == '_') && word(number, char::is_ascii_digit)
    })
}

/// What stands in each pair of brackets of a text, innermost ones only.
fn bracketed(text: &str) -> impl Iterator<Item = &str> {
    text.split('(').skip(1).filter_map(|rest| rest.split_once(')').map(|(inside, _)| inside))
}

/// Equation numbers that the code cites, as `eq. (step.3)`, `eq. (step.2) and (step.3)` or `(eq. step.3, step.4)`, each
/// with a file that does. Numbers in brackets count in any comment, so that none escapes by its wording.
fn cited() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for path in files(&root().join("src"), "rs") {
        for line in read(&path).lines().filter(|line| line.contains("//")) {
            for inside in bracketed(line) {
                for label in inside.trim_start_matches("eq. ").split(", ").filter(|label| is_label(label)) {
                    found.insert(label.to_owned(), path.display().to_string());
                }
            }
        }
    }
    found
}

/// Equation numbers that the book gives, each with its page.
fn given() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for path in files(&book(), "md") {
        for rest in read(&path).split("\\tag{").skip(1) {
            let label = rest.split('}').next().unwrap_or_default().to_owned();
            assert!(is_label(&label), "{}: \\tag{{{label}}} is no number such as step.3", path.display());
            let before = found.insert(label.clone(), path.display().to_string());
            assert_eq!(before, None, "{}: the number ({label}) is given twice", path.display());
        }
    }
    found
}

#[test]
fn every_equation_that_the_code_cites_is_in_the_book() {
    let (cited, given) = (cited(), given());
    assert!(cited.len() > 20, "only {} citations were found; has the way of citing changed?", cited.len());
    let missing: Vec<_> = cited.iter().filter(|(label, _)| !given.contains_key(*label)).collect();
    assert!(missing.is_empty(), "cited but not in docs/src: {missing:#?}");
}

#[test]
fn every_numbered_equation_of_the_book_is_cited_by_the_code() {
    let (cited, given) = (cited(), given());
    let idle: Vec<_> = given.iter().filter(|(label, _)| !cited.contains_key(*label)).collect();
    assert!(idle.is_empty(), "numbered but cited nowhere in src (cite it or drop the number): {idle:#?}");
}

/// The targets of the links of a page.
fn links(text: &str) -> Vec<String> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    targets.map(|(target, _)| target.to_owned()).collect()
}

#[test]
fn every_page_is_in_the_summary_once() {
    let listed = links(&read(&book().join("SUMMARY.md")));
    for path in files(&book(), "md") {
        let name = path.strip_prefix(book()).expect("a page of the book").display().to_string();
        let times = listed.iter().filter(|target| **target == name).count();
        assert_eq!(times, usize::from(name != "SUMMARY.md"), "docs/src/{name} in SUMMARY.md");
    }
}

#[test]
fn links_lead_somewhere() {
    let mut pages = files(&root().join("docs"), "md");
    pages.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name)));
    for page in pages {
        for target in links(&read(&page)).iter().filter(|target| !target.contains("://")) {
            let file = target.split('#').next().unwrap_or_default();
            let there = page.parent().expect("a folder").join(file);
            assert!(file.is_empty() || there.exists(), "{} leads to {target}, which is not there", page.display());
        }
    }
}

/// Signs that Markdown eats inside an equation, so that mdBook would show something else than GitHub.
const EATEN: [&str; 7] = ["\\,", "\\;", "\\!", "\\{", "\\\\", "}_", "*"];

#[test]
fn equations_survive_markdown() {
    for path in files(&book(), "md") {
        for equation in read(&path).split("$$").skip(1).step_by(2) {
            for sign in EATEN {
                let bad = equation.contains(sign);
                assert!(!bad, "{}: {sign} in {equation} (use \\quad, \\cr, \\lbrace, \\ast)", path.display());
            }
        }
    }
}

/// The words of a command line, without the quotes around some.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quote = None;
    for c in command.chars() {
        match (c, quote) {
            ('\'' | '"', None) => quote = Some(c),
            (c, Some(open)) if c == open => quote = None,
            (' ', None) => words.push(String::new()),
            _ => words.last_mut().expect("a word").push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The commands of the program that a page shows, in its blocks for the shell and in its text, without comments.
fn commands(page: &str) -> Vec<String> {
    let blocks = page.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next()).flat_map(str::lines);
    let marked = page.split('`').skip(1).step_by(2);
    let lines = blocks.chain(marked).map(|line| line.split(" #").next().unwrap_or_default().trim());
    let program = |line: &str| line.starts_with("pseudopod ") || line.starts_with("./setup run ");
    lines
        .filter(|line| program(line) && !line.contains('\n'))
        .map(|line| line.replace("./setup", "pseudopod"))
        .collect()
}

/// The pages that show commands to users.
fn pages_with_commands() -> Vec<PathBuf> {
    let mut pages = files(&book(), "md");
    pages.extend(files(&root().join("experiments"), "md"));
    pages.push(root().join("README.md"));
    pages
}

/// Stands for the document that a page shows, or for an experiment that it does not name.
const STANDS_FOR: [&str; 3] = ["FILE", "EXPERIMENT", "experiment.toml"];

#[test]
fn commands_shown_to_users_are_accepted_with_their_changes() {
    let (mut run, mut changed) = (0, 0);
    for path in pages_with_commands() {
        let page = read(&path);
        let shown = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
        let shown: Vec<&str> = shown.filter(|text| text.contains("[run]")).collect();
        for command in commands(&page) {
            let words = words(&command);
            let [_, verb, document, ..] = words.as_slice() else { continue };
            // A run of a study names no document.
            if !["run", "check"].contains(&verb.as_str()) || document.starts_with("--") {
                continue;
            }
            let sets: Vec<String> =
                words.windows(2).filter(|pair| pair[0] == "--set").map(|pair| pair[1].clone()).collect();
            let name = format!("{}: {command}", path.display());
            // The document of a tutorial grows on its page; tests/figures/tutorials.rs runs its commands.
            let grows = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("tutorial_"));
            let read = match STANDS_FOR.contains(&document.as_str()) {
                true if sets.is_empty() || grows => continue,
                true => {
                    let first = shown.first().unwrap_or_else(|| panic!("{name}: the page shows no document"));
                    pseudopod::experiment::Document::parse(&name, first, root(), &sets)
                }
                false => pseudopod::experiment::Document::read(&root().join(document), &sets),
            };
            if let Err(error) = read {
                panic!("{name}\n{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
            }
            (run, changed) = (run + 1, changed + sets.len());
        }
    }
    assert!(
        run >= 20 && changed >= 3,
        "{run} commands with {changed} changes were found; has the way of showing changed?"
    );
}

#[test]
fn pictures_shown_to_users_are_there_and_none_lies_idle() {
    let mut shown = std::collections::BTreeSet::new();
    for path in pages_with_commands() {
        for target in links(&read(&path)).into_iter().filter(|target| target.ends_with(".png")) {
            let file = path.parent().expect("a folder").join(target);
            let file = file.canonicalize().unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            shown.insert(file);
        }
    }
    let kept = files(&root().join("docs/pictures"), "png");
    let idle: Vec<&PathBuf> =
        kept.iter().filter(|path| !shown.contains(&path.canonicalize().expect("a path"))).collect();
    assert!(idle.is_empty(), "pictures that no page shows: {idle:?}");
}

#[test]
fn the_gallery_shows_every_experiment_with_a_picture() {
    let page = read(&book().join("gallery.md"));
    let entries = std::fs::read_dir(root().join("experiments")).expect("the experiments");
    let folders = entries.map(|entry| entry.expect("an entry")).filter(|entry| entry.path().is_dir());
    let mut count = 0;
    for name in folders.map(|entry| entry.file_name().to_string_lossy().into_owned()) {
        let part = page.split(&format!("**[{name}](")).nth(1).unwrap_or_else(|| panic!("gallery.md lacks {name}"));
        let own = part.split("**[").next().unwrap_or_default();
        assert_eq!(own.matches("](../pictures/").count(), 1, "{name} has one picture");
        count += 1;
    }
    assert_eq!(page.matches("**[").count(), count, "and nothing else is shown");
}

#[test]
fn the_book_lists_every_kind_of_measure_and_plot() {
    let page = read(&book().join("documents.md"));
    let schema = serde_json::to_value(pseudopod::experiment::schema()).expect("a schema");
    let definitions = &schema["$defs"];
    for (of, mark) in [("Measure", "**measure kinds**"), ("Plot", "**plot kinds**")] {
        let line = page.split(mark).nth(1).unwrap_or_else(|| panic!("{mark} in documents.md"));
        let line = line.split(['\n', '*']).next().unwrap_or_default();
        let kinds = definitions[of]["oneOf"].as_array().unwrap_or_else(|| panic!("kinds of {of}"));
        assert!(kinds.len() > 4, "{of}: {kinds:?}");
        for kind in kinds {
            let name = kind["properties"]["kind"]["const"].as_str().expect("a name");
            assert!(line.contains(&format!("`{name}`")), "{mark} lacks `{name}`");
        }
    }
}

#[test]
fn documents_shown_to_users_pass_the_check() {
    let mut pages = files(&book(), "md");
    pages.push(root().join("README.md"));
    let mut shown = 0;
    for page in pages {
        for rest in read(&page).split("```toml\n").skip(1) {
            let text = rest.split("```").next().unwrap_or_default();
            if !text.contains("[run]") {
                continue;
            }
            shown += 1;
            let name = page.display().to_string();
            let checked = pseudopod::experiment::Document::parse(&name, text, root(), &[]);
            if let Err(error) = checked {
                panic!("{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
            }
        }
    }
    assert!(shown >= 2, "the README and the book each show a document; {shown} found");
}
