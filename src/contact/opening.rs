//! How far open the space between two surfaces is at a point of one of them: the diameter of the ball that rests on the one there and
//! just touches the other, eq. (contacts.13). Between parallel surfaces that is their distance. Surfaces that look away from each
//! other have no such ball, however near they are, and where the other surface turns or ends it changes without a jump.

use super::closest::Feature;
use crate::Vec3;

/// The ball that rests on a surface at a point and just touches a facet of another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Opening {
    /// Its diameter, µm; negative by what the point is behind the facet.
    pub width: f64,
    /// Barycentric weights of where it touches the facet.
    pub weights: [f64; 3],
    /// From the point to there, over what of this is along the normal of the surface: 1 along it, more across it.
    pub towards: Vec3,
}

/// What a point may be behind a facet that faces it and still touch it, over the length of the facet: twice the depth that is promised. Beside
/// a ridge a point is behind the plane of the far wall by more, and is not in it.
pub(super) const BEHIND: f64 = 0.03;

/// Cosine below which normals face each other.
pub(super) const FACING: f64 = -0.3;

/// One over the squared cosine of the angle between the normal at a point and the way to where the other surface is touched, 75°, beyond which
/// that is beside the point and not before it. A surface that is touched there looks to where the point's own looks, within 30°, and
/// what moves it a little changes the ball without bound.
pub(super) const BESIDE: f64 = 16.0;

/// A step along the normal below which it gives no direction, over the distance.
pub(super) const LEVEL: f64 = 1e-9;

/// The opening between a point x of a surface with the unit normal n to its outside and a facet with its unit normal m,
///
/// `l = min |y − x|² / (n · (y − x))` over the points y of the facet with `n · (y − x) > 0`,
///
/// and where on the facet that y is. None where there is none, or that y is beside the point.
#[inline]
pub fn opening_to_facet(x: Vec3, n: Vec3, corners: &[Vec3; 3], m: Vec3) -> Option<(Opening, Feature)> {
    let height = (x - corners[0]).dot(&m);
    let size = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm().sqrt();
    // Behind a valley of two facets a point is beside both by less than it is behind them.
    let beside = (-height / size).max(0.0);
    let faces = height >= 0.0 || n.dot(&m) < FACING && -height <= BEHIND * size;
    let plane = opening_to_face(x, n, corners, m);
    let found = match plane.filter(|opening| faces && opening.weights.iter().all(|w| *w >= -beside)) {
        Some(opening) => Some((opening, Feature::Face)),
        None => {
            let met = if height >= 0.0 { plane } else { opening_to_face(x, n, corners, -m) };
            opening_to_sides(x, n, corners, met.map_or([true; 3], sides_beyond))
        }
    };
    found.filter(|(opening, _)| opening.is_before())
}

impl Opening {
    /// Whether it leads to what is before the point and not beside it.
    #[inline]
    fn is_before(&self) -> bool {
        self.towards.norm_squared() <= BESIDE
    }
}

/// A little less than 1, so that rounding makes no bound too wide.
pub const SURELY: f64 = 1.0 - 1e-9;

/// The sides of a facet, by the corner before each, that a ball may touch first. It grows on the point where it rests and meets the plane of the
/// facet at one point, from where on it covers a growing disc of that: what the disc comes to first is on a side beyond which that point lies.
#[inline]
fn sides_beyond(met: Opening) -> [bool; 3] {
    let [u, v, w] = met.weights.map(|weight| weight <= 0.0);
    // A ball that comes from behind may meet the face itself, which counts for nothing.
    if u || v || w { [w, u, v] } else { [true; 3] }
}

/// The opening to what of a facet the ball touched before things moved a little: to the plane of its face, the line of a side or a
/// corner, so that it goes on smoothly where another facet or side is touched by now.
#[inline]
pub fn opening_to_feature(x: Vec3, n: Vec3, corners: &[Vec3; 3], m: Vec3, feature: Feature) -> Option<Opening> {
    let found = match feature {
        Feature::Face => opening_to_face(x, n, corners, m),
        Feature::Side(side) => {
            let (side, next) = (side as usize, (side as usize + 1) % 3);
            let (from, along) = (corners[side] - x, corners[next] - corners[side]);
            opening_to_side(n, from, along, [side, next], share_of_side(n, from, along))
        }
        Feature::Corner(corner) => {
            let corner = corner as usize;
            opening_to_side(n, corners[corner] - x, Vec3::zeros(), [corner, (corner + 1) % 3], 0.0)
        }
    };
    found.filter(Opening::is_before)
}

/// The opening between a point at a height over a plane, on a surface with the unit normal n, and the plane with the unit normal m: its
/// width, µm, and the direction as in [`Opening`]. None where both look the same way, within 30°.
#[inline]
pub fn opening_to_plane(n: Vec3, height: f64, m: Vec3) -> Option<(f64, Vec3)> {
    ball_on_plane(n, height, m).filter(|(_, towards)| towards.norm_squared() <= BESIDE)
}

/// The same, be what it touches before the point or beside it.
#[inline]
fn ball_on_plane(n: Vec3, height: f64, m: Vec3) -> Option<(f64, Vec3)> {
    let apart = 1.0 - n.dot(&m);
    (apart > LEVEL).then(|| (2.0 * height / apart, (n - m) / apart))
}

/// The opening to the plane of a facet; weights may be negative, and none is there where the facet has no area.
#[inline]
fn opening_to_face(x: Vec3, n: Vec3, corners: &[Vec3; 3], m: Vec3) -> Option<Opening> {
    let (one, other) = (corners[1] - corners[0], corners[2] - corners[0]);
    let (width, towards) = ball_on_plane(n, (x - corners[0]).dot(&m), m)?;
    let foot = x + 0.5 * width * (n - m) - corners[0];
    let (a, b, c) = (one.norm_squared(), one.dot(&other), other.norm_squared());
    let (d, e) = (foot.dot(&one), foot.dot(&other));
    let det = a * c - b * b;
    let [v, w] = [(c * d - b * e) / det, (a * e - b * d) / det];
    (det > 0.0).then_some(Opening { width, weights: [1.0 - v - w, v, w], towards })
}

/// The least opening to sides of a facet, each by the corner where it begins.
fn opening_to_sides(x: Vec3, n: Vec3, corners: &[Vec3; 3], sides: [bool; 3]) -> Option<(Opening, Feature)> {
    let mut best: Option<(Opening, Feature)> = None;
    for side in (0..3).filter(|side| sides[*side]) {
        let next = (side + 1) % 3;
        let (from, along) = (corners[side] - x, corners[next] - corners[side]);
        let share = share_of_side(n, from, along).clamp(0.0, 1.0);
        let Some(opening) = opening_to_side(n, from, along, [side, next], share) else { continue };
        if best.is_none_or(|(best, _)| opening.width < best.width) {
            let feature = match share {
                0.0 => Feature::Corner(side as u8),
                1.0 => Feature::Corner(next as u8),
                _ => Feature::Side(side as u8),
            };
            best = Some((opening, feature));
        }
    }
    best
}

/// The opening to a point of a side between two corners. A point on the side has no direction to it but its own normal.
#[inline]
fn opening_to_side(n: Vec3, from: Vec3, along: Vec3, [one, other]: [usize; 2], share: f64) -> Option<Opening> {
    let to = from + share * along;
    let (rise, squared) = (n.dot(&to), to.norm_squared());
    let (width, towards) = match squared <= LEVEL * LEVEL * along.norm_squared() {
        true => (0.0, n),
        false if rise > LEVEL * squared.sqrt() => (squared / rise, to / rise),
        false => return None,
    };
    let mut weights = [0.0; 3];
    (weights[one], weights[other]) = (1.0 - share, share);
    Some(Opening { width, weights, towards })
}

/// Where on the line of a side, `from + s along`, `|y|²/(n·y)` is least: a root of a quadratic, the one with n·y > 0. Where all lies in the
/// plane of the point's surface only the nearest point may touch it.
#[inline]
fn share_of_side(n: Vec3, from: Vec3, along: Vec3) -> f64 {
    let (a, b, c) = (from.norm_squared(), from.dot(&along), along.norm_squared());
    let (d, e) = (n.dot(&from), n.dot(&along));
    let root = (c * (c * d * d - 2.0 * b * d * e + a * e * e)).max(0.0).sqrt();
    let share = if d > 0.0 { (a * e - 2.0 * b * d) / (root + c * d) } else { (root - c * d) / (c * e) };
    let share = if share.is_finite() { share } else { -b / c };
    if share.is_finite() { share } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, Stream};

    const FACET: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];

    #[test]
    fn between_parallel_surfaces_it_is_their_distance_and_behind_them_less_than_nothing() {
        for height in [2.0, 1e-6, 0.0, -0.1] {
            let found = opening_to_facet(Vec3::new(1.0, 1.0, height), -Vec3::z(), &FACET, Vec3::z());
            let (opening, feature) = found.expect("faces");
            assert_eq!(feature, Feature::Face);
            assert!((opening.width - height).abs() < 1e-15, "{opening:?}");
            assert!((opening.towards + Vec3::z()).norm() < 1e-12, "{opening:?}");
            let [_, v, w] = opening.weights;
            assert!((v - 0.25).abs() < 1e-12 && (w - 0.25).abs() < 1e-12);
        }
        let away = opening_to_facet(Vec3::new(1.0, 1.0, 1.0), Vec3::z(), &FACET, Vec3::z());
        assert_eq!(away, None);
    }

    #[test]
    fn a_wall_over_a_plane_is_twice_its_height_open() {
        let (width, towards) = opening_to_plane(Vec3::x(), 0.3, Vec3::z()).expect("a ball");
        assert!((width - 0.6).abs() < 1e-15 && (towards - (Vec3::x() - Vec3::z())).norm() < 1e-15);
    }

    #[test]
    fn sides_that_are_passed_over_are_never_touched_first() {
        let mut stream = Stream::new(9, Purpose::Placement, 0, 0);
        let mut passed_over = 0;
        for _ in 0..20_000 {
            let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
            let n = Vec3::new(number(), number(), number()).normalize();
            let x = Vec3::new(2.0 + 3.0 * number(), 2.0 + 3.0 * number(), 1.4 * number());
            let Some((found, feature)) = opening_to_facet(x, n, &FACET, Vec3::z()) else { continue };
            assert!(found.towards.norm_squared() <= BESIDE, "{found:?}");
            if feature != Feature::Face {
                let (of_all, _) = opening_to_sides(x, n, &FACET, [true; 3]).expect("a side");
                // Where the ball meets the plane on the line of a side rounding decides between two that it touches alike.
                assert!((found.width - of_all.width).abs() <= 1e-9 * of_all.width, "{found:?} {of_all:?}");
                let met = opening_to_face(x, n, &FACET, if x.z >= 0.0 { Vec3::z() } else { -Vec3::z() });
                passed_over += sides_beyond(met.expect("met")).iter().filter(|side| !**side).count();
            }
        }
        assert!(passed_over > 10_000, "{passed_over}");
    }

    #[test]
    fn it_is_the_least_of_all_points_of_the_facet() {
        let mut stream = Stream::new(7, Purpose::Placement, 0, 0);
        let (mut seen, mut beside) = ([0; 2], 0);
        for _ in 0..2000 {
            let mut number = || 2.0 * stream.uniform_pair()[0] - 1.0;
            let n = Vec3::new(number(), number(), number()).normalize();
            let x = Vec3::new(2.0 + 3.0 * number(), 2.0 + 3.0 * number(), 1.5 + 1.4 * number());
            let (mut least, mut cosine) = (f64::INFINITY, 1.0);
            for i in 0..=200 {
                for j in 0..=200 - i {
                    let y = (FACET[1] * f64::from(i) + FACET[2] * f64::from(j)) / 200.0 - x;
                    if n.dot(&y) > 1e-3 && y.norm_squared() / n.dot(&y) < least {
                        (least, cosine) = (y.norm_squared() / n.dot(&y), n.dot(&y) / y.norm());
                    }
                }
            }
            // What is beside the point is not told of: it is surely so a little beyond the bound.
            if cosine < 0.3 {
                beside += usize::from(cosine < 0.2 && opening_to_facet(x, n, &FACET, Vec3::z()).is_none());
                assert!(cosine > 0.2 || opening_to_facet(x, n, &FACET, Vec3::z()).is_none(), "{x} {n}");
                continue;
            }
            let found = opening_to_facet(x, n, &FACET, Vec3::z()).map_or(f64::INFINITY, |found| found.0.width);
            // Far balls are as wide as their touching point is near the plane of x: no one asks for those.
            if least < 20.0 {
                assert!(found <= least * (1.0 + 1e-12) && found > 0.97 * least, "{found} {least} {n} {x}");
                let (opening, feature) = opening_to_facet(x, n, &FACET, Vec3::z()).expect("found");
                let again = opening_to_feature(x, n, &FACET, Vec3::z(), feature).expect("the same");
                assert!((again.width - found).abs() < 1e-9 * found && (again.towards - opening.towards).norm() < 1e-9);
                let y = (0..3).map(|i| opening.weights[i] * FACET[i]).sum::<Vec3>() - x;
                assert!((y.norm_squared() / n.dot(&y) - found).abs() < 1e-9 * found);
                assert!((y / n.dot(&y) - opening.towards).norm() < 1e-6 * opening.towards.norm());
                seen[usize::from(opening.weights.iter().all(|weight| *weight > 0.0))] += 1;
            }
        }
        assert!(seen.iter().all(|count| *count > 100) && beside > 20, "{seen:?} {beside}");
    }
}
