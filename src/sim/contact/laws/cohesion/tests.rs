//! Forces of the cohesive law against its energy, and energies of scenes whose openings are known.

use super::patch::Partner;
use super::*;
use crate::contact::Sides;
use crate::contact::{Reach, Shape};
use crate::geometry::{Obstacle, Surface, facet_areas, icosphere, sheet};
use crate::random::{Purpose, Stream};

const REACH: Reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 };

/// Bodies of one kind each, all of which stick to each other and to obstacles alike.
pub(super) fn scene(
    surfaces: &[(Surface, Sides)],
    obstacles: Vec<Obstacle>,
    cohesive: Cohesive,
) -> (CohesionTable, Scene, Vec<Vec3>) {
    let shapes: Vec<Shape> = surfaces.iter().map(|(rest, sides)| Shape::new(rest, *sides, 0.15)).collect();
    let mut table = CohesionTable::new(shapes.len(), obstacles.len());
    table.between.fill(cohesive);
    table.on_obstacles.fill(cohesive);
    table.points.fill(2);
    let positions = surfaces.iter().flat_map(|(rest, _)| rest.positions.iter().copied()).collect();
    (table, Scene::new(shapes, &(0..surfaces.len()).collect::<Vec<_>>(), obstacles, REACH), positions)
}

pub(super) fn moved(mut surface: Surface, by: Vec3) -> Surface {
    surface.positions.iter_mut().for_each(|x| *x += by);
    surface
}

pub(super) fn found(table: &CohesionTable, scene: &Scene, positions: &[Vec3]) -> CohesionScratch {
    let mut found = CohesionScratch::default();
    table.find(scene, &Controls::default(), NONE, positions, &mut found);
    found
}

pub(super) fn floor() -> Obstacle {
    Obstacle::Plane { point: Vec3::zeros(), normal: Vec3::z() }
}

/// No bonds from before.
const NONE: Earlier = Earlier { bonds: &[], time: 0.0 };

pub(super) const GLUE: Cohesive = Cohesive { strength: 3.0, work: 1.2, friction: 0.0, bonds: None };

#[test]
fn forces_are_the_gradient_of_the_energy_and_have_neither_sum_nor_torque() {
    let mut surfaces = vec![
        (icosphere(3.0, 1), Sides::Outer),
        (moved(icosphere(2.0, 2), Vec3::new(0.7, 0.4, 5.2)), Sides::Outer),
        (moved(sheet(4.0, 4.0, 5, 5), Vec3::new(0.1, 0.0, 7.5)), Sides::Both),
    ];
    let mut stream = Stream::new(1, Purpose::Placement, 0, 0);
    for (surface, _) in &mut surfaces {
        for x in &mut surface.positions {
            let [[a, b], [c, _]] = [stream.uniform_pair(), stream.uniform_pair()];
            *x += 0.2 * Vec3::new(a - 0.5, b - 0.5, c - 0.5);
        }
    }
    for obstacles in [vec![], vec![Obstacle::Plane { point: Vec3::new(0.0, 0.0, -3.1), normal: Vec3::z() }]] {
        let on_obstacle = !obstacles.is_empty();
        let (table, scene, positions) = scene(&surfaces, obstacles, GLUE);
        let mut found = found(&table, &scene, &positions);
        let mut force = vec![Vec3::zeros(); positions.len()];
        table.add_forces(&scene, &mut found, &positions, &mut force, None);
        let energy = table.energy(&scene, &found, &positions);
        assert!(energy < -0.5, "{energy}");
        let acted = force.iter().filter(|force| force.norm() > 0.0).count();
        assert!(acted > 30, "{acted}");
        for (atom, axis) in (0..positions.len()).flat_map(|atom| [(atom, 0), (atom, 1), (atom, 2)]) {
            let at = |by: f64| {
                let mut positions = positions.clone();
                positions[atom][axis] += by;
                table.energy(&scene, &found, &positions)
            };
            let (slope, step) = ((at(1e-5) - at(-1e-5)) / 2e-5, 1e-5);
            // Parts at the end of the range or between two sides of a facet have a kink in their force within the step.
            let off = (slope + force[atom][axis]).abs();
            assert!(
                off < 1e-6 * (1.0 + force[atom].norm()) + 4.0 * step,
                "{atom} {axis}: {slope} {}",
                force[atom][axis]
            );
        }
        if !on_obstacle {
            let torque: Vec3 = positions.iter().zip(&force).map(|(x, force)| x.cross(force)).sum();
            let sum: Vec3 = force.iter().sum();
            assert!(sum.norm() < 1e-11 && torque.norm() < 1e-10, "{sum} {torque}");
        }
    }
}

#[test]
fn what_attracts_a_point_does_not_depend_on_what_did_before() {
    let surfaces = [
        (icosphere(3.0, 2), Sides::Outer),
        (moved(icosphere(2.0, 2), Vec3::new(0.7, 0.4, 5.05)), Sides::Outer),
        (moved(icosphere(2.5, 1), Vec3::new(0.2, 5.5, 1.0)), Sides::Outer),
        (moved(sheet(4.0, 4.0, 5, 5), Vec3::new(0.1, 0.0, -3.1)), Sides::Both),
    ];
    let (table, scene, mut positions) =
        scene(&surfaces, vec![Obstacle::Plane { point: -4.0 * Vec3::z(), normal: Vec3::z() }], GLUE);
    let mut stream = Stream::new(5, Purpose::Placement, 0, 0);
    let (mut followed, mut changed, mut before) = (CohesionScratch::default(), 0, Vec::new());
    for _ in 0..12 {
        table.find(&scene, &Controls::default(), NONE, &positions, &mut followed);
        let anew = found(&table, &scene, &positions);
        assert!(followed.patches == anew.patches && anew.patches.iter().flatten().count() > 100);
        changed += usize::from(before != anew.patches);
        before = anew.patches;
        for x in &mut positions {
            let [[a, b], [c, _]] = [stream.uniform_pair(), stream.uniform_pair()];
            *x += 0.2 * Vec3::new(a - 0.5, b - 0.5, c - 0.5);
        }
    }
    assert_eq!(changed, 12);
}

#[test]
fn of_facets_that_attract_a_point_alike_the_same_counts_whatever_is_guessed_first() {
    // Meshes that are the same on both sides of the gaps: many points have several facets as near, by sides and corners that these share.
    let ball = |by: Vec3| (moved(icosphere(3.0, 1), by), Sides::Outer);
    let lid = |height: f64| (moved(sheet(4.0, 4.0, 4, 4), height * Vec3::z()), Sides::Both);
    let surfaces = [ball(Vec3::zeros()), ball(5.9 * Vec3::x()), ball(5.9 * Vec3::y()), lid(3.2), lid(3.5)];
    let (table, scene, positions) = scene(&surfaces, vec![], GLUE);
    let anew = found(&table, &scene, &positions);
    assert!(anew.patches.iter().flatten().count() > 100);
    let mut guessing = CohesionScratch::default();
    table.find(&scene, &Controls::default(), NONE, &positions, &mut guessing);
    for turn in 1..=20 {
        for (_, known) in &mut guessing.looks {
            known
                .iter_mut()
                .enumerate()
                .for_each(|(point, guess)| *guess = (point * 7 + turn * 13) as u32 % scene.facets as u32);
        }
        table.find(&scene, &Controls::default(), NONE, &positions, &mut guessing);
        assert!(guessing.patches == anew.patches, "guesses of turn {turn} changed what was found");
    }
}

#[test]
fn flat_surfaces_that_touch_have_the_work_of_separation_an_area_and_pull_with_the_strength_whatever_their_meshes() {
    for (parts, other) in [(3, 3), (4, 7), (1, 10)] {
        for gap in [1e-6, 0.1, 0.4, 0.79] {
            let (one, lid) = (sheet(4.0, 4.0, parts, parts), sheet(8.0, 8.0, other, other));
            let surfaces = [(one, Sides::Both), (moved(lid, gap * Vec3::z()), Sides::Both)];
            let (table, scene, positions) = scene(&surfaces, vec![], GLUE);
            let found = found(&table, &scene, &positions);
            let first = scene.bodies[1].first_atom as usize;
            // The small sheet has its half exactly; the large one has the other, and what is beside as far as it is seen askew.
            let of_small = found.patches.iter().flatten().filter(|patch| (patch.own[0] as usize) < first);
            let pulls: Vec<_> = of_small.filter_map(|patch| patch.pull(&scene, &positions)).collect();
            let energy: f64 = pulls.iter().map(|pull| pull.energy).sum();
            let t: f64 = gap / GLUE.range();
            let left = if t < 0.5 { 1.0 - 2.0 * t * t } else { 2.0 * (1.0 - t) * (1.0 - t) };
            assert!((energy + 0.5 * 16.0 * GLUE.work * left).abs() < 1e-9, "{parts} {gap}: {energy}");
            let pull: f64 = pulls.iter().flat_map(|pull| pull.on_own).map(|force| force.z).sum();
            let traction = GLUE.strength * if t < 0.5 { 2.0 * t } else { 2.0 - 2.0 * t };
            assert!((pull - 0.5 * 16.0 * traction).abs() < 1e-9, "{parts} {gap}: {pull}");
        }
    }
}

#[test]
fn a_box_on_a_floor_is_in_contact_with_its_floor_alone() {
    // A box of 4 x 4 x 4 µm: a sheet for each side would do; an icosphere cannot have corners.
    let side = |parts: u32| {
        let mut all = Surface { positions: Vec::new(), facets: Vec::new() };
        let flat = sheet(4.0, 4.0, parts, parts);
        for face in 0..6 {
            let first = all.positions.len() as u32;
            let turned = |x: &Vec3| {
                let (u, v, w) = (x.x, x.y, 2.0);
                let at = match face {
                    0 => Vec3::new(u, v, w),
                    1 => Vec3::new(v, u, -w),
                    2 => Vec3::new(w, u, v),
                    3 => Vec3::new(-w, v, u),
                    4 => Vec3::new(v, w, u),
                    _ => Vec3::new(u, -w, v),
                };
                at + 2.0 * Vec3::z()
            };
            all.positions.extend(flat.positions.iter().map(turned));
            all.facets.extend(flat.facets.iter().map(|facet| facet.map(|atom| first + atom)));
        }
        all
    };
    for parts in [4, 8] {
        let (table, scene, positions) = scene(&[(side(parts), Sides::Outer)], vec![floor()], GLUE);
        let found = found(&table, &scene, &positions);
        let area: f64 = found.facing.iter().map(|facing| facing.area).sum();
        assert!((area - 16.0).abs() < 1e-9, "{parts}: {area}");
        let total: f64 = facet_areas(&side(parts)).iter().sum();
        assert!((total - 96.0).abs() < 1e-9);
    }
}

#[test]
fn a_patch_takes_as_much_memory_as_its_decision_says() {
    assert_eq!((size_of::<Patch>(), size_of::<facet::Facet>()), (64, 64));
}

#[test]
fn forces_are_added_up_in_the_order_of_parts_by_any_number_of_threads() {
    // Cells of several batches, each beside cells of its own and of others, on a floor.
    let middle = |number: u32| [number % 4, number / 4 % 4, number / 16].map(|index| 3.9 * f64::from(index));
    let cells: Vec<(Surface, Sides)> = (0..40)
        .map(|number| (moved(icosphere(2.0, 1), Vec3::from(middle(number)) + 2.1 * Vec3::z()), Sides::Outer))
        .collect();
    let (table, scene, positions) = scene(&cells, vec![floor()], GLUE);
    assert!(scene.batches() > 5);
    let mut found = found(&table, &scene, &positions);
    let mut plain = vec![Vec3::zeros(); positions.len()];
    let mut between_batches = 0;
    for patch in found.patches.iter().flatten() {
        let Some(pull) = patch.pull(&scene, &positions) else { continue };
        let mut add = |atoms: [u32; 3], forces: [Vec3; 3]| {
            atoms.iter().zip(forces).for_each(|(atom, force)| plain[*atom as usize] += force);
        };
        add(patch.own, pull.on_own);
        if let Partner::Facet(atoms, _) = patch.other {
            add(atoms, pull.on_other);
            let [own, other] = [patch.own, atoms].map(|atoms| scene.batch_of(scene.body_of_atom(atoms[0])));
            between_batches += usize::from(own != other);
        }
    }
    assert!(between_batches > 1000, "{between_batches}");
    for threads in [1, 2, 5] {
        let mut force = vec![Vec3::zeros(); positions.len()];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| table.add_forces(&scene, &mut found, &positions, &mut force, None));
        assert!(force == plain, "the same to the last bit with {threads} threads");
    }
}
