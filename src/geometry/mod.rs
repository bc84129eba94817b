//! The shapes of cells as triangle surfaces: how they are made, read, checked and measured. No physics, no time.

mod boxes;
mod check;
mod curvature;
mod export;
mod grading;
mod import;
mod lathe;
mod measure;
mod obstacle;
mod occupied;
mod orient;
mod principal;
mod profile;
mod red_cell;
mod sheet;
pub mod solid;
mod spheres;
mod topology;
mod transform;
mod turned;
mod weld;

pub use boxes::box_surface;
pub use check::{Boundary, LEAST_FACET_QUALITY, MeshFault, SurfaceRules, check_surface};
pub use curvature::{gaussian_curvature, mean_curvature, mixed_areas};
pub use export::{OfAtoms, export_surface, write_obj, write_ply, write_stl};
pub use grading::grade_sphere;
pub use import::{read_checked_surface, read_surface};
pub use lathe::lathe;
pub use measure::{
    area, area_vectors, atom_areas, atom_normals, bounding_box, centre_of_volume, facet_areas, facet_qualities,
    finest_edge_length, mean_edge_length, smallest_angle, volume, volume_gradient,
};
pub use obstacle::Obstacle;
pub use occupied::{Occupied, point_in_box};
pub use orient::orient_outwards;
pub use principal::{PrincipalAxes, principal_axes, principal_extents};
pub use profile::{Profile, ProfileFault};
pub use red_cell::{RED_CELL_DIAMETER, red_cell, red_cell_area, red_cell_half_thickness, red_cell_volume};
pub use sheet::sheet;
pub use solid::{Solid, SolidCell, SolidFault};
pub use spheres::{MAX_ICOSPHERE_LEVEL, icosphere, octasphere};
pub use topology::{Flap, Ring, Topology};
pub use transform::{rotate, scale, translate};
pub use turned::{Beside, Turned};

use crate::Vec3;

/// A triangle surface, closed or open. Facets are oriented: seen from outside, their atoms run counter-clockwise,
/// so that `(b − a) × (c − a)` points outwards and a closed surface has a positive volume.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Positions of the atoms, µm.
    pub positions: Vec<Vec3>,
    /// The three atoms of each facet.
    pub facets: Vec<[u32; 3]>,
}

impl Surface {
    /// The positions of the three corners of a facet, µm.
    ///
    /// # Panics
    /// When the facet names an atom that the surface does not have.
    pub fn corners(&self, facet: [u32; 3]) -> [Vec3; 3] {
        facet.map(|atom| self.positions[atom as usize])
    }
}
