//! What the door of the library promises: the same course whoever looks, saves, restores or lends threads; troubles that have
//! names; cells that do what a program sets.

use crate::turns::take_turn;
use pseudopod::cell::BehaviourState;
use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, ResumeOptions, RunOptions, run};
use pseudopod::sim::contact::ObstacleBond;
use pseudopod::sim::{AtomBalance, State};
use pseudopod::simulation::{Builder, CellId, CheckpointFault, EXAMPLE, NewCell, PopulationTrouble, SeriesScope};
use pseudopod::{CancelToken, Simulation, SimulationError};
use std::ops::ControlFlow;
use std::path::Path;

/// Cells that walk, touch, stick, feel fibres and loads, and have systems with events that are linked to fields and cells.
const EVERYTHING: &str = r#"
title = "Everything at once"
seed = 3
[run]
until = "20 s"
integrator = { max_step = "0.2 s" }
[contact]
strength = "0.1 pN/um^2"
[[planes]]
name = "floor"
point = ["0 um", "0 um", "-5.2 um"]
normal = [0, 0, 1]
[cells.walker]
number = 5
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { grid = [5, 1, 1], spacing = "10.3 um" }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
motility = { brownian = { speed = "20 um/min", persistence = "3 s" } }
pseudopods = { pressure = "5 Pa", fibres = { number = 3, stiffness = "0.3 pN/um" }, pause = "0.2 s", protrusion = "0.5 s", retraction = "0.4 s" }
chemistry = ["own"]
[cells.pulled]
number = 2
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["-6 um", "12 um", "0 um"], ["6 um", "12 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
loads = [{ name = "pull", cap = { direction = [0, 0, -1], number = 3 }, direction = [0, 0, -1], force = [["0 s", "0 pN"], ["7 s", "3 pN"]] }]
fibres = [{ name = "belt", pattern = "horizontal", stiffness = "0.5 pN/um" }]
[chemistry.medium]
document = "medium.eml"
[chemistry.own]
document = "own.eml"
"#;

const MEDIUM: &str = r#"<eml name="medium"><grid dimension="2" spacing="2.5" origin="-40 -40" size="80 80"/>
    <field id="food" diffusion="20" decay="0.05" initial="1 + 0.01*x"/><field id="waste" diffusion="10" initial="0"/></eml>"#;

const OWN: &str = r#"<eml name="own"><input id="seen" default="0"/><variable id="U" initial="0" rate="seen"/>
    <variable id="turns" initial="0" rate="0"/>
    <event id="full" when="U gt 1"><set id="U">0</set><set id="turns">turns+1</set></event>
    <define id="soft">1 - 0.3*U</define>
    <link from="field[food]" to="system.seen"/><link from="system.soft" to="cell.stiffness"/></eml>"#;

fn builder() -> Builder {
    Simulation::builder().equations("medium.eml", MEDIUM).equations("own.eml", OWN)
}

fn everything(threads: usize) -> Simulation {
    let made = builder().threads(threads).text("everything.toml", EVERYTHING);
    made.unwrap_or_else(|error| panic!("{error}"))
}

fn example() -> Simulation {
    Simulation::from_text("example", EXAMPLE).unwrap()
}

/// A simulation in which a program has set what it can.
fn driven(threads: usize) -> Simulation {
    let mut simulation = everything(threads);
    let cells: Vec<CellId> = simulation.cells().collect();
    for (cell, what, value) in SET {
        simulation.set(cells[cell], what, value).unwrap_or_else(|error| panic!("{what}: {error}"));
    }
    simulation.set_force(cells[4], [0.3, 0.0, 0.1]).unwrap();
    simulation
}

/// What a test makes a program set of the cells of [`everything`].
const SET: [(usize, &str, f64); 10] = [
    (0, "motility.speed", 0.5),
    (1, "adhesion", 0.5),
    (2, "secretion[waste]", 3.0),
    (5, "motility.bias.y", -0.3),
    (5, "fibre[belt]", 0.4),
    (0, "pseudopods.cue.x", 2.0),
    (1, "pseudopods.protrusion", 0.4),
    (6, "load[pull]", 2.0),
    (6, "stiffness", 1.5),
    (6, "rest_volume_ratio", 1.05),
];

/// Compares all bits: what nobody has set is NaN in some lists.
fn assert_same(one: &State, other: &State) {
    let same = postcard::to_stdvec(one).unwrap() == postcard::to_stdvec(other).unwrap();
    // The whole states would fill the screen.
    assert!(same, "states differ at {} and {} s, steps {} and {}", one.time, other.time, one.step, other.step);
}

#[test]
fn what_a_program_sets_is_state_and_the_model_is_as_it_was() {
    let mut simulation = everything(1);
    let (before, cells) = (format!("{:?}", simulation.model()), simulation.cells().collect::<Vec<_>>());
    for (cell, what, value) in SET {
        let state = postcard::to_stdvec(simulation.state()).unwrap();
        simulation.set(cells[cell], what, value).unwrap();
        assert!(postcard::to_stdvec(simulation.state()).unwrap() != state, "{what} is in the state");
        assert!(format!("{:?}", simulation.model()) == before, "{what} is not in the model");
    }
}

#[test]
fn a_restored_simulation_goes_on_to_the_same_bits_with_everything_in_the_scene() {
    let mut whole = driven(2);
    whole.run_until(2.0).unwrap();
    let cells: Vec<CellId> = whole.cells().collect();
    whole.add_cells("walker", &[NewCell::at([0.0, -30.0, 0.0]).born_from(cells[0])]).unwrap();
    whole.remove_cells(&cells[3..4]).unwrap();
    whole.run_until(4.0).unwrap();
    let saved = whole.checkpoint();
    whole.run_until(8.0).unwrap();
    assert!(whole.series("own.turns").unwrap()[..5].iter().any(|turns| *turns > 0.0), "events happened");
    assert!(whole.series("contact.count").unwrap()[0] > 0.0, "cells touch");
    assert!(
        whole.field("medium").unwrap().values("waste").unwrap().iter().any(|value| *value > 0.0),
        "it was secreted"
    );
    // Back in the same simulation, and on in another that nothing was set of.
    let (end, mut fresh) = (whole.state().clone(), everything(1));
    for simulation in [&mut whole, &mut fresh] {
        simulation.restore(&saved).unwrap();
        assert_eq!(simulation.time(), 4.0);
        simulation.run_until(8.0).unwrap();
        assert_same(simulation.state(), &end);
    }
}

#[test]
fn threads_and_looking_do_not_change_the_course() {
    let (mut one, mut two) = (driven(1), driven(2));
    two.keep(&["energy", "contact.area.walker.walker", "chemistry.own.U"], 0.0).unwrap();
    one.run_until(5.0).unwrap();
    let looked = two.run_with(5.0, |simulation, _| match simulation.series("velocity_x") {
        Ok(_) => ControlFlow::Continue(()),
        Err(error) => ControlFlow::Break(error.to_string()),
    });
    assert_eq!(looked.unwrap(), ControlFlow::Continue(()));
    assert_eq!(two.history().times().len() as u64, two.steps() + 1);
    assert_same(one.state(), two.state());
}

#[test]
fn a_recorded_run_goes_the_same_course_as_a_simulation() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let equations = [("medium.eml", MEDIUM), ("own.eml", OWN)].map(|(path, text)| (path.to_owned(), text.to_owned()));
    let sets = ["run.until=6 s".to_owned(), "output.every=0.7 s".to_owned()];
    let document = Document::parse_beside("test", EVERYTHING, Path::new("."), &sets, equations.into()).unwrap();
    let options = RunOptions { threads: Some(2), ..RunOptions::new(folder.path().join("run.h5")) };
    run(&document, &options, &mut Quiet).unwrap();
    let file = ResultFile::open(&options.result).unwrap();

    let mut simulation = Simulation::from_document(&document).unwrap();
    simulation.run_until(simulation.end()).unwrap();
    let (last, now) = (file.frames() - 1, simulation.snapshot());
    assert_eq!(now.positions(), file.positions(last).unwrap());
    let mut compared = 0;
    for info in simulation.series_infos() {
        let recorded = match info.scope {
            SeriesScope::Scene if info.name == "time" => vec![file.times().unwrap()[last]],
            SeriesScope::Scene => vec![file.scene_series(&info.name).unwrap()[last]],
            SeriesScope::Cells => file.cell_series(&info.name).unwrap().row(last).to_vec(),
        };
        // Cells without a system have NaN.
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&now.series(&info.name).unwrap()), bits(&recorded), "{}", info.name);
        assert_eq!(info.unit, file.units(&info.name).unwrap(), "{}", info.name);
        compared += 1;
    }
    assert!(compared > 40, "{compared} series were compared");
}

#[test]
fn run_until_ends_exactly_where_it_is_told_to() {
    let mut simulation = example();
    for time in [0.1, 0.30000001, 1.0 / 3.0, 7.0, 7.0, 3.0, f64::NAN] {
        let before = simulation.time();
        simulation.run_until(time).unwrap();
        assert_eq!(simulation.time(), if time > before { time } else { before });
    }
    // The end of the experiment is no wall.
    simulation.run_until(12.5).unwrap();
    assert_eq!((simulation.time(), simulation.end()), (12.5, 10.0));
}

#[test]
fn a_token_stops_a_simulation_in_another_thread_which_can_go_on() {
    let token = CancelToken::new();
    let mut simulation = Simulation::builder().cancel_token(token.clone()).text("example", EXAMPLE).unwrap();
    let worker = std::thread::spawn(move || {
        let ended = simulation.run_until(f64::INFINITY);
        (simulation, ended)
    });
    std::thread::sleep(std::time::Duration::from_millis(50));
    token.cancel();
    let (mut simulation, ended) = worker.join().unwrap();
    let reached = simulation.time();
    assert!(matches!(ended, Err(SimulationError::Cancelled { time }) if time == reached), "{ended:?}");
    assert!(matches!(simulation.step(), Err(SimulationError::Cancelled { .. })), "it stays cancelled");
    assert_eq!(simulation.time(), reached);
    simulation.set_cancel_token(CancelToken::new());
    simulation.step().unwrap();
    assert!(simulation.time() > reached);
}

#[test]
fn a_cancelled_run_can_be_resumed_to_the_same_bits() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let document = Document::parse("test", EXAMPLE, Path::new("."), &[]).unwrap();
    let [whole, stopped] = ["whole.h5", "stopped.h5"].map(|name| RunOptions::new(folder.path().join(name)));
    run(&document, &whole, &mut Quiet).unwrap();
    stopped.cancel.cancel();
    let ended = run(&document, &stopped, &mut Quiet);
    assert_eq!(ended.unwrap_err().exit_code(), 130);
    pseudopod::run::resume(&stopped.result, &ResumeOptions::default(), &mut Quiet).unwrap();
    let last = |options: &RunOptions| {
        let file = ResultFile::open(&options.result).unwrap();
        (file.times().unwrap(), file.positions(file.frames() - 1).unwrap())
    };
    assert_eq!(last(&whole), last(&stopped));
}

#[test]
fn damaged_and_foreign_checkpoints_are_refused_and_change_nothing() {
    let mut simulation = example();
    simulation.run_until(1.0).unwrap();
    let (saved, before) = (simulation.checkpoint(), simulation.state().clone());
    let mut refused = |bytes: &[u8]| match simulation.restore(bytes) {
        Err(SimulationError::Checkpoint(fault)) => {
            assert_same(simulation.state(), &before);
            fault
        }
        other => panic!("{other:?}"),
    };
    for at in (0..saved.len()).step_by(13) {
        let mut wrong = saved.clone();
        wrong[at] ^= 0x20;
        assert!(matches!(refused(&wrong), CheckpointFault::Damaged(_) | CheckpointFault::NotACheckpoint), "byte {at}");
        assert!(matches!(refused(&saved[..at]), CheckpointFault::Damaged(_) | CheckpointFault::NotACheckpoint));
    }
    assert_eq!(refused(b"something else"), CheckpointFault::NotACheckpoint);
    // A model that differs in anything: a seed, a parameter, a mesh.
    for set in [
        ("seed", "9"),
        ("cells.pulled.loads[0].force", "5.000001 pN"),
        ("cells.squeezed.mechanics.shape_memory.shape_modulus", "11 pN/um"),
        ("cells.squeezed.mesh.radius", "5.1 um"),
        ("cells.squeezed.fibres[0].stiffness", "2 pN/um"),
    ] {
        let other = Simulation::builder().set(set.0, set.1).text("example", EXAMPLE).unwrap();
        assert_eq!(refused(&other.checkpoint()), CheckpointFault::Foreign, "{set:?}");
    }
    let changed = everything_with(OWN.replace("0.3*U", "0.31*U"));
    let (mut own, foreign) = (everything(1), CheckpointFault::Foreign);
    assert!(matches!(own.restore(&changed.checkpoint()), Err(SimulationError::Checkpoint(fault)) if fault == foreign));
}

fn everything_with(own: String) -> Simulation {
    builder().equations("own.eml", own).text("everything.toml", EVERYTHING).unwrap()
}

#[test]
fn positions_are_read_all_at_once_or_cell_by_cell() {
    let mut simulation = everything(1);
    simulation.run_until(0.5).unwrap();
    let mut all = vec![[0.0; 3]; simulation.atom_count()];
    simulation.positions_into(&mut all).unwrap();
    assert_eq!(all, simulation.snapshot().positions());
    let mut rest = all.as_slice();
    for cell in simulation.cells() {
        let mut own = vec![[0.0; 3]; simulation.type_of(cell).unwrap().atom_count()];
        simulation.cell_positions_into(cell, &mut own).unwrap();
        assert_eq!(own, rest[..own.len()], "cell {cell}");
        rest = &rest[own.len()..];
    }
    assert!(rest.is_empty());
    assert!(matches!(
        simulation.positions_into(&mut all[1..]),
        Err(SimulationError::Length { expected: 294, found: 293 })
    ));
}

#[test]
fn fields_show_their_grid_and_values() {
    let simulation = everything(1);
    let field = simulation.field("medium").unwrap();
    assert_eq!((field.boxes(), field.spacing()[0], field.origin()), ([32, 32, 1], 2.5, [-40.0, -40.0, 0.0]));
    assert_eq!(field.species().collect::<Vec<_>>(), ["food", "waste"]);
    let food = field.values("food").unwrap();
    // Boxes have the value at their centre, x fastest.
    for (at, value) in food.iter().enumerate() {
        let x = -40.0 + 2.5 * ((at % 32) as f64 + 0.5);
        assert!((value - (1.0 + 0.01 * x)).abs() < 1e-12, "{value} at {x}");
    }
    let error = field.values("fod").unwrap_err();
    assert_eq!(error.help().unwrap(), "did you mean `food`? there is `food` and `waste`");
}

/// Runs the example for a second with something set of one of its cells, or not.
fn after_a_second(kind: usize, set: Option<(&str, f64)>) -> (Simulation, usize) {
    let mut simulation = example();
    let cell = simulation.types().nth(kind).unwrap().cells().next().unwrap();
    if let Some((what, value)) = set {
        simulation.set(cell, what, value).unwrap();
    }
    simulation.run_until(1.0).unwrap();
    let at = simulation.position_of(cell).unwrap();
    (simulation, at)
}

#[test]
fn cells_do_what_a_program_sets() {
    let value = |kind: usize, set: Option<(&str, f64)>, series: &str| {
        let (simulation, at) = after_a_second(kind, set);
        simulation.series(series).unwrap()[at]
    };
    // Without a walk of its own a cell with a bias moves at this speed.
    let moved = value(1, Some(("motility.bias.y", 2.0)), "position_y");
    assert!((moved - 2.0).abs() < 1e-9, "{moved}");
    // Force over drag, and a little more, since the centre of the volume goes ahead of the atoms; nothing without the load.
    let pulled = value(0, None, "position_x") + 10.0;
    let twice = value(0, Some(("load[pull]", 2.0)), "position_x") + 10.0;
    assert!((0.25..0.27).contains(&pulled) && (twice / pulled - 2.0).abs() < 0.02, "{pulled} {twice}");
    let still = value(0, Some(("load[pull]", 0.0)), "position_x");
    assert!((still + 10.0).abs() < 1e-9, "{still}");
    let (relaxed, narrow) = (value(1, None, "size_x"), value(1, Some(("fibre[belt]", 1.0)), "size_x"));
    assert!(narrow < 0.98 * relaxed, "{narrow} {relaxed}");
    let (soft, stiff) = (value(0, None, "size_x"), value(0, Some(("stiffness", 10.0)), "size_x"));
    assert!(soft - relaxed > 3.0 * (stiff - relaxed), "{soft} {stiff} {relaxed}");
    let (small, large) = (value(1, None, "volume"), value(1, Some(("rest_volume_ratio", 1.1)), "volume"));
    assert!((large / small - 1.1).abs() < 1e-9, "{large} {small}");
}

#[test]
fn what_a_program_makes_a_cell_secrete_is_what_the_field_gains() {
    let mut simulation = everything(1);
    let cell = simulation.cells().nth(3).unwrap();
    simulation.set(cell, "secretion[waste]", 2.0).unwrap();
    simulation.run_until(3.0).unwrap();
    let amount = simulation.field("medium").unwrap().values("waste").unwrap().iter().sum::<f64>() * 2.5 * 2.5;
    assert!((amount - 6.0).abs() < 1e-9, "{amount}");
}

#[test]
fn what_cannot_be_set_is_named_and_changes_nothing() {
    let mut simulation = example();
    let [pulled, squeezed] = [0, 1].map(CellId::new);
    let before = simulation.state().clone();
    for (cell, what, value, message) in [
        (CellId::new(2), "stiffness", 1.0, "there is no cell 2"),
        (squeezed, "stifness", 1.0, "there is no setting `stifness`"),
        (squeezed, "", 1.0, "there is no setting ``"),
        (squeezed, "fibre[bell]", 1.0, "there is no fibre `bell`"),
        (pulled, "fibre[belt]", 1.0, "there is no fibre `belt`"),
        (squeezed, "fibre[belt]", 1.5, "fibre[belt] of cell 1 cannot be 1.5: a number from 0 to 1 was expected"),
        (squeezed, "stiffness", f64::NAN, "stiffness of cell 1 cannot be NaN: a finite number was expected"),
        (squeezed, "secretion[food]", 1.0, "there is no field `food`"),
        (
            squeezed,
            "adhesion",
            1.0,
            "adhesion of cell 1 cannot be set: type `squeezed` touches nothing in this experiment",
        ),
        (
            squeezed,
            "motility.speed",
            1.0,
            "motility.speed of cell 1 cannot be set: type `squeezed` has no Brownian motility",
        ),
        (
            squeezed,
            "atom[3].x",
            1.0,
            "atom[3].x of cell 1 cannot be set: type `squeezed` has atoms that move by forces",
        ),
    ] {
        let error = simulation.set(cell, what, value).unwrap_err();
        assert_eq!(error.to_string(), message);
        assert!(error.help().is_some() || matches!(error, SimulationError::Value { .. }), "{message}");
        assert_same(simulation.state(), &before);
    }
    let error = simulation.set(squeezed, "fibre[bell]", 1.0).unwrap_err();
    assert_eq!(error.help().unwrap(), "did you mean `belt`? there is `belt`");
}

#[test]
fn cells_come_and_go_and_keep_their_ids() {
    let mut simulation = example();
    simulation.keep(&["volume"], 1.0).unwrap();
    simulation.run_until(1.5).unwrap();
    let first = simulation.types().next().unwrap();
    let shape: Vec<[f64; 3]> = first.rest_positions().map(|[x, y, z]| [x, 1.1 * y + 30.0, z]).collect();
    let before: Vec<CellId> = simulation.cells().collect();
    let new = [NewCell::at([0.0, -20.0, 0.0]), NewCell::with_positions(shape).born_from(before[0])];
    let added = simulation.add_cells("pulled", &new).unwrap();
    assert_eq!(added, [2, 3].map(CellId::new));
    // Cells stand type after type; who was there keeps its id, and what is set of it.
    let order = |simulation: &Simulation| simulation.cells().map(CellId::number).collect::<Vec<_>>();
    assert_eq!((order(&simulation), simulation.position_of(before[1]).unwrap()), (vec![0, 2, 3, 1], 3));
    let positions = simulation.snapshot();
    assert_eq!(positions.cells().collect::<Vec<_>>(), simulation.cells().collect::<Vec<_>>());
    let centre =
        |simulation: &Simulation, cell| simulation.series("position_y").unwrap()[simulation.position_of(cell).unwrap()];
    assert!((centre(&simulation, added[0]) + 20.0).abs() < 1e-9 && (centre(&simulation, added[1]) - 30.0).abs() < 1e-9);
    simulation.set(added[0], "motility.bias.y", 1.0).unwrap();
    simulation.remove_cells(&before[..1]).unwrap();
    assert_eq!(order(&simulation), [2, 3, 1]);
    simulation.run_until(2.5).unwrap();
    assert!((centre(&simulation, added[0]) + 19.0).abs() < 1e-6, "{}", centre(&simulation, added[0]));
    assert_eq!(simulation.add_cells("squeezed", &new[..1]).unwrap(), [CellId::new(4)], "ids are never used again");
    let history = simulation.history();
    let kept: Vec<usize> = history.values("volume").unwrap().iter().map(Vec::len).collect();
    assert_eq!((kept, history.cells(1).len(), history.cells(2).len()), (vec![2, 2, 3], 2, 3));
    // What is refused changes nothing.
    let now = simulation.state().clone();
    let gone = simulation.remove_cells(&[added[0], before[0]]).unwrap_err();
    assert!(matches!(gone, SimulationError::NoSuchCell { cell } if cell == before[0]), "{gone}");
    let kind = simulation.add_cells("pulld", &[]).unwrap_err();
    assert_eq!(kind.help().unwrap(), "did you mean `pulled`? there is `pulled` and `squeezed`");
    let atoms = simulation.add_cells("pulled", &[NewCell::with_positions(vec![[0.0; 3]; 7])]).unwrap_err();
    assert!(matches!(atoms, SimulationError::Population(PopulationTrouble::Atoms { found: 7, expected: 42, .. })));
    let mut touching = everything(1);
    let overlap = touching.add_cells("walker", &[NewCell::at([1.0, 0.0, 0.0])]).unwrap_err();
    assert!(matches!(overlap, SimulationError::Population(PopulationTrouble::Overlap { .. })), "{overlap}");
    assert_same(simulation.state(), &now);
}

#[test]
fn what_was_kept_of_later_times_is_dropped_by_going_back() {
    let mut simulation = example();
    simulation.keep(&["size_x", "load.pull"], 0.5).unwrap();
    simulation.run_until(1.25).unwrap();
    let saved = simulation.checkpoint();
    simulation.run_until(3.0).unwrap();
    let kept = simulation.history().clone();
    assert_eq!(kept.times().len(), 7);
    simulation.restore(&saved).unwrap();
    assert!(simulation.history().times().iter().all(|time| *time <= 1.25) && simulation.history().times().len() == 3);
    simulation.run_until(3.0).unwrap();
    assert_eq!(*simulation.history(), kept);
    assert!(kept.values("load.pull").unwrap().iter().all(|value| *value == [5.0]));
    assert!(matches!(simulation.keep(&["size"], 1.0), Err(SimulationError::Unknown { what: "series", .. })));
    assert!(matches!(simulation.keep(&["size_x"], -1.0), Err(SimulationError::Value { .. })));
    assert_eq!(*simulation.history(), kept, "what is refused drops nothing");
}

#[test]
fn faults_of_a_document_keep_their_positions() {
    let error = Simulation::from_text("wrong.toml", &EXAMPLE.replace("drag", "darg")).unwrap_err();
    let SimulationError::Input(pseudopod::error::Error::Input(faults)) = &error else { panic!("{error:?}") };
    assert!(
        faults.iter().any(|fault| fault.location.as_ref().is_some_and(|location| location.source.name == "wrong.toml"))
    );
    assert!(std::error::Error::source(&error).is_none(), "the message is that of the faults themselves");
    let threads = Simulation::builder().threads(0).text("example", EXAMPLE).unwrap_err();
    assert_eq!(threads.to_string(), "a run cannot be made by 0 threads");
}

#[test]
fn a_state_that_names_what_is_not_there_is_refused() {
    // As it may come from a file with good checksums.
    let bond = ObstacleBond { atom: 0, obstacle: 0, force: [0.0; 3], stored: 0.0 };
    type Spoil<'a> = &'a dyn Fn(&mut State);
    let late = |state: &mut State, late: f64| {
        let all = state.kinds.iter_mut().flat_map(|kind| kind.behaviours.iter_mut().flatten());
        for behaviour in all {
            if let BehaviourState::Brownian(walk) = behaviour {
                walk.left = late;
            }
        }
    };
    let late_pods = |state: &mut State, late: f64, waits: bool| {
        let all = state.kinds.iter_mut().flat_map(|kind| kind.behaviours.iter_mut().flatten());
        for behaviour in all {
            if let BehaviourState::Pseudopods(pods) = behaviour {
                *(if waits { &mut pods.wait } else { &mut pods.pod.left }) = late;
            }
        }
    };
    let spoilt: [(&str, Spoil); 9] = [
        ("what the cells of type", &|state| late_pods(state, -1e9, false)),
        ("what the cells of type", &|state| late_pods(state, f64::NAN, true)),
        ("what the cells of type", &|state| late(state, -1e9)),
        ("what the cells of type", &|state| late(state, f64::NAN)),
        ("its time is NaN s", &|state| state.time = f64::NAN),
        ("its time is -0.5 s", &|state| state.time = -0.5),
        ("its contacts are", &|state| state.contact.obstacles.push(ObstacleBond { obstacle: u32::MAX, ..bond })),
        ("its contacts are", &|state| state.contact.released.push(1_000_000)),
        ("the cells of type", &|state| state.kinds[0].balance.push(AtomBalance::NONE)),
    ];
    for (words, spoil) in spoilt {
        let (model, mut state) = everything(1).into_parts();
        spoil(&mut state);
        let error = Simulation::new(model, state).unwrap_err();
        assert!(matches!(&error, SimulationError::Mismatch(found) if found.starts_with(words)), "{error}");
    }
}

#[test]
fn a_state_of_another_model_is_refused() {
    let (model, _) = example().into_parts();
    let (_, state) = everything(1).into_parts();
    let error = Simulation::new(model, state).unwrap_err();
    assert!(matches!(&error, SimulationError::Mismatch(_)), "{error}");
    // A state goes on under a model of the same cells: here one that is twice as stiff.
    let mut simulation = example();
    simulation.run_until(2.0).unwrap();
    let stiffer = Simulation::builder()
        .set("cells.pulled.mechanics.shape_memory.shape_modulus", "20 pN/um")
        .text("example", EXAMPLE)
        .unwrap();
    let (long, (_, state)) = (simulation.series("size_x").unwrap()[0], simulation.into_parts());
    let mut forked = Simulation::new(stiffer.into_parts().0, state).unwrap();
    assert_eq!(forked.time(), 2.0);
    forked.run_until(4.0).unwrap();
    assert!(forked.series("size_x").unwrap()[0] < long, "the stiffer cell is shorter");
}

#[test]
fn threads_that_share_the_sweeps_of_a_large_population_give_the_same_bits() {
    let places = (0..343).map(|cell| {
        let at = [cell % 7, cell / 7 % 7, cell / 49].map(|index| 10.1 * (f64::from(index) - 3.0));
        format!("[\"{} um\", \"{} um\", \"{} um\"]", at[0], at[1], at[2])
    });
    let text = format!(
        "title = \"A crowd is pressed together\"\n[run]\nuntil = \"6 s\"\n[cells.cell]\nnumber = 343\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [{}] }}\n\
         mechanics = {{ drag = \"20 pN s/um\", shape_memory = {{ shape_modulus = \"5 pN/um\" }} }}\n\
         motility = {{ attraction = {{ to = [\"0 um\", \"0 um\", \"0 um\"], stiffness = \"0.012 pN/um\" }} }}\n\
         [contact]\nstrength = \"0.2 pN/um^2\"\n",
        places.collect::<Vec<_>>().join(", ")
    );
    let on = |threads: usize| {
        let mut simulation = Simulation::builder().threads(threads).text("crowd.toml", &text).unwrap();
        simulation.run_until(6.0).unwrap();
        let mut positions = vec![[0.0; 3]; simulation.atom_count()];
        simulation.positions_into(&mut positions).unwrap();
        let bits: Vec<u64> = positions.into_iter().flatten().map(f64::to_bits).collect();
        (simulation.series("contact.count").unwrap()[0], bits)
    };
    let (one, two) = (on(1), on(2));
    // From 4096 contacts on sweeps are shared.
    assert!(one.0 >= 4096.0, "{} contacts", one.0);
    assert!(one == two, "the bits differ");
}
