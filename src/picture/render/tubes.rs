//! Lines and arrows as thin tubes, so that they have a size in µm and hide behind cells.

use super::scene::{Scene, Surface, SurfaceColour};
use crate::Vec3;
use crate::picture::colour::Colour;

/// Sides of a tube; six look round at the few pixels that a tube is wide.
const SIDES: u32 = 6;
/// Sides of the head of an arrow.
const HEAD_SIDES: u32 = 16;

impl Scene {
    /// Adds a straight line between two points (µm) that is twice `radius` thick: a link, a fibre, a bond.
    pub fn add_line(&mut self, from: [f64; 3], to: [f64; 3], radius: f64, colour: Colour) {
        add_cone(&mut self.strokes, from, to, [radius, radius], SIDES, colour);
    }

    /// Adds a path through points (µm).
    pub fn add_path(&mut self, points: &[[f64; 3]], radius: f64, colour: Colour) {
        for pair in points.windows(2) {
            self.add_line(pair[0], pair[1], radius, colour);
        }
    }

    /// Adds an arrow from its tail to its tip (µm): a load, a velocity.
    pub fn add_arrow(&mut self, tail: [f64; 3], tip: [f64; 3], radius: f64, colour: Colour) {
        let (a, b) = (Vec3::from(tail), Vec3::from(tip));
        let length = (b - a).norm();
        let head = (6.0 * radius).min(0.6 * length);
        if length.is_nan() || length <= 0.0 {
            return;
        }
        let neck = b - (b - a) * (head / length);
        let wide = (2.4 * radius).min(0.5 * head);
        add_cone(&mut self.strokes, tail, neck.into(), [radius, radius], HEAD_SIDES, colour);
        add_cone(&mut self.strokes, neck.into(), tip, [wide, 0.0], HEAD_SIDES, colour);
        // The base of the head, seen from behind.
        let back = neck - (b - a) * (1e-6 * head / length);
        add_cone(&mut self.strokes, back.into(), neck.into(), [0.0, wide], HEAD_SIDES, colour);
    }
}

/// Appends a frustum around the line between two points, with a radius at each.
fn add_cone(surface: &mut Surface, from: [f64; 3], to: [f64; 3], radii: [f64; 2], sides: u32, colour: Colour) {
    let (a, b) = (Vec3::from(from), Vec3::from(to));
    let Some(along) = (b - a).try_normalize(1e-300).filter(|v| v.iter().all(|x| x.is_finite())) else { return };
    let helper = if along.z.abs() < 0.9 { Vec3::z() } else { Vec3::x() };
    let u = along.cross(&helper).normalize();
    let v = along.cross(&u);
    // The flank of a cone leans towards its tip.
    let lean = (radii[0] - radii[1]) / (b - a).norm();
    let first = surface.positions.len() as u32;
    if !matches!(surface.colour, SurfaceColour::PerAtom(_)) {
        surface.colour = SurfaceColour::PerAtom(vec![colour; surface.positions.len()]);
    }
    for side in 0..sides {
        let angle = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
        let out = u * angle.cos() + v * angle.sin();
        for (end, radius) in [(a, radii[0]), (b, radii[1])] {
            surface.positions.push((end + out * radius).into());
            surface.normals.push((out + along * lean).into());
            if let SurfaceColour::PerAtom(colours) = &mut surface.colour {
                colours.push(colour);
            }
        }
        let (p, q) = (first + 2 * side, first + 2 * ((side + 1) % sides));
        surface.facets.push([p, q, p + 1]);
        surface.facets.push([q, q + 1, p + 1]);
    }
}
