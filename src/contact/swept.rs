//! Whether something passed through something in a step: an atom through a facet, or an edge through an edge, when
//! all atoms move along straight lines.

use super::closest::{closest_on_facet, closest_on_segments};
use crate::Vec3;

/// Halvings of the step after which a pair that still may touch counts as touching.
const HALVINGS: u32 = 30;
/// Halvings in all that one pair may cost; then it counts as touching.
const MOST_HALVINGS: usize = 4_000;

/// The time, as a share of the step, until which an atom surely has not met a facet; none when it does not meet it.
/// Positions in µm at the start and at the end of the step; `thickness` (µm) counts as touching, at least round-off.
///
/// The four points lie in a plane when a cubic in time is zero, eq. (contacts.8). A part of the step in which the
/// cubic keeps its sign, or in which the two are farther apart than they can move, is passed; others are halved. The
/// test errs towards touching only.
pub fn atom_meets_facet(atom: [Vec3; 2], facet: [[Vec3; 3]; 2], thickness: f64) -> Option<f64> {
    let points = |end: usize| [atom[end], facet[end][0], facet[end][1], facet[end][2]];
    let distance = |[p, a, b, c]: [Vec3; 4]| closest_on_facet(p, [a, b, c]).offset.norm();
    first_meeting([points(0), points(1)], 1, distance, thickness)
}

/// The time, as a share of the step, until which two edges surely have not met; see [`atom_meets_facet`].
pub fn edges_meet(first: [[Vec3; 2]; 2], second: [[Vec3; 2]; 2], thickness: f64) -> Option<f64> {
    let points = |end: usize| [first[end][0], first[end][1], second[end][0], second[end][1]];
    let distance = |[a, b, c, d]: [Vec3; 4]| closest_on_segments([a, b], [c, d]).0.sqrt();
    first_meeting([points(0), points(1)], 2, distance, thickness)
}

/// Searches the step for the first meeting; the first `of_one` points belong to one of the two.
fn first_meeting(
    [start, end]: [[Vec3; 4]; 2],
    of_one: usize,
    distance: impl Fn([Vec3; 4]) -> f64,
    thickness: f64,
) -> Option<f64> {
    let move_of = |point: usize| end[point] - start[point];
    // What both have in common brings them no nearer.
    let common = (0..4).map(move_of).sum::<Vec3>() / 4.0;
    let fastest = |points: std::ops::Range<usize>| points.map(|k| (move_of(k) - common).norm()).fold(0.0, f64::max);
    let speed = fastest(0..of_one) + fastest(of_one..4);
    let size = (1..4).map(|k| (start[k] - start[0]).norm()).fold(speed, f64::max);
    let round_off = 1e-12 * (size + start[0].norm());
    let touching = thickness.max(round_off);
    let cubic = bernstein(start, end);
    let largest = size * size * size;
    let at = |share: f64| [0, 1, 2, 3].map(|k| start[k] + (end[k] - start[k]) * share);
    // Depth first: of each halving one part waits while the other is looked at.
    let mut parts = [(0.0, 1.0, cubic, 0); HALVINGS as usize + 2];
    let (mut waiting, mut halvings) = (1, 0);
    while waiting > 0 {
        waiting -= 1;
        let (from, to, cubic, depth) = parts[waiting];
        // The volume of four points within `touching` of each other's plane is less than this.
        let least = 16.0 * touching * size * size + 1e-13 * largest;
        if cubic.iter().all(|value| *value > least) || cubic.iter().all(|value| *value < -least) {
            continue;
        }
        let middle: f64 = 0.5 * (from + to);
        let apart = distance(at(middle));
        if apart > touching + 0.5 * speed * (to - from) {
            continue;
        }
        halvings += 1;
        if depth == HALVINGS || halvings > MOST_HALVINGS || distance(at(from)) <= touching {
            return Some(from);
        }
        let [first, second] = halves(cubic);
        parts[waiting] = (middle, to, second, depth + 1);
        parts[waiting + 1] = (from, middle, first, depth + 1);
        waiting += 2;
    }
    None
}

/// Six times the volume of the four points as a cubic in time, by its Bernstein coefficients: their sign bounds its.
fn bernstein(start: [Vec3; 4], end: [Vec3; 4]) -> [f64; 4] {
    let sides = |points: [Vec3; 4]| [1, 2, 3].map(|k| points[k] - points[0]);
    let (s, e) = (sides(start), sides(end));
    let volume = |a: Vec3, b: Vec3, c: Vec3| a.dot(&b.cross(&c));
    [
        volume(s[0], s[1], s[2]),
        (volume(e[0], s[1], s[2]) + volume(s[0], e[1], s[2]) + volume(s[0], s[1], e[2])) / 3.0,
        (volume(s[0], e[1], e[2]) + volume(e[0], s[1], e[2]) + volume(e[0], e[1], s[2])) / 3.0,
        volume(e[0], e[1], e[2]),
    ]
}

/// The coefficients of the first and the second half (de Casteljau).
fn halves([a, b, c, d]: [f64; 4]) -> [[f64; 4]; 2] {
    let (ab, bc, cd) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
    let (abc, bcd) = (0.5 * (ab + bc), 0.5 * (bc + cd));
    let middle = 0.5 * (abc + bcd);
    [[a, ab, abc, middle], [middle, bcd, cd, d]]
}
