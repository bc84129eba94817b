//! Openings between points and facets, eq. (contacts.13), for as many pairs at a time as registers hold: number by number what
//! [`opening_to_facet`](super::opening_to_facet) has for each, in the same bits.

use pulp::{Arch, Simd, WithSimd};

use super::closest::Feature;
use super::lanes::{V, dot, lane, minus};
use super::opening::{BEHIND, BESIDE, FACING, LEVEL};
use crate::Vec3;

/// Pairs that are worked out at a time.
pub const PAIRS: usize = 8;

/// Numbers of all pairs side by side.
type Row = [f64; PAIRS];

/// Pairs of points and facets, and the openings between them.
#[derive(Debug, Clone, Default)]
pub struct Openings {
    /// Points, µm, and the unit normals of their surfaces.
    x: [Row; 3],
    n: [Row; 3],
    /// Corners of facets, µm, and their unit normals.
    corners: [[Row; 3]; 3],
    m: [Row; 3],
    /// Widths, µm, and what is touched, by the number that [`feature`] knows.
    width: Row,
    touched: Row,
}

/// Number of an opening that is not there, of a face, of the first of three sides and of the first of three corners.
const NOTHING: f64 = -1.0;
const FACE: f64 = 0.0;
const SIDES: f64 = 1.0;
const CORNERS: f64 = 4.0;

impl Openings {
    /// Puts a pair in a lane: a point x with the unit normal n of its surface, and a facet with its unit normal m.
    #[inline]
    pub fn put(&mut self, lane: usize, (x, n): (Vec3, Vec3), corners: &[Vec3; 3], m: Vec3) {
        for axis in 0..3 {
            self.x[axis][lane] = x[axis];
            self.n[axis][lane] = n[axis];
            self.m[axis][lane] = m[axis];
            (0..3).for_each(|corner| self.corners[corner][axis][lane] = corners[corner][axis]);
        }
    }

    /// Works out the openings of all lanes; what a lane without a pair holds is of no account.
    pub fn find(&mut self) {
        Arch::new().dispatch(Find(self));
    }

    /// The width of the opening of a lane, µm, and what is touched, if there is one.
    #[inline]
    pub fn of(&self, lane: usize) -> Option<(f64, Feature)> {
        feature(self.touched[lane]).map(|feature| (self.width[lane], feature))
    }
}

/// What is touched by its number.
fn feature(number: f64) -> Option<Feature> {
    match number as i8 {
        side @ 1..=3 => Some(Feature::Side(side as u8 - 1)),
        corner @ 4..=6 => Some(Feature::Corner(corner as u8 - 4)),
        0 => Some(Feature::Face),
        _ => None,
    }
}

struct Find<'a>(&'a mut Openings);

impl WithSimd for Find<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Openings { x, n, corners, m, width, touched } = self.0;
        for k in 0..PAIRS {
            let corners = [lane(&corners[0], k), lane(&corners[1], k), lane(&corners[2], k)];
            (width[k], touched[k]) = opening(lane(x, k), lane(n, k), corners, lane(m, k));
        }
    }
}

#[inline(always)]
fn plus(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn times(a: f64, b: V) -> V {
    [a * b[0], a * b[1], a * b[2]]
}

#[inline(always)]
fn choose(first: bool, a: V, b: V) -> V {
    [if first { a[0] } else { b[0] }, if first { a[1] } else { b[1] }, if first { a[2] } else { b[2] }]
}

/// A ball that may be the one: its width, where it leads to over `across`, and the number of what it touches.
#[derive(Clone, Copy)]
struct Ball {
    width: f64,
    to: V,
    across: f64,
    touched: f64,
}

/// The ball of a plane, and where it touches that in weights of corners of a facet.
#[derive(Clone, Copy)]
struct OnPlane {
    ball: Ball,
    weights: V,
    is_there: bool,
}

/// As [`opening_to_facet`](super::opening_to_facet), without branches.
#[inline(always)]
fn opening(x: V, n: V, corners: [V; 3], m: V) -> (f64, f64) {
    let [a, b, c] = corners;
    let (one, other) = (minus(b, a), minus(c, a));
    let height = dot(minus(x, a), m);
    let twice = [
        one[1] * other[2] - one[2] * other[1],
        one[2] * other[0] - one[0] * other[2],
        one[0] * other[1] - one[1] * other[0],
    ];
    let size = dot(twice, twice).sqrt().sqrt();
    let beside = -height / size;
    let beside = if beside > 0.0 { beside } else { 0.0 };
    let is_before = height >= 0.0;
    let faces = is_before | ((dot(n, m) < FACING) & (-height <= BEHIND * size));
    let plane = on_plane(x, n, a, [one, other], m, height);
    let is_within = (plane.weights[0] >= -beside) & (plane.weights[1] >= -beside) & (plane.weights[2] >= -beside);
    let meets_face = plane.is_there & faces & is_within;
    let behind = on_plane(x, n, a, [one, other], times(-1.0, m), -height);
    let is_met = if is_before { plane.is_there } else { behind.is_there };
    let [u, v, w] = choose(is_before, plane.weights, behind.weights);
    let [u, v, w] = [is_met & (u <= 0.0), is_met & (v <= 0.0), is_met & (w <= 0.0)];
    let any = !(u | v | w);
    let from = [minus(a, x), minus(b, x), minus(c, x)];
    let none = Ball { width: f64::INFINITY, to: n, across: 1.0, touched: NOTHING };
    let best = nearer(none, (any | w) & !meets_face, on_side(n, from[0], minus(b, a), 0.0));
    let best = nearer(best, (any | u) & !meets_face, on_side(n, from[1], minus(c, b), 1.0));
    let best = nearer(best, (any | v) & !meets_face, on_side(n, from[2], minus(a, c), 2.0));
    let best = pick(meets_face, plane.ball, best);
    let towards = [best.to[0] / best.across, best.to[1] / best.across, best.to[2] / best.across];
    (best.width, if dot(towards, towards) <= BESIDE { best.touched } else { NOTHING })
}

#[inline(always)]
fn pick(first: bool, a: Ball, b: Ball) -> Ball {
    Ball {
        width: if first { a.width } else { b.width },
        to: choose(first, a.to, b.to),
        across: if first { a.across } else { b.across },
        touched: if first { a.touched } else { b.touched },
    }
}

/// The better of a ball and another one, where that counts and is there.
#[inline(always)]
fn nearer(best: Ball, counts: bool, other: Ball) -> Ball {
    pick(counts & (other.touched >= 0.0) & ((best.touched < 0.0) | (other.width < best.width)), other, best)
}

/// The ball on the plane of a facet from one of its sides, from a corner of it and the ways from there to the others.
#[inline(always)]
fn on_plane(x: V, n: V, corner: V, [one, other]: [V; 2], m: V, height: f64) -> OnPlane {
    let apart = 1.0 - dot(n, m);
    let (width, to) = (2.0 * height / apart, minus(n, m));
    let foot = minus(plus(x, times(0.5 * width, to)), corner);
    let (a, b, c) = (dot(one, one), dot(one, other), dot(other, other));
    let (d, e) = (dot(foot, one), dot(foot, other));
    let det = a * c - b * b;
    let (v, w) = ((c * d - b * e) / det, (a * e - b * d) / det);
    let is_there = (apart > LEVEL) & (det > 0.0);
    OnPlane { ball: Ball { width, to, across: apart, touched: FACE }, weights: [1.0 - v - w, v, w], is_there }
}

/// The ball on a side of a facet, its number told: from the point to the corner where it begins, and from there along it.
#[inline(always)]
fn on_side(n: V, from: V, along: V, side: f64) -> Ball {
    let (a, b, c) = (dot(from, from), dot(from, along), dot(along, along));
    let (d, e) = (dot(n, from), dot(n, along));
    let squared = c * (c * d * d - 2.0 * b * d * e + a * e * e);
    let root = (if squared > 0.0 { squared } else { 0.0 }).sqrt();
    let (above, below) = if d > 0.0 { (a * e - 2.0 * b * d, root + c * d) } else { (root - c * d, c * e) };
    let (share, nearest) = (above / below, -b / c);
    let share = if share.abs() < f64::INFINITY { share } else { nearest };
    let share = if share.abs() < f64::INFINITY { share } else { 0.0 };
    let share = if share < 0.0 { 0.0 } else { share };
    let share = if share > 1.0 { 1.0 } else { share };
    let to = plus(from, times(share, along));
    let (rise, squared) = (dot(n, to), dot(to, to));
    let touches = squared <= LEVEL * LEVEL * c;
    let is_there = touches | (rise > LEVEL * squared.sqrt());
    let next = if side == 2.0 { 0.0 } else { side + 1.0 };
    let touched = if share == 0.0 { CORNERS + side } else { SIDES + side };
    let touched = if share == 1.0 { CORNERS + next } else { touched };
    Ball {
        width: if touches { 0.0 } else { squared / rise },
        to: choose(touches, n, to),
        across: if touches { 1.0 } else { rise },
        touched: if is_there { touched } else { NOTHING },
    }
}

#[cfg(test)]
mod tests {
    use super::super::opening::opening_to_facet;
    use super::*;
    use crate::random::{Purpose, Stream};

    /// Holds the openings of all lanes to those of one pair at a time, and counts faces, sides, corners and none.
    fn hold(pairs: &[(Vec3, Vec3, [Vec3; 3], Vec3)], seen: &mut [usize; 4]) {
        let mut openings = Openings::default();
        for (lane, (x, n, corners, m)) in pairs.iter().enumerate() {
            openings.put(lane, (*x, *n), corners, *m);
        }
        openings.find();
        for (lane, (x, n, corners, m)) in pairs.iter().enumerate() {
            let expected = opening_to_facet(*x, *n, corners, *m).map(|(opening, feature)| (opening.width, feature));
            let found = openings.of(lane);
            let bits = |of: Option<(f64, Feature)>| of.map(|(width, feature)| (width.to_bits(), feature));
            assert_eq!(bits(found), bits(expected), "{found:?} {expected:?}: {x} {n} {corners:?}");
            seen[match found {
                Some((_, Feature::Face)) => 0,
                Some((_, Feature::Side(_))) => 1,
                Some((_, Feature::Corner(_))) => 2,
                None => 3,
            }] += 1;
        }
    }

    #[test]
    fn they_are_those_of_one_pair_at_a_time_in_the_same_bits() {
        let mut stream = Stream::new(21, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let mut seen = [0; 4];
        for turn in 0..8_000 {
            let pairs: [_; PAIRS] = std::array::from_fn(|lane| {
                let corners = [0, 1, 2].map(|_| Vec3::new(number(), number(), number()));
                let m = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
                let n = Vec3::new(number(), number(), number()).normalize();
                // Near and far, and every other time a little before or behind what looks at it.
                let x = if turn % 2 == 0 {
                    2.0 * Vec3::new(number(), number(), number())
                } else {
                    let (v, w) = (1.2 * number().abs(), 1.2 * number().abs());
                    (1.0 - v - w) * corners[0] + v * corners[1] + w * corners[2] + 0.05 * number() * m
                };
                (x, if lane % 2 == 0 { n } else { (0.4 * n - m).normalize() }, corners, m)
            });
            hold(&pairs, &mut seen);
        }
        assert!(seen.iter().all(|count| *count > 3_000), "{seen:?}");
    }

    #[test]
    fn they_are_so_where_things_are_level_or_touch_or_have_no_size() {
        let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        let flat = [at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0), at(0.0, 4.0, 0.0)];
        let (line, speck) = ([at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(1.0, 0.0, 0.0)], [at(0.0, 0.0, 0.0); 3]);
        let points = [
            at(0.0, 0.0, 0.0),
            at(2.0, 0.0, 0.0),
            at(2.0, 2.0, 0.0),
            at(1.0, 1.0, 0.0),
            at(1.0, 1.0, -0.05),
            at(5.0, 0.0, 0.0),
            at(-1.0, -1.0, 1.0),
            at(1.0, -1.0, 0.0),
        ];
        let mut seen = [0; 4];
        for (corners, m) in [(flat, Vec3::z()), (flat, -Vec3::z()), (line, Vec3::zeros()), (speck, Vec3::zeros())] {
            for n in [Vec3::x(), -Vec3::x(), Vec3::y(), Vec3::z(), -Vec3::z(), at(0.6, 0.0, -0.8)] {
                hold(&points.map(|x| (x, n, corners, m)), &mut seen);
            }
        }
        assert!(seen.iter().all(|count| *count > 4), "{seen:?}");
    }
}
