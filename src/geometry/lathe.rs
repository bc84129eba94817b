//! Surfaces of revolution: pipettes, rings, tips, cones and cylinders.

use super::{LEAST_FACET_QUALITY, Surface, facet_qualities, volume};
use crate::Vec3;
use crate::elementary::turn as turn_by;
use std::f64::consts::PI;

/// A corner turns by more than this, rad, or is not rounded.
const STRAIGHT: f64 = 1e-6;

/// The fewest atoms of a ring around the axis.
const FEWEST: u32 = 6;

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

/// Turns a profile about the z axis. Rings of atoms are as far from each other as atoms of the widest one are, and have fewer atoms where they
/// are narrower, so that facets are nearly regular. Atoms are numbered ring by ring along the profile.
///
/// # Errors
/// A profile that crosses itself, or of which no closed surface can be made.
///
/// # Panics
/// When fewer than 6 atoms are wanted around.
pub fn lathe(profile: Profile) -> Result<Surface, ProfileFault> {
    let Profile { corners, rounding, around } = profile;
    assert!(around >= FEWEST, "a surface of revolution needs at least {FEWEST} atoms around");
    let is_ring = check(corners)?;
    let rounded = round(corners, is_ring, rounding)?;
    let widest = rounded.iter().map(|point| point[0]).fold(0.0, f64::max);
    let points = divide(&rounded, is_ring, 2.0 * PI * widest / f64::from(around));
    let mut surface = Surface::default();
    let rings: Vec<Ring> = points
        .iter()
        .enumerate()
        .map(|(number, &point)| Ring::new(point, number, widest, around, &mut surface.positions))
        .collect();
    for (ring, next) in rings.iter().zip(&rings[1..]) {
        ring.join(next, &mut surface.facets);
    }
    if is_ring {
        rings[rings.len() - 1].join(&rings[0], &mut surface.facets);
    }
    if volume(&surface) < 0.0 {
        surface.facets.iter_mut().for_each(|facet| facet.swap(1, 2));
    }
    match sliver(&surface) {
        None => Ok(surface),
        Some(at) => {
            let from = |corner: &[f64; 2]| (corner[0] - at[0]).hypot(corner[1] - at[1]);
            let near = (0..corners.len()).min_by(|a, b| from(&corners[*a]).total_cmp(&from(&corners[*b])));
            Err(ProfileFault::Slivers(near.unwrap_or_default()))
        }
    }
}

/// Where the worst facet is a sliver, its distance from the axis and its height.
fn sliver(surface: &Surface) -> Option<[f64; 2]> {
    let qualities = facet_qualities(surface).into_iter().enumerate();
    let (worst, quality) = qualities.min_by(|one, other| one.1.total_cmp(&other.1))?;
    let first = surface.corners(surface.facets[worst])[0];
    (quality < LEAST_FACET_QUALITY || quality.is_nan()).then(|| [first.x.hypot(first.y), first.z])
}

/// Looks whether a closed surface comes of a profile; says whether it is a ring.
fn check(corners: &[[f64; 2]]) -> Result<bool, ProfileFault> {
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
fn round(corners: &[[f64; 2]], is_ring: bool, radius: f64) -> Result<Vec<[f64; 2]>, ProfileFault> {
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
fn divide(points: &[[f64; 2]], is_ring: bool, most: f64) -> Vec<[f64; 2]> {
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

/// Atoms around the axis at a height.
struct Ring {
    first: u32,
    atoms: u32,
    /// The angle of the first over that between two.
    begin: f64,
}

impl Ring {
    /// Puts atoms around the axis; every other ring is turned by half the angle between two.
    fn new([r, z]: [f64; 2], number: usize, widest: f64, around: u32, positions: &mut Vec<Vec3>) -> Self {
        let wanted = (f64::from(around) * r / widest).round() as u32;
        let atoms = if r == 0.0 { 1 } else { wanted.max(FEWEST) };
        let ring =
            Self { first: positions.len() as u32, atoms, begin: if number.is_multiple_of(2) { 0.0 } else { 0.5 } };
        positions.extend((0..atoms).map(|atom| {
            let [cos, sin] = turn_by(ring.turns(atom));
            Vec3::new(r * cos, r * sin, z)
        }));
        ring
    }

    /// Where an atom is, in whole turns; those behind the last go on.
    fn turns(&self, atom: u32) -> f64 {
        (f64::from(atom) + self.begin) / f64::from(self.atoms)
    }

    fn atom(&self, number: u32) -> u32 {
        self.first + number % self.atoms
    }

    /// Facets to the next ring: wherever an atom of one of both comes next around.
    fn join(&self, next: &Self, facets: &mut Vec<[u32; 3]>) {
        let (mut here, mut there) = (0, 0);
        let sides = |ring: &Self| if ring.atoms == 1 { 0 } else { ring.atoms };
        while here < sides(self) || there < sides(next) {
            let goes_here = there == sides(next)
                || (here < sides(self)
                    && self.turns(here + 1) + self.turns(here) <= next.turns(there + 1) + next.turns(there));
            let [a, b] = [self.atom(here), next.atom(there)];
            if goes_here {
                here += 1;
                facets.push([a, self.atom(here), b]);
            } else {
                there += 1;
                facets.push([a, next.atom(there), b]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{SurfaceRules, Topology, area, check_surface, facet_qualities};

    const PIPETTE: [[f64; 2]; 4] = [[2.0, 0.0], [3.0, 0.0], [3.0, 9.0], [2.0, 9.0]];

    fn made(corners: &[[f64; 2]], rounding: f64, around: u32) -> Surface {
        lathe(Profile { corners, rounding, around }).unwrap_or_else(|fault| panic!("{fault:?}"))
    }

    fn fault(corners: &[[f64; 2]], rounding: f64) -> ProfileFault {
        lathe(Profile { corners, rounding, around: 12 }).expect_err("no surface")
    }

    #[test]
    fn a_ring_has_a_hole_and_the_volume_and_area_of_what_it_stands_for() {
        let errors = [16, 32, 64, 128].map(|around| {
            let ring = made(&PIPETTE, 0.0, around);
            assert_eq!(Topology::of(&ring).euler_characteristic(), 0);
            assert!(check_surface(&ring, &SurfaceRules::CELL).is_ok(), "{around}");
            (volume(&ring) - 45.0 * PI, area(&ring) - 100.0 * PI)
        });
        for (coarse, fine) in errors.iter().zip(&errors[1..]) {
            assert!((3.5..4.5).contains(&(coarse.1 / fine.1)), "second order: {errors:?}");
        }
        // What the outer wall lacks of its volume the hole lacks, too.
        assert!(errors[0].0.abs() < 0.5 && errors[2].0.abs() < 0.02, "{errors:?}");
    }

    #[test]
    fn a_profile_between_two_points_of_the_axis_makes_a_body_without_a_hole() {
        let cone = made(&[[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]], 0.0, 96);
        assert_eq!(Topology::of(&cone).euler_characteristic(), 2);
        assert!((volume(&cone) / (12.0 * PI) - 1.0).abs() < 2e-3, "{}", volume(&cone));
        assert!((area(&cone) / (24.0 * PI) - 1.0).abs() < 2e-3, "{}", area(&cone));
        let [upwards, downwards] =
            [[[0.0, 0.0], [2.0, 0.0], [2.0, 5.0], [0.0, 5.0]], [[0.0, 5.0], [2.0, 5.0], [2.0, 0.0], [0.0, 0.0]]]
                .map(|corners| volume(&made(&corners, 0.0, 48)));
        assert!(
            (upwards - downwards).abs() < 1e-9 && (upwards / (20.0 * PI) - 1.0).abs() < 5e-3,
            "{upwards} {downwards}"
        );
    }

    #[test]
    fn facets_are_nearly_regular_wherever_they_are() {
        for (corners, rounding) in [(&PIPETTE[..], 0.5), (&[[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]], 0.0)] {
            let surface = made(corners, rounding, 32);
            let worst = facet_qualities(&surface).into_iter().fold(1.0, f64::min);
            assert!(worst > 0.5, "{worst}");
        }
    }

    #[test]
    fn corners_are_rounded_by_arcs_that_touch_both_sides() {
        let rounded = made(&PIPETTE, 0.5, 64);
        let lowest = rounded.positions.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        assert!(lowest.abs() < 1e-12, "{lowest}");
        for x in rounded.positions.iter().filter(|x| x.z < 0.5) {
            let off = (x.x.hypot(x.y) - 2.5).hypot(x.z - 0.5) - 0.5;
            assert!(off.abs() < 1e-9, "{x:?}: {off}");
        }
        // The arcs of both lips, each half a circle that turns about the axis, are a torus in place of a part of the tube.
        let exact = 2.0 * PI * 2.5 * (8.0 + PI * 0.25);
        assert!((volume(&rounded) / exact - 1.0).abs() < 1e-2, "{} {exact}", volume(&rounded));
        // A corner that looks in is filled.
        let notched = made(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0]], 0.5, 64);
        assert!(notched.positions.iter().all(|x| (x.x.hypot(x.y) - 2.0).hypot(x.z - 2.0) > 0.2));
    }

    #[test]
    fn a_corner_on_a_straight_side_changes_nothing() {
        let plain = made(&PIPETTE, 0.4, 32);
        let [a, b, c, d] = PIPETTE;
        let with_more = made(&[a, b, [3.0, 4.5], c, d], 0.4, 32);
        assert!((volume(&plain) - volume(&with_more)).abs() < 0.01 && (area(&plain) - area(&with_more)).abs() < 0.05);
        let widest = with_more.positions.iter().map(|x| x.x.hypot(x.y)).fold(0.0, f64::max);
        assert!((widest - 3.0).abs() < 1e-12, "{widest}");
    }

    #[test]
    fn what_makes_no_surface_is_told() {
        use ProfileFault::*;
        assert_eq!(fault(&[[1.0, 0.0], [2.0, 0.0]], 0.0), TooFew);
        assert_eq!(fault(&[[1.0, 0.0], [2.0, 0.0], [-1.0, 3.0]], 0.0), Beyond(2));
        assert_eq!(fault(&[[1.0, 0.0], [0.0, 1.0], [1.0, 3.0]], 0.0), OnAxis(1));
        assert_eq!(fault(&[[0.0, 0.0], [1.0, 1.0], [1.0, 3.0]], 0.0), OnAxis(2));
        assert_eq!(fault(&[[1.0, 0.0], [1.0, 0.0], [1.0, 3.0]], 0.0), Twice(1));
        assert_eq!(fault(&[[1.0, 0.0], [2.0, 0.0], [1.0, 3.0], [2.0, 3.0]], 0.0), Crosses(1, 3));
        assert_eq!(fault(&[[1.0, 0.0], [3.0, 0.0], [2.0, 0.0], [2.0, 3.0]], 0.0), Crosses(0, 1));
        assert_eq!(fault(&[[1.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 0.0]], 0.0), Crosses(0, 2));
        let Rounding(_, most) = fault(&PIPETTE, 0.6) else { panic!("too round") };
        assert!((most - 0.5).abs() < 1e-12, "{most}");
        assert_eq!(fault(&[[0.0, 0.0], [1e-7, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]], 0.0), Slivers(1));
    }
}
