//! Scratch of the contacts.

use super::links::Link;
use super::momentum::Momentum;
use super::rows::{Pull, Row};
use super::sweep::{V4, VolumeRow};
use crate::Vec3;
use crate::contact::{Contacts, Detector};

/// Scratch of the contacts; arrays over all atoms stand in the order of cells.
#[derive(Debug, Clone, Default)]
pub struct ContactScratch {
    /// Pairs that are near.
    pub detector: Detector,
    /// What touches where the step began.
    pub found: Contacts,
    /// Positions where the step began, µm.
    pub start: Vec<Vec3>,
    /// Force of the contacts on the atoms where the step began, pN.
    pub force: Vec<Vec3>,
    /// Links of the step.
    pub links: Vec<Link>,
    /// Facets that have one.
    pub(super) linked: Vec<bool>,
    /// Positions in the stage that is being made, µm.
    pub(super) places: Vec<Vec3>,
    /// Force of links or penalties on the atoms in that stage, pN; empty where there are none.
    pub(super) live_force: Vec<Vec3>,
    /// What the surface at each atom releases an area of contact, pN/µm.
    pub(super) relief: Vec<f64>,
    /// Contacts as the sweeps see them: atoms on facets, then edges on edges, then atoms on planes.
    pub rows: Vec<Row>,
    /// What each row carries.
    pub pulls: Vec<Pull>,
    /// Displacement of the atoms over the step, µm, and their displacement over force, µm/pN.
    pub(super) moved: Vec<V4>,
    /// Gradients of the volumes, µm², and 0.
    pub(super) gradient: Vec<V4>,
    /// Volumes to keep.
    pub(super) volumes: Vec<VolumeRow>,
    /// Atoms and axes that are held.
    pub(super) held: Vec<(u32, u32)>,
    /// Pushes that mend depths, pN.
    pub(super) push: Vec<f64>,
    pub(super) momentum: Momentum,
    /// Sweeps of the last projection.
    pub sweeps: u32,
}

impl ContactScratch {
    /// Writes NaN over all scratch numbers and forgets all pairs.
    pub fn poison(&mut self) {
        self.detector.forget();
        self.found.clear();
        self.rows.clear();
        self.pulls.clear();
        self.volumes.clear();
        self.held.clear();
        self.links.clear();
        self.linked.clear();
        [&mut self.places, &mut self.live_force].into_iter().for_each(|all| all.fill(Vec3::repeat(f64::NAN)));
        self.start.fill(Vec3::repeat(f64::NAN));
        self.force.fill(Vec3::repeat(f64::NAN));
        self.moved.fill([f64::NAN; 4]);
        self.gradient.fill([f64::NAN; 4]);
        self.push.fill(f64::NAN);
        self.relief.fill(f64::NAN);
        self.momentum.poison();
        self.sweeps = u32::MAX;
    }
}
