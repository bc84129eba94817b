//! What links read of the cells that a cell touches, against what it is by hand.

use crate::coupled_scene::{Scene, scene};
use pseudopod::Vec3;

/// Four cells in a row that just touch, two of a type `left` and two of a type `right`, each with the same system.
fn row(own: &str) -> Scene {
    let cells = |name: &str, at: [f64; 2]| {
        format!(
            "[cells.{name}]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 2 }}\nchemistry = [\"own\"]\n\
             placement = {{ at = [[\"{} um\", \"0 um\", \"0 um\"], [\"{} um\", \"0 um\", \"0 um\"]] }}\n\
             mechanics = {{ drag = \"20 pN s/um\", shape_memory = {{ shape_modulus = \"10 pN/um\" }} }}\n",
            at[0], at[1]
        )
    };
    let text = format!(
        "[run]\nuntil = \"0.2 s\"\nintegrator = {{ step = \"0.1 s\" }}\n[output]\nevery = \"0.2 s\"\n\
         [contact]\nstrength = \"1 Pa\"\nmodel = \"adhesives\"\n{}{}[chemistry.own]\ndocument = \"own.eml\"\n",
        cells("left", [-15.03, -5.01]),
        cells("right", [5.01, 15.03])
    );
    scene(&[("own", own)], &text)
}

#[test]
fn a_cell_reads_how_many_touch_it_and_what_they_have() {
    // What each has is what it reads of where it is, so that this must be carried first.
    let inputs = [
        ("count", "count"),
        ("left_count", "count"),
        ("sum", "chemistry[own].v.sum"),
        ("mean", "chemistry[own].v.mean"),
        ("largest", "chemistry[own].v.largest"),
        ("smallest", "chemistry[own].v.smallest"),
        ("weighted", "chemistry[own].v.area_mean"),
        ("weights", "chemistry[own].v.area_sum"),
        ("area", "area"),
        ("positions", "position.x.sum"),
    ];
    let links = inputs.map(|(id, path)| {
        let of = if id == "left_count" { "[left]" } else { "" };
        format!("<input id=\"{id}\" default=\"0\"/><link from=\"cell.neighbours{of}.{path}\" to=\"system.{id}\"/>")
    });
    let own = format!(
        "<eml name=\"own\" level=\"cell\">{}<variable id=\"idle\" initial=\"0\" rate=\"0\"/><input id=\"x\" default=\"0\"/>\
         <define id=\"v\">10 + x</define><link from=\"cell.position.x\" to=\"system.x\"/></eml>",
        links.concat()
    );
    let mut scene = row(&own);
    scene.begin();
    let near: [&[usize]; 4] = [&[1], &[0, 2], &[1, 3], &[2]];
    let read = |id: &str| [0, 1, 2, 3].map(|cell| scene.value(0, id, cell));
    let (v, x, area) = (read("v"), read("x"), read("area"));
    assert!((v[0] + 5.03).abs() < 1e-6, "{v:?}");
    // What two share is the same from either side.
    let shared = [area[0], area[1] - area[0], area[3]];
    assert!((area[2] - area[3] - shared[1]).abs() < 1e-12, "{area:?}");
    assert!(shared.iter().all(|area| (0.5..60.0).contains(area)), "{shared:?}");
    for cell in 0..4 {
        let of = |values: [f64; 4]| near[cell].iter().map(move |other| values[*other]);
        let weight = |other: usize| shared[cell.min(other)];
        let weights: f64 = near[cell].iter().map(|other| weight(*other)).sum();
        let weighted: f64 = near[cell].iter().map(|other| weight(*other) * v[*other]).sum();
        for (id, wanted) in [
            ("count", near[cell].len() as f64),
            ("left_count", near[cell].iter().filter(|other| **other < 2).count() as f64),
            ("sum", of(v).sum()),
            ("mean", of(v).sum::<f64>() / near[cell].len() as f64),
            ("largest", of(v).fold(f64::NEG_INFINITY, f64::max)),
            ("smallest", of(v).fold(f64::INFINITY, f64::min)),
            ("weighted", weighted / weights),
            ("weights", weighted),
            ("area", weights),
            ("positions", of(x).sum()),
        ] {
            let found = scene.value(0, id, cell);
            assert!((found - wanted).abs() < 1e-9, "{id} of {cell}: {found} for {wanted}");
        }
    }
}

#[test]
fn who_touches_nobody_reads_nothing() {
    let own = r#"<eml name="own" level="cell"><input id="mean" default="7"/><input id="count" default="7"/>
        <variable id="v" initial="3" rate="0"/><link from="cell.neighbours[right].chemistry[own].v.mean" to="system.mean"/>
        <link from="cell.neighbours[right].count" to="system.count"/></eml>"#;
    let mut scene = row(own);
    scene.begin();
    // The left one touches its like only.
    assert_eq!(
        [0, 1].map(|cell| [scene.value(0, "mean", cell), scene.value(0, "count", cell)]),
        [[0.0, 0.0], [3.0, 1.0]]
    );
}

/// Cells at some points, where they stay, that have the document `delta_notch`, whose hours are seconds.
fn lateral(at: &[Vec3]) -> Scene {
    let points: Vec<String> = at.iter().map(|x| format!("[\"{} um\", \"{} um\", \"0 um\"]", x.x, x.y)).collect();
    let text = format!(
        "seed = 2\n[run]\nuntil = \"200 s\"\nintegrator = {{ step = \"0.5 s\" }}\n[output]\nevery = \"200 s\"\n\
         [cells.cell]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nchemistry = [\"delta_notch\"]\n\
         placement = {{ at = [{}] }}\nmechanics = {{ drag = \"20 pN s/um\", shape_memory = {{ shape_modulus = \"10 pN/um\" }} }}\n\
         [contact]\nstrength = \"1e-9 Pa\"\nmodel = \"adhesives\"\nproximity = \"1 um\"\n\
         [chemistry.delta_notch]\ndocument = \"delta_notch.eml\"\nset = {{ decay = 3600 }}\n",
        points.join(", ")
    );
    let document = std::fs::read_to_string(format!("{}/eml/delta_notch.eml", env!("CARGO_MANIFEST_DIR")));
    let mut scene = scene(&[("delta_notch", &document.expect("a document that ships"))], &text);
    scene.run();
    scene
}

fn notch(delta_around: f64) -> f64 {
    delta_around.powi(2) / (0.01 + delta_around.powi(2))
}

fn delta(notch: f64) -> f64 {
    1.0 / (1.0 + 100.0 * notch.powi(2))
}

#[test]
fn of_two_cells_that_begin_nearly_alike_one_takes_the_delta() {
    let scene = lateral(&[Vec3::new(-5.0, 0.0, 0.0), Vec3::new(5.0, 0.0, 0.0)]);
    let mut found = [0, 1].map(|cell| scene.value(0, "delta", cell));
    found.sort_by(f64::total_cmp);
    // Where each is what the other makes of it (Collier et al. 1996).
    let mut wanted = [0.0, 1.0];
    for _ in 0..100 {
        wanted = [delta(notch(wanted[1])), delta(notch(wanted[0]))];
    }
    assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} for {wanted:?}");
}

#[test]
fn in_a_layer_of_cells_no_two_with_much_delta_touch_and_all_others_touch_one() {
    let at: Vec<Vec3> = (-2_i32..=2)
        .flat_map(|row| (-2_i32..=2).map(move |column| (row, column)))
        .filter(|(row, column)| (row + column).abs() <= 2)
        .map(|(row, column)| {
            10.0 * Vec3::new(f64::from(column) + 0.5 * f64::from(row), 0.75_f64.sqrt() * f64::from(row), 0.0)
        })
        .collect();
    assert_eq!(at.len(), 19);
    let scene = lateral(&at);
    let much: Vec<bool> = (0..19).map(|cell| scene.value(0, "delta", cell) > 0.5).collect();
    let near = |cell: usize| {
        (0..19)
            .filter(move |&other| other != cell)
            .filter(|&other| (at[cell] - at[other]).norm() < 11.0)
            .collect::<Vec<_>>()
    };
    for cell in 0..19 {
        let around = near(cell);
        let with_much = around.iter().filter(|other| much[**other]).count();
        assert!(if much[cell] { with_much == 0 } else { with_much > 0 }, "{cell}: {much:?}");
        // It rests, by what it reads of those around.
        let rest = delta(notch(scene.value(0, "delta_around", cell)));
        let own = scene.value(0, "delta", cell);
        assert!((own - rest).abs() < 1e-3, "{cell}: {own} for {rest}");
    }
    let count = much.iter().filter(|much| **much).count();
    // A third of a layer without rim; of 19 cells from 4 to 9 can be so.
    assert!((4..=9).contains(&count), "{count}: {much:?}");
}
