//! Algebraic rules determine what nothing else does.

use crate::sbml_models::{
    CHANGING, SYMBOLS, apply, at, cell, close, event, events, math, reaction, read, rule, rules, time,
};

fn equation(formula: &str) -> String {
    format!("<algebraicRule>{}</algebraicRule>", math(formula))
}

fn n(value: f64) -> String {
    format!("<cn> {value} </cn>")
}

const P: &str = "<ci> p </ci>";
const Q: &str = "<ci> q </ci>";

#[test]
fn one_symbol_follows_from_one_rule() {
    let line = apply("minus", &(apply("times", &(n(2.0) + P)) + &time()));
    close(&at(&read(3, 2, &rules(&[equation(&line)])), 3.0, &["p", "q"]), &[1.5, 0.0]);
    // (p + 1)/4 = t, in Level 2.
    let quotient = apply("divide", &(apply("plus", &(n(1.0) + P)) + &n(4.0)));
    let quotient = apply("minus", &(time() + &quotient));
    let model = read(2, 4, &rules(&[equation(&quotient)]));
    close(&at(&model, 1.0, &["p"]), &[3.0]);
    // p before t = 1, and 2 p after, are 1.
    let early = apply("lt", &(time() + &n(1.0)));
    let twice = apply("times", &(P.to_owned() + &n(2.0)));
    let pieces = format!("<piecewise><piece>{P}{early}</piece><otherwise>{twice}</otherwise></piecewise>");
    let model = read(3, 2, &rules(&[equation(&apply("minus", &(pieces + &n(1.0))))]));
    close(&[at(&model, 0.5, &["p"]), at(&model, 2.0, &["p"])].concat(), &[1.0, 0.5]);
}

#[test]
fn rules_determine_symbols_together() {
    // p + q = 3 and p - q = t
    let sum = apply("minus", &(apply("plus", &format!("{P}{Q}")) + &n(3.0)));
    let difference = apply("minus", &(apply("minus", &format!("{P}{Q}")) + &time()));
    let model = read(3, 2, &rules(&[equation(&sum), equation(&difference)]));
    close(&at(&model, 1.0, &["p", "q"]), &[2.0, 1.0]);
    // One after the other, in whatever order they stand: q = t, p + q = 3.
    let known = apply("minus", &format!("{Q}{}", time()));
    for all in [[equation(&sum), equation(&known)], [equation(&known), equation(&sum)]] {
        close(&at(&read(3, 2, &rules(&all)), 1.0, &["p", "q"]), &[2.0, 1.0]);
    }
}

#[test]
fn a_symbol_may_hide_behind_an_assignment_rule() {
    let hidden = rule("assignmentRule", "q", &apply("times", &(n(2.0) + P)));
    let sum = apply("minus", &(apply("plus", &format!("{P}{Q}")) + &apply("times", &(n(3.0) + &time()))));
    close(&at(&read(3, 2, &rules(&[hidden, equation(&sum)])), 2.0, &["p", "q"]), &[2.0, 4.0]);
}

#[test]
fn what_reactions_rates_and_events_change_is_not_solved_for() {
    // S grows by 1 in a volume of 0.5; p + [S] = 6.
    let sum = apply("minus", &(apply("plus", &format!("{P}<ci> S </ci>")) + &n(6.0)));
    let product = r#"<speciesReference species="S" stoichiometry="1" constant="true"/>"#;
    let body = cell(CHANGING, r#"initialAmount="0""#) + &rules(&[equation(&sum)]) + &reaction(product, &math(&n(1.0)));
    close(&at(&read(3, 2, &body), 1.0, &["S", "p"]), &[1.0, 4.0]);
    let twin = apply("minus", &format!("{P}{Q}"));
    let trigger = apply("gt", &(time() + &n(0.5)));
    let body = rules(&[equation(&twin)]) + &events(&[event("", "", &trigger, &[("q", &n(8.0))])]);
    close(&at(&read(3, 2, &body), 1.0, &["p"]), &[8.0]);
    let rate_of =
        format!(r#"<apply><csymbol encoding="text" definitionURL="{SYMBOLS}/rateOf"> r </csymbol>{Q}</apply>"#);
    let body = rules(&[equation(&apply("minus", &(rate_of + P))), rule("rateRule", "q", &n(2.0))]);
    close(&at(&read(3, 2, &body), 1.0, &["p", "q"]), &[2.0, 2.0]);
}

#[test]
fn a_boundary_species_is_held_where_something_else_can_follow() {
    let species =
        r#"<species id="B" compartment="V" initialConcentration="3" boundaryCondition="true"/></listOfSpecies>"#;
    let twin = apply("minus", "<ci> B </ci><ci> S </ci>");
    let body = cell(CHANGING, r#"initialConcentration="2""#).replace("</listOfSpecies>", species);
    let body = body.replace("constant=\"false\"", "constant=\"true\"") + &rules(&[equation(&twin)]);
    close(&at(&read(3, 2, &body), 1.0, &["[S]", "[B]", "S"]), &[3.0, 3.0, 1.5]);
}

#[test]
fn what_is_not_linear_is_sought_from_the_value_that_the_model_gives() {
    // p² + p = t + 6, from 1.
    let square = |symbol: &str| apply("times", &format!("{symbol}{symbol}"));
    let left = apply("plus", &(square(P) + P));
    let right = apply("plus", &(time() + &n(6.0)));
    let model = read(3, 2, &rules(&[equation(&apply("minus", &(left + &right)))]));
    close(&at(&model, 6.0, &["p"]), &[3.0]);
    // Behind an assignment rule, and where it begins says which of two: [S] = 4/q and q = [S] + 3.
    for (start, expected) in [("0.5", 1.0), ("-3", -4.0)] {
        let hidden = rule("assignmentRule", "q", &apply("plus", &("<ci> S </ci>".to_owned() + &n(3.0))));
        let product = apply("minus", &(apply("times", &format!("<ci> S </ci>{Q}")) + &n(4.0)));
        let species = format!(r#"initialConcentration="{start}""#);
        let body = cell(r#"size="0.5" constant="true""#, &species) + &rules(&[hidden, equation(&product)]);
        close(&at(&read(3, 2, &body), 1.0, &["[S]", "S", "q"]), &[expected, 0.5 * expected, expected + 3.0]);
    }
    // Two rules together, neither linear in either, of p' = p + 0.8 and q' = q + 0.8: p'² + q'³ = 2 + t, p'³ = q'² + t.
    let cube = |symbol: &str| apply("times", &(symbol.to_owned() + &square(symbol)));
    let shifted = |symbol: &str| apply("plus", &(symbol.to_owned() + &n(0.8)));
    let (p, q) = (shifted(P), shifted(Q));
    let one = apply("minus", &(apply("plus", &(square(&p) + &cube(&q))) + &apply("plus", &(n(2.0) + &time()))));
    let other = apply("minus", &(cube(&p) + &apply("plus", &(square(&q) + &time()))));
    let model = read(3, 2, &rules(&[equation(&one), equation(&other)]));
    close(&at(&model, 1e-9, &["p", "q"]), &[0.2, 0.2]);
    let found = at(&model, 2.0, &["p", "q"]);
    let (p, q) = (found[0] + 0.8, found[1] + 0.8);
    close(&[p * p + q.powi(3), p.powi(3) - q * q], &[4.0, 2.0]);
}
