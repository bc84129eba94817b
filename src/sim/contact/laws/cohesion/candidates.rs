//! Facets that may attract the points of a facet: what is surely farther from a point than what is known to attract it is not looked at.

use pulp::Arch;

use super::bounds::{Block, FACETS, Looked, ToPoints};
use super::facet::Facet;
use crate::Vec3;

/// Facets that may attract points of a facet, in blocks of some side by side. What stands beyond their count is of no account.
#[derive(Debug, Clone, Default)]
pub struct Candidates {
    blocks: Vec<Block>,
    /// Which they are, numbered through all bodies, and which of the attracting bodies each belongs to.
    numbers: Vec<[(u32, u32); FACETS]>,
    count: usize,
}

impl Candidates {
    /// Makes room for so many, and forgets what was there.
    pub fn empty_for(&mut self, most: usize) {
        self.count = 0;
        let blocks = most.div_ceil(FACETS);
        if self.blocks.len() < blocks {
            self.blocks.resize(blocks, Block::default());
            self.numbers.resize(blocks, Default::default());
        }
    }

    /// Adds a facet of an attracting body if it `counts`. There must be room for it.
    #[inline]
    pub fn add_if(&mut self, counts: bool, (facet, body): (u32, u32), seen: &Facet) {
        // Written in any case: whether it counts can be foreseen by no processor.
        let (block, lane) = (self.count / FACETS, self.count % FACETS);
        self.numbers[block][lane] = (facet, body);
        let block = &mut self.blocks[block];
        for axis in 0..3 {
            block.middles[axis][lane] = seen.middle[axis];
            block.normals[axis][lane] = seen.normal[axis];
        }
        block.radii[lane] = seen.radius;
        block.may[lane] = 0.0;
        self.count += usize::from(counts);
    }

    /// Finds which of them may have openings to points that matter, of a surface with the unit normal n; `first` is the number of the first
    /// of the points.
    pub fn look_from(&mut self, points: &[Looked], first: usize, n: Vec3) {
        let blocks = &mut self.blocks[..self.count.div_ceil(FACETS)];
        Arch::new().dispatch(ToPoints { n: [n.x, n.y, n.z], points, first, blocks });
    }

    /// Calls `each` with the numbers of a point, of a facet that may have such an opening to it, and of its body.
    #[inline]
    pub fn near_points(&self, mut each: impl FnMut(usize, u32, u32)) {
        for (number, block) in self.blocks[..self.count.div_ceil(FACETS)].iter().enumerate() {
            let lanes = FACETS.min(self.count - number * FACETS);
            for (may, (facet, body)) in block.may[..lanes].iter().zip(&self.numbers[number]) {
                let mut may = *may as u64;
                while may != 0 {
                    each(may.trailing_zeros() as usize, *facet, *body);
                    may &= may - 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::facet::apart;
    use super::*;
    use crate::contact::opening_to_facet;
    use crate::random::{Purpose, Stream};

    /// Whether a facet may have an opening to a point that is less than the `widest`, µm.
    fn may_be_nearer((x, n): (Vec3, Vec3), facet: &Facet, widest: f64) -> bool {
        let mut candidates = Candidates::default();
        candidates.empty_for(1);
        candidates.add_if(true, (7, 0), facet);
        candidates.look_from(&[Looked { x: [x.x, x.y, x.z], widest }], 3, n);
        let mut found = false;
        candidates.near_points(|point, facet, body| {
            assert_eq!((point, facet, body), (3, 7, 0));
            found = true;
        });
        found
    }

    #[test]
    fn no_facet_that_is_passed_over_is_nearer() {
        let mut stream = Stream::new(11, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let (mut seen, mut passed_over) = (0, 0);
        for _ in 0..20_000 {
            let corners = [0, 1, 2].map(|_| Vec3::new(number(), number(), number()));
            let m = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
            let n = Vec3::new(number(), number(), number()).normalize();
            let x = 2.0 * Vec3::new(number(), number(), number());
            let Some((opening, _)) = opening_to_facet(x, n, &corners, m) else { continue };
            seen += 1;
            let facet = Facet::of(&corners);
            for more in [1e-6, 0.1, 10.0] {
                let widest = opening.width.max(0.0) * (1.0 + more) + 1e-6;
                assert!(may_be_nearer((x, n), &facet, widest), "{opening:?} {widest}");
            }
            passed_over += usize::from(opening.width > 0.0 && !may_be_nearer((x, n), &facet, 0.5 * opening.width));
        }
        assert!(seen > 5000 && passed_over > seen / 4, "{passed_over} of {seen} facets are passed over");
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
            let n = (1.2 * Vec3::new(number(), number(), number()) - m).normalize();
            // Around the first corner, on all sides of it.
            let (v, w, behind) = (0.03 * number(), 0.03 * number(), 0.03 * number().abs());
            let at = (1.0 - v - w) * corners[0] + v * corners[1] + w * corners[2];
            let x = at - behind * twice.norm().sqrt() * m;
            let found = opening_to_facet(x, n, &corners, m).filter(|(opening, _)| opening.width < 0.0);
            if found.is_none() {
                continue;
            }
            let facet = Facet::of(&corners);
            for widest in [1e-9, 0.3, 3.0] {
                assert!(may_be_nearer((x, n), &facet, widest), "{widest} {found:?} {corners:?}");
            }
            let point = Facet { normal: n, middle: x, radius: 0.0 };
            assert!(apart(&point, n, &facet, 0.0) <= 0.0);
            seen += 1;
            outside += usize::from((x - facet.middle).norm() > facet.radius);
        }
        assert!(seen > 2000 && outside > 100, "{outside} of {seen} are outside the sphere around the facet");
    }

    #[test]
    fn no_point_of_a_facet_is_nearer_to_another_than_they_are_apart() {
        let mut stream = Stream::new(12, Purpose::Placement, 0, 0);
        let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
        let mut seen = 0;
        for _ in 0..20_000 {
            let mut corners = || [0, 1, 2].map(|_| Vec3::new(number(), number(), number()));
            let (own, there) = (corners(), corners());
            let own = own.map(|corner| 0.5 * corner + Vec3::new(1.0, 0.0, 0.0));
            let (facet, other) = (Facet::of(&there), Facet::of(&own));
            let mut widths = Vec::new();
            for [u, v] in [[0.01, 0.01], [0.98, 0.01], [0.01, 0.98], [0.3, 0.3]] {
                let x = (1.0 - u - v) * own[0] + u * own[1] + v * own[2];
                widths.extend(opening_to_facet(x, other.normal, &there, facet.normal).map(|found| found.0.width));
            }
            let Some(least) = widths.into_iter().reduce(f64::min) else { continue };
            seen += 1;
            assert!(apart(&other, other.normal, &facet, least.max(0.0) + 1e-9) <= 0.0, "{least}");
        }
        assert!(seen > 5000);
    }
}
