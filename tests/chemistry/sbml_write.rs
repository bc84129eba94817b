//! What is written as SBML is read as the same system: models of the SBML test suite go through EML and back.

use crate::every_function::{POINTS, functions, system};
use crate::sbml_suite::{Case, Solved, all_cases, suite};
use pseudopod::equations::tree::{Expr, Participant, Role, System};
use pseudopod::equations::{self, Read, eml, sbml};
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{SolveOptions, solve};
use std::path::Path;
use std::sync::Arc;

fn read(name: &str, text: String) -> Result<Read, String> {
    let source = Arc::new(Source { name: name.to_owned(), text });
    equations::read(source).map_err(|error| render(&error, Paint::Plain))
}

fn good(text: &str) -> Read {
    read("text", text.to_owned()).unwrap_or_else(|error| panic!("{error}"))
}

/// A document as SBML, and the system that is read of that.
fn written(document: &eml::Document) -> (eml::Written, System) {
    let text = sbml::write(document).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)));
    let again = good(&text.text).document.system;
    (text, again)
}

fn rule<'s>(system: &'s System, id: &str) -> &'s Expr {
    match &system.quantities[system.find(id).expect(id) as usize].role {
        Role::Defined { rule } => rule,
        Role::Variable { rate } => rate,
        other => panic!("{id}: {other:?}"),
    }
}

/// A model as EML.
fn as_eml(file: &Path) -> Result<eml::Document, String> {
    let first = read(&file.display().to_string(), std::fs::read_to_string(file).expect("a model"))?;
    Ok(read("EML", eml::write(&first.document, "").text)?.document)
}

/// The values of some quantities of a system at the times of a case.
fn values(case: &Case, system: &System, columns: &[u32]) -> Solved {
    let (times, last) = (&case.times, case.times.len() - 1);
    let options = SolveOptions { relative: 1e-8, absolute: 1e-6 * case.absolute.min(1e-6), ..SolveOptions::default() };
    let solution = solve(system, times[0], times[last], times, &options);
    let values = solution.map_err(|trouble| trouble.to_string())?.values;
    Ok(values.iter().map(|row| columns.iter().map(|column| row[*column as usize]).collect()).collect())
}

/// A case of the suite, solved as EML, which has the quantities in the same order.
fn converted(case: &Case) -> Solved {
    let document = as_eml(&case.file)?;
    let count = case.model.system.quantities.len();
    assert_eq!(document.system.quantities.len(), count);
    values(case, &document.system, &(0..count as u32).collect::<Vec<_>>())
}

/// A case of the suite, solved as SBML that was EML.
fn rewritten(case: &Case) -> Solved {
    let document = as_eml(&case.file)?;
    let written = sbml::write(&document).map_err(|error| render(&error, Paint::Plain))?;
    let again = read("SBML again", written.text)?.document;
    let found = document.system.quantities.iter().map(|quantity| again.system.find(&quantity.id));
    values(case, &again.system, &found.collect::<Option<Vec<u32>>>().ok_or("a quantity is lost")?)
}

#[test]
fn the_suites_time_courses_come_through_eml_and_back() {
    suite("ode", 40, &rewritten);
}

#[test]
fn the_suites_events_come_through_eml_and_back() {
    suite("events", 10, &rewritten);
}

/// `git clone https://github.com/sbmlteam/sbml-test-suite`, then
/// `PSEUDOPOD_SBML_SUITE=sbml-test-suite/cases/semantic cargo test --release --test chemistry sbml_write -- --ignored --nocapture`.
#[test]
#[ignore = "slow: reads and solves the cases of the SBML test suite, in the folder that PSEUDOPOD_SBML_SUITE names, as EML and again as SBML (5 min)"]
fn the_whole_suite_comes_through_eml_and_back() {
    let Some(folder) = std::env::var_os("PSEUDOPOD_SBML_SUITE") else {
        panic!("name the folder cases/semantic of the suite in the variable PSEUDOPOD_SBML_SUITE");
    };
    let (agree, bad) = all_cases(Path::new(&folder), &converted, &rewritten);
    println!("{agree} cases agree as EML, {} of them as SBML again", agree - bad.len());
    // EML has no starts that are infinite or no number.
    assert!(agree >= 1600, "{agree} cases agree as EML");
    assert!(bad.is_empty(), "{} cases differ as SBML again:\n{}", bad.len(), bad.join("\n"));
}

#[test]
fn every_function_keeps_its_values() {
    let mut document = good(r#"<eml name="m"><variable id="x" initial="1" rate="-x"/></eml>"#).document;
    let mut tried = 0;
    for function in functions() {
        document.system = system(function.clone(), Expr::Number(1.0));
        let (text, again) = written(&document);
        let made = rule(&again, "x");
        for (x, y) in POINTS.into_iter().chain([(0.0, 1.0), (2.5, 2.5), (7.0, -2.0), (-7.0, 2.0), (1.0, 0.0)]) {
            let old = function.evaluate(0.4, &|number| [x, y, 1.5, 0.25, x + y][number as usize]);
            let values = [("x", x), ("y", y), ("given", 1.5), ("k", 0.25), ("sum", x + y), ("vessel", 1.0)];
            let new = made.evaluate(0.4, &|number| {
                let id = &again.quantities[number as usize].id;
                values.iter().find(|(name, _)| name == id).unwrap_or_else(|| panic!("{id}")).1
            });
            let near = (old - new).abs() <= 1e-12 * old.abs();
            assert!(
                old == new || near || (old.is_nan() && new.is_nan()),
                "{new} instead of {old} at {x}, {y}: {}",
                text.text
            );
            tried += 1;
        }
    }
    assert!(tried > 500);
}

#[test]
fn conditions_are_numbers_and_numbers_conditions_where_eml_has_them() {
    let text = r#"<eml name="m"><variable id="x" initial="0" rate="1"/>
        <define id="steps">(x ge 1) - (x ge 2) + (x gt 3 and x)</define>
        <define id="chosen">piecewise(5, x - 1, 6, x lt 2, 7)</define>
        <define id="odd">(x lt 1) == (x lt 2) xor 1</define><define id="not_it">not x</define></eml>"#;
    let document = good(text).document;
    let again = written(&document).1;
    for x in [0.0, 0.5, 1.0, 1.5, 2.0, 3.5] {
        for id in ["steps", "chosen", "odd", "not_it"] {
            let [old, new] = [&document.system, &again].map(|system| {
                let variable = system.find("x");
                rule(system, id).evaluate(0.0, &|number| if Some(number) == variable { x } else { panic!("{number}") })
            });
            assert_eq!(old, new, "{id} at {x}");
        }
    }
    // Others take no number for a truth: each condition is a comparison or is put together from such.
    let text = written(&document).0.text;
    assert!(text.contains("<not/><apply><neq/><ci> x </ci><cn type=\"integer\"> 0 </cn></apply>"), "{text}");
}

#[test]
fn events_stay_what_they_are() {
    let text = r#"<eml name="m"><parameter id="k" value="2"/><variable id="x" initial="1" rate="0"/>
        <event when="time ge 3 and x lt k" delay="k" priority="x" values_from="execution" persistent="false" at_start="wait">
          <set id="x">x + k</set></event>
        <event id="second" when="x ge 3 or time gt 4"><set id="x">0</set></event></eml>"#;
    let document = good(text).document;
    let (text, again) = written(&document);
    assert_eq!(again, document.system, "{}", text.text);
    assert!(!text.text.contains("<species") && !text.text.contains("<compartment"), "a switch is a parameter");
}

#[test]
fn schedules_and_pulses_happen_at_their_times() {
    let text = r#"<eml name="m"><parameter id="tau" value="3"/><parameter id="k" value="2"/><parameter id="twice" value="2*k"/>
        <variable id="x" initial="0" rate="k*pulse(1, 0.5, tau) + 0*twice"/>
        <event every="tau" first="2" until="8"><set id="k">k + 1</set></event></eml>"#;
    let document = good(text).document;
    let (text, again) = written(&document);
    assert!(text.text.contains(r#"<parameter id="k" value="2" constant="false"/>"#), "{}", text.text);
    assert!(text.text.contains(r#"<parameter id="tau" value="3" constant="true"/>"#), "{}", text.text);
    let times = [0.9, 1.2, 3.0, 4.25, 7.6, 12.0];
    let options = SolveOptions { relative: 1e-9, absolute: 1e-12, ..SolveOptions::default() };
    let values = solve(&again, 0.0, 12.0, &times, &options).expect("a course").values;
    let column = |id: &str| again.find(id).expect(id) as usize;
    // k is 2, from 2 on 3, from 5 on 4, from 8 on 5; x grows by k/2 in each of the pulses from 1, 4, 7 and 10 on.
    for (row, (k, x)) in values.iter().zip([(2.0, 0.0), (2.0, 0.4), (3.0, 1.0), (3.0, 1.75), (4.0, 4.5), (5.0, 7.0)]) {
        assert!(
            (row[column("k")] - k).abs() < 1e-12 && (row[column("x")] - x).abs() < 1e-8,
            "{row:?} instead of {k}, {x}"
        );
        assert_eq!(row[column("twice")], 4.0, "what was worked out at the start stays");
    }
}

#[test]
fn reactions_stay_reactions() {
    let text = r#"<eml name="m" time_unit="min"><parameter id="k" value="0.3" unit="1/(uM min)"/>
        <input id="F" default="2" unit="uM"/><variable id="E" initial="0.5" unit="uM"/>
        <variable id="A" initial="1.5" unit="uM"/><variable id="B" initial="0" unit="uM"/>
        <define id="twice" unit="uM/min">2*bind</define>
        <reaction id="feed" equation="$F -> A" rate="k*F*A"/>
        <reaction id="bind" equation="2 A + $E = B + $E" rate="k*A^2*E/E" reverse="k*B^2"/>
        <reaction id="make" equation="-> 0.5 E" rate="k*twice/k*B/B"/></eml>"#;
    let text = text.replace("k*twice/k*B/B", "twice");
    let document = good(&text).document;
    let (text, again) = written(&document);
    let told = |reaction: &pseudopod::equations::tree::Reaction, system: &System| {
        let side = |all: &[Participant]| -> Vec<(String, f64, bool)> {
            let one =
                |it: &Participant| (system.quantities[it.quantity as usize].id.clone(), it.stoichiometry, it.is_held);
            all.iter().map(one).collect()
        };
        (reaction.reversible, side(&reaction.reactants), side(&reaction.products))
    };
    let all: Vec<_> = again.reactions.iter().map(|reaction| told(reaction, &again)).collect();
    let one = |id: &str, number: f64, held: bool| (id.to_owned(), number, held);
    // E is made by another reaction, so that it is no species at the boundary: it takes part as a modifier.
    assert_eq!(
        all,
        [
            (false, vec![one("F", 1.0, true)], vec![one("A", 1.0, false)]),
            (true, vec![one("A", 2.0, false)], vec![one("B", 1.0, false)]),
            (false, vec![], vec![one("E", 0.5, false)]),
        ]
    );
    assert!(text.text.contains(r#"<modifierSpeciesReference species="E"/>"#), "{}", text.text);
    let times = [0.0, 0.5, 2.0];
    let options = SolveOptions { relative: 1e-10, absolute: 1e-13, ..SolveOptions::default() };
    let [old, new] = [&document.system, &again]
        .map(|system| solve(system, 0.0, 2.0, &times, &options).unwrap_or_else(|trouble| panic!("{trouble}")).values);
    for id in ["A", "B", "E", "bind", "twice"] {
        let [a, b] = [(&document.system, &old), (&again, &new)].map(|(system, rows)| {
            let column = system.find(id).expect(id) as usize;
            rows.iter().map(|row| row[column]).collect::<Vec<f64>>()
        });
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-9), "{id}: {b:?} instead of {a:?}");
    }
}

#[test]
fn units_say_what_may_be_a_species() {
    let text = r#"<eml name="m" time_unit="min"><parameter id="c" value="1" unit="1/min"/><parameter id="r" value="2/4" unit="um"/>
        <variable id="conc" initial="1" unit="nM" rate="-c*conc"/><variable id="amount" initial="2" unit="fmol" rate="0"/>
        <variable id="share" initial="3" unit="1" rate="c*(1 - share)"/><variable id="length" initial="r" unit="um" rate="c*r"/>
        <variable id="switch" initial="0" unit="1" rate="0"/><event when="length gt 4*r" delay="0.5"><set id="length">3</set></event></eml>"#;
    let text = written(&good(text).document).0.text;
    for part in [
        r#"timeUnits="min""#,
        r#"<species id="conc" compartment="vessel" initialConcentration="1" substanceUnits="nM_l" hasOnlySubstanceUnits="false""#,
        r#"<unitDefinition id="nM_l" name="nM l">
        <listOfUnits>
          <unit kind="mole" exponent="1" scale="-9" multiplier="1"/>"#,
        r#"<species id="amount" compartment="vessel" initialAmount="2" substanceUnits="fmol" hasOnlySubstanceUnits="true""#,
        r#"<species id="share" compartment="vessel" initialAmount="3" substanceUnits="dimensionless""#,
        r#"<parameter id="length" units="um" constant="false"/>"#,
        r#"<parameter id="switch" value="0" units="dimensionless" constant="false"/>"#,
        // Numbers that stand alone are in the unit that is expected, others are plain.
        r#"<cn type="integer" sbml:units="um"> 2 </cn>"#,
        r#"<cn sbml:units="min"> 0.5 </cn>"#,
        r#"<cn type="integer" sbml:units="um"> 3 </cn>"#,
        r#"<cn type="integer" sbml:units="dimensionless"> 1 </cn><ci> share </ci>"#,
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

#[test]
fn names_that_sbml_cannot_have_are_changed_and_told() {
    let text = r#"<eml name="1. α/β"><parameter id="α" value="2"/><parameter id="alpha" value="1"/>
        <variable id="vessel" initial="1" name="a &lt; b" rate="-α*hill(vessel, alpha, 2)"/>
        <event id="é" when="vessel lt 0.5"><set id="vessel">1</set></event></eml>"#;
    let (text, again) = written(&good(text).document);
    assert_eq!(text.notices, ["`α` is called `alpha_`", "`é` is called `u00E9`"]);
    let found: Vec<&str> = again.quantities.iter().map(|quantity| quantity.id.as_str()).collect();
    assert_eq!(found, ["vessel_", "vessel", "[vessel]", "alpha_", "alpha"]);
    assert!(text.text.contains(r#"<model id="_1__alpha_beta" name="1. α/β">"#), "{}", text.text);
    assert!(text.text.contains(r#"<parameter id="alpha_" name="α" value="2" constant="true"/>"#), "{}", text.text);
    let same = r#"<eml name="x"><variable id="x" initial="1" rate="-x"/></eml>"#;
    assert!(
        written(&good(same).document).0.text.contains(r#"<model id="x_" name="x""#),
        "models have names of the same kind"
    );
    assert_eq!((again.quantities[1].name.as_str(), again.events[0].id.as_str()), ("a < b", "u00E9"));
}

#[test]
fn a_history_that_the_start_continues_is_an_initial_assignment() {
    let text = |history: &str| {
        format!(
            r#"<eml name="m"><parameter id="a" value="1"/>
            <variable id="x" initial="a" history="{history}" rate="-delay(x, 1)"/></eml>"#
        )
    };
    let document = good(&text("a + 0.5*sin(time)")).document;
    let (text_of, again) = written(&document);
    assert!(text_of.notices.is_empty(), "{:?}", text_of.notices);
    let options = SolveOptions { relative: 1e-9, absolute: 1e-12, ..SolveOptions::default() };
    let [old, new] = [&document.system, &again].map(|system| {
        let number = system.find("x").expect("x") as usize;
        solve(system, 0.0, 0.8, &[0.8], &options).expect("a course").values[0][number]
    });
    // x' = -(1 + sin(t - 1)/2) until t = 1.
    let exact = 1.0 - 0.8 + 0.5 * ((-0.2f64).cos() - (-1.0f64).cos());
    assert!((old - exact).abs() < 1e-8 && (new - exact).abs() < 1e-8, "{old}, {new} instead of {exact}");
    // What a definition was before the start is in its rule: x' = -3 until t = 1.
    let defined = r#"<eml name="m"><variable id="x" initial="1" rate="-delay(y, 1)"/><define id="y" history="3">x</define></eml>"#;
    let again = written(&good(defined).document).1;
    let number = again.find("x").expect("x") as usize;
    let end = solve(&again, 0.0, 0.8, &[0.8], &options).expect("a course").values[0][number];
    assert!((end - (1.0 - 2.4)).abs() < 1e-8, "{end}");
    let other = written(&good(&text("2")).document).0;
    let told = "the history of `x` is left out: SBML has only one that is the value of the start at the start";
    assert_eq!(other.notices, [told]);
}

#[test]
fn documents_that_ship_solve_to_the_same_numbers() {
    let mut tried = 0;
    for entry in std::fs::read_dir("eml").expect("the folder of documents") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|end| end != "eml") {
            continue;
        }
        let document = good(&std::fs::read_to_string(&path).expect("a text")).document;
        if sbml::write(&document).is_err() {
            assert!(
                document.level == eml::Level::Field
                    || document.level == eml::Level::Membrane
                    || !document.noise.is_empty(),
                "{}",
                path.display()
            );
            continue;
        }
        tried += 1;
        let again = written(&document).1;
        let times = [0.0, 1.0, 5.0, 20.0, 30.0];
        let options = SolveOptions { relative: 1e-9, absolute: 1e-12, ..SolveOptions::default() };
        // What is drawn is in its middle there.
        let undrawn = System { draws: Vec::new(), ..document.system.clone() };
        let is_drawn = |number: usize| document.system.draws.iter().any(|draw| draw.quantity as usize == number);
        let [old, new] =
            [&undrawn, &again].map(|system| solve(system, 0.0, 30.0, &times, &options).expect("a course").values);
        for (number, quantity) in document.system.quantities.iter().enumerate().filter(|(number, _)| !is_drawn(*number))
        {
            let column = again.find(&quantity.id).expect("the same names") as usize;
            for (old, new) in old.iter().zip(&new) {
                let (a, b) = (old[number], new[column]);
                assert!(
                    (a - b).abs() <= 1e-6 * a.abs().max(1.0),
                    "{}: `{}` is {b}, not {a}",
                    path.display(),
                    quantity.id
                );
            }
        }
    }
    assert!(tried >= 6, "{tried} documents were written");
}
