use super::*;
use crate::geometry::{SurfaceRules, check_surface, export_surface, red_cell, volume, write_ply, write_stl};

/// A tetrahedron of volume 1/6 as PLY text.
const TETRAHEDRON: &str = "ply\nformat ascii 1.0\ncomment a corner of a cube\nelement vertex 4\n\
     property float x\nproperty float y\n\
     property float z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_index\nend_header\n\
     0 0 0 255\n1 0 0 255\n0 1 0 255\n0 0 1 255\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// The messages of what must be bad input.
fn messages<T: std::fmt::Debug>(outcome: std::result::Result<T, Vec<Fault>>) -> Vec<String> {
    outcome.unwrap_err().into_iter().map(|fault| fault.message).collect()
}

/// The tetrahedron as binary PLY of either byte order, with types of every width.
fn binary_tetrahedron(big_endian: bool) -> Vec<u8> {
    let order = if big_endian { "big" } else { "little" };
    let mut bytes = format!(
        "ply\r\nformat binary_{order}_endian 1.0\r\nelement vertex 4\r\nproperty short flag\r\nproperty double x\r\n\
         property float y\r\nproperty int8 z\r\nelement edge 1\r\nproperty list ushort uint16 weights\r\n\
         element face 4\r\nproperty list uint8 uint32 vertex_indices\r\nproperty ushort mark\r\nend_header\r\n"
    )
    .into_bytes();
    fn put<const N: usize>(bytes: &mut Vec<u8>, mut value: [u8; N], big_endian: bool) {
        if big_endian {
            value.reverse();
        }
        bytes.extend(value);
    }
    for [x, y, z] in [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] {
        put(&mut bytes, (-7_i16).to_le_bytes(), big_endian);
        put(&mut bytes, f64::from(x).to_le_bytes(), big_endian);
        put(&mut bytes, (y as f32).to_le_bytes(), big_endian);
        put(&mut bytes, (z as i8).to_le_bytes(), big_endian);
    }
    for value in [2_u16, 300, 400] {
        put(&mut bytes, value.to_le_bytes(), big_endian);
    }
    for facet in [[0_u32, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        bytes.push(3);
        facet.iter().for_each(|atom| put(&mut bytes, atom.to_le_bytes(), big_endian));
        put(&mut bytes, 9_u16.to_le_bytes(), big_endian);
    }
    bytes
}

#[test]
fn every_format_brings_a_red_cell_back() {
    let cell = red_cell(7.82, 1);
    let folder = tempfile::tempdir().unwrap();
    for (name, tolerance) in [("cell.obj", 0.0), ("cell.ply", 0.0), ("cell.STL", 1e-6)] {
        let path = folder.path().join(name);
        export_surface(&cell, &[("cell", vec![7.0; 42])], &path).unwrap();
        let back = read_surface(&path, 1.0).unwrap();
        assert_eq!(check_surface(&back, &SurfaceRules::CELL), Ok(()));
        assert_eq!((back.positions.len(), back.facets.len()), (42, 80));
        // STL numbers its atoms anew and keeps 24 bits: corners are compared facet by facet.
        for (old, new) in cell.facets.iter().zip(&back.facets) {
            for (was, is) in cell.corners(*old).iter().zip(back.corners(*new)) {
                assert!((was - is).norm() <= tolerance, "{name}");
            }
        }
        if tolerance == 0.0 {
            assert_eq!(back, cell);
        }
    }
}

#[test]
fn the_scale_turns_the_units_of_the_file_into_micrometres() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.ply");
    std::fs::write(&path, TETRAHEDRON).unwrap();
    let surface = read_surface(&path, 1000.0).unwrap();
    assert!((volume(&surface) - 1e9 / 6.0).abs() < 1e-6);
    assert!(matches!(read_surface(&path, 0.0), Err(Error::Input(_))));
    assert!(matches!(read_surface(&path, f64::NAN), Err(Error::Input(_))));
}

#[test]
fn obj_takes_polygons_negative_numbers_textures_and_comments() {
    let text = "# a pyramid\no pyramid\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 # corner\nv 0 1 0\nvn 0 0 1\nvt 0 0\nv 0.5 0.5 1\r\n\
                usemtl skin\ns off\nf 4/1/1 3/1/1 2//1 1\nf -5 -4 -1\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    let surface = obj::parse("p.obj", text.as_bytes()).unwrap();
    assert_eq!(surface.facets.len(), 6);
    assert_eq!(surface.facets[2], [0, 1, 4]);
    assert!((volume(&surface) - 1.0 / 3.0).abs() < 1e-15);
    // Facets may come before their vertices.
    let early = obj::parse("e.obj", b"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap();
    assert_eq!(early.facets, [[0, 1, 2]]);
}

#[test]
fn obj_faults_are_reported_together_with_their_locations() {
    let text = "v 0 0 zero\nv 1 2\nv 0 0 inf\nf 1 2\nf 0 1 2\nf 1 2 -9\n";
    let faults = obj::parse("bad.obj", text.as_bytes()).unwrap_err();
    let found: Vec<_> = faults
        .iter()
        .map(|fault| {
            let position = fault.location.as_ref().unwrap();
            let line = position.source.text[..position.start].matches('\n').count() + 1;
            format!(
                "{line}: {} [{}]",
                fault.message,
                &position.source.text[position.start..position.start + position.length]
            )
        })
        .collect();
    assert_eq!(
        found,
        [
            "1: `zero` is not a coordinate [zero]",
            "2: `v` has 2 coordinates [v]",
            "3: `inf` is not a coordinate [inf]",
            "4: a facet has 2 corners [f]",
            "5: `0` names no vertex [0]",
            "6: `-9` names no vertex [-9]",
        ]
    );
    let beyond = obj::parse("b.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    assert_eq!(messages(beyond), ["facet names vertex 4, but the file has 3 vertices"]);
    assert_eq!(obj::parse("b.obj", "f 1 2\n".repeat(99).as_bytes()).unwrap_err().len(), 10);
}

#[test]
fn ply_is_read_in_all_three_encodings() {
    let ascii = ply::parse("t.ply", TETRAHEDRON.as_bytes()).unwrap();
    assert!((volume(&ascii) - 1.0 / 6.0).abs() < 1e-15);
    for big_endian in [false, true] {
        assert_eq!(ply::parse("t.ply", &binary_tetrahedron(big_endian)).unwrap(), ascii);
    }
}

#[test]
fn ply_faults_say_what_is_wrong() {
    let with = |old: &str, new: &str| messages(ply::parse("t.ply", TETRAHEDRON.replace(old, new).as_bytes()));
    assert_eq!(with("end_header", "the end"), ["mesh file `t.ply` has no PLY header"]);
    assert_eq!(with("format ascii", "format roman"), ["`roman` does not belong here in a PLY header"]);
    assert_eq!(with("format ascii 1.0\n", ""), ["the PLY header has no `format` line"]);
    assert_eq!(
        with("property float z\n", ""),
        ["mesh file `t.ply`: its PLY header has no property `z` of its vertices"]
    );
    assert_eq!(with("element face 4", "element fan 4"), ["mesh file `t.ply`: its PLY header has no element `face`"]);
    assert_eq!(with("uchar int vertex", "uchar long vertex"), ["`property` does not belong here in a PLY header"]);
    assert_eq!(with("vertex 4", "vertex -4"), ["`-4` does not belong here in a PLY header"]);
    assert_eq!(with("0 1 0 255", "0 one 0 255"), ["`one` is not a number"]);
    assert_eq!(with("0 1 0 255", "0 nan 0 255"), ["the position of vertex 2 is not a number: (0, NaN, 0)"]);
    assert_eq!(with("3 1 2 3", "3 1 2 4"), ["face 3 names vertex 4, but the file has 4 vertices"]);
    assert_eq!(with("3 1 2 3", "3 1 2 -1"), ["face 3 names vertex -1, but the file has 4 vertices"]);
    assert_eq!(with("3 1 2 3", "2 1 2"), ["face 3 has 2 corners, expected at least 3"]);
    assert_eq!(with("3 1 2 3", "3 1 2"), ["mesh file `t.ply` ends in face 3 of the 4 that its header promises"]);
}

#[test]
fn headers_that_promise_the_moon_fail_without_taking_memory() {
    let moon = |element: &str| TETRAHEDRON.replace(&format!("{element} 4"), &format!("{element} 18446744073709551615"));
    assert_eq!(
        messages(ply::parse("m.ply", moon("element face").as_bytes())),
        ["mesh file `m.ply` ends in face 4 of the 18446744073709551615 that its header promises"]
    );
    assert!(ply::parse("m.ply", moon("element vertex").as_bytes()).is_err());
    let list = TETRAHEDRON.replace("3 0 2 1", "1e300 0 2 1");
    assert!(messages(ply::parse("m.ply", list.as_bytes()))[0].contains("ends in face 0"));
    let nothing = TETRAHEDRON.replace("end_header", "element void 18446744073709551615\nend_header");
    assert!(ply::parse("m.ply", nothing.as_bytes()).is_ok());

    let mut stl = vec![b' '; 80];
    stl.extend(u32::MAX.to_le_bytes());
    assert_eq!(
        messages(stl::parse("m.stl", &stl)),
        ["mesh file `m.stl` ends after 0 whole facets of the 4294967295 that its header promises"]
    );
}

#[test]
fn files_cut_anywhere_are_bad_input_and_never_panic() {
    let (mut binary_ply, mut binary_stl) = (Vec::new(), Vec::new());
    let cell = red_cell(7.82, 0);
    write_ply(&cell, &[], &mut binary_ply).unwrap();
    write_stl(&cell, &mut binary_stl).unwrap();
    for length in 0..binary_ply.len() {
        assert!(ply::parse("c.ply", &binary_ply[..length]).is_err(), "{length}");
    }
    for length in 0..binary_stl.len() {
        assert!(stl::parse("c.stl", &binary_stl[..length]).is_err(), "{length}");
    }
    for length in 0..TETRAHEDRON.len() {
        let _ = ply::parse("c.ply", &TETRAHEDRON.as_bytes()[..length]);
        let _ = obj::parse("c.obj", &TETRAHEDRON.as_bytes()[..length]);
        let _ = stl::parse("c.stl", &TETRAHEDRON.as_bytes()[..length]);
    }
}

#[test]
fn ascii_stl_is_read_and_its_corners_merged() {
    let corner = |k: usize| ["0 0 0", "1 0 0", "0 1 0", "0 0 1.0e0"][k];
    let facet = |[a, b, c]: [usize; 3]| {
        format!(
            " facet normal 0 0 0\n  outer loop\n   vertex {}\n   vertex {}\n   vertex {}\n  endloop\n endfacet\n",
            corner(a),
            corner(b),
            corner(c)
        )
    };
    let facets: String = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(facet).concat();
    let text = format!("solid tetra\n{facets}endsolid tetra\n");
    let surface = stl::parse("t.stl", text.as_bytes()).unwrap();
    assert_eq!(surface.positions.len(), 4);
    assert_eq!(check_surface(&surface, &SurfaceRules::CELL), Ok(()));

    let with = |old: &str, new: &str| messages(stl::parse("t.stl", text.replacen(old, new, 1).as_bytes()));
    assert_eq!(with("endsolid tetra", ""), ["the file ends after 4 whole facets, without `endsolid`"]);
    assert_eq!(with("vertex 0 0 0", "vertex 0 0"), ["`vertex` has 2 coordinates"]);
    assert_eq!(with("vertex 0 0 0", "vertex 0 0 nan"), ["`nan` is not a coordinate"]);
    assert_eq!(with("   vertex 0 0 0\n", ""), ["a facet has 2 corners"]);
    assert_eq!(with("endloop", "loop"), ["`loop` does not belong here"]);
    assert_eq!(with(" facet", "facets"), ["`facets` does not belong here"]);
}

#[test]
fn binary_stl_with_a_corner_that_is_not_a_number_names_the_facet() {
    let mut bytes = Vec::new();
    write_stl(&red_cell(7.82, 0), &mut bytes).unwrap();
    let at = 84 + 50 * 7 + 12;
    bytes[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(messages(stl::parse("c.stl", &bytes))[0].starts_with("mesh file `c.stl`: a corner of facet 7 is not"));
}
