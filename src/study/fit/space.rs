//! Where the parameters of a fit are: as shares of their ranges, as numbers, as tables show them.

use super::document::FitDocument;
use crate::elementary::{exp, ln};
use crate::error::{Error, Fault, Result};
use crate::study::design::{Points, latin_hypercube};
use crate::study::document::{Anything, Spacing};
use crate::study::range::Range;
use crate::study::value::shown;
use crate::study::variation::{Column, Values, variations};

/// A parameter that is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What tables say of it.
    pub column: Column,
    /// From bound to bound. A share of it, of its logarithm where it is spaced by ratios, is what is sought: eq. (fit.2).
    pub range: Range,
    /// Where it starts, as a share.
    pub start: f64,
    /// How far it is changed for derivatives, as a share.
    pub step: f64,
}

impl Axis {
    /// The number at a share, in the unit of the column; beyond 0 and 1 beyond the bounds.
    pub fn value(&self, share: f64) -> f64 {
        let Range { from, to, scale, .. } = self.range;
        match scale {
            Spacing::Linear => from + share * (to - from),
            Spacing::Log => exp(ln(from) + share * (ln(to) - ln(from))),
        }
    }

    /// The share at which a number lies.
    pub fn share(&self, value: f64) -> f64 {
        let Range { from, to, scale, .. } = self.range;
        match scale {
            Spacing::Linear => (value - from) / (to - from),
            Spacing::Log => (ln(value) - ln(from)) / (ln(to) - ln(from)),
        }
    }

    /// Its name and a number with its unit, in words: `shear = 2.95 uN/m`.
    pub fn told(&self, value: f64) -> String {
        format!("{} = {}", self.column.name, self.with_unit(value))
    }

    /// A number with its unit, four digits.
    pub fn with_unit(&self, value: f64) -> String {
        let unit = self.column.kind.unit().filter(|unit| *unit != "1").map(|unit| format!(" {unit}"));
        format!("{}{}", four_digits(value), unit.unwrap_or_default())
    }
}

/// A number as words have it: four digits.
pub fn four_digits(value: f64) -> String {
    crate::error::short(format!("{value:.3e}").parse().unwrap_or(value))
}

/// All of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    /// In the order of the document.
    pub axes: Vec<Axis>,
}

impl Space {
    /// What the parameters of a fit can be.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of bounds, units, names and starts.
    pub fn of(document: &FitDocument) -> Result<Self> {
        let (mut axes, mut faults) = (Vec::new(), Vec::new());
        let said = document.fit.parameter.iter().enumerate();
        for ((number, parameter), variation) in said.zip(variations(&document.study)?) {
            let Values::Range(range) = variation.source else { continue };
            let mut axis = Axis { column: variation.column, range, start: 0.5, step: parameter.step };
            if let Some(start) = &parameter.start {
                match start_of(&axis, start) {
                    Ok(share) => axis.start = share,
                    Err(fault) => faults
                        .push(fault.at(document.location(&format!("parameter[{number}].start"), "cannot start here"))),
                }
            }
            axes.push(axis);
        }
        if faults.is_empty() { Ok(Self { axes }) } else { Err(Error::Input(faults)) }
    }

    /// A point as tables show it, and as runs have it: ten digits, so that the same point has the same run on every machine.
    pub fn cells(&self, point: &[f64]) -> Vec<String> {
        self.axes.iter().zip(point).map(|(axis, share)| axis.range.at(*share)).collect()
    }

    /// A point in words.
    pub fn told(&self, point: &[f64]) -> String {
        let told = self.axes.iter().zip(point).map(|(axis, share)| axis.told(axis.value(*share)));
        told.collect::<Vec<_>>().join(", ")
    }

    /// So many points to start from: the first is the declared one, the others are those of a Latin hypercube.
    pub fn starts(&self, number: u32, seed: u64) -> Vec<Vec<f64>> {
        let declared = self.axes.iter().map(|axis| axis.start).collect();
        let drawn = latin_hypercube(number - 1, self.axes.len(), seed);
        [declared].into_iter().chain(drawn).collect()
    }

    /// The same as the points of a study.
    pub fn points(&self, points: &[Vec<f64>]) -> Points {
        let columns = self.axes.iter().map(|axis| axis.column.clone()).collect();
        Points { columns, rows: points.iter().map(|point| self.cells(point)).collect() }
    }

    /// Points at which the experiment has to be possible: starts, and the first of them with each parameter at each bound.
    pub fn to_be_tried(&self, starts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut points = starts.to_vec();
        for axis in 0..self.axes.len() {
            for bound in [0.0, 1.0] {
                points.push(self.with(&starts[0], axis, bound));
            }
        }
        points
    }

    /// A point with one parameter elsewhere.
    pub fn with(&self, point: &[f64], axis: usize, share: f64) -> Vec<f64> {
        let mut moved = point.to_vec();
        moved[axis] = share;
        moved
    }
}

/// Where a declared start lies.
fn start_of(axis: &Axis, start: &Anything) -> std::result::Result<f64, Fault> {
    let (kind, cell) = shown(&start.0);
    let Range { from, to, .. } = axis.range;
    let key = &axis.column.key;
    let value: f64 = match cell.parse() {
        Ok(value) if kind == axis.column.kind => value,
        _ => {
            let like = axis.column.kind.unit().map_or("a plain number".into(), |unit| format!("a quantity in {unit}"));
            let fault =
                Fault::new(format!("`start` of `{key}` is {}; {like} was expected, as its bounds are", start.0));
            return Err(fault.help("write it like the bounds, in the same unit"));
        }
    };
    if !(from..=to).contains(&value) {
        let fault = Fault::new(format!("`{key}` starts at {cell}, and its bounds are {from} and {to}"));
        return Err(fault.help("start between the bounds, or leave `start` out to start in the middle"));
    }
    Ok(axis.share(value).clamp(0.0, 1.0))
}
