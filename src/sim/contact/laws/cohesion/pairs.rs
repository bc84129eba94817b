//! Pairs of points and facets that wait until there are enough of them to be looked at together.

use super::attracted::{Attracted, Attracting};
use super::patch::{Partner, depth_of_well};
use crate::Vec3;
use crate::contact::{Openings, PAIRS};

/// Pairs that wait.
#[derive(Debug, Clone, Default)]
pub struct Pairs {
    openings: Openings,
    waiting: [Waiting; PAIRS],
    count: usize,
}

/// A pair: the number of the point, that of the facet through all bodies, its atoms in the order in which its normal points to the point,
/// and how its body attracts.
#[derive(Debug, Clone, Copy, Default)]
struct Waiting {
    point: usize,
    facet: u32,
    atoms: [u32; 3],
    by: Attracting,
}

/// A facet as a point sees it.
pub struct SeenFacet {
    pub number: u32,
    /// In the order in which its normal points to the point.
    pub atoms: [u32; 3],
    /// µm.
    pub corners: [Vec3; 3],
    pub normal: Vec3,
}

impl Attracting {
    /// What attracts a point so far open, if it does.
    pub fn attracted(&self, number: u32, width: f64, partner: Partner) -> Option<Attracted> {
        let Self { strength, range, .. } = *self;
        let released = strength * range * depth_of_well(width / range);
        (released > 0.0).then_some(Attracted { released, width, number, strength, range, partner })
    }
}

impl Pairs {
    /// Adds the pair of a point, by its number among those that are looked at, and a facet. What attracts points `most` is known of all
    /// pairs but those that wait.
    #[inline]
    pub fn add(
        &mut self,
        (point, at): (usize, (Vec3, Vec3)),
        facet: SeenFacet,
        by: Attracting,
        most: &mut [Option<Attracted>],
    ) {
        self.openings.put(self.count, at, &facet.corners, facet.normal);
        self.waiting[self.count] = Waiting { point, facet: facet.number, atoms: facet.atoms, by };
        self.count += 1;
        if self.count == PAIRS {
            self.look(most);
        }
    }

    /// Looks at all that wait.
    pub fn look(&mut self, most: &mut [Option<Attracted>]) {
        if self.count == 0 {
            return;
        }
        self.openings.find();
        for (lane, Waiting { point, facet, atoms, by }) in self.waiting[..self.count].iter().enumerate() {
            let Some((width, feature)) = self.openings.of(lane) else { continue };
            if let Some(found) = by.attracted(*facet, width, Partner::Facet(*atoms, feature))
                && most[*point].is_none_or(|most| found.is_more_than(&most))
            {
                most[*point] = Some(found);
            }
        }
        self.count = 0;
    }
}
