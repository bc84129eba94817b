//! The names of a model: which quantity each stands for, and what is said about each.

use super::document::{Document, RuleKind};
use super::math::{Function, Reader};
use super::xml::{Node, Page};
use crate::equations::tree::{Expr, Quantity, QuantityId, Role};
use std::collections::{HashMap, HashSet};

/// What a symbol is.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Compartment(usize),
    Species(usize),
    Parameter(usize),
    Reaction(usize),
    /// A species reference: reaction, participant.
    Reference(usize, usize),
    Function,
    Event,
}

/// How the size of a compartment changes.
#[derive(Clone, Copy, PartialEq)]
pub enum Change {
    Never,
    /// By events only.
    Jumps,
    /// By a rate rule, and perhaps by events.
    Flows,
    /// By an assignment rule.
    Defined,
}

/// A fast reaction whose equilibrium holds.
#[derive(Clone, Copy)]
pub struct Equilibrium {
    /// The index of the reaction.
    pub reaction: usize,
    /// The indices of the species that is used up and of the one that is made.
    pub species: [usize; 2],
    /// The total of the two, which the reaction keeps; none where one of them is at the boundary.
    pub total: Option<QuantityId>,
}

/// A model between the document and the system.
pub struct Plan<'p, 'a> {
    pub page: &'p Page<'a>,
    pub document: &'p Document<'a>,
    pub reader: Reader<'p, 'a>,
    pub quantities: Vec<Quantity>,
    /// The element that declares each quantity.
    pub nodes: Vec<Node<'a>>,
    pub kinds: HashMap<&'a str, Kind>,
    /// Rules that have a formula, by the symbol they are for.
    pub rules: HashMap<&'a str, (RuleKind, Node<'a>)>,
    /// What algebraic rules say of the symbols that they determine.
    pub solved: HashMap<&'a str, Expr>,
    /// Initial assignments that have a formula.
    pub initial: HashMap<&'a str, Node<'a>>,
    /// What events set.
    pub set_by_events: HashSet<&'a str>,
    /// The amount of each species; its concentration is the quantity after it.
    pub amounts: Vec<QuantityId>,
    /// Local parameters by the indices of their elements.
    pub locals: HashMap<usize, QuantityId>,
    /// Quantities without a value of their own.
    pub unset: Vec<QuantityId>,
    /// Fast reactions that are solved for.
    pub equilibria: Vec<Equilibrium>,
    /// What quantities were before the start, where it does not follow from the start.
    pub history: Vec<(QuantityId, Expr)>,
}

impl<'p, 'a> Plan<'p, 'a> {
    /// Gives every symbol its quantity and notes what is said about it.
    pub fn new(page: &'p Page<'a>, document: &'p Document<'a>) -> Self {
        let mut plan = Self {
            page,
            document,
            reader: Reader::new(page),
            quantities: Vec::new(),
            nodes: Vec::new(),
            kinds: HashMap::new(),
            rules: HashMap::new(),
            solved: HashMap::new(),
            initial: HashMap::new(),
            set_by_events: HashSet::new(),
            amounts: Vec::new(),
            locals: HashMap::new(),
            unset: Vec::new(),
            equilibria: Vec::new(),
            history: Vec::new(),
        };
        plan.declare();
        plan.statements();
        // Rates of change, which need not be known yet, have numbers beyond all others for now.
        plan.reader.first_rate = QuantityId::MAX / 2;
        let determined = plan.algebraic_rules();
        plan.declare_helpers();
        plan.declare_equilibria();
        plan.reader.first_rate = plan.quantities.len() as QuantityId;
        plan.solve(&determined);
        plan
    }

    /// A new quantity that is a parameter without a value for now.
    pub fn quantity(&mut self, id: String, node: Node<'a>) -> QuantityId {
        let name = node.attribute("name").unwrap_or_default().to_owned();
        let (role, initial) = (Role::Parameter, Expr::Number(f64::NAN));
        self.quantities.push(Quantity { id, name, role, initial, unit: String::new() });
        self.nodes.push(node);
        self.quantities.len() as QuantityId - 1
    }

    /// Whether a symbol is new; it is noted as taken.
    fn take(&mut self, id: &'a str, node: Node<'a>, kind: Kind) -> bool {
        if id.is_empty() {
            return false;
        }
        let fresh = self.kinds.insert(id, kind).is_none();
        if !fresh {
            let help = "identifiers are unique in the whole model: rename one of the two";
            self.page.fault_in(node, "id", format!("`{id}` is declared twice"), help);
        }
        fresh
    }

    fn symbol(&mut self, id: &'a str, node: Node<'a>, kind: Kind) {
        if self.take(id, node, kind) {
            let quantity = self.quantity(id.to_owned(), node);
            self.reader.symbols.insert(id, quantity);
        }
    }

    fn declare(&mut self) {
        let document = self.document;
        for function in &document.functions {
            if self.take(function.id, function.node, Kind::Function) {
                let read = self.function(function.lambda);
                self.reader.functions.insert(function.id, read);
            }
        }
        for (number, compartment) in document.compartments.iter().enumerate() {
            self.symbol(compartment.id, compartment.node, Kind::Compartment(number));
        }
        for (number, species) in document.species.iter().enumerate() {
            self.take(species.id, species.node, Kind::Species(number));
            let amount = self.quantity(species.id.to_owned(), species.node);
            let concentration = self.quantity(format!("[{}]", species.id), species.node);
            self.reader.symbols.insert(species.id, if species.only_amount { amount } else { concentration });
            self.amounts.push(amount);
        }
        for (number, parameter) in document.parameters.iter().enumerate() {
            self.symbol(parameter.id, parameter.node, Kind::Parameter(number));
        }
        for (number, reaction) in document.reactions.iter().enumerate() {
            self.symbol(reaction.id, reaction.node, Kind::Reaction(number));
            for (position, participant) in reaction.participants.iter().enumerate() {
                if let Some(id) = participant.id {
                    self.symbol(id, participant.node, Kind::Reference(number, position));
                }
            }
            for local in reaction.law.iter().flat_map(|law| &law.locals) {
                let quantity = self.quantity(format!("{}.{}", reaction.id, local.id), local.node);
                self.locals.insert(local.node.index(), quantity);
            }
        }
        for event in &document.events {
            if let Some(id) = event.id {
                self.take(id, event.node, Kind::Event);
            }
        }
    }

    /// Arguments and formula of a function.
    fn function(&self, lambda: Option<Node<'a>>) -> Function<'a> {
        let mut read = Function { arguments: Vec::new(), body: None };
        let Some(mut node) = lambda else { return read };
        if node.name() == "semantics" {
            node = node.elements().next().unwrap_or(node);
        }
        if node.name() != "lambda" {
            let found = format!("a function is a <lambda>, not <{}>", node.name());
            self.page.fault(node, found, "put <lambda> around the arguments (each in a <bvar>) and the formula");
            return read;
        }
        for child in node.elements() {
            if child.name() == "bvar" {
                let name = child.elements().next().map(super::math::name).unwrap_or_default();
                if name.is_empty() || read.arguments.contains(&name) {
                    let help = "each <bvar> holds one <ci> with a name of its own";
                    self.page.fault(child, "an argument has no name, or one that is taken", help);
                }
                read.arguments.push(name);
            } else {
                read.body = Some(child);
            }
        }
        read
    }
}
