//! Fields that are carried: by flow, by taxis, and by diffusion that varies in space, in time and with the fields.

use std::f64::consts::PI;
use std::sync::Arc;

use pseudopod::equations::eml;
use pseudopod::error::{Error, Fault, Result, Source};
use pseudopod::field::{FieldSystem, Fields, Grid, Stepping};

pub const ADAPTIVE: Stepping = Stepping::Adaptive { relative: 1e-3, absolute: 0.0 };

pub fn open(text: &str) -> (FieldSystem, Fields) {
    let source = Arc::new(Source { name: "test.eml".into(), text: text.into() });
    let document = eml::read(source).expect("a good document");
    let system = FieldSystem::new(&document, None).expect("a grid");
    let none = |_: &eml::Profile, _: &Grid| -> Result<Vec<f64>> { Err(Error::input(Fault::new("no file"))) };
    let fields = system.start(&none).expect("good profiles");
    (system, fields)
}

/// The fields of a document after a time, in so many windows.
pub fn solved(text: &str, until: f64, windows: u32, stepping: Stepping) -> (FieldSystem, Fields) {
    let (system, mut fields) = open(text);
    for _ in 0..windows {
        let report = system.advance(&mut fields, until / f64::from(windows), &[], stepping).expect("a window");
        assert!(report.steps > 0);
    }
    (system, fields)
}

/// Mean and largest difference of a field from a function of the position.
pub fn apart(fields: &Fields, exact: impl Fn(f64, f64) -> f64) -> [f64; 2] {
    let grid = fields.grid();
    let at = |at: usize| {
        let centre = grid.centre(at);
        (fields.values(0)[at] - exact(centre.x, centre.y)).abs()
    };
    let all = (0..grid.len()).map(at);
    [all.clone().sum::<f64>() / grid.len() as f64, all.fold(0.0, f64::max)]
}

pub fn order(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).log2() / (errors.len() - 1) as f64
}

#[test]
fn a_gaussian_in_a_flow_moves_with_second_order_and_keeps_its_amount() {
    let errors: Vec<f64> = [64, 128, 256]
        .map(|boxes| {
            let spacing = 20.0 / f64::from(boxes);
            let (_, before) = open(&moving(spacing));
            let (_, fields) = solved(&moving(spacing), 10.0, 1, ADAPTIVE);
            assert!((fields.amount(0) / before.amount(0) - 1.0).abs() < 1e-12);
            assert!(fields.values(0).iter().all(|value| *value >= 0.0));
            // Once around, and half a length further.
            apart(&fields, |x, _| (-(x.abs() - 10.0).powi(2) / 2.0).exp())[0]
        })
        .into();
    assert!(order(&errors) > 1.8 && errors[2] < 1.5e-3, "{errors:?}: {}", order(&errors));
}

fn moving(spacing: f64) -> String {
    format!(
        "<eml name=\"moves\"><parameter id=\"v\" value=\"3\"/>
         <grid dimension=\"1\" spacing=\"{spacing}\" origin=\"-10\" size=\"20\"/>
         <field id=\"c\" initial=\"exp(-x^2/2)\"><advection x=\"v\"/>
         <wall side=\"x-\" kind=\"periodic\"/><wall side=\"x+\" kind=\"periodic\"/></field></eml>"
    )
}

#[test]
fn what_turns_once_around_comes_back_with_second_order_in_the_plane() {
    let errors: Vec<f64> = [24, 48]
        .map(|boxes| {
            let spacing = 2.0 / f64::from(boxes);
            let text = format!(
                "<eml name=\"turns\"><grid dimension=\"2\" spacing=\"{spacing}\" origin=\"-1 -1\" size=\"2 2\"/>
                 <field id=\"c\" initial=\"exp(-40*((x - 0.4)^2 + y^2))\"><advection x=\"-2*pi*y\" y=\"2*pi*x\"/></field></eml>"
            );
            let (_, before) = open(&text);
            let (_, fields) = solved(&text, 1.0, 1, ADAPTIVE);
            assert!((fields.amount(0) / before.amount(0) - 1.0).abs() < 1e-12);
            assert!(fields.values(0).iter().all(|value| *value >= 0.0));
            apart(&fields, |x, y| (-40.0 * ((x - 0.4).powi(2) + y * y)).exp())[0]
        })
        .into();
    assert!(order(&errors) > 1.7 && errors[1] < 4e-3, "{errors:?}: {}", order(&errors));
}

#[test]
fn a_step_in_a_flow_stays_between_its_values() {
    let (_, fields) = solved(
        "<eml name=\"step\"><grid dimension=\"2\" spacing=\"0.5\" origin=\"0 0\" size=\"20 10\"/>
         <field id=\"c\" initial=\"piecewise(1, x lt 5 and y lt 5, 0)\"><advection x=\"1\" y=\"0.3\"/>
         <wall side=\"x-\" kind=\"periodic\"/><wall side=\"x+\" kind=\"periodic\"/>
         <wall side=\"y-\" kind=\"periodic\"/><wall side=\"y+\" kind=\"periodic\"/></field></eml>",
        7.0,
        1,
        ADAPTIVE,
    );
    let (least, most) = fields.values(0).iter().fold((1.0_f64, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
    assert!(least >= 0.0 && most <= 1.0 + 1e-3 && most > 0.9, "{least} {most}");
    assert!((fields.amount(0) / 25.0 - 1.0).abs() < 1e-12);
}

/// Cells that follow a field that stays, s = cos(πx/10), until they are at rest.
fn follows(spacing: f64, sensitivity: &str, s: &str) -> String {
    format!(
        "<eml name=\"follows\" time_unit=\"s\">
         <grid dimension=\"1\" spacing=\"{spacing}\" origin=\"0\" size=\"10\" unit=\"um\"/>
         <field id=\"c\" unit=\"uM\" diffusion=\"2 [um^2/s]\" initial=\"1 [uM]\">
         <taxis towards=\"s\" sensitivity=\"{sensitivity}\"/></field>
         <field id=\"s\" unit=\"1\" range=\"free\" initial=\"{s}\"/></eml>"
    )
}

#[test]
fn at_rest_cells_that_follow_a_field_are_where_theory_has_them() {
    let cosine = "cos(pi*x/10 [um])";
    let errors: Vec<f64> = [10, 20, 40]
        .map(|boxes| {
            let text = follows(10.0 / f64::from(boxes), "3 [um^2/s]", cosine);
            let (_, fields) = solved(&text, 50.0, 2, ADAPTIVE);
            assert!((fields.amount(0) / 10.0 - 1.0).abs() < 1e-12, "{}", fields.amount(0));
            // c ∝ exp(χ s/D), with the mean of I₀(χ/D) = Σ (χ/2D)²ᵏ/k!².
            let terms = (0..20).scan(1.0, |term, k| {
                let now = *term;
                *term *= (1.5_f64 / 2.0).powi(2) / f64::from((k + 1) * (k + 1));
                Some(now)
            });
            let mean: f64 = terms.sum();
            apart(&fields, |x, _| (1.5 * (PI * x / 10.0).cos()).exp() / mean)[1]
        })
        .into();
    assert!(order(&errors) > 1.8 && errors[2] < 5e-3, "{errors:?}: {}", order(&errors));
}

#[test]
fn a_sensitivity_that_saturates_gives_the_profile_of_its_integral() {
    // χ = χ₀ K/(K + s)²: c ∝ exp(χ₀/D · s/(K + s)).
    let text = follows(0.2, "4 [um^2/s]*2/(2 + s)^2", "x/5 [um]");
    let (_, fields) = solved(&text, 50.0, 2, ADAPTIVE);
    let exact = |x: f64| (2.0 * (x / 5.0) / (2.0 + x / 5.0)).exp();
    let mean = (0..10_000).map(|i| exact((f64::from(i) + 0.5) * 1e-3)).sum::<f64>() / 1e4;
    let [_, worst] = apart(&fields, |x, _| exact(x) / mean);
    assert!(worst < 5e-4, "{worst}");
}

#[test]
fn a_steep_taxis_into_nothing_leaves_nothing_below_zero() {
    let (_, fields) = solved(
        "<eml name=\"steep\"><grid dimension=\"2\" spacing=\"1\" origin=\"-10 -10\" size=\"20 20\"/>
         <field id=\"c\" diffusion=\"0.1\" initial=\"piecewise(1, x lt -5, 0)\"><taxis towards=\"s\" sensitivity=\"20\"/></field>
         <field id=\"s\" diffusion=\"5\" decay=\"0.1\" initial=\"exp(-(x^2 + y^2)/8)\"><reaction>c</reaction></field></eml>",
        4.0,
        8,
        ADAPTIVE,
    );
    assert!(fields.values(0).iter().all(|value| *value >= 0.0));
    let amount = 20.0 * 5.0;
    assert!((fields.amount(0) / amount - 1.0).abs() < 1e-12, "{}", fields.amount(0));
}

#[test]
fn two_layers_at_rest_have_the_flux_of_both_resistances() {
    // D is 4 left of 0 and 1 right of it; walls hold 2 and 0: the value between them is 2·4/(4 + 1).
    let (_, fields) = solved(
        "<eml name=\"layers\"><grid dimension=\"1\" spacing=\"0.5\" origin=\"-5\" size=\"10\"/>
         <field id=\"c\" diffusion=\"piecewise(4, x lt 0, 1)\" initial=\"1\">
         <wall side=\"x-\" kind=\"fixed\" value=\"2\"/><wall side=\"x+\" kind=\"fixed\" value=\"0\"/></field></eml>",
        100.0,
        1,
        ADAPTIVE,
    );
    let between = 1.6;
    let exact = |x: f64, _| if x < 0.0 { between - (2.0 - between) * x / 5.0 } else { between * (1.0 - x / 5.0) };
    let [_, worst] = apart(&fields, exact);
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn diffusion_that_varies_in_time_spreads_by_its_integral() {
    // Variance 1 + 2 ∫ (2 + sin t) dt.
    let errors: Vec<f64> = [1e-2, 1e-4]
        .map(|relative| {
            let (_, fields) = solved(
                "<eml name=\"course\"><grid dimension=\"1\" spacing=\"0.2\" origin=\"-20\" size=\"40\"/>
                 <field id=\"c\" diffusion=\"2 + sin(time)\" initial=\"exp(-x^2/2)\"/></eml>",
                5.0,
                1,
                Stepping::Adaptive { relative, absolute: 0.0 },
            );
            let variance = 1.0 + 2.0 * (10.0 + 1.0 - 5f64.cos());
            apart(&fields, |x, _| (-x * x / (2.0 * variance)).exp() / variance.sqrt())[1]
        })
        .into();
    assert!(errors[0] < 2e-3 && errors[1] < 2e-4, "{errors:?}");
}

#[test]
fn diffusion_by_its_own_value_spreads_as_barenblatt_says() {
    // ∂c/∂t = ∇·(2c ∇c) = Δ(c²): c = t^(−1/3) max(0, 1 − x²/(12 t^(2/3))), from t = 1 on.
    let exact = |x: f64, t: f64| t.powf(-1.0 / 3.0) * (1.0 - x * x / (12.0 * t.powf(2.0 / 3.0))).max(0.0);
    let errors: Vec<f64> = [0.4, 0.2, 0.1]
        .map(|spacing| {
            let (_, fields) = solved(
                &format!(
                    "<eml name=\"porous\"><grid dimension=\"1\" spacing=\"{spacing}\" origin=\"-12\" size=\"24\"/>
                     <field id=\"c\" diffusion=\"2*c\" initial=\"max(0, 1 - x^2/12)\"/></eml>"
                ),
                7.0,
                1,
                ADAPTIVE,
            );
            assert!(fields.values(0).iter().all(|value| *value >= 0.0));
            apart(&fields, |x, _| exact(x, 8.0))[0]
        })
        .into();
    // The front has a corner: the mean error falls as the spacing to the power 4/3 or better there.
    assert!(order(&errors) > 1.3 && errors[2] < 1e-3, "{errors:?}: {}", order(&errors));
}

/// All kinds of transport at once, in space.
const ALL: &str = "<eml name=\"all\"><input id=\"w\" default=\"1\"/><grid dimension=\"3\" spacing=\"1\" origin=\"0 0 0\" size=\"20 17 16\"/>
    <field id=\"c\" diffusion=\"0.5 + 0.1*c\" decay=\"0.01\" initial=\"1 + 0.3*sin(x + y)\">
    <advection x=\"w\" y=\"0.2*z\" z=\"0.1*sin(time)\"/><taxis towards=\"s\" sensitivity=\"1/(1 + s)^2\"/>
    <source from=\"2 2 2\" to=\"9 4 14\" strength=\"3\"/><wall side=\"x-\" kind=\"flux\" value=\"0.5*(2 - c)\"/>
    <wall side=\"x+\" kind=\"open\"/><wall side=\"y-\" kind=\"periodic\"/><wall side=\"y+\" kind=\"periodic\"/>
    <wall side=\"z+\" kind=\"fixed\" value=\"1 + 0.1*x*time\"/></field>
    <field id=\"s\" diffusion=\"2\" decay=\"0.5\" initial=\"exp(-x)\"><reaction>c</reaction></field></eml>";

#[test]
fn threads_change_no_bit_of_what_is_carried() {
    let run = |threads: usize| -> Vec<u64> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| {
            let (system, mut fields) = open(ALL);
            system.advance(&mut fields, 0.2, &[0.8], ADAPTIVE).expect("a window");
            (0..2).flat_map(|s| fields.values(s)).map(|value| value.to_bits()).collect()
        })
    };
    assert!(run(1) == run(3), "one and three threads differ");
}

#[test]
fn what_is_written_of_transport_is_read_as_the_same() {
    let read = |text: &str| eml::read(Arc::new(Source { name: "all.eml".into(), text: text.into() })).expect("good");
    let again = eml::write(&read(ALL), "").text;
    let run = |text: &str| {
        let (system, mut fields) = open(text);
        system.advance(&mut fields, 0.05, &[0.8], Stepping::Fixed(1)).expect("a window");
        fields.values(0).to_vec()
    };
    // What cells release is brought in by parts of the time in which it decays, which is told of carried fields, too.
    let (system, _) = open(ALL);
    assert!(system.species()[0].decay == 0.01 && system.species()[0].carried && !system.species()[1].carried);
    assert!(again.contains("<advection") && again.contains("<taxis") && again.contains("kind=\"open\""), "{again}");
    assert!(run(ALL) == run(&again), "{again}");
}

#[test]
fn inputs_reach_what_carries() {
    let mean = |w: f64| {
        let (system, mut fields) =
            open(&moving(0.5).replace("<parameter id=\"v\" value=\"3\"/>", "<input id=\"v\" default=\"0\"/>"));
        system.advance(&mut fields, 2.0, &[w], ADAPTIVE).expect("a window");
        let grid = system.grid();
        (0..grid.len()).map(|at| grid.centre(at).x * fields.values(0)[at]).sum::<f64>()
            / fields.values(0).iter().sum::<f64>()
    };
    assert!((mean(1.5) - 3.0).abs() < 0.02 && mean(0.0).abs() < 1e-9, "{} {}", mean(1.5), mean(0.0));
}

#[test]
fn halves_of_fixed_steps_err_a_quarter_with_all_that_acts_in_turn() {
    // Reactions, plain diffusion of s and transport of c are taken in turn.
    let run = |steps: u32| {
        let text =
            ALL.replace("dimension=\"3\"", "dimension=\"2\"").replace("0 0 0", "0 0").replace("20 17 16", "12 8");
        let text = text.replace("<wall side=\"z+\" kind=\"fixed\" value=\"1 + 0.1*x*time\"/>", "");
        let text = text
            .replace(" z=\"0.1*sin(time)\"", "")
            .replace("2 2 2", "2 2")
            .replace("9 4 14", "9 4")
            .replace("0.2*z", "0.2*x");
        let (system, mut fields) = open(&text);
        system.advance(&mut fields, 1.0, &[0.8], Stepping::Fixed(steps)).expect("a window");
        fields
    };
    let best = run(256);
    let error = |steps: u32| {
        let fields = run(steps);
        let apart =
            |s: usize| fields.values(s).iter().zip(best.values(s)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        apart(0).max(apart(1))
    };
    let errors = [error(16), error(32)];
    let order = order(&errors);
    assert!((1.7..2.6).contains(&order), "{errors:?}: {order}");
}

#[test]
fn stages_of_a_long_step_see_the_time_where_they_are() {
    // The second moment grows by 2 ∫ D dt whatever the grid, so that what is left is the step's error in time alone.
    let error = |steps: u32| {
        let (system, mut fields) = open(
            "<eml name=\"course\"><grid dimension=\"1\" spacing=\"0.5\" origin=\"-20\" size=\"40\"/>
             <field id=\"c\" diffusion=\"1 + time^3\" initial=\"exp(-x^2/2)\"/></eml>",
        );
        let moment = |fields: &Fields| {
            let boxes = fields.values(0).iter().enumerate();
            let sum: f64 = boxes.map(|(at, value)| value * fields.grid().centre(at).x.powi(2)).sum();
            sum / fields.values(0).iter().sum::<f64>()
        };
        let before = moment(&fields);
        system.advance(&mut fields, 2.0, &[], Stepping::Fixed(steps)).expect("a window");
        (moment(&fields) - before - 2.0 * (2.0 + 4.0)).abs()
    };
    let errors = [error(4), error(8)];
    // The trapezoidal rule errs 0.125 in steps of 0.25.
    assert!(order(&errors) > 1.7 && errors[1] < 0.25, "{errors:?}: {}", order(&errors));
}

#[test]
fn a_long_step_of_what_is_rough_leaves_nothing_below_zero() {
    for steps in 1..=12 {
        let (_, fields) = solved(
            "<eml name=\"rough\"><grid dimension=\"1\" spacing=\"1\" origin=\"-20\" size=\"40\"/>
             <field id=\"c\" diffusion=\"2 + 0.01*x\" initial=\"piecewise(1, x gt 0 and x lt 1, 0)\"><advection x=\"0.8\"/></field></eml>",
            6.0,
            1,
            Stepping::Fixed(steps),
        );
        assert!(fields.values(0).iter().all(|value| *value >= 0.0));
        assert!((fields.amount(0) - 1.0).abs() < 1e-12, "{}", fields.amount(0));
    }
}

#[test]
fn a_sink_takes_no_more_than_there_is() {
    for steps in [1, 2, 5] {
        let (_, fields) = solved(
            "<eml name=\"sink\"><grid dimension=\"1\" spacing=\"1\" origin=\"-20\" size=\"40\"/>
             <field id=\"c\" diffusion=\"2\" initial=\"0.1\"><source at=\"-5.5\" strength=\"-1\"/></field></eml>",
            6.0,
            1,
            Stepping::Fixed(steps),
        );
        assert!(fields.values(0).iter().all(|value| *value >= 0.0));
        assert!(fields.amount(0) < 4.0 && fields.values(0)[14] < 0.02, "{:?}", fields.values(0));
    }
}
