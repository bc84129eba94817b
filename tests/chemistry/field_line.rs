//! Fields on a line: they are those of a plane that vary along x alone, and spread as theory says.

use std::sync::Arc;

use pseudopod::equations::eml;
use pseudopod::error::{Error, Fault, Result, Source};
use pseudopod::field::{FieldSystem, Fields, Grid, Stepping};

const ADAPTIVE: Stepping = Stepping::Adaptive { relative: 1e-4, absolute: 0.0 };

fn open(text: &str) -> (FieldSystem, Fields) {
    let source = Arc::new(Source { name: "test.eml".into(), text: text.into() });
    let system = FieldSystem::new(&eml::read(source).expect("a good document"), None).expect("a grid");
    let none = |_: &eml::Profile, _: &Grid| -> Result<Vec<f64>> { Err(Error::input(Fault::new("no file"))) };
    let fields = system.start(&none).expect("good profiles");
    (system, fields)
}

/// Two species that react, on a line or on a plane that is as long.
fn pair(grid: &str) -> (FieldSystem, Fields) {
    open(&format!(
        "<eml name=\"pair\"><grid {grid}/>
         <field id=\"u\" diffusion=\"3\" initial=\"1 + 0.5*cos(x)\"><reaction>1 - u*v + 0.1*x + y</reaction>
         <wall side=\"x-\" kind=\"fixed\" value=\"2\"/></field>
         <field id=\"v\" diffusion=\"0.5\" decay=\"0.1\" initial=\"exp(-x^2/4)\"><reaction>u - v</reaction></field></eml>"
    ))
}

#[test]
fn a_line_is_a_row_of_a_plane() {
    let (line, mut on_line) = pair("dimension=\"1\" spacing=\"0.25\" origin=\"-4\" size=\"8\"");
    // The middle row of five lies at y = 0.
    let (plane, mut on_plane) = pair("dimension=\"2\" spacing=\"0.25\" origin=\"-4 -0.625\" size=\"8 1.25\"");
    assert_eq!((line.grid().cells, line.grid().dimension(), plane.grid().dimension()), ([32, 1, 1], 1, 2));
    // What depends on y is odd around the middle row, and linear, but for u*v: so a short window.
    line.advance(&mut on_line, 1e-3, &[], Stepping::Fixed(4)).expect("a window");
    plane.advance(&mut on_plane, 1e-3, &[], Stepping::Fixed(4)).expect("a window");
    for s in 0..2 {
        for (a, b) in on_line.values(s).iter().zip(&on_plane.values(s)[64..96]) {
            assert!((a - b).abs() < 1e-6, "{a} and {b}");
        }
    }
}

#[test]
fn a_gaussian_on_a_line_spreads_with_second_order_and_keeps_its_amount() {
    // Variance 1 + 2 D t, D = 2 µm²/s, in mm and minutes: 0.001 mm of standard deviation at the start.
    let errors: Vec<f64> = [8, 16]
        .map(|boxes| {
            let spacing = 1e-3 / f64::from(boxes) * 4.0;
            let (system, mut fields) = open(&format!(
                "<eml name=\"spreads\" time_unit=\"min\">
                 <grid dimension=\"1\" spacing=\"{spacing}\" unit=\"mm\" origin=\"-0.02\" size=\"0.04\"/>
                 <field id=\"c\" diffusion=\"120e-6\" initial=\"exp(-(x/0.001 [mm])^2/2)\"/></eml>"
            ));
            let before = fields.amount(0);
            assert!((before - (2.0 * std::f64::consts::PI).sqrt()).abs() < 1e-9, "amount per µm²: {before}");
            system.advance(&mut fields, 3.0, &[], Stepping::Fixed(4 * boxes)).expect("a window");
            assert!((fields.amount(0) / before - 1.0).abs() < 1e-12);
            let variance: f64 = 1.0 + 2.0 * 2.0 * 3.0;
            let exact = |x: f64| variance.sqrt().recip() * (-x * x / (2.0 * variance)).exp();
            let grid = system.grid();
            (0..grid.len()).map(|at| (fields.values(0)[at] - exact(grid.centre(at).x)).abs()).fold(0.0, f64::max)
        })
        .into();
    let order = (errors[0] / errors[1]).log2();
    assert!((1.85..2.2).contains(&order) && errors[1] < 2e-3, "{errors:?} order {order}");
}

#[test]
fn a_front_of_fisher_on_a_line_has_its_speed() {
    // Ablowitz and Zeppetella (1979): u = (1 + e^{(x − 5t/√6)/√6})⁻² for u_t = u_xx + u(1 − u).
    let (system, mut fields) = open(
        "<eml name=\"front\"><grid dimension=\"1\" spacing=\"0.1\" origin=\"-20\" size=\"60\"/>
         <field id=\"u\" diffusion=\"1\" initial=\"(1 + exp(x/sqrt(6)))^-2\"><reaction>u*(1 - u)</reaction></field></eml>",
    );
    system.advance(&mut fields, 8.0, &[], ADAPTIVE).expect("a window");
    let exact = |x: f64| (1.0 + ((x - 8.0 * 5.0 / 6f64.sqrt()) / 6f64.sqrt()).exp()).powi(-2);
    let grid = system.grid();
    let apart = (0..grid.len()).map(|at| (fields.values(0)[at] - exact(grid.centre(at).x)).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-3, "{apart}");
}
