//! Facets as the search of what attracts their points sees them: each a ball around its middle that a plane goes through.

use crate::Vec3;

/// What a point may be behind a facet, and beside it there, and still be looked at, over the size of the facet.
pub const BEHIND: f64 = 0.2;

/// A facet at an instant, in one line of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
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

/// How far apart two facets are beyond what may meet, µm: below 0 where they may.
pub fn apart(own: &Facet, n: Vec3, facet: &Facet, range: f64) -> f64 {
    let from = own.middle + 0.5 * range * n - facet.middle;
    from.norm() - own.radius - 0.5 * range - (1.0 + BEHIND) * facet.radius
}

/// The same more closely, by the planes of both, of facets that have not moved: what is touched from a point is on the plane of the facet, before
/// the point and no farther off than the range.
pub fn apart_at_once(own: &Facet, n: Vec3, facet: &Facet, range: f64) -> f64 {
    let between = facet.middle - own.middle;
    let before = (n.dot(&between) - 0.5 * range).abs() - 0.5 * range - (1.0 + BEHIND) * facet.radius;
    let off = facet.normal.dot(&between).abs() - range - own.radius;
    apart(own, n, facet, range).max(before).max(off)
}

/// By how much a facet may have come nearer to others at most since it was so, in what [`apart`] measures, be it the one that looks or the
/// one that is seen.
pub fn nearer(now: &Facet, then: &Facet, range: f64) -> f64 {
    let grown = (1.0 + BEHIND) * (now.radius - then.radius).max(0.0);
    (now.middle - then.middle).norm() + 0.5 * range * (now.normal - then.normal).norm() + grown
}

#[cfg(test)]
mod tests {
    use super::super::points::points_of_facet;
    use super::*;
    use crate::contact::opening_to_facet;
    use crate::random::{Purpose, Stream};

    #[test]
    fn what_may_meet_is_not_apart_and_planes_tell_more_than_balls() {
        let mut stream = Stream::new(14, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let (mut met, mut by_balls, mut by_planes) = (0, 0, 0);
        for _ in 0..50_000 {
            let mut corners = |size: f64| [0, 1, 2].map(|_| size * Vec3::new(number(), number(), number()));
            let (of_own, there) = (corners(0.5), corners(3.0));
            let [own, other] = [of_own, there].map(|at| Facet::of(&at));
            for (range, (own, other), (of_own, there)) in
                [(0.3, (&own, &other), (&of_own, &there)), (0.3, (&other, &own), (&there, &of_own))]
            {
                let apart = [apart(own, own.normal, other, range), apart_at_once(own, own.normal, other, range)];
                by_balls += usize::from(apart[0] > 0.0);
                by_planes += usize::from(apart[1] > 0.0);
                for weights in points_of_facet(2) {
                    let x = weights[0] * of_own[0] + weights[1] * of_own[1] + weights[2] * of_own[2];
                    let opening = opening_to_facet(x, own.normal, there, other.normal);
                    if opening.is_some_and(|(opening, _)| opening.width < range) {
                        met += 1;
                        // Lengths of some µm, rounded.
                        assert!(apart[1] <= 1e-12, "{apart:?}");
                    }
                }
            }
        }
        assert!(met > 1000 && by_planes > 2 * by_balls, "{met} {by_balls} {by_planes}");
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
}
