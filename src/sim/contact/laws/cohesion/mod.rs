//! The cohesive law of surfaces: what an area of contact bears and what it costs to open, whatever the meshes. Each point of a surface
//! is drawn to the other by a traction against how far open the space between them is there, eq. (adhesion.17), at most the strength σ and
//! nothing from the range 2W/σ on, so that opening an area takes the work of separation W.

mod acting;
mod area;
#[cfg(test)]
mod area_tests;
mod attracted;
mod bonds;
mod bounds;
mod candidates;
mod closed;
mod facet;
mod facing;
mod pairs;
mod patch;
mod points;
mod search;
mod slope;
#[cfg(test)]
mod slope_tests;
mod surroundings;
mod table;
#[cfg(test)]
mod tests;
mod turnover;

use rayon::prelude::*;

use self::acting::Acting;
pub use self::area::AreaScratch;
pub use self::bonds::{BondKinetics, Pathway};
pub use self::closed::Earlier;
use self::closed::PatchBonds;
pub use self::facing::{Faced, Facing, area_between, number_of};
use self::patch::Patch;
use self::search::{Around, Seen, UNKNOWN};
use self::slope::Slope;
use self::surroundings::Surroundings;
pub use self::table::{CohesionTable, Cohesive};
use self::turnover::Turnover;
use crate::Vec3;
use crate::contact::Scene;
use crate::sim::contact::state::SurfaceBonds;
use crate::sim::contact::tractions::ContactTractions;
use crate::sim::controls::Controls;

/// What the law finds where a step begins.
#[derive(Debug, Clone, Default)]
pub struct CohesionScratch {
    around: Surroundings,
    /// Those of each batch of bodies.
    patches: Vec<Vec<Patch>>,
    /// What each batch looks at, and which facets attracted each of its points when it looked last.
    looks: Vec<(Around, Vec<u32>)>,
    /// Areas in contact around the atoms of each batch.
    of_batches: Vec<Vec<Facing>>,
    /// Those of all, in the order of atoms.
    pub(in crate::sim::contact) facing: Vec<Facing>,
    /// Bonds of the parts of each batch, one for each; none where no surfaces have bonds.
    bonds: Vec<Vec<PatchBonds>>,
    /// What their turnover changes of the forces on atoms, pN.
    change: Vec<Vec3>,
    /// What parts of some batches do.
    acting: Acting,
    /// How what they do changes as they move; where the step answers that, one for each part.
    slopes: Vec<Vec<Option<Slope>>>,
}

impl CohesionScratch {
    /// Forgets what was near, so that the next look finds it anew.
    pub fn forget(&mut self) {
        self.looks.clear();
        self.around.near.forget();
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.forget();
        self.patches.clear();
        self.facing.clear();
        self.bonds.clear();
        self.change.clear();
        self.slopes.clear();
    }

    /// Lets bonds close and open in a step that ends at these positions, eq. (adhesion.25); `shear` is what each bears along the surface, pN,
    /// as `facing`. Returns what that changes of the forces on atoms there, pN.
    pub(in crate::sim::contact) fn turn_over(
        &mut self,
        table: &CohesionTable,
        (scene, positions): (&Scene, &[Vec3]),
        (dt, shear): (f64, &[f64]),
    ) -> &[Vec3] {
        let Self { patches, facing, bonds, change, .. } = self;
        let turnover = Turnover { table, scene, positions, dt, facing, shear };
        bonds.par_iter_mut().zip(&*patches).for_each(|(bonds, patches)| turnover.turn_over(bonds, patches));
        change.clear();
        change.resize(scene.atoms, Vec3::zeros());
        bonds.iter().zip(&*patches).for_each(|(bonds, patches)| turnover.add_change(bonds, patches, change));
        change
    }

    /// Writes the bonds that there are where a step ends.
    pub(super) fn keep_bonds(&self, table: &CohesionTable, scene: &Scene, kept: &mut Vec<SurfaceBonds>) {
        kept.extend(self.bonds.iter().flatten().filter_map(|bonds| bonds.kept(table, scene)));
    }
}

impl CohesionTable {
    /// Finds which parts of surfaces attract each other at these positions, by those of their bonds that were closed before.
    pub fn find(
        &self,
        scene: &Scene,
        controls: &Controls,
        before: Earlier,
        positions: &[Vec3],
        to: &mut CohesionScratch,
    ) {
        let range = self.range();
        if range == 0.0 {
            return to.clear();
        }
        to.around.find(scene, positions, range, true);
        let CohesionScratch {
            around: Surroundings { near, facets, nearer, .. },
            patches,
            looks,
            of_batches,
            facing,
            bonds,
            ..
        } = to;
        let seen = Seen { table: self, scene, controls, positions, facets, nearer, range };
        patches.resize_with(scene.batches(), Vec::new);
        looks.resize_with(scene.batches(), Default::default);
        of_batches.resize_with(scene.batches(), Vec::new);
        bonds.resize_with(scene.batches(), Vec::new);
        let has_bonds = self.has_bonds();
        let batches = patches.par_iter_mut().zip(looks.par_iter_mut()).zip(of_batches.par_iter_mut());
        batches.zip(bonds.par_iter_mut()).enumerate().for_each(
            |(batch, (((patches, (around, known)), facing), bonds))| {
                patches.clear();
                bonds.clear();
                known.resize(scene.bodies_of(batch).map(|body| self.points_of(scene, body)).sum(), UNKNOWN);
                let mut known = &mut known[..];
                let mut before = before.from_body(scene, scene.bodies_of(batch).start);
                scene.bodies_of(batch).for_each(|body| {
                    let (of_body, rest) = std::mem::take(&mut known).split_at_mut(self.points_of(scene, body));
                    known = rest;
                    seen.find(body, near.of_body(scene, body), of_body, around, |spot, mut patch| {
                        if has_bonds {
                            bonds.push(before.bind(self, scene, (body, spot), &mut patch));
                        }
                        patches.push(patch);
                    });
                });
                facing.clear();
                if self.resists {
                    Facing::add((patches, bonds), scene, positions, facing);
                }
            },
        );
        facing.clear();
        of_batches.iter().for_each(|of_batch| facing.extend_from_slice(of_batch));
    }

    /// Adds the forces of what attracts each other where the atoms are now, and notes them.
    pub(super) fn add_forces(
        &self,
        scene: &Scene,
        found: &mut CohesionScratch,
        now: &[Vec3],
        force: &mut [Vec3],
        noted: Option<&mut ContactTractions>,
    ) {
        let CohesionScratch { patches, acting, .. } = found;
        acting::add_forces(scene, patches, acting, |_, _, patch| patch.pull(scene, now), force, noted);
    }

    /// Finds how what all parts do changes as they move from where the atoms are now.
    pub(super) fn find_slopes(scene: &Scene, found: &mut CohesionScratch, now: &[Vec3]) {
        let CohesionScratch { patches, slopes, .. } = found;
        slopes.resize_with(patches.len(), Vec::new);
        slopes.par_iter_mut().zip(&*patches).for_each(|(slopes, patches)| {
            slopes.clear();
            slopes.extend(patches.iter().map(|patch| patch.slope(scene, now)));
        });
    }

    /// Adds what parts do, beyond what they do where the atoms were, where these are moved so (µm), so many times, and notes it.
    pub(super) fn answer(
        scene: &Scene,
        found: &mut CohesionScratch,
        (times, moved): (f64, &[Vec3]),
        force: &mut [Vec3],
        noted: Option<&mut ContactTractions>,
    ) {
        let CohesionScratch { patches, acting, slopes, .. } = found;
        let answer = |batch: usize, number: usize, patch: &Patch| {
            slopes[batch][number].as_ref().map(|slope| slope.answer(patch, times, moved))
        };
        acting::add_forces(scene, patches, acting, answer, force, noted);
    }

    /// How many bonds are closed of what was found, where the atoms are now.
    pub fn closed_bonds(&self, scene: &Scene, found: &CohesionScratch, now: &[Vec3]) -> f64 {
        let parts = found.bonds.iter().flatten().zip(found.patches.iter().flatten());
        parts.map(|(bonds, patch)| bonds.count(self, scene, patch, now)).sum()
    }

    /// The energy of what was found, where the atoms are now, pN·µm.
    pub fn energy(&self, scene: &Scene, found: &CohesionScratch, now: &[Vec3]) -> f64 {
        found.patches.iter().flatten().filter_map(|patch| patch.pull(scene, now)).map(|pull| pull.energy).sum()
    }
}
