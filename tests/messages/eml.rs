//! Every message about a bad EML document is kept beside the document.

use crate::turns::take_turn;
use pseudopod::equations::eml;
use pseudopod::error::{Error, Paint, Source, render};
use std::path::PathBuf;
use std::sync::Arc;

fn documents() -> Vec<(PathBuf, String)> {
    let folder = std::fs::read_dir("tests/messages/eml").expect("the folder of bad documents");
    let paths = folder.map(|entry| entry.expect("an entry of the folder").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "eml")).collect();
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), std::fs::read_to_string(path).expect("a text"))).collect()
}

fn read(path: &std::path::Path, text: String) -> Result<eml::Document, Error> {
    let name = path.file_name().expect("a name").to_string_lossy().into_owned();
    eml::read(Arc::new(Source { name, text }))
}

#[test]
fn every_bad_document_gets_the_message_beside_it() {
    let documents = documents();
    assert!(documents.len() >= 40, "bad documents are missing: {}", documents.len());
    let mut differences = Vec::new();
    for (path, text) in documents {
        let kept = path.with_extension("txt");
        let Err(error) = read(&path, text) else {
            differences.push(format!("{} is taken for a good document", path.display()));
            continue;
        };
        assert_eq!(error.exit_code(), 2, "bad input ends with 2");
        let message = render(&error, Paint::Plain);
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&kept, message).expect("the text is kept");
        } else if std::fs::read_to_string(&kept).unwrap_or_default() != message {
            differences.push(format!("{}:\n{message}", kept.display()));
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}

#[test]
fn every_fault_of_a_document_has_a_location_and_says_what_to_do() {
    for (path, text) in documents() {
        let Err(Error::Input(faults)) = read(&path, text) else { continue };
        for fault in faults {
            let location = fault.location.unwrap_or_else(|| panic!("{}: {}", path.display(), fault.message));
            assert!(
                location.source.text.get(location.start..location.start + location.length).is_some(),
                "inside the text"
            );
            assert!(fault.help.is_some_and(|help| !help.is_empty()), "{}: {}", path.display(), fault.message);
        }
    }
}

#[test]
fn implicit_schemes_refuse_systems_whose_matrices_would_not_fit() {
    let _turn = take_turn();
    let variables: String = (0..5001).map(|i| format!("<variable id=\"x{i}\" initial=\"1\"/>\n")).collect();
    let equations: String = (0..5001).map(|i| format!("<equation of=\"x{i}\">-x{i}</equation>\n")).collect();
    let folder = tempfile::tempdir().unwrap();
    let text = format!("<eml name=\"big\" level=\"scene\" time_unit=\"s\">\n{variables}{equations}</eml>\n");
    std::fs::write(folder.path().join("big.eml"), text).unwrap();
    let experiment = "title = \"Big\"\n[run]\nuntil = \"1 s\"\n[chemistry.big]\ndocument = \"big.eml\"\n";
    std::fs::write(folder.path().join("big.toml"), experiment).unwrap();
    let told = |arguments: &[&str]| {
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_pseudopod"));
        let out = program.args(arguments).current_dir(folder.path()).output().unwrap();
        (out.status.code(), String::from_utf8(out.stderr).unwrap())
    };
    let solve = ["eml", "solve", "big.eml", "--until", "1", "--points", "2", "--columns", "x0", "--scheme"];
    let with = |scheme: &'static str| solve.iter().copied().chain([scheme]).collect::<Vec<_>>();
    for scheme in ["rosenbrock", "bdf"] {
        let (code, words) = told(&with(scheme));
        let expected = format!("big has 5001 variables; the scheme {scheme} takes up to 5000");
        let help = "take --scheme rk45 if the system is not stiff; write what spreads in space as a field";
        assert!(code == Some(2) && words.contains(&expected) && words.contains(help), "{words}");
    }
    assert_eq!(told(&with("rk45")), (Some(0), String::new()));
    let (code, words) = told(&["check", "big.toml"]);
    assert!(code == Some(2) && words.contains("`big` has 5001 variables; the scheme rosenbrock"), "{words}");
    assert!(words.contains("add `scheme = \"rk45\"`"), "{words}");
    std::fs::write(folder.path().join("big.toml"), format!("{experiment}scheme = \"rk45\"\n")).unwrap();
    assert_eq!(told(&["check", "big.toml"]), (Some(0), String::new()));
}

#[test]
fn single_solves_refuse_noise() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    let text = "<eml name=\"noisy\">\n<variable id=\"x\" initial=\"1\" rate=\"-x\" noise=\"0.1\"/>\n</eml>\n";
    std::fs::write(folder.path().join("noisy.eml"), text).unwrap();
    let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_pseudopod"));
    let out = program.args(["eml", "solve", "noisy.eml", "--until", "1"]).current_dir(folder.path()).output().unwrap();
    let words = String::from_utf8(out.stderr).unwrap();
    assert_eq!(out.status.code(), Some(2));
    assert!(words.contains("noisy.eml has noise, which single solves do not have"), "{words}");
    assert!(words.contains("noisy.eml:2") && words.contains("noise=\"0.1\""), "{words}");
}
