//! Cells come and go between steps: what stays goes on as if nothing else had been there, and nothing is known of what is gone.

use crate::everything::{after, everything};
use pseudopod::Vec3;
use pseudopod::cell::Behaviour;
use pseudopod::cell::motility::{BrownianMotility, Space};
use pseudopod::geometry::{self, Surface, Topology, icosphere};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::sim::{
    Change, Kind, Model, NewCell, PopulationChange, PopulationTrouble, Removal, State, VolumeRule, Workspace,
    add_cells, apply_due_changes, remove_cells, step,
};

const STEP: StepSize = StepSize::Fixed(0.05);

fn bytes(state: &State) -> Vec<u8> {
    postcard::to_stdvec(state).unwrap()
}

/// A cell at rest around a centre.
fn at(model: &Model, kind: usize, centre: [f64; 3]) -> NewCell {
    let centre = Vec3::from(centre);
    NewCell { positions: model.kinds[kind].rest.positions.iter().map(|x| x + centre).collect(), parent: None }
}

/// Positions of the atoms of the cell with an id.
fn cell(model: &Model, state: &State, id: u64) -> Vec<Vec3> {
    let (kind, cell) = state.find(id).expect("the cell is there");
    state.kinds[kind].cell(&model.kinds[kind], cell)
}

/// Steps some times, and looks after each that all volumes are exact.
fn run(model: &Model, state: &mut State, ws: &mut Workspace, steps: usize) {
    for _ in 0..steps {
        step(model, state, ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        for (kind, now) in model.kinds.iter().zip(&state.kinds) {
            for number in 0..now.cells() {
                let surface = Surface { positions: now.cell(kind, number), facets: kind.rest.facets.clone() };
                let error = geometry::volume(&surface) / now.rest_volumes[number] - 1.0;
                let exact = matches!(kind.volume, VolumeRule::Exact(_));
                assert!(!exact || error.abs() < 1e-10, "cell {number} of `{}`: {error:e}", kind.name);
            }
        }
    }
}

/// The scene that has everything, begun, with fixed steps.
fn begun() -> (Model, State, Workspace) {
    let (model, start) = everything(Some("0.05 s"), "0.3 s");
    let (state, ws) = after(&model, start, 0);
    (model, state, ws)
}

#[test]
fn ids_are_given_once_and_kinds_may_have_no_cells() {
    let (model, mut state, mut ws) = begun();
    assert_eq!((&state.kinds[0].ids[..], &state.kinds[1].ids[..], state.next_id), (&[0, 1, 2][..], &[3][..], 4));
    run(&model, &mut state, &mut ws, 3);
    let far = [at(&model, 0, [60.0, 0.0, 5.02]), at(&model, 0, [60.0, 15.0, 5.02])];
    assert_eq!(add_cells(&model, &mut state, &mut ws, 0, &far), Ok(vec![4, 5]));
    assert_eq!(state.kinds[0].ids, [0, 1, 2, 4, 5]);
    assert_eq!((state.kinds[1].first_cell, state.kinds[1].first_atom), (5, 210));
    run(&model, &mut state, &mut ws, 3);
    remove_cells(&model, &mut state, &mut ws, &[5, 3, 1]).unwrap();
    assert_eq!((&state.kinds[0].ids[..], state.kinds[1].cells()), (&[0, 2, 4][..], 0));
    run(&model, &mut state, &mut ws, 3);
    let child = NewCell { parent: Some(4), ..at(&model, 0, [60.0, 30.0, 5.02]) };
    assert_eq!(add_cells(&model, &mut state, &mut ws, 0, &[child]), Ok(vec![6]), "5 is never given again");
    assert_eq!(state.kinds[0].parents, [None, None, None, Some(4)]);
    assert_eq!(add_cells(&model, &mut state, &mut ws, 1, &[at(&model, 1, [-40.0, 9.0, 4.02])]), Ok(vec![7]));
    run(&model, &mut state, &mut ws, 3);
    remove_cells(&model, &mut state, &mut ws, &[0, 2, 4, 6, 7]).unwrap();
    assert_eq!((state.cells(), state.next_id), (0, 8));
    assert!(state.kinds[0].behaviours.iter().all(Vec::is_empty) && state.contact == Default::default());
    run(&model, &mut state, &mut ws, 3);
    add_cells(&model, &mut state, &mut ws, 0, &[at(&model, 0, [0.0, 0.0, 5.02])]).unwrap();
    run(&model, &mut state, &mut ws, 3);
    assert_eq!(state.kinds[0].ids, [8]);
}

#[test]
fn what_cannot_come_or_go_is_refused_and_leaves_every_byte() {
    let (model, mut state, mut ws) = begun();
    run(&model, &mut state, &mut ws, 3);
    let before = bytes(&state);
    let mut refused = |kind: usize, cells: &[NewCell]| {
        let trouble = add_cells(&model, &mut state, &mut ws, kind, cells).expect_err("refused");
        assert!(bytes(&state) == before);
        trouble
    };
    let good = at(&model, 0, [60.0, 0.0, 5.02]);
    let inside = refused(0, &[good.clone(), at(&model, 0, [1.0, 0.0, 5.5])]);
    let PopulationTrouble::Overlap { cells: [one, other], depth } = &inside else { panic!("{inside}") };
    let mut names = [(one.0.as_str(), one.1), (other.0.as_str(), other.1)];
    names.sort_unstable();
    assert_eq!(names, [("walker", 0), ("walker", 5)]);
    assert!(*depth > 0.9 && inside.to_string().contains("cell 5 of type `walker`"), "{inside}");
    let twice = refused(0, &[good.clone(), good.clone()]);
    assert!(matches!(twice, PopulationTrouble::Overlap { .. }), "two that come at the same place: {twice}");
    let below = refused(1, &[at(&model, 1, [60.0, 0.0, 0.0])]);
    assert!(matches!(&below, PopulationTrouble::BehindObstacle { cell: (_, 4), .. }), "{below}");
    assert_eq!(refused(7, std::slice::from_ref(&good)), PopulationTrouble::NoSuchKind { kind: 7, kinds: 2 });
    let orphan = NewCell { parent: Some(4), ..good.clone() };
    assert_eq!(refused(0, &[orphan]), PopulationTrouble::NoSuchCell { id: 4 });
    let short = NewCell { positions: vec![Vec3::zeros()], parent: None };
    assert!(matches!(refused(0, &[short]), PopulationTrouble::Atoms { found: 1, expected: 42, .. }));
    let mut nowhere = good;
    nowhere.positions[3].y = f64::NAN;
    assert!(matches!(refused(0, &[nowhere]), PopulationTrouble::NotFinite { cell: 0, .. }));
    assert_eq!(remove_cells(&model, &mut state, &mut ws, &[0, 9]), Err(PopulationTrouble::NoSuchCell { id: 9 }));
    assert!(bytes(&state) == before);
}

#[test]
fn a_cell_that_came_and_went_leaves_the_others_as_if_it_had_never_been() {
    // Far away, so that nothing joins it with the others but the number of sweeps, which needs contacts.
    let (mut model, mut plain, mut ws) = begun();
    model.contact = None;
    model.chemistry = Default::default();
    plain.chemistry = State::new(&model, &[vec![Vec::new(); 3], vec![Vec::new(); 1]]).chemistry;
    let (mut other, mut scratch) = (plain.clone(), Workspace::new(&model));
    let far = [at(&model, 0, [500.0, 0.0, 5.02]), at(&model, 0, [500.0, 30.0, 5.02])];
    let ids = add_cells(&model, &mut other, &mut scratch, 0, &far).unwrap();
    run(&model, &mut plain, &mut ws, 10);
    run(&model, &mut other, &mut scratch, 10);
    assert!(cell(&model, &other, ids[1])[0].x > 400.0);
    remove_cells(&model, &mut other, &mut scratch, &ids).unwrap();
    run(&model, &mut plain, &mut ws, 10);
    run(&model, &mut other, &mut scratch, 10);
    for id in 0..4 {
        assert_eq!(cell(&model, &plain, id), cell(&model, &other, id), "cell {id}");
    }
    assert_eq!(plain.kinds[0].behaviours, other.kinds[0].behaviours, "walks are drawn by ids");
    assert!(other.ended_runs.iter().any(|run| ids.contains(&run.0)), "and those of cells that are gone are told");
}

#[test]
fn contacts_of_the_cells_that_stay_go_on() {
    let (model, mut state, mut ws) = begun();
    let name = |state: &State, atom: u32| -> (u64, u32) {
        let kind = state.kinds.iter().rposition(|now| now.first_atom <= atom as usize).unwrap();
        let (now, atoms) = (&state.kinds[kind], model.kinds[kind].atoms() as u32);
        let own = atom - now.first_atom as u32;
        (now.ids[(own / atoms) as usize], own % atoms)
    };
    // Each bond by the ids of its cells, with what it carries.
    let bonds = |state: &State| -> Vec<((u64, u32), [f32; 3])> {
        let planes = state.contact.obstacles.iter().map(|bond| (name(state, bond.atom), bond.force));
        state.contact.atoms.iter().map(|bond| (name(state, bond.atom), bond.force)).chain(planes).collect()
    };
    let scene = |state: &State| model.contact.as_ref().unwrap().scene_of(&state.kinds).scene;
    let other = |state: &State| -> Vec<u64> {
        let body = |facet: u32| scene(state).body_of_facet(facet) as usize;
        let id = |body: usize| state.kind_of(body);
        let ids = state.contact.atoms.iter().map(|bond| id(body(bond.facet)));
        ids.map(|(kind, cell)| state.kinds[kind].ids[cell]).collect()
    };
    // Until the second cell, which goes, touches another, and so do two that stay.
    let touch = |state: &State, goes: bool| {
        let pairs = bonds(state).into_iter().zip(other(state));
        pairs.into_iter().any(|((one, _), other)| [one.0, other].contains(&1) == goes)
    };
    for _ in 0..200 {
        run(&model, &mut state, &mut ws, 1);
        if touch(&state, true) && touch(&state, false) {
            break;
        }
    }
    assert!(touch(&state, true) && touch(&state, false), "both kinds of contacts");
    let (before, touched) = (bonds(&state), other(&state));
    remove_cells(&model, &mut state, &mut ws, &[1]).unwrap();
    let (atoms, planes) = before.split_at(touched.len());
    let stays =
        atoms.iter().zip(&touched).filter(|((one, _), other)| one.0 != 1 && **other != 1).map(|(bond, _)| *bond);
    let expected: Vec<_> = stays.chain(planes.iter().copied().filter(|((one, _), _)| *one != 1)).collect();
    assert_eq!(bonds(&state), expected, "bonds of cells that stay, and no others");
    assert!(expected.iter().any(|(_, force)| *force != [0.0; 3]));
    // One comes before the ball in the order of cells, so that all numbers of the ball rise.
    add_cells(&model, &mut state, &mut ws, 0, &[at(&model, 0, [60.0, 0.0, 5.02])]).unwrap();
    assert_eq!(bonds(&state), expected);
    let touching = state.contact.atoms.len();
    run(&model, &mut state, &mut ws, 5);
    assert!(state.contact.atoms.len() > touching / 2, "they still touch: {} of {touching}", state.contact.atoms.len());
}

/// Steps, additions and removals, with something done between them.
fn course(threads: usize, between: impl Fn(&mut State, &mut Workspace) + Sync) -> Vec<u8> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let (model, start) = everything(None, "0.3 s");
        let (mut state, mut ws) = after(&model, start, 0);
        for round in 0..24u32 {
            between(&mut state, &mut ws);
            match round {
                4 => drop(add_cells(&model, &mut state, &mut ws, 0, &[at(&model, 0, [-10.3, 0.0, 5.02])]).unwrap()),
                8 => remove_cells(&model, &mut state, &mut ws, &[0]).unwrap(),
                12 => drop(add_cells(&model, &mut state, &mut ws, 1, &[at(&model, 1, [30.0, 0.0, 4.02])]).unwrap()),
                16 => remove_cells(&model, &mut state, &mut ws, &[3]).unwrap(),
                _ => {}
            }
            between(&mut state, &mut ws);
            step(&model, &mut state, &mut ws).unwrap();
        }
        bytes(&state)
    })
}

#[test]
fn a_course_with_cells_that_come_and_go_is_the_same_for_any_threads_scratch_and_checkpoints() {
    let plain = course(1, |_, _| ());
    assert!(plain == course(2, |_, _| ()), "threads");
    assert!(plain == course(1, |state, _| *state = postcard::from_bytes(&bytes(state)).unwrap()), "checkpoints");
    let (model, _) = everything(None, "0.3 s");
    assert!(plain == course(1, |_, ws| *ws = Workspace::new(&model)), "no scratch");
    assert!(plain == course(1, |_, ws| ws.poison(&model)), "scratch of what is not a number");
}

#[test]
fn lanes_are_filled_and_emptied_in_any_order() {
    let surface = icosphere(5.0, 1);
    let rings: Vec<Vec<u32>> = Topology::of(&surface).rings.into_iter().map(|ring| ring.atoms).collect();
    let memory = ShapeMemory::new(&surface.positions, &rings, 10.0, Reaction::Exact);
    for (lanes, cells) in [(8, 20), (1, 2)] {
        let mut kind = Kind::new("cell", surface.clone(), vec![Force::ShapeMemory(memory.clone())]).for_cells(cells);
        assert_eq!(kind.lanes, lanes);
        kind.bound_stiffness();
        let walk = BrownianMotility { speed: 0.5, persistence: 2.0, space: Space::Volume };
        kind.behaviours = vec![Behaviour::Brownian(walk)];
        let integrator = Integrator { method: Method::Implicit { order: Order::Second }, size: STEP };
        let model = Model::of(vec![kind], integrator, 1e9);
        let atoms_of = |count: usize| -> Vec<Vec<Vec3>> {
            (0..count).map(|n| at(&model, 0, [20.0 * n as f64, 0.0, 0.0]).positions).collect()
        };
        let (mut all, mut ws) = (State::new(&model, &[atoms_of(20)]), Workspace::new(&model));
        let (mut some, mut other) = (State::new(&model, &[atoms_of(3)]), Workspace::new(&model));
        let rest: Vec<NewCell> = (3..20).map(|n| at(&model, 0, [20.0 * f64::from(n), 0.0, 0.0])).collect();
        add_cells(&model, &mut some, &mut other, 0, &rest[..9]).unwrap();
        add_cells(&model, &mut some, &mut other, 0, &rest[9..]).unwrap();
        assert_eq!(all, some, "cells that come before the first step are those that were there");
        let gone = [7, 0, 19, 8, 15, 16];
        for round in 0..6 {
            step(&model, &mut all, &mut ws).unwrap();
            step(&model, &mut some, &mut other).unwrap();
            remove_cells(&model, &mut some, &mut other, &[gone[round]]).unwrap();
        }
        assert_eq!(some.kinds[0].positions.len(), 14usize.div_ceil(lanes) * model.kinds[0].block_len());
        for &id in &some.kinds[0].ids {
            assert_eq!(cell(&model, &some, id), cell(&model, &all, id), "{lanes} lanes, cell {id}");
        }
        assert_eq!(some.kinds[0].ids.len(), 14);
    }
}

#[test]
fn changes_of_the_model_are_made_at_their_times_and_draw_by_ids() {
    let (mut model, mut state, mut ws) = begun();
    model.changes = vec![
        PopulationChange { time: 0.12, kind: 0, change: Change::Add(vec![Vec3::new(60.0, 0.0, 5.02); 1]) },
        PopulationChange { time: 0.12, kind: 0, change: Change::Remove(Removal::Share(0.5)) },
        PopulationChange { time: 0.33, kind: 0, change: Change::Remove(Removal::Number(1)) },
        PopulationChange { time: 0.4, kind: 1, change: Change::Remove(Removal::All) },
    ];
    let mut met = Vec::new();
    while state.time < 0.5 {
        step(&model, &mut state, &mut ws).unwrap();
        let made = apply_due_changes(&model, &mut state, &mut ws).unwrap();
        if made > 0 {
            met.push((state.time, made, state.kinds[0].ids.clone(), state.kinds[1].cells()));
        }
    }
    let rows: Vec<(f64, usize, usize, usize)> =
        met.iter().map(|(time, made, ids, balls)| (*time, *made, ids.len(), *balls)).collect();
    assert_eq!(rows, [(0.12, 2, 2, 1), (0.33, 1, 1, 1), (0.4, 1, 1, 0)], "steps end where cells come and go");
    assert!(met[1].2.iter().all(|id| met[0].2.contains(id)));
    assert_eq!((state.changes, state.next_id), (4, 5));
    // Who is drawn depends on ids alone: the same in a run in which the last cell is not there.
    let drawn = |seed: u64, cells: u64| -> Vec<u64> {
        let mut model = model.clone();
        (model.seed, model.contact) = (seed, None);
        model.changes = vec![PopulationChange { time: 0.0, kind: 0, change: Change::Remove(Removal::Number(2)) }];
        let mut state = everything(Some("0.05 s"), "0.3 s").1;
        let more: Vec<NewCell> = (4..cells).map(|n| at(&model, 0, [60.0 * n as f64, 0.0, 5.02])).collect();
        let mut ws = Workspace::new(&model);
        add_cells(&model, &mut state, &mut ws, 0, &more).unwrap();
        apply_due_changes(&model, &mut state, &mut ws).unwrap();
        (0..cells).filter(|id| *id != 3 && state.find(*id).is_none()).collect()
    };
    assert_eq!(drawn(1, 12), drawn(1, 12));
    assert!((2..12).any(|seed| drawn(seed, 12) != drawn(1, 12)), "seeds draw others");
}
