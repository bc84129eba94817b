//! Random scenes of contacts hold what the book promises: volumes, depths, strengths, energy, momentum, the same bits.
//!
//! All that is promised of states holds in every scene. A few in a thousand are refused: they end with the message that two cells are
//! too deep in each other though they have room.
//!
//! One number makes a scene. A failure names it, and
//! `CONTACT_SEED=17 cargo test --release --test physics one_scene -- --ignored --nocapture` makes it again. The long
//! run, in chunks: `CONTACT_SEED=1000 CONTACT_SCENES=500 cargo test --release --test physics thousands -- --ignored`.

use crate::contact_scenes::{Purposed, Scene};
use pseudopod::Vec3;
use pseudopod::contact::{Sides, closest_on_facet, winding_number};
use pseudopod::geometry::{atom_areas, bounding_box};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::attraction::Attraction;
use pseudopod::mechanics::integrator::StepSize;
use pseudopod::sim::contact::{AtomBond, Pairing, check_passed, find_contacts};
use pseudopod::sim::observe::{CellMeasure, measure_cells};
use pseudopod::sim::{Model, State, Trouble, VolumeRule, Workspace, step};

/// The deepest that one cell may be in another, over the mean edge.
const DEEPEST: f64 = 0.02;

/// The part of space that balls fill in a random close packing.
const RANDOM_PACKING: f64 = 0.64;

/// Steps from one state that is recorded to the next.
const RECORDED: u64 = 20;

/// What is wrong with a scene.
struct Wrong {
    words: String,
    /// Whether the run was refused, and no state was wrong.
    refused: bool,
}

impl From<String> for Wrong {
    fn from(words: String) -> Self {
        Self { words, refused: false }
    }
}

/// What a scene showed.
#[derive(Debug, Default, Clone)]
struct Seen {
    steps: u64,
    /// Most contacts in a step.
    contacts: usize,
    /// Largest depth over the edge of the cell with the shorter edges.
    deepest: f64,
    volume: f64,
    /// Smallest area of a facet over its area at rest.
    facet: f64,
    /// Largest rise of the energy in a step, over the energy at the start.
    rise: f64,
    /// Largest distance of the centre of drag from where it was, µm.
    drift: f64,
    /// Largest pull of an atom on one cell over what it may bear.
    pull: f64,
    sweeps: u32,
    all_sweeps: u64,
    /// How often the fixed step was halved because an atom would have gone too far.
    halved: u32,
    /// How much of the box the volumes of the cells are in the end; 0 without a box.
    fill: f64,
    /// How the run ended early.
    trouble: Option<Trouble>,
}

/// Makes a scene and says what is wrong with it.
fn play(scene: &Scene) -> Result<Seen, Wrong> {
    let (mut model, start) = scene.build();
    for halved in 0..20 {
        match (play_steps(scene, &model, &start), &mut model.integrator.size) {
            // What the message asks for.
            (Err((_, Some(trouble))), StepSize::Fixed(step)) if matches!(*trouble, Trouble::TooFast { .. }) => {
                *step *= 0.5;
            }
            (Err((words, trouble)), _) => {
                let refused = matches!(trouble.as_deref(), Some(Trouble::Pressed { .. } | Trouble::Contact { .. }));
                return Err(Wrong { words, refused });
            }
            (Ok((end, seen)), _) => {
                check_bits(scene, &model, &start, &end)?;
                return Ok(Seen { halved, ..seen });
            }
        }
    }
    Err(Wrong::from("no fixed step is short enough".to_owned()))
}

/// What is wrong, with the trouble that the step had.
type Failure = (String, Option<Box<Trouble>>);

fn play_steps(scene: &Scene, model: &Model, start: &State) -> Result<(State, Seen), Failure> {
    let start = &press(scene, model, start)?;
    let mut state = start.clone();
    let mut ws = Workspace::new(model);
    let mut seen = Seen { facet: f64::INFINITY, ..Seen::default() };
    let mut before: Option<f64> = None;
    let (mut energy_at_start, centre) = (0.0, centre_of_drag(model, start));
    // A box takes longer to fill.
    let most = if scene.purpose == Purposed::Overfull { 8 * scene.steps } else { scene.steps };
    while state.time < model.until && state.step < start.step + most {
        let done = step(model, &mut state, &mut ws);
        // As a run looks before it records.
        let is_last = state.time >= model.until || state.step == start.step + most;
        let is_recorded = is_last || state.step.is_multiple_of(RECORDED);
        match done.and_then(|_| if is_recorded { check_passed(model, &state) } else { Ok(()) }) {
            Ok(()) => {}
            Err(trouble @ Trouble::TooFast { .. }) => return Err((format!("{trouble}"), Some(Box::new(trouble)))),
            Err(trouble @ (Trouble::Pressed { .. } | Trouble::Contact { .. } | Trouble::Volume { .. }))
                if scene.purpose == Purposed::Overfull =>
            {
                seen.trouble = Some(trouble);
                break;
            }
            Err(trouble) => return Err((format!("step {}: {trouble}", state.step), Some(Box::new(trouble)))),
        }
        let cells = measure_cells(model, &state);
        let at = |words: String| (format!("step {}: {words}", state.step), None);
        seen.steps = state.step - start.step;
        seen.contacts = seen.contacts.max(ws.contact.rows.len());
        seen.all_sweeps += u64::from(ws.contact.sweeps);
        seen.sweeps = seen.sweeps.max(ws.contact.sweeps);
        check_cells(model, &state, &cells, &mut seen).map_err(at)?;
        seen.fill = fill(scene, model, &cells);
        check_depth(model, &state, &ws, &mut seen).map_err(at)?;
        check_strength(scene, model, &state, &ws, &mut seen).map_err(at)?;
        if scene.purpose == Purposed::Alone {
            let energy = cells.iter().map(|cell| cell.energy).sum::<f64>()
                + pressed_energy(model, &state, &cells)
                + state.contact.stored();
            // The first step restores what facets make of the volumes.
            match before {
                None => energy_at_start = energy,
                Some(before) => seen.rise = seen.rise.max((energy - before) / energy_at_start),
            }
            before = Some(energy);
            seen.drift = seen.drift.max((centre_of_drag(model, &state) - centre).norm());
        }
    }
    if seen.trouble.is_some() {
        // Balls fill as much without being deformed: below, cells have room.
        if seen.fill < RANDOM_PACKING {
            return Err((format!("a box is too full at {:.3}", seen.fill), None));
        }
        return Ok((state, seen));
    }
    find_contacts(model, &state, &mut ws);
    check_depth(model, &state, &ws, &mut seen).map_err(|words| (format!("at the end: {words}"), None))?;
    let cells = measure_cells(model, &state);
    check_inside(model, &state, &cells)
        .map_err(|words| (format!("at the end: {words}, fill {:.3}", seen.fill), None))?;
    if scene.purpose == Purposed::Alone {
        // Round-off of positions of some 10 um in so many steps.
        let most = 1e-14 * seen.steps as f64;
        if seen.drift > most.max(1e-13) {
            return Err((format!("the pair drifts by {:.1e} um in {} steps", seen.drift, seen.steps), None));
        }
        if seen.rise > 1e-7 {
            return Err((format!("the energy rises by {:.1e} of what it was", seen.rise), None));
        }
    }
    Ok((state, seen))
}

/// Presses two cells together that are left alone afterwards.
fn press(scene: &Scene, model: &Model, start: &State) -> Result<State, Failure> {
    let (mut model, mut state) = (model.clone(), start.clone());
    if scene.pressed > 0.0 {
        for kind in &mut model.kinds {
            kind.forces.retain(|force| !matches!(force, Force::Attraction(_)));
            kind.forces.push(Force::Attraction(Attraction { to: Vec3::zeros(), stiffness: scene.pressed }));
            kind.bound_stiffness();
        }
        let mut ws = Workspace::new(&model);
        while state.time < 0.5 * model.until && state.step < scene.steps / 2 {
            step(&model, &mut state, &mut ws)
                .map_err(|trouble| (format!("pressed: {trouble}"), Some(Box::new(trouble))))?;
        }
    }
    Ok(state)
}

/// Volumes that are kept are, facets have areas, all numbers are numbers.
fn check_cells(model: &Model, state: &State, cells: &[CellMeasure], seen: &mut Seen) -> Result<(), String> {
    for (number, cell) in cells.iter().enumerate() {
        let kind = &model.kinds[state.kind_of(number).0];
        if !cell.positions.iter().all(|x| x.iter().all(|a| a.is_finite())) || !cell.energy.is_finite() {
            return Err(format!("cell {number} has numbers that are none"));
        }
        if matches!(kind.volume, VolumeRule::Exact(_)) {
            seen.volume = seen.volume.max(cell.volume_error.abs());
            // The promise, and the round-off of another way to sum.
            if cell.volume_error.abs() > 1e-10 + 1e-13 {
                return Err(format!("the volume of cell {number} is off by {:.1e}", cell.volume_error));
            }
        }
        seen.facet = seen.facet.min(cell.smallest_facet);
        if cell.smallest_facet.is_nan() || cell.smallest_facet <= 0.0 {
            return Err(format!("a facet of cell {number} has no area"));
        }
    }
    Ok(())
}

/// The part of a closed box that is filled.
fn fill(scene: &Scene, model: &Model, cells: &[CellMeasure]) -> f64 {
    if scene.purpose != Purposed::Overfull {
        return 0.0;
    }
    let widths = model.obstacles.chunks(2).map(|pair| {
        let centre = Vec3::zeros();
        pair[0].beside(0.0, &centre).gap + pair[1].beside(0.0, &centre).gap
    });
    cells.iter().map(|cell| cell.volume).sum::<f64>() / widths.product::<f64>()
}

/// Gaps where the step ended.
fn check_depth(model: &Model, state: &State, ws: &Workspace, seen: &mut Seen) -> Result<(), String> {
    let (found, scene) = (&ws.contact.found, &model.contact.as_ref().unwrap().scene_of(&state.kinds).scene);
    let body_of = |atom: u32| scene.body_of_atom(atom);
    let edge = |body: u32| model.kinds[scene.bodies[body as usize].shape as usize].edge;
    let of_atoms = found.atoms.iter().map(|near| (near.gap, body_of(near.atom), near.body(scene)));
    let of_edges = found.edges.iter().map(|near| {
        let [one, other] = near.bodies(scene);
        (near.gap, one, other)
    });
    let of_planes = found.obstacles.iter().map(|near| (near.gap, body_of(near.atom), body_of(near.atom)));
    for (gap, one, other) in of_atoms.chain(of_edges).chain(of_planes) {
        let depth = -gap / edge(one).min(edge(other));
        seen.deepest = seen.deepest.max(depth);
        if depth > DEEPEST {
            return Err(format!(
                "cells {one} and {other} are {depth:.4} edges deep in each other, fill {:.3}",
                seen.fill
            ));
        }
    }
    Ok(())
}

/// No contact pulls or shears more than its strength times its area, which the places share where an atom touches a cell.
fn check_strength(scene: &Scene, model: &Model, state: &State, ws: &Workspace, seen: &mut Seen) -> Result<(), String> {
    let (s, on) = (&ws.contact, &model.contact.as_ref().unwrap().scene_of(&state.kinds).scene);
    let bodies = &on.bodies;
    // In the order of the rows.
    let bonds = &state.contact;
    let body_of = |atom: u32| on.body_of_atom(atom) as usize;
    let kind_of = |body: usize| bodies[body].shape as usize;
    let areas: Vec<Vec<f64>> = model.kinds.iter().map(|kind| atom_areas(&kind.rest)).collect();
    let area_of = |atom: u32| {
        let body = body_of(atom);
        areas[kind_of(body)][(atom - bodies[body].first_atom) as usize]
    };
    // What is farther off than the proximity is kept apart and bears nothing. Gaps to sheets count from their skin.
    let touches = |number: usize, body: usize| {
        let skin = if on.shape(body as u32).sides == Sides::Both { 0.05 * on.reach.prediction } else { 0.0 };
        on.reach.touches(s.rows[number].gap() + skin)
    };
    let of_atoms = bonds.atoms.iter().enumerate().map(|(number, bond)| {
        let (own, other) = (body_of(bond.atom), bond.body(on) as usize);
        if own == other || !touches(number, other) {
            return ([0.0; 2], 0.0);
        }
        let same = |(at, one): &(usize, &AtomBond)| {
            (one.atom, one.body(on)) == (bond.atom, bond.body(on)) && touches(*at, other)
        };
        let shared_by = bonds.atoms.iter().enumerate().filter(same).count();
        (scene.between[kind_of(own)][kind_of(other)], 0.5 * area_of(bond.atom) / shared_by as f64)
    });
    // Of edges only those are kept that carry a force.
    let edges = s.rows.iter().filter(|row| row.pairing == Pairing::Edges).count();
    let of_edges = std::iter::repeat_n(([0.0; 2], 0.0), edges);
    let before_planes = bonds.atoms.len() + edges;
    let of_planes = bonds.obstacles.iter().enumerate().map(|(number, bond)| {
        if !on.reach.touches(s.rows[before_planes + number].gap()) {
            return ([0.0; 2], 0.0);
        }
        let kind = kind_of(body_of(bond.atom));
        (scene.on_planes[kind][bond.obstacle as usize], area_of(bond.atom))
    });
    let largest = s.pulls.iter().map(|pull| pull.force().norm()).fold(0.0, f64::max);
    let mut sum = ((0, 0), 0.0);
    for (number, (([tensile, shear], area), pull)) in
        of_atoms.chain(of_edges).chain(of_planes).zip(&s.pulls).enumerate()
    {
        let (normal, force) = (s.rows[number].normal(), pull.force());
        let (along, across) = (normal.dot(&force), (force - normal.dot(&force) * normal).norm());
        // Forces and normals have seven digits, and so has what a force was while it was being found.
        let slack = 1e-6 * (largest + tensile.max(shear) * area);
        if -along > tensile * area + slack {
            return Err(format!("contact {number} pulls {} pN of {} pN", -along, tensile * area));
        }
        if across > shear * area + slack {
            return Err(format!("contact {number} shears {across} pN of {} pN", shear * area));
        }
        if let Some(bond) = bonds.atoms.get(number).filter(|_| tensile > 0.0) {
            let pair = (bond.atom, bond.body(on));
            if sum.0 != pair {
                sum = (pair, 0.0);
            }
            sum.1 -= along.min(0.0);
            seen.pull = seen.pull.max(sum.1 / (0.5 * tensile * area_of(bond.atom)));
        }
    }
    Ok(())
}

/// Looks without contacts: points along all edges of all cells, whether they are inside another and how far from its surface.
fn check_inside(model: &Model, state: &State, cells: &[CellMeasure]) -> Result<(), String> {
    let scene = &model.contact.as_ref().unwrap().scene_of(&state.kinds).scene;
    let boxes: Vec<(Vec3, Vec3)> = cells.iter().map(|cell| bounding_box(&cell.positions).unwrap()).collect();
    for (one, cell) in cells.iter().enumerate() {
        for other in 0..cells.len() {
            let (shape, there) = (scene.shape(other as u32), &cells[other].positions);
            let edge = model.kinds[state.kind_of(one).0].edge.min(model.kinds[state.kind_of(other).0].edge);
            if one == other || shape.sides != Sides::Outer {
                continue;
            }
            let (low, high) = boxes[other];
            for &[a, b] in &scene.shape(one as u32).edges {
                for part in 0..=8 {
                    let point = cell.positions[a as usize].lerp(&cell.positions[b as usize], f64::from(part) / 8.0);
                    if (0..3).any(|axis| point[axis] < low[axis] || point[axis] > high[axis])
                        || winding_number(point, there, &shape.facets) < 0.5
                    {
                        continue;
                    }
                    let corners = shape.facets.iter().map(|facet| facet.map(|corner| there[corner as usize]));
                    let depths = corners.map(|corners| closest_on_facet(point, corners).offset.norm());
                    let depth = depths.fold(f64::INFINITY, f64::min) / edge;
                    if depth > DEEPEST {
                        return Err(format!("an edge of cell {one} is {depth:.4} edges inside cell {other}"));
                    }
                }
            }
        }
    }
    Ok(())
}

/// Energy of the pressure of compressible cells, which is no part of that of their surfaces, pN um.
fn pressed_energy(model: &Model, state: &State, cells: &[CellMeasure]) -> f64 {
    let of_cell = |(number, cell): (usize, &CellMeasure)| {
        let (kind, own) = state.kind_of(number);
        match &model.kinds[kind].volume {
            VolumeRule::Compressible { modulus, .. } => {
                0.5 * modulus * cell.volume_error.powi(2) * state.kinds[kind].rest_volumes[own]
            }
            _ => 0.0,
        }
    };
    cells.iter().enumerate().map(of_cell).sum()
}

fn centre_of_drag(model: &Model, state: &State) -> Vec3 {
    let (mut sum, mut total) = (Vec3::zeros(), 0.0);
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for cell in 0..now.cells() {
            sum += now.cell(kind, cell).iter().sum::<Vec3>() * kind.drag;
            total += kind.drag * kind.atoms() as f64;
        }
    }
    sum / total
}

/// In some scenes: the same bits with two threads, and after a checkpoint in the middle.
fn check_bits(scene: &Scene, model: &Model, start: &State, end: &State) -> Result<(), String> {
    let start = &press(scene, model, start).map_err(|(words, _)| words)?;
    let again = |threads: usize, checkpoint: Option<u64>| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut state, mut ws) = (start.clone(), Workspace::new(model));
            while state.step < end.step {
                if Some(state.step) == checkpoint {
                    state = postcard::from_bytes(&postcard::to_stdvec(&state).unwrap()).unwrap();
                    ws = Workspace::new(model);
                }
                step(model, &mut state, &mut ws).unwrap();
            }
            state
        })
    };
    match scene.seed % 8 {
        0 if again(2, None) != *end => Err("another state with two threads".into()),
        4 if again(1, Some(u64::midpoint(start.step, end.step))) != *end => {
            Err("another state after a checkpoint".into())
        }
        _ => Ok(()),
    }
}

/// Plays scenes with one thread each; tells of all that are wrong and gives the others back. So many may be refused.
fn play_all(seeds: impl Iterator<Item = u64>, steps: u64, may_be_refused: usize) -> Vec<(Scene, Seen)> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let (mut played, mut refusals, mut failed) = (Vec::new(), Vec::new(), Vec::new());
    for seed in seeds {
        let scene = Scene { steps, ..Scene::draw(seed) };
        let result = pool.install(|| std::panic::catch_unwind(|| play(&scene)));
        match result.unwrap_or_else(|_| Err(Wrong::from("it panics".to_owned()))) {
            Ok(seen) => {
                println!("{seed} {:?}: {seen:?}", scene.purpose);
                played.push((scene, seen));
            }
            Err(Wrong { words, refused }) => {
                println!("{seed} {}: {words} ({})", if refused { "REFUSED" } else { "FAILED" }, scene.summary());
                let list = if refused { &mut refusals } else { &mut failed };
                list.push(format!("CONTACT_SEED={seed}: {words}"));
            }
        }
    }
    let shortened = played.iter().filter(|(_, seen)| seen.halved > 0).count();
    let full = played.iter().filter(|(_, seen)| seen.trouble.is_some()).count();
    println!(
        "{} scenes hold everything, {shortened} with a fixed step made shorter, {full} until they were full; {} are refused",
        played.len(),
        refusals.len()
    );
    assert!(failed.is_empty(), "{} scenes fail:\n{}", failed.len(), failed.join("\n"));
    assert!(refusals.len() <= may_be_refused, "{} scenes are refused:\n{}", refusals.len(), refusals.join("\n"));
    played
}

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name} is not a number")))
}

#[test]
#[ignore = "slow: a scene that was found to fail, by its number in CONTACT_SEED"]
fn one_scene() {
    let seed = number("CONTACT_SEED", 0);
    println!("{:#?}", Scene::draw(seed));
    play_all(seed..=seed, number("CONTACT_STEPS", 100), 0);
}

#[test]
#[ignore = "slow: CONTACT_SCENES scenes from CONTACT_SEED on (0.2 s each), of which one in a hundred may be refused"]
fn thousands_of_scenes_hold_what_the_book_promises() {
    let (first, count) = (number("CONTACT_SEED", 1000), number("CONTACT_SCENES", 2000));
    play_all(first..first + count, number("CONTACT_STEPS", 100), count as usize / 100);
}

#[test]
fn random_scenes_hold_what_the_book_promises() {
    // In the last ones edges slide in over the end of others (1422, 1437, 1474), sweeps leave an atom on the wrong side of a sheet
    // (1439) or of its own cell (30094), fixed steps do not come to rest (1132, 1455), and crushed cells cross (1053).
    let hard = [1053, 1132, 1422, 1437, 1439, 1455, 1474, 30094];
    let played = play_all((0..60).chain(hard), 100, 0);
    let contacts = played.iter().map(|(_, seen)| seen.contacts).sum::<usize>();
    assert!(contacts > 1000, "a fuzz of nothing: {contacts} contacts");
}
