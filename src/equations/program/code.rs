//! From graph to register code: operations in order, registers used again as soon as their value is done with.

use super::graph::{Graph, Node, NodeId, Source};
use crate::equations::tree::{Binary, Search, Unary};
use std::sync::Arc;

/// Number of a register: first the slots of the program, then its constants, then what is worked out.
pub type Register = u32;

/// What an operation does.
#[derive(Debug, Clone, Copy, PartialEq, Hash)]
pub enum Action {
    /// A function of `a`.
    Unary(Unary),
    /// A function of `a` and `b`.
    Binary(Binary),
    /// `b` where `a` is true, and else `c`.
    Select,
    /// `a·b + c`, rounded twice as the two operations would be.
    MulAdd,
    /// `a·b − c`, rounded twice.
    MulSub,
    /// `c − a·b`, rounded twice.
    SubMul,
    /// `a` itself.
    Copy,
    /// Solves the equations of one of [`Code::solved`] in the registers from `to` on.
    Solve(u32),
}

/// One operation over all lanes.
#[derive(Debug, Clone, Copy, PartialEq, Hash)]
pub struct Op {
    /// What is done.
    pub action: Action,
    /// The register that is set.
    pub to: Register,
    /// First operand.
    pub a: Register,
    /// Second operand, or `a` again.
    pub b: Register,
    /// Third operand, or `a` again.
    pub c: Register,
}

/// Register code with the registers of its results.
#[derive(Debug, Clone, Default, Hash)]
pub struct Code {
    /// Operations in order.
    pub ops: Vec<Op>,
    /// Where each result stands in the end.
    pub outputs: Vec<Register>,
    /// How many registers are needed.
    pub registers: usize,
    /// Equations that are solved on the way.
    pub solved: Vec<Arc<Function>>,
    /// The delayed values that must stand in their slots before, by their indices, inner ones first.
    pub delays: Vec<usize>,
}

/// The constants that the codes of a program share, placed behind its slots.
#[derive(Debug, Clone, Default)]
pub struct Constants {
    /// Their values.
    pub values: Vec<f64>,
}

impl Constants {
    fn slot(&mut self, value: f64) -> usize {
        let same = |known: &f64| known.to_bits() == value.to_bits();
        self.values.iter().position(same).unwrap_or_else(|| {
            self.values.push(value);
            self.values.len() - 1
        })
    }

    /// Takes up the constants that some nodes need.
    pub fn collect(&mut self, graph: &Graph, roots: &[NodeId]) {
        for (id, _) in graph.needed(roots).iter().enumerate().filter(|(_, needed)| **needed) {
            if let Some(value) = graph.value(id as NodeId) {
                self.slot(value);
            }
        }
    }
}

impl Code {
    /// Whether an operation or a result is that register's value.
    pub fn reads(&self, register: Register) -> bool {
        self.outputs.contains(&register) || self.ops.iter().any(|op| [op.a, op.b, op.c].contains(&register))
    }

    /// Code for some nodes. All their constants must have been collected, since they stand between slots and results.
    pub fn of(graph: &Graph, roots: &[NodeId], slots: usize, constants: &Constants) -> Self {
        let needed = graph.needed(roots);
        let merged = Merged::of(graph, roots, &needed);
        let last_use = merged.last_uses(graph, roots, &needed);
        let mut register = vec![Register::MAX; graph.len()];
        let (mut free, mut next) = (Vec::new(), (slots + constants.values.len()) as Register);
        let mut ops = Vec::new();
        // Where the unknowns of each call stand, once it is made.
        let (mut solved, mut unknowns) = (Vec::new(), vec![Register::MAX; graph.calls.len()]);
        for id in (0..graph.len()).filter(|&id| needed[id] && !merged.inner[id]) {
            let (action, operands) = match graph.node(id as NodeId) {
                Node::Slot(slot) => {
                    register[id] = slot;
                    continue;
                }
                Node::Constant(bits) => {
                    let at = constants.values.iter().position(|value| value.to_bits() == bits);
                    register[id] = (slots + at.expect("constants are collected before code is made")) as Register;
                    continue;
                }
                Node::Unary(function, a) => (Action::Unary(function), [a, a, a]),
                Node::Binary(..) if merged.outer[id].is_some() => merged.outer[id].expect("just asked"),
                Node::Binary(function, a, b) => (Action::Binary(function), [a, b, a]),
                Node::Select(a, b, c) => (Action::Select, [a, b, c]),
                Node::Root(number, index) => {
                    let call = &graph.calls[number as usize];
                    let unknowns = &mut unknowns[number as usize];
                    if *unknowns == Register::MAX {
                        let (function, first) = (Function::of(&call.source), next);
                        next += function.registers() as Register;
                        *unknowns = first + (function.first_of_search() + function.search.unknown(0)) as Register;
                        for (operand, offset) in call.operands.iter().zip(function.operands()) {
                            let a = register[*operand as usize];
                            ops.push(Op { action: Action::Copy, to: first + offset as Register, a, b: a, c: a });
                        }
                        let action = Action::Solve(solved.len() as u32);
                        ops.push(Op { action, to: first, a: first, b: first, c: first });
                        solved.push(Arc::new(function));
                    }
                    register[id] = *unknowns + index;
                    continue;
                }
            };
            let [a, b, c] = operands.map(|operand| register[operand as usize]);
            for (index, operand) in operands.iter().enumerate() {
                let first = !operands[..index].contains(operand);
                let is_result = graph.operands(*operand).next().is_some();
                if first && is_result && last_use[*operand as usize] == id {
                    free.push(register[*operand as usize]);
                }
            }
            let to = free.pop().unwrap_or_else(|| {
                next += 1;
                next - 1
            });
            register[id] = to;
            ops.push(Op { action, to, a, b, c });
        }
        let outputs = roots.iter().map(|&root| register[root as usize]).collect();
        Self { ops, outputs, registers: next as usize, solved, delays: Vec::new() }
    }
}

/// Equations that are solved on the way, as code of their own. Its slots are what they use, in the first one the time, and behind that
/// the unknowns. Where it is called it has registers of its own, and behind them those of the search.
#[derive(Debug, Clone, Hash)]
pub struct Function {
    /// Works out the equations' values, then their derivatives by the unknowns, row by row.
    pub code: Code,
    /// The constants behind the slots, by their bits.
    pub constants: Vec<u64>,
    /// How many slots are used before those of the unknowns.
    pub used: usize,
    /// The search for the unknowns.
    pub search: Search,
}

impl Function {
    fn of(source: &Source) -> Self {
        let search = Search { count: source.residuals.len() };
        let roots = [source.residuals.as_slice(), &source.slopes].concat();
        let mut constants = Constants::default();
        constants.collect(&source.graph, &roots);
        let code = Code::of(&source.graph, &roots, source.used + search.count, &constants);
        let constants = constants.values.iter().map(|value| value.to_bits()).collect();
        Self { code, constants, used: source.used, search }
    }

    /// How many registers a call takes.
    pub fn registers(&self) -> usize {
        self.first_of_search() + self.search.registers()
    }

    /// Where the operands of a call must stand, from its first register on: what is used, and the starts.
    pub fn operands(&self) -> impl Iterator<Item = usize> + use<> {
        let starts = self.first_of_search();
        (0..self.used).chain(starts..starts + self.search.count)
    }

    /// The first register of the search.
    pub fn first_of_search(&self) -> usize {
        self.code.registers.max(self.used + self.search.count + self.constants.len())
    }
}

/// Products that only one sum or difference uses become one operation with it.
struct Merged {
    /// The operation of a sum that has taken up a product.
    outer: Vec<Option<(Action, [NodeId; 3])>>,
    /// Whether a node is such a product.
    inner: Vec<bool>,
}

impl Merged {
    fn of(graph: &Graph, roots: &[NodeId], needed: &[bool]) -> Self {
        let mut uses = vec![0; graph.len()];
        for id in (0..graph.len()).filter(|&id| needed[id]) {
            graph.operands(id as NodeId).for_each(|operand| uses[operand as usize] += 1);
        }
        roots.iter().for_each(|&root| uses[root as usize] += 2);
        let product = |id: NodeId| match graph.node(id) {
            Node::Binary(Binary::Mul, a, b) if uses[id as usize] == 1 => Some([a, b]),
            _ => None,
        };
        let mut merged = Self { outer: vec![None; graph.len()], inner: vec![false; graph.len()] };
        for id in (0..graph.len()).filter(|&id| needed[id]) {
            let Node::Binary(function @ (Binary::Add | Binary::Sub), left, right) = graph.node(id as NodeId) else {
                continue;
            };
            let sum = function == Binary::Add;
            let found = match (product(left), product(right)) {
                (Some([a, b]), _) => Some((left, if sum { Action::MulAdd } else { Action::MulSub }, [a, b, right])),
                (None, Some([a, b])) => Some((right, if sum { Action::MulAdd } else { Action::SubMul }, [a, b, left])),
                _ => None,
            };
            if let Some((taken, action, operands)) = found {
                merged.outer[id] = Some((action, operands));
                merged.inner[taken as usize] = true;
            }
        }
        merged
    }

    /// The node that uses each node last; results count as used after all.
    fn last_uses(&self, graph: &Graph, roots: &[NodeId], needed: &[bool]) -> Vec<usize> {
        let mut last = vec![0; graph.len()];
        for id in (0..graph.len()).filter(|&id| needed[id] && !self.inner[id]) {
            match self.outer[id] {
                Some((_, operands)) => operands.iter().for_each(|&operand| last[operand as usize] = id),
                None => graph.operands(id as NodeId).for_each(|operand| last[operand as usize] = id),
            }
        }
        roots.iter().for_each(|&root| last[root as usize] = usize::MAX);
        last
    }
}
