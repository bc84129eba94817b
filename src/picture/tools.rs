//! Tools in pictures: how far they have gone, and their profiles, turned about their axes, as of glass.

use std::f64::consts::PI;

use super::Colour;
use super::render::{Scene, Surface, SurfaceColour};
use crate::Vec3;
use crate::error::Result;
use crate::output::{Obstacle, ResultFile};

/// Parts that a tool is divided into around its axis.
const AROUND: usize = 96;

/// Where a profile turns by more than this, rad, an edge is seen.
const SHARP: f64 = PI / 6.0;

const GLASS: Colour = Colour([0x8f, 0xa9, 0xbd]);

/// How much of what is behind it a tool hides.
const OPACITY: f32 = 0.3;

/// Adds a tool that has gone so far, µm.
pub fn add_tool(scene: &mut Scene, tool: &Obstacle, gone: Vec3) {
    let Some(axis) = Vec3::from(tool.normal).try_normalize(1e-300) else { return };
    let across = axis.cross(&if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() }).normalize();
    let other = axis.cross(&across);
    let origin = Vec3::from(tool.point) + gone;
    let sides = sides(&tool.profile);
    let normals = normals_of(&sides);
    let mut surface = Surface { colour: SurfaceColour::Uniform(GLASS), opacity: OPACITY, ..Surface::default() };
    for (side, normals) in sides.iter().zip(&normals) {
        let first = surface.positions.len() as u32;
        for part in 0..AROUND {
            let (sin, cos) = (2.0 * PI * part as f64 / AROUND as f64).sin_cos();
            let out = cos * across + sin * other;
            for ([radius, height], [outwards, along]) in side.iter().zip(normals) {
                surface.positions.push((origin + *radius * out + *height * axis).into());
                surface.normals.push((*outwards * out + *along * axis).into());
            }
        }
        for part in 0..AROUND as u32 {
            let [a, b] = [first + 2 * part, first + 2 * ((part + 1) % AROUND as u32)];
            surface.facets.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    scene.surfaces.push(surface);
}

/// How far an obstacle has gone in each frame, µm; nothing of what stands.
///
/// # Errors
/// A damaged file.
pub fn gone(result: &ResultFile, obstacle: &Obstacle) -> Result<Vec<Vec3>> {
    let direction = Vec3::from(obstacle.direction);
    if direction == Vec3::zeros() {
        return Ok(Vec::new());
    }
    let displacement = result.scene_series(&format!("tool_displacement.{}", obstacle.name))?;
    Ok(displacement.iter().map(|by| *by * direction).collect())
}

/// The sides of a profile from point to point; one more where neither end is on the axis.
fn sides(profile: &[[f64; 2]]) -> Vec<[[f64; 2]; 2]> {
    let mut sides: Vec<[[f64; 2]; 2]> = profile.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    if let ([first, ..], [.., last]) = (profile, profile)
        && (first[0] > 0.0 || last[0] > 0.0)
    {
        sides.push([*last, *first]);
    }
    sides.retain(|[from, to]| from != to);
    sides
}

/// Normals at both ends of each side, of which those of sides that meet without an edge are the same.
fn normals_of(sides: &[[[f64; 2]; 2]]) -> Vec<[[f64; 2]; 2]> {
    let area: f64 = sides.iter().map(|[a, b]| a[0] * b[1] - b[0] * a[1]).sum();
    let normal = |[a, b]: [[f64; 2]; 2]| {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]) * area.signum();
        [(b[1] - a[1]) / length, (a[0] - b[0]) / length]
    };
    let own: Vec<[f64; 2]> = sides.iter().map(|side| normal(*side)).collect();
    let meeting = |number: usize, other: usize| {
        let ([r, z], [s, w]) = (own[number], own[other]);
        let cosine = r * s + z * w;
        if cosine < SHARP.cos() { own[number] } else { [r + s, z + w].map(|part| part / (2.0 + 2.0 * cosine).sqrt()) }
    };
    let count = sides.len();
    (0..count)
        .map(|number| [meeting(number, (number + count - 1) % count), meeting(number, (number + 1) % count)])
        .collect()
}
