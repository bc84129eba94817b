//! Documents that come with the program, each against a reference of another kind.

use nalgebra::{Matrix2, Matrix4};
use pseudopod::equations::eml::{self, Document};
use pseudopod::equations::program::Program;
use pseudopod::equations::tree::{Role, System};
use pseudopod::error::Source;
use pseudopod::ode::{
    Kick, Method, Noise, Numbers, Population, PopulationScratch, Scheme, SolveOptions, Tolerances, solve,
};
use std::sync::Arc;

const ADAPTIVE: [Method; 3] = [Method::Rk45, Method::Rk65, Method::Rosenbrock];

fn document(name: &str) -> Document {
    let path = format!("{}/eml/{name}.eml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a document that ships");
    eml::read(Arc::new(Source { name: name.into(), text })).unwrap_or_else(|error| panic!("{error}"))
}

/// Values of quantities at some times.
fn rows(system: &System, ids: &[&str], times: &[f64], (method, relative): (Method, f64)) -> Vec<Vec<f64>> {
    let options = SolveOptions {
        scheme: Scheme::OneStep(method),
        relative,
        absolute: 1e-3 * relative,
        ..SolveOptions::default()
    };
    let until = times[times.len() - 1];
    let solution = solve(system, 0.0, until, times, &options).unwrap_or_else(|trouble| panic!("{trouble}"));
    let numbers: Vec<usize> = ids.iter().map(|id| system.find(id).expect("a quantity") as usize).collect();
    solution.values.iter().map(|row| numbers.iter().map(|number| row[*number]).collect()).collect()
}

#[test]
fn lotka_and_volterra_keep_what_they_keep_and_their_means_are_those_of_rest() {
    let [alpha, beta, delta, gamma] = [1.1_f64, 0.4, 0.1, 0.4];
    let system = document("lotka_volterra").system;
    let times: Vec<f64> = (0..=40_000).map(|i| f64::from(i) * 1e-3).collect();
    for method in ADAPTIVE {
        let rows = rows(&system, &["prey", "predators"], &times, (method, 1e-9));
        let kept = |row: &[f64]| gamma * row[0].ln() - delta * row[0] + alpha * row[1].ln() - beta * row[1];
        let worst = rows.iter().map(|row| (kept(row) - kept(&rows[0])).abs()).fold(0.0, f64::max);
        // A thousand times the tolerance for errors that add up over 40 days, in which what is kept has slopes of some 10 by the logarithms.
        assert!(worst < 1e-6, "{method:?}: {worst}");
        // A period ends where the prey passes its start again in the same direction.
        let turns: Vec<f64> = (1..rows.len())
            .filter(|&i| rows[i - 1][0] < 10.0 && rows[i][0] >= 10.0)
            .map(|i| i as f64 - (rows[i][0] - 10.0) / (rows[i][0] - rows[i - 1][0]))
            .collect();
        let (first, last) = (turns[0], turns[turns.len() - 1]);
        assert!(turns.len() >= 3, "{turns:?}");
        for (species, rest) in [(0, gamma / delta), (1, alpha / beta)] {
            // The trapezoidal rule, with the ends of the period between two points.
            let at = |i: f64| {
                let (whole, part) = (i.floor() as usize, i.fract());
                rows[whole][species] * (1.0 - part) + rows[whole + 1][species] * part
            };
            let (begin, end) = (first.ceil() as usize, last.floor() as usize);
            let inner: f64 = (begin..end).map(|i| 0.5 * (rows[i][species] + rows[i + 1][species])).sum();
            let ends = 0.5 * (at(first) + rows[begin][species]) * (begin as f64 - first)
                + 0.5 * (rows[end][species] + at(last)) * (last - end as f64);
            let mean = (inner + ends) / (last - first);
            // Rows are 1e-3 apart; the ends of the period lie on lines between them.
            assert!((mean / rest - 1.0).abs() < 1e-5, "{method:?}, {species}: {mean} for {rest}");
        }
    }
}

/// The course of Lorenz's equations by their Taylor series, which the products give term by term.
fn by_series(until: f64) -> [f64; 3] {
    const TERMS: usize = 30;
    let (sigma, rho, beta, step) = (10.0, 28.0, 8.0 / 3.0, 0.01);
    let mut state = [0.0, 1.0, 0.0];
    for _ in 0..(until / step).round() as usize {
        let mut c = [[0.0; TERMS + 1]; 3];
        (0..3).for_each(|v| c[v][0] = state[v]);
        for k in 0..TERMS {
            let product = |a: usize, b: usize| (0..=k).map(|i| c[a][i] * c[b][k - i]).sum::<f64>();
            let rates =
                [sigma * (c[1][k] - c[0][k]), rho * c[0][k] - product(0, 2) - c[1][k], product(0, 1) - beta * c[2][k]];
            (0..3).for_each(|v| c[v][k + 1] = rates[v] / (k + 1) as f64);
        }
        (0..3).for_each(|v| state[v] = c[v].iter().rev().fold(0.0, |sum, term| sum * step + term));
    }
    state
}

#[test]
fn lorenz_goes_where_the_taylor_series_goes() {
    let system = document("lorenz").system;
    for until in [5.0, 15.0] {
        let found = &rows(&system, &["x", "y", "z"], &[until], (Method::Rk65, 1e-13))[0];
        let wanted = by_series(until);
        let worst = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // What the tolerance allows of the largest value, some 30, grows with Lyapunov's exponent, 0.9.
        println!("{until}: {worst:.1e}");
        assert!(worst < 30.0 * 1e-13 * (0.9 * until).exp(), "{until}: {found:?} {wanted:?}");
    }
}

/// The Jacobian of the rates of a system, by central differences, at a state and with an input.
fn jacobian(system: &System, input: (&str, f64), state: [f64; 4]) -> Matrix4<f64> {
    let variables = system.variables();
    let values = |state: [f64; 4]| {
        let mut values: Vec<Option<f64>> = vec![None; system.quantities.len()];
        values[system.find(input.0).expect("an input") as usize] = Some(input.1);
        variables.iter().zip(state).for_each(|(variable, value)| values[*variable as usize] = Some(value));
        values
    };
    fn value(system: &System, values: &[Option<f64>], number: u32) -> f64 {
        values[number as usize].unwrap_or_else(|| match &system.quantities[number as usize].role {
            Role::Defined { rule } => rule.evaluate(0.0, &|other| value(system, values, other)),
            _ => system.quantities[number as usize].initial.evaluate(0.0, &|other| value(system, values, other)),
        })
    }
    let rates = |state: [f64; 4]| -> Vec<f64> {
        let values = values(state);
        let rate = |variable: &u32| match &system.quantities[*variable as usize].role {
            Role::Variable { rate } => rate.evaluate(0.0, &|other| value(system, &values, other)),
            _ => f64::NAN,
        };
        variables.iter().map(rate).collect()
    };
    Matrix4::from_fn(|row, column| {
        let h = 1e-5 * state[column].abs().max(0.1);
        let moved = |by: f64| {
            let mut state = state;
            state[column] += by;
            rates(state)[row]
        };
        (moved(h) - moved(-h)) / (2.0 * h)
    })
}

/// The time between spikes at 10 uA/cm^2, ms, of equations that are written out here, by the classical method in steps of 0.005 ms.
fn period_by_runge_and_kutta() -> f64 {
    let ramp = |x: f64| if x.abs() < 1e-9 { 1.0 } else { x / (1.0 - (-x).exp()) };
    let rates = |[v, m, h, n]: [f64; 4]| {
        let sodium = 120.0 * m.powi(3) * h * (v - 50.0);
        let rest = 36.0 * n.powi(4) * (v + 77.0) + 0.3 * (v + 54.387);
        [
            10.0 - sodium - rest,
            ramp((v + 40.0) / 10.0) * (1.0 - m) - 4.0 * (-(v + 65.0) / 18.0).exp() * m,
            0.07 * (-(v + 65.0) / 20.0).exp() * (1.0 - h) - h / (1.0 + (-(v + 35.0) / 10.0).exp()),
            0.1 * ramp((v + 55.0) / 10.0) * (1.0 - n) - 0.125 * (-(v + 65.0) / 80.0).exp() * n,
        ]
    };
    let (mut y, step, mut spikes) = ([-65.0, 0.0529, 0.5961, 0.3177], 0.005, Vec::new());
    for number in 0..40_000 {
        let moved = |by: f64, k: [f64; 4]| std::array::from_fn(|i| y[i] + by * step * k[i]);
        let a = rates(y);
        let b = rates(moved(0.5, a));
        let c = rates(moved(0.5, b));
        let d = rates(moved(1.0, c));
        let next: [f64; 4] = std::array::from_fn(|i| y[i] + step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        if number >= 20_000 && y[0] < 0.0 && next[0] >= 0.0 {
            spikes.push(step * (f64::from(number) - y[0] / (next[0] - y[0])));
        }
        y = next;
    }
    (spikes[spikes.len() - 1] - spikes[0]) / (spikes.len() - 1) as f64
}

#[test]
fn hodgkin_and_huxley_fire_between_two_bifurcations() {
    let system = document("hodgkin_huxley").system;
    let ramp = |x: f64| if x.abs() < 1e-9 { 1.0 } else { x / (1.0 - (-x).exp()) };
    // At rest at a voltage the gates are where they stay, and the current is what flows.
    let rest = |v: f64| {
        let gate = |alpha: f64, beta: f64| alpha / (alpha + beta);
        let m = gate(ramp((v + 40.0) / 10.0), 4.0 * (-(v + 65.0) / 18.0).exp());
        let h = gate(0.07 * (-(v + 65.0) / 20.0).exp(), 1.0 / (1.0 + (-(v + 35.0) / 10.0).exp()));
        let n = gate(0.1 * ramp((v + 55.0) / 10.0), 0.125 * (-(v + 65.0) / 80.0).exp());
        let current = 120.0 * m.powi(3) * h * (v - 50.0) + 36.0 * n.powi(4) * (v + 77.0) + 0.3 * (v + 54.387);
        (current, [v, m, h, n])
    };
    let grows = |v: f64| {
        let (current, state) = rest(v);
        let eigenvalues = jacobian(&system, ("current", current), state).complex_eigenvalues();
        eigenvalues.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max)
    };
    // Where the largest real part passes nothing.
    let hopf = |mut low: f64, mut high: f64| {
        let begins = grows(low) > 0.0;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (grows(middle) > 0.0) == begins { low = middle } else { high = middle }
        }
        rest(low).0
    };
    // Rinzel and Miller (1980), at 6.3 degrees, the temperature of these rates.
    let (lower, upper) = (hopf(-65.0, -55.0), hopf(-50.0, -35.0));
    println!("{lower} {upper}");
    // To the digits that are published.
    assert!((lower - 9.78).abs() < 0.01 && (upper - 154.5).abs() < 0.05, "{lower} {upper}");
    // A train of spikes, whose period the implicit and the explicit methods share, with peaks near the voltage of sodium.
    let times: Vec<f64> = (0..=20_000).map(|i| f64::from(i) * 0.01).collect();
    let periods = ADAPTIVE.map(|method| {
        let v: Vec<f64> = rows(&system, &["V"], &times, (method, 1e-8)).into_iter().map(|row| row[0]).collect();
        let peak = v[10_000..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!((25.0..50.0).contains(&peak), "{peak}");
        let turns: Vec<f64> = (10_000..20_000)
            .filter(|&i| v[i] < 0.0 && v[i + 1] >= 0.0)
            .map(|i| 0.01 * (i as f64 - v[i] / (v[i + 1] - v[i])))
            .collect();
        (turns[turns.len() - 1] - turns[0]) / (turns.len() - 1) as f64
    });
    let wanted = period_by_runge_and_kutta();
    println!("{periods:?} for {wanted}: {} spikes a second", 1000.0 / wanted);
    // Spikes are met between rows of 0.01 ms, which bends of the flank move by some 1e-4 ms.
    assert!(periods.iter().all(|period| (period - wanted).abs() < 1e-3), "{periods:?} for {wanted}");
}

#[test]
fn the_noise_of_a_toggle_switch_is_that_of_its_linear_equations() {
    let document = document("toggle_switch");
    let noise = Noise::new(&document).expect("no circle").expect("some noise");
    let program = Program::new(&document.system).expect("no circle");
    // Where it rests with much u.
    let (mut u, mut v) = (5.0_f64, 0.2_f64);
    for _ in 0..200 {
        (u, v) = (5.0 / (1.0 + v * v), 5.0 / (1.0 + u * u));
    }
    let slope = |x: f64| -10.0 * x / (1.0 + x * x).powi(2);
    let a = Matrix2::new(-1.0, slope(v), slope(u), -1.0);
    // A C + C Aᵀ + D = 0 for the covariances C of the linear equations about it.
    let d = [2.0 * u / 1000.0, 2.0 * v / 1000.0];
    let system = nalgebra::Matrix3::new(
        2.0 * a[(0, 0)],
        2.0 * a[(0, 1)],
        0.0,
        a[(1, 0)],
        a[(0, 0)] + a[(1, 1)],
        a[(0, 1)],
        0.0,
        2.0 * a[(1, 0)],
        2.0 * a[(1, 1)],
    );
    let wanted = system.lu().solve(&nalgebra::Vector3::new(-d[0], 0.0, -d[1])).expect("one solution");
    let (cells, pace) = (4000, 0.01);
    let mut population = Population::new(&program, cells, Method::Rk45);
    let (mut scratch, ids) = (PopulationScratch::default(), 0..cells as u64);
    for number in 0..800 {
        let (from, until) = (number as f64 * pace, (number + 1) as f64 * pace);
        let kick = Kick { number, span: pace };
        let numbers = Numbers { seed: 3, system: "toggle_switch" };
        population.kick(&noise, numbers, ids.clone(), (from, kick), &mut scratch).expect("numbers");
        population.advance(&program, from, until, &Tolerances::default(), &mut scratch).expect("no trouble");
    }
    let of = |variable: usize| (0..cells).map(|cell| population.state(cell, variable)).collect::<Vec<f64>>();
    let (us, vs) = (of(0), of(1));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / cells as f64;
    let (mean_u, mean_v) = (mean(&us), mean(&vs));
    let covariance = us.iter().zip(&vs).map(|(u, v)| (u - mean_u) * (v - mean_v)).sum::<f64>() / cells as f64;
    let variance = |values: &[f64], mean: f64| values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / cells as f64;
    // Beside three standard errors: what is not linear is of the order of the variance, 6e-3 where slopes bend over distances of 1, and kicks that
    // come each hundredth of a lifetime are off by half of that.
    let error = 3.0 * (2.0 / cells as f64).sqrt() + 0.02;
    for (what, found, wanted) in [("u", variance(&us, mean_u), wanted[0]), ("v", variance(&vs, mean_v), wanted[2])] {
        println!("{what}: {found:.3e} for {wanted:.3e}");
        assert!((found / wanted - 1.0).abs() < error, "{what}: {found} for {wanted}");
    }
    let correlation = covariance / (wanted[0] * wanted[2]).sqrt();
    let expected = wanted[1] / (wanted[0] * wanted[2]).sqrt();
    println!("correlation {correlation:.3} for {expected:.3}");
    assert!((correlation - expected).abs() < 3.0 / (cells as f64).sqrt() + 0.02, "{correlation} for {expected}");
    // Three standard errors, and what the variance of v, 2.5e-4, does to what is made: half of it times the bend, at most 10.
    assert!((mean_u - u).abs() < 3.0 * (wanted[0] / cells as f64).sqrt() + 1.3e-3, "{mean_u} for {u}");
}
