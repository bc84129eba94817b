//! Memory is part of the design: nothing is allocated in a step after the first, and an atom at rest costs few bytes.
//! A file of its own, because the allocator of a test program counts for all its tests; one test after the other.

#[path = "support/everything.rs"]
mod everything;

use everything::{after, everything};
use pseudopod::Vec3;
use pseudopod::cell::Behaviour;
use pseudopod::cell::motility::{BrownianMotility, Space};
use pseudopod::geometry::{Topology, icosphere};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::sim::{Kind, Model, Plane, State, Workspace, step};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The system's allocator, counted.
struct Counting;

static CALLS: AtomicUsize = AtomicUsize::new(0);
thread_local! {
    /// Whether this thread works on steps: threads of a pool that start or end, or of the test, do not count.
    static WORKS: Cell<bool> = const { Cell::new(false) };
}
static BYTES: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is handed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if WORKS.try_with(Cell::get).unwrap_or(false) {
            CALLS.fetch_add(1, Ordering::Relaxed);
        }
        BYTES.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller keeps the allocator's contract.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        BYTES.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What acts on the cells of a scene.
#[derive(Clone, Copy, PartialEq)]
enum Acting {
    Elastic,
    Loads,
    Planes,
    Motility,
}

fn scene(method: Method, acting: Acting, cells: usize) -> Model {
    let surface = icosphere(5.0, 1);
    let rings: Vec<Vec<u32>> = Topology::of(&surface).rings.into_iter().map(|ring| ring.atoms).collect();
    let memory = ShapeMemory::new(&surface.positions, &rings, 10.0, Reaction::Exact);
    let mut kind = Kind::new("cell", surface, vec![Force::ShapeMemory(memory)]);
    kind.bound_stiffness();
    let mut planes = Vec::new();
    match acting {
        Acting::Elastic => {}
        Acting::Loads => kind.forces.extend([pull(Vec3::z(), 0), pull(-Vec3::z(), 7)]),
        Acting::Planes => {
            let plane = |name: &str, side: f64| Plane {
                name: name.to_owned(),
                point: Vec3::new(0.0, 0.0, side * 4.9),
                normal: Vec3::new(0.0, 0.0, -side),
            };
            planes = vec![plane("floor", -1.0), plane("roof", 1.0)];
        }
        Acting::Motility => {
            // Runs so long that none ends: each that does is kept for the result, which is no scratch.
            let walk = BrownianMotility { speed: 0.1, persistence: 1e9, space: Space::Plane };
            kind.behaviours = vec![Behaviour::Brownian(walk)];
        }
    }
    let integrator = Integrator { method, size: StepSize::Fixed(0.01) };
    Model { planes, ..Model::of(vec![kind.for_cells(cells)], integrator, 1e9) }
}

fn pull(direction: Vec3, atom: u32) -> Force {
    Force::Load(Load::new("pull", vec![(atom, 1.0)], direction, Course::constant(1.0)))
}

/// Allocations of twenty steps, after a few that may size scratch for what they meet.
fn allocations(method: Method, acting: Acting, threads: usize) -> usize {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .start_handler(|_| WORKS.set(true))
        .exit_handler(|_| WORKS.set(false))
        .build()
        .unwrap();
    let model = scene(method, acting, 20);
    let positions = vec![model.kinds[0].rest.positions.clone(); 20];
    let (mut state, mut ws) = (State::new(&model, &[positions]), Workspace::new(&model));
    pool.install(|| {
        let mut run = |steps: usize| {
            for _ in 0..steps {
                step(&model, &mut state, &mut ws).unwrap();
            }
        };
        run(3);
        let before = CALLS.load(Ordering::Relaxed);
        run(20);
        CALLS.load(Ordering::Relaxed) - before
    })
}

/// Allocations of twenty steps in the scene that has everything: contacts, walks, fields, systems with events, links. Walks do not turn, for
/// each run that ends is kept for the result.
fn allocations_of_everything() -> usize {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .start_handler(|_| WORKS.set(true))
        .exit_handler(|_| WORKS.set(false))
        .build()
        .unwrap();
    let (model, start) = everything(Some("0.05 s"), "1000 h");
    pool.install(|| {
        // Until the cells lie where they stay, as long as their bonds take, and lists of contacts, and of what may become one, are as long
        // as they become; with noise in everything that takes a while.
        let (mut state, mut ws) = after(&model, start, 1000);
        let pulses = |state: &State| -> f64 { (0..3).map(|cell| state.chemistry.populations[0].state(cell, 3)).sum() };
        let contacts = |State { contact, .. }: &State| {
            [contact.atoms.len(), contact.edges.len(), contact.planes.len(), contact.bonds.len()]
        };
        state.ended_pseudopods.clear();
        let (mut calls, mut counted, mut with_events, mut most, mut since) = (0, 0, 0, contacts(&state), 0);
        for _ in 0..40 {
            let (before, pulsed) = (CALLS.load(Ordering::Relaxed), pulses(&state));
            step(&model, &mut state, &mut ws).unwrap();
            // As the recorder does now and then: pseudopods that end are kept for the result until then.
            state.ended_pseudopods.clear();
            let now = contacts(&state);
            since = if (0..4).any(|list| now[list] > most[list]) { 0 } else { since + 1 };
            most = std::array::from_fn(|list| most[list].max(now[list]));
            // Lists that become longer than they ever were take memory, in this state and in the next two, which have lists of their
            // own. All other steps, which are most, take none; in some of them events are executed.
            if since > 2 {
                (calls, counted) = (calls + CALLS.load(Ordering::Relaxed) - before, counted + 1);
                with_events += usize::from(pulses(&state) != pulsed);
            }
        }
        assert!(counted >= 10, "lists become longer now and then: {counted} steps of 40 without");
        assert!((1..counted).contains(&with_events), "events now and then: in {with_events} steps of {counted}");
        calls
    })
}

#[test]
fn steps_allocate_nothing_and_an_atom_costs_few_bytes() {
    let methods = [
        Method::Implicit { order: Order::First },
        Method::Implicit { order: Order::Second },
        Method::Explicit,
        Method::Euler,
        Method::SemiImplicitEuler,
        Method::Verlet,
        Method::RungeKutta4,
    ];
    for method in methods {
        for acting in [Acting::Elastic, Acting::Loads, Acting::Planes, Acting::Motility] {
            assert_eq!(allocations(method, acting, 1), 0, "{method:?} with scene {}", acting as usize);
        }
        // Idle threads of the pool now and then allocate for their own queues; ours would come in every step.
        let shared = allocations(method, Acting::Loads, 2);
        assert!(shared < 20, "{method:?} on two threads: {shared}");
    }
    assert_eq!(allocations_of_everything(), 0, "where there is everything");
    let before = BYTES.load(Ordering::Relaxed);
    let model = scene(Method::Implicit { order: Order::Second }, Acting::Elastic, 100_000);
    let positions = vec![model.kinds[0].rest.positions.clone(); 100_000];
    let (mut state, mut ws) = (State::new(&model, &[positions]), Workspace::new(&model));
    step(&model, &mut state, &mut ws).unwrap();
    let bytes = (BYTES.load(Ordering::Relaxed) - before) as f64 / state.atoms(&model) as f64;
    println!("{bytes:.0} bytes an atom on {} cells of {} atoms", state.cells(), model.kinds[0].atoms());
    assert!(bytes < 250.0, "{bytes}");
}
