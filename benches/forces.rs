//! Every elastic force and the volume projection, one after the other on the same cells; rates and ratios of one run.

use std::hint::black_box;
use std::time::Instant;

use pseudopod::Vec3;
use pseudopod::geometry::{Surface, Topology, icosphere};
use pseudopod::mechanics::angles::Angles;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::bending::{Bending, RestAngle};
use pseudopod::mechanics::elasticity::Elasticity;
use pseudopod::mechanics::lanes::LANES;
use pseudopod::mechanics::membrane::{Membrane, MembraneLaw};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::mechanics::springs::Springs;
use pseudopod::mechanics::tension::Tension;
use pseudopod::mechanics::volume;

/// One elasticity a force, all on the same mesh.
fn forces(surface: &Surface) -> Vec<(&'static str, Elasticity)> {
    let topology = Topology::of(surface);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let (x, facets) = (&surface.positions, &surface.facets);
    let memory = |reaction| vec![ShapeMemory::new(x, &rings, 10.0, reaction)];
    let membrane = |law| vec![Membrane::new(x, facets, law)];
    let rules = BarrierRules { energy: 1.0, area_share: 0.2, fold_angle: 2.0 };
    let none = Elasticity::default;
    vec![
        ("shape memory, exact", Elasticity { shape_memory: memory(Reaction::Exact), ..none() }),
        ("shape memory, spread", Elasticity { shape_memory: memory(Reaction::Spread), ..none() }),
        ("shape memory, angles", Elasticity { angles: vec![Angles::new(x, &rings, 10.0)], ..none() }),
        (
            "membrane, Skalak",
            Elasticity { membrane: membrane(MembraneLaw::Skalak { shear: 2.5, area: 50.0 }), ..none() },
        ),
        (
            "membrane, neo-Hookean",
            Elasticity {
                membrane: membrane(MembraneLaw::NeoHookean { shear: 2.5, area: 50.0, hardening: 0.0 }),
                ..none()
            },
        ),
        ("tension and total area", Elasticity { tension: vec![Tension::new(x, facets, 10.0, 5.0)], ..none() }),
        ("bending", Elasticity { bending: vec![Bending::new(x, &topology.flaps, 0.2, RestAngle::Flat)], ..none() }),
        ("springs on edges", Elasticity { springs: vec![Springs::on_edges(x, &topology.edges, 10.0)], ..none() }),
        ("barrier at rest", Elasticity { barrier: vec![Barrier::new(x, facets, &topology.flaps, rules)], ..none() }),
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
fn places(surface: &Surface, lanes: usize) -> Vec<f64> {
    let drawn = |p: &Vec3| [p.x / 1.1, p.y / 1.1, p.z * 1.21];
    surface.positions.iter().flat_map(drawn).flat_map(|value| vec![value; lanes]).collect()
}

/// Million atoms a second of a force on a block of `lanes` cells.
fn rate(elasticity: &Elasticity, surface: &Surface, lanes: usize) -> f64 {
    let x = places(surface, lanes);
    let (mut f, mut energy) = (vec![0.0; x.len()], vec![0.0; lanes]);
    let repeats = 40_000 / surface.positions.len() + 1;
    let seconds = fastest(|| {
        for _ in 0..repeats {
            elasticity.add_forces(lanes, black_box(&x), &mut f, &mut energy);
        }
    });
    1e-6 * (repeats * surface.positions.len() * lanes) as f64 / seconds
}

/// Million atoms a second of the projection onto the exact volume; each round starts from the same error.
fn projection_rate(surface: &Surface, lanes: usize) -> f64 {
    let start = places(surface, lanes);
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
        for (name, elasticity) in forces(&surface) {
            let (wide, alone) = (rate(&elasticity, &surface, LANES), rate(&elasticity, &surface, 1));
            println!("  {name:<24} {wide:8.2} | {alone:8.2} | {:5.2}", wide / alone);
        }
        let (wide, alone) = (projection_rate(&surface, LANES), projection_rate(&surface, 1));
        println!("  {:<24} {wide:8.2} | {alone:8.2} | {:5.2}", "exact volume", wide / alone);
    }
}
