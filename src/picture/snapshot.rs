//! One recorded instant, as pictures show it.

use super::joined::Joint;
use super::render::Sheet;
use crate::Vec3;
use crate::output::{Cell, Layout};

/// One recorded instant.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    /// Types of cells with their meshes, and planes.
    pub layout: &'a Layout,
    /// The cells that there are.
    pub cells: &'a [Cell],
    /// Positions of all atoms, µm.
    pub positions: &'a [[f64; 3]],
    /// Simulated time, s.
    pub time: f64,
    /// What colours show.
    pub values: Values<'a>,
    /// Arrows over the cells, from tail to tip (µm): loads, velocities.
    pub arrows: &'a [[[f64; 3]; 2]],
    /// Fibres inside the cells: their ends (µm) and what they pull with (pN); none where they are not shown in any frame.
    pub fibres: Option<&'a [DrawnFibre]>,
    /// Lines between the centres of cells that are linked (µm) and the number of their links; none where they are not shown in any frame.
    pub links: Option<&'a [Joint]>,
    /// A field under or between the cells; the look says its colours.
    pub field: Option<&'a Sheet>,
    /// Positions of the atoms of a cell of each type, µm, from which its edges are known; those behind the last have those of now.
    pub rest: &'a [Vec<[f64; 3]>],
    /// How far obstacles have gone, µm, in the order of the layout; those behind the last have not.
    pub gone: &'a [Vec3],
}

/// The ends of a fibre (µm) and what it pulls with (pN).
pub type DrawnFibre = ([[f64; 3]; 2], f64);

/// What colours show.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Values<'a> {
    /// The type of the cell.
    #[default]
    Type,
    /// One number per atom, in the order of the positions.
    Atoms(&'a [f64]),
    /// One number per cell, in the order of the cells.
    Cells(&'a [f64]),
}
