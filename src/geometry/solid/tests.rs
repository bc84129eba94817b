//! Cells are cut so that neighbours agree, fill the body, and are told where they are not sound.

use super::*;
use crate::geometry::{SurfaceRules, Topology, check_surface, volume};

/// The surface alone.
fn outer(solid: &Solid) -> Surface {
    let positions = solid.surface.positions[..solid.outer_atoms()].to_vec();
    Surface { positions, facets: solid.surface.facets.clone() }
}

/// Whether tetrahedra fill the surface, which is closed and sound.
fn holds_together(solid: &Solid) {
    let surface = outer(solid);
    check_surface(&surface, &SurfaceRules::CELL).expect("a sound surface");
    let (inside, around) = (solid.volumes().sum::<f64>(), volume(&surface));
    assert!((inside / around - 1.0).abs() < 1e-13, "{inside} in {around}");
    assert!(solid.volumes().all(|volume| volume > 0.0));
    assert_eq!(*solid.cells.last().expect("cells") as usize, solid.tetrahedra.len());
}

#[test]
fn a_block_is_filled_by_five_tetrahedra_a_box_that_are_mirrored_from_box_to_box() {
    let solid = block([2.0, 3.0, 4.0], [2, 3, 4]).expect("a sound body");
    assert_eq!(solid.tetrahedra.len(), 5 * 2 * 3 * 4);
    assert_eq!(solid.surface.positions.len(), 3 * 4 * 5);
    assert_eq!(solid.outer_atoms(), 3 * 4 * 5 - 2 * 3);
    assert!((solid.volumes().sum::<f64>() - 24.0).abs() < 1e-12);
    holds_together(&solid);
    assert_eq!(Topology::of(&outer(&solid)).euler_characteristic(), 2);
}

#[test]
fn a_rod_is_filled_and_its_volume_is_that_of_its_polygon() {
    for rings in 1..5 {
        let solid = rod([2.0, 2.0], 5.0, rings, 3).expect("a sound body");
        holds_together(&solid);
        let corners = f64::from(6 * rings);
        let expected = 5.0 * 0.5 * corners * 4.0 * (std::f64::consts::TAU / corners).sin();
        let found = solid.volumes().sum::<f64>();
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
        assert_eq!(solid.surface.positions.len() as u32, 4 * (1 + 3 * rings * (rings + 1)));
    }
}

/// A cube of edge 1 beside another of 1 × 1 × 1 made of two wedges, on which a pyramid of the same height stands; numbers are mixed by `turn`.
fn mixed(turn: u32) -> (Vec<Vec3>, Vec<SolidCell>) {
    let corners = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [0, 0, 1],
        [1, 0, 1],
        [1, 1, 1],
        [0, 1, 1],
        [2, 0, 0],
        [2, 1, 0],
        [2, 0, 1],
        [2, 1, 1],
    ];
    let mut all: Vec<Vec3> = corners.iter().map(|corner| Vec3::from(corner.map(f64::from))).collect();
    all.push(Vec3::new(1.5, 0.5, 2.0));
    let count = all.len() as u32;
    // A shuffle that is one to one, as 13 is a prime.
    let number = |atom: u32| atom * turn % count;
    let mut positions = vec![Vec3::zeros(); all.len()];
    all.iter().zip(0..).for_each(|(x, atom)| positions[number(atom) as usize] = *x);
    let cells = vec![
        SolidCell::Hexahedron([0, 1, 2, 3, 4, 5, 6, 7].map(number)),
        SolidCell::Wedge([1, 8, 9, 5, 10, 11].map(number)),
        SolidCell::Wedge([1, 9, 2, 5, 11, 6].map(number)),
        SolidCell::Pyramid([5, 10, 11, 6, 12].map(number)),
    ];
    (positions, cells)
}

#[test]
fn cells_of_all_kinds_agree_on_their_faces_whatever_their_numbers() {
    for turn in 1..13 {
        let (positions, cells) = mixed(turn);
        let (mut solid, numbers) = Solid::of_cells(&positions, &cells).expect("a sound body");
        assert!(numbers.iter().all(Option::is_some));
        // The wedges' common face ends on the base of the pyramid, whose diagonal is another where numbers say so: then faces are left
        // between them.
        let total: f64 = solid.volumes().sum();
        assert!((total - (2.0 + 1.0 / 3.0)).abs() < 1e-12, "{total}");
        solid.surface.positions.truncate(solid.outer_atoms());
        let around = volume(&solid.surface);
        assert!((around - total).abs() < 1e-12, "turn {turn}: {around} around {total}");
    }
}

#[test]
fn hexahedra_without_two_colours_are_cut_from_their_lowest_atoms() {
    // Three boxes around an edge: their outer corners form a cycle of odd length through the shared edge's neighbours.
    let around = [0.0_f64, 120.0, 240.0].map(f64::to_radians);
    let (mut positions, mut cells) = (vec![Vec3::zeros()], Vec::new());
    for angle in around {
        let along = |angle: f64, r: f64| Vec3::new(r * angle.cos(), r * angle.sin(), 0.0);
        positions.extend([along(angle, 1.0), along(angle + 60f64.to_radians(), 1.0)]);
    }
    let level = positions.len() as u32;
    positions.extend(positions.clone().iter().map(|x| x + Vec3::z()));
    for k in 0..3 {
        let base = [0, 1 + 2 * k, 2 + 2 * k, 1 + 2 * ((k + 1) % 3)];
        let [a, b, c, d] = base;
        cells.push(SolidCell::Hexahedron([a, b, c, d, a + level, b + level, c + level, d + level]));
    }
    // These are two-colourable; a wedge beside them forbids five.
    let (solid, _) = Solid::of_cells(&positions, &cells).expect("sound");
    assert_eq!(solid.tetrahedra.len(), 15);
    holds_together(&solid);
    let far = positions.len() as u32;
    positions.push(Vec3::new(3.0, 0.5, 0.0));
    positions.push(Vec3::new(3.0, 0.5, 1.0));
    cells.push(SolidCell::Wedge([1, far, 2, 1 + level, far + 1, 2 + level]));
    let (solid, _) = Solid::of_cells(&positions, &cells).expect("sound");
    assert_eq!(solid.tetrahedra.len(), 3 * 6 + 3);
    holds_together(&solid);
}

#[test]
fn a_cell_that_is_told_inside_out_is_turned_and_one_that_is_torn_is_refused() {
    let (positions, mut cells) = mixed(1);
    cells.truncate(1);
    let whole = Solid::of_cells(&positions, &cells).expect("sound").0;
    let SolidCell::Hexahedron([a, b, c, d, e, f, g, h]) = cells[0] else { unreachable!("it is one") };
    let turned = [SolidCell::Hexahedron([e, f, g, h, a, b, c, d])];
    let other = Solid::of_cells(&positions, &turned).expect("sound").0;
    assert!((whole.volumes().sum::<f64>() - other.volumes().sum::<f64>()).abs() < 1e-14);
    holds_together(&other);
    let torn = [SolidCell::Hexahedron([a, b, d, c, e, f, g, h])];
    let faults = Solid::of_cells(&positions, &torn).expect_err("torn");
    assert!(
        faults.iter().any(|fault| matches!(fault, SolidFault::Inverted { .. } | SolidFault::Flat { .. })),
        "{faults:?}"
    );
}

#[test]
fn faults_say_which_cell_and_which_atoms() {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let corners = [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 1.0), at(0.3, 0.3, 0.001)];
    let of = |cells: &[[u32; 4]]| {
        let cells: Vec<SolidCell> = cells.iter().map(|atoms| SolidCell::Tetrahedron(*atoms)).collect();
        let faults = Solid::of_cells(&corners, &cells).expect_err("faults");
        faults.iter().map(|fault| format!("{fault}; {}", fault.help())).collect::<Vec<_>>().join("\n")
    };
    assert!(of(&[]).contains("no cells that fill it"));
    assert!(of(&[[0, 1, 2, 9]]).contains("cell 0 names atom 9, and there are 5"));
    assert!(of(&[[0, 1, 2, 3], [0, 1, 1, 3]]).contains("cell 1 names atom 1 twice"));
    assert!(of(&[[0, 1, 2, 4]]).contains("the tetrahedron of atoms [0, 1, 2, 4] in cell 0 is flat: its quality is "));
    assert!(of(&[[0, 1, 2, 3], [0, 1, 2, 3], [0, 1, 2, 3]]).contains("3 tetrahedra share the face of atoms [0, 1, 2]"));
    let far: Vec<Vec3> = corners[..4]
        .iter()
        .chain(&corners[..4].iter().map(|x| x + Vec3::x() * 5.0).collect::<Vec<_>>())
        .copied()
        .collect();
    let cells = [SolidCell::Tetrahedron([0, 1, 2, 3]), SolidCell::Tetrahedron([4, 5, 6, 7])];
    let faults = Solid::of_cells(&far, &cells).expect_err("two pieces");
    assert_eq!(faults, [SolidFault::Pieces { count: 2, atoms: vec![0, 4] }]);
}
