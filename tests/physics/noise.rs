//! Noise at all four levels, as documents have it.

use crate::coupled_scene::{Scene, crowd, scene, sphere};
use pseudopod::membrane::MembraneCells;
use pseudopod::sim::{add_cells, remove_cells};

fn surfaces(scene: &Scene) -> &MembraneCells {
    &scene.state().chemistry.membranes[0].kinds[0]
}

/// Whether a variance, of so many numbers of known mean 0, is within three standard errors.
fn check(what: &str, found: f64, expected: f64, numbers: usize) {
    let error = expected * (2.0 / numbers as f64).sqrt();
    println!("{what}: {found:.6}, expected {expected:.6}: {:.2} standard errors", (found - expected) / error);
    assert!((found - expected).abs() <= 3.0 * error, "{what}: {found}, not {expected} ± {error}");
}

/// Five variables that only noise changes, three times as strong as 1, one pool twice as strong, kicked twice a step.
const ON_SURFACE: &str = r#"<eml name="own" level="membrane" time_unit="s">
    <parameter id="s" value="3"/>
    <variable id="a" initial="0" rate="0" noise="s"/><variable id="b" initial="0" rate="0" noise="s"/>
    <variable id="c" initial="0" rate="0" noise="s"/><variable id="d" initial="0" rate="0" noise="s*sqrt(1 + m - m)"/>
    <variable id="pool" level="cell" initial="0" rate="0" noise="2"/>
    <mean id="m">a</mean><solver noise_step="0.25"/></eml>"#;

#[test]
fn noise_of_a_membrane_has_the_variance_of_white_noise_on_any_mesh() {
    for level in [1, 2, 3] {
        let (steps, h) = (250, 0.5);
        let mut scene = scene(&[("own", ON_SURFACE)], &sphere(level, "1000 s", "0.5 s"));
        scene.begin();
        let atoms = scene.compiled.model.kinds[0].atoms();
        let (mut of_means, mut of_atoms, mut of_pool) = (0.0, 0.0, 0.0);
        let mut whole = 0.0;
        let mut before = (surfaces(&scene).clone(), 0.0);
        for _ in 0..steps {
            scene.step().unwrap();
            let (now, pool) = (surfaces(&scene), scene.value(0, "pool", 0));
            whole = (0..atoms).map(|atom| now.area(0, atom)).sum();
            for variable in 0..4 {
                // The shape is at rest: areas stay.
                let change = |atom| now.value(0, variable, atom) - before.0.value(0, variable, atom);
                let mean = (0..atoms).map(|atom| now.area(0, atom) * change(atom)).sum::<f64>() / whole;
                of_means += mean * mean * whole;
                of_atoms += (0..atoms).map(|atom| now.area(0, atom) * change(atom).powi(2)).sum::<f64>();
            }
            of_pool += (pool - before.1).powi(2);
            before = (now.clone(), pool);
        }
        // The mean over the surface has the variance s² t / A, whatever the mesh; an atom s² t / A_i.
        let (n, scale) = (4 * steps, 9.0 * h);
        println!("{atoms} atoms, {whole:.2} µm²");
        check("mean over the surface", of_means / n as f64, scale, n);
        check("atoms", of_atoms / (n * atoms) as f64, scale, n * atoms);
        check("pool", of_pool / steps as f64, 4.0 * h, steps);
    }
}

#[test]
fn diffusion_moves_noise_and_changes_no_mean() {
    // The same numbers kick variables of one name.
    let own = |diffusion: &str| {
        format!(
            r#"<eml name="own" level="membrane"><variable id="a" initial="5" diffusion="{diffusion}" rate="0" noise="1"/></eml>"#
        )
    };
    let run = |diffusion: &str| {
        let mut scene = scene(&[("own", &own(diffusion))], &sphere(2, "1000 s", "0.5 s"));
        for _ in 0..20 {
            scene.step().unwrap();
        }
        let (now, atoms) = (surfaces(&scene), scene.compiled.model.kinds[0].atoms());
        let mean = now.amount(0, 0) / (0..atoms).map(|atom| now.area(0, atom)).sum::<f64>();
        (mean, now.values(0, 0).map(|value| (value - mean).powi(2)).sum::<f64>() / atoms as f64)
    };
    let (still, spread) = (run("0"), run("10"));
    assert!((still.0 / spread.0 - 1.0).abs() < 1e-12 && still.0 != 5.0, "{still:?}, {spread:?}");
    assert!(spread.1 < 0.1 * still.1, "diffusion evens it out: {still:?}, {spread:?}");
}

/// A field that only noise changes, on a flat grid or in a medium.
fn field(dimension: usize, spacing: f64) -> String {
    let (origin, size) = if dimension == 2 { ("-10 -10", "20 20") } else { ("-10 -10 -10", "20 20 20") };
    format!(
        r#"<eml name="noisy"><grid dimension="{dimension}" spacing="{spacing}" origin="{origin}" size="{size}"/>
        <field id="still" range="free" initial="3"/>
        <field id="c" range="free" initial="0" noise="2"/><field id="e" range="free" initial="0" noise="2 + 0*x*time*still"/></eml>"#
    )
}

const EMPTY: &str = r#"
[run]
until = "1000 s"
integrator = { step = "0.5 s" }
[output]
every = "1000 s"
"#;

#[test]
fn noise_of_a_field_has_the_variance_of_white_noise_on_any_grid() {
    for (dimension, spacing) in [(2, 4.0), (2, 1.0), (3, 4.0)] {
        let mut scene = scene(&[("noisy", &field(dimension, spacing))], EMPTY);
        let (steps, h) = (300, 0.5);
        let boxes = scene.state().chemistry.fields[0].values.len() / 3;
        let (of_box, whole) = (f64::powi(spacing, dimension as i32), f64::powi(20.0, dimension as i32));
        let (mut of_means, mut of_boxes) = (0.0, 0.0);
        let mut before = scene.state().chemistry.fields[0].values.clone();
        for _ in 0..steps {
            scene.step().unwrap();
            let now = scene.state().chemistry.fields[0].values.clone();
            assert!(now[..boxes].iter().all(|value| *value == 3.0), "no noise, no change");
            for field in 1..3 {
                let own = field * boxes..(field + 1) * boxes;
                let changes = now[own.clone()].iter().zip(&before[own]).map(|(now, before)| now - before);
                let (sum, square) =
                    changes.fold((0.0, 0.0), |(sum, square), change| (sum + change, square + change * change));
                of_means += (sum / boxes as f64).powi(2) * whole;
                of_boxes += square * of_box;
            }
            before = now;
        }
        let n = 2 * steps;
        println!("{boxes} boxes of {of_box} µm^{dimension}");
        check("mean of the field", of_means / n as f64, 4.0 * h, n);
        check("boxes", of_boxes / (n * boxes) as f64, 4.0 * h, n * boxes);
    }
}

const CELL: &str = r#"<eml name="own" level="cell" time_unit="min"><input id="c" default="0"/>
    <variable id="u" initial="1" rate="c - u" noise="0.2*u"/><variable id="w" initial="0" rate="u - w" noise="0.1"/>
    <variable id="hits" initial="0" rate="0"/><event when="u gt 1.02"><set id="hits">hits + 1</set></event>
    <solver noise_step="0.002"/><link from="field[c]" to="system.c"/></eml>"#;
const FIELD: &str = r#"<eml name="f"><grid dimension="2" spacing="4" origin="-64 -64" size="128 128"/><input id="sum" default="0"/>
    <field id="c" range="free" diffusion="30" decay="0.1" initial="2" noise="0.5 + 0.01*x"><reaction>0.1 - 0.02*c</reaction></field>
    <field id="n" range="free" initial="0" noise="0.1 + 0*sum"/><link from="scene.time" to="system.sum"/></eml>"#;
const SCENE: &str =
    r#"<eml name="all"><variable id="z" initial="0" rate="-z" noise="1"/><solver noise_step="0.3"/></eml>"#;
const SKIN: &str = r#"<eml name="own" level="membrane"><variable id="a" initial="1 + 0.05*x" diffusion="0.5" rate="inside - a" noise="0.3*sqrt(max(a, 0))"/>
    <variable id="b" initial="0" rate="a - b"/><variable id="inside" level="cell" initial="1" rate="1 - inside" noise="0.1*m"/>
    <mean id="m">a</mean><solver noise_step="0.05"/></eml>"#;

#[test]
fn threads_and_stops_change_no_bit_of_noise() {
    for (own, span) in [(CELL, 0.12), (SKIN, 0.05)] {
        let documents = [("own", own), ("f", FIELD), ("all", SCENE)];
        let once = crowd(1, &documents, 6, |_| ());
        assert_eq!(once.state(), crowd(3, &documents, 6, |_| ()).state(), "threads");
        assert_eq!(once.state(), crowd(2, &documents, 6, Scene::stop_and_resume).state(), "stops");
        let poisoned = crowd(1, &documents, 6, |scene| {
            let model = scene.compiled.model.clone();
            scene.ws.poison(&model);
        });
        assert_eq!(once.state(), poisoned.state(), "scratch is scratch");
        let (kicks, time) = (&once.state().chemistry.kicks, once.state().time);
        let expected = [span, 0.3].map(|span| (time / span).ceil() as u64);
        assert_eq!(kicks[..], expected, "noise has kicked on grids of its own until {time}");
    }
}

#[test]
fn cells_that_come_and_go_change_no_number_of_the_others() {
    for own in [CELL, SKIN] {
        let run = |change: bool| {
            crowd(1, &[("own", own), ("f", FIELD)], 5, |scene| {
                let Scene { compiled, ws } = scene;
                let (model, state) = (&compiled.model, &mut compiled.state);
                if change && state.step == 2 {
                    remove_cells(model, state, ws, &[0, 9, 10]).unwrap();
                    let positions = state.kinds[0].cell(&model.kinds[0], 4);
                    let positions = positions.iter().map(|x| x + pseudopod::Vec3::new(0.0, 0.0, 40.0)).collect();
                    let new = pseudopod::sim::NewCell { positions, parent: None };
                    add_cells(model, state, ws, 0, &[new]).unwrap();
                }
            })
        };
        let (stays, changes) = (run(false), run(true));
        let number = |scene: &Scene, id: u64| scene.state().kinds[0].ids.iter().position(|own| *own == id).unwrap();
        for id in (0..37).filter(|id| ![0, 9, 10].contains(id)) {
            let (one, other) = (number(&stays, id), number(&changes, id));
            let population =
                |scene: &Scene, cell: usize| scene.state().chemistry.populations[0].state(cell, 0).to_bits();
            assert_eq!(population(&stays, one), population(&changes, other), "cell {id}");
            if own == SKIN {
                let surface =
                    |scene: &Scene, cell: usize| surfaces(scene).values(cell, 0).map(f64::to_bits).collect::<Vec<_>>();
                assert_eq!(surface(&stays, one), surface(&changes, other), "cell {id}");
            }
        }
    }
}

#[test]
fn noise_that_is_no_number_ends_the_step_and_leaves_the_state() {
    let cell =
        r#"<eml name="own" level="cell"><variable id="u" initial="1" rate="0" noise="sqrt(0.75 - time)"/></eml>"#;
    let skin =
        r#"<eml name="own" level="membrane"><variable id="u" initial="1" rate="0" noise="sqrt(0.75 - time)"/></eml>"#;
    for own in [cell, skin] {
        let mut scene = scene(&[("own", own)], &sphere(1, "1000 s", "0.5 s"));
        let told = scene.until_trouble().to_string();
        assert!(scene.state().step == 2 && told.contains("no longer a finite number"), "{told}");
    }
    let field = r#"<eml name="own"><grid dimension="2" spacing="4" origin="0 0" size="20 20"/>
        <field id="c" range="free" initial="0" noise="sqrt(0.75 - time)"/></eml>"#;
    let mut scene = scene(&[("own", field)], EMPTY);
    let told = scene.until_trouble().to_string();
    assert!(scene.state().step == 2 && told.contains("field 'c'"), "{told}");
}
