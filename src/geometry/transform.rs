//! Moving, turning and resizing a surface.

use super::Surface;
use crate::Vec3;
use nalgebra::UnitQuaternion;

/// Moves a surface by `by`, µm.
pub fn translate(surface: &mut Surface, by: Vec3) {
    surface.positions.iter_mut().for_each(|position| *position += by);
}

/// Turns a surface about the origin.
pub fn rotate(surface: &mut Surface, by: &UnitQuaternion<f64>) {
    surface.positions.iter_mut().for_each(|position| *position = by * *position);
}

/// Stretches a surface about the origin by one factor per axis. Where the factors mirror the surface (their product
/// is negative) its facets are turned round, so that they still face outwards.
pub fn scale(surface: &mut Surface, factors: Vec3) {
    surface.positions.iter_mut().for_each(|position| position.component_mul_assign(&factors));
    if factors.product() < 0.0 {
        surface.facets.iter_mut().for_each(|facet| facet.swap(1, 2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{area, icosphere, volume};

    #[test]
    fn turning_keeps_volume_and_area_and_mirroring_keeps_the_outside_outside() {
        let mut surface = icosphere(2.0, 1);
        let (volume_before, area_before) = (volume(&surface), area(&surface));
        rotate(&mut surface, &UnitQuaternion::from_scaled_axis(Vec3::new(0.3, -1.0, 2.0)));
        translate(&mut surface, Vec3::new(3.0, 0.0, -1.0));
        // Round-off of 80 terms of size 10.
        assert!((volume(&surface) - volume_before).abs() < 1e-12);
        assert!((area(&surface) - area_before).abs() < 1e-12);
        scale(&mut surface, Vec3::new(-1.0, 2.0, 3.0));
        assert!((volume(&surface) - 6.0 * volume_before).abs() < 1e-11);
    }
}
