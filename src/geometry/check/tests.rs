use super::*;
use crate::Vec3;
use crate::geometry::{box_surface, icosphere, octasphere, red_cell, sheet, translate};

/// The faults of a surface as lines of text.
fn faults(surface: &Surface, rules: &SurfaceRules) -> Vec<String> {
    check_surface(surface, rules).unwrap_err().iter().map(MeshFault::to_string).collect()
}

/// A tetrahedron, atoms 0 to 3, the simplest closed surface.
fn tetrahedron() -> Surface {
    Surface {
        positions: vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()],
        facets: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    }
}

#[test]
fn the_shapes_we_make_pass() {
    for surface in [
        tetrahedron(),
        icosphere(5.0, 0),
        icosphere(1e-3, 4),
        octasphere(5.0, 4),
        red_cell(7.82, 3),
        box_surface([10.0, 1.0, 2.0], [10, 1, 2]),
    ] {
        assert_eq!(check_surface(&surface, &SurfaceRules::CELL), Ok(()));
    }
    assert_eq!(check_surface(&sheet(4.0, 2.0, 8, 4), &SurfaceRules::SHEET), Ok(()));
}

#[test]
fn a_surface_without_facets_is_a_fault() {
    assert_eq!(faults(&Surface::default(), &SurfaceRules::SHEET), ["the mesh has no facets"]);
}

#[test]
fn an_atom_out_of_range_is_named_with_its_facet() {
    let mut surface = tetrahedron();
    surface.facets[2] = [0, 9, 2];
    assert_eq!(
        faults(&surface, &SurfaceRules::CELL),
        ["facet 2 (atoms 0, 9, 2) names an atom that the mesh, with 4 atoms, does not have"]
    );
}

#[test]
fn a_facet_that_names_an_atom_twice_is_a_fault() {
    let mut surface = tetrahedron();
    surface.facets.push([1, 1, 2]);
    assert_eq!(
        faults(&surface, &SurfaceRules::CELL),
        [
            "facet 4 (atoms 1, 1, 2) names an atom twice",
            "facet 4 (atoms 1, 1, 2) is a sliver: its quality is 0.0e0, the least accepted 0.05"
        ]
    );
}

#[test]
fn a_position_that_is_not_a_number_is_a_fault() {
    let mut surface = tetrahedron();
    surface.positions[3].y = f64::NAN;
    assert_eq!(faults(&surface, &SurfaceRules::CELL), ["the position of atom 3 is not a number: (0, NaN, 1)"]);
}

#[test]
fn an_atom_without_facets_is_a_fault() {
    let mut surface = tetrahedron();
    surface.positions.push(Vec3::new(2.0, 2.0, 2.0));
    assert_eq!(faults(&surface, &SurfaceRules::CELL), ["atom 4 belongs to no facet"]);
}

#[test]
fn two_atoms_at_one_position_are_a_fault() {
    let mut surface = tetrahedron();
    surface.positions.push(Vec3::y());
    surface.facets[3] = [1, 4, 3];
    assert_eq!(faults(&surface, &SurfaceRules::SHEET), ["atoms 2 and 4 stand at the same place, (0, 1, 0) um"]);
}

#[test]
fn an_edge_of_three_facets_is_a_fault() {
    let mut surface = tetrahedron();
    surface.positions.push(Vec3::new(0.5, 0.5, -1.0));
    surface.facets.push([1, 2, 4]);
    assert_eq!(
        faults(&surface, &SurfaceRules::SHEET),
        ["the edge between atoms 1 and 2 is shared by 3 facets (3, 4, 0)"]
    );
}

#[test]
fn a_facet_that_faces_the_other_way_is_one_fault_that_names_its_neighbours() {
    let mut surface = tetrahedron();
    surface.facets[3].swap(1, 2);
    assert_eq!(
        faults(&surface, &SurfaceRules::CELL),
        ["the mesh has 3 pairs of facets that face to opposite sides: facets 0 and 3; facets 1 and 3; \
             facets 2 and 3"]
    );
}

#[test]
fn a_hole_is_a_fault_where_the_surface_must_be_closed() {
    let mut surface = tetrahedron();
    surface.facets.pop();
    assert_eq!(
        faults(&surface, &SurfaceRules::CELL),
        ["the mesh is open: it has 3 edges with one facet only: of facet 0, from atom 2 to atom 1; of facet 1, \
             from atom 1 to atom 3; of facet 2, from atom 3 to atom 2"]
    );
    assert_eq!(check_surface(&surface, &SurfaceRules::SHEET), Ok(()));
}

#[test]
fn two_bodies_that_touch_in_one_atom_are_pinched() {
    let mut surface = tetrahedron();
    surface.positions.extend([-Vec3::x(), -Vec3::y(), -Vec3::z()]);
    surface.facets.extend([[0, 4, 5], [0, 6, 4], [0, 5, 6], [4, 6, 5]]);
    assert_eq!(faults(&surface, &SurfaceRules::CELL), ["2 separate fans of facets meet at atom 0"]);
}

#[test]
fn two_separate_bodies_are_a_fault() {
    let mut surface = tetrahedron();
    let mut other = tetrahedron();
    translate(&mut other, Vec3::x() * 5.0);
    surface.positions.extend(other.positions);
    surface.facets.extend(other.facets.iter().map(|facet| facet.map(|atom| atom + 4)));
    assert_eq!(
        faults(&surface, &SurfaceRules::CELL),
        ["the mesh is made of 2 separate surfaces (facets 0, 4, one in each)"]
    );
}

#[test]
fn a_thin_facet_is_a_sliver() {
    let mut surface = tetrahedron();
    surface.positions[3] = Vec3::new(0.5, 0.01, 1e-4);
    let found = faults(&surface, &SurfaceRules::CELL);
    assert_eq!(found, ["facet 1 (atoms 0, 1, 3) is a sliver: its quality is 2.3e-2, the least accepted 0.05"]);
}

#[test]
fn an_inverted_surface_is_a_fault() {
    let mut surface = tetrahedron();
    surface.facets.iter_mut().for_each(|facet| facet.swap(0, 1));
    assert_eq!(
        faults(&surface, &SurfaceRules::CELL),
        ["the mesh is inverted: its facets are oriented inwards (volume -0.1667 um^3)"]
    );
}

#[test]
fn a_surface_folded_flat_encloses_no_volume() {
    let mut surface = icosphere(2.0, 1);
    surface.positions.iter_mut().for_each(|position| position.z *= 1e-7);
    let found = faults(&surface, &SurfaceRules { boundary: Boundary::Closed, least_quality: 0.0 });
    assert_eq!(found, ["the mesh encloses no volume (2.9e-6 um^3 inside an area of 23.5114 um^2)"]);
}

#[test]
fn many_faults_of_a_kind_are_one_with_their_number_and_the_first_positions() {
    let mut surface = icosphere(1.0, 1);
    surface.positions.extend((0..25).map(|k| Vec3::x() * (2.0 + f64::from(k))));
    let found = faults(&surface, &SurfaceRules::CELL);
    assert_eq!(found, ["the mesh has 25 atoms without facets: atom 42; atom 43; atom 44; …"]);
    surface.facets.pop();
    let found = faults(&surface, &SurfaceRules::CELL);
    assert_eq!(found.len(), 2, "one for the hole, one for the atoms: {found:?}");
}

#[test]
fn a_fault_becomes_bad_input_that_names_the_mesh_and_says_what_to_do() {
    let fault = MeshFault::Inverted { volume: -1.0 }.into_fault("mesh `cell.obj`");
    assert_eq!(
        fault.message,
        "mesh `cell.obj`: the mesh is inverted: its facets are oriented inwards (volume -1.0000 um^3)"
    );
    assert_eq!(fault.help.as_deref(), Some("flip the orientation of all facets (\"flip normals\" in a mesh editor)"));
}
