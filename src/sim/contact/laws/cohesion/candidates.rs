//! Facets that may attract the points of a facet, and how near each can at best be: what is surely farther than the best is not looked at.

use pulp::{Arch, Simd, WithSimd};

use crate::Vec3;
use crate::contact::SURELY;

/// A facet at an instant.
#[derive(Debug, Clone, Copy)]
pub struct Facet {
    /// Its unit normal; zero where it has no area.
    pub normal: Vec3,
    /// Its middle, µm.
    pub middle: Vec3,
    /// From there to its farthest corner, µm.
    pub radius: f64,
}

impl Facet {
    /// The facet with these corners.
    pub fn of(corners: &[Vec3; 3]) -> Self {
        let [a, b, c] = corners;
        let middle = (a + b + c) / 3.0;
        let squared = corners.iter().map(|corner| (corner - middle).norm_squared()).fold(0.0, f64::max);
        Self { normal: (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default(), middle, radius: squared.sqrt() }
    }
}

/// Facets that may attract points of a facet, number by number: their middles and unit normals axis by axis, and from there to their
/// farthest corners, µm. What stands beyond their count is of no account.
#[derive(Debug, Clone, Default)]
pub struct Candidates {
    /// Which they are, numbered through all bodies.
    pub facets: Vec<u32>,
    middles: [Vec<f64>; 3],
    normals: [Vec<f64>; 3],
    radii: Vec<f64>,
    count: usize,
    /// The least opening that each can have to the facet, or to each of its points, µm: all candidates for a point after those for the one
    /// before.
    bounds: Vec<f64>,
}

/// The three corners of the facet that is looked at, its unit normal, and what sticks out of it.
#[derive(Debug, Clone, Copy)]
pub struct Looking {
    facet: Facet,
    /// A corner of each side, and the unit normal of the side in the plane of the facet, to its outside.
    sides: [(Vec3, Vec3); 3],
}

impl Looking {
    /// That with these corners.
    pub fn from(facet: Facet, corners: &[Vec3; 3]) -> Self {
        let side = |k: usize| {
            let along = corners[(k + 1) % 3] - corners[k];
            (corners[k], along.cross(&facet.normal).try_normalize(0.0).unwrap_or_default())
        };
        Self { facet, sides: [side(0), side(1), side(2)] }
    }
}

impl Candidates {
    /// Makes room for so many, and forgets what was there.
    pub fn empty_for(&mut self, most: usize) {
        self.count = 0;
        if self.facets.len() < most {
            self.facets.resize(most, 0);
            let Self { middles, normals, radii, .. } = self;
            middles.iter_mut().chain(normals).chain([radii]).for_each(|numbers| numbers.resize(most, 0.0));
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Adds a facet if it `counts`. There must be room for it.
    #[inline]
    pub fn add_if(&mut self, counts: bool, number: u32, facet: &Facet) {
        // Written in any case: whether it counts can be foreseen by no processor.
        let at = self.count;
        self.facets[at] = number;
        for axis in 0..3 {
            self.middles[axis][at] = facet.middle[axis];
            self.normals[axis][at] = facet.normal[axis];
        }
        self.radii[at] = facet.radius;
        self.count += usize::from(counts);
    }

    /// Adds that with a number of others if it `counts`. There must be room for it.
    #[inline]
    fn take_if(&mut self, counts: bool, others: &Self, number: usize) {
        let at = self.count;
        self.facets[at] = others.facets[number];
        for axis in 0..3 {
            self.middles[axis][at] = others.middles[axis][number];
            self.normals[axis][at] = others.normals[axis][number];
        }
        self.radii[at] = others.radii[number];
        self.count += usize::from(counts);
    }

    /// Adds those of others in a range of their numbers that have a bound less than the `widest`, µm.
    pub fn take_nearer(&mut self, others: &Self, numbers: std::ops::Range<usize>, widest: f64) {
        for number in numbers {
            self.take_if(others.bounds[number] < widest, others, number);
        }
    }

    /// Finds how near each can be to the points of a facet, from the side to which its normal points, and from the other one if it has two.
    pub fn bound_all(&mut self, of: &Looking, has_two: bool) {
        let (seen, to) = self.seen(1);
        let n = [of.facet.normal.x, of.facet.normal.y, of.facet.normal.z];
        Arch::new().dispatch(ToFacet { of, n, other: has_two.then(|| n.map(|axis| -axis)), seen, to });
    }

    /// Finds how near each can be to each of some points of a surface with the unit normal n.
    pub fn bound(&mut self, points: impl ExactSizeIterator<Item = Vec3>, n: Vec3) {
        let (seen, to) = self.seen(points.len());
        if seen.radii.is_empty() {
            return;
        }
        for (x, to) in points.zip(to.chunks_exact_mut(seen.radii.len())) {
            Arch::new().dispatch(ToPoint { x: [x.x, x.y, x.z], n: [n.x, n.y, n.z], seen, to });
        }
    }

    /// All of them, and where their bounds to so many points go.
    fn seen(&mut self, points: usize) -> (Columns<'_>, &mut [f64]) {
        let Self { middles, normals, radii, count, bounds, .. } = self;
        let most = points * *count;
        bounds.resize(most.max(bounds.len()), 0.0);
        let [middles, normals] = [middles, normals].map(|axes| axes.each_ref().map(|axis| &axis[..*count]));
        (Columns { middles, normals, radii: &radii[..*count] }, &mut bounds[..most])
    }

    /// How near each can be to one of the points, µm.
    pub fn bounds_of(&self, point: usize) -> &[f64] {
        &self.bounds[point * self.count..][..self.count]
    }
}

/// What a point may be behind a facet, and beside it there, and still be looked at, over the size of the facet.
const BEHIND: f64 = 0.2;

type V = [f64; 3];

/// A facet that is seen: as [`Facet`].
#[derive(Clone, Copy)]
struct Seen {
    middle: V,
    normal: V,
    radius: f64,
}

/// Facets that are seen, axis by axis.
#[derive(Clone, Copy)]
struct Columns<'a> {
    middles: [&'a [f64]; 3],
    normals: [&'a [f64]; 3],
    radii: &'a [f64],
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
struct ToPoint<'a> {
    x: V,
    n: V,
    seen: Columns<'a>,
    to: &'a mut [f64],
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
struct ToFacet<'a> {
    of: &'a Looking,
    n: V,
    other: Option<V>,
    seen: Columns<'a>,
    to: &'a mut [f64],
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
/// around the facet, and of the one that just touches its plane, the greater of the two.
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

/// The least opening, µm, that a facet can have to any point of another one, as seen from the side of the other to which n looks.
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

/// How far apart two facets are beyond what may meet, µm: below 0 where they may.
pub fn apart(own: &Facet, n: Vec3, facet: &Facet, range: f64) -> f64 {
    let from = own.middle + 0.5 * range * n - facet.middle;
    from.norm() - own.radius - 0.5 * range - (1.0 + BEHIND) * facet.radius
}

/// By how much a facet may have come nearer to others at most since it was so, in what [`apart`] measures, be it the one that looks or the
/// one that is seen.
pub fn nearer(now: &Facet, then: &Facet, range: f64) -> f64 {
    let grown = (1.0 + BEHIND) * (now.radius - then.radius).max(0.0);
    (now.middle - then.middle).norm() + 0.5 * range * (now.normal - then.normal).norm() + grown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::opening_to_facet;
    use crate::random::{Purpose, Stream};

    fn only(facet: &Facet) -> Candidates {
        let mut candidates = Candidates::default();
        candidates.empty_for(1);
        candidates.add_if(true, 7, facet);
        candidates
    }

    #[test]
    fn no_facet_is_nearer_than_its_bound() {
        let mut stream = Stream::new(11, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let (mut seen, mut near) = (0, 0);
        for _ in 0..20_000 {
            let corners = [0, 1, 2].map(|_| Vec3::new(number(), number(), number()));
            let m = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
            let n = Vec3::new(number(), number(), number()).normalize();
            let x = 2.0 * Vec3::new(number(), number(), number());
            let mut candidates = only(&Facet::of(&corners));
            candidates.bound([x].into_iter(), n);
            let bound = candidates.bounds_of(0)[0];
            let Some((opening, _)) = opening_to_facet(x, n, &corners, m) else { continue };
            seen += 1;
            near += usize::from(opening.width < 2.0 * bound);
            assert!(opening.width < 0.0 && bound <= 1e-9 || bound <= opening.width, "{bound} {opening:?}");
        }
        assert!(seen > 5000 && near > seen / 4, "bounds of {near} of {seen} facets tell something");
    }

    #[test]
    fn a_facet_that_a_point_is_behind_and_a_little_beside_is_not_passed_over() {
        let mut stream = Stream::new(13, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let (mut seen, mut outside) = (0, 0);
        for _ in 0..20_000 {
            let corners = [0, 1, 2].map(|_| Vec3::new(number(), number(), number()));
            let twice = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            let m = twice.normalize();
            let n = (0.3 * Vec3::new(number(), number(), number()) - m).normalize();
            // Around the first corner, on all sides of it.
            let (v, w, behind) = (0.03 * number(), 0.03 * number(), 0.03 * number().abs());
            let at = (1.0 - v - w) * corners[0] + v * corners[1] + w * corners[2];
            let x = at - behind * twice.norm().sqrt() * m;
            let found = opening_to_facet(x, n, &corners, m).filter(|(opening, _)| opening.width < 0.0);
            if found.is_none() {
                continue;
            }
            let facet = Facet::of(&corners);
            let mut candidates = only(&facet);
            candidates.bound([x].into_iter(), n);
            let of_point = candidates.bounds_of(0)[0];
            let point = Facet { normal: n, middle: x, radius: 0.0 };
            candidates.bound_all(&Looking::from(point, &[x; 3]), false);
            assert_eq!([of_point, candidates.bounds_of(0)[0]], [0.0, 0.0], "{found:?} {corners:?}");
            assert!(apart(&point, n, &facet, 0.0) <= 0.0);
            seen += 1;
            outside += usize::from((x - facet.middle).norm() > facet.radius);
        }
        assert!(seen > 2000 && outside > 100, "{outside} of {seen} are outside the sphere around the facet");
    }

    #[test]
    fn facets_come_nearer_by_no_more_than_both_have_changed() {
        let mut stream = Stream::new(13, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let mut close: f64 = 0.0;
        for _ in 0..5_000 {
            let mut corners = |size: f64| [0, 1, 2].map(|_| size * Vec3::new(number(), number(), number()));
            let then = [corners(1.0), corners(1.0).map(|corner| corner + Vec3::new(2.0, 0.0, 0.0))];
            let now = then.map(|facet| {
                let moved = corners(0.2);
                [0, 1, 2].map(|corner| facet[corner] + moved[corner])
            });
            let ([own, other], [own_now, other_now]) = (then.map(|at| Facet::of(&at)), now.map(|at| Facet::of(&at)));
            let before = apart(&own, own.normal, &other, 1.5);
            let after = apart(&own_now, own_now.normal, &other_now, 1.5);
            let most = nearer(&own_now, &own, 1.5) + nearer(&other_now, &other, 1.5);
            assert!(before - after <= most + 1e-12, "{before} {after} {most}");
            close = close.max((before - after) / most);
        }
        assert!(close > 0.5, "the bound tells something: {close}");
    }

    #[test]
    fn no_point_of_a_facet_is_nearer_to_another_than_their_bound() {
        let mut stream = Stream::new(12, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let (mut seen, mut near) = (0, 0);
        for _ in 0..20_000 {
            let mut corners = || [0, 1, 2].map(|_| Vec3::new(number(), number(), number()));
            let (own, there) = (corners(), corners());
            let own = own.map(|corner| 0.5 * corner + Vec3::new(1.0, 0.0, 0.0));
            let (facet, other) = (Facet::of(&there), Facet::of(&own));
            let mut candidates = only(&facet);
            candidates.bound_all(&Looking::from(other, &own), false);
            let bound = candidates.bounds_of(0)[0];
            let mut widths = Vec::new();
            for [u, v] in [[0.01, 0.01], [0.98, 0.01], [0.01, 0.98], [0.3, 0.3]] {
                let x = (1.0 - u - v) * own[0] + u * own[1] + v * own[2];
                widths.extend(opening_to_facet(x, other.normal, &there, facet.normal).map(|found| found.0.width));
            }
            let Some(least) = widths.into_iter().reduce(f64::min) else { continue };
            seen += 1;
            near += usize::from(bound > 0.0);
            assert!(least < 0.0 && bound <= 1e-9 || bound <= least, "{bound} {least}");
            assert!(apart(&other, other.normal, &facet, least.max(0.0) + 1e-9) <= 0.0, "{least}");
        }
        assert!(seen > 5000 && near > seen / 4, "bounds of {near} of {seen} pairs tell something");
    }
}
