//! Whether a state is one of a model: as many numbers of everything as the model asks for.

use super::error::SimulationError;
use crate::cell::{Behaviour, BehaviourState};
use crate::geometry::Topology;
use crate::sim::chemistry::{ChemistryState, FieldState};
use crate::sim::contact::Numbered;
use crate::sim::controls::Controls;
use crate::sim::{Model, State};

/// Checks that all arrays of a state have the lengths that a model asks for.
///
/// # Errors
/// [`SimulationError::Mismatch`] with the first that has not.
pub fn check_fits(model: &Model, state: &State) -> Result<(), SimulationError> {
    let mismatch = |what: String| Err(SimulationError::Mismatch(what));
    if state.kinds.len() != model.kinds.len() {
        return mismatch(format!("it has {} types of cells, not {}", state.kinds.len(), model.kinds.len()));
    }
    // Runs begin at 0; where a clock is far below that it stands still, and frames would be due before the step.
    if !(0.0..f64::INFINITY).contains(&state.time) {
        return mismatch(format!("its time is {} s", state.time));
    }
    let inertial = model.integrator.method.is_inertial();
    let (mut first_cell, mut first_atom) = (0, 0);
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        let (count, blocks) = (now.cells(), now.blocks(kind));
        let (positions, padded) = (blocks * kind.block_len(), blocks * kind.lanes);
        let fits = now.positions.len() == positions
            && now.velocities.len() == if inertial { positions } else { 0 }
            && now.rest_volumes.len() == padded
            && (now.stiffness_shape.is_empty() || now.stiffness_shape.len() == 3 * kind.atoms())
            && now.mean_velocities.len() == count
            && [0, count * kind.atoms()].contains(&now.balance.len())
            && now.dissipated.len() == if kind.viscosity.is_some() { count } else { 0 }
            && now.fibres.fits(kind, count)
            && now.parents.len() == count
            && now.ids.is_sorted_by(|one, other| one < other)
            && now.ids.last().is_none_or(|id| *id < state.next_id)
            && (now.first_cell, now.first_atom) == (first_cell, first_atom);
        (first_cell, first_atom) = (first_cell + count, first_atom + count * kind.atoms());
        if !fits {
            return mismatch(format!("the cells of type `{}` are others, or of another number", kind.name));
        }
        let own = |(behaviour, states): (&Behaviour, &Vec<BehaviourState>)| {
            states.len() == count && states.iter().all(|state| behaviour.owns(state))
        };
        if now.behaviours.len() != kind.behaviours.len() || !kind.behaviours.iter().zip(&now.behaviours).all(own) {
            return mismatch(format!("the cells of type `{}` do something else by themselves", kind.name));
        }
        if !now.behaviours.iter().flatten().all(BehaviourState::can_go_on) {
            return mismatch(format!("what the cells of type `{}` wait for is over", kind.name));
        }
    }
    if !state.contact.fits(numbered(model, state)) {
        return mismatch("its contacts are those of other cells".to_owned());
    }
    let fields = model.chemistry.fields.iter().map(|field| FieldState {
        values: vec![0.0; field.system.species().len() * field.system.grid().len()].into(),
        inputs: vec![0.0; field.system.inputs().len()],
        ..FieldState::default()
    });
    let fresh = ChemistryState { fields: fields.collect(), ..ChemistryState::new(model, &state.counts(), &[]) };
    if !fresh.has_shape_of(&state.chemistry) {
        return mismatch("its systems or fields are others".to_owned());
    }
    check_controls(model, state, &state.chemistry.controls)
}

/// How many there are of what contacts name by its number.
fn numbered(model: &Model, state: &State) -> Numbered {
    let all = |of_kind: &dyn Fn(usize) -> usize| {
        state.counts().iter().enumerate().map(|(kind, cells)| cells * of_kind(kind)).sum()
    };
    // The edges of a mesh are counted only where some touch.
    let edges_of = |kind: usize| Topology::of(&model.kinds[kind].rest).edges.len();
    Numbered {
        bodies: state.cells(),
        atoms: state.atoms(model),
        facets: all(&|kind| model.kinds[kind].rest.facets.len()),
        edges: if state.contact.edges.is_empty() { 0 } else { all(&edges_of) },
        obstacles: model.obstacles.len(),
    }
}

/// A list of controls is empty or has one number a cell, and what is secreted is known.
fn check_controls(model: &Model, state: &State, controls: &Controls) -> Result<(), SimulationError> {
    let Controls {
        speed,
        bias,
        stiffness,
        adhesion,
        adhesion_of_atoms,
        elasticity_of_atoms,
        of_atoms,
        pseudopods,
        forces,
        secretion,
        secreted,
        atom_forces,
    } = controls;
    let fields = &model.chemistry.fields;
    let is_known = |&(field, species): &(usize, usize)| {
        fields.get(field).is_some_and(|field| species < field.system.species().len())
    };
    if !secreted.iter().all(is_known) || secretion.len() != model.chemistry.secreted.len() + secreted.len() {
        return Err(SimulationError::Mismatch("its cells secrete something else".to_owned()));
    }
    let (cells, atoms) = (state.cells(), state.atoms(model));
    if ![0, atoms].contains(&adhesion_of_atoms.len()) {
        let length = adhesion_of_atoms.len();
        return Err(SimulationError::Mismatch(format!("adhesion is set of {length} atoms, not {atoms}")));
    }
    if ![0, atoms].contains(&elasticity_of_atoms.len()) {
        let length = elasticity_of_atoms.len();
        return Err(SimulationError::Mismatch(format!("elasticity is set of {length} atoms, not {atoms}")));
    }
    if ![0, atoms].contains(&atom_forces.len()) {
        let length = atom_forces.len();
        return Err(SimulationError::Mismatch(format!("forces are set of {length} atoms, not {atoms}")));
    }
    let numbers = |kind: usize| state.kinds[kind].cells() * model.kinds[kind].atoms();
    let kinds = model.kinds.len();
    if ![0, kinds].contains(&of_atoms.len()) || !of_atoms.iter().enumerate().all(|(kind, own)| own.fits(numbers(kind)))
    {
        return Err(SimulationError::Mismatch("something is set of atoms of other cells".to_owned()));
    }
    let lists = [speed, stiffness, adhesion].into_iter().chain(forces.iter().flatten()).chain(secretion);
    match lists.map(Vec::len).chain([bias.len(), pseudopods.len()]).find(|length| ![0, cells].contains(length)) {
        None => Ok(()),
        Some(length) => Err(SimulationError::Mismatch(format!("something is set of {length} cells, not {cells}"))),
    }
}
