//! What single constructs of SBML mean, against solutions by hand.

use crate::sbml_models::{
    CHANGING, SYMBOLS, apply, at, cell, close, event, events, math, reaction, read, rule, rules, time,
};
use pseudopod::equations::sbml;
use pseudopod::equations::tree::Role;

#[test]
fn a_concentration_rate_holds_in_a_growing_compartment() {
    let body = cell(CHANGING, r#"initialConcentration="6""#)
        + &rules(&[rule("rateRule", "V", "<cn> 0.2 </cn>"), rule("rateRule", "S", "<cn> 0.1 </cn>")]);
    close(&at(&read(3, 2, &body), 1.0, &["V", "[S]", "S"]), &[0.7, 6.1, 6.1 * 0.7]);
}

#[test]
fn a_concentration_rate_holds_in_a_compartment_with_a_rule() {
    let size = apply("plus", &format!("<cn> 1 </cn>{}", time()));
    let body = cell(CHANGING, r#"initialAmount="6""#)
        + &rules(&[rule("assignmentRule", "V", &size), rule("rateRule", "S", "<cn> 0.1 </cn>")]);
    close(&at(&read(3, 2, &body), 1.0, &["V", "[S]", "S"]), &[2.0, 6.1, 12.2]);
}
#[test]
fn stoichiometries_follow_rules_events_and_initial_assignments() {
    let body = |rest: &str| {
        cell(r#"size="1""#, r#"initialAmount="0""#)
            + rest
            + &reaction(r#"<speciesReference id="n" species="S" stoichiometry="3"/>"#, &math("<cn> 1 </cn>"))
    };
    let by_rule = rules(&[rule("assignmentRule", "n", &apply("times", &format!("<cn> 2 </cn>{}", time())))]);
    close(&at(&read(3, 2, &body(&by_rule)), 2.0, &["S", "n"]), &[4.0, 4.0]);
    let by_rate = rules(&[rule("rateRule", "n", "<cn> 1 </cn>")]);
    close(&at(&read(3, 2, &body(&by_rate)), 2.0, &["S", "n"]), &[8.0, 5.0]);
    let trigger = apply("geq", &format!("{}<cn> 1 </cn>", time()));
    let by_event = events(&[event("", "", &trigger, &[("n", "<cn> 5 </cn>")])]);
    close(&at(&read(3, 1, &body(&by_event)), 2.0, &["S", "J"]), &[8.0, 1.0]);
    let initial = format!(
        r#"<listOfInitialAssignments><initialAssignment symbol="n">{}</initialAssignment></listOfInitialAssignments>"#,
        math("<ci> two </ci>")
    );
    close(&at(&read(3, 1, &body(&initial)), 2.0, &["S"]), &[4.0]);
}

#[test]
fn level_2_stoichiometry_math_changes_in_time() {
    let participant = format!(
        r#"<speciesReference species="S"><stoichiometryMath>{}</stoichiometryMath></speciesReference>"#,
        math(&time())
    );
    let body = cell("", r#"initialAmount="0""#) + &reaction(&participant, &math("<ci> two </ci>"));
    let model = read(2, 4, &body);
    close(&at(&model, 2.0, &["S"]), &[4.0]);
    assert!(model.notices.iter().any(|notice| notice.contains("has no size")), "{:?}", model.notices);
}

#[test]
fn conversion_factors_and_local_parameters_count() {
    let law = math(&apply("times", "<ci> two </ci><ci> S </ci>"))
        + r#"<listOfLocalParameters><localParameter id="two" value="0.5"/></listOfLocalParameters>"#;
    let participant = r#"<speciesReference species="S" stoichiometry="1" constant="true"/>"#;
    let body = cell(r#"size="4""#, r#"initialConcentration="1" conversionFactor="two""#) + &reaction(participant, &law);
    let model = read(3, 1, &body);
    // dn/dt = 2 · 0.5 · n/4
    close(&at(&model, 2.0, &["S", "J.two"]), &[4.0 * 0.5_f64.exp(), 0.5]);
    let body = cell(r#"size="4""#, r#"initialAmount="1" hasOnlySubstanceUnits="true" conversionFactor="two""#);
    close(&at(&read(3, 1, &(body + &reaction(participant, &law))), 2.0, &["S"]), &[2.0_f64.exp()]);
    let boundary = cell(r#"size="4""#, r#"initialAmount="1" boundaryCondition="true""#);
    close(&at(&read(3, 1, &(boundary + &reaction(participant, &law))), 2.0, &["S", "[S]"]), &[1.0, 0.25]);
}

#[test]
fn a_rate_of_a_concentration_knows_the_size() {
    let rate_of = |name: &str| {
        format!(
            r#"<apply><csymbol encoding="text" definitionURL="{SYMBOLS}/rateOf"> r </csymbol><ci> {name} </ci></apply>"#
        )
    };
    let body = cell(CHANGING, r#"initialAmount="3""#)
        + &rules(&[
            rule("rateRule", "V", "<cn> 0.2 </cn>"),
            rule("assignmentRule", "p", &rate_of("S")),
            rule("rateRule", "q", &rate_of("V")),
        ]);
    let model = read(3, 2, &body);
    close(&at(&model, 1.0, &["p", "q"]), &[-3.0 * 0.2 / (0.7 * 0.7), 0.2]);
}

#[test]
fn initial_assignments_use_each_other_rules_and_reactions() {
    let assign = |symbol: &str, formula: &str| {
        format!(r#"<initialAssignment symbol="{symbol}">{}</initialAssignment>"#, math(formula))
    };
    let all = assign("p", "<ci> J </ci>") + &assign("S", "<ci> two </ci>") + &assign("V", "<ci> q </ci>");
    let body = cell(CHANGING, r#"initialAmount="7""#)
        + &format!("<listOfInitialAssignments>{all}</listOfInitialAssignments>")
        + &rules(&[rule("assignmentRule", "q", "<cn> 5 </cn>")])
        + &reaction("", &math("<ci> S </ci>"));
    close(&at(&read(3, 2, &body), 1.0, &["p", "V", "S", "[S]"]), &[2.0, 5.0, 10.0, 2.0]);
}

#[test]
fn the_size_of_a_compartment_may_start_from_a_concentration_in_it() {
    let size = format!(r#"<initialAssignment symbol="V">{}</initialAssignment>"#, math("<ci><!-- c --> S </ci>"));
    let body = cell(CHANGING, r#"initialConcentration="3""#)
        + &format!("<listOfInitialAssignments>{size}</listOfInitialAssignments>");
    close(&at(&read(3, 2, &body), 1.0, &["V", "[S]", "S"]), &[3.0, 3.0, 9.0]);
}

#[test]
fn units_are_told_of_once() {
    let body =
        cell(r#"size="1" units="litre""#, r#"initialAmount="1" substanceUnits="mole" hasOnlySubstanceUnits="true""#);
    let model = read(3, 2, &body);
    assert_eq!(model.notices.len(), 1, "{:?}", model.notices);
    assert!(model.notices[0].contains("units"));
    let without = read(3, 2, &cell(r#"size="1""#, r#"initialAmount="1" hasOnlySubstanceUnits="true""#));
    assert!(without.notices.is_empty(), "{:?}", without.notices);
}

/// The value of a formula at time 0.25.
fn value(formula: &str) -> f64 {
    let model = read(3, 2, &rules(&[rule("assignmentRule", "p", formula)]));
    let index = model.column("p").expect("p") as usize;
    let Role::Defined { rule } = &model.system.quantities[index].role else { panic!("a rule") };
    rule.evaluate(0.25, &|other| if Some(other) == model.column("two") { 2.0 } else { f64::NAN })
}

#[test]
fn all_of_mathml_has_its_value() {
    let n = |value: f64| format!("<cn> {value} </cn>");
    let two = format!("{}<ci> two </ci>", n(7.0));
    let half = n(0.5);
    let three = |a: f64, b: f64, c: f64| n(a) + &n(b) + &n(c);
    let of = |names: &[&str], x: f64| -> Vec<f64> { names.iter().map(|name| value(&apply(name, &n(x)))).collect() };
    for (formula, expected) in [
        (r#"<cn type="rational"> 3 <sep/> 4 </cn>"#.to_owned(), 0.75),
        (r#"<cn type="e-notation"> 2.5 <sep/> -3 </cn>"#.to_owned(), 2.5e-3),
        (time(), 0.25),
        (format!(r#"<csymbol definitionURL="{SYMBOLS}/avogadro"> N </csymbol>"#), 6.02214179e23),
        ("<infinity/>".to_owned(), f64::INFINITY),
        ("<exponentiale/>".to_owned(), std::f64::consts::E),
        (apply("plus", ""), 0.0),
        (apply("times", ""), 1.0),
        (apply("and", ""), 1.0),
        (apply("or", ""), 0.0),
        (apply("plus", &three(1.0, 2.0, 4.0)), 7.0),
        (apply("times", &three(3.0, 2.0, 4.0)), 24.0),
        (apply("minus", &two), 5.0),
        (apply("minus", &n(3.0)), -3.0),
        (apply("divide", &two), 3.5),
        (apply("power", &two), 49.0),
        (apply("root", &n(9.0)), 3.0),
        (apply("root", &format!("<degree>{}</degree>{}", n(3.0), n(-8.0))), -2.0),
        (apply("root", &format!("<degree><ci> two </ci></degree>{}", n(9.0))), 3.0),
        (apply("log", &n(1000.0)), 3.0),
        (apply("log", &format!("<logbase>{}</logbase>{}", n(2.0), n(8.0))), 3.0),
        (apply("lt", &three(1.0, 2.0, 3.0)), 1.0),
        (apply("lt", &three(1.0, 3.0, 2.0)), 0.0),
        (apply("leq", &three(1.0, 1.0, 2.0)), 1.0),
        (apply("geq", &three(3.0, 1.0, 2.0)), 0.0),
        (apply("eq", &three(1.0, 1.0, 1.0)), 1.0),
        (apply("neq", &two), 1.0),
        (apply("xor", "<true/><true/><true/>"), 1.0),
        (apply("not", "<false/>"), 1.0),
        (apply("implies", "<true/><false/>"), 0.0),
        (apply("implies", "<false/><false/>"), 1.0),
        (apply("max", &three(1.0, 9.0, 2.0)), 9.0),
        (apply("min", &three(4.0, 1.0, 2.0)), 1.0),
        (apply("quotient", &two), 3.0),
        (apply("rem", &two), 1.0),
        (apply("quotient", &(n(-7.0) + &n(2.0))), -3.0),
        (apply("rem", &(n(-7.0) + &n(2.0))), -1.0),
        (apply("factorial", &n(5.0)), 120.0),
        (apply("ceiling", &half), 1.0),
        (apply("floor", &half), 0.0),
        (apply("abs", &n(-2.0)), 2.0),
        (format!("<piecewise><piece>{half}<true/></piece></piecewise>"), 0.5),
        (format!("<piecewise><piece>{half}<false/></piece><otherwise>{}</otherwise></piecewise>", n(4.0)), 4.0),
        (format!("<semantics>{half}<annotation> any </annotation></semantics>"), 0.5),
    ] {
        let got = value(&formula);
        assert!(
            (got - expected).abs() <= 1e-12 * expected.abs() || got == expected,
            "{formula}: {got}, not {expected}"
        );
    }
    let x: f64 = 0.5;
    let names = ["sin", "cos", "tan", "sec", "csc", "cot", "sinh", "cosh", "tanh", "sech", "csch", "coth", "exp", "ln"];
    let expected =
        [x.sin(), x.cos(), x.tan(), 1.0 / x.cos(), 1.0 / x.sin(), 1.0 / x.tan(), x.sinh(), x.cosh(), x.tanh()];
    let rest = [1.0 / x.cosh(), 1.0 / x.sinh(), 1.0 / x.tanh(), x.exp(), x.ln()];
    close(&of(&names, x), &[&expected[..], &rest[..]].concat());
    // The inverse functions undo them.
    let pairs = [("arcsin", 0.5_f64.sin()), ("arccos", 0.5_f64.cos()), ("arctan", 0.5_f64.tan())];
    let more = [("arcsec", 1.0 / 0.5_f64.cos()), ("arccsc", 1.0 / 0.5_f64.sin()), ("arccot", 1.0 / 0.5_f64.tan())];
    let hyperbolic = [("arcsinh", 0.5_f64.sinh()), ("arccosh", 0.5_f64.cosh()), ("arctanh", 0.5_f64.tanh())];
    let last = [("arcsech", 1.0 / x.cosh()), ("arccsch", 1.0 / x.sinh()), ("arccoth", 1.0 / x.tanh())];
    for (name, y) in pairs.into_iter().chain(more).chain(hyperbolic).chain(last) {
        close(&of(&[name], y), &[0.5]);
    }
    assert!(value("<notanumber/>").is_nan());
    assert!(value("<piecewise/>").is_nan(), "no branch holds");
}

#[test]
fn functions_are_expanded_wherever_they_stand() {
    let lambda = |arguments: &str, body: &str| {
        let all: String = arguments.chars().map(|name| format!("<bvar><ci> {name} </ci></bvar>")).collect();
        math(&format!("<lambda>{all}{body}</lambda>"))
    };
    let call = |name: &str, rest: &str| format!("<apply><ci> {name} </ci>{rest}</apply>");
    let functions = format!(
        r#"<listOfFunctionDefinitions><functionDefinition id="f">{}</functionDefinition>
        <functionDefinition id="g">{}</functionDefinition></listOfFunctionDefinitions>"#,
        lambda("xy", &call("g", "<ci> y </ci>")),
        lambda("x", &apply("minus", "<ci> x </ci><cn> 1 </cn>"))
    );
    let body = functions + &rules(&[rule("assignmentRule", "p", &call("f", &call("g", "<cn> 9 </cn>").repeat(2)))]);
    close(&at(&read(2, 4, &body), 1.0, &["p"]), &[7.0]);
}

#[test]
fn sbml_is_known_by_its_root() {
    assert!(sbml::is_sbml("\u{feff}<?xml version='1.0'?>\n<!-- a --> <sbml level='2'>"));
    assert!(sbml::is_sbml("<x:sbml/>"));
    assert!(!sbml::is_sbml("<eml/>") && !sbml::is_sbml("") && !sbml::is_sbml("<!-- <sbml> -->"));
}
