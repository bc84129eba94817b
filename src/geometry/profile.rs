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

/// What the corner of a profile becomes when it is rounded.
enum Bend {
    /// It stays as it is.
    Sharp([f64; 2]),
    /// An arc of a circle that touches both sides.
    Round(Arc),
}

/// An arc of a circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arc {
    /// Middle of the circle, µm.
    centre: [f64; 2],
    /// Its radius, µm.
    radius: f64,
    /// The angle at which it begins, rad.
    begin: f64,
    /// How far it turns, rad, counter-clockwise.
    angle: f64,
    /// The direction from the middle of the circle to its own middle.
    halfway: [f64; 2],
    /// The cosine between that and the directions to its ends.
    widest: f64,
}

impl Arc {
    /// That around a point (µm), from an angle on and so far around, rad.
    pub fn new(centre: [f64; 2], radius: f64, begin: f64, angle: f64) -> Self {
        let (sin, cos) = (begin + 0.5 * angle).sin_cos();
        Self { centre, radius, begin, angle, halfway: [cos, sin], widest: (0.5 * angle).cos() }
    }

    /// Radius of its circle, µm.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    fn direction(&self, share: f64) -> [f64; 2] {
        let (sin, cos) = (self.begin + self.angle * share).sin_cos();
        [cos, sin]
    }

    fn point(&self, share: f64) -> [f64; 2] {
        let [cos, sin] = self.direction(share);
        [self.centre[0] + self.radius * cos, self.centre[1] + self.radius * sin]
    }

    /// Points in steps that turn by no more than an angle, rad, both ends among them.
    fn points(&self, most: f64) -> impl Iterator<Item = [f64; 2]> {
        let turns = (self.angle.abs() / most - 1e-9).ceil().max(1.0);
        (0..=turns as u32).map(move |step| self.point(f64::from(step) / turns))
    }
}

/// Rounds corners by arcs of circles that touch both sides. What points into a corner is sharper than it and recedes farther, so that no arc crosses
/// a side.
fn bends(corners: &[[f64; 2]], is_ring: bool, radius: f64) -> Result<Vec<Bend>, ProfileFault> {
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
    let bend = |number: usize| {
        let at = corners[number];
        if radius == 0.0 || !is_round(number) {
            return Ok(Bend::Sharp(at));
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
        Ok(Bend::Round(Arc::new(centre, radius, begin, angle)))
    };
    (0..count).map(bend).collect()
}

/// A profile with rounded corners as points, arcs in steps.
pub(super) fn round(corners: &[[f64; 2]], is_ring: bool, radius: f64) -> Result<Vec<[f64; 2]>, ProfileFault> {
    let mut points = Vec::new();
    for bend in bends(corners, is_ring, radius)? {
        match bend {
            Bend::Sharp(at) => points.push(at),
            Bend::Round(arc) => arc.points(TURN).for_each(|point| push_apart(&mut points, point, radius)),
        }
    }
    if is_ring && points.len() > 1 && near(points[0], points[points.len() - 1], radius) {
        points.pop();
    }
    Ok(points)
}

/// A part of a profile whose normal is that of a side or an arc.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Piece {
    /// A straight one, from one point to another.
    Side([[f64; 2]; 2]),
    /// A part of a circle.
    Arc(Arc),
}

impl Piece {
    /// Where it begins and ends.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Side(ends) => *ends,
            Self::Arc(arc) => [arc.point(0.0), arc.point(1.0)],
        }
    }

    /// The unit normal to its right at one of its ends.
    pub fn normal_at_end(&self, end: usize) -> [f64; 2] {
        match self {
            Self::Side([a, b]) => right_of([b[0] - a[0], b[1] - a[1]]),
            Self::Arc(arc) => arc.direction(end as f64).map(|part| part * arc.angle.signum()),
        }
    }

    /// How far a point is to its right, and the unit normal there, where the nearest point of its line or circle is one of its own.
    pub fn beside(&self, p: [f64; 2]) -> Option<(f64, [f64; 2])> {
        match self {
            Self::Side([a, b]) => {
                let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
                let share = (from[0] * along[0] + from[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
                let normal = right_of(along);
                (0.0..=1.0).contains(&share).then(|| (from[0] * normal[0] + from[1] * normal[1], normal))
            }
            Self::Arc(arc) => {
                let from = [p[0] - arc.centre[0], p[1] - arc.centre[1]];
                let (distance, sign) = (from[0].hypot(from[1]), arc.angle.signum());
                let along = from[0] * arc.halfway[0] + from[1] * arc.halfway[1];
                let normal = if distance > 0.0 { from.map(|part| sign * part / distance) } else { arc.halfway };
                (along >= arc.widest * distance).then_some((sign * (distance - arc.radius), normal))
            }
        }
    }

    /// Its points but the last, arcs in steps of a part of a right angle.
    pub fn points(&self, parts: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Side([a, _]) => vec![*a],
            Self::Arc(arc) => {
                let mut points: Vec<[f64; 2]> = arc.points(0.5 * PI / parts).collect();
                points.pop();
                points
            }
        }
    }
}

/// The unit vector to the right of a direction.
fn right_of([r, z]: [f64; 2]) -> [f64; 2] {
    let length = r.hypot(z);
    [z / length, -r / length]
}

/// The pieces of a profile with rounded corners from end to end, and whether it is a ring.
///
/// # Errors
/// As of [`check`] and [`round`].
pub(super) fn outline(corners: &[[f64; 2]], radius: f64) -> Result<(Vec<Piece>, bool), ProfileFault> {
    let is_ring = check(corners)?;
    let bends = bends(corners, is_ring, radius)?;
    let ends = |bend: &Bend| match bend {
        Bend::Sharp(at) => [*at; 2],
        Bend::Round(arc) => [arc.point(0.0), arc.point(1.0)],
    };
    let mut pieces = Vec::new();
    for (number, bend) in bends.iter().enumerate() {
        if let Bend::Round(arc) = bend {
            pieces.push(Piece::Arc(*arc));
        }
        let Some(next) = bends.get(number + 1).or_else(|| bends.first().filter(|_| is_ring)) else { continue };
        let side = [ends(bend)[1], ends(next)[0]];
        // Two arcs that fill a side leave nothing of it.
        if !near(side[0], side[1], radius) {
            pieces.push(Piece::Side(side));
        }
    }
    Ok((pieces, is_ring))
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
