//! Derivatives of the equations, worked out on the graph so that what they share stays shared.

use super::graph::{Graph, Node, NodeId};
use crate::chemistry::tree::{Binary, Unary};

impl Graph {
    /// The derivative of a node with respect to a slot. Steps (floor, comparisons, heaviside …) count as flat and a
    /// kink has the derivative of one of its sides.
    pub fn derivative(&mut self, id: NodeId, slot: u32) -> NodeId {
        if let Some(&known) = self.derivatives.get(&(id, slot)) {
            return known;
        }
        let derivative = match self.node(id) {
            Node::Constant(_) => self.constant(0.0),
            Node::Slot(own) => self.constant(f64::from(u8::from(own == slot))),
            Node::Unary(function, a) => {
                let da = self.derivative(a, slot);
                if self.value(da) == Some(0.0) { da } else { self.derivative_of_unary(function, id, a, da) }
            }
            Node::Binary(function, a, b) => {
                let (da, db) = (self.derivative(a, slot), self.derivative(b, slot));
                self.derivative_of_binary(function, id, (a, b), (da, db))
            }
            Node::Select(condition, yes, no) => {
                let (yes, no) = (self.derivative(yes, slot), self.derivative(no, slot));
                self.select(condition, yes, no)
            }
        };
        self.derivatives.insert((id, slot), derivative);
        derivative
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
