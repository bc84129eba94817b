//! Events against analytic answers, and their order, delay and persistence.

use std::collections::HashMap;

use crate::ode_problems::{self, expression, system};
use pseudopod::equations::tree::{Binary, Event, Expr, System};
use pseudopod::ode::{
    EventPlan, Eventful, Method, Numbers, Population, PopulationScratch, Reason, Scheme, SolveOptions, Tolerances,
    solve,
};

fn compare(function: Binary, a: Expr, b: Expr) -> Expr {
    Expr::Binary(function, Box::new(a), Box::new(b))
}

fn event(trigger: Expr, assignments: Vec<(u32, Expr)>) -> Event {
    Event {
        id: "event".into(),
        trigger,
        true_before_start: true,
        delay: None,
        priority: None,
        values_from_firing: true,
        persistent: true,
        assignments,
        schedule: None,
    }
}

fn on(system: &System, text: &str) -> Expr {
    let numbers: HashMap<String, u32> =
        system.quantities.iter().enumerate().map(|(number, quantity)| (quantity.id.clone(), number as u32)).collect();
    expression(text, &numbers)
}

const SCHEMES: [Scheme; 4] = [
    Scheme::OneStep(Method::Rosenbrock),
    Scheme::OneStep(Method::Rk45),
    Scheme::OneStep(Method::Rk65),
    Scheme::OneStep(Method::Rk4 { step: 0.01 }),
];

#[test]
fn a_ball_bounces_when_it_should() {
    let mut ball = system("ball", &[("x", 1.0, "v"), ("v", 0.0, "0-9.81"), ("bounces", 0.0, "0")], &[]);
    let down = compare(Binary::Lt, Expr::Quantity(0), Expr::Number(0.0));
    ball.events.push(event(down, vec![(1, on(&ball, "0-0.8*v")), (2, on(&ball, "bounces+1")), (0, Expr::Number(0.0))]));
    let fall = (2.0 / 9.81_f64).sqrt();
    // The n-th bounce is at fall·(1 + 2(0.8 + 0.8² + …)); between two the flight is a parabola.
    let mut bounces = vec![fall];
    for n in 1..6 {
        bounces.push(bounces[n - 1] + 2.0 * fall * 0.8_f64.powi(n as i32));
    }
    let middles: Vec<f64> = bounces.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    for scheme in SCHEMES {
        let options = SolveOptions { scheme, ..SolveOptions::default() };
        let solution = solve(&ball, 0.0, 3.0, &middles, &options).expect("a ball");
        for (n, values) in solution.values.iter().enumerate() {
            let height = 0.64_f64.powi(n as i32 + 1);
            // Parabolas are exact for every method; only the time of the bounce has an error of round-off.
            assert!((values[0] - height).abs() < 1e-10, "{scheme:?}: height {} instead of {height}", values[0]);
            assert!(values[1].abs() < 1e-9, "{scheme:?}: speed {} at the top", values[1]);
            assert_eq!(values[2], n as f64 + 1.0);
        }
    }
}

#[test]
fn the_clock_switches_at_its_time_and_points_show_the_values_after() {
    // k rises from 0 to 1 at t = 1 (≥), and after t = 2 (>) to 3.
    let mut switched = system("switched", &[("x", 0.0, "k")], &[("k", 0.0)]);
    switched.events.push(event(compare(Binary::Ge, Expr::Time, Expr::Number(1.0)), vec![(1, Expr::Number(1.0))]));
    switched.events.push(event(compare(Binary::Gt, Expr::Time, Expr::Number(2.0)), vec![(1, Expr::Number(3.0))]));
    for scheme in SCHEMES {
        let options = SolveOptions { scheme, ..SolveOptions::default() };
        let solution =
            solve(&switched, 0.0, 3.0, &[0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0], &options).expect("straight lines");
        let x: Vec<f64> = solution.values.iter().map(|values| values[0]).collect();
        let k: Vec<f64> = solution.values.iter().map(|values| values[1]).collect();
        assert_eq!(k, [0.0, 0.0, 1.0, 1.0, 1.0, 3.0, 3.0], "{scheme:?}");
        for (found, wanted) in x.iter().zip([0.0, 0.0, 0.0, 0.5, 1.0, 2.5, 4.0]) {
            assert!((found - wanted).abs() < 1e-12, "{scheme:?}: {x:?}");
        }
    }
}

#[test]
fn a_short_pulse_of_the_clock_is_not_missed() {
    let pulse = Expr::Piecewise {
        branches: vec![(
            compare(
                Binary::And,
                compare(Binary::Ge, Expr::Time, Expr::Number(50.0)),
                compare(Binary::Lt, Expr::Time, Expr::Number(50.001)),
            ),
            Expr::Number(1000.0),
        )],
        otherwise: Box::new(Expr::Number(0.0)),
    };
    let mut system = system("pulse", &[("x", 0.0, "0")], &[]);
    system.quantities[0] = ode_problems::quantity("x", pseudopod::equations::tree::Role::Variable { rate: pulse }, 0.0);
    for scheme in &SCHEMES[..2] {
        let options = SolveOptions { scheme: *scheme, ..SolveOptions::default() };
        let solution = solve(&system, 0.0, 100.0, &[49.0, 60.0], &options).expect("a step");
        assert_eq!(solution.values[0][0], 0.0);
        assert!((solution.values[1][0] - 1.0).abs() < 1e-9, "{scheme:?}: {}", solution.values[1][0]);
        assert!(solution.work.steps < 200, "{scheme:?}: {:?}", solution.work);
    }
}

/// Two counters that grow with the clock, and events set by the caller.
fn clocked(events: impl Fn(&System) -> Vec<Event>) -> Vec<f64> {
    let mut system = system("clocked", &[("x", 0.0, "1"), ("y", 0.0, "0"), ("z", 0.0, "0")], &[("k", 0.0)]);
    system.events = events(&system);
    let solution = solve(&system, 0.0, 10.0, &[10.0], &SolveOptions::default()).expect("straight lines");
    solution.values[0].clone()
}

#[test]
fn delays_take_values_from_the_firing_or_the_execution() {
    let after = || compare(Binary::Gt, Expr::Quantity(0), Expr::Number(2.0));
    let delayed = |values_from_firing| {
        clocked(|_| {
            vec![Event {
                delay: Some(Expr::Number(1.5)),
                values_from_firing,
                ..event(after(), vec![(1, Expr::Quantity(0))])
            }]
        })[1]
    };
    assert!((delayed(true) - 2.0).abs() < 1e-9 && (delayed(false) - 3.5).abs() < 1e-9);
}

#[test]
fn what_does_not_persist_is_dropped_when_its_trigger_falls() {
    let between = || {
        let begin = compare(Binary::Gt, Expr::Quantity(0), Expr::Number(2.0));
        compare(Binary::And, begin, compare(Binary::Lt, Expr::Quantity(0), Expr::Number(3.0)))
    };
    let delayed = |persistent, delay| {
        clocked(|_| {
            let plain = event(between(), vec![(1, Expr::Number(7.0))]);
            vec![Event { delay: Some(Expr::Number(delay)), persistent, ..plain }]
        })[1]
    };
    assert_eq!([delayed(true, 2.0), delayed(false, 2.0), delayed(false, 0.5)], [7.0, 0.0, 7.0]);
}

#[test]
fn the_larger_priority_goes_first_and_its_effects_count() {
    let after = || compare(Binary::Ge, Expr::Time, Expr::Number(2.0));
    let ordered = |first: f64, second: f64| {
        clocked(|system| {
            let double = event(after(), vec![(1, on(system, "y*2"))]);
            let add = event(after(), vec![(1, on(system, "y+3"))]);
            let priority = |value| Some(Expr::Number(value));
            vec![
                Event { priority: priority(first), values_from_firing: false, ..double },
                Event { priority: priority(second), values_from_firing: false, ..add },
            ]
        })[1]
    };
    assert_eq!([ordered(1.0, 2.0), ordered(2.0, 1.0)], [6.0, 3.0]);
}

#[test]
fn one_event_sets_off_another_and_one_at_the_start_counts() {
    let values = clocked(|system| {
        let start = compare(Binary::Lt, Expr::Quantity(0), Expr::Number(1.0));
        let y_above = compare(Binary::Gt, Expr::Quantity(1), Expr::Number(0.5));
        vec![
            Event { true_before_start: false, ..event(start, vec![(1, Expr::Number(1.0))]) },
            event(y_above, vec![(2, on(system, "z+1")), (3, Expr::Number(4.0))]),
        ]
    });
    assert_eq!(values[1..], [1.0, 1.0, 4.0]);
}

#[test]
fn events_without_end_are_trouble_with_a_name() {
    let mut system = system("flip", &[("x", 0.0, "1"), ("y", 0.0, "0")], &[]);
    let (up, down) = (compare(Binary::Gt, Expr::Quantity(1), Expr::Number(0.5)), "0");
    let late = compare(Binary::Gt, Expr::Quantity(0), Expr::Number(1.0));
    let low = compare(Binary::And, late, compare(Binary::Lt, Expr::Quantity(1), Expr::Number(0.5)));
    system.events = vec![event(low, vec![(1, Expr::Number(1.0))]), event(up, vec![(1, on(&system, down))])];
    let trouble = solve(&system, 0.0, 2.0, &[], &SolveOptions::default()).expect_err("they go on for ever");
    assert_eq!(trouble.reason, Reason::EndlessEvents, "{trouble}");
    assert!((trouble.time - 1.0).abs() < 1e-9, "{trouble}");
}

#[test]
fn a_parameter_that_an_event_sets_stays_set_from_window_to_window() {
    // k rises from its start to 1 at t = 1, and after x > 1.5 to 3.
    let mut switched = system("switched", &[("x", 0.0, "k")], &[("k", 0.0)]);
    switched.events.push(event(compare(Binary::Ge, Expr::Time, Expr::Number(1.0)), vec![(1, Expr::Number(1.0))]));
    let high = compare(Binary::Gt, Expr::Quantity(0), Expr::Number(1.5));
    switched.events.push(event(high, vec![(1, Expr::Number(3.0))]));
    let (program, plan) = EventPlan::compile(&switched, 0.0).expect("a program");
    for method in [Method::Rosenbrock, Method::Rk45, Method::Rk65, Method::Rk4 { step: 0.01 }] {
        let mut cells = Population::new(&program, 2, method);
        let (mut memories, mut scratch) = (vec![plan.before_start(0.0); 2], PopulationScratch::default());
        cells.set_open(1, 0, 0.5);
        let numbers = Numbers { seed: 1, system: "switched" };
        let one = Eventful { program: &program, plan: &plan, tolerances: Tolerances::default(), span: 4.0, numbers };
        for window in 0..10 {
            let (from, until) = (0.4 * f64::from(window), 0.4 * f64::from(window + 1));
            let moved = one.advance(&mut cells, &mut memories, 0..2, (from, until), &mut scratch);
            moved.expect("straight lines");
        }
        // 1.5 at 2.5 and 3·1.5 after; with 0.5 at the start 1.5 at 2 and 3·2 after.
        for (cell, end) in [(0, 6.0), (1, 7.5)] {
            assert_eq!(cells.open_value(cell, 0), 3.0, "{method:?}");
            assert!((cells.state(cell, 0) - end).abs() < 1e-9, "{method:?}: {}", cells.state(cell, 0));
        }
    }
}

/// Two events of one trigger and one priority, each of which undoes the other's trigger: one of them counts at each turn of the clock.
fn competing(priority: Option<f64>) -> System {
    let variables = [("x", 0.0, "1"), ("y", 0.0, "0"), ("z", 0.0, "0"), ("last", 0.0, "0")];
    let mut system = system("competing", &variables, &[]);
    for winner in ["y", "z"] {
        let trigger = compare(Binary::Ge, on(&system, "x-last"), Expr::Number(1.0));
        let target = system.find(winner).expect("a variable");
        let won = event(trigger, vec![(target, on(&system, &format!("{winner}+1"))), (3, on(&system, "x"))]);
        system.events.push(Event { persistent: false, priority: priority.map(Expr::Number), ..won });
    }
    system
}

#[test]
fn events_of_one_time_and_one_priority_go_in_an_order_at_random() {
    let counts = |priority, seed| {
        let options = SolveOptions { scheme: SCHEMES[1], seed, ..SolveOptions::default() };
        let solution = solve(&competing(priority), 0.0, 400.5, &[400.5], &options).expect("straight lines");
        (solution.values[0][1], solution.values[0][2])
    };
    let all = [0, 1, 2].map(|seed| counts(Some(1.0), seed));
    for (y, z) in all {
        // The standard deviation of the difference of 400 draws is 20.
        assert!(y + z == 400.0 && (y - z).abs() < 80.0, "{all:?}");
    }
    assert_eq!(all[1], counts(Some(1.0), 1), "a seed gives the same order again");
    assert!(all[0] != all[1] || all[1] != all[2], "{all:?}");
    assert_eq!(counts(None, 0), (400.0, 0.0), "without a priority the first to fire goes first");
}

#[test]
fn cells_choose_by_their_numbers_and_not_by_their_neighbours() {
    let system = competing(Some(2.0));
    let (program, plan) = EventPlan::compile(&system, 0.0).expect("a program");
    let numbers = Numbers { seed: 5, system: "competing" };
    let one = Eventful { program: &program, plan: &plan, tolerances: Tolerances::default(), span: 64.0, numbers };
    // How often the first event won, in windows of a length.
    let wins = |ids: &[u64], windows: u32| -> Vec<f64> {
        let mut cells = Population::new(&program, ids.len(), Method::Rk45);
        let (mut memories, mut scratch) = (vec![plan.before_start(0.0); ids.len()], PopulationScratch::default());
        for window in 0..windows {
            let [from, until] = [window, window + 1].map(|end| 64.0 * f64::from(end) / f64::from(windows));
            let moved = one.advance(&mut cells, &mut memories, ids.iter().copied(), (from, until), &mut scratch);
            moved.expect("straight lines");
        }
        (0..ids.len()).map(|cell| cells.state(cell, 1)).collect()
    };
    let all = wins(&[7, 3, 11, 4], 1);
    assert!(all.iter().any(|count| *count != all[0]), "{all:?}");
    assert_eq!([wins(&[3], 1)[0], wins(&[4], 1)[0]], [all[1], all[3]]);
}
