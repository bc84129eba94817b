//! The human red blood cell at rest: a disc 7.82 µm across with a dimple on either side.

use super::{Surface, icosphere};
use crate::Vec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Diameter of the average human red cell at 300 mosmol, µm. Source: Evans & Fung 1972, Microvasc. Res. 4, 335.
pub const RED_CELL_DIAMETER: f64 = 7.82;

/// The coefficients C0, C2, C4 of the thickness. Source: Evans & Fung 1972, for 300 mosmol.
const COEFFICIENTS: [f64; 3] = [0.207_161, 2.002_558, -1.122_762];

/// Panels of the table of arc lengths. Simpson's rule on 1024 panels knows the arc length to 1e-12 of it.
const PANELS: usize = 1024;

/// Half the thickness of a red cell at distance `radius` from its axis, µm; 0 beyond the rim.
///
/// z(r) = ½ R √(1 − (r/R)²) (C0 + C2 (r/R)² + C4 (r/R)⁴), 2R the diameter (Evans & Fung 1972).
pub fn red_cell_half_thickness(diameter: f64, radius: f64) -> f64 {
    let rim = 0.5 * diameter;
    let sine = (radius / rim).abs();
    if sine >= 1.0 { 0.0 } else { rim * unit_height(sine, (1.0 - sine * sine).sqrt()) }
}

/// The biconcave red cell of Evans & Fung on the mesh of [`icosphere`] `level` (12, 42, 162, 642, 2562 … atoms),
/// centred on the origin with its axis along z; `diameter` in µm, [`RED_CELL_DIAMETER`] for the average cell, other
/// diameters keep the proportions.
///
/// The atoms lie on the profile. Each meridian of the sphere is laid along the meridian of the cell so that equal
/// steps of angle become equal steps of arc length: the facets then stay well shaped at the rim and in the dimple
/// alike, where a projection along z would leave slivers.
///
/// # Panics
/// When `level` exceeds [`MAX_ICOSPHERE_LEVEL`](super::MAX_ICOSPHERE_LEVEL).
pub fn red_cell(diameter: f64, level: u32) -> Surface {
    let mut surface = icosphere(1.0, level);
    let lengths = arc_lengths();
    for position in &mut surface.positions {
        let width = position.x.hypot(position.y);
        let polar = width.atan2(position.z.abs());
        let angle = angle_at_arc(&lengths, polar / FRAC_PI_2);
        let (sine, cosine) = if polar == FRAC_PI_2 { (1.0, 0.0) } else { angle.sin_cos() };
        let outwards = if width > 0.0 { sine / width } else { 0.0 };
        let height = unit_height(sine, cosine).copysign(position.z);
        *position = 0.5 * diameter * Vec3::new(outwards * position.x, outwards * position.y, height);
    }
    surface
}

/// Volume of the exact profile, µm³: 94.1 for the average cell (published: 94).
pub fn red_cell_volume(diameter: f64) -> f64 {
    // 2 ∫ 2π r z dr with r = R sin φ.
    let integrand = |angle: f64| 4.0 * PI * angle.sin() * angle.cos() * unit_height(angle.sin(), angle.cos());
    (0.5 * diameter).powi(3) * simpson(integrand)
}

/// Area of the exact profile, µm²: 134.1 for the average cell (published: 135).
pub fn red_cell_area(diameter: f64) -> f64 {
    (0.5 * diameter).powi(2) * simpson(|angle| 4.0 * PI * angle.sin() * arc_speed(angle))
}

/// Half thickness over R where r/R = `sine`; `cosine` = √(1 − sine²).
fn unit_height(sine: f64, cosine: f64) -> f64 {
    let [c0, c2, c4] = COEFFICIENTS;
    let square = sine * sine;
    0.5 * cosine * (c0 + square * (c2 + square * c4))
}

/// Arc length of the profile over R per angle φ, where r = R sin φ. Smooth at the rim, where dz/dr is infinite.
fn arc_speed(angle: f64) -> f64 {
    let [c0, c2, c4] = COEFFICIENTS;
    let (sine, cosine) = angle.sin_cos();
    let square = sine * sine;
    let thickness = c0 + square * (c2 + square * c4);
    let slope = 2.0 * sine * cosine * (c2 + 2.0 * square * c4);
    cosine.hypot(0.5 * (cosine * slope - sine * thickness))
}

/// Share of the arc length from the axis to the rim at [`PANELS`] + 1 equal steps of angle: 0 at first, 1 at last.
fn arc_lengths() -> Vec<f64> {
    let step = FRAC_PI_2 / PANELS as f64;
    let mut lengths = vec![0.0];
    for panel in 0..PANELS {
        let start = step * panel as f64;
        let mean = (arc_speed(start) + 4.0 * arc_speed(start + 0.5 * step) + arc_speed(start + step)) / 6.0;
        lengths.push(lengths[panel] + step * mean);
    }
    let total = lengths[PANELS];
    lengths.iter_mut().for_each(|length| *length /= total);
    lengths
}

/// The angle φ at a share of the arc length: read off the table between its two neighbours.
fn angle_at_arc(lengths: &[f64], share: f64) -> f64 {
    let panel = lengths.partition_point(|&length| length <= share).clamp(1, PANELS) - 1;
    let within = (share - lengths[panel]) / (lengths[panel + 1] - lengths[panel]);
    FRAC_PI_2 * (panel as f64 + within) / PANELS as f64
}

/// The integral of a smooth function from 0 to π/2.
fn simpson(function: impl Fn(f64) -> f64) -> f64 {
    let step = FRAC_PI_2 / PANELS as f64;
    (0..PANELS)
        .map(|panel| {
            let start = step * panel as f64;
            step * (function(start) + 4.0 * function(start + 0.5 * step) + function(start + step)) / 6.0
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{area, facet_qualities, principal_extents, smallest_angle, volume};

    #[test]
    fn the_exact_profile_has_the_published_volume_and_area() {
        // Evans & Fung 1972 print 94 µm³ and 135 µm² for their 7.82 µm; the figures are rounded to 1 %.
        let (volume, area) = (red_cell_volume(RED_CELL_DIAMETER), red_cell_area(RED_CELL_DIAMETER));
        assert!((volume / 94.0 - 1.0).abs() < 0.01, "volume {volume}");
        assert!((area / 135.0 - 1.0).abs() < 0.01, "area {area}");
        // 4πR³/2 ∫ s √(1−s²)(C0 + C2 s² + C4 s⁴) ds = 2πR³ (C0/3 + 2 C2/15 + 8 C4/105), integrated by hand.
        let [c0, c2, c4] = COEFFICIENTS;
        let exact = 2.0 * PI * 3.91_f64.powi(3) * (c0 / 3.0 + 2.0 * c2 / 15.0 + 8.0 * c4 / 105.0);
        assert!((volume - exact).abs() < 1e-9);
    }

    #[test]
    fn meshes_approach_the_exact_volume_and_area() {
        let (exact_volume, exact_area) = (red_cell_volume(RED_CELL_DIAMETER), red_cell_area(RED_CELL_DIAMETER));
        let mut last = (f64::INFINITY, f64::INFINITY);
        for level in 1..=4 {
            let cell = red_cell(RED_CELL_DIAMETER, level);
            let errors = ((volume(&cell) / exact_volume - 1.0).abs(), (area(&cell) / exact_area - 1.0).abs());
            // Second order: a level quarters the error; 2.5 allows for the coarsest meshes.
            assert!(errors.0 < last.0 / 2.5 && errors.1 < last.1 / 2.5, "level {level}: {errors:?} after {last:?}");
            last = errors;
        }
        assert!(last.0 < 0.005 && last.1 < 0.005, "{last:?}");
    }

    #[test]
    fn facets_are_well_shaped_at_every_level() {
        for level in 1..=4 {
            let cell = red_cell(RED_CELL_DIAMETER, level);
            let worst = facet_qualities(&cell).into_iter().fold(1.0, f64::min);
            assert!(worst > 0.85, "level {level}: worst quality {worst}");
            assert!(smallest_angle(&cell).to_degrees() > 45.0, "level {level}");
        }
    }

    #[test]
    fn atoms_lie_on_the_profile_and_the_axis_is_z() {
        let cell = red_cell(8.0, 3);
        for position in &cell.positions {
            let half = red_cell_half_thickness(8.0, position.x.hypot(position.y));
            // √(1 − (r/R)²) near the rim turns round-off of 1e-16 into 1e-8.
            assert!((position.z.abs() - half).abs() < 1e-6, "{position:?}");
        }
        assert_eq!(cell.positions[0], Vec3::new(0.0, 0.0, red_cell_half_thickness(8.0, 0.0)));
        let extents = principal_extents(&cell.positions);
        assert!((extents[0] - 8.0).abs() < 0.05 && (extents[2] / 8.0 - 0.329).abs() < 0.01, "{extents:?}");
    }
}
