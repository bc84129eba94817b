//! What the variables of a single system were: the values within its steps, piece by piece.

use std::collections::VecDeque;
use std::sync::Arc;

/// Where the values within a step are taken down, and of which variables.
#[derive(Debug, Default)]
pub struct Frame {
    /// The variables that are looked back at, by their positions in the state.
    pub kept: Vec<usize>,
    /// Shares of the step: Chebyshev's points with both ends, on which a polynomial is known by its values.
    shares: Vec<f64>,
    /// Weights of the values there in the barycentric formula.
    weights: Vec<f64>,
}

impl Frame {
    /// A frame for polynomials of a degree of 1 or more.
    pub fn new(kept: Vec<usize>, degree: usize) -> Self {
        let share = |node: usize| 0.5 - 0.5 * (std::f64::consts::PI * node as f64 / degree as f64).cos();
        let end = |node: usize| if node == 0 || node == degree { 0.5 } else { 1.0 };
        let weight = |node: usize| if node.is_multiple_of(2) { end(node) } else { -end(node) };
        let mut shares: Vec<f64> = (0..=degree).map(share).collect();
        (shares[0], shares[degree]) = (0.0, 1.0);
        Self { kept, shares, weights: (0..=degree).map(weight).collect() }
    }
}

/// The values within one step: a polynomial for each variable that is kept.
#[derive(Debug, Clone)]
pub struct Piece {
    frame: Arc<Frame>,
    /// When the step began.
    pub begin: f64,
    /// When it was left: at its end, or where an event cut it.
    pub end: f64,
    /// Its length, uncut.
    length: f64,
    /// Node after node one value a variable.
    values: Vec<f64>,
    /// What the open quantities were.
    pub open: Vec<f64>,
}

impl Piece {
    /// A piece without values yet.
    pub fn blank(frame: &Arc<Frame>, begin: f64, length: f64, open: &[f64]) -> Self {
        let values = vec![0.0; frame.shares.len() * frame.kept.len()];
        Self { frame: frame.clone(), begin, end: begin + length, length, values, open: open.to_vec() }
    }

    /// How many nodes it has.
    pub fn nodes(&self) -> usize {
        self.frame.shares.len()
    }

    /// The share of the step at which a node stands.
    pub fn share(&self, node: usize) -> f64 {
        self.frame.shares[node]
    }

    /// Sets the values at a node to those of a state.
    pub fn set(&mut self, node: usize, state: &[f64]) {
        let width = self.frame.kept.len();
        let to = &mut self.values[node * width..(node + 1) * width];
        to.iter_mut().zip(&self.frame.kept).for_each(|(to, &variable)| *to = state[variable]);
    }

    /// Hands over the variables at a time: their positions and values. Beyond the ends the polynomials go on.
    pub fn values(&self, time: f64, mut each: impl FnMut(usize, f64)) {
        let Frame { kept, shares, weights } = &*self.frame;
        let (share, width) = ((time - self.begin) / self.length, kept.len());
        if let Some(node) = shares.iter().position(|known| *known == share) {
            kept.iter().enumerate().for_each(|(at, &variable)| each(variable, self.values[node * width + at]));
            return;
        }
        let factor = |node: usize| weights[node] / (share - shares[node]);
        let all: f64 = (0..shares.len()).map(factor).sum();
        for (at, &variable) in kept.iter().enumerate() {
            let first = self.values[at];
            // Changes, so that what stands still does so to the last bit.
            let sum: f64 = (1..shares.len()).map(|node| factor(node) * (self.values[node * width + at] - first)).sum();
            each(variable, first + sum / all);
        }
    }
}

/// Pieces in the order of time.
#[derive(Debug, Default)]
pub struct History {
    pieces: VecDeque<Piece>,
}

impl History {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.pieces.clear();
    }

    /// Adds the last piece.
    pub fn push(&mut self, piece: Piece) {
        self.pieces.push_back(piece);
    }

    /// The last piece that has begun by a time.
    pub fn at(&self, time: f64) -> Option<&Piece> {
        let next = self.pieces.partition_point(|piece| piece.begin <= time);
        self.pieces.get(next.saturating_sub(1))
    }

    /// Forgets what was left before a time.
    pub fn forget_before(&mut self, time: f64) {
        while self.pieces.get(1).is_some_and(|second| second.begin <= time) {
            self.pieces.pop_front();
        }
    }

    /// How many pieces there are.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.pieces.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_the_degree_is_kept_to_round_off() {
        for degree in 1..=5 {
            let frame = Arc::new(Frame::new(vec![1], degree));
            let mut piece = Piece::blank(&frame, 2.0, 0.5, &[]);
            let value = |time: f64| (0..=degree).map(|power| (time - 1.7).powi(power as i32)).sum::<f64>();
            for node in 0..piece.nodes() {
                piece.set(node, &[0.0, value(2.0 + 0.5 * piece.share(node))]);
            }
            for step in 0..=60 {
                let time = 1.95 + 0.01 * f64::from(step);
                piece.values(time, |variable, got| {
                    assert_eq!(variable, 1);
                    assert!((got - value(time)).abs() < 1e-13, "degree {degree} at {time}: {got}");
                });
            }
        }
    }

    #[test]
    fn what_is_no_longer_looked_back_at_is_forgotten() {
        let (frame, mut history) = (Arc::new(Frame::new(vec![], 1)), History::default());
        for begin in 0..10 {
            history.push(Piece::blank(&frame, f64::from(begin), 1.0, &[]));
            history.forget_before(f64::from(begin + 1) - 2.5);
            assert!(history.len() <= 3 && history.at(f64::from(begin) - 1.5).is_some());
        }
        assert_eq!(history.at(8.0).map(|piece| piece.begin), Some(8.0), "a piece holds at its begin");
    }
}
