//! Documents of `eml/` with fields on a line, against what theory says of them.

use std::f64::consts::PI;

use pseudopod::field::{FieldSystem, Fields, Stepping};

use crate::field_transport::open;

fn from_file(name: &str, changes: &[(&str, &str)]) -> (FieldSystem, Fields) {
    let path = format!("{}/eml/{name}.eml", env!("CARGO_MANIFEST_DIR"));
    let mut text = std::fs::read_to_string(path).expect("a document of eml/");
    for (from, to) in changes {
        assert!(text.contains(from), "{name} has {from}");
        text = text.replace(from, to);
    }
    open(&text)
}

/// How the program chooses steps where nobody says anything.
fn usual(system: &FieldSystem) -> Stepping {
    let (relative, absolute) = system.usual_tolerance();
    Stepping::Adaptive { relative, absolute }
}

/// The height of a wave of cells in the cosine with so many half lengths.
fn height(fields: &Fields, halves: f64) -> f64 {
    let grid = fields.grid();
    let wave = |at: usize| (halves * PI * grid.centre(at).x / 200.0).cos() * fields.values(0)[at];
    2.0 * (0..grid.len()).map(wave).sum::<f64>() / grid.len() as f64
}

#[test]
fn waves_of_cells_that_follow_themselves_grow_above_the_threshold_as_their_dispersion_says() {
    // The threshold of this wave, D (Ds q² + b)/(a n₀), is 109.9 µm²/min/nM.
    let square = (2.0 * PI / 200.0_f64).powi(2);
    for chi in [200.0_f64, 130.0, 90.0] {
        let (system, mut fields) =
            from_file("keller_segel", &[("id=\"chi\" value=\"200\"", &format!("id=\"chi\" value=\"{chi}\""))]);
        let cells = fields.amount(0);
        let mut heights = Vec::new();
        for _ in 0..2 {
            // After the first window the wave that dies, at more than 1/min, is gone.
            system.advance(&mut fields, 12.0 * 60.0, &[], usual(&system)).expect("a window");
            heights.push(height(&fields, 2.0));
        }
        let growth = (heights[1] / heights[0]).ln() / 12.0;
        let (sum, product) = (200.0 * square + 1.0, 100.0 * square * (100.0 * square + 1.0) - chi * square);
        let exact = -0.5 * sum + (0.25 * sum * sum - product).sqrt();
        assert_eq!(exact > 0.0, chi > 109.9, "{chi}: {exact}");
        println!("NOTE chi {chi}: growth {growth}, by theory {exact}");
        assert!((growth - exact).abs() < 3e-3 * 0.2, "{chi}: {growth} {exact}");
        assert!((fields.amount(0) / cells - 1.0).abs() < 1e-12, "{} {cells}", fields.amount(0));
    }
}

#[test]
fn predators_invade_prey_at_the_speed_of_their_foremost() {
    let (system, mut fields) = from_file("predator_prey", &[]);
    let front = |fields: &Fields| {
        let values = fields.values(1);
        let at = values.iter().rposition(|value| *value > 0.05).expect("predators");
        let part = (values[at] - 0.05) / (values[at] - values[at + 1]);
        system.grid().centre(at).x + part * system.grid().spacing[0]
    };
    let mut fronts = Vec::new();
    for _ in 0..2 {
        system.advance(&mut fields, 32.0, &[], usual(&system)).expect("a window");
        fronts.push(front(&fields));
    }
    // Bramson: x = c t − 3/(2λ) ln t, λ = c/2D; the grid makes waves of exp(−λ x) spread faster, by the factor 2(cosh λh − 1)/(λh)².
    let (growth, h) = (2.0 / 1.4 - 0.6_f64, 0.5);
    let speed = |rate: f64| (2.0 * ((rate * h).cosh() - 1.0) / (h * h) + growth) / rate;
    let best = (1..4000).map(|i| f64::from(i) * 1e-3).min_by(|a, b| speed(*a).total_cmp(&speed(*b))).expect("some");
    let exact = speed(best) - 1.5 / best * 2f64.ln() / 32.0;
    let found = (fronts[1] - fronts[0]) / 32.0;
    println!("NOTE speed {found}, by theory {exact}, at last {}", speed(best));
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}

/// How far the front of an Oregonator has come at two times, by Euler's rule in very small steps on boxes of some width.
fn fronts_by_euler(h: f64, times: [f64; 2]) -> [f64; 2] {
    let (epsilon, f, q) = (0.01, 3.0, 0.002);
    let rest = 0.5 * (((f + q - 1.0_f64).powi(2) + 4.0 * q * (1.0 + f)).sqrt() - (f + q - 1.0));
    let n = (8.0 / h).round() as usize;
    let centre = |at: usize| (at as f64 + 0.5) * h;
    let mut u: Vec<f64> = (0..n).map(|at| if centre(at) < 0.5 { 0.8 } else { rest }).collect();
    let (mut w, dt) = (vec![rest; n], 0.2 * h * h);
    let (mut next_u, mut next_w) = (u.clone(), w.clone());
    let mut done = 0;
    times.map(|time| {
        while f64::from(done) * dt < time {
            let spread =
                |c: &[f64], at: usize| (c[at.saturating_sub(1)] + c[(at + 1).min(n - 1)] - 2.0 * c[at]) / (h * h);
            for at in 0..n {
                let (a, b) = (u[at], w[at]);
                next_u[at] = a + dt * ((a * (1.0 - a) - f * b * (a - q) / (a + q)) / epsilon + spread(&u, at));
                next_w[at] = b + dt * (a - b + 0.6 * spread(&w, at));
            }
            std::mem::swap(&mut u, &mut next_u);
            std::mem::swap(&mut w, &mut next_w);
            done += 1;
        }
        where_it_falls(&u, h)
    })
}

/// Where the last box of much acid is, between it and the next.
fn where_it_falls(u: &[f64], h: f64) -> f64 {
    let at = u.iter().rposition(|value| *value > 0.3).expect("a front");
    (at as f64 + 0.5 + (u[at] - 0.3) / (u[at] - u[at + 1])) * h
}

#[test]
fn the_front_of_an_oregonator_runs_as_fast_as_on_finer_grids_in_tiny_steps() {
    let times = [0.15, 0.3];
    let [coarse, fine] = [0.02, 0.01].map(|h| {
        let [first, last] = fronts_by_euler(h, times);
        (last - first) / (times[1] - times[0])
    });
    // Of second order in the boxes, and so in steps that go with their square.
    let exact = fine + (fine - coarse) / 3.0;
    let (system, mut fields) = from_file("oregonator", &[]);
    let mut fronts = [0.0; 2];
    for front in &mut fronts {
        system.advance(&mut fields, 0.15, &[], usual(&system)).expect("a window");
        *front = where_it_falls(fields.values(0), 0.02);
    }
    let found = (fronts[1] - fronts[0]) / 0.15;
    println!("NOTE speed {found}, on the same grid {coarse}, by extrapolation {exact}");
    assert!((found / exact - 1.0).abs() < 0.01 && (found / coarse - 1.0).abs() < 0.01, "{found} {coarse} {exact}");
    assert!((10.0..20.0).contains(&exact), "a front at all: {exact}");
}
