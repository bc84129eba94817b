//! Walls with a flux or a course, open ones, and sources at points and on lines, against what theory has.

use std::f64::consts::PI;

use crate::field_transport::{ADAPTIVE, apart, order, solved};

fn line(spacing: f64, size: f64, field: &str) -> String {
    format!(
        "<eml name=\"walls\"><parameter id=\"k\" value=\"0.7\"/><grid dimension=\"1\" spacing=\"{spacing}\" origin=\"0\" size=\"{size}\"/>
         <field id=\"c\" {field}</field></eml>"
    )
}

#[test]
fn a_flux_through_walls_makes_a_line_and_what_came_in_is_there() {
    // What comes in at 0 at 0.6 µm⁻²·µm/s leaves at 10, which holds 1.
    let field = "diffusion=\"2\" initial=\"1\"><wall side=\"x-\" kind=\"flux\" value=\"0.6\"/>
                 <wall side=\"x+\" kind=\"fixed\" value=\"1\"/>";
    let (_, fields) = solved(&line(0.5, 10.0, field), 500.0, 5, ADAPTIVE);
    let [_, worst] = apart(&fields, |x, _| 1.0 + 0.3 * (10.0 - x));
    assert!(worst < 1e-6, "{worst}");
    let field = "diffusion=\"2\" initial=\"1\"><wall side=\"x-\" kind=\"flux\" value=\"0.6*time\"/>";
    let (_, fields) = solved(&line(0.5, 10.0, field), 4.0, 3, ADAPTIVE);
    assert!((fields.amount(0) - (10.0 + 0.3 * 16.0)).abs() < 1e-9, "{}", fields.amount(0));
}

#[test]
fn a_wall_that_lets_pass_by_a_transfer_coefficient_is_at_rest_with_second_order() {
    // Robin: D c' = k (c − 3) at 0; decay inside, closed at 4: c = A cosh((4 − x)/λ), λ² = D/decay.
    let errors: Vec<f64> = [0.25, 0.125, 0.0625]
        .map(|spacing| {
            let field =
                "diffusion=\"1\" decay=\"0.5\" initial=\"0\"><wall side=\"x-\" kind=\"flux\" value=\"k*(3 - c)\"/>";
            let (_, fields) = solved(&line(spacing, 4.0, field), 60.0, 4, ADAPTIVE);
            let (rate, length) = (0.5f64.sqrt(), 4.0);
            let factor = 3.0 * 0.7 / (0.7 * (rate * length).cosh() + rate * (rate * length).sinh());
            apart(&fields, |x, _| factor * (rate * (length - x)).cosh())[1]
        })
        .into();
    assert!(order(&errors) > 1.8 && errors[2] < 1e-3, "{errors:?}: {}", order(&errors));
}

#[test]
fn a_wall_that_swings_sends_a_wave_that_dies_as_stokes_says() {
    // c = 2 + exp(−x q) cos(ω t − x q), q = √(ω/2D).
    let (omega, diffusion) = (2.0 * PI / 10.0, 2.0);
    let rate = (omega / (2.0 * diffusion)).sqrt();
    let exact = |x: f64, t: f64| 2.0 + (-x * rate).exp() * (omega * t - x * rate).cos();
    let errors: Vec<f64> = [0.5, 0.25]
        .map(|spacing| {
            let field = format!(
                "diffusion=\"2\" initial=\"2 + exp(-x*{rate})*cos(x*{rate})\"><wall side=\"x-\" kind=\"fixed\" value=\"2 + cos(2*pi*time/10)\"/>"
            );
            let (_, fields) = solved(&line(spacing, 40.0, &field), 23.0, 23, ADAPTIVE);
            apart(&fields, |x, _| exact(x, 23.0))[1]
        })
        .into();
    assert!(order(&errors) > 1.7 && errors[1] < 3e-3, "{errors:?}: {}", order(&errors));
}

#[test]
fn what_flows_through_open_walls_comes_in_with_their_value_and_leaves() {
    let field = "initial=\"0\"><advection x=\"2\"/><wall side=\"x-\" kind=\"open\" value=\"1 + sin(time)\"/><wall side=\"x+\" kind=\"open\"/>";
    let (_, fields) = solved(&line(0.05, 10.0, field), 8.0, 4, ADAPTIVE);
    let [mean, _] = apart(&fields, |x, _| 1.0 + (8.0 - x / 2.0).sin());
    assert!(mean < 1e-3, "{mean}");
    // A flow against a wall that holds a value, with diffusion: c = (e^{Pe x/L} − 1)/(e^{Pe} − 1).
    let field = "diffusion=\"1\" initial=\"0\"><advection x=\"0.5\"/><wall side=\"x-\" kind=\"fixed\" value=\"0\"/>
                 <wall side=\"x+\" kind=\"fixed\" value=\"1\"/>";
    let (_, fields) = solved(&line(0.1, 10.0, field), 100.0, 4, ADAPTIVE);
    let [_, worst] = apart(&fields, |x, _| ((0.5 * x).exp() - 1.0) / (5f64.exp() - 1.0));
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn a_point_on_a_line_feeds_what_decays() {
    // At rest c = S/(2√(D k)) exp(−|x − 10|/λ), λ = √(D/k) = 1, far from the walls.
    let errors: Vec<f64> = [0.2, 0.1]
        .map(|spacing| {
            let field = "diffusion=\"2\" decay=\"2\" initial=\"0\"><source at=\"10\" strength=\"3\"/>";
            let (_, fields) = solved(&line(spacing, 20.0, field), 10.0, 2, ADAPTIVE);
            assert!((fields.amount(0) - 1.5 * (1.0 - (-20.0f64).exp())).abs() < 1e-3, "{}", fields.amount(0));
            let beside = |x: f64| (x - 10.0f64).abs() > 0.5;
            apart(&fields, |x, _| 0.75 * (-(x - 10.0).abs()).exp())[usize::from(beside(0.0))]
        })
        .into();
    assert!(order(&errors) > 1.5 && errors[1] < 5e-3, "{errors:?}: {}", order(&errors));
}

#[test]
fn what_a_point_releases_in_the_plane_spreads_by_the_exponential_integral() {
    // c = S/(4πD) E₁(r²/4Dt); all of it stays.
    let (system, fields) = solved(
        "<eml name=\"point\"><grid dimension=\"2\" spacing=\"0.5\" origin=\"-10 -10\" size=\"20 20\"/>
         <field id=\"c\" diffusion=\"1\" initial=\"0\"><source at=\"0.2 -0.1\" strength=\"5\"/></field></eml>",
        4.0,
        2,
        ADAPTIVE,
    );
    assert!((fields.amount(0) / 20.0 - 1.0).abs() < 1e-12, "{}", fields.amount(0));
    let exponential_integral = |u: f64| {
        // ∫₁^∞ e^(−u s)/s ds by the substitution s = e^q.
        let steps = 4000;
        let h = 8.0 / f64::from(steps);
        (0..steps).map(|i| (-u * ((f64::from(i) + 0.5) * h).exp()).exp() * h).sum::<f64>()
    };
    for (x, y) in [(2.25, 0.25), (-1.75, 1.75), (0.25, -3.75)] {
        let index = [x, y].map(|p: f64| ((p + 10.0) / 0.5) as usize);
        let value = fields.values(0)[system.grid().at(index[0], index[1], 0)];
        let squared = (x - 0.2_f64).powi(2) + (y + 0.1_f64).powi(2);
        let exact = 5.0 / (4.0 * PI) * exponential_integral(squared / 16.0);
        assert!((value / exact - 1.0).abs() < 0.02, "{value} {exact}");
    }
}

#[test]
fn a_line_across_the_plane_is_a_point_on_a_line() {
    let of = |grid: &str, source: &str| {
        let (_, fields) = solved(
            &format!(
                "<eml name=\"line\"><grid {grid}/>
                 <field id=\"c\" diffusion=\"1\" initial=\"0\"><source {source} strength=\"2 + cos(time)\"/></field></eml>"
            ),
            3.0,
            1,
            ADAPTIVE,
        );
        fields
    };
    let plane = of("dimension=\"2\" spacing=\"0.5\" origin=\"-4 0\" size=\"8 4\"", "from=\"0.1 0\" to=\"0.1 4\"");
    let line = of("dimension=\"1\" spacing=\"0.5\" origin=\"-4\" size=\"8\"", "at=\"0.1\"");
    for row in 0..8 {
        for x in 0..16 {
            // Per µm of the line.
            let (a, b) = (plane.values(0)[16 * row + x], line.values(0)[x] / 4.0);
            assert!((a - b).abs() < 1e-3 * b.abs() + 1e-6, "{a} {b}");
        }
    }
    assert!((plane.amount(0) - (6.0 + 3f64.sin())).abs() < 2e-3, "{}", plane.amount(0));
}
