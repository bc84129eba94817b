//! Small models of SBML, written piece by piece, and their values.
#![allow(dead_code)]

use pseudopod::equations::sbml::{self, Model};
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{Method, Scheme, SolveOptions, solve};
use std::sync::Arc;

const MATH: &str = "http://www.w3.org/1998/Math/MathML";
pub const SYMBOLS: &str = "http://www.sbml.org/sbml/symbols";

pub fn read(level: u32, version: u32, body: &str) -> Model {
    let space = if level == 2 { format!("level2/version{version}") } else { format!("level3/version{version}/core") };
    let text = format!(
        r#"<sbml xmlns="http://www.sbml.org/sbml/{space}" level="{level}" version="{version}">
        <model conversionFactor="one"><listOfParameters><parameter id="one" value="1"/><parameter id="two" value="2"/>
        <parameter id="p" value="1" constant="false"/><parameter id="q" value="0" constant="false"/></listOfParameters>
        {body}</model></sbml>"#
    );
    let source = Arc::new(Source { name: "model.xml".to_owned(), text });
    sbml::read(&source).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)))
}

pub const OPTIONS: SolveOptions = SolveOptions {
    scheme: Scheme::OneStep(Method::Rosenbrock),
    relative: 1e-9,
    absolute: 1e-12,
    max_steps: 1_000_000,
    seed: 0,
    longest: f64::INFINITY,
};

/// Values of columns at a time.
pub fn at(model: &Model, until: f64, columns: &[&str]) -> Vec<f64> {
    let rows = solve(&model.system, 0.0, until, &[0.0, until], &OPTIONS).expect("a solution").values;
    columns.iter().map(|name| rows[1][model.column(name).expect(name) as usize]).collect()
}

/// Equal to what the solver's tolerance of 1e-9 leaves, ten thousand steps long.
pub fn close(got: &[f64], expected: &[f64]) {
    assert_eq!(got.len(), expected.len());
    for (a, b) in got.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-6 * (1.0 + b.abs()), "{got:?} instead of {expected:?}");
    }
}

pub fn math(formula: &str) -> String {
    format!(r#"<math xmlns="{MATH}">{formula}</math>"#)
}

pub fn rule(kind: &str, variable: &str, formula: &str) -> String {
    format!(r#"<{kind} variable="{variable}">{}</{kind}>"#, math(formula))
}

pub fn rules(all: &[String]) -> String {
    format!("<listOfRules>{}</listOfRules>", all.concat())
}

pub fn time() -> String {
    format!(r#"<csymbol encoding="text" definitionURL="{SYMBOLS}/time"> t </csymbol>"#)
}

pub fn apply(operator: &str, operands: &str) -> String {
    format!("<apply><{operator}/>{operands}</apply>")
}

/// One species in one compartment.
pub fn cell(compartment: &str, species: &str) -> String {
    format!(
        r#"<listOfCompartments><compartment id="V" {compartment}/></listOfCompartments>
        <listOfSpecies><species id="S" compartment="V" {species}/></listOfSpecies>"#
    )
}

pub fn event(rest: &str, delay: &str, trigger: &str, assignments: &[(&str, &str)]) -> String {
    let one = |(variable, formula): &(&str, &str)| {
        format!(r#"<eventAssignment variable="{variable}">{}</eventAssignment>"#, math(formula))
    };
    let all: String = assignments.iter().map(one).collect();
    let delay = if delay.is_empty() { String::new() } else { format!("<delay>{}</delay>", math(delay)) };
    format!(
        r#"<event {rest}><trigger initialValue="true" persistent="true">{}</trigger>{delay}
        <listOfEventAssignments>{all}</listOfEventAssignments></event>"#,
        math(trigger)
    )
}

pub fn events(all: &[String]) -> String {
    format!("<listOfEvents>{}</listOfEvents>", all.concat())
}

/// A compartment of size 0.5 that may change.
pub const CHANGING: &str = r#"size="0.5" constant="false""#;

pub fn reaction(participant: &str, law: &str) -> String {
    format!(
        r#"<listOfReactions><reaction id="J" reversible="false"><listOfProducts>{participant}</listOfProducts>
        <kineticLaw>{law}</kineticLaw></reaction></listOfReactions>"#
    )
}
