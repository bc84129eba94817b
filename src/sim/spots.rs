//! Where a cell may touch obstacles: its atoms and, on curved obstacles, the points of its edges that are deepest, eq. (planes.3).

use super::kind::Kind;
use super::obstacle::Obstacle;
use crate::Vec3;
use crate::geometry::Beside;

/// A point of an atom or an edge beside an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Number of the obstacle.
    pub obstacle: usize,
    /// The two atoms of the edge; twice the same where it is an atom.
    pub atoms: [usize; 2],
    /// Their shares of the point.
    pub shares: [f64; 2],
    /// How far it is from the obstacle, µm.
    pub gap: f64,
    /// The normal of the obstacle there.
    pub normal: Vec3,
}

/// An edge is looked at where the means of its ends are less than this part of its length from an obstacle: its middle is nearer by half of it at most.
const NEAR: f64 = 0.75;

/// Halvings and secants by which the deepest point of an edge is found.
const SEARCH: usize = 40;

/// The share of an edge to which its deepest point is found: the gap there is flat.
const FOUND: f64 = 1e-9;

impl Spot {
    fn of_atom(obstacle: usize, atom: usize, Beside { gap, normal }: Beside) -> Self {
        Self { obstacle, atoms: [atom; 2], shares: [1.0, 0.0], gap, normal }
    }

    /// Whether it is the same atom or edge, beside the same obstacle.
    pub fn is_of(&self, other: &Self) -> bool {
        (self.obstacle, self.atoms) == (other.obstacle, other.atoms)
    }

    /// What is told of atoms, at the point.
    pub fn mean(&self, of_atom: impl Fn(usize) -> Vec3) -> Vec3 {
        match self.shares {
            [_, 0.0] => of_atom(self.atoms[0]),
            [one, other] => one * of_atom(self.atoms[0]) + other * of_atom(self.atoms[1]),
        }
    }

    /// The atoms of the point with their shares.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> {
        self.atoms.into_iter().zip(self.shares).filter(|(_, share)| *share != 0.0)
    }
}

/// Writes the spots of a cell at a time (s) whose atoms are `at` (µm): of all atoms, obstacle by obstacle, and of edges with a point that is
/// deeper than both ends.
pub fn find_spots(kind: &Kind, obstacles: &[Obstacle], time: f64, at: impl Fn(usize) -> Vec3, spots: &mut Vec<Spot>) {
    spots.clear();
    for (number, obstacle) in obstacles.iter().enumerate() {
        let begin = spots.len();
        spots.extend((0..kind.atoms()).map(|atom| Spot::of_atom(number, atom, obstacle.beside(time, &at(atom)))));
        if obstacle.is_flat() {
            continue;
        }
        for edge in &kind.edges {
            let ends = edge.map(|atom| spots[begin + atom as usize]);
            spots.extend(deepest_of_edge(obstacle, time, &at, ends));
        }
    }
}

/// The deepest point of an edge between two spots of atoms, if it is deeper than both.
fn deepest_of_edge(obstacle: &Obstacle, time: f64, at: impl Fn(usize) -> Vec3, ends: [Spot; 2]) -> Option<Spot> {
    let atoms = ends.map(|end| end.atoms[0]);
    let [a, b] = atoms.map(at);
    let along = b - a;
    // The slopes of the gap along the edge at its ends.
    let [mut low, mut high] = [ends[0].normal.dot(&along), ends[1].normal.dot(&along)];
    if low >= 0.0 || high <= 0.0 || 0.5 * (ends[0].gap + ends[1].gap) > NEAR * along.norm() {
        return None;
    }
    let [mut from, mut to] = [0.0, 1.0];
    let mut share = 0.5;
    for _ in 0..SEARCH {
        let secant = from - low * (to - from) / (high - low);
        share = if secant > from && secant < to { secant } else { 0.5 * (from + to) };
        let slope = obstacle.beside(time, &(a + share * along)).normal.dot(&along);
        // Regula falsi after Illinois: an end that stays counts half.
        if slope < 0.0 {
            (from, low, high) = (share, slope, 0.5 * high);
        } else {
            (to, high, low) = (share, slope, 0.5 * low);
        }
        if slope.abs() <= FOUND * along.norm() || to - from < FOUND {
            break;
        }
    }
    let Beside { gap, normal } = obstacle.beside(time, &(a + share * along));
    let is_deepest = gap < ends[0].gap && gap < ends[1].gap;
    is_deepest.then_some(Spot { obstacle: ends[0].obstacle, atoms, shares: [1.0 - share, share], gap, normal })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{self, Turned, icosphere};

    #[test]
    fn an_edge_over_a_ball_is_deepest_where_it_is_nearest_to_its_middle() {
        let ball = Obstacle {
            name: "ball".into(),
            surface: geometry::Obstacle::Turned(Turned::ball(1.0, Vec3::zeros()).into()),
            going: None,
        };
        let kind = Kind::new("a", icosphere(2.0, 2), Vec::new());
        // The whole mesh beside the ball, so that some facets lie over it.
        let at = |atom: usize| kind.rest.positions[atom] + Vec3::new(0.1, 0.2, -2.9);
        let mut spots = Vec::new();
        find_spots(&kind, &[ball], 0.0, at, &mut spots);
        let edges: Vec<&Spot> = spots.iter().skip(kind.atoms()).collect();
        assert!(edges.len() > 5, "{}", edges.len());
        for spot in edges {
            let [a, b] = spot.atoms.map(at);
            let along = b - a;
            let share = -a.dot(&along) / along.norm_squared();
            assert!((spot.shares[1] - share).abs() < 1e-7, "{share} {spot:?}");
            assert!((spot.gap - ((a + share * along).norm() - 1.0)).abs() < 1e-13, "{spot:?}");
        }
    }
}
