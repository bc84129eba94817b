//! Fields: how many values a core moves in a second, how that grows with the grid, the species and the threads, and
//! what it costs that cells release into a field and sense it. All ratios come from one run.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use pseudopod::Vec3;
use pseudopod::equations::eml;
use pseudopod::error::Source;
use pseudopod::field::{Chunk, FieldSystem, Fields, Grid, Range, Sensed, Species, Stepping, Wall};

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

fn fields(cells: [usize; 3], species: usize, wall: Wall) -> Fields {
    let grid = Grid::new(cells, [1.0; 3], Vec3::zeros()).expect("a grid");
    let across = if cells[2] == 1 { Wall::NoFlux } else { wall };
    let walls = [[wall; 2], [wall; 2], [across; 2]];
    let one = |s: usize| Species::new(format!("s{s}"), 1.0 + s as f64, 0.1).with_walls(walls);
    let mut fields = Fields::new(grid, (0..species).map(one).collect()).expect("species");
    for s in 0..species {
        fields.set(s, |p| 2.0 + (0.1 * p.x).sin() + (0.2 * p.y + 0.1 * p.z).cos()).expect("positive values");
    }
    fields
}

/// Values moved by a step of diffusion and decay, million a second.
fn rate(cells: [usize; 3], species: usize, wall: Wall, threads: usize) -> f64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
    let mut fields = fields(cells, species, wall);
    let values = fields.grid().len() * species;
    // Rounds are short, so that some of them run undisturbed on a machine that others use too.
    let steps = (500_000 / values).max(1) as u32;
    let seconds = pool.install(|| {
        fastest(60, || {
            fields.advance(0.5 * f64::from(steps), Stepping::Fixed(steps), None).expect("a step");
        })
    });
    1e-6 * f64::from(steps) * values as f64 / seconds
}

/// Microseconds that all atoms of 1 000 cells of 42 atoms take to release and to sense.
fn touch(cells: [usize; 3]) -> (f64, f64) {
    let mut fields = fields(cells, 1, Wall::NoFlux);
    let size = Vec3::from_fn(|axis, _| cells[axis] as f64);
    // Cells in a lattice-free but even spread (Weyl's sequence), atoms on a circle of 3 boxes around each.
    let atom = |i: usize| {
        let (cell, atom) = ((i / 42) as f64, (i % 42) as f64);
        let centre = Vec3::new(0.754_877 * cell, 0.569_84 * cell, 0.438_579 * cell).map(f64::fract);
        centre.component_mul(&size) + 3.0 * Vec3::new(atom.cos(), atom.sin(), (2.0 * atom).cos())
    };
    let positions: Vec<Vec3> = (0..42_000).map(atom).collect();
    let amounts = vec![1e-6; positions.len()];
    let mut sensed = vec![Sensed::default(); positions.len()];
    let deposit = fastest(200, || {
        black_box(fields.deposit_all(0, black_box(&positions), &amounts));
    });
    let sense = fastest(200, || fields.sense_all(0, black_box(&positions), black_box(&mut sensed)));
    (1e6 * deposit, 1e6 * sense)
}

/// Million points a second of a Schnakenberg step (reaction, diffusion, reaction), and the part the reaction takes.
fn reacting(cells: [usize; 3]) -> (f64, f64) {
    let mut fields = fields(cells, 2, Wall::Periodic);
    let schnakenberg = |chunk: &mut Chunk| {
        let dt = chunk.dt;
        let [u, v] = chunk.rows();
        for (u, v) in u.iter_mut().zip(v) {
            let slope = |u: f64, v: f64| (0.1 - u + u * u * v, 0.9 - u * u * v);
            let first = slope(*u, *v);
            let second = slope(*u + dt * first.0, *v + dt * first.1);
            *u += 0.5 * dt * (first.0 + second.0);
            *v += 0.5 * dt * (first.1 + second.1);
        }
    };
    let points = fields.grid().len();
    let steps = (300_000 / points).max(1) as u32;
    let mut time = |reactions: Option<&(dyn Fn(&mut Chunk) + Sync)>| {
        fastest(30, || {
            fields.advance(0.01 * f64::from(steps), Stepping::Fixed(steps), reactions).expect("a step");
        })
    };
    let (with, without) = (time(Some(&schnakenberg)), time(None));
    (1e-6 * f64::from(steps) * points as f64 / with, 1.0 - without / with)
}

/// Million values a second of reaction and diffusion through a document's compiled equations, and how many times as long
/// its reactions alone take as those of a function written by hand with the same arithmetic.
fn document(name: &str, by_hand: &(dyn Fn(&mut Chunk) + Sync), dt: f64) -> (f64, f64) {
    let path = format!("{}/eml/{name}.eml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a document of eml/");
    let began = Instant::now();
    let document = eml::read(Arc::new(Source { name: name.into(), text })).expect("a good document");
    let system = FieldSystem::new(&document, None).expect("a good document");
    let read = began.elapsed().as_secs_f64();
    let no_file = |_: &eml::Profile, _: &Grid| unreachable!("the document names no file");
    let start = system.start(&no_file).expect("good profiles");
    println!("{name}: read and compiled in {:.2} ms", 1e3 * read);
    let mut fields = start.clone();
    let points = fields.grid().len();
    let steps = (300_000 / points).max(4) as u32;
    let (window, stepping) = (dt * f64::from(steps), Stepping::Fixed(steps));
    let compiled = fastest(40, || {
        system.advance(&mut fields, window, &[], stepping).expect("a step");
    });
    let mut time = |reactions: Option<&(dyn Fn(&mut Chunk) + Sync)>| {
        fastest(40, || {
            fields.advance(window, stepping, reactions).expect("a step");
        })
    };
    let (hand, without) = (time(Some(by_hand)), time(None));
    let values = f64::from(steps) * (points * fields.species().len()) as f64;
    println!(
        "{name} on {points} boxes, million values/s: {:.0} compiled, {:.0} by hand, {:.0} without reactions",
        1e-6 * values / compiled,
        1e-6 * values / hand,
        1e-6 * values / without
    );
    (1e-6 * values / compiled, (compiled - without) / (hand - without))
}

/// A midpoint step of two species, lanes side by side.
fn midpoint(chunk: &mut Chunk, slope: impl Fn(f64, f64) -> (f64, f64)) {
    let dt = chunk.dt;
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || {
            let [u, v] = chunk.rows();
            for (u, v) in u.iter_mut().zip(v) {
                let first = slope(*u, *v);
                let second = slope(*u + 0.5 * dt * first.0, *v + 0.5 * dt * first.1);
                *u += dt * second.0;
                *v += dt * second.1;
            }
        },
    );
}

fn documents() {
    let gray_scott = |chunk: &mut Chunk| {
        midpoint(chunk, |u, v| (-u * (v * v) + 0.04 * (1.0 - u), u * (v * v) - (0.04 + 0.06) * v));
    };
    let brusselator = |chunk: &mut Chunk| {
        midpoint(chunk, |u, v| (4.5 - (7.0 + 1.0) * u + u * u * v, 7.0 * u - u * u * v));
    };
    for (name, by_hand, dt) in
        [("gray_scott", &gray_scott as &(dyn Fn(&mut Chunk) + Sync), 0.5), ("brusselator", &brusselator, 0.005)]
    {
        let (_, ratio) = document(name, by_hand, dt);
        println!("{name}: compiled reactions take {ratio:.2} times as long as those by hand");
    }
}

fn main() {
    println!("diffusion and decay, million values/s on one thread (aim: 300 at 100² and 64³)");
    println!("{:>12} {:>8} {:>8} {:>8}", "grid", "1 field", "2", "5");
    for cells in [[100, 100, 1], [400, 400, 1], [64, 64, 64], [100, 100, 100]] {
        let [one, two, five] = [1, 2, 5].map(|species| rate(cells, species, Wall::NoFlux, 1));
        println!("{:>12} {one:8.0} {two:8.0} {five:8.0}", format!("{}×{}×{}", cells[0], cells[1], cells[2]));
    }
    let cells = [400, 400, 1];
    let one = rate(cells, 1, Wall::NoFlux, 1);
    println!("400², periodic walls: {:.2} of no-flux walls", rate(cells, 1, Wall::Periodic, 1) / one);
    println!("400², walls held at 1: {:.2} of no-flux walls", rate(cells, 1, Wall::Fixed(1.0), 1) / one);
    println!("400², two threads: {:.2} of one", rate(cells, 1, Wall::NoFlux, 2) / one);
    let mut free = fields(cells, 1, Wall::NoFlux);
    free =
        Fields::new(free.grid().clone(), vec![free.species()[0].clone().with_range(Range::Free)]).expect("a species");
    let point = |fields: &mut Fields| {
        fields.deposit(0, Vec3::new(200.0, 200.0, 0.0), 1.0);
        fastest(1, || {
            fields.advance(1.0, Stepping::Fixed(10), None).expect("a step");
        })
    };
    let free_time = point(&mut free);
    let mut kept = fields_without_substance(cells);
    println!(
        "400², a point source, first steps: {:.1} times as long when kept from going below zero",
        point(&mut kept) / free_time
    );
    for cells in [[100, 100, 1], [64, 64, 64]] {
        let (deposit, sense) = touch(cells);
        println!(
            "{}×{}×{}: 42 000 atoms release in {deposit:.0} µs and sense value and gradient in {sense:.0} µs (aim: 1000 together)",
            cells[0], cells[1], cells[2]
        );
    }
    rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("threads start").install(documents);
    let (rate, part) = reacting([256, 256, 1]);
    println!("Schnakenberg on 256²: {rate:.0} million points/s, {:.0} % of it reaction", 100.0 * part);
}

fn fields_without_substance(cells: [usize; 3]) -> Fields {
    let grid = Grid::new(cells, [1.0; 3], Vec3::zeros()).expect("a grid");
    Fields::new(grid, vec![Species::new("s", 1.0, 0.1)]).expect("a species")
}
