//! What the graph makes simpler while it grows, and divisors shared before code is made.

use super::graph::{Graph, Node, NodeId};
use crate::equations::tree::{Binary, Unary};

/// Whole and half exponents up to this one become products and a root; the error of x^k grows as k/2 units in the last place.
const LARGEST_PRODUCT: f64 = 16.0;

impl Graph {
    /// A function of one argument.
    pub fn unary(&mut self, function: Unary, a: NodeId) -> NodeId {
        if let Some(value) = self.value(a) {
            return self.constant(function.apply(value));
        }
        if let (Unary::Neg, Node::Unary(Unary::Neg, inner)) = (function, self.node(a)) {
            return inner;
        }
        self.intern(Node::Unary(function, a))
    }

    /// An operator or function of two arguments. `0·x` is 0 whatever x is.
    pub fn binary(&mut self, function: Binary, a: NodeId, b: NodeId) -> NodeId {
        use Binary as B;
        let (left, right) = (self.value(a), self.value(b));
        if let (Some(left), Some(right)) = (left, right) {
            return self.constant(function.apply(left, right));
        }
        match (function, left, right) {
            (B::Add, Some(0.0), _) => return b,
            (B::Add | B::Sub, _, Some(0.0)) => return a,
            (B::Sub, Some(0.0), _) => return self.unary(Unary::Neg, b),
            (B::Mul, Some(0.0), _) | (B::Mul, _, Some(0.0)) | (B::Div, Some(0.0), _) => return self.constant(0.0),
            (B::Mul, Some(1.0), _) => return b,
            (B::Mul | B::Div, _, Some(1.0)) => return a,
            (B::Mul, Some(-1.0), _) => return self.unary(Unary::Neg, b),
            (B::Mul | B::Div, _, Some(-1.0)) => return self.unary(Unary::Neg, a),
            _ => {}
        }
        // Signs move outwards, where a sum takes them up: all of it exact.
        let negated = |id| match self.node(id) {
            Node::Unary(Unary::Neg, inner) => Some(inner),
            _ => None,
        };
        match (function, negated(a), negated(b)) {
            (B::Mul | B::Div, Some(a), Some(b)) => return self.binary(function, a, b),
            (B::Mul | B::Div, Some(a), None) => return self.negative(function, a, b),
            (B::Mul | B::Div, None, Some(b)) => return self.negative(function, a, b),
            (B::Add, _, Some(b)) => return self.binary(B::Sub, a, b),
            (B::Add, Some(a), None) => return self.binary(B::Sub, b, a),
            (B::Sub, _, Some(b)) => return self.binary(B::Add, a, b),
            _ => {}
        }
        if let (B::Pow, Some(exponent)) = (function, right)
            && let Some(product) = self.power(a, exponent)
        {
            return product;
        }
        let commutes = matches!(function, B::Add | B::Mul | B::Eq | B::Ne | B::And | B::Or | B::Xor);
        let (a, b) = if commutes && a > b { (b, a) } else { (a, b) };
        self.intern(Node::Binary(function, a, b))
    }

    fn negative(&mut self, function: Binary, a: NodeId, b: NodeId) -> NodeId {
        let positive = self.binary(function, a, b);
        self.unary(Unary::Neg, positive)
    }

    /// A power with a constant exponent that products and a root give.
    fn power(&mut self, a: NodeId, exponent: f64) -> Option<NodeId> {
        if (2.0 * exponent).fract() != 0.0 || exponent.abs() > LARGEST_PRODUCT {
            return None;
        }
        let (mut left, mut square) = (exponent.abs() as u32, a);
        let mut product = if exponent.fract() != 0.0 { self.unary(Unary::Sqrt, a) } else { self.constant(1.0) };
        while left > 0 {
            if left & 1 == 1 {
                product = self.binary(Binary::Mul, product, square);
            }
            left >>= 1;
            if left > 0 {
                square = self.binary(Binary::Mul, square, square);
            }
        }
        if exponent < 0.0 {
            let one = self.constant(1.0);
            product = self.binary(Binary::Div, one, product);
        }
        Some(product)
    }

    /// The second where the first is true, and else the third.
    pub fn select(&mut self, condition: NodeId, yes: NodeId, no: NodeId) -> NodeId {
        match self.value(condition) {
            _ if yes == no => yes,
            Some(0.0) => no,
            Some(_) => yes,
            None => self.intern(Node::Select(condition, yes, no)),
        }
    }

    /// The same nodes in a graph in which a divisor of several quotients is inverted once and they multiply: a division
    /// costs as much as many products. Such quotients differ in their last place, and a divisor below 1e-308 gives infinity.
    pub fn with_shared_divisors(&self, roots: &[NodeId]) -> (Self, Vec<NodeId>) {
        let needed = self.needed(roots);
        let mut quotients = vec![0; self.nodes.len()];
        for id in (0..self.nodes.len()).filter(|&id| needed[id]) {
            if let Node::Binary(Binary::Div, _, divisor) = self.nodes[id] {
                quotients[divisor as usize] += 1;
            }
        }
        let (mut graph, mut new) = (Self::default(), vec![NodeId::MAX; self.nodes.len()]);
        for id in (0..self.nodes.len()).filter(|&id| needed[id]) {
            let at = |id: NodeId| new[id as usize];
            new[id] = match self.nodes[id] {
                Node::Binary(Binary::Div, a, b) if quotients[b as usize] > 1 => {
                    let one = graph.constant(1.0);
                    let inverse = graph.binary(Binary::Div, one, at(b));
                    graph.binary(Binary::Mul, at(a), inverse)
                }
                Node::Binary(function, a, b) => graph.binary(function, at(a), at(b)),
                Node::Unary(function, a) => graph.unary(function, at(a)),
                Node::Select(a, b, c) => graph.select(at(a), at(b), at(c)),
                Node::Root(call, index) => graph.called(&self.calls[call as usize], index, at),
                leaf => graph.intern(leaf),
            };
        }
        let roots = roots.iter().map(|&root| new[root as usize]).collect();
        (graph, roots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slots() -> (Graph, [NodeId; 3]) {
        let mut graph = Graph::default();
        let slots = [0, 1, 2].map(|slot| graph.slot(slot));
        (graph, slots)
    }

    #[test]
    fn signs_end_in_sums() {
        let (mut graph, [x, y, z]) = slots();
        let minus = graph.unary(Unary::Neg, x);
        let product = graph.binary(Binary::Mul, minus, y);
        let sum = graph.binary(Binary::Add, product, z);
        let positive = graph.binary(Binary::Mul, x, y);
        assert_eq!(sum, graph.binary(Binary::Sub, z, positive), "-x·y + z is z - x·y");
        assert_eq!(graph.binary(Binary::Mul, minus, minus), graph.binary(Binary::Mul, x, x));
        let quotient = graph.binary(Binary::Div, y, minus);
        let back = graph.unary(Unary::Neg, quotient);
        assert_eq!(back, graph.binary(Binary::Div, y, x));
        let difference = graph.binary(Binary::Sub, z, minus);
        assert_eq!(difference, graph.binary(Binary::Add, z, x));
    }

    #[test]
    fn a_divisor_of_several_quotients_divides_once() {
        let (mut graph, [x, y, z]) = slots();
        let (first, second) = (graph.binary(Binary::Div, x, z), graph.binary(Binary::Div, y, z));
        let alone = graph.binary(Binary::Div, z, x);
        let divisions = |graph: &Graph, roots: &[NodeId]| {
            let needed = graph.needed(roots);
            let is_division = |id: &usize| matches!(graph.node(*id as NodeId), Node::Binary(Binary::Div, ..));
            (0..graph.len()).filter(|&id| needed[id]).filter(is_division).count()
        };
        let (shared, roots) = graph.with_shared_divisors(&[first, second, alone]);
        assert_eq!((divisions(&graph, &[first, second, alone]), divisions(&shared, &roots)), (3, 2));
        let exact = shared.node(roots[2]);
        assert!(
            matches!(exact, Node::Binary(Binary::Div, ..)),
            "a quotient with a divisor of its own stays: {exact:?}"
        );
    }
}
