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
    /// What its value is, in Markdown, for the book.
    about: &'static str,
}

const fn one(
    name: &'static str,
    function: Unary,
    units: UnitRule,
    example: &'static str,
    about: &'static str,
) -> Known {
    Known { name, meaning: Meaning::One(function), units, example, about }
}

const fn two(
    name: &'static str,
    function: Binary,
    units: UnitRule,
    example: &'static str,
    about: &'static str,
) -> Known {
    Known { name, meaning: Meaning::Two(function), units, example, about }
}

/// All functions.
#[rustfmt::skip] // a table
pub(super) const FUNCTIONS: [Known; 36] = [
    one("exp", Unary::Exp, UnitRule::Plain, "exp(x)", "The exponential."),
    one("ln", Unary::Ln, UnitRule::Plain, "ln(x)", "The natural logarithm."),
    Known { name: "log", meaning: Meaning::Log, units: UnitRule::Plain, example: "log(x) or log(base, x)",
        about: "The natural logarithm, or that to a base." },
    one("log10", Unary::Log10, UnitRule::Plain, "log10(x)", "The logarithm to the base 10."),
    two("pow", Binary::Pow, UnitRule::Power, "pow(x, exponent)", "A power, as `x^exponent`."),
    one("sqrt", Unary::Sqrt, UnitRule::Root, "sqrt(x)", "The square root."),
    one("abs", Unary::Abs, UnitRule::Same, "abs(x)", "The absolute value."),
    one("sign", Unary::Sign, UnitRule::Any, "sign(x)", "1, 0 or -1."),
    one("floor", Unary::Floor, UnitRule::Same, "floor(x)", "The largest whole number that is not above it."),
    one("ceil", Unary::Ceil, UnitRule::Same, "ceil(x)", "The smallest whole number that is not below it."),
    one("sin", Unary::Sin, UnitRule::OfAngle, "sin(x)", "The sine."),
    one("cos", Unary::Cos, UnitRule::OfAngle, "cos(x)", "The cosine."),
    one("tan", Unary::Tan, UnitRule::OfAngle, "tan(x)", "The tangent."),
    one("asin", Unary::Asin, UnitRule::Plain, "asin(x)", "The angle with this sine."),
    one("acos", Unary::Acos, UnitRule::Plain, "acos(x)", "The angle with this cosine."),
    one("atan", Unary::Atan, UnitRule::Plain, "atan(x)", "The angle with this tangent."),
    one("sinh", Unary::Sinh, UnitRule::Plain, "sinh(x)", "The hyperbolic sine."),
    one("cosh", Unary::Cosh, UnitRule::Plain, "cosh(x)", "The hyperbolic cosine."),
    one("tanh", Unary::Tanh, UnitRule::Plain, "tanh(x)", "The hyperbolic tangent."),
    one("asinh", Unary::Asinh, UnitRule::Plain, "asinh(x)", "The inverse of `sinh`."),
    one("acosh", Unary::Acosh, UnitRule::Plain, "acosh(x)", "The inverse of `cosh`."),
    one("atanh", Unary::Atanh, UnitRule::Plain, "atanh(x)", "The inverse of `tanh`."),
    one("heaviside", Unary::Heaviside, UnitRule::Any, "heaviside(x)", "0 below zero, else 1."),
    one("factorial", Unary::Factorial, UnitRule::Plain, "factorial(n)", "The factorial of the nearest whole number; infinite above 170."),
    Known { name: "min", meaning: Meaning::Many(Binary::Min), units: UnitRule::Same, example: "min(a, b, …)",
        about: "The smallest, of up to 100." },
    Known { name: "max", meaning: Meaning::Many(Binary::Max), units: UnitRule::Same, example: "max(a, b, …)",
        about: "The largest, of up to 100." },
    two("rem", Binary::Rem, UnitRule::Same, "rem(a, b)", "What is left of a divided by b, with the sign of a."),
    two("quotient", Binary::Quotient, UnitRule::Quotient, "quotient(a, b)", "The largest whole number that is not above a/b."),
    Known { name: "piecewise", meaning: Meaning::Piecewise, units: UnitRule::Piecewise,
        example: "piecewise(value, condition, …, otherwise)",
        about: "The value before the first condition that holds." },
    Known { name: "hill", meaning: Meaning::Hill, units: UnitRule::Hill, example: "hill(x, K, n)",
        about: "x^n/(K^n + x^n)." },
    Known { name: "delay", meaning: Meaning::Delay, units: UnitRule::Delay, example: "delay(x, tau)",
        about: "What x was the time tau ago: [delays](eml.md#delays)." },
    Known { name: "pulse", meaning: Meaning::Pulse, units: UnitRule::Times, example: "pulse(start, duration, period)",
        about: "1 from the start for the duration, again after each period if there is one, else 0: [schedules](eml.md#schedules)." },
    // Other spellings of the same.
    one("ceiling", Unary::Ceil, UnitRule::Same, "ceiling(x)", "As `ceil`."),
    one("arcsin", Unary::Asin, UnitRule::Plain, "arcsin(x)", "As `asin`."),
    one("arccos", Unary::Acos, UnitRule::Plain, "arccos(x)", "As `acos`."),
    one("arctan", Unary::Atan, UnitRule::Plain, "arctan(x)", "As `atan`."),
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

/// How all built-in functions are written, and what they are, in Markdown, for the book.
pub fn functions_in_words() -> impl Iterator<Item = (&'static str, &'static str)> {
    FUNCTIONS.iter().map(|function| (function.example, function.about))
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
