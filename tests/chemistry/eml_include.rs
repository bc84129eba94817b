//! Documents that include others: the same equations as written in one, faults told where they stand, files that are named.

use pseudopod::equations::tree::System;
use pseudopod::equations::{self, Files, eml, sbml};
use pseudopod::error::{Error, Fault, Source};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

/// A folder with some files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("the folder");
        std::fs::write(path, text).expect("a file");
    }
    folder
}

fn source(path: &Path) -> Arc<Source> {
    let text = std::fs::read_to_string(path).expect("a text");
    Arc::new(Source { name: path.display().to_string(), text })
}

fn read(folder: &Path, name: &str) -> Result<eml::Document, Vec<Fault>> {
    let path = folder.join(name);
    match equations::read_in(source(&path), Files::of_folder(path.parent())) {
        Ok(read) => Ok(read.document),
        Err(Error::Input(faults)) => Err(faults),
        Err(other) => panic!("{other}"),
    }
}

fn good(files: &[(&str, &str)]) -> eml::Document {
    let folder = folder(files);
    read(folder.path(), files[0].0).unwrap_or_else(|faults| panic!("{faults:?}"))
}

fn whole(text: &str) -> System {
    good(&[("whole.eml", text)]).system
}

/// The name of its file from the folder, the bytes and the words of each fault.
fn told(files: &[(&str, &str)]) -> Vec<(String, String, String)> {
    let folder = folder(files);
    let faults = read(folder.path(), files[0].0).expect_err("a fault");
    let of = |fault: Fault| {
        let at = fault.location.expect("a location");
        let name = at.source.name.replace(&format!("{}/", folder.path().display()), "");
        assert!(fault.help.is_some(), "{}", fault.message);
        let words = format!("{} {}", fault.message, at.label).replace(&format!("{}/", folder.path().display()), "");
        (name, at.source.text[at.start..at.start + at.length].to_owned(), words)
    };
    faults.into_iter().map(of).collect()
}

const MAIN: &str = r#"<eml name="m" time_unit="min">
  <variable id="x" initial="1" rate="-k*hill(x, K, 2) + f(x)"/>
  <include document="parts/decay.eml"/>
  <define id="all">x + y</define>
</eml>"#;
const DECAY: &str = r#"<eml name="d" time_unit="min"><include document="constants.eml"/><include document="../K.eml"/>
  <function id="f" args="z">z*k</function><variable id="y" initial="K" rate="-k*y"/>
  <event id="e" when="y lt 0.5"><set id="y">1</set></event><solver scheme="rk4" inner_step="0.1"/></eml>"#;
const CONSTANTS: &str =
    r#"<eml name="c" time_unit="min"><parameter id="k" value="0.1"/><include document="../K.eml"/></eml>"#;
const K: &str = r#"<eml name="K" time_unit="min"><parameter id="K" value="2"/></eml>"#;

#[test]
fn what_is_included_stands_as_if_it_were_written_there() {
    let files = [("m.eml", MAIN), ("parts/decay.eml", DECAY), ("parts/constants.eml", CONSTANTS), ("K.eml", K)];
    let document = good(&files);
    let wanted = whole(
        r#"<eml name="m" time_unit="min"><variable id="x" initial="1" rate="-k*hill(x, K, 2) + f(x)"/>
        <parameter id="k" value="0.1"/><parameter id="K" value="2"/><function id="f" args="z">z*k</function>
        <variable id="y" initial="K" rate="-k*y"/><event id="e" when="y lt 0.5"><set id="y">1</set></event>
        <define id="all">x + y</define></eml>"#,
    );
    assert_eq!(document.system, wanted, "K is there once, though two documents include it");
    assert_eq!(document.solver, eml::SolverChoice::default(), "how it is solved says the document that includes");
    assert!(document.locations[2].source.name.ends_with("K.eml"), "{:?}", document.locations[2]);
    // Written as SBML it is one model, and reads as that of one document does.
    let text = sbml::write(&document).expect("SBML").text;
    let alone = good(&[("whole.eml", &eml::write(&document, "").text)]);
    assert_eq!(alone.system, document.system);
    assert_eq!(text, sbml::write(&alone).expect("SBML").text);
}

#[test]
fn a_prefix_lets_a_document_be_there_twice_with_other_values() {
    let part = r#"<eml name="part"><input id="S" default="1"/><parameter id="n" value="2"/><parameter id="k" value="n/2"/>
        <function id="g" args="x, k">k*x + n + outer</function>
        <table id="t" value="k" file="t.csv"/>
        <repeat index="i" count="2"><variable id="X[i]" initial="k"/></repeat>
        <repeat index="i" count="1"><reaction id="go[i]" equation="2 X[i] -> X[i+1] + $S" rate="t(time)*g(X[i], 3)"/></repeat>
        <define id="sum_of">sum(j, 1, 2, X[j])</define>
        <event id="e" when="X_1 lt 0.1"><set id="X_1">k</set></event>
        <link id="l" from="field[S].value" to="system.S" transfer="value*k"/></eml>"#;
    let main = r#"<eml name="m"><parameter id="outer" value="7"/>
        <include document="sub/part.eml" prefix="a"/>
        <include document="sub/part.eml" prefix="b"><set id="n">outer</set><set id="X_2">0.5</set></include></eml>"#;
    let document = good(&[("m.eml", main), ("sub/part.eml", part), ("sub/t.csv", "time,k\n0,1\n2,3\n")]);
    let copy = |p: &str, n: &str, start: &str| {
        format!(
            r#"<input id="{p}_S" default="1"/><parameter id="{p}_n" value="{n}"/><parameter id="{p}_k" value="{p}_n/2"/>
            <function id="{p}_g" args="x, k">k*x + {p}_n + outer</function><table id="{p}_t">0 1
            2 3</table><variable id="{p}_X_1" initial="{p}_k"/><variable id="{p}_X_2" initial="{start}"/>
            <reaction id="{p}_go_1" equation="2 {p}_X_1 -> {p}_X_2 + ${p}_S" rate="{p}_t(time)*{p}_g({p}_X_1, 3)"/>
            <define id="{p}_sum_of">({p}_X_1) + ({p}_X_2)</define>
            <event id="{p}_e" when="{p}_X_1 lt 0.1"><set id="{p}_X_1">{p}_k</set></event>
            <link id="{p}_l" from="field[S].value" to="system.{p}_S" transfer="value*{p}_k"/>"#
        )
    };
    let (a, b) = (copy("a", "2", "a_k"), copy("b", "outer", "0.5"));
    let wanted = good(&[("w.eml", &format!(r#"<eml name="m"><parameter id="outer" value="7"/>{a}{b}</eml>"#))]);
    assert_eq!(document.system, wanted.system);
    let links = |document: &eml::Document| {
        let of = |link: &eml::LinkDescription| {
            (link.id.clone(), link.from.text.clone(), link.to.text.clone(), link.transfer.clone())
        };
        document.links.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(links(&document), links(&wanted));
}

#[test]
fn faults_are_told_where_they_stand() {
    let main = "<eml name=\"m\">\n<parameter id=\"k\" value=\"1\"/>\n<include document=\"a.eml\"/>\n<define id=\"d\">wrong</define>\n</eml>";
    let a = "<eml name=\"a\">\n\n<variable id=\"y\" initial=\"1\" rate=\"-missing*y\"/><parameter id=\"k\" value=\"2\"/>\n<include document=\"b.eml\"/></eml>";
    let b = "<eml name=\"b\"><table id=\"t\" file=\"t.csv\"/><event id=\"e\" every=\"-1\"><set id=\"nothing\">1</set></event></eml>";
    let found = told(&[("m.eml", main), ("a.eml", a), ("b.eml", b), ("t.csv", "t,v\n0,1\n1,two\n")]);
    let short: Vec<(&str, &str)> = found.iter().map(|(file, at, _)| (file.as_str(), at.as_str())).collect();
    let wanted = [("m.eml", "wrong"), ("a.eml", "missing"), ("a.eml", "k"), ("b.eml", "nothing"), ("t.csv", "two")];
    assert_eq!(short, wanted);
    assert!(found[2].2.ends_with("already declared in line 2 of m.eml"), "{}", found[2].2);
    // A fault of what is there twice is told once.
    let twice =
        "<eml name=\"m\"><include document=\"a.eml\" prefix=\"a\"/><include document=\"a.eml\" prefix=\"b\"/></eml>";
    assert_eq!(told(&[("m.eml", twice), ("a.eml", "<eml name=\"a\"><define id=\"d\">wrong</define></eml>")]).len(), 1);
    // A fault that is seen once all values are known, and one of the text itself.
    let a = "<eml name=\"a\"><event id=\"e\" every=\"-k\"><set id=\"k\">1</set></event></eml>";
    let found = told(&[("m.eml", &main.replace("wrong", "1")), ("a.eml", a)]);
    assert_eq!((found[0].0.as_str(), found[0].1.as_str()), ("a.eml", "-k"));
    let found = told(&[("m.eml", &main.replace("wrong", "1")), ("a.eml", "<eml name=\"a\"><variable></eml>")]);
    assert_eq!((found.len(), found[0].0.as_str()), (1, "a.eml"));
    let found = told(&[("m.eml", &main.replace("wrong", "1")), ("a.eml", "<sbml/>")]);
    assert_eq!((found[0].0.as_str(), found[0].1.as_str()), ("a.eml", "sbml"));
}

#[test]
fn what_cannot_be_included_is_told() {
    let one = |main: &str, others: &[(&str, &str)]| {
        let main =
            format!("<eml name=\"m\" time_unit=\"min\" level=\"cell\"><parameter id=\"k\" value=\"1\"/>{main}</eml>");
        let found = told(&[&[("m.eml", main.as_str())], others].concat());
        assert_eq!(found.len(), 1, "{found:?}");
        found[0].clone()
    };
    let include = r#"<include document="a.eml"/>"#;
    let (file, at, words) = one(include, &[]);
    assert!((file, at) == ("m.eml".into(), "a.eml".into()) && words.contains("cannot be read"), "{words}");
    let (file, at, words) =
        one(include, &[("a.eml", r#"<eml name="a" time_unit="min"><include document="./m.eml"/></eml>"#)]);
    assert!((file, at) == ("a.eml".into(), "./m.eml".into()) && words.contains("m.eml → a.eml → m.eml"), "{words}");
    let (file, at, words) = one(include, &[("a.eml", r#"<eml name="a"><parameter id="b" value="1"/></eml>"#)]);
    assert!((file, at) == ("a.eml".into(), "eml".into()) && words.contains("time in s, and the one"), "{words}");
    let (file, at, words) = one(include, &[("a.eml", r#"<eml name="a" time_unit="min" level="scene"/>"#)]);
    assert!((file, at) == ("a.eml".into(), "scene".into()) && words.contains("of level scene"), "{words}");
    assert_eq!(one(r#"<include document="a.eml" prefix="2"/>"#, &[]).1, "2");
    let part =
        ("a.eml", r#"<eml name="a" time_unit="min"><parameter id="speed" value="1"/><define id="d">1</define></eml>"#);
    for (id, words) in [("sped", "declares no `sped`"), ("d", "is a <define>, which has no value")] {
        let main = format!(r#"<include document="a.eml" prefix="p"><set id="{id}">2</set></include>"#);
        let found = one(&main, &[part]);
        assert!(found.1 == id && found.2.contains(words), "{found:?}");
    }
    // The same again with another value declares everything twice.
    let again = format!(r#"{include}<include document="a.eml"><set id="speed">2</set></include>"#);
    let main = format!("<eml name=\"m\" time_unit=\"min\">{again}</eml>");
    let found = told(&[("m.eml", &main), part]);
    assert!(found.len() == 2 && found[0].2.contains("already declared in line 1 of a.eml"), "{found:?}");
}

#[test]
fn there_are_limits() {
    let chain: Vec<(String, String)> = (0..20)
        .map(|n| (format!("{n}.eml"), format!(r#"<eml name="n"><include document="{}.eml"/></eml>"#, n + 1)))
        .collect();
    let files: Vec<(&str, &str)> = chain.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let found = told(&files);
    assert!(found.len() == 1 && found[0].0 == "16.eml" && found[0].2.contains("more than 16 documents in a row"));
    // Each twice as many as the one before.
    let twice = |next: &str| {
        format!(r#"<eml name="n"><include document="{next}" prefix="a"/><include document="{next}" prefix="b"/></eml>"#)
    };
    let files: Vec<(String, String)> =
        (0..12).map(|n| (format!("{n}.eml"), twice(&format!("{}.eml", n + 1)))).collect();
    let leaf = ("12.eml", r#"<eml name="n"><parameter id="k" value="1"/></eml>"#);
    let mut files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    files.push(leaf);
    assert!(told(&files).iter().all(|(_, _, words)| words.contains("more than 200 documents")));
}

#[test]
fn the_files_that_are_named_are_known_and_texts_can_stand_in_their_place() {
    let main = r#"<eml name="m"><include document="sub/a.eml" prefix="a"/><table id="t" file="t.csv"/><variable id="x" initial="1" rate="a_k + t(x) + a_t(x)"/></eml>"#;
    let part = r#"<eml name="a"><parameter id="k" value="1"/><table id="t" file="../u.csv"/></eml>"#;
    let files =
        folder(&[("m.eml", main), ("sub/a.eml", part), ("t.csv", "t,v\n0,1\n1,2\n"), ("u.csv", "t,v\n0,3\n1,4\n")]);
    let path = files.path().join("m.eml");
    let (text, beside) = (source(&path), Files::of_folder(path.parent()));
    let named = equations::named_files(text.clone(), beside);
    let relative = |path: &Path| path.strip_prefix(files.path()).expect("in the folder").display().to_string();
    let names: Vec<String> = named.iter().map(|file| relative(&file.path)).collect();
    assert_eq!(names, ["sub/a.eml", "sub/../u.csv", "t.csv"]);
    let before = read(files.path(), "m.eml").expect("good").system;
    let kept: BTreeMap<_, _> = named.into_iter().map(|file| (file.path, file.text.expect("a text"))).collect();
    // With what is kept the document means the same, whatever becomes of the files.
    for name in ["sub/a.eml", "t.csv", "u.csv"] {
        std::fs::remove_file(files.path().join(name)).expect("removed");
    }
    let again = equations::read_in(text, Files { kept, ..Files::of_folder(path.parent()) }).expect("good");
    assert_eq!(again.document.system, before);
    assert!(read(files.path(), "m.eml").is_err());
}
