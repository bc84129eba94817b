//! Equations that determine unknowns in a graph: calls of them, and the derivatives of the unknowns.

use super::graph::{Call, Graph, Node, NodeId, Source};
use crate::equations::tree::{Binary, Equations, Expr, QuantityId, Unary};
use std::sync::Arc;

impl Source {
    /// With the derivatives by the unknowns, whose slots stand behind those of what is used.
    fn new(mut graph: Graph, residuals: Vec<NodeId>, used: usize) -> Self {
        let unknowns = used as u32..(used + residuals.len()) as u32;
        let of_row = |&row: &NodeId| unknowns.clone().map(move |slot| (row, slot));
        let pairs: Vec<(NodeId, u32)> = residuals.iter().flat_map(of_row).collect();
        let slopes = pairs.into_iter().map(|(row, slot)| graph.derivative(row, slot)).collect();
        Self { graph, residuals, slopes, used }
    }
}

impl Graph {
    /// The node of an unknown of equations.
    pub(super) fn root(&mut self, equations: &Equations, index: u32, quantities: &[NodeId]) -> NodeId {
        let mut used: Vec<QuantityId> = Vec::new();
        for residual in &equations.residuals {
            residual.each_quantity(&mut |quantity| {
                if !equations.unknowns.contains(&quantity) && !used.contains(&quantity) {
                    used.push(quantity);
                }
            });
        }
        let time = match equations.residuals.iter().any(Expr::uses_time) {
            true => self.slot(0),
            false => self.constant(0.0),
        };
        let used_nodes = used.iter().map(|quantity| quantities[*quantity as usize]);
        let mut operands: Vec<NodeId> = std::iter::once(time).chain(used_nodes).collect();
        operands.extend(equations.starts.iter().map(|start| self.expression(start, quantities)));
        let is_same = |call: &Call| call.operands == operands && call.equations.as_ref() == Some(equations);
        let number = self.calls.iter().position(is_same).unwrap_or_else(|| {
            let mut graph = Graph::default();
            // The first slot is the time.
            let mut inner = vec![NodeId::MAX; quantities.len()];
            for (slot, quantity) in used.iter().chain(&equations.unknowns).enumerate() {
                inner[*quantity as usize] = graph.slot(1 + slot as u32);
            }
            let residuals = equations.residuals.iter().map(|one| graph.expression(one, &inner)).collect();
            let source = Source::new(graph, residuals, 1 + used.len());
            self.calls.push(Call { source: Arc::new(source), operands, equations: Some(equations.clone()) });
            self.calls.len() - 1
        });
        self.intern(Node::Root(number as u32, index))
    }

    /// The node of an unknown of a call of another graph, with operands of this one.
    pub(super) fn called(&mut self, call: &Call, index: u32, at: impl Fn(NodeId) -> NodeId) -> NodeId {
        let operands: Vec<NodeId> = call.operands.iter().map(|operand| at(*operand)).collect();
        let is_same = |known: &Call| known.operands == operands && Arc::ptr_eq(&known.source, &call.source);
        let number = self.calls.iter().position(is_same).unwrap_or_else(|| {
            self.calls.push(Call { operands, ..call.clone() });
            self.calls.len() - 1
        });
        self.intern(Node::Root(number as u32, index))
    }

    /// The derivative of an unknown, eq. (ode.12).
    pub(super) fn derivative_of_root(&mut self, number: u32, index: u32, slot: u32) -> NodeId {
        let call = self.calls[number as usize].clone();
        let mut source = (*call.source).clone();
        let count = source.residuals.len();
        let used = call.operands[..source.used].to_vec();
        let changes: Vec<NodeId> = used.iter().map(|operand| self.derivative(*operand, slot)).collect();
        if changes.iter().all(|change| self.value(*change) == Some(0.0)) {
            return self.constant(0.0);
        }
        // At the solution the slots are what is used and the unknowns themselves.
        let mut slots = used;
        slots.extend((0..count as u32).map(|unknown| self.intern(Node::Root(number, unknown))));
        let slopes = self.taken_over(&source.graph, &source.slopes, &slots);
        let mut moved = Vec::with_capacity(count);
        for row in 0..count {
            let mut sum = self.constant(0.0);
            for (part, &change) in changes.iter().enumerate() {
                if self.value(change) == Some(0.0) {
                    continue;
                }
                let by = source.graph.derivative(source.residuals[row], part as u32);
                let by = self.taken_over(&source.graph, &[by], &slots)[0];
                let product = self.binary(Binary::Mul, by, change);
                sum = self.binary(Binary::Add, sum, product);
            }
            moved.push(sum);
        }
        if count == 1 {
            let share = self.binary(Binary::Div, moved[0], slopes[0]);
            return self.unary(Unary::Neg, share);
        }
        self.linear(&slopes, &moved, index)
    }

    /// Nodes of another graph in this one, whose slots are nodes here.
    fn taken_over(&mut self, other: &Graph, roots: &[NodeId], slots: &[NodeId]) -> Vec<NodeId> {
        let needed = other.needed(roots);
        let mut new = vec![NodeId::MAX; other.len()];
        for id in (0..other.len()).filter(|&id| needed[id]) {
            let at = |id: NodeId| new[id as usize];
            new[id] = match other.node(id as NodeId) {
                Node::Slot(slot) => slots[slot as usize],
                Node::Constant(bits) => self.constant(f64::from_bits(bits)),
                Node::Unary(function, a) => self.unary(function, at(a)),
                Node::Binary(function, a, b) => self.binary(function, at(a), at(b)),
                Node::Select(a, b, c) => self.select(at(a), at(b), at(c)),
                Node::Root(call, index) => self.called(&other.calls[call as usize], index, at),
            };
        }
        roots.iter().map(|&root| new[root as usize]).collect()
    }

    /// An unknown of the linear equations S v + m = 0, which are solved as others are: so rows are exchanged where that is better.
    fn linear(&mut self, slopes: &[NodeId], moved: &[NodeId], index: u32) -> NodeId {
        let count = moved.len();
        let used = 1 + count * count + count;
        let mut graph = Graph::default();
        let mut residuals = Vec::with_capacity(count);
        for row in 0..count {
            let mut sum = graph.slot((1 + count * count + row) as u32);
            for column in 0..count {
                let (factor, unknown) =
                    (graph.slot((1 + row * count + column) as u32), graph.slot((used + column) as u32));
                let product = graph.binary(Binary::Mul, factor, unknown);
                sum = graph.binary(Binary::Add, sum, product);
            }
            residuals.push(sum);
        }
        let source = Source::new(graph, residuals, used);
        let zero = self.constant(0.0);
        let operands: Vec<NodeId> = std::iter::once(zero)
            .chain(slopes.iter().copied())
            .chain(moved.iter().copied())
            .chain(std::iter::repeat_n(zero, count))
            .collect();
        let is_same = |call: &Call| call.equations.is_none() && call.operands == operands;
        let number = self.calls.iter().position(is_same).unwrap_or_else(|| {
            self.calls.push(Call { source: Arc::new(source), operands, equations: None });
            self.calls.len() - 1
        });
        self.intern(Node::Root(number as u32, index))
    }
}
