use super::*;
use crate::cell::motility::Space;
use crate::cell::pseudopods::{Cycle, Several};
use crate::cell::turning::Turning;
use crate::geometry::icosphere;
use crate::mechanics::Force;
use crate::mechanics::course::Course;
use crate::mechanics::fibres::Fibres;
use crate::mechanics::integrator::{Integrator, Method, Order, StepSize};
use crate::mechanics::membrane::{Membrane, MembraneLaw};
use crate::sim::forces::add_forces;
use crate::sim::{Inertia, Kind, step};

const RULE: PodFibres = PodFibres { number: 5, stiffness: 0.3 };

const PODS: Pseudopods = Pseudopods {
    pressure: 4.0,
    reach: f64::INFINITY,
    least_cosine: 0.7,
    contraction: 0.0,
    fibres: Some(RULE),
    release: 1.0,
    cycle: Cycle { means: [1.0, 2.0, 3.0], variation: 0.5 },
    turning: Turning { split: 0.5, angle: 1.0, spread: 0.1, alternation: 0.7, space: Space::Plane },
    several: Several { most: 2, rate: 0.3 },
    abandon: None,
    inhibition: None,
};

/// A kind without a budget yet, and cells of it, each bent in another way.
fn bent(forces: Vec<Force>, cells: usize) -> (Kind, Vec<Vec<Vec3>>) {
    let rest = icosphere(5.0, 2);
    let bend = |cell: usize, x: &Vec3| {
        Vec3::new(1.3 * x.x + 0.02 * cell as f64 * x.y * x.y, 0.8 * x.y, x.z + 0.05 * x.x * x.y) + Vec3::repeat(3.0)
    };
    let positions = (0..cells).map(|cell| rest.positions.iter().map(|x| bend(cell, x)).collect()).collect();
    (Kind::new("cell", rest, forces).for_cells(cells), positions)
}

fn model_of(kind: Kind) -> Model {
    let size = StepSize::Fixed(0.25);
    Model::of(vec![kind], Integrator { method: Method::Implicit { order: Order::Second }, size }, 1e3)
}

const PAIRS: [[u32; 2]; 4] = [[0, 7], [3, 140], [3, 99], [161, 12]];

#[test]
fn a_fibre_that_was_made_pulls_as_one_that_was_always_there_to_the_last_bit() {
    for cells in [1, 11] {
        let constant = Fibres::new("all", PAIRS.into(), 0.7, Course::constant(0.6));
        let (kind, positions) = bent(vec![Force::Fibres(constant)], cells);
        let always = model_of(kind);
        let (kind, _) = bent(Vec::new(), cells);
        let made = model_of(Kind { fibre_budget: 6, ..kind });
        let mut forces = Vec::new();
        for model in [&always, &made] {
            let (mut state, mut ws) = (State::new(model, std::slice::from_ref(&positions)), Workspace::new(model));
            let (kind, now) = (&model.kinds[0], &mut state.kinds[0]);
            for cell in 0..if kind.fibre_budget > 0 { cells } else { 0 } {
                for atoms in PAIRS {
                    let fibre = Fibre { atoms, stiffness: 0.7, activation: 0.6 };
                    assert!(now.fibres.add(kind, cell, 0.0, None, fibre).is_some());
                }
            }
            add_forces(model, 0.0, &state, &mut ws);
            forces.push((ws.kinds[0].force.clone(), ws.kinds[0].energy.clone()));
        }
        assert_eq!(forces[0].0, forces[1].0, "{cells} cells");
        for (always, made) in forces[0].1.iter().zip(&forces[1].1) {
            // Round-off of a sum of four.
            assert!((always - made).abs() < 1e-14 * always && *made > 1.0, "{always} and {made}");
        }
    }
}

#[test]
fn forces_are_the_slope_of_the_energy_with_neither_sum_nor_torque() {
    let fibre = Fibre { atoms: [0, 1], stiffness: 0.7, activation: 0.6 };
    let [a, b] = [Vec3::new(1.0, -2.0, 0.5), Vec3::new(-3.0, 4.0, 2.5)];
    let (on_a, _) = fibre.pull(b - a);
    let step = 1e-4;
    for axis in 0..3 {
        let moved = |by: f64| fibre.pull(b - a - Vec3::from_fn(|i, _| if i == axis { by } else { 0.0 })).1;
        let slope = (moved(step) - moved(-step)) / (2.0 * step);
        // The energy is quadratic: nothing but round-off of an energy of 12 over the step.
        assert!((on_a[axis] + slope).abs() < 1e-10, "{} and {}", on_a[axis], -slope);
    }
    // The other end has the opposite: the torque is what is left along their line.
    assert!((a.cross(&on_a) - b.cross(&on_a)).norm() < 1e-14 * on_a.norm() * b.norm());
}

/// Soft cells that have pseudopods with fibres, where steps begin.
fn cell_with_pods(cells: usize) -> (Model, State, Workspace) {
    let rest = icosphere(5.0, 2);
    let skin = Membrane::new(&rest.positions, &rest.facets, MembraneLaw::Skalak { shear: 20.0, area: 40.0 });
    let (kind, positions) = bent(vec![Force::Membrane(skin)], cells);
    let mut kind =
        Kind { behaviours: vec![Behaviour::Pseudopods(PODS)], fibre_budget: 2 * RULE.number, drag: 10.0, ..kind };
    kind.bound_stiffness();
    let model = model_of(kind);
    let (state, ws) = (State::new(&model, &[positions]), Workspace::new(&model));
    (model, state, ws)
}

#[test]
fn fibres_come_when_a_pseudopod_begins_to_retract_and_go_when_that_has_ended() {
    let (model, mut state, mut ws) = cell_with_pods(3);
    let kind = &model.kinds[0];
    let (mut seen, mut came, mut most, mut before) = (0, 0, 0, state.clone());
    for _ in 0..200 {
        step(&model, &mut state, &mut ws).unwrap();
        let now = &state.kinds[0];
        for cell in 0..now.cells() {
            let BehaviourState::Pseudopods(pods) = now.behaviours[0][cell] else { panic!() };
            most = most.max(pods.did.iter().filter(|did| did.retraction > 0.0).count());
            let retracts: Vec<&Activity> = pods.did.iter().filter(|did| did.retraction > 0.0).collect();
            let fibres: Vec<_> = now.fibres.of_cell(kind, cell).collect();
            assert_eq!(fibres.len(), RULE.number * retracts.len());
            seen += fibres.len();
            let mut ends: Vec<u32> = fibres.iter().flat_map(|made| made.fibre.atoms).collect();
            ends.sort_unstable();
            ends.dedup();
            assert!(retracts.len() != 1 || ends.len() == 2 * fibres.len(), "each has atoms of its own");
            for made in fibres {
                let did = retracts.iter().find(|did| Some(did.number) == made.pod).expect("its pseudopod retracts");
                assert_eq!((made.fibre.activation, made.fibre.stiffness), (did.retraction, RULE.stiffness));
                let is_new = before.kinds[0].fibres.of_cell(kind, cell).all(|known| known.number != made.number);
                assert_eq!(is_new, made.since == before.time, "a fibre keeps its number while it is there");
                if is_new {
                    came += 1;
                    let positions = Positions { kind, now: &before.kinds[0], cell };
                    let (centre, ahead) = (positions.centre(), Vec3::from(did.direction));
                    for (atom, direction) in made.fibre.atoms.into_iter().zip([ahead, -ahead]) {
                        assert!(positions.share(&PODS, atom as usize, (&centre, &direction)) > 0.0);
                    }
                }
            }
        }
        before = state.clone();
    }
    assert!(seen > 500 && came > 20 * RULE.number && most == 2, "{seen} fibres seen, {came} came, of {most} at once");
    let made: u64 = state.kinds[0].fibres.made.iter().sum();
    assert_eq!(made, came as u64, "each is counted once");
}

#[test]
fn atoms_are_as_likely_as_they_belong_to_front_and_rear() {
    let (kind, positions) = bent(Vec::new(), 1);
    let kind = Kind { fibre_budget: 1, ..kind };
    let now = KindState::new(&kind, &positions, 0, Inertia::OverDamped, 1);
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let (centre, ahead) = (positions.centre(), Vec3::new(0.6, 0.8, 0.0));
    let pods = 20_000;
    let mut counts = [vec![0; kind.atoms()], vec![0; kind.atoms()]];
    for number in 0..pods {
        let mut fibres = FibreState::new(&kind, 1);
        let did = Activity { direction: ahead.into(), protrusion: 0.0, retraction: 1.0, number };
        let rule = PodFibres { number: 1, ..RULE };
        make(&positions, (&PODS, rule), &did, (1, 0.0), &mut fibres);
        let atoms = fibres.of_cell(&kind, 0).next().expect("one is made").fibre.atoms;
        counts.iter_mut().zip(atoms).for_each(|(counts, atom)| counts[atom as usize] += 1);
    }
    for (counts, direction) in counts.iter().zip([ahead, -ahead]) {
        let shares: Vec<f64> =
            (0..kind.atoms()).map(|atom| positions.share(&PODS, atom, (&centre, &direction))).collect();
        let whole: f64 = shares.iter().sum();
        for (count, share) in counts.iter().zip(&shares) {
            let chance = share / whole;
            let error = (chance * (1.0 - chance) / f64::from(pods)).sqrt();
            // Four standard errors: of some fifty atoms one in three hundred seeds has one beyond.
            assert!((f64::from(*count) / f64::from(pods) - chance).abs() <= 4.0 * error, "{count}, {chance}");
        }
    }
}

#[test]
fn a_budget_that_is_used_up_and_a_front_that_is_too_small_make_fewer_fibres() {
    let (kind, positions) = bent(Vec::new(), 2);
    let kind = Kind { fibre_budget: 100, ..kind };
    let now = KindState::new(&kind, &positions, 0, Inertia::OverDamped, 1);
    let positions = Positions { kind: &kind, now: &now, cell: 1 };
    let (centre, ahead) = (positions.centre(), Vec3::x());
    let in_end = |direction: &Vec3| {
        (0..kind.atoms()).filter(|atom| positions.share(&PODS, *atom, (&centre, direction)) > 0.0).count()
    };
    let fewest = in_end(&ahead).min(in_end(&-ahead));
    let did = Activity { direction: ahead.into(), protrusion: 0.0, retraction: 1.0, number: 3 };
    let mut fibres = FibreState::new(&kind, 2);
    make(&positions, (&PODS, PodFibres { number: 100, ..RULE }), &did, (1, 0.0), &mut fibres);
    assert_eq!([0, 1].map(|cell| fibres.of_cell(&kind, cell).count()), [0, fewest]);
    assert!((5..100).contains(&fewest), "{fewest}");
}
