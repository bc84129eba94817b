//! Ranges of numbers, divided by differences or by ratios.

use super::document::Spacing;
use super::value::rounded;
use crate::elementary::{exp, ln};

/// A range of numbers in the unit of its column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The lower end.
    pub from: f64,
    /// The upper end.
    pub to: f64,
    /// How it is divided.
    pub scale: Spacing,
    /// Whether numbers are rounded to whole ones.
    pub whole: bool,
}

impl Range {
    /// The number at a share of the range, 0 at its lower and 1 at its upper end, as tables show it.
    pub fn at(&self, share: f64) -> String {
        let Self { from, to, scale, whole } = *self;
        let value = match scale {
            _ if share == 0.0 => from,
            _ if share == 1.0 => to,
            Spacing::Linear => from + share * (to - from),
            // By our own functions, so that the number is the same on every machine.
            Spacing::Log => exp(ln(from) + share * (ln(to) - ln(from))),
        };
        rounded(if whole { value.round() } else { value }).to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_divided_in_their_own_unit_and_end_where_they_are_told() {
        let range = Range { from: 0.001, to: 0.1, scale: Spacing::Log, whole: false };
        let cells: Vec<String> = (0..5).map(|k| range.at(f64::from(k) / 4.0)).collect();
        assert_eq!(cells, ["0.001", "0.00316227766", "0.01", "0.0316227766", "0.1"]);
        let range = Range { from: 0.0, to: 0.3, scale: Spacing::Linear, whole: false };
        assert_eq!([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|share| range.at(share)), ["0", "0.1", "0.2", "0.3"]);
        let range = Range { whole: true, to: 9.0, ..range };
        assert_eq!([0.0, 0.25, 1.0].map(|share| range.at(share)), ["0", "2", "9"]);
    }
}
