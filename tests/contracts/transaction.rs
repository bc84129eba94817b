//! A step is a transaction: where any of its stages fails, in a scene that has everything, every byte of the state is as it was; scratch
//! is scratch there, threads do not matter, and what ends a step well is written down.

use crate::everything::{after, everything};
use pseudopod::Vec3;
use pseudopod::equations::tree::Expr;
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::StepSize;
use pseudopod::sim::chemistry::{Control, Members, Target};
use pseudopod::sim::{Model, Obstacle, State, Trouble, Workspace, begin_chemistry, step};

fn bytes(state: &State) -> Vec<u8> {
    postcard::to_stdvec(state).unwrap()
}

/// Makes the steps of a model that is broken somewhere fail, and looks at the state.
fn fails(what: &str, model: &Model, state: &State, ws: &mut Workspace, is: impl Fn(&Trouble) -> bool) {
    let (mut tried, before) = (state.clone(), bytes(state));
    let trouble = step(model, &mut tried, ws).expect_err(what);
    assert!(is(&trouble), "{what}: {trouble:?}");
    assert!(bytes(&tried) == before, "{what}: the state is the one before the step, byte by byte");
    let again = step(model, &mut tried, ws).expect_err(what);
    // By their words: a number that is none is not equal to itself.
    assert_eq!(
        format!("{again:?}"),
        format!("{trouble:?}"),
        "{what}: nothing that is left of a failed step changes the next"
    );
    assert!(bytes(&tried) == before, "{what}: the second time");
}

/// Breaks a link of the model, found by its target, so that it carries a number.
fn carry(model: &mut Model, to: impl Fn(&Target) -> bool, number: f64) {
    let link = model.chemistry.links.iter_mut().find(|link| to(&link.to)).expect("such a link");
    (link.transfer, link.gain) = (Expr::Number(number), 1.0);
}

/// Thirty steps on, with a shape that K must be made for again in the next step.
fn scene(fixed: Option<&str>) -> (Model, State, Workspace) {
    let (model, start) = everything(fixed, "0.3 s");
    let (mut state, ws) = after(&model, start, 30);
    let ball = &mut state.kinds[1];
    ball.stiffness_shape = ball.positions.iter().map(|x| 0.5 * x).collect();
    assert!(
        !state.contact.atoms.is_empty() && !state.contact.obstacles.is_empty(),
        "cells touch each other and the floor"
    );
    assert!(state.contact.atoms.iter().any(|bond| bond.force != [0.0; 3]), "contacts carry forces");
    assert!(!state.ended_runs.is_empty(), "walks have turned");
    (model, state, ws)
}

/// Gives the first load of the first kind another force, pN.
fn load_with(model: &mut Model, force: f64) {
    let loads = model.kinds[0]
        .forces
        .iter_mut()
        .filter_map(|force| if let Force::Load(load) = force { Some(load) } else { None });
    loads.take(1).for_each(|load| load.force = Course::constant(force));
}

#[test]
fn a_step_that_succeeds_writes_every_part_of_the_state() {
    let (model, state, mut ws) = scene(None);
    let mut next = state.clone();
    while next.ended_runs.len() == state.ended_runs.len() {
        step(&model, &mut next, &mut ws).unwrap();
    }
    assert!(next.time > state.time && next.step > state.step);
    for (now, then) in next.kinds.iter().zip(&state.kinds) {
        assert_ne!(now.positions, then.positions);
        assert_ne!(now.mean_velocities, then.mean_velocities);
        assert_ne!(now.balance, then.balance);
    }
    assert_ne!(next.kinds[0].rest_volumes, state.kinds[0].rest_volumes, "links set them");
    assert_ne!(next.kinds[1].stiffness_shape, state.kinds[1].stiffness_shape, "K was made again");
    assert_ne!(next.kinds[0].behaviours, state.kinds[0].behaviours);
    assert_ne!(next.contact, state.contact);
    assert_ne!(next.chemistry.populations, state.chemistry.populations);
    assert_ne!(next.chemistry.times, state.chemistry.times);
    assert_ne!(next.chemistry.fields, state.chemistry.fields);
    assert_ne!(next.chemistry.controls, state.chemistry.controls);
    let events = |state: &State| postcard::to_stdvec(&state.chemistry.events).unwrap();
    assert!(events(&next) != events(&state) || next.chemistry.populations != state.chemistry.populations);
}

#[test]
fn a_stage_of_mechanics_that_fails_leaves_every_byte() {
    let (model, state, mut ws) = scene(None);
    let broken = |change: &dyn Fn(&mut Model)| {
        let mut model = model.clone();
        change(&mut model);
        model
    };
    // Before the first attempt: two cells too deep in each other.
    let mut deep = state.clone();
    deep.kinds[1].shift(&model.kinds[1], 0, &Vec3::new(-2.0, -2.0, 1.0));
    fails("depth", &model, &deep, &mut ws, |trouble| matches!(trouble, Trouble::Pressed { .. }));
    // Free motion.
    let pulled = broken(&|model| load_with(model, f64::NAN));
    fails("forces", &pulled, &state, &mut ws, |trouble| matches!(trouble, Trouble::NotFinite { .. }));
    // Contacts whose sweeps never come to rest.
    let restless = broken(&|model| {
        let contact = model.contact.as_mut().unwrap();
        (contact.tolerance, contact.most_sweeps) = (0.0, 3);
    });
    fails("sweeps", &restless, &state, &mut ws, |trouble| matches!(trouble, Trouble::Contact { .. }));
    // An error that no step makes small enough.
    let strict = broken(&|model| model.integrator.size = StepSize::Adaptive { tolerance: 0.0, largest: 0.1 });
    fails("error", &strict, &state, &mut ws, |trouble| matches!(trouble, Trouble::StepTooSmall { .. }));
    let (model, state, mut ws) = scene(Some("0.05 s"));
    // Exact volumes: cells between two planes that leave them none. A fixed step is not made shorter for that.
    let mut pressed = model.clone();
    let plane = |height: f64, up: f64| Obstacle::plane("press", Vec3::z() * height, Vec3::z() * up);
    pressed.obstacles = vec![plane(3.0, 1.0), plane(3.001, -1.0)];
    fails("volumes", &pressed, &state, &mut ws, |trouble| matches!(trouble, Trouble::Volume { .. }));
    // Atoms that go farther than contacts allow.
    let mut fast = model.clone();
    load_with(&mut fast, -4000.0);
    fails("travel", &fast, &state, &mut ws, |trouble| matches!(trouble, Trouble::TooFast { .. }));
    // Where the step ends: cells that are deeper in each other than a part of the least edge. No edge, no depth.
    let mut touchy = model.clone();
    touchy.kinds.iter_mut().for_each(|kind| kind.edge = 1e-12);
    let mut deepened = state.clone();
    let trouble = (0..200).find_map(|_| {
        let before = bytes(&deepened);
        let trouble = step(&touchy, &mut deepened, &mut ws).err()?;
        assert!(bytes(&deepened) == before, "the end: the state is the one before the step");
        Some(trouble)
    });
    assert!(matches!(trouble, Some(Trouble::Pressed { .. })), "{trouble:?}");
}

#[test]
fn a_stage_of_chemistry_that_fails_leaves_every_byte() {
    let (model, state, mut ws) = scene(None);
    // Systems.
    let mut blown = state.clone();
    let of_cells = model.chemistry.reactors.iter().position(|reactor| reactor.members != Members::Scene);
    blown.chemistry.populations[of_cells.expect("cells have systems")].set_state(1, 0, f64::NAN);
    fails("systems", &model, &blown, &mut ws, |trouble| matches!(trouble, Trouble::System { .. }));
    // Fields.
    let mut burst = state.clone();
    burst.chemistry.fields[0].values[17] = f64::NAN;
    fails("fields", &model, &burst, &mut ws, |trouble| matches!(trouble, Trouble::Field { .. }));
    // Links: the last one, when all others have been carried.
    let mut wrong = model.clone();
    wrong.chemistry.links.last_mut().unwrap().gain = f64::NAN;
    fails("links", &wrong, &state, &mut ws, |trouble| matches!(trouble, Trouble::Link { .. }));
    // The volume of a cell one of whose atoms is put far away.
    let mut torn = model.clone();
    carry(&mut torn, |to| matches!(to, Target::Cell(_, Control::Atom(..))), 1e300);
    // What membranes read of such a shape is no number either, and would be told first.
    let read = torn.chemistry.links.iter_mut().filter(|link| matches!(link.to, Target::Given { .. }));
    read.for_each(|link| link.transfer = Expr::Number(0.0));
    fails("imposed", &torn, &state, &mut ws, |trouble| matches!(trouble, Trouble::Volume { .. }));
}

#[test]
fn the_start_of_chemistry_is_a_transaction_too() {
    let (mut model, state) = everything(None, "0.3 s");
    let (before, mut ws) = (bytes(&state), Workspace::new(&model));
    let good = model.clone();
    model.chemistry.links.last_mut().unwrap().gain = f64::NAN;
    let mut tried = state.clone();
    assert!(matches!(begin_chemistry(&model, &mut tried, &mut ws), Err(Trouble::Link { .. })));
    assert!(bytes(&tried) == before);
    // The first step begins chemistry where that was not done, and leaves nothing of it behind when it fails later on.
    let mut pulled = good.clone();
    load_with(&mut pulled, f64::NAN);
    assert!(step(&pulled, &mut tried, &mut ws).is_err());
    assert!(bytes(&tried) == before);
    begin_chemistry(&good, &mut tried, &mut ws).unwrap();
    assert!(bytes(&tried) != before);
}

#[test]
fn a_failed_step_does_not_change_those_that_follow() {
    let (model, state, mut ws) = scene(None);
    let mut wrong = model.clone();
    wrong.chemistry.links.last_mut().unwrap().gain = f64::NAN;
    let (mut plain, mut tried, mut other) = (state.clone(), state, Workspace::new(&model));
    for _ in 0..5 {
        step(&model, &mut plain, &mut ws).unwrap();
        assert!(step(&wrong, &mut tried, &mut other).is_err());
        step(&model, &mut tried, &mut other).unwrap();
        assert!(bytes(&plain) == bytes(&tried));
    }
}

#[test]
fn scratch_is_scratch_and_threads_do_not_matter_where_there_is_everything() {
    let (model, start) = everything(None, "0.3 s");
    let run = |threads: usize, between: &(dyn Fn(&mut State, &mut Workspace) + Sync)| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut state, mut ws) = after(&model, start.clone(), 0);
            for _ in 0..30 {
                between(&mut state, &mut ws);
                step(&model, &mut state, &mut ws).unwrap();
            }
            bytes(&state)
        })
    };
    let plain = run(1, &|_, _| ());
    assert!(plain == run(2, &|_, _| ()), "threads");
    assert!(plain == run(1, &|_, ws| ws.poison(&model)), "scratch full of what is not a number");
    assert!(plain == run(1, &|_, ws| *ws = Workspace::new(&model)), "no scratch");
    let through_a_checkpoint = |state: &mut State, _: &mut Workspace| {
        *state = postcard::from_bytes(&bytes(state)).unwrap();
    };
    assert!(plain == run(1, &through_a_checkpoint), "checkpoints");
}
