//! Amounts that come to nothing where rates are roots and broken powers of them: no rate is known below, and stages get there.

use crate::ode_problems::system;
use pseudopod::equations::program::Program;
use pseudopod::ode::{LANES, Method, Population, PopulationScratch, Reason, Scheme, SolveOptions, Tolerances, solve};

/// A vessel that runs out by Torricelli's law, into another: the height is (1 − t/2)², and nothing from t = 2 on.
fn height(time: f64) -> f64 {
    (1.0 - 0.5 * time).max(0.0).powi(2)
}

fn options(relative: f64) -> SolveOptions {
    let scheme = Scheme::OneStep(Method::Rosenbrock);
    SolveOptions { scheme, relative, absolute: 1e-3 * relative, ..SolveOptions::default() }
}

#[test]
fn a_vessel_runs_out_and_stays_empty() {
    let vessel = system("vessel", &[("x", 1.0, "0-sqrt(x)"), ("y", 0.0, "sqrt(x)")], &[]);
    let times: Vec<f64> = (1..=30).map(|n| 0.2 * f64::from(n)).collect();
    for relative in [1e-4, 1e-6, 1e-8] {
        let solution = solve(&vessel, 0.0, 6.0, &times, &options(relative)).expect("it runs out");
        for (time, values) in times.iter().zip(&solution.values) {
            let off = [values[0] - height(*time), values[1] - 1.0 + height(*time)].map(f64::abs);
            // Ten tolerances: what some ten steps until it is empty may add up to.
            assert!(values[0] >= 0.0 && off.into_iter().all(|off| off < 10.0 * relative), "{time}: {values:?}");
        }
        // Steps that ever shorter ones near nothing would need are thousands.
        assert!(solution.work.steps < 400, "{:?}", solution.work);
    }
}

/// The classical method in many steps, with no power of what is below nothing.
fn in_small_steps(rates: impl Fn(f64, [f64; 3]) -> [f64; 3], until: f64) -> [f64; 3] {
    let (count, mut y) = ((until / 1e-3).round() as usize, [0.0; 3]);
    let step = until / count as f64;
    for number in 0..count {
        let time = step * number as f64;
        let at = |share: f64, k: [f64; 3]| rates(time + share * step, [0, 1, 2].map(|i| y[i] + share * step * k[i]));
        let one = at(0.0, [0.0; 3]);
        let two = at(0.5, one);
        let three = at(0.5, two);
        let four = at(1.0, three);
        y = [0, 1, 2].map(|i| y[i] + step / 6.0 * (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i]));
    }
    y
}

#[test]
fn broken_powers_of_what_begins_at_nothing_or_comes_to_it_are_solved() {
    // A substrate that a cooperative enzyme uses up, its product, and two that begin at nothing and feed on each other.
    let problem = system(
        "powers",
        &[("s", 1.0, "0-5*s^0.7"), ("p", 0.0, "5*s^0.7 - p^1.3"), ("a", 0.0, "1 - a^0.4"), ("b", 0.0, "a^1.4 - b^0.6")],
        &[],
    );
    // s^0.3 falls evenly, and is nothing from t = 2/3 on.
    let left = |time: f64| (1.0 - 1.5 * time).max(0.0).powf(1.0 / 0.3);
    let power = |base: f64, exponent: f64| base.max(0.0).powf(exponent);
    let rates = |time: f64, [p, a, b]: [f64; 3]| {
        [5.0 * power(left(time), 0.7) - power(p, 1.3), 1.0 - power(a, 0.4), power(a, 1.4) - power(b, 0.6)]
    };
    let times = [0.5, 5.0, 10.0];
    let solution = solve(&problem, 0.0, 10.0, &times, &options(1e-7)).expect("it is solved");
    for (time, found) in times.into_iter().zip(&solution.values) {
        let [p, a, b] = in_small_steps(rates, time);
        for (found, wanted) in found.iter().zip([left(time), p, a, b]) {
            // The small steps are off by 10⁻⁵ at the first instant, from where they begin at nothing (steps a tenth as long by a tenth of that).
            assert!((found - wanted).abs() < 3e-5 * wanted + 1e-9, "{found} for {wanted} at {time}");
        }
    }
}

#[test]
fn cells_that_run_out_stay_empty_and_the_others_do_not_notice() {
    let vessel = system("vessel", &[("x", 1.0, "0-sqrt(x)"), ("y", 0.0, "sqrt(x)")], &[]);
    let program = Program::new(&vessel).expect("no circles");
    let (mut scratch, cells) = (PopulationScratch::default(), LANES + 5);
    let mut all = Population::new(&program, cells, Method::Rosenbrock);
    // The first is empty after 0.2 s, the last after 6 s.
    let start = |cell: usize| (0.1 + 2.9 * cell as f64 / (cells - 1) as f64).powi(2);
    (0..cells).for_each(|cell| all.set_state(cell, 0, start(cell)));
    let mut alone = Population::new(&program, 1, Method::Rosenbrock);
    alone.set_state(0, 0, start(cells - 2));
    for window in 0..50 {
        let (from, until) = (0.1 * f64::from(window), 0.1 * f64::from(window + 1));
        all.advance(&program, from, until, &Tolerances::default(), &mut scratch).expect("they run out");
        alone.advance(&program, from, until, &Tolerances::default(), &mut scratch).expect("it runs out");
        assert_eq!(all.state(cells - 2, 0).to_bits(), alone.state(0, 0).to_bits(), "window {window}");
        for cell in 0..cells {
            let wanted = (start(cell).sqrt() - 0.5 * until).max(0.0).powi(2);
            let x = all.state(cell, 0);
            // The largest begin at 9, of which a step may err by 9·10⁻⁶.
            assert!(x >= 0.0 && (x - wanted).abs() < 1e-5, "{cell} at {until}: {x} for {wanted}");
        }
    }
}

#[test]
fn what_earlier_steps_left_below_nothing_counts_as_nothing() {
    // The power is no number below nothing; what is there is 10⁻³⁰ of what anyone asks for.
    let from = |x: f64| {
        let late = system("late", &[("x", x, "k*y - x"), ("y", 1.0, "0-x^1.3 - y")], &[("k", 0.5)]);
        solve(&late, 0.0, 2.0, &[2.0], &options(1e-8)).map(|solution| solution.values[0].clone())
    };
    let (left, nothing) = (from(-1e-30).expect("it is solved"), from(0.0).expect("it is solved"));
    for (found, wanted) in left.iter().zip(nothing) {
        // Less than the absolute tolerance: nothing else is different.
        assert!((found - wanted).abs() < 1e-12, "{found} for {wanted}");
    }
    // What is below it by more than that is told.
    let trouble = from(-1e-6).expect_err("no power of what is below nothing");
    assert_eq!(trouble.reason, Reason::NotFinite, "{trouble}");
}

#[test]
fn what_runs_below_nothing_by_its_rate_is_told_and_not_hidden() {
    let falls = system("falls", &[("x", 0.5, "0-1"), ("y", 0.0, "sqrt(x)")], &[]);
    let trouble =
        solve(&falls, 0.0, 1.0, &[1.0], &options(1e-6)).expect_err("there is no root of what is below nothing");
    // It is nothing at t = 0.5, and is let go on by the absolute tolerance at most.
    assert!((trouble.time - 0.5).abs() <= 1e-9, "{trouble}");
    assert!(matches!(trouble.reason, Reason::NotFinite | Reason::StepUnderflow), "{trouble}");
}
