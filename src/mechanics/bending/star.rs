//! An atom and the ring of its neighbours: how much the surface bends around it, over how much area, and the gradient of both.
//!
//! `M = Σ l tan(θ/2)` over the sides to its neighbours, eq. (bending.2), and `A` the Voronoi area where facets are acute,
//! eq. (bending.3). Nothing but roots and quotients is needed.

use crate::mechanics::lanes::{Real, V3, Vectors};
use crate::mechanics::tangent::matrix::Blocks;

/// Neighbours whose facets are kept from one pass to the next; of atoms with more, those beyond are measured again.
pub(super) const KEPT: usize = 10;

/// Doubled areas below this (µm²) count as this.
const TINY: f64 = 1e-50;

/// 1 + cos θ below this counts as this: θ of 169°, where tan(θ/2) is 10.
const FOLDED: f64 = 0.02;

/// How far the area of an atom goes from a third of its facets' areas, over that third.
const RANGE: f64 = 0.7;

/// A facet at the atom, from one neighbour to the next.
#[derive(Clone, Copy)]
struct Facet<T> {
    /// From the atom to both neighbours, µm.
    sides: [V3<T>; 2],
    /// Squares of both, and their product, µm².
    squares: [T; 2],
    product: T,
    /// Twice the area vector, µm².
    normal: V3<T>,
    /// Its length, and one over it.
    doubled: T,
    inverse: T,
    /// What of it is nearer to the atom than to both neighbours, µm², where its angles are acute.
    voronoi: T,
}

/// The fold along a side of length l.
#[derive(Clone, Copy)]
struct Fold<T> {
    /// tan(θ/2)/l, 1/µm.
    bend: T,
    /// ∂ tan(θ/2)/∂θ.
    turn: T,
}

/// The facets and folds of one ring after the other.
pub(super) struct Kept<T>([(Facet<T>, Fold<T>); KEPT]);

/// A ring in the current shape.
pub(super) struct Star<'a, T: Real> {
    x: &'a Vectors<'a, T>,
    atom: u32,
    here: V3<T>,
    ring: &'a [u32],
    kept: &'a Kept<T>,
    /// M, the integral of both principal curvatures' sum over the atom's share of the surface, µm.
    pub bent: T,
    /// A, the atom's share of the surface, µm².
    pub area: T,
    /// The derivatives of A by a third of the facets' areas and by their Voronoi areas.
    by_third: T,
    by_voronoi: T,
}

impl<T: Real> Kept<T> {
    /// Room for one ring.
    #[inline(always)]
    pub fn new(token: T::Token) -> Self {
        let (zero, none) = (V3::zero(token), T::constant(token, 0.0));
        let (sides, squares) = ([zero; 2], [none; 2]);
        let facet = Facet { sides, squares, product: none, normal: zero, doubled: none, inverse: none, voronoi: none };
        Self([(facet, Fold { bend: none, turn: none }); KEPT])
    }
}

impl<'a, T: Real> Star<'a, T> {
    /// Measures the ring of an atom, whose neighbours stand in the order of its facets.
    #[inline(always)]
    pub fn measure(x: &'a Vectors<'a, T>, atom: usize, ring: &'a [u32], kept: &'a mut Kept<T>) -> Self {
        let (zero, one) = (T::constant(x.token, 0.0), T::constant(x.token, 1.0));
        let (here, count) = (x.get(atom), ring.len());
        let (mut bent, mut doubled, mut voronoi) = (zero, zero, zero);
        let mut before = Facet::measure(x, here, ring, count - 1);
        for k in 0..count {
            let facet = Facet::measure(x, here, ring, k);
            let fold = Fold::between(x.token, &before, &facet);
            bent += fold.bend * facet.squares[0];
            doubled += facet.doubled;
            voronoi += facet.voronoi;
            if k < KEPT {
                kept.0[k] = (facet, fold);
            }
            before = facet;
        }
        // A = T (1 + r s(t)) with t = (V/T − 1)/r and s = t/(1 + t⁴)^¼, which is t but for its fifth power.
        let third = doubled * (1.0 / 6.0);
        let share = voronoi / third;
        let t = (share + -1.0) * (1.0 / RANGE);
        let fourth = t * t * t * t + 1.0;
        let root = one / fourth.sqrt().sqrt();
        let (limited, by_voronoi) = (t * root * RANGE + 1.0, root / fourth);
        let by_third = limited - by_voronoi * share;
        Self { x, atom: atom as u32, here, ring, kept, bent, area: third * limited, by_third, by_voronoi }
    }

    /// Tells `each` the derivative of `by_bent`·M + `by_area`·A by the position of each neighbour, eq. (bending.4). That by the atom's
    /// own is minus the sum of all.
    #[inline(always)]
    pub fn gradients(&self, by_bent: T, by_area: T, mut each: impl FnMut(usize, V3<T>)) {
        let weights = self.weights(by_bent, by_area);
        let last = self.ring.len() - 1;
        let (mut facet, mut fold) = self.get(0);
        let mut from_before = {
            let (facet, before) = self.get(last);
            facet.pulls([before, fold], weights)[1]
        };
        for k in 0..=last {
            let (next, after) = self.get(if k == last { 0 } else { k + 1 });
            let [here, there] = facet.pulls([fold, after], weights);
            each(k, from_before + here);
            (facet, fold, from_before) = (next, after, there);
        }
    }

    /// The one of neighbour k.
    #[inline(always)]
    pub fn gradient(&self, k: usize, by_bent: T, by_area: T) -> V3<T> {
        let weights = self.weights(by_bent, by_area);
        let last = self.ring.len() - 1;
        let (back, next) = (if k == 0 { last } else { k - 1 }, if k == last { 0 } else { k + 1 });
        let ((facet, fold), (earlier, before)) = (self.get(k), self.get(back));
        earlier.pulls([before, fold], weights)[1] + facet.pulls([fold, self.get(next).1], weights)[0]
    }

    /// The derivatives of what is asked for by M, by the doubled area of a facet and by its Voronoi area.
    #[inline(always)]
    fn weights(&self, by_bent: T, by_area: T) -> [T; 3] {
        [by_bent, self.by_third * by_area * (1.0 / 6.0), self.by_voronoi * by_area]
    }

    /// Adds the stiffness across the facet from neighbour k to the next of a tension in it (pN/µm).
    #[inline(always)]
    pub fn add_tension(&self, k: usize, tension: T, blocks: &mut Blocks<T>) {
        let facet = self.get(k).0;
        let next = if k + 1 == self.ring.len() { 0 } else { k + 1 };
        let atoms = [self.atom, self.ring[k], self.ring[next]];
        let [u, v] = facet.sides;
        blocks.add_tension(atoms, [v - u, -v, u], facet.normal.times(facet.inverse), tension * facet.inverse * 0.5);
    }

    #[inline(always)]
    fn get(&self, k: usize) -> (Facet<T>, Fold<T>) {
        if k < KEPT {
            return self.kept.0[k];
        }
        let facet = |k: usize| Facet::measure(self.x, self.here, self.ring, k);
        (facet(k), Fold::between(self.x.token, &facet(k - 1), &facet(k)))
    }
}

impl<T: Real> Facet<T> {
    /// The facet from neighbour k to the next.
    #[inline(always)]
    fn measure(x: &Vectors<T>, here: V3<T>, ring: &[u32], k: usize) -> Self {
        let next = if k + 1 == ring.len() { 0 } else { k + 1 };
        let sides = [x.get(ring[k] as usize) - here, x.get(ring[next] as usize) - here];
        let normal = sides[0].cross(sides[1]);
        let doubled = normal.squared().sqrt().max(T::constant(x.token, TINY));
        let (inverse, product) = (T::constant(x.token, 1.0) / doubled, sides[0].dot(sides[1]));
        let squares @ [p, q] = [sides[0].squared(), sides[1].squared()];
        // (|e|² cot + |e'|² cot')/8 with the angles across both sides.
        let voronoi = (p * q * 2.0 - product * (p + q)) * inverse * 0.125;
        Self { sides, squares, product, normal, doubled, inverse, voronoi }
    }

    /// What of the derivatives by the ends of both sides comes from this facet and the folds along them, the first of which has its own
    /// length in M; with the derivatives by M, by the doubled area and by the Voronoi area.
    #[inline(always)]
    fn pulls(&self, [fold, after]: [Fold<T>; 2], [by_bent, by_doubled, by_voronoi]: [T; 3]) -> [V3<T>; 2] {
        let [p, q] = self.squares;
        let lift = self.normal.times(self.inverse * self.inverse * by_bent);
        let lifted = [self.product * fold.turn - q * after.turn, self.product * after.turn - p * fold.turn];
        let eighth = by_voronoi * self.inverse * 0.125;
        let on_doubled = (by_doubled - by_voronoi * self.voronoi * self.inverse) * self.inverse;
        let across = eighth * (p + q) + on_doubled * self.product;
        let along = |other: T| eighth * (other * 2.0 - self.product) * 2.0 + on_doubled * other;
        let [u, v] = self.sides;
        [
            lift.times(lifted[0]) + u.times(along(q) + fold.bend * by_bent) - v.times(across),
            lift.times(lifted[1]) + v.times(along(p)) - u.times(across),
        ]
    }
}

impl<T: Real> Fold<T> {
    /// The fold along the first side of a facet, positive where the surface is convex; `before` is the facet on its other side.
    #[inline(always)]
    fn between(token: T::Token, before: &Facet<T>, facet: &Facet<T>) -> Self {
        let scale = before.inverse * facet.inverse;
        let cosine = before.normal.dot(facet.normal) * scale;
        let (zero, one, least) = (T::constant(token, 0.0), T::constant(token, 1.0), T::constant(token, FOLDED));
        let above = cosine + 1.0;
        let inverse = one / above.max(least);
        // 1 but where the fold counts as another, and 0 there.
        let is_true = ((above + -FOLDED) * 1e300).max(zero).min(one);
        // sin θ = −l (N·e)/(|N| |N'|) with the side e before and its facet N'.
        let bend = -(facet.normal.dot(before.sides[0]) * scale * inverse);
        Self { bend, turn: (cosine + is_true * (-cosine + 1.0)) * inverse }
    }
}
