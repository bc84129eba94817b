//! Reads "5.3 uN/m": a number, then units with prefixes and powers.

use super::dimension::Dimension;
use super::symbols::{ONE, Scale, meant, unit};
use std::ops::Range;

/// A quantity read from a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value in base units.
    pub value: f64,
    /// What it is.
    pub dimension: Dimension,
}

/// Why a text is not a quantity.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}; {help}")]
pub struct UnitError {
    /// What was found.
    pub message: String,
    /// What was expected and what to do.
    pub help: String,
    /// The bytes of the text that are at fault.
    pub at: Range<usize>,
}

/// Reads a quantity: a number, then units.
///
/// Units are multiplied by a space, `*` or `·`, divided by `/`, raised by `^2` or `²`. After a `/` only one unit or a
/// bracket may follow, because "pN/um s" means different things to different people.
///
/// # Errors
/// Says what is wrong and where: no number, an unknown unit, an ambiguous product.
pub fn parse(text: &str) -> Result<Measured, UnitError> {
    parse_like(text, "5 um")
}

/// Reads a quantity; `example` stands in the advice to a text that is none at all.
fn parse_like(text: &str, example: &str) -> Result<Measured, UnitError> {
    let (number, start) = split_number(text, example)?;
    let scale = Units { text, position: start, divided: false }.whole()?;
    measured(&number, scale, text)
}

/// Reads a quantity that must have the given dimension, and returns its value in base units. Zero needs no unit.
///
/// # Errors
/// As [`parse`], and when it is something else: "is a speed; a length was expected".
pub fn parse_as(text: &str, expected: Dimension) -> Result<f64, UnitError> {
    let found = parse_like(text, &expected.example())?;
    // Nothing is nothing in every unit.
    if found.dimension == expected || found.dimension == Dimension::NUMBER && found.value == 0.0 {
        return Ok(found.value);
    }
    let (message, help) = if found.dimension == Dimension::NUMBER {
        let unit = expected.example().split_once(' ').map_or(String::new(), |(_, unit)| unit.to_owned());
        let meant = format!("{} {unit}", text.trim());
        (
            format!("\"{text}\" has no unit; {} was expected", expected.with_article()),
            format!("{} needs a unit, such as \"{meant}\"", expected.with_article()),
        )
    } else {
        let help = format!("write {}, such as \"{}\"", expected.with_article(), expected.example());
        let (found, expected) = (found.dimension.with_article(), expected.with_article());
        (format!("\"{text}\" is {found}; {expected} was expected"), help)
    };
    Err(UnitError { message, help, at: 0..text.len() })
}

/// Reads a unit without a number ("um") and returns how many base units it holds.
///
/// # Errors
/// As [`parse`].
pub fn parse_unit(text: &str) -> Result<Measured, UnitError> {
    if text.trim().is_empty() {
        return Err(UnitError {
            message: "no unit".into(),
            help: "write one, such as \"um\"".into(),
            at: 0..text.len(),
        });
    }
    let scale = Units { text, position: 0, divided: false }.whole()?;
    measured("1", scale, text)
}

/// Puts number and scale together. The power of ten goes into the number's own text, so that the result is the
/// double nearest to the decimal that the user meant.
fn measured(number: &str, scale: Scale, text: &str) -> Result<Measured, UnitError> {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let exponent = exponent.parse::<i32>().unwrap_or(0).saturating_add(scale.ten);
    let decimal = format!("{mantissa}e{exponent}").parse::<f64>().unwrap_or(f64::NAN);
    let value = decimal * scale.numerator / scale.divisor;
    if value.is_finite() {
        return Ok(Measured { value, dimension: scale.dimension });
    }
    let help = "write a number between 1e-300 and 1e300 in µm, s and pN".to_owned();
    Err(UnitError { message: format!("\"{text}\" is too large a number"), help, at: 0..text.len() })
}

/// Splits the leading number off; returns it in a form that `f64` reads, and where the rest starts.
fn split_number(text: &str, example: &str) -> Result<(String, usize), UnitError> {
    let start = text.len() - text.trim_start().len();
    let mut number = String::new();
    let mut end = start;
    for (offset, c) in text[start..].char_indices() {
        let digits = number.chars().any(|c| c.is_ascii_digit());
        let rest = &text[start + offset + c.len_utf8()..];
        let accepted = match c {
            '0'..='9' | '.' => true,
            '+' | '-' | '−' => number.is_empty() || number.ends_with('e'),
            'e' | 'E' => digits && !number.contains('e') && starts_exponent(rest),
            _ => false,
        };
        if !accepted {
            break;
        }
        number.push(match c {
            '−' => '-',
            'E' => 'e',
            c => c,
        });
        end = start + offset + c.len_utf8();
    }
    let fault = |message: String, help: &str, at: Range<usize>| Err(UnitError { message, help: help.to_owned(), at });
    if number.is_empty() {
        let message = format!("\"{text}\" does not begin with a number");
        return fault(message, &format!("write a number and a unit, such as \"{example}\""), 0..text.len());
    }
    if text[end..].starts_with(',') {
        let message = format!("\"{text}\" has a comma in its number");
        let help = format!("write a decimal point: \"{}\"", text.replacen(',', ".", 1));
        return fault(message, &help, end..end + 1);
    }
    if number.parse::<f64>().is_err() {
        let message = format!("\"{}\" is not a number", &text[start..end]);
        return fault(message, "write it such as \"5\", \"0.2\" or \"1e-19\"", start..end);
    }
    Ok((number, end))
}

/// Whether an exponent's sign and digits follow an `e`.
fn starts_exponent(rest: &str) -> bool {
    rest.trim_start_matches(['+', '-', '−']).starts_with(|c: char| c.is_ascii_digit())
}

/// Reads units from left to right.
struct Units<'a> {
    text: &'a str,
    position: usize,
    /// A `/` was passed on the present level of brackets.
    divided: bool,
}

impl Units<'_> {
    fn rest(&self) -> &str {
        &self.text[self.position..]
    }

    fn skip_spaces(&mut self) {
        self.position = self.text.len() - self.rest().trim_start().len();
    }

    /// Takes `c` if it is next.
    fn take(&mut self, c: char) -> bool {
        let found = self.rest().starts_with(c);
        if found {
            self.position += c.len_utf8();
        }
        found
    }

    fn whole(mut self) -> Result<Scale, UnitError> {
        let scale = self.product()?;
        if self.rest().is_empty() {
            return Ok(scale);
        }
        Err(self.fault("an opening bracket is missing".into(), "write brackets in pairs, such as \"pN/(um s)\"", 1))
    }

    /// A product or quotient, up to the end or a closing bracket.
    fn product(&mut self) -> Result<Scale, UnitError> {
        let mut scale = ONE;
        let outer = std::mem::replace(&mut self.divided, false);
        let mut first = true;
        loop {
            self.skip_spaces();
            if self.rest().is_empty() || self.rest().starts_with(')') {
                break;
            }
            let start = self.position;
            let divides = self.take('/');
            if !divides {
                let sign = self.take('*') || self.take('·') || self.take('×');
                if sign && first {
                    return Err(self.fault("a unit is missing before the product sign".into(), "write \"pN um\"", 0));
                }
            }
            self.skip_spaces();
            let factor = self.factor()?;
            if self.divided && !divides {
                let help = "use brackets, \"pN/(um s)\", or a power, \"pN um^-1 s\"";
                let mut error = self.fault("a product after \"/\" can be read in two ways".into(), help, 0);
                error.at = start..self.position;
                return Err(error);
            }
            self.divided |= divides;
            scale = scale.times(factor.to_the(if divides { -1 } else { 1 }));
            first = false;
        }
        self.divided = outer;
        Ok(scale)
    }

    /// A unit or a bracket, with its power.
    fn factor(&mut self) -> Result<Scale, UnitError> {
        let scale = if self.take('(') {
            let inside = self.product()?;
            if !self.take(')') {
                return Err(self.fault("a closing bracket is missing".into(), "write \"pN/(um s)\"", 0));
            }
            inside
        } else {
            self.symbol()?
        };
        let power = self.power()?;
        Ok(scale.to_the(power))
    }

    fn symbol(&mut self) -> Result<Scale, UnitError> {
        let is_symbol = |c: char| c.is_alphabetic() && !"²³¹".contains(c) || "%°".contains(c);
        let rest = self.rest();
        let end = if rest.starts_with('1') { 1 } else { rest.find(|c| !is_symbol(c)).unwrap_or(rest.len()) };
        let symbol = rest[..end].to_owned();
        if symbol.is_empty() {
            let found = rest.chars().next().map_or("the end of the text".to_owned(), |c| format!("\"{c}\""));
            let length = rest.chars().next().map_or(0, char::len_utf8);
            return Err(self.fault(
                format!("{found} where a unit was expected"),
                "write a unit, such as \"um\"",
                length,
            ));
        }
        let Some(scale) = unit(&symbol) else {
            let help = match meant(&symbol) {
                Some(unit) => format!("did you mean \"{unit}\"?"),
                None => {
                    "units are m, s, min, h, N, g, J, Pa, l, Hz, rad, deg, % with prefixes such as k, m, u, n, p".into()
                }
            };
            return Err(self.fault(format!("unknown unit \"{symbol}\""), &help, end));
        };
        self.position += end;
        Ok(scale)
    }

    /// `^2`, `^-1`, `**2`, `²`, `⁻¹`; 1 if there is none.
    fn power(&mut self) -> Result<i32, UnitError> {
        let caret = self.take('^');
        let start = self.position;
        let mut digits = String::new();
        while let Some(c) = self.rest().chars().next() {
            let raised = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c).and_then(|index| "-0123456789".chars().nth(index));
            let plain = Some(c).filter(|c| caret && (c.is_ascii_digit() || *c == '-'));
            let Some(digit) = raised.or(plain) else { break };
            digits.push(digit);
            self.position += c.len_utf8();
        }
        if digits.is_empty() && !caret {
            return Ok(1);
        }
        match digits.parse::<i32>() {
            Ok(power) if power.abs() <= 9 => Ok(power),
            _ => {
                let mut error =
                    self.fault("the power of a unit is not a small whole number".into(), "write \"um^2\"", 0);
                error.at = start..self.position;
                Err(error)
            }
        }
    }

    /// A fault at the next `length` bytes.
    fn fault(&self, message: String, help: &str, length: usize) -> UnitError {
        UnitError { message, help: help.to_owned(), at: self.position..self.position + length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> f64 {
        parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).value
    }

    #[test]
    fn quantities_are_read_in_base_units_without_rounding_twice() {
        for (text, expected, dimension) in [
            ("5 um", 5.0, Dimension::LENGTH),
            ("100 nm", 0.1, Dimension::LENGTH),
            ("5.3 uN/m", 5.3, Dimension::LINE_STIFFNESS),
            ("2 pN/um", 2.0, Dimension::LINE_STIFFNESS),
            ("0.2 pN um", 0.2, Dimension::ENERGY),
            ("0.2 pN*um", 0.2, Dimension::ENERGY),
            ("0.2 pN·µm", 0.2, Dimension::ENERGY),
            ("1e-19 J", 0.1, Dimension::ENERGY),
            ("3 pN*s/um", 3.0, Dimension::DRAG),
            ("3 pN/(um/s)", 3.0, Dimension::DRAG),
            ("9.81 m/s^2", 9.81e6, Dimension::ACCELERATION),
            ("9.81 m/s²", 9.81e6, Dimension::ACCELERATION),
            ("9.81 m s⁻²", 9.81e6, Dimension::ACCELERATION),
            ("2 kPa", 2000.0, Dimension::STRESS),
            ("90 ml", 90e12, Dimension::VOLUME),
            ("90 fl", 90.0, Dimension::VOLUME),
            ("1 mg", 1.0, Dimension::MASS),
            ("1e-6 kg", 1.0, Dimension::MASS),
            ("37 %", 0.37, Dimension::NUMBER),
            ("37%", 0.37, Dimension::NUMBER),
            ("7.82um", 7.82, Dimension::LENGTH),
            ("7.82 μm", 7.82, Dimension::LENGTH),
            ("1.5 min", 90.0, Dimension::TIME),
            ("2 Hz", 2.0, Dimension::FREQUENCY),
            ("6 /min", 0.1, Dimension::FREQUENCY),
            ("1 1/s", 1.0, Dimension::FREQUENCY),
            ("6 dyn/cm", 6000.0, Dimension::LINE_STIFFNESS),
            ("−3 pN", -3.0, Dimension::FORCE),
            ("12", 12.0, Dimension::NUMBER),
            ("3 uM", 3.0, Dimension::CONCENTRATION),
            ("3 µmol/l", 3.0, Dimension::CONCENTRATION),
            ("2 nM", 0.002, Dimension::CONCENTRATION),
            ("2 fmol", 2e6, Dimension::AMOUNT),
            ("1 zmol/um^3", 1.0, Dimension::CONCENTRATION),
        ] {
            assert_eq!(parse(text), Ok(Measured { value: expected, dimension }), "{text}");
        }
        assert!((value("180 deg") - std::f64::consts::PI).abs() < 1e-15, "one rounding of pi");
    }

    #[test]
    fn a_fault_points_at_the_unit_and_says_what_was_meant() {
        for (text, at, told) in [
            ("5 umm", 2..5, "unknown unit \"umm\"; did you mean \"um\"?"),
            ("5 um/sec", 5..8, "unknown unit \"sec\"; did you mean \"s\"?"),
            ("5 PN", 2..4, "unknown unit \"PN\"; did you mean \"pN\"?"),
            ("5,3 um", 1..2, "\"5,3 um\" has a comma in its number; write a decimal point: \"5.3 um\""),
            ("um", 0..2, "\"um\" does not begin with a number; write a number and a unit, such as \"5 um\""),
            ("1.2.3 um", 0..5, "\"1.2.3\" is not a number; write it such as \"5\", \"0.2\" or \"1e-19\""),
            ("1 um^1.5", 6..7, "\".\" where a unit was expected"),
            ("1 um^x", 5..5, "the power of a unit is not a small whole number"),
            ("1 pN/um s", 8..9, "a product after \"/\" can be read in two ways"),
            ("1 pN/(um s", 10..10, "a closing bracket is missing"),
            ("1 pN)", 4..5, "an opening bracket is missing"),
            ("1e400 um", 0..8, "is too large a number"),
        ] {
            let error = parse(text).expect_err(text);
            assert_eq!(error.at, at, "{text}: {error}");
            assert!(error.to_string().contains(told), "{text}: {error}");
        }
        let error = parse_as("5 um/min", Dimension::LENGTH).expect_err("a speed is no length");
        assert_eq!(error.message, "\"5 um/min\" is a speed; a length was expected");
        assert_eq!(error.help, "write a length, such as \"5 um\"");
        let error = parse_as("5", Dimension::LENGTH).expect_err("a number is no length");
        assert_eq!(error.help, "a length needs a unit, such as \"5 um\"");
    }

    proptest! {
        #[test]
        fn any_value_written_in_base_units_is_read_back_exactly(
            value in -1e12f64..1e12, length in -3i8..4, time in -3i8..4, force in -2i8..3,
        ) {
            let dimension = Dimension::of(length, time, force);
            let text = format!("{value} {}", dimension.base_unit());
            prop_assert_eq!(parse(&text), Ok(Measured { value, dimension }), "{}", text);
        }

        #[test]
        fn any_text_is_read_or_refused_within_its_bounds(text in "\\PC{0,24}") {
            if let Err(error) = parse(&text) {
                prop_assert!(text.get(error.at.clone()).is_some(), "{:?} in {:?}", error, text);
            }
        }

        #[test]
        fn texts_made_of_unit_letters_never_panic(text in "[0-9eE.+µmunpNsJ/ ()^²*-]{0,16}") {
            if let Err(error) = parse(&text) {
                prop_assert!(text.get(error.at.clone()).is_some(), "{:?} in {:?}", error, text);
            }
        }
    }
}
