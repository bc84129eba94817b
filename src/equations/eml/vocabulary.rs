//! The elements and attributes of EML. `eml/eml.xsd` and the book say the same; a test compares them.

/// An attribute of an element: its name and what it means, in Markdown.
pub type Attribute = (&'static str, &'static str);

/// An element of the language.
#[derive(Debug)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// What it is, in Markdown.
    pub meaning: &'static str,
    /// Attributes that must be there.
    pub required: &'static [Attribute],
    /// Attributes that may be there.
    pub optional: &'static [Attribute],
    /// Elements that may stand inside.
    pub children: &'static [&'static str],
    /// Whether it holds an expression.
    pub text: bool,
    /// The only element that it stands in, where another one of the same name stands elsewhere.
    pub inside: Option<&'static str>,
}

impl Kind {
    /// The names of its attributes, those first that must be there.
    pub fn attributes(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.required.iter().chain(self.optional).map(|(name, _)| *name)
    }
}

/// An element that holds no expression.
const fn kind(
    name: &'static str,
    meaning: &'static str,
    required: &'static [Attribute],
    optional: &'static [Attribute],
    children: &'static [&'static str],
) -> Kind {
    Kind { name, meaning, required, optional, children, text: false, inside: None }
}

/// An element that holds an expression.
const fn holds(
    name: &'static str,
    meaning: &'static str,
    required: &'static [Attribute],
    optional: &'static [Attribute],
) -> Kind {
    Kind { text: true, ..kind(name, meaning, required, optional, &[]) }
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

const ID: Attribute =
    ("id", "Its name in expressions, columns and links: letters, digits, `_`, not beginning with a digit.");
const NAME: Attribute = ("name", "A name for people.");
const UNIT: Attribute = ("unit", "Its unit, `1` for a plain number; see [Units](eml.md#units).");
const NOISE: Attribute =
    ("noise", "The strength of [noise](noise.md), an expression of all that rates may use; none when absent.");
const HISTORY: Attribute =
    ("history", "What it was before the start, an expression of parameters and the time, for [delays](eml.md#delays).");

/// All elements.
#[rustfmt::skip] // a table
pub const ELEMENTS: [Kind; 25] = [
    kind("eml", "A document.", &[("name", "The name of the system, for messages.")], &[
        ("level", "Who has the system: `scene` (one for all), `cell` (one for each cell of the types that name it), `field` (one at each point of \
                   a grid), `membrane` (one at each atom of these cells). When absent `field` if there are fields, else `scene`."),
        ("time_unit", "The unit of time of all rates, such as `min`; `s` when absent.")], &PARTS),
    kind("include", "[What another document declares](eml.md#included-documents).",
        &[("document", "Its path from the folder of the document.")],
        &[("prefix", "Identifiers of what it declares are `prefix_ID` here; as they are when absent.")], &["set"]),
    kind("parameter", "A quantity that keeps its value, unless an event sets it.",
        &[ID, ("value", "A number, or an expression of other parameters.")], &[NAME, UNIT], &[]),
    kind("variable", "A quantity that changes.", &[ID,
        ("initial", "What it starts with: an expression without time, also with [random numbers](eml.md#random-starts).")], &[
        ("diffusion", "Along the surface, in documents of membranes, in um^2 over the `time_unit`; 0 when absent."), HISTORY,
        ("level", "`cell` for a pool inside the cell, in documents of [membranes](membranes.md)."), NAME, NOISE,
        ("rate", "Its rate of change; an `<equation>` or `<reaction>`s say it when absent."), UNIT], &[]),
    holds("equation", "The rate of change of a variable.", &[("of", "The identifier of the variable.")], &[]),
    kind("reaction", "[What turns variables into others](eml.md#reactions); its identifier equals its rate.",
        &[("equation", "What is used up and what is made, with the number of each: `2 A = D`, `-> A`, `A + $S -> B`."), ID,
            ("rate", "How often it happens in the unit of time, an expression.")],
        &[NAME, ("reverse", "How often the way back happens; its rate is the difference.")], &[]),
    holds("define", "A quantity that always equals an expression.", &[ID], &[HISTORY, NAME, UNIT]),
    holds("algebraic", "[A quantity that an equation determines](eml.md#algebraic-equations), which it holds: `left = right`.", &[ID],
        &[NAME, ("start", "From where it is sought, an expression without the unknowns; needed where the equation is not linear in it."), UNIT]),
    holds("function", "A function for expressions; it may call others.",
        &[("args", "The names of its arguments, parted by commas."), ID], &[]),
    holds("table", "[A function by rows of numbers](eml.md#tables), which stand in it or in a file.", &[ID], &[
        ("argument", "The column of the file with arguments; the first when absent."),
        ("argument_unit", "The unit of the argument; the `time_unit` when absent."),
        ("file", "A file of comma separated values, by its path from the folder of the document."),
        ("interpolation", "`linear` (when absent), `step` (the row before) or `cubic` (smooth, rising and falling with the rows)."),
        ("unit", "The unit of the values; plain numbers when absent."),
        ("value", "The column of the file with values; the second when absent.")]),
    kind("input", "A number from outside, by a link or by the program.",
        &[("default", "The value that stands until one comes."), ID],
        &[("level", "`membrane`, in documents of membranes: a number for each atom."), NAME, UNIT], &[]),
    holds("mean", "The mean of an expression over the grid or over the surface of the cell.", &[ID], &[NAME, UNIT]),
    holds("integral", "The integral of an expression over the grid or over the surface of the cell.", &[ID], &[NAME, UNIT]),
    kind("event", "[What happens at an instant](eml.md#events): it sets variables, parameters and fields.", &[], &[
        ("at_start", "What an event does whose condition holds at the start: `fire` (when absent), or `wait` until it has been false."),
        ("delay", "Time from firing to execution; 0 when absent."),
        ("every", "In place of `when`: it fires again each time that this has passed."),
        ("first", "The time of the first of these; 0 when absent."),
        ("id", "A name, for messages."),
        ("persistent", "`false`: it is dropped when its condition becomes false before it is executed; `true` when absent."),
        ("priority", "Of events at one time the larger is executed first."),
        ("until", "The time after which `every` fires no more; without end when absent."),
        ("values_from", "When the new values are computed: at `firing` (when absent) or at `execution`."),
        ("when", "The condition: the event fires when it turns from false to true.")], &["set"]),
    holds("set", "What an event sets, or what is put into an included document: the expression is the new value.",
        &[("id", "What is set.")], &[]),
    kind("solver", "How the document asks [to be solved](ode.md); the experiment may override all of it.", &[], &[
        ("atol", "Absolute tolerance."),
        ("inner_step", "The step of `rk4` and `euler`, which need one, in the `time_unit`."),
        ("noise_step", "Time between two kicks of [noise](noise.md); each step of the run when absent."),
        ("rtol", "Relative tolerance."),
        ("scheme", "One of the [schemes](#schemes)."),
        ("step", "Time between two exchanges with the model; each step of the run when absent.")], &[]),
    kind("grid", "The points of the fields, in documents of [fields](fields.md).", &[
        ("dimension", "1 on a line along x, 2 on the substrate, 3 in the medium."),
        ("spacing", "The distance of its points.")], &[
        ("origin", "Its lower corner, 1 to 3 numbers with blanks between, where the experiment does not say it."),
        ("size", "The lengths of its sides, likewise."),
        ("unit", "The unit of these lengths; `um` when absent.")], &[]),
    kind("field", "A substance, or another quantity, at every point of the grid.", &[ID], &[
        ("dataset", "In place of `initial`: `FILE.h5:/GROUP/DATASET`, times `scale`."),
        ("decay", "The rate at which it decays, of numbers and parameters; 0 when absent."),
        ("diffusion", "In length squared over time, an expression of everything; 0 when absent."),
        ("image", "In place of `initial`: an image file, black 0 and white `scale`."),
        ("initial", "What it starts with: an expression of the position x, y, z."), NAME, NOISE,
        ("range", "`non_negative` (when absent), a concentration, or `free`, such as a potential."),
        ("scale", "What white in the `image`, or 1 in the `dataset`, stands for; 1 when absent."), UNIT],
        &["advection", "reaction", "source", "taxis", "wall"]),
    kind("advection", "A flow that carries the field: expressions of parameters, inputs, the position and the time.", &[],
        &[("x", "Its velocity along x; 0 when absent."), ("y", "Along y."), ("z", "Along z.")], &[]),
    kind("taxis", "The field moves up the gradient of another.", &[
        ("sensitivity", "The velocity over the gradient, an expression of everything; negative to move down."),
        ("towards", "The field that it follows.")], &[], &[]),
    kind("source", "A point, or a line, that releases the field.",
        &[("strength", "How much over time, an expression of parameters, inputs and the time; negative to take.")], &[
        ("at", "The point, in the unit of the grid."),
        ("from", "In place of `at`: one end of a line."), ("to", "The other end.")], &[]),
    Kind { inside: Some("field"), ..holds("reaction", "The rate at which reactions change the field: an expression of all fields, parameters, \
        definitions, inputs, the time and the position.", &[], &[]) },
    kind("wall", "What happens at a side of the grid; nothing passes where there is none.", &[
        ("kind", "`no_flux`, `fixed` (the field has the value), `periodic`, `flux` (so much comes in for each area) or `open` (what flows out \
                  leaves, what flows in has the value)."),
        ("side", "`x-`, `x+`, `y-`, `y+`, `z-` or `z+`.")],
        &[("value", "An expression of the position and the time, of `flux` also of the fields.")], &[]),
    kind("repeat", "[Parts that there are several times](eml.md#repeated-parts): `X[i]` becomes `X_1`, `X_2`, ….", &[
        ("count", "How many times."), ("index", "The name of the index.")], &[
        ("from", "The first value of the index; 1 when absent."),
        ("periodic", "`true`: the last has the first as its neighbour.")], &REPEATED),
    kind("link", "[A number that is carried](eml.md#links) at each exchange.", &[
        ("from", "Where it is read: `system.ID`, or `cell.volume`, `field[NAME].gradient.x` …: see [what can be read](coupling.md)."),
        ("to", "Where it is set.")], &[
        ("gain", "A factor of it; 1 when absent."),
        ("id", "A name, so that an experiment can replace the link."),
        ("transfer", "What becomes of it: an expression of `value` and the quantities of the system; `value` when absent.")], &[]),
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
