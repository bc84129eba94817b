//! What expressions look like: what is a condition, what follows from the left, what is a Hill function.

use crate::equations::tree::{Binary, Expr, Unary};

/// Whether an expression is made of numbers alone.
pub fn is_bare(expr: &Expr) -> bool {
    let mut bare = !expr.uses_time();
    expr.each_quantity(&mut |_| bare = false);
    bare
}

/// The operands of operators of one kind that follow each other from the left.
pub fn spine(function: Binary, expr: &Expr) -> Vec<&Expr> {
    let (mut parts, mut first) = (Vec::new(), expr);
    while let Expr::Binary(other, left, right) = first
        && *other == function
    {
        parts.push(&**right);
        first = left;
    }
    parts.push(first);
    parts.reverse();
    parts
}

/// x, K and n of xⁿ/(Kⁿ + xⁿ).
pub fn hill<'e>(above: &'e Expr, below: &'e Expr) -> Option<(&'e Expr, &'e Expr, &'e Expr)> {
    let Expr::Binary(Binary::Pow, x, exponent) = above else { return None };
    let Expr::Binary(Binary::Add, free, bound) = below else { return None };
    let Expr::Binary(Binary::Pow, half, other) = &**free else { return None };
    (**bound == *above && other == exponent).then_some((&**x, &**half, &**exponent))
}

pub fn is_comparison(function: Binary) -> bool {
    use Binary::{Eq, Ge, Gt, Le, Lt, Ne};
    matches!(function, Lt | Le | Gt | Ge | Eq | Ne)
}

/// Whether the value of an expression is a truth.
pub fn is_truth(expr: &Expr) -> bool {
    match expr {
        Expr::Unary(function, _) => *function == Unary::Not,
        Expr::Binary(function, ..) => {
            is_comparison(*function) || matches!(function, Binary::And | Binary::Or | Binary::Xor)
        }
        _ => false,
    }
}

pub fn operator_name(function: Binary) -> &'static str {
    match function {
        Binary::Add => "plus",
        Binary::Sub => "minus",
        Binary::Mul => "times",
        Binary::Div => "divide",
        Binary::Pow => "power",
        Binary::Min => "min",
        Binary::Max => "max",
        Binary::Rem => "rem",
        Binary::Quotient => "quotient",
        Binary::Lt => "lt",
        Binary::Le => "leq",
        Binary::Gt => "gt",
        Binary::Ge => "geq",
        Binary::Eq => "eq",
        Binary::Ne => "neq",
        Binary::And => "and",
        Binary::Or => "or",
        Binary::Xor => "xor",
    }
}
