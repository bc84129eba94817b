//! Repeated parts: chains and rings against what is known of them.

use pseudopod::equations::eml;
use pseudopod::equations::tree::System;
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{SolveOptions, solve};
use std::f64::consts::PI;
use std::sync::Arc;

fn system(parts: &str) -> System {
    let source = Source { name: "test".to_owned(), text: format!(r#"<eml name="m">{parts}</eml>"#) };
    eml::read(Arc::new(source)).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain))).system
}

/// Values of all quantities at a time.
fn at(system: &System, time: f64) -> impl Fn(&str) -> f64 + use<'_> {
    let options = SolveOptions { relative: 1e-11, absolute: 1e-14, ..SolveOptions::default() };
    let values = solve(system, 0.0, time, &[time], &options).expect("a course").values.remove(0);
    move |id| values[system.find(id).unwrap_or_else(|| panic!("{id}")) as usize]
}

#[test]
fn a_chain_of_compartments_passes_on_as_the_terms_of_poisson() {
    let system = system(
        r#"<parameter id="k" value="0.7"/><variable id="X_1" initial="1"/>
           <repeat index="i" from="2" count="19"><variable id="X[i]" initial="0"/></repeat>
           <repeat index="i" count="19"><reaction id="step[i]" equation="X[i] -> X[i+1]" rate="k*X[i]"/></repeat>
           <define id="total">sum(j, 1, 20, X[j])</define><define id="mean">sum(j, 1, 20, j*X[j])/total</define>"#,
    );
    let time = 9.0;
    let value = at(&system, time);
    let mut term = (-0.7 * time).exp();
    for number in 1..20 {
        let found = value(&format!("X_{number}"));
        assert!((found - term).abs() < 1e-10, "X_{number}: {found}, not {term}");
        term *= 0.7 * time / f64::from(number);
    }
    assert!((value("total") - 1.0).abs() < 1e-12);
    // Of 20 compartments the last keeps what comes: the mean lags behind kt + 1 by little.
    assert!((value("mean") - 7.3).abs() < 1e-3, "{}", value("mean"));
}

#[test]
fn a_number_may_stand_right_before_what_has_an_index() {
    // Each of the pairs that join to X_(i+1) takes two of X_i; `2e1` is twenty, so that X_1 falls at 40 of it.
    let system = system(
        r#"<variable id="X_1" initial="8"/><repeat index="i" from="2" count="2"><variable id="X[i]" initial="0"/></repeat>
           <repeat index="i" count="2"><reaction id="join[i]" equation="2X[i] -> X[i+1]" rate="2e1*X[i]"/></repeat>"#,
    );
    let early = at(&system, 0.05)("X_1");
    assert!((early - 8.0 * (-2.0_f64).exp()).abs() < 1e-9, "{early}");
    let value = at(&system, 10.0);
    for (id, expected) in [("X_1", 0.0), ("X_2", 0.0), ("X_3", 2.0)] {
        assert!((value(id) - expected).abs() < 1e-9, "{id}: {}", value(id));
    }
}

#[test]
fn waves_round_a_ring_decay_at_the_rates_of_its_modes() {
    let system = system(
        r#"<repeat index="i" from="0" count="24" periodic="true">
             <variable id="u[i]" initial="cos(2*pi*3*i/24)" rate="0.4*(u[i - 1] - 2*u[i] + u[i+1])"/>
           </repeat>"#,
    );
    assert_eq!(system.quantities.len(), 24);
    let value = at(&system, 5.0);
    let decay = (-5.0 * 4.0 * 0.4 * (PI * 3.0 / 24.0).sin().powi(2)).exp();
    for number in 0..24 {
        let expected = decay * (2.0 * PI * 3.0 * f64::from(number) / 24.0).cos();
        assert!((value(&format!("u_{number}")) - expected).abs() < 1e-10, "u_{number}");
    }
}

#[test]
fn indices_stand_within_each_other_and_units_links_and_sums_are_what_they_were() {
    let text = r#"<eml name="m" level="cell" time_unit="s"><parameter id="s" value="2" unit="1/s"/><parameter id="sum" value="1" unit="1"/>
        <repeat index="m" from="4" count="2"><repeat index="n" count="2">
          <variable id="a[n][m]" name="m and n" initial="m + 10*n" unit="m" rate="-0.5 [m/s]*n - s*a[n][m]"/></repeat>
          <link from="system.a[1][m]" to="cell.atom[m].y" transfer="value*m"/></repeat>
        <define id="d" unit="m">0*a[1][4] + sum(p, 4, 5, sum(q, 1, 2, a[q][p]*q))*sum</define></eml>"#;
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    let document = eml::read(Arc::new(source)).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)));
    let ids: Vec<&str> = document.system.quantities.iter().map(|quantity| quantity.id.as_str()).collect();
    assert_eq!(ids, ["s", "sum", "a_1_4", "a_2_4", "a_1_5", "a_2_5", "d"]);
    assert_eq!(document.system.quantities[2].name, "m and n");
    let ends: Vec<[&str; 2]> =
        document.links.iter().map(|link| [link.from.text.as_str(), link.to.text.as_str()]).collect();
    assert_eq!(ends, [["system.a_1_4", "cell.atom[4].y"], ["system.a_1_5", "cell.atom[5].y"]]);
    let value = at(&document.system, 1e-9);
    assert!((value("d") - (14.0 + 2.0 * 24.0 + 15.0 + 2.0 * 25.0)).abs() < 1e-6, "{}", value("d"));
}

#[test]
fn an_index_right_behind_a_number_is_no_digit_of_it() {
    let text =
        r#"<eml name="m"><repeat index="i" count="1"><variable id="X[i]" initial="1" rate="3i"/></repeat></eml>"#;
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    let told = render(&eml::read(Arc::new(source)).expect_err("31 is not what was meant"), Paint::Plain);
    assert!(told.contains("3i") && !told.contains("31"), "{told}");
}
