//! Whether contacts can be mended where a step begins, and whether cells have passed each other unnoticed.

use rayon::prelude::*;

use super::find::write_contacts;
use super::gather::gather_positions;
use super::laws::PROMISED;
use super::remember::find_at;
use super::scene::ContactScene;
use crate::Vec3;
use crate::contact::{Contacts, Sides, find_centre_inside, find_deeper, winding_number};
use crate::sim::model::Model;
use crate::sim::population_trouble::PopulationTrouble;
use crate::sim::state::State;
use crate::sim::trouble::Trouble;
use crate::sim::workspace::Workspace;

/// Contacts that a thread looks at at once, at least.
const CONTACTS_PER_JOB: usize = 2048;

/// How deep one surface may be inside another where a step begins, over the depth to which contacts are found. Beyond
/// it a step may lose the contact, and the two would pass each other.
const DEEPEST: f64 = 0.5;

/// Refuses to go on where cells are too deep in each other: they do not fit, and depths grow faster than they are
/// mended. Contacts must have been found for this step, and the state must still hold those of the step before.
///
/// # Errors
/// The two cells that are too deep in each other.
pub fn check_depth(model: &Model, state: &State, ws: &mut Workspace) -> Result<(), Trouble> {
    let Some(contact) = &ws.contact.scene(model, &state.kinds) else { return Ok(()) };
    let found = &ws.contact.found;
    let of_atoms = found.atoms.par_iter().with_min_len(CONTACTS_PER_JOB);
    let of_atoms = of_atoms.map(|near| (near.gap, near.atom, near.body(&contact.scene)));
    let of_edges = found.edges.par_iter().with_min_len(CONTACTS_PER_JOB).map(|near| {
        let [own, other] = near.bodies(&contact.scene);
        (near.gap, contact.scene.bodies[own as usize].first_atom, other)
    });
    let deepest = of_atoms.chain(of_edges).min_by(|one, other| one.0.total_cmp(&other.0));
    let most = contact.reach.depth;
    let too_deep = deepest.filter(|(gap, ..)| -gap > DEEPEST * most).map(|(gap, atom, body)| (-gap, atom, body));
    let lost = || lost_inside(contact, state, ws).map(|(atom, body)| (most, atom, body));
    let Some((depth, atom, body)) = too_deep.or_else(lost) else { return Ok(()) };
    Err(pressed(model, state, [contact.body_of(atom), body], depth))
}

/// The trouble of two bodies that are so deep in each other, µm.
fn pressed(model: &Model, state: &State, bodies: [u32; 2], depth: f64) -> Trouble {
    let (time, cells) = (state.time, bodies.map(|body| state.kind_of(body as usize)));
    let cells = cells.map(|(kind, cell)| (model.kinds[kind].name.clone(), cell));
    Trouble::Pressed { cells, time, depth }
}

/// The depth from which on a step is made shorter where it deepens, over the shorter mean edge of the two cells: half of what is
/// promised.
const DEEP: f64 = 0.01;

/// What a depth may grow by in such a step, over what it was: a tenth, so that steps are not halved for what the next one mends.
const GROWS: f64 = 1.1;

/// Two cells that are deep in each other after a step, and deeper than any were before it: something met within the step that no
/// contact at its begin told of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deepened {
    deepest: Deepest,
}

impl Deepened {
    /// Whether they are deeper in each other than is promised.
    pub fn breaks_promise(&self) -> bool {
        self.deepest.share > PROMISED
    }

    /// The trouble that this is where no step is short enough.
    pub fn trouble(&self, model: &Model, from: &State) -> Trouble {
        pressed(model, from, self.deepest.bodies, self.deepest.depth)
    }
}

/// Finds what touches where a step ends, and says whether cells are deep in each other there. The next step begins with what is
/// found, and with what contacts carry now, which is written before.
pub fn look_for_depth(model: &Model, from: &State, to: &mut State, ws: &mut Workspace) -> Option<Deepened> {
    let s = &mut ws.contact;
    let contact = &s.scene(model, &from.kinds).filter(|contact| contact.law.promises_depth())?;
    let before = Deepest::of(model, contact, &s.found);
    write_contacts(contact, &from.chemistry.controls, &mut to.contact, s);
    gather_positions(model, contact, &to.kinds, &mut s.start);
    find_at(contact, &to.contact, &s.start, &mut s.detector, &mut s.found);
    s.has_looked = true;
    let deepest = Deepest::of(model, contact, &s.found)?;
    let before = before.map_or(0.0, |before| before.share);
    // Below what is promised a depth may creep on; beyond it, it may not.
    let grows = deepest.share > if deepest.share > PROMISED { before } else { GROWS * before };
    (deepest.share > DEEP && grows).then_some(Deepened { deepest })
}

/// The deepest contact.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Deepest {
    /// Depth over the shorter mean edge of the two cells.
    share: f64,
    /// Depth, µm.
    depth: f64,
    /// The two cells; twice the same on an obstacle.
    bodies: [u32; 2],
}

impl Deepest {
    /// That of all contacts; none where nothing is inside.
    fn of(model: &Model, contact: &ContactScene, found: &Contacts) -> Option<Self> {
        let edge = |body: u32| model.kinds[contact.kind_of(body)].edge;
        let of_atoms = found.atoms.par_iter().with_min_len(CONTACTS_PER_JOB).filter(|near| near.gap < 0.0);
        let of_atoms = of_atoms.map(|near| (near.gap, [contact.body_of(near.atom), near.body(&contact.scene)]));
        let of_edges = found.edges.par_iter().with_min_len(CONTACTS_PER_JOB).filter(|near| near.gap < 0.0);
        let of_edges = of_edges.map(|near| (near.gap, near.bodies(&contact.scene)));
        let of_obstacles = found.obstacles.par_iter().with_min_len(CONTACTS_PER_JOB).filter(|near| near.gap < 0.0);
        let of_obstacles = of_obstacles.map(|near| (near.gap, [contact.body_of(near.atom); 2]));
        let all = of_atoms.chain(of_edges).chain(of_obstacles).map(|(gap, bodies)| {
            let [one, other] = bodies.map(edge);
            Self { share: -gap / one.min(other), depth: -gap, bodies }
        });
        all.max_by(|one, other| one.share.total_cmp(&other.share))
    }
}

/// An atom that touched a body in the step before, and is now so deep in it that no contact is found, with the body.
fn lost_inside(contact: &ContactScene, state: &State, ws: &Workspace) -> Option<(u32, u32)> {
    let (found, scene) = (&ws.contact.found.atoms, &contact.scene);
    let is_found = |atom: u32, body: u32| {
        let at = found.partition_point(|near| near.atom < atom);
        found[at..].iter().take_while(|near| near.atom == atom).any(|near| near.body(scene) == body)
    };
    let is_inside = |atom: u32, body: u32| {
        let (shape, first) = (scene.shape(body), scene.bodies[body as usize].first_atom as usize);
        let own = (first..first + shape.atoms).contains(&(atom as usize));
        let closed = shape.closed && shape.sides == Sides::Outer;
        let there = &ws.contact.start[first..first + shape.atoms];
        closed && !own && winding_number(ws.contact.start[atom as usize], there, &shape.facets) > 0.5
    };
    let touched = state.contact.atoms.par_iter().with_min_len(CONTACTS_PER_JOB);
    let touched = touched.map(|bond| (bond.atom, bond.body(scene)));
    touched.find_first(|&(atom, body)| !is_found(atom, body) && is_inside(atom, body))
}

/// Refuses a state in which cells are deeper in each other than is promised. Contacts look at what is near; where cells are crushed
/// beyond what they can resolve, as in a box that is too small, surfaces may slip through each other where no
/// contact sees it. This looks at all atoms and edges, slowly: for the instants that are recorded. Where depths are not promised, as
/// under penalties, they may be as deep as contacts are found.
///
/// # Errors
/// The first two cells that are inside each other.
pub fn check_passed(model: &Model, state: &State) -> Result<(), Trouble> {
    let Some(contact) = &model.contact.as_ref().map(|contact| contact.scene_of(&state.kinds)) else { return Ok(()) };
    let scene = &contact.scene;
    let mut positions = Vec::new();
    gather_positions(model, contact, &state.kinds, &mut positions);
    let edge = |body: u32| model.kinds[contact.kind_of(body)].edge;
    let most = |one: u32, other: u32| contact.law.most_depth(edge(one).min(edge(other)), scene.reach.depth);
    let passed = find_deeper(scene, &positions, most);
    passed.map_or(Ok(()), |(body, other, depth)| Err(pressed(model, state, [body, other], depth)))
}

/// Refuses cells that were just added behind the others of their kind where they overlap others, or are behind obstacles.
///
/// # Errors
/// The first that is where it cannot be.
pub fn check_added(model: &Model, state: &State, kind: usize, added: usize) -> Result<(), PopulationTrouble> {
    let Some(contact) = &model.contact.as_ref().map(|contact| contact.scene_of(&state.kinds)) else { return Ok(()) };
    let name = |body: u32| {
        let (kind, cell) = state.kind_of(body as usize);
        (model.kinds[kind].name.clone(), state.kinds[kind].ids[cell])
    };
    let end = state.kinds[kind].numbers().end;
    let is_new = |body: u32| (end - added..end).contains(&(body as usize));
    let mut positions = Vec::new();
    gather_positions(model, contact, &state.kinds, &mut positions);
    let edge = |body: u32| model.kinds[contact.kind_of(body)].edge;
    let most = |one: u32, other: u32| match is_new(one) || is_new(other) {
        true => PROMISED * edge(one).min(edge(other)),
        false => f64::INFINITY,
    };
    if let Some((one, other, depth)) = find_deeper(&contact.scene, &positions, most) {
        return Err(PopulationTrouble::Overlap { cells: [name(one), name(other)], depth });
    }
    // One exactly in the place of another, or in its middle, has no atom near its surface.
    let new = (end - added) as u32..end as u32;
    if let Some([inner, outer]) = find_centre_inside(&contact.scene, &positions, new.clone()) {
        let atoms = |body: u32| {
            let first = contact.scene.bodies[body as usize].first_atom as usize;
            &positions[first..first + contact.scene.shape(body).atoms]
        };
        let centre = atoms(inner).iter().sum::<Vec3>() / atoms(inner).len() as f64;
        let depth = atoms(outer).iter().map(|x| (x - centre).norm()).fold(f64::INFINITY, f64::min);
        return Err(PopulationTrouble::Overlap { cells: [name(inner), name(outer)], depth });
    }
    for body in new {
        let first = contact.scene.bodies[body as usize].first_atom as usize;
        let atoms = &positions[first..first + contact.scene.shape(body).atoms];
        for obstacle in &model.obstacles {
            let height = |x: &Vec3| obstacle.surface.gap(x);
            let depth = -atoms.iter().map(height).fold(f64::INFINITY, f64::min);
            if depth > contact.reach.safe_travel() {
                return Err(PopulationTrouble::BehindObstacle {
                    cell: name(body),
                    obstacle: obstacle.name.clone(),
                    depth,
                });
            }
        }
    }
    Ok(())
}
