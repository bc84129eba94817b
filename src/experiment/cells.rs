//! Types of cells: how many, of which shape, where, and how they move about.

use super::loads::Applied;
use super::mechanics::Mechanics;
use super::motility::Motility;
use super::placement::Placement;
use super::population::{Added, Removed};
use super::pseudopods::Pseudopods;
use crate::units::{Angle, Length};
use crate::values::{Colour, LengthUnit, OneOrMany};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A type of cells that share shape and mechanics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct CellType {
    /// How many cells at the start; without it as many as the placement says, or one. None where all are added later.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    pub number: Option<u32>,
    /// The colour in pictures, "#c0392b"; chosen when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// The surface at rest.
    pub mesh: Mesh,
    /// By how much the mesh is drawn out along x, y and z before it is turned: so is the cell at rest, an ellipsoid from a sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 0.1, max = 10.0)))]
    pub stretch: Option<[f64; 3]>,
    /// How the surface is turned before it is placed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
    /// Where the cells start; at the origin if there is one, else on a square grid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub placement: Option<Placement>,
    /// Cells that come during the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub added: Vec<Added>,
    /// Cells that go during the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub removed: Vec<Removed>,
    /// What the cells are made of.
    pub mechanics: Mechanics,
    /// What is done to some of its atoms.
    #[serde(flatten)]
    pub applied: Applied,
    /// How the cells move by themselves.
    #[serde(default)]
    pub motility: Motility,
    /// Pseudopods that push and draw the cell along what it sticks to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pseudopods: Option<Pseudopods>,
    /// How many fibres a cell has at most that are made while it runs, by its pseudopods or by a program; as many as its pseudopods need when
    /// absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 10_000))]
    pub fibre_budget: Option<u32>,
    /// Systems of equations that every cell has a copy of: names in `[chemistry]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub chemistry: Vec<String>,
}

impl CellType {
    /// A type with this surface and mechanics, and nothing else.
    pub fn new(mesh: Mesh, mechanics: Mechanics) -> Self {
        Self {
            number: None,
            colour: None,
            mesh,
            stretch: None,
            orientation: None,
            placement: None,
            added: Vec::new(),
            removed: Vec::new(),
            mechanics,
            applied: Applied::default(),
            motility: Motility::default(),
            pseudopods: None,
            fibre_budget: None,
            chemistry: Vec::new(),
        }
    }

    /// How many cells there are at the start: `number` if given, else one for each position of the placement, else one.
    pub fn count(&self) -> usize {
        let positions = self.placement.as_ref().map_or(1, Placement::positions);
        self.number.map_or(positions, |number| number as usize)
    }

    /// How many fibres a cell may have at most that are made while it runs.
    pub(super) fn fibre_budget(&self) -> usize {
        let of_pods = || self.pseudopods.as_ref().map_or(0, Pseudopods::fibres_at_once);
        self.fibre_budget.unwrap_or_else(of_pods) as usize
    }

    /// The most cells that there can be at a time: those of the start and all that come.
    pub fn most(&self) -> usize {
        self.count() + self.added.iter().map(Added::count).sum::<usize>()
    }
}

/// The surface of a cell at rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "snake_case", deny_unknown_fields)]
pub enum Mesh {
    /// The biconcave red cell of Evans and Fung (1972) on an icosphere, its axis along z.
    RedCell {
        /// Diameter of the disc.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        diameter: Length,
        /// Refinement: 12, 42, 162, 642, 2562 … atoms.
        #[schemars(range(min = 0, max = 6))]
        level: u8,
    },
    /// A sphere refined from an icosahedron.
    Icosphere {
        /// Distance of every atom from the centre.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        radius: Length,
        /// Refinement: 12, 42, 162, 642, 2562 … atoms.
        #[schemars(range(min = 0, max = 6))]
        level: u8,
        /// Where its facets are finest; all alike when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        finest: Option<Finest>,
    },
    /// A sphere refined from an octahedron; 66 atoms with 4 divisions.
    Octasphere {
        /// Distance of every atom from the centre.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        radius: Length,
        /// Parts that every edge of the octahedron is divided into.
        #[schemars(range(min = 1, max = 64))]
        divisions: u32,
    },
    /// A closed rectangular box, centred.
    Box {
        /// Lengths of its edges along x, y and z.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        size: [Length; 3],
        /// Parts that the edges are divided into.
        #[schemars(inner(range(min = 1, max = 1000)))]
        divisions: [u32; 3],
    },
    /// An open flat sheet in the plane z = 0, centred.
    Sheet {
        /// Lengths of its sides along x and y.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        size: [Length; 2],
        /// Parts that the sides are divided into.
        #[schemars(inner(range(min = 1, max = 10000)))]
        divisions: [u32; 2],
    },
    /// A single open equilateral facet, for studies of stability.
    Triangle {
        /// Length of its sides.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        side: Length,
    },
    /// A profile turned about the z axis: a pipette, a ring, a tip, a cone, a cylinder.
    Lathe {
        /// Corners of the profile, each its distance from the axis and its height. With both ends on the axis it makes a body without a hole; with
        /// no corner on the axis it is closed from the last to the first, and makes a ring.
        #[schemars(length(min = 3, max = 1000))]
        profile: Vec<[Length; 2]>,
        /// The radius to which corners beside the axis are rounded.
        #[schemars(extend("x-minimum" = 0, "x-maximum" = 1e6))]
        #[serde(default, skip_serializing_if = "is_sharp")]
        rounding: Length,
        /// Atoms around the axis where the profile is widest; rings are as far from each other as these are.
        #[schemars(range(min = 6, max = 10000))]
        around: u32,
    },
    /// A filled box, centred, of hexahedra that are cut into five tetrahedra each: a gel, a beam, a block of tissue.
    Block {
        /// Lengths of its edges along x, y and z.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        size: [Length; 3],
        /// Parts that the edges are divided into.
        #[schemars(inner(range(min = 1, max = 200)))]
        divisions: [u32; 3],
        /// Where its parts are finest; all alike when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        finest: Option<Finest>,
    },
    /// A filled cylinder about the z axis, centred, of rings of wedges that are cut into three tetrahedra each.
    Rod {
        /// Distance of its outer atoms from the axis.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        radius: Length,
        /// Its length along the axis.
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        length: Length,
        /// The radius halfway, where it bulges or has a waist: its outline is the arc of a circle. `radius` when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-exclusive-minimum" = 0, "x-minimum" = 1e-3, "x-maximum" = 1e6))]
        middle: Option<Length>,
        /// Rings around the axis; a layer has 6 wedges in the first, 18 in the second, 30 in the third.
        #[schemars(range(min = 1, max = 100))]
        rings: u32,
        /// Layers along the axis.
        #[schemars(range(min = 1, max = 1000))]
        layers: u32,
    },
    /// A surface from a file: OBJ, STL, PLY or PML.
    File {
        /// The file, relative to the document.
        #[schemars(extend("x-text" = "file"))]
        path: PathBuf,
        /// The length that a coordinate of 1 stands for. Of a PML file that is what its property `lengthUnit` says when absent, or else 1 mm.
        #[serde(default)]
        unit: LengthUnit,
        /// The component of a PML file whose facets are meant, or several; the one that is a closed surface when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        component: Option<OneOrMany<String>>,
        /// Whether the body is filled: made of the tetrahedra, pyramids, wedges and hexahedra of a PML file, of the component or of all.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        filled: bool,
    },
}

/// Where the parts of a block or the facets of a sphere are finest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Finest {
    /// A point within a block; of a sphere the point of its surface that is nearest, any but its centre.
    pub at: [Length; 3],
    /// How many times as long parts are at the end that is farthest; between they grow with the distance along the axis. How many times as long
    /// edges of a sphere are opposite; between the map is conformal.
    #[schemars(range(min = 1, max = 100))]
    pub ratio: f64,
    /// Up to which distance from the point, along each axis, parts of a block are as short as at it.
    #[schemars(extend("x-minimum" = 0))]
    #[serde(default, skip_serializing_if = "is_sharp")]
    pub even: Length,
}

/// Whether corners are not rounded.
fn is_sharp(rounding: &Length) -> bool {
    rounding.value() == 0.0
}

impl Mesh {
    /// Whether there are atoms inside.
    pub fn is_filled(&self) -> bool {
        matches!(self, Self::Block { .. } | Self::Rod { .. } | Self::File { filled: true, .. })
    }

    /// Whether the surface has a border, as far as that is known without reading a file.
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Sheet { .. } | Self::Triangle { .. })
    }
}

/// A turn about an axis through the cell's centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orientation {
    /// The axis; its length does not matter.
    pub axis: [f64; 3],
    /// The angle, right-handed.
    pub angle: Angle,
}
