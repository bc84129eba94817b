//! Fibres that a program makes and removes draw atoms together by their law, and nothing else changes.

use crate::pseudopods::pushing_and_drawn_by;
use pseudopod::Vec3;
use pseudopod::simulation::{CellId, EXAMPLE, FibreFault, NewCell, Simulation, SimulationError};

/// Balls without a volume of their own, whose only elastic part is a spring of 6 pN/µm between the atoms 0 and 20.
fn sprung(cells: usize, step: &str, more: &str) -> Simulation {
    let text = format!(
        "title = \"sprung\"\nseed = 1\n[run]\nuntil = \"60 s\"\nintegrator = {{ {step} }}\n[cells.ball]\nnumber = {cells}\n\
         mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nfibre_budget = 3\n\
         mechanics = {{ drag = \"200 pN s/um\", volume = {{ rule = \"free\" }} }}\n\
         links = [{{ pairs = [[0, 20]], stiffness = \"6 pN/um\" }}]\n{more}"
    );
    Simulation::from_text("sprung.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn positions(simulation: &Simulation, cell: CellId) -> Vec<Vec3> {
    let mut positions = vec![[0.0; 3]; 42];
    simulation.cell_positions_into(cell, &mut positions).unwrap();
    positions.into_iter().map(Vec3::from).collect()
}

fn length(simulation: &Simulation, cell: CellId, [a, b]: [usize; 2]) -> f64 {
    let positions = positions(simulation, cell);
    (positions[a] - positions[b]).norm()
}

#[test]
fn ends_come_together_as_drag_lets_them_and_stay_where_they_were_left() {
    for cells in [1, 11] {
        let mut simulation = sprung(cells, "max_step = \"0.25 s\", tolerance = 1e-5", "");
        let last = simulation.cells().last().unwrap();
        let (ends, start) = ([3, 7], length(&simulation, last, [3, 7]));
        let middle = |simulation: &Simulation| positions(simulation, last).iter().sum::<Vec3>() / 42.0;
        let before = middle(&simulation);
        let fibre = simulation.add_fibre(last, ends.map(|atom| atom as u32), 2.0).unwrap();
        simulation.run_until(2.0).unwrap();
        // d' = −2 K d / ζ.
        let drag = 200.0 / 42.0;
        let exact = (-2.0 * 2.0 / drag * 2.0f64).exp();
        let close = length(&simulation, last, ends) / start;
        assert!((close - exact).abs() < 1e-4, "{cells} cells: {close} and {exact}");
        let [tension, energy] =
            ["fibre_tension", "fibre_energy"].map(|name| *simulation.series(name).unwrap().last().unwrap());
        let now = close * start;
        assert!((tension - 2.0 * now).abs() < 1e-12 * tension && (energy - now * now).abs() < 1e-12 * energy);
        simulation.activate_fibre(fibre, 0.5).unwrap();
        simulation.run_until(4.0).unwrap();
        let half = length(&simulation, last, ends) / start;
        assert!((half - exact.powf(1.5)).abs() < 1e-4, "{half}");
        simulation.remove_fibre(fibre).unwrap();
        simulation.run_until(6.0).unwrap();
        // Nothing acts between these atoms any more.
        assert!((length(&simulation, last, ends) / start - half).abs() < 1e-12);
        assert!((middle(&simulation) - before).norm() < 1e-12, "a cell does not move itself");
    }
}

#[test]
fn a_fibre_and_a_spring_share_a_length_as_their_stiffnesses_say() {
    let mut simulation = sprung(1, "max_step = \"0.5 s\"", "");
    let cell = simulation.cells().next().unwrap();
    let rest = length(&simulation, cell, [0, 20]);
    let fibre = simulation.add_fibre(cell, [20, 0], 3.0).unwrap();
    simulation.run_until(40.0).unwrap();
    // 6 (L − L₀) + 3 L = 0.
    assert!((length(&simulation, cell, [0, 20]) - rest * 6.0 / 9.0).abs() < 1e-6);
    simulation.remove_fibre(fibre).unwrap();
    simulation.run_until(80.0).unwrap();
    assert!((length(&simulation, cell, [0, 20]) - rest).abs() < 1e-6, "the spring has its length again");
}

#[test]
fn fibres_that_cannot_be_are_refused_with_their_reason() {
    let mut simulation = sprung(2, "max_step = \"0.5 s\"", "");
    let cell = simulation.cells().nth(1).unwrap();
    let refused = |simulation: &mut Simulation, atoms, stiffness| {
        let error = simulation.add_fibre(cell, atoms, stiffness).unwrap_err();
        let help = error.help().unwrap_or_default();
        format!("{error}; {help}")
    };
    let said = [
        (
            ([0, 42], 1.0),
            "cell 1 has no atom 42: its atoms are 0 to 41; take atoms of the cell itself, numbered from 0",
        ),
        (([5, 5], 1.0), "both ends of a fibre of cell 1 are its atom 5; take two atoms"),
        (([0, 1], 0.0), "the stiffness of a fibre of cell 1 cannot be 0: a number above 0, in pN/um, was expected; "),
        (
            ([0, 1], f64::NAN),
            "the stiffness of a fibre of cell 1 cannot be NaN: a number above 0, in pN/um, was expected; ",
        ),
        // ζ/(2 dt) = 200/42/2/0.5.
        (
            ([0, 1], 5.0),
            "fibres at atom 0 of cell 1 would have 5 pN/um together, and steps bear 4.7619; let it be softer, take another atom, or let steps be shorter (run.integrator.max_step)",
        ),
    ];
    for ((atoms, stiffness), expected) in said {
        assert_eq!(refused(&mut simulation, atoms, stiffness), expected);
    }
    let first = simulation.add_fibre(cell, [0, 1], 3.0).unwrap();
    assert!(
        refused(&mut simulation, [1, 2], 2.0).starts_with("fibres at atom 1 of cell 1 would have 5 pN/um together")
    );
    simulation.add_fibre(cell, [2, 3], 1.0).unwrap();
    let third = simulation.add_fibre(cell, [4, 5], 1.0).unwrap();
    assert_eq!(third.number(), 2);
    assert!(refused(&mut simulation, [6, 7], 1.0).starts_with("cell 1 has 3 fibres, all that its budget allows"));
    let other = simulation.cells().next().unwrap();
    assert!(simulation.fibres(other).unwrap().is_empty());
    assert!(matches!(simulation.activate_fibre(first, 1.5).unwrap_err(), SimulationError::Value { value: 1.5, .. }));
    simulation.remove_fibre(first).unwrap();
    let error = simulation.remove_fibre(first).unwrap_err();
    assert!(matches!(error, SimulationError::Fibre(FibreFault::NoSuchFibre { number: 0, .. })), "{error}");
    assert_eq!(simulation.add_fibre(cell, [0, 1], 1.0).unwrap().number(), 3, "a number is never given again");
    let mut without = Simulation::from_text("example", EXAMPLE).unwrap();
    let squeezed = without.cells().nth(1).unwrap();
    let error = without.add_fibre(squeezed, [0, 1], 1.0).unwrap_err();
    assert_eq!(error.to_string(), "cells of type `squeezed` have no fibres that are made at run time");
    simulation.remove_cells(&[cell]).unwrap();
    assert!(matches!(simulation.add_fibre(cell, [0, 1], 1.0), Err(SimulationError::NoSuchCell { .. })));
}

#[test]
fn fibres_stay_with_their_cells_when_others_come_and_go() {
    let mut simulation = sprung(3, "max_step = \"0.5 s\"", "");
    let cells: Vec<CellId> = simulation.cells().collect();
    for (number, cell) in cells.iter().enumerate() {
        simulation.add_fibre(*cell, [number as u32, 30], 1.0).unwrap();
    }
    let added = simulation.add_cells("ball", &[NewCell::at([0.0, 90.0, 0.0])]).unwrap()[0];
    simulation.remove_cells(&cells[..1]).unwrap();
    for (number, cell) in cells.iter().enumerate().skip(1) {
        let fibres = simulation.fibres(*cell).unwrap();
        assert_eq!((fibres.len(), fibres[0].atoms), (1, [number as u32, 30]));
    }
    assert!(simulation.fibres(added).unwrap().is_empty());
    simulation.add_fibre(added, [0, 1], 1.0).unwrap();
    simulation.run_until(1.0).unwrap();
    assert_eq!(simulation.series("fibre_count").unwrap(), [1.0; 3]);
}

/// Cells that crawl, drawn together by fibres of their own, on so many threads.
fn crawling(threads: usize) -> Simulation {
    let text = "title = \"Cells crawl\"\nseed = 3\n[run]\nuntil = \"60 s\"\nintegrator = { max_step = \"0.5 s\" }\n[[planes]]\nname = \"glass\"\n\
         point = [\"0 um\", \"0 um\", \"-5.05 um\"]\nnormal = [0, 0, 1]\n[cells.cell]\nnumber = 9\n\
         mesh = { shape = \"icosphere\", radius = \"5 um\", level = 1 }\nplacement = { grid = [3, 3, 1], spacing = \"14 um\" }\n\
         [cells.cell.mechanics]\ndrag = \"500 pN s/um\"\n\
         membrane = { law = \"skalak\", shear = \"5 pN/um\", area = \"10 pN/um\", bending = \"2 pN um\", tension = \"10 pN/um\" }\n\
         [cells.cell.pseudopods]\npressure = \"15 Pa\"\nfibres = { number = 5, stiffness = \"1 pN/um\" }\npause = \"1 s\"\nprotrusion = \"4 s\"\nretraction = \"3 s\"\n\
         [contact]\nstrength = \"0 Pa\"\n[[contact.between]]\ntypes = [\"cell\", \"glass\"]\nenergy = \"10 pN/um\"\nrange = \"1.5 um\"\nshear_strength = \"100 Pa\"\n";
    Simulation::builder().threads(threads).text("crawling.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn cells_with_fibres_go_the_same_way_on_any_threads_and_after_a_checkpoint() {
    let (mut one, mut two) = (crawling(1), crawling(2));
    one.run_until(9.0).unwrap();
    two.run_until(9.0).unwrap();
    assert_eq!(one.checkpoint(), two.checkpoint());
    let mut most: f64 = 0.0;
    let saved = loop {
        let count = one.series("fibre_count").unwrap().iter().copied().fold(0.0, f64::max);
        most = most.max(count);
        if count > 0.0 {
            break one.checkpoint();
        }
        one.step().unwrap();
    };
    assert_eq!(most, 5.0);
    let mut other = crawling(2);
    other.restore(&saved).unwrap();
    one.run_until(25.0).unwrap();
    other.run_until(25.0).unwrap();
    assert_eq!(one.checkpoint(), other.checkpoint());
}

#[test]
fn a_cell_that_its_own_fibres_draw_together_advances_only_where_it_grips() {
    let went = |grip: &str| {
        let contact = "[contact]\nstrength = \"0 Pa\"\n[[contact.between]]\ntypes = [\"cell\", \"glass\"]\nenergy = \"10 pN/um\"\nrange = \"1.5 um\"";
        let fibres = "fibres = { number = 5, stiffness = \"1.2 pN/um\" }";
        let mut simulation = pushing_and_drawn_by(fibres, &format!("{contact}\nshear_strength = \"{grip} Pa\"\n"));
        let cell = simulation.cells().next().unwrap();
        let middle = |simulation: &Simulation| positions(simulation, cell).iter().sum::<Vec3>() / 42.0;
        let start = middle(&simulation);
        simulation.run_until(90.0).unwrap();
        let went = middle(&simulation) - start;
        went.x.hypot(went.y)
    };
    let [without, with] = ["0", "100"].map(went);
    assert!(without < 1e-3 * 5.0, "{without} um in ten cycles without a grip");
    assert!(with > 1.0, "{with} um in ten cycles with one");
}
