//! Cells that wander in an aggregate keep their facets on the outside, soft or stiff, as long as they bear what they push with.

use pseudopod::{Simulation, Vec3};
use std::collections::BTreeMap;

/// Twenty-five cells of 42 atoms that push with 6.7 pN in one aggregate, for a minute: the smallest cosine between the normals of two facets
/// beside each other at any second, and the greatest depth over the mean edge.
fn stirred(material: &str, strength: f64) -> (f64, f64) {
    let text = format!(
        "title = \"Stirred\"\nseed = 5\n[run]\nuntil = \"60 s\"\nintegrator = {{ max_step = \"1 s\" }}\n[cells.cell]\nnumber = 25\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\n\
         placement = {{ random_from = [\"-25 um\", \"-25 um\", \"-25 um\"], random_to = [\"25 um\", \"25 um\", \"25 um\"] }}\n\
         [cells.cell.mechanics]\ndrag = \"20 pN s/um\"\n{material}\n[cells.cell.motility]\n\
         brownian = {{ speed = \"20 um/min\", persistence = \"20 s\", space = \"volume\" }}\n\
         attraction = {{ to = [\"0 um\", \"0 um\", \"0 um\"], stiffness = \"0.02 pN/um\" }}\n[contact]\nstrength = \"{strength} pN/um^2\"\n[output]\nevery = \"1 s\"\n"
    );
    let mut simulation = Simulation::from_text("stirred.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    let kind = simulation.types().next().expect("one type");
    let (atoms, facets) = (kind.atom_count(), kind.facets().to_vec());
    let neighbours = beside_each_other(&facets);
    let mut positions = vec![[0.0; 3]; simulation.atom_count()];
    let (mut smallest, mut deepest) = (1.0_f64, 0.0_f64);
    for second in 1..=60 {
        simulation.run_until(f64::from(second)).unwrap_or_else(|error| panic!("{material}, {strength}: {error}"));
        simulation.positions_into(&mut positions).unwrap_or_else(|error| panic!("{error}"));
        for cell in positions.chunks(atoms) {
            let corner = |atom: u32| Vec3::from(cell[atom as usize]);
            let normal = |[a, b, c]: [u32; 3]| (corner(b) - corner(a)).cross(&(corner(c) - corner(a))).normalize();
            let normals: Vec<Vec3> = facets.iter().map(|facet| normal(*facet)).collect();
            let cosines = neighbours.iter().map(|[one, other]| normals[*one].dot(&normals[*other]));
            smallest = cosines.fold(smallest, f64::min);
        }
        deepest = deepest.max(simulation.series("contact.deepest").unwrap_or_else(|error| panic!("{error}"))[0]);
    }
    (smallest, deepest)
}

/// Pairs of facets that share an edge.
fn beside_each_other(facets: &[[u32; 3]]) -> Vec<[usize; 2]> {
    let mut of_edge: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (number, [a, b, c]) in facets.iter().enumerate() {
        for (one, other) in [(a, b), (b, c), (c, a)] {
            of_edge.entry([*one.min(other), *one.max(other)]).or_default().push(number);
        }
    }
    of_edge.into_values().filter_map(|pair| pair.try_into().ok()).collect()
}

fn membrane(shear: f64) -> String {
    let area = shear.max(200.0);
    format!(
        "membrane = {{ law = \"skalak\", shear = \"{shear} pN/um\", area = \"{area} pN/um\", bending = \"10 pN um\" }}"
    )
}

fn memory(stiffness: f64) -> String {
    format!("shape_memory = {{ stiffness = \"{stiffness} pN/um\" }}")
}

fn keep_their_facets(materials: &[String], strengths: &[f64]) {
    for material in materials {
        for &strength in strengths {
            let (cosine, depth) = stirred(material, strength);
            println!("{material}, {strength} pN/um^2: cosine {cosine:.2}, depth {depth:.4}");
            assert!(cosine > -0.2 && depth < 0.02, "{material}, {strength} pN/um^2: cosine {cosine}, depth {depth}");
        }
    }
}

#[test]
fn cells_soft_in_shear_keep_their_facets() {
    keep_their_facets(&[membrane(0.01)], &[0.2]);
}

#[test]
#[ignore = "slow: 3 minutes"]
fn cells_of_all_stiffnesses_that_bear_their_push_keep_their_facets() {
    let skins = [0.01, 0.1, 1.0, 10.0, 100.0, 1000.0, 10_000.0].map(membrane);
    let shapes = [10.0, 100.0, 1000.0, 10_000.0].map(memory);
    keep_their_facets(&[&skins[..], &shapes[..]].concat(), &[0.05, 0.2, 1.0]);
}
