//! How what parts of surfaces do changes as they move, eq. (adhesion.27), which the implicit step answers where drag alone cannot.

use super::patch::{Partner, Patch, PatchPull, traction};
use crate::Vec3;
use crate::contact::{Feature, Opening, Scene};
use crate::sim::contact::vectors::gather_corners;

/// Up to where a part pulls the more the farther it is open, over its range, eq. (adhesion.17).
const RISES: f64 = 0.5;

/// The least opening by which a pull is turned, over the range: what touches has no direction.
const TOUCHES: f64 = 1e-9;

/// How what a part does changes as it moves: that of the second derivative of its energy that holds it, by how what it faces moves beside its
/// facet, as seen from there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// Pull over opening, pN/µm.
    along: f64,
    /// Pull over what moves aside, pN/µm.
    across: f64,
    /// The direction q of eq. (contacts.14) and the normal at the point.
    towards: Vec3,
    normal: Vec3,
    /// From the point to what is touched, along the normal, µm.
    rise: f64,
    /// Weights of what is touched.
    weights: [f64; 3],
    /// From the first atom of the facet to the others, µm.
    sides: [Vec3; 2],
    /// The area of the facet, µm².
    area: f64,
    /// Which way what is touched slides along a side as things move aside; none for a corner.
    slides: Option<Vec3>,
}

impl Patch {
    /// How what it does changes as it moves from where the atoms are; none where nothing holds it, and on obstacles.
    pub fn slope(&self, scene: &Scene, now: &[Vec3]) -> Option<Slope> {
        let (Opening { width, weights, towards: q }, twice, sides, n) = self.opening(scene, now)?;
        let (t, area, squared) = (width / self.range, 0.5 * twice.norm(), q.norm_squared());
        let along = if t < RISES { 2.0 * self.strength * area / self.range } else { 0.0 };
        let aside = || 2.0 * self.strength * area * traction(t) * squared / width.max(TOUCHES * self.range);
        let (across, slides) = match self.other {
            Partner::Facet(_, Feature::Corner(_)) => (aside(), None),
            Partner::Facet(atoms, Feature::Side(side)) => {
                let corners = gather_corners(now, atoms);
                let ends = [0, 1].map(|next| corners[(side as usize + next) % 3]);
                let side = ends[1] - ends[0];
                (aside(), (side - n.dot(&side) * q).try_normalize(0.0))
            }
            // What is touched of a face slides along it wherever it likes.
            Partner::Facet(_, Feature::Face) => (0.0, None),
            Partner::Obstacle(_) => return None,
        };
        let slope = Slope { along, across, towards: q, normal: n, rise: width / squared, weights, sides, area, slides };
        (along > 0.0 || across > 0.0).then_some(slope)
    }
}

impl Slope {
    /// What the part does where atoms are moved so (µm), beyond what it does where they were, so many times.
    pub fn answer(&self, patch: &Patch, times: f64, moved: &[Vec3]) -> PatchPull {
        let Self { along, across, towards: q, normal: n, rise, weights, sides: [to_b, to_c], area, slides } = self;
        let own = patch.own.map(|atom| moved[atom as usize]);
        let [u, v, w] = *patch.weights;
        let (at_b, at_c) = (own[1] - own[0], own[2] - own[0]);
        // How the facet turns: its normal, and about it.
        let tilts = n.cross(&(at_b.cross(to_c) + to_b.cross(&at_c))) / (2.0 * area);
        let turns = tilts + (at_b.dot(to_c) - at_c.dot(to_b)) / (4.0 * area) * n;
        let mut apart = -(u * own[0] + v * own[1] + w * own[2]) - turns.cross(&(*rise * q));
        for (weight, atom) in weights.iter().zip(patch.other.atoms().iter().flatten()) {
            apart += *weight * moved[*atom as usize];
        }
        let pull = 2.0 * q - q.norm_squared() * n;
        let mut aside = apart - n.dot(&apart) * q;
        if let Some(slides) = slides {
            aside -= slides.dot(&aside) * slides;
        }
        let against = -times * (along * pull.dot(&apart) * pull + *across * (aside - q.dot(&aside) * n));
        let torque = against.cross(&(*rise * q));
        let tilt = torque.cross(n) / (2.0 * area);
        let about = torque.dot(n) / (4.0 * area);
        let (on_b, on_c) = (to_c.cross(&tilt) + about * to_c, tilt.cross(to_b) - about * to_b);
        PatchPull {
            energy: 0.0,
            on_own: [-u * against - on_b - on_c, -v * against + on_b, -w * against + on_c],
            on_other: weights.map(|weight| weight * against),
        }
    }
}
