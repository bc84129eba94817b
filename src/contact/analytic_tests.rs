//! Contacts whose answer is known without computing.

use super::test_scenes::{Dice, Stage, deform, stage};
use super::{
    AtomContact, Contacts, Detector, EdgeContact, Facing, Feature, Reach, Scene, Shape, Sides, add_walls_of_grooves,
    detect_all_pairs, find_overlaps, winding_number,
};
use crate::Vec3;
use crate::geometry::Obstacle;
use crate::geometry::{Surface, icosphere, sheet, translate};

const REACH: Reach = Reach { proximity: 0.2, prediction: 0.2, depth: 0.2, margin: 0.1 };

fn detect(stage: &Stage) -> Contacts {
    let mut contacts = Contacts::default();
    Detector::default().detect(&stage.scene, &stage.positions, &mut contacts);
    contacts
}

/// Two surfaces where they are.
fn pair(first: &Surface, second: &Surface, reach: Reach) -> Stage {
    let bodies = [first, second].map(|surface| (surface, Sides::Outer, surface.positions.clone()));
    stage(&bodies, Vec::new(), reach)
}

/// A tetrahedron that stands on the atom `tip`, 1 high.
fn needle(tip: Vec3) -> Surface {
    let top = |x: f64, y: f64| tip + Vec3::new(x, y, 1.0);
    let positions = vec![tip, top(0.3, 0.0), top(-0.15, 0.26), top(-0.15, -0.26)];
    Surface { positions, facets: vec![[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]] }
}

/// A box of two squares of facets a side, from −1 to 1 along x and y and from −2 to 0 along z.
fn block() -> Surface {
    let mut block = crate::geometry::box_surface([2.0, 2.0, 2.0], [2, 2, 2]);
    let middle = block.positions.iter().sum::<Vec3>() / block.positions.len() as f64;
    translate(&mut block, -middle - Vec3::z());
    block
}

#[test]
fn two_spheres_at_a_known_gap_touch_at_their_facing_atoms() {
    // Atoms of the octasphere lie on the axes, so that two of them face each other.
    let first = crate::geometry::octasphere(1.0, 4);
    for gap in [0.15, 0.01, -0.05] {
        let mut second = first.clone();
        translate(&mut second, Vec3::z() * (2.0 + gap));
        let contacts = detect(&pair(&first, &second, REACH));
        if gap > 0.0 {
            assert!((contacts.smallest_gap() - gap).abs() < 1e-12, "{gap}: {}", contacts.smallest_gap());
        }
        let nearest = contacts.atoms.iter().min_by(|a, b| a.gap.total_cmp(&b.gap)).expect("a contact");
        if gap > 0.0 {
            assert!((nearest.normal.wide().z.abs() - 1.0).abs() < 1e-12, "{nearest:?}");
        } else {
            // The facets around the facing atom lean by 15°, and the shortest displacement leads out: through one of them.
            assert!(nearest.normal.wide().z.abs() > 0.95 && (-0.05..-0.045).contains(&nearest.gap), "{nearest:?}");
        }
    }
}

#[test]
fn an_atom_over_a_face_an_edge_and_a_corner_is_told_once_each() {
    let block = block();
    let cases = [
        (Vec3::new(0.6, 0.3, 0.1), 0.1, Vec3::z()),
        // In the plane of two facets, over the edge between them: a gap, one contact, normal up.
        (Vec3::new(0.0, 0.5, 0.1), 0.1, Vec3::z()),
        (Vec3::new(0.0, 0.0, 0.1), 0.1, Vec3::z()),
        // Beside the block's edge and its corner.
        (Vec3::new(1.08, 0.5, 0.06), 0.1, Vec3::new(0.8, 0.0, 0.6)),
        (Vec3::new(1.02, 1.06, 0.09), 0.11, Vec3::new(2.0, 6.0, 9.0) / 11.0),
        // Inside, under the top and nearest to it.
        (Vec3::new(0.3, 0.4, -0.07), -0.07, Vec3::z()),
        (Vec3::new(0.95, 0.2, -0.12), -0.05, Vec3::x()),
    ];
    for (tip, gap, normal) in cases {
        let contacts = detect(&pair(&block, &needle(tip), REACH));
        let of_tip: Vec<_> = contacts.atoms.iter().filter(|contact| contact.atom == 26).collect();
        assert_eq!(of_tip.len(), 1, "{tip:?}: {of_tip:?}");
        assert!((of_tip[0].gap - gap).abs() < 1e-12, "{tip:?}: {of_tip:?}");
        assert!((of_tip[0].normal.wide() - normal).norm() < 1e-6, "{tip:?}: {of_tip:?}");
    }
}

#[test]
fn an_atom_in_a_groove_touches_both_of_its_walls() {
    // A sheet folded upwards along x = 0, its outside above.
    let mut groove = sheet(2.0, 2.0, 2, 2);
    let middle = groove.positions.iter().sum::<Vec3>() / 9.0;
    translate(&mut groove, -middle);
    groove.positions.iter_mut().for_each(|x| x.z = x.x.abs());
    let contacts = detect(&pair(&groove, &needle(Vec3::new(0.0, 0.3, 0.1)), REACH));
    let of_tip: Vec<_> = contacts.atoms.iter().filter(|contact| contact.atom == 9).collect();
    assert_eq!(of_tip.len(), 2, "{of_tip:?}");
    for contact in of_tip {
        assert!((contact.gap - 0.1 / 2f64.sqrt()).abs() < 1e-12 && contact.feature == Feature::Face, "{contact:?}");
    }
}

/// A ridge along x at height `top`, pointing up (`up` = 1) or down (−1): two facets of a long tent.
fn tent(direction: Vec3, top: f64, up: f64) -> Surface {
    let side = Vec3::z().cross(&direction);
    let (near, far) = (direction * -1.0 + Vec3::z() * top, direction + Vec3::z() * top);
    let low = Vec3::z() * (-up);
    tetrahedron([near, far, Vec3::z() * top + low + side, Vec3::z() * top + low - side])
}

/// A tetrahedron that faces outwards.
fn tetrahedron(corners: [Vec3; 4]) -> Surface {
    let mut surface = Surface { positions: corners.into(), facets: vec![[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]] };
    if crate::geometry::volume(&surface) < 0.0 {
        surface.facets.iter_mut().for_each(|facet| facet.swap(1, 2));
    }
    surface
}

#[test]
fn an_atom_that_slides_into_a_groove_has_its_other_wall_before_it_is_there() {
    // Two squares that rise from the y axis, one by 0.1 and one by 0.2 to each side.
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let positions =
        vec![at(0.0, -1.0, 0.0), at(0.0, 1.0, 0.0), at(1.0, 0.0, 0.1), at(-1.0, 0.0, 0.2), at(2.0, 1.0, 0.2)];
    let trough = Surface { positions, facets: vec![[0, 2, 1], [0, 1, 3], [1, 2, 4]] };
    let (thin, within) = (Sides::Both, 0.05);
    for (x, height, walls) in [(0.02, 0.01, 2), (-0.02, 0.01, 2), (0.2, 0.03, 1), (0.02, -0.03, 1)] {
        let slope = if x > 0.0 { 0.1 } else { -0.2 };
        let needle = needle(at(x, 0.0, slope * x + height));
        let bodies = [(&trough, thin, trough.positions.clone()), (&needle, Sides::Outer, needle.positions.clone())];
        let stage = stage(&bodies, Vec::new(), REACH);
        let mut contacts = detect(&stage);
        add_walls_of_grooves(&stage.scene, &stage.positions, within, &mut contacts);
        let is_of_tip = |near: &&AtomContact| near.atom == 5 && near.body(&stage.scene) == 0;
        let of_tip: Vec<_> = contacts.atoms.iter().filter(is_of_tip).collect();
        assert_eq!(of_tip.len(), walls, "{x}, {height}: {of_tip:?}");
        for contact in of_tip {
            let [a, b, c] = [0, 1, 2].map(|k| trough.positions[trough.facets[contact.facet as usize][k] as usize]);
            let front = (b - a).cross(&(c - a)).normalize() * height.signum();
            let distance = front.dot(&(needle.positions[0] - a));
            assert!(
                (contact.gap - distance).abs() < 1e-12 && (contact.normal.wide() - front).norm() < 1e-6,
                "{contact:?}"
            );
        }
    }
}

#[test]
fn a_groove_has_no_wall_that_an_atom_is_far_behind() {
    // An atom that has come by a sweep's worth around a corner of a rough ball is told by its memory as behind it, and is as far behind the
    // planes of the facets beside as these are steep.
    let (rest, mut dice) = (icosphere(1.0, 1), Dice(3));
    let reach = Reach { proximity: 0.05, prediction: 0.3, depth: 0.3, margin: 0.1 };
    let (tip, needle) = (rest.positions.len(), needle(Vec3::zeros()));
    let bodies = [(&rest, Sides::Both, rest.positions.clone()), (&needle, Sides::Outer, needle.positions.clone())];
    let mut stage = stage(&bodies, Vec::new(), reach);
    let mut walls = 0;
    for number in 0..1000 {
        stage.positions[..tip].copy_from_slice(&deform(&rest, &mut dice, 0.0, 0.2));
        let at = stage.positions[number % tip] + 0.03 * dice.vector();
        stage.positions[tip..].iter_mut().zip(&needle.positions).for_each(|(x, rest)| *x = rest + at);
        let mut contacts = detect(&stage);
        contacts.atoms.retain(|near| near.atom as usize == tip);
        let found = contacts.atoms.clone();
        for near in contacts.atoms.iter_mut().filter(|near| near.facing != Facing::Any) {
            let facing = if near.facing == Facing::Front { Facing::Back } else { Facing::Front };
            (near.gap, near.normal, near.facing) = (-near.gap, -near.normal, facing);
        }
        add_walls_of_grooves(&stage.scene, &stage.positions, stage.scene.safe_travel(), &mut contacts);
        let is_wall = |near: &&AtomContact| found.iter().all(|other| other.facet != near.facet);
        for wall in contacts.atoms.iter().filter(is_wall) {
            walls += 1;
            // A hundredth of the prediction, which sweeps may leave.
            assert!(wall.gap >= -0.003, "{wall:?} beside {found:?}");
        }
    }
    assert!(walls > 20, "{walls}");
}

/// A tent that hangs from its lowest edge, between two points.
fn keel(from: Vec3, to: Vec3) -> Surface {
    let (middle, across) = (0.5 * (from + to) + Vec3::z(), Vec3::z().cross(&(to - from)).normalize());
    tetrahedron([from, to, middle + across, middle - across])
}

#[test]
fn an_edge_that_has_slid_in_over_its_end_touches_the_crest_that_it_passes_below() {
    // The wall of this block at x = 1 leans in below its crest: what passes 0.01 below the crest is beside the wall there.
    let mut block = block();
    block
        .positions
        .iter_mut()
        .filter(|position| position.x == 1.0)
        .for_each(|position| position.x += 0.05 * position.z);
    for (end, touches) in [(1.1, true), (1.0002, true), (0.9998, true), (0.99, false)] {
        let keel = keel(Vec3::new(end, 0.3, -0.01), Vec3::new(-1.2, 0.3, -0.01));
        for (own, stage) in [(1, pair(&block, &keel, REACH)), (0, pair(&keel, &block, REACH))] {
            let contacts = detect(&stage);
            let bodies = |contact: &EdgeContact| contact.bodies(&stage.scene);
            let keels_share = |contact: &EdgeContact| contact.along[usize::from(bodies(contact)[1] == own)];
            let at_crest = contacts.edges.iter().find(|contact| keels_share(contact) < 0.05);
            assert_eq!(at_crest.is_some(), touches, "end at {end}: {:?}", contacts.edges);
            if let Some(contact) = at_crest {
                assert!((contact.gap + 0.01).abs() < 1e-12 && contact.normal.wide().z.abs() > 0.999_999, "{contact:?}");
                assert!(contact.along.iter().all(|share| (0.0..=1.0).contains(share)), "{contact:?}");
            } else {
                // Its end is inside, and the atom there has a contact for that.
                assert!(contacts.atoms.iter().any(|contact| contact.gap < -0.009), "{:?}", contacts.atoms);
            }
        }
    }
}

#[test]
fn an_edge_that_cuts_through_a_thin_ridge_that_leans_over_touches_its_crest() {
    // Between the walls x = −z/5 and x = −z: what passes below the crest is beside the one, comes in through it and goes out through the other.
    let ridge = tetrahedron([-Vec3::y(), Vec3::y(), Vec3::new(0.2, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0)]);
    // Far across it, as far as just behind the second wall, between the two, and before it has come in.
    for (end, touches) in [(1.0, true), (0.06, true), (0.03, true), (0.005, false)] {
        let keel = keel(Vec3::new(end, 0.3, -0.05), Vec3::new(-1.2, 0.3, -0.05));
        for stage in [pair(&ridge, &keel, REACH), pair(&keel, &ridge, REACH)] {
            let contacts = detect(&stage);
            let at_crest = contacts.edges.iter().find(|contact| (contact.gap + 0.05).abs() < 1e-12);
            assert_eq!(at_crest.is_some(), touches, "end at {end}: {:?}", contacts.edges);
            if let Some(contact) = at_crest {
                assert!(contact.normal.wide().z.abs() > 0.999_999, "{contact:?}");
            }
        }
    }
}

#[test]
fn an_edge_whose_end_stands_on_a_wall_of_a_ridge_touches_the_crest_if_it_cuts_through() {
    let ridge = tetrahedron([-Vec3::y(), Vec3::y(), Vec3::new(0.2, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0)]);
    // 0.05 below the crest the first wall is at x = 0.01: the end is before it by round-off, stands on it, and is inside.
    for (end, touches) in [(0.01 - 1e-9, true), (0.01 + 1e-5, true), (0.03, false)] {
        let keel = keel(Vec3::new(end, 0.3, -0.05), Vec3::new(1.2, 0.3, -0.05));
        for stage in [pair(&ridge, &keel, REACH), pair(&keel, &ridge, REACH)] {
            let contacts = detect(&stage);
            let at_crest = contacts.edges.iter().find(|contact| (contact.gap + 0.05).abs() < 1e-12);
            assert_eq!(at_crest.is_some(), touches, "end at {end}: {:?}", contacts.edges);
            // An end that is inside has a contact of its atom for it.
            assert!(touches || contacts.atoms.iter().any(|contact| contact.gap < -0.01), "{:?}", contacts.atoms);
        }
    }
}

#[test]
fn two_crossing_ridges_touch_by_their_edges_with_a_signed_gap() {
    for gap in [0.1, 0.02, -0.05] {
        let stage = pair(&tent(Vec3::x(), 0.0, 1.0), &tent(Vec3::new(0.6, 0.8, 0.0), gap, -1.0), REACH);
        let contacts = detect(&stage);
        assert_eq!(contacts.edges.len(), 1, "gap {gap}: {:?}", contacts.edges);
        let contact = contacts.edges[0];
        assert!((contact.gap - gap).abs() < 1e-12 && contact.along == [0.5, 0.5], "{contact:?}");
        // From the second to the first, towards the outside of the second: down.
        assert!((contact.normal.wide() + Vec3::z()).norm() < 1e-12, "{contact:?}");
    }
}

/// A ridge along x in the plane z = 0, convex from above, with one facet that falls away and one that rises by this sine.
fn leaning_ridge(sine: f64) -> Surface {
    // From the end of the ridge to the atom across it is √2 along the plane.
    let height = (2.0 * sine * sine / (1.0 - sine * sine)).sqrt();
    let positions = vec![-Vec3::x(), Vec3::x(), Vec3::new(0.0, 1.0, height), Vec3::new(0.0, -1.0, -1.0)];
    Surface { positions, facets: vec![[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]] }
}

#[test]
fn ridges_that_have_not_passed_each_other_touch_though_a_facet_rises_a_little() {
    let cases = [
        (0.09, 0.15, true),
        (0.09, 0.0, true),
        // Passed by less than a hundredth of the prediction, and by more.
        (0.09, -0.0019, true),
        (0.09, -0.0021, false),
        (0.11, 0.15, false),
        // Nearer than the depth and the margin, but not than the prediction.
        (0.09, 0.21, false),
    ];
    for (sine, gap, touches) in cases {
        let direction = Vec3::new(0.6, 0.8, 0.0);
        for stage in [
            pair(&leaning_ridge(sine), &tent(direction, gap, -1.0), REACH),
            pair(&tent(direction, gap, -1.0), &leaning_ridge(sine), REACH),
        ] {
            let contacts = detect(&stage);
            let crossing = contacts.edges.iter().find(|contact| contact.along == [0.5, 0.5]);
            assert_eq!(crossing.is_some(), touches, "sine {sine}, gap {gap}: {:?}", contacts.edges);
            if let Some(contact) = crossing {
                let upwards = if stage.positions[2].z > 0.0 && stage.positions[3].z == -1.0 { -1.0 } else { 1.0 };
                assert!((contact.gap - gap).abs() < 1e-12, "{contact:?}");
                assert!((contact.normal.wide() - upwards * Vec3::z()).norm() < 1e-12, "{contact:?}");
            }
        }
    }
}

#[test]
fn parallel_edges_and_collapsed_facets_give_numbers() {
    let parallel = detect(&pair(&tent(Vec3::x(), 0.0, 1.0), &tent(Vec3::x(), 0.1, -1.0), REACH));
    assert!((parallel.smallest_gap() - 0.1).abs() < 1e-12, "the ends of parallel ridges face each other");
    // All atoms of a facet in one point, all of a cell in one line, all of a cell in one point.
    let rest = icosphere(1.0, 1);
    let mut broken = rest.clone();
    let [a, b, c] = rest.facets[7].map(|atom| atom as usize);
    (broken.positions[b], broken.positions[c]) = (broken.positions[a], broken.positions[a]);
    let line: Vec<Vec3> = rest.positions.iter().map(|x| Vec3::x() * x.x + Vec3::z() * 1.05).collect();
    let point = vec![Vec3::new(0.1, 0.9, 0.3); 42];
    let bodies = [(&rest, Sides::Outer, broken.positions), (&rest, Sides::Outer, line), (&rest, Sides::Outer, point)];
    let stage = stage(&bodies, Vec::new(), REACH);
    let contacts = detect(&stage);
    assert!(contacts.atoms.len() > 10);
    let normals =
        contacts.atoms.iter().map(|c| (c.gap, c.normal)).chain(contacts.edges.iter().map(|c| (c.gap, c.normal)));
    for (gap, normal) in normals {
        assert!(gap.is_finite() && (normal.wide().norm() - 1.0).abs() < 1e-6, "{gap} {normal:?}");
    }
    assert!(contacts.atoms.iter().all(|contact| contact.weights().iter().all(|weight| weight.is_finite())));
}

#[test]
fn a_folded_sheet_touches_itself_and_a_flat_one_does_not() {
    let flat = sheet(4.0, 1.0, 8, 2);
    let of = |positions: Vec<Vec3>| detect(&stage(&[(&flat, Sides::Both, positions)], Vec::new(), REACH));
    assert_eq!(of(flat.positions.clone()), Contacts::default());
    // Folded over along x = 0, with a space of 0.1 between the halves.
    let fold = |x: &Vec3| if x.x <= 0.0 { *x } else { Vec3::new(-x.x, x.y, 0.1) };
    let folded = of(flat.positions.iter().map(fold).collect());
    assert!(folded.atoms.len() > 10, "{folded:?}");
    assert!(folded.atoms.iter().all(|contact| (contact.gap - 0.1).abs() < 1e-12));
}

#[test]
fn sheets_have_one_outside_or_two_and_none_beyond_their_rim() {
    let flat = sheet(2.0, 2.0, 2, 2);
    let tip = |position: Vec3, sides: Sides| {
        let needle = needle(position);
        let points = (flat.positions.clone(), needle.positions.clone());
        let contacts =
            detect(&stage(&[(&flat, sides, points.0), (&needle, Sides::Outer, points.1)], Vec::new(), REACH));
        contacts.atoms.iter().find(|contact| contact.atom == 9).map(|contact| (contact.gap, contact.normal.wide().z))
    };
    assert_eq!(tip(Vec3::new(0.7, 0.6, -0.1), Sides::Outer), Some((-0.1, 1.0)));
    assert_eq!(tip(Vec3::new(0.7, 0.6, -0.1), Sides::Both), Some((0.1, -1.0)));
    let (gap, up) = tip(Vec3::new(1.1, 0.6, -0.01), Sides::Outer).expect("a contact with the rim");
    assert!(gap > 0.1 && gap < 0.102 && up < 0.0, "an atom beside a sheet is not behind it");
}

#[test]
fn atoms_behind_a_plane_are_found_however_deep() {
    let sphere = icosphere(1.0, 1);
    let obstacle = Obstacle::Plane { point: Vec3::z() * 5.0, normal: Vec3::z() };
    let stage = stage(&[(&sphere, Sides::Outer, sphere.positions.clone())], vec![obstacle], REACH);
    let contacts = detect(&stage);
    assert_eq!(contacts.obstacles.len(), 42);
    assert!((contacts.smallest_gap() + 6.0).abs() < 0.2);
}

#[test]
fn overlaps_at_the_start_are_told_apart() {
    let small = icosphere(0.4, 1);
    let large = icosphere(1.0, 1);
    let mut aside = icosphere(1.0, 1);
    translate(&mut aside, Vec3::x() * 1.7);
    let mut away = icosphere(1.0, 1);
    translate(&mut away, Vec3::y() * 2.5);
    let bodies: Vec<_> =
        [&small, &large, &aside, &away].map(|surface| (surface, Sides::Outer, surface.positions.clone())).into();
    let stage = stage(&bodies, Vec::new(), REACH);
    let overlaps = find_overlaps(&stage.scene, &stage.positions);
    assert_eq!(overlaps.len(), 2, "{overlaps:?}");
    assert_eq!((overlaps[0].bodies, overlaps[0].atoms_inside, overlaps[0].nested()), ([0, 1], [42, 0], Some(0)));
    assert_eq!((overlaps[1].bodies, overlaps[1].nested()), ([1, 2], None));
    assert!(overlaps[1].crossings > 0 && overlaps[1].atoms_inside[0] > 0);
    let winding = winding_number(Vec3::new(0.2, 0.1, 0.3), &large.positions, &large.facets);
    assert!((winding - 1.0).abs() < 1e-14);
    assert!(winding_number(Vec3::x() * 1.2, &large.positions, &large.facets).abs() < 1e-14);
}

#[test]
fn an_empty_scene_and_a_body_without_facets_are_no_trouble() {
    let mut contacts = Contacts::default();
    let empty = Scene::new([], &[], Vec::new(), REACH);
    assert_eq!(Detector::default().detect(&empty, &[], &mut contacts).pairs, 0);
    let lone = Surface { positions: vec![Vec3::zeros(), Vec3::x()], facets: Vec::new() };
    let scene = Scene::new(vec![Shape::new(&lone, Sides::Both, 0.1)], &[0, 0], Vec::new(), REACH);
    let positions = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    Detector::default().detect(&scene, &positions, &mut contacts);
    let mut all = contacts.clone();
    detect_all_pairs(&scene, &positions, &mut all);
    assert_eq!(contacts, all);
}
