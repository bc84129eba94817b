//! A flat image in the scene: the values of a field on the substrate or on a slice, as colours.

use super::floor::Ground;
use super::scene::Sheet;
use super::view::{PlaneOnScreen, View};
use crate::Vec3;

/// How much of the floor's shadows falls on a sheet: enough to seat the cells, not enough to falsify the colours.
const SHADOW_SHARE: f32 = 0.55;

/// A sheet made ready for drawing.
pub(super) struct Carpet<'a> {
    sheet: &'a Sheet,
    screen: PlaneOnScreen,
    /// Lengths of its sides, µm.
    sides: [f64; 2],
    /// Whether it lies where the floor is, and so is shaded by what stands on the floor.
    on_floor: bool,
    /// Colours of equally spaced values, sRGB from 0 to 1.
    colours: Vec<[f32; 3]>,
}

/// Colours that values are rounded to; the eye tells apart some 200 along a map.
const COLOURS: usize = 1024;

impl<'a> Carpet<'a> {
    /// Prepares a sheet; `None` when it has no area, no values, or is seen exactly edge on.
    pub fn new(sheet: &'a Sheet, view: &View, floor: Option<(Vec3, Vec3)>) -> Option<Self> {
        let (side_u, side_v) = (Vec3::from(sheet.side_u), Vec3::from(sheet.side_v));
        let (u, v) = (side_u.try_normalize(1e-300)?, side_v.try_normalize(1e-300)?);
        let normal = u.cross(&v).try_normalize(1e-9)?;
        let corner = Vec3::from(sheet.corner) - view.target;
        let [nu, nv] = sheet.size;
        if nu == 0 || nv == 0 || sheet.values.len() != nu * nv {
            return None;
        }
        if !view.is_above(&corner, &normal) && !view.is_above(&corner, &-normal) {
            return None;
        }
        // A sheet within a percent of its own size of the floor counts as lying on it.
        let near = 0.01 * (side_u.norm() + side_v.norm());
        let on_floor = floor.is_some_and(|(point, up)| {
            up.dot(&normal).abs() > 0.999 && (Vec3::from(sheet.corner) - point).dot(&up).abs() < near
        });
        let colour = |k: usize| sheet.map.at(k as f64 / (COLOURS - 1) as f64).0.map(|byte| f32::from(byte) / 255.0);
        Some(Self {
            sheet,
            screen: PlaneOnScreen::new(view, &corner, &u, &v),
            sides: [side_u.norm(), side_v.norm()],
            on_floor,
            colours: (0..COLOURS).map(colour).collect(),
        })
    }

    /// How near the sheet is at a pixel; `None` where it is not.
    pub fn nearness(&self, view: &View, x: f64, row: [f64; 2], y: f64) -> Option<f32> {
        let [grow, start] = row;
        let near = grow * x + start;
        if view.is_perspective && near <= 0.0 {
            return None;
        }
        let (at, _) = self.screen.meet(x, y);
        let inside = (0..2).all(|k| at[k] >= 0.0 && at[k] <= self.sides[k]);
        inside.then_some(near as f32)
    }

    /// Whether it lies on the floor.
    pub fn lies_on_floor(&self) -> bool {
        self.on_floor
    }

    /// See [`PlaneOnScreen::nearness_along_row`].
    pub fn nearness_along_row(&self, y: f64) -> [f64; 2] {
        self.screen.nearness_along_row(y)
    }

    /// Its colour at a pixel, sRGB from 0 to 1.
    pub fn colour(&self, ground: Option<&Ground>, px: f64, py: f64) -> [f32; 3] {
        let (at, _) = self.screen.meet(px, py);
        let value = self.value([at[0] / self.sides[0], at[1] / self.sides[1]]);
        let share = self.sheet.scale.share(value, self.sheet.range);
        let paint = if share.is_nan() {
            self.sheet.map.at(f64::NAN).0.map(|byte| f32::from(byte) / 255.0)
        } else {
            self.colours[(share.clamp(0.0, 1.0) * (COLOURS - 1) as f64 + 0.5) as usize]
        };
        let Some(ground) = ground.filter(|_| self.on_floor) else { return paint };
        let light = ground.light_at(px, py);
        paint.map(|channel| channel * (1.0 - SHADOW_SHARE * (1.0 - light)))
    }

    /// The value at a point given as shares of the sides: a smooth curve through the values of the boxes' centres,
    /// which never leaves the values around.
    fn value(&self, share: [f64; 2]) -> f64 {
        let [nu, nv] = self.sheet.size;
        let along = |k: usize, n: usize| {
            let node = (share[k] * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
            let below = (node.floor() as usize).min(n.saturating_sub(2));
            (below, node - below as f64)
        };
        let ((i, s), (j, t)) = (along(0, nu), along(1, nv));
        let (mut sum, mut least, mut most) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        let (weights_u, weights_v) = (catmull_rom(s), catmull_rom(t));
        for (b, weight_v) in weights_v.into_iter().enumerate() {
            let row = (j + b).saturating_sub(1).min(nv - 1) * nu;
            for (a, weight_u) in weights_u.into_iter().enumerate() {
                let value = self.sheet.values[row + (i + a).saturating_sub(1).min(nu - 1)];
                sum += weight_u * weight_v * value;
                if (1..3).contains(&a) && (1..3).contains(&b) {
                    (least, most) = (least.min(value), most.max(value));
                }
            }
        }
        if least <= most { sum.clamp(least, most) } else { sum }
    }
}

/// Weights of four neighbours for a point between the second and the third (Catmull and Rom 1974).
fn catmull_rom(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [0.5 * (-t3 + 2.0 * t2 - t), 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0), 0.5 * (-3.0 * t3 + 4.0 * t2 + t), 0.5 * (t3 - t2)]
}

#[cfg(test)]
mod tests {
    use super::catmull_rom;

    #[test]
    fn smooth_weights_keep_straight_lines() {
        for t in [0.0, 0.3, 1.0] {
            let weights = catmull_rom(t);
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            let line: f64 = weights.iter().zip([-1.0, 0.0, 1.0, 2.0]).map(|(w, x)| w * x).sum();
            assert!((line - t).abs() < 1e-15, "{line} at {t}");
        }
    }
}
