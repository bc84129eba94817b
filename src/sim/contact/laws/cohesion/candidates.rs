//! Facets that may attract the points of a facet, and how near each can at best be: what is surely farther than the best is not looked at.

use pulp::Arch;

use super::bounds::{Columns, ToFacet, ToPoint};
use super::facet::{Facet, Looking};
use crate::Vec3;

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

#[cfg(test)]
mod tests {
    use super::super::facet::apart;
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
