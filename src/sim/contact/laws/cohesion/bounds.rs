//! Which facets may be nearer to points than what is known to attract these, for as many at a time as registers hold: the others are surely
//! not, and are not looked at.

use pulp::{Simd, WithSimd};

use super::facet::BEHIND;
use crate::contact::SURELY;
use crate::contact::lanes::{V, dot, lane, minus};

/// Facets of a block.
pub const FACETS: usize = 8;

/// Numbers of all facets of a block side by side.
pub type Row = [f64; FACETS];

/// Some facets that are seen, as [`Facet`](super::facet::Facet) has each.
#[derive(Debug, Clone, Copy, Default)]
pub struct Block {
    pub middles: [Row; 3],
    pub normals: [Row; 3],
    pub radii: Row,
    /// The points that each may be near enough to: a bit for each point, up to 52 of which a number holds exactly.
    pub may: Row,
}

/// A point that is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Looked {
    /// Where it is, µm.
    pub x: V,
    /// How wide the opening to a facet is at most that matters to it, µm.
    pub widest: f64,
}

/// Finds which facets may be near enough to which of the points of a surface with the unit normal n. Closures would be compiled for the
/// least of processors.
pub struct ToPoints<'a> {
    pub n: V,
    pub points: &'a [Looked],
    /// The number of the first of these points.
    pub first: usize,
    pub blocks: &'a mut [Block],
}

impl WithSimd for ToPoints<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { n, points, first, blocks } = self;
        for Block { middles, normals, radii, may } in blocks {
            let (mut along, mut strays) = ([0.0; FACETS], [0.0; FACETS]);
            for k in 0..FACETS {
                along[k] = dot(n, lane(normals, k));
                // How high points of a facet are over its middle, along n.
                strays[k] = radii[k] * (most(1.0 - along[k] * along[k], 0.0).sqrt() + BEHIND);
            }
            for (number, &Looked { x, widest }) in (first..).zip(points) {
                let bit = (1_u64 << number) as f64;
                for k in 0..FACETS {
                    let from = minus(x, lane(middles, k));
                    let far = is_surely_farther(widest, from, n, lane(normals, k), (radii[k], along[k], strays[k]));
                    may[k] += if far { 0.0 } else { bit };
                }
            }
        }
    }
}

#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Whether a facet with a unit normal and radius surely has no opening to a point with the unit normal n that is less than the `widest`, µm:
/// a ball so wide does not reach to the plane of the facet or to the disc around it there, or all of it lies below the surface. `from`
/// leads from its middle to the point.
#[inline(always)]
fn is_surely_farther(widest: f64, from: V, n: V, normal: V, (radius, along, strays): (f64, f64, f64)) -> bool {
    let (height, over, squared) = (dot(from, normal), dot(from, n), dot(from, from));
    let is_before = height > 0.0;
    let is_below = strays <= over;
    // The ball's middle: how far it is from that of the facet, squared, and how high over its plane. Its own radius is half of the widest.
    let half = 0.5 * widest;
    let (apart, over_plane) = (squared + widest * over + half * half, height + half * along);
    let aside = most(apart - over_plane * over_plane, 0.0);
    // It is out of reach if aside + disc² + height² − 2 disc √aside is more than the radius of the ball squared. What is behind a facet and
    // only a little beside it touches it without a ball.
    let disc = if is_before { radius } else { (1.0 + BEHIND) * radius };
    let beyond = SURELY * (apart + disc * disc) - half * half;
    let is_out = is_before | (squared > disc * disc);
    let reaches = (aside <= disc * disc) | (beyond <= 0.0) | (SURELY * beyond * beyond < 4.0 * disc * disc * aside);
    let height = if is_before { height } else { -height - BEHIND * radius };
    let level = most(if is_before { 1.0 - along } else { 1.0 + along }, f64::MIN_POSITIVE);
    is_below | (is_out & !reaches) | (SURELY * 2.0 * height >= widest * level)
}
