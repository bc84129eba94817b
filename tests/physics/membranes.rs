//! Substances on membranes: they spread, react, are diluted and exchanged as the equations of the book say.

use crate::coupled_scene::{Scene, crowd, scene, sphere};
use pseudopod::membrane::MembraneCells;

fn surfaces(scene: &Scene) -> &MembraneCells {
    &scene.state().chemistry.membranes[0].kinds[0]
}

/// Harmonics of degree 1, 2 and 3, each on a substance of its own with D = 1 µm²/s.
const HARMONICS: &str = r#"<eml name="own" level="membrane">
    <variable id="one" initial="1 + z/5" diffusion="1" rate="0"/>
    <variable id="two" initial="1 + (3*z^2 - 25)/50" diffusion="1" rate="0"/>
    <variable id="three" initial="1 + (5*z^3 - 75*z)/250" diffusion="1" rate="0"/>
    <solver rtol="1e-9" atol="1e-11"/></eml>"#;

#[test]
fn harmonics_on_a_sphere_decay_at_their_rates_with_second_order() {
    let rates = |level: usize| -> [f64; 3] {
        let mut scene = scene(&[("own", HARMONICS)], &sphere(level, "2 s", "0.1 s"));
        scene.begin();
        let atoms = scene.compiled.model.kinds[0].atoms();
        let start = surfaces(&scene).clone();
        scene.run();
        let now = surfaces(&scene);
        std::array::from_fn(|variable| {
            let part = |then: &MembraneCells| -> f64 {
                let shape = |atom: usize| start.value(0, variable, atom) - 1.0;
                (0..atoms).map(|i| start.area(0, i) * shape(i) * (then.value(0, variable, i) - 1.0)).sum()
            };
            -(part(now) / part(&start)).ln() / 2.0
        })
    };
    let found: Vec<[f64; 3]> = (1..=4).map(rates).collect();
    for degree in 1..=3 {
        // l (l + 1) D / R².
        let exact = (degree * (degree + 1)) as f64 / 25.0;
        let errors: Vec<f64> = found.iter().map(|rates| rates[degree - 1] / exact - 1.0).collect();
        println!("degree {degree}: relative errors {errors:?}");
        for (level, pair) in errors.windows(2).enumerate() {
            let order = (pair[0] / pair[1]).abs().log2();
            println!("  order from level {} to {}: {order}", level + 1, level + 2);
            // Degree 1 does better: the scheme is exact for coordinates but for the direction of the normals.
            let most = if degree == 1 { 4.5 } else { 2.3 };
            assert!((1.7..most).contains(&order), "degree {degree}: order {order} from {pair:?}");
        }
        assert!(errors[3].abs() < 0.01, "{errors:?}");
    }
}

/// A cell that is drawn out by two loads while substances spread on it, react and are exchanged with the inside.
fn drawn_out(documents: &[(&str, &str)]) -> Scene {
    let text = sphere(2, "4 s", "0.05 s")
        + r#"loads = [
  { name = "up", cap = { direction = [0, 0, 1], number = 12 }, direction = [0, 0, 1], force = "500 pN" },
  { name = "down", cap = { direction = [0, 0, -1], number = 12 }, direction = [0, 0, -1], force = "500 pN" },
]
"#;
    scene(documents, &text)
}

#[test]
fn what_is_on_a_deforming_cell_stays_and_is_diluted_where_the_surface_stretches() {
    let eml = r#"<eml name="own" level="membrane">
        <variable id="still" initial="2 + 0.2*x" rate="0"/>
        <variable id="spreads" initial="2 + 0.3*z" diffusion="3" rate="0"/></eml>"#;
    let mut scene = drawn_out(&[("own", eml)]);
    scene.begin();
    let start = surfaces(&scene).clone();
    let atoms = scene.compiled.model.kinds[0].atoms();
    let (mut worst, mut stretched) = (0.0_f64, 1.0_f64);
    while scene.state().time < 4.0 {
        scene.step().unwrap();
        let now = surfaces(&scene);
        for variable in 0..2 {
            worst = worst.max((now.amount(0, variable) / start.amount(0, variable) - 1.0).abs());
        }
        for atom in 0..atoms {
            let stretch = now.area(0, atom) / start.area(0, atom);
            stretched = stretched.max(stretch);
            let diluted = now.value(0, 0, atom) * stretch / start.value(0, 0, atom);
            // Two divisions and two products a step, for 80 steps.
            assert!((diluted - 1.0).abs() < 1e-13, "atom {atom}: {diluted}");
        }
    }
    println!("worst change of an amount {worst:.1e}, largest stretch {stretched:.3}");
    assert!(stretched > 1.2, "the surface must stretch: {stretched}");
    assert!(worst < 1e-12, "{worst}");
}

#[test]
fn what_leaves_the_membrane_is_found_inside() {
    // a binds and leaves: amount per area times area, and per volume times volume, together stay.
    let eml = r#"<eml name="own" level="membrane" time_unit="s">
        <parameter id="on" value="2" unit="um/s"/><parameter id="off" value="0.5" unit="1/s"/>
        <variable id="a" initial="10 [1/um^2]*(1 + x/10 [um])" unit="1/um^2" diffusion="0.5"/>
        <variable id="c" initial="8" unit="1/um^3" level="cell" rate="-inflow/volume"/>
        <define id="binding" unit="1/um^2/s">(on*c - off*a)*(1 + z^2/25 [um^2])</define>
        <equation of="a">binding</equation>
        <integral id="inflow" unit="1/s">binding</integral>
        <integral id="bound" unit="1">a</integral></eml>"#;
    let mut scene = drawn_out(&[("own", eml)]);
    scene.begin();
    let amount = |scene: &Scene| {
        let kind = &scene.compiled.model.kinds[0];
        let shape = pseudopod::geometry::Surface {
            positions: scene.state().kinds[0].cell(kind, 0),
            facets: kind.rest.facets.clone(),
        };
        let inside = scene.value(0, "c", 0) * pseudopod::geometry::volume(&shape);
        (inside + surfaces(scene).amount(0, 0), inside)
    };
    let (start, inside) = amount(&scene);
    let mut worst = 0.0_f64;
    while scene.state().time < 4.0 {
        scene.step().unwrap();
        worst = worst.max((amount(&scene).0 / start - 1.0).abs());
        let bound = scene.value(0, "bound", 0) / surfaces(&scene).amount(0, 0);
        assert!((bound - 1.0).abs() < 1e-13, "the integral is that of the present shape: {bound}");
    }
    println!("worst change of the amount {worst:.1e}; inside {inside} to {}", amount(&scene).1);
    assert!((amount(&scene).1 / inside - 1.0).abs() > 0.1, "much is exchanged");
    assert!(worst < 1e-12, "{worst}");
    // At rest binding and leaving are in balance, whatever the geometry: a = on c / off everywhere.
    assert!(
        (scene.value(0, "bound", 0) / scene.value(0, "area", 0) / (4.0 * scene.value(0, "c", 0)) - 1.0).abs() < 0.01
    );
}

const PINNING: &str = include_str!("../../eml/wave_pinning.eml");

#[test]
fn threads_and_stops_change_no_bit_of_a_membrane() {
    let documents = [("own", PINNING)];
    let once = crowd(1, &documents, 6, |_| ());
    let threads = crowd(3, &documents, 6, |_| ());
    let stopped = crowd(2, &documents, 6, Scene::stop_and_resume);
    assert_eq!(once.state(), threads.state(), "threads");
    assert_eq!(once.state(), stopped.state(), "stops");
    let poisoned = crowd(1, &documents, 6, |scene| {
        let model = scene.compiled.model.clone();
        scene.ws.poison(&model);
    });
    assert_eq!(once.state(), poisoned.state(), "scratch is scratch");
}

/// The least and the largest density of a variable on a cell.
fn extremes(cells: &MembraneCells, variable: usize) -> (f64, f64) {
    cells
        .values(0, variable)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// The density of the inactive form at which a front between the two states of the active one stands still (Maxwell's rule: the
/// reaction does no work from one to the other), and these states, for the numbers of the paper.
fn standing_front() -> [f64; 3] {
    let rate = |a: f64, b: f64| b * (0.067 + a * a / (1.0 + a * a)) - a;
    let root = |b: f64, mut low: f64, mut high: f64| {
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if (rate(low, b) > 0.0) == (rate(middle, b) > 0.0) { low = middle } else { high = middle }
        }
        low
    };
    let work = |b: f64| {
        let (low, high) = (root(b, 0.0, 0.35), root(b, 0.9, 4.0));
        let integral = |a: f64| b * (1.067 * a - a.atan()) - 0.5 * a * a;
        (integral(high) - integral(low), low, high)
    };
    let (mut under, mut over) = (1.79, 2.2);
    for _ in 0..100 {
        let middle = 0.5 * (under + over);
        if work(middle).0 < 0.0 { under = middle } else { over = middle }
    }
    let (_, low, high) = work(under);
    [under, low, high]
}

#[test]
fn a_pinned_wave_polarises_from_a_transient_cue_keeps_its_side_and_turns_with_the_cue() {
    let mut scene = scene(&[("own", PINNING)], &sphere(3, "200 s", "0.5 s"));
    scene.begin();
    let polarity = |scene: &Scene| scene.value(0, "polarity", 0);
    let (molecules, mut worst) = (scene.value(0, "molecules", 0), 0.0_f64);
    let mut until = |scene: &mut Scene, time: f64| {
        while scene.state().time < time {
            scene.step().unwrap();
            worst = worst.max((scene.value(0, "molecules", 0) / molecules - 1.0).abs());
        }
        let (a, b) = (extremes(surfaces(scene), 0), extremes(surfaces(scene), 1));
        println!(
            "t = {time}: polarity {:.4}, a from {:.4} to {:.4}, b from {:.4} to {:.4}",
            polarity(scene),
            a.0,
            a.1,
            b.0,
            b.1
        );
        (polarity(scene), a, b)
    };
    // Before the cue (the step that ends at 5 s already sees its begin) the surface is uniform but for what its shape settles.
    let (before, a, _) = until(&mut scene, 4.5);
    assert!(before.abs() < 1e-6 && a.1 / a.0 < 1.0 + 1e-6, "{before}, {a:?}");
    let (cued, ..) = until(&mut scene, 25.0);
    let (kept, a, b) = until(&mut scene, 100.0);
    assert!(cued > 0.3 && kept > 0.3, "polarised to {cued}, kept {kept}");
    let [still, low, high] = standing_front();
    println!("a front stands still at b = {still:.4}, between a = {low:.4} and {high:.4}");
    // The inactive form is all but uniform, at the density at which a front stands still; the front here is bent and D_b finite.
    let mean = 0.5 * (b.0 + b.1);
    assert!((mean / still - 1.0).abs() < 0.02, "{mean} against {still}");
    assert!((a.0 / low - 1.0).abs() < 0.05 && (a.1 / high - 1.0).abs() < 0.05, "{a:?} against {low} and {high}");
    let (turned, ..) = until(&mut scene, 120.0);
    let (stays, ..) = until(&mut scene, 200.0);
    assert!(turned < -0.3 && stays < -0.3, "turned to {turned}, stays {stays}");
    println!("worst change of the molecules {worst:.1e}");
    assert!(worst < 1e-12, "{worst}");
}

#[test]
fn without_a_cue_nothing_is_polarised() {
    let own = PINNING.replace("id=\"strength\" value=\"0.3\"", "id=\"strength\" value=\"0\"");
    assert_ne!(own, PINNING);
    let mut scene = scene(&[("own", &own)], &sphere(2, "100 s", "1 s"));
    scene.begin();
    scene.run();
    let (low, high) = extremes(surfaces(&scene), 0);
    println!("densities differ by {:.1e}", high / low - 1.0);
    // Stretches of atoms that come back to 1 differ by round-off in each of 100 steps; nothing makes more of it.
    assert!(high / low - 1.0 < 1e-12, "{low} to {high}");
}

/// What spreads, reacts and is exchanged, all of it not linear.
const MIXED: &str = r#"<eml name="own" level="membrane">
    <variable id="a" initial="1 + 0.1*x + 0.02*y*z" diffusion="2" rate="inside*a^2/(1 + a^2) - 0.5*a"/>
    <variable id="inside" initial="1.5" level="cell" rate="0.3 - 0.2*mean*inside"/>
    <mean id="mean">a</mean>SOLVER</eml>"#;

#[test]
fn reactions_diffusion_and_exchange_are_of_third_order_together() {
    let end = |solver: &str| {
        let own = MIXED.replace("SOLVER", solver);
        let mut scene = scene(&[("own", &own)], &sphere(1, "4 s", "2 s"));
        scene.run();
        let mut values: Vec<f64> = surfaces(&scene).values(0, 0).collect();
        values.push(scene.value(0, "inside", 0));
        values
    };
    let exact = end(r#"<solver rtol="1e-10" atol="1e-12"/>"#);
    let error = |step: f64| {
        let found = end(&format!(r#"<solver inner_step="{step}" rtol="1e-10" atol="1e-12"/>"#));
        found.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let errors = [0.5, 0.25, 0.125].map(error);
    let orders = [errors[0] / errors[1], errors[1] / errors[2]].map(f64::log2);
    println!("errors {errors:?}, orders {orders:?}");
    assert!(orders.iter().all(|order| (2.7..3.4).contains(order)), "{orders:?}");
}

#[test]
fn the_error_of_a_run_follows_its_tolerance() {
    let end = |rtol: f64| {
        let own = MIXED.replace("SOLVER", &format!(r#"<solver rtol="{rtol}" atol="{}"/>"#, rtol * 1e-3));
        let mut scene = scene(&[("own", &own)], &sphere(1, "20 s", "20 s"));
        scene.run();
        let values: Vec<f64> = surfaces(&scene).values(0, 0).collect();
        values
    };
    let exact = end(1e-10);
    for rtol in [1e-3, 1e-4, 1e-5, 1e-6] {
        let error = end(rtol).iter().zip(&exact).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        println!("tolerance {rtol:.0e}: relative error {error:.1e}");
        // The error of a step is held; steps add up, and the solution that is kept is of higher order.
        assert!(error < 10.0 * rtol, "{error} at {rtol}");
    }
}

#[test]
fn pools_keep_their_amount_when_the_volume_changes() {
    let eml = r#"<eml name="own" level="membrane"><variable id="a" initial="1" rate="0"/>
        <variable id="c" initial="2 + 0*volume" level="cell" rate="0"/></eml>"#;
    let text = sphere(1, "2 s", "0.1 s").replace(
        "shape_modulus = \"10 pN/um\" } }",
        "shape_modulus = \"10 pN/um\" }, volume = { rule = \"exact\", ratio = [[\"0 s\", 1.0], [\"2 s\", 1.3]] } }",
    );
    let mut scene = scene(&[("own", eml)], &text);
    scene.begin();
    let amount = |scene: &Scene| scene.value(0, "c", 0) * scene.value(0, "volume", 0);
    let (start, area) = (amount(&scene), surfaces(&scene).amount(0, 0));
    scene.run();
    println!("concentration {}", scene.value(0, "c", 0));
    assert!((scene.value(0, "c", 0) / (2.0 / 1.3) - 1.0).abs() < 1e-9, "the volume is exact to 1e-10");
    assert!((amount(&scene) / start - 1.0).abs() < 1e-13 && (surfaces(&scene).amount(0, 0) / area - 1.0).abs() < 1e-13);
}

#[test]
fn nothing_leaves_a_sheet_at_its_rim() {
    let eml =
        r#"<eml name="own" level="membrane"><variable id="a" initial="1 + (x gt 0)" diffusion="10" rate="0"/></eml>"#;
    let text = r#"
[run]
until = "40 s"
integrator = { step = "1 s" }
[output]
every = "40 s"
[cells.cell]
mesh = { shape = "sheet", size = ["16 um", "4 um"], divisions = [16, 4] }
mechanics = { drag = "20 pN s/um", shape_memory = { stiffness = "10 pN/um" } }
chemistry = ["own"]
"#;
    let mut scene = scene(&[("own", eml)], text);
    scene.begin();
    let start = surfaces(&scene).amount(0, 0);
    scene.run();
    let (low, high) = extremes(surfaces(&scene), 0);
    println!("from {low} to {high}");
    assert!((surfaces(&scene).amount(0, 0) / start - 1.0).abs() < 1e-13);
    // The slowest wave decays by exp(-D (pi/16)^2 40), 2e-7, and what the tolerance of 1e-4 leaves is spread, too.
    assert!(high - low < 1e-5 && (high * 64.0 / start - 1.0).abs() < 1e-5, "{low} to {high}");
}

#[test]
fn cells_that_come_start_and_those_that_stay_keep_what_is_on_them() {
    let mut scene = crowd(1, &[("own", PINNING)], 3, |_| ());
    let before = surfaces(&scene).clone();
    let pseudopod::experiment::Compiled { model, state, .. } = &mut scene.compiled;
    let ids = state.kinds[0].ids.clone();
    pseudopod::sim::remove_cells(model, state, &mut scene.ws, &[ids[4], ids[20]]).unwrap();
    let positions: Vec<pseudopod::Vec3> =
        model.kinds[0].rest.positions.iter().map(|x| x + pseudopod::Vec3::new(0.0, 0.0, 40.0)).collect();
    let new = pseudopod::sim::NewCell { positions, parent: None };
    pseudopod::sim::add_cells(model, state, &mut scene.ws, 0, &[new]).unwrap();
    let now = surfaces(&scene);
    assert_eq!(now.cells(), before.cells() - 1);
    let kept = (0..before.cells()).filter(|cell| ![4, 20].contains(cell));
    for (cell, old) in kept.enumerate() {
        assert!(now.values(cell, 0).eq(before.values(old, 0)), "cell {old}");
    }
    let last = now.cells() - 1;
    assert!(now.values(last, 0).all(|value| value == 0.2683), "the new cell has its start");
    assert!((scene.value(0, "active", last) - 0.2683).abs() < 1e-12, "and its sums");
    for _ in 0..3 {
        scene.step().unwrap();
    }
}

#[test]
fn no_diffusion_is_too_fast_for_a_step() {
    let eml = r#"<eml name="own" level="membrane"><variable id="a" initial="1 + x/5" diffusion="1e8" rate="0"/></eml>"#;
    let mut scene = scene(&[("own", eml)], &sphere(2, "2 s", "1 s"));
    scene.begin();
    let start = surfaces(&scene).amount(0, 0);
    scene.run();
    let (low, high) = extremes(surfaces(&scene), 0);
    println!("from {low} to {high}");
    assert!(high - low < 1e-4, "the tolerance is 1e-4: {low} to {high}");
    assert!((surfaces(&scene).amount(0, 0) / start - 1.0).abs() < 1e-12);
}

#[test]
fn a_cell_alone_and_cells_abreast_come_to_the_same() {
    let end = |number: usize| {
        let text = sphere(1, "10 s", "0.5 s").replace("[cells.cell]", &format!("[cells.cell]\nnumber = {number}"));
        let mut scene = scene(&[("own", PINNING)], &text);
        scene.run();
        let cells = surfaces(&scene);
        (0..number).map(|cell| cells.values(cell, 0).collect::<Vec<f64>>()).collect::<Vec<_>>()
    };
    let (alone, abreast) = (&end(1)[0], end(11));
    for (cell, values) in abreast.iter().enumerate() {
        let worst = values.iter().zip(alone).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        // Positions differ by the round-off of where the cells stand, 1e-14 of an edge, and angles with them.
        assert!(worst < 1e-10, "cell {cell}: {worst:.1e}");
    }
}

#[test]
fn pulses_far_shorter_than_a_step_are_all_there_on_membranes() {
    let own = r#"<eml name="own" level="membrane"><variable id="a" initial="0" diffusion="1" rate="1000*pulse(3, 0.001, 4)"/>
        <variable id="pool" level="cell" initial="0" rate="piecewise(100, rem(time, 7) lt 0.02, 0)"/><mean id="m">a</mean></eml>"#;
    for step in ["1 s", "3 s"] {
        let mut scene = crate::coupled_scene::scene(&[("own", own)], &crate::coupled_scene::one_cell("12 s", step));
        scene.run();
        // Three of one each on the surface, two of 2 in the pool.
        for (id, wanted) in [("m", 3.0), ("pool", 4.0)] {
            let found = scene.value(0, id, 0);
            assert!((found / wanted - 1.0).abs() < 1e-9, "{step}, {id}: {found} for {wanted}");
        }
    }
}
