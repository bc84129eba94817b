//! Where a picture is cut off, and the flat faces that solids show there.

use super::samples::NOTHING;
use super::view::View;

/// A side of a solid as seen from the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// Where lines of sight go in.
    In,
    /// Where they come out.
    Out,
}

/// Where things are cut off.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    /// What is nearer than this is not seen.
    pub nearness: f32,
    /// How much nearer than where a line of sight comes out of a solid it may already have gone into another: solids that touch may be
    /// a little inside each other.
    pub overlap: f32,
}

/// How far solids may be inside each other, over the typical radius.
const OVERLAP: f64 = 0.05;

impl Cut {
    /// At a point, µm; none where that is behind the camera.
    pub fn at(point: [f64; 3], typical_radius: f64, view: &View) -> Option<Self> {
        let nearer = crate::Vec3::from(point) - OVERLAP * typical_radius * view.forward;
        let nearness = view.nearness(point)?;
        Some(Self { nearness, overlap: view.nearness(nearer.into())? - nearness })
    }
}

/// The solids behind the cut at one sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    /// How much oftener the line of sight comes out of solids than it goes into some: it begins inside so many.
    inside: i16,
    /// The nearest facet where it comes out, or [`NOTHING`], and its nearness.
    out: u32,
    nearness: f32,
}

impl Face {
    /// No solid.
    pub const NONE: Self = Self { inside: 0, out: NOTHING, nearness: f32::NEG_INFINITY };

    /// The facet that stands for the face of a solid that is cut here, and its nearness; none where the line of sight begins outside all
    /// solids. Facets are drawn with a little overlap and may count twice: what is seen anyway, at `near`, must not be clearly nearer.
    pub fn shown(&self, near: f32, overlap: f32) -> Option<(u32, f32)> {
        let begins_inside = self.inside > 0 && self.out != NOTHING && near - self.nearness <= overlap;
        begins_inside.then_some((self.out, self.nearness))
    }

    /// Counts a facet of a solid.
    pub fn pass(&mut self, side: Side, near: f32, number: u32) {
        self.inside += if side == Side::Out { 1 } else { -1 };
        if side == Side::Out && near > self.nearness {
            (self.out, self.nearness) = (number, near);
        }
    }
}
