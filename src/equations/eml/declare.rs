//! First reading of a document: what has an identifier, its unit, and the functions.

use super::context::Context;
use super::document::Level;
use super::random_words::misplaced;
use super::reactions::{changes, equation, shared_unit};
pub(super) use super::reads::POSITION;
use super::tables::table;
use super::xml::{Element, Text};
use crate::equations::expression::{Function, Scope, Trouble, Unit, is_identifier, is_reserved, parse};
use crate::equations::tree::{Expr, QuantityId, Reaction};
use std::collections::{BTreeMap, HashMap};

/// Elements whose identifier names a quantity.
const QUANTITIES: [&str; 9] =
    ["parameter", "variable", "define", "algebraic", "reaction", "input", "field", "mean", "integral"];
/// What is given on the surface of a cell: the position from its centre, and area and volume of the cell.
pub const SURFACE: [&str; 5] = ["x", "y", "z", "area", "volume"];

/// A quantity and the element that declares it.
pub(super) struct Declared<'a> {
    pub(super) id: String,
    pub(super) element: &'a Element,
}

/// What is known before any expression is looked at.
pub(super) struct Declarations<'a> {
    pub(super) quantities: Vec<Declared<'a>>,
    /// Everything that an expression may use.
    pub(super) scope: Scope,
    pub(super) units: HashMap<String, Unit>,
    pub(super) level: Level,
    pub(super) time_text: String,
    pub(super) time: Unit,
    /// Unit of length of the grid.
    pub(super) length_text: String,
    pub(super) length: Unit,
    /// Quantities that every document of this level has, behind those that it declares, with their units.
    pub(super) given: Vec<(&'static str, Unit)>,
    /// The reactions whose equations are good.
    pub(super) reactions: Vec<Reaction>,
    /// Whether the equation of some reaction is at fault, so that it is not known what changes.
    pub(super) lost_reactions: bool,
    /// Whether the document has any unit; in one without, time and position have none either.
    measured: bool,
}

impl<'a> Declarations<'a> {
    /// The quantity with an identifier, as it is declared.
    pub(super) fn declared(&self, id: &str) -> Option<&Declared<'a>> {
        self.scope.quantities.get(id).and_then(|number| self.quantities.get(*number as usize))
    }

    /// The element that declares an identifier: "variable".
    pub(super) fn sort(&self, id: &str) -> Option<&'static str> {
        self.declared(id).map(|declared| declared.element.kind.name)
    }

    /// All identifiers of quantities.
    pub(super) fn ids(&self) -> impl Iterator<Item = &str> {
        self.quantities.iter().map(|quantity| quantity.id.as_str())
    }

    /// The unit of time, if the document has units.
    pub(super) fn time_in_units(&self) -> Option<&Unit> {
        self.measured.then_some(&self.time)
    }
}

/// Tells a trouble of an expression at its location in the document.
pub(super) fn tell(context: &mut Context, text: &Text, trouble: &Trouble) {
    context.fault(text.location(&trouble.at), &trouble.message, &trouble.label, &trouble.help);
}

/// A fault at an attribute of an element.
pub(super) fn tell_at(context: &mut Context, at: &Element, attribute: &str, message: &str, label: &str, help: &str) {
    context.fault(at.location(attribute), message, label, help);
}

/// Reads the unit in an attribute.
pub(super) fn unit(context: &mut Context, element: &Element, attribute: &str) -> Option<Unit> {
    let text = element.attribute(attribute)?;
    match Unit::read(&text.text) {
        Ok(unit) => Some(unit),
        Err(error) => {
            context.fault(text.location(&error.at), &error.message, "this unit", &error.help);
            None
        }
    }
}

/// Reads all declarations of a document.
pub(super) fn declare<'a>(context: &mut Context, root: &'a Element) -> Declarations<'a> {
    let level = level(context, root);
    let (time_text, time) =
        base_unit(context, root, "time_unit", "s", &Unit::read("s").unwrap_or_else(|_| Unit::plain()));
    let grid = root.all("grid").next();
    let micrometre = Unit::read("um").unwrap_or_else(|_| Unit::plain());
    let (length_text, length) = match grid {
        Some(grid) => base_unit(context, grid, "unit", "um", &micrometre),
        None => ("um".to_owned(), micrometre),
    };
    let mut found = Declarations {
        quantities: Vec::new(),
        scope: Scope::default(),
        units: HashMap::new(),
        level,
        time_text,
        time,
        length_text,
        given: given(level, &length),
        length,
        reactions: Vec::new(),
        lost_reactions: false,
        measured: root.attribute("time_unit").is_some()
            || root.children.iter().any(|child| child.attribute("unit").is_some()),
    };
    let mut lines: BTreeMap<String, usize> = BTreeMap::new();
    for element in root.children.iter().filter(|child| child.attribute("id").is_some()) {
        let id = element.word("id");
        let quantity = QUANTITIES.contains(&element.kind.name);
        let taken = found.given.iter().any(|(name, _)| *name == id).then_some(level);
        if !usable(context, element, &id, taken) || !unique(context, element, &id, &mut lines) || !quantity {
            continue;
        }
        if let Some(unit) = unit(context, element, "unit") {
            found.units.insert(id.clone(), unit);
        }
        found.scope.quantities.insert(id.clone(), found.quantities.len() as QuantityId);
        found.quantities.push(Declared { id, element });
    }
    for (index, (name, unit)) in found.given.iter().enumerate() {
        found.scope.quantities.insert((*name).to_owned(), (found.quantities.len() + index) as QuantityId);
        if found.measured {
            found.units.insert((*name).to_owned(), unit.clone());
        }
    }
    if matches!(level, Level::Field | Level::Membrane) {
        found.scope.no_delay =
            format!("documents of level {} keep no history: let a chain of substances take the time", level.name());
    }
    reactions(context, root, &mut found);
    tables(context, root, &mut found);
    functions(context, root, &mut found.scope);
    found
}

/// Reads the tables, each of which is a function.
fn tables(context: &mut Context, root: &Element, found: &mut Declarations) {
    for element in root.all("table").filter(|element| element.attribute("id").is_some()) {
        let id = element.word("id");
        for attribute in ["unit", "argument_unit"] {
            unit(context, element, attribute);
        }
        let argument = element.attribute("argument_unit").map_or(found.time_text.clone(), |text| text.text.clone());
        let value = element.attribute("unit").map_or("1".to_owned(), |text| text.text.clone());
        let units = found.measured.then_some([argument.as_str(), value.as_str()]);
        let Some(function) = table(context, element, units) else {
            // Calls of it are known all the same.
            let body = parse("0").0;
            found.scope.functions.insert(id, Function { arguments: vec!["x".to_owned()], body });
            continue;
        };
        found.scope.functions.insert(id, function);
    }
}

/// Reads the equations of the reactions, which tell the units of their rates.
fn reactions(context: &mut Context, root: &Element, found: &mut Declarations) {
    for element in root.all("reaction") {
        let id = element.word("id");
        let Some(rate) = found.scope.quantities.get(&id).copied() else { continue };
        let find = |id: &str| {
            let number = found.scope.quantities.get(id).copied()?;
            Some((number, found.quantities.get(number as usize).map(|declared| declared.element)))
        };
        let names = || found.quantities.iter().filter(|other| changes(other.element)).map(|other| other.id.as_str());
        let Some(terms) = equation(context, element, &find, &names) else {
            found.lost_reactions = true;
            continue;
        };
        if let Some(unit) = shared_unit(context, &terms, &found.units) {
            found.units.insert(id, unit.times(&found.time.to_the(-1.0)));
        }
        found.reactions.push(terms.reaction(rate));
    }
}

/// What every document of a level is given.
fn given(level: Level, length: &Unit) -> Vec<(&'static str, Unit)> {
    let position = POSITION.map(|name| (name, length.clone()));
    match level {
        Level::Scene | Level::Cell => Vec::new(),
        Level::Field => position.to_vec(),
        Level::Membrane => {
            let more = [(SURFACE[3], length.to_the(2.0)), (SURFACE[4], length.to_the(3.0))];
            position.into_iter().chain(more).collect()
        }
    }
}

fn level(context: &mut Context, root: &Element) -> Level {
    let has_fields = root.all("field").next().is_some();
    let level = match root.word("level").as_str() {
        "scene" => Level::Scene,
        "cell" => Level::Cell,
        "field" => Level::Field,
        "membrane" => Level::Membrane,
        "" if has_fields => Level::Field,
        "" => Level::Scene,
        other => {
            let message = format!("there is no level \"{other}\"");
            context.fault(
                root.location("level"),
                &message,
                "unknown level",
                "write \"scene\", \"cell\", \"field\" or \"membrane\"",
            );
            return if has_fields { Level::Field } else { Level::Scene };
        }
    };
    // What a document of fields may not hold, and the other way round.
    let (misplaced, help): (&[&str], &str) = match level {
        Level::Field => (&["algebraic"], "give it a document of its own, without fields, and join the two by <link>s"),
        Level::Membrane => (
            &["field", "grid", "event", "algebraic"],
            "a document of membranes has <variable>s; give fields and events documents of their own",
        ),
        _ => (
            &["field", "grid", "mean", "integral"],
            "write level=\"field\" for a document of fields, level=\"membrane\" for one of surfaces, and join it by <link>s",
        ),
    };
    for element in root.children.iter().filter(|child| misplaced.contains(&child.kind.name)) {
        let message = format!("<{}> cannot stand in a document of level {}", element.kind.name, level.name());
        let help = match element.kind.name {
            "algebraic" => {
                "equations that determine unknowns stand in documents of the scene and of cells: solve for it by hand"
            }
            _ => help,
        };
        context.fault(element.at.clone(), &message, "not at this level", help);
    }
    level
}

/// A unit that must measure the same as a base unit.
fn base_unit(context: &mut Context, element: &Element, attribute: &str, usual: &str, base: &Unit) -> (String, Unit) {
    let usual = || (usual.to_owned(), base.clone());
    let Some(found) = unit(context, element, attribute) else { return usual() };
    if found.dimension() == base.dimension() {
        return (element.word(attribute), found);
    }
    let wanted = base.dimension().map_or(String::new(), |dimension| dimension.with_article());
    let told = found.dimension().map_or(String::new(), |dimension| dimension.with_article());
    let message = format!("`{attribute}` is {told}; {wanted} was expected");
    context.fault(element.location(attribute), &message, &told, &format!("write a unit such as \"{}\"", base.text()));
    usual()
}

/// Whether a word can be an identifier here.
fn usable(context: &mut Context, element: &Element, id: &str, taken: Option<Level>) -> bool {
    let (message, help) = if !is_identifier(id) {
        (format!("\"{id}\" is no identifier"), "write letters, digits and _, beginning with a letter")
    } else if is_reserved(id) {
        (
            format!("`{id}` means something in every expression"),
            "choose another identifier, such as one with a _ at its end",
        )
    } else if let Some(level) = taken {
        let what = match (level, POSITION.contains(&id)) {
            (Level::Field, _) => "the position in a field",
            (_, true) => "the position on the surface",
            (_, false) => "of the whole cell",
        };
        (format!("`{id}` is {what}"), "choose another identifier")
    } else {
        return true;
    };
    context.fault(element.location("id"), &message, "this identifier", help);
    false
}

fn unique(context: &mut Context, element: &Element, id: &str, lines: &mut BTreeMap<String, usize>) -> bool {
    let at = element.location("id");
    if let Some(&other) = lines.get(id) {
        let label = format!("already declared in {}", context.line(other, at.start));
        context.fault(
            at,
            &format!("two things have the identifier `{id}`"),
            &label,
            "give one of them another identifier",
        );
        return false;
    }
    lines.insert(id.to_owned(), at.start);
    true
}

/// Reads the functions and checks their bodies and that none calls itself.
fn functions(context: &mut Context, root: &Element, scope: &mut Scope) {
    let mut elements: BTreeMap<String, &Element> = BTreeMap::new();
    for element in root.all("function") {
        let id = element.word("id");
        if !is_identifier(&id) || is_reserved(&id) || elements.contains_key(&id) {
            continue;
        }
        let arguments = arguments(context, element);
        let (body, troubles) = parse(&element.text.text);
        troubles.iter().for_each(|trouble| tell(context, &element.text, trouble));
        scope.functions.insert(id.clone(), Function { arguments, body });
        elements.insert(id, element);
    }
    for circle in circles(scope) {
        let element = elements[&circle[0]];
        let path: Vec<String> = circle.iter().chain([&circle[0]]).map(|id| format!("`{id}`")).collect();
        let message = format!("functions call each other in a circle: {}", path.join(" → "));
        context.fault(
            element.location("id"),
            &message,
            "in the circle",
            "a function may only call others that do not call it",
        );
        for id in &circle {
            // Calls of it are still known, but nothing is expanded.
            if let Some(function) = scope.functions.get_mut(id) {
                function.body = parse("0").0;
            }
        }
    }
    for (id, element) in elements {
        let function = scope.functions[&id].clone();
        if let Some(trouble) = misplaced(&function.body, scope) {
            tell(context, &element.text, &trouble);
            continue;
        }
        let arguments: BTreeMap<String, Expr> =
            function.arguments.iter().map(|name| (name.clone(), Expr::Number(1.0))).collect();
        for trouble in scope.resolve_with(&function.body, &arguments).err().unwrap_or_default() {
            tell(context, &element.text, &trouble);
        }
    }
}

/// Names of a function's arguments.
fn arguments(context: &mut Context, element: &Element) -> Vec<String> {
    let Some(text) = element.attribute("args") else { return Vec::new() };
    let mut names: Vec<String> = Vec::new();
    let mut start = 0;
    for part in text.text.split(',') {
        let name = part.trim();
        let at = text.location(&(start..start + part.len()));
        start += part.len() + 1;
        if !is_identifier(name) || is_reserved(name) || names.iter().any(|known| known == name) {
            let message = format!("\"{name}\" cannot be the name of an argument");
            context.fault(at, &message, "this argument", "write different names between commas, such as args=\"x, K\"");
        }
        names.push(name.to_owned());
    }
    names
}

/// Functions that call each other in a circle, each circle once.
fn circles(scope: &Scope) -> Vec<Vec<String>> {
    let names: Vec<&String> = scope.functions.keys().collect();
    let numbers: HashMap<&str, usize> =
        names.iter().enumerate().map(|(number, name)| (name.as_str(), number)).collect();
    let uses = |number: usize| -> Vec<usize> {
        let calls = scope.functions[names[number]].body.calls();
        calls.iter().filter_map(|(name, _)| numbers.get(name).copied()).collect()
    };
    let found = super::circles::circles(names.len(), &uses);
    found.into_iter().map(|circle| circle.into_iter().map(|number| names[number].clone()).collect()).collect()
}
