//! Documents that ship against what is published of them, or follows from them by other means.

use pseudopod::equations::eml;
use pseudopod::equations::tree::{Expr, System};
use pseudopod::error::Source;
use pseudopod::ode::{SolveOptions, solve};
use std::sync::Arc;

/// A document that ships, with other values of some parameters and starts.
fn shipped(name: &str, values: &[(&str, f64)]) -> System {
    let text = std::fs::read_to_string(format!("eml/{name}.eml")).expect("a document that ships");
    let mut system = eml::read(Arc::new(Source { name: name.into(), text })).expect("no fault").system;
    for (id, value) in values {
        let number = system.find(id).expect(id) as usize;
        system.quantities[number].initial = Expr::Number(*value);
    }
    system
}

/// Values of some quantities at some times.
fn course<const N: usize>(system: &System, ids: [&str; N], times: &[f64], relative: f64) -> Vec<[f64; N]> {
    let options = SolveOptions { relative, absolute: 1e-14, max_steps: 1_000_000, ..SolveOptions::default() };
    let solution = solve(system, 0.0, times[times.len() - 1], times, &options).expect("a course");
    let numbers = ids.map(|id| system.find(id).expect(id) as usize);
    solution.values.iter().map(|row| numbers.map(|number| row[number])).collect()
}

/// What the active kinases of the cascade come to at a stimulus.
fn answer(stimulus: f64) -> [f64; 3] {
    let system = shipped("mapk", &[("E1_total", stimulus)]);
    course(&system, ["KKKa", "KKpp", "Kpp"], &[2e4], 1e-6)[0]
}

#[test]
fn the_cascade_of_mapk_is_steeper_from_kinase_to_kinase_as_published() {
    let grid: Vec<f64> = (0..=25).map(|point| 0.3 * f64::from(point - 25) * 10.0_f64.ln()).collect();
    let answers: Vec<[f64; 3]> = grid.iter().map(|stimulus| answer(stimulus.exp())).collect();
    // The logarithm of the stimulus at which a kinase is at a share of the most.
    let stimulus = |kinase: usize, share: f64| -> f64 {
        let wanted = share * answers[25][kinase];
        let above = answers.iter().position(|answer| answer[kinase] >= wanted).expect("the last one is above");
        let (mut low, mut high) = (grid[above - 1], grid[above]);
        while high - low > 2e-3 {
            let middle = 0.5 * (low + high);
            if answer(middle.exp())[kinase] < wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    };
    let steepness: Vec<f64> =
        (0..3).map(|kinase| 81.0_f64.ln() / (stimulus(kinase, 0.9) - stimulus(kinase, 0.1))).collect();
    // They are published with two digits.
    for (found, published) in steepness.iter().zip([1.0, 1.7, 4.9]) {
        assert!((found - published).abs() < 0.05, "{steepness:?}");
    }
}

#[test]
fn the_cascade_of_mapk_keeps_what_there_is_of_each_protein() {
    let system = shipped("mapk", &[]);
    let totals: [(&[&str], f64); 7] = [
        (&["E1", "KKK_E1"], 3e-5),
        (&["E2", "KKKa_E2"], 3e-4),
        (&["KKK", "KKKa", "KKK_E1", "KKKa_E2", "KK_KKKa", "KKp_KKKa"], 0.003),
        (&["KKP", "KKp_KKP", "KKpp_KKP"], 3e-4),
        (&["KK", "KKp", "KKpp", "KK_KKKa", "KKp_KKKa", "KKp_KKP", "KKpp_KKP", "K_KKpp", "Kp_KKpp"], 1.2),
        (&["KP", "Kp_KP", "Kpp_KP"], 0.12),
        (&["K", "Kp", "Kpp", "K_KKpp", "Kp_KKpp", "Kp_KP", "Kpp_KP"], 1.2),
    ];
    let solution = solve(&system, 0.0, 200.0, &[1.0, 20.0, 200.0], &SolveOptions::default()).expect("a course");
    for (parts, total) in totals {
        for row in &solution.values {
            let sum: f64 = parts.iter().map(|id| row[system.find(id).expect(id) as usize]).sum();
            assert!((sum / total - 1.0).abs() < 1e-9, "{parts:?}: {sum}, not {total}");
        }
    }
}

#[test]
fn the_clock_of_per_has_a_period_of_a_day() {
    let system = shipped("goldbeter_clock", &[]);
    let times: Vec<f64> = (0..=40_000).map(|point| 500.0 + 0.01 * f64::from(point)).collect();
    let rows = course(&system, ["M", "total"], &times, 1e-8);
    let middle = rows.iter().map(|row| row[0]).sum::<f64>() / rows.len() as f64;
    let rises = rows.windows(2).zip(&times).filter(|(pair, _)| pair[0][0] < middle && pair[1][0] >= middle);
    let rises: Vec<f64> =
        rises.map(|(pair, time)| time + 0.01 * (middle - pair[0][0]) / (pair[1][0] - pair[0][0])).collect();
    let periods: Vec<f64> = rises.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(periods.len() >= 15 && periods.iter().all(|period| (period - periods[0]).abs() < 1e-3), "{periods:?}");
    // "Close to 24 h": to half an hour.
    assert!((periods[0] - 24.0).abs() < 0.5, "{periods:?}");
    let [least, most] =
        rows.iter().fold([f64::MAX, 0.0_f64], |[least, most], row| [least.min(row[0]), most.max(row[0])]);
    assert!(most > 3.0 * least, "mRNA goes from {least} to {most}");
}

#[test]
fn the_repressilator_begins_to_oscillate_where_its_steady_state_loses_stability() {
    let (beta, n) = (0.2_f64, 2.0_f64);
    // By the published criterion, without mRNA under full repression: (beta + 1)^2/beta = 3 X^2/(4 + 2 X).
    let side = (beta + 1.0).powi(2) / beta;
    let slope = -(-side + (side * side + 12.0 * side).sqrt()) / 3.0;
    let square = -slope / (n + slope);
    let threshold = square.sqrt() * (1.0 + square);
    for share in [0.9, 0.99, 1.01, 1.1] {
        let alpha = share * threshold;
        // The steady state p (1 + p^2) = alpha.
        let mut p = alpha.cbrt();
        (0..50).for_each(|_| p -= (p * (1.0 + p * p) - alpha) / (1.0 + 3.0 * p * p));
        let slope = -alpha * n * p / (1.0 + p * p).powi(2);
        // Growth and frequency: the roots of (s + 1)(s + beta) = beta X w with w^3 = 1.
        let (re, im) = (-0.5 * beta * slope, -3.0_f64.sqrt() / 2.0 * beta * slope);
        let inside = ((1.0 - beta).powi(2) / 4.0 + re, im);
        let root = f64::hypot(inside.0, inside.1);
        let (growth, turn) = ((0.5 * (root + inside.0)).sqrt() - 0.5 * (1.0 + beta), (0.5 * (root - inside.0)).sqrt());
        let starts = [("lacI", p * (1.0 + 1e-6)), ("tetR", p), ("cI", p), ("m_lacI", p), ("m_tetR", p), ("m_cI", p)];
        let system = shipped("repressilator", &[&starts[..], &[("alpha", alpha), ("alpha_0", 0.0)]].concat());
        let times: Vec<f64> = (0..=100).map(|point| 40.0 + 0.4 * f64::from(point)).collect();
        let rows = course(&system, ["lacI", "tetR", "cI"], &times, 1e-12);
        // The amplitude of the wave that runs round the ring.
        let wave = |row: &[f64; 3]| -> (f64, f64) {
            let (c, s) = (-0.5, 3.0_f64.sqrt() / 2.0);
            (row[0] + c * (row[1] + row[2]), s * (row[1] - row[2]))
        };
        let (first, last) = (wave(&rows[0]), wave(&rows[100]));
        let grown = (f64::hypot(last.0, last.1) / f64::hypot(first.0, first.1)).ln() / 40.0;
        let angles: Vec<f64> = rows.iter().map(|row| wave(row).1.atan2(wave(row).0)).collect();
        let mut turned = 0.0;
        for pair in angles.windows(2) {
            turned += (pair[1] - pair[0] + std::f64::consts::PI).rem_euclid(2.0 * std::f64::consts::PI)
                - std::f64::consts::PI;
        }
        assert!((grown - growth).abs() < 1e-4, "{share}: {grown}, not {growth}");
        assert!((turned.abs() / 40.0 - turn).abs() < 1e-4 * turn, "{share}: {turned}, not {turn}");
        assert_eq!(grown > 0.0, share > 1.0);
    }
}

#[test]
fn a_cascade_of_hill_functions_comes_to_their_composition_and_multiplies_sensitivities() {
    let at = |signal: f64| -> [f64; 3] {
        course(&shipped("hill_cascade", &[("S", signal)]), ["A", "B", "C"], &[100.0], 1e-10)[0]
    };
    let hill = |x: f64, half: f64| x * x / (half * half + x * x);
    for signal in [0.05, 0.5, 1.0, 20.0] {
        let expected = [1.0, 0.5, 0.5].into_iter().scan(signal, |x, half| {
            *x = hill(*x, half);
            Some(*x)
        });
        for (found, expected) in at(signal).into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9 * expected + 1e-13, "{signal}: {found}, not {expected}");
        }
    }
    // Of small signals the logarithms go with the product of the exponents.
    let sensitivity = (at(0.0501)[2] / at(0.0499)[2]).ln() / (0.0501_f64 / 0.0499).ln();
    assert!((sensitivity - 8.0).abs() < 0.03, "{sensitivity}");
}
