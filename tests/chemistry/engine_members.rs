//! Cells of a population come and go between windows, and the others do not notice.

use crate::ode_problems::{self, martiel_goldbeter, system, van_der_pol_pair};
use pseudopod::equations::program::Program;
use pseudopod::equations::tree::Role;
use pseudopod::ode::{LANES, Method, Population, PopulationScratch, Tolerances};

/// Everything of a cell that decides about its future.
fn cell(population: &Population, program: &Program, cell: usize) -> Vec<u64> {
    let states = (0..program.size()).map(|v| population.state(cell, v));
    let open = (0..program.open.len()).map(|v| population.open_value(cell, v));
    states.chain(open).chain([population.next_step(cell)]).map(f64::to_bits).collect()
}

/// A population in which every cell starts elsewhere; `names[cell]` says where.
fn crowd(program: &Program, names: &[usize], method: Method) -> Population {
    let mut population = Population::new(program, names.len(), method);
    for (cell, &name) in names.iter().enumerate() {
        (0..program.size()).for_each(|v| population.set_state(cell, v, start(program, name)[v]));
    }
    population
}

fn start(program: &Program, name: usize) -> Vec<f64> {
    (0..program.size()).map(|v| 1.0 + 0.5 * (0.37 * name as f64 + v as f64).sin()).collect()
}

#[test]
fn cells_that_come_and_go_leave_the_bits_of_the_others() {
    for (system, method) in [
        (van_der_pol_pair(5.0), Method::Rk45),
        (van_der_pol_pair(5.0), Method::Rk65),
        (martiel_goldbeter(), Method::Rosenbrock),
        (van_der_pol_pair(5.0), Method::Rk4 { step: 0.01 }),
    ] {
        let program = Program::new(&system).expect("no circles");
        let mut names: Vec<usize> = (0..LANES + 3).collect();
        let mut still = crowd(&program, &names, method);
        let mut moving = still.clone();
        let (mut one, mut other) = (PopulationScratch::default(), PopulationScratch::default());
        for window in 0..12_usize {
            let (from, until) = (0.1 * window as f64, 0.1 * (window + 1) as f64);
            still.advance(&program, from, until, &Tolerances::default(), &mut one).expect("oscillators");
            moving.advance(&program, from, until, &Tolerances::default(), &mut other).expect("oscillators");
            for name in 0..LANES + 3 {
                if let Some(now) = names.iter().position(|known| *known == name) {
                    let (a, b) = (cell(&still, &program, name), cell(&moving, &program, now));
                    assert_eq!(a, b, "{method:?}, window {window}, cell {name}, now {now}");
                }
            }
            // Four come, at the begin, within and at the end, so that a block is added; then six go, three of them of the first ones.
            let come = 1000 + 10 * window;
            for (new, at) in [0, 5, names.len() / 2].into_iter().enumerate() {
                names.insert(at, come + new);
                moving.insert(&program, at, &start(&program, come + new), &[]);
            }
            names.push(come + 3);
            moving.push(&program, &start(&program, come + 3), &[]);
            assert_eq!(moving.cells(), names.len());
            for go in [names.len() - 1, 0, names.len() / 3] {
                names.remove(go);
                moving.remove(go);
            }
            let gone = |name: usize| (name + window).is_multiple_of(13);
            moving.retain(|cell| !gone(names[cell]));
            names.retain(|name| !gone(*name));
        }
        let left = names.iter().filter(|name| **name < LANES + 3).count();
        assert!(left > 0 && left < LANES + 3, "{left} of the first are left");
    }
}

#[test]
fn a_cell_that_comes_and_goes_leaves_no_trace() {
    let program = Program::new(&van_der_pol_pair(5.0)).expect("no circles");
    for method in [Method::Rk45, Method::Rk4 { step: 0.01 }] {
        for cells in [1, LANES - 1, LANES, LANES + 1] {
            let names: Vec<usize> = (0..cells).collect();
            let (mut population, mut scratch) = (crowd(&program, &names, method), PopulationScratch::default());
            population.advance(&program, 0.0, 0.1, &Tolerances::default(), &mut scratch).expect("oscillators");
            for at in [0, cells / 2, cells] {
                let mut other = population.clone();
                other.insert_default(&program, at);
                other.remove(at);
                assert_eq!(other, population, "{method:?}: cell {at} beside {cells}");
            }
        }
    }
}

#[test]
fn a_new_cell_starts_as_the_system_does() {
    let mut driven = system("driven", &[("x", 2.0, "k-x")], &[("k", 3.0)]);
    driven.quantities[1] = ode_problems::quantity("k", Role::Input, 3.0);
    let program = Program::new(&driven).expect("no circles");
    let mut grown = Population::new(&program, 0, Method::Rk45);
    for cells in 1..=2 * LANES + 1 {
        grown.push_default(&program);
        assert_eq!(grown, Population::new(&program, cells, Method::Rk45), "{cells} cells");
    }
    grown.push(&program, &[0.5], &[7.0]);
    let last = grown.cells() - 1;
    assert_eq!((grown.state(last, 0), grown.open_value(last, 0), grown.next_step(last)), (0.5, 7.0, 0.0));
    assert_eq!((grown.state(last - 1, 0), grown.open_value(last - 1, 0)), (2.0, 3.0));
    grown.retain(|_| false);
    assert_eq!(grown, Population::new(&program, 0, Method::Rk45), "none is left");
    let mut scratch = PopulationScratch::default();
    let work = grown.advance(&program, 0.0, 1.0, &Tolerances::default(), &mut scratch).expect("nothing to do");
    assert_eq!(work.steps, 0);
}
