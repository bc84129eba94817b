//! Delay differential equations: the method of steps against exact solutions and other methods.

use crate::sbml_models::{SYMBOLS, apply, math, rule, rules, time};
use pseudopod::equations::tree::System;
use pseudopod::equations::{self, eml};
use pseudopod::error::Source;
use pseudopod::ode::{Method, Scheme, SolveOptions, solve};
use std::sync::Arc;

/// The equations of a document with these parts.
fn system(parts: &str) -> System {
    let text = format!("<eml name=\"test\">{parts}</eml>");
    eml::read(Arc::new(Source { name: "test.eml".into(), text })).expect(parts).system
}

fn options(method: Method, relative: f64) -> SolveOptions {
    SolveOptions { scheme: Scheme::OneStep(method), relative, absolute: 1e-14, ..SolveOptions::default() }
}

/// The values of a quantity at the points.
fn values(system: &System, id: &str, points: &[f64], options: &SolveOptions) -> Vec<f64> {
    let until = points[points.len() - 1];
    let solution = solve(system, 0.0, until, points, options).unwrap_or_else(|trouble| panic!("{trouble}"));
    let number = system.find(id).expect(id) as usize;
    solution.values.iter().map(|row| row[number]).collect()
}

/// Points from 0 on, this far apart.
fn every(step: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|point| step * f64::from(point)).collect()
}

fn largest(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// y' = −y(t − 1) with y = 1 before: y = Σ (−1)^k (t − k + 1)^k / k! over all k with t ≥ k − 1.
fn unit_delay(time: f64) -> f64 {
    let mut sum = 0.0;
    let mut over = 1.0;
    for k in 0..40 {
        let past = time - f64::from(k) + 1.0;
        if k > 0 && past < 0.0 {
            break;
        }
        sum += if k == 0 { 1.0 } else { past.powi(k) / over };
        over *= -f64::from(k + 1);
    }
    sum
}

const ADAPTIVE: [Method; 3] = [Method::Rk45, Method::Rk65, Method::Rosenbrock];

#[test]
fn steps_that_choose_themselves_meet_the_polynomials_of_a_unit_delay() {
    let (system, points) = (system(r#"<variable id="y" initial="1" rate="-delay(y, 1)"/>"#), every(0.25, 40));
    let exact: Vec<f64> = points.iter().map(|&time| unit_delay(time)).collect();
    for method in ADAPTIVE {
        for relative in [1e-4, 1e-6, 1e-8, 1e-10] {
            let off = largest(&values(&system, "y", &points, &options(method, relative)), &exact);
            // Errors of some ten steps of each unit of time add up.
            assert!(off <= 3.0 * relative, "{method:?} at {relative:e}: {off:e}");
        }
    }
}

#[test]
fn fixed_steps_keep_their_order_whether_they_divide_the_delay_or_not() {
    let system = system(r#"<variable id="y" initial="1" rate="-delay(y, 1)"/>"#);
    let points = every(1.0, 5);
    let exact: Vec<f64> = points.iter().map(|&time| unit_delay(time)).collect();
    for (make, order) in [((|step| Method::Rk4 { step }) as fn(f64) -> Method, 4), (|step| Method::Euler { step }, 1)] {
        for step in [0.1, 0.07] {
            let off = [step, 0.5 * step, 0.25 * step]
                .map(|step| largest(&values(&system, "y", &points, &options(make(step), 1.0)), &exact));
            for (coarse, fine) in [(off[0], off[1]), (off[1], off[2])] {
                let found = (coarse / fine).log2();
                // Steps are cut at the breaks, so that their lengths do not halve to the last one.
                assert!((found - f64::from(order)).abs() < 0.25, "order {found} of {order}, steps of {step}: {off:?}");
            }
        }
    }
}

#[test]
fn errors_fall_with_the_tolerance_where_a_rate_depends_on_now_and_then() {
    // x' = −x(t − π/2) + (x − sin t)/2 is solved by x = sin t with the history sin t.
    let parts = r#"<parameter id="tau" value="pi/2"/>
        <variable id="x" initial="0" history="sin(time)" rate="-delay(x, tau) + 0.5*(x - sin(time))"/>
        <define id="then">delay(x^2, tau)</define>"#;
    let (system, points) = (system(parts), every(0.3, 20));
    let exact: Vec<f64> = points.iter().map(|time| time.sin()).collect();
    let then: Vec<f64> = points.iter().map(|time| time.cos().powi(2)).collect();
    for method in ADAPTIVE {
        for relative in [1e-5, 1e-7, 1e-9] {
            let (x, squares) = (
                values(&system, "x", &points, &options(method, relative)),
                values(&system, "then", &points, &options(method, relative)),
            );
            // The equation lets errors grow to e^3 = 20 times until then, and those of squares are twice as large.
            assert!(largest(&x, &exact) <= 40.0 * relative, "{method:?} at {relative:e}: {:e}", largest(&x, &exact));
            assert!(largest(&squares, &then) <= 80.0 * relative, "{method:?} at {relative:e}");
        }
    }
}

/// y' = −y(t − τ) with a decay that is much slower than the delay: y = exp(λt) with λ = −exp(−λτ), and steps are longer than the delay.
#[test]
fn steps_longer_than_the_delay_look_back_at_themselves() {
    let tau = 1e-3;
    let mut rate: f64 = -1.0;
    for _ in 0..60 {
        rate = -(-rate * tau).exp();
    }
    let parts = format!(r#"<variable id="y" initial="1" history="exp({rate:?}*time)" rate="-delay(y, {tau})"/>"#);
    let (system, points) = (system(&parts), every(0.5, 4));
    let exact: Vec<f64> = points.iter().map(|time| (rate * time).exp()).collect();
    for method in ADAPTIVE {
        let solution = solve(&system, 0.0, 2.0, &points, &options(method, 1e-6)).expect("a solution");
        let found: Vec<f64> = solution.values.iter().map(|row| row[0]).collect();
        assert!(largest(&found, &exact) <= 1e-5, "{method:?}: {:e}", largest(&found, &exact));
        assert!(solution.work.steps < 400, "{method:?} takes {} steps", solution.work.steps);
    }
}

#[test]
fn a_delay_may_depend_on_the_state() {
    // y = √(1 + t) looks back by τ = 3y²/4 to where it was y/2, so that y' = 1/(2y) = 1/(4 y(t − τ)).
    let parts = r#"<variable id="y" initial="1" history="sqrt(1 + time)" rate="1/(4*delay(y, 0.75*y^2))"/>"#;
    let (system, points) = (system(parts), every(0.5, 20));
    let exact: Vec<f64> = points.iter().map(|time| (1.0 + time).sqrt()).collect();
    for method in ADAPTIVE {
        for relative in [1e-5, 1e-7, 1e-9] {
            let off = largest(&values(&system, "y", &points, &options(method, relative)), &exact);
            // y grows to 3.3, and some ten steps add their errors up; where the delay has kinks, the error estimate alone finds them.
            assert!(off <= 20.0 * relative, "{method:?} at {relative:e}: {off:e}");
        }
    }
}

#[test]
fn a_jump_is_met_again_exactly_a_delay_later() {
    // u jumps at t = 0.35; y' = u(t − 1), and an event looks back at u, too.
    let parts = r#"<variable id="u" initial="0" rate="0"/><variable id="y" initial="0" rate="delay(u, 1)"/>
        <variable id="seen" initial="0" rate="0"/><define id="before">delay(u, 1)</define>
        <event when="time ge 0.35"><set id="u">2</set></event>
        <event when="delay(u, 1) gt 1"><set id="seen">time</set></event>"#;
    let system = system(parts);
    for method in ADAPTIVE.into_iter().chain([Method::Rk4 { step: 0.3 }, Method::Euler { step: 0.3 }]) {
        let points = [0.0, 1.0, 1.35, 2.0];
        let off = largest(&values(&system, "y", &points, &options(method, 1e-6)), &[0.0, 0.0, 0.0, 1.3]);
        assert!(off < 1e-14, "{method:?}: {off:e}");
        assert_eq!(values(&system, "before", &points, &options(method, 1e-6)), [0.0, 0.0, 2.0, 2.0]);
        assert_eq!(values(&system, "seen", &[2.0], &options(method, 1e-6)), [1.35]);
    }
}

#[test]
fn delays_in_delays_add_up() {
    let parts = r#"<define id="s">sin(time)</define><define id="one">delay(s, 0.5)</define>
        <define id="two">delay(one, 0.25) + delay(time, one - one)</define><variable id="x" initial="0" rate="delay(delay(s, 1), 2)"/>"#;
    let (system, points) = (system(parts), every(0.4, 10));
    let off = |id: &str, exact: &dyn Fn(f64) -> f64| {
        let exact: Vec<f64> = points.iter().map(|&time| exact(time)).collect();
        largest(&values(&system, id, &points, &options(Method::Rk65, 1e-9)), &exact)
    };
    assert!(off("two", &|time| (time - 0.75).sin() + time) < 1e-14);
    assert!(off("x", &|time| 3.0_f64.cos() - (time - 3.0).cos()) < 1e-8);
}

#[test]
fn what_looks_ahead_is_told() {
    let system = system(r#"<variable id="y" initial="0.5" rate="-delay(y, y)"/>"#);
    let at = |parts: &str| solve(&self::system(parts), 0.0, 3.0, &[3.0], &options(Method::Rk45, 1e-6));
    assert!(solve(&system, 0.0, 0.2, &[0.2], &options(Method::Rk45, 1e-6)).is_ok());
    let text = at(r#"<variable id="x" initial="0" rate="1"/><define id="y">delay(x, 1 - time)</define>"#)
        .unwrap_err()
        .to_string();
    assert!(text.contains("looks ahead") && text.contains("delay(x, 1 - time)"), "{text}");
    let trouble = solve(&system, 0.0, 1.0, &[], &SolveOptions { scheme: Scheme::Bdf, ..SolveOptions::default() });
    assert!(trouble.unwrap_err().to_string().contains("takes no delays"));
}

/// A chain x₁' = f(x_last(t − τ)) − µ x₁, x₂' = x₁ − µ x₂ … by the trapezoidal rule on grids that divide the delay, so that what is looked
/// back at lies on them. The value of the last at the end, to which three grids come by Richardson's extrapolation with an error of
/// the sixth order.
fn on_grids(until: f64, tau: f64, start: &[f64], decay: f64, made: &dyn Fn(f64) -> f64) -> f64 {
    let on_grid = |count: usize| {
        let h = tau / count as f64;
        let mut rows = vec![start.to_vec()];
        let past = |rows: &[Vec<f64>], at: usize| rows[at.saturating_sub(count)][start.len() - 1];
        for at in 0..(until / h).round() as usize {
            let (before, mut now) = (rows[at].clone(), Vec::new());
            let mut gain = made(past(&rows, at)) + made(past(&rows, at + 1));
            for (variable, old) in before.iter().enumerate() {
                now.push((old * (1.0 - 0.5 * h * decay) + 0.5 * h * gain) / (1.0 + 0.5 * h * decay));
                gain = old + now[variable];
            }
            rows.push(now);
        }
        rows[rows.len() - 1][start.len() - 1]
    };
    let [coarse, middle, fine] = [100, 200, 400].map(on_grid);
    let [first, second] = [(4.0 * middle - coarse) / 3.0, (4.0 * fine - middle) / 3.0];
    (16.0 * second - first) / 15.0
}

#[test]
fn hes1_oscillates_as_the_trapezoidal_rule_says() {
    let text = std::fs::read_to_string("eml/hes1.eml").expect("a document that ships");
    let system = eml::read(Arc::new(Source { name: "hes1.eml".into(), text })).expect("no fault").system;
    // 40 delays: some six periods.
    let made = |protein: f64| 1.0 / (1.0 + (protein / 100.0_f64).powi(5));
    let expected = on_grids(740.0, 18.5, &[3.0, 100.0], 0.03, &made);
    for method in ADAPTIVE {
        let found = values(&system, "P", &[740.0], &options(method, 1e-9))[0];
        // A hundred times the tolerance: phases of six periods add errors up.
        assert!((found / expected - 1.0).abs() < 1e-7, "{method:?}: {found}, not {expected}");
    }
}

#[test]
fn mackey_and_glass_agree_with_the_trapezoidal_rule() {
    let parts = r#"<variable id="x" initial="1.2" rate="0.2*delay(x, 17)/(1 + delay(x, 17)^10) - 0.1*x"/>"#;
    let made = |past: f64| 0.2 * past / (1.0 + past.powi(10));
    let expected = on_grids(17.0 * 12.0, 17.0, &[1.2], 0.1, &made);
    for method in ADAPTIVE {
        let found = values(&system(parts), "x", &[17.0 * 12.0], &options(method, 1e-9))[0];
        // A thousand times the tolerance: the course is chaotic, and errors add up over twelve delays and grow.
        assert!((found / expected - 1.0).abs() < 1e-6, "{method:?}: {found}, not {expected}");
    }
}

/// `delay` of something by 1, in MathML.
fn delayed(what: &str) -> String {
    format!(
        r#"<apply><csymbol encoding="text" definitionURL="{SYMBOLS}/delay"> d </csymbol>{what}<cn> 1 </cn></apply>"#
    )
}

/// SBML: before the start rates are 0, starts by formulas of the time hold, and what is defined follows.
#[test]
fn models_have_a_past_and_keep_it_when_they_are_written_as_eml() {
    let rate = format!(
        r#"<apply><csymbol encoding="text" definitionURL="{SYMBOLS}/rateOf"> r </csymbol><ci> p </ci></apply>"#
    );
    let start = math(&apply("times", &format!("<cn> 3 </cn>{}", time())));
    let all = [
        rule("rateRule", "p", "<cn> 4 </cn>"),
        rule("rateRule", "q", "<cn> 0 </cn>"),
        rule("assignmentRule", "R", &delayed(&rate)),
        rule("assignmentRule", "Q", &delayed("<ci> q </ci>")),
    ];
    let parameter = |id: &str| format!(r#"<parameter id="{id}" value="0" constant="false"/>"#);
    let text = format!(
        r#"<sbml xmlns="http://www.sbml.org/sbml/level3/version2/core" level="3" version="2"><model>
        <listOfParameters>{}</listOfParameters>
        <listOfInitialAssignments><initialAssignment symbol="q">{start}</initialAssignment></listOfInitialAssignments>
        {}</model></sbml>"#,
        ["p", "q", "R", "Q"].map(parameter).concat(),
        rules(&all)
    );
    let model = equations::read(Arc::new(Source { name: "model.xml".into(), text })).expect("a model").document;
    let text = eml::write(&model, "").text;
    let written = eml::read(Arc::new(Source { name: "written.eml".into(), text: text.clone() })).expect(&text).system;
    for system in [&model.system, &written] {
        let at = |id: &str, time: f64| values(system, id, &[time], &options(Method::Rosenbrock, 1e-9))[0];
        assert_eq!([at("R", 0.5), at("Q", 0.5), at("R", 1.5), at("Q", 1.5)], [0.0, -1.5, 4.0, 0.0], "{text}");
    }
}
