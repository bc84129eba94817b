//! A curved triangle through three atoms whose normals are known.

use crate::Vec3;

/// A cubic triangle with a quadratic normal, after Vlachos, Peters, Boyd and Mitchell (2001), "Curved PN triangles". Its sides depend on
/// what is at their ends alone, so that two that meet have no gap between them.
pub(super) struct Patch {
    corners: [Vec3; 3],
    normals: [Vec3; 3],
    /// Control points of the side from each corner to the next, near its beginning and near its end.
    sides: [[Vec3; 2]; 3],
    middle: Vec3,
    /// Normals at the middles of the sides.
    bends: [Vec3; 3],
}

/// How far a control point may leave its chord, over the chord: more, and a fold would bulge.
const STEEPEST: f64 = 0.6;

/// By how much farther than a third of its chord's part along a tangent a control point is away, so that the curve is an arc of a
/// circle within 0.1 % of its height. Vlachos et al. take 1, and circles of few parts are a tenth too flat. The arc turns by an angle with
/// this cosine.
fn as_arc(cosine: f64) -> f64 {
    let half = (0.5 + 0.5 * cosine).max(0.0).sqrt().clamp(0.8, 1.0);
    2.0 / (half * (1.0 + half))
}

impl Patch {
    /// Through atoms with unit normals; a side that is an edge leaves its ends along the tangents that are named.
    pub fn new(corners: [Vec3; 3], normals: [Vec3; 3], tangents: [Option<[Vec3; 2]>; 3]) -> Self {
        let next = |k: usize| (k + 1) % 3;
        let stretches = [0, 1, 2].map(|k| {
            let turns = tangents[k].map(|[one, other]| one.dot(&other).abs());
            as_arc(turns.unwrap_or_else(|| normals[k].dot(&normals[next(k)])))
        });
        let sides = [0, 1, 2].map(|k| {
            let chord = corners[next(k)] - corners[k];
            let leaving = |end: usize, along: Vec3| match tangents[k] {
                Some(tangents) => tangents[usize::from(end != k)] * along.dot(&tangents[usize::from(end != k)]),
                None => {
                    let steepest = STEEPEST * along.norm();
                    along - normals[end] * along.dot(&normals[end]).clamp(-steepest, steepest)
                }
            };
            let third = stretches[k] / 3.0;
            [corners[k] + leaving(k, chord) * third, corners[next(k)] + leaving(next(k), -chord) * third]
        });
        let mean = sides.iter().flatten().sum::<Vec3>() / 6.0;
        // A half for what is nearly flat, and more where it bends: so spheres of 12, 42 and 162 atoms are round within 0.3 %.
        let bulge = 0.5 + 1.65 * (stretches.iter().sum::<f64>() / 3.0 - 1.0);
        let middle = mean + bulge * (mean - corners.iter().sum::<Vec3>() / 3.0);
        let bends = [0, 1, 2].map(|k| {
            let (chord, sum) = (corners[next(k)] - corners[k], normals[k] + normals[next(k)]);
            let squared = chord.norm_squared().max(1e-300);
            (sum - chord * (2.0 * chord.dot(&sum) / squared)).try_normalize(1e-12).unwrap_or(normals[k])
        });
        Self { corners, normals, sides, middle, bends }
    }

    /// The point with these weights of the corners.
    pub fn point(&self, [u, v, w]: [f64; 3]) -> Vec3 {
        let ([a, b, c], [ab, bc, ca]) = (&self.corners, &self.sides);
        a * (u * u * u)
            + b * (v * v * v)
            + c * (w * w * w)
            + (ab[0] * u + ab[1] * v) * (3.0 * u * v)
            + (bc[0] * v + bc[1] * w) * (3.0 * v * w)
            + (ca[0] * w + ca[1] * u) * (3.0 * w * u)
            + self.middle * (6.0 * u * v * w)
    }

    /// The normal there, of any length.
    pub fn normal(&self, [u, v, w]: [f64; 3]) -> Vec3 {
        let ([a, b, c], [ab, bc, ca]) = (&self.normals, &self.bends);
        a * (u * u) + b * (v * v) + c * (w * w) + ab * (u * v) + bc * (v * w) + ca * (w * u)
    }

    /// How far it goes away from the flat triangle, about.
    pub fn height(&self) -> f64 {
        let flat = |[u, v, w]: [f64; 3]| self.corners[0] * u + self.corners[1] * v + self.corners[2] * w;
        let third = 1.0 / 3.0;
        let at = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [third; 3]];
        at.into_iter().map(|w| (self.point(w) - flat(w)).norm()).fold(0.0, f64::max)
    }
}
