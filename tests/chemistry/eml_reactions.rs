//! Reactions: what they make of the rates of variables, and what stays the same.

use pseudopod::equations::tree::{Role, System};
use pseudopod::equations::{self, Read, eml};
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{SolveOptions, solve};
use std::sync::Arc;

fn read(text: &str) -> Read {
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    equations::read(Arc::new(source)).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)))
}

fn system(parts: &str) -> System {
    read(&format!(r#"<eml name="m">{parts}</eml>"#)).document.system
}

/// Values of all quantities at some times.
fn course(system: &System, times: &[f64]) -> Vec<Vec<f64>> {
    let options = SolveOptions { relative: 1e-10, absolute: 1e-13, ..SolveOptions::default() };
    solve(system, 0.0, times[times.len() - 1], times, &options).expect("a course").values
}

fn number(system: &System, id: &str) -> usize {
    system.find(id).expect(id) as usize
}

#[test]
fn dimers_bind_and_part_as_the_formula_says() {
    // x dimers of a total T = A + 2x: x' = k (T - 2x)^2 - r x, a Riccati equation with roots p < q of 4k x^2 - (4kT + r) x + k T^2.
    let (k, r, total) = (0.3_f64, 0.2, 1.5);
    let system = system(
        r#"<parameter id="k" value="0.3"/><parameter id="r" value="0.2"/>
           <variable id="A" initial="1.5"/><variable id="D" initial="0"/>
           <reaction id="binding" equation="2 A = D" rate="k*A^2" reverse="r*D"/>"#,
    );
    let (a, b, c) = (4.0 * k, -(4.0 * k * total + r), k * total * total);
    let root = (b * b - 4.0 * a * c).sqrt();
    let (p, q) = ((-b - root) / (2.0 * a), (-b + root) / (2.0 * a));
    for (time, values) in [0.5, 2.0, 10.0].iter().zip(course(&system, &[0.5, 2.0, 10.0])) {
        let growth = (a * (p - q) * time).exp();
        let expected = p * q * (1.0 - growth) / (q - p * growth);
        let [monomer, dimer, rate] = ["A", "D", "binding"].map(|id| values[number(&system, id)]);
        assert!((dimer - expected).abs() < 1e-9, "{dimer} at {time}, not {expected}");
        assert!((monomer + 2.0 * dimer - total).abs() < 1e-12, "the total is kept");
        assert!((rate - (k * monomer * monomer - r * dimer)).abs() < 1e-12, "the reaction is its net rate");
    }
}

#[test]
fn reactions_are_the_equations_that_they_stand_for() {
    let by_reactions = system(
        r#"<parameter id="F" value="3"/><variable id="A" initial="1"/><variable id="B" initial="0.5"/>
           <variable id="C" initial="0"/>
           <reaction id="feed" equation="$F -> A" rate="0.1*F"/>
           <reaction id="grow" equation="2 A + B -> 3 B + 0.5*C" rate="0.7*A^2*B"/>
           <reaction id="flow" equation="C -> " rate="0.2*C"/><reaction id="die" equation="B -> C" rate="B*0.3"/>"#,
    );
    let by_equations = system(
        r#"<variable id="A" initial="1" rate="0.3 - 2*g"/><variable id="B" initial="0.5" rate="2*g - 0.3*B"/>
           <variable id="C" initial="0" rate="0.5*g - 0.2*C + 0.3*B"/><define id="g">0.7*A^2*B</define>"#,
    );
    let times = [0.3, 1.0, 4.0];
    for (a, b) in course(&by_reactions, &times).iter().zip(course(&by_equations, &times)) {
        for id in ["A", "B", "C"] {
            let (a, b) = (a[number(&by_reactions, id)], b[number(&by_equations, id)]);
            assert!((a - b).abs() < 1e-9, "{id}: {a}, not {b}");
        }
    }
    assert_eq!(by_reactions.reactions.len(), 4);
}

#[test]
fn reactions_read_back_the_same_at_every_level() {
    let cell = r#"<eml name="c" level="cell" time_unit="min"><parameter id="k" value="2" unit="1/(uM min)"/>
        <input id="S" default="1" unit="uM"/><variable id="A" initial="1" unit="uM"/><variable id="B" initial="1" unit="uM"/>
        <reaction id="J" name="a &lt; b" equation="1.5 A + $S = B" rate="k*A*S" reverse="0.1 [1/min]*B"/></eml>"#;
    let plain = r#"<eml name="c"><variable id="A" initial="1"/><variable id="B" initial="1" rate="J"/>
        <reaction id="J" equation="-> A" rate="1 - A"/></eml>"#;
    let membrane = r#"<eml name="m" level="membrane"><variable id="a" initial="1" diffusion="0.1"/>
        <variable id="b" initial="1"/><variable id="c" level="cell" initial="1"/>
        <reaction id="on" equation="a -> b" rate="a*c"/><reaction id="out" equation="c ->" rate="c"/></eml>"#;
    let field = r#"<eml name="f"><grid dimension="2" spacing="1"/><field id="u" initial="1" diffusion="1"/>
        <field id="v" initial="x"/><reaction id="J" equation="u -> v" rate="u*v^2"/></eml>"#;
    for text in [cell, plain, membrane, field] {
        let document = read(text).document;
        let written = eml::write(&document, "").text;
        let mut again = read(&written).document.system;
        let mut expected = document.system;
        if text == cell {
            // A number with a unit of its own costs those of the text.
            expected.quantities.iter_mut().chain(&mut again.quantities).for_each(|quantity| quantity.unit.clear());
        }
        assert_eq!(again, expected, "{written}");
        assert!(written.contains("<reaction id=\"J\"") || text == membrane, "{written}");
        let Some(number) = again.find("J") else { continue };
        assert!(matches!(again.quantities[number as usize].role, Role::Defined { .. }));
    }
}

/// A model of SBML with two species that react, and more.
fn model(species: &str, product: &str, more: &str) -> Read {
    read(&format!(
        r#"<sbml xmlns="http://www.sbml.org/sbml/level3/version2/core" level="3" version="2"><model>
        <listOfCompartments><compartment id="c" size="2" constant="true"/></listOfCompartments>
        <listOfParameters><parameter id="f" value="3" constant="true"/><parameter id="n" value="2" constant="false"/></listOfParameters>
        <listOfSpecies>
        <species id="A" compartment="c" initialAmount="1" hasOnlySubstanceUnits="false" boundaryCondition="false" constant="false"/>
        <species id="B" compartment="c" initialAmount="0" hasOnlySubstanceUnits="false" boundaryCondition="false" constant="false" {species}/>
        <species id="X" compartment="c" initialAmount="4" hasOnlySubstanceUnits="false" boundaryCondition="true" constant="false"/>
        </listOfSpecies>{more}
        <listOfReactions><reaction id="J" reversible="false"><listOfReactants>
        <speciesReference species="A" stoichiometry="2" constant="true"/><speciesReference species="X" stoichiometry="1" constant="true"/>
        </listOfReactants><listOfProducts><speciesReference species="B" {product}/></listOfProducts>
        <kineticLaw><math xmlns="http://www.w3.org/1998/Math/MathML"><apply><times/><ci>c</ci><ci>A</ci><ci>X</ci></apply></math></kineticLaw>
        </reaction></listOfReactions></model></sbml>"#
    ))
}

#[test]
fn reactions_of_sbml_stay_reactions_where_that_says_the_same() {
    let whole = model("", r#"stoichiometry="3" constant="true""#, "").document;
    let text = eml::write(&whole, "").text;
    let expected = r#"<reaction id="J" equation="2 A + $X -> 3 B" rate="c*A_concentration*X_concentration"/>"#;
    assert!(text.contains(expected), "{text}");
    // A factor of one species alone, or a stoichiometry that changes, is no number beside an identifier.
    let factor = model(r#"conversionFactor="f""#, r#"stoichiometry="3" constant="true""#, "").document;
    let start = r#"<listOfInitialAssignments><initialAssignment symbol="nb"><math xmlns="http://www.w3.org/1998/Math/MathML"><ci>n</ci>
        </math></initialAssignment></listOfInitialAssignments>"#;
    let named = model("", r#"id="nb" stoichiometry="3" constant="false""#, start).document;
    for document in [&factor, &named] {
        let text = eml::write(document, "").text;
        assert!(text.contains("<define id=\"J\">"), "{text}");
    }
}
