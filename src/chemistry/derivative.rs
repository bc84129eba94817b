//! Derivatives of expressions, as expressions.

use super::tree::{Binary, Expr, QuantityId, Unary};

impl Expr {
    /// The derivative by a quantity, the others and time held fixed; simplified. Steps (floor, sign, comparisons …) have
    /// the derivative 0, which is right beside their jumps. Defined quantities count as independent: a caller who wants
    /// the total derivative applies the chain rule along [`super::tree::System::definition_order`].
    pub fn derivative(&self, by: QuantityId) -> Self {
        derivative(self, &|leaf| matches!(leaf, Self::Quantity(number) if *number == by)).simplify()
    }

    /// The derivative by time where it stands in the expression, all quantities held fixed; simplified.
    pub fn time_derivative(&self) -> Self {
        derivative(self, &|leaf| matches!(leaf, Self::Time)).simplify()
    }

    /// The expression without what adds 0, multiplies by 1 or can be computed now. `0*x` becomes 0, so a value that is
    /// not finite may be lost; sums and products are not reordered.
    pub fn simplify(&self) -> Self {
        match self {
            Self::Number(_) | Self::Time | Self::Quantity(_) => self.clone(),
            Self::Unary(function, a) => simple_unary(*function, a.simplify()),
            Self::Binary(function, a, b) => simple_binary(*function, a.simplify(), b.simplify()),
            Self::Piecewise { branches, otherwise } => simple_piecewise(branches, otherwise.simplify()),
        }
    }
}

const ZERO: Expr = Expr::Number(0.0);
const ONE: Expr = Expr::Number(1.0);

fn is(expr: &Expr, number: f64) -> bool {
    matches!(expr, Expr::Number(value) if *value == number)
}

fn simple_unary(function: Unary, a: Expr) -> Expr {
    match (function, a) {
        (_, Expr::Number(value)) if function.apply(value).is_finite() => Expr::Number(function.apply(value)),
        (Unary::Neg, Expr::Unary(Unary::Neg, inner)) => *inner,
        (_, a) => a.unary(function),
    }
}

fn simple_binary(function: Binary, a: Expr, b: Expr) -> Expr {
    if let (Expr::Number(left), Expr::Number(right)) = (&a, &b) {
        let value = function.apply(*left, *right);
        if value.is_finite() {
            return Expr::Number(value);
        }
    }
    match function {
        Binary::Add if is(&a, 0.0) => b,
        Binary::Add | Binary::Sub if is(&b, 0.0) => a,
        Binary::Sub if is(&a, 0.0) => simple_unary(Unary::Neg, b),
        Binary::Mul if is(&a, 0.0) || is(&b, 0.0) => ZERO,
        Binary::Mul if is(&a, 1.0) => b,
        Binary::Mul | Binary::Div | Binary::Pow if is(&b, 1.0) => a,
        Binary::Mul if is(&a, -1.0) => simple_unary(Unary::Neg, b),
        Binary::Mul | Binary::Div if is(&b, -1.0) => simple_unary(Unary::Neg, a),
        Binary::Div if is(&a, 0.0) && !is(&b, 0.0) => ZERO,
        Binary::Pow if is(&b, 0.0) => ONE,
        _ => a.binary(function, b),
    }
}

fn simple_piecewise(branches: &[(Expr, Expr)], otherwise: Expr) -> Expr {
    let mut kept: Vec<(Expr, Expr)> = Vec::new();
    let mut last = otherwise;
    for (condition, value) in branches {
        let (condition, value) = (condition.simplify(), value.simplify());
        match condition {
            Expr::Number(0.0) => {}
            // It always holds: nothing after it is ever reached.
            Expr::Number(_) => {
                last = value;
                break;
            }
            condition => kept.push((condition, value)),
        }
    }
    if kept.iter().all(|(_, value)| *value == last) {
        return last;
    }
    Expr::Piecewise { branches: kept, otherwise: Box::new(last) }
}

/// The derivative by the leaf that `is_it` recognises.
fn derivative(expr: &Expr, is_it: &impl Fn(&Expr) -> bool) -> Expr {
    match expr {
        leaf @ (Expr::Number(_) | Expr::Time | Expr::Quantity(_)) => {
            if is_it(leaf) {
                ONE
            } else {
                ZERO
            }
        }
        Expr::Unary(function, a) => {
            let inner = derivative(a, is_it).simplify();
            if is(&inner, 0.0) { ZERO } else { unary(*function, a).binary(Binary::Mul, inner) }
        }
        Expr::Binary(function, a, b) => {
            let (da, db) = (derivative(a, is_it).simplify(), derivative(b, is_it).simplify());
            if is(&da, 0.0) && is(&db, 0.0) { ZERO } else { binary(*function, expr, (a, da), (b, db)) }
        }
        Expr::Piecewise { branches, otherwise } => Expr::Piecewise {
            branches: branches.iter().map(|(when, value)| (when.clone(), derivative(value, is_it))).collect(),
            otherwise: Box::new(derivative(otherwise, is_it)),
        },
    }
}

/// The derivative of a function of one argument by that argument.
fn unary(function: Unary, a: &Expr) -> Expr {
    let a = a.clone();
    let number = Expr::Number;
    let square = |a: Expr| a.binary(Binary::Pow, number(2.0));
    let inverse = |a: Expr| ONE.binary(Binary::Div, a);
    match function {
        Unary::Neg => number(-1.0),
        Unary::Not | Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Heaviside | Unary::Factorial => ZERO,
        Unary::Abs => a.unary(Unary::Sign),
        Unary::Exp => a.unary(Unary::Exp),
        Unary::Ln => inverse(a),
        Unary::Log10 => inverse(a.binary(Binary::Mul, number(std::f64::consts::LN_10))),
        Unary::Sqrt => number(0.5).binary(Binary::Div, a.unary(Unary::Sqrt)),
        Unary::Sin => a.unary(Unary::Cos),
        Unary::Cos => a.unary(Unary::Sin).unary(Unary::Neg),
        Unary::Tan => ONE.binary(Binary::Add, square(a.unary(Unary::Tan))),
        Unary::Asin => inverse(ONE.binary(Binary::Sub, square(a)).unary(Unary::Sqrt)),
        Unary::Acos => number(-1.0).binary(Binary::Div, ONE.binary(Binary::Sub, square(a)).unary(Unary::Sqrt)),
        Unary::Atan => inverse(ONE.binary(Binary::Add, square(a))),
        Unary::Sinh => a.unary(Unary::Cosh),
        Unary::Cosh => a.unary(Unary::Sinh),
        Unary::Tanh => ONE.binary(Binary::Sub, square(a.unary(Unary::Tanh))),
        Unary::Asinh => inverse(square(a).binary(Binary::Add, ONE).unary(Unary::Sqrt)),
        // Two roots, so that an argument below 1 stays what it is: not a number.
        Unary::Acosh => {
            let below = a.clone().binary(Binary::Sub, ONE).unary(Unary::Sqrt);
            inverse(below.binary(Binary::Mul, a.binary(Binary::Add, ONE).unary(Unary::Sqrt)))
        }
        Unary::Atanh => inverse(ONE.binary(Binary::Sub, square(a))),
    }
}

/// The derivative of an operator, from its operands and their derivatives.
fn binary(function: Binary, whole: &Expr, (a, da): (&Expr, Expr), (b, db): (&Expr, Expr)) -> Expr {
    let (a, b) = (a.clone(), b.clone());
    match function {
        Binary::Add | Binary::Sub => da.binary(function, db),
        Binary::Mul => da.binary(Binary::Mul, b).binary(Binary::Add, a.binary(Binary::Mul, db)),
        Binary::Div if is(&db, 0.0) => da.binary(Binary::Div, b),
        Binary::Div => {
            let change = whole.clone().binary(Binary::Mul, db);
            da.binary(Binary::Sub, change).binary(Binary::Div, b)
        }
        Binary::Pow => power(whole, (a, da), (b, db)),
        Binary::Min | Binary::Max => {
            let nearer = if function == Binary::Min { Binary::Le } else { Binary::Ge };
            Expr::Piecewise { branches: vec![(a.binary(nearer, b), da)], otherwise: Box::new(db) }
        }
        // The remainder moves with the dividend and, by the whole part of the quotient, against the divisor.
        Binary::Rem => {
            let quotient = a.binary(Binary::Div, b);
            let whole_part = quotient.clone().unary(Unary::Abs).unary(Unary::Floor);
            let signed = quotient.unary(Unary::Sign).binary(Binary::Mul, whole_part);
            da.binary(Binary::Sub, signed.binary(Binary::Mul, db))
        }
        Binary::Quotient => ZERO,
        Binary::Lt | Binary::Le | Binary::Gt | Binary::Ge | Binary::Eq | Binary::Ne => ZERO,
        Binary::And | Binary::Or | Binary::Xor => ZERO,
    }
}

/// The derivative of aᵇ. A part whose derivative is 0 leaves no logarithm and no division behind, which would spoil the
/// value at a = 0.
fn power(whole: &Expr, (a, da): (Expr, Expr), (b, db): (Expr, Expr)) -> Expr {
    let by_base = {
        let less = b.clone().binary(Binary::Sub, ONE).simplify();
        b.clone().binary(Binary::Mul, a.clone().binary(Binary::Pow, less)).binary(Binary::Mul, da)
    };
    if is(&db, 0.0) {
        return by_base;
    }
    let by_exponent = whole.clone().binary(Binary::Mul, a.unary(Unary::Ln)).binary(Binary::Mul, db);
    by_base.binary(Binary::Add, by_exponent)
}

#[cfg(test)]
mod tests {
    use super::super::expression::{Scope, parse};
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> Expr {
        let names = [("x", 0), ("y", 1)].map(|(name, number)| (name.to_owned(), number));
        let scope = Scope { quantities: names.into(), ..Scope::default() };
        let (node, troubles) = parse(text);
        assert_eq!(troubles, [], "{text}");
        scope.resolve(&node).expect(text)
    }

    fn at(expr: &Expr, time: f64, x: f64, y: f64) -> f64 {
        expr.evaluate(time, &|number| if number == 0 { x } else { y })
    }

    /// Compares all three derivatives with central differences.
    fn check(expr: &Expr, time: f64, x: f64, y: f64) {
        let h = 1e-5;
        let differences = [
            (expr.derivative(0), (at(expr, time, x + h, y) - at(expr, time, x - h, y)) / (2.0 * h)),
            (expr.derivative(1), (at(expr, time, x, y + h) - at(expr, time, x, y - h)) / (2.0 * h)),
            (expr.time_derivative(), (at(expr, time + h, x, y) - at(expr, time - h, x, y)) / (2.0 * h)),
        ];
        let size = at(expr, time, x, y).abs();
        for (derivative, difference) in differences {
            let value = at(&derivative, time, x, y);
            // The difference errs by h² times a third derivative (of the size of the first for these functions, with
            // room for steep ones) and by round-off over h.
            let error = 1e-6 * (1.0 + value.abs()) * (1.0 + value.abs()).sqrt() + 1e-10 * size;
            assert!((value - difference).abs() <= error, "{expr:?}: {value} against {difference}");
        }
    }

    #[test]
    fn every_function_has_the_derivative_that_differences_show() {
        for text in [
            "exp(x*y)",
            "ln(x + 1)",
            "log10(x)",
            "log(y + 2, x)",
            "pow(x, y)",
            "x^3",
            "x^(1/3)",
            "2^x",
            "sqrt(x*y)",
            "abs(x - 2)",
            "sin(x)*cos(y)",
            "tan(x/2)",
            "asin(x/2)",
            "acos(y/2)",
            "atan(x*y)",
            "sinh(x)",
            "cosh(y)",
            "tanh(x - y)",
            "asinh(x)",
            "acosh(x + 1.5)",
            "atanh(x/3)",
            "min(x, y)*x",
            "max(x, y, 0.2)*y",
            "rem(x*7, 1.3)",
            "rem(7, x)",
            "-rem(-7, x)",
            "quotient(x, 0.37)",
            "sign(x)*y",
            "floor(x) + y",
            "ceil(y)*x",
            "heaviside(x - 0.3)*y",
            "factorial(3)*x",
            "hill(x, y, 4)",
            "hill(x, 0.5, y)",
            "piecewise(x^2, x < y, y^2)",
            "time*x",
            "sin(time*y)",
            "x/(y + time)",
            "-(x - y)/x",
            "not x",
            "x < y",
            "x > y and y > 0",
            "x*(x > y xor y > 9)",
        ] {
            check(&read(text), 0.7, 0.83, 0.41);
            check(&read(text), 1.9, 0.29, 1.13);
        }
    }

    #[test]
    fn a_power_of_nothing_has_a_derivative() {
        assert_eq!(at(&read("x^2").derivative(0), 0.0, 0.0, 0.0), 0.0);
        assert_eq!(at(&read("x^1").derivative(0), 0.0, 0.0, 0.0), 1.0);
        assert_eq!(at(&read("hill(x, 1, 2)").derivative(0), 0.0, 0.0, 0.0), 0.0);
    }

    #[test]
    fn what_does_nothing_is_left_out() {
        for (text, simple) in [
            ("0 + 1*x", "x"),
            ("x*0 + 3", "3"),
            ("x^1/1 - 0", "x"),
            ("-(-(x))", "x"),
            ("2*3 + 4", "10"),
            ("piecewise(1, 1 > 2, y)", "y"),
            ("piecewise(x, x > 2, x)", "x"),
            ("0 - x", "-x"),
            ("x^0", "1"),
        ] {
            assert_eq!(read(text).simplify(), read(simple).simplify(), "{text}");
        }
        assert_eq!(read("1/0").simplify(), read("1/0"), "what is not finite is left for the reader to see");
        assert_eq!(read("3*x^2").derivative(0), read("3*(2*x)"));
    }

    /// Smooth expressions in which no function leaves its domain.
    fn smooth() -> impl Strategy<Value = Expr> {
        let leaf =
            prop_oneof![(-2.0f64..2.0).prop_map(Expr::Number), Just(Expr::Time), (0u32..2).prop_map(Expr::Quantity),];
        leaf.prop_recursive(3, 12, 3, |inner| {
            let bounded = [Unary::Sin, Unary::Cos, Unary::Tanh, Unary::Atan, Unary::Asinh, Unary::Neg];
            prop_oneof![
                (prop::sample::select(bounded.to_vec()), inner.clone()).prop_map(|(function, a)| a.unary(function)),
                (inner.clone(), inner.clone()).prop_map(|(a, b)| a.binary(Binary::Add, b)),
                (inner.clone(), inner.clone()).prop_map(|(a, b)| a.binary(Binary::Sub, b)),
                (inner.clone(), inner.clone()).prop_map(|(a, b)| a.unary(Unary::Sin).binary(Binary::Mul, b)),
                (inner.clone(), inner.clone()).prop_map(|(a, b)| {
                    let positive = b.unary(Unary::Cos).binary(Binary::Add, Expr::Number(2.0));
                    a.unary(Unary::Tanh).binary(Binary::Div, positive)
                }),
                (inner.clone(), inner).prop_map(|(a, b)| {
                    let positive = a.unary(Unary::Sin).binary(Binary::Add, Expr::Number(2.0));
                    positive.binary(Binary::Pow, b.unary(Unary::Cos))
                }),
            ]
        })
    }

    proptest! {
        #[test]
        fn random_expressions_have_the_derivatives_that_differences_show(
            expr in smooth(), time in 0.0f64..2.0, x in -2.0f64..2.0, y in -2.0f64..2.0,
        ) {
            check(&expr, time, x, y);
        }

        #[test]
        fn a_simpler_expression_has_the_same_value(expr in smooth(), time in 0.0f64..2.0, x in -2.0f64..2.0) {
            let (plain, simple) = (at(&expr, time, x, 0.5), at(&expr.simplify(), time, x, 0.5));
            prop_assert!(plain == simple, "{} {}", plain, simple);
        }
    }
}
