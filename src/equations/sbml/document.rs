//! What an SBML text says, element by element, before anything is made of it.

use super::xml::{Node, Page};

/// A compartment as written.
pub struct Compartment<'a> {
    pub node: Node<'a>,
    pub id: &'a str,
    pub size: Option<f64>,
    pub dimensions: f64,
    pub constant: bool,
}

/// A species as written.
pub struct Species<'a> {
    pub node: Node<'a>,
    pub id: &'a str,
    pub compartment: &'a str,
    pub amount: Option<f64>,
    pub concentration: Option<f64>,
    /// Its symbol stands for the amount even outside of reactions.
    pub only_amount: bool,
    pub boundary: bool,
    pub constant: bool,
    pub factor: Option<&'a str>,
}

/// A global or a local parameter as written.
pub struct Parameter<'a> {
    pub node: Node<'a>,
    pub id: &'a str,
    pub value: Option<f64>,
    pub constant: bool,
}

/// A species that a reaction uses up or makes, as written.
pub struct Participant<'a> {
    pub node: Node<'a>,
    pub id: Option<&'a str>,
    pub species: &'a str,
    /// -1 for a reactant, 1 for a product.
    pub sign: f64,
    pub stoichiometry: Option<f64>,
    /// The formula of Level 2.
    pub math: Option<Node<'a>>,
    pub constant: bool,
}

/// A kinetic law as written.
pub struct Law<'a> {
    pub math: Option<Node<'a>>,
    pub locals: Vec<Parameter<'a>>,
}

/// A reaction as written.
pub struct Reaction<'a> {
    pub node: Node<'a>,
    pub id: &'a str,
    /// Its equilibrium holds at all times.
    pub fast: bool,
    /// Whether it is meant to go both ways.
    pub reversible: bool,
    pub participants: Vec<Participant<'a>>,
    pub law: Option<Law<'a>>,
}

/// What a rule says of its variable.
#[derive(Clone, Copy, PartialEq)]
pub enum RuleKind {
    /// Equal to the formula.
    Assignment,
    /// Changing at the formula's rate.
    Rate,
}

/// A rule, an initial assignment or an event assignment as written.
#[derive(Clone, Copy)]
pub struct Assignment<'a> {
    pub node: Node<'a>,
    pub symbol: &'a str,
    pub math: Option<Node<'a>>,
}

/// An algebraic rule as written: 0 = formula.
#[derive(Clone, Copy)]
pub struct Equation<'a> {
    pub node: Node<'a>,
    pub math: Option<Node<'a>>,
}

/// A function definition as written.
pub struct Function<'a> {
    pub node: Node<'a>,
    pub id: &'a str,
    pub lambda: Option<Node<'a>>,
}

/// An event as written.
pub struct Event<'a> {
    pub node: Node<'a>,
    pub id: Option<&'a str>,
    pub trigger: Option<Node<'a>>,
    pub initially_true: bool,
    pub persistent: bool,
    pub delay: Option<Node<'a>>,
    pub priority: Option<Node<'a>>,
    pub values_from_trigger: bool,
    pub assignments: Vec<Assignment<'a>>,
}

/// A model as written.
#[derive(Default)]
pub struct Document<'a> {
    pub name: &'a str,
    pub factor: Option<&'a str>,
    pub functions: Vec<Function<'a>>,
    pub compartments: Vec<Compartment<'a>>,
    pub species: Vec<Species<'a>>,
    pub parameters: Vec<Parameter<'a>>,
    pub initial: Vec<Assignment<'a>>,
    pub rules: Vec<(RuleKind, Assignment<'a>)>,
    pub algebraic: Vec<Equation<'a>>,
    pub reactions: Vec<Reaction<'a>>,
    pub events: Vec<Event<'a>>,
}

/// Reads all elements of a model; what cannot be had is noted as a fault.
pub fn read<'a>(page: &Page<'a>, xml: &'a crate::xml::Document<'a>) -> Document<'a> {
    let root = xml.root();
    packages(page, root, xml.namespaces());
    units(page, root);
    let Some(model) = page.child(root, "model") else {
        page.fault(root, "there is no model in the document", "put one `<model>` into `<sbml>`");
        return Document::default();
    };
    let mut document = Document {
        name: model.attribute("id").or(model.attribute("name")).unwrap_or_default(),
        factor: model.attribute("conversionFactor").map(str::trim),
        ..Document::default()
    };
    for list in page.children(model) {
        match list.name() {
            "listOfFunctionDefinitions" => {
                document.functions = items(page, list, "functionDefinition", function);
            }
            "listOfCompartments" => document.compartments = items(page, list, "compartment", compartment),
            "listOfSpecies" => document.species = items(page, list, "species", species),
            "listOfParameters" => document.parameters = items(page, list, "parameter", parameter),
            "listOfInitialAssignments" => {
                document.initial =
                    items(page, list, "initialAssignment", |page, node| assignment(page, node, "symbol"));
            }
            "listOfRules" => page.children(list).for_each(|node| rule(page, node, &mut document)),
            "listOfReactions" => document.reactions = items(page, list, "reaction", reaction),
            "listOfEvents" => document.events = items(page, list, "event", event),
            "listOfConstraints" => {
                if page.children(list).any(|child| child.name() == "constraint") {
                    page.notice("constraints are not watched: they change no solution");
                }
            }
            "notes" | "annotation" | "listOfUnitDefinitions" | "listOfCompartmentTypes" | "listOfSpeciesTypes" => {}
            _ => unknown(page, list),
        }
    }
    document
}

/// The elements of a list; anything else in it is a fault.
fn items<'a, T>(page: &Page<'a>, list: Node<'a>, name: &str, read: impl Fn(&Page<'a>, Node<'a>) -> T) -> Vec<T> {
    let mut found = Vec::new();
    for child in page.children(list) {
        match child.name() {
            "notes" | "annotation" => {}
            given if given == name => found.push(read(page, child)),
            _ => unknown(page, child),
        }
    }
    found
}

fn unknown(page: &Page<'_>, node: Node<'_>) {
    let parent = node.parent().map_or("sbml", |parent| parent.name());
    let found = format!("<{}> is not known in <{parent}>", node.name());
    page.fault(node, found, "delete it, or correct its name; only the core of SBML is read");
}

/// The name of the package that a namespace is of, if it is one of a package.
fn package(space: &str) -> Option<&str> {
    let rest = ["/sbml/level3/version1/", "/sbml/level3/version2/"].iter().find_map(|mark| space.split(mark).nth(1))?;
    let name = rest.split('/').next().unwrap_or(rest);
    (name != "core").then_some(name)
}

/// Packages that the model needs are refused, others told of. One that does not say whether it is needed must say so.
fn packages<'a>(page: &Page<'a>, root: Node<'a>, namespaces: impl Iterator<Item = &'a str>) {
    let mut spaces: Vec<&str> = namespaces.filter(|space| package(space).is_some()).collect();
    // Told by its attribute though the namespace has another form.
    let with_prefix = root.attributes().iter().filter(|a| a.name == "required").filter_map(|a| a.namespace);
    spaces.extend(with_prefix.map(|namespace| root.name_of(namespace)));
    spaces.sort_unstable();
    spaces.dedup();
    for space in spaces {
        let name = package(space).unwrap_or(space);
        match root.attribute_of(space, "required").map(str::trim) {
            Some("false" | "0") => page.notice(format!(
                "the package `{name}` is not read; the model says that it does not change the equations"
            )),
            Some("true" | "1") => {
                let found = format!("the model needs the package `{name}`, which is not read");
                page.fault(root, found, "flatten or convert the model to core SBML with the tool that wrote it");
            }
            Some(other) => {
                let found = format!("whether the package `{name}` is required is neither true nor false but `{other}`");
                page.fault(root, found, "write required=\"false\" for it if it does not change the equations");
            }
            None => {
                let found = format!("the package `{name}` is not read, and <sbml> does not say whether it is required");
                let help = "remove the package, or write required=\"false\" for it if it does not change the equations";
                page.fault(root, found, help);
            }
        }
    }
}

/// Units anywhere in the model are told of once.
fn units<'a>(page: &Page<'a>, root: Node<'a>) {
    let has_units = |node: Node<'_>| {
        node.name() == "unitDefinition"
            || node
                .attributes()
                .iter()
                .any(|a| a.name.to_lowercase().ends_with("units") && a.name != "hasOnlySubstanceUnits")
    };
    if root.descendants().any(|node| node.is_element() && has_units(node)) {
        page.notice("units are neither checked nor converted: all numbers are taken as they stand");
    }
}

/// An identifier, which must be there and be well formed.
fn id<'a>(page: &Page<'a>, node: Node<'a>) -> &'a str {
    let id = page.required(node, "id");
    let good = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if !id.is_empty() && (!id.chars().all(good) || id.starts_with(|c: char| c.is_ascii_digit())) {
        let help = "use letters, digits and `_`, and no digit in front";
        page.fault_in(node, "id", format!("`{id}` is not an identifier"), help);
    }
    id
}

fn compartment<'a>(page: &Page<'a>, node: Node<'a>) -> Compartment<'a> {
    Compartment {
        node,
        id: id(page, node),
        size: page.number(node, "size"),
        dimensions: page.number(node, "spatialDimensions").unwrap_or(3.0),
        constant: page.flag(node, "constant", true),
    }
}

fn species<'a>(page: &Page<'a>, node: Node<'a>) -> Species<'a> {
    let read = Species {
        node,
        id: id(page, node),
        compartment: page.required(node, "compartment"),
        amount: page.number(node, "initialAmount"),
        concentration: page.number(node, "initialConcentration"),
        only_amount: page.flag(node, "hasOnlySubstanceUnits", false),
        boundary: page.flag(node, "boundaryCondition", false),
        constant: page.flag(node, "constant", false),
        factor: node.attribute("conversionFactor").map(str::trim),
    };
    if read.amount.is_some() && read.concentration.is_some() {
        let found = format!("species `{}` has both an initial amount and an initial concentration", read.id);
        page.fault_in(node, "initialAmount", found, "delete one of the two");
    }
    read
}

fn parameter<'a>(page: &Page<'a>, node: Node<'a>) -> Parameter<'a> {
    let constant = page.flag(node, "constant", true);
    Parameter { node, id: id(page, node), value: page.number(node, "value"), constant }
}

fn assignment<'a>(page: &Page<'a>, node: Node<'a>, attribute: &str) -> Assignment<'a> {
    Assignment { node, symbol: page.required(node, attribute), math: page.math(node) }
}

fn function<'a>(page: &Page<'a>, node: Node<'a>) -> Function<'a> {
    Function { node, id: id(page, node), lambda: page.math(node) }
}

fn rule<'a>(page: &Page<'a>, node: Node<'a>, document: &mut Document<'a>) {
    let kind = match node.name() {
        "assignmentRule" => RuleKind::Assignment,
        "rateRule" => RuleKind::Rate,
        "algebraicRule" => return document.algebraic.push(Equation { node, math: page.math(node) }),
        "notes" | "annotation" => return,
        _ => return unknown(page, node),
    };
    document.rules.push((kind, assignment(page, node, "variable")));
}

fn reaction<'a>(page: &Page<'a>, node: Node<'a>) -> Reaction<'a> {
    let (id, fast) = (id(page, node), page.flag(node, "fast", false));
    let reversible = page.flag(node, "reversible", true);
    let mut read = Reaction { node, id, fast, reversible, participants: Vec::new(), law: None };
    for child in page.children(node) {
        match child.name() {
            "listOfReactants" => {
                read.participants.extend(items(page, child, "speciesReference", |p, n| participant(p, n, -1.0)))
            }
            "listOfProducts" => {
                read.participants.extend(items(page, child, "speciesReference", |p, n| participant(p, n, 1.0)))
            }
            "kineticLaw" => read.law = Some(law(page, child)),
            "listOfModifiers" | "notes" | "annotation" => {}
            _ => unknown(page, child),
        }
    }
    read
}

fn participant<'a>(page: &Page<'a>, node: Node<'a>, sign: f64) -> Participant<'a> {
    let stoichiometry = page.number(node, "stoichiometry");
    let denominator = page.number(node, "denominator").unwrap_or(1.0);
    if page.level == 3 && stoichiometry.is_none() && node.attribute("id").is_none() {
        page.notice("species references without a stoichiometry count as 1");
    }
    Participant {
        node,
        id: node.attribute("id").map(|_| id(page, node)),
        species: page.required(node, "species"),
        sign,
        stoichiometry: stoichiometry.map(|number| number / denominator),
        math: page.child(node, "stoichiometryMath").and_then(|child| page.math(child)),
        constant: page.level == 3 && page.flag(node, "constant", false),
    }
}

fn law<'a>(page: &Page<'a>, node: Node<'a>) -> Law<'a> {
    let mut locals = Vec::new();
    for child in page.children(node) {
        match child.name() {
            "listOfParameters" => locals.extend(items(page, child, "parameter", parameter)),
            "listOfLocalParameters" => locals.extend(items(page, child, "localParameter", parameter)),
            "notes" | "annotation" => {}
            _ => unknown(page, child),
        }
    }
    Law { math: page.math(node), locals }
}

fn event<'a>(page: &Page<'a>, node: Node<'a>) -> Event<'a> {
    let mut read = Event {
        node,
        id: node.attribute("id").map(|_| id(page, node)),
        trigger: None,
        initially_true: true,
        persistent: true,
        delay: None,
        priority: None,
        values_from_trigger: page.flag(node, "useValuesFromTriggerTime", true),
        assignments: Vec::new(),
    };
    for child in page.children(node) {
        match child.name() {
            "trigger" => {
                read.trigger = page.math(child);
                read.initially_true = page.flag(child, "initialValue", true);
                read.persistent = page.flag(child, "persistent", true);
            }
            "delay" => read.delay = page.math(child),
            "priority" => read.priority = page.math(child),
            "listOfEventAssignments" => {
                read.assignments =
                    items(page, child, "eventAssignment", |page, node| assignment(page, node, "variable"));
            }
            "notes" | "annotation" => {}
            _ => unknown(page, child),
        }
    }
    read
}
