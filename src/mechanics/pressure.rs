//! Pressure on facets, along their normals wherever these are, eqs. (loads.2) to (loads.4).

use super::course::Course;
use super::lanes::{Real, V3, Vectors, VectorsMut};
use crate::Vec3;

/// Where a pressure acts: beyond a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beyond {
    /// A point of the plane, µm.
    pub point: Vec3,
    /// Unit normal to the side on which it acts.
    pub direction: Vec3,
    /// How far from the axis through the point along the normal it acts, µm; everywhere beyond the plane if not said.
    pub radius: Option<f64>,
}

/// How a pressure differs with the angle between an axis in space and the direction in which a facet lies from the mean of all atoms of its cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Unit axis.
    pub axis: Vec3,
    /// Cosines of angles, rising from −1 to 1.
    pub cosines: Vec<f64>,
    /// What the pressure is multiplied by there; straight between them.
    pub factors: Vec<f64>,
    /// Atoms of a cell.
    pub atoms: usize,
}

/// A pressure on facets of every cell of a kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Pressure {
    /// Its name; the series is `pressure.<name>`.
    pub name: String,
    /// The facets.
    pub facets: Vec<[u32; 3]>,
    /// How much higher it is outside, pN/µm²: it pushes facets in, or draws them out where it is negative.
    pub pressure: Course,
    /// Where it acts; everywhere if not said.
    pub beyond: Option<Beyond>,
    /// How it differs over the surface; alike everywhere if not said.
    pub profile: Option<Profile>,
}

/// Far below any length, and yet no zero to divide by.
const TINY: f64 = 1e-300;

impl Pressure {
    /// Adds the force on every atom at this pressure (pN/µm²). It has no energy.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, pressure: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let third = T::constant(x.token, 1.0 / 3.0);
        let centre = self.profile.as_ref().map(|profile| profile.centre(x));
        for facet in &self.facets {
            let corners = facet.map(|atom| x.get(atom as usize));
            let [a, b, c] = corners;
            // Of a vector of the whole area, which looks outwards.
            let mut push = (b - a).cross(c - a).times(pressure * -0.5);
            if let (Some(profile), Some(centre)) = (&self.profile, centre) {
                push = push.times(profile.factor(x.token, (a + b + c).scaled(1.0 / 3.0) - centre));
            }
            let weights = match &self.beyond {
                None => [third; 3],
                Some(plane) => plane.weights(x.token, corners),
            };
            for (atom, weight) in facet.iter().zip(weights) {
                f.add(*atom as usize, push.times(weight));
            }
        }
        T::constant(x.token, 0.0)
    }
}

impl Profile {
    /// The mean of the atoms, µm.
    #[inline(always)]
    fn centre<T: Real>(&self, x: &Vectors<T>) -> V3<T> {
        let mut sum = V3::zero(x.token);
        for atom in 0..self.atoms {
            sum += x.get(atom);
        }
        sum.scaled(1.0 / self.atoms as f64)
    }

    /// What the pressure on a facet is multiplied by that lies so from the centre.
    #[inline(always)]
    fn factor<T: Real>(&self, token: T::Token, from: V3<T>) -> T {
        let along = from.dot(V3::constant(token, self.axis.into()));
        (along / (from.squared().sqrt() + TINY)).map(|cosine| self.at(cosine))
    }

    /// What it is multiplied by at an angle with this cosine.
    fn at(&self, cosine: f64) -> f64 {
        let last = self.cosines.len() - 1;
        let after = self.cosines.partition_point(|known| *known < cosine).clamp(1, last);
        let [low, high] = [after - 1, after];
        let share = ((cosine - self.cosines[low]) / (self.cosines[high] - self.cosines[low])).clamp(0.0, 1.0);
        self.factors[low] + share * (self.factors[high] - self.factors[low])
    }
}

impl Beyond {
    /// What of a pressure on a facet each of its corners bears.
    #[inline(always)]
    fn weights<T: Real>(&self, token: T::Token, corners: [V3<T>; 3]) -> [T; 3] {
        let &Self { point, direction, radius } = self;
        let [point, direction] = [point, direction].map(|vector| V3::constant(token, vector.into()));
        let from = corners.map(|corner| corner - point);
        let heights = from.map(|from| from.dot(direction));
        let weights = beyond(heights);
        let Some(radius) = radius else { return weights };
        let [a, b, c] = [0, 1, 2].map(|i| from[i] - direction.times(heights[i]));
        let middle = a + b + c;
        let outwards = middle.times(T::constant(token, 1.0) / (middle.squared().sqrt() + TINY));
        // The circle stands for its tangent where the facet is.
        let [p, q, r] = beyond([a, b, c].map(|across| -across.dot(outwards) + radius));
        weights.map(|weight| weight * (p + q + r))
    }
}

/// The integral of each barycentric weight over the part of a facet that is beyond a plane, over its area, eq. (loads.3), where the corners have
/// these heights over the plane.
#[inline(always)]
fn beyond<T: Real>(heights: [T; 3]) -> [T; 3] {
    let above = heights.map(|height| height.max(height * 0.0));
    let below = [0, 1, 2].map(|i| above[i] - heights[i]);
    // 1 where a corner is beyond the plane, else 0; so no lane has to be told from others.
    let is = [0, 1, 2].map(|i| above[i] / (above[i] + below[i] + TINY));
    let not = is.map(|is| -is + 1.0);
    let all = is[0] * is[1] * is[2] * (1.0 / 3.0);
    let mut weights = [all; 3];
    for a in 0..3 {
        let [b, c] = [(a + 1) % 3, (a + 2) % 3];
        let cut = corner_of(above[a], [below[b], below[c]], is[a] * not[b] * not[c]);
        let left = corner_of(below[a], [above[b], above[c]], not[a] * is[b] * is[c]);
        let rest = not[a] * is[b] * is[c] * (1.0 / 3.0);
        for (k, corner) in [a, b, c].into_iter().enumerate() {
            weights[corner] += cut[k] + rest - left[k];
        }
    }
    weights
}

/// The same for the triangle that a plane cuts off at one corner, `height` from the plane where the two others are at `others` beyond it, times
/// what is 1 where that is so and else 0.
#[inline(always)]
fn corner_of<T: Real>(height: T, others: [T; 2], is_so: T) -> [T; 3] {
    let [to_b, to_c] = others.map(|other| height / (height + other + TINY));
    let third = to_b * to_c * is_so * (1.0 / 3.0);
    [third * (-(to_b + to_c) * 1.0 + 3.0), third * to_b, third * to_c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_beyond_a_plane_are_what_many_points_say() {
        const POINTS: usize = 900;
        let heights = [
            [1.0, 2.0, 0.5],
            [-1.0, -0.2, -3.0],
            [1.0, -0.3, -2.0],
            [-0.4, 1.5, -0.1],
            [0.7, 0.2, -0.9],
            [-0.3, 1.0, 1.1],
            [0.0, 1.0, -1.0],
            [0.0, 0.0, 1.0],
            [0.0, -1.0, -2.0],
        ];
        for heights in heights {
            let mut wanted = [0.0; 3];
            let mut count = 0.0;
            for i in 0..POINTS {
                for j in 0..POINTS - i {
                    let [b, c] = [i, j].map(|i| (i as f64 + 1.0 / 3.0) / POINTS as f64);
                    let weights = [1.0 - b - c, b, c];
                    count += 1.0;
                    if (0..3).map(|k| weights[k] * heights[k]).sum::<f64>() > 0.0 {
                        (0..3).for_each(|k| wanted[k] += weights[k]);
                    }
                }
            }
            let found = beyond(heights);
            let off = (0..3).map(|k| (found[k] - wanted[k] / count).abs()).fold(0.0, f64::max);
            // A row of points along a cut is a 900th of the height, and counts on one side of it.
            assert!(off < 3e-3, "{heights:?}: {found:?}, {:?}", wanted.map(|w| w / count));
        }
    }

    #[test]
    fn weights_have_no_jump_where_a_corner_passes_the_plane() {
        for heights in [[0.0, 1.0, -2.0], [0.0, 1.0, 2.0], [0.0, -1.0, -2.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]] {
            let [low, high] = [-1e-9, 1e-9].map(|by| beyond([heights[0] + by, heights[1], heights[2]]));
            let jump = (0..3).map(|k| (low[k] - high[k]).abs()).fold(0.0, f64::max);
            assert!(jump < 1e-8, "{heights:?}: {low:?} {high:?}");
        }
    }
}
