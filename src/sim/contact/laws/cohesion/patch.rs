//! Parts of facets that another surface attracts: their energy and its forces, exact for the energy as the positions of atoms have it.

use super::super::super::vectors::gather_corners;
use crate::Vec3;
use crate::contact::{Feature, Opening, Scene, opening_to_feature, opening_to_plane};
use crate::geometry::Beside;
use crate::sim::contact::state::Faced;

/// A part of a facet that another surface attracts: forces of both are those of an energy of the positions of their atoms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// The atoms of its facet, in the order in which its normal points to the other surface.
    pub own: [u32; 3],
    /// The atoms of the facet that attracts it, or an obstacle.
    pub other: Partner,
    /// Barycentric weights of its middle.
    pub weights: &'static [f64; 3],
    /// What it is of the facet.
    pub share: f64,
    /// The largest traction, of one side and of its part of the facet, pN/µm².
    pub strength: f64,
    /// Opening beyond which there is none, µm.
    pub range: f64,
}

/// What attracts a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Partner {
    /// What of a facet, by its atoms in the order in which its normal points to the patch.
    Facet([u32; 3], Feature),
    /// An obstacle.
    Obstacle(u32),
}

impl Partner {
    /// The atoms of a facet.
    pub fn atoms(&self) -> Option<[u32; 3]> {
        match self {
            Self::Facet(atoms, _) => Some(*atoms),
            Self::Obstacle(_) => None,
        }
    }
}

/// Traction over the strength at an opening over the range: a tent, eq. (adhesion.17). What touches is not drawn: contact alone holds it
/// apart.
pub fn traction(t: f64) -> f64 {
    2.0 * t.min(1.0 - t).max(0.0)
}

/// The energy at an opening over the range, over that where surfaces touch, with its sign turned: what opening on from there still takes.
pub fn depth_of_well(t: f64) -> f64 {
    let beyond = 1.0 - t;
    if t < 0.0 {
        1.0
    } else if t < 0.5 {
        1.0 - 2.0 * t * t
    } else if t < 1.0 {
        2.0 * beyond * beyond
    } else {
        0.0
    }
}

/// The opening over the range where the well is so deep.
pub fn width_of_well(depth: f64) -> f64 {
    if depth > 0.5 { (0.5 - 0.5 * depth).sqrt() } else { 1.0 - (0.5 * depth).sqrt() }
}

/// The cosine between the surface at a point and one across the way to where the other is touched: 1 where they are parallel, 0 where the
/// one stands on the other.
fn cosine_to(opening: &Opening) -> f64 {
    2.0 / opening.towards.norm_squared() - 1.0
}

/// The part of an area of a surface that faces the other: all of it up to 60°, nothing from 90° on.
pub fn part_that_faces(opening: &Opening) -> f64 {
    (2.0 * cosine_to(opening)).clamp(0.0, 1.0)
}

/// What a patch and its partner do to each other.
#[derive(Debug, Clone)]
pub struct PatchPull {
    /// pN·µm.
    pub energy: f64,
    /// On the atoms of the patch's facet, pN.
    pub on_own: [Vec3; 3],
    /// On those of the other.
    pub on_other: [Vec3; 3],
}

impl Patch {
    /// Its opening where the atoms are now, with the vector product of two sides of its facet, these, and its unit normal.
    pub fn opening(&self, scene: &Scene, now: &[Vec3]) -> Option<(Opening, Vec3, [Vec3; 2], Vec3)> {
        let [a, b, c] = gather_corners(now, self.own);
        let sides = [b - a, c - a];
        let twice = sides[0].cross(&sides[1]);
        let n = twice.try_normalize(0.0)?;
        let [u, v, w] = *self.weights;
        let x = u * a + v * b + w * c;
        let opening = match self.other {
            Partner::Facet(atoms, feature) => {
                let corners = gather_corners(now, atoms);
                let m = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).try_normalize(0.0)?;
                opening_to_feature(x, n, &corners, m, feature)?
            }
            Partner::Obstacle(obstacle) => {
                let Beside { gap, normal } = scene.obstacles[obstacle as usize].beside(&x);
                let (width, towards) = opening_to_plane(n, gap, normal)?;
                Opening { width, weights: [0.0; 3], towards }
            }
        };
        (opening.width < self.range).then_some((opening, twice, sides, n))
    }

    /// What it faces.
    pub fn faces(&self, scene: &Scene) -> Faced {
        match self.other {
            Partner::Facet([atom, ..], _) => Faced::Body(scene.body_of_atom(atom)),
            Partner::Obstacle(obstacle) => Faced::Obstacle(obstacle),
        }
    }

    /// The traction over the strength where the atoms are now.
    pub fn share_of_traction(&self, scene: &Scene, now: &[Vec3]) -> f64 {
        self.opening(scene, now).map_or(0.0, |(opening, ..)| traction(opening.width / self.range))
    }

    /// The area of all of its facet, µm².
    pub fn area_of_facet(&self, now: &[Vec3]) -> f64 {
        let [a, b, c] = gather_corners(now, self.own);
        0.5 * (b - a).cross(&(c - a)).norm()
    }

    /// The part of its area that is in contact, as seen from the other surface, µm²: all of it up to half of the range, from where on the
    /// traction falls.
    pub fn area_in_contact(&self, scene: &Scene, now: &[Vec3]) -> f64 {
        let Some((opening, twice, ..)) = self.opening(scene, now) else { return 0.0 };
        let held = (2.0 - 2.0 * opening.width / self.range).min(1.0);
        self.share * 0.5 * twice.norm() * cosine_to(&opening).max(0.0) * held
    }

    /// Its area where the opening is less than the range, µm²: less of it where the two turn away from each other by more than 60°, and
    /// nothing of a wall at a right angle.
    pub fn area_within(&self, scene: &Scene, now: &[Vec3]) -> f64 {
        let Some((opening, twice, ..)) = self.opening(scene, now) else { return 0.0 };
        self.share * 0.5 * twice.norm() * part_that_faces(&opening)
    }

    /// Energy E = −s A δ/2 φ(l/δ) and its forces, with s the strength, A the area of the facet, l the opening and δ the range.
    pub fn pull(&self, scene: &Scene, now: &[Vec3]) -> Option<PatchPull> {
        let (Opening { width, weights, towards: q }, twice, [to_b, to_c], n) = self.opening(scene, now)?;
        let area = 0.5 * twice.norm();
        let t = width / self.range;
        let depth = depth_of_well(t);
        let traction = self.strength * area * traction(t);
        // Eq. (contacts.14): dl = pull·(dy − dx) − |q|² r·dn with r = y − x and q = r/(n·r).
        let squared = q.norm_squared();
        let pull = 2.0 * q - squared * n;
        let across = (width / squared) * (q - n);
        // dE = turn·d(AB × AC), by the turn of the normal and by the area.
        let turn = -(traction * squared / (2.0 * area)) * across - (0.25 * self.strength * self.range * depth) * n;
        let (on_b, on_c) = (-to_c.cross(&turn), -turn.cross(&to_b));
        let drawn = traction * pull;
        let [u, v, w] = *self.weights;
        Some(PatchPull {
            energy: -0.5 * self.strength * self.range * area * depth,
            on_own: [u * drawn - on_b - on_c, v * drawn + on_b, w * drawn + on_c],
            on_other: weights.map(|weight| -weight * drawn),
        })
    }
}
