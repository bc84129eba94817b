//! Cylinders that are filled.

use super::{Solid, SolidCell, SolidFault};
use crate::Vec3;
use std::f64::consts::TAU;

/// A filled cylinder about the z axis, centred on the origin, of these radii at its ends and halfway, between which its outline is the arc of a
/// circle, and of this length (µm): `rings` rings of wedges around the axis, 6, 18, 30 …
/// in a layer, and `layers` of them. Its cross section is the polygon of 6·`rings` corners on the circle.
///
/// # Errors
/// Flat tetrahedra, where layers are far thicker or thinner than rings are wide, or no rings or layers at all.
pub fn rod([radius, middle]: [f64; 2], length: f64, rings: u32, layers: u32) -> Result<Solid, Vec<SolidFault>> {
    let in_layer = 1 + 3 * rings * (rings + 1);
    // Corner `k` of ring `ring` of a layer.
    let number = |ring: u32, k: u32| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) + k % (6 * ring) };
    let mut flat = vec![[0.0; 2]];
    for ring in 1..=rings {
        let r = radius * f64::from(ring) / f64::from(rings);
        flat.extend((0..6 * ring).map(|k| {
            let (sine, cosine) = (TAU * f64::from(k) / f64::from(6 * ring)).sin_cos();
            [r * cosine, r * sine]
        }));
    }
    let mut triangles = Vec::new();
    for ring in 1..=rings {
        for sector in 0..6 {
            // Along a side of a sector `ring` edges outside meet `ring` − 1 inside.
            let (outer, inner) = (sector * ring, sector * (ring - 1));
            for k in 0..ring {
                triangles.push([number(ring, outer + k), number(ring, outer + k + 1), number(ring - 1, inner + k)]);
                if k + 1 < ring {
                    triangles.push([
                        number(ring, outer + k + 1),
                        number(ring - 1, inner + k + 1),
                        number(ring - 1, inner + k),
                    ]);
                }
            }
        }
    }
    let height = |layer: u32| length * (f64::from(layer) / f64::from(layers) - 0.5);
    let on_layer = |layer: u32| {
        let (z, wider) = (height(layer), outline([radius, middle], length, height(layer)) / radius);
        flat.iter().map(move |[x, y]| Vec3::new(x * wider, y * wider, z))
    };
    let positions: Vec<Vec3> = (0..=layers).flat_map(on_layer).collect();
    let cells: Vec<SolidCell> = (0..layers)
        .flat_map(|layer| {
            let first = layer * in_layer;
            triangles.iter().map(move |&[a, b, c]| {
                let [a, b, c] = [a + first, b + first, c + first];
                SolidCell::Wedge([a, b, c, a + in_layer, b + in_layer, c + in_layer])
            })
        })
        .collect();
    Solid::of_cells(&positions, &cells).map(|(solid, _)| solid)
}

/// The radius at a height above the middle.
fn outline([radius, middle]: [f64; 2], length: f64, height: f64) -> f64 {
    let rise = middle - radius;
    if rise == 0.0 {
        return radius;
    }
    // The radius of the arc, negative where there is a waist.
    let arc = (0.25 * length * length + rise * rise) / (2.0 * rise);
    middle - arc + arc.signum() * (arc * arc - height * height).max(0.0).sqrt()
}
