//! All facets of a scene in the coordinates of the picture.

use nalgebra::Vector3;

use super::camera::Bounds;
use super::cut::{Cut, Side};
use super::samples::{BAND_ROWS, BESIDE, NOTHING, SAMPLES};
use super::scene::{Edges, Scene, Surface, SurfaceColour};
use super::skin::{Skin, skin_of, skins};
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
    /// Where corners of bodies that are marked lie at rest from the middles of these, µm; those of others say nothing.
    pub marks: Vec<Vector3<f32>>,
    pub triangles: Vec<Triangle>,
    /// Half the diagonal of a typical surface, µm: the scale of shadows.
    pub typical_radius: f64,
    /// Where things are cut off.
    pub cut: Option<Cut>,
}

/// One facet, or a piece of one.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    pub corners: [u32; 3],
    /// Where in the colours its own stand: three corners' or one for all.
    pub colour: [u32; 3],
    /// Sides of the mesh that are drawn, each named by the corner across from it: one bit for each.
    pub lines: u8,
    /// Parts that the sides of its facet are divided into.
    pub parts: u16,
    /// Whether its normals are on the side that is not seen.
    pub is_turned: bool,
    /// Whether its body is painted in two tones.
    pub is_marked: bool,
    /// 1 for a skin that hides everything behind it.
    pub opacity: f32,
    /// The number of its surface, or [`NOTHING`] for one without an outline.
    pub body: u32,
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
            marks: Vec::new(),
            triangles: Vec::new(),
            typical_radius: 1.0,
            cut: None,
        };
        let mut radii: Vec<f64> = Vec::with_capacity(scene.surfaces.len());
        for (number, (surface, skin)) in scene.surfaces.iter().zip(skins(scene, view)).enumerate() {
            geometry.append(surface, if surface.is_outlined { number as u32 } else { NOTHING }, skin, view);
            radii.extend(Bounds::around(&surface.positions).map(|bounds| 0.5 * bounds.diagonal()));
        }
        geometry.append(&scene.strokes, NOTHING, skin_of(&scene.strokes, view), view);
        if !radii.is_empty() {
            let middle = radii.len() / 2;
            geometry.typical_radius = radii.select_nth_unstable_by(middle, f64::total_cmp).1.max(1e-6);
        }
        geometry.cut = scene.cut.and_then(|cut| Cut::at(cut, geometry.typical_radius, view));
        geometry
    }

    fn append(&mut self, surface: &Surface, body: u32, skin: Skin, view: &View) {
        let first = self.screen.len() as u32;
        let mut visible = Vec::with_capacity(skin.points.len());
        for position in &skin.points {
            let point = crate::Vec3::from(*position) - view.target;
            let projected = view.project(&point).filter(|(at, _)| at.iter().all(|v| v.is_finite() && v.abs() < 1e6));
            visible.push(projected.is_some());
            let ([x, y, near], weight) = projected.unwrap_or_default();
            self.screen.push([x * SAMPLES as f32, y * SAMPLES as f32, near]);
            self.weights.push(weight);
            self.points.push(point.cast());
        }
        self.normals.extend(skin.normals);
        let is_marked = !skin.marks.is_empty();
        if is_marked {
            self.marks.resize(first as usize, Vector3::zeros());
            self.marks.extend(skin.marks);
        }
        let first_colour = self.colours.len() as u32;
        let Some(last) = (skin.colours.len() as u32).checked_sub(1) else { return };
        self.colours.extend(skin.colours);
        let per_point = matches!(surface.colour, SurfaceColour::PerAtom(_));
        for piece in skin.pieces.iter().filter(|piece| piece.corners.iter().all(|point| visible[*point as usize])) {
            let corners = piece.corners.map(|point| first + point);
            let [a, b, c] = corners.map(|corner| self.points[corner as usize]);
            let normal = (b - a).cross(&(c - a));
            let faces_viewer = normal.dot(&view.towards_viewer(&a)) >= 0.0;
            let normals: Vector3<f32> = corners.iter().map(|corner| self.normals[*corner as usize]).sum();
            let side = if faces_viewer { Side::In } else { Side::Out };
            let own = if per_point { piece.corners } else { [piece.facet; 3] };
            self.triangles.push(Triangle {
                corners,
                colour: own.map(|index| first_colour + index.min(last)),
                lines: if surface.edges == Edges::Thin { piece.lines } else { 0 },
                parts: piece.parts,
                is_turned: (normals.dot(&normal) < 0.0) == faces_viewer,
                is_marked,
                opacity: surface.opacity.clamp(0.0, 1.0),
                body,
                side: surface.is_solid.then_some(side),
            });
        }
    }

    /// For every band of rows the facets that touch it or the samples beside it, in the order of the scene.
    pub fn bins(&self, height: usize) -> Vec<Vec<u32>> {
        let mut bins = vec![Vec::new(); height.div_ceil(BAND_ROWS)];
        let rows = (BAND_ROWS * SAMPLES) as f32;
        for (number, triangle) in self.triangles.iter().enumerate() {
            let y = triangle.corners.map(|corner| self.screen[corner as usize][1]);
            let (low, high) = (y[0].min(y[1]).min(y[2]) - BESIDE as f32, y[0].max(y[1]).max(y[2]) + BESIDE as f32);
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
