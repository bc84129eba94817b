//! Quantities of cells: what is recorded of each at each instant.

use serde::{Deserialize, Serialize};

use super::balance::TractionRecord;

/// What is recorded of one cell at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct CellRecord {
    /// Centre of volume (mean of the atoms for an open surface), µm.
    pub position: [f64; 3],
    /// Mean velocity of the atoms over the last step, µm/s.
    pub velocity: [f64; 3],
    /// Enclosed volume, µm³ (0 for an open surface).
    pub volume: f64,
    /// (V − target)/target.
    pub volume_error: f64,
    /// Surface area, µm².
    pub area: f64,
    /// Elastic energy, pN·µm.
    pub energy: f64,
    /// What viscosity has taken since the cell is there, pN·µm; 0 in runs in which nothing is viscous.
    pub dissipated: f64,
    /// Extents of the axis-aligned bounding box, µm.
    pub size: [f64; 3],
    /// Extents along the principal axes of the atoms, longest first, µm.
    pub principal: [f64; 3],
    /// Smallest area of a facet over its area at rest.
    pub smallest_facet: f64,
    /// Smallest cosine between the normal of a facet and the direction from the cell's centre; 0 for an open surface.
    pub smallest_cosine: f64,
    /// Share of the atoms that are near another cell; 0 without contacts.
    pub contact_share: f64,
    /// Id of the aggregate: of the cell in it with the smallest; the cell's own where it touches no other.
    pub aggregate: f64,
    /// Forces between it and what is around it; nothing in runs that do not record them.
    pub traction: TractionRecord,
    /// Its fibres that were made at run time; nothing in runs in which none may be.
    pub fibres: FibresRecord,
}

/// What the fibres of a cell are like that were made at run time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct FibresRecord {
    /// How many there are.
    pub count: f64,
    /// Sum of what they pull with, pN.
    pub tension: f64,
    /// Their mean length, µm; NaN where there are none.
    pub length: f64,
    /// Their energy, pN·µm.
    pub energy: f64,
}

/// A row of [`CELL`].
#[derive(Debug, Clone, Copy)]
pub struct CellQuantity {
    /// Its dataset in the result file; the name is what follows the last `/`.
    pub dataset: &'static str,
    /// Unit; `1` for pure numbers.
    pub unit: &'static str,
    /// What the numbers mean, in a sentence.
    pub description: &'static str,
    /// Where the numbers come from, and what charts call them.
    pub values: Values,
}

/// Where the numbers of a quantity come from.
#[derive(Debug, Clone, Copy)]
pub enum Values {
    /// One number per cell, with the words of a chart for it.
    Number(fn(&CellRecord) -> f64, &'static str),
    /// Three numbers per cell; each component is a series `NAME_ENDING` with its own words.
    Vector(fn(&CellRecord) -> [f64; 3], [(&'static str, &'static str); 3]),
}

pub(super) const fn row(
    dataset: &'static str,
    unit: &'static str,
    values: Values,
    description: &'static str,
) -> CellQuantity {
    CellQuantity { dataset, unit, description, values }
}

use Values::{Number, Vector};

/// All quantities of cells, in the order of the result file.
#[rustfmt::skip]
pub const CELL: &[CellQuantity] = &[
    row("/cells/position", "um", Vector(|c| c.position, [("x", "position x"), ("y", "position y"), ("z", "position z")]),
        "Centre of volume; mean of the atoms for an open surface."),
    row("/cells/velocity", "um/s", Vector(|c| c.velocity, [("x", "velocity_x"), ("y", "velocity_y"), ("z", "velocity_z")]),
        "Mean velocity of the atoms over the last step."),
    row("/cells/volume", "um^3", Number(|c| c.volume, "volume"),
        "Enclosed volume; 0 for an open surface."),
    row("/cells/volume_error", "1", Number(|c| c.volume_error, "volume error"),
        "(volume - target) / target."),
    row("/cells/area", "um^2", Number(|c| c.area, "area"),
        "Area of the surface."),
    row("/cells/energy", "pN um", Number(|c| c.energy, "elastic energy"),
        "Elastic energy."),
    row("/cells/size", "um", Vector(|c| c.size, [("x", "extent along x"), ("y", "extent along y"), ("z", "extent along z")]),
        "Extents of the box along the axes."),
    row("/cells/principal", "um", Vector(|c| c.principal, [("1", "longest extent"), ("2", "middle extent"), ("3", "shortest extent")]),
        "Extents along the principal axes of the atoms, longest first."),
    row("/cells/smallest_facet", "1", Number(|c| c.smallest_facet, "smallest facet over rest"),
        "Smallest area of a facet over its area at rest."),
    row("/cells/smallest_cosine", "1", Number(|c| c.smallest_cosine, "smallest cosine of normal and radius"),
        "Smallest cosine between the normal of a facet and the direction from the centre; below 0 where a facet has folded over, 0 for an open surface."),
    row("/cells/contact_share", "1", Number(|c| c.contact_share, "share of atoms in contact"),
        "Share of the atoms that are near another cell; 0 without contacts."),
    row("/cells/aggregate", "1", Number(|c| c.aggregate, "aggregate"),
        "Aggregate of a cell: the smallest id of the cells that it touches, and that these touch; its own where it is alone."),
];

/// What is recorded of cells in runs in which some are viscous.
#[rustfmt::skip]
pub const VISCOUS: &[CellQuantity] = &[
    row("/cells/dissipated", "pN um", Number(|c| c.dissipated, "energy lost to viscosity"),
        "What the viscosity of its membrane and of what fills it has taken of its energy since the cell is there."),
];

impl CellQuantity {
    /// The name of the quantity.
    pub fn name(&self) -> &'static str {
        self.dataset.rsplit('/').next().unwrap_or_default()
    }

    /// The component that a series means (none for a number) and its label, if the series is of this quantity.
    pub fn component(&self, series: &str) -> Option<(Option<usize>, &'static str)> {
        match &self.values {
            Number(_, label) => (series == self.name()).then_some((None, *label)),
            Vector(_, components) => {
                let ending = series.strip_prefix(self.name())?.strip_prefix('_')?;
                let index = components.iter().position(|(known, _)| *known == ending)?;
                Some((Some(index), components[index].1))
            }
        }
    }
}
