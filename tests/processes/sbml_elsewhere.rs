//! Others read the SBML that we write: libSBML finds no errors in it, libRoadRunner solves it to our numbers; and models of Antimony come
//! in and go out by the package antimony.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::shared::shared;
use crate::turns::take_turn;

/// For each NAME.xml of a folder: no errors of libSBML, and the columns of NAME.csv by libRoadRunner, which knows no delays.
const SCRIPT: &str = r#"
import collections, csv, pathlib, sys
import libsbml, numpy, roadrunner
roadrunner.Logger.setLevel(roadrunner.Logger.LOG_FATAL)
# What libSBML says of quantities and times without units, which it cannot check.
UNMEASURED = {20513, 20616, 20702, 80701, 99505, 99506, 99507, 99508}
bad, warnings, delayed = [], collections.Counter(), []
paths = sorted(pathlib.Path(sys.argv[1]).glob("*.xml"))
for path in paths:
    document = libsbml.readSBMLFromFile(str(path))
    document.checkConsistency()
    for error in map(document.getError, range(document.getNumErrors())):
        if error.getSeverity() >= libsbml.LIBSBML_SEV_ERROR or error.getErrorId() not in UNMEASURED:
            bad.append(f"{path.name}: {error.getErrorId()} {error.getMessage()}")
        warnings[error.getErrorId()] += 1
    text = path.read_text()
    units = [p.getUnits() for p in document.getModel().getListOfParameters()]
    if units and all(units) and document.getNumErrors():
        bad.append(f"{path.name}: everything has a unit, and there are warnings: {document.getError(0).getMessage()}")
    if "sbml/symbols/delay" in text:
        delayed.append(path.stem)
        continue
    head, *rows = csv.reader(path.with_suffix(".csv").open())
    ours = numpy.array(rows, float)
    runner = roadrunner.RoadRunner(str(path))
    runner.integrator.absolute_tolerance, runner.integrator.relative_tolerance = 1e-14, 1e-10
    runner.integrator.setValue("maximum_num_steps", 1000000)
    theirs = numpy.array(runner.simulate(ours[0, 0], ours[-1, 0], len(ours), head))
    off = numpy.abs(theirs - ours).max(0)
    for name, off, most in zip(head, off, numpy.abs(ours).max(0)):
        if not off <= 1e-6 * most:
            bad.append(f"{path.name}: `{name}` is off by {off}, its largest value is {most}")
assert not bad, "\n".join(bad)
print(len(paths), "models agree;", *delayed, "with delays not compared;", dict(warnings))
"#;

fn pseudopod(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pseudopod")).args(arguments).output().expect("the program starts")
}

/// What the program prints when all is good.
fn printed(arguments: &[&str]) -> String {
    let out = pseudopod(arguments);
    assert!(out.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).expect("a text")
}

/// What a script of Python prints when it ends well. `PYTHON` names the interpreter.
fn python(script: &str, folder: &Path) -> String {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let out =
        Command::new(python).args(["-c", script]).arg(folder).current_dir(folder).output().expect("python3 starts");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).expect("a text")
}

/// The files below a folder that have an ending, in order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        match path.is_dir() {
            true => found.extend(files(&path, ending)),
            false if path.to_string_lossy().ends_with(ending) => found.push(path),
            false => {}
        }
    }
    found.sort();
    found
}

/// Writes a document as SBML and as a table of its variables.
fn write(document: &Path, folder: &Path, until: f64) {
    let name = document.file_stem().expect("a name").to_string_lossy().into_owned();
    let [model, table] = ["xml", "csv"].map(|ending| folder.join(format!("{name}.{ending}")).display().to_string());
    let (document, until) = (document.display().to_string(), until.to_string());
    printed(&["eml", "to-sbml", &document, "-o", &model]);
    let solve = ["--rtol", "1e-9", "--atol", "1e-13", "--scheme", "rosenbrock", "-o", &table];
    printed(&[["eml", "solve", &document, "--until", &until, "--points", "51"].as_slice(), &solve].concat());
}

/// `python3 -m venv /tmp/venv && /tmp/venv/bin/pip install python-libsbml libroadrunner antimony`, then
/// `PYTHON=/tmp/venv/bin/python cargo test --release --test processes sbml_elsewhere -- --ignored`.
#[test]
#[ignore = "slow: needs python3 with python-libsbml and libroadrunner (1 min)"]
fn libsbml_and_libroadrunner_agree_with_us() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().expect("a folder");
    let mut count = 0;
    for document in files(Path::new("eml"), ".eml") {
        let written = pseudopod(&["eml", "to-sbml", &document.display().to_string()]);
        // What is drawn is in its middle there.
        let is_drawn = String::from_utf8_lossy(&written.stderr).contains("drawn at random");
        if written.status.success() && !is_drawn {
            // Errors of this one grow by e in each unit of time.
            let until = if document.ends_with("lorenz.eml") { 5.0 } else { 60.0 };
            write(&document, folder.path(), until);
            count += 1;
        }
    }
    let reactions = folder.path().join("reactions.eml");
    std::fs::write(&reactions, REACTIONS).expect("a document is written");
    write(&reactions, folder.path(), 20.0);
    // The cases of the suite are models of SBML that were EML in between.
    for model in shared("sbml-suite").map(|suite| files(&suite, "-sbml-l3v2.xml")).unwrap_or_default() {
        let settings = std::fs::read_to_string(model.to_string_lossy().replace("sbml-l3v2.xml", "settings.txt"));
        let settings = settings.expect("settings");
        let duration = settings.lines().find_map(|line| line.strip_prefix("duration:")).expect("a duration");
        let document = folder.path().join(model.file_name().expect("a name")).with_extension("eml");
        printed(&["eml", "from-sbml", &model.display().to_string(), "-o", &document.display().to_string()]);
        write(&document, folder.path(), duration.trim().parse().expect("a number"));
        count += 1;
    }
    let said = python(SCRIPT, folder.path());
    println!("{said}");
    assert!(said.starts_with(&format!("{} models agree; hes1 with delays", count + 1)), "{said}");
}

const REACTIONS: &str = r#"<eml name="reactions" time_unit="min">
  <parameter id="k_on" value="0.3" unit="1/(uM min)"/><parameter id="k_off" value="0.2" unit="1/min"/>
  <parameter id="E" value="2" unit="uM"/><parameter id="dose" value="1.5" unit="uM"/>
  <parameter id="length" value="0.1" unit="um/uM"/><parameter id="limit" value="0.8" unit="uM"/>
  <variable id="A" initial="1.5" unit="uM"/><variable id="D" initial="dose/3" unit="uM"/>
  <variable id="x" initial="0" unit="um" rate="length*binding"/>
  <reaction id="binding" equation="2 A = D" rate="k_on*A^2" reverse="k_off*D"/>
  <reaction id="synthesis" equation="$E -> A + $E" rate="k_off*hill(E, dose, 2)*dose"/>
  <reaction id="loss" equation="D ->" rate="k_off*D*heaviside(sign(D))"/>
  <event id="pulse" when="D gt limit" delay="0.5"><set id="A">A + dose</set></event>
</eml>
"#;

/// The commands of the page on equations that bring in a model of Antimony and take one out.
#[test]
#[ignore = "slow: needs python3 with antimony and libroadrunner (10 s)"]
fn models_of_antimony_come_in_and_go_out() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().expect("a folder");
    let page = std::fs::read_to_string("docs/src/howto_equations.md").expect("the page of the book");
    let block = |mark: &str| {
        let (_, rest) = page.split_once(mark).unwrap_or_else(|| panic!("{mark} is not in the book"));
        rest.split_once("```").expect("the end of a block").0
    };
    std::fs::write(folder.path().join("chain.ant"), block("```antimony\n")).expect("a model is written");
    let python_of_page = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    for line in block("```bash\n").lines().filter(|line| line.starts_with("python3 ")) {
        let line = line.replacen("python3", &python_of_page, 1);
        let path = |name: &str| folder.path().join(name).display().to_string();
        let out = Command::new("bash").args(["-c", &line]).current_dir(folder.path()).output().expect("bash starts");
        assert!(out.status.success(), "{line}: {}", String::from_utf8_lossy(&out.stderr));
        if !folder.path().join("chain.eml").exists() {
            printed(&["eml", "from-sbml", &path("chain.xml"), "-o", &path("chain.eml")]);
            printed(&["eml", "to-sbml", &path("chain.eml"), "-o", &path("back.xml")]);
        }
    }
    let end = |model: &str| {
        let model = folder.path().join(model).display().to_string();
        let table = printed(&[
            "eml",
            "solve",
            &model,
            "--until",
            "4",
            "--points",
            "2",
            "--columns",
            "time,A,B",
            "--rtol",
            "1e-10",
        ]);
        let last = table.lines().last().expect("a row").to_owned();
        last.split(',').map(|number| number.parse::<f64>().expect("a number")).collect::<Vec<f64>>()
    };
    // A decays at k1 = 0.4, B of which it is made at k2 = 0.1: 20 of A at first in a volume of 2.
    let (k1, k2, t) = (0.4_f64, 0.1_f64, 4.0);
    let exact = [t, 20.0 * (-k1 * t).exp(), 20.0 * k1 / (k1 - k2) * ((-k2 * t).exp() - (-k1 * t).exp())];
    for model in ["chain.xml", "chain.eml", "back.xml"] {
        let found = end(model);
        assert!(
            found.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-6 * b),
            "{model}: {found:?} instead of {exact:?}"
        );
    }
    let back = std::fs::read_to_string(folder.path().join("back.ant")).expect("Antimony again");
    assert!(back.contains("A -> B;") && back.contains("at ") && back.contains("species A in vessel"), "{back}");
}
