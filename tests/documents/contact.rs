//! What the table of contacts in a document means, and where cells start that touch.

use pseudopod::Vec3;
use pseudopod::analysis::aggregates::{Change, changes};
use pseudopod::experiment::{Compiled, Document, PushedApart, compile, settle_start};
use pseudopod::output::{Overwrite, ResultFile};
use pseudopod::recorded::{CONTACTS, Touch};
use pseudopod::run::{Quiet, RunOptions, run};
use pseudopod::sim::contact::{Cohesive, Strength};
use pseudopod::sim::{Workspace, begin_chemistry, step};
use std::collections::BTreeMap;
use std::path::Path;

/// Two types at random in a box above a plane, without contacts.
const SCENE: &str = r#"
title = "Two types"
seed = 3
[run]
until = "2 s"
[cells.red]
number = 12
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { random_from = ["0 um", "0 um", "0 um"], random_to = ["60 um", "60 um", "30 um"] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "50 pN/um" } }
[cells.white]
number = 6
mesh = { shape = "icosphere", radius = "4 um", level = 1 }
placement = { random_from = ["0 um", "0 um", "0 um"], random_to = ["60 um", "60 um", "30 um"] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "50 pN/um" } }
[[planes]]
name = "floor"
point = ["0 um", "0 um", "0 um"]
normal = [0, 0, 1]
"#;

fn document(more: &str) -> Document {
    Document::parse("contacts.toml", &format!("{SCENE}{more}"), Path::new("."), &[]).unwrap_or_else(|error| {
        panic!("{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
    })
}

fn compiled(more: &str) -> Compiled {
    let document = document(more);
    let mut compiled = compile(&document).expect("a good document");
    let pushed = settle_start(&document, &mut compiled).expect("a start without overlap");
    assert_eq!(pushed, PushedApart::default());
    compiled
}

/// Mean of the atoms of every cell; exact centres, for the atoms of an icosphere lie opposite each other.
fn centres(compiled: &Compiled) -> Vec<(Vec3, f64)> {
    let kinds = compiled.model.kinds.iter().zip(&compiled.state.kinds);
    let of_kind = |(kind, now): (&pseudopod::sim::Kind, &pseudopod::sim::KindState)| -> Vec<(Vec3, f64)> {
        let radius = kind.rest.positions[0].norm();
        let mean = |cell| now.cell(kind, cell).iter().sum::<Vec3>() / kind.atoms() as f64;
        (0..now.cells()).map(|cell| (mean(cell), radius)).collect()
    };
    kinds.flat_map(of_kind).collect()
}

const TABLE: &str = r#"
strength = "10 pN/um^2"
shear_strength = "4 Pa"
[[contact.between]]
types = ["white", "red"]
strength = "2 Pa"
[[contact.between]]
types = ["floor", "red"]
strength = "50 pN/um^2"
shear_strength = "5 pN/um^2"
"#;

#[test]
fn the_table_gives_each_pair_its_strength_and_the_default_the_others() {
    let compiled = compiled(&format!("[contact]\nmodel = \"adhesives\"{TABLE}"));
    let contact = compiled.model.contact.expect("contacts");
    let (default, pair) =
        (Strength { tensile: 10.0, shear: 4.0, energy: 0.0 }, Strength { tensile: 2.0, shear: 2.0, energy: 0.0 });
    assert_eq!(contact.between, [default, pair, pair, default]);
    assert_eq!(contact.on_obstacles, [Strength { tensile: 50.0, shear: 5.0, energy: 0.0 }, Strength::default()]);
}

#[test]
fn surfaces_attract_each_other_by_default_as_far_as_the_energy_or_the_range_or_the_default_says() {
    let found = |range: &str, of_pair: &str| {
        let table = TABLE.replace("\"2 Pa\"", &format!("\"2 Pa\"\n{of_pair}"));
        let contact = compiled(&format!("[contact]{range}{table}")).model.contact.expect("contacts");
        let table = contact.law.cohesion().expect("the default").clone();
        let is_sheared_only = |strength: &Strength| (strength.tensile, strength.energy) == (0.0, 0.0);
        assert!(contact.between.iter().chain(&contact.on_obstacles).all(is_sheared_only));
        assert_eq!(
            [contact.between[0].shear, contact.between[1].shear, contact.on_obstacles[0].shear],
            [4.0, 2.0, 5.0]
        );
        assert_eq!(table.on_obstacles[1], Cohesive::default(), "nothing sticks to a plane that is not named");
        [table.between[0], table.between[1], table.on_obstacles[0]].map(|pair| (pair.strength, pair.work))
    };
    assert_eq!(found("", ""), [(10.0, 7.5), (2.0, 1.5), (50.0, 37.5)]);
    assert_eq!(found("\nrange = \"2 um\"", ""), [(10.0, 10.0), (2.0, 2.0), (50.0, 50.0)]);
    assert_eq!(found("\nrange = \"2 um\"", "energy = \"3 pN/um\""), [(10.0, 10.0), (2.0, 3.0), (50.0, 50.0)]);
    assert_eq!(found("\nenergy = \"9 pN/um\"", "range = \"4 um\""), [(10.0, 9.0), (2.0, 4.0), (50.0, 37.5)]);
}

#[test]
fn an_energy_alone_has_the_strength_that_parts_it_over_the_range() {
    let found = |contact: &str| {
        let contact = compiled(contact).model.contact.expect("contacts");
        let pair = contact.law.cohesion().expect("the default").between[0];
        (pair.strength, pair.work, contact.between[0].shear)
    };
    assert_eq!(found("[contact]\nenergy = \"3 pN/um\"\n"), (4.0, 3.0, 4.0));
    assert_eq!(found("[contact]\nenergy = \"3 pN/um\"\nrange = \"2 um\"\n"), (3.0, 3.0, 3.0));
    assert_eq!(found("[contact]\nenergy = \"3 pN/um\"\nshear_strength = \"1 Pa\"\n"), (4.0, 3.0, 1.0));
}

#[test]
fn an_empty_table_turns_contacts_on_and_nothing_sticks() {
    assert!(compiled("").model.contact.is_none());
    let Compiled { model, .. } = compiled("[contact]\n");
    let contact = model.contact.expect("contacts");
    assert!(contact.between.iter().chain(&contact.on_obstacles).all(|strength| *strength == Strength::default()));
}

#[test]
fn a_step_looks_ahead_for_a_fifth_of_an_edge_and_for_what_touches_at_least() {
    let of = |contact: &str| {
        let Compiled { model, .. } = compiled(&format!("[contact]\n{contact}\n"));
        let smallest = model.kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
        let reach = model.contact.expect("contacts").reach;
        [reach.proximity, reach.prediction, reach.depth].map(|length| length / smallest)
    };
    let near = |found: [f64; 3], expected: [f64; 3]| {
        assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-9), "{found:?}");
    };
    for law in ["", "strength = \"10 Pa\"", "model = \"adhesives\"", "model = \"links\""] {
        near(of(law), [0.1, 0.2, 0.2]);
    }
    let edge = 1.0 / of("proximity = \"1 um\"")[0];
    let named = |key: &str, share: f64| format!("{key} = \"{} um\"\n", share * edge);
    near(of(&named("proximity", 0.05)), [0.05, 0.2, 0.2]);
    near(of(&named("proximity", 0.3)), [0.3, 0.3, 0.3]);
    near(of(&named("prediction", 0.4)), [0.1, 0.4, 0.4]);
    near(of(&named("prediction", 0.05)), [0.05, 0.05, 0.05]);
    near(of(&(named("proximity", 0.2) + &named("prediction", 0.3))), [0.2, 0.3, 0.3]);
}

#[test]
fn cells_at_random_start_apart_and_above_the_planes() {
    let with = compiled("[contact]\nproximity = \"0.3 um\"\n");
    let cells = centres(&with);
    assert_eq!(cells.len(), 18);
    for (number, (centre, radius)) in cells.iter().enumerate() {
        for (other, its) in &cells[..number] {
            // Round-off of the mean.
            assert!((centre - other).norm() >= radius + its + 0.3 - 1e-9, "cell {number}");
        }
    }
    let lowest = |kind: &pseudopod::sim::Kind, now: &pseudopod::sim::KindState| {
        (0..now.cells()).flat_map(|cell| now.cell(kind, cell)).map(|p| p.z).fold(f64::INFINITY, f64::min)
    };
    for (kind, now) in with.model.kinds.iter().zip(&with.state.kinds) {
        assert!(lowest(kind, now) > -1e-7, "an atom stands on the plane at most");
    }
}

#[test]
fn a_cell_that_fits_at_once_is_where_it_is_without_contacts() {
    let (with, without) = (compiled("[contact]\n"), compiled(""));
    let same = centres(&with).iter().zip(centres(&without)).filter(|(one, other)| **one == *other).count();
    // Spheres that drew a free place at once; the others drew again.
    assert!((4..18).contains(&same), "{same} of 18 cells stay where they were");
    assert_eq!(with.state.kinds[0].cell(&with.model.kinds[0], 0).len(), 42);
}

/// Three cells in a row that touch, one alone, pulled apart by nothing.
const ROW: &str = r#"
title = "Three in a row and one alone"
[run]
until = "0.2 s"
[cells.red]
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
placement = { at = [["0 um", "0 um", "20 um"], ["20.4 um", "0 um", "20 um"], ["50 um", "0 um", "20 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "50 pN/um" } }
[cells.white]
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
placement = { at = [["10.2 um", "0 um", "20 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "50 pN/um" } }
[contact]
proximity = "0.6 um"
strength = "1 Pa"
[output]
every = "0.1 s"
[measure.together]
kind = "value"
series = "largest_aggregate"
[measure.share]
kind = "value"
series = "contact_share"
cells = "white"
[measure.mixed]
kind = "segregation"
[measure.p]
kind = "segregation"
cells = ["red", "white"]
statistic = "p_value"
[[plot]]
name = "contacts"
kind = "series"
y = ["contact.count", "contact.deepest", "aggregates"]
"#;

#[test]
fn aggregates_are_what_links_join_and_pairs_are_what_touches() {
    let folder = tempfile::tempdir().expect("a folder");
    for (stiffness, joined, together) in
        [("5 pN/um", [0.0, 0.0, 2.0, 0.0], 3.0), ("0 pN/um", [0.0, 1.0, 2.0, 3.0], 1.0)]
    {
        let model = format!("model = \"links\"\nlink = \"{stiffness}\"");
        let text = ROW.replace("strength = \"1 Pa\"", &model).replace("\"contact.count\"", "\"contact.links\"");
        let document = Document::parse("row.toml", &text, Path::new("."), &[]).expect("a good document");
        let result = folder.path().join("row.vtkhdf");
        let options = RunOptions { overwrite: Overwrite::Replace, threads: Some(1), ..RunOptions::new(&result) };
        run(&document, &options, &mut Quiet).expect("a run");
        let file = ResultFile::open(&result).expect("a result");
        let aggregate = file.cell_series("aggregate").expect("a series");
        assert!(aggregate.rows().into_iter().all(|row| row.to_vec() == joined), "{stiffness}: {aggregate}");
        assert!(file.scene_series("largest_aggregate").expect("a series").iter().all(|cells| *cells == together));
        assert!(
            file.scene_series("contact.links")
                .expect("a series")
                .iter()
                .all(|links| (*links > 0.0) == (together > 1.0))
        );
        assert_eq!(file.pairs(0).expect("pairs").len(), 2, "they touch, linked or not");
    }
}

#[test]
fn linked_aggregates_merge_when_driven_together_and_split_where_the_pull_is_largest() {
    // Two linked pairs in a row. What pulls them apart acts on every cell, so that the link in the middle bears twice what the
    // others do.
    let pair = |name: &str, names_of: [&str; 2], direction: i32| {
        let [one, other] = names_of;
        format!(
            r#"[cells.{name}]
mesh = {{ shape = "icosphere", radius = "5 um", level = 1 }}
placement = {{ at = [["{one} um", "0 um", "0 um"], ["{other} um", "0 um", "0 um"]] }}
mechanics = {{ drag = "2 pN s/um", shape_memory = {{ shape_modulus = "50 pN/um" }} }}
loads = [{{ name = "{name}_pull", all = true, direction = [{direction}, 0, 0], force = [["0 s", "-3 pN"], ["6 s", "-3 pN"], ["6.5 s", "0 pN"], ["56.5 s", "500 pN"]] }}]
"#
        )
    };
    let (left, right) = (pair("left", ["-15.9", "-6.2"], -1), pair("right", ["6.2", "15.9"], 1));
    let text = format!(
        "title = \"Merge and split\"\n[run]\nuntil = \"56.5 s\"\nintegrator = {{ max_step = \"0.5 s\" }}\n{left}{right}[contact]\nproximity = \"0.6 um\"\nmodel = \"links\"\nlink = \"5 pN/um\"\n[output]\nevery = \"0.5 s\"\n"
    );
    let document = Document::parse("pairs.toml", &text, Path::new("."), &[]).expect("a good document");
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("pairs.vtkhdf");
    let options = RunOptions { threads: Some(1), ..RunOptions::new(&result) };
    run(&document, &options, &mut Quiet).expect("a run");
    let file = ResultFile::open(&result).expect("a result");
    let events = changes(file.cell_series("aggregate").expect("a series").view());
    println!("{events:?}");
    let first: Vec<(Change, &[u64], &[u64])> =
        events.iter().map(|event| (event.change, &event.before[..], &event.after[..])).take(2).collect();
    assert_eq!(first, [(Change::Merge, &[0, 2][..], &[0][..]), (Change::Split, &[0][..], &[0, 2][..])]);
}

#[test]
fn adhesives_and_the_atoms_of_the_largest_are_recorded() {
    let folder = tempfile::tempdir().expect("a folder");
    for (kappa, together) in [("1 um", true), ("0 um", false)] {
        let model = format!("model = \"virtual_adhesives\"\nkappa = \"{kappa}\"");
        let text = ROW.replace("strength = \"1 Pa\"", &model).replace("\"contact.count\"", "\"contact.adhesives\"");
        let text = text.replacen("[run]\n", "[run]\nintegrator = { step = \"0.05 s\" }\n", 1);
        let document = Document::parse("row.toml", &text, Path::new("."), &[]).expect("a good document");
        let result = folder.path().join("row.vtkhdf");
        let options = RunOptions { overwrite: Overwrite::Replace, threads: Some(1), ..RunOptions::new(&result) };
        run(&document, &options, &mut Quiet).expect("a run");
        let file = ResultFile::open(&result).expect("a result");
        let last = |name: &str| *file.scene_series(name).expect("a series").last().expect("a frame");
        let (adhesives, largest) = (last("contact.adhesives"), last("contact.largest_adhesive"));
        assert_eq!((adhesives > 0.0, largest >= 2.0), (together, together), "{kappa}: {adhesives}, {largest}");
    }
}

#[test]
fn aggregates_and_shares_of_contact_are_recorded() {
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("row.vtkhdf");
    let document = Document::parse("row.toml", ROW, Path::new("."), &[]).unwrap_or_else(|error| {
        panic!("{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
    });
    let options = RunOptions { threads: Some(1), ..RunOptions::new(&result) };
    run(&document, &options, &mut Quiet).expect("a run");
    let file = ResultFile::open(&result).expect("a result");
    let frames = file.frames();
    assert!(frames >= 3);
    // Cells 0, 1, 2 are red, 3 is white and stands between 0 and 1.
    let aggregate = file.cell_series("aggregate").expect("a series");
    assert!(aggregate.rows().into_iter().all(|row| row.to_vec() == [0.0, 0.0, 2.0, 0.0]), "{aggregate}");
    let share = file.cell_series("contact_share").expect("a series");
    assert!(share.rows().into_iter().all(|row| row[2] == 0.0 && row[0] > 0.0 && row[3] > row[0]), "{share}");
    for (series, value) in [("aggregates", 2.0), ("largest_aggregate", 3.0)] {
        assert_eq!(file.scene_series(series).expect("a series"), vec![value; frames], "{series}");
    }
    assert!(file.scene_series("contact.count").expect("a series").iter().all(|count| *count >= 2.0));
    assert_eq!(file.scene_series("contact.sweeps").expect("a series")[0], 0.0, "no step before the first frame");
    let summary = file.summary().expect("measures");
    assert_eq!(summary.iter().find(|measure| measure.name == "together").map(|measure| measure.value), Some(3.0));
    for frame in 0..frames {
        let pairs: Vec<[u32; 2]> =
            file.pairs(frame).unwrap().iter().map(|pair| [pair.cell as u32, pair.other as u32]).collect();
        assert_eq!(pairs, [[0, 3], [1, 3]], "in frame {frame}");
    }
    // Two red cells and a white one touch: by chance a pair is alike with probability 1/3, and none is. There are three
    // ways to deal the types, of which one has no pair alike and two have one.
    let measure = |name: &str| summary.iter().find(|measure| measure.name == name).expect("a measure").value;
    assert!((measure("mixed") + 0.5).abs() < 1e-15 && measure("p") == 1.0);
    assert_eq!(file.scene_series("contact.segregation").expect("a series")[0], measure("mixed"));
    assert_eq!(file.scene_series("contact.heterotypic_share").expect("a series"), vec![1.0; frames]);
    let names = Touch::all(2, 0).into_iter().map(|series| series.name(&["red", "white"], &[])).collect::<Vec<_>>();
    let of_file = file
        .scene_names()
        .into_iter()
        .filter(|name| name.starts_with("contact.") && !CONTACTS.iter().any(|row| row.name == *name));
    assert_eq!(of_file.collect::<Vec<_>>(), names);
    let page = pseudopod::output::describe(&file).expect("a page");
    assert!(page.contains("2 aggregates in the last frame, the largest of 3"), "{page}");
    // A facet of an icosphere has its middle along its normal.
    let cosine = file.cell_series("smallest_cosine").expect("a series");
    assert!(cosine.iter().all(|cosine| *cosine > 0.98 && *cosine <= 1.0), "{cosine}");
}

/// Sheets that lie on each other, 0.1 µm apart, the lowest as high above a floor.
const STACK: &str = r#"
title = "A stack of sheets"
[run]
until = "1 us"
[cells.low]
mesh = { shape = "sheet", size = ["10 um", "8 um"], divisions = [5, 4] }
placement = { at = [["0 um", "0 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", springs = { stiffness = "10 pN/um" } }
[cells.high]
mesh = { shape = "sheet", size = ["10 um", "8 um"], divisions = [5, 4] }
placement = { at = [["0 um", "0 um", "0.1 um"], ["0 um", "0 um", "0.2 um"]] }
mechanics = { drag = "20 pN s/um", springs = { stiffness = "10 pN/um" } }
[[planes]]
name = "floor"
point = ["0 um", "0 um", "-0.1 um"]
normal = [0, 0, 1]
[contact]
proximity = "0.15 um"
[measure.none]
kind = "value"
series = "contact.area.low.low"
[measure.pair]
kind = "value"
series = "contact.area.low.high"
[measure.floor]
kind = "value"
series = "contact.area.low.floor"
[[plot]]
name = "areas"
kind = "series"
y = ["contact.area.low.high", "contact.area.high.high"]
"#;

#[test]
fn sheets_that_lie_on_each_other_touch_with_all_their_area() {
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("stack.vtkhdf");
    let document = Document::parse("stack.toml", STACK, Path::new("."), &[]).unwrap_or_else(|error| {
        panic!("{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
    });
    let options = RunOptions { threads: Some(1), ..RunOptions::new(&result) };
    run(&document, &options, &mut Quiet).expect("a run");
    let file = ResultFile::open(&result).expect("a result");
    let area = |name: &str| file.scene_series(&format!("contact.area.{name}")).expect("a series")[0];
    // 80 µm² each. A face has the nearest before it: the lower one of the lowest the floor, all others that of the next sheet.
    for (name, wanted) in
        [("low.floor", 80.0), ("low.high", 80.0), ("high.high", 80.0), ("low.low", 0.0), ("high.floor", 0.0)]
    {
        // Round-off of sums over parts of facets.
        assert!((area(name) - wanted).abs() < 1e-11, "{name}: {} µm² in place of {wanted}", area(name));
    }
    let pairs: Vec<[u32; 2]> =
        file.pairs(0).unwrap().iter().map(|pair| [pair.cell as u32, pair.other as u32]).collect();
    assert_eq!(pairs, [[0, 1], [1, 2]]);
    let values = |name: &str| file.summary().unwrap().into_iter().find(|measure| measure.name == name).unwrap().value;
    assert!(values("none") == 0.0 && values("pair") > 79.9 && values("floor") > 79.9);
    let chart = pseudopod::picture::plots::chart_of(&file, &document, &document.experiment.plot[0]).expect("a chart");
    assert_eq!((chart.series.len(), chart.y.label.as_str()), (2, "µm²"));
}

#[test]
fn a_run_without_contacts_records_cells_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("row.vtkhdf");
    let (before, rest) = ROW.split_once("[contact]").expect("the table");
    let text =
        format!("{before}{}", rest.split_once("[output]").map(|(_, rest)| format!("[output]{rest}")).expect("output"));
    let text = text.split_once("[measure.together]").expect("measures").0;
    let document = Document::parse("row.toml", text, Path::new("."), &[]).expect("a good document");
    let options = RunOptions { threads: Some(1), ..RunOptions::new(&result) };
    run(&document, &options, &mut Quiet).expect("a run");
    let file = ResultFile::open(&result).expect("a result");
    let aggregate = file.cell_series("aggregate").expect("a series");
    assert!(aggregate.rows().into_iter().all(|row| row.to_vec() == [0.0, 1.0, 2.0, 3.0]));
    assert!(file.cell_series("contact_share").expect("a series").iter().all(|share| *share == 0.0));
    assert!(file.scene_series("contact.count").is_err());
}

#[test]
fn chemistry_feels_other_cells_the_same_with_every_scratch() {
    let eml = r#"<eml name="touch" level="cell"><input id="share" default="0"/><variable id="sum" initial="0" rate="share"/>
        <link from="cell.contact_share" to="system.share"/></eml>"#;
    let before = ROW.split_once("[output]").expect("the output").0;
    // Nothing moves, so that all stay on the floor.
    let at_rest = before.replace("[contact]", "[contact]\nmodel = \"adhesives\"");
    let with_system = at_rest.replace("mechanics =", "chemistry = [\"touch\"]\nmechanics =");
    let text = format!("{with_system}[chemistry.touch]\ndocument = \"touch.eml\"\n");
    let beside = BTreeMap::from([("touch.eml".to_owned(), eml.to_owned())]);
    let document = Document::parse_beside("row.toml", &text, Path::new("."), &[], beside).expect("a good document");
    let Compiled { model, mut state, .. } = compile(&document).expect("a good experiment");
    let mut ws = Workspace::new(&model);
    begin_chemistry(&model, &mut state, &mut ws).expect("a start");
    let share = |state: &pseudopod::sim::State| -> Vec<f64> {
        let (reactor, population) = (&model.chemistry.reactors[0], &state.chemistry.populations[0]);
        let (quantity, ..) = reactor.recorded.iter().find(|(_, id, _)| id == "share").expect("the input");
        let mut values = vec![0.0; population.cells()];
        population.observe(&reactor.program, *quantity, state.time, &mut values);
        values
    };
    let at_start = share(&state);
    // In the middle, at the ends of the row, and alone.
    assert!(at_start[3] > at_start[0] && at_start[0] > 0.0 && at_start[2] == 0.0, "{at_start:?}");
    let mut other = state.clone();
    for _ in 0..12 {
        step(&model, &mut state, &mut ws).expect("a step");
        // What goes on from a checkpoint has a new workspace.
        step(&model, &mut other, &mut Workspace::new(&model)).expect("a step");
        assert!(share(&state) == share(&other) && state == other, "at {} s", state.time);
    }
}

#[test]
fn links_read_the_share_in_contact_that_is_recorded_and_planes_have_a_share_of_their_own() {
    let eml = r#"<eml name="touch" level="cell"><input id="share" default="0"/><input id="ground" default="0"/>
        <variable id="sum" initial="0" rate="share + ground"/>
        <link from="cell.contact_share" to="system.share"/><link from="cell.plane_share" to="system.ground"/></eml>"#;
    let planes = "[[planes]]\nname = \"floor\"\npoint = [0, 0, \"15 um\"]\nnormal = [0, 0, 1]\n";
    let before = ROW.split_once("[output]").expect("the output").0;
    // Nothing moves, so that all stay on the floor.
    let at_rest = before.replace("[contact]", "[contact]\nmodel = \"adhesives\"");
    let with_system = at_rest.replace("mechanics =", "chemistry = [\"touch\"]\nmechanics =");
    let text = format!("{with_system}{planes}[chemistry.touch]\ndocument = \"touch.eml\"\n");
    let beside = BTreeMap::from([("touch.eml".to_owned(), eml.to_owned())]);
    let document = Document::parse_beside("row.toml", &text, Path::new("."), &[], beside).expect("a good document");
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("row.vtkhdf");
    let options = RunOptions { threads: Some(1), ..RunOptions::new(&result) };
    run(&document, &options, &mut Quiet).expect("a run");
    let file = ResultFile::open(&result).expect("a result");
    let series = |name: &str| file.cell_series(name).expect("a series");
    let (recorded, read, ground) = (series("contact_share"), series("touch.share"), series("touch.ground"));
    assert!(recorded.iter().any(|share| *share > 0.0) && recorded == read, "{recorded} {read}");
    assert!(ground.iter().all(|share| *share > 0.0), "all stand on the floor: {ground}");
}

/// Two cells drawn to one point.
const DRAWN: &str = r#"
title = "Drawn together"
[run]
until = "20 s"
[cells.red]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { grid = [2, 1, 1], spacing = "11 um" }
number = 2
mechanics = { drag = "20 pN s/um", shape_memory = { stiffness = "1 pN/um" } }
motility = { attraction = { to = [0, 0, 0], stiffness = "0.2 pN/um" } }
[contact]
"#;

#[test]
fn explicit_steps_that_nobody_names_are_as_short_as_contacts_need() {
    let folder = tempfile::tempdir().expect("a folder");
    let end = |method: &str| {
        let sets = [format!("run.integrator.method={method}")];
        let document = Document::parse("drawn.toml", DRAWN, Path::new("."), &sets).expect("a good document");
        let result = folder.path().join(format!("{method}.vtkhdf"));
        let options = RunOptions { threads: Some(1), ..RunOptions::new(&result) };
        let outcome = run(&document, &options, &mut Quiet).expect("a run that comes to its end");
        let file = ResultFile::open(&result).expect("a result");
        let last = |axis: &str| {
            let series = file.cell_series(&format!("position_{axis}")).expect("a series");
            series[[file.frames() - 1, 1]] - series[[file.frames() - 1, 0]]
        };
        let [x, y, z] = ["x", "y", "z"].map(last);
        (outcome, x.hypot(y).hypot(z))
    };
    let ((explicit, one), (_, other)) = (end("explicit"), end("implicit"));
    assert!(explicit.limited > 0, "the stable step is too long for contacts: {explicit:?}");
    // Nothing keeps the pair from turning; how near the cells come is the same by both methods, to 1 % of a diameter.
    assert!((one - other).abs() < 0.1, "{one} {other}");
}

/// Two cells that loads press together; closed surfaces have no elastic force as a whole.
const PRESSED: &str = r#"
title = "Pressed"
[run]
until = "20 s"
[cells.left]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["-5.1 um", "0 um", "0 um"]] }
mechanics = { drag = "2 pN s/um", shape_memory = { shape_modulus = "50 pN/um" } }
loads = [{ name = "push", all = true, direction = [1, 0, 0], force = "8 pN" }]
[cells.right]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["5.1 um", "0 um", "0 um"]] }
mechanics = { drag = "2 pN s/um", shape_memory = { shape_modulus = "50 pN/um" } }
loads = [{ name = "push_back", all = true, direction = [-1, 0, 0], force = "8 pN" }]
[contact]
model = "adhesives"
strength = "1 Pa"
[output]
every = "1 s"
forces = true
"#;

#[test]
fn recorded_forces_have_those_of_contacts_among_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("pressed.vtkhdf");
    let document = Document::parse("pressed.toml", PRESSED, Path::new("."), &[]).expect("a good document");
    let options = RunOptions { threads: Some(1), ..RunOptions::new(&result) };
    run(&document, &options, &mut Quiet).expect("a run");
    let file = ResultFile::open(&result).expect("a result");
    let on_left = |frame: usize| {
        let forces = file.forces(frame).expect("a frame").expect("forces were asked for");
        forces[..42].iter().fold(Vec3::zeros(), |sum, force| sum + Vec3::from(*force))
    };
    // Before they meet the load is all there is. Then the sum of all forces is what drag takes, 2 pN s/µm times the
    // velocity, which is the mean over the last step: between that and the end of the step the balance shifts by thousandths
    // of a pN, and by more where a contact catches just then. While the pair is pressed it moves slowly, so that little is left
    // of 8 pN; in the end it rolls off the poles.
    assert!((on_left(0).x - 8.0).abs() < 1e-4, "{}", on_left(0));
    let shift = |frame: usize| {
        let velocity = |axis: &str| file.cell_series(&format!("velocity_{axis}")).expect("a series")[[frame, 0]];
        let drag = 2.0 * Vec3::from(["x", "y", "z"].map(velocity));
        (drag.norm() < 3.0).then(|| (on_left(frame) - drag).norm())
    };
    let mut shifts: Vec<f64> = (4..file.frames()).filter_map(shift).collect();
    shifts.sort_unstable_by(f64::total_cmp);
    // In all frames but one: that in which the pair slips off, when the velocity is the mean over a step with and without a load.
    let (median, largest_but_one) = (shifts[shifts.len() / 2], shifts[shifts.len() - 2]);
    assert!(shifts.len() > 5 && median < 0.01 && largest_but_one < 0.2, "pN: {shifts:?}");
}
