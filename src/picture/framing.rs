//! What must not jump from one picture of a run to the next: camera, floor, and the ends of scales.

use super::colour::{decades_of, scale_of};
use super::look::Look;
use super::planes::{add_planes, corners};
use super::render::{Bounds, Camera, Insets, Scene, Sheet, basis};
use super::snapshot::{Snapshot, Values};
use super::ticks::Scale;
use crate::Vec3;

/// What stays the same in all pictures of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Framing {
    /// Right, up and towards the viewer.
    pub(super) axes: [Vec3; 3],
    /// For each of a set of directions seen by the camera the outermost point so far.
    outermost: Vec<(Vec3, f64, [f64; 3])>,
    /// The box around the cells in all frames.
    pub(super) bounds: Option<Bounds>,
    /// Corners of the panes, which are to be seen whole.
    pane_corners: Vec<[f64; 3]>,
    /// Corners of the part of the field around the cells, which is to be seen whole.
    field_corners: Vec<[f64; 3]>,
    range: [f64; 2],
    field_range: [f64; 2],
    /// The smallest value of the field above 0.
    field_least: f64,
    /// What the strongest fibre pulls with, pN.
    pub(super) strongest: f64,
    /// The most links between two cells.
    pub(super) most_links: f64,
    /// The latest time, s.
    pub(super) longest: f64,
}

impl Framing {
    /// Nothing seen yet, for pictures with this look.
    pub fn new(look: &Look) -> Self {
        let back = Vec3::from(look.direction).try_normalize(1e-300).unwrap_or(Vec3::z());
        let [right, up, forward] = basis(-back, Vec3::from(look.up));
        let axes = [right, up, -forward];
        let mut outermost = Vec::new();
        for n in 0..27 {
            let signs = [n % 3, n / 3 % 3, n / 9].map(|k| f64::from(k) - 1.0);
            let direction = axes[0] * signs[0] + axes[1] * signs[1] + axes[2] * signs[2];
            if n != 13 {
                outermost.push((direction, f64::NEG_INFINITY, [0.0; 3]));
            }
        }
        Self {
            axes,
            outermost,
            bounds: None,
            pane_corners: Vec::new(),
            field_corners: Vec::new(),
            range: [f64::INFINITY, f64::NEG_INFINITY],
            field_range: [f64::INFINITY, f64::NEG_INFINITY],
            field_least: f64::INFINITY,
            strongest: 0.0,
            most_links: 0.0,
            longest: 0.0,
        }
    }

    /// For pictures of a run that lasts at least so long, s: all their times have the unit that suits this one.
    pub fn lasting(mut self, time: f64) -> Self {
        self.longest = self.longest.max(time);
        self
    }

    /// Fits the view to a frame that will be drawn.
    pub fn include(&mut self, snapshot: &Snapshot) {
        let points = || snapshot.positions.iter().chain(snapshot.arrows.iter().flatten());
        for point in points().filter(|point| point.iter().all(|v| v.is_finite())) {
            let at = Vec3::from(*point);
            for (direction, far, outermost) in &mut self.outermost {
                let along = direction.dot(&at);
                if along > *far {
                    (*far, *outermost) = (along, *point);
                }
            }
        }
        if let Some(bounds) = Bounds::around(points()) {
            let bounds = self.bounds.map_or(bounds, |before| before.joined(bounds));
            self.bounds = Some(bounds);
            let mut planes = Scene::default();
            add_planes(&mut planes, snapshot.layout, &bounds, 1.0);
            self.pane_corners = planes.panes.iter().flat_map(corners).collect();
        }
        if let Values::Atoms(values) | Values::Cells(values) = snapshot.values {
            for value in values.iter().filter(|value| value.is_finite()) {
                self.range = [self.range[0].min(*value), self.range[1].max(*value)];
            }
        }
        if let Some(sheet) = snapshot.field {
            for value in sheet.values.iter().filter(|value| value.is_finite()) {
                self.field_range = [self.field_range[0].min(*value), self.field_range[1].max(*value)];
                if *value > 0.0 {
                    self.field_least = self.field_least.min(*value);
                }
            }
            self.field_corners = corners_near(sheet, self.bounds.as_ref());
        }
        let pulls = snapshot.fibres.into_iter().flatten().map(|(_, tension)| *tension);
        self.strongest = pulls.fold(self.strongest, f64::max);
        let links = snapshot.links.into_iter().flatten().map(|(_, number)| *number);
        self.most_links = links.fold(self.most_links, f64::max);
        self.longest = self.longest.max(snapshot.time);
    }

    /// The camera that shows everything included.
    pub fn camera(&self, look: &Look, aspect: f64, insets: Insets) -> Camera {
        let mut points: Vec<[f64; 3]> = self.outermost.iter().filter(|o| o.1.is_finite()).map(|o| o.2).collect();
        points.extend(&self.pane_corners);
        points.extend(&self.field_corners);
        let fitted = Camera::fit(&points, self.axes[2].into(), self.axes[1].into(), look.projection, aspect, insets);
        fitted.zoomed(look.zoom)
    }

    /// The numbers at the ends of the colour bar.
    pub(super) fn ends(&self, look: &Look) -> [f64; 2] {
        look.range.unwrap_or_else(|| scale_of(self.range, look.least))
    }

    /// The numbers at the ends of the field's colour bar.
    pub(super) fn field_ends(&self, look: &Look) -> [f64; 2] {
        if look.field_scale == Scale::Log {
            return look.field_range.unwrap_or_else(|| decades_of([self.field_least, self.field_range[1]]));
        }
        // A field that comes close to nothing is shown from nothing on.
        let [low, high] = self.field_range;
        let from_zero = if (0.0..0.25 * high).contains(&low) { 0.0 } else { low };
        look.field_range.unwrap_or_else(|| scale_of([from_zero, high], 0.0))
    }
}

/// The corners of what a picture should show of a sheet: no more than a wide margin around the cells, so that a few
/// cells in a wide field do not become specks. Without cells it is the whole sheet.
fn corners_near(sheet: &Sheet, bounds: Option<&Bounds>) -> Vec<[f64; 3]> {
    let reach = |axis: usize| {
        let (start, end) = (sheet.corner[axis], sheet.corner[axis] + sheet.side_u[axis] + sheet.side_v[axis]);
        let Some(bounds) = bounds else { return (start, end) };
        let margin = 1.5 * bounds.diagonal();
        (start.max(bounds.low[axis] - margin), end.min(bounds.high[axis] + margin))
    };
    let (x, y) = (reach(0), reach(1));
    if x.0 > x.1 || y.0 > y.1 {
        return Vec::new();
    }
    let z = sheet.corner[2];
    vec![[x.0, y.0, z], [x.1, y.0, z], [x.0, y.1, z], [x.1, y.1, z]]
}
