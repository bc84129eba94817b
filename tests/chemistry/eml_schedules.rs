//! Doses and infusions by a schedule against closed sums, and events that set parameters.

use pseudopod::equations::eml;
use pseudopod::equations::tree::System;
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{Method, Scheme, SolveOptions, solve};
use std::sync::Arc;

fn read(text: &str) -> eml::Document {
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    eml::read(Arc::new(source)).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)))
}

fn system(parts: &str) -> System {
    read(&format!(r#"<eml name="m">{parts}</eml>"#)).system
}

const METHODS: [Method; 3] = [Method::Rosenbrock, Method::Rk45, Method::Rk65];

/// Values of the first variable at some times, from a start on.
fn course(system: &System, method: Method, start: f64, times: &[f64]) -> Vec<f64> {
    let options = SolveOptions {
        scheme: Scheme::OneStep(method),
        relative: 1e-12,
        absolute: 1e-13,
        max_steps: 1_000_000,
        ..SolveOptions::default()
    };
    let solution = solve(system, start, times[times.len() - 1], times, &options).expect("a course");
    solution.values.iter().map(|row| row[system.variables()[0] as usize]).collect()
}

#[test]
fn doses_at_equal_intervals_add_up_as_the_sum_of_their_decays() {
    let k = 0.3_f64;
    // Intervals that binary numbers have, and others; the last time is one of the schedule, or lies between two.
    for (first, every, until, count) in [
        (0.0, 24.0, f64::INFINITY, 1000),
        (0.1, 0.1, 2.0, 20),
        (2.0, 1.0 / 3.0, 4.0, 7),
        (1.5, 7.0, 29.0, 4),
        (0.3, 0.7, 3.1, 5),
    ] {
        let limit = if until < 1e9 { format!("until=\"{until}\"") } else { String::new() };
        let system = system(&format!(
            r#"<parameter id="every" value="{every}"/><variable id="x" initial="0" rate="-0.3*x"/>
               <event every="every" first="{first}" {limit}><set id="x">x + 2</set></event>"#
        ));
        let times: Vec<f64> = (1..=40).map(|point| 1.37 * every * f64::from(point) / 2.0 + 0.011 * every).collect();
        let exact = |time: f64| -> f64 {
            let doses = (0..count).map(|dose| first + f64::from(dose) * every);
            doses.filter(|dose| *dose < time).map(|dose| 2.0 * (-k * (time - dose)).exp()).sum()
        };
        for method in METHODS {
            for (time, x) in times.iter().zip(course(&system, method, 0.0, &times)) {
                let expected = exact(*time);
                assert!(
                    (x - expected).abs() < 1e-10 * (1.0 + expected),
                    "{every} {method:?} at {time}: {x} {expected}"
                );
            }
        }
    }
}

#[test]
fn a_start_within_a_schedule_waits_for_the_next_time_and_a_start_at_one_does_not() {
    let system =
        system(r#"<variable id="x" initial="0" rate="0"/><event every="10" first="2"><set id="x">x + 1</set></event>"#);
    for (start, expected) in [(0.0, 3.0), (2.0, 3.0), (3.0, 2.0), (11.9, 2.0), (12.0, 2.0), (22.0, 1.0)] {
        assert_eq!(course(&system, Method::Rk45, start, &[30.0])[0], expected, "from {start}");
    }
}

#[test]
fn infusions_by_pulses_add_up_as_the_sum_of_their_integrals() {
    // Rate 1 for 0.25 from 0.5 on, each 2, with decay.
    let system = system(
        r#"<parameter id="long" value="0.25"/><variable id="x" initial="0" rate="pulse(0.5, long, 2) + pulse(3, 1) - 0.4*x"/>"#,
    );
    let exact = |time: f64| -> f64 {
        let of = |begin: f64, long: f64| {
            let decay = |since: f64| (-0.4 * since.max(0.0)).exp();
            if time < begin { 0.0 } else { (decay(time - begin - long) - decay(time - begin)) / 0.4 }
        };
        of(3.0, 1.0) + (0..20).map(|number| of(0.5 + 2.0 * f64::from(number), 0.25)).sum::<f64>()
    };
    let times: Vec<f64> = (1..=60).map(|point| 0.31 * f64::from(point)).collect();
    for method in METHODS {
        for (time, x) in times.iter().zip(course(&system, method, 0.0, &times)) {
            assert!((x - exact(*time)).abs() < 1e-10, "{method:?} at {time}: {x}, not {}", exact(*time));
        }
    }
}

#[test]
fn a_parameter_that_an_event_sets_has_its_new_value_from_then_on() {
    let text = r#"<eml name="m"><parameter id="k" value="0.5"/><parameter id="double" value="2*k"/>
        <variable id="x" initial="1" rate="-k*x"/><variable id="y" initial="0" rate="double"/>
        <event when="time ge 2"><set id="k">k/5</set></event><event every="3" first="1" until="4"><set id="y">y</set></event></eml>"#;
    let document = read(text);
    for method in METHODS {
        let x = course(&document.system, method, 0.0, &[5.0])[0];
        assert!((x - (-0.5_f64 * 2.0 - 0.1 * 3.0).exp()).abs() < 1e-11, "{method:?}: {x}");
    }
    // What is worked out of it at the start stays.
    let options = SolveOptions::default();
    let solution = solve(&document.system, 0.0, 5.0, &[5.0], &options).expect("a course");
    let value = |id: &str| solution.values[0][document.system.find(id).expect("a quantity") as usize];
    assert_eq!([value("k"), value("double")], [0.1, 1.0]);
    let written = eml::write(&document, "").text;
    assert_eq!(read(&written).system, document.system, "{written}");
}

#[test]
fn the_doses_that_ship_are_absorbed_and_cleared_as_the_formula_says() {
    let text = std::fs::read_to_string("eml/dosing.eml").expect("a document that ships");
    let system = read(&text).system;
    let value = |id: &str| {
        let number = system.find(id).expect(id) as usize;
        system.quantities[number].initial.evaluate(0.0, &|_| f64::NAN)
    };
    let [ka, cl, v, dose, tau] = ["k_a", "CL", "V", "dose", "tau"].map(value);
    let ke = cl / v;
    // One dose that is absorbed at a rate k_a (Bateman 1910).
    let one = |since: f64| dose * ka / (v * (ka - ke)) * ((-ke * since).exp() - (-ka * since).exp());
    let times: Vec<f64> = (1..=200).map(|point| 1.09 * f64::from(point)).collect();
    let options = SolveOptions { relative: 1e-12, absolute: 1e-13, ..SolveOptions::default() };
    let solution = solve(&system, 0.0, 220.0, &times, &options).expect("a course");
    let number = system.find("C").expect("C") as usize;
    for (time, row) in times.iter().zip(&solution.values) {
        let doses = (0..10).map(|dose| f64::from(dose) * tau);
        let expected: f64 = doses.filter(|begin| begin < time).map(|begin| one(time - begin)).sum();
        assert!(
            (row[number] - expected).abs() < 1e-10 * (1.0 + expected),
            "at {time}: {}, not {expected}",
            row[number]
        );
    }
    // In the end of the row of doses: close to the steady state, whose mean over an interval is dose/(CL tau).
    let mean = dose / (cl * tau);
    let last = solution.values.iter().zip(&times).filter(|(_, time)| (192.0..216.0).contains(*time));
    let (sum, count) = last.fold((0.0, 0.0), |(sum, count), (row, _)| (sum + row[number], count + 1.0));
    assert!((sum / count / mean - 1.0).abs() < 0.05, "{} and {mean}", sum / count);
}

#[test]
fn schedules_that_no_course_can_meet_are_refused_and_long_ones_are_met() {
    let counted = |every: &str, rest: &str| {
        system(&format!(
            r#"<variable id="n" initial="0" rate="0"/><event id="tick" every="{every}" {rest}><set id="n">n + 1</set></event>"#
        ))
    };
    for every in ["1e-300", "1e-17", "1e-7"] {
        let trouble = solve(&counted(every, ""), 0.0, 2.0, &[2.0], &SolveOptions::default()).expect_err("too many");
        let words = trouble.to_string();
        assert!(
            words.contains("more than 10000000 times") && words.contains(&format!("'tick' fires every {every}")),
            "{words}"
        );
    }
    // What ends early, or begins after the course, is no trouble.
    assert_eq!(course(&counted("1e-3", r#"until="1.0005""#), Method::Rk45, 0.0, &[2.0]), [1001.0]);
    assert_eq!(course(&counted("1e-300", r#"first="3""#), Method::Rk45, 0.0, &[2.0]), [0.0]);
}
