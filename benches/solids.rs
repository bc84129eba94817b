//! Filled bodies: steps a second of explicit schemes, as the documents give them, and of implicit steps with factors of growing bodies; rates of one
//! run on one thread.

use std::time::Instant;

use pseudopod::Vec3;
use pseudopod::geometry::Solid as Body;
use pseudopod::geometry::solid::{block, pairs_within};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory};
use pseudopod::mechanics::solid::Solid;
use pseudopod::mechanics::solid::law::{Elastic, SolidLaw};
use pseudopod::mechanics::springs::Springs;
use pseudopod::sim::{Kind, Model, State, VolumeRule, Workspace, step};

fn springs(body: &Body) -> Force {
    let pairs = pairs_within(&body.tetrahedra, &body.cells);
    Force::Springs(Springs::on_edges(&body.surface.positions, &pairs, 1.0))
}

fn shape_memory(body: &Body) -> Force {
    let mut near = vec![Vec::new(); body.surface.positions.len()];
    for &[a, b] in &body.edges {
        near[a as usize].push(b);
        near[b as usize].push(a);
    }
    Force::ShapeMemory(ShapeMemory::new(&body.surface.positions, &near, 1.0, Reaction::Exact))
}

fn material(law: SolidLaw) -> impl Fn(&Body) -> Force {
    move |body| {
        let elastic = Elastic { law, shear: 1.0, lame: 2.0 };
        Force::Solid(Solid::new(&body.surface.positions, &body.tetrahedra, elastic, None))
    }
}

/// Seconds of a step of a body that begins drawn out by a hundredth: the fastest of several rounds.
fn seconds(body: &Body, force: Force, method: Method, dt: f64, steps: usize) -> f64 {
    let mut kind = Kind::new("body", body.surface.clone(), vec![force]);
    kind.tetrahedra.clone_from(&body.tetrahedra);
    kind.volume = VolumeRule::Free;
    kind.drag = 1.0;
    kind.bound_stiffness();
    if matches!(method, Method::Implicit { .. }) {
        kind.use_tangent(false);
    }
    let model = Model::of(vec![kind], Integrator { method, size: StepSize::Fixed(dt) }, 1e9);
    let start = body.surface.positions.iter().map(|p| p.component_mul(&Vec3::new(1.0, 1.0, 1.01))).collect();
    let (mut state, mut ws) = (State::new(&model, &[vec![start]]), Workspace::new(&model));
    let mut round = || {
        let began = Instant::now();
        for _ in 0..steps {
            step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
        }
        began.elapsed().as_secs_f64() / steps as f64
    };
    round();
    (0..5).map(|_| round()).fold(f64::INFINITY, f64::min)
}

fn cube(parts: u32) -> Body {
    block([8.0; 3], [parts; 3]).expect("a sound body")
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("a thread starts");
    let (lattice, organ) = (cube(8), block([8.0, 8.0, 6.0], [12, 12, 9]).expect("a sound body"));
    println!("explicit steps a second, one thread (documents: 340 of 729 atoms; 9 and 45 of 6 342 tetrahedra):");
    let explicit = |name: &str, body: &Body, force: Force| {
        let rate = 1.0 / seconds(body, force, Method::Explicit, 1e-5, 200);
        let (atoms, tetrahedra) = (body.surface.positions.len(), body.tetrahedra.len());
        println!("  {name}: {rate:.0} of {atoms} atoms, {tetrahedra} tetrahedra");
    };
    explicit("springs between 26 neighbours", &lattice, springs(&lattice));
    explicit("shape memory of 6 neighbours", &lattice, shape_memory(&lattice));
    explicit("St Venant-Kirchhoff", &organ, material(SolidLaw::StVenantKirchhoff)(&organ));
    explicit("linear", &organ, material(SolidLaw::Linear)(&organ));
    println!("implicit steps of second order, one thread:");
    for parts in [6, 8, 12, 16] {
        let body = cube(parts);
        let force = material(SolidLaw::NeoHookean)(&body);
        let taken = seconds(&body, force, Method::Implicit { order: Order::Second }, 1.0, 2);
        println!("  {} atoms: {:.1} ms", body.surface.positions.len(), 1e3 * taken);
    }
}
