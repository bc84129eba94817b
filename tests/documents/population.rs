//! Cells that come and go, as a document says.

use pseudopod::sim::{Change, Removal};
use pseudopod::simulation::Simulation;

const DISH: &str = r#"
title = "A second seeding and a washout"
seed = 7
[run]
until = "12 s"
[cells.white]
number = 6
mesh = { shape = "icosphere", radius = "5 um", level = 0 }
placement = { random_from = ["-40 um", "-40 um", "0 um"], random_to = ["40 um", "40 um", "0 um"] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
motility = { brownian = { speed = "1 um/s", persistence = "2 s" } }
[[cells.white.removed]]
time = "8 s"
share = 0.5
[[cells.white.added]]
time = "4 s"
number = 10
placement = { random_from = ["-40 um", "-40 um", "0 um"], random_to = ["40 um", "40 um", "0 um"] }
[cells.red]
number = 0
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
[[cells.red.added]]
time = "2 s"
placement = { at = [["0 um", "0 um", "20 um"], ["0 um", "0 um", "-20 um"]] }
[[cells.red.removed]]
time = "10 s"
[contact]
"#;

fn dish() -> Simulation {
    Simulation::from_text("dish.toml", DISH).unwrap_or_else(|error| panic!("{error}"))
}

/// Ids of the cells of each type.
fn ids(simulation: &Simulation) -> Vec<Vec<u64>> {
    simulation.state().kinds.iter().map(|now| now.ids.clone()).collect()
}

#[test]
fn changes_stand_in_the_order_of_time() {
    let model = dish().into_parts().0;
    let told: Vec<(f64, usize)> = model.changes.iter().map(|change| (change.time, change.kind)).collect();
    assert_eq!(told, [(2.0, 1), (4.0, 0), (8.0, 0), (10.0, 1)]);
    assert!(matches!(&model.changes[0].change, Change::Add(centres) if centres.len() == 2));
    assert!(matches!(model.changes[1].change, Change::Seed(10, _)));
    assert_eq!(model.changes[2].change, Change::Remove(Removal::Share(0.5)));
    assert_eq!(model.changes[3].change, Change::Remove(Removal::All));
}

#[test]
fn cells_come_clear_of_others_and_go_at_their_times_and_no_id_is_used_twice() {
    let mut simulation = dish();
    let mut counts = Vec::new();
    for time in [1.0, 3.0, 5.0, 9.0, 12.0] {
        simulation.run_until(time).unwrap_or_else(|error| panic!("{error}"));
        simulation.check_contacts().unwrap_or_else(|error| panic!("{error}"));
        counts.push(ids(&simulation).iter().map(Vec::len).collect::<Vec<_>>());
    }
    assert_eq!(counts, [[6, 0], [6, 2], [16, 2], [8, 2], [8, 0]]);
    // Six at the start, then two, then ten.
    assert_eq!(simulation.state().next_id, 18);
    let mut seen: Vec<u64> = ids(&simulation).concat();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), 8);
}

#[test]
fn the_same_cells_come_and_go_for_any_threads_and_after_a_checkpoint() {
    let end = |threads: usize, stop: Option<f64>| -> Vec<u8> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut simulation = dish();
            if let Some(stop) = stop {
                simulation.run_until(stop).unwrap_or_else(|error| panic!("{error}"));
                let kept = simulation.checkpoint();
                simulation = dish();
                simulation.restore(&kept).unwrap_or_else(|error| panic!("{error}"));
            }
            simulation.run_until(12.0).unwrap_or_else(|error| panic!("{error}"));
            simulation.checkpoint()
        })
    };
    let whole = end(1, None);
    assert!(whole == end(3, None), "threads");
    // A stop is a step of its own: two that stop at one instant are alike.
    assert!(end(1, Some(4.0)) == end(2, Some(4.0)), "threads after a stop where cells come");
    assert!(whole == end(1, Some(4.0)), "a stop where a step ends anyway changes nothing");
}

#[test]
fn a_seeding_without_space_names_the_type_and_how_many_fitted() {
    let crowded = DISH.replacen("number = 10\n", "number = 400\n", 1);
    let mut simulation = Simulation::from_text("dish.toml", &crowded).unwrap_or_else(|error| panic!("{error}"));
    let before = simulation.run_until(12.0).expect_err("400 cells do not fit").to_string();
    assert!(before.contains("no space for all cells that come to type `white`"), "{before}");
    assert!((simulation.time() - 4.0).abs() < 1e-9, "the state is the one before: {}", simulation.time());
    assert_eq!(ids(&simulation)[0].len(), 6);
}
