//! The whole step and its contacts in packed populations of cells of 42 atoms, each with exactly its volume: processor
//! time, what contacts take of it, and memory. The cells begin on a lattice where they just touch, and a pull to
//! the middle packs them before anything is measured.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use pseudopod::Vec3;
use pseudopod::contact::{Contacts, Detector, Reach};
use pseudopod::geometry::{Topology, icosphere, mean_edge_length};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::attraction::Attraction;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::sim::contact::{ContactModel, Strength, find_contacts};
use pseudopod::sim::{Kind, Model, State, Workspace, step};

/// Bytes held now.
static HELD: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: every call goes on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.fetch_add(layout.size(), Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Steps of which the parts are timed.
const STEPS: u32 = 40;

/// Steps of atoms that are timed, at least: a contact that lets go in a small population makes
/// some steps dearer, so that many are needed to tell what one costs.
const ATOMS_TIMED: u32 = 400_000;

/// A population that is being pulled together, and its start.
fn population(cells: usize, largest: f64) -> (Model, State) {
    let rest = icosphere(5.0, 1);
    let topology = Topology::of(&rest);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let energy = 5.0 * mean_edge_length(&rest).powi(2);
    let memory = ShapeMemory::new(&rest.positions, &rings, 5.0, Reaction::Exact);
    let barrier = Barrier::new(&rest.positions, &rest.facets, &topology.flaps, BarrierRules::with_energy(energy));
    let mut kind = Kind::new("cell", rest.clone(), vec![Force::ShapeMemory(memory), Force::Barrier(barrier)]);
    kind.drag = 20.0 / 42.0;
    // The same pressure in the middle, however many there are.
    let stiffness = 0.05 * (25.0 / cells as f64).powf(2.0 / 3.0);
    kind.forces.push(Force::Attraction(Attraction { to: Vec3::zeros(), stiffness }));
    kind.largest_stiffness = kind.measure_largest_stiffness();
    let mut kind = kind.for_cells(cells);
    kind.bound_stiffness();
    let size = StepSize::Adaptive { tolerance: 1e-3, largest };
    let integrator = Integrator { method: Method::Implicit { order: Order::Second }, size };
    let mut model = Model::of(vec![kind], integrator, f64::MAX);
    let near = 0.1 * model.kinds[0].edge;
    let mut contact =
        ContactModel::new(&model.kinds, &[], Reach { proximity: near, prediction: near, depth: near, margin: near });
    contact.stick(0, 0, Strength { tensile: 0.2, shear: 0.2, energy: 0.0 });
    model.contact = Some(contact.suited_to(size));
    let side = (1..).find(|side: &usize| side.pow(3).div_ceil(2) >= cells).expect("a cube large enough");
    let sites = (0..side.pow(3)).map(|site| [site / side / side, site / side % side, site % side]);
    let middle = Vec3::repeat(0.5 * (side - 1) as f64);
    let positions = sites.filter(|site| site.iter().sum::<usize>() % 2 == 0).take(cells).map(|site| {
        let centre = (Vec3::from(site.map(|index| index as f64)) - middle) * (2f64.sqrt() * 5.02);
        rest.positions.iter().map(|x| x + centre).collect()
    });
    let state = State::new(&model, &[positions.collect()]);
    (model, state)
}

/// Seconds of processor time, for one thread where the system tells, so that other programs do not count; or else seconds
/// on the clock.
fn seconds(since: &Instant, threads: usize) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok().filter(|_| threads == 1);
    let nanoseconds = told.and_then(|told| told.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |n| 1e-9 * n)
}

/// The positions of all atoms, in the order of cells.
fn positions(model: &Model, state: &State) -> Vec<Vec3> {
    let kind = &model.kinds[0];
    (0..state.cells()).flat_map(|cell| state.kinds[0].cell(kind, cell)).collect()
}

/// Packs a population and prints what its steps cost.
fn measure(cells: usize, threads: usize, pack: f64) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let (clock, before) = (Instant::now(), HELD.load(Ordering::Relaxed));
        let now = || seconds(&clock, threads);
        let (model, mut state) = population(cells, 0.2);
        let mut ws = Workspace::new(&model);
        while state.time < pack {
            step(&model, &mut state, &mut ws).expect("a step");
        }
        let (mut tries, mut sweeps, mut contacts) = (0, 0, 0);
        let steps = (ATOMS_TIMED / state.atoms(&model) as u32).max(STEPS);
        let (began, start) = (now(), state.time);
        for _ in 0..steps {
            let done = step(&model, &mut state, &mut ws).expect("a step");
            tries += 1 + done.refused;
            sweeps += ws.contact.sweeps;
            contacts += ws.contact.rows.len();
        }
        let (seconds, simulated) = (now() - began, state.time - start);
        let bytes = (HELD.load(Ordering::Relaxed) - before) as f64 / state.atoms(&model) as f64;
        // The same cells as if they passed through each other: the rest of the step.
        let (alone, mut trial) = (Model { contact: None, ..model.clone() }, state.clone());
        let mut spare = Workspace::new(&alone);
        step(&alone, &mut trial, &mut spare).expect("a step");
        let (began, mut others) = (now(), 0);
        for _ in 0..STEPS {
            others += 1 + step(&alone, &mut trial, &mut spare).expect("a step").refused;
        }
        let without = now() - began;
        let (mut finding, mut detecting) = (0.0, 0.0);
        let (mut detector, mut found) = (Detector::default(), Contacts::default());
        let scene = &model.contact.as_ref().expect("contacts").scene_of(&state.kinds).scene;
        detector.detect(scene, &positions(&model, &state), &mut found);
        for _ in 0..STEPS {
            step(&model, &mut state, &mut ws).expect("a step");
            // The first takes what the step found at its end.
            find_contacts(&model, &state, &mut ws);
            // Shorter than the parts in which the system counts processor time.
            let began = Instant::now();
            find_contacts(&model, &state, &mut ws);
            finding += began.elapsed().as_secs_f64();
            // Pairs are collected anew as often as in the step.
            let positions = positions(&model, &state);
            let began = Instant::now();
            detector.detect(scene, &positions, &mut found);
            detecting += began.elapsed().as_secs_f64();
        }
        let each = |seconds: f64, count: u32| 1e3 * seconds / f64::from(count);
        println!(
            "{cells:6} {threads:8} {:10.3} {:10.2} {:10.2} {:10.3} {:8.1} {:12.1} {:10.2} {:10.2} {:10.3} {:10.0}",
            seconds / simulated,
            each(seconds, steps),
            each(seconds, tries),
            1e-6 * state.atoms(&model) as f64 * f64::from(tries) / seconds,
            f64::from(sweeps) / f64::from(steps),
            contacts as f64 / f64::from(steps) / cells as f64,
            each(seconds, tries) - each(without, others),
            each(finding, STEPS),
            each(detecting, STEPS),
            bytes,
        );
    });
}

fn main() {
    println!(
        "{:>6} {:>8} {:>10} {:>10} {:>10} {:>10} {:>8} {:>12} {:>10} {:>10} {:>10} {:>10}",
        "cells",
        "threads",
        "s a second",
        "ms a step",
        "ms a try",
        "Matom/s",
        "sweeps",
        "rows a cell",
        "contact ms",
        "find ms",
        "detect ms",
        "B an atom"
    );
    // `--large` adds 10 000 cells; numbers of cells measure these alone, and `--single` on one thread only.
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let [large, single] = ["--large", "--single"].map(|word| asked.iter().any(|argument| argument == word));
    let chosen: Vec<usize> = asked.iter().filter_map(|argument| argument.parse().ok()).collect();
    // The pull draws 1 000 and 10 000 cells together by the same part, and a smaller population farther.
    for (cells, pack) in [(25, 40.0), (100, 20.0), (1000, 6.0), (10_000, 28.0)] {
        for threads in [1, 2] {
            let wanted = if chosen.is_empty() { cells < 10_000 || large } else { chosen.contains(&cells) };
            if wanted && (threads == 1 || !single) {
                measure(cells, threads, pack);
            }
        }
    }
}
