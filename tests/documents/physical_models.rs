//! Physical models in place of meshes and of loads: what of a document in PML and LML becomes a cell and what is done to it.

use pseudopod::error::{Error, Fault};
use pseudopod::experiment::{Compiled, Document, compile, loads_as_lml, notices, prepare};
use pseudopod::geometry::{icosphere, volume};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::load::Load;
use pseudopod::physical_model::lml::Loads;
use pseudopod::physical_model::pml::{PhysicalModel, model_of_surfaces};
use std::path::Path;

/// Two spheres of 12 atoms in a file, `a 0` (atoms 0 to 11) and `b 1` (atoms 12 to 23), of 2 and 3 units.
fn write_model(folder: &Path, change: impl Fn(&mut PhysicalModel)) {
    let surfaces = [("a 0".to_owned(), icosphere(2.0, 0)), ("b 1".to_owned(), icosphere(3.0, 0))];
    let mut model = model_of_surfaces("two", "um", &surfaces);
    change(&mut model);
    model.write(std::fs::File::create(folder.join("two.pml")).unwrap()).unwrap();
}

fn document_text(mesh: &str, more: &str) -> String {
    format!(
        "title = \"A model\"\nrun = {{ until = \"1 s\" }}\n[cells.a]\nmesh = {{ shape = \"file\", path = \"two.pml\"{mesh} }}\n\
         mechanics = {{ drag = \"10 pN s/um\", mass = \"24 pN s^2/um\", shape_memory = {{ stiffness = \"5 pN/um\" }} }}\n{more}\n"
    )
}

fn compiled(folder: &Path, mesh: &str, more: &str) -> Result<Compiled, Vec<Fault>> {
    let text = document_text(mesh, more);
    match Document::parse("model.toml", &text, folder, &[]).and_then(|document| compile(&document)) {
        Ok(compiled) => Ok(compiled),
        Err(Error::Input(faults)) => Err(faults),
        Err(other) => panic!("{other}"),
    }
}

const B: &str = ", component = \"Facet of region #1 (b 1)\"";

/// The loads on a cell of the second sphere that a text in LML becomes, and what is held.
fn loads_of(inside: &str) -> Result<(Vec<Load>, Vec<f64>), String> {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let text = format!(
        "<loads xmlns=\"http://www-timc.imag.fr/load\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">\n{inside}\n</loads>"
    );
    std::fs::write(folder.path().join("own.lml"), text).unwrap();
    let compiled = compiled(folder.path(), B, "loads_file = \"own.lml\"").map_err(|faults| {
        assert!(faults.iter().all(|fault| fault.help.is_some() && fault.location.is_some()), "{faults:?}");
        faults
            .iter()
            .map(|fault| fault.message.replace(&folder.path().display().to_string(), "FOLDER"))
            .collect::<String>()
    })?;
    let kind = &compiled.model.kinds[0];
    let load = |force: &Force| if let Force::Load(load) = force { Some(load.clone()) } else { None };
    Ok((kind.forces.iter().filter_map(load).collect(), kind.held.clone()))
}

fn load(kind: &str, targets: &str, direction: &str, events: &[(f64, f64)], unit: &str) -> String {
    let events: String =
        events.iter().map(|(date, value)| format!("<valueEvent date=\"{date}\" value=\"{value}\"/>")).collect();
    format!(
        "<load xsi:type=\"{kind}\"><appliedTo>{targets}</appliedTo><direction {direction}/>{events}<unit>{unit}</unit></load>"
    )
}

#[test]
fn a_component_of_a_model_is_the_surface_of_a_cell_in_its_unit() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let kind = |mesh: &str| compiled(folder.path(), mesh, "").unwrap().model.kinds.remove(0);
    assert_eq!(kind(B).rest, icosphere(3.0, 0), "the file says that it is in um");
    let nano = kind(&format!("{B}, unit = \"nm\""));
    assert!((volume(&nano.rest) / volume(&icosphere(3e-3, 0)) - 1.0).abs() < 1e-12, "the document has the last word");
    write_model(folder.path(), |model| model.properties = Default::default());
    let milli = kind(B);
    assert!((volume(&milli.rest) / volume(&icosphere(3e3, 0)) - 1.0).abs() < 1e-12, "mm is usual");
}

#[test]
fn files_that_break_the_rules_are_told_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let text = std::fs::read_to_string(folder.path().join("two.pml")).unwrap();
    std::fs::write(folder.path().join("two.pml"), text.replace("nrOfAtoms=\"24\"", "nrOfAtoms=\"25\"")).unwrap();
    std::fs::write(folder.path().join("none.lml"), "<loads/>").unwrap();
    let text = document_text(B, "loads_file = \"none.lml\"");
    let document = Document::parse("model.toml", &text, folder.path(), &[]).unwrap();
    let told = notices(&document, &prepare(&document).unwrap()).join("\n");
    assert!(
        told.contains("two.pml breaks the rules: line 2: 25 atoms are told, 24 are there; those were taken"),
        "{told}"
    );
    assert!(told.contains("none.lml breaks the rules: line 1: <loads> is not in the namespace"), "{told}");
}

#[test]
fn a_component_of_a_file_that_has_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    pseudopod::geometry::export_surface(&icosphere(2.0, 0), &[], &folder.path().join("two.obj")).unwrap();
    let text = document_text(", component = \"a\"", "").replace("two.pml", "two.obj");
    let document = Document::parse("model.toml", &text, folder.path(), &[]).unwrap();
    let Err(Error::Input(faults)) = compile(&document) else { panic!("it is taken") };
    assert_eq!(faults[0].message, "`cells.a.mesh.component` has no meaning for `two.obj`");
}

#[test]
fn several_surfaces_are_listed_with_the_key_that_chooses() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let faults = compiled(folder.path(), "", "").unwrap_err();
    let help = faults[0].help.as_deref().unwrap();
    assert!(faults[0].message.ends_with("two.pml` has 2 components that are closed surfaces"), "{faults:?}");
    assert!(
        help.contains("`component = \"Facet of region #0 (a 0)\"`")
            && help.contains("`Facet of region #1 (b 1)` (20 facets, closed)")
    );
    let faults = compiled(folder.path(), ", component = \"Facet of region #1 (b 2)\"", "").unwrap_err();
    assert!(faults[0].help.as_deref().unwrap().starts_with("did you mean `Facet of region #1 (b 1)`?"), "{faults:?}");
    let faults = compiled(folder.path(), ", component = \"Region #0 a 0\"", "").unwrap_err();
    assert!(faults[0].message.contains("has no facets"), "{faults:?}");
}

#[test]
fn a_force_acts_with_its_value_on_each_atom_along_a_direction_that_is_no_unit_vector() {
    let two = load("Force", "12, 20-21", "x=\"3\" y=\"-4\"", &[(0.0, 2.0), (1.0, 6.0)], "pN");
    let (loads, held) = loads_of(&two).unwrap();
    assert_eq!(loads[0].atoms, [(0, 1.0 / 3.0), (8, 1.0 / 3.0), (9, 1.0 / 3.0)]);
    assert!((loads[0].direction.x - 0.6).abs() < 1e-15 && (loads[0].direction.y + 0.8).abs() < 1e-15);
    assert_eq!(
        [0.0, 0.5, 9.0].map(|time| loads[0].force.at(time)),
        [30.0, 60.0, 90.0],
        "5 times 3 atoms times the value"
    );
    assert_eq!((loads[0].name.as_str(), held.len()), ("lml1", 0));
}

#[test]
fn a_course_jumps_at_its_first_event_and_where_two_have_one_date() {
    let jumps = load("Force", "12", "z=\"1\"", &[(0.5, 50.0), (0.7, 50.0), (0.7, 10.0)], "pN");
    let (loads, _) = loads_of(&jumps).unwrap();
    let values = [0.0, 0.499, 0.5, 0.6, 0.699, 0.7, 2.0].map(|time| loads[0].force.at(time));
    assert_eq!(values, [0.0, 0.0, 50.0, 50.0, 50.0, 10.0, 10.0]);
}

#[test]
fn names_mean_the_atoms_of_components_and_null_holds_them() {
    let null = load("Translation", "Facet of region #1 (b 1) ", "x=\"NULL\" z=\"NULL\"", &[(0.0, 1.0)], "mm");
    let (loads, held) = loads_of(&null).unwrap();
    assert_eq!((loads.len(), held), (0, [0.0, 1.0, 0.0].repeat(12)));
    let nothing = load("Translation", "13", "z=\"-0.5\"", &[(0.0, 0.0)], "mm");
    let (_, held) = loads_of(&nothing).unwrap();
    assert_eq!(held.iter().enumerate().filter(|(_, factor)| **factor == 0.0).map(|(i, _)| i).collect::<Vec<_>>(), [5]);
}

#[test]
fn a_displacement_moves_atoms_on_its_course_and_leaves_them_free_where_it_says_nothing() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let slips = load("Translation", "12-13", "x=\"NULL\" z=\"-0.5\"", &[(1.0, 0.0), (3.0, 4.0)], "micron");
    let held = load("Translation", "14", "x=\"0\" y=\"2\" z=\"NULL\"", &[(0.0, 0.0), (1.0, 1.0)], "nm");
    let text = format!(
        "<loads xmlns=\"http://www-timc.imag.fr/load\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">{slips}{held}</loads>"
    );
    std::fs::write(folder.path().join("own.lml"), text).unwrap();
    let plot = "loads_file = \"own.lml\"\n[[plot]]\nname = \"force\"\nkind = \"curve\"\nx = \"displacement.lml1\"\ny = \"force.lml1\"";
    let kind = compiled(folder.path(), B, plot).unwrap().model.kinds.remove(0);
    let [slips, held] = &kind.moved[..] else { panic!("{:?}", kind.moved) };
    assert_eq!((slips.name.as_str(), slips.atoms.as_slice()), ("lml1", &[0, 1][..]));
    assert_eq!(slips.gone(2.0), pseudopod::Vec3::new(0.0, 0.0, -1.0));
    assert_eq!(held.gone(5.0), pseudopod::Vec3::new(0.0, 2e-3, 0.0));
    assert_eq!(kind.held[..9], [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(kind.held[9..].iter().all(|factor| *factor == 1.0));
    let own = plot.replace(
        "loads_file = \"own.lml\"",
        "moved = [{ name = \"lml1\", atoms = [3], direction = [1, 0, 0], displacement = \"0 um\" }]",
    );
    assert!(compiled(folder.path(), B, &own).is_ok(), "what a document moves has the same series");
    let twice = load("Translation", "12", "z=\"1\"", &[(0.0, 0.0), (1.0, 1.0)], "mm").repeat(2);
    let message = loads_of(&twice).unwrap_err();
    assert_eq!(message, "`cells.a.loads_file` moves atom 0, which `cells.a` holds or moves already");
}

#[test]
fn the_force_that_a_displacement_of_a_file_takes_is_told_and_other_schemes_refuse_it() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let lift = load("Translation", "12", "x=\"NULL\" y=\"NULL\" z=\"1\"", &[(0.0, 0.0), (0.5, 0.2)], "micron");
    let still = load("Translation", "13-23", "x=\"NULL\" y=\"NULL\" z=\"NULL\"", &[(0.0, 1.0)], "micron");
    let text = format!(
        "<loads xmlns=\"http://www-timc.imag.fr/load\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">{lift}{still}</loads>"
    );
    std::fs::write(folder.path().join("own.lml"), text).unwrap();
    let text = document_text(B, "loads_file = \"own.lml\"");
    let document = Document::parse("model.toml", &text, folder.path(), &[]).unwrap();
    let mut simulation = pseudopod::simulation::Simulation::from_document(&document).unwrap();
    simulation.run_until(1.0).unwrap();
    assert_eq!(simulation.series("displacement.lml1").unwrap(), [0.2]);
    let force = simulation.series("force.lml1").unwrap()[0];
    let held = simulation.series("holding_force_z").unwrap()[0];
    assert!(
        force.abs() > 0.1 && held.abs() < 1e-6 * force.abs(),
        "{force} pN lift one atom, the others hold against it: {held}"
    );
    let explicit = text.replace("until = \"1 s\"", "until = \"1 s\", integrator = { method = \"explicit\" }");
    let document = Document::parse("model.toml", &explicit, folder.path(), &[]).unwrap();
    let Err(Error::Input(faults)) = compile(&document) else { panic!("it is taken") };
    assert!(
        faults[0].message.ends_with("the load (Translation) moves atoms, which only the implicit scheme does"),
        "{faults:?}"
    );
}

#[test]
fn a_pressure_is_a_traction_and_an_acceleration_is_a_force_by_mass() {
    let (loads, _) = loads_of(&load("Pressure", "12-23", "y=\"2\"", &[(0.0, 3.0)], "Pa")).unwrap();
    let area = pseudopod::geometry::area(&icosphere(3.0, 0));
    assert!((loads[0].force.at(0.0) / (6.0 * area) - 1.0).abs() < 1e-12);
    let (loads, _) = loads_of(&load("Acceleration", "12-14", "y=\"-2\"", &[(0.0, 5.0)], "mm/s^2")).unwrap();
    // Three atoms of 24/12 pN s²/µm each, 10 000 µm/s².
    assert!((loads[0].force.at(0.0) / 60_000.0 - 1.0).abs() < 1e-12);
}

#[test]
fn a_load_on_atoms_that_the_surface_does_not_have_is_left_out_and_told() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let inside =
        [load("Force", "3-5", "z=\"1\"", &[(0.0, 1.0)], "pN"), load("Force", "11-12", "z=\"1\"", &[(0.0, 1.0)], "pN")];
    let text = format!(
        "<loads xmlns=\"http://www-timc.imag.fr/load\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">{}</loads>",
        inside.concat()
    );
    std::fs::write(folder.path().join("own.lml"), text).unwrap();
    let text = document_text(B, "loads_file = \"own.lml\"");
    let document = Document::parse("model.toml", &text, folder.path(), &[]).unwrap();
    let prepared = prepare(&document).unwrap();
    let loads = prepared.model.kinds[0].forces.iter();
    let loads: Vec<&Load> =
        loads.filter_map(|force| if let Force::Load(load) = force { Some(load) } else { None }).collect();
    assert_eq!((loads.len(), loads[0].atoms.as_slice()), (1, &[(0, 1.0)][..]));
    let told = notices(&document, &prepared).join("\n");
    assert!(told.contains("own.lml:1: the load (Force) acts on no atom of the surface and is left out"), "{told}");
}

#[test]
fn what_cannot_be_done_is_refused_with_the_line_of_the_load() {
    for (text, told) in [
        (load("Translation", "12", "z=\"1\"", &[(0.0, 1.0), (1.0, 2.0)], "mm"), "has moved atoms already at the start"),
        (load("Rotation", "12", "z=\"1\"", &[(0.0, 1.0)], "radian"), "the load (Rotation) turns atoms"),
        (load("Force", "12", "toward=\"13\"", &[(0.0, 1.0)], "N"), "acts toward an atom"),
        (load("Force", "12", "z=\"1\"", &[(0.0, 1.0)], "mm"), "has the unit \"mm\""),
        (load("Force", "30", "z=\"1\"", &[(0.0, 1.0)], "pN"), "acts on atom 30, which is not there"),
        (load("Force", "top", "z=\"1\"", &[(0.0, 1.0)], "pN"), "acts on `top`, which the PML file"),
        (load("Torque", "12", "z=\"1\"", &[(0.0, 1.0)], "pN"), "the load (Torque) is of no known kind"),
    ] {
        let message = loads_of(&format!("\n{text}")).unwrap_err();
        assert!(message.starts_with("FOLDER/own.lml:3: the load (") && message.contains(told), "{message}");
    }
}

#[test]
fn loads_that_are_told_in_lml_are_read_as_the_same_loads() {
    let folder = tempfile::tempdir().unwrap();
    write_model(folder.path(), |_| ());
    let applied = "loads = [{ name = \"pull\", cap = { direction = [0, 0, 1], number = 4 }, direction = [0, 3, 4], spread = \"tapered\", \
                   force = [[\"0.1 s\", \"3 pN\"], [\"0.5 s\", \"8 pN\"]] }]\nfixed = [{ atoms = [0, 1, 2, 7], axes = [\"x\", \"z\"] }]\n\
                   moved = [{ name = \"grip\", atoms = [3, 7, 9], axes = [\"y\"], direction = [0, -2, 0], displacement = [[\"0 s\", \"0 um\"], [\"0.5 s\", \"0.7 um\"]] }]";
    let told = compiled(folder.path(), B, applied).unwrap();
    let (loads, untold) = loads_as_lml(&told.model, &[(0, 12)]);
    assert!(untold.is_empty());
    let mut written = Vec::new();
    loads.write(&mut written).unwrap();
    assert_eq!(Loads::read("told", written.clone()).unwrap().document, loads);
    std::fs::write(folder.path().join("told.lml"), written).unwrap();
    let read = compiled(folder.path(), B, "loads_file = \"told.lml\"").unwrap();
    let [told, read] = [&told, &read].map(|compiled| &compiled.model.kinds[0]);
    assert_eq!(told.held, read.held);
    let displaced = |kind: &pseudopod::sim::Kind, atom: u32| -> pseudopod::Vec3 {
        let own = kind.moved.iter().filter(|moved| moved.atoms.contains(&atom));
        own.map(|moved| moved.gone(0.3)).sum()
    };
    for atom in 0..12 {
        assert!((displaced(told, atom) - displaced(read, atom)).norm() < 1e-15, "{atom}");
    }
    let on = |kind: &pseudopod::sim::Kind, atom: u32, time: f64| -> [f64; 3] {
        let of = |force: &Force| match force {
            Force::Load(load) => {
                let share: f64 = load.atoms.iter().filter(|own| own.0 == atom).map(|own| own.1).sum();
                load.direction * (share * load.force.at(time))
            }
            _ => Default::default(),
        };
        kind.forces.iter().map(of).sum::<pseudopod::Vec3>().into()
    };
    for atom in 0..12 {
        for time in [0.0, 0.2, 0.5, 0.9] {
            let [expected, found] = [on(told, atom, time), on(read, atom, time)];
            let away = (0..3).map(|axis| (expected[axis] - found[axis]).abs()).fold(0.0, f64::max);
            assert!(away < 1e-12, "{atom} at {time} s: {expected:?} {found:?}");
        }
    }
}
