//! What the clock switches in fields is met exactly, be it ever so short.

use pseudopod::field::Stepping;

use crate::field_transport::open;

#[test]
fn pulses_far_shorter_than_a_step_are_all_there() {
    let text = r#"<eml name="pulses">
  <grid dimension="1" spacing="1" size="20" origin="0"/>
  <field id="inside" initial="0" diffusion="30"><reaction>1000*pulse(3, 0.001, 4)</reaction></field>
  <field id="wall" initial="0" diffusion="30">
    <wall side="x-" kind="flux" value="piecewise(500, rem(time, 7) lt 0.004, 0)"/></field>
  <field id="source" initial="0" diffusion="30"><source at="9.5" strength="piecewise(100, floor(20*time) == 113, 0)"/></field>
</eml>"#;
    let (system, start) = open(text);
    let (relative, absolute) = system.usual_tolerance();
    for windows in [1, 3, 8] {
        for stepping in [Stepping::Adaptive { relative, absolute }, Stepping::Fixed(5)] {
            let mut fields = start.clone();
            for _ in 0..windows {
                system.advance(&mut fields, 12.0 / f64::from(windows), &[], stepping).expect("a window");
            }
            // Three pulses of one each in twelve seconds; two of 2 through the wall; one of 5.
            for (species, amount) in [(0, 3.0 * 20.0), (1, 2.0 * 2.0), (2, 5.0)] {
                let found = fields.amount(species);
                assert!((found / amount - 1.0).abs() < 1e-9, "{windows} {stepping:?} {species}: {found} for {amount}");
            }
        }
    }
}

#[test]
fn a_jump_of_a_rate_costs_no_digits() {
    // Growth at 1 /s until 1.7 s, and none afterwards.
    let (system, mut fields) = open(
        r#"<eml name="jump"><grid dimension="1" spacing="1" size="8" origin="0"/>
        <field id="c" initial="1" diffusion="1"><reaction>piecewise(c, time lt 1.7, 0)</reaction></field></eml>"#,
    );
    let report = system.advance(&mut fields, 10.0, &[], Stepping::Adaptive { relative: 1e-6, absolute: 0.0 });
    let found = fields.values(0)[3];
    println!("NOTE {report:?}, {found}, exact {}", 1.7_f64.exp());
    // The tolerance of what changes in a step, of which the growth is one of 1.7 in the exponent.
    assert!((found / 1.7_f64.exp() - 1.0).abs() < 1.7e-6, "{found}");
    assert!(report.expect("a window").rejected < 16);
}
