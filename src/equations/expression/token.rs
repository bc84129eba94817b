//! Cuts the text of an expression into numbers, names and signs.

use super::Trouble;
use std::ops::Range;

/// What a piece of the text is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    /// A number and, in square brackets, its unit.
    Number(f64, Option<String>),
    Name(String),
    /// An operator, in its plain spelling: "<=" also for "≤" and `le`.
    Sign(&'static str),
}

/// A piece of the text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) at: Range<usize>,
}

/// Spellings of the signs; a longer one stands before those that begin it.
#[rustfmt::skip] // a table
const SIGNS: [(&str, &str); 23] = [
    ("&&", "and"), ("||", "or"), ("<=", "<="), (">=", ">="), ("==", "=="), ("!=", "!="), ("≤", "<="), ("≥", ">="),
    ("≠", "!="), ("<", "<"), (">", ">"), ("!", "not"), ("+", "+"), ("-", "-"), ("−", "-"), ("*", "*"), ("·", "*"),
    ("×", "*"), ("/", "/"), ("^", "^"), ("(", "("), (")", ")"), (",", ","),
];

/// Words that are signs, so that documents need not escape `<` and `&`.
#[rustfmt::skip] // a table
pub(super) const WORDS: [(&str, &str); 10] = [
    ("and", "and"), ("or", "or"), ("not", "not"), ("xor", "xor"), ("lt", "<"), ("le", "<="), ("gt", ">"), ("ge", ">="),
    ("eq", "=="), ("ne", "!="),
];

/// Signs of other languages, and what is written here.
const FOREIGN: [(&str, &str); 4] = [("**", "^"), ("=", "=="), ("&", "and"), ("|", "or")];

/// Cuts a text; what cannot be read is told and passed over.
pub(super) fn tokens(text: &str, troubles: &mut Vec<Trouble>) -> Vec<Token> {
    let mut found = Vec::new();
    let mut position = 0;
    while let Some(c) = text[position..].chars().next() {
        let start = position;
        let rest = &text[start..];
        if c.is_whitespace() {
            position += c.len_utf8();
        } else if c.is_ascii_digit() || c == '.' {
            position += number_length(rest);
            let (unit, length) = unit_after(&text[position..], position, troubles);
            let value = number(&text[start..position], start, troubles);
            position += length;
            found.push(Token { kind: Kind::Number(value, unit), at: start..position });
        } else if begins_name(c) {
            position += rest.find(|c| !continues_name(c)).unwrap_or(rest.len());
            let name = &text[start..position];
            let sign = WORDS.iter().find(|(word, _)| *word == name).map(|(_, sign)| Kind::Sign(sign));
            found.push(Token { kind: sign.unwrap_or_else(|| Kind::Name(name.to_owned())), at: start..position });
        } else if let Some((spelling, sign)) = foreign(rest).or_else(|| known_sign(rest)) {
            position += spelling.len();
            if foreign(rest).is_some() {
                troubles.push(
                    Trouble::new(format!("`{spelling}` is no sign of this language"), start..position)
                        .label(format!("write `{sign}`"))
                        .help(format!("write `{sign}` instead of `{spelling}`")),
                );
            }
            found.push(Token { kind: Kind::Sign(sign), at: start..position });
        } else {
            position += c.len_utf8();
            let help = "an expression holds numbers, names and + - * / ^ ( ) , < <= > >= == != and, or, not";
            troubles.push(
                Trouble::new(format!("`{c}` cannot stand in an expression"), start..position)
                    .label("unknown sign")
                    .help(help),
            );
        }
    }
    found
}

/// The foreign sign that a text begins with; "==" and its like are known ones.
fn foreign(rest: &str) -> Option<(&'static str, &'static str)> {
    let sign = FOREIGN.iter().find(|(spelling, _)| rest.starts_with(spelling)).copied()?;
    let known = ["==", "&&", "||"].iter().any(|known| rest.starts_with(known));
    (!known).then_some(sign)
}

fn known_sign(rest: &str) -> Option<(&'static str, &'static str)> {
    SIGNS.iter().copied().find(|(spelling, _)| rest.starts_with(spelling))
}

/// Whether a name may begin with the letter.
pub fn begins_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

/// Whether a name may go on with the letter.
pub fn continues_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Bytes of the number at the start: digits, points and an exponent.
fn number_length(rest: &str) -> usize {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let mantissa = digits(rest);
    let tail = &rest[mantissa..];
    if !tail.starts_with(['e', 'E']) {
        return mantissa;
    }
    let sign = usize::from(tail[1..].starts_with(['+', '-']));
    let exponent = &tail[1 + sign..];
    let length = exponent.find(|c: char| !c.is_ascii_digit()).unwrap_or(exponent.len());
    if length == 0 { mantissa } else { mantissa + 1 + sign + length }
}

fn number(text: &str, start: usize, troubles: &mut Vec<Trouble>) -> f64 {
    let at = start..start + text.len();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => return value,
        Ok(_) => troubles.push(
            Trouble::new(format!("the number {text} is not finite"), at)
                .label("beyond 1.8e308")
                .help("write a smaller number, or `infinity` if that is meant"),
        ),
        Err(_) => troubles.push(
            Trouble::new(format!("`{text}` is not a number"), at)
                .label("a number was expected")
                .help("write it such as 5, 0.2 or 1e-19"),
        ),
    }
    0.0
}

/// The unit in brackets after a number, and the bytes that it takes.
fn unit_after(rest: &str, start: usize, troubles: &mut Vec<Trouble>) -> (Option<String>, usize) {
    let blank = rest.len() - rest.trim_start().len();
    let Some(inner) = rest[blank..].strip_prefix('[') else { return (None, 0) };
    match inner.find(']') {
        Some(end) => (Some(inner[..end].to_owned()), blank + end + 2),
        None => {
            troubles.push(
                Trouble::new("the bracket of a unit is not closed", start + blank..start + blank + 1)
                    .label("opened here")
                    .help("write the unit of a number as in `0.1 [1/s]`"),
            );
            (None, blank + 1)
        }
    }
}
