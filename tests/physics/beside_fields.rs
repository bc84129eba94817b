//! What stands beside the fields of a document, in a run.

use crate::coupled_scene::{Scene, crowd, one_cell, scene};

/// A bath of 1 000 µm² and a field of 1 600 that take up from each other, at twice the rate that comes from outside.
const BATH: &str = r#"<eml name="bath">
  <grid dimension="2" spacing="2" size="40 40" origin="-20 -20"/>
  <input id="rate" default="7"/>
  <define id="k">2*rate</define>
  <field id="c" initial="0.5 + 0.5*sin(3.141592653589793*x/40)" diffusion="20"><reaction>k*(s - c)</reaction></field>
  <integral id="flow">k*(s - c)</integral>
  <variable id="s" initial="2" rate="-flow/1000"/>
  <variable id="doses" initial="0" rate="0"/>
  <event every="7" first="4.5"><set id="c">c + 0.1</set><set id="doses">doses + 1</set></event>
  <link from="scene.time" to="system.rate" transfer="0.25 + 0*value"/>
</eml>"#;

/// The bath is told to each cell.
const OWN: &str = r#"<eml name="own" level="cell"><input id="around" default="0"/><variable id="seen" initial="0" rate="around"/>
  <link from="scene.chemistry[bath].s" to="system.around"/></eml>"#;

#[test]
fn a_bath_and_a_field_come_to_rest_as_is_known_however_long_the_steps() {
    // Mean and bath relax to their common mean at 1.3/s; a dose lifts the mean by a tenth.
    let relax = |[mean, bath]: [f64; 2], time: f64| {
        let (rest, left) = ((1.6 * mean + bath) / 2.6, (-0.5 * 2.6 * time).exp());
        [rest + (mean - rest) * left, rest + (bath - rest) * left]
    };
    let dosed = |[mean, bath]: [f64; 2]| [mean + 0.1, bath];
    let exact = relax(dosed(relax([0.5, 2.0], 4.5)), 1.5);
    for step in ["0.05 s", "0.4 s", "3 s"] {
        let mut scene = scene(&[("bath", BATH), ("own", OWN)], &one_cell("6 s", step));
        scene.run();
        let found = [scene.state().chemistry.fields[0].values.iter().sum::<f64>() / 400.0, scene.value(0, "s", 0)];
        println!("NOTE steps of {step}: {found:?}, exact {exact:?}");
        // As alone (`tests/chemistry/fields_beside.rs`); 2e-6 is measured.
        assert!(
            found.iter().zip(exact).all(|(found, exact)| (found - exact).abs() < 1e-4),
            "{step}: {found:?} {exact:?}"
        );
        assert_eq!(scene.value(0, "doses", 0), 1.0);
        assert!(scene.value(1, "seen", 0) > 1.2 * 6.0, "cells read it");
    }
}

/// A crowd that reads and feeds a medium, whose events set the field when the mean passes a bound.
fn crowd_after(threads: usize, before: impl Fn(&mut Scene) + Sync) -> Scene {
    let medium = r#"<eml name="medium">
      <grid dimension="2" spacing="5" size="160 160" origin="-80 -80"/>
      <input id="uptake" default="0"/>
      <field id="c" initial="1 + 0.5*cos(x/20)" diffusion="30"><reaction>0.2*(s - c) + 0.1*(c - m)*(m - uptake)</reaction></field>
      <mean id="m">c</mean>
      <variable id="s" initial="1" rate="1 - 0.3*m*s"/>
      <variable id="n" initial="0" rate="0"/>
      <event when="m gt 1.2"><set id="c">0.5*c*s</set><set id="n">n + 1</set></event>
      <link from="type[cell].chemistry[own].u" to="system.uptake"/></eml>"#;
    let own = r#"<eml name="own" level="cell"><input id="c" default="0"/><variable id="u" initial="0" rate="c - u"/>
        <link from="field[c]" to="system.c"/><link from="system.u" to="cell.secretion[c]"/></eml>"#;
    crowd(threads, &[("medium", medium), ("own", own)], 12, before)
}

#[test]
fn neither_threads_nor_scratch_nor_a_stop_matter_to_what_stands_beside_fields() {
    let after = |threads: usize| crowd_after(threads, |_| ()).compiled.state;
    let scene = crowd_after(1, |_| ());
    assert!(scene.value(0, "n", 0) > 0.0, "events have happened");
    let plain = scene.compiled.state;
    assert!(plain.chemistry.fields[0].values.iter().all(|value| value.is_finite()));
    assert_eq!(plain, after(3), "threads");
    assert_eq!(plain, crowd_after(1, |scene| scene.ws.poison(&scene.compiled.model)).compiled.state, "scratch");
    assert_eq!(plain, crowd_after(1, Scene::stop_and_resume).compiled.state, "a stop");
}
