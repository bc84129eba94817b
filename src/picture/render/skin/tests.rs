use super::*;
use crate::picture::render::tests::{front, sphere};
use crate::picture::render::{Camera, Floor, Overlay, Projection, draw};
use std::f64::consts::TAU;

fn view() -> View {
    View::new(&front(), 800, 800)
}

fn skin(surface: &Surface, planes: &[[Vec3; 2]]) -> Skin {
    let view = view();
    let shape = Shape::new(surface, &topology_of(surface), &view);
    assert!(shape.parts > 1, "a coarse mesh, seen large, is divided");
    shape.skin(4, planes, None)
}

/// A block of 3 × 2 × 2 squares of 2 µm, each of two facets, with its atoms at edges shared.
fn block() -> Surface {
    let size = [3, 2, 2];
    let mut points: Vec<[i32; 3]> = Vec::new();
    let mut facets = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (level, i, j) in [0, size[axis]]
            .into_iter()
            .flat_map(|level| (0..size[u]).flat_map(move |i| (0..size[v]).map(move |j| (level, i, j))))
        {
            let mut at = |i: i32, j: i32| {
                let mut point = [0; 3];
                (point[axis], point[u], point[v]) = (level, i, j);
                points.iter().position(|known| *known == point).unwrap_or_else(|| {
                    points.push(point);
                    points.len() - 1
                }) as u32
            };
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            facets.extend(if level > 0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
        }
    }
    let positions = points.iter().map(|point| point.map(|k| 2.0 * f64::from(k))).collect();
    Surface::new(positions, facets, Colour([0x80; 3]))
}

/// A rod of `around` sides with flat ends, 4 µm thick and 6 µm long.
fn rod(around: u32) -> Surface {
    let mut positions = vec![[0.0, 0.0, 0.0], [0.0, 0.0, 6.0]];
    let mut facets = Vec::new();
    for k in 0..around {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(around)).sin_cos();
        positions.extend([[2.0 * cos, 2.0 * sin, 0.0], [2.0 * cos, 2.0 * sin, 6.0]]);
        let [a, b] = [2 + 2 * k, 2 + 2 * ((k + 1) % around)];
        facets.extend([[a, b, b + 1], [a, b + 1, a + 1], [0, b, a], [1, a + 1, b + 1]]);
    }
    Surface::new(positions, facets, Colour([0x80; 3]))
}

#[test]
fn a_skin_of_few_atoms_is_round_and_passes_through_them() {
    let surface = sphere([1.0, 2.0, 3.0], 5.0, 1);
    let skin = skin(&surface, &[]);
    let centre = Vec3::new(1.0, 2.0, 3.0);
    for (point, normal) in skin.points.iter().zip(&skin.normals) {
        let outwards = Vec3::from(*point) - centre;
        // The middles of the flat facets are 0.3 µm and more inside.
        assert!((outwards.norm() - 5.0).abs() < 0.03, "{}", outwards.norm());
        assert!(normal.cast::<f64>().dot(&outwards.normalize()) > 0.999);
    }
    for atom in &surface.positions {
        let nearest = skin.points.iter().map(|point| (Vec3::from(*point) - Vec3::from(*atom)).norm());
        assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-12);
    }
}

#[test]
fn spheres_of_few_atoms_are_round() {
    for (splits, within) in [(0, 0.003), (1, 0.003), (2, 0.001)] {
        let skin = skin(&sphere([0.0; 3], 5.0, splits), &[]);
        let off = skin.points.iter().map(|point| (Vec3::from(*point).norm() / 5.0 - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < within, "{splits}: {off}");
    }
}

#[test]
fn a_block_keeps_flat_faces_and_straight_edges() {
    let view = view();
    let surface = block();
    let skin = Shape::new(&surface, &topology_of(&surface), &view).skin(3, &[], None);
    let size = [6.0, 4.0, 4.0];
    for (point, normal) in skin.points.iter().zip(&skin.normals) {
        let axis = (0..3).find(|k| normal[*k].abs() > 0.999_99).expect("a normal along an axis, at corners, too");
        let level = if normal[axis] > 0.0 { size[axis] } else { 0.0 };
        assert!((point[axis] - level).abs() < 1e-12, "{point:?} {normal:?}");
    }
    assert_eq!(Shape::new(&surface, &topology_of(&surface), &view).parts, 1, "what is flat is not divided");
}

#[test]
fn rims_of_rods_are_round_and_sharp() {
    let skin = skin(&rod(8), &[]);
    let mut rim = 0;
    for (point, normal) in skin.points.iter().zip(&skin.normals) {
        let radius = point[0].hypot(point[1]);
        if normal.z.abs() > 0.5 {
            assert!(normal.z.abs() > 0.999_99 && (point[2] * (6.0 - point[2])).abs() < 1e-12, "{point:?} {normal:?}");
            rim += usize::from(radius > 1.99);
        } else {
            assert!(normal.z.abs() < 1e-5 && (radius - 2.0).abs() < 0.01, "{point:?} {normal:?}");
        }
    }
    assert!(rim > 64, "ends reach the rim between atoms, too: {rim}");
}

#[test]
fn a_fold_that_ends_within_a_skin_is_no_edge() {
    // A sheet of 8 × 8 squares that is folded along its middle from one side on, and flat beyond `end`.
    let folded = |end: f64| {
        let height = |x: f64, y: f64| -0.6 * x.abs().min(1.0) * (0.25 * (end - y)).clamp(0.0, 1.0);
        let at = |n: u32| (f64::from(n % 9) - 4.0, f64::from(n / 9));
        let positions = (0..81).map(at).map(|(x, y)| [x, y, height(x, y)]).collect();
        let corner = |n: u32| n / 8 * 9 + n % 8;
        let facets = (0..64).map(corner).flat_map(|a| [[a, a + 1, a + 10], [a, a + 10, a + 9]]).collect();
        let surface = Surface::new(positions, facets, Colour([0x80; 3]));
        Shape::new(&surface, &topology_of(&surface), &view()).bearing.creases.has_edges
    };
    assert!(folded(20.0) && !folded(5.0));
}

#[test]
fn a_mesh_has_the_edges_that_it_has_at_rest() {
    let flattened = |mut surface: Surface| {
        surface.rest.clone_from(&surface.positions);
        surface.positions.iter_mut().for_each(|p| p[2] = p[2].max(0.0));
        surface
    };
    let has_edges = |surface: &Surface| Shape::new(surface, &topology_of(surface), &view()).bearing.creases.has_edges;
    let drop = flattened(sphere([0.0; 3], 5.0, 2));
    assert!(!has_edges(&drop) && has_edges(&Surface { rest: Vec::new(), ..drop }));
    let mut block = block();
    block.rest.clone_from(&block.positions);
    block.positions.iter_mut().for_each(|p| p[1] *= 1.0 + 0.1 * p[0]);
    assert!(has_edges(&block));
}

#[test]
fn neighbours_have_no_gap_between_them() {
    let mut open = sphere([0.0; 3], 5.0, 1);
    open.facets.truncate(50);
    for surface in [sphere([0.0; 3], 5.0, 1), rod(8), open] {
        let view = view();
        let topology = topology_of(&surface);
        let skin = Shape::new(&surface, &topology, &view).skin(4, &[], None);
        // Points on sides of facets: two of them at each, but for rims.
        let mut on_sides: Vec<[i64; 3]> = Vec::new();
        for piece in &skin.pieces {
            for k in (0..3).filter(|k| piece.lines >> k & 1 == 1) {
                let [p, q] = [1, 2].map(|next| Vec3::from(skin.points[piece.corners[(k + next) % 3] as usize]));
                on_sides.push((0.5 * (p + q) * 1e9).map(|x| x.round() as i64).into());
            }
        }
        on_sides.sort_unstable();
        let near = |a: &[i64; 3], b: &[i64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() <= 1);
        let alone = on_sides.chunk_by(near).filter(|same| same.len() == 1).count();
        let rims = topology.across.iter().filter(|side| **side == topology::NONE).count();
        assert_eq!(alone, 4 * rims, "{} facets", surface.facets.len());
    }
}

#[test]
fn a_skin_comes_no_nearer_to_a_plane_than_its_atoms() {
    let mut surface = sphere([0.0, 0.0, 4.0], 5.0, 1);
    surface.positions.iter_mut().for_each(|p| p[2] = p[2].clamp(0.02, 7.0));
    let planes = [[Vec3::zeros(), Vec3::z()], [Vec3::new(0.0, 0.0, 7.1), Vec3::z()]];
    let heights = |planes: &[[Vec3; 2]]| {
        let skin = skin(&surface, planes);
        let z = || skin.points.iter().map(|point| point[2]);
        [z().fold(f64::INFINITY, f64::min), z().fold(f64::NEG_INFINITY, f64::max)]
    };
    assert!(heights(&[])[0] < -0.05 && heights(&[])[1] > 7.1, "{:?}", heights(&[]));
    assert!(heights(&planes)[0] > 0.019_999 && heights(&planes)[1] < 7.000_001, "{:?}", heights(&planes));
}

#[test]
fn a_crowd_is_not_divided_beyond_measure() {
    let cell = |n: usize| sphere([0.1 * n as f64, 0.0, 0.0], 5.0, 1);
    let scene = Scene { surfaces: (0..1000).map(cell).collect(), ..Scene::default() };
    let triangles: usize = skins(&scene, &view()).iter().map(|skin| skin.pieces.len()).sum();
    let facets = 1000 * scene.surfaces[0].facets.len();
    assert!(triangles > facets && triangles <= 2 * facets + MORE, "{triangles}");
}

#[test]
fn what_is_far_from_the_eye_stays_as_it_is() {
    let scene = Scene { surfaces: vec![sphere([0.0; 3], 5.0, 1)], ..Scene::default() };
    let pieces = |scene: &Scene| skins(scene, &view())[0].pieces.clone();
    let back = |piece: &&Piece| piece.parts == 1;
    assert!(pieces(&scene).iter().filter(back).count() >= 8);
    let cut = Scene { cut: Some([0.0, 2.0, 0.0]), ..scene };
    assert!(pieces(&cut).iter().all(|piece| piece.parts == 1), "cuts are told by facets");
}

#[test]
fn a_round_cell_of_few_atoms_has_a_round_outline_without_dark_slivers() {
    let overlay = Overlay { scale_bar: crate::picture::render::ScaleBar::Hidden, ..Overlay::default() };
    let mut surface = sphere([0.0; 3], 5.0, 0);
    surface.colour = SurfaceColour::Uniform(Colour([0x56, 0xb4, 0xe9]));
    let background = crate::picture::render::Background::plain(Colour([255; 3]));
    let scene = Scene { surfaces: vec![surface], background, ..Scene::default() };
    let image = draw(&scene, &front(), &overlay, 400, 400);
    let inside: Vec<u8> =
        (0..400 * 400).map(|n| image.pixel(n % 400, n / 400).0[2]).filter(|blue| *blue < 250).collect();
    let radius = (inside.len() as f64 / std::f64::consts::PI).sqrt();
    // Twelve atoms: flat facets cover a disc of 93 pixels' radius.
    assert!((radius - 100.0).abs() < 1.5, "{radius}");
    assert!(inside.iter().all(|blue| *blue > 90), "{:?}", inside.iter().min());
}

#[test]
fn a_block_on_a_floor_has_each_face_in_one_light() {
    let overlay = Overlay { scale_bar: crate::picture::render::ScaleBar::Hidden, ..Overlay::default() };
    let floor = Some(Floor { point: [0.0; 3], normal: [0.0, 0.0, 1.0], grid: 1.0, radius: 20.0 });
    let scene = Scene { surfaces: vec![block()], floor, ..Scene::default() };
    let camera = crate::picture::Camera { eye: [30.0, -50.0, 30.0], target: [3.0, 2.0, 2.0], ..front() };
    let image = draw(&scene, &camera, &overlay, 400, 400);
    let mut colours: std::collections::HashMap<Colour, usize> = std::collections::HashMap::new();
    (0..400 * 400).for_each(|n| *colours.entry(image.pixel(n % 400, n / 400)).or_default() += 1);
    let mut counts: Vec<usize> = colours.into_values().collect();
    counts.sort_unstable();
    // Parallel rays: each face has one colour but for its outline.
    let faces: usize = counts.iter().rev().take(3).sum();
    assert!(faces > 15_000, "{faces} pixels in the three commonest colours");
}

#[test]
fn a_ball_on_an_open_sheet_does_not_bulge_through_it() {
    let ball = sphere([0.0, 0.0, 0.0], 5.0, 1);
    // Turned so that a facet is its lowest part, and put onto the sheet.
    let facet = ball.facets[0].map(|atom| Vec3::from(ball.positions[atom as usize]));
    let down = -(facet[1] - facet[0]).cross(&(facet[2] - facet[0])).normalize();
    let down = if down.dot(&facet[0]) > 0.0 { down } else { -down };
    let turn = nalgebra::Rotation3::rotation_between(&down, &-Vec3::z()).unwrap_or_else(nalgebra::Rotation3::identity);
    let lowest = ball.positions.iter().map(|at| (turn * Vec3::from(*at)).z).fold(f64::INFINITY, f64::min);
    let lie = |at: &[f64; 3]| <[f64; 3]>::from(turn * Vec3::from(*at) + Vec3::new(0.3, 0.2, 0.01 - lowest));
    let ball = Surface { positions: ball.positions.iter().map(lie).collect(), ..ball };
    let (mut positions, mut facets) = (Vec::new(), Vec::new());
    for n in 0..11_u32 {
        positions.extend((0..11).map(|m| [2.0 * f64::from(n) - 10.0, 2.0 * f64::from(m) - 10.0, 0.0]));
    }
    for at in (0..110_u32).filter(|at| at % 11 != 10) {
        facets.extend([[at, at + 11, at + 12], [at, at + 12, at + 1]]);
    }
    let sheet = Surface::new(positions, facets, Colour([90; 3]));
    let camera = Camera {
        eye: [0.0, -40.0, 4.0],
        target: [0.0, 0.0, 4.0],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Orthographic { height: 12.0 },
        shift: [0.0; 2],
    };
    let view = View::new(&camera, 800, 800);
    let least = |surfaces: Vec<Surface>| {
        let ball = surfaces.len() - 1;
        let skins = skins(&Scene { surfaces, ..Scene::default() }, &view);
        skins[ball].points.iter().map(|at| at[2]).fold(f64::INFINITY, f64::min)
    };
    let (alone, lying) = (least(vec![ball.clone()]), least(vec![sheet, ball]));
    assert!(alone < -0.02, "the skin of a ball alone is below its facets: {alone}");
    assert!(lying > 0.0, "{lying}");
}
