//! Functions that machine code calls: those which have no instruction.

use crate::equations::program::math;
use crate::equations::tree::{Binary, Unary};

/// A function of one number.
pub type Call1 = extern "C" fn(f64) -> f64;
/// A function of two numbers.
pub type Call2 = extern "C" fn(f64, f64) -> f64;

/// The same function as [`run`](crate::equations::program::run) applies.
pub fn unary(function: Unary) -> Call1 {
    macro_rules! call {
        ($value:expr) => {{
            extern "C" fn call(a: f64) -> f64 {
                ($value)(a)
            }
            call
        }};
    }
    macro_rules! each {
        ($($name:ident)*) => {
            match function {
                Unary::Exp => call!(math::exp),
                Unary::Ln => call!(math::ln),
                $(Unary::$name => call!(|a| Unary::$name.apply(a)),)*
            }
        };
    }
    each!(Neg Not Abs Sign Floor Ceil Log10 Sqrt Sin Cos Tan Asin Acos Atan Sinh Cosh Tanh Asinh Acosh Atanh Heaviside
        Factorial)
}

/// A power, a remainder or a whole quotient; nothing for what has instructions.
pub fn binary(function: Binary) -> Option<Call2> {
    extern "C" fn power(a: f64, b: f64) -> f64 {
        Binary::Pow.apply(a, b)
    }
    extern "C" fn remainder(a: f64, b: f64) -> f64 {
        Binary::Rem.apply(a, b)
    }
    extern "C" fn quotient(a: f64, b: f64) -> f64 {
        Binary::Quotient.apply(a, b)
    }
    match function {
        Binary::Pow => Some(power),
        Binary::Rem => Some(remainder),
        Binary::Quotient => Some(quotient),
        _ => None,
    }
}
