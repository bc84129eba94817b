//! What events of SBML set where concentrations meet sizes that change.

use crate::sbml_models::{CHANGING, apply, at, cell, close, event, events, math, read, rule, rules, time};

#[test]
fn an_amount_stays_when_the_size_jumps() {
    let trigger = apply("gt", &format!("{}<cn> 0.5 </cn>", time()));
    for species in [r#"initialAmount="3""#, r#"initialAmount="3" constant="true""#] {
        let body = cell(CHANGING, species) + &events(&[event("", "", &trigger, &[("V", "<cn> 2 </cn>")])]);
        close(&at(&read(3, 2, &body), 1.0, &["S", "[S]"]), &[3.0, 1.5]);
    }
}

#[test]
fn an_event_sets_a_concentration_by_the_size_before() {
    let trigger = apply("gt", &format!("{}<cn> 0.5 </cn>", time()));
    let species = r#"initialAmount="3""#;
    for set in [[("S", "<cn> 2 </cn>"), ("V", "<cn> 2 </cn>")], [("V", "<cn> 2 </cn>"), ("S", "<cn> 2 </cn>")]] {
        let body = cell(CHANGING, species) + &events(&[event("", "", &trigger, &set)]);
        close(&at(&read(3, 2, &body), 1.0, &["[S]", "S"]), &[0.5, 1.0]);
    }
    // The same where the size follows from what the event sets, and where the state is the concentration.
    let size = rule("assignmentRule", "V", &apply("times", "<ci> p </ci><cn> 0.5 </cn>"));
    let still = rule("rateRule", "S", "<cn> 0 </cn>");
    for rules_of in [vec![size.clone()], vec![size.clone(), still.clone()]] {
        let both = event("", "", &trigger, &[("S", "<cn> 2 </cn>"), ("p", "<cn> 4 </cn>")]);
        let body = cell(CHANGING, species) + &rules(&rules_of) + &events(&[both]);
        close(&at(&read(3, 2, &body), 1.0, &["[S]", "S"]), &[0.5, 1.0]);
    }
    let alone = event("", "", &trigger, &[("p", "<cn> 4 </cn>")]);
    let body = cell(CHANGING, species) + &rules(&[size, still]) + &events(&[alone]);
    close(&at(&read(3, 2, &body), 1.0, &["[S]", "S"]), &[1.5, 3.0]);
}

#[test]
fn an_event_meets_the_size_that_another_of_its_instant_has_set() {
    let trigger = apply("gt", &format!("{}<cn> 0.5 </cn>", time()));
    let with = |priority: f64, set: (&str, &str)| {
        let priority = format!("<priority>{}</priority><listOfEv", math(&format!("<cn> {priority} </cn>")));
        event("", "", &trigger, &[set]).replace("<listOfEv", &priority)
    };
    let both = |size: f64| events(&[with(1.0, ("S", "<cn> 4 </cn>")), with(size, ("V", "<cn> 2 </cn>"))]);
    // The size first: 4·2; or the concentration first: 4·0.5.
    for (size, amount) in [(2.0, 8.0), (0.0, 2.0)] {
        let body = cell(CHANGING, r#"initialAmount="3""#) + &both(size);
        close(&at(&read(3, 2, &body), 1.0, &["S", "V"]), &[amount, 2.0]);
    }
}

#[test]
fn a_delayed_concentration_meets_the_size_of_its_execution() {
    let trigger = apply("gt", &format!("{}<cn> 1 </cn>", time()));
    for values in ["true", "false"] {
        let rest = format!(r#"useValuesFromTriggerTime="{values}""#);
        let late = event(&rest, "<cn> 1 </cn>", &trigger, &[("S", &time())]);
        let body = cell(CHANGING, r#"initialAmount="3""#)
            + &rules(&[rule("rateRule", "V", "<cn> 1 </cn>")])
            + &events(&[late]);
        let expected = if values == "true" { 1.0 } else { 2.0 };
        close(&at(&read(3, 2, &body), 2.0 + 1e-9, &["[S]", "S"]), &[expected, 2.5 * expected]);
    }
}

#[test]
fn a_delayed_event_sets_a_concentration_by_the_size_before_its_execution() {
    let trigger = apply("gt", &format!("{}<cn> 1 </cn>", time()));
    for (values, expected) in [("true", 1.0), ("false", 2.0)] {
        let rest = format!(r#"useValuesFromTriggerTime="{values}""#);
        let late = event(&rest, "<cn> 1 </cn>", &trigger, &[("S", &time()), ("V", "<cn> 5 </cn>")]);
        let body = cell(CHANGING, r#"initialAmount="3""#)
            + &rules(&[rule("rateRule", "V", "<cn> 1 </cn>")])
            + &events(&[late]);
        close(&at(&read(3, 2, &body), 2.0 + 1e-9, &["V", "S"]), &[5.0, 2.5 * expected]);
    }
}
