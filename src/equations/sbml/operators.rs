//! The operators and elementary functions of MathML that SBML takes.

use super::notes::Notes;
use super::xml::Node;
use crate::equations::pieces::{binary, extent, join, negative, number, quotient, unary};
use crate::equations::tree::{Binary, Expr, Unary};

/// The value of an operator for its operands; `qualifier` is the base of a logarithm or the degree of a root.
pub fn apply<'a>(notes: &Notes<'_, 'a>, head: Node<'a>, operands: Vec<Expr>, qualifier: Option<Expr>) -> Option<Expr> {
    let name = head.name();
    let Some((least, most)) = arity(name) else {
        let found = format!("<{name}> is not an operator of SBML");
        return notes.fault(head, found, "the chapter on SBML lists those that are read");
    };
    if operands.len() < least || operands.len() > most {
        let wanted = match (least, most) {
            (1, 1) => "1 operand".to_owned(),
            (least, usize::MAX) => format!("{least} operands or more"),
            (least, most) if least == most => format!("{least} operands"),
            (least, most) => format!("{least} to {most} operands"),
        };
        let found = format!("<{name}> has {} operand{}", operands.len(), if operands.len() == 1 { "" } else { "s" });
        return notes.fault(head, found, format!("it takes {wanted}"));
    }
    if qualifier.is_some() && !matches!(name, "log" | "root") {
        return notes.fault(head, format!("<{name}> has no base and no degree"), "only <log/> and <root/> have");
    }
    // These use an operand twice: nested in each other they would grow without bound.
    let twice = matches!(name, "quotient" | "root") || (arity(name) == Some((1, usize::MAX)) && operands.len() > 2);
    if twice && !notes.take(operands.iter().map(|operand| extent(operand).1).sum()) {
        return notes.too_large(head);
    }
    Some(value(name, operands, qualifier))
}

/// The least and the largest number of operands.
fn arity(name: &str) -> Option<(usize, usize)> {
    const MANY: usize = usize::MAX;
    Some(match name {
        "plus" | "times" | "and" | "or" | "xor" => (0, MANY),
        "max" | "min" => (1, MANY),
        "eq" | "lt" | "gt" | "leq" | "geq" => (1, MANY),
        "minus" => (1, 2),
        "neq" | "divide" | "power" | "quotient" | "rem" | "implies" => (2, 2),
        "not" | "log" | "root" => (1, 1),
        name if elementary(name).is_some() || reciprocal(name).is_some() || inverse_reciprocal(name).is_some() => {
            (1, 1)
        }
        _ => return None,
    })
}

fn value(name: &str, mut operands: Vec<Expr>, qualifier: Option<Expr>) -> Expr {
    match name {
        "plus" => join(Binary::Add, operands, 0.0),
        "times" => join(Binary::Mul, operands, 1.0),
        "and" => join(Binary::And, truths(operands), 1.0),
        "or" => join(Binary::Or, truths(operands), 0.0),
        "xor" => join(Binary::Xor, truths(operands), 0.0),
        "max" => join(Binary::Max, operands, f64::NAN),
        "min" => join(Binary::Min, operands, f64::NAN),
        "eq" => chain(Binary::Eq, operands),
        "lt" => chain(Binary::Lt, operands),
        "gt" => chain(Binary::Gt, operands),
        "leq" => chain(Binary::Le, operands),
        "geq" => chain(Binary::Ge, operands),
        "minus" => minus(operands),
        _ => {
            let last = operands.pop().expect("at least one operand");
            match operands.pop() {
                Some(first) => of_two(name, first, last),
                None => of_one(name, last, qualifier),
            }
        }
    }
}

/// a ∘ b and b ∘ c and … for the operands of a comparison.
fn chain(function: Binary, operands: Vec<Expr>) -> Expr {
    let pairs = operands.windows(2).map(|pair| binary(function, pair[0].clone(), pair[1].clone())).collect();
    join(Binary::And, pairs, 1.0)
}

/// Minus of one operand, or the difference of two.
fn minus(mut operands: Vec<Expr>) -> Expr {
    let last = operands.pop().expect("one or two operands");
    match operands.pop() {
        Some(first) => binary(Binary::Sub, first, last),
        None => negative(last),
    }
}

/// The operands of a logical operator; a lone one that is a number becomes a truth.
fn truths(operands: Vec<Expr>) -> Vec<Expr> {
    match <[Expr; 1]>::try_from(operands) {
        Ok([lone]) => vec![binary(Binary::Ne, lone, number(0.0))],
        Err(operands) => operands,
    }
}

fn of_two(name: &str, a: Expr, b: Expr) -> Expr {
    match name {
        "neq" => binary(Binary::Ne, a, b),
        "divide" => binary(Binary::Div, a, b),
        "power" => binary(Binary::Pow, a, b),
        "rem" => binary(Binary::Rem, a, b),
        "implies" => binary(Binary::Or, unary(Unary::Not, a), b),
        // The quotient is cut towards zero, so that a = b·quotient + rem with a remainder of the sign of a.
        _ => {
            let ratio = binary(Binary::Div, a, b);
            let size = unary(Unary::Floor, unary(Unary::Abs, ratio.clone()));
            binary(Binary::Mul, unary(Unary::Sign, ratio), size)
        }
    }
}

fn of_one(name: &str, a: Expr, qualifier: Option<Expr>) -> Expr {
    match name {
        "not" => unary(Unary::Not, a),
        "log" => match qualifier {
            None | Some(Expr::Number(10.0)) => unary(Unary::Log10, a),
            Some(base) => quotient(unary(Unary::Ln, a), unary(Unary::Ln, base)),
        },
        "root" => match qualifier {
            None | Some(Expr::Number(2.0)) => unary(Unary::Sqrt, a),
            Some(Expr::Number(degree)) if degree % 2.0 == 1.0 || degree % 2.0 == -1.0 => odd_root(a, degree),
            Some(degree) => binary(Binary::Pow, a, quotient(number(1.0), degree)),
        },
        _ => {
            if let Some(function) = elementary(name) {
                unary(function, a)
            } else if let Some(function) = reciprocal(name) {
                binary(Binary::Div, number(1.0), unary(function, a))
            } else {
                let function = inverse_reciprocal(name).expect("a name whose number of operands is known");
                unary(function, binary(Binary::Div, number(1.0), a))
            }
        }
    }
}

/// A root of odd degree, which negative numbers have too.
fn odd_root(a: Expr, degree: f64) -> Expr {
    let size = binary(Binary::Pow, unary(Unary::Abs, a.clone()), number(1.0 / degree));
    binary(Binary::Mul, unary(Unary::Sign, a), size)
}

fn elementary(name: &str) -> Option<Unary> {
    Some(match name {
        "abs" => Unary::Abs,
        "exp" => Unary::Exp,
        "ln" => Unary::Ln,
        "floor" => Unary::Floor,
        "ceiling" => Unary::Ceil,
        "factorial" => Unary::Factorial,
        "sin" => Unary::Sin,
        "cos" => Unary::Cos,
        "tan" => Unary::Tan,
        "arcsin" => Unary::Asin,
        "arccos" => Unary::Acos,
        "arctan" => Unary::Atan,
        "sinh" => Unary::Sinh,
        "cosh" => Unary::Cosh,
        "tanh" => Unary::Tanh,
        "arcsinh" => Unary::Asinh,
        "arccosh" => Unary::Acosh,
        "arctanh" => Unary::Atanh,
        _ => return None,
    })
}

/// The function that is one over this one.
fn reciprocal(name: &str) -> Option<Unary> {
    Some(match name {
        "sec" => Unary::Cos,
        "csc" => Unary::Sin,
        "cot" => Unary::Tan,
        "sech" => Unary::Cosh,
        "csch" => Unary::Sinh,
        "coth" => Unary::Tanh,
        _ => return None,
    })
}

/// The function that has the same value at one over the operand.
fn inverse_reciprocal(name: &str) -> Option<Unary> {
    Some(match name {
        "arcsec" => Unary::Acos,
        "arccsc" => Unary::Asin,
        "arccot" => Unary::Atan,
        "arcsech" => Unary::Acosh,
        "arccsch" => Unary::Asinh,
        "arccoth" => Unary::Atanh,
        _ => return None,
    })
}
