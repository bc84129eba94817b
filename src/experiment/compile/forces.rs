//! All forces on a type of cells, in the order in which they are added up.

use super::super::CellType;
use super::super::scene::Environment;
use super::builder::Builder;
use super::numbers::vector;
use crate::mechanics::Force;
use crate::mechanics::gravity::Gravity;

/// Adds the forces on a type.
pub fn add_forces(cell: &CellType, environment: &Environment, to: &mut Builder) {
    cell.mechanics.add_elastic(to);
    cell.applied.add_links(to);
    // As strong as what it guards.
    if cell.mechanics.rigid.is_none() {
        cell.mechanics.barrier.add(to);
    }
    cell.applied.add_driven(to);
    let gravity = environment.gravity.map_or([0.0; 3], |g| g.map(|a| a.value()));
    if gravity != [0.0; 3] {
        to.forces.push(Force::Gravity(Gravity { acceleration: vector(gravity) }));
    }
    to.forces.extend(cell.motility.attraction.as_ref().map(|attraction| attraction.force()));
}
