//! Expressions that are linear in a quantity, solved for it.

use crate::equations::pieces::{difference, negative, product, quotient, sum};
use crate::equations::tree::{Binary, Expr, QuantityId, Unary};

/// What a quantity is equal to where an expression is zero; none when the expression is not linear in it, or does not depend on it.
pub fn root(expr: &Expr, of: QuantityId) -> Option<Expr> {
    let (slope, rest) = line(expr, of)?;
    match slope {
        Expr::Number(0.0) => None,
        Expr::Number(-1.0) => Some(rest),
        Expr::Number(slope) => Some(quotient(negative(rest), Expr::Number(slope))),
        slope => Some(quotient(negative(rest), slope)),
    }
}

/// Slope and rest of an expression that is linear in a quantity x: slope · x + rest; none when it is not.
pub fn line(expr: &Expr, x: QuantityId) -> Option<(Expr, Expr)> {
    parts(expr, x).map(|Line { slope, rest }| (slope, rest))
}

/// Whether an expression uses a quantity.
fn uses(expr: &Expr, quantity: QuantityId) -> bool {
    let mut found = false;
    expr.each_quantity(&mut |other| found |= other == quantity);
    found
}

/// slope · x + rest
struct Line {
    slope: Expr,
    rest: Expr,
}

fn parts(expr: &Expr, x: QuantityId) -> Option<Line> {
    const ZERO: Expr = Expr::Number(0.0);
    if !uses(expr, x) {
        return Some(Line { slope: ZERO, rest: expr.clone() });
    }
    match expr {
        // What was is not what is.
        Expr::Number(_) | Expr::Time | Expr::Delay(..) | Expr::Root(..) => None,
        Expr::Quantity(_) => Some(Line { slope: Expr::Number(1.0), rest: ZERO }),
        Expr::Unary(Unary::Neg, a) => parts(a, x).map(|a| Line { slope: negative(a.slope), rest: negative(a.rest) }),
        Expr::Unary(..) => None,
        Expr::Binary(Binary::Add, a, b) => {
            let (a, b) = (parts(a, x)?, parts(b, x)?);
            Some(Line { slope: folded(sum(a.slope, b.slope)), rest: sum(a.rest, b.rest) })
        }
        Expr::Binary(Binary::Sub, a, b) => {
            let (a, b) = (parts(a, x)?, parts(b, x)?);
            Some(Line { slope: folded(difference(a.slope, b.slope)), rest: difference(a.rest, b.rest) })
        }
        Expr::Binary(Binary::Mul, a, b) => match uses(a, x) {
            true => parts(a, x).filter(|_| !uses(b, x)).map(|a| a.each(|part| scaled(part, b))),
            false => parts(b, x).map(|b| b.each(|part| scaled(part, a))),
        },
        Expr::Binary(Binary::Div, a, b) => {
            let a = parts(a, x).filter(|_| !uses(b, x))?;
            Some(a.each(|part| if part == ZERO { part } else { quotient(part, (**b).clone()) }))
        }
        Expr::Binary(..) => None,
        Expr::Piecewise { branches, otherwise } => pieces(branches, otherwise, x),
    }
}

impl Line {
    fn each(self, with: impl Fn(Expr) -> Expr) -> Self {
        Self { slope: with(self.slope), rest: with(self.rest) }
    }
}

/// A sum or difference of two numbers as a number, so that slopes that cancel each other are seen to be none.
fn folded(slope: Expr) -> Expr {
    match &slope {
        Expr::Binary(function, a, b) => match (&**a, &**b) {
            (Expr::Number(a), Expr::Number(b)) => Expr::Number(function.apply(*a, *b)),
            _ => slope,
        },
        _ => slope,
    }
}

/// A product with a factor that is nothing where one is plainly zero: the line has no such part.
fn scaled(part: Expr, by: &Expr) -> Expr {
    if part == Expr::Number(0.0) { part } else { product(by.clone(), part) }
}

/// The line of each piece; which piece holds must not depend on the quantity.
fn pieces(branches: &[(Expr, Expr)], otherwise: &Expr, x: QuantityId) -> Option<Line> {
    let (mut slopes, mut rests) = (Vec::new(), Vec::new());
    for (condition, value) in branches {
        let line = parts(value, x).filter(|_| !uses(condition, x))?;
        slopes.push((condition.clone(), line.slope));
        rests.push((condition.clone(), line.rest));
    }
    let last = parts(otherwise, x)?;
    let joined = |branches, last| Expr::Piecewise { branches, otherwise: Box::new(last) };
    Some(Line { slope: joined(slopes, last.slope), rest: joined(rests, last.rest) })
}
