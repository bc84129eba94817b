//! The limits of step and stiffness for one atom on two fixed ones: found by simulation, within 1 % of the derivation
//! in the book's chapter on stability. The scene is the document of `experiments/stability_limits`.

use pseudopod::Vec3;
use pseudopod::experiment::{Document, compile};
use pseudopod::geometry::icosphere;
use pseudopod::mechanics::Force;
use pseudopod::mechanics::attraction::Attraction;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::fibres::Fibres;
use pseudopod::sim::{Kind, Workspace, step};
use std::path::Path;

/// The models of the triangle, as the document names them.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    /// Shape memory of the free atom.
    Memory,
    /// Shape memory of all three atoms: the free one bears its share of the reactions.
    MemoryOfAll,
    Springs,
}

/// Along which axes the third atom may move.
#[derive(Clone, Copy)]
enum Free {
    Base,
    Height,
    Both,
}

/// Drag k_a (pN·s/µm) and mass m (mg) of the atom.
#[derive(Clone, Copy)]
struct Atom {
    drag: f64,
    mass: f64,
}

const ATOM: Atom = Atom { drag: 1.0, mass: 1.0 };

/// Where the third atom stands in the course of explicit Euler with a push of 10⁻⁶ µm at the start: relative to rest,
/// µm. Small enough that the answer is linear; with exact limits known to six digits more.
fn course(cell: Cell, free: Free, atom: Atom, stiffness: f64, dt: f64, steps: usize) -> Vec<[f64; 2]> {
    let name = if cell == Cell::Springs { "springs" } else { "memory" };
    let held = match free {
        Free::Base => "[\"y\", \"z\"]",
        Free::Height => "[\"x\", \"z\"]",
        Free::Both => "[\"z\"]",
    };
    let what = if cell == Cell::Springs { "springs" } else { "shape_memory" };
    let mut sets = vec![
        format!("run.integrator.step={dt} s"),
        format!("run.until={} s", 2.0 * dt * steps as f64),
        format!("cells.{name}.fixed=[{{ atoms = [0, 1] }}, {{ atoms = [2], axes = {held} }}]"),
        format!("output.every={} s", 4.0 * dt),
        format!("cells.{name}.loads=[]"),
        format!("cells.{name}.mechanics.mass={} mg", 3.0 * atom.mass),
        format!("cells.{name}.mechanics.drag={} pN s/um", 3.0 * atom.drag),
        format!("cells.{name}.mechanics.{what}.stiffness={stiffness} pN/um"),
    ];
    if cell == Cell::MemoryOfAll {
        sets.push("cells.memory.mechanics.shape_memory.only={ all = true }".to_owned());
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/stability_limits/experiment.toml");
    let document = Document::read(&path, &sets).unwrap_or_else(|error| panic!("{error}"));
    let mut compiled = compile(&document).unwrap();
    let number = compiled.model.kinds.iter().position(|kind| kind.name == name).unwrap();
    compiled.model.kinds = vec![compiled.model.kinds[number].clone()];
    compiled.state.kinds = vec![compiled.state.kinds[number].clone()];
    (compiled.state.kinds[0].first_cell, compiled.state.kinds[0].first_atom) = (0, 0);
    let rest = [6, 7].map(|slot: usize| compiled.state.kinds[0].positions[slot]);
    for (axis, held) in [(0, matches!(free, Free::Height)), (1, matches!(free, Free::Base))] {
        if !held {
            compiled.state.kinds[0].positions[6 + axis] += 1e-6;
        }
    }
    let mut ws = Workspace::new(&compiled.model);
    let mut course = Vec::with_capacity(steps);
    for _ in 0..steps {
        // Outside the linear range there is nothing more to learn.
        if step(&compiled.model, &mut compiled.state, &mut ws).is_err() {
            break;
        }
        let x = &compiled.state.kinds[0].positions;
        course.push([x[6] - rest[0], x[7] - rest[1]]);
        if (x[6] - rest[0]).abs().max((x[7] - rest[1]).abs()) > 1e-3 {
            break;
        }
    }
    course
}

/// Whether the motion dies out: the last quarter of a long course stays below the first.
fn dies_out(cell: Cell, free: Free, atom: Atom, stiffness: f64, dt: f64) -> bool {
    let steps = 8000;
    let course = course(cell, free, atom, stiffness, dt, steps);
    let size = |part: &[[f64; 2]]| part.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    course.len() == steps && size(&course[3 * steps / 4..]) < size(&course[..steps / 4])
}

/// Whether the motion oscillates: x(n+2) = a x(n+1) + b x(n) has complex roots.
fn oscillates(cell: Cell, free: Free, atom: Atom, stiffness: f64) -> bool {
    let axis = usize::from(matches!(free, Free::Height));
    // A step at which the four numbers differ well; explicit Euler's roots turn complex where those of the flow do.
    let course = course(cell, free, atom, stiffness, 0.4 * atom.mass / atom.drag, 4);
    let [p, q, r, s] = [0, 1, 2, 3].map(|n: usize| course[n][axis]);
    let determinant = q * q - r * p;
    let (a, b) = ((r * q - s * p) / determinant, (q * s - r * r) / determinant);
    0.25 * a * a + b < 0.0
}

/// Where a claim turns from true to false between two bounds, to a part in ten thousand.
fn turning_point(from: f64, to: f64, holds: impl Fn(f64) -> bool) -> f64 {
    assert!(holds(from) && !holds(to), "the limit lies between {from} and {to}");
    let (mut low, mut high) = (from, to);
    while high / low > 1.0001 {
        let middle = (low * high).sqrt();
        if holds(middle) { low = middle } else { high = middle }
    }
    (low * high).sqrt()
}

fn check(name: &str, derived: f64, found: f64) {
    println!("{name}: derived {derived:.5}, simulated {found:.5}, {:+.2} %", 100.0 * (found / derived - 1.0));
    assert!((found / derived - 1.0).abs() < 0.01, "{name}: {derived} derived, {found} simulated");
}

fn largest_step(cell: Cell, free: Free, stiffness: f64, derived: f64) -> f64 {
    turning_point(0.7 * derived, 1.4 * derived, |dt| dies_out(cell, free, ATOM, stiffness, dt))
}

/// On one thread of a pool: an empty scene of three atoms is all overhead otherwise.
fn alone(work: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(work);
}

#[test]
fn the_largest_steps_of_oscillating_modes_are_two_thirds_and_one_drag_over_stiffness() {
    alone(|| {
        let k = 4.0;
        for (name, cell, free, derived) in [
            ("memory, base", Cell::Memory, Free::Base, 1.0 / k),
            ("memory, height", Cell::Memory, Free::Height, 1.0 / k),
            ("memory", Cell::Memory, Free::Both, 1.0 / k),
            ("memory of all, base", Cell::MemoryOfAll, Free::Base, 8.0 / (9.0 * k)),
            ("memory of all, height", Cell::MemoryOfAll, Free::Height, 8.0 / (15.0 * k)),
            ("springs, base", Cell::Springs, Free::Base, 2.0 / k),
            ("springs, height", Cell::Springs, Free::Height, 2.0 / (3.0 * k)),
            ("springs", Cell::Springs, Free::Both, 2.0 / (3.0 * k)),
        ] {
            check(&format!("step, oscillating, {name}"), derived, largest_step(cell, free, k, derived));
        }
    });
}

#[test]
fn the_largest_steps_of_over_damped_modes_tend_to_two_masses_over_drag() {
    alone(|| {
        let limit = |stiffness: f64| (1.0 - (1.0 - 4.0 * stiffness).sqrt()) / stiffness;
        for k in [0.1, 0.01] {
            for (name, cell, free, derived) in [
                ("memory", Cell::Memory, Free::Both, limit(k)),
                ("springs, base", Cell::Springs, Free::Base, limit(0.5 * k)),
                ("springs, height", Cell::Springs, Free::Height, limit(1.5 * k)),
                ("springs", Cell::Springs, Free::Both, limit(0.5 * k)),
            ] {
                check(
                    &format!("step, over-damped, stiffness {k}, {name}"),
                    derived,
                    largest_step(cell, free, k, derived),
                );
            }
        }
        check("step, critically damped, memory", 4.0, largest_step(Cell::Memory, Free::Both, 0.25, 4.0));
        let soft = largest_step(Cell::Memory, Free::Both, 1e-3, 2.0);
        check("step, softest mode against 2m/k_a", 2.0, soft);
    });
}

#[test]
fn the_largest_stiffness_at_a_step_is_drag_over_step() {
    alone(|| {
        let dt = 0.5;
        for (name, cell, derived) in [("memory", Cell::Memory, 1.0 / dt), ("springs", Cell::Springs, 2.0 / (3.0 * dt))]
        {
            let found = turning_point(0.7 * derived, 1.4 * derived, |k| dies_out(cell, Free::Both, ATOM, k, dt));
            check(&format!("stiffness at step {dt}, {name}"), derived, found);
        }
    });
}

#[test]
fn oscillation_begins_at_a_quarter_and_a_sixth_of_the_drag_squared_over_mass() {
    alone(|| {
        for atom in [ATOM, Atom { drag: 3.0, mass: 2.0 }] {
            let unit = atom.drag * atom.drag / atom.mass;
            for (name, cell, free, derived) in [
                ("memory, base", Cell::Memory, Free::Base, unit / 4.0),
                ("memory, height", Cell::Memory, Free::Height, unit / 4.0),
                ("springs, base", Cell::Springs, Free::Base, unit / 2.0),
                ("springs, height", Cell::Springs, Free::Height, unit / 6.0),
            ] {
                let found = turning_point(0.7 * derived, 1.4 * derived, |k| !oscillates(cell, free, atom, k));
                check(&format!("onset of oscillation, {name}"), derived, found);
            }
        }
    });
}

#[test]
fn forces_that_are_not_elastic_are_bounded_each_by_itself() {
    let fibres = |pairs: &[[u32; 2]], stiffness: f64| {
        Force::Fibres(Fibres::new("fibres", pairs.to_vec(), stiffness, Course::constant(0.0)))
    };
    // No atom has fibres of both lists: a bound on their sum would be that of one of them, 8 pN/um, and 5 for the attraction.
    let attraction = Force::Attraction(Attraction { to: Vec3::zeros(), stiffness: 5.0 });
    let forces = vec![attraction, fibres(&[[0, 1], [0, 2]], 2.0), fibres(&[[3, 4], [5, 6]], 3.0)];
    let kind = Kind::new("cell", icosphere(5.0, 1), forces);
    assert_eq!(kind.measure_largest_stiffness(), 8.0 + 6.0 + 5.0);
}
