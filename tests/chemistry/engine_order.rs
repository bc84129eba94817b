//! Every method converges with the order that is claimed for it, and populations agree with single solves.

use crate::ode_problems::{self, martiel_goldbeter, system, van_der_pol_pair};
use pseudopod::equations::program::Program;
use pseudopod::ode::{Method, Population, PopulationScratch, Reason, Scheme, SolveOptions, Tolerances, solve};

/// Errors at the end, and work in steps, of a system with known answer for a list of tolerances or steps.
fn errors(schemes: &[(Scheme, f64)]) -> Vec<(f64, f64)> {
    // x = exp(sin t), y = exp(5 sin t): not autonomous, not linear.
    let rates = [("x", 1.0, "y^0.2*cos(t)"), ("y", 1.0, "5*x^5*cos(t)")];
    let system = system("pair", &rates, &[]);
    let error = |&(scheme, relative): &(Scheme, f64)| {
        let options = SolveOptions { scheme, relative, absolute: relative, ..SolveOptions::default() };
        let solution = solve(&system, 0.0, 1.0, &[1.0], &options).expect("a smooth problem");
        let exact = [1.0_f64.sin().exp(), (5.0 * 1.0_f64.sin()).exp()];
        let error = (0..2).map(|v| (solution.values[0][v] / exact[v] - 1.0).abs()).fold(0.0, f64::max);
        (error, solution.work.steps as f64)
    };
    schemes.iter().map(error).collect()
}

#[test]
fn fixed_steps_converge_with_their_order() {
    for (order, scheme) in [
        (4.0, (|step| Scheme::OneStep(Method::Rk4 { step })) as fn(f64) -> Scheme),
        (1.0, |step| Scheme::OneStep(Method::Euler { step })),
    ] {
        let found = errors(&[(scheme(1.0 / 80.0), 1e-6), (scheme(1.0 / 160.0), 1e-6)]);
        let slope = (found[0].0 / found[1].0).log2();
        assert!((slope - order).abs() < 0.15, "order {slope} instead of {order}");
    }
}

#[test]
fn adaptive_methods_converge_with_their_order() {
    for (order, method, tight) in
        [(5.0, Method::Rk45, 1e-11), (6.0, Method::Rk65, 1e-11), (4.0, Method::Rosenbrock, 1e-10)]
    {
        let scheme = Scheme::OneStep(method);
        let found = errors(&[(scheme, 1e-6), (scheme, tight)]);
        let slope = (found[0].0 / found[1].0).ln() / (found[1].1 / found[0].1).ln();
        // Steps vary in length, so the number of steps gives the order only roughly; it may be better where they fall well.
        assert!(slope > order - 0.6, "{method:?}: order {slope} instead of {order}: {found:?}");
    }
}

#[test]
fn steps_of_equal_length_converge_with_the_order_of_their_method() {
    // Growth that saturates. The leading error of Verner's pair is so small that in other problems the next ones hide it.
    let program = Program::new(&system("logistic", &[("x", 0.1, "x*(1-x)")], &[])).expect("no circles");
    let exact = |t: f64| 1.0 / (1.0 + 9.0 * (-t).exp());
    // With tolerances so loose every window is one step, but for the first, which finds its length and begins at −h.
    let any = Tolerances { relative: 1e9, absolute: 1e9, ..Tolerances::default() };
    for (order, method) in [(5.0, Method::Rk45), (6.0, Method::Rk65), (4.0, Method::Rosenbrock)] {
        let error = |steps: u32| {
            let at = |number: i32| 6.0 * f64::from(number) / f64::from(steps);
            let (mut cell, mut scratch) = (Population::new(&program, 1, method), PopulationScratch::default());
            cell.set_state(0, 0, exact(at(-1)));
            for number in -1..steps as i32 {
                let work = cell.advance(&program, at(number), at(number + 1), &any, &mut scratch);
                let work = work.expect("a smooth problem");
                assert!(number < 0 || work.steps == 1, "{method:?}: {} steps", work.steps);
            }
            (cell.state(0, 0) / exact(6.0) - 1.0).abs()
        };
        // Longer steps show more than the leading error, shorter ones show round-off.
        let slope = (error(24) / error(48)).log2();
        assert!((slope - order).abs() < 0.4, "{method:?}: order {slope}, not {order}");
    }
}

#[test]
fn values_between_steps_are_as_good_as_the_steps() {
    let rates = [("x", 0.0, "y"), ("y", 1.0, "0-x")];
    let system = system("circle", &rates, &[]);
    let points: Vec<f64> = (0..=1000).map(|n| 0.01 * f64::from(n)).collect();
    for (method, bound) in
        [(Method::Rk45, 1e-7), (Method::Rk65, 1e-7), (Method::Rosenbrock, 1e-6), (Method::Rk4 { step: 0.01 }, 1e-8)]
    {
        let options =
            SolveOptions { scheme: Scheme::OneStep(method), relative: 1e-8, absolute: 1e-8, ..Default::default() };
        let solution = solve(&system, 0.0, 10.0, &points, &options).expect("a circle");
        assert_eq!(solution.times, points);
        let error = points.iter().zip(&solution.values).map(|(t, values)| (values[0] - t.sin()).abs());
        let worst = error.fold(0.0, f64::max);
        assert!(worst < bound, "{method:?}: {worst:e}");
    }
}

#[test]
fn populations_agree_with_single_solves() {
    for (system, method) in [
        (van_der_pol_pair(1.0), Method::Rk45),
        (martiel_goldbeter(), Method::Rk65),
        (martiel_goldbeter(), Method::Rosenbrock),
    ] {
        let program = Program::new(&system).expect("no circles");
        let (mut population, mut scratch) = (Population::new(&program, 20, method), PopulationScratch::default());
        let tolerances = Tolerances { relative: 1e-8, absolute: 1e-10, ..Tolerances::default() };
        for window in 0..40 {
            let (from, until) = (0.1 * f64::from(window), 0.1 * f64::from(window + 1));
            let advanced = population.advance(&program, from, until, &tolerances, &mut scratch);
            advanced.expect("oscillators do not blow up");
        }
        let options = SolveOptions { relative: 1e-10, absolute: 1e-12, ..SolveOptions::default() };
        let solution = solve(&system, 0.0, 4.0, &[4.0], &options).expect("oscillators do not blow up");
        for v in 0..program.size() {
            let (found, wanted) = (population.state(19, v), solution.values[0][v]);
            // The error of 1e-8 a step grows over the steps to t = 4.
            assert!((found - wanted).abs() < 1e-5 * (1.0 + wanted.abs()), "{}: {found} {wanted}", system.name);
            let mut values = vec![0.0; 20];
            population.observe(&program, program.variables[v], 4.0, &mut values);
            assert_eq!(values[19], found);
        }
    }
}

/// A crowd in which every cell starts elsewhere, after ten windows, on some threads.
fn crowd(cells: std::ops::Range<usize>, method: Method, threads: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
    let program = Program::new(&van_der_pol_pair(20.0)).expect("no circles");
    let mut population = Population::new(&program, cells.len(), method);
    for (index, cell) in cells.clone().enumerate() {
        (0..4).for_each(|v| population.set_state(index, v, (cell as f64 * 0.37 + v as f64).sin() * 2.0));
    }
    pool.install(|| {
        let mut scratch = PopulationScratch::default();
        for window in 0..10 {
            let (from, until) = (0.1 * f64::from(window), 0.1 * f64::from(window + 1));
            let advanced = population.advance(&program, from, until, &Tolerances::default(), &mut scratch);
            advanced.expect("oscillators do not blow up");
        }
    });
    (0..cells.len())
        .flat_map(|cell| (0..4).map(move |v| (cell, v)))
        .map(|(c, v)| population.state(c, v).to_bits())
        .collect()
}

#[test]
fn a_cell_is_the_same_to_the_last_bit_alone_or_in_a_crowd_on_any_threads() {
    for method in [Method::Rk45, Method::Rk65, Method::Rosenbrock, Method::Rk4 { step: 0.01 }] {
        let many = crowd(0..10_001, method, 2);
        assert!(many == crowd(0..10_001, method, 1), "{method:?}: one thread and two differ");
        for cell in [0, 15, 777, 10_000] {
            // One and two are advanced one by one, three side by side.
            for count in (1..=3).filter(|count| cell + count <= 10_001) {
                let few = crowd(cell..cell + count, method, 1);
                assert_eq!(few, many[4 * cell..4 * (cell + count)], "{method:?}, {count} from cell {cell}");
            }
        }
    }
}

#[test]
fn trouble_names_cell_time_and_variable_and_spares_the_neighbours() {
    let system = system("bomb", &[("calm", 1.0, "0-calm"), ("growth", 0.1, "growth^2")], &[]);
    let program = Program::new(&system).expect("no circles");
    for method in [Method::Rk45, Method::Rk65, Method::Rosenbrock] {
        let mut population = Population::new(&program, 40, method);
        population.set_state(30, 1, 2.0); // 1/(0.5 − t)
        population.set_state(20, 1, 1.25); // 1/(0.8 − t)
        let (tolerances, mut scratch) = (Tolerances::default(), PopulationScratch::default());
        let trouble = population.advance(&program, 0.0, 1.0, &tolerances, &mut scratch).expect_err("it blows up");
        assert_eq!((trouble.cell, trouble.variable.as_deref()), (Some(20), Some("growth")), "{method:?}: {trouble}");
        assert!((trouble.time - 0.8).abs() < 1e-6, "{method:?}: {trouble}");
        assert!(population.state(20, 1).is_finite(), "the last good state is kept");
        assert!((population.state(21, 0) - (-1.0_f64).exp()).abs() < 1e-5, "the neighbour has arrived");
        let mut pair = Population::new(&program, 2, method);
        pair.set_state(0, 1, 2.0);
        let trouble = pair.advance(&program, 0.0, 1.0, &tolerances, &mut scratch).expect_err("it blows up");
        assert_eq!((trouble.cell, trouble.variable.as_deref()), (Some(0), Some("growth")), "{method:?}: {trouble}");
        assert!((pair.state(1, 0) - (-1.0_f64).exp()).abs() < 1e-5, "the other has arrived");
    }
    let options = SolveOptions::default();
    let trouble = solve(&system, 0.0, 100.0, &[], &options).expect_err("it blows up at 10");
    assert!((trouble.time - 10.0).abs() < 1e-6 && trouble.variable.as_deref() == Some("growth"), "{trouble}");
    let hole = ode_problems::system("hole", &[("x", 0.0, "1/(x-x)")], &[]);
    let trouble = solve(&hole, 0.0, 1.0, &[], &options).expect_err("division by zero");
    assert_eq!(trouble.reason, Reason::NotFinite, "{trouble}");
}

#[test]
fn inputs_differ_between_cells() {
    use pseudopod::equations::tree::{Expr, Role};
    let mut system = system("driven", &[("x", 0.0, "k")], &[("k", 1.0)]);
    system.quantities[1] = ode_problems::quantity("k", Role::Input, 1.0);
    assert_eq!(system.quantities[0].role, Role::Variable { rate: Expr::Quantity(1) });
    let program = Program::new(&system).expect("no circles");
    let mut population = Population::new(&program, 33, Method::Rk45);
    (0..33).for_each(|cell| population.set_open(cell, 0, cell as f64));
    let mut scratch = PopulationScratch::default();
    population.advance(&program, 0.0, 2.0, &Tolerances::default(), &mut scratch).expect("a straight line");
    (0..33)
        .for_each(|cell| assert!((population.state(cell, 0) - 2.0 * cell as f64).abs() < 1e-12 * (1.0 + cell as f64)));
}

#[test]
fn rates_kept_between_windows_change_no_bit() {
    use pseudopod::equations::tree::Role;
    // Driven by an input, and by the clock.
    let driven = |rate: &str| {
        let mut system = system("driven", &[("x", 1.0, "y"), ("y", 0.0, rate)], &[("k", 1.0)]);
        system.quantities[2] = ode_problems::quantity("k", Role::Input, 1.0);
        system
    };
    let cases = [Method::Rk45, Method::Rk65].into_iter();
    let cases = cases.flat_map(|method| [(method, "k*(1-x^2)*y-x", true), (method, "k*cos(3*t)-x", false)]);
    for (method, rate, keeps) in cases {
        let program = Program::new(&driven(rate)).expect("no circles");
        let mut kept = Population::new(&program, 37, method);
        (0..37).for_each(|cell| kept.set_state(cell, 1, 0.1 * cell as f64));
        let (mut anew, mut scratch) = (kept.clone(), PopulationScratch::default());
        let (mut work, mut all) = (0, 0);
        for window in 0..12 {
            let (from, until) = (0.3 * f64::from(window), 0.3 * f64::from(window + 1));
            for cell in 0..37 {
                // Some inputs and states change, most are set to what they are.
                let input = if cell % 5 == 0 { 1.0 + 0.1 * f64::from(window) } else { 1.0 };
                let jump = if (cell + window as usize).is_multiple_of(9) { 0.5 } else { 0.0 };
                for population in [&mut kept, &mut anew] {
                    population.set_open(cell, 0, input);
                    population.set_state(cell, 0, population.state(cell, 0) + jump);
                }
            }
            let tolerances = Tolerances::default();
            work += kept.advance(&program, from, until, &tolerances, &mut scratch).expect("it stays small").rates;
            let mut empty = PopulationScratch::default();
            all += anew.advance(&program, from, until, &tolerances, &mut empty).expect("it stays small").rates;
            for (cell, v) in (0..37).flat_map(|cell| [(cell, 0), (cell, 1)]) {
                let (a, b) = (kept.state(cell, v), anew.state(cell, v));
                assert_eq!(a.to_bits(), b.to_bits(), "{rate}, window {window}, cell {cell}: {a} and {b}");
            }
            assert!(kept == anew);
        }
        assert_eq!(work < all, keeps, "{rate}: {work} and {all} evaluations");
    }
}

#[test]
fn a_population_may_use_the_scratch_of_any_other() {
    let [slow, fast] = ["k-x", "k-2*x"].map(|rate| {
        let mut system = system("decay", &[("x", 1.0, rate)], &[("k", 0.0)]);
        system.quantities[1] = ode_problems::quantity("k", pseudopod::equations::tree::Role::Input, 0.0);
        Program::new(&system).expect("no circles")
    });
    for method in [Method::Rk45, Method::Rk65, Method::Rosenbrock, Method::Euler { step: 0.01 }] {
        // Populations of two programs and of many sizes, one after the other, with one scratch and each with a fresh one.
        let make = |cells: usize, program: &Program| {
            let mut population = Population::new(program, cells, method);
            (0..cells).for_each(|cell| population.set_open(cell, 0, (cell as f64).sin()));
            population
        };
        let sizes = [(1, &slow), (2, &fast), (40, &slow), (40, &fast), (33, &fast), (2, &slow)];
        let start: Vec<(Population, &Program)> = sizes.iter().map(|&(cells, p)| (make(cells, p), p)).collect();
        let end = |share: bool| -> Vec<Population> {
            let (mut all, mut shared) = (start.clone(), PopulationScratch::default());
            for window in 0..4 {
                let (from, until) = (f64::from(window), f64::from(window + 1));
                for (population, program) in &mut all {
                    let mut own = PopulationScratch::default();
                    let scratch = if share { &mut shared } else { &mut own };
                    population.advance(program, from, until, &Tolerances::default(), scratch).expect("a decay");
                }
            }
            all.into_iter().map(|(population, _)| population).collect()
        };
        assert_eq!(end(true), end(false), "{method:?}");
    }
}

#[test]
fn rates_of_another_program_do_not_count() {
    let [slow, fast] =
        ["0-x", "0-2*x"].map(|rate| Program::new(&system("decay", &[("x", 1.0, rate)], &[])).expect("no circles"));
    let (mut cells, mut scratch) = (Population::new(&slow, 3, Method::Rk45), PopulationScratch::default());
    cells.advance(&slow, 0.0, 1.0, &Tolerances::default(), &mut scratch).expect("a decay");
    cells.advance(&fast, 1.0, 2.0, &Tolerances::default(), &mut scratch).expect("a decay");
    // Twenty tolerances.
    assert!((cells.state(1, 0) - (-3.0_f64).exp()).abs() < 2e-5, "{}", cells.state(1, 0));
}
