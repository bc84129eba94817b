//! Light: how a seen facet, the floor, panes and the background become the colour of a pixel.

use nalgebra::Vector3;

use super::cut::Side;
use super::floor::Ground;
use super::geometry::{Geometry, Triangle};
use super::glass::Glass;
use super::outlines::Outlines;
use super::raster::Band;
use super::samples::{FLOOR, NOTHING, SAMPLES, SHEET};
use super::scene::{Background, Scene};
use super::sheet::Carpet;
use super::view::View;
use crate::Vec3;

/// Colour of the floor and of its grid, sRGB from 0 to 1.
const FLOOR_COLOUR: [f32; 3] = [0.930, 0.940, 0.952];
const GRID_COLOUR: [f32; 3] = [0.795, 0.82, 0.85];
/// How much white there is in the colour of a cut face, as an amount of light.
const PALE: f32 = 0.35;
/// The least cosine between a normal that is lit and the line of sight.
const GRAZING: f32 = 0.06;
/// Entries of the table from linear light to sRGB: steps below a third of a grey level at the dark end.
const GAMMA_STEPS: usize = 8192;

/// A scene's lights and planes made ready for shading.
pub(super) struct Shader<'a> {
    view: &'a View,
    ground: Option<Ground>,
    carpet: Option<Carpet<'a>>,
    panes: Vec<Glass>,
    background: Background,
    /// Unit vector towards the main light.
    light: Vector3<f32>,
    /// Unit vector towards the sky.
    sky: Vector3<f32>,
    gamma: Vec<f32>,
}

impl<'a> Shader<'a> {
    pub fn new(scene: &'a Scene, view: &'a View, geometry: &Geometry) -> Self {
        let sky = scene.floor.and_then(|f| Vec3::from(f.normal).try_normalize(1e-300)).unwrap_or(Vec3::z());
        // Over the viewer's left shoulder, and always well above the floor.
        let light = (-view.forward * 0.75 - view.right * 0.62 + view.up * 0.5 + sky * 0.75).normalize();
        let ground = scene.floor.and_then(|floor| Ground::new(&floor, view, geometry, &light));
        let gamma = (0..=GAMMA_STEPS).map(|k| to_srgb(k as f32 / GAMMA_STEPS as f32)).collect();
        let panes = scene.panes.iter().filter_map(|pane| Glass::new(pane, view)).collect();
        let (light, sky) = (light.cast(), sky.cast());
        let floor = scene.floor.and_then(|f| Some((Vec3::from(f.point), Vec3::from(f.normal).try_normalize(1e-300)?)));
        let carpet = scene.sheet.as_ref().and_then(|sheet| Carpet::new(sheet, view, floor));
        Self { view, ground, carpet, panes, background: scene.background, light, sky, gamma }
    }

    /// Puts the floor into the samples of a band that show it.
    pub fn lay_floor(&self, band: &mut Band) {
        let Some(ground) = &self.ground else { return };
        let per_sample = 1.0 / SAMPLES as f64;
        for y in 0..band.height {
            let [grow, start] = ground.screen.nearness_along_row(((band.first + y) as f64 + 0.5) * per_sample);
            for x in 0..band.width {
                let near = grow * (x as f64 + 0.5) * per_sample + start;
                if near > 0.0 || !self.view.is_perspective {
                    band.nearness[y * band.width + x] = near as f32;
                    band.seen[y * band.width + x] = FLOOR;
                }
            }
        }
    }

    /// Puts the sheet into the samples of a band where it is not below the floor.
    pub fn lay_sheet(&self, band: &mut Band) {
        let Some(carpet) = &self.carpet else { return };
        let per_sample = 1.0 / SAMPLES as f64;
        for y in 0..band.height {
            let py = ((band.first + y) as f64 + 0.5) * per_sample;
            let row = carpet.nearness_along_row(py);
            for x in 0..band.width {
                let sample = y * band.width + x;
                let Some(near) = carpet.nearness(self.view, (x as f64 + 0.5) * per_sample, row, py) else { continue };
                // A sheet on the floor hides it, whatever the last digits say.
                let (below, hides) = (band.nearness[sample], carpet.lies_on_floor() && band.seen[sample] == FLOOR);
                if hides || near >= below {
                    band.nearness[sample] = near;
                    band.seen[sample] = SHEET;
                }
            }
        }
    }

    /// Turns a band into pixels: everything that a pixel's samples show is shaded once and weighted by its samples.
    pub fn resolve(&self, band: &Band, geometry: &Geometry, rows: &mut [u8]) {
        const ALL: u32 = (1 << (SAMPLES * SAMPLES)) - 1;
        let width = band.width / SAMPLES;
        let outlines = Outlines::of(band, geometry);
        for (py, row) in rows.chunks_exact_mut(3 * width).enumerate() {
            for (px, pixel) in row.chunks_exact_mut(3).enumerate() {
                let corner = (band.above + py * SAMPLES) * band.width + px * SAMPLES;
                let sample = |k: usize| corner + k / SAMPLES * band.width + k % SAMPLES;
                let mut waiting = ALL;
                let mut sum = [0.0f32; 3];
                while waiting != 0 {
                    let lead = sample(waiting.trailing_zeros() as usize);
                    let shown = [band.seen[lead], band.veil[lead]];
                    let (mut count, mut x, mut y, mut near) = (0.0f32, 0.0f32, 0.0f32, 0.0f32);
                    for k in 0..SAMPLES * SAMPLES {
                        if waiting >> k & 1 == 1 && [band.seen[sample(k)], band.veil[sample(k)]] == shown {
                            count += 1.0;
                            x += (k % SAMPLES) as f32;
                            y += (k / SAMPLES) as f32;
                            near += band.nearness[sample(k)];
                            waiting &= !(1 << k);
                        }
                    }
                    let (x, y) = (x / count + 0.5, y / count + 0.5);
                    let (x, y) = ((px * SAMPLES) as f32 + x, (band.first + band.above + py * SAMPLES) as f32 + y);
                    let colour = self.colour(geometry, shown, x, y, near / count);
                    for k in 0..3 {
                        sum[k] += count * colour[k];
                    }
                }
                let light = outlines.light(corner);
                for k in 0..3 {
                    pixel[k] = (light * sum[k] * (255.0 / (SAMPLES * SAMPLES) as f32) + 0.5).clamp(0.0, 255.0) as u8;
                }
            }
        }
    }

    /// sRGB colour, 0 to 1, seen at a point given in samples.
    fn colour(&self, geometry: &Geometry, [seen, veil]: [u32; 2], x: f32, y: f32, near: f32) -> [f32; 3] {
        let (px, py) = (f64::from(x) / SAMPLES as f64, f64::from(y) / SAMPLES as f64);
        let behind = || {
            let share = (py / self.view.height as f64).clamp(0.0, 1.0) as f32;
            let (top, bottom) = (self.background.top.0, self.background.bottom.0);
            std::array::from_fn(|k| (f32::from(top[k]) * (1.0 - share) + f32::from(bottom[k]) * share) / 255.0)
        };
        let mut colour = match (seen, &self.ground) {
            (NOTHING, _) | (FLOOR, None) => behind(),
            (SHEET, ground) => self.carpet.as_ref().map_or_else(behind, |c| c.colour(ground.as_ref(), px, py)),
            (FLOOR, Some(ground)) => self.floor_colour(ground, behind(), px, py),
            (facet, _) => self.facet_colour(geometry, &geometry.triangles[facet as usize], x, y).0,
        };
        if veil != NOTHING {
            let (skin, share) = self.facet_colour(geometry, &geometry.triangles[veil as usize], x, y);
            for k in 0..3 {
                colour[k] += share * (skin[k] - colour[k]);
            }
        }
        for glass in &self.panes {
            if let Some(strength) = glass.strength(self.view, px, py, near) {
                for k in 0..3 {
                    colour[k] += strength * (glass.colour[k] - colour[k]);
                }
            }
        }
        colour
    }

    fn floor_colour(&self, ground: &Ground, behind: [f32; 3], px: f64, py: f64) -> [f32; 3] {
        let (at, pixel) = ground.screen.meet(px, py);
        let presence = ground.presence(at);
        if presence <= 0.0 {
            return behind;
        }
        let line = ground.grid_strength(at, pixel);
        let light = ground.light(at);
        std::array::from_fn(|k| {
            let plain = FLOOR_COLOUR[k] + line * (GRID_COLOUR[k] - FLOOR_COLOUR[k]);
            // Shadows keep a little blue, as under an open sky.
            let lit = plain * (light + (1.0 - light) * [0.0, 0.03, 0.08][k]);
            behind[k] + presence * (lit - behind[k])
        })
    }

    /// Colour of a facet at a point and how much of what lies behind it hides.
    fn facet_colour(&self, geometry: &Geometry, triangle: &Triangle, x: f32, y: f32) -> ([f32; 3], f32) {
        let (area, flat) = geometry.barycentric(triangle, x, y);
        // The mean position of some samples may lie a little outside the facet.
        let flat = flat.map(|w| w.clamp(0.0, 1.0));
        let true_weights: [f32; 3] =
            std::array::from_fn(|k| flat[k] * geometry.weights[triangle.corners[k] as usize].max(1e-9));
        let total: f32 = true_weights.iter().sum();
        let weights = true_weights.map(|w| w / total);
        let mix = |values: &[Vector3<f32>]| -> Vector3<f32> {
            (0..3).map(|k| values[triangle.corners[k] as usize] * weights[k]).sum()
        };
        let paint: [f32; 3] = std::array::from_fn(|channel| {
            (0..3).map(|k| geometry.colours[triangle.colour[k] as usize][channel] * weights[k]).sum()
        });
        let point = mix(&geometry.points);
        let paint = match triangle.is_marked {
            true => two_tone(paint, &mix(&geometry.marks), self.view.pixels_per_micron(&point.cast())),
            false => paint,
        };
        let viewer = self.view.towards_viewer(&point);
        if geometry.cut.is_some() && triangle.side == Some(Side::Out) {
            // The flat face where a body is cut.
            return (self.cut_face(paint), 1.0);
        }
        let normal = mix(&geometry.normals) * if triangle.is_turned { -1.0 } else { 1.0 };
        let normal = towards(normal.try_normalize(1e-12).unwrap_or(viewer), &viewer);
        let mut colour = self.lit(paint, &normal, &viewer);
        // A thin skin seen edge on is looked through at a slant and hides more.
        let slant = 1.0 - normal.dot(&viewer).clamp(0.0, 1.0);
        let mut share = triangle.opacity + (1.0 - triangle.opacity) * slant * slant;
        if triangle.lines != 0 {
            let line = edge_strength(geometry, triangle, area, flat, SAMPLES as f32);
            colour = colour.map(|c| c * (1.0 - 0.5 * line));
            share = share.max(0.6 * line);
        }
        (colour, share)
    }

    /// What is seen of a body where it is cut: its colour, paler and without light or shade.
    fn cut_face(&self, paint: [f32; 3]) -> [f32; 3] {
        paint.map(|light| self.gamma[((PALE + (1.0 - PALE) * light).clamp(0.0, 1.0) * GAMMA_STEPS as f32) as usize])
    }

    /// A painted skin under a bright sky, a main light and a weak lamp at the camera: sRGB from 0 to 1.
    fn lit(&self, paint: [f32; 3], normal: &Vector3<f32>, viewer: &Vector3<f32>) -> [f32; 3] {
        let facing = normal.dot(viewer).clamp(0.0, 1.0);
        let sky = 0.5 + 0.5 * normal.dot(&self.sky);
        // Light wraps around soft bodies a little.
        let main = ((normal.dot(&self.light) + 0.25) / 1.25).max(0.0);
        let amount = 0.20 + 0.30 * sky + 0.62 * main + 0.10 * facing;
        let half = (self.light + viewer).normalize();
        let gloss = 0.10 * normal.dot(&half).max(0.0).powi(42) + 0.035 * normal.dot(&half).max(0.0).powi(9);
        let rim = (1.0 - facing).powi(3);
        std::array::from_fn(|k| {
            // The skin seen edge on is darker, which draws the outline, with a breath of sky on it.
            let light = paint[k] * amount * (1.0 - 0.45 * rim) + gloss + 0.05 * rim * sky;
            self.gamma[(light.clamp(0.0, 1.0) * GAMMA_STEPS as f32) as usize]
        })
    }
}

/// The paint of a marked body where it lies so far from its middle at rest, µm: plain and another in turn, in eighths of space. The border
/// is as wide as a pixel.
fn two_tone(paint: [f32; 3], mark: &Vector3<f32>, pixels_per_micron: f64) -> [f32; 3] {
    let side: f32 = mark.iter().map(|along| (along * pixels_per_micron as f32).clamp(-1.0, 1.0)).product();
    let light = 0.2126 * paint[0] + 0.7152 * paint[1] + 0.0722 * paint[2];
    // Paler, and darker where paint is pale.
    let other = paint.map(|part| if light < 0.5 { part + 0.75 * (1.0 - part) } else { 0.3 * part });
    std::array::from_fn(|k| paint[k] + (0.5 - 0.5 * side) * (other[k] - paint[k]))
}

/// A normal of a skin whose facet is seen: one that points away from the viewer, as where few facets go round a bend, would be lit
/// as what is not seen and show as a black sliver. It is bent until it is at a right angle to the line of sight, and a little less.
fn towards(normal: Vector3<f32>, viewer: &Vector3<f32>) -> Vector3<f32> {
    let facing = normal.dot(viewer);
    if facing >= GRAZING { normal } else { (normal + (GRAZING - facing) * viewer).normalize() }
}

/// How strongly an edge of the facet's mesh shows at a point, 0 to 1.
fn edge_strength(geometry: &Geometry, triangle: &Triangle, area: f32, flat: [f32; 3], samples: f32) -> f32 {
    let corners = triangle.corners.map(|corner| geometry.screen[corner as usize]);
    let (mut nearest, mut smallest) = (f32::INFINITY, f32::INFINITY);
    for k in 0..3 {
        let (p, q) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        let height = area.abs() / (p[0] - q[0]).hypot(p[1] - q[1]).max(1e-9) / samples;
        if triangle.lines >> k & 1 == 1 {
            nearest = nearest.min(flat[k] * height);
        }
        smallest = smallest.min(height);
    }
    let visibility = ((smallest * f32::from(triangle.parts) - 2.0) / 6.0).clamp(0.0, 1.0);
    visibility * (1.0 - nearest).clamp(0.0, 1.0)
}

/// From an amount of light to the number that a screen turns into it.
fn to_srgb(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}
