//! Algebraic equations: solved for where they are straight, else sought; courses against formulas and bisection, derivatives against
//! differences, lanes against each other.

use pseudopod::equations::program::{Program, run};
use pseudopod::equations::tree::{Expr, Role, System};
use pseudopod::equations::{self, eml, sbml};
use pseudopod::error::{Paint, Source, render};
use pseudopod::ode::{LANES, Method, Population, PopulationScratch, Scheme, SolveOptions, Tolerances, solve};
use std::sync::Arc;

fn read_text(text: &str) -> Result<eml::Document, String> {
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    equations::read(Arc::new(source)).map(|read| read.document).map_err(|error| render(&error, Paint::Plain))
}

fn read(body: &str) -> System {
    read_text(&format!("<eml name=\"m\">{body}</eml>")).unwrap_or_else(|message| panic!("{message}")).system
}

fn rule(system: &System, id: &str) -> Expr {
    match &system.quantities[system.find(id).expect(id) as usize].role {
        Role::Defined { rule } => rule.clone(),
        other => panic!("{id} is {other:?}"),
    }
}

fn is_searched(system: &System, id: &str) -> bool {
    matches!(rule(system, id), Expr::Root(..))
}

/// The values of some quantities at some times.
fn course<const N: usize>(system: &System, method: Method, times: &[f64], ids: [&str; N]) -> Vec<[f64; N]> {
    let options = SolveOptions { scheme: Scheme::OneStep(method), relative: 1e-11, ..SolveOptions::default() };
    let until = times.last().copied().expect("a time");
    let solution = solve(system, 0.0, until, times, &options).unwrap_or_else(|trouble| panic!("{trouble}"));
    let numbers = ids.map(|id| system.find(id).expect(id) as usize);
    solution.values.iter().map(|row| numbers.map(|number| row[number])).collect()
}

/// Where a function that grows is nothing.
fn bisected(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(middle) > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

const METHODS: [Method; 4] = [Method::Rosenbrock, Method::Rk45, Method::Rk65, Method::Rk4 { step: 1e-3 }];

#[test]
fn a_planet_is_where_keplers_equation_says() {
    // E is sought; W follows dE/dt = n/(1 - e cos E), whose integral E is.
    for e in [0.2, 0.9] {
        let system = read(&format!(
            r#"<parameter id="e" value="{e}"/><parameter id="n" value="2*pi/5"/><define id="M">n*time</define>
            <algebraic id="E" start="M + e*sin(M)">E - e*sin(E) = M</algebraic>
            <variable id="W" initial="0" rate="n/(1 - e*cos(E))"/>"#
        ));
        assert!(is_searched(&system, "E"));
        let times: Vec<f64> = (0..=40).map(|k| 0.25 * f64::from(k)).collect();
        for method in METHODS {
            for (time, [found, followed]) in times.iter().zip(course(&system, method, &times, ["E", "W"])) {
                let mean = 2.0 * std::f64::consts::PI / 5.0 * time;
                let exact = bisected(mean - 1.0, mean + 1.0, |x| x - e * x.sin() - mean);
                assert!((found - exact).abs() < 2e-14 * exact.max(1.0), "{e}, {time}: {found}, not {exact}");
                // Order 4 in steps of a thousandth near the sun, and what 1e-11 allows to the others.
                assert!((followed - exact).abs() < 1e-8, "{e}, {method:?}, {time}: {followed}, not {exact}");
            }
        }
    }
}

#[test]
fn a_complex_in_quasi_steady_state_is_the_root_of_its_quadratic() {
    // Total quasi-steady state: (E - C)(S - C) = K C, and the substrate in all, S, falls by k C.
    let formula = "((E + S + K) - sqrt((E + S + K)^2 - 4*E*S))/2";
    let body = |complex: &str| {
        format!(
            r#"<parameter id="E" value="0.8"/><parameter id="K" value="0.3"/><parameter id="k" value="2"/>{complex}
            <variable id="S" initial="1.7" rate="-k*C"/>"#
        )
    };
    let sought = read(&body(r#"<algebraic id="C" start="0">(E - C)*(S - C) = K*C</algebraic>"#));
    let known = read(&body(&format!("<define id=\"C\">{formula}</define>")));
    assert!(is_searched(&sought, "C"));
    let times: Vec<f64> = (0..=12).map(|k| 0.25 * f64::from(k)).collect();
    for method in METHODS {
        let both = [&sought, &known].map(|system| course(system, method, &times, ["S", "C"]));
        for (time, (one, other)) in times.iter().zip(both[0].iter().zip(&both[1])) {
            for (a, b) in one.iter().zip(other) {
                // The formula itself cancels four digits at the end.
                assert!((a - b).abs() < 1e-11, "{method:?} at {time}: {a}, not {b}");
            }
        }
    }
}

#[test]
fn what_is_straight_is_solved_for() {
    // In turn, through a definition, and together.
    let system = read(
        r#"<algebraic id="p">2*p + d = time</algebraic><define id="d">p + q</define><algebraic id="q">q = 3 - r</algebraic>
        <algebraic id="r">r*(1 + time) = 2</algebraic><variable id="y" initial="0" rate="p"/>
        <algebraic id="u">u + v = 3*time</algebraic><algebraic id="v">u - v = w</algebraic><define id="w">time + 1</define>"#,
    );
    assert!(["p", "q", "r", "u", "v"].iter().all(|id| !is_searched(&system, id)));
    for (time, found) in
        [0.0, 1.0, 3.0].iter().zip(course(&system, Method::Rk45, &[0.0, 1.0, 3.0], ["p", "q", "r", "u", "v"]))
    {
        let (r, t) = (2.0 / (1.0 + time), *time);
        let q = 3.0 - r;
        let wanted = [(t - q) / 3.0, q, r, 2.0 * t + 0.5, t - 0.5];
        found.iter().zip(wanted).for_each(|(a, b)| assert!((a - b).abs() < 1e-14, "{time}: {a}, not {b}"));
    }
    // Straight together, with slopes that may be nothing: rows change places.
    let system = read(
        r#"<parameter id="a" value="0"/><algebraic id="x">a*x + y = 2</algebraic><algebraic id="y">x*(1 + a) + 3*y = time</algebraic>
        <variable id="z" initial="0" rate="x"/>"#,
    );
    for (time, [x, y, z]) in [0.0, 2.0].iter().zip(course(&system, Method::Rosenbrock, &[0.0, 2.0], ["x", "y", "z"])) {
        assert!((x - (time - 6.0)).abs() < 1e-13 && (y - 2.0).abs() < 1e-14, "{x} {y}");
        assert!((z - (0.5 * time * time - 6.0 * time)).abs() < 1e-9, "{z}");
    }
}

/// Three equations of which none can be solved for, one through a definition; a fourth unknown uses what they determine.
const TANGLED: &str = r#"<parameter id="k" value="1.3"/><input id="s" default="0.4"/>
    <algebraic id="a" start="1">a^2*b + exp(-c) = 1 + x</algebraic>
    <algebraic id="b" start="1">b + d*b^3 = 2 + k*sin(time)</algebraic><define id="d">c*a</define>
    <algebraic id="c" start="0.5">c + 0.3*sin(a*b) = s + 0.1*y</algebraic>
    <algebraic id="last" start="1">last^3 + a*last = b + c</algebraic>
    <variable id="x" initial="1" rate="a - x*b"/><variable id="y" initial="0.5" rate="last - c*y + time*s"/>"#;

#[test]
fn derivatives_of_what_is_sought_are_those_of_differences() {
    let system = read(TANGLED);
    let program = Program::new(&system).expect("no circles");
    let rates = |time: f64, x: f64, y: f64| {
        let mut file = program.file::<1>();
        (file[0], file[1], file[2]) = ([time], [x], [y]);
        run(&program.linear, &mut file);
        program.linear.outputs.iter().map(|&output| file[output as usize][0]).collect::<Vec<f64>>()
    };
    let (h, at) = (1e-5, [0.7, 1.1, 0.6]);
    let all = rates(at[0], at[1], at[2]);
    for (which, name) in ["time", "x", "y"].iter().enumerate() {
        let moved = |by: f64| {
            let mut to = at;
            to[which] += by;
            rates(to[0], to[1], to[2])
        };
        let (above, below) = (moved(h), moved(-h));
        for row in 0..2 {
            let difference = (above[row] - below[row]) / (2.0 * h);
            let found = match which {
                0 => all[2 + row],
                column => {
                    let entry = program.pattern.iter().position(|entry| *entry == (row as u32, column as u32 - 1));
                    entry.map_or(0.0, |entry| all[4 + entry])
                }
            };
            // A difference errs by h² times a third derivative, of the size of ten here.
            assert!((found - difference).abs() < 1e-8, "rate {row} by {name}: {found}, not {difference}");
            assert!(difference.abs() > 1e-3, "rate {row} depends on {name}");
        }
    }
    // The equations hold, to round-off, and what evaluates the tree finds the same.
    let values = course(&system, Method::Rk45, &[0.0, 2.0], ["a", "b", "c", "d", "last", "x", "y"]);
    for ([a, b, c, d, last, x, y], time) in values.into_iter().zip([0.0_f64, 2.0]) {
        let residuals = [
            a * a * b + (-c).exp() - 1.0 - x,
            b + d * b.powi(3) - 2.0 - 1.3 * time.sin(),
            d - c * a,
            c + 0.3 * (a * b).sin() - 0.4 - 0.1 * y,
            last.powi(3) + a * last - b - c,
        ];
        assert!(residuals.iter().all(|residual| residual.abs() < 1e-13), "{residuals:?}");
    }
    let known = |number: u32| match system.quantities[number as usize].id.as_str() {
        "x" => 1.0,
        "y" => 0.5,
        "s" => 0.4,
        _ => 1.3,
    };
    let first = course(&system, Method::Rk45, &[0.0], ["a"])[0][0];
    assert!((rule(&system, "a").evaluate(0.0, &known) - first).abs() < 1e-13);
}

#[test]
fn a_cell_finds_the_same_bits_alone_and_among_others() {
    let program = Program::new(&read(TANGLED)).expect("no circles");
    let start = |cell: usize| [0.6 + 0.05 * cell as f64, 1.5 - 0.07 * cell as f64];
    let input = |cell: usize| 0.3 + 0.02 * cell as f64;
    let ended = |cells: &[usize], method: Method| {
        let mut population = Population::new(&program, cells.len(), method);
        for (index, &cell) in cells.iter().enumerate() {
            (0..2).for_each(|v| population.set_state(index, v, start(cell)[v]));
            population.set_open(index, 0, input(cell));
        }
        let mut scratch = PopulationScratch::default();
        population.advance(&program, 0.0, 3.0, &Tolerances::default(), &mut scratch).expect("a course");
        (0..cells.len()).map(|index| [0, 1].map(|v| population.state(index, v).to_bits())).collect::<Vec<_>>()
    };
    let all: Vec<usize> = (0..LANES + 3).collect();
    for method in METHODS {
        let together = ended(&all, method);
        for cell in [0, 5, LANES + 2] {
            assert_eq!(ended(&[cell], method)[0], together[cell], "{method:?}, cell {cell}");
        }
    }
}

#[test]
fn where_no_solution_is_left_the_unknown_is_named_with_the_time() {
    // x³ - 3x = y has its left root until y = 2.
    let fold = r#"<algebraic id="x" start="-2">x^3 - 3*x = y</algebraic><variable id="y" initial="-1" rate="1"/>"#;
    let system = read(fold);
    for method in [Method::Rosenbrock, Method::Rk45, Method::Rk65] {
        let options = SolveOptions { scheme: Scheme::OneStep(method), ..SolveOptions::default() };
        let trouble = solve(&system, 0.0, 5.0, &[5.0], &options).expect_err("no course");
        assert!((trouble.time - 3.0).abs() < 1e-9, "{method:?}: {trouble}");
        assert!(trouble.to_string().contains("algebraic equation of 'x'"), "{method:?}: {trouble}");
        // Also where nothing but a column asks for it, or nothing changes at a rate.
        let still = read(r#"<algebraic id="x" start="-2">x^3 - 3*x = time - 1</algebraic>"#);
        let trouble = solve(&still, 0.0, 5.0, &[2.0, 4.0, 5.0], &options).expect_err("no course");
        assert!(trouble.time == 4.0 && trouble.to_string().contains("equation of 'x'"), "{method:?}: {trouble}");
        let ended = course(&system, method, &[2.9], ["x"])[0][0];
        let exact = bisected(-2.0, -1.0, |x| x.powi(3) - 3.0 * x - 1.9);
        assert!((ended - exact).abs() < 1e-9, "{method:?}: {ended}, not {exact}");
    }
}

#[test]
fn events_and_what_they_set_hold_with_the_equations() {
    // At x = 2, which is at y = 10, y falls by half.
    let system = read(
        r#"<algebraic id="x" start="1">x^3 + x = y</algebraic><variable id="y" initial="2" rate="c"/><parameter id="c" value="2"/>
        <variable id="seen" initial="0" rate="0"/>
        <event id="e" when="x ge 2"><set id="y">y/2</set><set id="c">0.5</set><set id="seen">x</set></event>"#,
    );
    let found = course(&system, Method::Rosenbrock, &[3.9, 4.1, 6.0], ["x", "y", "seen"]);
    let root = |y: f64| bisected(0.0, 3.0, |x| x.powi(3) + x - y);
    for ([x, y, seen], (wanted, noted)) in found.into_iter().zip([(9.8, 0.0), (5.05, 2.0), (6.0, 2.0)]) {
        assert!(
            (y - wanted).abs() < 1e-9 && (x - root(wanted)).abs() < 1e-9 && (seen - noted).abs() < 1e-9,
            "{x} {y} {seen}"
        );
    }
}

#[test]
fn they_read_back_the_same_and_go_through_sbml() {
    let document = read_text(&format!("<eml name=\"m\">{TANGLED}</eml>")).expect("good");
    let again = read_text(&eml::write(&document, "").text).expect("good").system;
    // A definition is put into the equations that need it.
    let ids = ["a", "b", "c", "d", "last", "x", "y"];
    assert_eq!(again, document.system);
    let model = sbml::write(&document).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain))).text;
    // The third one is solved for c, and put into the first two.
    assert_eq!(model.matches("<algebraicRule>").count(), 3, "{model}");
    let back = read_text(&model).unwrap_or_else(|message| panic!("{message}\n{model}")).system;
    assert!(is_searched(&back, "a") && is_searched(&back, "last"));
    let [one, other] = [&document.system, &back].map(|system| course(system, Method::Rk45, &[1.0, 2.0], ids));
    for (one, other) in one.iter().flatten().zip(other.iter().flatten()) {
        assert!((one - other).abs() < 1e-10, "{one} and {other}");
    }
    // What is straight is a definition, and units are checked across the sign.
    let body = "<eml name=\"m\"><variable id=\"S\" initial=\"2\" unit=\"uM\" rate=\"0\"/><algebraic id=\"x\" start=\"1\" unit=\"uM\">x^2 = S</algebraic></eml>";
    assert!(read_text(body).expect_err("units").contains("uM^2"));
    let body = body.replace("= S", "= S*1 [uM]").replace("start=\"1\"", "start=\"S\"");
    let document = read_text(&body).unwrap_or_else(|message| panic!("{message}"));
    assert!(is_searched(&document.system, "x"));
}
