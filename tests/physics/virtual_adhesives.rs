//! Virtual adhesives: zones of contact that move as rigid bodies, let go of what is pulled by more than a displacement in a step, and
//! recruit, merge and die.

use crate::same_bits::{go_on, through_a_checkpoint};
use pseudopod::Vec3;
use pseudopod::contact::Reach;
use pseudopod::geometry::{Surface, Topology, icosphere, mean_edge_length, sheet};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::sim::contact::{AdhesiveTable, ContactModel, Law, Zones};
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{Kind, Model, Obstacle, State, Workspace, step};

/// Drag of an atom, pN s/µm.
const DRAG: f64 = 0.5;

/// A kind of one cell that keeps its shape with 5 pN/µm.
fn kind(name: &str, rest: Surface) -> Kind {
    let topology = Topology::of(&rest);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let energy = 5.0 * mean_edge_length(&rest).powi(2);
    let memory = ShapeMemory::new(&rest.positions, &rings, 5.0, Reaction::Exact);
    let barrier = Barrier::new(&rest.positions, &rest.facets, &topology.flaps, BarrierRules::with_energy(energy));
    let barrier = topology.is_closed().then_some(Force::Barrier(barrier));
    let mut kind = Kind::new(name, rest, [Force::ShapeMemory(memory)].into_iter().chain(barrier).collect());
    kind.drag = DRAG;
    kind
}

/// A cell of 42 atoms and 5 µm radius.
fn cell(name: &str) -> Kind {
    kind(name, icosphere(5.0, 1))
}

/// Pulls all atoms of a kind alike, each with a course of forces (s, pN).
fn pull(kind: &mut Kind, direction: Vec3, force: &[(f64, f64)]) {
    let atoms = (0..kind.atoms() as u32).map(|atom| (atom, 1.0)).collect();
    let force = Course::through(force.to_vec()).expect("times that rise");
    kind.forces.push(Force::Load(Load::new("pull", atoms, direction, force)));
}

/// A model in which all kinds are glued alike, with fixed steps.
fn model(mut kinds: Vec<Kind>, method: Method, dt: f64, until: f64, kappa: f64) -> Model {
    for kind in &mut kinds {
        kind.largest_stiffness = kind.measure_largest_stiffness();
        kind.bound_stiffness();
    }
    let near = 0.1 * kinds[0].edge;
    let integrator = Integrator { method, size: StepSize::Fixed(dt) };
    let mut contact =
        ContactModel::new(&kinds, &[], Reach { proximity: near, prediction: near, depth: near, margin: near });
    contact = contact.suited_to(integrator.size);
    let (between, on_obstacles) = (vec![kappa; kinds.len() * kinds.len()], Vec::new());
    contact.law = Law::VirtualAdhesives(AdhesiveTable { between, on_obstacles, zones: Zones::Merged });
    Model { contact: Some(contact), ..Model::of(kinds, integrator, until) }
}

const IMPLICIT: Method = Method::Implicit { order: Order::Second };

/// One cell of each kind, moved from where it is at rest.
fn state(model: &Model, at: &[Vec3]) -> State {
    let positions: Vec<_> = (model.kinds.iter().zip(at))
        .map(|(kind, at)| vec![kind.rest.positions.iter().map(|x| x + at).collect()])
        .collect();
    State::new(model, &positions)
}

fn positions(model: &Model, state: &State) -> Vec<Vec3> {
    let kinds = model.kinds.iter().zip(&state.kinds);
    kinds.flat_map(|(kind, now)| (0..now.cells()).flat_map(|cell| now.cell(kind, cell))).collect()
}

/// Goes on to the end, or until something is so.
fn run(model: &Model, state: &mut State, mut ended: impl FnMut(&State, &Workspace) -> bool) {
    let mut ws = Workspace::new(model);
    while state.time < model.until {
        step(model, state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble:?} in step {}", state.step));
        if ended(state, &ws) {
            return;
        }
    }
}

/// The adhesives of a state, each the list of its atoms.
fn adhesives(state: &State) -> Vec<Vec<u32>> {
    let adhesives = state.contact.adhesives.chunk_by(|one, other| one.adhesive == other.adhesive);
    adhesives.map(|atoms| atoms.iter().map(|one| one.atom).collect()).collect()
}

/// Two sheets of one mesh, 6 µm wide, one above the other within the proximity, drawn apart by a force an atom (s, pN).
fn sheets(method: Method, dt: f64, kappa: f64, force: &[(f64, f64)]) -> (Model, State) {
    let mut pair = [kind("low", sheet(6.0, 6.0, 6, 6)), kind("high", sheet(6.0, 6.0, 6, 6))];
    pull(&mut pair[0], -Vec3::z(), force);
    pull(&mut pair[1], Vec3::z(), force);
    let model = model(pair.into(), method, dt, 4.0, kappa);
    let state = state(&model, &[Vec3::zeros(), 0.02 * Vec3::z()]);
    (model, state)
}

#[test]
fn sheets_part_where_the_force_of_an_atom_would_move_it_by_more_than_kappa_in_a_step_and_hold_below() {
    for (method, steps) in [(IMPLICIT, [0.04, 0.02]), (Method::Explicit, [0.01, 0.005])] {
        for dt in steps {
            for (over, parts) in [(0.99, false), (1.01, true)] {
                // f dt/ζ is 0.99 or 1.01 κ.
                let kappa: f64 = 0.03;
                let force = over * kappa * DRAG / dt;
                let (model, mut state) = sheets(method, dt, kappa, &[(0.0, force), (4.0, force)]);
                let gap = |state: &State| {
                    let x = positions(&model, state);
                    (0..49).map(|atom| (x[49 + atom] - x[atom]).norm()).fold(f64::INFINITY, f64::min)
                };
                run(&model, &mut state, |_, _| false);
                let (gap, left) = (gap(&state), adhesives(&state));
                println!("{method:?}, {dt} s, {over} kappa: gap {gap} um");
                if parts {
                    assert!(left.is_empty(), "{left:?}");
                    // Free in all steps but the first.
                    let free = 2.0 * force / DRAG * (4.0 - dt) + 0.02;
                    assert!((gap - free).abs() < 1e-9 * free, "{gap} against {free}");
                } else {
                    assert_eq!(left, [(0..98).collect::<Vec<u32>>()]);
                    assert!((gap - 0.02).abs() < 1e-12, "{gap}");
                }
            }
        }
    }
}

#[test]
fn a_plane_holds_what_is_glued_to_it_below_kappa_and_lets_go_above_as_chemistry_scales_it() {
    let (dt, kappa) = (0.04, 0.03);
    // Chemistry's factor of the sheet's adhesion, and the displacement in a step over κ.
    for (factor, over, parts) in [(1.0, 0.99, false), (1.0, 1.01, true), (0.5, 0.495, false), (0.5, 0.505, true)] {
        let mut lone = kind("sheet", sheet(6.0, 6.0, 6, 6));
        let force: f64 = over * kappa * DRAG / dt;
        pull(&mut lone, Vec3::z(), &[(0.0, force), (4.0, force)]);
        let mut model = model(vec![lone], IMPLICIT, dt, 2.0, 0.0);
        model.obstacles = vec![Obstacle::plane("floor", Vec3::zeros(), Vec3::z())];
        let near = 0.1 * model.kinds[0].edge;
        let reach = Reach { proximity: near, prediction: near, depth: near, margin: near };
        let mut contact = ContactModel::new(&model.kinds, &model.obstacles, reach).suited_to(model.integrator.size);
        let table = AdhesiveTable { between: vec![0.0], on_obstacles: vec![kappa], zones: Zones::Merged };
        contact.law = Law::VirtualAdhesives(table);
        model.contact = Some(contact);
        let mut state = state(&model, &[0.02 * Vec3::z()]);
        state.chemistry.controls.adhesion = vec![factor];
        run(&model, &mut state, |_, _| false);
        let lowest = positions(&model, &state).iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        println!("factor {factor}, {over} kappa: {lowest} um");
        assert_eq!(adhesives(&state).is_empty(), parts, "{factor} {over}");
        // Free in all steps but the first, or where it was: a plane does not move.
        let height = if parts { 0.02 + force / DRAG * (2.0 - dt) } else { 0.02 };
        assert!((lowest - height).abs() < 1e-9 * height, "{lowest} against {height}");
    }
}

#[test]
fn an_adhesive_moves_as_one_through_large_rotations_and_the_pair_as_drag_lets_it() {
    // One side of the pair is pushed, so that it turns.
    let (mut model, mut state) = sheets(IMPLICIT, 0.02, 10.0, &[(0.0, 0.0), (4.0, 0.0)]);
    let force = Course::through(vec![(0.0, 6.0), (4.0, 6.0)]).unwrap();
    model.kinds[1].forces.push(Force::Load(Load::new("push", vec![(0, 1.0)], Vec3::z(), force)));
    let began = positions(&model, &state);
    run(&model, &mut state, |_, _| false);
    let now = positions(&model, &state);
    let clones = adhesives(&state).concat();
    assert_eq!(clones.len(), 98, "all hold");
    let lengths = |x: &[Vec3]| -> Vec<f64> {
        (0..98).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| (x[i] - x[j]).norm()).collect()
    };
    let worst = lengths(&began).iter().zip(lengths(&now)).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    let turned = (began[6] - began[0]).angle(&(now[6] - now[0])).max((began[42] - began[0]).angle(&(now[42] - now[0])));
    let mean = |x: &[Vec3]| x.iter().sum::<Vec3>() / 98.0;
    let drift = mean(&now) - mean(&began);
    println!("shape within {worst} um, turned by {turned}, drift {drift:?}");
    assert!(turned > 0.2, "there is a rotation to speak of: {turned}");
    // Two hundred steps of round-off.
    assert!(worst < 1e-12, "{worst}");
    // Total drag times drift is the impulse: 6 pN for 4 s.
    assert!((98.0 * DRAG * drift - 24.0 * Vec3::z()).norm() < 1e-9, "{drift:?}");
}

/// Two cells that are pressed on each other by a force an atom for 5 s, let go and drawn apart by another from 8 s on.
fn cells(dt: f64, until: f64, kappa: f64, press: f64, draw: f64) -> (Model, State) {
    let mut pair = [cell("left"), cell("right")];
    let course = [(0.0, press), (5.0, press), (5.5, 0.0), (8.0, 0.0), (8.5, -draw), (until, -draw)];
    pull(&mut pair[0], Vec3::x(), &course);
    pull(&mut pair[1], -Vec3::x(), &course);
    let model = model(pair.into(), IMPLICIT, dt, until, kappa);
    let state = state(&model, &[-5.1 * Vec3::x(), Vec3::new(5.1, 0.4, -0.3)]);
    (model, state)
}

#[test]
fn pressed_cells_recruit_atoms_keep_their_volumes_and_do_not_drift() {
    let (model, mut state) = cells(0.05, 9.0, 1.0, 0.5, 0.0);
    let mean = |state: &State| positions(&model, state).iter().sum::<Vec3>() / 84.0;
    let (began, mut sizes, mut worst, mut shape) = (mean(&state), Vec::new(), 0.0_f64, 0.0_f64);
    let mut energies = Vec::new();
    let mut before = positions(&model, &state);
    run(&model, &mut state, |state, ws| {
        sizes.push(state.contact.adhesives.len());
        if state.time > 5.5 {
            energies.push(measure_cells(&model, state).iter().map(|cell| cell.energy).sum::<f64>());
        }
        worst = measure_cells(&model, state).iter().map(|cell| cell.volume_error.abs()).fold(worst, f64::max);
        let now = positions(&model, state);
        // Of those of the step, before any is released.
        for of_one in ws.contact.law.adhesives.atoms.chunk_by(|one, other| one.adhesive == other.adhesive) {
            for one in of_one {
                let (i, j) = (one.atom as usize, of_one[0].atom as usize);
                shape = shape.max(((now[i] - now[j]).norm() - (before[i] - before[j]).norm()).abs());
            }
        }
        before = now;
        false
    });
    let drift = (mean(&state) - began).norm();
    println!("{:?} atoms, volume {worst}, drift {drift}, shapes within {shape} um a step", sizes.iter().max());
    let gained = energies.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::NEG_INFINITY, f64::max);
    println!(
        "left alone from {} to {} pN um, at most {gained} gained in a step",
        energies[0],
        energies[energies.len() - 1]
    );
    assert!(gained < 0.0, "left alone they lose energy in every step: {gained}");
    assert!(sizes.windows(2).any(|pair| pair[0] > 0 && pair[1] > pair[0]), "atoms are recruited: {sizes:?}");
    assert_eq!(adhesives(&state).len(), 1, "one zone of contact");
    assert!(worst < 1e-10, "{worst}");
    assert!(drift < 1e-11, "{drift}");
    // What the sweeps and the exact volume leave: a thousandth of what a sweep may move, 1e-4 of an edge.
    assert!(shape < 1e-6 * model.kinds[0].edge, "{shape}");
}

#[test]
fn cells_hold_below_the_load_that_their_adhesive_bears_and_part_above() {
    let dt = 0.05;
    for (draw, parts) in [(0.02, false), (1.0, true)] {
        let (kappa, until) = (0.1, 30.0);
        let (model, mut state) = cells(dt, until, kappa, 0.5, draw);
        let mut glued = 0;
        run(&model, &mut state, |state, _| {
            if state.time < 8.0 {
                glued = state.contact.adhesives.len() / 2;
            }
            false
        });
        let left = adhesives(&state);
        println!("{draw} pN an atom: {glued} atoms a side held, {left:?} left");
        // The 42 atoms of a cell are drawn with `draw` each, its clones bear κζ/dt at most; forces of shape add to that.
        let most = glued as f64 * kappa * DRAG / dt;
        if parts {
            assert!(42.0 * draw > 2.0 * most, "{most}");
            assert!(left.is_empty());
        } else {
            assert!(42.0 * draw < 0.5 * most, "{most}");
            assert!(!left.is_empty());
        }
    }
}

#[test]
fn an_adhesive_that_bridges_two_makes_them_one_unless_zones_are_kept_by_pair() {
    for (zones, last) in [(Zones::Merged, 1), (Zones::Pairs, 3)] {
        // Two sheets lie on a wide one that is held, and a third falls between them.
        let mut low = kind("low", sheet(12.0, 6.0, 12, 6));
        low.held = vec![0.0; 3 * low.atoms()];
        let high = || kind("high", sheet(3.0, 6.0, 3, 6));
        let mut middle = high();
        pull(&mut middle, -Vec3::z(), &[(0.0, 0.5), (2.0, 0.5)]);
        let mut model = model(vec![low, high(), high(), middle], IMPLICIT, 0.02, 1.0, 1.0);
        let contact = model.contact.as_mut().unwrap();
        contact.law = Law::VirtualAdhesives(AdhesiveTable { between: vec![1.0; 16], on_obstacles: Vec::new(), zones });
        let at = |x: f64, height: f64| Vec3::new(x, 0.0, height);
        let mut state = state(&model, &[at(0.0, 0.0), at(-4.0, 0.02), at(4.0, 0.02), at(0.0, 0.4)]);
        let mut numbers = Vec::new();
        run(&model, &mut state, |state, _| {
            numbers.push(adhesives(state).len());
            false
        });
        println!("{zones:?}: {numbers:?}");
        assert_eq!((numbers[0], numbers.last()), (2, Some(&last)), "{zones:?}");
        for atoms in adhesives(&state) {
            assert!(atoms.windows(2).all(|pair| pair[0] < pair[1]), "in order, each once");
        }
        // What holds the wide sheet holds all: nothing has moved but the one that fell, by what 50 steps of sweeps leave, each
        // a thousandth of 1e-4 of an edge of 1.2 µm at most.
        let x = positions(&model, &state);
        assert!((x[91].z - 0.02).abs() < 1e-7, "{}", x[91].z);
    }
}

#[test]
fn adhesives_go_on_from_a_checkpoint_to_the_same_bits_with_any_number_of_threads() {
    let (model, whole) = cells(0.05, 12.0, 0.05, 0.5, 0.3);
    let (mut parts, mut whole) = (whole.clone(), whole);
    go_on(&model, &mut whole, 1, 200);
    go_on(&model, &mut parts, 2, 90);
    assert!(!parts.contact.adhesives.is_empty());
    let mut parts = through_a_checkpoint(&parts);
    go_on(&model, &mut parts, 1, 110);
    assert_eq!(whole, parts);
}
