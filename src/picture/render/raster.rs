//! Which facet is seen through which sample of the picture.

use super::cut::Face;
use super::geometry::Geometry;
use super::samples::{BESIDE, NOTHING, SAMPLES};
use super::spans::{SLACK, row_span, samples_between};

/// What is seen through the samples of some rows.
pub(super) struct Band {
    /// Samples across.
    pub width: usize,
    /// Samples down.
    pub height: usize,
    /// First row of samples, counted from the top of the picture.
    pub first: usize,
    /// Rows of samples before those of its pixels.
    pub above: usize,
    pub nearness: Vec<f32>,
    /// Facet, [`SHEET`], [`FLOOR`] or [`NOTHING`].
    pub seen: Vec<u32>,
    /// The nearest translucent facet, or [`NOTHING`], and its nearness; left out when it lies behind what is seen.
    pub veil: Vec<u32>,
    pub veil_nearness: Vec<f32>,
    /// What is seen of solids where they are cut; empty without a cut.
    faces: Vec<Face>,
}

impl Band {
    /// A band of `rows` rows of pixels that begins at row `first_row`.
    pub fn new(width: usize, rows: usize, first_row: usize, is_cut: bool) -> Self {
        let above = BESIDE.min(first_row * SAMPLES);
        let (width, height) = (width * SAMPLES, above + rows * SAMPLES + BESIDE);
        let first = first_row * SAMPLES - above;
        let (far, nothing) = (vec![f32::NEG_INFINITY; width * height], vec![NOTHING; width * height]);
        let faces = vec![Face::NONE; if is_cut { width * height } else { 0 }];
        let (nearness, seen) = (far.clone(), nothing.clone());
        Self { width, height, first, above, nearness, seen, veil: nothing, veil_nearness: far, faces }
    }

    /// Shows the faces of what is cut, and forgets translucent facets that lie behind something opaque.
    pub fn settle(&mut self, geometry: &Geometry) {
        let overlap = geometry.cut.map_or(0.0, |cut| cut.overlap);
        for (k, face) in self.faces.iter().enumerate() {
            if let Some((facet, near)) = face.shown(self.nearness[k], overlap) {
                (self.seen[k], self.nearness[k]) = (facet, near);
            }
        }
        for k in 0..self.veil.len() {
            if self.veil_nearness[k] <= self.nearness[k] {
                self.veil[k] = NOTHING;
            }
        }
    }

    /// Puts a facet in front of everything that is farther away. Of two at the same depth the earlier stays, so the
    /// order of drawing is the order of the scene.
    pub fn add(&mut self, geometry: &Geometry, number: u32) {
        let triangle = &geometry.triangles[number as usize];
        let [a, b, c] = triangle.corners.map(|corner| geometry.screen[corner as usize]);
        let range = |k: usize, from: usize, count: usize| {
            samples_between(a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]), from, count)
        };
        let (columns, rows) = (range(0, 0, self.width), range(1, self.first, self.height));
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area.is_nan() || area.abs() <= 1e-9 {
            return;
        }
        let (step_b, step_c) = ((c[1] - a[1]) / area, -(b[1] - a[1]) / area);
        let (nearness, seen) = if triangle.opacity < 1.0 {
            (&mut self.veil_nearness, &mut self.veil)
        } else {
            (&mut self.nearness, &mut self.seen)
        };
        let steps = [-step_b - step_c, step_b, step_c];
        let cut = geometry.cut.map_or(f32::INFINITY, |cut| cut.nearness);
        let side = triangle.side.filter(|_| !self.faces.is_empty());
        for y in rows {
            let (dx, dy) = (columns.start as f32 + 0.5 - a[0], y as f32 + 0.5 - a[1]);
            let start_b = (dx * (c[1] - a[1]) - (c[0] - a[0]) * dy) / area;
            let start_c = ((b[0] - a[0]) * dy - dx * (b[1] - a[1])) / area;
            let row = (y - self.first) * self.width;
            let starts = [1.0 - start_b - start_c, start_b, start_c];
            for n in row_span(starts, steps, SLACK, columns.len()) {
                let (x, n) = (columns.start + n, n as f32);
                let (wb, wc) = (start_b + n * step_b, start_c + n * step_c);
                let wa = 1.0 - wb - wc;
                if wa >= SLACK && wb >= SLACK && wc >= SLACK {
                    let near = wa * a[2] + wb * b[2] + wc * c[2];
                    if near > cut {
                        continue;
                    }
                    if let Some(side) = side {
                        self.faces[row + x].pass(side, near, number);
                    }
                    if near > nearness[row + x] {
                        nearness[row + x] = near;
                        seen[row + x] = number;
                    }
                }
            }
        }
    }
}
