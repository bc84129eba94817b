//! What is written as EML is read as the same system, and models from SBML keep their numbers.

use pseudopod::equations::program::initial_values;
use pseudopod::equations::tree::{QuantityId, Role, System};
use pseudopod::equations::{self, Read, eml};
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{SolveOptions, solve};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::shared::shared;

/// The files below a folder that end in one of some ways, in order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.extension().is_some_and(|end| end == ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// All models of the suite and of BioModels.
fn models() -> Vec<PathBuf> {
    let folders = ["sbml-suite/ode", "sbml-suite/events", "biomodels"];
    folders.iter().filter_map(|name| shared(name)).flat_map(|folder| files(&folder, "xml")).collect()
}

fn read_text(name: &str, text: String) -> Read {
    let source = Arc::new(Source { name: name.to_owned(), text });
    equations::read(source).unwrap_or_else(|error| panic!("{name}: {}", render(&error, Paint::Plain)))
}

fn read(path: &Path) -> Read {
    read_text(&path.display().to_string(), std::fs::read_to_string(path).expect("a text"))
}

/// The system that is read from what is written of another.
fn rewritten(name: &str, document: &eml::Document) -> System {
    read_text(name, eml::write(document, "").text).document.system
}

/// Rates of what changes at a time and at given values of variables; of the quantities of `like`, which stand in the
/// same order.
fn rates(system: &System, like: &System, values: &[f64]) -> Vec<f64> {
    let order = system.definition_order().expect("no circle");
    let mut values = values.to_vec();
    for number in order {
        if let Role::Defined { rule } = &system.quantities[number as usize].role {
            values[number as usize] = rule.evaluate(0.7, &|other: QuantityId| values[other as usize]);
        }
    }
    let value = |number: QuantityId| values[number as usize];
    like.variables()
        .iter()
        .map(|&number| match &system.quantities[number as usize].role {
            Role::Variable { rate } => rate.evaluate(0.7, &value),
            _ => panic!("a variable is none any more"),
        })
        .chain(values.iter().copied())
        .collect()
}

/// Whether numbers agree to the round-off of sums in another order.
fn near(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}

#[test]
fn every_document_that_ships_reads_back_the_same() {
    let documents = files(Path::new("eml"), "eml");
    assert!(documents.len() >= 8);
    for path in documents {
        let document = read(&path).document;
        let text = eml::write(&document, "a comment -- with two dashes -").text;
        let again = read_text(&format!("{} again", path.display()), text).document;
        assert_eq!(again.system, document.system, "{}", path.display());
        assert_eq!((again.level, &again.time_unit), (document.level, &document.time_unit), "{}", path.display());
        assert_eq!(again.solver, document.solver, "{}", path.display());
        assert_eq!(again.fields.len(), document.fields.len());
        for (a, b) in again.fields.iter().zip(&document.fields) {
            assert_eq!((&a.diffusion, &a.decay, &a.initial), (&b.diffusion, &b.decay, &b.initial));
            assert_eq!((a.range, &a.walls), (b.range, &b.walls));
        }
        let grid = |document: &eml::Document| {
            document.grid.as_ref().map(|g| (g.dimension, g.spacing, g.origin, g.size, g.unit.clone()))
        };
        assert_eq!(grid(&again), grid(&document));
        let link = |link: &eml::LinkDescription| {
            (link.id.clone(), link.from.text.clone(), link.to.text.clone(), link.transfer.clone(), link.gain)
        };
        assert_eq!(
            again.links.iter().map(link).collect::<Vec<_>>(),
            document.links.iter().map(link).collect::<Vec<_>>()
        );
    }
}

#[test]
fn events_and_awkward_texts_read_back_the_same() {
    let text = r#"<eml name="a &amp; b &lt; &quot;c&quot;">
        <parameter id="k" value="2^-3 + 1e-7" name="&lt;k&gt;"/>
        <variable id="x" initial="2*k" rate="piecewise(-(-2), x lt 1 and not (k ge 2), -x^2 - -3, x == 1, x/(2/x))"/>
        <define id="sum">min(x, k, rem(x, 2)) - (x - k) + max(infinity, 1)</define>
        <input id="in" default="k"/>
        <event when="x lt 1" delay="k" priority="x" values_from="execution" persistent="false" at_start="wait">
          <set id="x">x + sum</set></event>
        <event id="second" when="x &gt;= 3 or time gt 4"><set id="x">0</set></event>
      </eml>"#;
    let document = read_text("text", text.to_owned()).document;
    assert_eq!(rewritten("text again", &document), document.system);
}

#[test]
fn noise_reads_back_the_same() {
    let membrane = r#"<eml name="m" level="membrane"><parameter id="q" value="2"/>
        <variable id="a" initial="1" diffusion="0.1" rate="-a" noise="sqrt(2*q)*a"/>
        <variable id="c" level="cell" initial="1" rate="0" noise="piecewise(0, q lt 1, 2)"/><solver noise_step="0.05"/></eml>"#;
    let field = r#"<eml name="f"><grid dimension="2" spacing="1"/>
        <field id="c" range="free" initial="0" noise="0.1*x"/></eml>"#;
    for text in [membrane, field] {
        let document = read_text("text", text.to_owned()).document;
        let again = read_text("text again", eml::write(&document, "").text).document;
        let noise = |document: &eml::Document| -> Vec<_> {
            document.noise.iter().map(|noise| (noise.quantity, noise.strength.clone())).collect()
        };
        assert!(!noise(&document).is_empty());
        assert_eq!((noise(&again), again.solver), (noise(&document), document.solver));
    }
}

#[test]
fn what_stands_beside_fields_reads_back_the_same() {
    let text = r#"<eml name="f"><grid dimension="2" spacing="1"/>
        <field id="c" initial="1"><reaction>s - c</reaction></field><variable id="s" initial="2" rate="m - s"/>
        <mean id="m">c^2</mean><integral id="q">c*s</integral>
        <event id="dose" when="q gt 3"><set id="c">c + x</set><set id="s">1</set></event></eml>"#;
    let document = read_text("text", text.to_owned()).document;
    let again = read_text("text again", eml::write(&document, "").text).document;
    assert_eq!(again.system, document.system);
    let totals = |document: &eml::Document| -> Vec<_> {
        let scene = document.scene.as_ref().expect("something stands beside the field");
        scene.totals.iter().map(|total| (total.quantity, total.taken, total.integrand.clone())).collect()
    };
    assert_eq!(totals(&again), totals(&document));
}

#[test]
fn units_of_numbers_cost_the_units_of_the_text_and_not_its_meaning() {
    let text = r#"<eml name="m"><variable id="c" unit="uM" initial="1" rate="-0.1 [1/s]*c"/></eml>"#;
    let document = read_text("text", text.to_owned()).document;
    let written = eml::write(&document, "");
    assert!(!written.text.contains("unit=") && written.notices.len() == 1, "{written:?}");
    let mut expected = document.system;
    expected.quantities[0].unit.clear();
    assert_eq!(read_text("again", written.text).document.system, expected);
}

#[test]
fn words_of_the_language_and_foreign_names_get_new_ones() {
    let mut document =
        read_text("text", r#"<eml name="m"><variable id="a" initial="1" rate="-a"/></eml>"#.into()).document;
    let a = document.system.quantities[0].clone();
    let ids = ["lt", "lt_", "[S]", "S", "J.k", "J_k", "rateOf(x)"];
    document
        .system
        .quantities
        .extend(ids.map(|id| pseudopod::equations::tree::Quantity { id: id.into(), ..a.clone() }));
    let written = eml::write(&document, "");
    let system = read_text("again", written.text).document.system;
    let found: Vec<&str> = system.quantities.iter().map(|quantity| quantity.id.as_str()).collect();
    assert_eq!(found, ["a", "lt__", "lt_", "S_concentration", "S", "J_k_", "J_k", "rateOf_x"]);
    assert_eq!(written.notices[0], "`lt` is a word of the language and is called `lt__`");
}

#[test]
fn every_model_from_sbml_keeps_its_rates_at_the_start() {
    for path in models() {
        let old = read(&path).document;
        let new = rewritten(&format!("{} as EML", path.display()), &old);
        let start = initial_values(&old.system, 0.0).expect("no circle");
        let (a, b) = (rates(&old.system, &old.system, &start), rates(&new, &old.system, &start));
        for (index, (a, b)) in a.iter().zip(&b).enumerate() {
            assert!(near(*a, *b), "{}: number {index} is {b} instead of {a}", path.display());
        }
        let again = initial_values(&new, 0.0).expect("no circle");
        for (quantity, (a, b)) in old.system.quantities.iter().zip(start.iter().zip(&again)) {
            // What has no value in SBML starts at 0 in EML, with a notice.
            assert!(near(*a, *b) || a.is_nan(), "{}: `{}` is {b} instead of {a}", path.display(), quantity.id);
        }
    }
}

#[test]
fn models_from_sbml_solve_to_the_same_numbers() {
    // Every fifth of the suite, all events, and the models of BioModels.
    let chosen = models().into_iter().enumerate().filter(|(number, path)| {
        let path = path.display().to_string();
        number % 5 == 0 || path.contains("/events/") || path.contains("/biomodels/")
    });
    for (_, path) in chosen {
        let old = read(&path).document.system;
        let new = rewritten(&format!("{} as EML", path.display()), &read(&path).document);
        let times: Vec<f64> = (0..=20).map(|point| f64::from(point) * 0.5).collect();
        let options = SolveOptions { relative: 1e-9, ..SolveOptions::default() };
        let [a, b] = [&old, &new].map(|system| {
            solve(system, 0.0, 10.0, &times, &options).unwrap_or_else(|trouble| panic!("{}: {trouble}", path.display()))
        });
        let largest = |number: usize| a.values.iter().map(|row| row[number].abs()).fold(0.0, f64::max);
        for number in 0..old.quantities.len() {
            for (x, y) in a.values.iter().zip(&b.values) {
                // A parameter that became a variable changes the steps, so the tolerance is that of the solver.
                let (x, y, most) = (x[number], y[number], 1e-7 * largest(number) + 1e-12);
                let same = x == y || x.is_nan() || (x - y).abs() <= most;
                assert!(same, "{}: `{}` is {y} instead of {x}", path.display(), old.quantities[number].id);
            }
        }
    }
}
