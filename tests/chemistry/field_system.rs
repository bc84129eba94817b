//! Documents of fields on their grids: they start and advance in their own units, the splitting agrees with the method
//! of lines to second order, and known fronts and patterns come out.

use std::sync::Arc;

use pseudopod::equations::eml;
use pseudopod::error::{Error, Fault, Result, Source};
use pseudopod::field::{FieldSystem, Fields, Grid, Placing, Stepping};

use crate::shared::shared;

const ADAPTIVE: Stepping = Stepping::Adaptive { relative: 1e-3, absolute: 1e-6 };

fn read(text: &str) -> eml::Document {
    eml::read(Arc::new(Source { name: "test.eml".into(), text: text.into() })).expect("a good document")
}

fn from_file(name: &str) -> eml::Document {
    let path = format!("{}/eml/{name}.eml", env!("CARGO_MANIFEST_DIR"));
    read(&std::fs::read_to_string(path).expect("a document of eml/"))
}

fn no_file(_: &eml::Profile, _: &Grid) -> Result<Vec<f64>> {
    Err(Error::input(Fault::new("no file was expected")))
}

fn on_grid(document: &eml::Document, placing: Option<&Placing>) -> (FieldSystem, Fields) {
    let system = FieldSystem::new(document, placing).expect("a good document");
    let fields = system.start(&no_file).expect("good profiles");
    (system, fields)
}

fn open(text: &str) -> (FieldSystem, Fields) {
    on_grid(&read(text), None)
}

/// Largest difference over all species and boxes.
fn apart(a: &Fields, b: &Fields) -> f64 {
    let species = 0..a.species().len();
    let pairs = species.flat_map(|s| a.values(s).iter().zip(b.values(s)));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn all_documents_of_fields_start_and_advance() {
    let placing = Placing { origin: [-50.0, -50.0, 2.0], size: [102.0, 100.0, 0.0] };
    for (name, boxes) in [("attractant", 21 * 20), ("brusselator", 128 * 128), ("gray_scott", 256 * 256)] {
        let (system, mut fields) = on_grid(&from_file(name), Some(&placing));
        assert_eq!((system.grid().len(), system.name()), (boxes, name));
        let report = system.advance(&mut fields, 1.0, &[], ADAPTIVE).expect("a window");
        assert!(report.error <= 1.0 && fields.time() == 1.0, "{name} {report:?}");
        println!("{name}: {report:?}");
    }
}

/// A small Brusselator between walls of one kind, far from its steady state.
fn brusselator(wall: &str, solver: &str) -> String {
    let walls = |value: &str| -> String {
        let value = if wall == "fixed" { format!("value=\"{value}\"") } else { String::new() };
        ["x-", "x+", "y-", "y+"].map(|side| format!("<wall side=\"{side}\" kind=\"{wall}\" {value}/>")).concat()
    };
    // A ring has no place that the wave must keep to.
    let turn = if wall == "periodic" { 0.7 } else { 0.0 };
    format!(
        "<eml name=\"brusselator\" level=\"field\"><parameter id=\"A\" value=\"3\"/><parameter id=\"B\" value=\"4.5\"/>
         <define id=\"turnover\">U^2*V</define>{solver}
         <grid dimension=\"2\" spacing=\"0.6\" origin=\"0 0\" size=\"6 4.8\"/>
         <field id=\"U\" diffusion=\"1\" initial=\"A*(1 + 0.4*cos(pi*x/3 + {turn})*cos(pi*y/2.4))\">{}
           <reaction>A - (B + 1)*U + turnover</reaction></field>
         <field id=\"V\" diffusion=\"8\" decay=\"0.3\" initial=\"B/A\">{}
           <reaction>B*U - turnover</reaction></field></eml>",
        walls("A"),
        walls("B/A")
    )
}

#[test]
fn the_splitting_agrees_with_the_method_of_lines_to_second_order() {
    for solver in [
        "",
        "<solver scheme=\"rosenbrock\"/>",
        "<solver scheme=\"rk45\" rtol=\"1e-8\"/>",
        "<solver scheme=\"rk65\" rtol=\"1e-8\"/>",
    ] {
        for wall in ["no_flux", "periodic", "fixed"] {
            let (system, start) = open(&brusselator(wall, solver));
            let reference = system.reference(&start, 0.4, &[], 1e-10, 1e-12).expect("the method of lines");
            let error = |steps: u32| {
                let mut fields = start.clone();
                system.advance(&mut fields, 0.4, &[], Stepping::Fixed(steps)).expect("a window");
                assert!((fields.time() - reference.time()).abs() < 1e-15);
                apart(&fields, &reference)
            };
            let [coarse, middle, fine] = [32, 64, 128].map(error);
            let orders = [(coarse / middle).log2(), (middle / fine).log2()];
            println!("{solver} {wall}: errors {coarse:e} {middle:e} {fine:e}, orders {orders:?}");
            // 2, but for the next term of the error; beside held walls V decays, which costs part of an order.
            let least = if wall == "fixed" { 1.7 } else { 1.9 };
            assert!(orders.iter().all(|order| (least..2.3).contains(order)), "{solver} {wall}: {orders:?}");
        }
    }
}

/// The largest over the species of the root mean square of the difference, relative to the species.
fn relative(a: &Fields, b: &Fields) -> f64 {
    let size = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>().sqrt();
    let one = |s: usize| {
        let (a, b) = (a.values(s), b.values(s));
        size(&mut a.iter().zip(b).map(|(a, b)| a - b)) / size(&mut b.iter().copied())
    };
    (0..a.species().len()).map(one).fold(0.0, f64::max)
}

#[test]
fn a_step_with_its_halves_is_second_order_and_what_is_kept_is_far_better() {
    for wall in ["no_flux", "periodic", "fixed"] {
        let (system, start) = open(&brusselator(wall, ""));
        for window in [0.004, 0.02] {
            let reference = system.reference(&start, window, &[], 1e-11, 1e-13).expect("the method of lines");
            let take = |stepping: Stepping| {
                let mut fields = start.clone();
                let report = system.advance(&mut fields, window, &[], stepping).expect("a window");
                (relative(&fields, &reference), report)
            };
            let (whole, _) = take(Stepping::Fixed(1));
            let (halves, _) = take(Stepping::Fixed(2));
            let (kept, report) = take(Stepping::Adaptive { relative: 1.0, absolute: 0.0 });
            assert_eq!((report.steps, report.checks), (1, 1));
            println!(
                "{wall}, {window} s: error {whole:e}, in halves {halves:e}, estimated {:e}, kept {kept:e}",
                report.error
            );
            // Second order, but for the next order of the step: what (field.7) and (field.15) are about. Beside held walls V decays, which
            // costs part of an order.
            let least = if wall == "fixed" { 3.0 } else { 3.5 };
            assert!((least..4.5).contains(&(whole / halves)), "{wall} {window}: {whole} {halves}");
            // Beside what reactions change, which is less than all there is, the error weighs more.
            assert!(report.error > whole, "{wall} {window}: {} {whole}", report.error);
            assert!(kept < 0.1 * whole, "extrapolated: {kept} {whole}");
        }
    }
}

#[test]
fn reactions_that_make_nothing_keep_the_mass() {
    let text = "<eml name=\"turnover\"><grid dimension=\"2\" spacing=\"0.5\" origin=\"0 0\" size=\"20 15\"/>
        <field id=\"A\" diffusion=\"3\" initial=\"1 + sin(x)*cos(y)\"><reaction>-A*B^2 + 0.2*C</reaction></field>
        <field id=\"B\" diffusion=\"0.1\" initial=\"exp(-(x - 9)^2)\"><reaction>A*B^2 - 0.1*B</reaction></field>
        <field id=\"C\" initial=\"0\"><reaction>0.1*B - 0.2*C</reaction></field></eml>";
    let (system, mut fields) = open(text);
    let mass = |fields: &Fields| (0..3).map(|s| fields.amount(s)).sum::<f64>();
    let before = mass(&fields);
    for stepping in [Stepping::Fixed(200), ADAPTIVE] {
        system.advance(&mut fields, 20.0, &[], stepping).expect("a window");
        // The issue's bound.
        assert!((mass(&fields) / before - 1.0).abs() < 1e-12, "{:e}", mass(&fields) / before - 1.0);
    }
}

/// A case of the analytic fronts and patterns, if they are there.
fn analytic(case: &str, number: usize) -> Option<serde_json::Value> {
    let text = std::fs::read_to_string(shared("analytic/fronts_patterns.json")?).expect("a file");
    let cases: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut found = cases.as_array().expect("a list").iter().filter(|one| one["case"] == case);
    Some(found.nth(number).expect("the case").clone())
}

/// Where a front of Fisher that falls along x passes one half, between the centres of the boxes: by what is linear in x there, so that
/// reading the place adds no error of its own.
fn front(fields: &Fields) -> f64 {
    let row = &fields.values(0)[..fields.grid().cells[0]];
    let at = row.iter().position(|value| *value < 0.5).expect("a front");
    let centre = |at: usize| fields.grid().centre(at).x;
    let straight = |value: f64| (value.powf(-0.5) - 1.0).ln();
    let [before, half, behind] = [row[at - 1], 0.5, row[at]].map(straight);
    centre(at - 1) + (half - before) / (behind - before) * (centre(at) - centre(at - 1))
}

#[test]
fn the_front_of_fisher_runs_at_its_speed() {
    for number in 0..2 {
        let Some(case) = analytic("fisher_kpp", number) else { return };
        let value = |name: &str| case[name].as_f64().expect("a number");
        let (d, r, speed) = (value("D"), value("r"), value("c_exact"));
        let steepness = (r / (6.0 * d)).sqrt();
        let error = |boxes: usize| {
            // Lengths in units of the front, times in those of the growth.
            let spacing = 12.0 / steepness / boxes as f64;
            let text = format!(
                "<eml name=\"fisher\"><grid dimension=\"2\" spacing=\"{spacing}\" origin=\"{} 0\" size=\"{} {}\"/>
                 <field id=\"u\" diffusion=\"{d}\" initial=\"(1 + exp({steepness}*x))^(-2)\"><reaction>{r}*u*(1 - u)</reaction>
                 </field></eml>",
                -8.0 / steepness,
                20.0 / steepness,
                4.0 * spacing
            );
            let (system, mut fields) = open(&text);
            let (window, began) = (5.0 / r, front(&fields));
            let steps = Stepping::Fixed((boxes / 2) as u32);
            system.advance(&mut fields, window, &[], steps).expect("a window");
            (front(&fields) - began) / window / speed - 1.0
        };
        let (coarse, fine) = (error(60), error(120));
        println!("case {number}: speed {coarse:e} and {fine:e} off");
        // Second order in space and time together: halving both leaves a quarter.
        assert!(fine.abs() < 2e-3 && (3.4..4.6).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

#[test]
fn the_brusselator_forms_waves_of_the_predicted_length() {
    let Some(case) = analytic("brusselator_turing", 0) else { return };
    let value = |name: &str| case[name].as_f64().expect("a number");
    let (a, wavelength, length) = (value("A"), value("wavelength"), 100.0);
    let waves = |b: f64| {
        let text = format!(
            "<eml name=\"turing\"><parameter id=\"A\" value=\"{a}\"/><parameter id=\"B\" value=\"{b}\"/>
             <grid dimension=\"2\" spacing=\"0.5\" origin=\"0 0\" size=\"{length} 2\"/>
             <field id=\"U\" diffusion=\"{}\" initial=\"A + 0.01*sin(12.9898*x^2)\">
               <wall side=\"x-\" kind=\"periodic\"/><wall side=\"x+\" kind=\"periodic\"/>
               <reaction>A - (B + 1)*U + U^2*V</reaction></field>
             <field id=\"V\" diffusion=\"{}\" initial=\"B/A\">
               <wall side=\"x-\" kind=\"periodic\"/><wall side=\"x+\" kind=\"periodic\"/>
               <reaction>B*U - U^2*V</reaction></field></eml>",
            value("Du"),
            value("Dv")
        );
        let (system, mut fields) = open(&text);
        // Far below the noise that the waves grow from, or steps would be so long that they smooth it.
        let stepping = Stepping::Adaptive { relative: 1e-5, absolute: 0.0 };
        let report = system.advance(&mut fields, 80.0, &[], stepping).expect("a window");
        println!("{report:?}");
        let row = &fields.values(0)[..200];
        let strength = |waves: usize| {
            let turn = |i: usize| std::f64::consts::TAU * (waves * i) as f64 / row.len() as f64;
            let sum = row.iter().enumerate().map(|(i, u)| (u * turn(i).cos(), u * turn(i).sin()));
            let (re, im) = sum.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
            2.0 * f64::hypot(re, im) / row.len() as f64
        };
        let most = (1..60).max_by(|a, b| strength(*a).total_cmp(&strength(*b))).expect("some waves");
        (most, strength(most))
    };
    let critical = value("B_c");
    let ((number, height), (_, below)) = (waves(1.05 * critical), waves(0.9 * critical));
    println!("{number} waves of height {height}; below the threshold {below:e}");
    // A ring holds a whole number of waves, so that the length is met to half a wave in 16.
    let expected = length / wavelength;
    assert!((number as f64 - expected).abs() <= 1.0, "{number} waves; {expected} were predicted");
    assert!(height > 0.3 && below < 1e-3, "waves grow above the threshold only: {height} {below}");
}

#[test]
fn a_document_in_other_units_is_the_same() {
    let text = |unit: &str, time: f64, length_unit: &str, length: f64| {
        format!(
            "<eml name=\"units\" time_unit=\"{unit}\"><input id=\"feed\" default=\"{}\"/>
             <grid dimension=\"3\" spacing=\"{}\" origin=\"{} 0 0\" size=\"{} {} {}\" unit=\"{length_unit}\"/>
             <field id=\"c\" diffusion=\"{}\" decay=\"{}\" initial=\"1 + sin({}*x/1 [{length_unit}])\">
               <wall side=\"z+\" kind=\"fixed\" value=\"2\"/><reaction>{}*x/1 [{length_unit}] - c^2*{} + feed</reaction></field></eml>",
            0.01 * time, 1.5 * length, 3.0 * length, 12.0 * length, 9.0 * length, 7.0 * length,
            2.0 * time * length * length, 0.1 * time, 0.3 / length, 0.02 * time / length, 0.05 * time,
        )
    };
    let run = |text: String| {
        let (system, mut fields) = open(&text);
        assert_eq!(system.grid().cells, [8, 6, 5], "the last side is 4.7 boxes long");
        let (id, default) = system.inputs()[0].clone();
        assert_eq!((system.inputs().len(), id.as_str()), (1, "feed"));
        system.advance(&mut fields, 3.0, &[2.0 * default], Stepping::Fixed(6)).expect("a window");
        fields
    };
    let (seconds, minutes) = (run(text("s", 1.0, "um", 1.0)), run(text("min", 60.0, "mm", 1e-3)));
    // Round-off of the units.
    assert!(apart(&seconds, &minutes) < 1e-12, "{:e}", apart(&seconds, &minutes));
    assert_eq!(seconds.time(), minutes.time());
}

#[test]
fn reactions_know_time_and_position() {
    let text = "<eml name=\"clock\"><grid dimension=\"2\" spacing=\"1\" origin=\"5 -3\" size=\"19 7\"/>
        <field id=\"c\" initial=\"0\"><reaction>(x + 10*y^2)*time</reaction></field></eml>";
    let (system, mut fields) = open(text);
    for _ in 0..2 {
        system.advance(&mut fields, 2.0, &[], Stepping::Fixed(3)).expect("a window");
    }
    for (at, value) in fields.values(0).iter().enumerate() {
        // The midpoint step is exact for what grows evenly; ∫ t dt from 0 to 4 is 8.
        let position = fields.grid().centre(at);
        let expected = 8.0 * (position.x + 10.0 * position.y * position.y);
        assert!((value - expected).abs() < 1e-12 * expected.abs(), "{position:?} {value} {expected}");
    }
}

#[test]
fn stiff_reactions_keep_the_step_of_the_splitting() {
    let text = |solver: &str| {
        format!(
            "<eml name=\"stiff\">{solver}<grid dimension=\"2\" spacing=\"1\" origin=\"0 0\" size=\"20 4\"/>
             <field id=\"A\" diffusion=\"1\" initial=\"1 + 0.5*cos(pi*x/20)\"><reaction>-1e5*A + 1e5*B</reaction></field>
             <field id=\"B\" diffusion=\"1\" initial=\"1\"><reaction>1e5*A - 1e5*B</reaction></field></eml>"
        )
    };
    let run = |solver: &str| {
        let (system, mut fields) = open(&text(solver));
        system.advance(&mut fields, 5.0, &[], Stepping::Fixed(10)).map(|_| fields)
    };
    let fields = run("<solver scheme=\"rosenbrock\"/>").expect("a stiff method");
    let wave = (-(std::f64::consts::PI / 20.0).powi(2) * 5.0).exp();
    for (at, values) in fields.values(0).iter().zip(fields.values(1)).enumerate() {
        let expected = 1.0 + 0.25 * wave * (std::f64::consts::PI * fields.grid().centre(at).x / 20.0).cos();
        // The grid's error is 0.3 % of the decay of the wave, the tolerance of the reactions 1e-6 a step.
        assert!((values.0 - expected).abs() < 1e-4 && (values.0 - values.1).abs() < 1e-4, "{values:?} {expected}");
    }
    let wrong = run("").map_or(f64::INFINITY, |other| apart(&other, &fields));
    assert!(wrong > 0.1, "the explicit step must fail here, or this test shows nothing: {wrong:e}");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let document = from_file("gray_scott");
    let run = |threads: usize, stepping: Stepping| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| {
            let (system, mut fields) = on_grid(&document, None);
            system.advance(&mut fields, 20.0, &[], stepping).expect("a window");
            [fields.values(0).to_vec(), fields.values(1).to_vec()]
        })
    };
    for stepping in [Stepping::Fixed(3), ADAPTIVE] {
        assert!(run(1, stepping) == run(2, stepping), "bits differ");
    }
}

#[test]
fn fields_start_from_files_and_others_from_them() {
    let text = "<eml name=\"files\"><grid dimension=\"2\" spacing=\"1\" origin=\"0 0\" size=\"6 5\"/>
        <field id=\"U\" image=\"start.png\" scale=\"3\"/><field id=\"V\" initial=\"10 - 2*U + 0*x\"/></eml>";
    let system = FieldSystem::new(&read(text), None).expect("a good document");
    let load = |profile: &eml::Profile, grid: &Grid| {
        let eml::Profile::Image { file, scale, .. } = profile else { panic!("{profile:?}") };
        assert_eq!(file, "start.png");
        Ok((0..grid.len()).map(|at| scale * at as f64 / 30.0).collect())
    };
    let fields = system.start(&load).expect("good profiles");
    for (u, v) in fields.values(0).iter().zip(fields.values(1)) {
        assert!((v - (10.0 - 2.0 * u)).abs() < 1e-14);
    }
    assert_eq!(fields.values(0)[29], 2.9);
    assert_eq!((system.species_number("V"), system.species_number("W")), (Some(1), None));
    assert!(system.quantity("U").is_some() && system.quantity("W").is_none());
}

#[test]
fn the_method_of_lines_refuses_what_it_is_not_for() {
    let (system, fields) = on_grid(&from_file("brusselator"), None);
    let error = system.reference(&fields, 1.0, &[], 1e-6, 1e-9).expect_err("too many values");
    assert!(matches!(error, Error::Input(_)), "{error}");
    assert_eq!(error.to_string(), "the method of lines is given 32768 values; 4000 at most were expected");
}
