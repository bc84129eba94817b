//! Contacts in the step: cells do not pass each other, stick with a strength, and keep their volumes meanwhile.
//!
//! Contacts are found where the step begins. What they carried in the last step acts as a force while the cells move
//! freely; then a projection finds what is missing, by projected Gauss–Seidel over all contacts and all volumes in a fixed
//! order, eq. (adhesion.3). At rest nothing is missing, and the force is the true one, whatever the step.
//!
//! Three other models are there to compare with: springs that link facets in place of strengths, penalties in place of the
//! projection, whose forces are those of where the atoms are in each stage of a step, and zones of contact that are rigid.

mod assemble;
mod cause;
mod change;
mod columns;
mod compliance;
mod depth;
mod find;
mod gather;
mod hold;
mod inherit;
mod laws;
mod mobility;
mod model;
mod momentum;
mod prepare;
mod remember;
mod renumber;
mod respond;
#[cfg(test)]
mod respond_tests;
mod rounds;
mod rows;
mod rub;
mod scene;
mod scratch;
mod settle;
mod spread;
mod state;
mod steep;
mod sweep;
#[cfg(test)]
mod sweep_tests;
mod together;
mod touch;
mod tractions;
mod turnover;
mod turns;
mod vectors;
mod volumes;

pub use cause::help_at;
pub use compliance::energy_of_compliance;
pub use depth::{Deepened, check_added, check_depth, check_passed, look_for_depth};
pub use find::{
    add_contact_forces, carry_forces, energy_of_law, find_contacts, has_live_forces, keep_contacts, locate_contacts,
    pull_contacts,
};
pub use hold::{hold_contacts, travel};
pub use laws::{
    AdhesiveScratch, AdhesiveTable, AreaScratch, BondKinetics, CohesionScratch, CohesionTable, Cohesive, Earlier, Law,
    LinkScratch, LinkTable, Pathway, Penalty, Strength, Touching, Zones,
};
pub use model::{AREA_WITHIN, ContactModel};
pub use rows::{Pairing, Pull, Row};
pub use scene::ContactScene;
pub use scratch::{ContactForces, ContactScratch, SweepRules};
pub use settle::settle_adhesives;
pub use state::{AdhesiveAtom, AtomBond, ContactState, EdgeBond, Faced, Link, Numbered, ObstacleBond, SurfaceBonds};
pub use steep::{answer, are_steep, find_slopes, take_answer};
pub use touch::near_cell;
pub use tractions::ContactTractions;
pub use turnover::turn_over_bonds;
