//! Areas of contact against shapes whose area is known, and against a search of all facets for each point.

use super::patch::part_that_faces;
use super::points::points_of_facet;
use super::*;
use crate::contact::test_scenes::{Stage, packed_stage};
use crate::contact::{Opening, Reach, Shape, Sides, opening_to_facet, opening_to_plane};
use crate::geometry::{Obstacle, Surface, icosphere, sheet, volume};

const REACH: Reach = Reach { proximity: 0.1, prediction: 0.1, depth: 0.1, margin: 0.1 };

/// What is near enough to be in contact, µm.
const WITHIN: f64 = 0.3;

fn stage(surfaces: &[(Surface, Sides)], obstacles: Vec<Obstacle>) -> Stage {
    let shapes: Vec<Shape> = surfaces.iter().map(|(rest, sides)| Shape::new(rest, *sides, 0.15)).collect();
    let scene = Scene::new(shapes, &(0..surfaces.len()).collect::<Vec<_>>(), obstacles, REACH);
    Stage { scene, positions: surfaces.iter().flat_map(|(rest, _)| rest.positions.iter().copied()).collect() }
}

/// Areas of pairs, in their order; `edge` is the mean edge of all shapes, µm.
fn areas(stage: &Stage, edge: f64) -> Vec<(u32, u32, f64)> {
    let Stage { scene, positions } = stage;
    let table = CohesionTable::alike(&vec![edge; scene.shapes.len()], scene.obstacles.len(), WITHIN);
    let mut all = Vec::new();
    table.add_areas(scene, positions, &mut AreaScratch::default(), &mut all);
    all.sort_by_key(|(one, other, _)| (*one, *other));
    all
}

/// The same by looking at all facets for each point.
fn areas_by_all(stage: &Stage, parts: u32) -> Vec<(u32, u32, f64)> {
    let Stage { scene, positions } = stage;
    let (bodies, points) = (scene.bodies.len() as u32, points_of_facet(parts));
    let corners = |body: u32, facet: u32| scene.facet_atoms(body, facet).map(|atom| positions[atom as usize]);
    let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(&(c - a)).normalize();
    let facets_of = |body: u32| {
        let first = scene.bodies[body as usize].first_facet;
        first..first + scene.shape(body).facets.len() as u32
    };
    let mut all = Vec::new();
    for (body, facet) in (0..bodies).flat_map(|body| facets_of(body).map(move |facet| (body, facet))) {
        let of = corners(body, facet);
        let sides: &[f64] = if scene.shape(body).sides == Sides::Both { &[1.0, -1.0] } else { &[1.0] };
        for (weights, side) in points.iter().flat_map(|weights| sides.iter().map(move |side| (weights, *side))) {
            let x = weights[0] * of[0] + weights[1] * of[1] + weights[2] * of[2];
            let (n, mut best) = (side * normal(of), (WITHIN, None));
            for other in (0..bodies).filter(|other| *other != body) {
                for facet in facets_of(other) {
                    let mut there = corners(other, facet);
                    let middle = (there[0] + there[1] + there[2]) / 3.0;
                    if scene.shape(other).sides == Sides::Both && (x - middle).dot(&normal(there)) < 0.0 {
                        there.swap(1, 2);
                    }
                    if let Some((opening, _)) = opening_to_facet(x, n, &there, normal(there))
                        && opening.width < best.0
                    {
                        best = (opening.width, Some((other, opening)));
                    }
                }
            }
            for (number, obstacle) in (bodies..).zip(&scene.obstacles) {
                let beside = obstacle.beside(&x);
                let opening = opening_to_plane(n, beside.gap, beside.normal);
                if let Some((width, towards)) = opening
                    && width < best.0
                {
                    best = (width, Some((number, Opening { width, weights: [0.0; 3], towards })));
                }
            }
            if let Some((other, opening)) = best.1 {
                let area = 0.5 * (of[1] - of[0]).cross(&(of[2] - of[0])).norm() / points.len() as f64;
                let seen = area * part_that_faces(&opening);
                all.push((body.min(other), body.max(other), if other < bodies { 0.5 * seen } else { seen }));
            }
        }
    }
    all.sort_by_key(|(one, other, _)| (*one, *other));
    all
}

fn sum(areas: &[(u32, u32, f64)]) -> Vec<(u32, u32, f64)> {
    let pairs = areas.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1));
    let sums = pairs.map(|alike| (alike[0].0, alike[0].1, alike.iter().map(|one| one.2).sum()));
    sums.filter(|one: &(u32, u32, f64)| one.2 > 0.0).collect()
}

#[test]
fn they_are_those_of_a_search_of_all_facets() {
    let (mut pairs, mut on_obstacles) = (0, 0);
    for number in 0..6 {
        let mut stage = packed_stage(8, REACH, number);
        stage.scene.obstacles = vec![Obstacle::Plane { point: Vec3::z() * -0.85, normal: Vec3::z() }];
        // Four points a facet.
        let (found, wanted) = (sum(&areas(&stage, WITHIN)), sum(&areas_by_all(&stage, 2)));
        let bodies = stage.scene.bodies.len() as u32;
        on_obstacles += wanted.iter().filter(|one| one.1 >= bodies).count();
        pairs += wanted.len();
        assert_eq!(found.len(), wanted.len(), "scene {number}: {found:?} {wanted:?}");
        for (found, wanted) in found.iter().zip(&wanted) {
            assert_eq!((found.0, found.1), (wanted.0, wanted.1), "scene {number}");
            assert!((found.2 - wanted.2).abs() < 1e-9 * (1.0 + wanted.2), "scene {number}: {found:?} {wanted:?}");
        }
    }
    assert!(pairs > 60 && on_obstacles > 10, "{pairs} {on_obstacles}");
}

/// Radius of the flat disc of a drop between plates, and of its rim, µm: about the volume of a ball of 5 µm.
const DISC: f64 = 3.5;
const RIM: f64 = 2.6;

/// A drop between plates at z = 0 and a little above twice the radius of its rim: discs, and round a rim that leaves them without a kink.
/// The atoms of a ball are spread by the length along its profile; as a drop that keeps its volume the mesh has that of theory.
fn drop_between_plates(level: u32) -> Surface {
    let mut drop = icosphere(1.0, level);
    for x in &mut drop.positions {
        let polar = (-x.z.abs()).acos() - std::f64::consts::FRAC_PI_2;
        let along = (1.0 - polar / std::f64::consts::FRAC_PI_2) * (DISC + RIM * std::f64::consts::FRAC_PI_2);
        let angle = ((along - DISC) / RIM).max(0.0);
        let (radius, height) = (along.min(DISC) + RIM * angle.sin(), RIM - RIM * angle.cos());
        let out = Vec3::new(x.x, x.y, 0.0).try_normalize(0.0).unwrap_or_default() * radius;
        *x = out + Vec3::z() * if x.z < 0.0 { height } else { 2.0 * RIM - height };
    }
    let pi = std::f64::consts::PI;
    let theory = pi * (2.0 * DISC * DISC * RIM + pi * DISC * RIM * RIM + 4.0 / 3.0 * RIM * RIM * RIM);
    let scale = (theory / volume(&drop)).cbrt();
    drop.positions.iter_mut().for_each(|x| *x *= scale);
    drop
}

/// The disc and what of the rim around it is 0.3 µm open at most: `apart` is the opening at an angle of the rim, `part` what counts there.
fn area_of_contact(apart: impl Fn(f64) -> f64, part: impl Fn(f64) -> f64) -> f64 {
    let pi = std::f64::consts::PI;
    let angles =
        (0..2000).map(|number| 1e-3 * (f64::from(number) + 0.5) * 0.5).take_while(|angle| apart(*angle) < WITHIN);
    let rim: f64 = angles.map(|at| 2.0 * pi * (DISC + RIM * at.sin()) * RIM * 0.5e-3 * part(at)).sum();
    pi * DISC * DISC + rim
}

#[test]
fn drops_pressed_on_planes_and_each_other_have_the_area_of_theory() {
    // An obstacle is met at the angle of the rim, another drop at twice that.
    let on_obstacle =
        area_of_contact(|at| 2.0 * RIM * (1.0 - at.cos()) / (1.0 + at.cos()), |at| (2.0 * at.cos()).min(1.0));
    let between =
        area_of_contact(|at| 2.0 * RIM * (1.0 - at.cos()) / at.cos(), |at| (2.0 * (2.0 * at).cos()).clamp(0.0, 1.0));
    for (level, edge) in [(2, 1.5), (3, 0.76)] {
        let height = drop_between_plates(level).positions.iter().map(|x| x.z).fold(0.0, f64::max);
        let obstacles = vec![
            Obstacle::Plane { point: Vec3::zeros(), normal: Vec3::z() },
            Obstacle::Plane { point: Vec3::z() * height, normal: -Vec3::z() },
        ];
        let found = sum(&areas(&stage(&[(drop_between_plates(level), Sides::Outer)], obstacles), edge));
        assert_eq!(found.len(), 2);
        for (_, obstacle, area) in found {
            assert!((area / on_obstacle - 1.0).abs() < 0.05, "{level}, {obstacle}: {area} of {on_obstacle}");
        }
        let mut other = drop_between_plates(level);
        // Turned about the axis, so that facets do not match, and below.
        let turn = nalgebra::Rotation3::from_axis_angle(&Vec3::z_axis(), 0.4);
        other.positions.iter_mut().for_each(|x| *x = turn * *x - Vec3::z() * (height + 1e-3));
        let pair = stage(&[(drop_between_plates(level), Sides::Outer), (other, Sides::Outer)], vec![]);
        let [(0, 1, found)] = sum(&areas(&pair, edge))[..] else { panic!("one contact") };
        // Facets of 162 atoms on a rim of 2.6 µm are 0.1 µm off it, on each side of an opening of 0.3 µm.
        let off = if level == 2 { 0.1 } else { 0.05 };
        assert!((found / between - 1.0).abs() < off, "{level}: {found} of {between}");
    }
}

#[test]
fn a_share_of_a_surface_counts_for_its_nearest_neighbour_alone() {
    let at = |z: f64| {
        let mut flat = sheet(4.0, 4.0, 4, 4);
        flat.positions.iter_mut().for_each(|x| x.z += z);
        (flat, Sides::Both)
    };
    // 0.1 µm apart, 0.1 µm above a floor and 0.4 µm below what looks down on them: each face has one neighbour or none.
    let obstacles = vec![
        Obstacle::Plane { point: Vec3::z() * -0.1, normal: Vec3::z() },
        Obstacle::Plane { point: Vec3::z() * 0.6, normal: -Vec3::z() },
    ];
    let found = sum(&areas(&stage(&[at(0.0), at(0.1), at(0.2)], obstacles), 1.0));
    let wanted = [(0, 1, 16.0), (0, 3, 16.0), (1, 2, 16.0)];
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(wanted) {
        assert!(
            (found.0, found.1) == (wanted.0, wanted.1) && (found.2 - wanted.2).abs() < 1e-9,
            "{found:?} {wanted:?}"
        );
    }
}
