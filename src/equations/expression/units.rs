//! Checks the units of an expression where its quantities have them. Numbers stay as the document writes them, so not
//! only kinds must agree (a speed is no length) but sizes too (µM/min is not µM/s): nothing is converted silently.

use super::Trouble;
use super::functions::{CONSTANTS, TIME, UnitRule, known};
use super::resolve::Scope;
use super::syntax::{Node, NodeKind};
use super::unit::Unit;
use crate::equations::tree::Binary;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

/// What is known of an expression's unit.
#[derive(Debug, Clone, PartialEq)]
pub enum Measure {
    /// Something without a unit takes part: nothing is checked.
    Unknown,
    /// A plain 0 or infinity, which fits everywhere.
    Fitting,
    /// This unit.
    Known(Unit),
}

/// What is needed to check units.
#[derive(Debug, Clone)]
pub struct UnitScope<'a> {
    /// Units of the quantities; those without a unit are absent.
    pub units: &'a HashMap<String, Unit>,
    /// The document's functions.
    pub scope: &'a Scope,
    /// The unit of time, where there is one.
    pub time: Option<&'a Unit>,
}

impl UnitScope<'_> {
    /// Checks an expression and tells its unit. The names must have been resolved without fault.
    pub fn measure(&self, node: &Node, troubles: &mut Vec<Trouble>) -> Measure {
        self.measure_with(node, &BTreeMap::new(), troubles)
    }

    /// As [`UnitScope::measure`], with names of known units besides.
    pub fn measure_with(&self, node: &Node, names: &BTreeMap<String, Measure>, troubles: &mut Vec<Trouble>) -> Measure {
        Check { scope: self, troubles, arguments: BTreeMap::new() }.measure(node, names)
    }

    /// Checks an expression that must have a unit; `what` it is for stands in the message.
    pub fn expect(&self, node: &Node, expected: &Unit, what: &str, troubles: &mut Vec<Trouble>) {
        if let Measure::Known(found) = self.measure(node, troubles)
            && !found.is_same(expected)
        {
            troubles.push(mismatch(&found, expected, what, node.at.clone()));
        }
    }
}

/// A unit that was found where another was expected.
pub(super) fn mismatch(found: &Unit, expected: &Unit, what: &str, at: Range<usize>) -> Trouble {
    Trouble::new(format!("{what} is {}; {} was expected", found.told(), expected.wanted()), at)
        .label(found.told())
        .help(expected.advice(found))
}

/// Whether a part is a number without a unit, which is taken in the unit that is expected.
fn is_number(node: &Node) -> bool {
    matches!(node.kind, NodeKind::Number(_, None))
}

struct Check<'a, 'b> {
    scope: &'a UnitScope<'a>,
    troubles: &'b mut Vec<Trouble>,
    /// Of the arguments of the function that is looked into, what was written where it is called.
    arguments: BTreeMap<String, String>,
}

type Names = BTreeMap<String, Measure>;

impl Check<'_, '_> {
    fn measure(&mut self, node: &Node, names: &Names) -> Measure {
        match &node.kind {
            NodeKind::Unread => Measure::Unknown,
            NodeKind::Number(value, None) if *value == 0.0 => Measure::Fitting,
            NodeKind::Number(_, None) => Measure::Known(Unit::plain()),
            NodeKind::Number(_, Some(unit)) => self.literal(unit, &node.at),
            NodeKind::Name(name) => self.name(name, names),
            NodeKind::Minus(a) => self.measure(a, names),
            NodeKind::Not(a) => {
                self.measure(a, names);
                Measure::Known(Unit::plain())
            }
            NodeKind::Binary(operator, a, b) => self.binary(*operator, a, b, names),
            NodeKind::Call(name, _, arguments) => self.call(name, arguments, &node.at, names),
        }
    }

    fn literal(&mut self, unit: &str, at: &Range<usize>) -> Measure {
        match Unit::read(unit) {
            Ok(unit) => Measure::Known(unit),
            Err(error) => {
                self.troubles.push(Trouble::new(error.message, at.clone()).label("this unit").help(error.help));
                Measure::Unknown
            }
        }
    }

    fn name(&mut self, name: &str, names: &Names) -> Measure {
        if let Some(measure) = names.get(name) {
            return measure.clone();
        }
        if self.scope.scope.quantities.contains_key(name) {
            return self.scope.units.get(name).map_or(Measure::Unknown, |unit| Measure::Known(unit.clone()));
        }
        if name == TIME {
            return self.scope.time.map_or(Measure::Unknown, |unit| Measure::Known(unit.clone()));
        }
        match CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            Some((_, value)) if value.is_infinite() => Measure::Fitting,
            _ => Measure::Known(Unit::plain()),
        }
    }

    fn binary(&mut self, operator: Binary, a: &Node, b: &Node, names: &Names) -> Measure {
        match operator {
            Binary::Mul | Binary::Div => {
                let (left, right) = (self.measure(a, names), self.measure(b, names));
                let power = if operator == Binary::Mul { 1.0 } else { -1.0 };
                match (left, right) {
                    (Measure::Known(left), Measure::Known(right)) => Measure::Known(left.times(&right.to_the(power))),
                    (Measure::Unknown, _) | (_, Measure::Unknown) => Measure::Unknown,
                    _ => Measure::Fitting,
                }
            }
            Binary::Pow => self.power(a, b, names),
            Binary::And | Binary::Or | Binary::Xor => {
                self.measure(a, names);
                self.measure(b, names);
                Measure::Known(Unit::plain())
            }
            Binary::Lt | Binary::Le | Binary::Gt | Binary::Ge | Binary::Eq | Binary::Ne => {
                self.shared(&[a, b], names);
                Measure::Known(Unit::plain())
            }
            Binary::Quotient => {
                self.shared(&[a, b], names);
                Measure::Known(Unit::plain())
            }
            Binary::Add | Binary::Sub | Binary::Min | Binary::Max | Binary::Rem => self.shared(&[a, b], names),
        }
    }

    /// The unit that parts share; a part in another unit than the first known one is told.
    fn shared(&mut self, parts: &[&Node], names: &Names) -> Measure {
        let mut common: Option<Unit> = None;
        let mut unknown = false;
        for part in parts {
            match (self.measure(part, names), &common) {
                (Measure::Unknown, _) => unknown = true,
                (Measure::Fitting, _) => {}
                (Measure::Known(unit), None) => common = Some(unit),
                (Measure::Known(unit), Some(first)) if !unit.is_same(first) => {
                    self.troubles.push(mismatch(&unit, first, "this part", part.at.clone()));
                    return Measure::Unknown;
                }
                (Measure::Known(_), Some(_)) => {}
            }
        }
        match common {
            _ if unknown => Measure::Unknown,
            Some(unit) => Measure::Known(unit),
            None => Measure::Fitting,
        }
    }

    /// A part that must be a plain number, or an angle where `angle` says so.
    fn plain(&mut self, node: &Node, names: &Names, angle: Option<&Unit>, what: &str) {
        if let Measure::Known(unit) = self.measure(node, names)
            && !unit.is_same(&Unit::plain())
            && angle.is_none_or(|angle| !unit.is_same(angle))
        {
            let trouble = mismatch(&unit, &Unit::plain(), what, node.at.clone());
            let is_raised = unit.is_raised();
            self.troubles.push(if is_raised {
                trouble
            } else {
                trouble.help("divide it by a quantity in the same unit")
            });
        }
    }

    /// A part that must be a time; a number alone is one.
    fn time(&mut self, node: &Node, names: &Names, what: &str) {
        if let (Measure::Known(unit), Some(time)) = (self.measure(node, names), self.scope.time)
            && !unit.is_same(time)
            && !is_number(node)
        {
            self.troubles.push(mismatch(&unit, time, what, node.at.clone()));
        }
    }

    fn power(&mut self, base: &Node, exponent: &Node, names: &Names) -> Measure {
        let unit = self.measure(base, names);
        let told = self.troubles.len();
        self.plain(exponent, names, None, "the exponent");
        if self.troubles.len() > told {
            return Measure::Unknown;
        }
        match (unit, &exponent.kind) {
            (Measure::Known(unit), NodeKind::Number(power, None)) => Measure::Known(unit.to_the(*power)),
            (Measure::Known(unit), _) if !unit.is_same(&Unit::plain()) => {
                let (multiple, written) = self.exponent(exponent);
                unit.to_the_expression(written, multiple).map_or(Measure::Unknown, Measure::Known)
            }
            (unit, _) => unit,
        }
    }

    /// An exponent that is not a number: its number, and the rest as it is written.
    fn exponent(&self, node: &Node) -> (f64, String) {
        match &node.kind {
            NodeKind::Minus(a) => {
                let (multiple, rest) = self.exponent(a);
                (-multiple, rest)
            }
            NodeKind::Binary(Binary::Mul, a, b) => match (&a.kind, &b.kind) {
                (NodeKind::Number(multiple, _), _) => (*multiple, self.written(b)),
                (_, NodeKind::Number(multiple, _)) => (*multiple, self.written(a)),
                _ => (1.0, self.written(node)),
            },
            _ => (1.0, self.written(node)),
        }
    }

    /// A part as it is written, with what arguments stand for: the same text means the same value.
    fn written(&self, node: &Node) -> String {
        match &node.kind {
            NodeKind::Unread => String::new(),
            NodeKind::Number(value, unit) => format!("{value}{}", unit.as_deref().unwrap_or_default()),
            NodeKind::Name(name) => self.arguments.get(name).unwrap_or(name).clone(),
            NodeKind::Minus(a) => format!("-({})", self.written(a)),
            NodeKind::Not(a) => format!("not ({})", self.written(a)),
            NodeKind::Binary(operator, a, b) => {
                format!("({}) {operator:?} ({})", self.written(a), self.written(b))
            }
            NodeKind::Call(name, _, parts) => {
                let parts: Vec<String> = parts.iter().map(|part| self.written(part)).collect();
                format!("{name}({})", parts.join(", "))
            }
        }
    }

    fn call(&mut self, name: &str, given: &[Node], at: &Range<usize>, names: &Names) -> Measure {
        if let Some(function) = self.scope.scope.functions.get(name) {
            let inner = function.arguments.iter().cloned();
            let inner: Names =
                inner.zip(given.iter().map(|node| self.measure(node, names)).collect::<Vec<_>>()).collect();
            // A trouble inside the function is told where it is called, since it depends on the arguments.
            let written = function.arguments.iter().cloned().zip(given.iter().map(|node| self.written(node))).collect();
            let outer = std::mem::replace(&mut self.arguments, written);
            let told = self.troubles.len();
            let value = self.measure(&function.body, &inner);
            self.arguments = outer;
            let inside = self.troubles.split_off(told);
            if let Some(trouble) = inside.into_iter().next() {
                let message = format!("in `{name}`, called here, {}", trouble.message);
                self.troubles.push(Trouble { message, at: at.clone(), ..trouble });
            }
            return value;
        }
        // What is miscounted is told where it is resolved; units that follow from it are looked for before.
        let Some(function) = known(name).filter(|function| function.meaning.takes(given.len())) else {
            return Measure::Unknown;
        };
        let plain = || Measure::Known(Unit::plain());
        let parts: Vec<&Node> = given.iter().collect();
        let what = format!("the argument of `{name}`");
        match function.units {
            UnitRule::Plain => {
                parts.iter().for_each(|part| self.plain(part, names, None, &what));
                plain()
            }
            UnitRule::OfAngle => {
                let radian = Unit::read("rad").ok();
                parts.iter().for_each(|part| self.plain(part, names, radian.as_ref(), &what));
                plain()
            }
            UnitRule::Any => {
                parts.iter().for_each(|part| drop(self.measure(part, names)));
                plain()
            }
            UnitRule::Same => self.shared(&parts, names),
            UnitRule::Root => match self.measure(parts[0], names) {
                Measure::Known(unit) => Measure::Known(unit.to_the(0.5)),
                other => other,
            },
            UnitRule::Power => self.power(parts[0], parts[1], names),
            UnitRule::Quotient => {
                self.shared(&parts, names);
                plain()
            }
            UnitRule::Hill => {
                self.shared(&parts[..2], names);
                self.plain(parts[2], names, None, "the exponent of `hill`");
                plain()
            }
            UnitRule::Delay => {
                let value = self.measure(parts[0], names);
                self.time(parts[1], names, "the time of `delay`");
                value
            }
            UnitRule::Times => {
                parts.iter().for_each(|part| self.time(part, names, &what));
                plain()
            }
            UnitRule::Piecewise => {
                let values: Vec<&Node> = parts.iter().step_by(2).copied().collect();
                parts.iter().skip(1).step_by(2).for_each(|condition| drop(self.measure(condition, names)));
                self.shared(&values, names)
            }
        }
    }
}
