//! Links that carry a number for each atom: what membranes read where their atoms are, and what they do to these atoms.

use crate::coupled_scene::{Scene, scene};
use pseudopod::Vec3;
use pseudopod::experiment::Compiled;
use pseudopod::sim::add_cells;
use pseudopod::sim::forces::add_forces;
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::remove_cells;

/// One cell, a sphere of radius 5 µm around (10, 0, 0) that has the membrane `own`; steps of 0.1 s.
fn ball(mechanics: &str, more: &str) -> String {
    format!(
        "seed = 4\n[run]\nuntil = \"1 s\"\nintegrator = {{ step = \"0.1 s\" }}\n[output]\nevery = \"1 s\"\n[cells.cell]\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 2 }}\nplacement = {{ at = [[\"10 um\", \"0 um\", \"0 um\"]] }}\n\
         chemistry = [\"own\"]\nmechanics = {{ drag = \"20 pN s/um\", {mechanics} }}\n{more}"
    )
}

const ROUND: &str = "shape_memory = { shape_modulus = \"10 pN/um\" }";

fn atoms(scene: &Scene, cell: usize) -> Vec<Vec3> {
    scene.state().kinds[0].cell(&scene.compiled.model.kinds[0], cell)
}

/// What links have set of the atoms of the first kind.
fn pressures(scene: &Scene) -> &[f64] {
    &scene.state().chemistry.controls.of_atoms[0].protrusion
}

#[test]
fn an_atom_reads_the_field_and_the_shape_where_it_is() {
    // c rises by 0.5 a micrometre along x; each reading is carried to a pressure in the same instant, through an input and a definition.
    let field = r#"<eml name="field"><grid dimension="3" spacing="1" origin="0 -10 -10" size="20 20 20"/>
        <field id="c" diffusion="0" initial="3 + 0.5*x"/></eml>"#;
    let read = |from: &str, transfer: &str| {
        let own = format!(
            "<eml name=\"own\" level=\"membrane\"><parameter id=\"k\" value=\"2\"/><input id=\"s\" default=\"0\" level=\"membrane\"/>\
             <variable id=\"a\" initial=\"1\" rate=\"0\"/><define id=\"twice\">k*s*a</define>\
             <link from=\"system.twice\" to=\"cell.atoms.protrusion\" transfer=\"{transfer}\" gain=\"3\"/>\
             <link from=\"cell.atoms.{from}\" to=\"system.s\" transfer=\"value/k\"/></eml>"
        );
        let mut scene = scene(&[("field", field), ("own", &own)], &ball(ROUND, ""));
        scene.begin();
        let found = pressures(&scene).to_vec();
        (scene, found)
    };
    let (scene, found) = read("field[c]", "value");
    for (x, found) in atoms(&scene, 0).iter().zip(&found) {
        // The grid interpolates a linear field exactly, away from the walls.
        assert!((found - 3.0 * (3.0 + 0.5 * x.x)).abs() < 1e-9, "{found} at {x}");
    }
    let (scene, found) = read("field[c].gradient.x", "value^2");
    assert!(
        found.iter().all(|found| (found - 3.0 * 0.25).abs() < 1e-6),
        "{found:?} at {} atoms",
        atoms(&scene, 0).len()
    );
    let (scene, found) = read("normal.z", "1 + value");
    for (x, found) in atoms(&scene, 0).iter().zip(&found) {
        // The area vectors of an icosphere of this level point up to 1.354° away from the radii: 0.0237, three times that.
        assert!((found - 3.0 * (1.0 + x.z / 5.0)).abs() < 0.0711, "{found} at {x}");
    }
    let (_, found) = read("curvature", "value");
    assert!(found.iter().all(|found| (found - 3.0 / 5.0).abs() < 0.02), "{found:?}");
    let (_, found) = read("area_strain", "1 + value");
    assert!(found.iter().all(|found| (found - 3.0).abs() < 1e-9), "{found:?}");
}

#[test]
fn an_atom_knows_what_it_touches() {
    let own = r#"<eml name="own" level="membrane"><input id="near" default="0" level="membrane"/><input id="low" default="0" level="membrane"/>
        <variable id="a" initial="0" rate="0"/><define id="both">near + 10*low</define>
        <link from="cell.atoms.in_contact" to="system.near"/><link from="cell.atoms.on_plane" to="system.low"/>
        <link from="system.both" to="cell.atoms.protrusion" gain="0.001"/></eml>"#;
    let planes = "placement = { at = [[\"0 um\", \"0 um\", \"5 um\"], [\"10.02 um\", \"0 um\", \"5 um\"]] }\n[[planes]]\nname = \"floor\"\npoint = [\"0 um\", \"0 um\", \"0 um\"]\n\
        normal = [0, 0, 1]\n[contact]\nstrength = \"1 Pa\"\nmodel = \"adhesives\"\n";
    let text = ball(ROUND, planes).replace("placement = { at = [[\"10 um\", \"0 um\", \"0 um\"]] }\n", "");
    let mut scene = scene(&[("own", own)], &text);
    scene.run();
    let near = |x: &Vec3, other: &[Vec3]| other.iter().map(|y| (x - y).norm()).fold(f64::INFINITY, f64::min);
    let (mut seen_near, mut seen_low) = (0, 0);
    for cell in 0..2 {
        let (own, other) = (atoms(&scene, cell), atoms(&scene, 1 - cell));
        for (x, told) in own.iter().zip(&pressures(&scene)[cell * own.len()..]) {
            let (is_low, is_near) = (*told > 0.009, (told * 1000.0).round() as i64 % 10 == 1);
            assert_eq!(is_low, x.z.abs() < 1e-5, "{x} is told {told}");
            // What is far from all atoms of the other touches nothing of it.
            assert!(!is_near || near(x, &other) < 2.0, "{x} is told {told}");
            seen_near += usize::from(is_near);
            seen_low += usize::from(is_low);
        }
    }
    assert!(seen_near >= 2 && seen_low >= 2, "{seen_near} touch the other cell, {seen_low} the floor");
}

#[test]
fn an_atom_tells_apart_whom_and_on_what_it_touches() {
    let own = r#"<eml name="own" level="membrane"><input id="like" default="0" level="membrane"/><input id="unlike" default="0" level="membrane"/>
        <input id="low" default="0" level="membrane"/><input id="high" default="0" level="membrane"/>
        <variable id="a" initial="0" rate="0"/><define id="all">like + 2*unlike + 4*low + 8*high</define>
        <link from="cell.atoms.in_contact[cell]" to="system.like"/><link from="cell.atoms.in_contact[other]" to="system.unlike"/>
        <link from="cell.atoms.on_plane[ground]" to="system.low"/><link from="cell.atoms.on_plane[lid]" to="system.high"/>
        <link from="system.all" to="cell.atoms.protrusion" gain="0.001"/></eml>"#;
    // Two cells of the type in a row along x, the other type to the left of the first; ground and lid are a little nearer than they are high.
    let more = "placement = { at = [[\"0 um\", \"0 um\", \"5 um\"], [\"10.02 um\", \"0 um\", \"5 um\"]] }\n\
        [cells.other]\nmesh = { shape = \"icosphere\", radius = \"5 um\", level = 2 }\nplacement = { at = [[\"-10.02 um\", \"0 um\", \"5 um\"]] }\n\
        mechanics = { drag = \"20 pN s/um\", shape_memory = { shape_modulus = \"10 pN/um\" } }\n\
        [[planes]]\nname = \"ground\"\npoint = [\"0 um\", \"0 um\", \"0.05 um\"]\nnormal = [0, 0, 1]\n\
        [[planes]]\nname = \"lid\"\npoint = [\"0 um\", \"0 um\", \"9.95 um\"]\nnormal = [0, 0, -1]\n\
        [contact]\nstrength = \"1 Pa\"\nmodel = \"adhesives\"\n";
    let text = ball(ROUND, more).replace("placement = { at = [[\"10 um\", \"0 um\", \"0 um\"]] }\n", "");
    let mut scene = scene(&[("own", own)], &text);
    scene.run();
    let mut seen = [0; 4];
    for (x, told) in atoms(&scene, 0).iter().zip(pressures(&scene)) {
        let told = (told * 1000.0).round() as usize;
        // Who touches on the right is of the own type, on the left of the other.
        for (bit, may_be) in [x.x > 3.0, x.x < -3.0, x.z < 1.0, x.z > 9.0].into_iter().enumerate() {
            let is_told = told & (1 << bit) != 0;
            assert!(!is_told || may_be, "{x} is told {told}");
            seen[bit] += usize::from(is_told);
        }
    }
    assert!(seen.iter().all(|count| *count >= 1), "{seen:?}");
}

#[test]
fn a_tension_that_chemistry_sets_everywhere_is_that_of_the_type() {
    let own = r#"<eml name="own" level="membrane"><variable id="t" initial="6" rate="0"/><define id="even">6 + 0*t</define>
        <link from="system.even" to="cell.atoms.tension"/></eml>"#;
    // First order with small steps: the two differ by how far they are implicit alone.
    let run = |own: &str, tension: &str, step: &str| {
        let soft = format!(
            "membrane = {{ law = \"skalak\", shear = \"2 pN/um\", area = \"4 pN/um\", bending = \"1 pN um\"{tension} }}"
        );
        let loads = "loads = [{ name = \"up\", cap = { direction = [0, 0, 1], number = 12 }, direction = [0, 0, 1], force = \"30 pN\" }, { name = \"down\", cap = { direction = [0, 0, -1], number = 12 }, direction = [0, 0, -1], force = \"30 pN\" }]\n";
        let text = ball(&soft, loads).replace("step = \"0.1 s\"", &format!("step = \"{step}\""));
        let mut scene = scene(&[("own", own)], &text);
        scene.run();
        atoms(&scene, 0)
    };
    let none = r#"<eml name="own" level="membrane"><variable id="t" initial="6" rate="0"/></eml>"#;
    let apart = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let without = run(none, "", "0.02 s");
    let errors = ["0.04 s", "0.02 s"].map(|step| {
        let of_type = run(none, ", tension = \"6 pN/um\"", step);
        let set = run(own, "", step);
        assert!(apart(&of_type, &without) > 0.1, "tension tells: {}", apart(&of_type, &without));
        apart(&of_type, &set)
    });
    assert!(errors[1] < 0.01 && errors[1] < 0.7 * errors[0], "{errors:?}");
}

/// Puts the atoms of the only cell where it is said.
fn place(scene: &mut Scene, positions: &[Vec3]) {
    let lanes = scene.compiled.model.kinds[0].lanes;
    let x = &mut scene.compiled.state.kinds[0].positions;
    for (atom, position) in positions.iter().enumerate() {
        (0..3).for_each(|axis| x[(3 * atom + axis) * lanes] = position[axis]);
    }
}

/// The forces on its atoms, pN.
fn forces(scene: &mut Scene) -> Vec<Vec3> {
    let Compiled { model, state, .. } = &scene.compiled;
    add_forces(model, state.time, state, &mut scene.ws);
    let (lanes, f) = (model.kinds[0].lanes, &scene.ws.kinds[0].force);
    (0..model.kinds[0].atoms()).map(|atom| Vec3::from_fn(|axis, _| f[(3 * atom + axis) * lanes])).collect()
}

/// A membrane cell that is stretched, with factors of the elasticity of its atoms as they follow from the height n of the normal; and the
/// forces on its atoms.
fn stretched(factor: &str) -> (Scene, Vec<Vec3>) {
    let own = format!(
        "<eml name=\"own\" level=\"membrane\"><input id=\"n\" default=\"0\" level=\"membrane\"/><variable id=\"a\" initial=\"0\" rate=\"0\"/>\
         <link from=\"cell.atoms.normal.z\" to=\"system.n\"/><define id=\"s\">{factor} + 0*a</define>\
         <link from=\"system.s\" to=\"cell.atoms.elasticity\"/></eml>"
    );
    let membrane = "membrane = { law = \"skalak\", shear = \"5 pN/um\", area = \"20 pN/um\" }";
    let mut scene = scene(&[("own", &own)], &ball(membrane, ""));
    scene.begin();
    let bent = |x: &Vec3| Vec3::new(10.0 + 1.1 * (x.x - 10.0), x.y, 0.95 * x.z);
    let positions: Vec<Vec3> = atoms(&scene, 0).iter().map(bent).collect();
    place(&mut scene, &positions);
    let found = forces(&mut scene);
    (scene, found)
}

#[test]
fn a_factor_at_every_atom_is_that_of_the_cell_and_one_that_differs_is_a_gradient() {
    let (_, once) = stretched("1");
    let (_, twice) = stretched("2");
    let size = once.iter().fold(0.0_f64, |size, f| size.max(f.norm()));
    assert!(size > 0.1, "{size} pN");
    assert!(once.iter().zip(&twice).all(|(one, two)| (two - 2.0 * one).norm() < 1e-12 * size));
    let (mut scene, found) = stretched("1.5 + n");
    let here = atoms(&scene, 0);
    let (sum, torque) = here.iter().zip(&found).fold((Vec3::zeros(), Vec3::zeros()), |(sum, torque), (x, f)| {
        (sum + f, torque + (x - Vec3::new(10.0, 0.0, 0.0)).cross(f))
    });
    assert!(sum.norm() < 1e-11 * size && torque.norm() < 1e-10 * size, "{sum} {torque}");
    assert!(found.iter().zip(&once).any(|(local, one)| (local - one).norm() > 0.1 * size), "it is another force");
    // Central differences of the energy; their own error is some 1e-7 of a force.
    for (atom, axis) in [(0, 0), (7, 1), (40, 2), (161, 0)] {
        let mut energy = |by: f64| {
            let mut moved = here.clone();
            moved[atom][axis] += by;
            place(&mut scene, &moved);
            measure_cells(&scene.compiled.model, scene.state())[0].energy
        };
        let slope = (energy(1e-5) - energy(-1e-5)) / 2e-5;
        let force = found[atom][axis];
        assert!((force + slope).abs() < 1e-6 * size, "{atom}, {axis}: {force} and {slope}");
    }
}

#[test]
fn what_atoms_secrete_is_their_area_times_their_rate() {
    let field = r#"<eml name="field"><grid dimension="3" spacing="1" origin="0 -10 -10" size="20 20 20"/><field id="c" diffusion="1" initial="0"/></eml>"#;
    let own = r#"<eml name="own" level="membrane"><variable id="a" initial="1 + 0.2*x" rate="0"/>
        <link from="system.a" to="cell.atoms.secretion[c]" gain="2"/></eml>"#;
    let mut scene = scene(&[("field", field), ("own", own)], &ball(ROUND, ""));
    scene.run();
    let surface = &scene.state().chemistry.membranes[0].kinds[0];
    let expected = 2.0 * surface.amount(0, 0) * scene.state().time;
    // Boxes of 1 um³.
    let found: f64 = scene.state().chemistry.fields[0].values.iter().sum();
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} instead of {expected}");
}

#[test]
fn what_is_set_of_atoms_comes_and_goes_with_their_cell() {
    let own = r#"<eml name="own" level="membrane"><input id="s" default="7" level="membrane"/><variable id="a" initial="1 + 0.1*x" rate="0"/>
        <define id="p">a + 0*s</define><link from="system.p" to="cell.atoms.protrusion" gain="1e-6"/><link from="system.a" to="cell.atoms.tension" gain="1e-6"/></eml>"#;
    let some = "placement = { at = [[\"-30 um\", \"0 um\", \"0 um\"], [\"0 um\", \"0 um\", \"0 um\"], [\"30 um\", \"0 um\", \"0 um\"]] }\n";
    let text = ball(ROUND, some).replace("placement = { at = [[\"10 um\", \"0 um\", \"0 um\"]] }\n", "");
    let mut scene = scene(&[("own", own)], &text);
    scene.step().unwrap();
    let each = 162;
    let set = pressures(&scene).to_vec();
    assert_eq!(set.len(), 3 * each);
    let Scene { compiled, ws } = &mut scene;
    remove_cells(&compiled.model, &mut compiled.state, ws, &[1]).unwrap();
    let controls = &compiled.state.chemistry.controls.of_atoms[0];
    assert_eq!(controls.protrusion, [&set[..each], &set[2 * each..]].concat());
    let at = |x: f64| pseudopod::sim::NewCell {
        positions: compiled.model.kinds[0].rest.positions.iter().map(|p| p + Vec3::new(x, 0.0, 0.0)).collect(),
        parent: None,
    };
    let new = at(60.0);
    add_cells(&compiled.model, &mut compiled.state, ws, 0, &[new]).unwrap();
    let controls = &compiled.state.chemistry.controls.of_atoms[0];
    assert_eq!(controls.protrusion.len(), 3 * each);
    assert!(controls.protrusion[2 * each..].iter().chain(&controls.tension[2 * each..]).all(|value| *value == 0.0));
    scene.step().unwrap();
    let (first, last) = (&pressures(&scene)[..each], &pressures(&scene)[2 * each..]);
    // But for what a millionth of a pressure has done to the shape of the first.
    assert!(
        first.iter().zip(last).all(|(a, b)| (a - b).abs() < 1e-3 * a),
        "the new cell does as those that were there"
    );
}

#[test]
fn a_pressure_that_cannot_be_is_named_with_cell_and_time() {
    let own = r#"<eml name="own" level="membrane"><variable id="a" initial="0.15" rate="-1"/><link from="system.a" to="cell.atoms.protrusion"/></eml>"#;
    let mut scene = scene(&[("own", own)], &ball(ROUND, ""));
    let trouble = scene.until_trouble().to_string();
    assert!(trouble.contains("cell.atoms.protrusion") && trouble.contains("not below 0"), "{trouble}");
}
