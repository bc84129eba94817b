//! Bodies of revolution as exact surfaces: how far a point is from one, by the sides and arcs of its profile, eq. (planes.2).

use super::profile::{Arc, Piece, Profile, ProfileFault, outline};
use crate::Vec3;
use std::f64::consts::PI;

/// Where a point is beside an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// Distance from its surface, µm; negative within.
    pub gap: f64,
    /// Unit normal of the surface at the point of it that is nearest, towards the free side: the gradient of the gap.
    pub normal: Vec3,
}

/// A body that a profile makes when it is turned about an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Turned {
    /// Where the axis has the height 0, µm.
    pub point: Vec3,
    /// Its unit direction.
    pub axis: Vec3,
    /// The profile with its rounded corners, as pieces from end to end.
    pieces: Vec<Piece>,
    /// 1 where what is right of the profile is outside, else -1.
    side: f64,
    /// The point where each piece begins, and the sum of the outward normals of both that meet there; one more behind the last where the profile
    /// has ends on the axis.
    corners: Vec<([f64; 2], [f64; 2])>,
}

/// A tip is sharp whose normal beside the axis leans away from it by more than this sine.
const SHARP: f64 = 0.05;

/// Points nearer to a corner than this part of a micrometre have the normal of the corner.
const ROUND_OFF: f64 = 1e-12;

impl Turned {
    /// The body of a profile about an axis through a point (µm) in a direction, which need not be of length 1.
    ///
    /// # Errors
    /// A profile that crosses itself, or of which no closed body can be made.
    pub fn new(profile: &Profile, point: Vec3, axis: Vec3) -> Result<Self, ProfileFault> {
        let (pieces, is_ring) = outline(profile.corners, profile.rounding)?;
        let ends = profile.corners.iter().zip(profile.corners.iter().cycle().skip(1));
        let doubled_area: f64 = ends.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
        Ok(Self::of_pieces(pieces, (is_ring, doubled_area.signum()), point, axis))
    }

    /// A ball of a radius around a point, µm.
    pub fn ball(radius: f64, centre: Vec3) -> Self {
        let half = Arc::new([0.0, 0.0], radius, -0.5 * PI, PI);
        Self::of_pieces(vec![Piece::Arc(half)], (false, 1.0), centre, Vec3::z())
    }

    fn of_pieces(pieces: Vec<Piece>, (is_ring, side): (bool, f64), point: Vec3, axis: Vec3) -> Self {
        let count = pieces.len();
        let normal = |number: usize, end: usize| pieces[number].normal_at_end(end).map(|part| part * side);
        let corner = |number: usize| {
            let (at, one, other) = match number {
                0 if !is_ring => (pieces[0].ends()[0], normal(0, 0), mirrored(normal(0, 0))),
                _ if number == count => {
                    (pieces[count - 1].ends()[1], normal(count - 1, 1), mirrored(normal(count - 1, 1)))
                }
                _ => (pieces[number].ends()[0], normal((number + count - 1) % count, 1), normal(number, 0)),
            };
            (at, [one[0] + other[0], one[1] + other[1]])
        };
        let corners = (0..if is_ring { count } else { count + 1 }).map(corner).collect();
        Self { point, axis: axis.normalize(), pieces, side, corners }
    }

    /// How far a point (µm) is from the surface, and the normal there.
    pub fn beside(&self, x: &Vec3) -> Beside {
        let from = x - self.point;
        let height = from.dot(&self.axis);
        let across = from - height * self.axis;
        let radius = across.norm();
        let (gap, [outwards, along]) = self.in_half_plane([radius, height]);
        let out = if radius > 0.0 { across / radius } else { any_across(&self.axis) };
        Beside { gap, normal: outwards * out + along * self.axis }
    }

    /// The same in the half plane of the profile.
    fn in_half_plane(&self, p: [f64; 2]) -> (f64, [f64; 2]) {
        let mut best = (f64::INFINITY, [0.0, 1.0]);
        for piece in &self.pieces {
            if let Some((gap, normal)) = piece.beside(p)
                && gap.abs() < best.0.abs()
            {
                best = (gap * self.side, normal.map(|part| part * self.side));
            }
        }
        for (at, normals) in &self.corners {
            let [r, z] = [p[0] - at[0], p[1] - at[1]];
            let distance = r.hypot(z);
            if distance <= best.0.abs() {
                let sign = (r * normals[0] + z * normals[1]).signum();
                let [r, z] = if distance > ROUND_OFF { [sign * r, sign * z] } else { *normals };
                let length = r.hypot(z);
                best = (sign * distance, [r / length, z / length]);
            }
        }
        best
    }

    /// How far from its axis its thinnest part is, µm: the radius of a ball, the corner that is nearest to the axis, nothing where a tip is sharp.
    pub fn thinnest(&self) -> f64 {
        if let [Piece::Arc(half)] = &self.pieces[..] {
            return half.radius();
        }
        let is_sharp = |end: &[f64; 2], normal: [f64; 2]| end[0] == 0.0 && normal[0].abs() > SHARP;
        let tips = self.pieces.iter().flat_map(|piece| [0, 1].map(|end| (piece.ends()[end], piece.normal_at_end(end))));
        if tips.clone().any(|(end, normal)| is_sharp(&end, normal)) {
            return 0.0;
        }
        tips.map(|(end, _)| end[0]).filter(|radius| *radius > 0.0).fold(f64::INFINITY, f64::min)
    }

    /// A point of its surface, µm.
    pub fn a_point(&self) -> Vec3 {
        let [radius, height] = self.pieces[0].ends()[0];
        self.point + radius * any_across(&self.axis) + height * self.axis
    }

    /// Points of its profile, each a distance from the axis and a height, µm, as close to each other on arcs as pictures need.
    pub fn profile(&self) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = self.pieces.iter().flat_map(|piece| piece.points(12.0)).collect();
        points.extend(self.corners.get(self.pieces.len()).map(|(at, _)| *at));
        points
    }
}

/// What a normal is on the other side of the axis.
fn mirrored([r, z]: [f64; 2]) -> [f64; 2] {
    [-r, z]
}

/// Some direction across an axis.
fn any_across(axis: &Vec3) -> Vec3 {
    axis.cross(&if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() }).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, Stream};

    const PIPETTE: [[f64; 2]; 4] = [[2.0, 0.0], [3.0, 0.0], [3.0, 9.0], [2.0, 9.0]];
    const TIP: [[f64; 2]; 4] = [[0.0, 0.0], [0.4, 0.3], [1.5, 6.0], [0.0, 6.0]];
    /// With a corner that points into it.
    const STEP: [[f64; 2]; 6] = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]];

    fn made(corners: &[[f64; 2]], rounding: f64) -> Turned {
        let profile = Profile { corners, rounding, around: 6 };
        Turned::new(&profile, Vec3::new(1.0, -2.0, 0.5), Vec3::new(1.0, 2.0, -2.0)).expect("good")
    }

    /// The distance from a profile in small straight parts, and whether a point is within by how often a ray crosses them.
    fn looked_for(body: &Turned, p: [f64; 2]) -> f64 {
        let points: Vec<[f64; 2]> = body.pieces.iter().flat_map(|piece| piece.points(4000.0)).collect();
        let last = body.pieces[body.pieces.len() - 1].ends()[1];
        let ends: Vec<[f64; 2]> = points.into_iter().chain([last]).collect();
        let mut parts: Vec<[[f64; 2]; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        let of_part = |[a, b]: &[[f64; 2]; 2]| {
            let along = [b[0] - a[0], b[1] - a[1]];
            let from = [p[0] - a[0], p[1] - a[1]];
            let share = (from[0] * along[0] + from[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
            let share = share.clamp(0.0, 1.0);
            (from[0] - share * along[0]).hypot(from[1] - share * along[1])
        };
        let distance = parts.iter().filter(|[a, b]| a != b).map(of_part).fold(f64::INFINITY, f64::min);
        parts.push([last, ends[0]]);
        let crosses = |[a, b]: &&[[f64; 2]; 2]| {
            (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        };
        if parts.iter().filter(crosses).count() % 2 == 1 { -distance } else { distance }
    }

    #[test]
    fn gaps_are_distances_and_normals_their_gradients() {
        let backwards: Vec<[f64; 2]> = STEP.iter().rev().copied().collect();
        let mut bodies: Vec<Turned> = [(&PIPETTE[..], 0.0), (&PIPETTE, 0.5), (&PIPETTE, 0.2), (&TIP, 0.1), (&TIP, 0.0)]
            .into_iter()
            .chain([(&STEP[..], 0.0), (&STEP, 0.45), (&backwards[..], 0.3)])
            .map(|(corners, rounding)| made(corners, rounding))
            .collect();
        bodies.push(Turned::ball(2.0, Vec3::new(1.0, 0.0, 0.0)));
        let mut stream = Stream::new(3, Purpose::Placement, 0, 0);
        for (number, body) in bodies.iter().enumerate() {
            let (mut within, mut turned) = (0, 0);
            for _ in 0..2000 {
                let [a, b] = stream.uniform_pair();
                let p = [4.0 * a, 14.0 * b - 2.5];
                let (gap, normal) = body.in_half_plane(p);
                assert!((gap - looked_for(body, p)).abs() < 1e-6, "{number} {p:?}: {gap} {}", looked_for(body, p));
                within += usize::from(gap < 0.0);
                // In space, at some angle about the axis.
                let [around, _] = stream.uniform_pair();
                let out = any_across(&body.axis);
                let (sin, cos) = (2.0 * PI * around).sin_cos();
                let out = cos * out + sin * body.axis.cross(&out);
                let x = body.point + p[0] * out + p[1] * body.axis;
                let beside = body.beside(&x);
                assert!((beside.gap - gap).abs() < 1e-12 && (beside.normal.norm() - 1.0).abs() < 1e-12);
                assert!((beside.normal - (normal[0] * out + normal[1] * body.axis)).norm() < 1e-9);
                // The nearest point is on the surface, and its normal the same.
                let foot = x - gap * beside.normal;
                assert!(body.beside(&foot).gap.abs() < 1e-9, "{number} {p:?}");
                let slope = Vec3::from_fn(|axis, _| {
                    let by = Vec3::from_fn(|other, _| if other == axis { 1e-6 } else { 0.0 });
                    (body.beside(&(x + by)).gap - body.beside(&(x - by)).gap) / 2e-6
                });
                // But where two parts of it are as near.
                turned += usize::from((slope - beside.normal).norm() < 1e-4);
            }
            assert!(within > 100 && turned > 1990, "{number}: {within} {turned}");
        }
    }

    #[test]
    fn the_gap_of_a_point_on_the_surface_has_a_normal() {
        for (at, normal) in [([3.0, 4.0], [1.0, 0.0]), ([2.0, 4.0], [-1.0, 0.0]), ([2.5, 0.0], [0.0, -1.0])] {
            let (gap, found) = made(&PIPETTE, 0.2).in_half_plane(at);
            assert!(gap.abs() < 1e-15 && found == normal, "{gap} {found:?}");
        }
        let (gap, found) = made(&TIP, 0.0).in_half_plane([0.0, 0.0]);
        assert!(gap == 0.0 && found == [0.0, -1.0], "{gap} {found:?}");
        let (gap, found) = made(&PIPETTE, 0.0).in_half_plane([3.0, 9.0]);
        assert!(gap == 0.0 && (found[0] - 0.5f64.sqrt()).abs() < 1e-15 && (found[1] - found[0]).abs() < 1e-15);
    }
}
