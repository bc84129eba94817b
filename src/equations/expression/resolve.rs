//! Looks the names of an expression up and expands the document's functions.

use super::Trouble;
use super::functions::{CONSTANTS, FUNCTIONS, Known, Meaning, TIME, known};
use super::syntax::{DEEPEST, Node, NodeKind};
use crate::equations::tree::{Expr, QuantityId, Unary};
use crate::error::words::meant;
use std::cell::Cell;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

/// The most parts an expression may have once its functions are expanded.
pub const LARGEST: usize = 200_000;

/// The most levels an expression may have once its functions are expanded: everything that walks it is recursive.
const TALLEST: usize = 1000;

/// A function that a document defines.
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    /// Names of its arguments.
    pub arguments: Vec<String>,
    /// Its value.
    pub body: Node,
}

/// The names that an expression may use.
#[derive(Debug, Clone, Default)]
pub struct Scope {
    /// Numbers of the quantities.
    pub quantities: HashMap<String, QuantityId>,
    /// The document's functions; none may use itself, directly or through others.
    pub functions: BTreeMap<String, Function>,
    /// Names that exist but not here, and why.
    pub absent: HashMap<String, String>,
    /// What `time` is told to be where it has no meaning; empty where it has.
    pub no_time: String,
    /// Why nothing can look back by `delay` here; empty where it can.
    pub no_delay: String,
    /// Parts made so far by all expressions of the scope, and words looked for.
    pub spent: Spent,
}

/// What the expressions of a scope have cost so far: a small document must not ask for much.
#[derive(Debug, Clone, Default)]
pub struct Spent {
    parts: Cell<usize>,
    words: Cell<usize>,
}

/// The most parts that all expressions of a scope may have together.
const MOST_PARTS: usize = 2_000_000;
/// The most misspelt words that are looked for in a scope, and the most names among which they are.
const MOST_WORDS: (usize, usize) = (100, 5000);

impl Scope {
    /// The expression with its names looked up and functions expanded.
    ///
    /// # Errors
    /// Every unknown name, every wrong count of arguments; an empty list when the parser has told all troubles.
    pub fn resolve(&self, node: &Node) -> Result<Expr, Vec<Trouble>> {
        self.resolve_with(node, &BTreeMap::new())
    }

    /// As [`Scope::resolve`]; `arguments` are names that stand for other expressions.
    ///
    /// # Errors
    /// As [`Scope::resolve`].
    pub fn resolve_with(&self, node: &Node, arguments: &BTreeMap<String, Expr>) -> Result<Expr, Vec<Trouble>> {
        if self.spent.parts.get() > MOST_PARTS {
            return Err(vec![
                Trouble::new("the document grows too large when its functions are expanded", node.at.clone())
                    .label(format!("more than {MOST_PARTS} parts"))
                    .help("let functions call fewer others; name parts with <define>"),
            ]);
        }
        let mut walk = Walk { scope: self, troubles: Vec::new(), parts: 0, level: 0 };
        let found = walk.expr(node, arguments);
        self.spent.parts.set(self.spent.parts.get() + walk.parts);
        if walk.parts > LARGEST || walk.level > DEEPEST {
            walk.troubles = vec![
                Trouble::new("the expression grows too large when its functions are expanded", node.at.clone())
                    .label(format!("more than {LARGEST} parts or {TALLEST} levels"))
                    .help("let functions call fewer others; name parts with <define>"),
            ];
            return Err(walk.troubles);
        }
        match found {
            Some(expr) if walk.troubles.is_empty() => Ok(expr),
            _ => Err(walk.troubles),
        }
    }

    /// The word that was meant, while not too many have been looked for.
    fn meant<'a>(&self, word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
        self.spent.words.set(self.spent.words.get() + 1);
        if self.spent.words.get() > MOST_WORDS.0 { None } else { meant(word, known.take(MOST_WORDS.1)) }
    }

    /// The names that may be written, for advice.
    fn names<'a>(&'a self, arguments: &'a BTreeMap<String, Expr>) -> impl Iterator<Item = &'a str> {
        let own = arguments.keys().map(String::as_str);
        let constants = CONSTANTS.iter().map(|(name, _)| *name).chain([TIME]);
        // They are put in order only while they will be looked at.
        let wanted = self.spent.words.get() < MOST_WORDS.0;
        let mut quantities: Vec<&str> =
            if wanted { self.quantities.keys().map(String::as_str).collect() } else { Vec::new() };
        quantities.sort_unstable();
        own.chain(quantities).chain(constants)
    }
}

struct Walk<'a> {
    scope: &'a Scope,
    troubles: Vec<Trouble>,
    /// Parts made so far.
    parts: usize,
    level: usize,
}

impl Walk<'_> {
    /// The expression, or nothing after a fault.
    fn expr(&mut self, node: &Node, arguments: &BTreeMap<String, Expr>) -> Option<Expr> {
        self.parts += 1;
        if self.parts > LARGEST || self.level > DEEPEST {
            return None;
        }
        self.level += 1;
        let found = match &node.kind {
            NodeKind::Unread => None,
            NodeKind::Number(value, _) => Some(Expr::Number(*value)),
            NodeKind::Name(name) => self.name(name, &node.at, arguments),
            NodeKind::Minus(a) => self.expr(a, arguments).map(|a| a.unary(Unary::Neg)),
            NodeKind::Not(a) => self.expr(a, arguments).map(|a| a.unary(Unary::Not)),
            NodeKind::Binary(operator, a, b) => {
                let (a, b) = (self.expr(a, arguments), self.expr(b, arguments));
                Some(a?.binary(*operator, b?))
            }
            NodeKind::Call(name, at, given) => self.call(name, at, given, arguments),
        };
        if self.parts <= LARGEST && self.level <= DEEPEST {
            self.level -= 1;
        }
        found
    }

    fn name(&mut self, name: &str, at: &Range<usize>, arguments: &BTreeMap<String, Expr>) -> Option<Expr> {
        if let Some(expr) = arguments.get(name) {
            self.parts += size(expr);
            return Some(expr.clone());
        }
        if let Some(number) = self.scope.quantities.get(name) {
            return Some(Expr::Quantity(*number));
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return Some(Expr::Number(*value));
        }
        if name == TIME && self.scope.no_time.is_empty() {
            return Some(Expr::Time);
        }
        self.troubles.push(self.unknown_name(name, at.clone(), arguments));
        None
    }

    fn unknown_name(&self, name: &str, at: Range<usize>, arguments: &BTreeMap<String, Expr>) -> Trouble {
        if name == TIME {
            return Trouble::new("`time` cannot be used here", at).label("time").help(self.scope.no_time.clone());
        }
        if let Some(why) = self.scope.absent.get(name) {
            return Trouble::new(format!("`{name}` cannot be used here"), at).label("not here").help(why.clone());
        }
        let trouble = Trouble::new(format!("nothing has the identifier `{name}`"), at).label("unknown identifier");
        if let Some(function) = known(name) {
            return trouble.help(format!("`{name}` is a function; write `{}`", function.example));
        }
        if self.scope.functions.contains_key(name) {
            return trouble.help(format!("`{name}` is a function of this document; write its arguments: `{name}(…)`"));
        }
        let advice = match self.scope.meant(name, self.scope.names(arguments)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "declare it with <parameter>, <variable>, <define> or <input>".to_owned(),
        };
        trouble.help(advice)
    }

    fn call(
        &mut self,
        name: &str,
        at: &Range<usize>,
        given: &[Node],
        arguments: &BTreeMap<String, Expr>,
    ) -> Option<Expr> {
        let resolved: Vec<Option<Expr>> = given.iter().map(|node| self.expr(node, arguments)).collect();
        let resolved: Option<Vec<Expr>> = resolved.into_iter().collect();
        if let Some(function) = self.scope.functions.get(name) {
            if function.arguments.len() != given.len() {
                let written = format!("{name}({})", function.arguments.join(", "));
                self.miscounted(name, at, &written, given.len());
                return None;
            }
            let inner = function.arguments.iter().cloned().zip(resolved?).collect();
            // Troubles of the body are told where the function is defined.
            let told = self.troubles.len();
            let value = self.expr(&function.body, &inner);
            self.troubles.truncate(told);
            if value.as_ref().is_some_and(|value| depth(value) > TALLEST) {
                self.parts = LARGEST + 1;
            }
            return value;
        }
        let Some(function) = known(name) else {
            self.troubles.push(self.unknown_function(name, at.clone()));
            return None;
        };
        if !function.meaning.takes(given.len()) {
            self.miscounted(name, at, function.example, given.len());
            return None;
        }
        if function.meaning == Meaning::Pulse && !self.scope.no_time.is_empty() {
            let trouble = Trouble::new(format!("`{name}` cannot be used here"), at.clone()).label("uses the time");
            self.troubles.push(trouble.help(self.scope.no_time.clone()));
            return None;
        }
        if function.meaning == Meaning::Delay && !self.scope.no_delay.is_empty() {
            let trouble = Trouble::new(format!("`{name}` cannot be used here"), at.clone()).label("looks back");
            self.troubles.push(trouble.help(self.scope.no_delay.clone()));
            return None;
        }
        Some(function.meaning.apply(resolved?))
    }

    fn miscounted(&mut self, name: &str, at: &Range<usize>, example: &str, count: usize) {
        let found = match count {
            0 => "no argument".to_owned(),
            1 => "1 argument".to_owned(),
            _ => format!("{count} arguments"),
        };
        let trouble = Trouble::new(format!("`{name}` cannot take {found}"), at.clone()).label(found);
        self.troubles.push(trouble.help(format!("write `{example}`")));
    }

    fn unknown_function(&self, name: &str, at: Range<usize>) -> Trouble {
        if self.scope.quantities.contains_key(name) {
            return Trouble::new(format!("`{name}` is not a function"), at)
                .label("a quantity")
                .help(format!("write a product with `*`: `{name}*(…)`"));
        }
        let own = self.scope.functions.keys().map(String::as_str);
        let near = self.scope.meant(name, own.chain(FUNCTIONS.iter().map(|Known { name, .. }| *name)));
        let advice = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => "define it with <function id=… args=…>".to_owned(),
        };
        Trouble::new(format!("there is no function `{name}`"), at).label("unknown function").help(advice)
    }
}

/// Parts of an expression.
fn size(expr: &Expr) -> usize {
    match expr {
        Expr::Number(_) | Expr::Time | Expr::Quantity(_) => 1,
        Expr::Unary(_, a) => 1 + size(a),
        Expr::Binary(_, a, b) | Expr::Delay(a, b) => 1 + size(a) + size(b),
        Expr::Root(equations, _) => 1 + equations.expressions().map(size).sum::<usize>(),
        Expr::Piecewise { branches, otherwise } => {
            1 + size(otherwise) + branches.iter().map(|(a, b)| size(a) + size(b)).sum::<usize>()
        }
    }
}

/// Levels of an expression.
fn depth(expr: &Expr) -> usize {
    1 + match expr {
        Expr::Number(_) | Expr::Time | Expr::Quantity(_) => 0,
        Expr::Unary(_, a) => depth(a),
        Expr::Binary(_, a, b) | Expr::Delay(a, b) => depth(a).max(depth(b)),
        Expr::Root(equations, _) => equations.expressions().map(depth).max().unwrap_or(0),
        Expr::Piecewise { branches, otherwise } => {
            branches.iter().map(|(a, b)| depth(a).max(depth(b))).max().unwrap_or(0).max(depth(otherwise))
        }
    }
}
