//! Small values that several parts of a document share: time courses, instants, colours.

use crate::units::{self, Dimension, Quantity, Time, UnitError, Written};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// A value that stays, or a course in time: straight between its points, constant before the first and after the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "course_of_{T}")]
pub enum Course<T> {
    /// The same value at all times.
    Constant(T),
    /// Points of time and value, times increasing: `[["0 s", "0 pN"], ["1 s", "16 pN"]]`.
    Points(Vec<(Time, T)>),
}

impl<const L: i8, const T: i8, const F: i8, const A: i8> Course<Quantity<L, T, F, A>> {
    /// The points of time (s) and value (base units); a constant is one point at 0 s.
    pub fn points(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Constant(value) => vec![(0.0, value.value())],
            Self::Points(points) => points.iter().map(|(time, value)| (time.value(), value.value())).collect(),
        }
    }
}

impl Course<f64> {
    /// The points of time (s) and value; a constant is one point at 0 s.
    pub fn points(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Constant(value) => vec![(0.0, *value)],
            Self::Points(points) => points.iter().map(|(time, value)| (time.value(), *value)).collect(),
        }
    }
}

/// One of something, or a list of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "one_or_many_{T}")]
pub enum OneOrMany<T> {
    /// A single one.
    One(T),
    /// A list.
    Many(Vec<T>),
}

impl<T> OneOrMany<T> {
    /// All of them.
    pub fn as_slice(&self) -> &[T] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Many(many) => many,
        }
    }
}

/// An axis of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis, upwards.
    Z,
}

/// An instant of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "String")]
pub enum When {
    /// The first frame.
    First,
    /// The last frame.
    #[default]
    Last,
    /// The frame nearest to this time.
    At(Time),
}

impl FromStr for When {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        match text {
            "first" => Ok(Self::First),
            "last" => Ok(Self::Last),
            _ => text.parse().map(Self::At),
        }
    }
}

impl fmt::Display for When {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::First => f.write_str("first"),
            Self::Last => f.write_str("last"),
            Self::At(time) => time.fmt(f),
        }
    }
}

impl TryFrom<Written> for When {
    type Error = UnitError;
    fn try_from(written: Written) -> Result<Self, UnitError> {
        written.0.parse()
    }
}

impl From<When> for String {
    fn from(when: When) -> Self {
        when.to_string()
    }
}

impl JsonSchema for When {
    fn schema_name() -> Cow<'static, str> {
        "when".into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        words_or_time(&["first", "last"])
    }
}

/// The schema of what is one of some words, or else a time.
pub(crate) fn words_or_time(words: &[&str]) -> Schema {
    json_schema!({
        "type": ["string", "integer"],
        "minimum": 0,
        "maximum": 0,
        "x-dimension": "time",
        "x-words": words,
        "examples": ["last", "12 s"],
    })
}

/// The length that one unit of a file's coordinates stands for, written as a unit: "um", "mm".
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct LengthUnit(f64);

impl LengthUnit {
    /// A unit of so many µm.
    pub const fn of_micrometres(length: f64) -> Self {
        Self(length)
    }

    /// Length of the unit, µm.
    pub const fn micrometres(self) -> f64 {
        self.0
    }
}

impl Default for LengthUnit {
    fn default() -> Self {
        Self(1.0)
    }
}

impl FromStr for LengthUnit {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let number_is_written = text.trim_start().starts_with(|c: char| c.is_ascii_digit());
        if number_is_written {
            return units::parse_as(text, Dimension::LENGTH).map(Self);
        }
        let unit = units::parse_unit(text)?;
        if unit.dimension == Dimension::LENGTH {
            return Ok(Self(unit.value));
        }
        let message = format!("\"{text}\" is a unit of {}; a unit of length was expected", unit.dimension.name());
        Err(UnitError { message, help: "write a unit of length, such as \"um\"".into(), at: 0..text.len() })
    }
}

impl TryFrom<String> for LengthUnit {
    type Error = UnitError;
    fn try_from(text: String) -> Result<Self, UnitError> {
        text.parse()
    }
}

impl From<LengthUnit> for String {
    fn from(unit: LengthUnit) -> Self {
        let named = [("um", 1.0), ("nm", 1e-3), ("mm", 1e3), ("cm", 1e4), ("m", 1e6)];
        let known = named.into_iter().find(|(_, size)| *size == unit.0);
        known.map_or_else(|| format!("{:e} um", unit.0), |(name, _)| name.to_owned())
    }
}

impl JsonSchema for LengthUnit {
    fn schema_name() -> Cow<'static, str> {
        "length_unit".into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "x-text": "length unit", "examples": ["um", "mm"] })
    }
}

/// Colours that have a name, as browsers and plotting libraries know them (CSS Color Module 4).
const NAMES: [(&str, u32); 36] = [
    ("black", 0x000000),
    ("blue", 0x0000ff),
    ("brown", 0xa52a2a),
    ("chocolate", 0xd2691e),
    ("coral", 0xff7f50),
    ("crimson", 0xdc143c),
    ("cyan", 0x00ffff),
    ("darkblue", 0x00008b),
    ("darkgreen", 0x006400),
    ("darkorange", 0xff8c00),
    ("darkred", 0x8b0000),
    ("gold", 0xffd700),
    ("gray", 0x808080),
    ("green", 0x008000),
    ("grey", 0x808080),
    ("indigo", 0x4b0082),
    ("lightblue", 0xadd8e6),
    ("lightgreen", 0x90ee90),
    ("lightgrey", 0xd3d3d3),
    ("lime", 0x00ff00),
    ("magenta", 0xff00ff),
    ("maroon", 0x800000),
    ("navy", 0x000080),
    ("olive", 0x808000),
    ("orange", 0xffa500),
    ("orchid", 0xda70d6),
    ("pink", 0xffc0cb),
    ("purple", 0x800080),
    ("red", 0xff0000),
    ("salmon", 0xfa8072),
    ("steelblue", 0x4682b4),
    ("teal", 0x008080),
    ("tomato", 0xff6347),
    ("turquoise", 0x40e0d0),
    ("violet", 0xee82ee),
    ("yellow", 0xffff00),
];

/// A colour, red, green and blue from 0 to 255, written "#c0392b", or as a name such as "steelblue".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Colour(pub [u8; 3]);

impl FromStr for Colour {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let fault = || {
            let near = NAMES.iter().map(|(name, _)| (strsim::damerau_levenshtein(name, text), name)).min();
            let meant = near.filter(|(apart, _)| *apart <= 2).map(|(_, name)| format!("did you mean \"{name}\"? "));
            UnitError {
                message: format!("\"{text}\" is not a colour"),
                help: format!(
                    "{}write # and six hexadecimal digits for red, green and blue, such as \"#c0392b\", or a name: {}",
                    meant.unwrap_or_default(),
                    NAMES.map(|(name, _)| name).join(", ")
                ),
                at: 0..text.len(),
            }
        };
        if let Some((_, number)) = NAMES.iter().find(|(name, _)| *name == text) {
            let [_, red, green, blue] = number.to_be_bytes();
            return Ok(Self([red, green, blue]));
        }
        let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6).ok_or_else(fault)?;
        if !digits.chars().all(|c| c.is_ascii_hexdigit()) {
            return Err(fault());
        }
        let number = u32::from_str_radix(digits, 16).map_err(|_| fault())?;
        let [_, red, green, blue] = number.to_be_bytes();
        Ok(Self([red, green, blue]))
    }
}

impl TryFrom<String> for Colour {
    type Error = UnitError;
    fn try_from(text: String) -> Result<Self, UnitError> {
        text.parse()
    }
}

impl From<Colour> for String {
    fn from(Colour([red, green, blue]): Colour) -> Self {
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}

impl JsonSchema for Colour {
    fn schema_name() -> Cow<'static, str> {
        "colour".into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let pattern = format!("^(#[0-9a-fA-F]{{6}}|{})$", NAMES.map(|(name, _)| name).join("|"));
        json_schema!({ "type": "string", "x-text": "colour", "pattern": pattern, "examples": ["#c0392b", "steelblue"] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_survives_its_own_text() {
        assert_eq!("#c0392B".parse(), Ok(Colour([0xc0, 0x39, 0x2b])));
        assert_eq!(String::from(Colour([0xc0, 0x39, 0x2b])), "#c0392b");
        assert_eq!("steelblue".parse(), Ok(Colour([0x46, 0x82, 0xb4])));
        assert!(
            "stealblue".parse::<Colour>().is_err_and(|fault| fault.help.starts_with("did you mean \"steelblue\"?"))
        );
        assert!("#c0392".parse::<Colour>().is_err() && "#+12345".parse::<Colour>().is_err());
    }

    #[test]
    fn a_unit_of_length_survives_its_own_text() {
        for text in ["um", "mm", "0.3 um", "2.5 nm"] {
            let unit: LengthUnit = text.parse().expect("a unit of length");
            assert_eq!(String::from(unit).parse(), Ok(unit), "{text}");
        }
        assert!("s".parse::<LengthUnit>().is_err());
    }
}
