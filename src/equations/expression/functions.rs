//! The functions and constants that every expression may use.

use crate::equations::tree::{Binary, Expr, Unary};

/// What a function does with its arguments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    One(Unary),
    Two(Binary),
    /// `log`: of one argument the natural logarithm, of two that of the second to the base of the first.
    Log,
    /// The smallest or largest of all arguments.
    Many(Binary),
    Piecewise,
    Hill,
    /// What the first was a time ago that the second tells.
    Delay,
    /// 1 from a time on for another, each time that a third has passed.
    Pulse,
}

/// What a function asks of the units of its arguments, and the unit of its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum UnitRule {
    /// Plain numbers in and out.
    Plain,
    /// An angle or a plain number in, a plain number out.
    OfAngle,
    /// The value has the unit of the argument or, of several, the one that they share.
    Same,
    /// Anything in, a plain number out.
    Any,
    Root,
    Power,
    Quotient,
    /// The first two share a unit, the third and the value are plain.
    Hill,
    Piecewise,
    /// Anything and a time in, the unit of the first out.
    Delay,
    /// Times in, a plain number out.
    Times,
}

/// A function.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) name: &'static str,
    pub(super) meaning: Meaning,
    pub(super) units: UnitRule,
    /// How it is written, for messages and for the book.
    pub(super) example: &'static str,
}

const fn one(name: &'static str, function: Unary, units: UnitRule, example: &'static str) -> Known {
    Known { name, meaning: Meaning::One(function), units, example }
}

const fn two(name: &'static str, function: Binary, units: UnitRule, example: &'static str) -> Known {
    Known { name, meaning: Meaning::Two(function), units, example }
}

/// All functions.
#[rustfmt::skip] // a table
pub(super) const FUNCTIONS: [Known; 36] = [
    one("exp", Unary::Exp, UnitRule::Plain, "exp(x)"),
    one("ln", Unary::Ln, UnitRule::Plain, "ln(x)"),
    Known { name: "log", meaning: Meaning::Log, units: UnitRule::Plain, example: "log(x) or log(base, x)" },
    one("log10", Unary::Log10, UnitRule::Plain, "log10(x)"),
    two("pow", Binary::Pow, UnitRule::Power, "pow(x, exponent)"),
    one("sqrt", Unary::Sqrt, UnitRule::Root, "sqrt(x)"),
    one("abs", Unary::Abs, UnitRule::Same, "abs(x)"),
    one("sign", Unary::Sign, UnitRule::Any, "sign(x)"),
    one("floor", Unary::Floor, UnitRule::Same, "floor(x)"),
    one("ceil", Unary::Ceil, UnitRule::Same, "ceil(x)"),
    one("sin", Unary::Sin, UnitRule::OfAngle, "sin(x)"),
    one("cos", Unary::Cos, UnitRule::OfAngle, "cos(x)"),
    one("tan", Unary::Tan, UnitRule::OfAngle, "tan(x)"),
    one("asin", Unary::Asin, UnitRule::Plain, "asin(x)"),
    one("acos", Unary::Acos, UnitRule::Plain, "acos(x)"),
    one("atan", Unary::Atan, UnitRule::Plain, "atan(x)"),
    one("sinh", Unary::Sinh, UnitRule::Plain, "sinh(x)"),
    one("cosh", Unary::Cosh, UnitRule::Plain, "cosh(x)"),
    one("tanh", Unary::Tanh, UnitRule::Plain, "tanh(x)"),
    one("asinh", Unary::Asinh, UnitRule::Plain, "asinh(x)"),
    one("acosh", Unary::Acosh, UnitRule::Plain, "acosh(x)"),
    one("atanh", Unary::Atanh, UnitRule::Plain, "atanh(x)"),
    one("heaviside", Unary::Heaviside, UnitRule::Any, "heaviside(x)"),
    one("factorial", Unary::Factorial, UnitRule::Plain, "factorial(n)"),
    Known { name: "min", meaning: Meaning::Many(Binary::Min), units: UnitRule::Same, example: "min(a, b, …)" },
    Known { name: "max", meaning: Meaning::Many(Binary::Max), units: UnitRule::Same, example: "max(a, b, …)" },
    two("rem", Binary::Rem, UnitRule::Same, "rem(a, b)"),
    two("quotient", Binary::Quotient, UnitRule::Quotient, "quotient(a, b)"),
    Known { name: "piecewise", meaning: Meaning::Piecewise, units: UnitRule::Piecewise,
        example: "piecewise(value, condition, …, otherwise)" },
    Known { name: "hill", meaning: Meaning::Hill, units: UnitRule::Hill, example: "hill(x, K, n)" },
    Known { name: "delay", meaning: Meaning::Delay, units: UnitRule::Delay, example: "delay(x, tau)" },
    Known { name: "pulse", meaning: Meaning::Pulse, units: UnitRule::Times, example: "pulse(start, duration, period)" },
    // Other spellings of the same.
    one("ceiling", Unary::Ceil, UnitRule::Same, "ceiling(x)"),
    one("arcsin", Unary::Asin, UnitRule::Plain, "arcsin(x)"),
    one("arccos", Unary::Acos, UnitRule::Plain, "arccos(x)"),
    one("arctan", Unary::Atan, UnitRule::Plain, "arctan(x)"),
];

/// Functions whose names identifiers may have as well, since documents had them before there was the function.
const YOUNG: [&str; 1] = ["pulse"];

/// Constants.
pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("infinity", f64::INFINITY)];

/// The name of the time.
pub(super) const TIME: &str = "time";

pub(super) fn known(name: &str) -> Option<&'static Known> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

/// Whether a document may not use the word as an identifier: a function, a constant, `time` or an operator.
pub fn is_reserved(word: &str) -> bool {
    let function = known(word).is_some() && !YOUNG.contains(&word);
    let constant = CONSTANTS.iter().any(|(name, _)| *name == word);
    let operator = super::token::WORDS.iter().any(|(name, _)| *name == word);
    function || constant || operator || word == TIME
}

/// Whether a word can be an identifier: letters, digits and `_`, not beginning with a digit.
pub fn is_identifier(word: &str) -> bool {
    word.starts_with(super::token::begins_name) && word.chars().all(super::token::continues_name)
}

/// Names of all built-in functions, for the book.
pub fn function_names() -> Vec<&'static str> {
    FUNCTIONS.iter().map(|function| function.name).collect()
}

impl Meaning {
    /// Whether the function takes this many arguments.
    pub(super) fn takes(self, count: usize) -> bool {
        match self {
            Self::One(_) => count == 1,
            Self::Two(_) | Self::Delay => count == 2,
            Self::Log => count == 1 || count == 2,
            // Each argument is a level of the expression.
            Self::Many(_) => (1..=100).contains(&count),
            Self::Piecewise => count >= 3 && count % 2 == 1,
            Self::Hill => count == 3,
            Self::Pulse => count == 2 || count == 3,
        }
    }

    /// The expression; the count of arguments has been checked.
    pub(super) fn apply(self, arguments: Vec<Expr>) -> Expr {
        let mut next = arguments.into_iter();
        let mut take = || next.next().unwrap_or(Expr::Number(0.0));
        match self {
            Self::One(function) => take().unary(function),
            Self::Two(function) => take().binary(function, take()),
            Self::Delay => Expr::Delay(Box::new(take()), Box::new(take())),
            Self::Log => {
                let first = take();
                match next.next() {
                    None => first.unary(Unary::Ln),
                    Some(of) => of.unary(Unary::Ln).binary(Binary::Div, first.unary(Unary::Ln)),
                }
            }
            Self::Many(function) => {
                let first = take();
                next.fold(first, |all, one| all.binary(function, one))
            }
            Self::Piecewise => {
                let mut rest: Vec<Expr> = next.collect();
                let otherwise = Box::new(rest.pop().unwrap_or(Expr::Number(0.0)));
                let pairs = rest.chunks(2).map(|pair| (pair[1].clone(), pair[0].clone()));
                Expr::Piecewise { branches: pairs.collect(), otherwise }
            }
            Self::Pulse => {
                let (start, duration) = (take(), take());
                pulse(&start, duration, next.next())
            }
            Self::Hill => {
                let (x, half, exponent) = (take(), take(), take());
                hill(x, half, exponent)
            }
        }
    }
}

/// xⁿ/(Kⁿ + xⁿ), the share of a receptor's states that n ligands hold.
fn hill(x: Expr, half: Expr, exponent: Expr) -> Expr {
    let bound = x.binary(Binary::Pow, exponent.clone());
    let free = half.binary(Binary::Pow, exponent);
    bound.clone().binary(Binary::Div, free.binary(Binary::Add, bound))
}

/// Whether the time is within one of the pulses that begin with the first. What switches is made of the time and the arguments alone, so
/// that the clock meets it.
fn pulse(start: &Expr, duration: Expr, period: Option<Expr>) -> Expr {
    let begun = Expr::Time.binary(Binary::Ge, start.clone());
    let since = Expr::Time.binary(Binary::Sub, start.clone());
    let since = match period {
        Some(period) => since.binary(Binary::Rem, period),
        None => since,
    };
    begun.binary(Binary::And, since.binary(Binary::Lt, duration))
}

impl Expr {
    /// A function of this.
    pub fn unary(self, function: Unary) -> Self {
        Self::Unary(function, Box::new(self))
    }

    /// An operator or function of this and another.
    pub fn binary(self, function: Binary, other: Self) -> Self {
        Self::Binary(function, Box::new(self), Box::new(other))
    }
}
