//! Every message about bad SBML is kept beside the text that causes it.

use pseudopod::equations::sbml;
use pseudopod::error::{Error, Paint, Source, render};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

fn read(name: &str, text: String) -> Result<sbml::Model, Error> {
    sbml::read(&Arc::new(Source { name: name.to_owned(), text }))
}

fn texts() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/messages/sbml");
    let paths = std::fs::read_dir(folder).expect("the folder of bad models").map(|entry| entry.expect("a file").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "xml")).collect();
    paths.sort();
    assert!(paths.len() >= 20, "bad models are missing: {paths:?}");
    paths
}

#[test]
fn every_bad_model_gets_the_message_beside_it() {
    let mut differences = Vec::new();
    for path in texts() {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        match read(&name, std::fs::read_to_string(&path).expect("a text")) {
            Ok(_) => differences.push(format!("{name} is taken for a good model")),
            Err(error) => {
                assert_eq!(error.exit_code(), 2, "bad input ends with 2");
                let (message, kept) = (render(&error, Paint::Plain), path.with_extension("txt"));
                if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
                    std::fs::write(&kept, message).expect("a text is written");
                } else if message != std::fs::read_to_string(&kept).unwrap_or_default() {
                    differences.push(format!("{name}:\n{message}"));
                }
            }
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}

#[test]
fn every_fault_of_a_model_has_a_location_and_says_what_to_do() {
    for path in texts() {
        let Err(Error::Input(faults)) = read("model", std::fs::read_to_string(&path).expect("a text")) else {
            continue;
        };
        for fault in faults {
            let location = fault.location.unwrap_or_else(|| panic!("{}: {}", path.display(), fault.message));
            assert!(
                location.source.text.get(location.start..location.start + location.length).is_some(),
                "inside the text"
            );
            assert!(fault.help.is_some(), "{}: {} says what to do", path.display(), fault.message);
        }
    }
}

const HEAD: &str = r#"<sbml xmlns="http://www.sbml.org/sbml/level3/version2/core" level="3" version="2"><model>"#;

/// A model of one rate rule with a formula.
fn with_formula(functions: &str, formula: &str) -> String {
    let parameter = r#"<listOfParameters><parameter id="x" value="1" constant="false"/></listOfParameters>"#;
    let math = format!(r#"<math xmlns="http://www.w3.org/1998/Math/MathML">{formula}</math>"#);
    let rule = format!(r#"<listOfRules><rateRule variable="x">{math}</rateRule></listOfRules>"#);
    format!("{HEAD}{functions}{parameter}{rule}</model></sbml>")
}

/// A chain of functions each of which calls the one before it twice: 2^60 nodes when expanded.
fn doubling() -> String {
    let function = |number: usize| {
        let call = match number {
            0 => "<ci> x </ci>".to_owned(),
            _ => format!("<apply><ci> f{} </ci><ci> x </ci></apply>", number - 1),
        };
        format!(
            r#"<functionDefinition id="f{number}"><math xmlns="http://www.w3.org/1998/Math/MathML"><lambda>
            <bvar><ci> x </ci></bvar><apply><plus/>{call}{call}</apply></lambda></math></functionDefinition>"#
        )
    };
    let all: String = (0..60).map(function).collect();
    let list = format!("<listOfFunctionDefinitions>{all}</listOfFunctionDefinitions>");
    with_formula(&list, "<apply><ci> f59 </ci><ci> x </ci></apply>")
}

/// Chains of comparisons within each other, each of which uses its middle operand twice.
fn nested_chains() -> String {
    let open = "<apply><lt/><cn> 0 </cn>".repeat(200);
    let close = "<cn> 1 </cn></apply>".repeat(200);
    with_formula("", &format!("{open}<ci> x </ci>{close}"))
}

#[test]
fn hostile_texts_are_refused_at_once() {
    let many = (0..200_000).map(|number| format!(" a{number}=\"\"")).collect::<String>();
    let texts = [
        ("deep", format!("{HEAD}{}", "<a>".repeat(1_000_000))),
        ("closed and deep", format!("{}{}", "<a>".repeat(100_000), "</a>".repeat(100_000))),
        ("many attributes", format!("<sbml{many}/>")),
        ("large", format!("{HEAD}<notes>{}</notes></model></sbml>", "x".repeat(80 << 20))),
        ("doubling functions", doubling()),
        ("nested chains", nested_chains()),
        ("no end", HEAD[..20].to_owned()),
        ("empty", String::new()),
        ("bytes", "\u{0}\u{1}\u{fffd}".to_owned()),
    ];
    for (name, text) in texts {
        let begin = Instant::now();
        let error = read(name, text).expect_err(name);
        assert_eq!(error.exit_code(), 2, "{name}");
        assert!(begin.elapsed() < Duration::from_secs(5), "{name} took {:?}", begin.elapsed());
    }
}

#[test]
fn a_sum_of_many_terms_is_not_deep() {
    let text = with_formula("", &format!("<apply><plus/>{}</apply>", "<ci> x </ci>".repeat(100_000)));
    let model = read("long sum", text).expect("a good model");
    let pseudopod::equations::tree::Role::Variable { rate } = &model.system.quantities[0].role else {
        panic!("a rate")
    };
    assert_eq!(rate.evaluate(0.0, &|_| 0.5), 50_000.0);
}
