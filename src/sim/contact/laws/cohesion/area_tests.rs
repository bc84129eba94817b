//! Areas of contact against shapes whose area is known, and against a search of all facets for each point.

use super::patch::{Partner, Patch};
use super::search::points_of_facet;
use super::*;
use crate::contact::test_scenes::{Stage, packed_stage, random_stage};
use crate::contact::{Plane, Reach, Shape, Sides, opening_to_facet, opening_to_plane};
use crate::geometry::{Surface, icosphere, sheet};

const REACH: Reach = Reach { proximity: 0.1, depth: 0.1, margin: 0.1 };

/// What is near enough to be in contact, µm.
const WITHIN: f64 = 0.3;

fn stage(surfaces: &[(Surface, Sides)], planes: Vec<Plane>) -> Stage {
    let shapes = surfaces.iter().map(|(rest, sides)| Shape::new(rest, *sides, 0.15)).collect();
    let scene = Scene::new(shapes, &(0..surfaces.len()).collect::<Vec<_>>(), planes, REACH);
    Stage { scene, positions: surfaces.iter().flat_map(|(rest, _)| rest.positions.iter().copied()).collect() }
}

/// Areas of pairs, in their order; `edge` is the mean edge of all shapes, µm.
fn areas(stage: &Stage, edge: f64) -> Vec<(u32, u32, f64)> {
    let Stage { scene, positions } = stage;
    let table = CohesionTable::alike(&vec![edge; scene.shapes.len()], scene.planes.len(), WITHIN);
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
                        best = (opening.width, Some((other, opening.towards)));
                    }
                }
            }
            for (number, plane) in (bodies..).zip(&scene.planes) {
                let opening = opening_to_plane(n, (x - plane.point).dot(&plane.normal), plane.normal);
                if let Some((width, towards)) = opening
                    && width < best.0
                {
                    best = (width, Some((number, towards)));
                }
            }
            if let Some((other, towards)) = best.1 {
                let area = 0.5 * (of[1] - of[0]).cross(&(of[2] - of[0])).norm() / points.len() as f64;
                let seen = area * (2.0 / towards.norm_squared() - 1.0).max(0.0);
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
    let scenes = [packed_stage(8, REACH, 1)].into_iter().chain((0..20).map(random_stage));
    let (mut pairs, mut on_planes) = (0, 0);
    for (number, stage) in scenes.enumerate() {
        // Four points a facet.
        let (found, wanted) = (sum(&areas(&stage, WITHIN)), sum(&areas_by_all(&stage, 2)));
        let bodies = stage.scene.bodies.len() as u32;
        on_planes += wanted.iter().filter(|one| one.1 >= bodies).count();
        pairs += wanted.len();
        assert_eq!(found.len(), wanted.len(), "scene {number}: {found:?} {wanted:?}");
        for (found, wanted) in found.iter().zip(&wanted) {
            assert_eq!((found.0, found.1), (wanted.0, wanted.1), "scene {number}");
            assert!((found.2 - wanted.2).abs() < 1e-9 * (1.0 + wanted.2), "scene {number}: {found:?} {wanted:?}");
        }
    }
    assert!(pairs > 40 && on_planes > 5, "{pairs} {on_planes}");
}

/// A ball whose cap below a height was pressed flat.
fn pressed(level: u32, flat: f64) -> Surface {
    let mut ball = icosphere(5.0, level);
    ball.positions.iter_mut().for_each(|x| x.z = x.z.max(-flat));
    ball
}

/// The cosine to the pole where balls pressed flat at the cosine `flat` are 0.3 µm apart: `apart` is the opening over the radius there.
fn rim(flat: f64, apart: impl Fn(f64) -> f64) -> f64 {
    let (mut near, mut far) = (flat, 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (near + far);
        if 5.0 * apart(middle) < WITHIN { near = middle } else { far = middle }
    }
    near
}

#[test]
fn a_ball_pressed_on_a_plane_or_another_ball_has_the_area_of_theory_on_meshes_of_162_and_642_atoms() {
    for flat in [0.6, 0.7, 0.8] {
        // Seen from the plane the rim is a circle; between two balls the cosine between the surfaces counts.
        let c = rim(flat, |c| 2.0 * (flat - c) / (1.0 + c));
        let on_plane = std::f64::consts::PI * 25.0 * (1.0 - c * c);
        let c = rim(flat, |c| 2.0 * (flat - c) / c);
        let part = |c: f64| c - 2.0 / 3.0 * c * c * c;
        let ring = 2.0 * std::f64::consts::PI * 25.0 * (part(flat) - part(c));
        let between = std::f64::consts::PI * 25.0 * (1.0 - flat * flat) + ring;
        for (level, edge) in [(2, 1.5), (3, 0.76)] {
            let below = 5.0 * flat;
            let floor = vec![Plane { point: Vec3::z() * -below, normal: Vec3::z() }];
            let [(0, 1, found)] = sum(&areas(&stage(&[(pressed(level, below), Sides::Outer)], floor), edge))[..] else {
                panic!("one contact")
            };
            assert!((found / on_plane - 1.0).abs() < 0.05, "{flat} {level}: {found} of {on_plane}");
            let mut other = pressed(level, below);
            // Turned about the axis, so that facets do not match, and upside down.
            let turn = nalgebra::Rotation3::from_axis_angle(&Vec3::z_axis(), 0.4);
            let turn = nalgebra::Rotation3::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI) * turn;
            other.positions.iter_mut().for_each(|x| *x = turn * *x - Vec3::z() * (2.0 * below + 1e-3));
            let pair = stage(&[(pressed(level, below), Sides::Outer), (other, Sides::Outer)], vec![]);
            let [(0, 1, found)] = sum(&areas(&pair, edge))[..] else { panic!("one contact") };
            assert!((found / between - 1.0).abs() < 0.05, "{flat} {level}: {found} of {between}");
        }
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
    let planes =
        vec![Plane { point: Vec3::z() * -0.1, normal: Vec3::z() }, Plane { point: Vec3::z() * 0.6, normal: -Vec3::z() }];
    let found = sum(&areas(&stage(&[at(0.0), at(0.1), at(0.2)], planes), 1.0));
    let wanted = [(0, 1, 16.0), (0, 3, 16.0), (1, 2, 16.0)];
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(wanted) {
        assert!((found.0, found.1) == (wanted.0, wanted.1) && (found.2 - wanted.2).abs() < 1e-9, "{found:?} {wanted:?}");
    }
}
