//! Which facet is seen through which sample of the picture.

use nalgebra::Vector3;

use super::camera::Bounds;
use super::cut::{Cut, Face, Side};
use super::samples::{BAND_ROWS, NOTHING, SAMPLES};
use super::scene::{Edges, Scene, Surface, SurfaceColour};
use super::spans::{SLACK, row_span, samples_between};
use super::view::View;

/// All facets of a scene in the coordinates of the picture.
pub(super) struct Geometry {
    /// Sample coordinates and nearness of every corner.
    pub screen: Vec<[f32; 3]>,
    /// Weights that make interpolation true to perspective.
    pub weights: Vec<f32>,
    /// Positions relative to the camera's target, µm.
    pub points: Vec<Vector3<f32>>,
    /// Unit normals.
    pub normals: Vec<Vector3<f32>>,
    /// Amounts of light, linear, per corner (or per facet, see [`Triangle::colour`]).
    pub colours: Vec<[f32; 3]>,
    pub triangles: Vec<Triangle>,
    /// Half the diagonal of a typical surface, µm: the scale of shadows.
    pub typical_radius: f64,
    /// Where things are cut off.
    pub cut: Option<Cut>,
}

/// One facet.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    pub corners: [u32; 3],
    /// Where in the colours its own stand: three corners' or one for all.
    pub colour: [u32; 3],
    pub edges: Edges,
    /// 1 for a skin that hides everything behind it.
    pub opacity: f32,
    /// Of a solid that is cut: the side on which lines of sight go in, or out.
    pub side: Option<Side>,
}

impl Geometry {
    pub fn new(scene: &Scene, view: &View) -> Self {
        let mut geometry = Self {
            screen: Vec::new(),
            weights: Vec::new(),
            points: Vec::new(),
            normals: Vec::new(),
            colours: Vec::new(),
            triangles: Vec::new(),
            typical_radius: 1.0,
            cut: None,
        };
        let mut radii: Vec<f64> = Vec::with_capacity(scene.surfaces.len());
        for surface in &scene.surfaces {
            geometry.append(surface, view);
            radii.extend(Bounds::around(&surface.positions).map(|bounds| 0.5 * bounds.diagonal()));
        }
        geometry.append(&scene.strokes, view);
        if !radii.is_empty() {
            let middle = radii.len() / 2;
            geometry.typical_radius = radii.select_nth_unstable_by(middle, f64::total_cmp).1.max(1e-6);
        }
        geometry.cut = scene.cut.and_then(|cut| Cut::at(cut, geometry.typical_radius, view));
        geometry
    }

    fn append(&mut self, surface: &Surface, view: &View) {
        let first = self.screen.len() as u32;
        let mut visible = Vec::with_capacity(surface.positions.len());
        for position in &surface.positions {
            let point = crate::Vec3::from(*position) - view.target;
            let projected = view.project(&point).filter(|(at, _)| at.iter().all(|v| v.is_finite() && v.abs() < 1e6));
            visible.push(projected.is_some());
            let ([x, y, near], weight) = projected.unwrap_or_default();
            self.screen.push([x * SAMPLES as f32, y * SAMPLES as f32, near]);
            self.weights.push(weight);
            self.points.push(point.cast());
        }
        self.normals.extend(surface.unit_normals());
        let first_colour = self.colours.len() as u32;
        let (colours, per_atom): (&[_], bool) = match &surface.colour {
            SurfaceColour::Uniform(colour) => (std::slice::from_ref(colour), false),
            SurfaceColour::PerAtom(colours) => (colours, true),
            SurfaceColour::PerFacet(colours) => (colours, false),
        };
        self.colours.extend(colours.iter().map(|colour| colour.linear()));
        if colours.is_empty() {
            return;
        }
        let last = colours.len() as u32 - 1;
        for (number, facet) in surface.facets.iter().enumerate() {
            if surface.is_drawable(facet) && facet.iter().all(|atom| visible[*atom as usize]) {
                let [a, b, c] = facet.map(|atom| self.points[(first + atom) as usize]);
                let faces_viewer = (b - a).cross(&(c - a)).dot(&view.towards_viewer(&a)) >= 0.0;
                let side = if faces_viewer { Side::In } else { Side::Out };
                let own = if per_atom { *facet } else { [number as u32; 3] };
                self.triangles.push(Triangle {
                    corners: facet.map(|atom| first + atom),
                    colour: own.map(|index| first_colour + index.min(last)),
                    edges: surface.edges,
                    opacity: surface.opacity.clamp(0.0, 1.0),
                    side: surface.is_solid.then_some(side),
                });
            }
        }
    }

    /// For every band of rows the facets that touch it, in the order of the scene.
    pub fn bins(&self, height: usize) -> Vec<Vec<u32>> {
        let mut bins = vec![Vec::new(); height.div_ceil(BAND_ROWS)];
        let rows = (BAND_ROWS * SAMPLES) as f32;
        for (number, triangle) in self.triangles.iter().enumerate() {
            let y = triangle.corners.map(|corner| self.screen[corner as usize][1]);
            let (low, high) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
            if high < 0.0 {
                continue;
            }
            let (first, last) = ((low.max(0.0) / rows) as usize, (high / rows) as usize);
            for bin in bins.iter_mut().take(last + 1).skip(first) {
                bin.push(number as u32);
            }
        }
        bins
    }

    /// Twice the signed area of a facet on screen and the weights of its corners at a point.
    pub fn barycentric(&self, triangle: &Triangle, x: f32, y: f32) -> (f32, [f32; 3]) {
        let [a, b, c] = triangle.corners.map(|corner| self.screen[corner as usize]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        let wb = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
        let wc = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area;
        (area, [1.0 - wb - wc, wb, wc])
    }
}

/// What is seen through the samples of some rows.
pub(super) struct Band {
    /// Samples across.
    pub width: usize,
    /// Samples down.
    pub height: usize,
    /// First row of samples, counted from the top of the picture.
    pub first: usize,
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
        let (width, height, first) = (width * SAMPLES, rows * SAMPLES, first_row * SAMPLES);
        let (far, nothing) = (vec![f32::NEG_INFINITY; width * height], vec![NOTHING; width * height]);
        let faces = vec![Face::NONE; if is_cut { width * height } else { 0 }];
        let (nearness, seen) = (far.clone(), nothing.clone());
        Self { width, height, first, nearness, seen, veil: nothing, veil_nearness: far, faces }
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
