//! Atoms on facets: the points where the distance from an atom to a surface is least, with a sign that is right at
//! edges and corners.

use super::closest::{FacetPoint, Feature, closest_on_facet};
use super::found::{AtomContact, Facing, push};
use super::scene::Scene;
use super::shape::{NONE, Shape, Sides};
use super::words::Part;
use crate::Vec3;

/// Cosine by which a closest point on an edge or a corner may miss being the lowest around: round-off, so that a point
/// between two facets is never refused by both.
const COSINE_ROUND_OFF: f64 = 1e-9;

/// A point on a surface where the distance to an atom is least.
#[derive(Debug, Clone, Copy)]
pub(super) struct Low {
    facet: u32,
    point: FacetPoint,
    squared: f64,
}

/// On which side of a point of least distance the atom is.
#[derive(Clone, Copy)]
struct Side {
    inside: bool,
    /// The normal that tells the sides apart, where it was needed.
    normal: Option<Vec3>,
}

/// The other surface, as an atom sees it.
struct Other<'a> {
    shape: &'a Shape,
    positions: &'a [Vec3],
    /// The atom, when this is its own surface.
    own: Option<u32>,
}

/// Adds the contacts of an atom (numbered in its body) with the facets of a list, eq. (contacts.1) to (contacts.3).
/// Those of a level above the limit are passed over.
pub(super) fn find_atom_contacts(
    scene: &Scene,
    positions: &[Vec3],
    [body, other]: [u32; 2],
    atom: u32,
    (facets, limit): (Part, u32),
    lows: &mut Vec<Low>,
    contacts: &mut Vec<AtomContact>,
) {
    let numbered = scene.bodies[body as usize].first_atom + atom;
    let position = positions[numbered as usize];
    let surface = Other {
        shape: scene.shape(other),
        positions: scene.of_body(other, positions),
        own: (other == body).then_some(atom),
    };
    lows.clear();
    let Some(nearest) = surface.find_lows(position, facets.up_to(limit), scene.reach.range(), lows) else { return };
    let first_facet = scene.bodies[other as usize].first_facet;
    let mut add = |low: &Low, side: Side| {
        let (gap, normal) = surface.gap(low, side);
        let facing = surface.facing(low, &normal);
        push(
            contacts,
            AtomContact {
                atom: numbered,
                facet: first_facet + low.facet,
                feature: low.point.feature,
                second_weights: low.point.weights.map(|weight| weight as f32),
                gap,
                normal: normal.into(),
                facing,
            },
        );
    };
    let side = surface.side(&nearest);
    if side.inside {
        if nearest.squared <= scene.reach.depth.powi(2) {
            add(&nearest, side);
        }
        return;
    }
    let prediction = scene.reach.prediction.powi(2);
    for low in lows.iter().filter(|low| low.squared < prediction) {
        let side = if low.facet == nearest.facet { side } else { surface.side(low) };
        if !side.inside {
            add(low, side);
        }
    }
}

impl Other<'_> {
    fn corners(&self, facet: u32) -> [Vec3; 3] {
        self.shape.corners(facet, self.positions)
    }

    /// Finds the points where the distance is least, within `range` µm, in the order of facets; the nearest comes back.
    #[inline]
    fn find_lows(
        &self,
        position: Vec3,
        facets: impl Iterator<Item = u32>,
        range: f64,
        lows: &mut Vec<Low>,
    ) -> Option<Low> {
        let farthest = range * range;
        let mut nearest: Option<Low> = None;
        for facet in facets {
            let corners = self.corners(facet);
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            let height = normal.dot(&(position - corners[0]));
            if height * height > farthest * normal.norm_squared() {
                continue;
            }
            let point = closest_on_facet(position, corners);
            let low = Low { facet, point, squared: point.offset.norm_squared() };
            if low.squared > farthest {
                continue;
            }
            if nearest.is_none_or(|nearest| low.squared < nearest.squared) {
                nearest = Some(low);
            }
            if self.is_lowest(position, &low) {
                push(lows, low);
            }
        }
        // The nearest is a point of least distance by definition; should round-off have refused it, it is put where it belongs.
        let nearest = nearest?;
        if lows.iter().all(|low| low.squared > nearest.squared * (1.0 + COSINE_ROUND_OFF)) {
            let after = lows.partition_point(|low| low.facet < nearest.facet);
            lows.insert(after, nearest);
        }
        Some(nearest)
    }

    /// Whether this facet may speak for a point: one that the atom does not skip as its own neighbourhood.
    fn speaks(&self, facet: u32) -> bool {
        self.own.is_none_or(|atom| !self.shape.is_near(atom, facet))
    }

    /// Whether the distance rises in all directions along the surface, eq. (contacts.2), and this is the first of the facets with that
    /// point.
    fn is_lowest(&self, position: Vec3, low: &Low) -> bool {
        let offset = low.point.offset;
        let falls_towards = |atom: u32| {
            let displacement = self.positions[atom as usize] - (position - offset);
            let along = offset.dot(&displacement);
            along > 0.0 && along * along > COSINE_ROUND_OFF.powi(2) * displacement.norm_squared() * low.squared
        };
        let facet = self.shape.facets[low.facet as usize];
        match low.point.feature {
            Feature::Face => true,
            Feature::Side(side) => {
                let other = self.shape.beyond[low.facet as usize][side as usize];
                if other == NONE {
                    return true;
                }
                if other < low.facet && self.speaks(other) {
                    return false;
                }
                let ends = [facet[side as usize], facet[(side as usize + 1) % 3]];
                let across = self.shape.facets[other as usize].into_iter().find(|atom| !ends.contains(atom));
                !across.is_some_and(falls_towards)
            }
            Feature::Corner(corner) => {
                let centre = facet[corner as usize];
                let around = self.shape.around(centre as usize);
                let speaker = around.iter().copied().find(|&facet| self.speaks(facet));
                speaker == Some(low.facet)
                    && around.iter().all(|&facet| {
                        self.shape.facets[facet as usize].iter().all(|&atom| atom == centre || !falls_towards(atom))
                    })
            }
        }
    }

    fn has_two_outsides(&self) -> bool {
        self.own.is_some() || self.shape.sides == Sides::Both
    }

    /// To which side of the surface a normal points.
    fn facing(&self, low: &Low, normal: &Vec3) -> Facing {
        if !self.has_two_outsides() {
            return Facing::Any;
        }
        match self.pseudonormal(low) {
            Some(front) if front.dot(normal) >= 0.0 => Facing::Front,
            Some(_) => Facing::Back,
            None => Facing::Any,
        }
    }

    /// Whether the atom is behind the surface there. Never on its own surface, where both sides have two outsides, nor
    /// beyond the rim of an open one.
    fn side(&self, low: &Low) -> Side {
        if self.has_two_outsides() {
            return Side { inside: false, normal: None };
        }
        let normal = self.pseudonormal(low);
        Side { inside: normal.is_some_and(|normal| low.point.offset.dot(&normal) < 0.0), normal }
    }

    /// The normal that tells the sides apart: that of the face, the mean over an edge, the mean weighted with angles
    /// around a corner (Bærentzen & Aanæs 2005), eq. (contacts.3). None on the rim of an open surface.
    fn pseudonormal(&self, low: &Low) -> Option<Vec3> {
        let unit = |facet: u32| {
            let [a, b, c] = self.corners(facet);
            (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
        };
        let facet = self.shape.facets[low.facet as usize];
        match low.point.feature {
            Feature::Face => Some(unit(low.facet)),
            Feature::Side(side) => {
                let other = self.shape.beyond[low.facet as usize][side as usize];
                (other != NONE).then(|| unit(low.facet) + unit(other))
            }
            Feature::Corner(corner) => {
                let centre = facet[corner as usize];
                let mut sum = Vec3::zeros();
                for &facet in self.shape.around(centre as usize) {
                    let atoms = self.shape.facets[facet as usize];
                    let here = atoms.iter().position(|&atom| atom == centre).unwrap_or_default();
                    let beyond = self.shape.beyond[facet as usize];
                    if beyond[here] == NONE || beyond[(here + 2) % 3] == NONE {
                        return None;
                    }
                    let [from, to] = [1, 2].map(|step| {
                        self.positions[atoms[(here + step) % 3] as usize] - self.positions[centre as usize]
                    });
                    sum += unit(facet) * from.angle(&to);
                }
                Some(sum)
            }
        }
    }

    /// The signed gap (µm) and the unit normal towards the outside.
    fn gap(&self, low: &Low, Side { inside, normal }: Side) -> (f64, Vec3) {
        let offset = low.point.offset;
        let sign = if inside { -1.0 } else { 1.0 };
        let distance = low.squared.sqrt();
        let corners = self.corners(low.facet);
        let size = (corners[1] - corners[0]).norm() + (corners[2] - corners[0]).norm();
        if low.point.feature == Feature::Face || distance <= COSINE_ROUND_OFF * size {
            // The offset is too short for a direction here, or less exact than the facet's own normal.
            let normal = normal.or_else(|| self.pseudonormal(low)).and_then(|normal| normal.try_normalize(0.0));
            let normal = normal
                .or_else(|| offset.try_normalize(0.0).map(|displacement| displacement * sign))
                .unwrap_or(Vec3::z());
            let height = offset.dot(&normal);
            return if (height < 0.0) == inside { (height, normal) } else { (-height, -normal) };
        }
        (sign * distance, offset * (sign / distance))
    }
}
