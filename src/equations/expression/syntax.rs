//! An expression as it is written: every part knows its location in the text.

use super::Trouble;
use crate::equations::tree::Binary;
use std::ops::Range;

/// A part of an expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What it is.
    pub kind: NodeKind,
    /// Its bytes in the text.
    pub at: Range<usize>,
}

/// What a part of an expression is.
#[derive(Debug, Clone, PartialEq)]
pub enum NodeKind {
    /// A number and the unit written after it.
    Number(f64, Option<String>),
    /// A name that is not called: a quantity, an argument, `time`, `pi`.
    Name(String),
    /// The sign changed.
    Minus(Box<Node>),
    /// Not true.
    Not(Box<Node>),
    /// Two operands.
    Binary(Binary, Box<Node>, Box<Node>),
    /// A function's name, the location of the name, and the arguments.
    Call(String, Range<usize>, Vec<Node>),
    /// What could not be read; a trouble tells why.
    Unread,
}

impl Node {
    pub(super) fn new(kind: NodeKind, at: Range<usize>) -> Self {
        Self { kind, at }
    }

    /// The parts of the part.
    pub fn children(&self) -> Vec<&Node> {
        match &self.kind {
            NodeKind::Number(..) | NodeKind::Name(_) | NodeKind::Unread => Vec::new(),
            NodeKind::Minus(a) | NodeKind::Not(a) => vec![a],
            NodeKind::Binary(_, a, b) => vec![a, b],
            NodeKind::Call(_, _, arguments) => arguments.iter().collect(),
        }
    }

    /// Every name that is used but not called, with its location.
    pub fn names(&self) -> Vec<(&str, Range<usize>)> {
        let mut found = Vec::new();
        self.visit(&mut |node| {
            if let NodeKind::Name(name) = &node.kind {
                found.push((name.as_str(), node.at.clone()));
            }
        });
        found
    }

    /// Every function that is called, with the location of its name.
    pub fn calls(&self) -> Vec<(&str, Range<usize>)> {
        let mut found = Vec::new();
        self.visit(&mut |node| {
            if let NodeKind::Call(name, at, _) = &node.kind {
                found.push((name.as_str(), at.clone()));
            }
        });
        found
    }

    fn visit<'a>(&'a self, see: &mut impl FnMut(&'a Node)) {
        see(self);
        for child in self.children() {
            child.visit(see);
        }
    }
}

/// Whether an expression is made of bare numbers alone.
pub fn is_constant(node: &Node) -> bool {
    match &node.kind {
        NodeKind::Name(_) | NodeKind::Number(_, Some(_)) => false,
        _ => node.children().iter().all(|child| is_constant(child)),
    }
}

/// The most levels an expression may have: brackets in brackets, or terms in a row.
pub const DEEPEST: usize = 400;
/// The most bytes an expression may have.
pub const LONGEST: usize = 100_000;

/// Refuses a text that is too long before anything is built from it.
pub(super) fn too_long(text: &str) -> Option<Trouble> {
    (text.len() > LONGEST).then(|| {
        Trouble::new(format!("the expression has {} bytes; at most {LONGEST} are read", text.len()), 0..0)
            .label("begins here")
            .help("split it with <define> or <function>")
    })
}
