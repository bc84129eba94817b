//! Writes an expression as a text that is read as the same expression.

use super::functions::{FUNCTIONS, Meaning};
use crate::equations::tree::{Binary, Expr, QuantityId, Unary};

/// The text of an expression; `name` gives the identifier of a quantity. What is not a number is written as 0/0.
pub fn write(expr: &Expr, name: &impl Fn(QuantityId) -> String) -> String {
    let mut text = String::new();
    part(expr, name, 0, &mut text);
    text
}

/// Sign of an operator, how strongly it binds, and what its right operand needs so as not to be parted.
fn sign(operator: Binary) -> Option<(&'static str, u8, u8)> {
    Some(match operator {
        Binary::Or => (" or ", 1, 2),
        Binary::Xor => (" xor ", 1, 2),
        Binary::And => (" and ", 3, 4),
        Binary::Lt => (" < ", 6, 7),
        Binary::Le => (" <= ", 6, 7),
        Binary::Gt => (" > ", 6, 7),
        Binary::Ge => (" >= ", 6, 7),
        Binary::Eq => (" == ", 6, 7),
        Binary::Ne => (" != ", 6, 7),
        Binary::Add => (" + ", 8, 9),
        Binary::Sub => (" - ", 8, 9),
        Binary::Mul => ("*", 9, 10),
        Binary::Div => ("/", 9, 10),
        Binary::Pow => ("^", 13, 13),
        Binary::Min | Binary::Max | Binary::Rem | Binary::Quotient => return None,
    })
}

/// Writes a part whose neighbours bind with `strength`.
fn part(expr: &Expr, name: &impl Fn(QuantityId) -> String, strength: u8, text: &mut String) {
    match expr {
        Expr::Number(value) => number(*value, strength, text),
        Expr::Time => text.push_str("time"),
        Expr::Quantity(number) => text.push_str(&name(*number)),
        Expr::Unary(Unary::Neg, a) => {
            bracketed(strength > 10, text, |text| {
                text.push('-');
                // A bare number would swallow the minus.
                let is_number = matches!(**a, Expr::Number(_));
                bracketed(is_number, text, |text| part(a, name, if is_number { 0 } else { 10 }, text));
            });
        }
        Expr::Unary(Unary::Not, a) => bracketed(strength > 5, text, |text| {
            text.push_str("not ");
            part(a, name, 5, text);
        }),
        Expr::Unary(function, a) => call(one(*function), &[a], name, text),
        Expr::Binary(operator, a, b) => match sign(*operator) {
            Some((sign, own, right)) => {
                // Comparisons do not follow each other.
                let left = if own == 6 {
                    7
                } else if own == 13 {
                    14
                } else {
                    own
                };
                bracketed(strength > own, text, |text| {
                    part(a, name, left, text);
                    text.push_str(sign);
                    part(b, name, right, text);
                });
            }
            None => call(two(*operator), &[a, b], name, text),
        },
        Expr::Piecewise { branches, otherwise } => {
            let mut arguments: Vec<&Expr> = branches.iter().flat_map(|(condition, value)| [value, condition]).collect();
            arguments.push(otherwise);
            // Without a condition it is its last value; one that never holds keeps the form.
            if branches.is_empty() {
                arguments.splice(0..0, [otherwise.as_ref(), &Expr::Number(0.0)]);
            }
            call("piecewise", &arguments, name, text);
        }
        Expr::Delay(value, delay) => call("delay", &[value, delay], name, text),
        // The value of an unknown is its name: writers of documents write the equations that determine it.
        Expr::Root(equations, index) => text.push_str(&name(equations.unknowns[*index as usize])),
    }
}

fn bracketed(needed: bool, text: &mut String, inner: impl FnOnce(&mut String)) {
    if needed {
        text.push('(');
    }
    inner(text);
    if needed {
        text.push(')');
    }
}

fn number(value: f64, strength: u8, text: &mut String) {
    if value.is_nan() {
        text.push_str("(0/0)");
    } else if value.is_infinite() {
        bracketed(value < 0.0, text, |text| text.push_str(if value < 0.0 { "-infinity" } else { "infinity" }));
    } else {
        let size = value.abs();
        let long = size != 0.0 && !(1e-4..1e15).contains(&size);
        let written = if long { format!("{value:e}") } else { format!("{value}") };
        // A sign binds weaker than a power, and a minus after an operator reads badly.
        bracketed(strength > 8 && value.is_sign_negative(), text, |text| text.push_str(&written));
    }
}

fn call(function: &str, arguments: &[&Expr], name: &impl Fn(QuantityId) -> String, text: &mut String) {
    text.push_str(function);
    text.push('(');
    for (index, argument) in arguments.iter().enumerate() {
        if index > 0 {
            text.push_str(", ");
        }
        part(argument, name, 0, text);
    }
    text.push(')');
}

fn one(wanted: Unary) -> &'static str {
    let is = |meaning: Meaning| matches!(meaning, Meaning::One(function) if function == wanted);
    FUNCTIONS.iter().find(|known| is(known.meaning)).map_or("unknown", |known| known.name)
}

fn two(wanted: Binary) -> &'static str {
    let is =
        |meaning: Meaning| matches!(meaning, Meaning::Two(function) | Meaning::Many(function) if function == wanted);
    FUNCTIONS.iter().find(|known| is(known.meaning)).map_or("unknown", |known| known.name)
}
