//! Reads an expression by the strength with which operators bind, and goes on after a fault.

use super::Trouble;
use super::syntax::{DEEPEST, Node, NodeKind, too_long};
use super::token::{Kind, Token, tokens};
use crate::equations::tree::Binary;
use std::ops::Range;

/// Reads a text. Every fault is told; what could not be read is [`NodeKind::Unread`].
pub fn parse(text: &str) -> (Node, Vec<Trouble>) {
    if let Some(trouble) = too_long(text) {
        return (Node::new(NodeKind::Unread, 0..text.len()), vec![trouble]);
    }
    let mut troubles = Vec::new();
    let tokens = tokens(text, &mut troubles);
    if tokens.is_empty() {
        if troubles.is_empty() {
            let trouble = Trouble::new("the expression is empty", 0..text.len()).label("an expression was expected");
            troubles.push(trouble.help("write an expression, such as `-0.1*U`"));
        }
        return (Node::new(NodeKind::Unread, 0..text.len()), troubles);
    }
    let end = tokens.last().map_or(text.len(), |token| token.at.end);
    let mut parser = Parser { tokens, next: 0, end, depth: 0, given_up: false, troubles };
    let mut node = parser.expression(0);
    while parser.next < parser.tokens.len() {
        parser.leftover();
        node = parser.continued(node, 0);
    }
    let mut troubles = parser.troubles;
    troubles.sort_by_key(|trouble| trouble.at.start);
    (node, troubles)
}

/// How strongly the operands of `not`, of a minus and of `^` are bound.
const NOT: u8 = 5;
const MINUS: u8 = 10;
const POWER: u8 = 12;

/// An operator between two operands, how strongly it binds to the left and what it needs on its right.
fn strength(sign: &str) -> Option<(Binary, u8, u8)> {
    Some(match sign {
        "or" => (Binary::Or, 1, 2),
        "xor" => (Binary::Xor, 1, 2),
        "and" => (Binary::And, 3, 4),
        "<" => (Binary::Lt, 6, 7),
        "<=" => (Binary::Le, 6, 7),
        ">" => (Binary::Gt, 6, 7),
        ">=" => (Binary::Ge, 6, 7),
        "==" => (Binary::Eq, 6, 7),
        "!=" => (Binary::Ne, 6, 7),
        "+" => (Binary::Add, 8, 9),
        "-" => (Binary::Sub, 8, 9),
        "*" => (Binary::Mul, 9, 10),
        "/" => (Binary::Div, 9, 10),
        "^" => (Binary::Pow, POWER + 1, POWER),
        _ => return None,
    })
}

fn compares(operator: Binary) -> bool {
    use Binary::{Eq, Ge, Gt, Le, Lt, Ne};
    matches!(operator, Lt | Le | Gt | Ge | Eq | Ne)
}

struct Parser {
    tokens: Vec<Token>,
    next: usize,
    /// The end of the last token: where something missing is missing.
    end: usize,
    depth: usize,
    /// Too deep a nesting was met: nothing more is read or told.
    given_up: bool,
    troubles: Vec<Trouble>,
}

impl Parser {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next)
    }

    fn sign(&self) -> Option<&'static str> {
        match self.peek()?.kind {
            Kind::Sign(sign) => Some(sign),
            _ => None,
        }
    }

    fn take(&mut self, sign: &str) -> Option<Range<usize>> {
        (self.sign() == Some(sign)).then(|| {
            self.next += 1;
            self.tokens[self.next - 1].at.clone()
        })
    }

    fn binary(&self) -> Option<(Binary, u8, u8)> {
        strength(self.sign()?)
    }

    /// Where the next token begins, or the end of the text.
    fn here(&self) -> usize {
        self.peek().map_or(self.end, |token| token.at.start)
    }

    fn trouble(&mut self, trouble: Trouble) {
        if !self.given_up {
            self.troubles.push(trouble);
        }
    }

    fn expression(&mut self, weakest: u8) -> Node {
        self.depth += 1;
        if self.depth > DEEPEST {
            self.refuse_depth();
        }
        let left = self.operand();
        let node = self.continued(left, weakest);
        self.depth -= 1;
        node
    }

    fn refuse_depth(&mut self) {
        if self.next < self.tokens.len() {
            let at = self.here()..self.here() + 1;
            let trouble = Trouble::new(format!("the expression has more than {DEEPEST} levels"), at);
            self.trouble(trouble.label("too deep").help("split it with <define> or <function>"));
            self.given_up = true;
            self.next = self.tokens.len();
        }
    }

    /// Goes on after an operand as long as operators bind strongly enough.
    fn continued(&mut self, mut left: Node, weakest: u8) -> Node {
        let mut compared = false;
        let mut rows = 0;
        loop {
            let Some((operator, to_left, to_right)) = self.binary() else {
                // Two operands side by side: told, and read as a product.
                if self.starts_operand() && weakest <= 9 {
                    let trouble = Trouble::new("an operator is missing", self.tokens[self.next].at.clone());
                    self.trouble(trouble.label("before this").help("write a product with `*`, as in `2*x`"));
                    let right = self.expression(10);
                    let at = left.at.start..right.at.end;
                    left = Node::new(NodeKind::Binary(Binary::Mul, Box::new(left), Box::new(right)), at);
                    continue;
                }
                return left;
            };
            if to_left < weakest {
                return left;
            }
            let at = self.tokens[self.next].at.clone();
            self.next += 1;
            rows += 1;
            if self.depth + rows > DEEPEST {
                self.refuse_depth();
                return left;
            }
            if compares(operator) && std::mem::replace(&mut compared, true) {
                let trouble = Trouble::new("a comparison of a comparison", at.clone()).label("second comparison");
                self.trouble(trouble.help("write `a < b and b < c` for `a < b < c`"));
            }
            let right = self.expression(to_right);
            let at = left.at.start..right.at.end.max(at.end);
            left = Node::new(NodeKind::Binary(operator, Box::new(left), Box::new(right)), at);
        }
    }

    fn starts_operand(&self) -> bool {
        match self.peek().map(|token| &token.kind) {
            Some(Kind::Number(..) | Kind::Name(_)) => true,
            Some(Kind::Sign(sign)) => *sign == "(",
            None => false,
        }
    }

    fn operand(&mut self) -> Node {
        let Some(token) = self.peek().cloned() else { return self.missing() };
        match token.kind {
            Kind::Number(value, unit) => {
                self.next += 1;
                Node::new(NodeKind::Number(value, unit), token.at)
            }
            Kind::Name(name) => {
                self.next += 1;
                match self.take("(") {
                    Some(open) => self.call(name, token.at, open),
                    None => Node::new(NodeKind::Name(name), token.at),
                }
            }
            Kind::Sign("-") => {
                self.next += 1;
                let number = matches!(self.peek().map(|token| &token.kind), Some(Kind::Number(..)));
                let inner = self.expression(MINUS);
                let at = token.at.start..inner.at.end.max(token.at.end);
                // A minus right before a number is part of the number.
                match inner.kind {
                    NodeKind::Number(value, unit) if number => Node::new(NodeKind::Number(-value, unit), at),
                    _ => Node::new(NodeKind::Minus(Box::new(inner)), at),
                }
            }
            Kind::Sign("+") => {
                self.next += 1;
                self.expression(MINUS)
            }
            Kind::Sign("not") => {
                self.next += 1;
                let inner = self.expression(NOT);
                let at = token.at.start..inner.at.end.max(token.at.end);
                Node::new(NodeKind::Not(Box::new(inner)), at)
            }
            Kind::Sign("(") => {
                self.next += 1;
                let inner = self.expression(0);
                let end = self.close(&token.at, "the parenthesis");
                // A number in brackets stays one; its location includes the brackets.
                Node::new(inner.kind, token.at.start..end)
            }
            Kind::Sign(_) => self.missing(),
        }
    }

    fn missing(&mut self) -> Node {
        let (at, label) = match self.peek() {
            Some(token) => (token.at.clone(), "before this"),
            None => (self.end..self.end, "at the end"),
        };
        // One trouble is enough where the text has already been given up.
        if self.troubles.last().is_none_or(|last| last.at.start != at.start) {
            let trouble = Trouble::new("an operand is missing", at.clone()).label(label);
            self.trouble(
                trouble.help("write a number, a name, a function or a parenthesis on both sides of an operator"),
            );
        }
        Node::new(NodeKind::Unread, at.start..at.start)
    }

    /// The arguments after the opening parenthesis of a function.
    fn call(&mut self, name: String, at: Range<usize>, open: Range<usize>) -> Node {
        let mut arguments = Vec::new();
        if self.sign() != Some(")") {
            arguments.push(self.expression(0));
            while self.take(",").is_some() {
                arguments.push(self.expression(0));
            }
        }
        let end = self.close(&open, &format!("the parenthesis of `{name}`"));
        Node::new(NodeKind::Call(name, at.clone(), arguments), at.start..end)
    }

    /// Takes a closing parenthesis, or tells which one is not closed; returns where it ends.
    fn close(&mut self, open: &Range<usize>, what: &str) -> usize {
        if let Some(at) = self.take(")") {
            return at.end;
        }
        let trouble = Trouble::new(format!("{what} is not closed"), open.clone()).label("opened here");
        self.trouble(trouble.help("close it with `)`"));
        self.here().max(open.end)
    }

    /// A token that nothing is waiting for.
    fn leftover(&mut self) {
        let Some(token) = self.peek().cloned() else { return };
        let (message, label, help) = match token.kind {
            Kind::Sign(")") => {
                ("a parenthesis is closed that was never opened", "closed here", "remove it, or open it with `(`")
            }
            Kind::Sign(",") => (
                "a comma outside a function",
                "here",
                "write a decimal point as `.`; commas part the arguments of functions",
            ),
            _ => ("this does not belong to the expression", "here", "write one expression"),
        };
        self.trouble(Trouble::new(message, token.at).label(label).help(help));
        self.next += 1;
    }
}
