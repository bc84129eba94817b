//! Finds points that stand at the same point.

use crate::Vec3;
use std::collections::HashMap;

/// For every point, the number of the first point within `tolerance` (µm) of it: its own number if it is the first at
/// its position. The points must be finite; a tolerance of 0 finds points that are exactly equal.
pub(super) fn first_at_same_position(points: &[Vec3], tolerance: f64) -> Vec<u32> {
    // Points are sorted into cubes of twice the tolerance, so a partner stands in the same cube or in the next one
    // along each axis.
    let side = if tolerance > 0.0 { 2.0 * tolerance } else { 1.0 };
    let cube =
        |point: &Vec3, shift: [f64; 3]| [0, 1, 2].map(|axis| ((point[axis] + shift[axis]) / side).floor() as i64);
    let mut first_points: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut firsts = Vec::with_capacity(points.len());
    for (number, point) in points.iter().enumerate() {
        let mut found = None;
        let low = cube(point, [-tolerance; 3]);
        let high = cube(point, [tolerance; 3]);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    for &other in first_points.get(&[x, y, z]).into_iter().flatten() {
                        if (points[other as usize] - point).norm() <= tolerance {
                            found = Some(found.map_or(other, |best: u32| best.min(other)));
                        }
                    }
                }
            }
        }
        let first = found.unwrap_or(number as u32);
        if found.is_none() {
            first_points.entry(cube(point, [0.0; 3])).or_default().push(first);
        }
        firsts.push(first);
    }
    firsts
}

/// Length of the diagonal of the box around the points, µm; 0 without points.
pub(super) fn diagonal(points: &[Vec3]) -> f64 {
    super::bounding_box(points).map_or(0.0, |(low, high)| (high - low).norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_within_the_tolerance_share_the_first_number() {
        let points = [0.0, 1.0, 1.0 + 1e-9, -1e-9, 1.0 - 1e-9, 2.0].map(|x| Vec3::new(x, -x, 3.0));
        assert_eq!(first_at_same_position(&points, 1e-8), [0, 1, 1, 0, 1, 5]);
        assert_eq!(first_at_same_position(&points, 0.0), [0, 1, 2, 3, 4, 5]);
        assert_eq!(first_at_same_position(&[Vec3::zeros(), -Vec3::zeros()], 0.0), [0, 0]);
    }
}
