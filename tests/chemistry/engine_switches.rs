//! What the clock switches: rates are those of each side, be they what they may at the instant itself, and schedules are met however they are
//! written. Jumps of rates where a variable comes to something from nothing are passed.

use pseudopod::equations::eml;
use pseudopod::equations::tree::System;
use pseudopod::error::Source;
use pseudopod::ode::{
    Method, OdeTrouble, Population, PopulationScratch, Reason, Scheme, Solution, SolveOptions, Tolerances, clocked,
    solve,
};
use std::sync::Arc;

/// The equations of a document with these parts.
fn system(parts: &str) -> System {
    let text = format!("<eml name=\"test\">{parts}</eml>");
    eml::read(Arc::new(Source { name: "test.eml".into(), text })).expect(parts).system
}

/// One variable from 0 on that changes by a rate.
fn one(rate: &str) -> System {
    system(&format!("<variable id=\"x\" initial=\"0\" rate=\"{rate}\"/>"))
}

fn solved(system: &System, method: Method, points: &[f64]) -> Result<Solution, OdeTrouble> {
    let options = SolveOptions { scheme: Scheme::OneStep(method), ..SolveOptions::default() };
    solve(system, 0.0, points[points.len() - 1], points, &options)
}

/// The last value of the first variable, and the number of steps.
fn end(system: &System, method: Method, until: f64) -> (f64, u64) {
    let solution = solved(system, method, &[until]).unwrap_or_else(|trouble| panic!("{trouble}"));
    (solution.values[0][0], solution.work.steps)
}

const METHODS: [Method; 3] = [Method::Rosenbrock, Method::Rk45, Method::Rk65];

#[test]
fn an_infusion_that_begins_or_ends_counts_to_the_last_bit_whichever_side_has_the_instant() {
    for (condition, amount) in
        [("time lt 9.3", 9.3), ("time le 9.3", 9.3), ("time gt 9.3", 10.7), ("time ge 9.3", 10.7), ("time gt 0", 20.0)]
    {
        let system = one(&format!("piecewise(1, {condition}, 0)"));
        for method in METHODS {
            let (x, steps) = end(&system, method, 20.0);
            // A rate of 1 for what an instant is passed by: some hundred of the last bits of 20.
            assert!((x - amount).abs() < 1e-12 && steps < 60, "{condition} {method:?}: {x} in {steps} steps");
        }
        let (x, _) = end(&system, Method::Rk4 { step: 0.7 }, 20.0);
        assert!((x - amount).abs() < 1e-12, "{condition}: {x} by rk4");
    }
}

#[test]
fn methods_of_many_steps_begin_anew_after_a_switch_and_give_all_rows() {
    let points: Vec<f64> = (0..=20).map(f64::from).collect();
    let schemes = [Scheme::Bdf, Scheme::Esdirk34, Scheme::TrBdf2, Scheme::Tsit45];
    // An infusion that one long step would pass over, one that ends where all does, and none that begins there.
    for (condition, decay, at_end) in [
        ("time ge 5 and time lt 5.001", 0.0, 0.001),
        ("time lt 20", 0.0, 20.0),
        ("time ge 20", 0.0, 0.0),
        ("time gt 0 and time le 1", 0.1, 10.0 * (-1.9_f64).exp() * (1.0 - (-0.1_f64).exp())),
    ] {
        let system = one(&format!("piecewise(1, {condition}, 0) - {decay}*x"));
        for scheme in schemes {
            let options = SolveOptions { scheme, ..SolveOptions::default() };
            let solution = solve(&system, 0.0, 20.0, &points, &options).unwrap_or_else(|trouble| panic!("{trouble}"));
            assert_eq!(solution.times, points, "{condition} {scheme:?}");
            let x = solution.values[20][0];
            // A hundred tolerances of a step: one of these methods has the order 2.
            assert!((x - at_end).abs() < 1e-5 * (0.001 + at_end), "{condition} {scheme:?}: {x} {at_end}");
        }
    }
}

#[test]
fn doses_of_a_schedule_are_taken_whole_however_it_is_written() {
    // Every three hours for 0.44, with decay: each dose is an exact sum of exponentials.
    let exact = |time: f64| -> f64 {
        let of_dose = |begin: f64| match time - begin {
            since if since <= 0.0 => 0.0,
            since => 2.0 * ((-0.5 * (since - 0.44).max(0.0)).exp() - (-0.5 * since).exp()),
        };
        (0..40).map(|dose| of_dose(3.0 * f64::from(dose))).sum()
    };
    let points: Vec<f64> = (1..=100).map(f64::from).collect();
    for schedule in [
        "rem(time, 3) lt 0.44",
        "time - 3*floor(time/3) le 0.44",
        "0 lt time - 3*quotient(time, 3) and time - 3*quotient(time, 3) lt 0.44",
        "time*604800/604800 - floor(time*604800/(3*604800))*3 lt 0.44",
        // Not even in time between its jumps.
        "(time - 3*floor(time/3))^2 lt 0.1936",
    ] {
        let system = one(&format!("piecewise(1, {schedule}, 0) - 0.5*x"));
        for method in METHODS {
            let solution = solved(&system, method, &points).unwrap_or_else(|trouble| panic!("{schedule}: {trouble}"));
            for (time, values) in points.iter().zip(&solution.values) {
                let off = (values[0] - exact(*time)).abs();
                // Ten tolerances: of decays between the doses, not of their edges.
                assert!(off < 1e-6 * exact(*time), "{schedule} {method:?} at {time}: {} {}", values[0], exact(*time));
            }
        }
    }
}

#[test]
fn a_schedule_is_kept_long_after_its_begin() {
    // Pulses from 100 002 to 100 098, which a look at every fortieth of a unit would pass over.
    let system = one("piecewise(1, rem(time, 3) lt 0.001, 0)");
    for method in METHODS {
        let options = SolveOptions { scheme: Scheme::OneStep(method), ..SolveOptions::default() };
        let solution = solve(&system, 1e5, 1e5 + 100.0, &[1e5 + 100.0], &options).expect("a schedule");
        // Edges of 33 pulses, each known to some tens of the last bits of 1e5, 1.5e-11.
        assert!((solution.values[0][0] - 0.033).abs() < 3e-8, "{method:?}: {:?}", solution.values);
    }
}

#[test]
fn cells_in_windows_have_each_pulse_of_a_schedule_too() {
    // A thousandth of a second every two: pulses begin at ends of windows, and end within them.
    for (schedule, exact) in [("rem(time, 2) lt 0.001", 0.003), ("time le 2", 2.0), ("time ge 2.05", 3.95)] {
        let system = one(&format!("piecewise(1, {schedule}, 0)"));
        let program = clocked(&system).expect("no circle");
        for cells in [1, 20] {
            let mut population = Population::new(&program, cells, Method::Rk45);
            let (tolerances, mut scratch) = (Tolerances::default(), PopulationScratch::default());
            for window in 0..60 {
                let span = [window, window + 1].map(|number| 0.1 * f64::from(number));
                let advanced = population.advance_by_clock(&program, span.into(), &tolerances, &mut scratch);
                advanced.unwrap_or_else(|trouble| panic!("{trouble}"));
            }
            for cell in 0..cells {
                let x = population.state(cell, 0);
                // What sums of 60 windows round, and what six edges are passed by.
                assert!((x - exact).abs() < 1e-13, "{schedule} {cells}: {x}");
            }
        }
    }
    // What depends on an input is another time for each cell, and left to the error estimate.
    let system = system(
        "<input id=\"begin\" default=\"1\"/><variable id=\"x\" initial=\"0\" rate=\"piecewise(1, time ge begin, 0)\"/>",
    );
    assert!(clocked(&system).expect("no circle").further.is_empty());
}

#[test]
fn a_day_by_a_rounded_sine_is_as_long_as_it_is() {
    // Light by a sine that is rounded up: half of each period, though nothing of it runs evenly.
    let system = one("ceil(sin(2*pi*time/24 + 0.001)/2)");
    for method in METHODS {
        let (x, steps) = end(&system, method, 96.0);
        // Eight switches, each to the last bits of where a sine is nothing: it varies by a quarter an hour, and no step meets a jump.
        assert!((x - 48.0).abs() < 1e-9 && steps < 400, "{method:?}: {x} in {steps} steps");
    }
}

#[test]
fn an_event_at_one_instant_of_a_schedule_happens_each_time() {
    let system = system(
        "<variable id=\"x\" initial=\"0\" rate=\"0\"/>\
         <event id=\"dose\" when=\"rem(time, 28) eq 27\"><set id=\"x\">x + 1</set></event>\
         <event id=\"end\" when=\"time gt 100\"><set id=\"x\">x + 10</set></event>",
    );
    let (x, _) = end(&system, Method::Rosenbrock, 200.0);
    assert_eq!(x, 7.0 + 10.0);
}

#[test]
fn what_comes_to_something_from_nothing_where_another_variable_passes_a_bound_does_so_there() {
    let system = system(
        "<variable id=\"x\" initial=\"0\" rate=\"piecewise(1 - 0.01*x, x + y gt 0.5, 0)\"/>\
         <variable id=\"y\" initial=\"0\" rate=\"0.01*(1 - y)\"/>",
    );
    // At a time of 69 the clock tells no steps apart that an error of 1e-14 of what is nothing would ask for, and none ends before it sees the jump, as the
    // bound is passed by what jumps as well.
    let exact = (1.0 - (-0.01 * (200.0 - 100.0 * 2.0_f64.ln())).exp()) / 0.01;
    for method in METHODS {
        let (x, steps) = end(&system, method, 200.0);
        // Ten tolerances: y is known to one where it passes its bound.
        assert!((x - exact).abs() < 1e-6 * exact && steps < 400, "{method:?}: {x} {exact} in {steps} steps");
    }
}

#[test]
fn what_stands_still_does_so_to_the_last_bit_at_all_points() {
    let system =
        system("<variable id=\"x\" initial=\"0.1\" rate=\"0\"/><variable id=\"y\" initial=\"1\" rate=\"-y\"/>");
    let points: Vec<f64> = (0..=1000).map(|point| 0.007 * f64::from(point)).collect();
    for method in METHODS {
        let solution = solved(&system, method, &points).expect("a decay");
        assert!(solution.values.iter().all(|values| values[0] == 0.1), "{method:?}");
    }
}

#[test]
fn no_step_is_longer_than_is_asked_for_so_that_a_narrow_pulse_of_a_variable_is_seen() {
    // Nothing happens but around y = 7, for two hundredths.
    let system = system(
        "<variable id=\"x\" initial=\"0\" rate=\"exp(-(y - 7)^2/0.0001)\"/><variable id=\"y\" initial=\"0\" rate=\"1\"/>",
    );
    let exact = 0.01 * std::f64::consts::PI.sqrt();
    for method in METHODS {
        let solved = |longest: f64| {
            let options = SolveOptions { scheme: Scheme::OneStep(method), longest, ..SolveOptions::default() };
            let solution = solve(&system, 0.0, 10.0, &[10.0], &options).unwrap_or_else(|trouble| panic!("{trouble}"));
            (solution.values[0][0], solution.work.steps)
        };
        let ((passed_over, few), (seen, many)) = (solved(f64::INFINITY), solved(0.005));
        assert!(passed_over < 0.5 * exact && few < 100 && many >= 2000, "{passed_over} {few} {many}");
        assert!((seen - exact).abs() < 1e-5 * exact, "{method:?}: {seen} {exact}");
    }
}

#[test]
fn a_pulse_faster_than_any_clock_tells_at_the_end_is_followed_from_the_start() {
    // Comes to rest within 1e-15 of a time of 100: of that the clock tells no 1e-14 apart in the end.
    let (x, _) = end(&one("1e6 - 5e16*x"), Method::Rosenbrock, 100.0);
    assert!((x - 2e-11).abs() < 1e-17, "{x}");
}

#[test]
fn what_grows_without_bound_or_is_driven_to_and_fro_is_told() {
    // Along a bound that it is driven to from both sides, it comes on in steps that its tolerance allows, and no farther than these are many.
    for (rate, time, within) in [("(1 + x)^2", 1.0, 1e-3), ("piecewise(1, x lt 0.5, -1)", 0.5, 0.1)] {
        for method in METHODS {
            let options =
                SolveOptions { scheme: Scheme::OneStep(method), max_steps: 20_000, ..SolveOptions::default() };
            let trouble = solve(&one(rate), 0.0, 2.0, &[2.0], &options).expect_err("no step is short enough");
            let known = matches!(trouble.reason, Reason::StepUnderflow | Reason::NotFinite | Reason::TooManySteps);
            assert!(known && (trouble.time - time).abs() < within, "{rate} {method:?}: {trouble}");
        }
    }
}
