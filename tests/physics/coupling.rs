//! What chemistry does to cells, and cells to chemistry, against what can be worked out by hand.

use crate::coupled_scene::{Scene, crowd, one_cell, scene};
use pseudopod::Vec3;
use pseudopod::sim::chemistry::next_exchange;
use pseudopod::sim::{State, Trouble};

#[test]
fn an_atom_goes_where_its_system_puts_it_and_the_volume_stays() {
    let eml = r#"<eml name="own" level="cell"><parameter id="k" value="0.1"/>
        <variable id="U" initial="1" rate="-k*U"/><input id="seen" default="0"/>
        <solver scheme="rosenbrock" rtol="1e-12" atol="1e-14"/>
        <link from="system.U" to="cell.atom[4].y" transfer="3*value"/>
        <link from="cell.atom[4].y" to="system.seen"/></eml>"#;
    let mut scene = scene(&[("own", eml)], &one_cell("10 s", "0.1 s"));
    scene.begin();
    while scene.state().time < 10.0 {
        let kind = &scene.compiled.model.kinds[0];
        let y = scene.state().kinds[0].cell(kind, 0)[4].y;
        let exact = 3.0 * (-0.1 * scene.state().time).exp();
        // The tolerance asked of the solver is 1e-12.
        assert!((y - exact).abs() < 1e-11, "{y} against {exact} at {}", scene.state().time);
        assert_eq!(scene.value(0, "seen", 0), y, "what is read is what was set");
        let surface = pseudopod::geometry::Surface {
            positions: scene.state().kinds[0].cell(kind, 0),
            facets: kind.rest.facets.clone(),
        };
        let volume = pseudopod::geometry::volume(&surface) / pseudopod::geometry::volume(&kind.rest);
        assert!((volume - 1.0).abs() < 1e-10, "{volume}");
        scene.step().unwrap();
    }
}

#[test]
fn a_cell_that_swims_by_its_own_position_follows_the_exponential_to_first_order() {
    // x' = −k x through position → input → bias; the coupling holds what is read over a step.
    let eml = r#"<eml name="own" level="cell"><input id="x" default="0"/><define id="v">-0.2*x</define>
        <link from="cell.position.x" to="system.x"/><link from="system.v" to="cell.motility.bias.x"/></eml>"#;
    let error = |step: &str| {
        let mut text = one_cell("5 s", step);
        text += "placement = { at = [[\"10 um\", \"0 um\", \"0 um\"]] }\n";
        let mut scene = scene(&[("own", eml)], &text);
        scene.run();
        (scene.position(0, 0) - 10.0 * (-1.0_f64).exp()).abs()
    };
    let (coarse, fine) = (error("0.2 s"), error("0.1 s"));
    let order = (coarse / fine).log2();
    assert!((0.9..1.1).contains(&order), "order {order}: {coarse}, {fine}");
}

#[test]
fn what_a_cell_secretes_is_what_the_field_gains() {
    let field = r#"<eml name="field"><grid dimension="2" spacing="2" origin="-40 -40" size="80 80"/>
        <field id="c" diffusion="30" initial="0"/></eml>"#;
    let own = r#"<eml name="own" level="cell"><variable id="rate" initial="2" rate="0.5"/>
        <link from="system.rate" to="cell.secretion[c]" gain="3"/></eml>"#;
    let mut scene = scene(&[("field", field), ("own", own)], &one_cell("4 s", "0.1 s"));
    scene.run();
    let values = &scene.state().chemistry.fields[0].values;
    let amount = values.iter().sum::<f64>() * 4.0;
    // Rates go on a line in a step, as this one does: 3 (2 + t/2) over 4 s.
    let released = 36.0;
    assert!((amount / released - 1.0).abs() < 1e-12, "{amount} against {released}");
    assert!(values.iter().all(|value| *value >= 0.0));
}

/// What is there at a time of what is released at a rate of 1 + cos(ω t) and decays with k.
fn beaten(omega: f64, k: f64, time: f64) -> f64 {
    let (sin, cos) = (omega * time).sin_cos();
    let fading = (-k * time).exp();
    (1.0 - fading) / k + (k * cos + omega * sin - k * fading) / (k * k + omega * omega)
}

/// Documents of a cell that releases at a rate of 1 + cos(ω t) into a field where it decays with k.
fn beat(omega: f64, k: f64) -> (String, String) {
    let field = format!(
        r#"<eml name="field"><grid dimension="2" spacing="2" origin="-40 -40" size="80 80"/>
        <field id="c" diffusion="30" decay="{k}" initial="0"/></eml>"#
    );
    let own = format!(
        r#"<eml name="own" level="cell"><parameter id="w" value="{omega}"/>
        <variable id="U" initial="1" rate="w*V"/><variable id="V" initial="0" rate="-w*U"/>
        <solver scheme="rosenbrock" rtol="1e-10" atol="1e-12"/>
        <link from="system.U" to="cell.secretion[c]" transfer="1 + value"/></eml>"#
    );
    (field, own)
}

#[test]
fn what_is_released_at_a_rate_that_changes_is_there_to_fourth_order() {
    for k in [1e-9, 0.5, 8.0] {
        let (field, own) = beat(1.0, k);
        let error = |step: &str| {
            let mut scene = scene(&[("field", &field), ("own", &own)], &one_cell("7.2 s", step));
            scene.begin();
            let rows =
                scene.rows_until(7.2, |scene| scene.state().chemistry.fields[0].values.iter().sum::<f64>() * 4.0);
            rows.iter().map(|(time, amount)| (amount - beaten(1.0, k, *time)).abs()).fold(0.0, f64::max)
        };
        let errors = ["0.9 s", "0.45 s", "0.225 s"].map(error);
        let order = (errors[0] / errors[2]).log2() / 2.0;
        println!("k = {k}: errors {errors:?}, order {order}");
        // Where much decays in a step the steps are still long: 3.5 was measured, 4.0 for k = 0.5, and 4.7 where errors of both signs meet.
        assert!((3.3..4.9).contains(&order), "{order}: {errors:?}");
    }
}

/// The amount in the field at the end of each step.
fn amounts(field: &str, own: &str, (until, step): (f64, &str)) -> Vec<(f64, f64)> {
    let mut scene = scene(&[("field", field), ("own", own)], &one_cell(&format!("{until} s"), step));
    scene.begin();
    scene.rows_until(until, |scene| scene.state().chemistry.fields[0].values.iter().sum::<f64>() * 4.0)
}

#[test]
fn what_is_released_at_a_rate_that_turns_within_steps_is_there_within_a_percent() {
    // Up to some five turns in a step, and half a lifetime to eight of them.
    for (omega, k) in [(1.0, 1e-9), (3.0, 1e-9), (3.0, 0.5), (8.0, 0.5), (2.0 * std::f64::consts::PI, 2.0)] {
        let (field, own) = beat(omega, k);
        for step in ["0.5 s", "1 s", "4 s"] {
            let rows = amounts(&field, &own, (12.0, step));
            let worst = rows.iter().map(|(time, amount)| (amount / beaten(omega, k, *time) - 1.0).abs());
            let worst = worst.fold(0.0, f64::max);
            println!("{omega} {k} {step}: {worst:.1e}");
            assert!(worst < 0.01, "{omega} {k} {step}: {worst}");
        }
    }
}

#[test]
fn pulses_of_release_that_the_clock_switches_are_there_in_full_however_long_the_step() {
    let decay = |k: f64| {
        format!(
            r#"<eml name="field"><grid dimension="2" spacing="2" origin="-40 -40" size="80 80"/>
            <field id="c" diffusion="30" decay="{k}" initial="0"/></eml>"#
        )
    };
    // In words of a definition, of a variable, and with an event that counts.
    for (body, rate) in [
        ("<define id=\"U\">piecewise(7, rem(time, 2.5) lt 0.04, 0)</define>", 7.0),
        ("<define id=\"U\">2*heaviside(rem(time, 2.5) - 2.46)</define>", 2.0),
        (
            "<variable id=\"N\" initial=\"0\" rate=\"0\"/><event when=\"time ge 1000\"><set id=\"N\">1</set></event>
             <define id=\"U\">piecewise(3, rem(time, 2.5) lt 0.04, 0)</define>",
            3.0,
        ),
    ] {
        let own = format!(
            r#"<eml name="own" level="cell"><variable id="idle" initial="0" rate="0"/>{body}
            <link from="system.U" to="cell.secretion[c]"/></eml>"#
        );
        for step in ["0.3 s", "1 s", "5 s"] {
            let rows = amounts(&decay(0.0), &own, (10.0, step));
            let (_, amount) = rows.last().expect("a step");
            assert!((amount / (4.0 * 0.04 * rate) - 1.0).abs() < 1e-9, "{body} {step}: {amount}");
        }
        // What is left of each: parts of a step of a field are at most half a lifetime.
        let k = 0.4;
        let left = |time: f64| {
            let each = |number: u32| {
                let begin = 2.5 * f64::from(number) + if rate == 2.0 { 2.46 } else { 0.0 };
                let from = |at: f64| (-k * (time - at)).exp();
                rate / k * (from(begin + 0.04) - from(begin))
            };
            (0..4).map(each).sum::<f64>()
        };
        let rows = amounts(&decay(k), &own, (10.0, "5 s"));
        let (_, amount) = rows.last().expect("a step");
        assert!((amount / left(10.0) - 1.0).abs() < 1e-6, "{body}: {amount} for {}", left(10.0));
    }
}

#[test]
fn a_release_that_an_event_switches_within_a_step_is_there_within_a_percent() {
    let field = r#"<eml name="field"><grid dimension="2" spacing="2" origin="-40 -40" size="80 80"/>
        <field id="c" diffusion="30" initial="0"/></eml>"#;
    let own = r#"<eml name="own" level="cell"><variable id="U" initial="0" rate="0.3"/><variable id="on" initial="0" rate="0"/>
        <event when="U ge 1"><set id="on">1</set></event><link from="system.on" to="cell.secretion[c]"/></eml>"#;
    for step in ["1 s", "4 s"] {
        let rows = amounts(field, own, (8.0, step));
        let (_, amount) = rows.last().expect("a step");
        let exact = 8.0 - 1.0 / 0.3;
        assert!((amount / exact - 1.0).abs() < 0.01, "{step}: {amount} for {exact}");
    }
}

#[test]
fn what_is_released_into_a_field_that_decays_is_there_in_full_whatever_the_step() {
    let field = r#"<eml name="field"><grid dimension="2" spacing="2" origin="-40 -40" size="80 80"/>
        <field id="c" diffusion="30" decay="0.5" initial="0"/></eml>"#;
    let own = r#"<eml name="own" level="cell"><variable id="rate" initial="3" rate="0"/>
        <link from="system.rate" to="cell.secretion[c]"/></eml>"#;
    // Released where a step begins, as it was, 70 % of it would be missing with the longest of these.
    for (until, step) in [("4 s", "0.1 s"), ("4 s", "0.5 s"), ("20 s", "4 s")] {
        let mut scene = scene(&[("field", field), ("own", own)], &one_cell(until, step));
        scene.run();
        let time = scene.state().time;
        let amount = scene.state().chemistry.fields[0].values.iter().sum::<f64>() * 4.0;
        let exact = 3.0 / 0.5 * (1.0 - f64::exp(-0.5 * time));
        println!("{step}: {amount} for {exact}");
        assert!((amount / exact - 1.0).abs() < 1e-10, "{step}: {amount} {exact}");
    }
}

#[test]
fn a_linear_field_is_sensed_exactly() {
    for (dimension, size, z, gz) in [(2, "80 80", "0", 0.0), (3, "80 80 80", "0.25*z", 0.25)] {
        let field = format!(
            r#"<eml name="field"><grid dimension="{dimension}" spacing="4" origin="-40 -40 -40" size="{size}"/>
            <field id="c" initial="200 + 2*x - 0.5*y + {z}"/></eml>"#
        );
        let field = if dimension == 2 { field.replace("-40 -40 -40", "-40 -40") } else { field };
        let own = r#"<eml name="own" level="cell"><input id="c" default="0"/><input id="gx" default="0"/>
            <input id="gy" default="0"/><input id="gz" default="0"/><input id="s" default="0"/><input id="a" default="0"/>
            <variable id="idle" initial="0" rate="0"/>
            <link from="field[c]" to="system.c"/><link from="cell.field[c].gradient.x" to="system.gx"/>
            <link from="field[c].gradient.y" to="system.gy"/><link from="field[c].gradient.z" to="system.gz"/>
            <link from="field[c].steepness" to="system.s"/><link from="cell.atom[7].field[c]" to="system.a"/></eml>"#;
        let text = one_cell("1 s", "0.5 s") + "placement = { at = [[\"7 um\", \"-3 um\", \"4 um\"]] }\n";
        let mut scene = scene(&[("field", &field), ("own", own)], &text);
        scene.begin();
        let atom = scene.state().kinds[0].cell(&scene.compiled.model.kinds[0], 0)[7];
        let value = |x: f64, y: f64, z: f64| 200.0 + 2.0 * x - 0.5 * y + gz * z;
        let expected = [
            ("c", value(7.0, -3.0, 4.0)),
            ("gx", 2.0),
            ("gy", -0.5),
            ("gz", gz),
            ("s", (4.25 + gz * gz).sqrt()),
            ("a", value(atom.x, atom.y, atom.z)),
        ];
        for (quantity, expected) in expected {
            let found = scene.value(0, quantity, 0);
            assert!((found - expected).abs() < 1e-9, "{dimension}-D {quantity}: {found} against {expected}");
        }
    }
}

#[test]
fn a_stiffness_set_by_chemistry_is_the_stiffness_of_a_stiffer_cell() {
    let own = r#"<eml name="own" level="cell"><parameter id="f" value="FACTOR"/>
        <link from="system.f" to="cell.stiffness"/></eml>"#;
    let load = "loads = [{ name = \"pull\", cap = { direction = [0, 0, 1], number = 3 }, direction = [0, 0, 1], \
                force = \"8 pN\" }]\n";
    let lengths = |factor: &str, modulus: &str| {
        let text = one_cell("20 s", "0.05 s").replace("10 pN/um", modulus) + load;
        let mut scene = scene(&[("own", &own.replace("FACTOR", factor))], &text);
        scene.run();
        scene.state().kinds[0].cell(&scene.compiled.model.kinds[0], 0)
    };
    let distance = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let unlinked = lengths("1", "10 pN/um");
    for (factor, modulus) in [("4", "40 pN/um"), ("0.5", "5 pN/um")] {
        let (linked, plain) = (lengths(factor, "10 pN/um"), lengths("1", modulus));
        let (apart, moved) = (distance(&linked, &plain), distance(&linked, &unlinked));
        // Both are the same problem; K differs by the power of two that covers the factor, so that steps of second
        // order differ by their errors. The factor itself moves atoms much further.
        assert!(apart < 2e-3, "factor {factor}: {apart} um apart");
        assert!(moved > 20.0 * 2e-3, "factor {factor}: only {moved} um from a cell of factor 1");
    }
}

#[test]
fn walks_loads_and_volumes_obey() {
    let own = r#"<eml name="own" level="cell"><parameter id="speed" value="0.25"/><parameter id="ratio" value="1.2"/>
        <parameter id="push" value="0"/><input id="volume" default="0"/><input id="strain" default="0"/>
        <link from="system.speed" to="cell.motility.speed"/><link from="system.ratio" to="cell.rest_volume_ratio"/>
        <link from="system.push" to="cell.load[push]"/>
        <link from="cell.volume" to="system.volume"/><link from="cell.volume_strain" to="system.strain"/></eml>"#;
    let text = one_cell("3 s", "0.1 s")
        + "motility = { brownian = { speed = \"7 um/s\", persistence = \"1000 min\" } }\n\
           loads = [{ name = \"push\", all = true, direction = [0, 0, 1], force = \"1 nN\" }]\n";
    let mut scene = scene(&[("own", own)], &text);
    scene.run();
    let travelled = scene.position(0, 0).hypot(scene.position(0, 1));
    assert!((travelled - 0.75).abs() < 1e-9, "0.25 um/s for 3 s, straight: {travelled}");
    assert!(scene.position(0, 2).abs() < 1e-9, "a load of factor 0 does nothing: {}", scene.position(0, 2));
    assert!((scene.value(0, "strain", 0) - 0.2).abs() < 1e-9);
    let rest = pseudopod::geometry::volume(&scene.compiled.model.kinds[0].rest);
    assert!((scene.value(0, "volume", 0) / rest - 1.2).abs() < 1e-10);
}

#[test]
fn systems_exchange_when_they_want_to_and_steps_end_there() {
    let own = r#"<eml name="own" level="cell" time_unit="min"><variable id="t" initial="0" rate="1"/>
        <input id="clock" default="0"/><solver step="0.02"/>
        <link from="scene.time" to="system.clock"/></eml>"#;
    let mut scene = scene(&[("own", own)], &one_cell("6 s", "0.7 s").replace("every = \"6 s\"", "every = \"3 s\""));
    let mut seen = Vec::new();
    while scene.state().time < 6.0 {
        let next = next_exchange(&scene.compiled.model, scene.state().time);
        scene.step().unwrap();
        assert!(scene.state().time <= next, "a step never runs over an exchange");
        let clock = scene.value(0, "clock", 0);
        // t is in minutes, and has run exactly until the last exchange.
        assert!((60.0 * scene.value(0, "t", 0) - clock).abs() < 1e-9);
        if seen.last() != Some(&clock) {
            seen.push(clock);
        }
    }
    assert_eq!(seen.len(), 6, "at 0, 1.2, … 6 s: {seen:?}");
    assert!(seen.iter().enumerate().all(|(n, t)| (t - 1.2 * n as f64).abs() < 1e-9), "{seen:?}");
}

#[test]
fn systems_read_each_other_and_the_means_of_types() {
    let a = r#"<eml name="own" level="cell"><variable id="u" initial="2" rate="0"/>
        <input id="x" default="0"/><link from="cell.position.x" to="system.x"/></eml>"#;
    let b = r#"<eml name="whole"><input id="from_cells" default="0"/><input id="mean_x" default="0"/>
        <define id="twice">2*from_cells</define>
        <link from="type[cell].chemistry[own].u" to="system.from_cells"/><link from="type[cell].position.x" to="system.mean_x"/>
        <link from="system.twice" to="type[cell].motility.bias.y" gain="0.1"/></eml>"#;
    let text = one_cell("2 s", "0.1 s")
        + "placement = { at = [[\"10 um\", \"0 um\", \"0 um\"], [\"30 um\", \"0 um\", \"0 um\"]] }\n";
    let mut scene = scene(&[("own", a), ("whole", b)], &text);
    scene.run();
    assert_eq!(scene.value(1, "twice", 0), 4.0);
    assert!((scene.value(1, "mean_x", 0) - 20.0).abs() < 1e-9);
    for cell in 0..2 {
        assert!((scene.position(cell, 1) - 0.8).abs() < 1e-9, "0.4 um/s for 2 s");
    }
}

#[test]
fn what_links_read_of_other_systems_is_worked_out_once_for_all_who_read_it() {
    let own = r#"<eml name="own" level="cell"><input id="x" default="0"/><variable id="u" initial="2" rate="-0.1*u"/>
        <define id="w">u+x</define><link from="cell.position.x" to="system.x"/></eml>"#;
    let other = r#"<eml name="other" level="cell"><input id="u" default="0"/><input id="w" default="0"/><input id="mean" default="0"/>
        <define id="v">0*w</define>
        <link from="cell.chemistry[own].u" to="system.u"/><link from="cell.chemistry[own].w" to="system.w"/>
        <link from="type[cell].chemistry[own].u" to="system.mean"/><link from="system.v" to="cell.motility.bias.x"/></eml>"#;
    let whole = r#"<eml name="whole"><input id="mean" default="0"/><input id="w" default="0"/>
        <link from="type[cell].chemistry[own].u" to="system.mean"/><link from="type[cell].chemistry[own].w" to="system.w"/></eml>"#;
    let blocks = |cells: u64| {
        let some = format!(
            "number = {cells}\nplacement = {{ random_from = [\"-90 um\", \"0 um\", \"0 um\"], random_to = [\"90 um\", \"0 um\", \"0 um\"] }}\n"
        );
        let text = one_cell("2 s", "0.5 s").replace("[\"own\"]", "[\"own\", \"other\"]") + &some;
        let mut scene = scene(&[("own", own), ("other", other), ("whole", whole)], &text);
        scene.run();
        let (first, last) = (0, cells as usize - 1);
        for cell in [first, last] {
            let (u, w) = (scene.value(0, "u", cell), scene.value(0, "w", cell));
            assert_eq!([scene.value(1, "u", cell), scene.value(1, "w", cell)], [u, w], "cell {cell} of {cells}");
            assert!((w - u).abs() > 1e-3 && scene.value(1, "mean", cell) == scene.value(2, "mean", 0));
        }
        scene.ws.chemistry.blocks_observed()
    };
    // At the start and after each of four steps: `u` and `w` of `own`, one after the other, and `v` of `other`.
    for cells in [16, 64, 256] {
        assert_eq!(blocks(cells), 5 * 3 * cells / 16, "{cells} cells");
    }
}

#[test]
fn what_chemistry_knows_of_a_cell_comes_and_goes_with_it() {
    let own = r#"<eml name="own" level="cell"><variable id="u" initial="2" rate="-u"/>
        <event when="u lt 1" delay="100"><set id="u">3</set></event>
        <link from="system.u" to="cell.stiffness"/><link from="system.u" to="cell.motility.bias.x"/>
        <link from="system.u" to="cell.secretion[c]"/></eml>"#;
    let field = r#"<eml name="field"><grid dimension="2" spacing="2" origin="-80 -80" size="160 160"/>
        <field id="c" diffusion="30" initial="0"/></eml>"#;
    let some = "placement = { at = [[\"-30 um\", \"0 um\", \"0 um\"], [\"0 um\", \"0 um\", \"0 um\"], [\"30 um\", \"0 um\", \"0 um\"]] }\n";
    let other = "[cells.other]\nmesh = { shape = \"icosphere\", radius = \"5 um\", level = 1 }\nplacement = { at = [[\"0 um\", \"40 um\", \"0 um\"], [\"30 um\", \"40 um\", \"0 um\"]] }\n\
        mechanics = { drag = \"20 pN s/um\", shape_memory = { shape_modulus = \"10 pN/um\" } }\nchemistry = [\"own\"]\n";
    let mut scene = scene(&[("field", field), ("own", own)], &(one_cell("2 s", "0.25 s") + some + other));
    scene.run();
    let model = &scene.compiled.model;
    let before = &scene.state().chemistry;
    for (kind, local, cell) in [(0, 0, 0), (0, 3, 3), (1, 1, 4), (1, 2, 5)] {
        let mut after = before.clone();
        after.insert_cell(model, &[3, 2], (kind, local), 5);
        assert_eq!((after.populations[0].cells(), after.events[0].len(), after.controls.bias.len()), (6, 6, 6));
        let new = (after.populations[0].state(cell, 0), after.controls.stiffness[cell], after.controls.bias[cell]);
        assert_eq!((new, after.controls.secretion[0][cell]), ((2.0, 1.0, [0.0; 3]), 0.0), "as at the start");
        let mut cells = [3, 2];
        cells[kind] += 1;
        after.retain_cells(model, &cells, |other, at| (other, at) != (kind, local));
        assert_eq!(after, *before, "cell {local} of kind {kind}");
    }
    let mut fewer = before.clone();
    fewer.retain_cells(model, &[3, 2], |kind, local| kind == 1 || local == 1);
    assert_eq!(
        fewer.events[0],
        [before.events[0][1].clone(), before.events[0][3].clone(), before.events[0][4].clone()]
    );
    assert_eq!(fewer.controls.stiffness, [1, 3, 4].map(|cell| before.controls.stiffness[cell]));
}

#[test]
fn a_system_that_blows_up_is_named_and_the_state_stays() {
    let own = r#"<eml name="own" level="cell"><input id="x" default="0"/>
        <variable id="U" initial="1" rate="U^2*x"/><link from="cell.position.x" to="system.x"/></eml>"#;
    let text = one_cell("30 s", "0.5 s")
        + "placement = { at = [[\"0 um\", \"0 um\", \"0 um\"], [\"0.1 um\", \"0 um\", \"0 um\"]] }\n";
    let mut scene = scene(&[("own", own)], &text);
    let trouble = scene.until_trouble();
    // U = 1/(1 − 0.1 t) for the second cell.
    let Trouble::System { system, owner, time, variable, .. } = &trouble else { panic!("{trouble}") };
    assert_eq!((system.as_str(), owner.clone()), ("own", Some(("cell".to_owned(), 1))));
    assert_eq!(variable.as_deref(), Some("U"));
    // The pole is met as exactly as the tolerance of 1e-6 lets the solution be.
    assert!((time - 10.0).abs() < 1e-3, "{time}");
}

#[test]
fn a_link_that_carries_nonsense_is_named() {
    let own = r#"<eml name="own" level="cell"><variable id="r" initial="1" rate="-0.01"/>
        <link from="system.r" to="cell.rest_volume_ratio" transfer="piecewise(value, value gt 0.98, -1)"/></eml>"#;
    let mut scene = scene(&[("own", own)], &one_cell("5 s", "0.25 s"));
    let trouble = loop {
        if let Err(trouble) = scene.step() {
            break trouble;
        }
    };
    let text = trouble.to_string();
    assert!(
        text.contains("from system.r to cell.rest_volume_ratio") && text.contains("cell 0 of type `cell`"),
        "{text}"
    );
}

/// Cells that secrete and climb what they secrete, after 20 steps; the field has boxes enough that threads share its reactions.
fn crowd_after(threads: usize, before: impl Fn(&mut Scene) + Sync) -> State {
    let field = r#"<eml name="field"><grid dimension="2" spacing="1.5" origin="-60 -60" size="120 120"/>
        <field id="c" diffusion="40" decay="0.05" initial="1 + 0.01*x"><reaction>-0.02*c^2</reaction></field></eml>"#;
    let own = r#"<eml name="own" level="cell"><input id="c" default="0"/><input id="gx" default="0"/>
        <variable id="u" initial="1" rate="c - u"/><variable id="w" initial="0" rate="u - w^3"/>
        <solver scheme="rk45" rtol="1e-6"/>
        <link from="field[c]" to="system.c"/><link from="field[c].gradient.x" to="system.gx"/>
        <link from="system.gx" to="cell.motility.bias.x" gain="5"/><link from="system.w" to="cell.secretion[c]" gain="10"/>
        <link from="system.u" to="cell.stiffness" transfer="1 + 0.5*tanh(value)"/></eml>"#;
    crowd(threads, &[("field", field), ("own", own)], 20, before).compiled.state
}

#[test]
fn an_experiment_chooses_the_scheme_of_a_fields_reactions() {
    let field = r#"<eml name="field"><grid dimension="2" spacing="4" origin="-20 -20" size="40 40"/>
        <field id="c" diffusion="10" initial="2 + 0.02*x"><reaction>-0.5*c^2</reaction></field>
        <solver scheme="rk4" inner_step="0.1"/></eml>"#;
    let end = |scheme: &str| {
        let text = one_cell("2 s", "0.1 s") + "[chemistry.field]\ndocument = \"field.eml\"\nrtol = 1e-6\n" + scheme;
        let idle = r#"<eml name="own" level="cell"><variable id="idle" initial="0" rate="0"/></eml>"#;
        let mut scene = scene(&[("field", field), ("own", idle)], &text);
        scene.run();
        scene.state().chemistry.fields[0].values.to_vec()
    };
    let own = end("");
    for scheme in ["rk45", "rk65", "rosenbrock"] {
        let other = end(&format!("scheme = \"{scheme}\"\n"));
        assert_ne!(own, other, "{scheme} takes other steps");
        let apart = own.iter().zip(&other).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        // A hundred tolerances.
        assert!(apart < 1e-4, "{scheme}: {apart:e}");
    }
}

#[test]
fn threads_and_scratch_do_not_matter_to_chemistry() {
    let plain = crowd_after(1, |_| ());
    let field = &plain.chemistry.fields[0].values;
    assert!(field.iter().all(|value| value.is_finite()) && field.len() == 6400);
    assert!(plain.chemistry.controls.stiffness.iter().all(|factor| (*factor - 1.0).abs() > 0.01), "links have acted");
    assert_eq!(plain, crowd_after(2, |_| ()), "threads");
    assert_eq!(plain, crowd_after(1, |scene| scene.ws.poison(&scene.compiled.model)), "scratch");
}

#[test]
fn a_run_goes_on_from_its_checkpoint_as_if_it_had_not_stopped() {
    assert_eq!(crowd_after(1, |_| ()), crowd_after(1, Scene::stop_and_resume));
}

#[test]
fn an_sbml_model_stands_where_an_eml_document_can() {
    let sbml = r#"<?xml version="1.0" encoding="UTF-8"?>
        <sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" level="3" version="1"><model id="decay">
        <listOfCompartments><compartment id="c" spatialDimensions="3" size="1" constant="true"/></listOfCompartments>
        <listOfSpecies><species id="S" compartment="c" initialAmount="2" hasOnlySubstanceUnits="true" boundaryCondition="false" constant="false"/></listOfSpecies>
        <listOfParameters><parameter id="k" value="7" constant="true"/></listOfParameters>
        <listOfReactions><reaction id="r" reversible="false" fast="false"><listOfReactants><speciesReference species="S" stoichiometry="1" constant="true"/></listOfReactants>
        <kineticLaw><math xmlns="http://www.w3.org/1998/Math/MathML"><apply><times/><ci>k</ci><ci>S</ci></apply></math></kineticLaw></reaction></listOfReactions>
        </model></sbml>"#;
    let text = one_cell("4 s", "0.1 s")
        + "[chemistry.own]\ndocument = \"own.eml\"\nrtol = 1e-9\natol = 1e-12\nlinks = [\n\
           { from = \"scene.time\", to = \"system.k\", transfer = \"0.5 + 0*value\" },\n\
           { from = \"system.S\", to = \"cell.motility.bias.x\", gain = 0.1 },\n]\n";
    let mut scene = scene(&[("own", sbml)], &text);
    scene.run();
    let exact = |t: f64| 2.0 * (-0.5 * t).exp();
    assert!((scene.value(0, "S", 0) / exact(4.0) - 1.0).abs() < 1e-7, "the link has set the model's parameter");
    // Each step is made with the amount at its start.
    let travelled: f64 = (0..40).map(|n| 0.1 * 0.1 * exact(0.1 * f64::from(n))).sum();
    assert!((scene.position(0, 0) - travelled).abs() < 1e-7, "{} against {travelled}", scene.position(0, 0));
}

#[test]
fn cells_let_go_when_chemistry_takes_their_adhesion_away() {
    // Two cells are pressed together, then pulled with less than what holds them; at 40 s each loses its adhesion.
    let own = r#"<eml name="own" level="cell"><variable id="a" initial="1" rate="0"/>
        <event id="off" when="time ge 40"><set id="a">0</set></event><link from="system.a" to="cell.adhesion"/></eml>"#;
    let cell = |name: &str, side: f64| {
        format!(
            r#"
[cells.{name}]
mesh = {{ shape = "icosphere", radius = "5 um", level = 1 }}
placement = {{ at = [["{} um", "0 um", "0 um"]] }}
mechanics = {{ drag = "20 pN s/um", shape_memory = {{ shape_modulus = "5 pN/um" }} }}
loads = [{{ name = "pull", all = true, direction = [{side}, 0, 0], force = [["0 s", "-10 pN"], ["20 s", "-10 pN"], ["21 s", "2.5 pN"], ["100 s", "2.5 pN"]] }}]
chemistry = ["own"]
"#,
            5.1 * side
        )
    };
    let text = format!(
        r#"[run]
until = "60 s"
integrator = {{ max_step = "0.2 s" }}
[output]
every = "1 s"
{}{}
[contact]
strength = "0.5 pN/um^2"
"#,
        cell("left", -1.0),
        cell("right", 1.0)
    );
    let mut scene = scene(&[("own", own)], &text);
    let rows = scene.rows_until(60.0, |scene| scene.state().contact.atoms.len());
    let at = |time: f64| rows.iter().rfind(|(when, _)| *when <= time).unwrap().1;
    assert!(at(39.9) > 0, "they hold against the pull");
    assert_eq!(at(60.0), 0, "they are apart");
}

#[test]
fn each_cell_begins_at_what_is_drawn_for_its_id_on_any_threads() {
    let own = r#"<eml name="own" level="cell"><variable id="k" initial="lognormal(2, 0.3)" rate="0"/>
        <variable id="u" initial="uniform(0, 1)" rate="-k*u"/><solver scheme="rk45" rtol="1e-10" atol="1e-12"/></eml>"#;
    let document = pseudopod::equations::eml::read(std::sync::Arc::new(pseudopod::error::Source {
        name: "own.eml".into(),
        text: own.to_owned(),
    }));
    let starts = pseudopod::ode::Starts::new(&document.expect("no fault").system).expect("something is drawn");
    // The seed of the crowd.
    let numbers = pseudopod::ode::Numbers { seed: 4, system: "own" };
    for threads in [1, 3] {
        let scene = crowd(threads, &[("own", own)], 5, |_| ());
        let time = scene.state().time;
        for cell in 0..37 {
            let wanted = starts.values(numbers, cell as u64);
            assert_eq!(scene.value(0, "k", cell), wanted[0]);
            let u = wanted[1] * (-wanted[0] * time).exp();
            assert!((scene.value(0, "u", cell) - u).abs() < 1e-8, "{cell}");
        }
    }
    let mut scene = crowd(1, &[("own", own)], 2, |_| ());
    let Scene { compiled, ws } = &mut scene;
    let id = compiled.state.next_id;
    let positions = compiled.model.kinds[0].rest.positions.iter().map(|x| x + Vec3::new(0.0, 0.0, 60.0)).collect();
    let new = pseudopod::sim::NewCell { positions, parent: None };
    pseudopod::sim::add_cells(&compiled.model, &mut compiled.state, ws, 0, &[new]).expect("space for one");
    assert_eq!(scene.value(0, "k", 37), starts.values(numbers, id)[0]);
}

#[test]
fn what_systems_read_is_the_mean_of_a_step() {
    let own = r#"<eml name="own" level="cell"><input id="t" default="0"/><variable id="u" initial="0" rate="t"/>
        <link from="scene.time" to="system.t"/></eml>"#;
    for step in ["0.25 s", "2.5 s"] {
        let mut scene = scene(&[("own", own)], &one_cell("10 s", step));
        scene.run();
        // The mean of a line is exact; what is left is round-off.
        assert!((scene.value(0, "u", 0) - 50.0).abs() < 1e-9, "{step}: {}", scene.value(0, "u", 0));
    }
}

#[test]
fn cells_and_the_field_that_they_read_and_feed_are_of_second_order_together() {
    // What the field holds makes a cell release more of it: m' = -0.3 m + 600 u/1600, u' = m - 0.1 u.
    let field = r#"<eml name="field"><grid dimension="2" spacing="2" origin="-20 -20" size="40 40"/>
        <field id="c" diffusion="100" decay="0.3" initial="1"/></eml>"#;
    let own = r#"<eml name="own" level="cell"><input id="c" default="0"/><variable id="u" initial="0.2" rate="c - 0.1*u"/>
        <solver rtol="1e-10" atol="1e-12"/>
        <link from="field[c].mean" to="system.c"/><link from="system.u" to="cell.secretion[c]" gain="600"/></eml>"#;
    // Rates of the two modes, and how much of each there is in u.
    let root = (0.01_f64 + 0.375).sqrt();
    let (growth, decay) = (-0.2 + root, -0.2 - root);
    let grows = (1.0 - 0.1 * 0.2 - decay * 0.2) / (growth - decay);
    let u = |t: f64| grows * (growth * t).exp() + (0.2 - grows) * (decay * t).exp();
    let m = |t: f64| grows * (growth + 0.1) * (growth * t).exp() + (0.2 - grows) * (decay + 0.1) * (decay * t).exp();
    let errors: Vec<[f64; 2]> = ["0.5 s", "0.25 s", "0.125 s"]
        .into_iter()
        .map(|step| {
            let mut scene = scene(&[("field", field), ("own", own)], &one_cell("12 s", step));
            scene.run();
            let mean = scene.state().chemistry.fields[0].values.iter().sum::<f64>() / 400.0;
            [(scene.value(0, "u", 0) / u(12.0) - 1.0).abs(), (mean / m(12.0) - 1.0).abs()]
        })
        .collect();
    println!("NOTE {errors:?}");
    for pair in errors.windows(2) {
        for (coarse, fine) in pair[0].iter().zip(&pair[1]) {
            assert!((1.7..2.3).contains(&(coarse / fine).log2()), "order {}: {errors:?}", (coarse / fine).log2());
        }
    }
    // Where the error chooses the step: at most a hundredth of the run by default; where 4 s are allowed, what cells and field do to each other
    // bounds it, so that each moves what is carried by 0.2 % at most (nine steps would be enough for mechanics, and 8 % off).
    let free = |integrator: &str| {
        let text = one_cell("12 s", "1 s").replace("integrator = { step = \"1 s\" }", integrator);
        let mut scene = scene(&[("field", field), ("own", own)], &text);
        scene.run();
        let mean = scene.state().chemistry.fields[0].values.iter().sum::<f64>() / 400.0;
        ([scene.value(0, "u", 0) / u(12.0) - 1.0, mean / m(12.0) - 1.0], scene.state().step)
    };
    println!("NOTE grown {} and {} fold", u(12.0) / u(0.0), m(12.0) / m(0.0));
    for (integrator, most) in [("", 0.005), ("integrator = { max_step = \"4 s\" }", 0.03)] {
        let (found, steps) = free(integrator);
        println!("NOTE {integrator}: {found:?} in {steps} steps");
        assert!(found.iter().all(|error| error.abs() < most), "{integrator}: {found:?} in {steps} steps");
    }
}

#[test]
fn what_a_cell_senses_of_its_own_release_does_not_depend_on_the_step() {
    let field = r#"<eml name="field"><grid dimension="2" spacing="2" origin="-40 -40" size="80 80"/>
        <field id="c" diffusion="100" decay="0.1" initial="0"/></eml>"#;
    let own = r#"<eml name="own" level="cell"><input id="c" default="0"/><variable id="u" initial="1" rate="0"/>
        <link from="field[c]" to="system.c"/><link from="system.u" to="cell.secretion[c]" gain="600"/></eml>"#;
    let sensed = |step: &str| {
        let mut scene = scene(&[("field", field), ("own", own)], &one_cell("4 s", step));
        scene.run();
        scene.value(0, "c", 0)
    };
    let exact = sensed("0.02 s");
    let found = ["0.2 s", "1 s", "4 s"].map(|step| (step, sensed(step) / exact - 1.0));
    println!("NOTE of {exact}: {found:?}");
    // What is released in a part of the step spreads from one instant. That is right for a Gaussian of the size of the cell, which a ring of
    // atoms on boxes is not: measured are 0.3, 0.2 and 1.7 %.
    assert!(found.iter().all(|(_, apart)| apart.abs() < 0.02), "{found:?}");
}
