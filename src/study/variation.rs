//! What each parameter of a study can be, worked out of what its document says.

use super::document::{Anything, Design, Parameter, Spacing, StudyDocument};
use super::range::Range;
use super::value::{Kind, shown};
use crate::error::{Error, Fault, Result, words};
use serde::{Deserialize, Serialize};

/// A parameter as a column of tables.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// What tables and charts call it.
    pub name: String,
    /// The key of the experiment.
    pub key: String,
    /// What its values are.
    #[serde(flatten)]
    pub kind: Kind,
    /// Whether it is spaced by ratios.
    pub log: bool,
}

impl Column {
    /// The title of the column: `contact.strength (pN/um^2)`.
    pub fn title(&self) -> String {
        titled(&self.name, self.kind.unit())
    }
}

/// A name with its unit, if it has one.
pub fn titled(name: &str, unit: Option<&str>) -> String {
    match unit {
        Some(unit) if unit != "1" && !unit.is_empty() => format!("{name} ({unit})"),
        _ => name.to_owned(),
    }
}

/// A parameter with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Its column.
    pub column: Column,
    /// Its values.
    pub source: Values,
}

/// The values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// These, as tables show them.
    Listed(Vec<String>),
    /// All of a range.
    Range(Range),
}

/// The parameters of a study.
///
/// # Errors
/// [`Error::Input`] with all faults, in the order of the text.
pub fn variations(document: &StudyDocument) -> Result<Vec<Variation>> {
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for (number, parameter) in document.study.parameter.iter().enumerate() {
        let reader = Reader { document, parameter, path: format!("parameter[{number}]") };
        let named = reader.name_fault(number);
        match (reader.read(), named) {
            (Ok(variation), None) => found.push(variation),
            (read, named) => faults.extend(read.err().into_iter().chain(named)),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(Error::Input(faults)) }
}

/// Names of columns that tables of studies have anyway.
const TAKEN: [&str; 8] = ["run", "point", "replicate", "seed", "output", "status", "version", "wall_time"];

struct Reader<'a> {
    document: &'a StudyDocument,
    parameter: &'a Parameter,
    path: String,
}

impl Reader<'_> {
    fn fault_at(&self, key: &str, label: &str, message: String, help: impl Into<String>) -> Fault {
        Fault::new(message).at(self.document.location(&format!("{}.{key}", self.path), label)).help(help)
    }

    /// That its name or its key is taken.
    fn name_fault(&self, number: usize) -> Option<Fault> {
        let (key, label) = (&self.parameter.key, self.parameter.label());
        if key == "seed" {
            let message = "the seed cannot be a parameter: replicates differ in it".to_owned();
            return Some(self.fault_at(
                "key",
                "not here",
                message,
                "give `replicates`, and `seed` for the study as a whole",
            ));
        }
        let others = &self.document.study.parameter[..number];
        let which = if self.parameter.name.is_some() { "name" } else { "key" };
        if others.iter().any(|other| other.key == *key) {
            let message = format!("`{key}` is varied twice");
            return Some(self.fault_at("key", "once more", message, "keep one of them, with all values"));
        }
        if others.iter().any(|other| other.label() == label) || TAKEN.contains(&label) || label.trim().is_empty() {
            let message = format!("two columns of tables would be named `{label}`");
            let help = "choose another `name` for the parameter";
            return Some(self.fault_at(which, "taken", message, help));
        }
        None
    }

    fn read(&self) -> std::result::Result<Variation, Fault> {
        let Parameter { values, from, to, .. } = self.parameter;
        let sampled = self.document.study.design.is_sampled();
        match (values, from, to) {
            (Some(values), None, None) if !sampled => self.listed(values),
            (None, Some(from), Some(to)) => self.range(from, to, sampled),
            (Some(_), None, None) => {
                let message = format!("`{}` has single values; this design takes ranges only", self.parameter.key);
                Err(self.fault_at(
                    "values",
                    "not with this design",
                    message,
                    "give `from` and `to`, or take a grid or a list",
                ))
            }
            (Some(_), ..) => {
                let message = format!("`{}` has values and a range", self.parameter.key);
                let key = if from.is_some() { "from" } else { "to" };
                Err(self.fault_at(key, "not beside `values`", message, "keep `values`, or `from` and `to`"))
            }
            (None, from, to) => {
                let lacks = match (from, to) {
                    (Some(_), _) => "`to`",
                    (_, Some(_)) => "`from`",
                    _ => "its values",
                };
                let message = format!("`{}` lacks {lacks}", self.parameter.key);
                let help =
                    "give `values = [\"1 um\", \"2 um\"]`, or a range: from = \"1 um\", to = \"5 um\", number = 5";
                Err(self.fault_at("key", "this parameter", message, help))
            }
        }
    }

    fn column(&self, kind: Kind) -> Column {
        let log = self.parameter.scale == Spacing::Log;
        Column { name: self.parameter.label().to_owned(), key: self.parameter.key.clone(), kind, log }
    }

    fn listed(&self, values: &[Anything]) -> std::result::Result<Variation, Fault> {
        for (key, is_there) in [("number", self.parameter.number.is_some()), ("whole", self.parameter.whole)] {
            if is_there {
                let message = format!("`{key}` goes with a range, and `{}` has values", self.parameter.key);
                return Err(self.fault_at(key, "without meaning", message, "leave it out, or give `from` and `to`"));
            }
        }
        let all: Vec<(Kind, String)> = values.iter().map(|value| shown(&value.0)).collect();
        // Nothing is nothing in every unit.
        let is_zero = |kind: &Kind, cell: &str| *kind == Kind::Number && cell.parse() == Ok(0.0);
        let first = all.iter().find(|(kind, cell)| !is_zero(kind, cell)).or(all.first());
        let Some(kind) = first.map(|(kind, _)| kind.clone()) else {
            return Err(self.fault_at("values", "nothing here", "no value".to_owned(), "give one at least"));
        };
        let mut cells: Vec<String> = Vec::new();
        for (number, (other, cell)) in all.into_iter().enumerate() {
            let at = format!("values[{number}]");
            if other != kind && !is_zero(&other, &cell) {
                let message = format!(
                    "`{}` has values of several kinds: {}, then {}",
                    self.parameter.key,
                    told(&kind),
                    told(&other)
                );
                return Err(self.fault_at(&at, "unlike the first", message, "write all values alike, in one unit"));
            }
            if cells.contains(&cell) {
                let message = format!("`{}` has the value {cell} twice", self.parameter.key);
                // In a list a value may come again beside another one of the other parameters.
                if self.document.study.design != Design::List {
                    return Err(self.fault_at(&at, "again", message, "leave it out; `replicates` repeats runs"));
                }
            }
            cells.push(cell);
        }
        Ok(Variation { column: self.column(kind), source: Values::Listed(cells) })
    }

    fn range(&self, from: &Anything, to: &Anything, sampled: bool) -> std::result::Result<Variation, Fault> {
        let Parameter { key, number, scale, whole, .. } = self.parameter;
        let [low, high] = [("from", from), ("to", to)].map(|(end, value)| {
            let (kind, cell) = shown(&value.0);
            match cell.parse::<f64>() {
                Ok(value) if kind.is_numeric() && value.is_finite() => Ok((kind, value)),
                _ => {
                    let message = format!("`{end}` of `{key}` is {}; a number was expected", told(&kind));
                    let help = "a range goes from a number to a number, such as \"1 um\" to \"5 um\"; words are listed in `values`";
                    Err(self.fault_at(end, "no number", message, help))
                }
            }
        });
        let ((kind, from), (other, to)) = (low?, high?);
        let kind = match (kind, other) {
            (one, other) if one == other => one,
            (Kind::Number, other) if from == 0.0 => other,
            (one, Kind::Number) if to == 0.0 => one,
            (one, other) => {
                let message = format!("the range of `{key}` goes from {} to {}", told(&one), told(&other));
                return Err(self.fault_at("to", "another unit", message, "write both ends in one unit"));
            }
        };
        if from >= to {
            let message = format!("the range of `{key}` goes from {from} to {to}");
            return Err(self.fault_at("to", "not above `from`", message, "write the smaller number first"));
        }
        if *scale == Spacing::Log && from <= 0.0 {
            let message = format!("the range of `{key}` has equal ratios and begins at {from}");
            let help = "begin above 0, or leave out `scale = \"log\"`";
            return Err(self.fault_at("from", "must be above 0", message, help));
        }
        let range = Range { from, to, scale: *scale, whole: *whole };
        let column = self.column(kind);
        match (number, sampled) {
            (None, true) => Ok(Variation { column, source: Values::Range(range) }),
            (Some(_), true) => {
                let message = format!("`{key}` has a `number`; this design has one for all parameters");
                Err(self.fault_at(
                    "number",
                    "not with this design",
                    message,
                    "leave it out: `design.number` says how many points there are",
                ))
            }
            (Some(number), false) => self.divided(column, range, *number),
            (None, false) => {
                let message = format!("the range of `{key}` lacks `number`");
                Err(self.fault_at(
                    "from",
                    "how many values?",
                    message,
                    "add how many values it has, its ends included: number = 5",
                ))
            }
        }
    }

    /// The values of a range that is divided into equal parts.
    fn divided(&self, column: Column, range: Range, number: u32) -> std::result::Result<Variation, Fault> {
        let cells: Vec<String> = (0..number).map(|k| range.at(f64::from(k) / f64::from(number - 1))).collect();
        if let Some(pair) = cells.windows(2).find(|pair| pair[0] == pair[1]) {
            let message = format!("{number} values of `{}` are not all different: {} comes twice", column.key, pair[0]);
            return Err(self.fault_at("number", "too many", message, "ask for fewer, or for a wider range"));
        }
        Ok(Variation { column, source: Values::Listed(cells) })
    }
}

/// What a value is, in words.
fn told(kind: &Kind) -> String {
    match kind {
        Kind::Quantity { unit } => format!("a quantity in {}", words::any_of([unit.as_str()])),
        Kind::Number => "a plain number".to_owned(),
        Kind::Text => "a text".to_owned(),
        Kind::Other => "neither number nor text".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_titled_with_its_unit() {
        assert_eq!(titled("adhesion", Some("pN/um^2")), "adhesion (pN/um^2)");
        assert_eq!(titled("number", None), "number");
        assert_eq!(titled("share", Some("1")), "share");
    }
}
