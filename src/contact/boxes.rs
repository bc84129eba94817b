//! Boxes around the facets of every body, eight to a pack, and packs of packs above them: a tree whose shape is fixed
//! by the mesh at rest, so that following a deformed cell takes one pass over its facets.

use super::shape::Shape;
use crate::Vec3;

/// A box along the axes, µm, rounded outwards to four bytes a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub low: [f32; 3],
    pub high: [f32; 3],
}

/// Rounding of a number to four bytes changes it by less than this share.
const ROUNDING: f32 = 1.2e-7;

fn down(value: f64) -> f32 {
    let value = value as f32;
    value - value.abs() * ROUNDING - f32::MIN_POSITIVE
}

fn up(value: f64) -> f32 {
    let value = value as f32;
    value + value.abs() * ROUNDING + f32::MIN_POSITIVE
}

impl Bounds {
    /// Contains nothing.
    pub const EMPTY: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    /// The box of points, grown by `reach` µm.
    pub fn around(points: &[Vec3], reach: f64) -> Self {
        let (mut low, mut high) = (points[0], points[0]);
        for point in &points[1..] {
            (low, high) = (low.inf(point), high.sup(point));
        }
        Self {
            low: [down(low.x - reach), down(low.y - reach), down(low.z - reach)],
            high: [up(high.x + reach), up(high.y + reach), up(high.z + reach)],
        }
    }

    /// Whether two boxes share a point.
    pub fn meets(&self, other: &Self) -> bool {
        let meets = |axis: usize| (self.low[axis] <= other.high[axis]) & (other.low[axis] <= self.high[axis]);
        meets(0) & meets(1) & meets(2)
    }

    /// The box grown by `reach` µm.
    pub fn grown(&self, reach: f64) -> Self {
        Self {
            low: self.low.map(|low| down(f64::from(low) - reach)),
            high: self.high.map(|high| up(f64::from(high) + reach)),
        }
    }
}

/// Eight boxes side by side; lanes without a box contain nothing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pack {
    low: [[f32; 8]; 3],
    high: [[f32; 8]; 3],
}

impl Pack {
    pub const EMPTY: Self = Self { low: [[f32::INFINITY; 8]; 3], high: [[f32::NEG_INFINITY; 8]; 3] };

    fn set(&mut self, lane: usize, bounds: &Bounds) {
        for axis in 0..3 {
            self.low[axis][lane] = bounds.low[axis];
            self.high[axis][lane] = bounds.high[axis];
        }
    }

    /// The box of all lanes.
    fn bounds(&self) -> Bounds {
        Bounds {
            low: self.low.map(|lanes| lanes.into_iter().fold(f32::INFINITY, f32::min)),
            high: self.high.map(|lanes| lanes.into_iter().fold(f32::NEG_INFINITY, f32::max)),
        }
    }

    /// The lanes whose box meets another: the lowest bit of each byte.
    #[inline]
    fn meeting(&self, bounds: &Bounds) -> u64 {
        let mut meets = [1u8; 8];
        for axis in 0..3 {
            let (low, high) = (bounds.low[axis], bounds.high[axis]);
            for lane in 0..8 {
                meets[lane] &= u8::from(self.low[axis][lane] <= high) & u8::from(low <= self.high[axis][lane]);
            }
        }
        u64::from_le_bytes(meets)
    }
}

/// Where the packs of a body stand: those of facets first, then those of packs, up to a level of a few packs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Levels {
    first: [u32; 12],
    count: usize,
}

/// A level with no more packs than this needs none above it.
const TOP_PACKS: u32 = 3;

impl Levels {
    /// The levels over this many facets.
    pub fn of(facets: usize) -> Self {
        let mut levels = Self { first: [0; 12], count: 0 };
        let mut size = (facets as u32).div_ceil(8);
        loop {
            levels.first[levels.count + 1] = levels.first[levels.count] + size;
            levels.count += 1;
            if size <= TOP_PACKS {
                return levels;
            }
            size = size.div_ceil(8);
        }
    }

    /// Number of packs of all levels.
    pub fn packs(&self) -> usize {
        self.first[self.count] as usize
    }

    fn of_level(&self, level: usize) -> std::ops::Range<usize> {
        self.first[level] as usize..self.first[level + 1] as usize
    }

    /// Puts the boxes of a body's facets into its packs; the box of the whole body comes back.
    pub fn measure(&self, shape: &Shape, positions: &[Vec3], packs: &mut [Pack]) -> Bounds {
        packs.fill(Pack::EMPTY);
        for (slot, &facet) in shape.order.iter().enumerate() {
            packs[slot / 8].set(slot % 8, &Bounds::around(&shape.corners(facet, positions), 0.0));
        }
        for level in 1..self.count {
            let (below, here) = packs.split_at_mut(self.first[level] as usize);
            for (child, pack) in below[self.of_level(level - 1)].iter().enumerate() {
                here[child / 8].set(child % 8, &pack.bounds());
            }
        }
        packs[self.of_level(self.count - 1)].iter().map(Pack::bounds).fold(Bounds::EMPTY, |all, one| Bounds {
            low: [0, 1, 2].map(|axis| all.low[axis].min(one.low[axis])),
            high: [0, 1, 2].map(|axis| all.high[axis].max(one.high[axis])),
        })
    }

    /// Calls `found` with the slot (in [`Shape::order`]) of every facet whose box meets `bounds`.
    #[inline]
    pub fn visit(&self, packs: &[Pack], bounds: &Bounds, found: &mut impl FnMut(usize)) {
        let top = self.count - 1;
        for index in 0..self.of_level(top).len() {
            self.visit_pack(packs, top, index, bounds, found);
        }
    }

    fn visit_pack(&self, packs: &[Pack], level: usize, index: usize, bounds: &Bounds, found: &mut impl FnMut(usize)) {
        let mut lanes = packs[self.first[level] as usize + index].meeting(bounds);
        while lanes != 0 {
            let child = 8 * index + lanes.trailing_zeros() as usize / 8;
            lanes &= lanes - 1;
            if level == 0 {
                found(child);
            } else {
                self.visit_pack(packs, level - 1, child, bounds, found);
            }
        }
    }
}
