//! The EML documents that come with the program, and what is refused.

use pseudopod::equations::eml::{
    self, Document, Index, LARGEST_DOCUMENT, Level, LinkDescription, Profile, Root, Scheme, Wall,
};
use pseudopod::equations::tree::{Expr, Role, System};
use pseudopod::error::{Error, Paint, Source, render};
use pseudopod::xml::{self, Limits, Node};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::shared::shared;

fn read_text(text: impl Into<String>) -> Result<Document, Error> {
    eml::read(Arc::new(Source { name: "test.eml".into(), text: text.into() }))
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn shipped(name: &str) -> Document {
    let path = root().join("eml").join(format!("{name}.eml"));
    let text = std::fs::read_to_string(&path).expect("a document that comes with the program");
    read_text(text).unwrap_or_else(|error| panic!("{name}:\n{}", render(&error, Paint::Plain)))
}

fn shipped_names() -> Vec<String> {
    let entries = std::fs::read_dir(root().join("eml")).expect("the folder eml");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let documents = paths.filter(|path| path.extension().is_some_and(|end| end == "eml"));
    documents.map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned()).collect()
}

#[test]
fn every_document_that_comes_with_the_program_is_without_fault_and_tells_its_origin() {
    let names = shipped_names();
    assert!(names.len() >= 8, "{names:?}");
    for name in names {
        let document = shipped(&name);
        assert_eq!(document.name, name, "a document is named as its file");
        let text = std::fs::read_to_string(root().join(format!("eml/{name}.eml"))).expect("a text");
        assert!(text.contains("<!-- Origin: "), "{name} tells its origin");
        document.system.definition_order().expect("no circle");
    }
}

#[test]
fn the_decay_steers_the_fourth_atom() {
    let decay = shipped("decay");
    assert_eq!(
        (decay.level, decay.solver.scheme, decay.solver.inner_step),
        (Level::Cell, Some(Scheme::Rk4), Some(0.01))
    );
    let system = &decay.system;
    let number = system.find("U").expect("U");
    let Role::Variable { rate } = &system.quantities[number as usize].role else { panic!("U is a variable") };
    assert_eq!(rate.evaluate(0.0, &|other| if other == number { 2.0 } else { 0.1 }), -0.2);
    let link = &decay.links[0];
    assert_eq!((&link.from.root, &link.to.root, link.gain), (&Root::System(number), &Root::Cell(None), 1.0));
    let steps: Vec<_> = link.to.path.iter().map(|step| (step.name.as_str(), step.index.clone())).collect();
    assert_eq!(steps, [("atom", Some(Index::Number(4))), ("y", None)]);
    assert_eq!(link.transfer.evaluate(0.0, &|id| if id == LinkDescription::VALUE { 5.0 } else { 0.0 }), 15.0);
}

#[test]
fn the_attractant_is_a_field_with_its_walls() {
    let document = shipped("attractant");
    assert_eq!(document.level, Level::Field);
    let grid = document.grid.expect("a grid");
    assert_eq!((grid.dimension, grid.spacing, grid.micrometres), (2, 5.0, 1.0));
    let field = &document.fields[0];
    assert_eq!(field.initial, Profile::Expression(Expr::Number(0.0)));
    assert!(
        matches!(field.walls[0], Wall::Fixed(Expr::Quantity(_))) && field.walls[1..].iter().all(|w| *w == Wall::NoFlux)
    );
    assert!(matches!(field.diffusion, Expr::Quantity(_)));
    let names: Vec<&str> = document.system.quantities.iter().map(|quantity| quantity.id.as_str()).collect();
    assert_eq!(names, ["D", "k", "source", "attractant", "x", "y", "z"], "the position is given by inputs");
}

/// Values of all quantities for values of the variables.
fn all_values(system: &System, order: &[u32], time: f64, state: &[f64]) -> Vec<f64> {
    let start = |number: usize| system.quantities[number].initial.evaluate(0.0, &|_| f64::NAN);
    let mut values: Vec<f64> = (0..system.quantities.len()).map(start).collect();
    for (number, value) in system.variables().into_iter().zip(state) {
        values[number as usize] = *value;
    }
    for number in order {
        let Role::Defined { rule } = &system.quantities[*number as usize].role else { continue };
        values[*number as usize] = rule.evaluate(time, &|other| values[other as usize]);
    }
    values
}

fn rates(system: &System, order: &[u32], time: f64, state: &[f64]) -> Vec<f64> {
    let values = all_values(system, order, time, state);
    let rate = |number: u32| match &system.quantities[number as usize].role {
        Role::Variable { rate } => rate.evaluate(time, &|other| values[other as usize]),
        _ => 0.0,
    };
    system.variables().into_iter().map(rate).collect()
}

/// One step of the classical Runge–Kutta method.
fn step(system: &System, order: &[u32], time: f64, dt: f64, state: &[f64]) -> Vec<f64> {
    let ahead = |k: &[f64], part: f64| -> Vec<f64> { state.iter().zip(k).map(|(y, k)| y + part * dt * k).collect() };
    let k1 = rates(system, order, time, state);
    let k2 = rates(system, order, time + dt / 2.0, &ahead(&k1, 0.5));
    let k3 = rates(system, order, time + dt / 2.0, &ahead(&k2, 0.5));
    let k4 = rates(system, order, time + dt, &ahead(&k3, 1.0));
    (0..state.len()).map(|i| state[i] + dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])).collect()
}

#[test]
fn martiel_and_goldbeter_follow_the_reference() {
    let Some(path) = shared("martiel-goldbeter/reference.json") else { return };
    let text = std::fs::read_to_string(path).expect("a file");
    let reference: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let expected = |name: &str, at: usize| reference[name][at].as_f64().expect("a number");
    let document = shipped("martiel_goldbeter");
    let order = document.system.definition_order().expect("no circle");
    let mut state = vec![0.8, 0.5, 0.1];
    let steps = 2000;
    for minute in 1..=10 {
        for part in 0..steps {
            let time = (minute - 1) as f64 + part as f64 / steps as f64;
            state = step(&document.system, &order, time, 1.0 / steps as f64, &state);
        }
        // The reference is a run at a finite tolerance; it says 6 digits or so.
        let error = (state[0] - expected("rho", minute)).abs();
        assert!(error < 1e-5, "rho at {minute} min: {} and not {}", state[0], expected("rho", minute));
    }
}

#[test]
fn hostile_xml_is_refused_before_a_tree_is_built() {
    let refused = |text: String, part: &str| {
        let error = read_text(text).expect_err(part);
        let message = render(&error, Paint::Plain);
        assert!(message.contains(part) && message.len() < 40_000, "{part}: {}", &message[..message.len().min(2000)]);
    };
    // The length is looked at before anything else, so a gigabyte costs no more than this.
    refused("a".repeat(LARGEST_DOCUMENT + 1), "bytes; at most");
    let bomb = "<!DOCTYPE b [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY c \"&a;&a;&a;\">]><eml name=\"&c;\"/>";
    refused(bomb.into(), "document type and entities");
    refused("<!DOCTYPE e SYSTEM \"file:///etc/passwd\"><eml name=\"e\"/>".into(), "document type and entities");
    refused(format!("{}{}", "<event>".repeat(100_000), "</event>".repeat(100_000)), "deep");
    refused(format!("<eml name=\"m\">{}</eml>", "<set/>".repeat(200_000)), "");
    refused(format!("<eml name=\"m\"><define id=\"a\">{}</define></eml>", "(".repeat(50_000)), "levels");
    refused(format!("<eml name=\"m\"><define id=\"a\">{}</define></eml>", "1+".repeat(500_000)), "bytes; at most");
    let wide = "x + ".repeat(20_000);
    refused(format!("<eml name=\"m\"><define id=\"d\">sum(j, 1, 19999, {wide} 1)</define></eml>"), "`sum` cannot go");
    let text = format!("<parameter id=\"p[i]\" value=\"{wide}\"/>");
    refused(format!("<eml name=\"m\"><repeat index=\"i\" count=\"19999\">{text}</repeat></eml>"), "are repeated");
    let chain: String = (1..20_000).map(|i| format!("<define id=\"d{i}\">d{}</define>", i - 1)).collect();
    refused(format!("<eml name=\"m\"><define id=\"d0\">time</define>{chain}</eml>"), "in a row");
}

#[test]
fn any_bytes_of_a_good_document_may_be_lost_without_a_panic() {
    for name in shipped_names() {
        let text = std::fs::read_to_string(root().join(format!("eml/{name}.eml"))).expect("a text");
        let cuts = text.char_indices().map(|(at, _)| at);
        for at in cuts.step_by(7) {
            let end =
                (at + 5..).find(|end| text.is_char_boundary((*end).min(text.len()))).expect("an end").min(text.len());
            let _ = read_text(format!("{}{}", &text[..at], &text[end..])).map_err(|error| render(&error, Paint::Plain));
            if at % 5 == 0 {
                let _ = read_text(&text[..at]);
            }
        }
    }
}

#[test]
fn a_text_with_escapes_and_comments_keeps_its_locations() {
    let text = "<eml name=\"e\"><variable id=\"U\" initial=\"1\"/>\n<equation of=\"U\">piecewise(1, U &lt; 2, 2, <!-- why --> Uu\
                <![CDATA[ < 3 ]]>, 0)</equation></eml>";
    let Err(Error::Input(faults)) = read_text(text) else { panic!("Uu is unknown") };
    let location = faults[0].location.as_ref().expect("a place");
    assert_eq!(&text[location.start..location.start + location.length], "Uu");
}

/// Names of elements and, of each, attributes, as the schema has them: `NAME attribute attribute`.
fn schema_words() -> Vec<String> {
    let text = std::fs::read_to_string(root().join("eml/eml.xsd")).expect("the schema");
    let limits = Limits { bytes: 1 << 20, depth: 100, nodes: 10_000, attributes: 100 };
    let tree = xml::Document::read(&text, limits).expect("XML");
    let mut found = Vec::new();
    let is_element =
        |node: &Node| node.name() == "element" && node.namespace() == Some("http://www.w3.org/2001/XMLSchema");
    for element in tree.root().descendants().filter(is_element) {
        let Some(name) = element.attribute("name") else { continue };
        let own = |node: &Node| {
            let mut around = std::iter::successors(node.parent(), |up| up.parent());
            around.find(|up| up.name() == "element").is_some_and(|up| up.index() == element.index())
        };
        let attributes = element.descendants().filter(|node| node.name() == "attribute" && own(node));
        let mut words: Vec<String> = attributes
            .map(|node| {
                let mark = if node.attribute("use") == Some("required") { "!" } else { "" };
                format!("{}{mark}", node.attribute("name").expect("a name"))
            })
            .collect();
        words.sort();
        let held = element.descendants().filter(|node| node.index() != element.index() && is_element(node));
        let mut children: Vec<&str> =
            held.filter_map(|node| node.attribute("ref").or_else(|| node.attribute("name"))).collect();
        children.sort_unstable();
        found.push(format!("{name}: {} / {}", words.join(" "), children.join(" ")));
    }
    found.sort();
    found
}

#[test]
fn the_schema_has_the_elements_and_attributes_of_the_reader() {
    let mut known: Vec<String> = eml::ELEMENTS
        .iter()
        .map(|kind| {
            let required = kind.required.iter().map(|(name, _)| format!("{name}!"));
            let mut words: Vec<String> =
                required.chain(kind.optional.iter().map(|(name, _)| (*name).to_owned())).collect();
            words.sort();
            let mut children = kind.children.to_vec();
            children.sort_unstable();
            format!("{}: {} / {}", kind.name, words.join(" "), children.join(" "))
        })
        .collect();
    known.sort();
    assert_eq!(schema_words(), known);
}

#[test]
fn the_book_has_every_element_attribute_and_function() {
    let book = std::fs::read_to_string(root().join("docs/src/eml.md")).expect("the chapter");
    for kind in eml::ELEMENTS {
        assert!(book.contains(&format!("<{}", kind.name)), "<{}> is in the chapter", kind.name);
        for name in kind.attributes() {
            assert!(book.contains(&format!("`{name}`")), "`{name}` of <{}> is in the chapter", kind.name);
        }
    }
    for name in pseudopod::equations::expression::function_names() {
        assert!(book.contains(&format!("`{name}(")), "{name} is in the chapter");
    }
    let summary = std::fs::read_to_string(Path::new(&root()).join("docs/src/SUMMARY.md")).expect("the contents");
    assert!(summary.contains("(eml.md)"));
}

#[test]
fn the_documents_in_the_chapter_are_good() {
    let book = std::fs::read_to_string(root().join("docs/src/eml.md")).expect("the chapter");
    let blocks = book.split("```xml\n").skip(1).map(|block| block.split("```").next().unwrap_or_default());
    let documents: Vec<&str> = blocks.filter(|block| block.starts_with("<eml")).collect();
    assert!(documents.len() >= 5, "documents are missing: {}", documents.len());
    for document in documents {
        read_text(document).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)));
    }
}

#[test]
fn functions_without_arguments_are_told_as_miscounted_and_no_number_of_them_ends_in_a_panic() {
    let names = pseudopod::equations::expression::function_names();
    for (name, count) in names.iter().flat_map(|name| (0..5).map(move |count| (name, count))) {
        let call = format!("{name}({})", vec!["a"; count].join(", "));
        let text = format!(
            r#"<eml name="d" time_unit="s"><parameter id="a" value="1" unit="s"/><define id="d">{call}</define><variable id="x" initial="{call}" unit="s" rate="{call}*1 [1/s]"/></eml>"#
        );
        // More arguments may be right, or be told for another reason, their units.
        let told = read_text(text).err().map_or_else(String::new, |error| render(&error, Paint::Plain));
        assert!(count > 0 || told.contains(&format!("`{name}` cannot take no argument")), "{told}");
    }
}
