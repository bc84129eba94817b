//! The smooth skin that is drawn through the atoms of a mesh, so that a round cell of few atoms does not look cut like a gem. It is made
//! for the eye alone: it passes through the atoms, keeps edges that are sharp, and comes no nearer to planes than atoms do.

mod creases;
mod flat;
mod normals;
mod patch;
mod topology;

use std::sync::Arc;

use nalgebra::Vector3;
use rayon::prelude::*;

use super::scene::{Scene, Surface, SurfaceColour};
use super::view::View;
use crate::Vec3;
use crate::picture::colour::Colour;
use normals::Bearing;
use patch::Patch;
use topology::Topology;

/// How far the drawn skin may be from the smooth one, pixels.
const NEAR_ENOUGH: f64 = 0.3;
/// The most parts that a side of a facet is divided into.
const MOST_PARTS: u16 = 12;
/// Triangles that may be added to those of a scene: by this many, and by as many as there are. Each takes less than a µs.
const MORE: usize = 300_000;
/// All corners of a facet face away from the viewer by more than this cosine: it is on the far side of a closed surface.
const FAR_SIDE: f64 = -0.35;

/// A surface as it is drawn.
#[derive(Default)]
pub(super) struct Skin {
    /// Positions, µm.
    pub points: Vec<[f64; 3]>,
    /// Unit normals at the points.
    pub normals: Vec<Vector3<f32>>,
    /// Amounts of light, linear: at the points where atoms have colours, else of the facets, or one for all.
    pub colours: Vec<[f32; 3]>,
    /// Where the points lie at rest from the middle of the body, µm, of one that is marked; else none.
    pub marks: Vec<Vector3<f32>>,
    pub pieces: Vec<Piece>,
}

/// A triangle of a skin.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub corners: [u32; 3],
    /// The facet that it is part of.
    pub facet: u32,
    /// Which of its sides, each named by the corner across from it, are sides of that facet: one bit for each.
    pub lines: u8,
    /// Parts that the sides of that facet are divided into.
    pub parts: u16,
}

const ALL_SIDES: u8 = 0b111;

/// The skins of a scene's surfaces, in their order.
pub(super) fn skins(scene: &Scene, view: &View) -> Vec<Skin> {
    let topologies = topologies(&scene.surfaces);
    let bare = scene.surfaces.par_iter().zip(&topologies);
    let mut shapes: Vec<Shape> = bare.map(|(surface, topology)| Shape::new(surface, topology, view)).collect();
    for (shape, bends) in shapes.iter_mut().zip(flat::bends(&scene.surfaces, &topologies)) {
        shape.bends = bends;
    }
    let (all, wanted) = shapes.iter().fold((0, 0), |(all, wanted), shape| {
        let facets = shape.surface.facets.len();
        (all + facets, wanted + facets * usize::from(shape.parts).pow(2))
    });
    let share = ((2 * all + MORE) as f64 / wanted.max(1) as f64).min(1.0).sqrt();
    let planes = planes(scene);
    let hides_inside = scene.cut.is_none();
    let skin = |shape: &Shape| {
        // Where things are cut open, what is inside of what is told by facets: skins of cells that press on each other bulge into each other,
        // and the faces of cuts would have holes there.
        let parts = if hides_inside { ((f64::from(shape.parts) * share) as u16).max(1) } else { 1 };
        shape.skin(parts, &planes, hides_inside.then_some(view))
    };
    shapes.par_iter().map(skin).collect()
}

/// The skin of lines and arrows, as they are.
pub(super) fn skin_of(strokes: &Surface, view: &View) -> Skin {
    Shape::new(strokes, &topology_of(strokes), view).skin(1, &[], None)
}

/// How facets meet, for each surface. Cells of one type follow each other and have the same facets.
fn topologies(surfaces: &[Surface]) -> Vec<Arc<Topology>> {
    let mut found: Vec<Arc<Topology>> = Vec::with_capacity(surfaces.len());
    for (number, surface) in surfaces.iter().enumerate() {
        let same = |last: &Surface| {
            last.facets == surface.facets && last.positions.len() == surface.positions.len() && !last.has_normals()
        };
        let known = number.checked_sub(1).filter(|last| same(&surfaces[*last]));
        found.push(known.map_or_else(|| Arc::new(topology_of(surface)), |last| Arc::clone(&found[last])));
    }
    found
}

/// How facets meet, where that is needed.
fn topology_of(surface: &Surface) -> Topology {
    let facets = if surface.has_normals() { &[][..] } else { &surface.facets };
    Topology::new(facets, surface.positions.len())
}

/// Points and unit normals of the planes of a scene.
fn planes(scene: &Scene) -> Vec<[Vec3; 2]> {
    let floor = scene.floor.iter().map(|floor| (floor.point, Vec3::from(floor.normal)));
    let panes = scene.panes.iter().map(|pane| (pane.centre, Vec3::from(pane.half_u).cross(&Vec3::from(pane.half_v))));
    let unit = |(point, normal): ([f64; 3], Vec3)| Some([Vec3::from(point), normal.try_normalize(1e-300)?]);
    floor.chain(panes).filter_map(unit).collect()
}

/// A mesh with what its skin follows from.
struct Shape<'a> {
    surface: &'a Surface,
    positions: Vec<Vec3>,
    bearing: Bearing,
    /// Whether it has an inside, which nobody sees.
    is_closed: bool,
    /// The parts that its sides should be divided into.
    parts: u16,
    /// How much of its bend the skin has at each atom; all of it where it is empty.
    bends: Vec<f64>,
}

impl<'a> Shape<'a> {
    fn new(surface: &'a Surface, topology: &Topology, view: &View) -> Self {
        let positions: Vec<Vec3> = surface.positions.iter().map(|position| Vec3::from(*position)).collect();
        let bearing = Bearing::of(surface, &positions, topology);
        let mut shape = Self { surface, positions, bearing, is_closed: false, parts: 1, bends: Vec::new() };
        if !surface.has_normals() {
            shape.is_closed = topology.is_closed && shape.volume() > 0.0;
            shape.parts = shape.wanted(view);
        }
        shape
    }

    fn drawable(&self) -> impl Iterator<Item = usize> {
        (0..self.surface.facets.len()).filter(|facet| self.surface.is_drawable(&self.surface.facets[*facet]))
    }

    fn corners(&self, facet: usize) -> [Vec3; 3] {
        self.surface.facets[facet].map(|atom| self.positions[atom as usize])
    }

    /// Six times the volume inside, less than nothing when facets turn inwards.
    fn volume(&self) -> f64 {
        let first = self.positions.first().copied().unwrap_or_default();
        let volume = |facet| {
            let [a, b, c] = self.corners(facet).map(|corner| corner - first);
            a.dot(&b.cross(&c))
        };
        self.drawable().map(volume).sum()
    }

    /// Parts that bring a skin as near to the smooth one as the eye can tell.
    fn wanted(&self, view: &View) -> u16 {
        let height = |facet| {
            let corners = self.corners(facet);
            self.patch(facet, corners).height() * view.pixels_per_micron(&(corners[0] - view.target))
        };
        let highest = self.drawable().map(height).fold(0.0, f64::max);
        // Each part is lower by the square of their number.
        ((highest / NEAR_ENOUGH).sqrt().ceil() as u16).clamp(1, MOST_PARTS)
    }

    fn patch(&self, facet: usize, corners: [Vec3; 3]) -> Patch {
        let (atoms, normals) =
            (self.surface.facets[facet], [0, 1, 2].map(|k| self.bearing.normal(facet, k, self.surface)));
        let tangents = [0, 1, 2].map(|k| {
            let next = (k + 1) % 3;
            self.bearing.creases.tangents_of(3 * facet + k, [atoms[k], atoms[next]], corners[next] - corners[k])
        });
        Patch::new(corners, normals, tangents)
    }

    /// The skin with the sides of facets in so many parts; what is on the far side as seen from `view` stays as it is.
    fn skin(&self, parts: u16, planes: &[[Vec3; 2]], view: Option<&View>) -> Skin {
        let surface = self.surface;
        let mut skin = Skin::default();
        let per_atom = match &surface.colour {
            SurfaceColour::Uniform(colour) => {
                skin.colours.push(colour.linear());
                &[][..]
            }
            SurfaceColour::PerFacet(colours) => {
                skin.colours.extend(colours.iter().map(|colour| colour.linear()));
                &[]
            }
            SurfaceColour::PerAtom(colours) => colours,
        };
        let marks = surface.marks().unwrap_or_default();
        if parts == 1 && !self.bearing.creases.has_edges {
            skin.points.clone_from(&surface.positions);
            skin.normals = self.bearing.normals.iter().map(|normal| normal.cast()).collect();
            skin.colours.extend(per_atom.iter().map(|colour| colour.linear()));
            skin.marks.extend(marks.iter().map(|mark| mark.cast()));
            let piece = |facet| Piece { corners: surface.facets[facet], facet: facet as u32, lines: ALL_SIDES, parts };
            skin.pieces.extend(self.drawable().map(piece));
            return skin;
        }
        for facet in self.drawable() {
            let is_far = view.is_some_and(|view| self.is_closed && self.is_on_far_side(facet, view));
            self.add_facet(&mut skin, facet, if is_far { 1 } else { parts }, (per_atom, &marks), planes);
        }
        skin
    }

    fn is_on_far_side(&self, facet: usize, view: &View) -> bool {
        let atoms = self.corners(facet);
        (0..3).all(|k| {
            let viewer = view.towards_viewer(&(atoms[k] - view.target).cast()).cast::<f64>();
            self.bearing.normal(facet, k, self.surface).dot(&viewer) < FAR_SIDE
        })
    }

    /// Adds a facet in `parts` × `parts` pieces.
    fn add_facet(
        &self,
        skin: &mut Skin,
        facet: usize,
        parts: u16,
        (per_atom, marks): (&[Colour], &[Vec3]),
        planes: &[[Vec3; 2]],
    ) {
        let corners = self.corners(facet);
        let patch = self.patch(facet, corners);
        let marks = self.surface.facets[facet].map(|atom| marks.get(atom as usize));
        let bends = self.surface.facets[facet].map(|atom| self.bends.get(atom as usize).copied().unwrap_or(1.0));
        let paints = self.surface.facets[facet].map(|atom| per_atom.get(atom as usize).or(per_atom.last()));
        let n = u32::from(parts);
        let first = skin.points.len() as u32;
        for j in 0..=n {
            for i in 0..=n - j {
                let weights = [n - i - j, i, j].map(|share| f64::from(share) / f64::from(n));
                let (bent, flat) = (patch.point(weights), mixed(&corners, weights));
                let bend = weights[0] * bends[0] + weights[1] * bends[1] + weights[2] * bends[2];
                skin.points.push(held_off(flat + bend * (bent - flat), weights, &corners, planes).into());
                let normal = patch.normal(weights).try_normalize(1e-12).unwrap_or_else(Vec3::z);
                skin.normals.push(normal.cast());
                if let [Some(a), Some(b), Some(c)] = marks {
                    skin.marks.push((a * weights[0] + b * weights[1] + c * weights[2]).cast());
                }
                if let [Some(a), Some(b), Some(c)] = paints {
                    let shares = weights.map(|weight| weight as f32);
                    let [a, b, c] = [a, b, c].map(|paint| paint.linear());
                    skin.colours.push([0, 1, 2].map(|k| shares[0] * a[k] + shares[1] * b[k] + shares[2] * c[k]));
                }
            }
        }
        let at = |i: u32, j: u32| first + j * (n + 1) + i - j * j.saturating_sub(1) / 2;
        for j in 0..n {
            for i in 0..n - j {
                let lines = u8::from(i + j + 1 == n) | u8::from(i == 0) << 1 | u8::from(j == 0) << 2;
                let piece = |corners, lines| Piece { corners, facet: facet as u32, lines, parts };
                skin.pieces.push(piece([at(i, j), at(i + 1, j), at(i, j + 1)], lines));
                if i + j + 1 < n {
                    skin.pieces.push(piece([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], 0));
                }
            }
        }
    }
}

/// The point of a flat triangle with these weights of its corners.
fn mixed(corners: &[Vec3; 3], weights: [f64; 3]) -> Vec3 {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}

/// A point of a skin, no nearer to any plane than the nearest of the atoms that it lies between: cells that rest on a plane or touch one
/// would seem to go through it.
fn held_off(point: Vec3, weights: [f64; 3], corners: &[Vec3; 3], planes: &[[Vec3; 2]]) -> Vec3 {
    let mut held = point;
    for [origin, normal] in planes {
        let off = corners.map(|corner| (corner - origin).dot(normal));
        let free = off.iter().sum::<f64>().signum();
        let atoms = (0..3).filter(|k| weights[*k] > 0.0).map(|k| free * off[k]);
        let least = atoms.fold(f64::INFINITY, f64::min);
        let lacks = least - free * (held - origin).dot(normal);
        if lacks > 0.0 && least.is_finite() {
            held += normal * (free * lacks);
        }
    }
    held
}

#[cfg(test)]
mod tests;
