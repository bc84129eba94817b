//! What is read is written, and what was written reads as the same document: real files, and a small one of each kind of
//! oddity.

use super::lml::{Component, LoadKind, Loads, Target};
use super::mml::{Criterion, MethodKind, Monitoring, Operator};
use super::pml::{CellType, LENGTH_UNIT, PhysicalModel, Wanted, model_of_surfaces};
use super::{Read, Warnings};
use crate::error::{Error, Result};
use crate::geometry::{SurfaceRules, Topology, check_surface, icosphere, volume};
use std::path::{Path, PathBuf};

#[path = "../../tests/support/shared.rs"]
mod shared;

fn pml(text: &str) -> Read<PhysicalModel> {
    PhysicalModel::read("model.pml", text.into()).expect("a model")
}

fn lml(text: &str) -> Read<Loads> {
    Loads::read("loads.lml", text.into()).expect("loads")
}

fn refusal<T: std::fmt::Debug>(outcome: Result<Read<T>>) -> String {
    match outcome {
        Err(Error::Input(faults)) => faults[0].message.clone(),
        other => panic!("{other:?}"),
    }
}

fn found(warnings: &Warnings) -> Vec<&str> {
    warnings.list.iter().map(|warning| warning.found.as_str()).collect()
}

/// Reads a file of one of the languages, writes it, reads that, and holds both equal; returns what was written.
fn there_and_back(path: &Path) -> Vec<u8> {
    let mut written = Vec::new();
    let name = path.display().to_string();
    match path.extension().and_then(|end| end.to_str()) {
        Some("pml") => {
            let first = PhysicalModel::open(path).expect("a model").document;
            first.write(&mut written).unwrap();
            let second = PhysicalModel::read(&name, written.clone()).expect("what was written");
            assert!(first == second.document, "{name}");
            assert!(second.warnings.list.iter().all(|warning| warning.found.contains("already")), "{name}");
        }
        Some("lml") => {
            let first = Loads::open(path).expect("loads").document;
            first.write(&mut written).unwrap();
            let second = Loads::read(&name, written.clone()).expect("what was written");
            assert_eq!((first, second.warnings), (second.document, Warnings::default()), "{name}");
        }
        _ => {
            let first = Monitoring::open(path).expect("monitoring").document;
            first.write(&mut written).unwrap();
            let second = Monitoring::read(&name, written.clone()).expect("what was written");
            assert_eq!((first, second.warnings), (second.document, Warnings::default()), "{name}");
        }
    }
    written
}

/// The real files that are there.
fn samples() -> Vec<PathBuf> {
    let folders = ["pml-lml-mml/pml", "pml-lml-mml/lml", "pml-lml-mml/mml", "truth-cube"];
    let folders = folders.into_iter().filter_map(shared::shared);
    let entries = folders.flat_map(|folder| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    let known =
        |path: &PathBuf| path.extension().is_some_and(|end| ["pml", "lml", "mml"].iter().any(|own| end == *own));
    entries.filter(known).collect()
}

#[test]
fn real_files_are_read_written_and_read_back_equal() {
    let samples = samples();
    for path in &samples {
        there_and_back(path);
    }
    assert!(samples.is_empty() || samples.len() >= 25, "{}", samples.len());
}

/// What is written is valid by the schemas of the languages. `PSEUDOPOD_XSD_PYTHON` names a Python that has lxml.
#[test]
#[ignore = "needs Python with lxml"]
fn what_is_written_is_valid() {
    let (Some(python), Some(schemas)) = (std::env::var_os("PSEUDOPOD_XSD_PYTHON"), shared::shared("pml-lml-mml/xsd"))
    else {
        panic!("set PSEUDOPOD_XSD_PYTHON, and have ../shared/data");
    };
    let folder = tempfile::tempdir().unwrap();
    let own = [("own.pml", ODD_MODEL), ("own.lml", ODD_LOADS), ("own.mml", ODD_MONITORING), ("found.mml", FOUND)];
    let own = own.map(|(name, text)| {
        let path = folder.path().join("in-".to_owned() + name);
        std::fs::write(&path, text).unwrap();
        path
    });
    let mut written: Vec<PathBuf> = Vec::new();
    for (number, path) in samples().iter().chain(&own).enumerate() {
        let copy = folder.path().join(format!("{number}-{}", path.file_name().unwrap().display()));
        std::fs::write(&copy, there_and_back(path)).unwrap();
        written.push(copy);
    }
    let made = model_of_surfaces("two", "um", &[("a".into(), icosphere(1.0, 1)), ("b".into(), icosphere(2.0, 0))]);
    let path = folder.path().join("made.pml");
    made.write(std::fs::File::create(&path).unwrap()).unwrap();
    written.push(path);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/validate_models.py");
    let status = std::process::Command::new(python).arg(script).arg(schemas).args(written).status().unwrap();
    assert!(status.success());
}

/// Indices with gaps and in no order, blanks in names, properties everywhere, parts in another order, an element and a
/// component that nobody knows.
const ODD_MODEL: &str = r#"<physicalModel name="odd &amp; old " nrOfAtoms="5" author="A. N. &quot;Other&quot;" xmlns:my="urn:mine" my:flag="1">
<informativeComponents><multiComponent name="Informative Components ">
  <structuralComponent name="labels" mode="POINTS" weight="2"><atomRef index="70"/><atomRef index="3"/></structuralComponent>
</multiComponent></informativeComponents>
<exclusiveComponents level="1"><multiComponent name="Exclusive Components " young="15000">
  <multiComponent name="nested"><structuralComponent name="facets">
    <color r="0.8" g="0.25" b="0.2" a="1"/>
    <cell><cellProperties index="4" type="TRIANGLE" phymulType="elastic"/><nrOfStructures value="3"/>
      <atomRef index="70"/><atomRef index="3"/><atomRef index="9"/></cell>
    <cell><cellProperties type="QUAD" name="q"/><color r="0" g="0" b="1" a="0.5"/>
      <atomRef index="70"/><atomRef index="3"/><atomRef index="9"/><atomRef index="0"/></cell>
  </structuralComponent></multiComponent>
</multiComponent></exclusiveComponents>
<atoms><structuralComponent name="list">
  <atom><atomProperties index="70" x="-1e-3" y="0.1" z="123456789.125" mass="100"/></atom>
  <atom><atomProperties index="3" x="1" y="0" z="0" name="a &lt; b"/></atom>
  <atom><atomProperties index="9" x="0" y="1" z="0"/></atom>
  <atom><atomProperties index="0" x="0" y="0" z="1"/></atom>
</structuralComponent></atoms>
</physicalModel>"#;

const ODD_LOADS: &str = r#"<loads xmlns="http://www-timc.imag.fr/load" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
<load xsi:type="Force"><unit>pN</unit><valueEvent date="0.5" value="50" transition="LINEAR"/>
  <direction x="NULL" y="2.5"/><appliedTo> 1-10, 24, the top one </appliedTo></load>
<load xsi:type="Translation"><appliedTo>15</appliedTo><direction toward="50"/><valueEvent value="1" date="0"/><unit>mm</unit></load>
</loads>"#;

const ODD_MONITORING: &str = r#"<monitoringIn xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
<dt value="0.1" unit="s"/><refresh value="1" unit="min"/><pmlFile>a model.pml</pmlFile><simulator>sofa</simulator>
<stoppingCriteria><multipleCriteria op="Or">
  <criteria xsi:type="Time" unit="s"><method xsi:type="MinThreshold" minValue="0.5" scope="Any"/></criteria>
  <multipleCriteria op="And">
    <criteria xsi:type="Position" unit="mm" target="beads "><method xsi:type="Threshold" maxValue="1e-1" scope="Average"/></criteria>
    <criteria xsi:type="Speed" unit="m/s"><method xsi:type="TimePeriodThreshold" minValue="2" iterations="3"/></criteria>
  </multipleCriteria></multipleCriteria></stoppingCriteria>
<monitors><monitor type="REN" index="2" target="beads" dx="-15"><startAt value="0" unit="s"/><stopAt value="100" unit="s"/>
  <reference document="ref.mml" monitorIndex="1" target="all"/></monitor></monitors>
</monitoringIn>"#;

const FOUND: &str = r#"<monitoringOut xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"><pmlFile>a.pml</pmlFile>
<time value="0.5" unit="s"><monitor type="Position" index="1" target="beads"><startAt value="0" unit="s"/><stopAt value="1" unit="s"/>
  <indexes>1 2</indexes><data>0 1.5 -2e-3 4 5 6</data></monitor></time></monitoringOut>"#;

#[test]
fn what_the_language_does_not_know_survives_a_round_trip() {
    let text =
        ODD_MODEL.replace("<atoms>", "<my:history><step n=\"1\">&lt;old&gt;</step></my:history><atoms>").replace(
            "<multiComponent name=\"nested\">",
            "<springs k=\"3\"><pair a=\"1\"/></springs><multiComponent name=\"nested\">",
        );
    let text = text.replace("<atomRef index=\"0\"/></cell>", "<atomRef index=\"0\" weight=\"0.5\"/><note/></cell>");
    let text = text.replace("<atom><atomProperties index=\"9\"", "<atom fixed=\"yes\"><atomProperties index=\"9\"");
    let first = pml(&text);
    let mut written = Vec::new();
    first.document.write(&mut written).unwrap();
    let again = String::from_utf8(written.clone()).unwrap();
    for kept in [
        "<my:history><step n=\"1\">&lt;old&gt;</step></my:history>",
        "<springs k=\"3\"><pair a=\"1\"/></springs>",
        "weight=\"0.5\"",
        "<note/>",
        "<atom fixed=\"yes\">",
        "my:flag=\"1\"",
        "xmlns:my=\"urn:mine\"",
        "phymulType=\"elastic\"",
        "mass=\"100\"",
        "young=\"15000\"",
        "name=\"Informative Components \"",
    ] {
        assert!(again.contains(kept), "{kept} is lost in\n{again}");
    }
    assert_eq!(PhysicalModel::read("again", written).unwrap().document, first.document);
}

#[test]
fn rules_that_are_broken_without_a_doubt_are_told_with_their_lines() {
    let read = pml(ODD_MODEL);
    assert_eq!(
        found(&read.warnings),
        ["<exclusiveComponents> has an attribute `level`", "5 atoms are told, 4 are there"]
    );
    assert_eq!(read.warnings.list.iter().map(|warning| warning.line).collect::<Vec<_>>(), [5, 1]);
    let twice = ODD_MODEL.replace("type=\"QUAD\"", "index=\"4\" type=\"QUAD\"");
    assert!(found(&pml(&twice).warnings).contains(&"cell 4 is there already"));
    let strange = ODD_MODEL.replace("QUAD", "SQUARE");
    let read = pml(&strange);
    assert!(found(&read.warnings).iter().any(|found| found.contains("\"SQUARE\", which PML has not")));
    let nested = read.document.structural_components()[0].cells[1].kind.clone();
    assert_eq!(nested, CellType::Other("SQUARE".into()));
}

#[test]
fn a_model_in_latin_1_is_read_and_said_to_be() {
    let text = ODD_MODEL.replace("name=\"labels\"", "name=\"\u{e9}tiquettes\"");
    let bytes: Vec<u8> = text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect();
    let read = PhysicalModel::read("old.pml", bytes).unwrap();
    assert_eq!(read.warnings.list[0].found, "the text is not UTF-8");
    let names: Vec<&str> = read.document.structural_components().iter().filter_map(|own| own.name.as_deref()).collect();
    assert_eq!(names, ["facets", "\u{e9}tiquettes"]);
}

#[test]
fn entities_of_its_own_are_refused_and_a_deep_document_too() {
    let bomb = "<!DOCTYPE a [<!ENTITY a \"&b;&b;\"><!ENTITY b \"&a;&a;\">]><physicalModel name=\"&a;\"/>";
    assert!(refusal(PhysicalModel::read("bomb", bomb.into())).contains("document type"));
    let deep = format!("<physicalModel><exclusiveComponents>{}", "<multiComponent>".repeat(100_000));
    assert!(refusal(PhysicalModel::read("deep", deep.into())).contains("nested more than"));
    let promise = ODD_MODEL.replace("nrOfAtoms=\"5\"", "nrOfAtoms=\"18446744073709551615\"");
    assert_eq!(pml(&promise).document.all_atoms().count(), 4, "counts are hints");
}

#[test]
fn components_of_directions_have_three_states_and_point_to_atoms() {
    let read = lml(ODD_LOADS);
    assert_eq!(found(&read.warnings), [""; 0]);
    let [force, translation] = read.document.loads.as_slice() else { panic!("two loads") };
    let direction = force.direction.as_ref().unwrap();
    assert_eq!(direction.components, [Component::Null, Component::Number(2.5), Component::Free]);
    assert_eq!(force.applied_to, [Target::Range(1, 10), Target::Index(24), Target::Name("the top one".into())]);
    assert_eq!((&force.kind, force.value_at(0.4), force.value_at(7.0)), (&LoadKind::Force, 0.0, 50.0));
    assert_eq!(translation.direction.as_ref().unwrap().toward, Some(Target::Index(50)));
    let mut written = Vec::new();
    read.document.write(&mut written).unwrap();
    let again = String::from_utf8(written.clone()).unwrap();
    assert!(again.contains("<direction x=\"NULL\" y=\"2.5\"/>") && again.contains("transition=\"LINEAR\""), "{again}");
    assert_eq!(Loads::read("again", written).unwrap().document, read.document);
}

#[test]
fn criteria_are_nested_and_numbers_of_monitors_are_read() {
    let Monitoring::In(own) = Monitoring::read("in", ODD_MONITORING.into()).unwrap().document else { panic!("in") };
    let Some(Criterion::Multiple { operator: Operator::Or, list, .. }) = &own.stop else { panic!("{:?}", own.stop) };
    let Criterion::Multiple { operator: Operator::And, list: inner, .. } = &list[1] else { panic!("{list:?}") };
    let Criterion::Single(speed) = &inner[1] else { panic!("{inner:?}") };
    assert_eq!(speed.method.kind, MethodKind::TimePeriodThreshold { min: 2.0, iterations: 3 });
    assert_eq!(
        (own.refresh.as_ref().unwrap().seconds(), own.monitors[0].offset),
        (Some(60.0), [Some(-15.0), None, None])
    );
    let Monitoring::Out(out) = Monitoring::read("out", FOUND.into()).unwrap().document else { panic!("out") };
    assert_eq!(out.times[0].monitors[0].numbers(), Some(vec![0.0, 1.5, -2e-3, 4.0, 5.0, 6.0]));
}

#[test]
fn a_model_made_of_surfaces_has_these_surfaces_and_rings_in_cyclic_order() {
    let (large, small) = (icosphere(3.0, 1), icosphere(0.7, 0));
    let model = model_of_surfaces("two", "um", &[("a 0".into(), large.clone()), ("b 1".into(), small.clone())]);
    let mut written = Vec::new();
    model.write(&mut written).unwrap();
    let read = pml(&String::from_utf8(written).unwrap());
    assert_eq!(found(&read.warnings), [""; 0]);
    assert_eq!(read.document, model);
    assert_eq!(model.properties.get(LENGTH_UNIT), Some("um"));
    let only = |name: &str| model.surface("two.pml", Wanted::Named(&[name.to_owned()])).unwrap();
    assert_eq!(only("Facet of region #0 (a 0)").surface, large);
    let second = only("Facet of region #1 (b 1)");
    assert_eq!((&second.surface, second.indices[0]), (&small, 42));
    let message = model.surface("two.pml", Wanted::TheOnly).unwrap_err();
    assert_eq!(message.message, "PML file `two.pml` has 2 components that are closed surfaces");
    let rings = &model.structural_components()[2].cells;
    let rings: Vec<Vec<u32>> =
        rings[42..].iter().map(|cell| cell.references.atoms.iter().map(|a| a - 42).collect()).collect();
    assert_eq!(rings, Topology::of(&small).rings.iter().map(|ring| ring.atoms.clone()).collect::<Vec<_>>());
}

#[test]
fn surfaces_of_real_models_are_whole_and_face_outwards() {
    for (path, component, atoms, size) in [
        ("pml-lml-mml/pml/cube2.pml", None, 14, Some(1000.0)),
        ("pml-lml-mml/pml/cube3.pml", None, 8, Some(1e-3)),
        ("pml-lml-mml/pml/icosahedron.pml", Some("Facets and neighbourhood"), 12, None),
        ("truth-cube/TruthCube-0-HexaFEM.pml", Some("volume #0"), 386, Some(80.0 * 80.0 * 80.0)),
        ("truth-cube/TruthCube-18.pml", None, 218, None),
    ] {
        let Some(file) = shared::shared(path) else { return };
        let model = PhysicalModel::open(&file).unwrap().document;
        let names: Vec<String> = component.iter().map(|name: &&str| (*name).to_owned()).collect();
        let wanted = if names.is_empty() { Wanted::TheOnly } else { Wanted::Named(&names) };
        let surface = model.surface(path, wanted).unwrap().surface;
        assert_eq!(check_surface(&surface, &SurfaceRules::CELL), Ok(()), "{path}");
        assert_eq!(surface.positions.len(), atoms, "{path}");
        assert!(volume(&surface) > 0.0);
        assert!(size.is_none_or(|size| (volume(&surface) / size - 1.0).abs() < 1e-9), "{path}: {}", volume(&surface));
    }
}

#[test]
fn quadrilaterals_are_cut_the_same_whatever_corner_they_begin_with() {
    let cut = |corners: [u32; 4]| {
        let text = ODD_MODEL.replace(
            "<atomRef index=\"70\"/><atomRef index=\"3\"/><atomRef index=\"9\"/><atomRef index=\"0\"/>",
            &corners.map(|corner| format!("<atomRef index=\"{corner}\"/>")).concat(),
        );
        let text = text.replace("TRIANGLE", "POLY_VERTEX");
        let mut facets = pml(&text).document.surface("odd", Wanted::TheOnly).unwrap().surface.facets;
        facets.iter_mut().for_each(|facet| facet.sort_unstable());
        facets.sort_unstable();
        facets
    };
    let expected = cut([70, 3, 9, 0]);
    assert_eq!(expected.len(), 2);
    for corners in [[3, 9, 0, 70], [9, 0, 70, 3], [0, 70, 3, 9], [0, 9, 3, 70]] {
        assert_eq!(cut(corners), expected, "{corners:?}");
    }
}

/// The most memory that the process has held so far, bytes.
#[cfg(target_os = "linux")]
fn most_memory() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    1024 * line.split_whitespace().nth(1).unwrap().parse::<usize>().unwrap()
}

/// Atoms with a property, and cells: what takes the most memory for its bytes. Run alone: other tests count as well.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "slow: 20 s without optimisation"]
fn a_file_of_100_mb_takes_no_more_than_four_times_its_bytes() {
    use std::io::Write as _;
    let path = tempfile::tempdir().unwrap().keep().join("large.pml");
    let mut out = std::io::BufWriter::new(std::fs::File::create(&path).unwrap());
    let atoms = 450_000;
    writeln!(out, "<physicalModel nrOfAtoms=\"4000000000\">\n<atoms><structuralComponent name=\"atoms\">").unwrap();
    for index in 0..atoms {
        let x = f64::from(index) * 0.125;
        writeln!(
            out,
            "<atom><atomProperties index=\"{index}\" x=\"{x}\" y=\"-0.25\" z=\"{}\" mass=\"100\"/></atom>",
            -x
        )
        .unwrap();
    }
    writeln!(out, "</structuralComponent></atoms>\n<exclusiveComponents><multiComponent><structuralComponent>")
        .unwrap();
    for index in 0..atoms {
        writeln!(out, "<cell><cellProperties index=\"{index}\" type=\"TRIANGLE\"/><nrOfStructures value=\"3\"/>")
            .unwrap();
        for atom in [index, (index + 1) % atoms, (index + 2) % atoms] {
            writeln!(out, "<atomRef index=\"{atom}\"/>").unwrap();
        }
        writeln!(out, "</cell>").unwrap();
    }
    writeln!(out, "</structuralComponent></multiComponent></exclusiveComponents></physicalModel>").unwrap();
    out.flush().unwrap();
    let (size, before, began) =
        (std::fs::metadata(&path).unwrap().len() as usize, most_memory(), std::time::Instant::now());
    let read = PhysicalModel::open(&path).unwrap();
    let (taken, seconds) = (most_memory() - before, began.elapsed().as_secs_f64());
    std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
    println!("{size} bytes: {taken} bytes of memory, {seconds} s");
    assert!(size > 100_000_000, "{size}");
    assert_eq!(read.document.all_atoms().count(), atoms as usize);
    assert!(taken < 4 * size, "{taken}");
}
