//! Contractile fibres draw their ends together as far as they are active, and let go elastically.

use crate::coupled_scene::{Scene, scene};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::fibres::Fibres;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::sim::{Kind, Model, State, Trouble, VolumeRule, Workspace, step};

/// The distance of two atoms that nothing but a fibre and drag acts on, µm, over that at the start, after 5 s.
fn drawn_together(cells: usize, size: StepSize) -> f64 {
    let rest = pseudopod::geometry::icosphere(5.0, 1);
    let (from, to) = (rest.positions[0], rest.positions[20]);
    // The documents' trunk: 0 to 1 in 2 s, back in half a second, then rest.
    let activation = Course::through(vec![(0.0, 0.0), (2.0, 1.0), (2.5, 0.0)]).unwrap();
    let trunk = Fibres::new("trunk", vec![[0, 20]], 3.0, activation);
    let mut kind = Kind::new("cell", rest, vec![Force::Fibres(trunk)]).for_cells(cells);
    kind.volume = VolumeRule::Free;
    kind.drag = 2.0;
    kind.bound_stiffness();
    let integrator = Integrator { method: Method::Implicit { order: Order::Second }, size };
    let model = Model::of(vec![kind], integrator, 5.0);
    let positions = vec![model.kinds[0].rest.positions.clone(); cells];
    let mut state = State::new(&model, &[positions]);
    let mut ws = Workspace::new(&model);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap();
    }
    let last = state.kinds[0].cell(&model.kinds[0], cells - 1);
    (last[20] - last[0]).norm() / (to - from).norm()
}

#[test]
fn ends_come_together_as_drag_lets_them_with_second_order() {
    // d' = −2 A K d / ζ, and the activation adds up to 1.25 s.
    let exact = (-2.0 * 3.0 / 2.0 * 1.25f64).exp();
    for cells in [1, 11] {
        let close = drawn_together(cells, StepSize::Adaptive { tolerance: 1e-5, largest: 0.5 });
        assert!((close - exact).abs() < 1e-4, "{cells} cells: {close} and {exact}");
    }
    let errors: Vec<f64> = [0.05, 0.025, 0.0125].map(|dt| drawn_together(1, StepSize::Fixed(dt)) - exact).into();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 1.8, "{errors:?}: order {order}");
    }
}

/// A ball whose only elastic part is a spring of 6 pN/µm between two atoms, which have a fibre of 4 pN/µm, too.
fn sprung(systems: &[(&str, &str)], activation: &str) -> Scene {
    let text = format!(
        r#"[run]
until = "60 s"
integrator = {{ max_step = "0.5 s" }}
[cells.ball]
mesh = {{ shape = "icosphere", radius = "5 um", level = 1 }}
mechanics = {{ drag = "20 pN s/um", volume = {{ rule = "free" }} }}
links = [{{ pairs = [[0, 20]], stiffness = "6 pN/um" }}]
fibres = [{{ name = "other", pairs = [[1, 2]], stiffness = "1 pN/um" }}, {{ name = "trunk", pairs = [[0, 20]], stiffness = "4 pN/um"{activation} }}]
{}
[output]
every = "60 s"
"#,
        if systems.is_empty() { "" } else { "chemistry = [\"drive\"]" }
    );
    scene(systems, &text)
}

/// The length of the fibre over that of the spring at rest.
fn length(scene: &Scene) -> f64 {
    let kind = &scene.compiled.model.kinds[0];
    let (now, rest) = (scene.state().kinds[0].cell(kind, 0), &kind.rest.positions);
    (now[20] - now[0]).norm() / (rest[20] - rest[0]).norm()
}

#[test]
fn a_fibre_shortens_a_spring_to_where_both_pull_alike_and_lets_it_back() {
    for (activation, wanted) in [("", 1.0), (", activation = 1", 0.6), (", activation = 0.5", 0.75)] {
        let mut held = sprung(&[], activation);
        held.run();
        assert!((length(&held) - wanted).abs() < 1e-6, "{activation}: {} and {wanted}", length(&held));
    }
    let mut relaxed = sprung(&[], ", activation = [[\"0 s\", 1], [\"20 s\", 1], [\"21 s\", 0]]");
    relaxed.run();
    assert!((length(&relaxed) - 1.0).abs() < 1e-6, "relaxation is elastic: {}", length(&relaxed));
}

#[test]
fn chemistry_sets_the_activation_of_a_fibre_by_its_name() {
    let drive = |value: &str| {
        format!(
            r#"<eml name="drive" level="cell"><variable id="a" initial="{value}" rate="-0.5*(a-0.5)"/>
        <link from="system.a" to="cell.fibre[trunk]"/></eml>"#
        )
    };
    let mut scene = sprung(&[("drive", &drive("0"))], ", activation = 1");
    let rows = scene.rows_until(60.0, |scene| (scene.value(0, "a", 0), length(scene)));
    let (time, (first, _)) = rows[rows.len() / 8];
    assert!((first - 0.5 * (1.0 - (-0.5 * time).exp())).abs() < 1e-4, "{first} at {time} s");
    let (_, (activation, shortened)) = rows[rows.len() - 1];
    assert!((activation - 0.5).abs() < 1e-4 && (shortened - 0.75).abs() < 1e-4, "{activation}: {shortened}");
    match sprung(&[("drive", &drive("1.5"))], "").until_trouble() {
        Trouble::Link { value, expected, .. } => {
            assert_eq!((value, expected), (1.5, "a number from 0 to 1"));
        }
        other => panic!("{other}"),
    }
}
