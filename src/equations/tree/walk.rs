//! What expressions use, and their values.

use super::{Expr, QuantityId};

impl Expr {
    /// Whether it uses the time itself.
    pub fn uses_time(&self) -> bool {
        match self {
            Self::Time | Self::Delay(..) => true,
            Self::Number(_) | Self::Quantity(_) => false,
            Self::Unary(_, a) => a.uses_time(),
            Self::Binary(_, a, b) => a.uses_time() || b.uses_time(),
            Self::Root(equations, _) => equations.expressions().any(Self::uses_time),
            Self::Piecewise { branches, otherwise } => {
                otherwise.uses_time() || branches.iter().any(|(a, b)| a.uses_time() || b.uses_time())
            }
        }
    }

    /// Whether it looks back.
    pub fn has_delay(&self) -> bool {
        let mut found = false;
        self.each_delay(&mut |_, _| found = true);
        found
    }

    /// Visits what is looked back at and how far, inner ones before those around them.
    pub fn each_delay<'e>(&'e self, visit: &mut impl FnMut(&'e Self, &'e Self)) {
        match self {
            Self::Number(_) | Self::Time | Self::Quantity(_) => {}
            Self::Unary(_, a) => a.each_delay(visit),
            Self::Binary(_, a, b) => {
                a.each_delay(visit);
                b.each_delay(visit);
            }
            Self::Root(equations, _) => equations.expressions().for_each(|one| one.each_delay(visit)),
            Self::Piecewise { branches, otherwise } => {
                for (condition, value) in branches {
                    condition.each_delay(visit);
                    value.each_delay(visit);
                }
                otherwise.each_delay(visit);
            }
            Self::Delay(value, delay) => {
                value.each_delay(visit);
                delay.each_delay(visit);
                visit(value, delay);
            }
        }
    }

    /// Visits the number of every quantity used, as often as it is used.
    pub fn each_quantity(&self, visit: &mut impl FnMut(QuantityId)) {
        match self {
            Self::Number(_) | Self::Time => {}
            Self::Quantity(number) => visit(*number),
            Self::Unary(_, a) => a.each_quantity(visit),
            Self::Binary(_, a, b) | Self::Delay(a, b) => {
                a.each_quantity(visit);
                b.each_quantity(visit);
            }
            Self::Root(equations, _) => equations.used().into_iter().for_each(visit),
            Self::Piecewise { branches, otherwise } => {
                for (condition, value) in branches {
                    condition.each_quantity(visit);
                    value.each_quantity(visit);
                }
                otherwise.each_quantity(visit);
            }
        }
    }

    /// The same with an expression in the place of a quantity.
    pub fn replaced(&self, quantity: QuantityId, by: &Self) -> Self {
        let of = |part: &Self| part.replaced(quantity, by);
        let boxed = |part: &Self| Box::new(of(part));
        match self {
            Self::Quantity(number) if *number == quantity => by.clone(),
            Self::Number(_) | Self::Time | Self::Quantity(_) => self.clone(),
            Self::Unary(function, a) => Self::Unary(*function, boxed(a)),
            Self::Binary(function, a, b) => Self::Binary(*function, boxed(a), boxed(b)),
            Self::Root(equations, index) => {
                Self::Root(Box::new(equations.map(|one| one.replaced(quantity, by))), *index)
            }
            Self::Piecewise { branches, otherwise } => Self::Piecewise {
                branches: branches.iter().map(|(condition, value)| (of(condition), of(value))).collect(),
                otherwise: boxed(otherwise),
            },
            Self::Delay(value, delay) => Self::Delay(boxed(value), boxed(delay)),
        }
    }

    /// The value, computed directly: the oracle of the compiled programs. `value` gives the value of a quantity, now and at all
    /// times before.
    pub fn evaluate(&self, time: f64, value: &impl Fn(QuantityId) -> f64) -> f64 {
        self.evaluate_at(time, &|number, _| value(number))
    }

    /// As [`Self::evaluate`], with quantities that were otherwise at other times.
    pub fn evaluate_at(&self, time: f64, value: &impl Fn(QuantityId, f64) -> f64) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Time => time,
            Self::Quantity(number) => value(*number, time),
            Self::Unary(function, a) => function.apply(a.evaluate_at(time, value)),
            Self::Binary(function, a, b) => function.apply(a.evaluate_at(time, value), b.evaluate_at(time, value)),
            Self::Root(equations, index) => equations.evaluate_at(*index, time, value),
            Self::Piecewise { branches, otherwise } => {
                let chosen = branches.iter().find(|(condition, _)| condition.evaluate_at(time, value) != 0.0);
                chosen.map_or(otherwise.as_ref(), |(_, value)| value).evaluate_at(time, value)
            }
            Self::Delay(past, delay) => past.evaluate_at(time - delay.evaluate_at(time, value), value),
        }
    }
}
