//! Which file of `src` uses which other: the `use` lines and the paths in the code, followed through what modules pass on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A module: its names from the crate's root.
pub type Module = Vec<String>;

/// A path as it is used, and the name that it is passed on under, if that is another.
type Used = (Vec<String>, Option<String>);

/// What a file says.
struct Page {
    file: String,
    /// Paths that its own code uses.
    uses: Vec<Used>,
    /// Paths that it passes on (`pub use`): whoever uses these uses the file where they stand.
    passed_on: Vec<Used>,
}

/// All files of a source folder by their modules.
pub struct Library(BTreeMap<Module, Page>);

impl Library {
    /// Reads the folder. Programs (`main.rs`) and files of tests (`*_tests.rs`, `tests.rs`, `test_*.rs`) are left out.
    pub fn read(source: &Path) -> Self {
        let mut pages = BTreeMap::new();
        let mut folders = vec![source.to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).expect("src can be read") {
                let path = entry.expect("an entry that can be read").path();
                let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
                let is_test = name.ends_with("_tests.rs") || name == "tests.rs" || name.starts_with("test_");
                if path.is_dir() {
                    folders.push(path);
                } else if name.ends_with(".rs") && name != "main.rs" && !is_test {
                    let below = path.strip_prefix(source).expect("a file of src").with_extension("");
                    let mut module: Module = below.iter().map(|part| part.to_string_lossy().into_owned()).collect();
                    if module.last().is_some_and(|last| last == "mod" || last == "lib") {
                        module.pop();
                    }
                    let text = std::fs::read_to_string(&path).expect("a source can be read");
                    let file = path.strip_prefix(source).expect("a file of src").to_string_lossy().replace('\\', "/");
                    pages.insert(module, page(file, &text));
                }
            }
        }
        Self(pages)
    }

    /// The files that each file uses, itself left out.
    pub fn arrows(&self) -> BTreeMap<&str, BTreeSet<&str>> {
        let of = |(module, page): (&Module, &Page)| -> BTreeSet<&str> {
            let used = page.uses.iter().filter_map(|(path, _)| self.absolute(module, path));
            let origins = used.filter_map(|path| self.origin(&path, &mut Vec::new()));
            origins
                .filter(|origin| *origin != module && !origin.is_empty())
                .map(|origin| &*self.0[origin].file)
                .collect()
        };
        self.0.iter().map(|(module, page)| (&*page.file, of((module, page)))).collect()
    }

    /// A path from the crate's root; none for other crates and local names.
    fn absolute(&self, module: &Module, path: &[String]) -> Option<Vec<String>> {
        let mut base = module.clone();
        let mut rest = path;
        match path[0].as_str() {
            "crate" => (base, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|name| name == "super") {
                    base.pop()?;
                    rest = &rest[1..];
                }
            }
            child => {
                let mut inner = base.clone();
                inner.push(child.to_owned());
                self.0.get(&inner)?;
            }
        }
        base.extend_from_slice(rest);
        Some(base)
    }

    /// The module in which the item of a path stands.
    fn origin<'a>(&'a self, path: &[String], seen: &mut Vec<(Module, String)>) -> Option<&'a Module> {
        let (module, page) = (0..=path.len()).rev().find_map(|end| self.0.get_key_value(&path[..end]))?;
        let Some(name) = path.get(module.len()) else { return Some(module) };
        let step = (module.clone(), name.clone());
        if !seen.contains(&step) {
            seen.push(step);
            for (passed, alias) in &page.passed_on {
                let (last, before) = passed.split_last()?;
                let target = match alias.as_ref().unwrap_or(last).as_str() {
                    "*" => [before, std::slice::from_ref(name)].concat(),
                    known if known == name => passed.clone(),
                    _ => continue,
                };
                let found = self.absolute(module, &target).and_then(|path| self.origin(&path, seen));
                if found.is_some_and(|found| !found.is_empty() && found != module) {
                    return found;
                }
            }
        }
        Some(module)
    }
}

fn page(file: String, text: &str) -> Page {
    let mut page = Page { file, uses: Vec::new(), passed_on: Vec::new() };
    let code = bare(text);
    let mut rest = String::new();
    for statement in code.split_inclusive(';') {
        // What stands before a `use` line belongs to the code.
        let at = statement.match_indices("use ").find(|(at, _)| starts_line(&statement[..*at])).map(|(at, _)| at);
        let Some(at) = at else {
            rest.push_str(statement);
            continue;
        };
        let line = statement[..at].rfind('\n').map_or(0, |end| end + 1);
        rest.push_str(&statement[..line]);
        let list = if statement[line..at].contains("pub") { &mut page.passed_on } else { &mut page.uses };
        add_tree(statement[at + 4..].trim_end_matches(';'), &[], list);
    }
    for start in ["crate::", "super::"] {
        for (at, _) in rest.match_indices(start) {
            let before = rest[..at].chars().next_back();
            if before.is_none_or(|sign| !sign.is_alphanumeric() && sign != '_' && sign != ':') {
                let end = rest[at..].find(|sign: char| !sign.is_alphanumeric() && sign != '_' && sign != ':');
                let path = &rest[at..end.map_or(rest.len(), |end| at + end)];
                page.uses.push((path.split("::").filter(|name| !name.is_empty()).map(str::to_owned).collect(), None));
            }
        }
    }
    page
}

/// Whether only a visibility stands between the begin of the line and its end.
fn starts_line(before: &str) -> bool {
    let line = before.rsplit('\n').next().unwrap_or_default().trim();
    line.is_empty() || line == "pub" || (line.starts_with("pub(") && line.ends_with(')'))
}

/// The code of a file without comments, texts and the tests at its end.
fn bare(text: &str) -> String {
    let body = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let mut code = String::with_capacity(body.len());
    for line in body.lines() {
        let (mut in_text, mut signs) = (false, line.chars().peekable());
        while let Some(sign) = signs.next() {
            match sign {
                '\\' if in_text => _ = signs.next(),
                '"' => in_text = !in_text,
                '/' if !in_text && signs.peek() == Some(&'/') => break,
                _ if !in_text => code.push(sign),
                _ => {}
            }
        }
        code.push('\n');
    }
    code
}

/// Adds all paths of a tree such as `a::{b, c::D as E}`.
fn add_tree(tree: &str, prefix: &[String], list: &mut Vec<Used>) {
    let names = |text: &str| -> Vec<String> {
        text.split("::").map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned).collect()
    };
    let Some((head, body)) = tree.split_once('{') else {
        let (path, alias) = tree.split_once(" as ").map_or((tree, None), |(path, alias)| (path, Some(alias)));
        let path = [prefix, &names(path)].concat();
        if !path.is_empty() {
            list.push((path, alias.map(|alias| alias.trim().to_owned())));
        }
        return;
    };
    let prefix = [prefix, &names(head)].concat();
    let (mut depth, mut from) = (0, 0);
    let body = body.rfind('}').map_or(body, |end| &body[..end]);
    for (at, sign) in body.char_indices() {
        match sign {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                add_tree(&body[from..at], &prefix, list);
                from = at + 1;
            }
            _ => {}
        }
    }
    add_tree(&body[from..], &prefix, list);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_found_in_trees_and_in_code_but_not_in_texts_and_comments() {
        let text = "use super::{a::B, c::{D as E, *}};\npub use f::G;\nfn x() {\n    // crate::no::No\n    let y = \"crate::no::No;\";\n    crate::h::i(y)\n}\n#[cfg(test)]\nmod tests {\n    use super::no::No;\n}\n";
        let page = page("x.rs".into(), text);
        let paths = |list: &[Used]| -> Vec<String> { list.iter().map(|(path, _)| path.join("::")).collect() };
        assert_eq!(paths(&page.uses), ["super::a::B", "super::c::D", "super::c::*", "crate::h::i"]);
        assert_eq!(page.uses[1].1.as_deref(), Some("E"));
        assert_eq!(paths(&page.passed_on), ["f::G"]);
    }
}
