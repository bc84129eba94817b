//! Noise of populations: moments, weak order, and whose numbers kick whom.

use pseudopod::equations::eml;
use pseudopod::equations::program::Program;
use pseudopod::error::Source;
use pseudopod::ode::{Method, Noise, Numbers, Pace, Population, PopulationScratch, Substep, Substeps, Tolerances};
use std::sync::Arc;

/// A system with noise, compiled.
struct System {
    program: Program,
    noise: Noise,
}

fn system(variables: &str) -> System {
    let text = format!("<eml name=\"test\" level=\"cell\"><input id=\"s\" default=\"0.7\"/>{variables}</eml>");
    let document =
        eml::read(Arc::new(Source { name: "test.eml".into(), text })).unwrap_or_else(|error| panic!("{error}"));
    let noise = Noise::new(&document).expect("no circle").expect("some noise");
    System { program: Program::new(&document.system).expect("no circle"), noise }
}

/// The seed of all tests here.
const NUMBERS: Numbers = Numbers { seed: 1, system: "test" };

impl System {
    fn cells(&self, count: usize, method: Method) -> Population {
        Population::new(&self.program, count, method)
    }

    /// Moves cells with these ids through windows of some length, kicked every so often, and shows them after each window.
    fn run(
        &self,
        population: &mut Population,
        ids: &[u64],
        (pace, window, windows): (f64, f64, usize),
        mut each: impl FnMut(usize, &Population),
    ) {
        let (mut kicks, mut scratch, tolerances) = (0, PopulationScratch::default(), Tolerances::default());
        for number in 0..windows {
            let (from, until) = (number as f64 * window, (number + 1) as f64 * window);
            let mut substeps = Substeps::between(Pace::Every(pace), kicks, from, until);
            for Substep { begin, end, kick, .. } in substeps.by_ref() {
                if let Some(kick) = kick {
                    population
                        .kick(&self.noise, NUMBERS, ids.iter().copied(), (begin, kick), &mut scratch)
                        .expect("numbers");
                }
                population.advance(&self.program, begin, end, &tolerances, &mut scratch).expect("no trouble");
            }
            kicks = substeps.kicks();
            each(number, population);
        }
    }
}

fn ids(count: usize) -> Vec<u64> {
    (0..count as u64).collect()
}

fn values(population: &Population, variable: usize) -> Vec<f64> {
    (0..population.cells()).map(|cell| population.state(cell, variable)).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// Mean and variance of numbers whose true mean is known.
fn moments(values: &[f64], true_mean: f64) -> (f64, f64) {
    (mean(values.iter().copied()), mean(values.iter().map(|x| (x - true_mean).powi(2))))
}

/// Whether a number is within three standard errors, beside what it is known to be off by.
fn check(what: &str, found: f64, expected: f64, (error, bias): (f64, f64)) {
    println!("{what}: {found:.6}, expected {expected:.6}: {:.2} standard errors", (found - expected) / error);
    assert!((found - expected).abs() <= 3.0 * error + bias.abs(), "{what}: {found}, not {expected} ± {error}");
}

/// dX = −k X dt + s dW from X = 2, with k = 1 and s = 0.7.
const OU: &str = "<variable id=\"x\" initial=\"2\" rate=\"-x\" noise=\"s\"/>";

#[test]
fn mean_variance_and_correlation_of_ornstein_and_uhlenbeck_come_out() {
    let (n, h, s) = (20_000, 0.02, 0.7_f64);
    let system = system(OU);
    let mut cells = system.cells(n, Method::Rk45);
    // From 2: at t = 1 the mean has fallen and the variance grown; at t = 6 (e^-12 from it) the variance is that of rest.
    let (mut early, mut rest, mut later) = (Vec::new(), Vec::new(), Vec::new());
    system.run(&mut cells, &ids(n), (h, 0.5, 13), |window, now| match window {
        1 => early = values(now, 0),
        11 => rest = values(now, 0),
        12 => later = values(now, 0),
        _ => {}
    });
    // Kicks of variance s² h, each followed by decay: a geometric series, and its limit for short steps.
    let step = |t: f64| s * s * h * (-2.0 * h).exp() * (1.0 - (-2.0 * t).exp()) / (1.0 - (-2.0 * h).exp());
    let exact = |t: f64| s * s / 2.0 * (1.0 - (-2.0 * t).exp());
    for (t, found) in [(1.0_f64, &early), (6.0, &rest)] {
        let expected = 2.0 * (-t).exp();
        let (average, variance) = moments(found, expected);
        let (of_mean, of_variance) = ((step(t) / n as f64).sqrt(), step(t) * (2.0 / n as f64).sqrt());
        check(&format!("mean at {t}"), average, expected, (of_mean, 0.0));
        check(&format!("variance at {t}, of these steps"), variance, step(t), (of_variance, 0.0));
        check(&format!("variance at {t}"), variance, exact(t), (of_variance, step(t) - exact(t)));
    }
    let rho = (-0.5_f64).exp();
    let product = mean(rest.iter().zip(&later).map(|(a, b)| a * b));
    let error = exact(6.0) * ((1.0 + rho * rho) / n as f64).sqrt();
    let bias = step(6.0) - exact(6.0);
    check("correlation after 0.5", product, exact(6.0) * rho, (error, bias));
}

/// dX = µ X dt + s X dW as Itô reads it, from X = 1, with µ = 0.3 and s = 0.7.
const GROWTH: &str = "<variable id=\"x\" initial=\"1\" rate=\"0.3*x\" noise=\"s*x\"/>";

#[test]
fn multiplicative_noise_is_that_of_ito() {
    let (n, h, s, mu) = (20_000, 0.02, 0.7_f64, 0.3_f64);
    let system = system(GROWTH);
    let mut cells = system.cells(n, Method::Rk45);
    let mut found = Vec::new();
    system.run(&mut cells, &ids(n), (h, 1.0, 1), |_, now| found = values(now, 0));
    // A kick has no mean; what Stratonovich reads would grow by e^(s²/2) more, 28 %.
    let second = |power: i32| ((1.0 + s * s * h) * (2.0 * mu * h).exp()).powi(power);
    // The fourth moment of 1 + a with a normal of variance v: 1 + 6 v + 3 v².
    let v = s * s * h;
    let fourth = ((1.0 + 6.0 * v + 3.0 * v * v) * (4.0 * mu * h).exp()).powi(50);
    let (first, count) = (mu.exp(), n as f64);
    let (average, square) = (mean(found.iter().copied()), mean(found.iter().map(|x| x * x)));
    check("mean", average, first, (((second(50) - first * first) / count).sqrt(), 0.0));
    let error = ((fourth - second(50).powi(2)) / count).sqrt();
    check("square, of these steps", square, second(50), (error, 0.0));
    let limit = (2.0 * mu + s * s).exp();
    check("square", square, limit, (error, second(50) - limit));
}

/// The mean, and its standard error, of what the square of the solution in steps is beyond that of the solution of the equation that has the same
/// kicks, `exact(their sum so far, kick)` from step to step.
fn excess(text: &str, (h, n): (f64, usize), exact: impl Fn(f64, f64) -> f64, start: f64) -> (f64, f64) {
    let system = system(text);
    let mut cells = system.cells(n, Method::Rk45);
    let steps = (1.0 / h).round() as usize;
    system.run(&mut cells, &ids(n), (h, 1.0, 1), |_, _| ());
    let normals = NUMBERS.of("x");
    let differences: Vec<f64> = (0..n)
        .map(|cell| {
            let path = (0..steps as u64).fold(start, |x, kick| exact(x, normals.one(kick, cell as u32, 0)));
            cells.state(cell, 0).powi(2) - path * path
        })
        .collect();
    let average = mean(differences.iter().copied());
    let variance = mean(differences.iter().map(|d| (d - average).powi(2)));
    (average, (variance / n as f64).sqrt())
}

#[test]
fn steps_err_in_the_mean_as_the_formula_says_which_is_of_weak_order_one() {
    let s = 0.7_f64;
    let additive = |h: f64| {
        // The equation over a step is a normal number of this variance.
        let spread = (s * s / 2.0 * (1.0 - (-2.0 * h).exp())).sqrt();
        let found = excess(OU, (h, 20_000), |x, xi| x * (-h).exp() + spread * xi, 2.0);
        let variance = |per_kick: f64| per_kick * (1.0 - (-2.0_f64).exp()) / (1.0 - (-2.0 * h).exp());
        (found, variance(s * s * h * (-2.0 * h).exp()) - variance(spread * spread))
    };
    let multiplicative = |h: f64| {
        let path = |x: f64, xi: f64| x * ((0.3 - s * s / 2.0) * h + s * h.sqrt() * xi).exp();
        let found = excess(GROWTH, (h, 200_000), path, 1.0);
        let steps = (1.0 / h).round();
        let square = ((1.0 + s * s * h) * (0.6 * h).exp()).powf(steps);
        (found, square - (0.6 + s * s).exp())
    };
    for (name, error) in
        [("additive", &additive as &dyn Fn(f64) -> ((f64, f64), f64)), ("multiplicative", &multiplicative)]
    {
        let errors = [0.2, 0.1, 0.05].map(error);
        for ((found, own), expected) in errors {
            check(&format!("{name}: error of the square"), found, expected, (own, 0.0));
        }
        // The errors that steps make are those of the formula, told from none by the coarsest step: six standard errors or more.
        let ((_, own), expected) = errors[0];
        assert!(expected.abs() > 6.0 * own, "{name}: {expected} ± {own}");
        for (pair, h) in errors.windows(2).zip([0.2, 0.1]) {
            let [(one, exact_one), (two, exact_two)] = [pair[0], pair[1]];
            let exact = (exact_one / exact_two).log2();
            // The next order of the error is as large as a step times what it is multiplied by, below 1 here.
            assert!((exact - 1.0).abs() < h, "{name}: the formula is of order {exact}");
            let own = ((one.1 / one.0).hypot(two.1 / two.0)) / std::f64::consts::LN_2;
            check(&format!("{name}: order"), (one.0 / two.0).log2(), exact, (own, 0.0));
        }
    }
}

/// Two variables that feed each other, with noise of both kinds that reads an input.
const PAIR: &str = "<variable id=\"u\" initial=\"1\" rate=\"v - u^3\" noise=\"0.2*s\"/>
    <variable id=\"v\" initial=\"0.5\" rate=\"u - v\" noise=\"0.3*v + 0.1*time\"/>";

#[test]
fn a_cell_is_kicked_alike_alone_and_among_others_and_with_any_threads() {
    let system = system(PAIR);
    let course = (0.1, 0.25, 8);
    let run = |ids: &[u64], threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let mut cells = system.cells(ids.len(), Method::Rk45);
        pool.install(|| system.run(&mut cells, ids, course, |_, _| ()));
        cells
    };
    let all = run(&ids(100), 1);
    assert_eq!(all, run(&ids(100), 3), "threads");
    let some = [3, 17, 18, 99];
    let among = run(&some, 1);
    let alone = run(&[17], 1);
    for (cell, &id) in some.iter().enumerate() {
        for variable in 0..2 {
            let bits = |cells: &Population, cell: usize| cells.state(cell, variable).to_bits();
            assert_eq!(bits(&all, id as usize), bits(&among, cell), "cell {id}");
            assert!(id != 17 || bits(&among, cell) == bits(&alone, 0), "alone");
        }
    }
}

#[test]
fn the_kicks_do_not_depend_on_how_time_is_cut_into_windows() {
    let system = system(PAIR);
    let run = |window: f64, windows: usize| {
        let mut cells = system.cells(40, Method::Rk4 { step: 0.01 });
        system.run(&mut cells, &ids(40), (0.1, window, windows), |_, _| ());
        cells
    };
    let (long, short) = (run(2.0, 1), run(0.125, 16));
    for cell in 0..40 {
        for variable in 0..2 {
            // Inner steps of the classical method differ: their errors are of 0.01⁴.
            let (a, b) = (long.state(cell, variable), short.state(cell, variable));
            assert!((a - b).abs() < 1e-7 * (1.0 + a.abs()), "{a} and {b}");
        }
    }
}

#[test]
fn a_kick_of_what_is_no_number_is_told() {
    let system = system("<variable id=\"x\" initial=\"1\" rate=\"0\" noise=\"sqrt(x - 2)\"/>");
    let mut cells = system.cells(20, Method::Rosenbrock);
    let mut scratch = PopulationScratch::default();
    for Substep { begin, kick, .. } in Substeps::new(Pace::EachWindow, 0, 0.0, 1.0) {
        let kick = kick.expect("a kick");
        let trouble = cells.kick(&system.noise, NUMBERS, 0..20, (begin, kick), &mut scratch);
        let told = trouble.expect_err("no number").to_string();
        let words = ["of cell 0 ", "not finite", "variable 'x'", "(of its noise)"];
        assert!(words.iter().all(|word| told.contains(word)), "{told}");
    }
}
