//! Files that use each other in a circle can only be read, changed and tested together. This test looks for circles among the files of
//! `src` and holds that there is none.

mod imports;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use imports::Library;

/// The largest sets of files each of which uses every other by some course, files alone left out.
fn circles<'a>(arrows: &BTreeMap<&'a str, BTreeSet<&'a str>>) -> Vec<Vec<&'a str>> {
    let reached = |from: &'a str| -> BTreeSet<&'a str> {
        let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
        while let Some(file) = next.pop() {
            next.extend(arrows.get(file).into_iter().flatten().filter(|other| seen.insert(**other)));
        }
        seen
    };
    let reach: BTreeMap<&str, BTreeSet<&str>> = arrows.keys().map(|&file| (file, reached(file))).collect();
    let circle = |file: &str| -> Vec<&'a str> {
        reach[file].iter().copied().filter(|other| reach.get(other).is_some_and(|set| set.contains(file))).collect()
    };
    let found: BTreeSet<Vec<&str>> = arrows.keys().map(|file| circle(file)).filter(|circle| circle.len() > 1).collect();
    found.into_iter().collect()
}

#[test]
fn circles_are_found_through_several_files() {
    let arrows = [("a", vec!["b"]), ("b", vec!["c"]), ("c", vec!["a", "d"]), ("d", vec!["e"]), ("e", vec![])];
    let arrows = arrows.into_iter().map(|(file, used)| (file, used.into_iter().collect())).collect();
    assert_eq!(circles(&arrows), [["a", "b", "c"]]);
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let library = Library::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let arrows = library.arrows();
    assert!(arrows.values().map(BTreeSet::len).sum::<usize>() > 500, "the imports of the code were not found");
    let found = circles(&arrows);
    let told = |circle: &[&str]| -> String {
        let within =
            |file: &&str| arrows[file].iter().filter(|other| circle.contains(other)).copied().collect::<Vec<_>>();
        let lines = circle.iter().map(|file| format!("    {file} -> {}", within(file).join(", ")));
        lines.collect::<Vec<_>>().join("\n")
    };
    let found: Vec<String> = found.iter().map(|circle| told(circle)).collect();
    assert!(found.is_empty(), "move what both need into a file below:\n{}", found.join("\n\n"));
}
