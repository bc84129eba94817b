//! The substrate in a picture: its grid and the soft shadows that make cells sit on it.

use nalgebra::Vector3;

use super::geometry::Geometry;
use super::scene::Floor;
use super::spans::{SLACK, row_span};
use super::view::{PlaneOnScreen, View};
use crate::Vec3;

/// Texels along the longer side of the shadow maps.
const TEXELS: usize = 512;
/// Shares of light that the two kinds of shadow on the floor take away where they are full.
const SHADOW_DEPTH: f32 = 0.20;
const CONTACT_DEPTH: f32 = 0.42;

/// The floor made ready for drawing.
pub(super) struct Ground {
    pub screen: PlaneOnScreen,
    /// A point of it relative to the camera's target, and its unit normal.
    point: Vec3,
    normal: Vec3,
    u: Vec3,
    v: Vec3,
    grid: f64,
    radius: f64,
    /// Low corner of the maps in the floor's own coordinates, size of a texel (µm), texels along u and v.
    corner: [f32; 2],
    texel: f32,
    size: [usize; 2],
    /// How much of the main light is kept away, 0 to 1.
    shadow: Vec<f32>,
    /// How much of the light from all around is kept away, 0 to 1.
    contact: Vec<f32>,
}

impl Ground {
    /// Prepares the floor and the shadows that the scene throws on it for light that comes from `light`; `None` when
    /// it is seen from below.
    pub fn new(floor: &Floor, view: &View, geometry: &Geometry, light: &Vec3) -> Option<Self> {
        let normal = Vec3::from(floor.normal).try_normalize(1e-300)?;
        let point = Vec3::from(floor.point) - view.target;
        if !view.is_above(&point, &normal) {
            return None;
        }
        let u = normal.cross(&if normal.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() }).normalize().cross(&normal);
        let v = normal.cross(&u);
        let mut ground = Self {
            screen: PlaneOnScreen::new(view, &point, &u, &v),
            point,
            normal,
            u,
            v,
            grid: floor.grid,
            radius: floor.radius.max(1e-6),
            corner: [0.0; 2],
            texel: 1.0,
            size: [0; 2],
            shadow: Vec::new(),
            contact: Vec::new(),
        };
        ground.throw_shadows(geometry, light);
        Some(ground)
    }

    /// How strongly the floor shows at a point: 1 in the middle, 0 at its radius.
    pub fn presence(&self, at: [f64; 2]) -> f32 {
        let share = ((at[0] * at[0] + at[1] * at[1]).sqrt() / self.radius).min(1.0) as f32;
        let t = ((1.0 - share) / 0.75).min(1.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// Strength of the grid's lines at a point, 0 to 1; `pixel` is the size of a pixel there, µm along u and v.
    pub fn grid_strength(&self, at: [f64; 2], pixel: [f64; 2]) -> f32 {
        if self.grid.is_nan() || self.grid <= 0.0 {
            return 0.0;
        }
        let line = |spacing: f64| -> f32 {
            let mut strength = 0.0f64;
            for k in 0..2 {
                let width = pixel[k].max(1e-9);
                // The distance to the nearest whole number; a cast is quicker than `round` on plain processors.
                let share = at[k] / spacing;
                let away = (share - (share + 0.5f64.copysign(share)) as i64 as f64).abs() * spacing;
                // Lines nearer than a few pixels would turn into a pattern; they fade out before.
                let visibility = (spacing / width / 6.0 - 1.0).clamp(0.0, 1.0);
                strength = strength.max(visibility * (1.2 - away / width).clamp(0.0, 1.0));
            }
            strength as f32
        };
        (0.5 * line(self.grid)).max(line(5.0 * self.grid))
    }

    /// How much light reaches the floor at one of its points, 0 to 1.
    pub fn light(&self, at: [f64; 2]) -> f32 {
        let [shadow, contact] = self.shade(at);
        (1.0 - SHADOW_DEPTH * shadow) * (1.0 - CONTACT_DEPTH * contact)
    }

    /// The same where the floor is seen at a pixel.
    pub fn light_at(&self, px: f64, py: f64) -> f32 {
        self.light(self.screen.meet(px, py).0)
    }

    /// Shares of main light and of light from all around that are kept away at a point.
    fn shade(&self, at: [f64; 2]) -> [f32; 2] {
        let point = [0, 1].map(|k| (at[k] as f32 - self.corner[k]) / self.texel - 0.5);
        let inside = |k: usize| point[k] >= 0.0 && point[k] < self.size[k] as f32 - 1.001;
        if self.size[0] == 0 || !inside(0) || !inside(1) {
            return [0.0; 2];
        }
        let (i, j) = (point[0] as usize, point[1] as usize);
        let (s, t) = (point[0] - i as f32, point[1] - j as f32);
        [&self.shadow, &self.contact].map(|map| {
            let row = |j: usize| {
                let start = j * self.size[0] + i;
                map[start] + s * (map[start + 1] - map[start])
            };
            row(j) + t * (row(j + 1) - row(j))
        })
    }

    /// Fills the maps: the scene's outline along the light, and how close it comes straight above.
    fn throw_shadows(&mut self, geometry: &Geometry, light: &Vec3) {
        let (u, v, n) = (self.u.cast::<f32>(), self.v.cast::<f32>(), self.normal.cast::<f32>());
        let point = self.point.cast::<f32>();
        let slant = light.cast::<f32>() / light.dot(&self.normal).max(0.2) as f32;
        let lean = [slant.dot(&u), slant.dot(&v)];
        let local: Vec<[f32; 3]> = geometry
            .points
            .iter()
            .map(|p| p - point)
            .map(|d: Vector3<f32>| [d.dot(&u), d.dot(&v), d.dot(&n)])
            .collect();
        let cast = |p: &[f32; 3]| [p[0] - lean[0] * p[2].max(0.0), p[1] - lean[1] * p[2].max(0.0)];
        let used = || geometry.triangles.iter().flat_map(|t| t.corners).map(|corner| &local[corner as usize]);
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for point in used().flat_map(|p| [[p[0], p[1]], cast(p)]) {
            for k in 0..2 {
                low[k] = low[k].min(point[k]);
                high[k] = high[k].max(point[k]);
            }
        }
        if low[0] > high[0] {
            return;
        }
        let radius = geometry.typical_radius as f32;
        let margin = 0.8 * radius;
        let span = [0, 1].map(|k| high[k] - low[k] + 2.0 * margin);
        self.texel = span[0].max(span[1]) / TEXELS as f32;
        self.corner = low.map(|v| v - margin);
        self.size = span.map(|v| ((v / self.texel).ceil() as usize).clamp(2, TEXELS));
        let (mut shadow, mut contact) = (vec![0.0f32; self.size[0] * self.size[1]], Vec::new());
        contact.clone_from(&shadow);
        for triangle in &geometry.triangles {
            let corners = triangle.corners.map(|corner| local[corner as usize]);
            if corners.iter().any(|p| p[2] > -0.5 * radius) {
                self.stamp(&mut shadow, corners.map(|p| [cast(&p)[0], cast(&p)[1], 0.0]), |_| 1.0);
                self.stamp(&mut contact, corners, |height| (-height.max(0.0) / (0.45 * radius)).exp());
            }
        }
        // The main light is as large as a window and the sky larger still, so both shadows are soft.
        let soften = |map: Vec<f32>, width: f32| blurred(map, self.size, (width / self.texel).round() as usize);
        (self.shadow, self.contact) = rayon::join(|| soften(shadow, 0.10 * radius), || soften(contact, 0.13 * radius));
    }

    /// Raises a map to the value of a triangle wherever the triangle lies over it.
    fn stamp(&self, map: &mut [f32], corners: [[f32; 3]; 3], value: impl Fn(f32) -> f32) {
        let [a, b, c] =
            corners.map(|p| [(p[0] - self.corner[0]) / self.texel, (p[1] - self.corner[1]) / self.texel, p[2]]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area.is_nan() || area.abs() <= 1e-9 {
            return;
        }
        let range = |k: usize| {
            let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
            ((low - 0.5).ceil().max(0.0) as usize)..((high + 0.5).floor().max(0.0) as usize).min(self.size[k])
        };
        let (step_b, step_c) = ((c[1] - a[1]) / area, -(b[1] - a[1]) / area);
        let (columns, steps) = (range(0), [-step_b - step_c, step_b, step_c]);
        for j in range(1) {
            let (dx, dy) = (columns.start as f32 + 0.5 - a[0], j as f32 + 0.5 - a[1]);
            let start_b = (dx * (c[1] - a[1]) - (c[0] - a[0]) * dy) / area;
            let start_c = ((b[0] - a[0]) * dy - dx * (b[1] - a[1])) / area;
            for n in row_span([1.0 - start_b - start_c, start_b, start_c], steps, SLACK, columns.len()) {
                let i = columns.start + n;
                let (wb, wc) = (start_b + n as f32 * step_b, start_c + n as f32 * step_c);
                let wa = 1.0 - wb - wc;
                if wa >= SLACK && wb >= SLACK && wc >= SLACK {
                    let cell = &mut map[j * self.size[0] + i];
                    *cell = cell.max(value(wa * a[2] + wb * b[2] + wc * c[2]));
                }
            }
        }
    }
}

/// Three means over squares of side 2 `reach` + 1, which together are close to a Gaussian.
fn blurred(mut map: Vec<f32>, size: [usize; 2], reach: usize) -> Vec<f32> {
    let reach = reach.max(1);
    let mut scratch = vec![0.0f32; size[0].max(size[1])];
    for _ in 0..3 {
        for (lines, count, stride, step) in [(size[1], size[0], size[0], 1), (size[0], size[1], 1, size[0])] {
            for line in 0..lines {
                let at = |k: usize| line * stride + k * step;
                let mut sum: f32 = (0..reach.min(count)).map(|k| map[at(k)]).sum();
                for k in 0..count {
                    if k + reach < count {
                        sum += map[at(k + reach)];
                    }
                    if k > reach {
                        sum -= map[at(k - reach - 1)];
                    }
                    scratch[k] = sum / (2 * reach + 1) as f32;
                }
                for k in 0..count {
                    map[at(k)] = scratch[k].max(0.0);
                }
            }
        }
    }
    map
}
