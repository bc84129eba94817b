//! Fast reactions are at their equilibrium at all times.

use crate::sbml_models::{apply, at, close, math, read, rule, rules, time};

fn species(id: &str, rest: &str) -> String {
    format!(r#"<species id="{id}" compartment="V" {rest}/>"#)
}

/// Species in a compartment of size 2, and reactions.
fn body(species: &[String], reactions: &[String]) -> String {
    format!(
        r#"<listOfCompartments><compartment id="V" size="2"/></listOfCompartments>
        <listOfSpecies>{}</listOfSpecies><listOfReactions>{}</listOfReactions>"#,
        species.concat(),
        reactions.concat()
    )
}

fn part(kind: &str, species: &str, stoichiometry: f64) -> String {
    let list = |rest: &str| format!("<listOf{kind}>{rest}</listOf{kind}>");
    match species {
        "" => String::new(),
        species => list(&format!(r#"<speciesReference species="{species}" stoichiometry="{stoichiometry}"/>"#)),
    }
}

/// A reaction from a reactant to a product, either of which may be none.
fn reaction(id: &str, fast: bool, [from, into]: [(&str, f64); 2], law: &str) -> String {
    let parts = part("Reactants", from.0, from.1) + &part("Products", into.0, into.1);
    format!(r#"<reaction id="{id}" fast="{fast}">{parts}<kineticLaw>{}</kineticLaw></reaction>"#, math(law))
}

/// k times a species
fn times(k: f64, species: &str) -> String {
    apply("times", &format!("<cn> {k} </cn><ci> {species} </ci>"))
}

#[test]
fn a_slow_reaction_draws_from_both_sides_of_an_equilibrium() {
    let all = [species("A", r#"initialAmount="4""#), species("B", r#"initialConcentration="2""#)];
    // [B] = 3 [A], and B decays with the rate [B]·2 of its amount: the total of 8 with 3/4.
    let law = apply("minus", &(times(3.0, "A") + &times(1.0, "B")));
    let decay = reaction("K", false, [("B", 1.0), ("", 1.0)], &times(2.0, "B"));
    let left = 8.0 * (-0.75_f64).exp();
    for (ends, law) in [(["A", "B"], law.clone()), (["B", "A"], apply("minus", &law))] {
        let fast = reaction("J", true, ends.map(|end| (end, 1.0)), &law);
        let model = read(3, 1, &body(&all, &[fast, decay.clone()]));
        close(&at(&model, 1.0, &["A", "B", "[B]"]), &[0.25 * left, 0.75 * left, 0.375 * left]);
        close(&at(&model, 1e-9, &["A", "B"]), &[2.0, 6.0]);
    }
}

#[test]
fn a_fast_reaction_without_return_uses_all_up() {
    let all = [species("A", r#"initialAmount="4""#), species("B", r#"initialAmount="1""#)];
    let fast = reaction("J", true, [("A", 2.0), ("B", 3.0)], &times(0.1, "A"));
    // One unit of A is made in a unit of time.
    let source = reaction("K", false, [("", 1.0), ("A", 1.0)], "<cn> 1 </cn>");
    let model = read(2, 4, &body(&all, &[fast, source]));
    close(&at(&model, 2.0, &["A", "B"]), &[0.0, 1.0 + 1.5 * 6.0]);
}

#[test]
fn a_boundary_holds_the_other_side_of_an_equilibrium() {
    let law = apply("minus", &(times(3.0, "A") + &times(1.0, "B")));
    for (held, expected) in [("B", [2.0, 6.0]), ("A", [6.0, 18.0])] {
        let all = ["A", "B"].map(|id| species(id, &format!(r#"initialAmount="6" boundaryCondition="{}""#, id == held)));
        let fast = reaction("J", true, [("A", 1.0), ("B", 1.0)], &law);
        let decay = reaction("K", false, [("A", 1.0), ("", 1.0)], &times(2.0, "A"));
        close(&at(&read(3, 1, &body(&all, &[fast, decay])), 1.0, &["A", "B"]), &expected);
    }
}

#[test]
fn a_species_that_speeds_up_its_own_making_uses_the_other_up() {
    // J = c A B: with c > 0 all becomes B, with c < 0 all becomes A, with c = 0 nothing does.
    let all = [species("A", r#"initialAmount="4""#), species("B", r#"initialAmount="2""#)];
    for (c, expected) in [(0.1, [0.0, 6.0]), (-3.0, [6.0, 0.0]), (0.0, [4.0, 2.0])] {
        let law = apply("times", &format!("<cn> {c} </cn><ci> A </ci><ci> B </ci>"));
        for (ends, expected) in [(["A", "B"], expected), (["B", "A"], [expected[1], expected[0]])] {
            let fast = reaction("J", true, ends.map(|end| (end, 1.0)), &law);
            let expected = if c == 0.0 { [4.0, 2.0] } else { expected };
            close(&at(&read(3, 1, &body(&all, &[fast])), 1.0, &["A", "B"]), &expected);
        }
    }
}

#[test]
fn a_fast_reaction_may_change_its_direction() {
    // J = p A where p > 0 and p B else, with p = 1 - t by a rule: all is in B until t = 1, in A from then on.
    let all = [species("A", r#"initialAmount="4""#), species("B", r#"initialAmount="2""#)];
    let product = |species: &str| apply("times", &format!("<ci> {species} </ci><ci> p </ci>"));
    let condition = apply("gt", "<ci> p </ci><cn> 0 </cn>");
    let law = format!(
        "<piecewise><piece>{}{condition}</piece><otherwise>{}</otherwise></piecewise>",
        product("A"),
        product("B")
    );
    let p = rules(&[rule("assignmentRule", "p", &apply("minus", &format!("<cn> 1 </cn>{}", time())))]);
    let fast = reaction("J", true, [("A", 1.0), ("B", 1.0)], &law);
    let text = body(&all, &[fast]).replace("<listOfReactions>", &format!("{p}<listOfReactions>"));
    let model = read(3, 1, &text);
    close(&at(&model, 0.5, &["A", "B"]), &[0.0, 6.0]);
    close(&at(&model, 2.0, &["A", "B"]), &[6.0, 0.0]);
}
