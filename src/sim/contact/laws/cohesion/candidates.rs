//! Facets that may attract the points of a facet, and how near each can at best be: what is surely farther than the best is not looked at.

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

/// Facets that may attract points of a facet, number by number.
#[derive(Debug, Clone, Default)]
pub struct Candidates {
    /// Which they are, numbered through all bodies.
    pub facets: Vec<u32>,
    /// Their middles, µm, and unit normals, axis by axis.
    middles: [Vec<f64>; 3],
    normals: [Vec<f64>; 3],
    /// From the middle to the farthest corner, µm.
    radii: Vec<f64>,
    /// The least opening that each can have to each point, µm: all candidates for a point after those for the one before.
    bounds: Vec<f64>,
}

impl Candidates {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.facets.clear();
        self.middles.iter_mut().chain(&mut self.normals).chain([&mut self.radii]).for_each(Vec::clear);
    }

    /// Adds a facet.
    pub fn push(&mut self, number: u32, facet: &Facet) {
        self.facets.push(number);
        for axis in 0..3 {
            self.middles[axis].push(facet.middle[axis]);
            self.normals[axis].push(facet.normal[axis]);
        }
        self.radii.push(facet.radius);
    }

    /// Finds how near each can be to each of some points of a surface with the unit normal n.
    pub fn bound(&mut self, points: impl ExactSizeIterator<Item = Vec3>, n: Vec3) {
        self.bounds.resize(points.len() * self.facets.len(), 0.0);
        let arch = pulp::Arch::new();
        let Self { facets, middles: [x, y, z], normals: [u, v, w], radii, bounds } = self;
        let count = facets.len();
        if count == 0 {
            return;
        }
        for (point, bounds) in points.zip(bounds.chunks_exact_mut(count)) {
            let (x, y, z) = (&x[..count], &y[..count], &z[..count]);
            let (u, v, w, radii) = (&u[..count], &v[..count], &w[..count], &radii[..count]);
            arch.dispatch(
                #[inline(always)]
                || {
                    for k in 0..count {
                        let from = [point.x - x[k], point.y - y[k], point.z - z[k]];
                        bounds[k] = least_opening(from, [n.x, n.y, n.z], [u[k], v[k], w[k]], radii[k]);
                    }
                },
            );
        }
    }

    /// How near each can be to one of the points, µm.
    pub fn bounds_of(&self, point: usize) -> &[f64] {
        &self.bounds[point * self.facets.len()..][..self.facets.len()]
    }
}

/// What a point may be behind a facet, and beside it there, and still be looked at, over the size of the facet.
const BEHIND: f64 = 0.2;

/// The least opening, µm, that a facet can have to a point with the unit normal n that is `from` its middle: that of the ball that just touches the sphere
/// around the facet, and of the one that just touches its plane, the greater of the two.
#[inline(always)]
fn least_opening(from: [f64; 3], n: [f64; 3], m: [f64; 3], radius: f64) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (height, along) = (dot(from, m), dot(n, m));
    // What is behind a facet may be a little beside it, too.
    let sphere = if height > 0.0 { radius } else { (1.0 + BEHIND) * radius };
    let (squared, rise) = (dot(from, from), sphere - dot(from, n));
    let outside = (squared - sphere * sphere).max(0.0);
    let to_sphere = if rise > 0.0 { outside / rise } else { f64::INFINITY };
    let (height, apart) = if height > 0.0 { (height, 1.0 - along) } else { (-height - BEHIND * radius, 1.0 + along) };
    let to_plane = 2.0 * height.max(0.0) / apart.max(f64::MIN_POSITIVE);
    SURELY * if to_sphere > to_plane { to_sphere } else { to_plane }
}

/// The least opening, µm, that a facet can have to any point of another one, as seen from the side of the other to which n looks.
pub fn least_opening_between(other: &Facet, n: Vec3, facet: &Facet) -> f64 {
    let (from, along) = (other.middle - facet.middle, n.dot(&facet.normal));
    // Points of the other lie in its plane: they are all as high over the middle of the facet along n, and stray along its normal by so much.
    let strays = other.radius * (1.0 - along * along).max(0.0).sqrt();
    let height = from.dot(&facet.normal);
    let sphere = if height > strays { facet.radius } else { (1.0 + BEHIND) * facet.radius };
    let (apart, rise) = ((from.norm() - other.radius).max(0.0), sphere - from.dot(&n));
    let outside = (apart * apart - sphere * sphere).max(0.0);
    let to_sphere = if rise > 0.0 { outside / rise } else { f64::INFINITY };
    let before = 2.0 * (height - strays).max(0.0) / (1.0 - along).max(f64::MIN_POSITIVE);
    let behind = 2.0 * (-height - strays - BEHIND * facet.radius).max(0.0) / (1.0 + along).max(f64::MIN_POSITIVE);
    SURELY * to_sphere.max(before).max(behind)
}

/// Whether balls as wide as `range` (µm) on the side of a facet to which n looks, or points of it that are behind the other facet, may touch
/// that: a quick look that leaves out most.
pub fn may_meet(own: &Facet, n: Vec3, facet: &Facet, range: f64) -> bool {
    let from = own.middle + 0.5 * range * n - facet.middle;
    let most = own.radius + 0.5 * range + (1.0 + BEHIND) * facet.radius;
    from.norm_squared() <= most * most
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
            let mut candidates = Candidates::default();
            candidates.push(7, &Facet::of(&corners));
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
            let mut candidates = Candidates::default();
            candidates.push(7, &facet);
            candidates.bound([x].into_iter(), n);
            let point = Facet { normal: n, middle: x, radius: 0.0 };
            let bounds = [candidates.bounds_of(0)[0], least_opening_between(&point, n, &facet)];
            assert_eq!(bounds, [0.0, 0.0], "{found:?} {corners:?}");
            assert!(may_meet(&point, n, &facet, 0.0));
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
            let bound = least_opening_between(&other, other.normal, &facet);
            let mut widths = Vec::new();
            for [u, v] in [[0.01, 0.01], [0.98, 0.01], [0.01, 0.98], [0.3, 0.3]] {
                let x = (1.0 - u - v) * own[0] + u * own[1] + v * own[2];
                widths.extend(opening_to_facet(x, other.normal, &there, facet.normal).map(|found| found.0.width));
            }
            let Some(least) = widths.into_iter().reduce(f64::min) else { continue };
            seen += 1;
            near += usize::from(bound > 0.0);
            assert!(least < 0.0 && bound <= 1e-9 || bound <= least, "{bound} {least}");
            assert!(may_meet(&other, other.normal, &facet, least.max(0.0) + 1e-9), "{least}");
            assert!(apart(&other, other.normal, &facet, least.max(0.0) + 1e-9) <= 0.0, "{least}");
        }
        assert!(seen > 5000 && near > seen / 4, "bounds of {near} of {seen} pairs tell something");
    }
}
