//! How near facets can be at best to a point or to another facet, for as many at a time as registers hold.

use pulp::{Simd, WithSimd};

use super::facet::{BEHIND, Looking};
use crate::contact::SURELY;

pub type V = [f64; 3];

/// A facet that is seen: as [`Facet`].
#[derive(Clone, Copy)]
struct Seen {
    middle: V,
    normal: V,
    radius: f64,
}

/// Facets that are seen, axis by axis.
#[derive(Clone, Copy)]
pub struct Columns<'a> {
    pub middles: [&'a [f64]; 3],
    pub normals: [&'a [f64]; 3],
    pub radii: &'a [f64],
}

impl Columns<'_> {
    /// Calls `each` with all of them, in their order.
    #[inline(always)]
    fn fill(self, to: &mut [f64], each: impl Fn(f64, Seen) -> f64) {
        let count = to.len();
        let ([x, y, z], [u, v, w]) = (self.middles.map(|axis| &axis[..count]), self.normals.map(|axis| &axis[..count]));
        let radii = &self.radii[..count];
        for k in 0..count {
            to[k] = each(to[k], Seen { middle: [x[k], y[k], z[k]], normal: [u[k], v[k], w[k]], radius: radii[k] });
        }
    }
}

/// Finds how near facets can be to a point. Closures would be compiled for the least of processors.
pub struct ToPoint<'a> {
    /// The point, µm, and the unit normal of its surface.
    pub x: V,
    pub n: V,
    pub seen: Columns<'a>,
    /// Where that goes, µm.
    pub to: &'a mut [f64],
}

impl WithSimd for ToPoint<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { x, n, seen, to } = self;
        seen.fill(
            to,
            #[inline(always)]
            |_, seen| least_opening(x, n, seen),
        );
    }
}

/// Finds how near facets can be to another one, as seen from the side to which n looks, and from the other if it has one.
pub struct ToFacet<'a> {
    pub of: &'a Looking,
    pub n: V,
    pub other: Option<V>,
    pub seen: Columns<'a>,
    /// Where that goes, µm.
    pub to: &'a mut [f64],
}

impl WithSimd for ToFacet<'_> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { of, n, other, seen, to } = self;
        seen.fill(
            to,
            #[inline(always)]
            |_, seen| least_opening_between(of, n, seen),
        );
        if let Some(n) = other {
            seen.fill(
                to,
                #[inline(always)]
                |before, seen| least(before, least_opening_between(of, n, seen)),
            );
        }
    }
}

#[inline(always)]
fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn minus(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The least opening, µm, that a facet can have to a point with the unit normal n: that of the ball that just touches the sphere
/// around the facet, and of the one that just touches its plane, the greater of the two; infinity where all of it lies below the surface.
#[inline(always)]
fn least_opening(x: V, n: V, Seen { middle, normal, radius }: Seen) -> f64 {
    let from = minus(x, middle);
    let (height, along) = (dot(from, normal), dot(n, normal));
    // What is behind a facet may be a little beside it, too.
    let sphere = if height > 0.0 { radius } else { (1.0 + BEHIND) * radius };
    // How high points of the facet are over the plane of the surface.
    let strays = radius * most(1.0 - along * along, 0.0).sqrt() + BEHIND * radius;
    let top = strays - dot(from, n);
    let squared = dot(from, from);
    let outside = most(squared - sphere * sphere, 0.0);
    let rise = sphere - dot(from, n);
    let to_sphere = if top > 0.0 { outside / rise } else { f64::INFINITY };
    let is_before = height > 0.0;
    let height = if is_before { height } else { -height - BEHIND * radius };
    let to_plane = 2.0 * most(height, 0.0) / most(if is_before { 1.0 - along } else { 1.0 + along }, f64::MIN_POSITIVE);
    SURELY * most(to_sphere, to_plane)
}

/// The least opening, µm, that a facet can have to any point of another one, as seen from the side of the other to which n looks: the greatest
/// of what [`least_opening`] has for all of these points, and what it takes to reach beyond the sides of the other.
#[inline(always)]
fn least_opening_between(of: &Looking, n: V, Seen { middle, normal, radius }: Seen) -> f64 {
    let own = of.facet;
    let from = minus([own.middle.x, own.middle.y, own.middle.z], middle);
    let (height, along) = (dot(from, normal), dot(n, normal));
    // Points of either lie in its plane: they are all as high as its middle, and stray along the normal of the other by so much.
    let sine = most(1.0 - along * along, 0.0).sqrt();
    let strays = own.radius * sine;
    let sphere = if height > strays { radius } else { (1.0 + BEHIND) * radius };
    let (rise, top) = (sphere - dot(from, n), (sine + BEHIND) * radius - dot(from, n));
    let apart = most(dot(from, from).sqrt() - own.radius, 0.0);
    let outside = most(apart * apart - sphere * sphere, 0.0);
    let to_sphere = if top > 0.0 { outside / rise } else { f64::INFINITY };
    let before = 2.0 * most(height - strays, 0.0) / most(1.0 - along, f64::MIN_POSITIVE);
    let behind = 2.0 * most(-height - strays - BEHIND * radius, 0.0) / most(1.0 + along, f64::MIN_POSITIVE);
    // A ball that rests inside a side reaches half of its width across it at most.
    let mut beyond = 0.0;
    for (corner, out) in of.sides {
        let away = dot(minus(middle, [corner.x, corner.y, corner.z]), [out.x, out.y, out.z]);
        beyond = most(beyond, away - (1.0 + BEHIND) * radius);
    }
    SURELY * most(most(to_sphere, 2.0 * beyond), most(before, behind))
}
