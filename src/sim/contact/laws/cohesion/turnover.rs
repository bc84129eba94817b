//! Bonds of surfaces over a step: what each bears where it ends, and how many are closed there.

use super::closed::PatchBonds;
use super::facing::{Facing, number_of};
use super::patch::{Partner, Patch};
use super::table::CohesionTable;
use crate::Vec3;
use crate::contact::Scene;
use crate::sim::contact::state::{Faced, SurfaceBonds};

/// What bonds are to be turned over in a step.
#[derive(Clone, Copy)]
pub struct Turnover<'a> {
    /// How surfaces stick.
    pub table: &'a CohesionTable,
    /// All surfaces.
    pub scene: &'a Scene,
    /// Where atoms are where the step ends, µm.
    pub positions: &'a [Vec3],
    /// The step, s.
    pub dt: f64,
    /// Areas that are bound around atoms.
    pub facing: &'a [Facing],
    /// What each bond bears along the surface around these, pN; empty where no contacts resist sliding.
    pub shear: &'a [f64],
}

impl Turnover<'_> {
    /// Lets the bonds of these parts close and open in a step, eq. (adhesion.25), by what each bears where it ends.
    pub fn turn_over(&self, bonds: &mut [PatchBonds], patches: &[Patch]) {
        let Self { table, scene, positions, dt, .. } = *self;
        for (bonds, patch) in bonds.iter_mut().zip(patches) {
            let SurfaceBonds { facet, other, closed, .. } = bonds.before;
            let cohesive = table.of(scene, scene.body_of_facet(facet), other);
            let Some(kinetics) = cohesive.bonds else { continue };
            let across = cohesive.strength * patch.share_of_traction(scene, positions) / kinetics.density;
            bonds.after = kinetics.after(closed, across.hypot(self.shear_at(patch, other)), dt);
        }
    }

    /// Adds what that changes of the forces on atoms where the step ends, pN.
    pub fn add_change(&self, bonds: &[PatchBonds], patches: &[Patch], change: &mut [Vec3]) {
        for (bonds, patch) in bonds.iter().zip(patches) {
            let changes = bonds.after - bonds.before.closed;
            if changes == 0.0 {
                continue;
            }
            let patch = Patch { strength: changes * bonds.strength, ..*patch };
            let Some(pull) = patch.pull(self.scene, self.positions) else { continue };
            patch.own.iter().zip(pull.on_own).for_each(|(atom, force)| change[*atom as usize] += force);
            if let Partner::Facet(atoms, _) = patch.other {
                atoms.iter().zip(pull.on_other).for_each(|(atom, force)| change[*atom as usize] += force);
            }
        }
    }

    /// The shear that each bond of a part bears, pN: that of bonds around the atoms of its facet, by its weights.
    fn shear_at(&self, patch: &Patch, other: Faced) -> f64 {
        let around = |atom: u32| {
            let number = number_of(self.facing, atom, other);
            number.and_then(|number| self.shear.get(number)).copied().unwrap_or(0.0)
        };
        patch.own.iter().zip(patch.weights).map(|(atom, weight)| weight * around(*atom)).sum()
    }
}

impl PatchBonds {
    /// How many of a part are closed where the atoms are now.
    pub fn count(&self, table: &CohesionTable, scene: &Scene, patch: &Patch, now: &[Vec3]) -> f64 {
        let cohesive = table.of(scene, scene.body_of_facet(self.before.facet), self.before.other);
        // What a part bears says how many bonds it has, each bearing the same.
        let most = cohesive.bonds.map_or(0.0, |bonds| bonds.density) / cohesive.strength;
        most * patch.strength * patch.area_of_facet(now)
    }

    /// Those that there are where the step ends; none of surfaces without bonds.
    pub fn kept(&self, table: &CohesionTable, scene: &Scene) -> Option<SurfaceBonds> {
        let body = scene.body_of_facet(self.before.facet);
        let has_bonds = table.of(scene, body, self.before.other).bonds.is_some();
        has_bonds.then_some(SurfaceBonds { closed: self.after, ..self.before })
    }
}
