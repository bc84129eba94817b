//! Finding contacts in packed aggregates of cells of 42 atoms: with pairs kept, with pairs collected anew, and against
//! all pairs. One thread unless `PSEUDOPOD_BENCH_THREADS` says otherwise.

use divan::Bencher;
use divan::counter::ItemsCount;
use pseudopod::Vec3;
use pseudopod::contact::{Contacts, Detector, Reach, Scene, Shape, Sides, detect_all_pairs};
use pseudopod::geometry::icosphere;
use pseudopod::random::{Purpose, Stream};

/// A tenth of the mean edge for all three.
const REACH: Reach = Reach { proximity: 0.055, prediction: 0.055, depth: 0.055, margin: 0.055 };

/// Half of the distance of cells of radius 1: they are flattened where they meet, and one in three atoms touches.
const HALF_DISTANCE: f64 = 0.82;

fn main() {
    let threads = std::env::var("PSEUDOPOD_BENCH_THREADS").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("a pool of threads");
    divan::main();
}

/// Three numbers uniform in [−1, 1).
fn vector(dice: &mut Stream) -> Vec3 {
    let ([x, y], [z, _]) = (dice.uniform_pair(), dice.uniform_pair());
    Vec3::new(x, y, z) * 2.0 - Vec3::repeat(1.0)
}

/// Cells on an fcc lattice, each turned at random and flattened against its neighbours, with noise.
pub fn packed(count: usize) -> (Scene, Vec<Vec3>) {
    let mut dice = Stream::new(1, Purpose::Placement, 0, 0);
    let rest = icosphere(1.0, 1);
    let shape = Shape::new(&rest, Sides::Outer, 1.5 * REACH.prediction);
    let side = (1..).find(|side: &usize| side.pow(3).div_ceil(2) >= count).expect("a cube large enough");
    let cube = (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side / side]);
    let directions = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
    let directions = directions.map(|direction: [i8; 3]| Vec3::from(direction.map(f64::from)) / 2f64.sqrt());
    let mut positions = Vec::with_capacity(42 * count);
    for site in cube.filter(|site| site.iter().sum::<usize>() % 2 == 0).take(count) {
        let centre = Vec3::from(site.map(|index| index as f64)) * (2f64.sqrt() * HALF_DISTANCE);
        let turn = turning(vector(&mut dice));
        for x in &rest.positions {
            let mut position = turn(x);
            for direction in directions {
                let height = position.dot(&direction);
                position -= direction * (height - height.clamp(0.02 - HALF_DISTANCE, HALF_DISTANCE - 0.02));
            }
            positions.push(centre + position + vector(&mut dice) * 0.01);
        }
    }
    (Scene::new(vec![shape], &vec![0; count], Vec::new(), REACH), positions)
}

/// A turn about an axis by its length times π.
fn turning(axis: Vec3) -> impl Fn(&Vec3) -> Vec3 {
    let turn = nalgebra::UnitQuaternion::from_scaled_axis(axis * std::f64::consts::PI);
    move |x| turn * x
}

/// Runs one bench, with pairs kept or collected each time.
fn detect(bencher: Bencher, cells: usize, prepare: impl Fn(&mut Detector)) {
    let (scene, positions) = packed(cells);
    let (mut detector, mut contacts) = (Detector::default(), Contacts::default());
    let detection = detector.detect(&scene, &positions, &mut contacts);
    let atoms = positions.len() as f64;
    eprintln!(
        "{cells} cells, per atom: {:.2} pairs, {:.2} atom contacts, {:.2} edge contacts, {:.0} bytes of pairs and boxes, {:.0} bytes of contacts",
        detection.pairs as f64 / atoms,
        contacts.atoms.len() as f64 / atoms,
        contacts.edges.len() as f64 / atoms,
        detector.bytes() as f64 / atoms,
        contacts.bytes() as f64 / atoms,
    );
    // Cells that stir by a hundredth of an edge, so that no branch is learnt by heart; the pairs stay valid.
    let stirred: Vec<Vec<Vec3>> = (0..8)
        .map(|seed| {
            let mut dice = Stream::new(seed, Purpose::Motility, 0, 0);
            positions.iter().map(|x| x + vector(&mut dice) * 0.005).collect()
        })
        .collect();
    let mut turn = 0;
    bencher.counter(ItemsCount::new(positions.len())).bench_local(|| {
        prepare(&mut detector);
        turn += 1;
        detector.detect(&scene, &stirred[turn % stirred.len()], &mut contacts)
    });
}

#[divan::bench(args = [25, 100, 1_000, 10_000], min_time = 1, max_time = 5)]
fn pairs_kept(bencher: Bencher, cells: usize) {
    detect(bencher, cells, |_| ());
}

#[divan::bench(args = [25, 100, 1_000, 10_000], min_time = 1, max_time = 5)]
fn pairs_collected(bencher: Bencher, cells: usize) {
    detect(bencher, cells, Detector::forget);
}

/// At 1 000 cells this takes minutes.
#[divan::bench(args = [25, 100, 1_000], sample_count = 1, sample_size = 1)]
fn all_pairs(bencher: Bencher, cells: usize) {
    let (scene, positions) = packed(cells);
    let mut contacts = Contacts::default();
    bencher
        .counter(ItemsCount::new(positions.len()))
        .bench_local(|| detect_all_pairs(&scene, &positions, &mut contacts));
}
