//! The one list of laws of contact: what surfaces do that touch. A law is a file that says what it finds where a step begins, what
//! force it adds while atoms move freely, how it takes part in the projection, what it keeps for the next step, and which series it
//! records; the step and the records ask the list.

mod adhesives;
mod cohesion;
mod links;
mod penalty;
mod virtual_adhesives;

pub(super) use adhesives::PROMISED;
pub use adhesives::Strength;
pub use cohesion::{
    AreaScratch, BondKinetics, CohesionScratch, CohesionTable, Cohesive, Earlier, Faced, Facing, Pathway, area_between,
    number_of,
};
pub use links::{LinkScratch, LinkTable};
pub use penalty::Penalty;
pub use virtual_adhesives::{AdhesiveScratch, AdhesiveTable, Zones};

use super::rows::Row;
use super::state::ContactState;
use super::tractions::ContactTractions;
use super::vectors::V4;
use crate::Vec3;
use crate::contact::{Contacts, Scene};
use crate::recorded::Recorded;
use crate::sim::controls::Controls;
use crate::sim::kind::Kind;

/// What surfaces do that touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Law {
    /// Contacts bear any push, and a pull and a shear, [`Strength`].
    #[default]
    Adhesives,
    /// Contacts bear any push and a shear; surfaces attract each other.
    Cohesion(CohesionTable),
    /// Contacts bear any push; springs hold the atoms of facets that collided.
    Links(LinkTable),
    /// Contacts push by their depth, and pull within the proximity.
    Penalty(Penalty),
    /// Contacts bear any push; atoms that touch move in rigid zones.
    VirtualAdhesives(AdhesiveTable),
}

/// What laws find of a step besides its contacts; empty under laws that find nothing.
#[derive(Debug, Clone, Default)]
pub struct LawScratch {
    /// Parts of surfaces that attract each other.
    pub cohesion: CohesionScratch,
    /// Links.
    pub links: LinkScratch,
    /// Virtual adhesives.
    pub adhesives: AdhesiveScratch,
}

/// Who touches whom at an instant, and where all atoms are.
#[derive(Debug, Clone, Copy)]
pub struct Touching<'a> {
    /// The surfaces of the cells that there are.
    pub scene: &'a Scene,
    /// Factors of the strengths of cells.
    pub controls: &'a Controls,
    /// What touches.
    pub found: &'a Contacts,
    /// Positions of all atoms, µm.
    pub positions: &'a [Vec3],
}

impl Law {
    /// Finds what the law needs besides contacts where a step begins at `time` (s): what there was `before`, and what comes of what
    /// touches now.
    pub(super) fn find(
        &self,
        kinds: &[Kind],
        now: Touching,
        before: &ContactState,
        time: f64,
        scratch: &mut LawScratch,
    ) {
        let Touching { scene, controls, found, positions } = now;
        match self {
            Self::Adhesives | Self::Penalty(_) => scratch.clear(),
            Self::Cohesion(table) => {
                let before = Earlier { bonds: &before.bonds, time };
                table.find(scene, controls, before, positions, &mut scratch.cohesion);
            }
            Self::Links(table) => table.find(scene, controls, &before.links, found, positions, &mut scratch.links),
            Self::VirtualAdhesives(table) => {
                scratch.adhesives.find(table, scene, kinds, controls, before, found, positions, time);
            }
        }
    }

    /// Whether the law adds forces that change while a step is made, [`Law::add_forces`].
    pub fn has_forces(&self) -> bool {
        match self {
            Self::Adhesives | Self::VirtualAdhesives(_) => false,
            Self::Cohesion(table) => table.range() > 0.0,
            Self::Links(_) | Self::Penalty(_) => true,
        }
    }

    /// Adds the forces of the law where the atoms are now, of contacts and links found where they were at `start`, and notes what of them
    /// cells do to what they touch.
    pub(super) fn add_forces(
        &self,
        scene: &Scene,
        controls: &Controls,
        (rows, found): (&[Row], &mut LawScratch),
        (start, now): (&[Vec3], &[Vec3]),
        force: &mut [Vec3],
        mut noted: Option<&mut ContactTractions>,
    ) {
        match self {
            Self::Adhesives | Self::VirtualAdhesives(_) => {}
            Self::Cohesion(table) => table.add_forces(scene, &mut found.cohesion, now, force, noted),
            Self::Links(table) => {
                table.act(scene, controls, &found.links.links, now, |atom, pull| {
                    force[atom as usize] += pull;
                    noted.iter_mut().for_each(|noted| noted.by_cell(atom, pull));
                });
            }
            Self::Penalty(penalty) => {
                penalty.act(rows, (start, now), force, |row, push| {
                    noted.iter_mut().for_each(|noted| noted.by_row(scene, row, push));
                });
            }
        }
    }

    /// The most that a pull of the law on an area grows with an opening, over 2, pN/µm³; 0 under laws whose forces the implicit step does not
    /// answer.
    pub(super) fn steepest(&self) -> f64 {
        match self {
            Self::Cohesion(table) => table.steepest(),
            Self::Adhesives | Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => 0.0,
        }
    }

    /// Finds how what the law does changes as the atoms move from where they are now.
    pub(super) fn find_slopes(&self, scene: &Scene, found: &mut LawScratch, now: &[Vec3]) {
        match self {
            Self::Cohesion(_) => CohesionTable::find_slopes(scene, &mut found.cohesion, now),
            Self::Adhesives | Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => {}
        }
    }

    /// Adds what the law does, beyond what it does where slopes were found, where atoms are moved so (µm), so many times; notes what of it
    /// cells do to what they touch.
    pub(super) fn answer(
        &self,
        scene: &Scene,
        found: &mut LawScratch,
        moved: (f64, &[Vec3]),
        force: &mut [Vec3],
        noted: Option<&mut ContactTractions>,
    ) {
        match self {
            Self::Cohesion(_) => CohesionTable::answer(scene, &mut found.cohesion, moved, force, noted),
            Self::Adhesives | Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => {}
        }
    }

    /// The energy of what the law found at the start of a step where the atoms are now, pN·µm; that of laws that are passive and have
    /// forces.
    pub(super) fn energy(&self, scene: &Scene, found: &LawScratch, now: &[Vec3]) -> f64 {
        match self {
            Self::Cohesion(table) => table.energy(scene, &found.cohesion, now),
            Self::Adhesives | Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => 0.0,
        }
    }

    /// Whether contacts keep surfaces apart by the projection.
    pub fn projects(&self) -> bool {
        match self {
            Self::Adhesives | Self::Cohesion(_) | Self::Links(_) | Self::VirtualAdhesives(_) => true,
            Self::Penalty(_) => false,
        }
    }

    /// Whether what the projection moves gives way as in a step, eq. (adhesion.16); else atoms move by their drag alone.
    pub fn moves_as_steps(&self) -> bool {
        match self {
            Self::Adhesives | Self::Cohesion(_) | Self::Links(_) => true,
            Self::Penalty(_) | Self::VirtualAdhesives(_) => false,
        }
    }

    /// Whether the law needs the positions where the step began after the sweeps; otherwise these may take their memory.
    pub(super) fn needs_start(&self) -> bool {
        match self {
            Self::Adhesives => false,
            Self::Cohesion(table) => table.range() > 0.0,
            Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => true,
        }
    }

    /// The depth to which surfaces may be inside each other at recorded instants, µm: what is promised for cells of this mean edge
    /// (µm), or, where nothing is promised, how deep contacts are found.
    pub(super) fn most_depth(&self, edge: f64, found_to: f64) -> f64 {
        match self {
            Self::Adhesives | Self::Cohesion(_) => PROMISED * edge,
            Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => found_to,
        }
    }

    /// Whether the law promises a depth, so that a step is looked at where it ends.
    pub(super) fn promises_depth(&self) -> bool {
        match self {
            Self::Adhesives | Self::Cohesion(_) => true,
            Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => false,
        }
    }

    /// Whether contacts never return more energy than they took, so that cells on which nothing else acts must not gain any.
    pub fn is_passive(&self) -> bool {
        match self {
            Self::Adhesives | Self::Cohesion(_) => true,
            Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => false,
        }
    }

    /// Keeps what the law found for the next step; `moved` has displacement over force of all atoms as its fourth number.
    pub(super) fn keep(
        &self,
        scene: &Scene,
        controls: &Controls,
        found: &Contacts,
        moved: &[V4],
        scratch: &mut LawScratch,
        kept: &mut ContactState,
    ) {
        kept.links.clear();
        kept.released.clear();
        kept.adhesives.clear();
        kept.bonds.clear();
        match self {
            Self::Adhesives | Self::Penalty(_) => {}
            Self::Cohesion(table) => scratch.cohesion.keep_bonds(table, scene, &mut kept.bonds),
            Self::Links(_) => kept.links.clone_from(&scratch.links.links),
            Self::VirtualAdhesives(table) => scratch.adhesives.keep(table, scene, controls, found, moved, kept),
        }
    }

    /// Which series a run records besides those of all contacts.
    pub fn series(&self) -> Recorded {
        match self {
            Self::Cohesion(table) if table.has_bonds() => Recorded::WithBonds,
            Self::Adhesives | Self::Cohesion(_) | Self::Penalty(_) => Recorded::Always,
            Self::Links(_) => Recorded::WithLinks,
            Self::VirtualAdhesives(_) => Recorded::WithAdhesives,
        }
    }

    /// The table of the cohesive law; none under other laws.
    pub fn cohesion(&self) -> Option<&CohesionTable> {
        match self {
            Self::Cohesion(table) => Some(table),
            Self::Adhesives | Self::Links(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => None,
        }
    }

    /// Finds the links at an instant, from those before; none under other laws.
    pub fn links_at<'a>(
        &self,
        now: Touching,
        before: &ContactState,
        scratch: &'a mut LinkScratch,
    ) -> Option<&'a LinkScratch> {
        match self {
            Self::Adhesives | Self::Cohesion(_) | Self::Penalty(_) | Self::VirtualAdhesives(_) => None,
            Self::Links(table) => {
                table.find(now.scene, now.controls, &before.links, now.found, now.positions, scratch);
                Some(scratch)
            }
        }
    }
}

impl LawScratch {
    fn clear(&mut self) {
        self.cohesion.clear();
        self.links.clear();
        self.adhesives.clear();
    }

    /// Forgets everything.
    pub(super) fn poison(&mut self) {
        self.cohesion.clear();
        self.links.clear();
        self.adhesives.poison();
    }
}
