//! The shape modulus: a stiffness of shape memory that does not depend on the mesh.

use pseudopod::experiment::{Document, compile};
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{Workspace, step};
use std::path::Path;

/// How much a sphere of radius 5 µm and shape modulus 5 pN/µm lengthens under 2 pN spread over caps of 40° at its
/// poles, µm.
fn lengthening(level: u32) -> f64 {
    let cap = |sign: i32| {
        format!(
            "{{ name = \"pull{sign}\", cap = {{ direction = [0, 0, {sign}], angle = \"40 deg\" }}, spread = \"area\", \
             direction = [0, 0, {sign}], force = \"2 pN\" }}"
        )
    };
    let text = format!(
        "title = \"modulus\"\n[run]\nuntil = \"400 s\"\n[cells.sphere]\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = {level} }}\n\
         mechanics = {{ drag = \"20 pN s/um\", shape_memory = {{ shape_modulus = \"5 pN/um\" }} }}\n\
         loads = [{}, {}]\n",
        cap(1),
        cap(-1)
    );
    let document = Document::parse("modulus.toml", &text, Path::new("."), &[]).unwrap();
    let mut compiled = compile(&document).unwrap();
    let mut ws = Workspace::new(&compiled.model);
    while compiled.state.time < compiled.model.until {
        step(&compiled.model, &mut compiled.state, &mut ws).unwrap();
    }
    measure_cells(&compiled.model, &compiled.state)[0].size.z - 10.0
}

#[test]
fn a_shape_modulus_gives_meshes_of_42_to_2562_atoms_the_same_stiffness() {
    let found: Vec<f64> = (1..=4).map(lengthening).collect();
    println!("lengthening at 42, 162, 642, 2562 atoms: {found:?} um");
    // Meshes may differ by a tenth from the finest one: the coarsest has only six facets under the load.
    let finest = found[3];
    assert!(found.iter().all(|length| (length / finest - 1.0).abs() < 0.10), "{found:?}");
}
