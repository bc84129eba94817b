//! The displacement by which one body leaves another: its direction and how far.

use super::boxes::Bounds;
use super::inside::{is_inside, passes_through};
use super::scene::{Scene, centre};
use super::shape::Sides;
use crate::Vec3;

/// How much shorter than along the line of centres the displacement along the normal must be to be taken.
const CLEARLY: f64 = 0.9;

/// The displacement of the first body by which it leaves the second, with a gap beyond (µm). It is zero for bodies without
/// a direction, those that have one centre and no normal.
pub fn separation(scene: &Scene, positions: &[Vec3], bodies: [u32; 2], gap: f64) -> Vec3 {
    let [first, second] = bodies.map(|body| centre(scene.of_body(body, positions)));
    let along = |direction: Vec3| {
        let normal = direction.try_normalize(f64::MIN_POSITIVE)?;
        Some((normal, last_contact(scene, positions, bodies, normal)))
    };
    let (centres, normal) = (along(first - second), along(normal_of_overlap(scene, positions, bodies)));
    let displacement = match (centres, normal) {
        (Some(centres), Some(normal)) if normal.1 < CLEARLY * centres.1 => Some(normal),
        (Some(centres), _) => Some(centres),
        (None, normal) => normal,
    };
    displacement.map_or(Vec3::zeros(), |(normal, far)| (far + gap) * normal)
}

/// The direction in which the volume of the overlap shrinks fastest when the first body moves: the vector area of what of
/// the second is inside the first, less that of what of the first is inside the second. Where no atom is inside, facets
/// that edges pass through stand in for them. Eq. (contacts.9); a surface without an inside faces the other's centre.
fn normal_of_overlap(scene: &Scene, positions: &[Vec3], [first, second]: [u32; 2]) -> Vec3 {
    let facing = facing(scene, positions, second, first) - facing(scene, positions, first, second);
    if facing != Vec3::zeros() {
        return facing;
    }
    pierced(scene, positions, second, first) - pierced(scene, positions, first, second)
}

/// The vector area of what of a body is inside another.
fn facing(scene: &Scene, positions: &[Vec3], body: u32, other: u32) -> Vec3 {
    let (here, bounds) = (scene.of_body(body, positions), Bounds::around(scene.of_body(other, positions), 0.0));
    let inside: Vec<bool> =
        here.iter().map(|position| is_inside(scene, positions, *position, other, &bounds)).collect();
    let shape = scene.shape(body);
    let facets = shape.facets.iter().filter(|facet| facet.iter().any(|atom| inside[*atom as usize]));
    let share = |facet: &[u32; 3]| facet.iter().filter(|atom| inside[**atom as usize]).count() as f64 / 3.0;
    let to = centre(scene.of_body(other, positions));
    facets.map(|facet| share(facet) * area_towards(shape.sides, facet.map(|atom| here[atom as usize]), to)).sum()
}

/// The vector area of the facets of a body that edges of another pass through.
fn pierced(scene: &Scene, positions: &[Vec3], body: u32, other: u32) -> Vec3 {
    let (here, there) = (scene.of_body(body, positions), scene.of_body(other, positions));
    let (bounds, to) = (Bounds::around(here, 0.0), centre(there));
    let edges = scene.shape(other).edges.iter().map(|edge| edge.map(|atom| there[atom as usize]));
    let near: Vec<[Vec3; 2]> = edges.filter(|ends| Bounds::around(ends, 0.0).meets(&bounds)).collect();
    let shape = scene.shape(body);
    let corners = shape.facets.iter().map(|facet| facet.map(|atom| here[atom as usize]));
    let hit = corners.filter(|corners| near.iter().any(|&[from, to]| passes_through(from, to, *corners)));
    hit.map(|corners| area_towards(shape.sides, corners, to)).sum()
}

/// The vector area of a facet: outwards, or towards a point where both sides are outer.
fn area_towards(sides: Sides, [a, b, c]: [Vec3; 3], point: Vec3) -> Vec3 {
    let area = 0.5 * (b - a).cross(&(c - a));
    if sides == Sides::Both && area.dot(&(point - (a + b + c) / 3.0)) < 0.0 { -area } else { area }
}

/// A body as seen along a direction: two coordinates across and the height along it.
struct Seen {
    points: Vec<Vec3>,
    facets: Vec<[Vec3; 3]>,
    edges: Vec<[Vec3; 2]>,
}

/// How far the first body has to move along a unit direction until it touches the second for the last time, µm: the
/// largest height of a point of the second over one of the first. Exact for any shape; nothing lies beyond it.
fn last_contact(scene: &Scene, positions: &[Vec3], [first, second]: [u32; 2], normal: Vec3) -> f64 {
    let aside = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
    let u = normal.cross(&aside).normalize();
    let v = normal.cross(&u);
    let turned = |body: u32| -> Vec<Vec3> {
        scene.of_body(body, positions).iter().map(|x| Vec3::new(x.dot(&u), x.dot(&v), x.dot(&normal))).collect()
    };
    let (low, high) = (turned(first), turned(second));
    let lowest = low.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    let highest = high.iter().map(|x| x.z).fold(f64::NEG_INFINITY, f64::max);
    let below = seen(scene, first, low, |z| z < highest);
    let above = seen(scene, second, high, |z| z > lowest);
    let mut far: f64 = 0.0;
    for facet in &above.facets {
        for position in &below.points {
            far = far.max(height_at(facet, position).map_or(0.0, |height| height - position.z));
        }
    }
    for facet in &below.facets {
        for position in &above.points {
            far = far.max(height_at(facet, position).map_or(0.0, |height| position.z - height));
        }
    }
    for one in &below.edges {
        for other in &above.edges {
            far = far.max(crossing(one, other).unwrap_or(0.0));
        }
    }
    far
}

/// What of a body matters: that with a corner whose height does.
fn seen(scene: &Scene, body: u32, points: Vec<Vec3>, matters: impl Fn(f64) -> bool) -> Seen {
    let shape = scene.shape(body);
    let facets = shape.facets.iter().map(|facet| facet.map(|atom| points[atom as usize]));
    let facets = facets.filter(|corners| corners.iter().any(|x| matters(x.z))).collect();
    let edges = shape.edges.iter().map(|edge| edge.map(|atom| points[atom as usize]));
    let edges = edges.filter(|ends| ends.iter().any(|x| matters(x.z))).collect();
    Seen { facets, edges, points: points.into_iter().filter(|x| matters(x.z)).collect() }
}

/// Twice the area that two vectors span across the direction.
fn across(a: Vec3, b: Vec3) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Height of a facet above or below a point, if it is there.
fn height_at([a, b, c]: &[Vec3; 3], position: &Vec3) -> Option<f64> {
    let [u, v, w] =
        [across(b - position, c - position), across(c - position, a - position), across(a - position, b - position)];
    let sum = u + v + w;
    let same = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    (same && sum != 0.0).then(|| (u * a.z + v * b.z + w * c.z) / sum)
}

/// Height of the second edge over the first where they cross, if they do.
fn crossing([a, b]: &[Vec3; 2], [c, d]: &[Vec3; 2]) -> Option<f64> {
    let (one, other) = (b - a, d - c);
    let turn = across(one, other);
    let (s, t) = (across(c - a, other) / turn, across(c - a, one) / turn);
    let meets = turn != 0.0 && (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    meets.then(|| (c.z + t * other.z) - (a.z + s * one.z))
}
