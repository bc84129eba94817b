//! What can be drawn: surfaces, lines, a floor and panes, all in µm.

use crate::Vec3;
use crate::picture::colour::{Colour, ColourMap};
use crate::picture::ticks::Scale;

/// Everything in front of the camera.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    /// Cells and other surfaces.
    pub surfaces: Vec<Surface>,
    /// Lines and arrows, kept as thin tubes; see [`Scene::add_line`].
    pub strokes: Surface,
    /// The substrate that cells sit on and throw shadows on; seen from its free side only.
    pub floor: Option<Floor>,
    /// Values of a field, on the floor or on a slice through the scene.
    pub sheet: Option<Sheet>,
    /// Translucent rectangles: walls, plates.
    pub panes: Vec<Pane>,
    /// Cells and lines are cut off where they are nearer to the camera than this point, µm.
    pub cut: Option<[f64; 3]>,
    /// What is behind everything.
    pub background: Background,
}

/// A surface of triangles, closed or open.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Positions of the atoms, µm.
    pub positions: Vec<[f64; 3]>,
    /// Normal at each atom for smooth shading: the facets are drawn as they are. When empty, a smooth skin is drawn through the
    /// atoms, with edges where the facets around have one.
    pub normals: Vec<[f64; 3]>,
    /// Positions of the atoms in which edges are sharp where facets meet, µm; the present ones when there are not as many. With those
    /// of a mesh at rest, a soft cell has no edges that come and go.
    pub rest: Vec<[f64; 3]>,
    /// Facets: three atoms each, all turning the same way round so that normals can be averaged.
    pub facets: Vec<[u32; 3]>,
    /// Colour.
    pub colour: SurfaceColour,
    /// Whether the edges of facets are drawn.
    pub edges: Edges,
    /// Whether a thin dark line is drawn where it meets another such surface in the picture, by which cells of one colour are told
    /// apart.
    pub is_outlined: bool,
    /// Whether it is painted in two tones, by the eighths of space that its atoms lie in at rest around their middle: what has turned since
    /// is seen. Needs positions at rest.
    pub is_marked: bool,
    /// How much the skin hides: 1 everything, less lets lines, floor and opaque surfaces behind it shine through. Of
    /// several such skins behind each other only the nearest shows.
    pub opacity: f32,
    /// Whether the surface is closed and full: where it is cut off a flat face is seen.
    pub is_solid: bool,
}

impl Default for Surface {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            rest: Vec::new(),
            facets: Vec::new(),
            colour: SurfaceColour::default(),
            edges: Edges::default(),
            is_outlined: false,
            is_marked: false,
            opacity: 1.0,
            is_solid: false,
        }
    }
}

/// The colour of a surface, in sRGB.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceColour {
    /// The same everywhere.
    Uniform(Colour),
    /// One per atom, blended across facets.
    PerAtom(Vec<Colour>),
    /// One per facet.
    PerFacet(Vec<Colour>),
}

impl Default for SurfaceColour {
    fn default() -> Self {
        Self::Uniform(Colour([0xb8, 0xbe, 0xc6]))
    }
}

/// Whether the edges of facets are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Edges {
    /// A smooth skin.
    #[default]
    Hidden,
    /// Thin dark lines, so that the mesh can be judged. They fade where facets get small.
    Thin,
}

/// A plane that cells sit on, drawn as a disc with a faint grid that fades into the background.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// A point of the plane, µm; the middle of the disc.
    pub point: [f64; 3],
    /// Normal towards the free side.
    pub normal: [f64; 3],
    /// Distance between grid lines, µm; every fifth is stronger. Zero for no grid.
    pub grid: f64,
    /// Radius where the floor has faded away, µm.
    pub radius: f64,
}

/// A rectangle that shows numbers as colours, smoothly between the centres of its boxes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    /// The corner of the first box, µm.
    pub corner: [f64; 3],
    /// Its first side as a vector, µm.
    pub side_u: [f64; 3],
    /// Its second side as a vector at a right angle to the first, µm.
    pub side_v: [f64; 3],
    /// Number of boxes along the two sides.
    pub size: [usize; 2],
    /// A value for each box, those along the first side together; NaN is shown grey.
    pub values: Vec<f64>,
    /// Colours.
    pub map: ColourMap,
    /// Values of the first and the last colour.
    pub range: [f64; 2],
    /// How values are spaced between them.
    pub scale: Scale,
}

/// A translucent rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pane {
    /// Its middle, µm.
    pub centre: [f64; 3],
    /// Half its first side as a vector, µm.
    pub half_u: [f64; 3],
    /// Half its second side as a vector at a right angle to the first, µm.
    pub half_v: [f64; 3],
    /// Colour of the glass.
    pub colour: Colour,
}

/// What is behind everything: a vertical gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Background {
    /// Colour of the top row.
    pub top: Colour,
    /// Colour of the bottom row.
    pub bottom: Colour,
}

impl Default for Background {
    fn default() -> Self {
        Self { top: Colour([0xff, 0xff, 0xff]), bottom: Colour([0xf1, 0xf3, 0xf6]) }
    }
}

impl Background {
    /// The same colour everywhere.
    pub fn plain(colour: Colour) -> Self {
        Self { top: colour, bottom: colour }
    }
}

impl Surface {
    /// A surface of one colour with smooth shading and hidden edges.
    pub fn new(positions: Vec<[f64; 3]>, facets: Vec<[u32; 3]>, colour: Colour) -> Self {
        Self { positions, facets, colour: SurfaceColour::Uniform(colour), ..Self::default() }
    }

    /// Whether a facet names atoms that exist and have finite positions.
    pub(super) fn is_drawable(&self, facet: &[u32; 3]) -> bool {
        facet.iter().all(|atom| self.positions.get(*atom as usize).is_some_and(|p| p.iter().all(|v| v.is_finite())))
    }

    /// Where its atoms lie at rest from their middle, µm, where that is seen by marks.
    pub(super) fn marks(&self) -> Option<Vec<Vec3>> {
        let count = self.positions.len();
        if !self.is_marked || count == 0 || self.rest.len() != count {
            return None;
        }
        let middle = self.rest.iter().map(|at| Vec3::from(*at)).sum::<Vec3>() / count as f64;
        Some(self.rest.iter().map(|at| Vec3::from(*at) - middle).collect())
    }

    /// Whether its normals are given.
    pub(super) fn has_normals(&self) -> bool {
        !self.positions.is_empty() && self.normals.len() == self.positions.len()
    }
}
