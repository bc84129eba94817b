//! Forces that a program exerts: cells move by them as drag says, the step counts them as it does loads, they are state, and what cannot be
//! is refused.

use pseudopod::simulation::{CellId, EXAMPLE, NewCell, SimulationError};
use pseudopod::{Simulation, Vec3};

/// What a cell of [`EXAMPLE`] has, pN s/um, and its atoms.
const DRAG: f64 = 20.0;
const ATOMS: usize = 42;

/// Two cells apart in a scene in which cells touch, whose steps are long beside what the shape relaxes in.
const APART: &str = r#"
title = "Two cells apart"
[run]
until = "100 s"
integrator = { step = "0.5 s" }
[output]
every = "10 s"
tractions = true
[contact]
[cells.white]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["-10 um", "0 um", "0 um"], ["10 um", "0 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
"#;

fn of(text: &str) -> Simulation {
    Simulation::builder().threads(1).text("forces.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

/// The mean of the atoms of a cell, um.
fn centre(simulation: &Simulation, cell: CellId) -> Vec3 {
    let mut positions = vec![[0.0; 3]; simulation.type_of(cell).unwrap().atom_count()];
    simulation.cell_positions_into(cell, &mut positions).unwrap();
    positions.iter().map(|x| Vec3::from(*x)).sum::<Vec3>() / positions.len() as f64
}

fn bytes(simulation: &Simulation) -> Vec<u8> {
    postcard::to_stdvec(simulation.state()).unwrap()
}

/// Forces of all directions and sizes, which neither a cell's symmetry nor its shape explains.
fn uneven() -> Vec<[f64; 3]> {
    (0..ATOMS).map(|atom| [0, 1, 2].map(|axis| f64::from((7 * atom as u32 + 5 * axis) % 11) / 11.0 - 0.3)).collect()
}

#[test]
fn a_free_cell_moves_at_the_force_over_its_drag_whatever_the_scheme() {
    let force = Vec3::new(8.0, -3.0, 1.5);
    for integrator in [
        "step = \"0.5 s\"",
        "step = \"0.5 s\", order = 1",
        "max_step = \"2 s\"",
        "method = \"explicit\", step = \"0.003 s\"",
    ] {
        let text = APART.replace("step = \"0.5 s\"", integrator);
        let mut simulation = of(&text);
        let [pushed, other] = [0, 1].map(CellId::new);
        let starts = [pushed, other].map(|cell| centre(&simulation, cell));
        simulation.set_force(pushed, force.into()).unwrap();
        simulation.run_until(4.0).unwrap();
        let moved = centre(&simulation, pushed) - starts[0];
        assert!((moved - force / DRAG * 4.0).norm() < 1e-9, "{integrator}: {moved}");
        assert!((centre(&simulation, other) - starts[1]).norm() < 1e-12, "{integrator}: nothing acts on the other");
        // It does not turn and keeps its shape: all atoms move alike.
        assert!(simulation.series("energy").unwrap()[0] < 1e-9, "{integrator}");
    }
}

#[test]
fn uneven_forces_move_the_mean_of_the_atoms_by_their_sum_and_deform() {
    let (mut simulation, cell, forces) = (of(APART), CellId::new(0), uneven());
    let (start, sum) = (centre(&simulation, cell), forces.iter().map(|force| Vec3::from(*force)).sum::<Vec3>());
    let volume = simulation.series("volume").unwrap()[0];
    simulation.set_atom_forces(cell, &forces).unwrap();
    simulation.run_until(5.0).unwrap();
    let moved = centre(&simulation, cell) - start;
    assert!((moved - 5.0 * sum / DRAG).norm() < 1e-9 * moved.norm().max(1.0), "{moved} for {sum}");
    assert!(simulation.series("energy").unwrap()[0] > 1e-3, "it is deformed");
    assert!((simulation.series("volume").unwrap()[0] / volume - 1.0).abs() < 1e-9);
    // What acts from outside is what the program exerts, and drag answers it.
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let told = |series: &str| simulation.series(&format!("{series}_{name}")).unwrap()[0];
        assert!((told("outer_force") - sum[axis]).abs() < 1e-9, "{name}");
        assert!((told("drag") + sum[axis]).abs() < 1e-9, "{name}");
    }
    // Without them it relaxes where it is.
    simulation.clear_forces();
    let (stopped, stored) = (centre(&simulation, cell), simulation.series("energy").unwrap()[0]);
    simulation.run_until(30.0).unwrap();
    assert!((centre(&simulation, cell) - stopped).norm() < 1e-9);
    assert!(simulation.series("energy").unwrap()[0] < 0.1 * stored);
}

#[test]
fn work_that_a_program_does_is_no_gain_that_shortens_steps() {
    let mut simulation = of(APART);
    let cell = CellId::new(0);
    let pull: Vec<[f64; 3]> = simulation.type_of(cell).unwrap().rest_positions().map(|x| x.map(|x| 0.3 * x)).collect();
    simulation.set_atom_forces(cell, &pull.iter().map(|[x, _, _]| [*x, 0.0, 0.0]).collect::<Vec<_>>()).unwrap();
    let before = simulation.series("energy").unwrap()[0];
    for _ in 0..6 {
        let made = simulation.step().unwrap();
        assert_eq!((made.dt, made.refused), (0.5, 0));
    }
    assert!(simulation.series("energy").unwrap()[0] > before + 1.0, "it was stretched");
}

#[test]
fn what_is_exerted_is_state_and_nothing_is_none() {
    let (mut simulation, plain) = (of(APART), of(APART));
    let [one, other] = [0, 1].map(CellId::new);
    simulation.set_atom_forces(one, &uneven()).unwrap();
    simulation.set_force(other, [0.0, 2.0, 0.0]).unwrap();
    simulation.run_until(2.0).unwrap();
    let saved = simulation.checkpoint();
    simulation.run_until(6.0).unwrap();
    for threads in [1, 2] {
        let mut again = of(APART);
        again.set_threads(threads).unwrap();
        again.restore(&saved).unwrap();
        again.run_until(6.0).unwrap();
        assert!(bytes(&again) == bytes(&simulation), "{threads} threads");
    }
    // Forces that were ended leave no trace in the state.
    let mut ended = of(APART);
    ended.set_force(one, [1.0, 0.0, 0.0]).unwrap();
    ended.set_force(one, [0.0; 3]).unwrap();
    assert!(bytes(&ended) == bytes(&plain));
    ended.set_atom_forces(other, &uneven()).unwrap();
    assert!(bytes(&ended) != bytes(&plain));
    ended.clear_forces();
    assert!(bytes(&ended) == bytes(&plain));
}

#[test]
fn forces_stay_with_their_cells_when_others_come_and_go() {
    let mut simulation = of(EXAMPLE);
    let [pulled, squeezed] = [0, 1].map(CellId::new);
    simulation.set_force(squeezed, [0.0, 0.0, 10.0]).unwrap();
    // Cells of the first type stand before it.
    let added =
        simulation.add_cells("pulled", &[NewCell::at([0.0, 40.0, 0.0]), NewCell::at([0.0, -40.0, 0.0])]).unwrap();
    simulation.set_force(added[1], [0.0, -6.0, 0.0]).unwrap();
    simulation.remove_cells(&[pulled, added[0]]).unwrap();
    let starts = [squeezed, added[1]].map(|cell| centre(&simulation, cell));
    simulation.run_until(2.0).unwrap();
    let moved = centre(&simulation, squeezed) - starts[0];
    assert!((moved - Vec3::new(0.0, 0.0, 1.0)).norm() < 1e-9, "{moved}");
    let moved = centre(&simulation, added[1]) - starts[1];
    assert!((moved.y + 0.6).abs() < 1e-9, "{moved}");
    // With the last one that has any they are gone.
    simulation.remove_cells(&[squeezed, added[1]]).unwrap();
    simulation.step().unwrap();
}

#[test]
fn forces_that_cannot_be_are_refused_and_change_nothing() {
    let mut simulation = of(EXAMPLE);
    let before = bytes(&simulation);
    let cell = CellId::new(1);
    let mut forces = vec![[0.0; 3]; ATOMS];
    let short = simulation.set_atom_forces(cell, &forces[1..]).unwrap_err();
    assert_eq!(short.to_string(), "forces on 41 atoms of cell 1 were given, which has 42");
    let help = "give one for each atom, in the order of positions, or one for the whole cell by `set_force`";
    assert_eq!(short.help().unwrap(), help);
    forces[7][2] = f64::NAN;
    let none = simulation.set_atom_forces(cell, &forces).unwrap_err();
    assert_eq!(none.to_string(), "the force on cell 1 cannot be NaN: a finite number, in pN, was expected");
    let endless = simulation.set_force(cell, [0.0, f64::INFINITY, 0.0]).unwrap_err();
    assert!(matches!(endless, SimulationError::Value { value: f64::INFINITY, .. }), "{endless}");
    let nobody = simulation.set_force(CellId::new(9), [1.0; 3]).unwrap_err();
    assert_eq!(nobody.to_string(), "there is no cell 9");
    assert!(bytes(&simulation) == before);
    // More than numbers bear is told by the step, and leaves the state.
    simulation.set_force(cell, [1e300; 3]).unwrap();
    let before = bytes(&simulation);
    assert!(matches!(simulation.step(), Err(SimulationError::Trouble(_))));
    assert!(bytes(&simulation) == before);
}
