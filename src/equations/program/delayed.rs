//! The delayed values of a system, as code.

use super::code::Code;
use super::graph::{Graph, NodeId};
use super::past::Past;
use crate::equations::expression;
use crate::equations::tree::{Expr, QuantityId, System};

/// A value of an earlier time, x(t − τ), that the codes of a program use.
#[derive(Debug, Clone)]
pub struct DelayedValue {
    /// The register in which it must stand; in the next one stands x'(t − τ) for code that has derivatives.
    pub register: usize,
    /// Works out the delay τ.
    pub delay: Code,
    /// Works out x, on the registers of the earlier time.
    pub value: Code,
    /// The delay, where it is constant.
    pub constant: Option<f64>,
    /// How far it and what it is made of look back in all; infinite where that varies.
    pub reach: f64,
    /// What is looked back at.
    pub expression: Expr,
    /// Whether it has one value before the start.
    pub is_steady: bool,
    /// As it is written, for messages.
    pub text: String,
}

/// All delayed values of a graph; `code` makes code for its nodes.
pub fn values(graph: &Graph, system: &System, start: f64, code: impl Fn(&[NodeId]) -> Code) -> Vec<DelayedValue> {
    let name = |quantity: QuantityId| system.quantities[quantity as usize].id.clone();
    let code = |node: NodeId| Code { delays: graph.delays(&[node]), ..code(&[node]) };
    let mut made: Vec<DelayedValue> = Vec::new();
    for delayed in &graph.delayed {
        let (delay, value) = (code(delayed.delay), code(delayed.value));
        let constant = graph.value(delayed.delay);
        let behind = value.delays.iter().chain(&delay.delays).map(|&inner| made[inner].reach).fold(0.0, f64::max);
        let (looked_at, by) = &delayed.expressions;
        made.push(DelayedValue {
            register: delayed.slot as usize,
            constant,
            reach: constant.unwrap_or(f64::INFINITY) + behind,
            expression: looked_at.clone(),
            is_steady: constant.is_some() && Past { system, start }.is_steady(looked_at),
            text: expression::write(&Expr::Delay(Box::new(looked_at.clone()), Box::new(by.clone())), &name),
            delay,
            value,
        });
    }
    made
}
