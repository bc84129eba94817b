//! Small pieces of expressions, put together.

use crate::equations::tree::{Binary, Expr, QuantityId, Unary};

pub fn number(value: f64) -> Expr {
    Expr::Number(value)
}

pub fn quantity(id: QuantityId) -> Expr {
    Expr::Quantity(id)
}

pub fn unary(function: Unary, a: Expr) -> Expr {
    Expr::Unary(function, Box::new(a))
}

pub fn binary(function: Binary, a: Expr, b: Expr) -> Expr {
    Expr::Binary(function, Box::new(a), Box::new(b))
}

/// Minus, at once for numbers and for what has one already.
pub fn negative(a: Expr) -> Expr {
    match a {
        Expr::Number(value) => number(-value),
        Expr::Unary(Unary::Neg, a) => *a,
        a => unary(Unary::Neg, a),
    }
}

/// A sum without plain zeros.
pub fn sum(a: Expr, b: Expr) -> Expr {
    match (a, b) {
        (Expr::Number(0.0), other) | (other, Expr::Number(0.0)) => other,
        (a, Expr::Unary(Unary::Neg, b)) => binary(Binary::Sub, a, *b),
        (a, b) => binary(Binary::Add, a, b),
    }
}

/// A difference without plain zeros.
pub fn difference(a: Expr, b: Expr) -> Expr {
    match (a, b) {
        (other, Expr::Number(0.0)) => other,
        (Expr::Number(0.0), b) => negative(b),
        (a, b) => binary(Binary::Sub, a, b),
    }
}

/// A product without plain ones. A plain zero stays: what it multiplies may not be finite.
pub fn product(a: Expr, b: Expr) -> Expr {
    match (a, b) {
        (Expr::Number(1.0), other) | (other, Expr::Number(1.0)) => other,
        (Expr::Number(-1.0), other) | (other, Expr::Number(-1.0)) => negative(other),
        (a, b) => binary(Binary::Mul, a, b),
    }
}

/// A quotient without plain ones.
pub fn quotient(a: Expr, b: Expr) -> Expr {
    match (a, b) {
        (other, Expr::Number(1.0)) => other,
        (a, b) => binary(Binary::Div, a, b),
    }
}

/// Many terms joined by one operator: from the left when they are few, as a balanced tree when they are many, so that
/// a sum of thousands does not nest thousands deep.
pub fn join(function: Binary, mut terms: Vec<Expr>, empty: f64) -> Expr {
    if terms.len() > 8 {
        let right = terms.split_off(terms.len() / 2);
        return binary(function, join(function, terms, empty), join(function, right, empty));
    }
    terms.into_iter().reduce(|a, b| binary(function, a, b)).unwrap_or(Expr::Number(empty))
}

/// A sum of many terms without plain zeros.
pub fn total(mut terms: Vec<Expr>) -> Expr {
    if terms.len() > 8 {
        let right = terms.split_off(terms.len() / 2);
        return sum(total(terms), total(right));
    }
    terms.into_iter().reduce(sum).unwrap_or(Expr::Number(0.0))
}

/// Nesting and number of nodes.
pub fn extent(expr: &Expr) -> (usize, usize) {
    let (mut depth, mut size) = (0, 1);
    let mut below = |a: &Expr| {
        let (d, s) = extent(a);
        depth = depth.max(d);
        size += s;
    };
    match expr {
        Expr::Number(_) | Expr::Time | Expr::Quantity(_) => {}
        Expr::Unary(_, a) => below(a),
        Expr::Binary(_, a, b) | Expr::Delay(a, b) => {
            below(a);
            below(b);
        }
        Expr::Piecewise { branches, otherwise } => {
            for (condition, value) in branches {
                below(condition);
                below(value);
            }
            below(otherwise);
        }
        Expr::Root(equations, _) => equations.expressions().for_each(below),
    }
    (depth + 1, size)
}

/// The expression with some quantities replaced by expressions.
pub fn replaced(expr: &Expr, by: &impl Fn(QuantityId) -> Option<Expr>) -> Expr {
    match expr {
        Expr::Number(_) | Expr::Time => expr.clone(),
        Expr::Quantity(id) => by(*id).unwrap_or_else(|| expr.clone()),
        Expr::Unary(function, a) => unary(*function, replaced(a, by)),
        Expr::Binary(function, a, b) => binary(*function, replaced(a, by), replaced(b, by)),
        Expr::Piecewise { branches, otherwise } => Expr::Piecewise {
            branches: branches.iter().map(|(c, v)| (replaced(c, by), replaced(v, by))).collect(),
            otherwise: Box::new(replaced(otherwise, by)),
        },
        Expr::Delay(value, delay) => Expr::Delay(Box::new(replaced(value, by)), Box::new(replaced(delay, by))),
        Expr::Root(equations, index) => Expr::Root(Box::new(equations.map(|part| replaced(part, by))), *index),
    }
}
