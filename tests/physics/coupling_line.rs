//! Fields on a line: cells sense them and release into them at their x, wherever else they are.

use crate::coupled_scene::{Scene, one_cell, scene};

/// A cell with a system beside a field on a line from -60 to 60.
fn on_a_line(field: &str, own: &str, at: &str, until: &str) -> Scene {
    let grid = r#"<grid dimension="1" spacing="1" origin="-60" size="120"/>"#;
    let field = format!(r#"<eml name="field">{grid}{field}</eml>"#);
    let text = one_cell(until, "0.1 s") + &format!("placement = {{ at = [[{at}]] }}\n");
    scene(&[("field", &field), ("own", &format!(r#"<eml name="own" level="cell">{own}</eml>"#))], &text)
}

#[test]
fn a_cell_senses_what_is_at_its_x() {
    // Between walls at 0 and 12 the field is a line, which nothing changes.
    let field = r#"<field id="c" diffusion="30" initial="6 + x/10"><wall side="x-" kind="fixed" value="0"/>
        <wall side="x+" kind="fixed" value="12"/></field>"#;
    let own = r#"<input id="seen" default="0"/><input id="slope" default="0"/><input id="across" default="1"/>
        <variable id="t" initial="0" rate="1"/><link from="field[c]" to="system.seen"/>
        <link from="field[c].gradient.x" to="system.slope"/><link from="field[c].gradient.y" to="system.across"/>"#;
    let mut bits = Vec::new();
    for at in [r#""7.3 um", "0 um", "0 um""#, r#""7.3 um", "300 um", "-40 um""#] {
        let mut scene = on_a_line(field, own, at, "1 s");
        scene.run();
        let [seen, slope, across] = ["seen", "slope", "across"].map(|id| scene.value(0, id, 0));
        assert!((seen - 6.73).abs() < 1e-9 && (slope - 0.1).abs() < 1e-10 && across == 0.0, "{seen} {slope} {across}");
        bits.push((seen, slope));
    }
    // Positions are rounded where the cell is put.
    assert!((bits[0].0 - bits[1].0).abs() < 1e-12);
}

#[test]
fn what_a_cell_releases_is_an_amount_of_the_cross_section_and_falls_off_on_both_sides() {
    let (d, k, rate) = (30.0, 0.5, 4.0);
    let field = format!(r#"<field id="c" diffusion="{d}" decay="{k}" initial="0"/>"#);
    let own = format!(
        r#"<parameter id="q" value="{rate}"/><variable id="t" initial="0" rate="1"/><link from="system.q" to="cell.secretion[c]"/>"#
    );
    let mut scene = on_a_line(&field, &own, r#""0 um", "25 um", "9 um""#, "40 s");
    scene.run();
    let values = &scene.state().chemistry.fields[0].values;
    assert_eq!(values.len(), 120);
    // Boxes are as large as they are long, so that sum and amount are one.
    let amount: f64 = values.iter().sum();
    assert!((amount / (rate / k) - 1.0).abs() < 2e-3, "{amount}, not {}", rate / k);
    // Far from the cell, which is 10 µm wide, exp(-x/λ) with λ² = D/k, and as much to the left as to the right.
    let length = (d / k).sqrt();
    for (near, far) in [(75, 85), (80, 95)] {
        let exact = (f64::from(far - near) / length).exp();
        let found = values[near as usize] / values[far as usize];
        // Boxes of 1 µm change λ by (h/λ)²/24, and time steps have an error of a thousandth each.
        assert!((found / exact - 1.0).abs() < 5e-3, "{found}, not {exact}");
        let mirrored = values[119 - near as usize];
        assert!((values[near as usize] / mirrored - 1.0).abs() < 1e-6, "{} and {mirrored}", values[near as usize]);
    }
    // In the middle of a cell of shells it is what a plane of its atoms makes: Q/(2 √(Dk)) times the mean of exp(-|x|/λ) over them.
    let kind = &scene.compiled.model.kinds[0];
    let atoms = scene.state().kinds[0].cell(kind, 0);
    let mean =
        |at: f64| atoms.iter().map(|atom| (-(atom.x - at).abs() / length).exp()).sum::<f64>() / atoms.len() as f64;
    let (found, exact) = (values[60], rate / (2.0 * (d * k).sqrt()) * mean(0.5));
    assert!((found / exact - 1.0).abs() < 1e-2, "{found}, not {exact}");
}
