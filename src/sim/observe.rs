//! What an observer may know of a cell at one instant. Observers hold shared references only.

use rayon::prelude::*;

use super::forces::elastic_energy;
use super::kind::Kind;
use super::model::Model;
use super::state::State;
use crate::Vec3;
use crate::geometry::{self, Surface};

/// One cell at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct CellMeasure {
    /// Positions of the atoms, µm.
    pub positions: Vec<Vec3>,
    /// Centre of volume (mean of the atoms for an open surface), µm.
    pub centre: Vec3,
    /// Enclosed volume, µm³ (0 for an open surface).
    pub volume: f64,
    /// (V − target)/target, 0 for an open surface.
    pub volume_error: f64,
    /// Surface area, µm².
    pub area: f64,
    /// Elastic energy, pN·µm.
    pub energy: f64,
    /// Extents of the axis-aligned bounding box, µm.
    pub size: Vec3,
    /// Extents along the principal axes, longest first, µm.
    pub principal: [f64; 3],
    /// Smallest area of a facet over its area at rest.
    pub smallest_facet: f64,
    /// Smallest cosine between the normal of a facet and the direction to it from the centre; 0 for an open surface.
    pub smallest_cosine: f64,
}

/// Measures every cell, in the order of cells.
pub fn measure_cells(model: &Model, state: &State) -> Vec<CellMeasure> {
    let mut all = Vec::with_capacity(state.cells());
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        let energy = elastic_energy(kind, now, &state.chemistry.controls);
        let rest_areas = geometry::facet_areas(&kind.rest);
        let factor = kind.volume.course().map_or(1.0, |course| course.at(state.time));
        let measured: Vec<CellMeasure> = (0..now.cells())
            .into_par_iter()
            .map(|cell| {
                let positions = now.cell(kind, cell);
                measure_cell(kind, positions, now.rest_volumes[cell] * factor, energy[cell], &rest_areas)
            })
            .collect();
        all.extend(measured);
    }
    all
}

fn measure_cell(kind: &Kind, positions: Vec<Vec3>, target: f64, energy: f64, rest_areas: &[f64]) -> CellMeasure {
    let surface = Surface { positions, facets: kind.rest.facets.clone() };
    let areas = geometry::facet_areas(&surface);
    let (low, high) = geometry::bounding_box(&surface.positions).unwrap_or_default();
    let volume = if kind.closed { geometry::volume(&surface) } else { 0.0 };
    let smallest = areas.iter().zip(rest_areas).map(|(now, rest)| now / rest).fold(f64::INFINITY, f64::min);
    let centre = if kind.closed {
        geometry::centre_of_volume(&surface)
    } else {
        surface.positions.iter().sum::<Vec3>() / surface.positions.len() as f64
    };
    CellMeasure {
        centre,
        volume,
        volume_error: if kind.closed { (volume - target) / target } else { 0.0 },
        area: areas.iter().sum(),
        energy,
        size: high - low,
        principal: geometry::principal_extents(&surface.positions),
        smallest_facet: smallest,
        smallest_cosine: if kind.closed { smallest_cosine(&surface, &centre) } else { 0.0 },
        positions: surface.positions,
    }
}

/// The smallest cosine between the normal of a facet and the direction from a centre to its middle; facets without area
/// have no normal and do not count.
fn smallest_cosine(surface: &Surface, centre: &Vec3) -> f64 {
    let cosine = |facet: &[u32; 3]| {
        let [a, b, c] = surface.corners(*facet);
        let (normal, out) = ((b - a).cross(&(c - a)), (a + b + c) / 3.0 - centre);
        normal.dot(&out) / (normal.norm() * out.norm())
    };
    surface.facets.iter().map(cosine).fold(1.0, f64::min)
}

/// Mean velocity of the atoms of every cell over the last step, µm/s, in the order of cells; zero before the first.
pub fn mean_velocities(state: &State) -> impl Iterator<Item = Vec3> {
    state.kinds.iter().flat_map(|kind| &kind.mean_velocities).copied().map(Vec3::from)
}
