//! Memory is part of the design: nothing is allocated in a step after the first, and an atom at rest costs few bytes.
//! A file of its own, because the allocator of a test program counts for all its tests; one test after the other.

#[path = "support/everything.rs"]
mod everything;

use everything::{after, everything};
use pseudopod::Vec3;
use pseudopod::cell::Behaviour;
use pseudopod::cell::motility::{BrownianMotility, Space};
use pseudopod::equations::eml;
use pseudopod::error::Source;
use pseudopod::experiment::{Compiled, Document, compile};
use pseudopod::field::{FieldSystem, Grid, Stepping};
use pseudopod::geometry::{Topology, icosphere};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::sim::{Kind, Model, Obstacle, State, Workspace, step};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;
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
    /// A program.
    Forces,
}

fn scene(method: Method, acting: Acting, cells: usize) -> Model {
    let surface = icosphere(5.0, 1);
    let rings: Vec<Vec<u32>> = Topology::of(&surface).rings.into_iter().map(|ring| ring.atoms).collect();
    let memory = ShapeMemory::new(&surface.positions, &rings, 10.0, Reaction::Exact);
    let mut kind = Kind::new("cell", surface, vec![Force::ShapeMemory(memory)]);
    kind.bound_stiffness();
    let mut planes = Vec::new();
    match acting {
        // What a program exerts is in the state.
        Acting::Elastic | Acting::Forces => {}
        Acting::Loads => kind.forces.extend([pull(Vec3::z(), 0), pull(-Vec3::z(), 7)]),
        Acting::Planes => {
            let plane = |name: &str, side: f64| Obstacle::plane(name, 4.9 * side * Vec3::z(), -side * Vec3::z());
            planes = vec![plane("floor", -1.0), plane("roof", 1.0)];
        }
        Acting::Motility => {
            // Runs so long that none ends: each that does is kept for the result, which is no scratch.
            let walk = BrownianMotility { speed: 0.1, persistence: 1e9, space: Space::Plane };
            kind.behaviours = vec![Behaviour::Brownian(walk)];
        }
    }
    let integrator = Integrator { method, size: StepSize::Fixed(0.01) };
    Model { obstacles: planes, ..Model::of(vec![kind.for_cells(cells)], integrator, 1e9) }
}

fn pull(direction: Vec3, atom: u32) -> Force {
    Force::Load(Load::new("pull", vec![(atom, 1.0)], direction, Course::constant(1.0)))
}

/// Threads whose allocations count.
fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .start_handler(|_| WORKS.set(true))
        .exit_handler(|_| WORKS.set(false))
        .build()
        .unwrap()
}

/// Allocations of twenty steps, after a few that may size scratch for what they meet.
fn allocations(method: Method, acting: Acting, threads: usize) -> usize {
    let pool = pool(threads);
    let model = scene(method, acting, 20);
    let positions = vec![model.kinds[0].rest.positions.clone(); 20];
    let (mut state, mut ws) = (State::new(&model, &[positions]), Workspace::new(&model));
    if acting == Acting::Forces {
        state.chemistry.controls.atom_forces = vec![Vec3::x(); state.atoms(&model)];
    }
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

/// Steps that were made, and those of them that took memory.
#[derive(Debug, Default)]
struct Taking {
    steps: usize,
    taking: usize,
}

impl Taking {
    fn count(&mut self, calls: usize) {
        (self.steps, self.taking) = (self.steps + 1, self.taking + usize::from(calls > 0));
    }
}

/// Steps in the scene that has everything: contacts, walks, fields, systems with events, links; all of them, and those in which events are
/// executed. Walks do not turn, for each run that ends is kept for the result.
fn taking_of_everything() -> [Taking; 2] {
    let pool = pool(1);
    let (model, start) = everything(Some("0.05 s"), "1000 h");
    pool.install(|| {
        // Until the cells lie where they stay and their bonds are as many as they become.
        let (mut state, mut ws) = after(&model, start, 1000);
        let own =
            model.chemistry.reactors.iter().position(|reactor| reactor.name == "own").expect("each walker has it");
        let own = |state: &State, cell: usize| state.chemistry.populations[own].state(cell, 3);
        let pulses = |state: &State| -> f64 { (0..3).map(|cell| own(state, cell)).sum() };
        let [mut all, mut with_events] = <[Taking; 2]>::default();
        for _ in 0..400 {
            // As the recorder does now and then: pseudopods that end are kept for the result until then.
            state.ended_pseudopods.clear();
            let (before, pulsed) = (CALLS.load(Ordering::Relaxed), pulses(&state));
            step(&model, &mut state, &mut ws).unwrap();
            let calls = CALLS.load(Ordering::Relaxed) - before;
            all.count(calls);
            if pulses(&state) != pulsed {
                with_events.count(calls);
            }
        }
        [all, with_events]
    })
}

/// Allocations of five windows of fields that are carried in all ways, after the first two.
fn taking_of_transport() -> usize {
    let text = "<eml name=\"all\"><grid dimension=\"2\" spacing=\"1\" origin=\"0 0\" size=\"20 16\"/>
        <field id=\"c\" diffusion=\"0.5 + 0.1*c\" decay=\"0.01\" initial=\"piecewise(1, x lt 5, 0)\">
        <advection x=\"1 + sin(time)\" y=\"0.1*x\"/><taxis towards=\"s\" sensitivity=\"1/(1 + s)^2\"/>
        <source from=\"2 2\" to=\"9 4\" strength=\"3*time\"/><wall side=\"x-\" kind=\"flux\" value=\"0.5*(2 - c)\"/>
        <wall side=\"x+\" kind=\"open\"/><wall side=\"y+\" kind=\"fixed\" value=\"1 + 0.1*x*time\"/></field>
        <field id=\"s\" diffusion=\"2\" decay=\"0.5\" initial=\"0\"><reaction>c</reaction></field></eml>";
    let source = Arc::new(Source { name: "all.eml".into(), text: text.into() });
    let system = FieldSystem::new(&eml::read(source).unwrap(), None).unwrap();
    let mut fields = system.start(&|_: &eml::Profile, _: &Grid| Ok(Vec::new())).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).start_handler(|_| WORKS.set(true)).build().unwrap();
    pool.install(|| {
        let mut before = 0;
        for window in 0..7 {
            if window == 2 {
                before = CALLS.load(Ordering::Relaxed);
            }
            let stepping = Stepping::Adaptive { relative: 3e-3, absolute: 0.0 };
            system.advance(&mut fields, 0.3, &[], stepping).unwrap();
        }
        CALLS.load(Ordering::Relaxed) - before
    })
}

/// Steps of two drops that stick so firmly that the matrix of the step reaches from one to the other, eq. (step.12).
fn taking_of_drops() -> Taking {
    let drop = |name: &str, x: f64| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nplacement = {{ at = [[\"{x} um\", \"0.1 um\", \"0 um\"]] }}\n\
             mechanics = {{ drag = \"200 pN s/um\", membrane = {{ law = \"neo_hookean\", shear = \"0 uN/m\", area = \"0 uN/m\", tension = \"100 uN/m\", ordering = \"2 uN/m\" }} }}\n"
        )
    };
    let text = format!(
        "title = \"two drops\"\n[run]\nuntil = \"1 h\"\nintegrator = {{ max_step = \"0.02 s\" }}\n[output]\nevery = \"1 h\"\n{}{}\
         [contact]\nstrength = \"200 pN/um^2\"\nshear_strength = \"0 Pa\"\nenergy = \"150 uN/m\"\n",
        drop("left", -5.02),
        drop("right", 5.02)
    );
    let document = Document::parse("drops.toml", &text, Path::new("."), &[]).unwrap();
    let Compiled { model, mut state, .. } = compile(&document).unwrap();
    let pool = pool(1);
    let mut ws = Workspace::new(&model);
    pool.install(|| {
        let mut all = Taking::default();
        for number in 0..500 {
            let before = CALLS.load(Ordering::Relaxed);
            step(&model, &mut state, &mut ws).unwrap();
            if number >= 300 {
                all.count(CALLS.load(Ordering::Relaxed) - before);
            }
        }
        all
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
    assert_eq!(taking_of_transport(), 0, "fields that are carried");
    for method in methods {
        for acting in [Acting::Elastic, Acting::Loads, Acting::Planes, Acting::Motility, Acting::Forces] {
            assert_eq!(allocations(method, acting, 1), 0, "{method:?} with scene {}", acting as usize);
        }
        // Idle threads of the pool now and then allocate for their own queues; ours would come in every step.
        let shared = allocations(method, Acting::Loads, 2);
        assert!(shared < 20, "{method:?} on two threads: {shared}");
    }
    // With noise in everything, a list of pairs is longer now and then than it ever was; what took memory by itself would do so in every
    // step, or in every one with an event.
    let [all, with_events] = taking_of_everything();
    println!("where there is everything: {all:?}, with events {with_events:?}");
    assert!(20 * all.taking <= all.steps, "{all:?}");
    assert!(with_events.steps >= 10 && 4 * with_events.taking <= with_events.steps, "{with_events:?}");
    // Solvers of steps of new lengths are made now and then.
    let drops = taking_of_drops();
    println!("drops: {drops:?}");
    assert!(10 * drops.taking <= drops.steps, "{drops:?}");
    let before = BYTES.load(Ordering::Relaxed);
    let model = scene(Method::Implicit { order: Order::Second }, Acting::Elastic, 100_000);
    let positions = vec![model.kinds[0].rest.positions.clone(); 100_000];
    let (mut state, mut ws) = (State::new(&model, &[positions]), Workspace::new(&model));
    step(&model, &mut state, &mut ws).unwrap();
    let bytes = (BYTES.load(Ordering::Relaxed) - before) as f64 / state.atoms(&model) as f64;
    println!("{bytes:.0} bytes an atom on {} cells of {} atoms", state.cells(), model.kinds[0].atoms());
    assert!(bytes < 250.0, "{bytes}");
}
