//! A value of a parameter: as a table shows it, as `--set` takes it, and as a number.

use crate::units;
use serde::{Deserialize, Serialize};
use toml::Value;

/// What the values of a parameter are.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Kind {
    /// Numbers with a unit.
    Quantity {
        /// The unit as documents write it: `pN/um^2`.
        unit: String,
    },
    /// Plain numbers.
    Number,
    /// Words, names and paths.
    Text,
    /// Anything else, as TOML writes it: true or false, lists, tables.
    Other,
}

impl Kind {
    /// The unit of a column, if it has one.
    pub fn unit(&self) -> Option<&str> {
        match self {
            Self::Quantity { unit } => Some(unit),
            _ => None,
        }
    }

    /// Whether values are numbers that can stand along an axis.
    pub fn is_numeric(&self) -> bool {
        matches!(self, Self::Quantity { .. } | Self::Number)
    }

    /// What `--set` takes for a value that a table shows as `cell`.
    pub fn set_text(&self, cell: &str) -> String {
        match self {
            Self::Quantity { unit } => Value::String(format!("{cell} {unit}")).to_string(),
            Self::Text => Value::String(cell.to_owned()).to_string(),
            Self::Number | Self::Other => cell.to_owned(),
        }
    }
}

/// What a value is, and how a table shows it.
pub fn shown(value: &Value) -> (Kind, String) {
    match value {
        Value::Integer(number) => (Kind::Number, number.to_string()),
        Value::Float(number) => (Kind::Number, number.to_string()),
        Value::String(text) => match quantity(text) {
            Some((number, unit)) => (Kind::Quantity { unit }, number),
            None => (Kind::Text, text.clone()),
        },
        other => (Kind::Other, other.to_string()),
    }
}

/// A text of a quantity as its number and its unit; none for any other text.
fn quantity(text: &str) -> Option<(String, String)> {
    let measured = units::parse(text).ok()?;
    let text = text.trim().replace('−', "-");
    // The longest beginning that is a number, so that digits stay as they were written.
    let ends = text.char_indices().map(|(at, _)| at).skip(1);
    let split = ends.filter(|end| text[..*end].parse::<f64>().is_ok_and(f64::is_finite)).last()?;
    let (number, unit) = (text[..split].trim(), text[split..].trim());
    let whole = units::parse_unit(unit).ok()?;
    (whole.dimension == measured.dimension).then(|| (number.to_owned(), unit.to_owned()))
}

/// A number as tables of studies hold it: ten digits, so that 0.1 + 0.2 is 0.3 on every machine.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_units_stay_as_they_were_written() {
        let quantity = |number: &str, unit: &str| (Kind::Quantity { unit: unit.into() }, number.to_owned());
        let text = |text: &str| shown(&Value::String(text.into()));
        assert_eq!(text("0.050 pN/um^2"), quantity("0.050", "pN/um^2"));
        assert_eq!(text(" 1e-3um"), quantity("1e-3", "um"));
        assert_eq!(text("−5 um"), quantity("-5", "um"));
        assert_eq!(text("5 eggs"), (Kind::Text, "5 eggs".into()));
        assert_eq!(text("lattice"), (Kind::Text, "lattice".into()));
        assert_eq!(shown(&Value::Integer(3)), (Kind::Number, "3".into()));
        assert_eq!(shown(&Value::Float(0.5)), (Kind::Number, "0.5".into()));
        assert_eq!(shown(&Value::Boolean(true)), (Kind::Other, "true".into()));
    }

    #[test]
    fn what_a_table_shows_can_be_set() {
        for text in ["0.05 pN/um^2", "a \"quoted\" word", "meshes/cell.obj"] {
            let (kind, cell) = shown(&Value::String(text.into()));
            let set = format!("key = {}", kind.set_text(&cell));
            assert_eq!(set.parse::<toml::Table>().unwrap()["key"].as_str(), Some(text));
        }
        let list = Value::Array(vec![Value::Integer(1), Value::String("2 um".into())]);
        let (kind, cell) = shown(&list);
        assert_eq!(format!("key = {}", kind.set_text(&cell)).parse::<toml::Table>().unwrap()["key"], list);
    }

    #[test]
    fn ten_digits_are_kept() {
        assert_eq!(rounded(0.1 + 0.2), 0.3);
        assert_eq!(rounded(-1.234_567_890_12e-7), -1.234_567_89e-7);
    }
}
