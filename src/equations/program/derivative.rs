//! Derivatives of the equations, worked out on the graph so that what they share stays shared.

use super::graph::{Graph, Node, NodeId};
use crate::equations::tree::{Binary, Unary};

impl Graph {
    /// The derivative of a node with respect to a slot. Steps (floor, comparisons, heaviside …) count as flat and a
    /// kink has the derivative of one of its sides.
    pub fn derivative(&mut self, id: NodeId, slot: u32) -> NodeId {
        if let Some(&known) = self.derivatives.get(&(id, slot)) {
            return known;
        }
        let derivative = match self.node(id) {
            Node::Constant(_) => self.constant(0.0),
            Node::Slot(own) if self.delayed_at(own).is_some() => self.derivative_of_delayed(own, slot),
            Node::Slot(own) => self.constant(f64::from(u8::from(own == slot))),
            Node::Unary(function, a) => {
                let da = self.derivative(a, slot);
                if self.value(da) == Some(0.0) { da } else { self.derivative_of_unary(function, id, a, da) }
            }
            Node::Binary(function, a, b) => {
                let (da, db) = (self.derivative(a, slot), self.derivative(b, slot));
                self.derivative_of_binary(function, id, (a, b), (da, db))
            }
            Node::Root(call, index) => self.derivative_of_root(call, index, slot),
            Node::Select(condition, yes, no) => {
                let (yes, no) = (self.derivative(yes, slot), self.derivative(no, slot));
                self.select(condition, yes, no)
            }
        };
        self.derivatives.insert((id, slot), derivative);
        derivative
    }

    /// The derivative of x(t − τ), eq. (ode.8): x' there, times that of t − τ.
    fn derivative_of_delayed(&mut self, own: u32, slot: u32) -> NodeId {
        let Some(delay) = self.delayed_at(own).map(|delayed| delayed.delay) else { return self.constant(0.0) };
        let clock = self.constant(f64::from(u8::from(slot == 0)));
        let stretch = self.derivative(delay, slot);
        let moved = self.binary(Binary::Sub, clock, stretch);
        let rate = self.slot(own + 1);
        self.binary(Binary::Mul, moved, rate)
    }

    fn derivative_of_unary(&mut self, function: Unary, id: NodeId, a: NodeId, da: NodeId) -> NodeId {
        use Binary as B;
        let one = self.constant(1.0);
        let square = self.binary(B::Mul, a, a);
        match function {
            Unary::Neg => self.unary(Unary::Neg, da),
            Unary::Abs => {
                let sign = self.unary(Unary::Sign, a);
                self.binary(B::Mul, sign, da)
            }
            Unary::Exp => self.binary(B::Mul, id, da),
            Unary::Ln => self.binary(B::Div, da, a),
            Unary::Log10 => {
                let ln10 = self.constant(std::f64::consts::LN_10);
                let below = self.binary(B::Mul, a, ln10);
                self.binary(B::Div, da, below)
            }
            Unary::Sqrt => {
                let half = self.constant(0.5);
                let above = self.binary(B::Mul, half, da);
                self.binary(B::Div, above, id)
            }
            Unary::Sin => {
                let cos = self.unary(Unary::Cos, a);
                self.binary(B::Mul, cos, da)
            }
            Unary::Cos => {
                let sin = self.unary(Unary::Sin, a);
                let product = self.binary(B::Mul, sin, da);
                self.unary(Unary::Neg, product)
            }
            Unary::Tan | Unary::Tanh => {
                let square = self.binary(B::Mul, id, id);
                let sign = if function == Unary::Tan { B::Add } else { B::Sub };
                let factor = self.binary(sign, one, square);
                self.binary(B::Mul, factor, da)
            }
            Unary::Asin | Unary::Acos => {
                let inside = self.binary(B::Sub, one, square);
                let root = self.unary(Unary::Sqrt, inside);
                let quotient = self.binary(B::Div, da, root);
                if function == Unary::Asin { quotient } else { self.unary(Unary::Neg, quotient) }
            }
            Unary::Atan | Unary::Atanh => {
                let sign = if function == Unary::Atan { B::Add } else { B::Sub };
                let below = self.binary(sign, one, square);
                self.binary(B::Div, da, below)
            }
            Unary::Sinh | Unary::Cosh => {
                let other = self.unary(if function == Unary::Sinh { Unary::Cosh } else { Unary::Sinh }, a);
                self.binary(B::Mul, other, da)
            }
            Unary::Asinh | Unary::Acosh => {
                let sign = if function == Unary::Asinh { B::Add } else { B::Sub };
                let inside = self.binary(sign, square, one);
                let root = self.unary(Unary::Sqrt, inside);
                self.binary(B::Div, da, root)
            }
            Unary::Not | Unary::Sign | Unary::Floor | Unary::Ceil | Unary::Heaviside | Unary::Factorial => {
                self.constant(0.0)
            }
        }
    }

    fn derivative_of_binary(
        &mut self,
        function: Binary,
        id: NodeId,
        (a, b): (NodeId, NodeId),
        (da, db): (NodeId, NodeId),
    ) -> NodeId {
        use Binary as B;
        match function {
            B::Add | B::Sub => self.binary(function, da, db),
            B::Mul if a == b => {
                let two = self.constant(2.0);
                let twice = self.binary(B::Mul, two, a);
                self.binary(B::Mul, twice, da)
            }
            B::Mul => {
                let left = self.binary(B::Mul, da, b);
                let right = self.binary(B::Mul, a, db);
                self.binary(B::Add, left, right)
            }
            B::Div => {
                let product = self.binary(B::Mul, id, db);
                let above = self.binary(B::Sub, da, product);
                self.binary(B::Div, above, b)
            }
            B::Pow => self.derivative_of_power(id, (a, b), (da, db)),
            B::Min | B::Max => {
                let first = self.binary(if function == B::Min { B::Le } else { B::Ge }, a, b);
                self.select(first, da, db)
            }
            B::Rem => {
                let whole = self.binary(B::Sub, a, id);
                let times = self.binary(B::Div, whole, b);
                let product = self.binary(B::Mul, times, db);
                self.binary(B::Sub, da, product)
            }
            B::Quotient | B::Lt | B::Le | B::Gt | B::Ge | B::Eq | B::Ne | B::And | B::Or | B::Xor => self.constant(0.0),
        }
    }

    /// b·a^(b−1)·da + a^b·ln(a)·db, with the last term 0 at a = 0.
    fn derivative_of_power(&mut self, id: NodeId, (a, b): (NodeId, NodeId), (da, db): (NodeId, NodeId)) -> NodeId {
        use Binary as B;
        let (zero, one) = (self.constant(0.0), self.constant(1.0));
        let lower = self.binary(B::Sub, b, one);
        let power = self.binary(B::Pow, a, lower);
        let factor = self.binary(B::Mul, b, power);
        let from_base = self.binary(B::Mul, factor, da);
        let ln = self.unary(Unary::Ln, a);
        let factor = self.binary(B::Mul, id, ln);
        let product = self.binary(B::Mul, factor, db);
        let at_zero = self.binary(B::Eq, a, zero);
        let from_exponent = self.select(at_zero, zero, product);
        self.binary(B::Add, from_base, from_exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Program, run};
    use crate::equations::expression::{Scope, parse};
    use crate::equations::tree::{Binary, Expr, Quantity, Role, System, Unary};
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

    /// Derivatives by x, y and time, from the program of dx/dt = expression.
    fn derivatives(expr: &Expr, time: f64, x: f64, y: f64) -> [f64; 3] {
        let quantity = |id: &str, rate: Expr| Quantity {
            id: id.into(),
            name: String::new(),
            role: Role::Variable { rate },
            initial: Expr::Number(0.0),
            unit: String::new(),
        };
        let quantities = vec![quantity("x", expr.clone()), quantity("y", Expr::Number(0.0))];
        let program = Program::new(&System { quantities, ..System::default() }).expect("no circles");
        let mut file = program.file::<1>();
        (file[0], file[1], file[2]) = ([time], [x], [y]);
        run(&program.linear, &mut file);
        let output = |number: usize| file[program.linear.outputs[number] as usize][0];
        let by = |column: u32| program.pattern.iter().position(|entry| *entry == (0, column));
        [by(0).map_or(0.0, |entry| output(4 + entry)), by(1).map_or(0.0, |entry| output(4 + entry)), output(2)]
    }

    /// Compares all three derivatives with central differences.
    fn check(expr: &Expr, time: f64, x: f64, y: f64) {
        let h = 1e-5;
        let differences = [
            (at(expr, time, x + h, y) - at(expr, time, x - h, y)) / (2.0 * h),
            (at(expr, time, x, y + h) - at(expr, time, x, y - h)) / (2.0 * h),
            (at(expr, time + h, x, y) - at(expr, time - h, x, y)) / (2.0 * h),
        ];
        let size = at(expr, time, x, y).abs();
        for (value, difference) in derivatives(expr, time, x, y).into_iter().zip(differences) {
            // The difference errs by h² times a third derivative (of the size of the first for these functions, with
            // a margin for steep ones) and by round-off over h.
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
        for (text, wanted) in [("x^2", 0.0), ("x^1", 1.0), ("x^3", 0.0), ("hill(x, 1, 2)", 0.0)] {
            assert_eq!(derivatives(&read(text), 0.0, 0.0, 0.5)[0], wanted, "{text}");
        }
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
    }
}
