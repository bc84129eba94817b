//! The elastic kernel and the whole step, measured side by side; the ratios that matter are printed from one run.

use std::hint::black_box;
use std::time::Instant;

use pseudopod::Vec3;
use pseudopod::geometry::{Topology, icosphere};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::lanes::LANES;
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory, reference};
use pseudopod::mechanics::sum::measure_elastic;
use pseudopod::sim::{Kind, Model, State, Workspace, step};

/// A kind of cells of 42 atoms (level 1) or more, with shape memory alone.
fn kind(level: u32, cells: usize) -> Kind {
    let surface = icosphere(5.0, level);
    let rings: Vec<Vec<u32>> = Topology::of(&surface).rings.into_iter().map(|ring| ring.atoms).collect();
    let memory = ShapeMemory::new(&surface.positions, &rings, 10.0, Reaction::Exact);
    let mut kind = Kind::new("cell", surface, vec![Force::ShapeMemory(memory)]);
    kind.bound_stiffness();
    kind.for_cells(cells)
}

fn model(kind: Kind, method: Method, dt: f64) -> Model {
    let integrator = Integrator { method, size: StepSize::Fixed(dt) };
    Model::of(vec![kind], integrator, 1e9)
}

fn stretched(kind: &Kind) -> Vec<Vec3> {
    kind.rest.positions.iter().map(|p| Vec3::new(p.x / 1.1, p.y / 1.1, p.z * 1.21)).collect()
}

/// Seconds of the fastest of several rounds: the least disturbed one.
fn fastest(rounds: usize, mut work: impl FnMut()) -> f64 {
    work();
    let time = |_| {
        let began = Instant::now();
        work();
        began.elapsed().as_secs_f64()
    };
    (0..rounds).map(time).fold(f64::INFINITY, f64::min)
}

/// Million atoms a second of the plain scalar reference.
fn reference_rate() -> f64 {
    let kind = kind(1, 1);
    let Force::ShapeMemory(memory) = &kind.forces[0] else { unreachable!("the kind has shape memory alone") };
    let x = stretched(&kind);
    let mut f = vec![Vec3::zeros(); x.len()];
    let repeats = 2000;
    let seconds = fastest(9, || {
        for _ in 0..repeats {
            black_box(reference::add_forces(memory, black_box(&x), &mut f));
        }
    });
    1e-6 * (repeats * x.len()) as f64 / seconds
}

/// Million atoms a second of the kernel over lanes.
fn lane_rate() -> f64 {
    let kind = kind(1, LANES);
    let x: Vec<f64> = stretched(&kind).iter().flat_map(|p| [p.x, p.y, p.z]).flat_map(|v| [v; LANES]).collect();
    let (mut f, mut energy) = (vec![0.0; x.len()], [0.0; LANES]);
    let repeats = 1000;
    let seconds = fastest(9, || {
        for _ in 0..repeats {
            measure_elastic(&kind.forces, LANES, black_box(&x), &mut f, &mut energy);
        }
    });
    1e-6 * (repeats * kind.atoms() * LANES) as f64 / seconds
}

/// Million atom-steps a second of whole steps.
fn step_rate(cells: usize, threads: usize, method: Method) -> f64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
    let model = model(kind(1, cells), method, 0.2);
    let position = stretched(&model.kinds[0]);
    let (mut state, mut ws) = (State::new(&model, &[vec![position; cells]]), Workspace::new(&model));
    let steps = (20_000 / cells).clamp(2, 2000);
    let seconds = pool.install(|| {
        fastest(3, || {
            for _ in 0..steps {
                step(&model, &mut state, &mut ws).expect("a relaxing cell steps");
            }
        })
    });
    1e-6 * (steps * cells * model.kinds[0].atoms()) as f64 / seconds
}

fn main() {
    let (scalar, lanes) = (reference_rate(), lane_rate());
    println!(
        "elastic forces, 42 atoms: reference {scalar:.2}, lanes {lanes:.2} M atoms/s; ratio {:.2} (aim 3)",
        lanes / scalar
    );
    for (name, order) in [("first order", Order::First), ("second order", Order::Second)] {
        for cells in [1, 1000, 100_000] {
            for threads in [1, 2] {
                let rate = step_rate(cells, threads, Method::Implicit { order });
                println!(
                    "step, {name}, {cells} cells, {threads} threads: {rate:.2} M atom-steps/s; over the reference's forces {:.2}",
                    rate / scalar
                );
            }
        }
    }
}
