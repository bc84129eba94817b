//! Parts of a filled body that are of another material: a nucleus, an inclusion. What documents say of them, and which cells of the mesh are theirs.

use super::compile::{Builder, Inside};
use crate::Vec3;
use crate::units::{Length, Stress, Viscosity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A part of a filled body that is of another material: the cells of the mesh whose middle is in an ellipsoid, of two the later.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// What it is, for messages.
    pub name: String,
    /// The middle of the ellipsoid, in the mesh before it is turned.
    #[serde(default, skip_serializing_if = "is_origin")]
    pub centre: [Length; 3],
    /// Its radii along x, y and z.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub radii: [Length; 3],
    /// Young's modulus at small strain there; Poisson's ratio and the law are those of the body.
    #[schemars(extend("x-minimum" = 0))]
    pub young: Stress,
    /// Viscosity there; that of the inside of the body when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-minimum" = 0))]
    pub viscosity: Option<Viscosity>,
}

fn is_origin(centre: &[Length; 3]) -> bool {
    centre.iter().all(|length| length.value() == 0.0)
}

impl Region {
    fn holds(&self, point: Vec3) -> bool {
        let share = |axis: usize| (point[axis] - self.centre[axis].value()) / self.radii[axis].value();
        (0..3).map(|axis| share(axis).powi(2)).sum::<f64>() < 1.0
    }
}

/// The number of the region of each cell of a body whose atoms are at `x` (µm), or none.
pub fn of_cells(regions: &[Region], inside: &Inside, x: &[Vec3]) -> Vec<Option<usize>> {
    let of_cell = |range: &[u32]| {
        let tetrahedra = &inside.tetrahedra[range[0] as usize..range[1] as usize];
        let middle: Vec3 = tetrahedra.iter().flatten().map(|&atom| x[atom as usize]).sum();
        let middle = middle / (4.0 * tetrahedra.len() as f64);
        regions.iter().rposition(|region| region.holds(middle))
    };
    inside.cells.windows(2).map(of_cell).collect()
}

/// The viscosity of each tetrahedron, Pa·s, of a body of which the regions without their own have this one; none where nothing is viscous.
pub fn viscosities(body: f64, regions: &[Region], inside: &Inside, x: &[Vec3]) -> Option<Vec<f64>> {
    let of = |region: Option<usize>| region.and_then(|k| regions[k].viscosity).map_or(body, |own| own.value());
    let mut all = Vec::with_capacity(inside.tetrahedra.len());
    for (range, region) in inside.cells.windows(2).zip(of_cells(regions, inside, x)) {
        all.extend((range[0]..range[1]).map(|_| of(region)));
    }
    all.iter().any(|viscosity| *viscosity > 0.0).then_some(all)
}

/// What of a body is of one region, or of none.
pub fn part(inside: &Inside, of_cells: &[Option<usize>], wanted: Option<usize>) -> Inside {
    let (mut tetrahedra, mut cells) = (Vec::new(), vec![0]);
    for (range, _) in inside.cells.windows(2).zip(of_cells).filter(|(_, region)| **region == wanted) {
        tetrahedra.extend_from_slice(&inside.tetrahedra[range[0] as usize..range[1] as usize]);
        cells.push(tetrahedra.len() as u32);
    }
    Inside { tetrahedra, cells, edges: Vec::new() }
}

/// Tells the regions that hold no cell of the mesh.
pub fn check(regions: &[Region], of_cells: &[Option<usize>], to: &mut Builder) {
    for (number, region) in regions.iter().enumerate().filter(|(number, _)| !of_cells.contains(&Some(*number))) {
        let found = format!(
            "no element (hexahedron, wedge, tetrahedron) of the mesh has its middle in `{}`, or later regions have them all",
            region.name
        );
        let help =
            "give it larger radii or another centre (in the mesh before it is turned), or the mesh smaller elements";
        to.fault(&format!("mechanics.solid.regions[{number}].radii"), "holds nothing", found, help);
    }
}
