//! Cells come and go between steps. Each change is a transaction: it is made in a copy of the state, which becomes the state when all
//! is good.

use super::chemistry::begin_membranes;
use super::contact::check_added;
use super::elasticity::gather_elasticity;
use super::kind::Kind;
use super::model::{Change, Model, Removal};
use super::population_trouble::PopulationTrouble;
use super::protrude::release_rears;
use super::seeding::seed;
use super::state::{NewCell, State};
use super::workspace::Workspace;
use crate::Vec3;
use crate::random::{Purpose, Stream};

/// Adds cells to a kind, behind those that it has; returns their ids. What is not known of them is as at the start of a run: rest
/// volumes, behaviours, systems; what links set of them changes nothing until the links have been carried.
///
/// # Errors
/// Cells that cannot be added, or that overlap others in a model with contacts; the state is as it was.
pub fn add_cells(
    model: &Model,
    state: &mut State,
    ws: &mut Workspace,
    kind: usize,
    cells: &[NewCell],
) -> Result<Vec<u64>, PopulationTrouble> {
    check_new(model, state, kind, cells)?;
    let mut next = state.clone();
    let bodies = (0..state.cells()).map(|cell| if state.kind_of(cell).0 > kind { cell + cells.len() } else { cell });
    let bodies: Vec<Option<u32>> = bodies.map(|cell| Some(cell as u32)).collect();
    let ids: Vec<u64> = (0..cells.len() as u64).map(|count| state.next_id + count).collect();
    let mut counts = state.counts();
    for (cell, &id) in cells.iter().zip(&ids) {
        next.kinds[kind].push(model, &model.kinds[kind], id, cell);
        next.chemistry.insert_cell(model, &counts, (kind, counts[kind]), id);
        counts[kind] += 1;
    }
    next.next_id += cells.len() as u64;
    settle(model, state, &mut next, &bodies);
    check_added(model, &next, kind, cells.len())?;
    ws.chemistry.suit(model, &next);
    begin_membranes(model, &mut next, &mut ws.chemistry.membranes);
    commit(state, next, ws);
    Ok(ids)
}

/// Removes the cells with these ids. Their bonds go with them; the cells that stay keep their order.
///
/// # Errors
/// [`PopulationTrouble::NoSuchCell`] with the first that is not there; the state is as it was.
pub fn remove_cells(
    model: &Model,
    state: &mut State,
    ws: &mut Workspace,
    ids: &[u64],
) -> Result<(), PopulationTrouble> {
    let mut goes: Vec<Vec<bool>> = state.kinds.iter().map(|now| vec![false; now.cells()]).collect();
    for &id in ids {
        let (kind, cell) = state.find(id).ok_or(PopulationTrouble::NoSuchCell { id })?;
        goes[kind][cell] = true;
    }
    let mut next = state.clone();
    let counts = state.counts();
    let mut left = 0;
    let bodies = goes.iter().flatten().map(|goes| {
        left += u32::from(!goes);
        (!goes).then(|| left - 1)
    });
    let bodies: Vec<Option<u32>> = bodies.collect();
    for ((kind, now), goes) in model.kinds.iter().zip(&mut next.kinds).zip(&goes) {
        if goes.contains(&true) {
            now.retain(kind, |cell| !goes[cell]);
        }
    }
    next.chemistry.retain_cells(model, &counts, |kind, cell| !goes[kind][cell]);
    settle(model, state, &mut next, &bodies);
    commit(state, next, ws);
    Ok(())
}

/// Makes the changes of the model's population whose time has come; returns how many. Between steps a program that steps calls this.
///
/// # Errors
/// As [`add_cells`]; changes before the one that fails have been made.
pub fn apply_due_changes(model: &Model, state: &mut State, ws: &mut Workspace) -> Result<usize, PopulationTrouble> {
    let mut made = 0;
    while let Some(due) = model.changes.get(state.changes).filter(|due| due.time <= state.time + model.clock_slack()) {
        match &due.change {
            Change::Add(centres) => add_at(model, state, ws, due.kind, centres)?,
            Change::Seed(number, corners) => {
                let centres = seed(model, state, due.kind, *number, *corners)?;
                add_at(model, state, ws, due.kind, &centres)?;
            }
            Change::Remove(removal) => {
                let ids = removed(model, state, due.kind, *removal)?;
                remove_cells(model, state, ws, &ids)?;
            }
        }
        state.changes += 1;
        made += 1;
    }
    Ok(made)
}

/// Adds cells at rest around these centres, µm.
fn add_at(
    model: &Model,
    state: &mut State,
    ws: &mut Workspace,
    kind: usize,
    centres: &[Vec3],
) -> Result<(), PopulationTrouble> {
    let of = model.kinds.get(kind).ok_or_else(|| no_such_kind(model, kind))?;
    let cells: Vec<NewCell> = centres.iter().map(|centre| at_rest(of, centre)).collect();
    add_cells(model, state, ws, kind, &cells).map(|_| ())
}

/// A cell at rest around a centre.
fn at_rest(kind: &Kind, centre: &Vec3) -> NewCell {
    NewCell { positions: kind.rest.positions.iter().map(|x| x + centre).collect(), parent: None }
}

/// The ids of the cells that a removal takes.
fn removed(model: &Model, state: &State, kind: usize, removal: Removal) -> Result<Vec<u64>, PopulationTrouble> {
    let ids = &state.kinds.get(kind).ok_or_else(|| no_such_kind(model, kind))?.ids;
    let number = match removal {
        Removal::All => ids.len(),
        Removal::Share(share) => (share * ids.len() as f64).round() as usize,
        Removal::Number(number) => number.min(ids.len()),
    };
    let draw = |id: u64| Stream::new(model.seed, Purpose::Removal, id as u32, state.changes as u64).uniform_pair()[0];
    let mut drawn: Vec<(f64, u64)> = ids.iter().map(|&id| (draw(id), id)).collect();
    drawn.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
    Ok(drawn.into_iter().take(number).map(|(_, id)| id).collect())
}

fn no_such_kind(model: &Model, kind: usize) -> PopulationTrouble {
    PopulationTrouble::NoSuchKind { kind, kinds: model.kinds.len() }
}

/// Looks at what is known of cells that come.
fn check_new(model: &Model, state: &State, number: usize, cells: &[NewCell]) -> Result<(), PopulationTrouble> {
    let kind = model.kinds.get(number).ok_or_else(|| no_such_kind(model, number))?;
    for (cell, new) in cells.iter().enumerate() {
        let (found, expected) = (new.positions.len(), kind.atoms());
        if found != expected {
            return Err(PopulationTrouble::Atoms { kind: kind.name.clone(), cell, found, expected });
        }
        if !new.positions.iter().flatten().all(|x| x.is_finite()) {
            return Err(PopulationTrouble::NotFinite { kind: kind.name.clone(), cell });
        }
        if let Some(id) = new.parent.filter(|id| *id >= state.next_id) {
            return Err(PopulationTrouble::NoSuchCell { id });
        }
    }
    Ok(())
}

/// Counts the cells that there are now, and takes over what contacts carried; `bodies` are the numbers that those before have now.
fn settle(model: &Model, before: &State, next: &mut State, bodies: &[Option<u32>]) {
    next.number_cells(model);
    release_rears(model, next);
    gather_elasticity(model, next);
    if let Some(contact) = &model.contact {
        let [old, new] = [&before.kinds, &next.kinds].map(|cells| contact.scene_of(cells));
        next.contact = before.contact.renumbered(&old, &new, bodies);
    }
}

/// The change is good: it is made.
fn commit(state: &mut State, next: State, ws: &mut Workspace) {
    *state = next;
    // What was found was found of other cells.
    ws.contact.forget();
}
