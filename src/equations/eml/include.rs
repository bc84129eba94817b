//! Included documents: `<include document="parts.eml" prefix="a"/>` stands for what the other one declares.

use super::context::Context;
use super::declare;
use super::prefix::with_prefix;
use super::vocabulary::with_article;
use super::xml::{Element, LARGEST_DOCUMENT, Text, tree};
use super::{repeat, tables};
use crate::equations::expression::{Unit, is_identifier, is_reserved};
use crate::equations::files::NamedFile;
use crate::error::Source;
use crate::files::tidy;
use std::path::PathBuf;
use std::sync::Arc;

/// The most documents of which each includes the next.
const DEEPEST: usize = 16;
/// The most documents that are included in all.
const MOST: usize = 200;

/// Puts what other documents declare in the place of the elements that include them.
pub(super) fn take(context: &mut Context, root: &mut Element) {
    if root.all("include").next().is_none() {
        return;
    }
    let path = PathBuf::from(&context.source(root.at.start).0.name);
    let mut included = Taking { open: vec![tidy(&path)], taken: Vec::new(), roots: Vec::new() };
    included.expand(context, root, "");
    agree(context, root, &included.roots);
}

/// What has been included so far.
struct Taking {
    /// The documents on the way to the one that is read.
    open: Vec<PathBuf>,
    /// The documents that have been included, and under which prefix.
    taken: Vec<(PathBuf, String)>,
    /// Their first elements, without what these held.
    roots: Vec<Element>,
}

impl Taking {
    fn expand(&mut self, context: &mut Context, root: &mut Element, prefix: &str) {
        let children = std::mem::take(&mut root.children);
        for child in children {
            match child.kind.name {
                "include" => root.children.extend(self.parts(context, &child, prefix)),
                _ => root.children.push(child),
            }
        }
    }

    /// What an included document declares.
    fn parts(&mut self, context: &mut Context, element: &Element, outer: &str) -> Vec<Element> {
        let own = prefix_of(context, element);
        let (Some(own), Some(path)) = (own, self.path(context, element)) else { return Vec::new() };
        let prefix = if own.is_empty() { outer.to_owned() } else { format!("{outer}{own}_") };
        let key = (path.clone(), prefix.clone());
        // What several documents build on is there once.
        if self.taken.contains(&key) && element.all("set").next().is_none() {
            return Vec::new();
        }
        self.taken.push(key);
        let Some(mut root) = read(context, element) else { return Vec::new() };
        self.open.push(path);
        self.expand(context, &mut root, &prefix);
        self.open.pop();
        let mut children = std::mem::take(&mut root.children);
        // How all of it is solved, the document says that includes it.
        children.retain(|child| child.kind.name != "solver");
        root.children = children;
        if !own.is_empty() || element.all("set").next().is_some() {
            // The names of repeated parts and sums are known once these are written out.
            repeat::expand(context, &mut root);
        }
        set(context, element, &mut root);
        if !own.is_empty() {
            with_prefix(&mut root, &own);
        }
        let children = std::mem::take(&mut root.children);
        self.roots.push(root);
        children
    }

    /// Where an included document is, unless it cannot be included there.
    fn path(&self, context: &mut Context, element: &Element) -> Option<PathBuf> {
        let path = tidy(&find(context, element, true)?);
        let at = element.location("document");
        if let Some(first) = self.open.iter().position(|open| *open == path) {
            let circle: Vec<String> =
                self.open[first..].iter().chain([&path]).map(|path| path.display().to_string()).collect();
            let message = format!("documents include each other in a circle: {}", circle.join(" → "));
            let help = "put what both need into a third document, and let both include that one";
            context.fault(at, &message, "in the circle", help);
            return None;
        }
        let (message, label) = match () {
            () if self.open.len() > DEEPEST => {
                (format!("more than {DEEPEST} documents in a row include each other"), "too deep")
            }
            () if self.taken.len() >= MOST => (format!("more than {MOST} documents are included"), "one too many"),
            () => return Some(path),
        };
        context.fault(at, &message, label, "write what belongs together into one document");
        None
    }
}

/// Where the document is that an element includes; told, where there can be none.
fn find(context: &mut Context, element: &Element, tells: bool) -> Option<PathBuf> {
    let text = element.attribute("document")?;
    let at = element.location("document");
    let word = text.text.trim();
    let fault = match &context.files.folder {
        _ if word.is_empty() => ("the included document has no path", "which file?", "write document=\"parts.eml\""),
        Some(folder) => return Some(folder.join(context.path(at.start, word))),
        None => (
            "this document is read from no folder, and names a file",
            "where?",
            "write what the other document declares here",
        ),
    };
    if tells {
        context.fault(at, fault.0, fault.1, fault.2);
    }
    None
}

/// The tree of an included document, which joins the texts of the context.
fn read(context: &mut Context, element: &Element) -> Option<Element> {
    let path = find(context, element, false)?;
    let (word, at) = (element.word("document"), element.location("document"));
    let text = match context.files.text(&path, LARGEST_DOCUMENT as u64) {
        Ok(text) => text,
        Err(error) => {
            let message = format!("{word} cannot be read: {error}");
            let help = format!("paths are those from the document that includes it: {} was looked for", path.display());
            context.fault(at, &message, "this file", &help);
            return None;
        }
    };
    if context.length() + text.len() > LARGEST_DOCUMENT {
        let message = format!("with {word} the documents have more than {LARGEST_DOCUMENT} bytes");
        context.fault(at, &message, "one too many", "equations need far less: keep data in files of their own");
        return None;
    }
    let folder = context.path(at.start, &word).parent().map(PathBuf::from).unwrap_or_default();
    let first = context.add(Arc::new(Source { name: path.display().to_string(), text }), folder);
    tree(context, first)
}

/// What is set before the identifiers of an included document; empty, where nothing is.
fn prefix_of(context: &mut Context, element: &Element) -> Option<String> {
    let Some(text) = element.attribute("prefix") else { return Some(String::new()) };
    let word = text.text.trim().to_owned();
    if is_identifier(&word) && !is_reserved(&word) {
        return Some(word);
    }
    let message = format!("`prefix` is \"{word}\", which can begin no identifier");
    let help = "write letters, digits and _, beginning with a letter: with prefix=\"a\" the k of the document is a_k";
    context.fault(element.location("prefix"), &message, "this prefix", help);
    None
}

/// Puts other values in the place of those that an included document has.
fn set(context: &mut Context, element: &Element, root: &mut Element) {
    for set in element.all("set").filter(|set| set.attribute("id").is_some()) {
        let id = set.word("id");
        let target = root.children.iter_mut().find(|child| child.word("id") == id);
        let attribute = match target.as_ref().map(|target| target.kind.name) {
            Some("parameter") => "value",
            Some("variable" | "field") => "initial",
            Some("input") => "default",
            Some("algebraic") => "start",
            other => {
                let message = match other {
                    Some(other) => {
                        format!("`{id}` of the included document is {}, which has no value to set", with_article(other))
                    }
                    None => format!("the included document declares no `{id}`"),
                };
                let names = root.children.iter().map(|child| child.word("id")).collect::<Vec<_>>();
                let help = match context.meant(&id, names.iter().map(String::as_str)).filter(|_| other.is_none()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "set a parameter, the start of a variable or the default of an input".to_owned(),
                };
                context.fault(set.location("id"), &message, "set here", &help);
                continue;
            }
        };
        if let Some(target) = target {
            target.put(attribute, set.text.clone());
        }
    }
}

/// Tells included documents whose level or unit of time is not that of the whole.
fn agree(context: &mut Context, root: &Element, included: &[Element]) {
    let level = match root.word("level") {
        level if !level.is_empty() => level,
        _ if root.all("field").next().is_some() => "field".to_owned(),
        _ => "scene".to_owned(),
    };
    let seconds = |text: &str| Unit::read(if text.is_empty() { "s" } else { text }).ok();
    let time = root.word("time_unit");
    for other in included {
        let theirs = other.word("level");
        if !theirs.is_empty() && theirs != level {
            let message = format!("the document is of level {theirs}, and the one that includes it of level {level}");
            let help = format!("write level=\"{level}\" here, or level=\"{theirs}\" in the document that includes it");
            context.fault(other.location("level"), &message, "another level", &help);
        }
        if other.attribute("time_unit").is_some() && declare::unit(context, other, "time_unit").is_none() {
            continue;
        }
        let (Some(own), Some(other_unit)) = (seconds(&time), seconds(&other.word("time_unit"))) else { continue };
        if !own.is_same(&other_unit) {
            let word = |text: String| if text.is_empty() { "s".to_owned() } else { text };
            let (own, theirs) = (word(time.clone()), word(other.word("time_unit")));
            let message = format!("the document has time in {theirs}, and the one that includes it in {own}");
            let help = format!(
                "write both for one unit: its rates stay as they are written, and time_unit=\"{own}\" says what they are in"
            );
            context.fault(other.location("time_unit"), &message, "another unit of time", &help);
        }
    }
}

/// All files that a document and those that it includes name.
pub(super) fn named(context: &Context, root: &Element) -> Vec<NamedFile> {
    let Some(folder) = context.files.folder.clone() else { return Vec::new() };
    let path = |text: &Text, written: &str| folder.join(context.path(text.whole().start, written));
    let mut found = context.included();
    for child in &root.children {
        if let Some(text) = child.attribute("file").filter(|_| child.kind.name == "table") {
            let path = path(text, text.text.trim());
            let text = context.files.text(&path, tables::LARGEST_FILE).ok();
            found.push(NamedFile { path, text });
        }
        let image = child.attribute("image").map(|text| (text, text.text.trim()));
        let dataset = child.attribute("dataset").and_then(|text| Some((text, text.text.trim().rsplit_once(":/")?.0)));
        let pictures = image.into_iter().chain(dataset);
        found.extend(pictures.map(|(text, written)| NamedFile { path: path(text, written), text: None }));
    }
    found
}
