//! The test set of stiff and other hard problems, against its published answers, and a published oscillator.

use crate::ode_problems::{martiel_goldbeter, system};
use crate::shared::shared;
use pseudopod::ode::{Method, OdeTrouble, Reason, Scheme, SolveOptions, Work, solve};
use serde_json::Value;

fn json(path: &str) -> Option<Value> {
    let text = std::fs::read_to_string(shared(path)?).expect("a file");
    Some(serde_json::from_str(&text).expect("the data is JSON"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number")).collect()
}

/// Fewest correct digits of all variables (relative to each), and the work.
fn digits(name: &str, scheme: Scheme, relative: f64, absolute: f64) -> Option<(f64, Work)> {
    let data = json(&format!("ivp-testset/{name}.json"))?;
    let names: Vec<&str> = data["vars"].as_array()?.iter().filter_map(Value::as_str).collect();
    let (initial, times, wanted) = (numbers(&data["y0"]), numbers(&data["t"]), numbers(&data["ref"]));
    let rate = |name: &str| data["rhs"][name].as_str().expect("a rate for each variable");
    let variables: Vec<(&str, f64, &str)> =
        names.iter().zip(&initial).map(|(name, value)| (*name, *value, rate(name))).collect();
    let parameters: Vec<(&str, f64)> = data["par"]
        .as_object()?
        .iter()
        .map(|(name, value)| (name.as_str(), value.as_f64().unwrap_or(f64::NAN)))
        .collect();
    let system = system(name, &variables, &parameters);
    let options = SolveOptions { scheme, relative, absolute, ..SolveOptions::default() };
    let solution =
        solve(&system, times[0], times[1], &[times[1]], &options).unwrap_or_else(|trouble| panic!("{trouble}"));
    let error = wanted.iter().zip(&solution.values[0]).map(|(wanted, found)| (found / wanted - 1.0).abs());
    Some((-error.fold(0.0, f64::max).log10(), solution.work))
}

const ROSENBROCK: Scheme = Scheme::OneStep(Method::Rosenbrock);
const RK45: Scheme = Scheme::OneStep(Method::Rk45);
const RK65: Scheme = Scheme::OneStep(Method::Rk65);
/// The default. Small enough for the smallest answer that is followed for itself, 2e-8 in Robertson's problem.
const ABSOLUTE: f64 = 1e-14;

#[test]
fn hard_problems_are_solved_to_six_digits_and_their_work_is_known() {
    let mut table = String::from("problem   method      steps  refused  rates  factorisations\n");
    for (name, label, scheme) in [
        ("vdpol", "Rosenbrock", ROSENBROCK),
        ("rober", "Rosenbrock", ROSENBROCK),
        ("pleiades", "Rosenbrock", ROSENBROCK),
        ("pleiades", "RK45", RK45),
        ("pleiades", "RK65", RK65),
    ] {
        let Some((digits, work)) = digits(name, scheme, 1e-8, ABSOLUTE) else { return };
        println!("{name} {label} {digits:.2}");
        assert!(digits >= 6.0, "{name} with {label}: {digits:.2} digits");
        let Work { steps, rejected, rates, jacobians, .. } = work;
        // No function of the system's library is called, so that the counts are the same on every machine.
        table += &format!("{name:<9} {label:<10} {steps:>6} {rejected:>8} {rates:>6} {jacobians:>15}\n");
    }
    insta::assert_snapshot!(table, @"
    problem   method      steps  refused  rates  factorisations
    vdpol     Rosenbrock   6280       19  37795            6299
    rober     Rosenbrock   1730        1  10387            1731
    pleiades  Rosenbrock   3712       53  22591            3765
    pleiades  RK45          683       24   4243               0
    pleiades  RK65          474       42   4129               0
    ");
}

#[test]
fn the_solvers_of_diffsol_agree_on_the_hard_problems() {
    for (name, scheme, least) in [
        ("vdpol", Scheme::Bdf, 6.0),
        ("rober", Scheme::Bdf, 5.5),
        ("vdpol", Scheme::Esdirk34, 5.0),
        ("pleiades", Scheme::Tsit45, 5.5),
    ] {
        let absolute = if scheme == Scheme::Esdirk34 { 1e-8 } else { ABSOLUTE };
        let Some((digits, work)) = digits(name, scheme, 1e-8, absolute) else { return };
        assert!(digits >= least && work.rates > work.steps, "{name} with {scheme:?}: {digits:.2} digits, {work:?}");
    }
}

#[test]
fn the_cyclic_amp_oscillator_keeps_its_published_run() {
    let Some(data) = json("martiel-goldbeter/reference.json") else { return };
    let times = numbers(&data["t"]);
    let fine: Vec<f64> = (0..=60_000).map(|n| 0.002 * f64::from(n)).collect();
    for scheme in [ROSENBROCK, RK45, RK65] {
        let options = SolveOptions { scheme, relative: 1e-9, absolute: 1e-11, ..SolveOptions::default() };
        let solution = solve(&martiel_goldbeter(), 0.0, 120.0, &fine, &options).expect("an oscillator");
        for (number, name) in ["rho", "beta", "gamma"].iter().enumerate() {
            let (wanted, row) = (numbers(&data[*name]), |time: f64| (time / 0.002).round() as usize);
            let size = wanted.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            for (time, wanted) in times.iter().zip(&wanted) {
                let found = solution.values[row(*time)][number];
                assert!((found - wanted).abs() < 1e-4 * size, "{name} at {time}: {found} instead of {wanted}");
            }
        }
        // Upward passages of gamma through 1.
        let gamma: Vec<f64> = solution.values.iter().map(|values| values[2]).collect();
        let rises: Vec<f64> = (1..gamma.len())
            .filter(|&n| gamma[n - 1] < 1.0 && gamma[n] >= 1.0)
            .map(|n| fine[n - 1] + 0.002 * (1.0 - gamma[n - 1]) / (gamma[n] - gamma[n - 1]))
            .collect();
        let period = (rises[rises.len() - 1] - rises[2]) / (rises.len() - 3) as f64;
        let wanted = data["period_min"].as_f64().expect("a period");
        // The reference was read off a grid of about 1e-3.
        assert!((period - wanted).abs() < 2e-3, "{period} instead of {wanted}");
    }
}

const E5: [(&str, f64, &str); 4] = [
    ("y1", 1.76e-3, "0-A*y1-B*y1*y3"),
    ("y2", 0.0, "A*y1-M*C*y2*y3"),
    ("y3", 0.0, "A*y1-B*y1*y3-M*C*y2*y3+C*y4"),
    ("y4", 0.0, "B*y1*y3-C*y4"),
];

/// E5 of the test set of Bari and CWI: the reactions keep y2 = y3 + y4, and all three fall from 10⁻¹⁰ to 9·10⁻²³.
fn e5(variables: &[(&str, f64, &str)], (relative, absolute): (f64, f64)) -> Result<Vec<f64>, OdeTrouble> {
    let system = system("E5", variables, &[("A", 7.89e-10), ("B", 1.1e7), ("C", 1.13e3), ("M", 1e6)]);
    let options = SolveOptions { relative, absolute, ..SolveOptions::default() };
    solve(&system, 0.0, 1e13, &[1e13], &options).map(|solution| solution.values[0].clone())
}

#[test]
fn a_value_of_which_round_off_leaves_no_digit_is_told_of() {
    for relative in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
        let trouble = e5(&E5, (relative, 1e-26)).expect_err("no digit is right");
        assert!(trouble.reason == Reason::RoundOff && trouble.time == 1e13, "{relative:e}: {trouble}");
        assert!(["y1", "y2", "y3"].contains(&trouble.variable.as_deref().unwrap_or_default()), "{trouble}");
    }
    // What is below the absolute tolerance is not asked for.
    assert!(e5(&E5, (1e-7, 1e-14)).is_ok());
    // With the sum in place of y2 nothing cancels.
    let third = E5[2].2.replace("y2", "(y3+y4)");
    let found = e5(&[E5[0], ("y3", 0.0, &third), E5[3]], (1e-7, 1e-26)).expect("all is known");
    assert!((found[1] / 8.861_234e-23 - 1.0).abs() < 1e-4 && found[2] < 1e-26, "{found:?}");
    // A decay is known to its digits however small it becomes.
    let decay = system("decay", &[("x", 1.0, "0-x")], &[]);
    let options = SolveOptions { relative: 1e-8, absolute: 1e-30, ..SolveOptions::default() };
    let left = solve(&decay, 0.0, 46.0, &[46.0], &options).expect("a decay").values[0][0];
    assert!((left / (-46.0_f64).exp() - 1.0).abs() < 1e-5, "{left:e}");
}

/// What diffuses along a chain of 1 000 compartments from the first, against its modes.
#[test]
fn a_long_chain_is_solved_as_its_modes_say() {
    const LENGTH: usize = 1000;
    let names: Vec<String> = (0..LENGTH).map(|i| format!("x{i}")).collect();
    let from_neighbours = |i: usize| {
        let near = [i.checked_sub(1), Some(i + 1).filter(|next| *next < LENGTH)].into_iter().flatten();
        near.map(|other| format!("k*(x{other} - x{i})")).collect::<Vec<_>>().join(" + ")
    };
    let rates: Vec<String> = (0..LENGTH).map(from_neighbours).collect();
    let at = |i: usize| (names[i].as_str(), f64::from(u8::from(i == 0)), rates[i].as_str());
    let variables: Vec<_> = (0..LENGTH).map(at).collect();
    let system = system("chain", &variables, &[("k", 100.0)]);
    let options = SolveOptions { scheme: ROSENBROCK, relative: 1e-8, absolute: 1e-12, ..SolveOptions::default() };
    let solution = solve(&system, 0.0, 10.0, &[10.0], &options).unwrap_or_else(|trouble| panic!("{trouble}"));
    for (i, found) in solution.values[0][..LENGTH].iter().enumerate() {
        let mode = |m: usize| {
            let wave = std::f64::consts::PI * m as f64 / LENGTH as f64;
            let share = if m == 0 { 1.0 } else { 2.0 };
            let decay = (-100.0 * 2.0 * (1.0 - wave.cos()) * 10.0).exp();
            share * (0.5 * wave).cos() * ((i as f64 + 0.5) * wave).cos() * decay
        };
        let wanted = (0..LENGTH).map(mode).sum::<f64>() / LENGTH as f64;
        assert!((found - wanted).abs() < 1e-9, "{i}: {found} for {wanted}");
    }
}
