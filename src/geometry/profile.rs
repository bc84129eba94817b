//! Profiles of surfaces of revolution: what is asked of them, how their corners are rounded and their sides divided.

use std::f64::consts::PI;

/// A corner turns by more than this, rad, or is not rounded.
const STRAIGHT: f64 = 1e-6;

/// Turns of a rounded corner are at most this large, rad: a right angle has three.
const TURN: f64 = PI / 6.0;

/// A profile that is turned about the z axis.
#[derive(Debug, Clone, Copy)]
pub struct Profile<'a> {
    /// Its corners, each a distance from the axis and a height, µm. With its ends on the axis it makes a body without a hole; with no corner on the
    /// axis it is closed from the last to the first, and makes a ring.
    pub corners: &'a [[f64; 2]],
    /// Radius to which its corners are rounded, µm; those on the axis stay.
    pub rounding: f64,
    /// Atoms around the axis where it is widest.
    pub around: u32,
}

/// Why a profile makes no surface. Corners are numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProfileFault {
    /// It has no area: a ring has at least three corners, a body without a hole one beside its ends.
    TooFew,
    /// A corner is beyond the axis.
    Beyond(usize),
    /// A corner is on the axis that is not an end, or one end is and the other is not.
    OnAxis(usize),
    /// A corner is where the one before it is.
    Twice(usize),
    /// The side after a corner crosses or touches that after another.
    Crosses(usize, usize),
    /// The sides beside a corner are too short for the rounding; the largest for which they are long enough, µm.
    Rounding(usize, f64),
    /// Corners are so near each other that facets are slivers, the worst around this corner.
    Slivers(usize),
}

/// Looks whether a closed surface comes of a profile; says whether it is a ring.
pub(super) fn check(corners: &[[f64; 2]]) -> Result<bool, ProfileFault> {
    let last = corners.len().saturating_sub(1);
    if let Some(beyond) = corners.iter().position(|corner| corner[0] < 0.0) {
        return Err(ProfileFault::Beyond(beyond));
    }
    let is_on_axis = |number: usize| corners[number][0] == 0.0;
    let ends = (0..corners.len()).filter(|number| is_on_axis(*number)).count();
    let is_ring = ends == 0;
    if corners.len() < 3 {
        return Err(ProfileFault::TooFew);
    }
    let stray = (0..corners.len()).find(|number| is_on_axis(*number) && ![0, last].contains(number));
    if let Some(stray) = stray.or_else(|| (ends == 1).then(|| if is_on_axis(0) { last } else { 0 })) {
        return Err(ProfileFault::OnAxis(stray));
    }
    let sides = if is_ring { corners.len() } else { last };
    let side = |number: usize| [corners[number], corners[(number + 1) % corners.len()]];
    if let Some(twice) = (0..sides).find(|number| side(*number)[0] == side(*number)[1]) {
        return Err(ProfileFault::Twice((twice + 1) % corners.len()));
    }
    match crossing(corners, is_ring) {
        Some((one, other)) => Err(ProfileFault::Crosses(one, other)),
        None => Ok(is_ring),
    }
}

/// Two sides that cross each other, touch without having an end in common, or lie on each other.
fn crossing(points: &[[f64; 2]], is_ring: bool) -> Option<(usize, usize)> {
    let sides = if is_ring { points.len() } else { points.len() - 1 };
    let side = |number: usize| [points[number], points[(number + 1) % points.len()]];
    let pairs = (0..sides).flat_map(|one| (one + 1..sides).map(move |other| (one, other)));
    pairs.into_iter().find(|&(one, other)| {
        let meet = other == one + 1 || (is_ring && one == 0 && other == sides - 1);
        if meet { fold_back(side(one), side(other)) } else { cross(side(one), side(other)) }
    })
}

/// Twice the area of a triangle, positive where it runs counter-clockwise.
fn turn([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether two sides have a point in common.
fn cross([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let apart = |p: f64, q: f64| (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0);
    let beside = |axis: usize| {
        let [low, high] = [a[axis].min(b[axis]), a[axis].max(b[axis])];
        c[axis].max(d[axis]) < low || c[axis].min(d[axis]) > high
    };
    !apart(turn([a, b, c]), turn([a, b, d])) && !apart(turn([c, d, a]), turn([c, d, b])) && !beside(0) && !beside(1)
}

/// Whether a side lies on the one beside it.
fn fold_back([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let corner = if b == c { [a, b, d] } else { [b, a, c] };
    let [one, middle, other] = corner;
    let along: f64 = (0..2).map(|axis| (one[axis] - middle[axis]) * (other[axis] - middle[axis])).sum();
    turn(corner) == 0.0 && along > 0.0
}

/// Rounds corners by arcs of circles that touch both sides. What points into a corner is sharper than it and recedes farther, so that no arc crosses
/// a side.
pub(super) fn round(corners: &[[f64; 2]], is_ring: bool, radius: f64) -> Result<Vec<[f64; 2]>, ProfileFault> {
    let count = corners.len();
    let is_corner = |number: usize| is_ring || (number > 0 && number < count - 1);
    // How much of both sides an arc takes.
    let sides = |number: usize| {
        let at = corners[number];
        [(number + count - 1) % count, (number + 1) % count].map(|other| {
            let side = [corners[other][0] - at[0], corners[other][1] - at[1]];
            let length = side[0].hypot(side[1]);
            (side.map(|axis| axis / length), length)
        })
    };
    let half_angle = |number: usize| {
        let [(one, _), (other, _)] = sides(number);
        0.5 * (one[0] * other[0] + one[1] * other[1]).clamp(-1.0, 1.0).acos()
    };
    let is_round = |number: usize| is_corner(number) && PI - 2.0 * half_angle(number) > STRAIGHT;
    let taken = |number: usize| if is_round(number) { radius / half_angle(number).tan() } else { 0.0 };
    let mut points = Vec::new();
    for number in 0..count {
        let at = corners[number];
        if radius == 0.0 || !is_round(number) {
            points.push(at);
            continue;
        }
        let [(back, before), (on, after)] = sides(number);
        let most = (before / (taken(number) + taken((number + count - 1) % count)))
            .min(after / (taken(number) + taken((number + 1) % count)));
        // Sides that two arcs just fill are long enough.
        if most < 1.0 - 1e-9 {
            return Err(ProfileFault::Rounding(number, most * radius));
        }
        let (length, half) = (taken(number), half_angle(number));
        let middle = [back[0] + on[0], back[1] + on[1]];
        let to_centre = radius / half.sin() / middle[0].hypot(middle[1]).max(1e-300);
        let centre = [at[0] + to_centre * middle[0], at[1] + to_centre * middle[1]];
        let [first, last] = [back, on].map(|side| [at[0] + length * side[0], at[1] + length * side[1]]);
        let [begin, end] = [first, last].map(|point| (point[1] - centre[1]).atan2(point[0] - centre[0]));
        let angle = (end - begin + 3.0 * PI).rem_euclid(2.0 * PI) - PI;
        let turns = (angle.abs() / TURN - 1e-9).ceil().max(1.0);
        for step in 0..=turns as u32 {
            let (sin, cos) = (begin + angle * f64::from(step) / turns).sin_cos();
            let point = [centre[0] + radius * cos, centre[1] + radius * sin];
            push_apart(&mut points, point, radius);
        }
    }
    if is_ring && points.len() > 1 && near(points[0], points[points.len() - 1], radius) {
        points.pop();
    }
    Ok(points)
}

fn near(one: [f64; 2], other: [f64; 2], length: f64) -> bool {
    (one[0] - other[0]).hypot(one[1] - other[1]) < 1e-6 * length
}

/// Two arcs that fill a side end in the same point.
fn push_apart(points: &mut Vec<[f64; 2]>, point: [f64; 2], length: f64) {
    if points.last().is_none_or(|last| !near(*last, point, length)) {
        points.push(point);
    }
}

/// Divides sides into parts that are no longer than this.
pub(super) fn divide(points: &[[f64; 2]], is_ring: bool, most: f64) -> Vec<[f64; 2]> {
    let sides = if is_ring { points.len() } else { points.len() - 1 };
    let mut divided = Vec::new();
    for number in 0..sides {
        let [a, b] = [points[number], points[(number + 1) % points.len()]];
        let parts = ((a[0] - b[0]).hypot(a[1] - b[1]) / most - 1e-9).ceil().max(1.0);
        divided.extend((0..parts as u32).map(|part| {
            let share = f64::from(part) / parts;
            [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
        }));
    }
    divided.extend((!is_ring).then(|| points[points.len() - 1]));
    divided
}
