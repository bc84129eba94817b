//! MathML to expressions.

use super::notes::Notes;
use super::operators;
use super::xml::{self, MATHML, Node, Page};
use crate::equations::pieces::{extent, number, quantity};
use crate::equations::tree::{Expr, QuantityId};
use std::cell::RefCell;
use std::collections::HashMap;

/// Avogadro's number as SBML Level 3 fixes it, 1/mol.
const AVOGADRO: f64 = 6.022_141_79e23;
/// Deepest nesting of an expression, functions expanded.
const DEPTH_LIMIT: usize = 300;

/// A function definition.
pub struct Function<'a> {
    pub arguments: Vec<&'a str>,
    /// Its formula; a call of a function without one has no value.
    pub body: Option<Node<'a>>,
}

/// What names stand for besides the model's own symbols: local parameters, or the arguments of a function.
#[derive(Default)]
pub struct Scope<'a> {
    pub names: HashMap<&'a str, Expr>,
    /// The function whose formula is read: it sees nothing but its arguments.
    function: Option<&'a str>,
}

/// Reads formulas of one model.
pub struct Reader<'p, 'a> {
    pub page: &'p Page<'a>,
    /// Quantities that symbols stand for in formulas.
    pub symbols: HashMap<&'a str, QuantityId>,
    pub functions: HashMap<&'a str, Function<'a>>,
    /// Number of the first quantity that holds a rate of change.
    pub first_rate: QuantityId,
    /// Quantities whose rate of change is asked for, with the location of the first asking.
    rates: RefCell<Vec<(QuantityId, Node<'a>)>>,
    calls: RefCell<Vec<&'a str>>,
    notes: Notes<'p, 'a>,
}

impl<'p, 'a> Reader<'p, 'a> {
    pub fn new(page: &'p Page<'a>) -> Self {
        Self {
            page,
            symbols: HashMap::new(),
            functions: HashMap::new(),
            first_rate: 0,
            rates: RefCell::default(),
            calls: RefCell::default(),
            notes: Notes::new(page),
        }
    }

    /// Quantities whose rate of change the formulas use, in the order of their numbers from `first_rate` on.
    pub fn rates(&self) -> Vec<(QuantityId, Node<'a>)> {
        self.rates.borrow().clone()
    }

    /// The expression of a formula that uses the model's symbols; not a number when the formula has a fault.
    pub fn formula(&self, node: Node<'a>) -> Expr {
        self.local_formula(node, &Scope::default())
    }

    /// The expression of a formula that uses local names too.
    pub fn local_formula(&self, node: Node<'a>, scope: &Scope<'a>) -> Expr {
        self.expr(node, scope, 0).unwrap_or(Expr::Number(f64::NAN))
    }

    /// The expression of an element; none when a fault was noted.
    fn expr(&self, node: Node<'a>, scope: &Scope<'a>, level: usize) -> Option<Expr> {
        if level > DEPTH_LIMIT || !self.take(1) {
            return self.too_large(node);
        }
        if node.namespace() != Some(MATHML) {
            let found = format!("<{}> is not MathML", node.name());
            return self.fault(node, found, format!("formulas are in the namespace {MATHML}"));
        }
        match node.name() {
            "cn" => self.number(node),
            "ci" => self.symbol(node, scope, level),
            "csymbol" => self.constant_symbol(node),
            "apply" => self.apply(node, scope, level),
            "piecewise" => self.piecewise(node, scope, level),
            "semantics" => match node.elements().next() {
                Some(child) => self.expr(child, scope, level + 1),
                None => self.fault(node, "<semantics> has no formula", "put the formula first"),
            },
            "true" => Some(number(1.0)),
            "false" => Some(number(0.0)),
            "pi" => Some(number(std::f64::consts::PI)),
            "exponentiale" => Some(number(std::f64::consts::E)),
            "infinity" => Some(number(f64::INFINITY)),
            "notanumber" => Some(number(f64::NAN)),
            "lambda" => {
                self.fault(node, "a function is defined within a formula", "put it into a <functionDefinition>")
            }
            name => self.fault(node, format!("<{name}> is not a value"), "write a number, a symbol or an <apply>"),
        }
    }

    /// Notes a fault.
    fn fault<T>(&self, node: Node<'_>, found: impl Into<String>, help: impl Into<String>) -> Option<T> {
        self.notes.fault(node, found, help)
    }

    /// Notes that the formulas are too large.
    pub fn too_large<T>(&self, node: Node<'a>) -> Option<T> {
        self.notes.too_large(node)
    }

    /// Takes from the nodes that may be made.
    pub fn take(&self, count: usize) -> bool {
        self.notes.take(count)
    }

    fn number(&self, node: Node<'a>) -> Option<Expr> {
        let mut texts = vec![String::new()];
        for child in node.children() {
            match child.text() {
                Some(text) => texts.last_mut().expect("one text at least").push_str(text),
                None if child.name() == "sep" => texts.push(String::new()),
                None => {}
            }
        }
        let kind = node.attribute("type").map_or("real", str::trim);
        let value = match (kind, texts.as_slice()) {
            ("real" | "integer" | "double", [text]) => xml::number(text),
            ("rational", [above, below]) => xml::number(above).zip(xml::number(below)).map(|(a, b)| a / b),
            ("e-notation", [text, power]) => xml::number(&format!("{}e{}", text.trim(), power.trim())),
            _ => None,
        };
        let base = node.attribute("base").is_none_or(|base| base.trim() == "10");
        match value.filter(|_| base) {
            Some(value) if !value.is_finite() => {
                let help = "numbers end at about 1.8e308; infinity is <infinity/>";
                self.fault(node, "this number is not finite".to_owned(), help)
            }
            Some(value) => Some(number(value)),
            None => {
                let help = "real and integer numbers are one text, rational and e-notation two with <sep/> between";
                self.fault(node, format!("this is not a number of type `{kind}`"), help)
            }
        }
    }

    fn symbol(&self, node: Node<'a>, scope: &Scope<'a>, level: usize) -> Option<Expr> {
        let name = name(node);
        if let Some(value) = scope.names.get(name) {
            let (depth, size) = extent(value);
            if level + depth > DEPTH_LIMIT || !self.take(size) {
                return self.too_large(node);
            }
            return Some(value.clone());
        }
        if let Some(function) = scope.function {
            let help = "a function sees only its arguments: hand the value over as one";
            return self.fault(node, format!("`{name}` is not an argument of function `{function}`"), help);
        }
        if let Some(&id) = self.symbols.get(name) {
            return Some(quantity(id));
        }
        if self.functions.contains_key(name) {
            return self.fault(node, format!("`{name}` is a function, not a value"), "call it within an <apply>");
        }
        let known = self.symbols.keys().chain(scope.names.keys());
        let near = known.map(|id| (strsim::damerau_levenshtein(id, name), id)).min().filter(|(far, _)| *far <= 2);
        let help = near.map_or("declare it as a compartment, species or parameter".to_owned(), |(_, id)| {
            format!("did you mean `{id}`?")
        });
        self.fault(node, format!("`{name}` is not known"), help)
    }

    fn constant_symbol(&self, node: Node<'a>) -> Option<Expr> {
        match definition(node) {
            "time" => Some(Expr::Time),
            "avogadro" => Some(number(AVOGADRO)),
            name @ ("delay" | "rateOf") => {
                self.fault(node, format!("{name} is a function, not a value"), "call it within an <apply>")
            }
            _ => self.unknown_symbol(node),
        }
    }

    fn unknown_symbol<T>(&self, node: Node<'a>) -> Option<T> {
        let url = node.attribute("definitionURL").unwrap_or_default();
        let help = "time, avogadro, delay and rateOf are known, as http://www.sbml.org/sbml/symbols/time and so on";
        self.fault(node, format!("the csymbol `{url}` is not known"), help)
    }

    fn apply(&self, node: Node<'a>, scope: &Scope<'a>, level: usize) -> Option<Expr> {
        let mut parts = node.elements();
        let Some(head) = parts.next() else {
            return self.fault(node, "an <apply> is empty", "put an operator and its operands into it");
        };
        let parts: Vec<Node<'a>> = parts.collect();
        match head.name() {
            "ci" => self.call(head, &parts, scope, level),
            "csymbol" => self.call_symbol(head, &parts, scope, level),
            _ => {
                let is_qualifier = |part: &Node<'a>| matches!(part.name(), "logbase" | "degree");
                let (qualifiers, operands): (Vec<Node<'a>>, Vec<Node<'a>>) = parts.into_iter().partition(is_qualifier);
                let qualifier = match qualifiers.first() {
                    Some(found) => match found.elements().next() {
                        Some(value) => Some(self.expr(value, scope, level + 1)?),
                        None => {
                            return self.fault(*found, "there is no value in it", "put a number or a formula into it");
                        }
                    },
                    None => None,
                };
                let operands = self.exprs(&operands, scope, level)?;
                operators::apply(&self.notes, head, operands, qualifier)
            }
        }
    }

    /// The expressions of several elements; all their faults are noted.
    fn exprs(&self, nodes: &[Node<'a>], scope: &Scope<'a>, level: usize) -> Option<Vec<Expr>> {
        let made: Vec<Option<Expr>> = nodes.iter().map(|node| self.expr(*node, scope, level + 1)).collect();
        made.into_iter().collect()
    }

    /// A call of a function of the model: its formula with the operands in place of the arguments.
    fn call(&self, head: Node<'a>, operands: &[Node<'a>], scope: &Scope<'a>, level: usize) -> Option<Expr> {
        let name = name(head);
        let Some((&name, function)) = self.functions.get_key_value(name) else {
            return self.fault(head, format!("there is no function `{name}`"), "add a <functionDefinition> for it");
        };
        if operands.len() != function.arguments.len() {
            let found = format!("function `{name}` is given {} values", operands.len());
            return self.fault(head, found, format!("it takes {}", function.arguments.len()));
        }
        let operands = self.exprs(operands, scope, level)?;
        let Some(body) = function.body else {
            self.page.notice(format!("function `{name}` has no formula: its value is not a number"));
            return Some(number(f64::NAN));
        };
        if self.calls.borrow().contains(&name) {
            return self.fault(head, format!("function `{name}` calls itself"), "functions cannot be recursive");
        }
        let inner = Scope { names: function.arguments.iter().copied().zip(operands).collect(), function: Some(name) };
        self.calls.borrow_mut().push(name);
        let made = self.expr(body, &inner, level + 1);
        self.calls.borrow_mut().pop();
        made
    }

    fn call_symbol(&self, head: Node<'a>, operands: &[Node<'a>], scope: &Scope<'a>, level: usize) -> Option<Expr> {
        match definition(head) {
            "rateOf" => {
                let [operand] = operands else {
                    return self.fault(
                        head,
                        format!("rateOf is given {} values", operands.len()),
                        "it takes one symbol",
                    );
                };
                match self.expr(*operand, scope, level + 1)? {
                    Expr::Quantity(id) => Some(quantity(self.rate_of(id, head))),
                    _ => self.fault(*operand, "this has no name to take the rate of", "rateOf takes one symbol"),
                }
            }
            "delay" => {
                let [value, delay] = operands else {
                    let found = format!("delay is given {} values", operands.len());
                    return self.fault(head, found, "it takes two: what is looked back at, and how far");
                };
                let (value, delay) = (self.expr(*value, scope, level + 1)?, self.expr(*delay, scope, level + 1)?);
                Some(Expr::Delay(Box::new(value), Box::new(delay)))
            }
            "time" | "avogadro" => {
                self.fault(head, "this is a value, not a function", "use it outside of an operator's place")
            }
            _ => self.unknown_symbol(head),
        }
    }

    /// The quantity that holds the rate of change of a quantity.
    fn rate_of(&self, id: QuantityId, node: Node<'a>) -> QuantityId {
        let mut rates = self.rates.borrow_mut();
        let position = rates.iter().position(|(other, _)| *other == id).unwrap_or_else(|| {
            rates.push((id, node));
            rates.len() - 1
        });
        self.first_rate + position as QuantityId
    }

    fn piecewise(&self, node: Node<'a>, scope: &Scope<'a>, level: usize) -> Option<Expr> {
        let mut branches = Vec::new();
        let mut otherwise = number(f64::NAN);
        for child in node.elements() {
            let parts: Vec<Node<'a>> = child.elements().collect();
            match (child.name(), parts.as_slice()) {
                ("piece", [value, condition]) => {
                    let value = self.expr(*value, scope, level + 2)?;
                    branches.push((self.expr(*condition, scope, level + 2)?, value));
                }
                ("otherwise", [value]) => otherwise = self.expr(*value, scope, level + 2)?,
                _ => {
                    let help = "<piece> holds a value and its condition, <otherwise> one value";
                    return self.fault(child, "this is not a piece of a <piecewise>", help);
                }
            }
        }
        if branches.is_empty() {
            Some(otherwise)
        } else {
            Some(Expr::Piecewise { branches, otherwise: Box::new(otherwise) })
        }
    }
}

/// The name in a `<ci>`, around which there may be comments.
pub fn name(node: Node<'_>) -> &str {
    let texts = node.children().filter_map(Node::text);
    texts.map(str::trim).find(|text| !text.is_empty()).unwrap_or_default()
}

/// The last part of a csymbol's definition.
fn definition<'a>(node: Node<'a>) -> &'a str {
    let url = node.attribute("definitionURL").unwrap_or_default().trim();
    url.strip_prefix("http://www.sbml.org/sbml/symbols/").unwrap_or("")
}
