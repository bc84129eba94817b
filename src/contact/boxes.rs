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
        let reach = Vec3::repeat(reach);
        Self::between(low - reach, high + reach)
    }

    /// The box between two corners.
    pub fn between(low: Vec3, high: Vec3) -> Self {
        Self { low: [down(low.x), down(low.y), down(low.z)], high: [up(high.x), up(high.y), up(high.z)] }
    }

    /// How far two boxes are apart, at least, µm; 0 where they meet.
    pub fn apart(&self, other: &Self) -> f64 {
        let along = |axis: usize| {
            let between = (self.low[axis] - other.high[axis]).max(other.low[axis] - self.high[axis]);
            // What a difference of numbers of four bytes rounds.
            f64::from(between.max(0.0) * (1.0 - ROUNDING))
        };
        (0..3).map(|axis| along(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// Whether the whole of a box is in it.
    pub fn holds(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.low[axis] && other.high[axis] <= self.high[axis])
    }

    /// Whether two boxes share a point.
    pub fn meets(&self, other: &Self) -> bool {
        let meets = |axis: usize| (self.low[axis] <= other.high[axis]) & (other.low[axis] <= self.high[axis]);
        meets(0) & meets(1) & meets(2)
    }

    /// What two boxes share that meet.
    pub fn shared_with(&self, other: &Self) -> Self {
        let axis = [0, 1, 2];
        Self {
            low: axis.map(|axis| self.low[axis].max(other.low[axis])),
            high: axis.map(|axis| self.high[axis].min(other.high[axis])),
        }
    }

    /// Whether all points are on one side of the box, so that nothing between them is in it.
    #[inline]
    pub fn is_beside(&self, points: &[Vec3]) -> bool {
        (0..3).any(|axis| {
            let (low, high) = (f64::from(self.low[axis]), f64::from(self.high[axis]));
            points.iter().all(|point| point[axis] < low) || points.iter().all(|point| point[axis] > high)
        })
    }

    /// The box grown by `reach` µm.
    pub fn grown(&self, reach: f64) -> Self {
        Self {
            low: self.low.map(|low| down(f64::from(low) - reach)),
            high: self.high.map(|high| up(f64::from(high) + reach)),
        }
    }
}

/// The positions of a body's box in steps from 0 to 126 along each axis. Rounding keeps the order of numbers, so that boxes
/// that meet also meet in steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps {
    low: [f32; 3],
    scale: [f32; 3],
}

/// The last step.
const LAST: u8 = 126;

/// A step that is behind all.
const BEHIND: u8 = 127;

/// The highest bit of each of eight bytes.
const HIGH_BITS: u64 = 0x8080_8080_8080_8080;

impl Steps {
    /// The steps of a body with this box.
    pub fn of(body: &Bounds) -> Self {
        Self { low: body.low, scale: [0, 1, 2].map(|axis| f32::from(LAST) / (body.high[axis] - body.low[axis])) }
    }

    #[inline]
    fn boxed(&self, bounds: &Bounds) -> Stepped {
        let step = |x: f32, axis: usize| (((x - self.low[axis]) * self.scale[axis]) as u8).min(LAST);
        Stepped {
            low: [step(bounds.low[0], 0), step(bounds.low[1], 1), step(bounds.low[2], 2)],
            high: [step(bounds.high[0], 0), step(bounds.high[1], 1), step(bounds.high[2], 2)],
        }
    }
}

/// A box in steps of a body's own box.
#[derive(Debug, Clone, Copy)]
struct Stepped {
    low: [u8; 3],
    high: [u8; 3],
}

/// Eight boxes side by side, one in each byte, in steps of the box of their body; bytes without a box contain nothing. The
/// highest bit of the high ends is set, so that eight differences fit into one subtraction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pack {
    low: [u64; 3],
    high: [u64; 3],
}

impl Pack {
    pub const EMPTY: Self = Self { low: [u64::from_le_bytes([BEHIND; 8]); 3], high: [HIGH_BITS; 3] };

    fn set(&mut self, lane: usize, bounds: &Stepped) {
        let put = |word: &mut u64, byte: u8| *word = *word & !(0xFF << (8 * lane)) | u64::from(byte) << (8 * lane);
        for axis in 0..3 {
            put(&mut self.low[axis], bounds.low[axis]);
            put(&mut self.high[axis], bounds.high[axis] | 0x80);
        }
    }

    /// The box of all lanes.
    fn bounds(&self) -> Stepped {
        Stepped {
            low: self.low.map(|lanes| lanes.to_le_bytes().into_iter().fold(BEHIND, u8::min)),
            high: self.high.map(|lanes| (lanes & !HIGH_BITS).to_le_bytes().into_iter().fold(0, u8::max)),
        }
    }

    /// The lanes whose box meets another, given by its ends in every byte, the high ones marked as in a pack: the highest
    /// bit of each byte.
    #[inline]
    fn meeting(&self, low: &[u64; 3], high: &[u64; 3]) -> u64 {
        let meets = |axis: usize| (high[axis] - self.low[axis]) & (self.high[axis] - low[axis]);
        meets(0) & meets(1) & meets(2) & HIGH_BITS
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
        if positions.is_empty() {
            return Bounds::EMPTY;
        }
        let body = Bounds::around(positions, 0.0);
        let steps = Steps::of(&body);
        for (slot, &facet) in shape.order.iter().enumerate() {
            let facet = Bounds::around(&shape.corners(facet, positions), 0.0);
            packs[slot / 8].set(slot % 8, &steps.boxed(&facet));
        }
        for level in 1..self.count {
            let (below, here) = packs.split_at_mut(self.first[level] as usize);
            for (child, pack) in below[self.of_level(level - 1)].iter().enumerate() {
                here[child / 8].set(child % 8, &pack.bounds());
            }
        }
        body
    }

    /// Calls `found` with the slot (in [`Shape::order`]) of every facet whose box meets `bounds`; `steps` are those of the
    /// box that measuring gave.
    #[inline]
    pub fn visit(&self, packs: &[Pack], steps: &Steps, bounds: &Bounds, found: &mut impl FnMut(usize)) {
        let Stepped { low, high } = steps.boxed(bounds);
        let everywhere = |byte: u8| u64::from_le_bytes([byte; 8]);
        let ends = [low.map(everywhere), high.map(|byte| everywhere(byte | 0x80))];
        let top = self.count - 1;
        for index in 0..self.of_level(top).len() {
            self.visit_pack(packs, top, index, &ends, found);
        }
    }

    fn visit_pack(
        &self,
        packs: &[Pack],
        level: usize,
        index: usize,
        ends: &[[u64; 3]; 2],
        found: &mut impl FnMut(usize),
    ) {
        let mut lanes = packs[self.first[level] as usize + index].meeting(&ends[0], &ends[1]);
        while lanes != 0 {
            let child = 8 * index + lanes.trailing_zeros() as usize / 8;
            lanes &= lanes - 1;
            if level == 0 {
                found(child);
            } else {
                self.visit_pack(packs, level - 1, child, ends, found);
            }
        }
    }
}
