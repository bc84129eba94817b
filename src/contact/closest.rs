//! Closest points: of an atom on a facet and of two edges on each other. Every answer is finite, also for facets and
//! edges that have collapsed.

use crate::Vec3;

/// Squared sine below which a facet counts as a line and two edges count as parallel.
pub(super) const LEAST_SINE_SQUARED: f64 = 1e-20;

/// Where on a facet the closest point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// Inside the facet.
    Face,
    /// On the side that runs from corner `k` to the next corner.
    Side(u8),
    /// On corner `k`.
    Corner(u8),
}

/// The point of a facet that is closest to an atom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacetPoint {
    /// Barycentric weights of the facet's second and third corner; the first has what is left of 1.
    pub weights: [f64; 2],
    /// Where on the facet it lies.
    pub feature: Feature,
    /// From the closest point to the atom, µm.
    pub offset: Vec3,
}

/// The point of a facet that is closest to an atom at `point`, eq. (contacts.1); positions in µm.
///
/// The regions around a triangle are told apart as by Ericson, Real-Time Collision Detection (2005), 5.1.5. A facet
/// without area is treated as its three sides, a facet shrunk to a point as that point.
#[inline]
pub fn closest_on_facet(point: Vec3, [a, b, c]: [Vec3; 3]) -> FacetPoint {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let at = |second: f64, third: f64, feature| FacetPoint {
        weights: [second, third],
        feature,
        offset: ap - ab * second - ac * third,
    };
    let doubled_area = ab.cross(&ac).norm_squared();
    if doubled_area <= LEAST_SINE_SQUARED * ab.norm_squared() * ac.norm_squared() {
        return closest_on_sides(point, [a, b, c]);
    }
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return at(0.0, 0.0, Feature::Corner(0));
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return at(1.0, 0.0, Feature::Corner(1));
    }
    let of_c = d1 * d4 - d3 * d2;
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return at(d1 / (d1 - d3), 0.0, Feature::Side(0));
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return at(0.0, 1.0, Feature::Corner(2));
    }
    let of_b = d5 * d2 - d1 * d6;
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return at(0.0, d2 / (d2 - d6), Feature::Side(2));
    }
    let of_a = d3 * d6 - d5 * d4;
    if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1.0 - share, share, Feature::Side(1));
    }
    let share = 1.0 / (of_a + of_b + of_c);
    at(of_b * share, of_c * share, Feature::Face)
}

/// The closest point on the three sides of a facet.
fn closest_on_sides(point: Vec3, corners: [Vec3; 3]) -> FacetPoint {
    let mut best = FacetPoint { weights: [0.0; 2], feature: Feature::Corner(0), offset: point - corners[0] };
    for side in 0..3 {
        let next = (side + 1) % 3;
        let along = corners[next] - corners[side];
        let share = share_along(point - corners[side], along);
        let offset = point - corners[side] - along * share;
        if offset.norm_squared() < best.offset.norm_squared() {
            let mut weights = [0.0; 3];
            weights[side] += 1.0 - share;
            weights[next] += share;
            let feature = match share {
                0.0 => Feature::Corner(side as u8),
                1.0 => Feature::Corner(next as u8),
                _ => Feature::Side(side as u8),
            };
            best = FacetPoint { weights: [weights[1], weights[2]], feature, offset };
        }
    }
    best
}

/// How far along a segment the foot of a point lies, from 0 to 1; 0 on a segment without length.
fn share_along(from_start: Vec3, along: Vec3) -> f64 {
    let length_squared = along.norm_squared();
    if length_squared > 0.0 { (from_start.dot(&along) / length_squared).clamp(0.0, 1.0) } else { 0.0 }
}

/// The squared distance between two segments, µm²; the parameters along both come with it.
///
/// Ericson 2005, 5.1.9; parallel segments and segments without length included.
#[inline]
pub fn closest_on_segments([a, b]: [Vec3; 2], [c, d]: [Vec3; 2]) -> (f64, [f64; 2]) {
    let (first, second, between) = (b - a, d - c, a - c);
    let (ff, ss) = (first.norm_squared(), second.norm_squared());
    let (fs, fb, sb) = (first.dot(&second), first.dot(&between), second.dot(&between));
    let sine_squared = ff * ss - fs * fs;
    let mut on_first = if sine_squared > LEAST_SINE_SQUARED * ff * ss {
        ((fs * sb - fb * ss) / sine_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    // The best point on one segment for the point on the other, twice: exact once one parameter is clamped.
    let mut on_second = if ss > 0.0 { ((fs * on_first + sb) / ss).clamp(0.0, 1.0) } else { 0.0 };
    if ff > 0.0 {
        on_first = ((fs * on_second - fb) / ff).clamp(0.0, 1.0);
    }
    if ss > 0.0 {
        on_second = ((fs * on_first + sb) / ss).clamp(0.0, 1.0);
    }
    ((between + first * on_first - second * on_second).norm_squared(), [on_first, on_second])
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACET: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];

    #[test]
    fn an_atom_over_a_face_a_side_and_a_corner_finds_each() {
        let of = |x: f64, y: f64| closest_on_facet(Vec3::new(x, y, 2.0), FACET);
        let face = of(1.0, 1.0);
        assert_eq!((face.feature, face.weights, face.offset), (Feature::Face, [0.25, 0.25], Vec3::z() * 2.0));
        let cases = [
            (of(2.0, -1.0), Feature::Side(0)),
            (of(3.0, 3.0), Feature::Side(1)),
            (of(-1.0, 2.0), Feature::Side(2)),
            (of(-1.0, -1.0), Feature::Corner(0)),
            (of(6.0, -1.0), Feature::Corner(1)),
            (of(-1.0, 6.0), Feature::Corner(2)),
        ];
        for (found, feature) in cases {
            assert_eq!(found.feature, feature);
        }
        assert_eq!(of(3.0, 3.0).weights, [0.5, 0.5]);
    }

    #[test]
    fn facets_without_area_answer_like_their_longest_side() {
        let flat = [Vec3::zeros(), Vec3::x() * 2.0, Vec3::x()];
        let found = closest_on_facet(Vec3::new(1.5, 3.0, 0.0), flat);
        assert_eq!(found.offset, Vec3::y() * 3.0);
        let point = closest_on_facet(Vec3::z(), [Vec3::zeros(); 3]);
        assert_eq!((point.feature, point.offset), (Feature::Corner(0), Vec3::z()));
    }

    #[test]
    fn segments_crossing_parallel_and_shrunk_have_their_distance() {
        let x = [Vec3::x() * -1.0, Vec3::x()];
        let crossing = [Vec3::new(0.5, -1.0, 0.3), Vec3::new(0.5, 1.0, 0.3)];
        let (squared, at) = closest_on_segments(x, crossing);
        assert!((squared - 0.09).abs() < 1e-15);
        assert_eq!(at, [0.75, 0.5]);
        let parallel = [Vec3::new(0.0, 2.0, 0.0), Vec3::new(5.0, 2.0, 0.0)];
        assert_eq!(closest_on_segments(x, parallel).0, 4.0);
        let point = [Vec3::new(3.0, 0.0, 0.0); 2];
        assert_eq!(closest_on_segments(x, point), (4.0, [1.0, 0.0]));
        assert_eq!(closest_on_segments(point, x), (4.0, [0.0, 1.0]));
    }
}
