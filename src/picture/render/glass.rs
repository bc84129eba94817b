//! Panes in front of and behind what is drawn.

use super::scene::Pane;
use super::view::{PlaneOnScreen, View};
use crate::Vec3;

/// A pane with what its drawing needs.
pub(super) struct Glass {
    screen: PlaneOnScreen,
    half: [f64; 2],
    /// Its colour, sRGB from 0 to 1.
    pub colour: [f32; 3],
}

impl Glass {
    /// Prepares a pane; `None` when it has no area or is seen exactly edge on.
    pub fn new(pane: &Pane, view: &View) -> Option<Self> {
        let (half_u, half_v) = (Vec3::from(pane.half_u), Vec3::from(pane.half_v));
        let (u, v) = (half_u.try_normalize(1e-300)?, half_v.try_normalize(1e-300)?);
        let normal = u.cross(&v).try_normalize(1e-9)?;
        let centre = Vec3::from(pane.centre) - view.target;
        if !view.is_above(&centre, &normal) && !view.is_above(&centre, &-normal) {
            return None;
        }
        Some(Self {
            screen: PlaneOnScreen::new(view, &centre, &u, &v),
            half: [half_u.norm(), half_v.norm()],
            colour: pane.colour.0.map(|byte| f32::from(byte) / 255.0),
        })
    }

    /// How much of the pane's colour covers what lies at nearness `near`; `None` where it does not.
    pub fn strength(&self, view: &View, px: f64, py: f64, near: f32) -> Option<f32> {
        let [grow, start] = self.screen.nearness_along_row(py);
        let own = grow * px + start;
        // Beyond the horizon of a perspective plane its nearness is negative.
        if (own as f32) < near || (view.is_perspective && own <= 0.0) {
            return None;
        }
        let (at, pixel) = self.screen.meet(px, py);
        let away = |k: usize| (self.half[k] - at[k].abs()) / pixel[k].max(1e-12);
        let inside = away(0).min(away(1)) + 0.5;
        let rim = (1.9 - inside).clamp(0.0, 1.0) as f32;
        (inside > 0.0).then(|| inside.min(1.0) as f32 * (0.13 + 0.52 * rim))
    }
}
