//! Machine code gives the bits of register code, cell by cell and fault by fault.

mod every_function;
mod ode_problems;

use ode_problems::{goldbeter_per, martiel_goldbeter, van_der_pol_pair};
use pseudopod::equations::program::Program;
use pseudopod::equations::tree::{Binary, Expr, Role, System};
use pseudopod::ode::tableau::{rodas, tsitouras, verner};
use pseudopod::ode::{Method, OdeTrouble, Population, Reason, Tolerances, Work};

/// The methods that have machine code.
const METHODS: [Method; 3] = [Method::Rk45, Method::Rk65, Method::Rosenbrock];

/// The program of a system, and the same with machine code; says whether there can be some here.
fn programs(system: &System) -> (Program, Program) {
    let [plain, code] = [(); 2].map(|()| Program::new(system).expect("no circles"));
    let small = plain.size() <= 64 && plain.rates.ops.len() <= 500;
    for tableau in [&tsitouras::TABLEAU, &verner::TABLEAU] {
        // It waits for fewer windows than these.
        let made = (0..20_000).any(|_| code.pair_step(tableau).is_some());
        assert_eq!(made, small, "on a machine that allows no code in memory this file compares nothing");
    }
    let made = (0..20_000).any(|_| code.rosenbrock_step(&rodas::TABLEAU).is_some());
    assert_eq!(made, small && system.name != "dense", "{}", system.name);
    (plain, code)
}

/// All that a cell takes on: state, next step.
fn bits(population: &Population, cell: usize, variables: usize) -> Vec<u64> {
    let state = (0..variables).map(|v| population.state(cell, v).to_bits());
    state.chain([population.next_step(cell).to_bits()]).collect()
}

/// What came of a window, as far as it can be compared: a number that is none is equal to itself.
fn told(result: Result<Work, OdeTrouble>) -> String {
    match result {
        Ok(work) => format!("{work:?}"),
        Err(trouble) => format!("{trouble}"),
    }
}

#[test]
fn every_function_gives_the_same_bits() {
    let odd = [0.0, -0.0, 1.0, -2.5, 5e-324, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    let points = every_function::POINTS.into_iter().chain(odd.into_iter().flat_map(|a| odd.map(|b| (a, b))));
    let points: Vec<(f64, f64)> = points.collect();
    for expression in every_function::functions() {
        let other = every_function::unary(pseudopod::equations::tree::Unary::Neg, expression.clone());
        let (plain, code) = programs(&every_function::system(expression.clone(), other));
        for (&(x, y), method) in points.iter().flat_map(|point| METHODS.map(|method| (point, method))) {
            let [one, two] = [&plain, &code].map(|program| {
                let mut cell = Population::new(program, 1, method);
                cell.set_state(0, 0, x);
                cell.set_state(0, 1, y);
                let few = Tolerances { max_steps: 20, ..Tolerances::default() };
                let ends = [0.0, 1e-3, 0.1].windows(2).map(|w| told(cell.advance(program, w[0], w[1], &few))).collect();
                (ends, bits(&cell, 0, 2))
            });
            let same: (Vec<String>, Vec<u64>) = two;
            assert_eq!(one, same, "{expression:?} at {x}, {y}, {method:?}");
        }
    }
}

/// A system driven by an input and by the clock.
fn driven() -> System {
    let rates = [("x", 1.0, "y"), ("y", 0.0, "k*(1-x^2)*y-x+0.3*cos(3*t)"), ("z", 2.0, "exp(0-x)-z/(1+x^2)")];
    let mut system = ode_problems::system("driven", &rates, &[("k", 5.0)]);
    system.quantities[3] = ode_problems::quantity("k", Role::Input, 5.0);
    system
}

/// Amounts in a compartment so small that their absolute tolerance is not that of the others.
fn compartments() -> System {
    let rates = [("a", 2e-3, "0-a*b/V+0.2*b"), ("b", 1.0, "0.5-0.3*b*a/V"), ("c", 3e-3, "a-c*(1+c/V)")];
    let mut system = ode_problems::system("compartments", &rates, &[("V", 2e-3)]);
    for (id, amount) in [("dense_a", 0), ("dense_c", 2)] {
        let rule = Expr::Binary(Binary::Div, Box::new(Expr::Quantity(amount)), Box::new(Expr::Quantity(3)));
        system.quantities.push(ode_problems::quantity(id, Role::Defined { rule }, 0.0));
    }
    system
}

/// A system whose rows are exchanged: what x does to y is far larger than what it does to itself.
fn exchanging() -> System {
    let rates = [("x", 1.0, "0.1*y-x+0.2*sin(t)"), ("z", 0.3, "x-z^2"), ("y", 0.5, "100000*(x-y)+z")];
    ode_problems::system("exchanging", &rates, &[])
}

#[test]
fn a_few_cells_in_machine_code_are_those_of_a_crowd_in_lanes() {
    let problems = [
        (van_der_pol_pair(20.0), 0.3),
        (goldbeter_per(), 0.5),
        (martiel_goldbeter(), 0.5),
        (driven(), 0.4),
        (compartments(), 0.4),
        (exchanging(), 0.4),
    ];
    for (system, window) in problems {
        let (plain, code) = programs(&system);
        if system.name == "compartments" {
            assert_eq!(plain.sizes, [2e-3, 1.0, 2e-3]);
        }
        let (n, open) = (plain.size(), plain.open.len());
        let tight = [1e-3, 1e-6, 1e-10].into_iter();
        // Explicit pairs take thousands of steps for what is stiff.
        let fits = |method: &Method| system.name != "exchanging" || *method == Method::Rosenbrock;
        for (relative, method) in
            tight.flat_map(|relative| METHODS.map(|method| (relative, method))).filter(|(_, method)| fits(method))
        {
            let tolerances = Tolerances { relative, absolute: relative, ..Tolerances::default() };
            let mut crowd = Population::new(&plain, 19, method);
            let initial: Vec<f64> = (0..n).map(|v| crowd.state(0, v)).collect();
            let start = |cell: usize, v: usize| initial[v] * (1.0 + 0.5 * (cell as f64 * 0.37 + v as f64).sin());
            let mut few: Vec<Population> = [1, 2, 5, 8].map(|count| Population::new(&code, count, method)).into();
            for population in few.iter_mut().chain([&mut crowd]) {
                (0..population.cells())
                    .for_each(|cell| (0..n).for_each(|v| population.set_state(cell, v, start(cell, v))));
            }
            let mut rejected = 0;
            for number in 0..120 {
                let (from, until) = (window * f64::from(number), window * f64::from(number + 1));
                for population in few.iter_mut().chain([&mut crowd]) {
                    // Inputs change now and then, and states jump.
                    let cells = 0..population.cells();
                    cells.clone().for_each(|cell| {
                        (0..open).for_each(|o| population.set_given(cell, o, 4.0 + f64::from(number / 3) * 0.2));
                    });
                    if number % 3 == 1 {
                        let jump = |cell: usize| 0.3 + 0.1 * (cell as f64 + f64::from(number)).sin();
                        cells.for_each(|cell| population.set_state(cell, 0, population.state(cell, 0) + jump(cell)));
                    }
                    let program = if population.cells() > 8 { &plain } else { &code };
                    let work = population.advance(program, from, until, &tolerances).expect("oscillators stay");
                    rejected += work.rejected;
                }
                for population in &few {
                    for cell in 0..population.cells() {
                        let (one, many) = (bits(population, cell, n), bits(&crowd, cell, n));
                        assert_eq!(one, many, "{}, {method:?}, {relative}, window {number}, cell {cell}", system.name);
                    }
                }
            }
            assert!(
                rejected > 0 || relative > 1e-4,
                "{}, {method:?}, {relative}: no step was ever refused",
                system.name
            );
        }
    }
}

#[test]
fn trouble_is_the_same_trouble() {
    let bomb = ode_problems::system("bomb", &[("calm", 1.0, "0-calm"), ("growth", 1.25, "growth^2")], &[]);
    let hole = ode_problems::system("hole", &[("x", 1.0, "1/(x-x)")], &[]);
    let root = ode_problems::system("root", &[("x", 1.0, "0-1+0.01*ln(x)")], &[]);
    for (system, reason, max_steps) in [
        (&bomb, Reason::StepUnderflow, 100_000),
        (&bomb, Reason::TooManySteps, 12),
        (&hole, Reason::NotFinite, 100_000),
        (&root, Reason::NotFinite, 100_000),
    ] {
        let (plain, code) = programs(system);
        let tolerances = Tolerances { max_steps, ..Tolerances::default() };
        for (cells, method) in [1, 3].into_iter().flat_map(|cells| METHODS.map(|method| (cells, method))) {
            let [(one, a), (two, b)] = [&plain, &code].map(|program| {
                let mut population = Population::new(program, cells, method);
                let trouble = population.advance(program, 0.0, 3.0, &tolerances).expect_err("there is no way on");
                (trouble, bits(&population, cells - 1, program.size()))
            });
            assert_eq!((&one, a), (&two, b), "{} with {cells} cells by {method:?}", system.name);
            assert_eq!(two.cell, Some(0), "{two}");
            // What grows without bound ends the Rosenbrock method by a value or by a step, as it comes.
            assert!(two.reason == reason || method == Method::Rosenbrock, "{two}");
        }
    }
}

#[test]
fn large_systems_have_large_frames_and_very_large_ones_no_code() {
    for count in [63, 64, 65] {
        // A chain in which each variable pulls the next.
        let names: Vec<String> = (0..count).map(|v| format!("x{v}")).collect();
        let rates: Vec<String> = (0..count).map(|v| format!("x{}-2*x{v}+0.1*x{v}^2", (v + 1) % count)).collect();
        let variables: Vec<(&str, f64, &str)> =
            (0..count).map(|v| (&*names[v], 1.0 / (1.0 + v as f64), &*rates[v])).collect();
        let (plain, code) = programs(&ode_problems::system("chain", &variables, &[]));
        for method in METHODS {
            let [one, two] = [&plain, &code].map(|program| {
                let mut population = Population::new(program, 1, method);
                population.advance(program, 0.0, 2.0, &Tolerances::default()).expect("a decay");
                bits(&population, 0, count)
            });
            assert_eq!(one, two, "{count} variables by {method:?}");
        }
    }
}

#[test]
fn systems_in_which_all_depends_on_all_have_no_code_for_their_matrices() {
    let count = 24;
    let names: Vec<String> = (0..count).map(|v| format!("x{v}")).collect();
    let sum = names.join("+");
    let rates: Vec<String> = names.iter().map(|name| format!("0.1*({sum})-5*{name}")).collect();
    let variables: Vec<(&str, f64, &str)> = names.iter().zip(&rates).map(|(n, r)| (&**n, 1.0, &**r)).collect();
    let (plain, code) = programs(&ode_problems::system("dense", &variables, &[]));
    let [one, two] = [&plain, &code].map(|program| {
        let mut population = Population::new(program, 1, Method::Rosenbrock);
        population.advance(program, 0.0, 1.0, &Tolerances::default()).expect("a decay");
        bits(&population, 0, count)
    });
    assert_eq!(one, two);
}

#[test]
fn threads_share_the_code_and_it_outlives_the_program_it_was_cloned_from() {
    let (plain, code) = programs(&van_der_pol_pair(5.0));
    let run = |program: &Program| {
        let mut population = Population::new(program, 1, Method::Rk45);
        for window in 0..500 {
            let from = 0.1 * f64::from(window);
            population.advance(program, from, from + 0.1, &Tolerances::default()).expect("an oscillator");
        }
        bits(&population, 0, 4)
    };
    let clone = code.clone();
    drop(code);
    let wanted = run(&plain);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| run(&clone))).collect();
        threads.into_iter().for_each(|thread| assert_eq!(thread.join().expect("no panic"), wanted));
    });
}
