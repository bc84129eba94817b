//! Fields keep what they must keep: mass, signs, steady states, symmetry, bits; and reach their order.

use pseudopod::Vec3;
use pseudopod::field::{Chunk, Fields, Grid, Range, Sensed, Species, Stepping, Wall, Walls};

const CLOSED: Walls = [[Wall::NoFlux; 2]; 3];
const RING: Walls = [[Wall::Periodic; 2]; 3];

fn one(cells: [usize; 3], spacing: f64, species: Species) -> Fields {
    Fields::new(Grid::new(cells, [spacing; 3], Vec3::zeros()).unwrap(), vec![species]).unwrap()
}

fn least(fields: &Fields) -> f64 {
    fields.values(0).iter().copied().fold(f64::INFINITY, f64::min)
}

#[test]
fn walls_that_nothing_passes_keep_the_mass_to_round_off() {
    for (cells, walls) in [([50, 37, 1], CLOSED), ([21, 18, 23], CLOSED), ([50, 37, 1], RING), ([21, 18, 23], RING)] {
        for ratio in [0.1, 5.0, 500.0] {
            let mut fields = one(cells, 1.0, Species::new("s", ratio, 0.0).with_walls(walls));
            fields.deposit(0, Vec3::new(9.3, 4.1, 0.7), 3.0);
            fields.deposit(0, Vec3::new(0.1, 17.0, 2.0), 1.0);
            let before = fields.amount(0);
            fields.advance(200.0, Stepping::Fixed(200), None).unwrap();
            let lost = fields.amount(0) / before - 1.0;
            // The bound.
            assert!(lost.abs() < 1e-12, "{cells:?} ratio {ratio}: {lost:e}");
            assert!(least(&fields) >= 0.0);
        }
    }
}

#[test]
fn a_point_source_never_gives_a_negative_value_however_large_the_step() {
    for walls in [CLOSED, RING, [[Wall::Fixed(0.0); 2], [Wall::NoFlux, Wall::Fixed(0.5)], [Wall::NoFlux; 2]]] {
        for (cells, point) in [([40, 33, 1], Vec3::new(11.5, 8.5, 0.0)), ([20, 17, 22], Vec3::new(3.5, 8.2, 20.9))] {
            for ratio in [0.01, 0.3, 1.0, 7.0, 100.0, 1e5] {
                let mut fields = one(cells, 1.0, Species::new("s", ratio, 0.1).with_walls(walls));
                for _ in 0..6 {
                    fields.deposit(0, point, 1.0);
                    fields.advance(1.0, Stepping::Fixed(1), None).unwrap();
                    assert!(least(&fields) >= 0.0, "{walls:?} {cells:?} {ratio}: {:e}", least(&fields));
                }
            }
        }
    }
}

#[test]
fn the_limiter_is_what_keeps_values_from_going_below_zero() {
    let lowest = |range: Range| {
        let mut fields = one([60, 60, 1], 1.0, Species::new("s", 2.0, 0.0).with_range(range));
        fields.deposit(0, Vec3::new(30.5, 30.5, 0.0), 1.0);
        fields.advance(1.0, Stepping::Fixed(1), None).unwrap();
        (least(&fields), fields.amount(0) - 1.0)
    };
    assert!(lowest(Range::Free).0 < -1e-8, "the free solve must undershoot, or this test shows nothing");
    let (kept, made) = lowest(Range::NonNegative);
    assert!(kept >= 0.0 && made.abs() < 1e-14, "{kept:e} {made:e}");
}

#[test]
fn decay_is_exact() {
    for diffusion in [0.0, 3.0] {
        let mut fields = one([30, 20, 1], 0.5, Species::new("s", diffusion, 0.37));
        fields.set(0, |p| 1.0 + p.x).unwrap();
        let before = fields.amount(0);
        fields.advance(5.0, Stepping::Fixed(3), None).unwrap();
        // Round-off of three steps.
        assert!((fields.amount(0) / before / (-0.37_f64 * 5.0).exp() - 1.0).abs() < 1e-13);
    }
}

#[test]
fn between_held_walls_the_profile_is_the_line_or_the_catenary() {
    // Without decay the discrete profile is the exact line; with it the error is of second order.
    let (n, length, d) = (2000, 10.0, 2.0);
    for decay in [0.0, 0.1] {
        for axis in 0..2 {
            let mut walls = CLOSED;
            walls[axis] = [Wall::Fixed(1.0), Wall::Fixed(3.0)];
            let mut cells = [6, 6, 1];
            cells[axis] = n;
            let h = length / n as f64;
            let mut fields = one(cells, h, Species::new("s", d, decay).with_walls(walls));
            // Steps far longer than any time of the problem, as short ones, must end in the same state.
            fields.advance(1e4, Stepping::Fixed(20), None).unwrap();
            fields.advance(1.0, Stepping::Fixed(3), None).unwrap();
            let m = f64::sqrt(decay / d);
            for (at, value) in fields.values(0).iter().enumerate() {
                let x = fields.grid().centre(at)[axis];
                let exact = match decay {
                    0.0 => 1.0 + 2.0 * x / length,
                    _ => ((m * (length - x)).sinh() + 3.0 * (m * x).sinh()) / (m * length).sinh(),
                };
                // On the grid m is smaller by m²h²/24 of it and a wall seems m²h²/8 lower; round-off of 2 000 boxes.
                let tolerance = 3.0 * (m * length / 24.0 + 1.0 / 8.0) * m * m * h * h + 1e-10;
                assert!(tolerance < 1e-6, "{tolerance:e}");
                assert!((value - exact).abs() < tolerance, "{x}: {value} {exact}");
            }
        }
    }
}

#[test]
fn walls_held_along_two_axes_agree_with_small_steps_of_an_explicit_method() {
    let walls = [[Wall::Fixed(1.0), Wall::NoFlux], [Wall::Fixed(0.2), Wall::Fixed(2.0)], [Wall::NoFlux; 2]];
    let mut fields = one([16, 12, 1], 1.0, Species::new("s", 1.0, 0.05).with_walls(walls));
    let mut slow = fields.values(0).to_vec();
    fields.advance(400.0, Stepping::Fixed(40), None).unwrap();
    explicit(fields.grid(), &walls, 1.0, 0.05, &mut slow, 400.0, 0.1, |_, _| ());
    let worst = fields.values(0).iter().zip(&slow).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // Both are at the steady state of the same equations, the explicit one to e^(−0.05·400).
    assert!(worst < 1e-8, "{worst:e}");
}

/// The method of lines by the classical Runge–Kutta method: the same equations, solved plainly.
fn explicit(
    grid: &Grid,
    walls: &Walls,
    diffusion: f64,
    decay: f64,
    u: &mut [f64],
    until: f64,
    dt: f64,
    reaction: impl Fn(&[f64], &mut [f64]),
) {
    let cells = grid.cells;
    let strides = [1, cells[0], cells[0] * cells[1]];
    let rate = |u: &[f64]| -> Vec<f64> {
        let mut slope: Vec<f64> = u.iter().map(|u| -decay * u).collect();
        for at in 0..u.len() {
            for axis in 0..3 {
                let (n, stride) = (cells[axis], strides[axis]);
                let i = at / stride % n;
                for (end, edge) in [(0, i == 0), (1, i + 1 == n)] {
                    let flow = match (edge, walls[axis][end]) {
                        (true, Wall::NoFlux) => 0.0,
                        (true, Wall::Fixed(value)) => 2.0 * (value - u[at]),
                        (true, Wall::Periodic) if end == 0 => u[at + (n - 1) * stride] - u[at],
                        (true, Wall::Periodic) => u[at - (n - 1) * stride] - u[at],
                        (false, _) if end == 0 => u[at - stride] - u[at],
                        (false, _) => u[at + stride] - u[at],
                    };
                    slope[at] += diffusion / grid.spacing[axis].powi(2) * flow;
                }
            }
        }
        reaction(u, &mut slope);
        slope
    };
    let plus = |u: &[f64], k: &[f64], h: f64| -> Vec<f64> { u.iter().zip(k).map(|(u, k)| u + h * k).collect() };
    let steps = (until / dt).ceil();
    let dt = until / steps;
    for _ in 0..steps as usize {
        let a = rate(u);
        let b = rate(&plus(u, &a, 0.5 * dt));
        let c = rate(&plus(u, &b, 0.5 * dt));
        let d = rate(&plus(u, &c, dt));
        for i in 0..u.len() {
            u[i] += dt / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
        }
    }
}

/// Exact logistic growth, u' = u (1 − u).
fn logistic(chunk: &mut Chunk) {
    let grown = chunk.dt.exp();
    for u in chunk.values.iter_mut() {
        *u = *u * grown / (1.0 + *u * (grown - 1.0));
    }
}

/// The error of the splitting at time 1 against the method of lines, for numbers of steps.
fn splitting_errors(cells: [usize; 3], walls: Walls, steps: [u32; 3]) -> [f64; 3] {
    let species = Species::new("u", 0.3, 0.2).with_walls(walls);
    let start = |p: Vec3| 0.4 + 0.3 * (1.3 * p.x).cos() * (0.9 * p.y).cos() * (0.7 * p.z).cos();
    let mut reference = one(cells, 0.5, species.clone());
    reference.set(0, start).unwrap();
    let mut u = reference.values(0).to_vec();
    let react = |u: &[f64], slope: &mut [f64]| u.iter().zip(slope).for_each(|(u, s)| *s += u * (1.0 - u));
    explicit(reference.grid(), &walls, 0.3, 0.2, &mut u, 1.0, 0.002, react);
    steps.map(|steps| {
        let mut fields = one(cells, 0.5, species.clone());
        fields.set(0, start).unwrap();
        fields.advance(1.0, Stepping::Fixed(steps), Some(&logistic)).unwrap();
        let squares: f64 = fields.values(0).iter().zip(&u).map(|(a, b)| (a - b) * (a - b)).sum();
        (squares / u.len() as f64).sqrt()
    })
}

#[test]
fn the_splitting_is_second_order_in_time_and_agrees_with_the_method_of_lines() {
    for (cells, walls) in [([16, 12, 1], CLOSED), ([16, 12, 1], RING), ([8, 10, 9], CLOSED), ([8, 10, 9], RING)] {
        let [a, b, c] = splitting_errors(cells, walls, [8, 16, 32]);
        let (first, second) = ((a / b).log2(), (b / c).log2());
        assert!(
            first > 1.85 && second > 1.94,
            "{cells:?} {walls:?}: orders {first} {second}, errors {a:e} {b:e} {c:e}"
        );
    }
}

#[test]
fn held_walls_beside_a_reaction_cost_at_most_part_of_an_order() {
    let walls = [[Wall::Fixed(0.4); 2], [Wall::NoFlux; 2], [Wall::NoFlux; 2]];
    let [a, b, c] = splitting_errors([16, 12, 1], walls, [10, 20, 40]);
    let (first, second) = ((a / b).log2(), (b / c).log2());
    println!("held walls with a reaction: orders {first} {second}, errors {a:e} {b:e} {c:e}");
    // The reaction moves the value at the wall, which diffusion then draws back: between first and second order.
    assert!(first > 1.2 && second > 1.2, "orders {first} {second}");
}

#[test]
fn the_adaptive_step_meets_its_tolerance_and_keeps_its_size() {
    let start = |p: Vec3| 0.02 + (-0.05 * (p - Vec3::new(10.0, 9.0, 0.0)).norm_squared()).exp();
    let run = |stepping: Stepping| {
        let mut fields = one([40, 36, 1], 0.5, Species::new("u", 0.5, 0.0));
        fields.set(0, start).unwrap();
        let mut steps = 0;
        for _ in 0..8 {
            steps += fields.advance(0.5, stepping, Some(&logistic)).unwrap().steps;
        }
        (fields.values(0).to_vec(), steps)
    };
    let (exact, _) = run(Stepping::Fixed(200));
    let mut before = 0;
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let (found, steps) = run(Stepping::Adaptive { relative: tolerance, absolute: 0.0 });
        let squares: f64 = found.iter().zip(&exact).map(|(a, b)| (a - b) * (a - b)).sum();
        let size: f64 = exact.iter().map(|b| b * b).sum();
        let error = (squares / size).sqrt();
        // A step's error is below the tolerance; those of all steps add up.
        assert!(error < tolerance * f64::from(steps), "{error:e} after {steps} steps at {tolerance:e}");
        assert!(steps >= before, "{steps} steps at {tolerance:e}, {before} before");
        before = steps;
    }
    assert!(before > 8 && before < 2000, "{before}");
}

#[test]
fn what_blows_up_is_told_and_leaves_the_last_good_state() {
    let explode = |chunk: &mut Chunk| {
        let dt = chunk.dt;
        chunk.values.iter_mut().for_each(|u| *u /= 1.0 - *u * dt);
        if chunk.time > 2.0 {
            chunk.values.fill(f64::NAN);
        }
    };
    for stepping in [Stepping::Fixed(4), Stepping::Adaptive { relative: 1e-3, absolute: 1e-9 }] {
        let mut fields = one([8, 8, 1], 1.0, Species::new("fuel", 0.5, 0.0));
        fields.set(0, |_| 0.01).unwrap();
        fields.advance(2.0, stepping, Some(&explode)).unwrap();
        let (kept, time) = (fields.values(0).to_vec(), fields.time());
        let message = fields.advance(2.0, stepping, Some(&explode)).unwrap_err().to_string();
        assert!(message.contains("fuel") || message.contains("tolerance"), "{message}");
        assert!(message.contains("t = "), "{message}");
        assert_eq!((fields.values(0), fields.time()), (&kept[..], time));
    }
}

#[test]
fn a_ring_has_no_beginning() {
    let run = |shift: [usize; 2]| {
        let (nx, ny) = (23, 19);
        let mut fields = one([nx, ny, 1], 1.0, Species::new("s", 2.0, 0.1).with_walls(RING));
        let point = Vec3::new((5 + shift[0]) as f64 % nx as f64 + 0.3, (7 + shift[1]) as f64 % ny as f64 + 0.6, 0.0);
        fields.deposit(0, point, 1.0);
        fields.advance(3.0, Stepping::Fixed(5), None).unwrap();
        let at = |x: usize, y: usize| fields.values(0)[fields.grid().at((x + shift[0]) % nx, (y + shift[1]) % ny, 0)];
        (0..nx * ny).map(|i| at(i % nx, i / nx)).collect::<Vec<_>>()
    };
    let here = run([0, 0]);
    for shift in [[17, 0], [3, 14]] {
        let worst = run(shift).iter().zip(&here).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Round-off of values of about 0.02.
        assert!(worst < 1e-16, "{worst:e}");
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut bits = Vec::new();
            for (cells, walls) in [([190, 203, 1], CLOSED), ([40, 33, 35], RING)] {
                let mut fields = one(cells, 1.0, Species::new("u", 1.3, 0.0).with_walls(walls));
                fields.deposit(0, Vec3::new(20.2, 21.7, 14.0), 50.0);
                let stepping = Stepping::Adaptive { relative: 1e-3, absolute: 1e-6 };
                for _ in 0..3 {
                    fields.advance(0.7, stepping, Some(&logistic)).unwrap();
                }
                bits.extend(fields.values(0).iter().map(|value| value.to_bits()));
            }
            bits
        })
    };
    assert!(run(1) == run(2), "one and two threads differ");
}

#[test]
fn releasing_is_conservative_wherever_it_happens() {
    for (cells, walls) in [([11, 13, 1], CLOSED), ([11, 13, 9], RING), ([11, 1, 1], CLOSED)] {
        let mut fields = one(cells, 0.7, Species::new("s", 1.0, 0.0).with_walls(walls));
        let points: Vec<Vec3> =
            (0..500).map(|i| Vec3::new(0.037, 0.041, 0.029) * f64::from(i) - Vec3::new(2.0, 3.0, 1.0)).collect();
        let amounts: Vec<f64> = (0..500).map(|i| 0.1 + f64::from(i % 7)).collect();
        let gained = fields.deposit_all(0, &points, &amounts);
        assert!((gained / amounts.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        assert!((fields.amount(0) / gained - 1.0).abs() < 1e-14);
        // Taking up gives back what was there and no more.
        let taken = fields.deposit_all(0, &points, &vec![-9.0; points.len()]);
        assert!((gained + taken - fields.amount(0)).abs() < 1e-12 * gained && least(&fields) >= 0.0);
        assert_eq!(fields.deposit(0, Vec3::new(f64::NAN, 0.0, 0.0), 1.0), 0.0);
        assert_eq!(fields.deposit(0, Vec3::zeros(), f64::INFINITY), 0.0);
    }
}

#[test]
fn releasing_together_is_releasing_one_after_the_other() {
    for (cells, walls) in [([11, 13, 1], CLOSED), ([11, 13, 9], RING), ([11, 1, 1], CLOSED)] {
        for range in [Range::NonNegative, Range::Free] {
            let species = Species::new("s", 1.0, 0.0).with_walls(walls).with_range(range);
            let mut together = one(cells, 0.7, species);
            let mut apart = together.clone();
            // Beyond the walls too, and some are taken up.
            let point = |i: i32| Vec3::new(0.037, 0.041, 0.029) * f64::from(i) - Vec3::new(2.0, 3.0, 1.0);
            let points: Vec<Vec3> = (0..501).map(point).collect();
            let amounts: Vec<f64> = (0..501).map(|i| (0.7 * f64::from(i)).sin() + 0.3).collect();
            let gained = together.deposit_all(0, &points, &amounts);
            let sum: f64 = points.iter().zip(&amounts).map(|(point, amount)| apart.deposit(0, *point, *amount)).sum();
            assert!(together.values(0) == apart.values(0), "{cells:?} {range:?}");
            assert!((gained - sum).abs() < 1e-12 * sum.abs());
        }
    }
}

/// Largest error of the sensed value and gradient over a domain of 1, walls included, at a spacing of 1/n.
fn sensing_errors(n: usize, flat: bool, walls: Walls, profile: impl Fn(Vec3) -> (f64, Vec3)) -> [f64; 2] {
    let grid = Grid::new([n, n, if flat { 1 } else { n }], [1.0 / n as f64; 3], Vec3::zeros()).unwrap();
    let mut fields = Fields::new(grid, vec![Species::new("s", 1.0, 0.0).with_walls(walls)]).unwrap();
    let flatten = |p: Vec3| if flat { Vec3::new(p.x, p.y, 0.0) } else { p };
    fields.set(0, |p| profile(flatten(p)).0).unwrap();
    let fraction = |i: i32, by: f64| (f64::from(i) * by).fract();
    let mut points: Vec<Vec3> = (0..4000)
        .map(|i| Vec3::new(fraction(i, 0.819_172_5), fraction(i, 0.671_043_6), fraction(i, 0.549_700_4)))
        .collect();
    points.extend([Vec3::zeros(), Vec3::new(1.0, 1.0, 1.0), Vec3::new(0.0, 0.5, 1.0), Vec3::new(1.0, 0.2, 0.0)]);
    let points: Vec<Vec3> = points.into_iter().map(flatten).collect();
    let mut sensed = vec![Sensed::default(); points.len()];
    fields.sense_all(0, &points, &mut sensed);
    points.iter().zip(&sensed).fold([0.0; 2], |worst, (p, sensed)| {
        let (value, gradient) = profile(*p);
        [worst[0].max((sensed.value - value).abs()), worst[1].max((sensed.gradient - gradient).norm())]
    })
}

#[test]
fn sensing_is_second_order_up_to_the_walls() {
    let pi = std::f64::consts::PI;
    let cosines = move |p: Vec3| {
        let [c, s] = [p.map(|v| (pi * v).cos()), p.map(|v| -pi * (pi * v).sin())];
        (2.0 + c.x * c.y * c.z, Vec3::new(s.x * c.y * c.z, c.x * s.y * c.z, c.x * c.y * s.z))
    };
    // Held at 1 along x, closed along y and z; the third derivative at the held wall does not vanish.
    let held = move |p: Vec3| {
        let (a, slope) = (p.x * (1.0 - p.x) * (1.0 + p.x), 1.0 - 3.0 * p.x * p.x);
        let [c, s] = [p.map(|v| (pi * v).cos()), p.map(|v| -pi * (pi * v).sin())];
        (1.0 + a * (2.0 + c.y * c.z), Vec3::new(slope * (2.0 + c.y * c.z), a * s.y * c.z, a * c.y * s.z))
    };
    let waves = move |p: Vec3| {
        let [c, s] = [p.map(|v| (2.0 * pi * v).cos()), p.map(|v| -2.0 * pi * (2.0 * pi * v).sin())];
        (2.0 + c.x * c.y * c.z, Vec3::new(s.x * c.y * c.z, c.x * s.y * c.z, c.x * c.y * s.z))
    };
    let walls = [[Wall::Fixed(1.0); 2], [Wall::NoFlux; 2], [Wall::NoFlux; 2]];
    let check = |name: &str, of: &dyn Fn(usize, bool) -> [f64; 2]| {
        for flat in [true, false] {
            let (coarse, fine) = (of(16, flat), of(32, flat));
            let orders = [0, 1].map(|i| (coarse[i] / fine[i]).log2());
            assert!(orders[0] > 1.85 && orders[1] > 1.85, "{name} flat {flat}: {orders:?} {coarse:?} {fine:?}");
        }
    };
    check("closed", &|n, flat| sensing_errors(n, flat, CLOSED, cosines));
    check("held", &|n, flat| sensing_errors(n, flat, walls, held));
    let ring = |flat: bool| if flat { [RING[0], RING[1], CLOSED[2]] } else { RING };
    check("ring", &|n, flat| sensing_errors(n, flat, ring(flat), waves));
}

#[test]
fn bad_species_and_grids_are_refused_with_all_their_faults() {
    let grid = Grid::new([8, 8, 1], [1.0; 3], Vec3::zeros()).unwrap();
    let walls = [[Wall::Periodic, Wall::NoFlux], [Wall::Fixed(-1.0); 2], [Wall::Fixed(0.0), Wall::NoFlux]];
    let bad = Species::new("a", -1.0, f64::NAN).with_walls(walls);
    let message = match Fields::new(grid.clone(), vec![bad]).unwrap_err() {
        pseudopod::error::Error::Input(faults) => faults.into_iter().map(|f| f.message).collect::<Vec<_>>().join("\n"),
        other => panic!("{other}"),
    };
    for part in [
        "diffusion coefficient of species 'a' is -1",
        "rate of decay",
        "periodic at one wall along x only",
        "holds species 'a' at -1",
        "fixed wall along z",
    ] {
        assert!(message.contains(part), "{part} not in {message}");
    }
    assert!(Grid::new([3, 8, 0], [1.0, -1.0, 1.0], Vec3::zeros()).is_err());
    assert!(Grid::new([usize::MAX, 8, 8], [1.0; 3], Vec3::zeros()).is_err());
    let mut fields = Fields::new(grid, vec![Species::new("a", 1.0, 0.0)]).unwrap();
    assert!(fields.set(0, |p| p.x - 1.0).is_err());
    assert!(fields.set_values(0, &[1.0]).is_err());
}
