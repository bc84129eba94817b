//! Edges on edges: two ridges that cross, each with its facets falling away from the other.

use super::closest::LEAST_SINE_SQUARED;
use super::found::{EdgeContact, push};
use super::lists::{Moved, by_body, level, number};
use super::scene::Scene;
use super::shape::{NONE, Shape, Sides};
use crate::Vec3;

/// An edge with its two facets.
struct Ridge<'a> {
    positions: &'a [Vec3],
    start: Vec3,
    along: Vec3,
    /// The atoms across, in the facet that runs along the edge and in the one that runs against it, or `NONE`.
    across: [u32; 2],
}

impl<'a> Ridge<'a> {
    #[inline]
    fn of(shape: &Shape, positions: &'a [Vec3], edge: u32) -> Self {
        let [start, end] = shape.ends(edge, positions);
        Self { positions, start, along: end - start, across: shape.across[edge as usize] }
    }

    /// From the start to the atoms across; zero where there is none.
    #[inline]
    fn flanks(&self) -> [Vec3; 2] {
        let flank = |atom: u32| if atom == NONE { Vec3::zeros() } else { self.positions[atom as usize] - self.start };
        [flank(self.across[0]), flank(self.across[1])]
    }

    /// Whether one of the facets is missing.
    fn is_rim(&self) -> bool {
        self.across.contains(&NONE)
    }

    /// The normals of the two facets, µm², not scaled.
    fn normals(&self) -> [Vec3; 2] {
        let [left, right] = self.flanks();
        [self.along.cross(&left), right.cross(&self.along)]
    }

    /// Between the unit normals of the two facets, not scaled.
    fn outward(&self) -> Vec3 {
        self.normals().iter().map(|normal| normal.normalize()).sum()
    }

    /// Whether the surface bends away from its outside here.
    fn is_convex(&self) -> bool {
        self.normals()[0].dot(&self.flanks()[1]) < 0.0
    }
}

/// The first edge of pairs, with what all of them need of it.
struct First<'a> {
    ridge: Ridge<'a>,
    flanks: [Vec3; 2],
    /// Their squared lengths, µm².
    squares: [f64; 2],
    is_one_sided: bool,
    is_convex: bool,
}

impl<'a> First<'a> {
    fn of(shape: &Shape, positions: &'a [Vec3], edge: u32) -> Self {
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

/// Adds the contacts of an edge (numbered in its body) with the edges of a list, eq. (contacts.4).
pub(super) fn find_edge_contacts(
    scene: &Scene,
    positions: &[Vec3],
    body: u32,
    edge: u32,
    list: &[u32],
    moved: &Moved,
    contacts: &mut Vec<EdgeContact>,
) {
    let mut first = None;
    for (other, edges) in by_body(list) {
        let limit = moved.limit(body, other);
        let mut candidates = edges.iter().filter(|edge| level(**edge) <= limit).map(|edge| number(*edge)).peekable();
        if candidates.peek().is_none() {
            continue;
        }
        let first = first.get_or_insert_with(|| First::of(scene.shape(body), scene.of_body(body, positions), edge));
        let (there, places) = (scene.shape(other), scene.of_body(other, positions));
        let surfaces_are_one_sided = first.is_one_sided && there.sides == Sides::Outer && other != body;
        if surfaces_are_one_sided && !first.is_convex && there.closed {
            continue;
        }
        for candidate in candidates {
            let second = Ridge::of(there, places, candidate);
            let one_sided = surfaces_are_one_sided && !second.is_rim();
            let crossing = cross(first, &second, one_sided, scene);
            let Some((along, gap, normal)) = crossing else { continue };
            let numbered = |body: u32, edge: u32| scene.bodies[body as usize].first_edge + edge;
            push(
                contacts,
                EdgeContact {
                    edges: [numbered(body, edge), numbered(other, candidate)],
                    bodies: [body, other],
                    along,
                    gap,
                    normal,
                },
            );
        }
    }
}

/// How far facets may rise towards the other edge, as a sine, where the edges have not passed each other.
const RISE: f64 = 0.1;

/// How far edges with such facets may have passed each other, over the proximity: what sweeps leave.
const PASSED: f64 = 0.01;

/// Where two edges touch: the parameters along both, the gap (µm) and the unit normal from the second to the first.
#[inline]
fn cross(
    First { ridge: first, flanks, squares, .. }: &First,
    second: &Ridge,
    one_sided: bool,
    scene: &Scene,
) -> Option<([f64; 2], f64, Vec3)> {
    let normal = first.along.cross(&second.along);
    let squared = normal.norm_squared();
    // The facets of the first edge lie beyond it as seen from the second, those of the second beyond that: the normal
    // or its opposite must do for all four, or nearly so. Most pairs fail here, whatever their distance.
    let (a, b) = (normal.dot(&flanks[0]), normal.dot(&flanks[1]));
    let slight = RISE * RISE * squared;
    if a * b < 0.0 && (!one_sided || (a * a > slight * squares[0] && b * b > slight * squares[1])) {
        return None;
    }
    let between = first.start - second.start;
    let height = normal.dot(&between);
    let is_within = |distance: f64| height * height <= distance * distance * squared;
    let may_rise = one_sided && is_within(scene.reach.proximity);
    if (a * b < 0.0 && !may_rise) || !is_within(scene.reach.range()) {
        return None;
    }
    let on_first = -between.cross(&second.along).dot(&normal);
    let on_second = -between.cross(&first.along).dot(&normal);
    if on_first < 0.0 || on_first > squared || on_second < 0.0 || on_second > squared {
        return None;
    }
    let [left, right] = second.flanks();
    let (c, d) = (-normal.dot(&left), -normal.dot(&right));
    let (lowest, highest) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    let rises = lowest < 0.0 && highest > 0.0;
    if rises && !may_rise {
        return None;
    }
    if squared <= LEAST_SINE_SQUARED * first.along.norm_squared() * second.along.norm_squared() {
        return None;
    }
    let facing = if rises {
        1f64.copysign(normal.dot(&(second.outward() - first.outward())))
    } else if highest > 0.0 {
        1.0
    } else if lowest < 0.0 {
        -1.0
    } else {
        1f64.copysign(height)
    };
    let length = squared.sqrt();
    let (gap, normal) = (facing * height / length, normal * (facing / length));
    if gap >= scene.reach.proximity || gap < -scene.reach.depth {
        return None;
    }
    let fits = if !one_sided {
        gap >= 0.0
    } else if !first.is_convex() || !second.is_convex() {
        false
    } else if rises {
        gap >= -PASSED * scene.reach.proximity && !have_turned(first, second, &normal, RISE)
    } else {
        gap >= 0.0 || is_really_inside(first, second, normal)
    };
    fits.then(|| ([on_first / squared, on_second / squared], gap, normal))
}

/// Whether a facet of one edge rises towards the other edge, along the normal from the second to the first, by more than
/// this sine.
fn have_turned(first: &Ridge, second: &Ridge, normal: &Vec3, slack: f64) -> bool {
    let rises = |flank: &Vec3, along: f64| along < -slack * flank.norm();
    first.flanks().iter().any(|flank| rises(flank, normal.dot(flank)))
        || second.flanks().iter().any(|flank| rises(flank, -normal.dot(flank)))
}

/// Whether each edge is behind both facets of the other: on ridges sharper than a right angle an edge may be below the
/// other's crest and yet beside it.
fn is_really_inside(first: &Ridge, second: &Ridge, normal: Vec3) -> bool {
    first.normals().iter().all(|facet| facet.dot(&normal) < 0.0)
        && second.normals().iter().all(|facet| facet.dot(&normal) > 0.0)
}

/// How far facets may rise towards the other edge, as a sine, before a contact that was there is let go.
const SLACK: f64 = 0.35;

/// Looks again at a contact of two edges that was there before with this normal. Between nearly flat surfaces the facets of
/// one edge rise a little towards the other in one moment and fall away in the next; a contact that carries a force must
/// not come and go with that. Nothing when the edges have slid off each other, are farther apart than the proximity, or
/// their facets have really turned.
pub fn edges_still_touch(
    scene: &Scene,
    positions: &[Vec3],
    edges: [u32; 2],
    bodies: [u32; 2],
    normal: &Vec3,
) -> Option<EdgeContact> {
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
    let near = gap < scene.reach.proximity && gap >= -scene.reach.depth;
    (near && !have_turned(&first, &second, &normal, SLACK)).then(|| EdgeContact {
        edges,
        bodies,
        along: [on_first / squared, on_second / squared],
        gap,
        normal,
    })
}
