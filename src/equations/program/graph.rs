//! The equations as a graph in which equal subexpressions are one node and constants are worked out.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use crate::equations::tree::{Binary, Equations, Expr, Unary};

/// Number of a node; a node uses only nodes with smaller numbers.
pub type NodeId = u32;

/// A node of the graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Node {
    /// A constant, by its bits.
    Constant(u64),
    /// Something given at run time: slot 0 is the time, then the variables, then the open quantities.
    Slot(u32),
    /// A function of one argument.
    Unary(Unary, NodeId),
    /// A function of two arguments.
    Binary(Binary, NodeId, NodeId),
    /// The second where the first is true, and else the third.
    Select(NodeId, NodeId, NodeId),
    /// An unknown of a call among [`Graph::calls`], by the indices of both.
    Root(u32, u32),
}

/// A value of a time ago. It stands in a slot of its own; in the slot behind that, how fast what is looked back at changed then.
#[derive(Debug, Clone)]
pub struct Delayed {
    /// Its slot.
    pub slot: u32,
    /// What is looked back at.
    pub value: NodeId,
    /// How far.
    pub delay: NodeId,
    /// The same as expressions.
    pub expressions: (Expr, Expr),
}

/// Equations that determine unknowns, as a graph of their own. Its slots are what they use, in the first one the time, and behind that the
/// unknowns.
#[derive(Debug, Clone)]
pub struct Source {
    /// The graph.
    pub graph: Graph,
    /// What is nothing.
    pub residuals: Vec<NodeId>,
    /// Derivatives by the unknowns, row by row.
    pub slopes: Vec<NodeId>,
    /// How many slots are used before those of the unknowns.
    pub used: usize,
}

/// A call of equations in a graph.
#[derive(Debug, Clone)]
pub struct Call {
    /// What is solved.
    pub source: Arc<Source>,
    /// What is used, and the starts.
    pub operands: Vec<NodeId>,
    /// What it was made of; none for what derivatives need.
    pub equations: Option<Equations>,
}

/// Nodes, each once; made by the functions of `simplify`.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    pub(super) nodes: Vec<Node>,
    known: HashMap<Node, NodeId>,
    /// Whether something was otherwise before the start than at the start.
    pub(super) has_history: bool,
    /// The slot of the first delayed value.
    pub(super) first_delayed: u32,
    /// Delayed values, inner ones before those around them.
    pub(super) delayed: Vec<Delayed>,
    /// Where equations are solved.
    pub(super) calls: Vec<Call>,
    pub(super) derivatives: HashMap<(NodeId, u32), NodeId>,
}

impl Graph {
    /// The node behind a number.
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id as usize]
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no node yet.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    pub(super) fn intern(&mut self, node: Node) -> NodeId {
        let Self { nodes, known, .. } = self;
        *known.entry(node).or_insert_with(|| {
            nodes.push(node);
            nodes.len() as NodeId - 1
        })
    }

    /// A constant.
    pub fn constant(&mut self, value: f64) -> NodeId {
        self.intern(Node::Constant(value.to_bits()))
    }

    /// Something given at run time.
    pub fn slot(&mut self, slot: u32) -> NodeId {
        self.intern(Node::Slot(slot))
    }

    /// The value of a node that is a constant.
    pub fn value(&self, id: NodeId) -> Option<f64> {
        match self.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The node of an expression; `quantities` has the node of every quantity that it uses.
    pub fn expression(&mut self, expression: &Expr, quantities: &[NodeId]) -> NodeId {
        match expression {
            Expr::Number(number) => self.constant(*number),
            Expr::Time => self.slot(0),
            Expr::Quantity(number) => quantities[*number as usize],
            Expr::Unary(function, a) => {
                let a = self.expression(a, quantities);
                self.unary(*function, a)
            }
            Expr::Binary(function, a, b) => {
                let a = self.expression(a, quantities);
                let b = self.expression(b, quantities);
                self.binary(*function, a, b)
            }
            Expr::Piecewise { branches, otherwise } => {
                let mut value = self.expression(otherwise, quantities);
                for (condition, branch) in branches.iter().rev() {
                    let condition = self.expression(condition, quantities);
                    let branch = self.expression(branch, quantities);
                    value = self.select(condition, branch, value);
                }
                value
            }
            Expr::Root(equations, index) => self.root(equations, *index, quantities),
            Expr::Delay(value, delay) => {
                let (at, by) = (self.expression(value, quantities), self.expression(delay, quantities));
                self.delayed((at, by), (value, delay))
            }
        }
    }

    /// A value of a time ago. What is constant was so before, unless the system has another history, and no time ago is now.
    fn delayed(&mut self, (value, delay): (NodeId, NodeId), expressions: (&Expr, &Expr)) -> NodeId {
        if (self.value(value).is_some() && !self.has_history) || self.value(delay) == Some(0.0) {
            return value;
        }
        if let Some(known) = self.delayed.iter().find(|known| (known.value, known.delay) == (value, delay)) {
            return self.slot(known.slot);
        }
        let slot = self.first_delayed + 2 * self.delayed.len() as u32;
        let expressions = (expressions.0.clone(), expressions.1.clone());
        self.delayed.push(Delayed { slot, value, delay, expressions });
        self.slot(slot)
    }

    /// The delayed value that stands in a slot.
    pub fn delayed_at(&self, slot: u32) -> Option<&Delayed> {
        let index = slot.checked_sub(self.first_delayed)? as usize;
        self.delayed.get(index / 2).filter(|_| index.is_multiple_of(2))
    }

    /// The slots that some nodes depend on, in order; those that tell how far they look back, too.
    pub fn slots(&self, roots: &[NodeId]) -> Vec<u32> {
        let (mut open, mut slots) = (roots.to_vec(), BTreeSet::new());
        while !open.is_empty() {
            let needed = self.needed(&open);
            open.clear();
            for (id, _) in needed.iter().enumerate().filter(|(_, needed)| **needed) {
                let Node::Slot(slot) = self.nodes[id] else { continue };
                if slots.insert(slot) {
                    open.extend(self.delayed_at(slot).map(|delayed| delayed.delay));
                }
            }
        }
        slots.into_iter().collect()
    }

    /// The indices of the delayed values that some nodes depend on, in order.
    pub fn delays(&self, roots: &[NodeId]) -> Vec<usize> {
        if self.delayed.is_empty() {
            return Vec::new();
        }
        // A rate of change needs the value that it is of.
        let index = |slot: u32| slot.checked_sub(self.first_delayed).map(|index| index as usize / 2);
        let mut found: Vec<usize> = self.slots(roots).into_iter().filter_map(index).collect();
        let more: Vec<NodeId> = found.iter().map(|&index| self.delayed[index].delay).collect();
        found.extend(self.slots(&more).into_iter().filter_map(index));
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The nodes that a node uses.
    pub fn operands(&self, id: NodeId) -> impl Iterator<Item = NodeId> + use<> {
        let more = match self.node(id) {
            Node::Root(call, _) => self.calls[call as usize].operands.clone(),
            _ => Vec::new(),
        };
        let operands = match self.node(id) {
            Node::Constant(_) | Node::Slot(_) | Node::Root(..) => [None; 3],
            Node::Unary(_, a) => [Some(a), None, None],
            Node::Binary(_, a, b) => [Some(a), Some(b), None],
            Node::Select(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        operands.into_iter().flatten().chain(more)
    }

    /// Which nodes some others need, themselves included.
    pub fn needed(&self, roots: &[NodeId]) -> Vec<bool> {
        let mut needed = vec![false; self.nodes.len()];
        for &root in roots {
            needed[root as usize] = true;
        }
        for id in (0..self.nodes.len()).rev() {
            if needed[id] {
                self.operands(id as NodeId).for_each(|operand| needed[operand as usize] = true);
            }
        }
        needed
    }
}
