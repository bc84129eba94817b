//! Fast reactions whose law is proportional to both species, and signs that rates have whatever the values.
//!
//! Where J = c n_A n_B with c > 0, B speeds up its own making: of the two equilibria n_A = 0 draws amounts near and n_B = 0 sends them
//! away, and A is used up as soon as there is some B. Where c < 0 it is the other way round. Such a law is as good as J = n_A, or −n_B.

use super::fast::DEPTH;
use super::plan::Plan;
use super::species::SpeciesIds;
use crate::equations::linear::line;
use crate::equations::pieces::{negative, quantity, quotient, replaced};
use crate::equations::tree::{Binary, Expr, QuantityId, Unary};

/// A quantity and the sign that it has where a condition holds.
type Assumed = (QuantityId, f64);

impl Plan<'_, '_> {
    /// The law of a reaction from one species to another, as one that is linear: as it is, or, where it is proportional to both, one
    /// with the same equilibrium, and 0 where nothing happens. None where the equilibrium would not be reached.
    pub fn without_catalysis(&self, law: &Expr, [from, into]: [SpeciesIds; 2]) -> Option<Expr> {
        let amount = |ids: &SpeciesIds| quotient(quantity(ids.amount), ids.size());
        let by_amounts =
            replaced(law, &|quantity_id| [from, into].iter().find(|ids| ids.concentration == quantity_id).map(amount));
        let Some(factor) = proportional(&by_amounts, from.amount).and_then(|slope| proportional(&slope, into.amount))
        else {
            return Some(law.clone());
        };
        let factor = self.steady_value(&factor, true, DEPTH);
        if factor == 0.0 {
            return Some(Expr::Number(0.0));
        }
        let (used, catalyst) = if factor > 0.0 { (from, into) } else { (into, from) };
        let begin = self.steady_value(&self.quantities[catalyst.amount as usize].initial, true, DEPTH);
        let goes = factor.is_finite() && begin > 0.0;
        let linear = quantity(used.amount);
        goes.then(|| if factor > 0.0 { linear } else { negative(linear) })
    }

    /// Whether an expression is above 0 (sign 1) or below (−1) whatever the values; what is assumed holds where it stands.
    pub fn has_sign(&self, expr: &Expr, sign: f64, assumed: Option<Assumed>) -> bool {
        if let Expr::Piecewise { branches, otherwise } = expr
            && let ([(condition, value)], None) = (branches.as_slice(), assumed)
        {
            let holds = assumption(condition);
            let fails = holds.map(|(of, sign)| (of, -sign));
            return self.has_sign(value, sign, holds) && self.has_sign(otherwise, sign, fails);
        }
        self.sign(expr, assumed) == sign
    }

    /// The sign of a product or quotient; not a number where it is not known or 0.
    fn sign(&self, expr: &Expr, assumed: Option<Assumed>) -> f64 {
        let value = self.steady_value(expr, true, DEPTH);
        match (expr, assumed) {
            _ if value != 0.0 && !value.is_nan() => value.signum(),
            (Expr::Quantity(of), Some((known, sign))) if *of == known => sign,
            (Expr::Unary(Unary::Neg, a), _) => -self.sign(a, assumed),
            (Expr::Binary(Binary::Mul | Binary::Div, a, b), _) => self.sign(a, assumed) * self.sign(b, assumed),
            _ => f64::NAN,
        }
    }
}

/// What an expression is a multiple of, as a function of a quantity: its slope, where it is a line through 0.
fn proportional(expr: &Expr, of: QuantityId) -> Option<Expr> {
    let (slope, rest) = line(expr, of)?;
    (rest == Expr::Number(0.0) && slope != Expr::Number(0.0)).then_some(slope)
}

/// What a comparison of a quantity with 0 says of its sign.
fn assumption(condition: &Expr) -> Option<Assumed> {
    let Expr::Binary(function, a, b) = condition else { return None };
    let sign = match function {
        Binary::Gt | Binary::Ge => 1.0,
        Binary::Lt | Binary::Le => -1.0,
        _ => return None,
    };
    match (&**a, &**b) {
        (Expr::Quantity(of), Expr::Number(0.0)) => Some((*of, sign)),
        (Expr::Number(0.0), Expr::Quantity(of)) => Some((*of, -sign)),
        _ => None,
    }
}
