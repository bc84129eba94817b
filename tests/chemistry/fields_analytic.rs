//! Fields against textbook solutions: heat kernels, sources, fronts, and the first wave of the Brusselator.

use pseudopod::Vec3;
use pseudopod::field::{Chunk, Fields, Grid, Range, Species, Stepping, Wall};
use serde_json::Value;

use crate::shared::shared;

/// The cases of a file of the shared data, or none, said and noted, where the data are not there.
fn cases(file: &str) -> Vec<Value> {
    let Some(path) = shared(&format!("analytic/{file}")) else { return Vec::new() };
    serde_json::from_str(&std::fs::read_to_string(path).expect("a file")).expect("an array of cases")
}

fn number(case: &Value, key: &str) -> f64 {
    case[key].as_f64().unwrap_or_else(|| panic!("{key} in {case}"))
}

/// An octant, or quadrant, or half line, with the source in its corner: closed walls mirror it. `n` boxes an axis.
fn corner(n: usize, dimensions: usize, size: f64, [diffusion, decay]: [f64; 2], range: Range) -> Fields {
    let cells = std::array::from_fn(|axis| if axis < dimensions { n } else { 1 });
    let spacing = std::array::from_fn(|axis| if axis < dimensions { size / n as f64 } else { 1.0 });
    let grid = Grid::new(cells, spacing, Vec3::zeros()).unwrap();
    Fields::new(grid, vec![Species::new("s", diffusion, decay).with_range(range)]).unwrap()
}

/// Value at distance r of a source that releases `released` at once and `rate` a second until `t`.
fn spread(
    case: &Value,
    n: usize,
    dimensions: usize,
    [released, rate]: [f64; 2],
    t: f64,
    steps: u32,
    range: Range,
) -> f64 {
    let (diffusion, r) = (number(case, "D"), number(case, "r"));
    let decay = case.get("k").and_then(Value::as_f64).unwrap_or(0.0);
    // The far walls mirror the source too, at less than e^(−12) of what is measured.
    let reach = f64::min((4.0 * diffusion * t).sqrt() * 3.5, 6.0 * (diffusion / decay).sqrt());
    let mut fields = corner(n, dimensions, r + reach, [diffusion, decay], range);
    let (part, dt) = (0.5_f64.powi(dimensions as i32), t / f64::from(steps));
    fields.deposit(0, Vec3::zeros(), released * part);
    for _ in 0..steps {
        // Half of what a step releases comes before it and half after: second order.
        fields.deposit(0, Vec3::zeros(), 0.5 * rate * dt * part);
        fields.advance(dt, Stepping::Fixed(1), None).unwrap();
        fields.deposit(0, Vec3::zeros(), 0.5 * rate * dt * part);
    }
    fields.sense(0, Vec3::new(r, 0.0, 0.0)).value
}

#[test]
fn a_point_source_spreads_as_the_heat_kernel_at_second_order() {
    let mut seen = 0;
    for case in cases("diffusion.json").iter().filter(|case| case["case"] == "heat_kernel_decay") {
        let (d, exact) = (case["d"].as_u64().unwrap() as usize, number(case, "c"));
        let n = [0, 192, 128, 48][d];
        let error = |n: usize, steps: u32, range: Range| {
            spread(case, n, d, [number(case, "M"), 0.0], number(case, "t"), steps, range) / exact - 1.0
        };
        let (coarse, fine) = (error(n / 2, 40, Range::Free), error(n, 80, Range::Free));
        let (order, kept) = ((coarse / fine).log2(), error(n, 80, Range::NonNegative));
        println!("d {d}: {coarse:+.2e} {fine:+.2e}, order {order:.2}; kept from going below zero {kept:+.2e}");
        assert!(order > 1.9 && fine.abs() < 1e-2, "{case}: {coarse:e} {fine:e}");
        // Released into nothing, the first steps leave undershoots, whose correction costs about 0.04 / steps.
        assert!((kept - fine).abs() < 1e-3, "{case}: {kept:e} {fine:e}");
        seen += 1;
    }
    assert!(seen == 10 || seen == 0, "{seen} cases");
}

#[test]
fn sources_that_go_on_reach_their_transient_and_steady_profiles() {
    let all = cases("diffusion.json");
    let (mut seen, skipped) = (0, all.is_empty());
    for case in &all {
        let name = case["case"].as_str().unwrap();
        let transient = name.starts_with("transient_point");
        if !transient && !name.starts_with("steady_point") {
            continue;
        }
        let (q, d, exact) = (number(case, "Q"), number(case, "D"), number(case, "c"));
        let dimensions = if name.contains("3d") { 3 } else { 2 };
        let t = if transient { number(case, "t") } else { 14.0 / number(case, "k") };
        // The distance must be several boxes and several times what a step spreads; and deep tails, where the value is
        // 10⁻⁷ of that at the source, are no measure.
        let (r, decay) = (number(case, "r"), case.get("k").and_then(Value::as_f64).unwrap_or(0.0));
        let (n, steps) = (if dimensions == 3 { 64 } else { 200 }, (64.0 * d * t / (r * r)).max(120.0));
        let box_size = (r + f64::min((4.0 * d * t).sqrt() * 3.5, 6.0 * (d / decay).sqrt())) / n as f64;
        if r < 8.0 * box_size || steps > 1500.0 || r / (4.0 * d * t).sqrt() > 2.0 {
            continue;
        }
        let value = |n: usize, steps: f64| {
            spread(case, n, dimensions, [0.0, q], t, steps as u32, Range::NonNegative) / exact - 1.0
        };
        let (coarse, fine) = (value(n / 2, 0.5 * steps), value(n, steps));
        let order = (coarse / fine).log2();
        println!("{name} r {r}: {coarse:+.2e} {fine:+.2e}, order {order:.2}");
        assert!(order > 1.7 && fine.abs() < 2e-2, "{case}: {coarse:e} {fine:e}");
        seen += 1;
    }
    assert!(seen >= 9 || skipped, "{seen} cases");
}
/// Error of a front after it has run for time t, against its exact profile, and the error of its speed.
fn front(
    [diffusion, speed, t, steepness]: [f64; 4],
    n: usize,
    steps: u32,
    profile: impl Fn(f64) -> f64,
    reaction: &(dyn Fn(&mut Chunk) + Sync),
) -> [f64; 2] {
    let (width, size) = (1.0 / steepness, 60.0 / steepness + speed * t);
    let grid = Grid::new([n, 1, 1], [size / n as f64, 1.0, 1.0], Vec3::zeros()).unwrap();
    let mut fields = Fields::new(grid, vec![Species::new("u", diffusion, 0.0)]).unwrap();
    let start = 25.0 * width;
    fields.set(0, |p| profile(p.x - start)).unwrap();
    let level = |fields: &Fields| fields.values(0).iter().sum::<f64>() * size / n as f64;
    let before = level(&fields);
    fields.advance(t, Stepping::Fixed(steps), Some(reaction)).unwrap();
    let found = (level(&fields) - before) / t;
    let worst = fields.values(0).iter().enumerate().fold(0.0_f64, |worst, (at, value)| {
        worst.max((value - profile(fields.grid().centre(at).x - start - speed * t)).abs())
    });
    [worst, found / speed - 1.0]
}

#[test]
fn fronts_of_fisher_and_nagumo_keep_shape_and_speed_at_second_order() {
    for case in &cases("fronts_patterns.json") {
        let name = case["case"].as_str().unwrap();
        if name == "brusselator_turing" {
            continue;
        }
        let d = number(case, "D");
        let of = |n: usize, steps: u32| match name {
            "fisher_kpp" => {
                let (r, c) = (number(case, "r"), number(case, "c_exact"));
                let k = f64::sqrt(r / (6.0 * d));
                let logistic = move |chunk: &mut Chunk| {
                    let grown = (r * chunk.dt).exp();
                    chunk.values.iter_mut().for_each(|u| *u = *u * grown / (1.0 + *u * (grown - 1.0)));
                };
                front([d, c, 8.0 / r, k], n, steps, |z| (1.0 + (k * z).exp()).powi(-2), &logistic)
            }
            _ => {
                let (a, c) = (number(case, "a"), number(case, "c"));
                let k = 1.0 / f64::sqrt(2.0 * d);
                let cubic = move |chunk: &mut Chunk| {
                    let dt = chunk.dt;
                    let f = |u: f64| u * (1.0 - u) * (u - a);
                    for u in chunk.values.iter_mut() {
                        let half = *u + 0.5 * dt * f(*u);
                        *u += dt * f(half);
                    }
                };
                front([d, c, 15.0, k], n, steps, |z| 1.0 / (1.0 + (k * z).exp()), &cubic)
            }
        };
        let (coarse, fine) = (of(400, 40), of(800, 80));
        let order = (coarse[0] / fine[0]).log2();
        println!("{name} D {d}: shape {coarse:?} {fine:?} order {order:.2}");
        assert!(order > 1.8 && fine[0] < 2e-2 && fine[1].abs() < 3e-3, "{case}: {coarse:?} {fine:?}");
    }
}

/// How fast a small wave of wave number q grows in the Brusselator, per second.
fn growth(case: &Value, b: f64, q: f64) -> f64 {
    let (a, du, dv) = (number(case, "A"), number(case, "Du"), number(case, "Dv"));
    let length = 2.0 * std::f64::consts::PI / q;
    let grid = Grid::new([64, 1, 1], [length / 64.0, 1.0, 1.0], Vec3::zeros()).unwrap();
    let walls = [[Wall::Periodic; 2], [Wall::NoFlux; 2], [Wall::NoFlux; 2]];
    let species =
        [("u", du), ("v", dv)].map(|(name, d)| Species::new(name, d, 0.0).with_walls(walls).with_range(Range::Free));
    let mut fields = Fields::new(grid, species.to_vec()).unwrap();
    fields.set(0, |p| a + 1e-6 * (q * p.x).cos()).unwrap();
    fields.set(1, |_| b / a).unwrap();
    let brusselator = |chunk: &mut Chunk| {
        let dt = chunk.dt;
        let [u, v] = chunk.rows();
        let f = |u: f64, v: f64| (a - (b + 1.0) * u + u * u * v, b * u - u * u * v);
        for (u, v) in u.iter_mut().zip(v) {
            let first = f(*u, *v);
            let second = f(*u + 0.5 * dt * first.0, *v + 0.5 * dt * first.1);
            (*u, *v) = (*u + dt * second.0, *v + dt * second.1);
        }
    };
    let size = |fields: &Fields| {
        let most = fields.values(0).iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = fields.values(0).iter().copied().fold(f64::INFINITY, f64::min);
        most - least
    };
    // What decays quickly is gone after the first 20 s.
    fields.advance(20.0, Stepping::Fixed(8000), Some(&brusselator)).unwrap();
    let before = size(&fields);
    fields.advance(20.0, Stepping::Fixed(8000), Some(&brusselator)).unwrap();
    (size(&fields) / before).ln() / 20.0
}

#[test]
fn the_brusselator_makes_its_first_wave_where_linear_theory_says() {
    for case in cases("fronts_patterns.json").iter().filter(|case| case["case"] == "brusselator_turing") {
        let (a, b, q) = (number(case, "A"), number(case, "B_c"), number(case, "q_c"));
        let (du, dv) = (number(case, "Du"), number(case, "Dv"));
        for factor in [0.97, 1.03] {
            let b = factor * b;
            let (fu, fv, gu, gv) = (b - 1.0 - du * q * q, a * a, -b, -a * a - dv * q * q);
            let (trace, determinant) = (fu + gv, fu * gv - fv * gu);
            let exact = 0.5 * trace + (0.25 * trace * trace - determinant).sqrt();
            let found = growth(case, b, q);
            println!("B {factor} of critical: growth {found:.5}, theory {exact:.5}");
            assert!(found * exact > 0.0 && (found - exact).abs() < 0.03 * exact.abs(), "{found} {exact}");
        }
        // Of waves just above the critical B only those near the critical wave number grow.
        assert!(growth(case, 1.005 * b, 0.75 * q) < 0.0 && growth(case, 1.005 * b, 1.35 * q) < 0.0);
        assert!(growth(case, 1.005 * b, q) > 0.0);
    }
}
