//! The elements and attributes of EML. `eml/eml.xsd` and the book say the same; a test compares them.

/// An element of the language.
#[derive(Debug)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// Attributes that must be there.
    pub required: &'static [&'static str],
    /// Attributes that may be there.
    pub optional: &'static [&'static str],
    /// Elements that may stand inside.
    pub children: &'static [&'static str],
    /// Whether it holds an expression.
    pub text: bool,
    /// The only element that it stands in, where another one of the same name stands elsewhere.
    pub inside: Option<&'static str>,
}

const fn kind(
    name: &'static str,
    required: &'static [&'static str],
    optional: &'static [&'static str],
    children: &'static [&'static str],
    text: bool,
) -> Kind {
    Kind { name, required, optional, children, text, inside: None }
}

/// The most elements that are made by repetition, and terms of sums.
pub(super) const MOST_REPEATED: usize = 20_000;

/// What stands at the top of a document.
const PARTS: [&str; 18] = [
    "include",
    "parameter",
    "variable",
    "equation",
    "reaction",
    "define",
    "algebraic",
    "function",
    "table",
    "input",
    "mean",
    "integral",
    "event",
    "solver",
    "grid",
    "field",
    "link",
    "repeat",
];

/// What can be repeated.
const REPEATED: [&str; 14] = [
    "parameter",
    "variable",
    "equation",
    "reaction",
    "define",
    "algebraic",
    "function",
    "input",
    "mean",
    "integral",
    "event",
    "field",
    "link",
    "repeat",
];

/// All elements.
#[rustfmt::skip] // a table
pub const ELEMENTS: [Kind; 25] = [
    kind("eml", &["name"], &["level", "time_unit"], &PARTS, false),
    kind("include", &["document"], &["prefix"], &["set"], false),
    kind("parameter", &["id", "value"], &["name", "unit"], &[], false),
    kind("variable", &["id", "initial"], &["diffusion", "history", "level", "name", "noise", "rate", "unit"], &[], false),
    kind("equation", &["of"], &[], &[], true),
    kind("reaction", &["equation", "id", "rate"], &["name", "reverse"], &[], false),
    kind("define", &["id"], &["history", "name", "unit"], &[], true),
    kind("algebraic", &["id"], &["name", "start", "unit"], &[], true),
    kind("function", &["args", "id"], &[], &[], true),
    kind("table", &["id"], &["argument", "argument_unit", "file", "interpolation", "unit", "value"], &[], true),
    kind("input", &["default", "id"], &["level", "name", "unit"], &[], false),
    kind("mean", &["id"], &["name", "unit"], &[], true),
    kind("integral", &["id"], &["name", "unit"], &[], true),
    kind("event", &[], &["at_start", "delay", "every", "first", "id", "persistent", "priority", "until", "values_from", "when"],
        &["set"], false),
    kind("set", &["id"], &[], &[], true),
    kind("solver", &[], &["atol", "inner_step", "noise_step", "rtol", "scheme", "step"], &[], false),
    kind("grid", &["dimension", "spacing"], &["origin", "size", "unit"], &[], false),
    kind("field", &["id"], &["dataset", "decay", "diffusion", "image", "initial", "name", "noise", "range", "scale", "unit"],
        &["advection", "reaction", "source", "taxis", "wall"], false),
    kind("advection", &[], &["x", "y", "z"], &[], false),
    kind("taxis", &["sensitivity", "towards"], &[], &[], false),
    kind("source", &["strength"], &["at", "from", "to"], &[], false),
    Kind { inside: Some("field"), ..kind("reaction", &[], &[], &[], true) },
    kind("wall", &["kind", "side"], &["value"], &[], false),
    kind("repeat", &["count", "index"], &["from", "periodic"], &REPEATED, false),
    kind("link", &["from", "to"], &["gain", "id", "transfer"], &[], false),
];

/// The name of an element with its article: "an <input>".
pub(super) fn with_article(name: &str) -> String {
    let article = if name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    format!("{article} <{name}>")
}

/// The element with a name.
pub fn kind_of(name: &str) -> Option<&'static Kind> {
    ELEMENTS.iter().find(|kind| kind.name == name)
}

/// The element with a name that may stand in another.
pub fn child_of(parent: &Kind, name: &str) -> Option<&'static Kind> {
    let own = ELEMENTS.iter().find(|kind| kind.name == name && kind.inside == Some(parent.name));
    own.or_else(|| kind_of(name)).filter(|child| parent.children.contains(&child.name))
}
