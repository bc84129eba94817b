//! Spheres that are finest on one side: where a tool or another cell bends the surface most.

use crate::Vec3;

/// Moves the atoms of a sphere around the origin along it so that edges are shortest at the point towards `finest` and
/// `ratio` times as long opposite, by the conformal map of eq. (geometry.1): small facets keep their shapes.
///
/// # Panics
/// When `finest` has no direction or `ratio` is not positive.
pub fn grade_sphere(positions: &mut [Vec3], finest: &Vec3, ratio: f64) {
    assert!(finest.norm() > 0.0 && ratio > 0.0, "finest towards {finest}, ratio {ratio}");
    let pole = finest.normalize();
    let shift = (ratio - 1.0) / (ratio + 1.0);
    let narrowing = (1.0 - shift * shift).sqrt();
    for position in positions {
        let (radius, height) = (position.norm(), position.dot(&pole));
        let across = *position - height * pole;
        let shrinking = 1.0 / (1.0 + shift * height / radius);
        *position = shrinking * (narrowing * across + (height + shift * radius) * pole);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Surface, Topology, area, facet_qualities, icosphere, volume};

    fn graded(level: u32, ratio: f64) -> Surface {
        let mut sphere = icosphere(2.0, level);
        grade_sphere(&mut sphere.positions, &Vec3::new(0.3, -0.2, 0.9), ratio);
        sphere
    }

    #[test]
    fn edges_are_so_many_times_as_long_opposite_and_between_by_the_factors_of_their_ends() {
        let mut sphere = icosphere(2.0, 3);
        let even = sphere.positions.clone();
        grade_sphere(&mut sphere.positions, &(0.7 * Vec3::z()), 6.0);
        // The factor σ of eq. (geometry.1), by the height in the even sphere: 6^(-1/2) at one pole, 6^(1/2) at the other.
        let shift = 5.0 / 7.0_f64;
        let factors: Vec<f64> = even.iter().map(|x| (1.0 - shift * shift).sqrt() / (1.0 + shift * x.z / 2.0)).collect();
        assert!((factors[11] / factors[0] - 6.0).abs() < 1e-12, "{} {}", factors[0], factors[11]);
        for facet in &sphere.facets {
            for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|edge| edge.map(|corner| facet[corner] as usize)) {
                let (before, after) = (even[b] - even[a], sphere.positions[b] - sphere.positions[a]);
                let factor = (factors[a] * factors[b]).sqrt();
                assert!((after.norm() - factor * before.norm()).abs() < 1e-13, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_graded_sphere_is_round_convex_and_has_well_shaped_facets() {
        for (level, ratio) in [(2, 4.0), (3, 16.0), (3, 1.0), (4, 100.0)] {
            let sphere = graded(level, ratio);
            assert!(sphere.positions.iter().all(|x| (x.norm() - 2.0).abs() < 1e-13));
            let worst = facet_qualities(&sphere).into_iter().fold(1.0, f64::min);
            assert!(worst > 0.7, "worst facet {worst} at level {level} and {ratio}");
            for facet in &sphere.facets {
                let [a, b, c] = sphere.corners(*facet);
                let normal = (b - a).cross(&(c - a));
                assert!(sphere.positions.iter().all(|x| (x - a).dot(&normal) < 1e-12), "convex at {facet:?}");
            }
            assert!(volume(&sphere) > 0.0 && area(&sphere) > 0.0 && Topology::of(&sphere).is_closed());
        }
    }

    #[test]
    fn a_ratio_of_one_leaves_all_where_it_is() {
        let sphere = graded(2, 1.0);
        let far = sphere.positions.iter().zip(icosphere(2.0, 2).positions).map(|(a, b)| (a - b).norm());
        assert!(far.fold(0.0, f64::max) < 1e-15);
    }
}
