//! An edge with the two facets beside it, as another edge sees it.

use super::shape::{NONE, Shape, Sides};
use crate::Vec3;

/// An edge with its two facets.
pub(super) struct Ridge<'a> {
    positions: &'a [Vec3],
    pub start: Vec3,
    pub along: Vec3,
    /// The atoms across, in the facet that runs along the edge and in the one that runs against it, or `NONE`.
    across: [u32; 2],
}

impl<'a> Ridge<'a> {
    #[inline(always)]
    pub fn of(shape: &Shape, positions: &'a [Vec3], edge: u32) -> Self {
        let [start, end] = shape.ends(edge, positions);
        Self { positions, start, along: end - start, across: shape.across[edge as usize] }
    }

    /// From the start to the atoms across; zero where there is none.
    #[inline(always)]
    pub fn flanks(&self) -> [Vec3; 2] {
        let flank = |atom: u32| if atom == NONE { Vec3::zeros() } else { self.positions[atom as usize] - self.start };
        [flank(self.across[0]), flank(self.across[1])]
    }

    /// Whether one of the facets is missing.
    #[inline(always)]
    pub fn is_rim(&self) -> bool {
        self.across.contains(&NONE)
    }

    /// The normals of the two facets, µm², not scaled.
    #[inline(always)]
    pub fn normals(&self) -> [Vec3; 2] {
        let [left, right] = self.flanks();
        [self.along.cross(&left), right.cross(&self.along)]
    }

    /// How far a displacement leads along the sum of the unit normals of the two facets.
    #[inline(always)]
    pub fn leads_out(&self, displacement: &Vec3) -> f64 {
        let [left, right] = self.normals();
        left.dot(displacement) / left.norm() + right.dot(displacement) / right.norm()
    }

    /// Whether the surface bends away from its outside here.
    #[inline(always)]
    pub fn is_convex(&self) -> bool {
        self.normals()[0].dot(&self.flanks()[1]) < 0.0
    }
}

/// The first edge of pairs, with what all of them need of it.
pub(super) struct First<'a> {
    pub ridge: Ridge<'a>,
    pub flanks: [Vec3; 2],
    /// Their squared lengths, µm².
    pub squares: [f64; 2],
    pub is_one_sided: bool,
    pub is_convex: bool,
}

impl<'a> First<'a> {
    #[inline(always)]
    pub fn of(shape: &Shape, positions: &'a [Vec3], edge: u32) -> Self {
        let ridge = Ridge::of(shape, positions, edge);
        let flanks = ridge.flanks();
        Self {
            flanks,
            squares: flanks.map(|flank| flank.norm_squared()),
            is_one_sided: shape.sides == Sides::Outer && !ridge.is_rim(),
            is_convex: ridge.is_convex(),
            ridge,
        }
    }
}
