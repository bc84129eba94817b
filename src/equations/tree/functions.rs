//! The functions that expressions are made of, and their values.

use serde::{Deserialize, Serialize};

/// Functions of one argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[allow(missing_docs)] // the names are the functions' usual ones
pub enum Unary {
    Neg,
    Not,
    Abs,
    Sign,
    Floor,
    Ceil,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    /// 0 below zero, 1 at zero and above.
    Heaviside,
    Factorial,
}

impl Unary {
    /// All of them, in order.
    pub const ALL: [Self; 24] = [
        Self::Neg,
        Self::Not,
        Self::Abs,
        Self::Sign,
        Self::Floor,
        Self::Ceil,
        Self::Exp,
        Self::Ln,
        Self::Log10,
        Self::Sqrt,
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Asinh,
        Self::Acosh,
        Self::Atanh,
        Self::Heaviside,
        Self::Factorial,
    ];
}

/// Operators and functions of two arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[allow(missing_docs)] // as above
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Min,
    Max,
    /// The remainder with the sign of the dividend.
    Rem,
    /// The floor of the quotient.
    Quotient,
    Lt,
    Le,
    Gt,
    Ge,
    Eq,
    Ne,
    And,
    Or,
    Xor,
}

impl Binary {
    /// All of them, in order.
    pub const ALL: [Self; 18] = [
        Self::Add,
        Self::Sub,
        Self::Mul,
        Self::Div,
        Self::Pow,
        Self::Min,
        Self::Max,
        Self::Rem,
        Self::Quotient,
        Self::Lt,
        Self::Le,
        Self::Gt,
        Self::Ge,
        Self::Eq,
        Self::Ne,
        Self::And,
        Self::Or,
        Self::Xor,
    ];
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// The smaller of two numbers, or that which is one. Of zeros with two signs the second, which `f64::min` leaves open.
#[inline(always)]
pub fn smaller(a: f64, b: f64) -> f64 {
    if (a < b) | b.is_nan() { a } else { b }
}

/// The larger of two numbers, as [`smaller`].
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if (a > b) | b.is_nan() { a } else { b }
}

impl Unary {
    /// The function's value.
    pub fn apply(self, a: f64) -> f64 {
        match self {
            Self::Neg => -a,
            Self::Not => truth(a == 0.0),
            Self::Abs => a.abs(),
            Self::Sign => truth(a > 0.0) - truth(a < 0.0),
            Self::Floor => a.floor(),
            Self::Ceil => a.ceil(),
            Self::Exp => a.exp(),
            Self::Ln => a.ln(),
            Self::Log10 => a.log10(),
            Self::Sqrt => a.sqrt(),
            Self::Sin => a.sin(),
            Self::Cos => a.cos(),
            Self::Tan => a.tan(),
            Self::Asin => a.asin(),
            Self::Acos => a.acos(),
            Self::Atan => a.atan(),
            Self::Sinh => a.sinh(),
            Self::Cosh => a.cosh(),
            Self::Tanh => a.tanh(),
            Self::Asinh => a.asinh(),
            Self::Acosh => a.acosh(),
            Self::Atanh => a.atanh(),
            Self::Heaviside => truth(a >= 0.0),
            // From 171 on it is infinite.
            Self::Factorial => (2..=a.round().clamp(0.0, 171.0) as u64).map(|k| k as f64).product(),
        }
    }
}

impl Binary {
    /// The function's value.
    pub fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Pow => a.powf(b),
            Self::Min => smaller(a, b),
            Self::Max => larger(a, b),
            Self::Rem => a % b,
            Self::Quotient => (a / b).floor(),
            Self::Lt => truth(a < b),
            Self::Le => truth(a <= b),
            Self::Gt => truth(a > b),
            Self::Ge => truth(a >= b),
            Self::Eq => truth(a == b),
            Self::Ne => truth(a != b),
            Self::And => truth(a != 0.0 && b != 0.0),
            Self::Or => truth(a != 0.0 || b != 0.0),
            Self::Xor => truth((a != 0.0) != (b != 0.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Binary, Unary, larger, smaller};

    #[test]
    fn the_lists_hold_every_function_at_its_number() {
        assert!(Unary::ALL.iter().enumerate().all(|(index, &function)| function as usize == index));
        assert!(Binary::ALL.iter().enumerate().all(|(index, &function)| function as usize == index));
        // A new function at the end is to be named here.
        assert_eq!((Unary::ALL.len(), Binary::ALL.len()), (Unary::Factorial as usize + 1, Binary::Xor as usize + 1));
    }

    #[test]
    fn the_smaller_and_the_larger_are_defined_for_odd_numbers_too() {
        let bits = |values: [f64; 2]| values.map(f64::to_bits);
        for (a, b, least, most) in [
            (1.0, 2.0, 1.0, 2.0),
            (2.0, 1.0, 1.0, 2.0),
            (0.0, -0.0, -0.0, -0.0),
            (-0.0, 0.0, 0.0, 0.0),
            (f64::NAN, 3.0, 3.0, 3.0),
            (3.0, f64::NAN, 3.0, 3.0),
            (f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY),
        ] {
            assert_eq!(bits([smaller(a, b), larger(a, b)]), bits([least, most]), "{a} and {b}");
        }
        assert!(smaller(f64::NAN, f64::NAN).is_nan() && larger(f64::NAN, f64::NAN).is_nan());
    }

    #[test]
    fn factorials_end_where_numbers_do() {
        let value = |a| Unary::Factorial.apply(a);
        assert_eq!([value(-1.0), value(0.0), value(1.0), value(5.2)], [1.0, 1.0, 1.0, 120.0]);
        assert!((value(170.0) / 7.257_415_615_307_994e306 - 1.0).abs() < 1e-14);
        assert_eq!([value(171.0), value(1e300), value(f64::INFINITY)], [f64::INFINITY; 3]);
        assert_eq!(value(f64::NAN), 1.0, "as below 0");
    }
}
