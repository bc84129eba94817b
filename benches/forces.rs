//! Every force and the volume projection, one after the other on the same cells; rates and ratios of one run.

use std::hint::black_box;
use std::time::Instant;

use pseudopod::Vec3;
use pseudopod::geometry::{Surface, Topology, icosphere};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::angles::Angles;
use pseudopod::mechanics::attraction::Attraction;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::bending::{Bending, RestAngle};
use pseudopod::mechanics::control::Context;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::fibres::Fibres;
use pseudopod::mechanics::gravity::Gravity;
use pseudopod::mechanics::lanes::LANES;
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::membrane::{Membrane, MembraneLaw};
use pseudopod::mechanics::ordering::Ordering;
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::mechanics::springs::Springs;
use pseudopod::mechanics::sum::measure_forces;
use pseudopod::mechanics::tension::Tension;
use pseudopod::mechanics::volume;

/// Every force, all on the same mesh.
fn forces(surface: &Surface) -> Vec<(&'static str, Force)> {
    let topology = Topology::of(surface);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let (x, facets) = (&surface.positions, &surface.facets);
    let memory = |reaction| Force::ShapeMemory(ShapeMemory::new(x, &rings, 10.0, reaction));
    let membrane = |law| Force::Membrane(Membrane::new(x, facets, law));
    let rules = BarrierRules { energy: 1.0, area_share: 0.2, fold_angle: 2.0 };
    let neo_hookean = MembraneLaw::NeoHookean { shear: 2.5, area: 50.0, hardening: 0.0 };
    let atoms = (0..x.len() as u32 / 10).map(|atom| (atom, 0.1)).collect();
    let pairs = (0..x.len() as u32 / 2).map(|atom| [atom, x.len() as u32 - 1 - atom]).collect();
    vec![
        ("shape memory, exact", memory(Reaction::Exact)),
        ("shape memory, spread", memory(Reaction::Spread)),
        ("shape memory, angles", Force::Angles(Angles::new(x, &rings, 10.0))),
        ("membrane, Skalak", membrane(MembraneLaw::Skalak { shear: 2.5, area: 50.0 })),
        ("membrane, neo-Hookean", membrane(neo_hookean)),
        ("tension and total area", Force::Tension(Tension::new(x, facets, 10.0, 5.0))),
        ("ordering", Force::Ordering(Ordering::new(x.len(), facets, 1.0))),
        ("bending", Force::Bending(Bending::new(x, &topology, 0.2, RestAngle::Flat))),
        ("springs on edges", Force::Springs(Springs::on_edges(x, &topology.edges, 10.0))),
        ("barrier at rest", Force::Barrier(Barrier::new(x, facets, &topology.flaps, rules))),
        ("load on a tenth", Force::Load(Load::new("pull", atoms, Vec3::z(), Course::constant(3.0)))),
        ("fibres across", Force::Fibres(Fibres::new("trunk", pairs, 2.0, Course::constant(1.0)))),
        ("gravity", Force::Gravity(Gravity { acceleration: -9.8 * Vec3::z() })),
        ("attraction", Force::Attraction(Attraction { to: Vec3::zeros(), stiffness: 0.1 })),
    ]
}

/// Seconds of the fastest of nine rounds: the least disturbed one.
fn fastest(mut work: impl FnMut()) -> f64 {
    work();
    let time = |_| {
        let began = Instant::now();
        work();
        began.elapsed().as_secs_f64()
    };
    (0..9).map(time).fold(f64::INFINITY, f64::min)
}

/// The cell drawn out a little, once for each lane.
fn positions(surface: &Surface, lanes: usize) -> Vec<f64> {
    let drawn = |p: &Vec3| [p.x / 1.1, p.y / 1.1, p.z * 1.21];
    surface.positions.iter().flat_map(drawn).flat_map(|value| vec![value; lanes]).collect()
}

/// Million atoms a second of a force on a block of `lanes` cells.
fn rate(force: &Force, surface: &Surface, lanes: usize) -> f64 {
    let x = positions(surface, lanes);
    let (mut f, mut energy) = (vec![0.0; x.len()], vec![0.0; lanes]);
    let context = Context::at(0.0);
    let repeats = 40_000 / surface.positions.len() + 1;
    let seconds = fastest(|| {
        for _ in 0..repeats {
            measure_forces(std::slice::from_ref(force), &context, lanes, black_box(&x), &mut f, &mut energy);
        }
    });
    1e-6 * (repeats * surface.positions.len() * lanes) as f64 / seconds
}

/// Million atoms a second of the projection onto the exact volume; each round starts from the same error.
fn projection_rate(surface: &Surface, lanes: usize) -> f64 {
    let start = positions(surface, lanes);
    let (mut x, mut gradient, mut second) = (start.clone(), start.clone(), start.clone());
    let (target, mut left) = (vec![500.0; lanes], vec![0.0; lanes]);
    let repeats = 40_000 / surface.positions.len() + 1;
    let seconds = fastest(|| {
        for _ in 0..repeats {
            x.copy_from_slice(black_box(&start));
            volume::enforce_block(&surface.facets, &mut x, &[], &target, &mut gradient, &mut second, &mut left);
        }
    });
    assert!(left.iter().all(|left| *left < 1e-9), "the projection reaches its target");
    1e-6 * (repeats * surface.positions.len() * lanes) as f64 / seconds
}

fn main() {
    for level in [1, 3] {
        let surface = icosphere(5.0, level);
        println!("{} atoms, one thread: M atoms/s on {LANES} lanes | on one | ratio", surface.positions.len());
        for (name, force) in forces(&surface) {
            let (wide, alone) = (rate(&force, &surface, LANES), rate(&force, &surface, 1));
            println!("  {name:<24} {wide:8.2} | {alone:8.2} | {:5.2}", wide / alone);
        }
        let (wide, alone) = (projection_rate(&surface, LANES), projection_rate(&surface, 1));
        println!("  {:<24} {wide:8.2} | {alone:8.2} | {:5.2}", "exact volume", wide / alone);
    }
}
