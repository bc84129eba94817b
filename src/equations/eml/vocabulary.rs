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
}

const fn kind(
    name: &'static str,
    required: &'static [&'static str],
    optional: &'static [&'static str],
    children: &'static [&'static str],
    text: bool,
) -> Kind {
    Kind { name, required, optional, children, text }
}

/// What stands at the top of a document.
const PARTS: [&str; 13] = [
    "parameter",
    "variable",
    "equation",
    "define",
    "function",
    "input",
    "mean",
    "integral",
    "event",
    "solver",
    "grid",
    "field",
    "link",
];

/// All elements.
#[rustfmt::skip] // a table
pub const ELEMENTS: [Kind; 20] = [
    kind("eml", &["name"], &["level", "time_unit"], &PARTS, false),
    kind("parameter", &["id", "value"], &["name", "unit"], &[], false),
    kind("variable", &["id", "initial"], &["diffusion", "history", "level", "name", "noise", "rate", "unit"], &[], false),
    kind("equation", &["of"], &[], &[], true),
    kind("define", &["id"], &["history", "name", "unit"], &[], true),
    kind("function", &["args", "id"], &[], &[], true),
    kind("input", &["default", "id"], &["level", "name", "unit"], &[], false),
    kind("mean", &["id"], &["name", "unit"], &[], true),
    kind("integral", &["id"], &["name", "unit"], &[], true),
    kind("event", &["when"], &["at_start", "delay", "id", "persistent", "priority", "values_from"], &["set"], false),
    kind("set", &["id"], &[], &[], true),
    kind("solver", &[], &["atol", "inner_step", "noise_step", "rtol", "scheme", "step"], &[], false),
    kind("grid", &["dimension", "spacing"], &["origin", "size", "unit"], &[], false),
    kind("field", &["id"], &["dataset", "decay", "diffusion", "image", "initial", "name", "noise", "range", "scale", "unit"],
        &["advection", "reaction", "source", "taxis", "wall"], false),
    kind("advection", &[], &["x", "y", "z"], &[], false),
    kind("taxis", &["sensitivity", "towards"], &[], &[], false),
    kind("source", &["strength"], &["at", "from", "to"], &[], false),
    kind("reaction", &[], &[], &[], true),
    kind("wall", &["kind", "side"], &["value"], &[], false),
    kind("link", &["from", "to"], &["gain", "id", "transfer"], &[], false),
];

/// The element with a name.
pub fn kind_of(name: &str) -> Option<&'static Kind> {
    ELEMENTS.iter().find(|kind| kind.name == name)
}
