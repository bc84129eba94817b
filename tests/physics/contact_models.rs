//! Dynamic links and penalties, the contacts to compare with: forces from an energy, equal and opposite; links that break
//! beyond their range and are part of the state.

use crate::same_bits::{go_on, through_a_checkpoint};
use pseudopod::Vec3;
use pseudopod::contact::{Contacts, Detector, Reach};
use pseudopod::geometry::{Topology, icosphere, mean_edge_length};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::sim::contact::{
    ContactModel, ContactScene, Law, Link, LinkScratch, LinkTable, Penalty, Row, Strength, Touching,
};
use pseudopod::sim::controls::Controls;
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{Kind, Model, State, VolumeRule, Workspace, step};

/// Radius of the cells, µm.
const RADIUS: f64 = 5.0;

/// Stiffness of the springs of links, pN/µm.
const LINK: f64 = 2.0;

/// An icosahedron of 12 atoms with the drag of 20 pN s/µm.
fn cell(name: &str) -> Kind {
    let rest = icosphere(RADIUS, 0);
    let topology = Topology::of(&rest);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let energy = 6.0 * mean_edge_length(&rest).powi(2);
    let memory = ShapeMemory::new(&rest.positions, &rings, 6.0, Reaction::Exact);
    let barrier = Barrier::new(&rest.positions, &rest.facets, &topology.flaps, BarrierRules::with_energy(energy));
    let mut kind = Kind::new(name, rest, vec![Force::ShapeMemory(memory), Force::Barrier(barrier)]);
    kind.drag = 20.0 / 12.0;
    kind
}

/// A model of these kinds, in which kinds `i` and `j` are linked with `LINK` where `binds(i, j)`, up to a mean edge.
fn model(mut kinds: Vec<Kind>, until: f64, binds: impl Fn(usize, usize) -> bool) -> Model {
    for kind in &mut kinds {
        kind.largest_stiffness = kind.measure_largest_stiffness();
        kind.bound_stiffness();
    }
    let (number, edge) = (kinds.len(), kinds[0].edge);
    let near = 0.1 * edge;
    let mut contact =
        ContactModel::new(&kinds, &[], Reach { proximity: near, prediction: near, depth: near, margin: near });
    let mut table = LinkTable::new(number, edge);
    for one in 0..number {
        for other in (0..number).filter(|other| binds(one, *other)) {
            table.stiffness[one * number + other] = LINK;
        }
    }
    contact.law = Law::Links(table);
    let integrator = Integrator {
        method: Method::Implicit { order: Order::Second },
        size: StepSize::Adaptive { tolerance: 1e-3, largest: 0.5 },
    };
    Model { contact: Some(contact), ..Model::of(kinds, integrator, until) }
}

/// The atoms of a cell of a kind around a centre, turned a little so that nothing is symmetric.
fn atoms_at(kind: &Kind, centre: Vec3, angle: f64) -> Vec<Vec3> {
    let turn = nalgebra::Rotation3::new(Vec3::new(0.3, 0.5, 0.8).normalize() * angle);
    kind.rest.positions.iter().map(|x| turn * x + centre).collect()
}

/// Two cells on the x axis whose surfaces are nearer than the proximity.
fn pair(model: &Model) -> State {
    let start_at = |gap: f64| {
        let ahead = Vec3::new(gap, 0.4, -0.3);
        [vec![atoms_at(&model.kinds[0], Vec3::zeros(), 0.2)], vec![atoms_at(&model.kinds[1], ahead, 0.9)]]
    };
    let gap = |apart: f64| {
        let state = State::new(model, &start_at(apart));
        detect(&scene(model, &state), &positions(model, &state)).smallest_gap()
    };
    // Down from where nothing touches.
    let apart =
        (0..400).map(|i| 12.0 - 0.01 * f64::from(i)).find(|apart| gap(*apart) < 0.3 * 0.1 * model.kinds[0].edge);
    State::new(model, &start_at(apart.expect("they touch")))
}

/// Contacts of the cells of a state.
fn scene<'a>(model: &'a Model, state: &State) -> ContactScene<'a> {
    model.contact.as_ref().expect("contacts").scene_of(&state.kinds)
}

fn detect(contact: &ContactScene, positions: &[Vec3]) -> Contacts {
    let mut found = Contacts::default();
    Detector::default().detect(&contact.scene, positions, &mut found);
    found
}

fn positions(model: &Model, state: &State) -> Vec<Vec3> {
    let kinds = model.kinds.iter().zip(&state.kinds);
    kinds.flat_map(|(kind, now)| (0..now.cells()).flat_map(|cell| now.cell(kind, cell))).collect()
}

/// The links at a state, with those before.
fn links(model: &Model, state: &State) -> Vec<Link> {
    let (contact, x) = (&scene(model, state), positions(model, state));
    let now =
        Touching { scene: &contact.scene, controls: &Controls::default(), found: &detect(contact, &x), positions: &x };
    let mut scratch = LinkScratch::default();
    contact.law.links_at(now, &state.contact, &mut scratch).map_or(Vec::new(), |now| now.links.clone())
}

/// The table of links of a model of links.
fn table(model: &Model) -> &LinkTable {
    match &model.contact.as_ref().expect("contacts").law {
        Law::Links(table) => table,
        other => panic!("links, not {other:?}"),
    }
}

/// Elastic energy of all cells and that of the links of a state, pN·µm.
fn energy(model: &Model, state: &State) -> f64 {
    let (contact, x) = (&scene(model, state), positions(model, state));
    let mut force = vec![Vec3::zeros(); x.len()];
    let of_links = table(model).add_forces(&contact.scene, &Controls::default(), &links(model, state), &x, &mut force);
    of_links + measure_cells(model, state).iter().map(|cell| cell.energy).sum::<f64>()
}

#[test]
fn forces_of_links_are_the_gradient_of_their_energy_without_net_force_or_torque() {
    let model = model(vec![cell("a"), cell("b")], 1.0, |_, _| true);
    let state = pair(&model);
    let contact = &scene(&model, &state);
    let (links, mut x) = (links(&model, &state), positions(&model, &state));
    assert!(!links.is_empty(), "they touch, so they are linked");
    let pull = |x: &[Vec3]| {
        let mut force = vec![Vec3::zeros(); x.len()];
        let energy = table(&model).add_forces(&contact.scene, &Controls::default(), &links, x, &mut force);
        (energy, force)
    };
    let (energy, force) = pull(&x);
    assert!(energy < 0.0, "a link that holds has gained something: {energy}");
    for atom in 0..x.len() {
        for axis in 0..3 {
            let mut at = |shift: f64| {
                x[atom][axis] += shift;
                let energy = pull(&x).0;
                x[atom][axis] -= shift;
                energy
            };
            // The energy is quadratic: central differences are exact but for round-off, 1e2 · 1e-16 / 1e-3.
            let slope = (at(1e-3) - at(-1e-3)) / 2e-3;
            assert!((slope + force[atom][axis]).abs() < 1e-9, "{slope} against {}", force[atom][axis]);
        }
    }
    let size: f64 = force.iter().map(Vec3::norm).sum();
    let torque: Vec3 = x.iter().zip(&force).map(|(x, f)| x.cross(f)).sum();
    assert!(size > LINK, "there is something to test: {size}");
    assert!(force.iter().sum::<Vec3>().norm() < 1e-12 * size && torque.norm() < 1e-11 * size, "{torque}");
}

#[test]
fn a_link_joins_every_atom_of_both_facets_by_the_nearest_pairs_and_a_facet_has_one() {
    let model = model(vec![cell("a"), cell("b")], 1.0, |_, _| true);
    let state = pair(&model);
    let (links, x) = (links(&model, &state), positions(&model, &state));
    let scene = &scene(&model, &state).scene;
    let mut facets = Vec::new();
    for link in &links {
        facets.extend(link.facets);
        let length = |one: u32, other: u32| (x[one as usize] - x[other as usize]).norm_squared();
        for side in 0..2 {
            let mut atoms = link.pairs.map(|pair| pair[side]);
            let mut corners = scene.facet_atoms(link.bodies[side], link.facets[side]);
            atoms.sort_unstable();
            corners.sort_unstable();
            assert_eq!(atoms, corners);
        }
        let [a, b, c] = link.pairs.map(|pair| pair[0]);
        let [p, q, r] = link.pairs.map(|pair| pair[1]);
        let sum = |[p, q, r]: [u32; 3]| length(a, p) + length(b, q) + length(c, r);
        let spans = [[p, q, r], [p, r, q], [q, p, r], [q, r, p], [r, p, q], [r, q, p]];
        assert!(spans.into_iter().all(|span| sum(span) >= sum([p, q, r])), "no other way is shorter");
    }
    let number = facets.len();
    facets.sort_unstable();
    facets.dedup();
    assert_eq!(facets.len(), number, "a facet has one link");
}

#[test]
fn cells_whose_types_do_not_bind_are_not_linked() {
    let model = model(vec![cell("a"), cell("b")], 20.0, |one, other| one == other);
    let mut state = pair(&model);
    assert!(links(&model, &state).is_empty());
    let mut ws = Workspace::new(&model);
    for _ in 0..20 {
        step(&model, &mut state, &mut ws).unwrap();
    }
    assert!(state.contact.links.is_empty());
}

#[test]
fn linked_cells_lose_energy_but_for_the_error_of_a_step_and_do_not_drift() {
    let model = model(vec![cell("a"), cell("b")], 60.0, |_, _| true);
    let mut state = pair(&model);
    let mean = |state: &State| positions(&model, state).iter().sum::<Vec3>() / 24.0;
    let (mut ws, began) = (Workspace::new(&model), mean(&state));
    let mut energies = vec![energy(&model, &state)];
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap();
        energies.push(energy(&model, &state));
    }
    let (first, last) = (energies[0], energies[energies.len() - 1]);
    let gained = energies.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    println!("{first} to {last} pN um in {} steps, at most {gained} gained in a step", energies.len() - 1);
    assert!(last < first - 1.0, "links pull the facets together");
    // Steps are exact to 1e-3 of an edge.
    assert!(gained < 1e-3 * (first - last), "gained {gained} of {}", first - last);
    assert!((mean(&state) - began).norm() < 1e-11, "the pair does not drift");
}

/// A cell that is linked to a rigid one and pulled away from it with a force from 20 s on.
fn hung(force: f64, until: f64) -> (Model, State) {
    let mut rigid = cell("rigid");
    (rigid.held, rigid.volume) = (vec![0.0; 36], VolumeRule::Free);
    let mut soft = cell("soft");
    let atoms = (0..12).map(|atom| (atom, 1.0 / 12.0)).collect();
    let course = Course::through(vec![(0.0, 0.0), (20.0, 0.0), (21.0, force), (until, force)]).expect("rising times");
    soft.forces.push(Force::Load(Load::new("load", atoms, Vec3::x(), course)));
    let model = model(vec![rigid, soft], until, |one, other| one != other);
    let state = pair(&model);
    (model, state)
}

#[test]
fn links_bear_exactly_the_load_and_break_above_what_their_range_allows() {
    let (model, mut state) = hung(6.0, 120.0);
    let mut ws = Workspace::new(&model);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap();
    }
    let x = positions(&model, &state);
    let mut force = vec![Vec3::zeros(); 24];
    let scene = scene(&model, &state).scene;
    table(&model).add_forces(&scene, &Controls::default(), &state.contact.links, &x, &mut force);
    let rows = ws.contact.rows.iter().zip(&ws.contact.pulls);
    for (row, pull) in rows {
        for (atom, weight) in row.atoms.iter().zip(row.weights()) {
            force[*atom as usize] += weight * pull.force();
        }
    }
    let borne: Vec3 = force[12..].iter().sum();
    assert!((borne + 6.0 * Vec3::x()).norm() < 6e-3, "{borne}");
    // A link of three springs bears at most three times stiffness times range, by Cauchy and Schwarz.
    let most = 3.0 * LINK * model.kinds[0].edge * state.contact.links.len() as f64;
    assert!(most > 6.0);

    let (model, mut state) = hung(20.0 * 3.0 * LINK * model.kinds[0].edge + 1.0, 60.0);
    let mut ws = Workspace::new(&model);
    while state.time < model.until && (state.time < 25.0 || !state.contact.links.is_empty()) {
        step(&model, &mut state, &mut ws).unwrap();
    }
    assert!(state.contact.links.is_empty(), "no more than twenty facets of it are linked, so that it comes free");
}

#[test]
fn links_go_on_from_a_checkpoint_to_the_same_bits_with_any_number_of_threads() {
    let model = model(vec![cell("a"), cell("b")], 30.0, |_, _| true);
    let (mut whole, mut parts) = (pair(&model), pair(&model));
    go_on(&model, &mut whole, 1, 40);
    go_on(&model, &mut parts, 2, 17);
    assert!(!parts.contact.links.is_empty());
    let mut parts = through_a_checkpoint(&parts);
    go_on(&model, &mut parts, 1, 23);
    assert_eq!(whole, parts);
}

/// The same model with penalties and this strength.
fn penalty(until: f64, strength: f64) -> Model {
    let mut model = model(vec![cell("a"), cell("b")], until, |_, _| false);
    let contact = model.contact.as_mut().unwrap();
    contact.law = Law::Penalty(Penalty { stiffness: 50.0, range: contact.reach.proximity });
    contact.reach.depth = 0.5 * model.kinds[0].edge;
    contact.stick(0, 1, Strength { tensile: strength, shear: 0.0, energy: 0.0 });
    model
}

#[test]
fn a_penalty_pushes_by_its_depth_and_pulls_within_its_range_with_one_smooth_energy() {
    let law = Penalty { stiffness: 50.0, range: 0.4 };
    assert_eq!(law.at(-0.1, 3.0).0, 5.0);
    assert_eq!((law.at(0.0, 3.0).0, law.at(0.5, 3.0)), (0.0, (0.0, 0.0)));
    assert!((law.at(0.2, 3.0).0 + 3.0).abs() < 1e-14, "the most is borne halfway");
    for gap in [-0.3, -0.01, 0.01, 0.1, 0.3, 0.39] {
        let slope = (law.at(gap + 1e-5, 3.0).1 - law.at(gap - 1e-5, 3.0).1) / 2e-5;
        // The third derivative of the energy is 8 · 3 / 0.4², times 1e-10 / 6.
        assert!((slope + law.at(gap, 3.0).0).abs() < 1e-8, "{gap}: {slope}");
    }
    for joint in [0.0, 0.4] {
        let [below, above] = [joint - 1e-12, joint + 1e-12].map(|gap| law.at(gap, 3.0).1);
        assert!((below - above).abs() < 1e-9, "nothing jumps at {joint}");
    }
}

/// Presses the two cells of a model against each other with 5 pN for 40 s, and leaves them alone then.
fn press_together(model: &mut Model) {
    let atoms: Vec<(u32, f64)> = (0..12).map(|atom| (atom, 1.0 / 12.0)).collect();
    let course = || Course::through(vec![(0.0, 5.0), (40.0, 5.0), (41.0, 0.0), (100.0, 0.0)]).unwrap();
    for (kind, direction) in model.kinds.iter_mut().zip([Vec3::x(), -Vec3::x()]) {
        kind.forces.push(Force::Load(Load::new("press", atoms.clone(), direction, course())));
    }
    model.kinks = vec![40.0, 41.0, 100.0];
}

#[test]
fn forces_of_penalties_are_the_gradient_of_their_energy_without_net_force_or_torque() {
    let mut model = penalty(20.0, 0.5);
    press_together(&mut model);
    let mut state = pair(&model);
    let mut ws = Workspace::new(&model);
    while state.time < 10.0 {
        step(&model, &mut state, &mut ws).unwrap();
    }
    // What was found where the last step began.
    let rows: Vec<Row> = ws.contact.rows.clone();
    let (start, law) = (ws.contact.start.clone(), Penalty { stiffness: 50.0, range: 0.1 * model.kinds[0].edge });
    let mut x = start.clone();
    let pressed = |x: &[Vec3]| {
        let mut force = vec![Vec3::zeros(); x.len()];
        (law.add_forces(&rows, &start, x, &mut force), force)
    };
    let force = pressed(&x).1;
    let size: f64 = force.iter().map(Vec3::norm).sum();
    assert!(size > 5.0, "they bear the load: {size}");
    let torque: Vec3 = x.iter().zip(&force).map(|(x, f)| x.cross(f)).sum();
    // Normals are kept with seven digits.
    assert!(force.iter().sum::<Vec3>().norm() < 1e-12 * size && torque.norm() < 1e-5 * size, "{torque} of {size}");
    // Once where they push, once where they are moved apart and those of atoms pull.
    for apart in [0.0, 0.3] {
        x[12..].iter_mut().for_each(|x| x.x += apart);
        let force = pressed(&x).1;
        for atom in 0..x.len() {
            for axis in 0..3 {
                let mut at = |shift: f64| {
                    x[atom][axis] += shift;
                    let energy = pressed(&x).0;
                    x[atom][axis] -= shift;
                    energy
                };
                // Normals have seven digits; round-off of the energy is 1e2 · 1e-16 / 1e-6.
                let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((slope + force[atom][axis]).abs() < 1e-6 * size, "{slope} against {}", force[atom][axis]);
            }
        }
    }
}

/// What is left of the impulse of a load on the second cell, over that impulse, when what penalties and drag bore is taken off.
fn impulse_left(tolerance: f64) -> f64 {
    let mut model = penalty(40.0, 0.0);
    press_together(&mut model);
    model.integrator.size = StepSize::Adaptive { tolerance, largest: 0.5 };
    let mut state = pair(&model);
    let mut ws = Workspace::new(&model);
    let mean = |state: &State| positions(&model, state)[12..].iter().sum::<Vec3>() / 12.0;
    let law = Penalty { stiffness: 50.0, range: model.contact.as_ref().unwrap().reach.proximity };
    // The push on the second cell with the contacts of a step, the mean of its begin and its end.
    let borne = |ws: &Workspace, state: &State| -> Vec3 {
        let at = |x: &[Vec3]| {
            let mut force = vec![Vec3::zeros(); x.len()];
            law.add_forces(&ws.contact.rows, &ws.contact.start, x, &mut force);
            force[12..].iter().sum::<Vec3>()
        };
        0.5 * (at(&ws.contact.start) + at(&positions(&model, state)))
    };
    let (mut impulse, mut began) = (Vec3::zeros(), None);
    while state.time < 38.0 {
        if state.time > 30.0 && began.is_none() {
            began = Some((state.time, mean(&state)));
        }
        let report = step(&model, &mut state, &mut ws).unwrap();
        if began.is_some() {
            impulse += report.dt * (borne(&ws, &state) - 5.0 * Vec3::x());
        }
    }
    let (time, atoms_at) = began.expect("there are steps after 30 s");
    let load = 5.0 * (state.time - time);
    let left = impulse - 20.0 * (mean(&state) - atoms_at);
    println!("{left:?} left of {load} pN s, in {} steps", state.step);
    left.norm() / load
}

#[test]
fn what_penalties_bear_of_a_load_and_what_drag_bears_add_up_as_steps_get_short() {
    // The push is the mean of those at a step's begin and end; what the scheme makes of it differs by what it changes in a step.
    let [long, short] = [3e-4, 3e-5].map(impulse_left);
    assert!(short < 0.5 * long && short < 0.01, "{long} and {short}");
}
