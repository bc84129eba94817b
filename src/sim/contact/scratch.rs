//! Scratch of the contacts.

use super::inherit::Inherited;
use super::laws::LawScratch;
use super::mobility::Mobility;
use super::momentum::Momentum;
use super::rows::{Pull, Row};
use super::scene::{ContactScene, Surfaces};
use super::tractions::ContactTractions;
use super::vectors::V4;
use super::volumes::{InModes, VolumeRow};
use crate::Vec3;
use crate::contact::{Contacts, Detector, Stride};
use crate::sim::model::Model;
use crate::sim::state::{KindState, State};

/// Forces of contacts on all atoms while these move freely, pN, in the order of cells; empty where there are none.
#[derive(Debug, Clone, Default)]
pub struct ContactForces {
    /// What contacts carry where the step begins.
    pub carried: Vec<Vec3>,
    /// What the law of contact does in the stage that is being made.
    pub live: Vec<Vec3>,
}

/// How contacts are swept in an attempt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepRules {
    /// What sweeps may leave, over what contacts allow.
    pub tolerance_factor: f64,
    /// Whether what is inside is pushed out.
    pub mends: bool,
    /// Whether contacts return no more than they took.
    pub in_account: bool,
}

/// Scratch of the contacts; arrays over all atoms stand in the order of cells.
#[derive(Debug, Clone, Default)]
pub struct ContactScratch {
    /// The surfaces of the cells that there are.
    surfaces: Option<Surfaces>,
    /// Pairs that are near.
    pub detector: Detector,
    /// What touches: under adhesives where the step ended, once it has, and else where it began.
    pub found: Contacts,
    /// Whether this was found where the step ended.
    pub(super) has_looked: bool,
    /// Positions where that is, µm. Under laws that do not need them the projection takes their memory for `before`.
    pub start: Vec<Vec3>,
    /// Forces on all atoms. The projection takes the memory of those carried for its direction.
    pub forces: ContactForces,
    /// What cells do to what they touch in the attempt; empty where nobody asks.
    pub tractions: ContactTractions,
    /// Displacements before the last sweep of the projection, µm, under laws whose projection needs `start`.
    pub(super) before: Vec<Vec3>,
    /// Gradients of the volumes that are kept, µm².
    pub(super) gradient: Vec<[f64; 3]>,
    /// What contacts of edges have taken over from others.
    pub(super) inherited: Inherited,
    /// What the law of contact found besides.
    pub law: LawScratch,
    /// Positions in the stage that is being made, µm; under laws with forces only.
    pub(super) positions: Vec<Vec3>,
    /// What the surface at each atom releases an area of contact, pN/µm.
    pub(super) relief: Vec<f64>,
    /// What each bond bears along the surface around each atom and what it faces, pN; empty where surfaces have no bonds.
    pub(super) shear: Vec<f64>,
    /// Contacts as the sweeps see them: atoms on facets, then edges on edges, then atoms on obstacles; where there are many, in the order in
    /// which they are swept.
    pub rows: Vec<Row>,
    /// Whether they stand in that order.
    pub(super) is_in_turns: bool,
    /// What each row carries.
    pub pulls: Vec<Pull>,
    /// Displacement of the atoms over the step, µm, and their displacement over force, µm/pN.
    pub(super) moved: Vec<V4>,
    /// How cells give way to contacts, and what their modes have moved.
    pub(super) mobility: Mobility,
    /// Volumes to keep.
    pub(super) volumes: Vec<VolumeRow>,
    /// What their gradients are in modes, where cells move by them.
    pub(super) volume_modes: Vec<InModes>,
    /// Atoms and axes that are held.
    pub(super) held: Vec<(u32, u32)>,
    /// Rows that are inside, and the pushes that mend them, pN.
    pub(super) deep: Vec<(u32, f64)>,
    pub(super) momentum: Momentum,
    /// How bodies move in the step.
    pub(super) strides: Vec<Stride>,
    /// Sweeps of the last projection.
    pub sweeps: u32,
}

impl ContactScratch {
    /// The contacts of the cells that there are; made again where these are others than last time. None in a model without contacts.
    pub(crate) fn scene<'a>(&mut self, model: &'a Model, cells: &[KindState]) -> Option<ContactScene<'a>> {
        let rules = model.contact.as_ref()?;
        if !self.surfaces.as_ref().is_some_and(|surfaces| surfaces.are_of(cells)) {
            self.forget();
            self.surfaces = Some(Surfaces::of(rules, cells));
        }
        self.surfaces.as_ref().map(|surfaces| surfaces.with(rules))
    }

    /// Makes what is kept from look to look that of the cells there are; says whether a model has contacts.
    pub(crate) fn suit(&mut self, model: &Model, state: &State) -> bool {
        self.scene(model, &state.kinds).is_some()
    }

    /// Notes what cells do to virtual adhesives in the attempt.
    pub(in crate::sim) fn note_adhesives(&mut self) {
        if let Some(noted) = self.tractions.counting(1.0) {
            self.law.adhesives.note(noted);
        }
    }

    /// Where the row of a contact stands, by the number of that contact.
    pub(in crate::sim) fn row_of(&self, number: usize) -> usize {
        if self.is_in_turns { self.mobility.turns.of_row(number) } else { number }
    }

    /// Forgets what was found, so that the next look finds it anew.
    pub fn forget(&mut self) {
        self.detector.forget();
        self.law.cohesion.forget();
        self.has_looked = false;
    }

    /// Writes NaN over all scratch numbers and forgets all pairs.
    pub fn poison(&mut self) {
        self.forget();
        self.surfaces = None;
        self.found.clear();
        self.rows.clear();
        self.pulls.clear();
        self.volumes.clear();
        self.volume_modes.clear();
        self.held.clear();
        self.law.poison();
        let forces = [&mut self.forces.carried, &mut self.forces.live];
        let vectors = [&mut self.start, &mut self.before, &mut self.positions].into_iter().chain(forces);
        vectors.for_each(|all| all.fill(Vec3::repeat(f64::NAN)));
        self.tractions.poison();
        self.gradient.fill([f64::NAN; 3]);
        self.moved.fill([f64::NAN; 4]);
        self.deep.clear();
        self.mobility.clear(false);
        self.mobility.columns.poison();
        self.relief.fill(f64::NAN);
        self.shear.clear();
        self.momentum.poison();
        self.strides.clear();
        self.sweeps = u32::MAX;
    }
}

/// Makes a list so long; what it has stays as it is. It grows as [`empty_for`] lets it.
pub(super) fn resize_for<T: Clone>(list: &mut Vec<T>, count: usize, item: T) {
    if list.capacity() < count {
        empty_for(list, count);
    }
    list.resize(count, item);
}

/// Empties a list that will have this many items. Where it must grow it takes a sixty-fourth more, where a `Vec` would double: rows
/// are much of the memory of a packed population.
pub(super) fn empty_for<T>(list: &mut Vec<T>, count: usize) {
    list.clear();
    if list.capacity() < count {
        list.reserve_exact(count + count / 64);
    }
}
