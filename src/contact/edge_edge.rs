//! Edges on edges: two ridges that cross, each with its facets falling away from the other.

use super::closest::{LEAST_SINE_SQUARED, closest_on_segments};
use super::found::{EdgeContact, push};
use super::ridge::{First, Ridge};
use super::scene::Scene;
use super::shape::Sides;
use super::words::Part;
use crate::Vec3;

/// Adds the contacts of an edge (numbered in its body) with the edges of a list, eq. (contacts.4). Those of a level above
/// the limit are passed over. `first` is worked out where it is none, for the next bodies.
pub(super) fn find_edge_contacts<'a>(
    scene: &'a Scene,
    positions: &'a [Vec3],
    [body, other]: [u32; 2],
    edge: u32,
    (candidates, limit): (Part, u32),
    first: &mut Option<First<'a>>,
    contacts: &mut Vec<EdgeContact>,
) {
    let first = first.get_or_insert_with(|| First::of(scene.shape(body), scene.of_body(body, positions), edge));
    let (there, points) = (scene.shape(other), scene.of_body(other, positions));
    let is_outer = [first.is_one_sided && other != body, there.sides == Sides::Outer && other != body];
    if is_outer == [true; 2] && !first.is_convex && there.closed {
        return;
    }
    for candidate in candidates.up_to(limit) {
        let second = Ridge::of(there, points, candidate);
        let outer = Outer([is_outer[0], is_outer[1] && !second.is_rim()]);
        let crossing = cross(first, &second, outer, scene);
        let Some((along, gap, normal)) = crossing else { continue };
        let numbered = |body: u32, edge: u32| scene.bodies[body as usize].first_edge + edge;
        push(
            contacts,
            EdgeContact {
                edges: [numbered(body, edge), numbered(other, candidate)],
                along: along.map(|share| share as f32),
                gap,
                normal: normal.into(),
            },
        );
    }
}

/// Which of two edges are of surfaces with one outside. The side of those with two is told by the other, if that has one.
#[derive(Clone, Copy)]
struct Outer([bool; 2]);

impl Outer {
    fn any(self) -> bool {
        self.0[0] || self.0[1]
    }

    fn both(self) -> bool {
        self.0[0] && self.0[1]
    }
}

/// How far facets may rise towards the other edge, as a sine, where the edges have not passed each other.
pub(super) const RISE: f64 = 0.1;

/// How far edges with such facets may have passed each other, over the prediction: what sweeps leave.
const PASSED: f64 = 0.01;

/// How far from where an edge crosses the crest of another, over its length, it may enter it, and how far beyond its end it may cross
/// it then.
const BEYOND: f64 = 0.1;

/// How far behind a facet an end stands on it, over what the edges have passed each other.
const ON_FACET: f64 = 0.1;

/// Where two edges touch: the parameters along both, the gap (µm) and the unit normal from the second to the first.
#[inline]
fn cross(
    First { ridge: first, flanks, squares, is_convex: first_is_convex, .. }: &First,
    second: &Ridge,
    outer: Outer,
    scene: &Scene,
) -> Option<([f64; 2], f64, Vec3)> {
    let normal = first.along.cross(&second.along);
    let squared = normal.norm_squared();
    // The facets of the first edge lie beyond it as seen from the second, those of the second beyond that: the normal
    // or its opposite must do for all four, or nearly so. Most pairs fail here, whatever their distance.
    let [a, b] = flanks.map(|flank| normal.dot(&flank));
    let slight = RISE * RISE * squared;
    let between = first.start - second.start;
    let height = normal.dot(&between);
    let is_within = |distance: f64| height * height <= distance * distance * squared;
    let may_rise = outer.any() & is_within(scene.reach.prediction);
    let on_first = -between.cross(&second.along).dot(&normal);
    let on_second = -between.cross(&first.along).dot(&normal);
    let least = -BEYOND * squared;
    // All tests are made before a result is looked at: which of them a pair fails cannot be foretold.
    let rises = a * b < 0.0;
    let rises_much = (a * a > slight * squares[0]) & (b * b > slight * squares[1]);
    let beyond =
        (on_first < least) | (on_first > squared - least) | (on_second < least) | (on_second > squared - least);
    if (rises & (!may_rise | rises_much)) | !is_within(scene.reach.range()) | beyond {
        return None;
    }
    let [c, d] = second.flanks().map(|flank| -normal.dot(&flank));
    let (lowest, highest) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    let rises = (lowest < 0.0) & (highest > 0.0);
    let along = [on_first / squared, on_second / squared];
    let within = (0.0..=1.0).contains(&along[0]) & (0.0..=1.0).contains(&along[1]);
    let is_convex = [!outer.0[0] | first_is_convex, !outer.0[1] | second.is_convex()];
    let is_straight = squared <= LEAST_SINE_SQUARED * first.along.norm_squared() * second.along.norm_squared();
    if (rises & (!may_rise | !within)) | (outer.any() & (!is_convex[0] | !is_convex[1])) | is_straight {
        return None;
    }
    let facing = if rises {
        1f64.copysign(leads_out(first, second, outer, &normal))
    } else if highest > 0.0 {
        1.0
    } else if lowest < 0.0 {
        -1.0
    } else {
        1f64.copysign(height)
    };
    let length = squared.sqrt();
    let (gap, normal) = (facing * height / length, normal * (facing / length));
    if gap >= scene.reach.prediction || gap < -scene.reach.depth {
        return None;
    }
    let fits = if !outer.any() {
        gap >= 0.0 && within
    } else if rises {
        gap >= -PASSED * scene.reach.prediction && !have_turned(first, second, &normal, RISE)
    } else if gap >= 0.0 {
        within
    } else {
        // Beyond their ends only pairs that are kept: those that are so near.
        (within || (outer.both() && are_within(first, second, scene.reach.range())))
            && (!outer.0[1] || dips_into(first, along[0], second, gap, &-normal))
            && (!outer.0[0] || dips_into(second, along[1], first, gap, &normal))
    };
    fits.then(|| (along.map(|share| share.clamp(0.0, 1.0)), gap, normal))
}

/// How far a displacement leads from the second edge to the first, by where the outsides of their surfaces are.
#[inline(always)]
fn leads_out(first: &Ridge, second: &Ridge, outer: Outer, displacement: &Vec3) -> f64 {
    let of = |ridge: &Ridge, side: usize| if outer.0[side] { ridge.leads_out(displacement) } else { 0.0 };
    of(second, 1) - of(first, 0)
}

/// Whether a facet of one edge rises towards the other edge, along the normal from the second to the first, by more than
/// this sine.
fn have_turned(first: &Ridge, second: &Ridge, normal: &Vec3, slack: f64) -> bool {
    let rises = |flank: &Vec3, along: f64| along < 0.0 && along * along > slack * slack * flank.norm_squared();
    first.flanks().iter().any(|flank| rises(flank, normal.dot(flank)))
        || second.flanks().iter().any(|flank| rises(flank, -normal.dot(flank)))
}

/// Whether two edges are nearer than a distance, µm.
fn are_within(first: &Ridge, second: &Ridge, distance: f64) -> bool {
    let ends = |ridge: &Ridge| [ridge.start, ridge.start + ridge.along];
    closest_on_segments(ends(first), ends(second)).0 <= distance * distance
}

/// Whether an edge that passes below the crest of a ridge is behind both its facets there, or comes to be so close by: nearer to the facet
/// that faces it than to the other, or on its way out through that. On ridges sharper than a right angle an edge may be below the other's
/// crest and yet beside it; on one as sharp as that an edge that slides in over its end is still beside one facet where it
/// crosses the crest, or crosses it just beyond its end, and inside next to that; and one that leans over may be cut through near its crest
/// on so short a way that a tenth of the edge is past it. `facing` is the direction into the ridge.
fn dips_into(edge: &Ridge, at: f64, ridge: &Ridge, gap: f64, facing: &Vec3) -> bool {
    let facets = ridge.normals().map(|normal| normal.normalize());
    let slopes = facets.map(|facet| edge.along.dot(&facet));
    let start = at.clamp(0.0, 1.0);
    // Behind a facet is negative.
    let heights = [0, 1].map(|facet| -gap * facing.dot(&facets[facet]) + (start - at) * slopes[facet]);
    let beside = usize::from(heights[1] > heights[0]);
    if heights[beside] < 0.0 && start == at {
        return true;
    }
    // An end that is inside is for the atom there; one that stands on a facet is held there, and its edge may yet cut through the ridge.
    if heights[beside] < ON_FACET * gap {
        return false;
    }
    let end = if slopes[beside] > 0.0 { (start - BEYOND).max(0.0) } else { (start + BEYOND).min(1.0) };
    let from = [beside, 1 - beside].map(|facet| -heights[facet]);
    let to = [beside, 1 - beside].map(|facet| -heights[facet] - (end - start) * slopes[facet]);
    if to[1] > 0.0 {
        return to[0] >= to[1];
    }
    // Where it comes out through the facet that faces it, it must have come in through the other.
    from[1] > 0.0 && from[0] + from[1] / (from[1] - to[1]) * (to[0] - from[0]) > 0.0
}

/// How far facets may rise towards the other edge, as a sine, before a contact that was there is let go.
const SLACK: f64 = 0.35;

/// Looks again at a contact of two edges that was there before with this normal. Between nearly flat surfaces the facets of
/// one edge rise a little towards the other in one moment and fall away in the next; a contact that carries a force must
/// not come and go with that. Nothing when the edges have slid off each other, are farther apart than the prediction, or
/// their facets have really turned.
pub fn edges_still_touch(scene: &Scene, positions: &[Vec3], edges: [u32; 2], normal: &Vec3) -> Option<EdgeContact> {
    let bodies = edges.map(|edge| scene.body_of_edge(edge));
    let [first, second] = [0, 1].map(|side| {
        let (shape, own) = (scene.shape(bodies[side]), edges[side] - scene.bodies[bodies[side] as usize].first_edge);
        Ridge::of(shape, scene.of_body(bodies[side], positions), own)
    });
    let across = first.along.cross(&second.along);
    let squared = across.norm_squared();
    if squared <= LEAST_SINE_SQUARED * first.along.norm_squared() * second.along.norm_squared() {
        return None;
    }
    let between = first.start - second.start;
    let on_first = -between.cross(&second.along).dot(&across);
    let on_second = -between.cross(&first.along).dot(&across);
    if on_first < 0.0 || on_first > squared || on_second < 0.0 || on_second > squared {
        return None;
    }
    let normal = across * (1f64.copysign(across.dot(normal)) / squared.sqrt());
    let gap = normal.dot(&between);
    let near = gap < scene.reach.prediction && gap >= -scene.reach.depth;
    (near && !have_turned(&first, &second, &normal, SLACK)).then(|| EdgeContact {
        edges,
        along: [on_first, on_second].map(|share| (share / squared) as f32),
        gap,
        normal: normal.into(),
    })
}
