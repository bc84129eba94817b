//! The contract of volume: whatever acts on a cell and whatever moves it, after every step its volume is the target
//! within 10⁻¹⁰; and the equation of state of cells that may change theirs, eq. (volume.4).

use pseudopod::experiment::{Compiled, Document, compile};
use pseudopod::geometry::{self, Surface};
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::sum::measure_elastic;
use pseudopod::sim::forces::add_forces;
use pseudopod::sim::{Kind, Model, State, VolumeRule, Workspace, step};
use std::path::Path;

/// What the contract allows, relative to the target.
const TOLERANCE: f64 = 1e-10;

/// A cell with drag and shape memory; tables of the scenes are added to it.
const CELL: &str = r#"
title = "A cell whose volume is held"
seed = 3
[run]
until = "0.5 s"
integrator = { max_step = "0.05 s" }
[cells.white]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { random_from = ["-40 um", "-40 um", "0 um"], random_to = ["90 um", "40 um", "0 um"] }
mechanics = { drag = "20 pN s/um", mass = "0.2 mg", shape_memory = { shape_modulus = "10 pN/um" } }
[output]
every = "0.5 s"
"#;

/// Everything that may act on a cell, one by one and at last together: name, and the keys that it sets.
#[rustfmt::skip] // a table
const SCENES: &[(&str, &[&str])] = &[
    ("nothing", &[]),
    ("atoms fixed on one axis", &[PULL, r#"cells.white.fixed=[{ cap = { direction = [0, 0, -1], number = 5 }, axes = ["z"] }]"#]),
    ("atoms fixed on two axes", &[PULL, r#"cells.white.fixed=[{ cap = { direction = [0, 0, -1], number = 5 }, axes = ["x", "z"] }]"#]),
    ("atoms fixed on all axes", &[PULL, r#"cells.white.fixed=[{ cap = { direction = [0, 0, -1], number = 5 } }]"#]),
    ("different atoms fixed on different axes", &[PULL, r#"cells.white.fixed=[{ atoms = [0, 1, 2], axes = ["x"] }, { atoms = [3, 4], axes = ["y", "z"] }, { atoms = [5] }]"#]),
    ("all but a few atoms fixed", &[PULL, r#"cells.white.fixed=[{ cap = { direction = [0, 0, -1], fraction = 0.85 } }]"#]),
    ("planes that press from above and below", &[DRIVEN, r#"planes=[{ name = "floor", point = ["0 um", "0 um", "-5 um"], normal = [0, 0, 1] }, { name = "lid", point = ["0 um", "0 um", "5 um"], normal = [0, 0, -1] }]"#]),
    ("a plane and weight", &[WEIGHT, r#"planes=[{ name = "floor", point = ["0 um", "0 um", "-5 um"], normal = [0, 0, 1] }]"#]),
    ("links", &[r#"cells.white.links=[{ pattern = "diagonal", stiffness = "1 pN/um", rest_ratio = 0.6 }, { pairs = [[0, 7], [3, 9]], stiffness = "4 pN/um", rest_length = "4 um" }]"#]),
    ("a strong local load that turns round", &[PULL]),
    ("weight", &[WEIGHT]),
    ("a driven volume", &[DRIVEN]),
    ("a driven volume, pulled", &[DRIVEN, PULL]),
    ("motility in space", &[WALK]),
    ("central attraction", &[ATTRACTION]),
    ("a membrane with tension and bending", &[PULL, r#"cells.white.mechanics.membrane={ law = "skalak", shear = "5 pN/um", area = "10 pN/um", tension = "20 pN/um", bending = "2 pN um", total_area = "5 pN/um" }"#]),
    ("all together", &[PULL, WEIGHT, DRIVEN, WALK, ATTRACTION,
        r#"cells.white.fixed=[{ atoms = [0, 1], axes = ["x"] }]"#,
        r#"cells.white.links=[{ pattern = "diagonal", stiffness = "1 pN/um", rest_ratio = 0.8 }]"#,
        r#"planes=[{ name = "floor", point = ["0 um", "0 um", "-5 um"], normal = [0, 0, 1] }]"#]),
];

/// 60 pN on five atoms double the length of this cell if they are left to act.
const PULL: &str = r#"cells.white.loads=[{ name = "pull", cap = { direction = [0, 0, 1], number = 5 }, direction = [1, 0, 3], force = [["0 s", "0 pN"], ["0.05 s", "60 pN"], ["0.2 s", "-30 pN"]] }]"#;
const WEIGHT: &str = r#"environment.gravity=["0 um/s^2", "0 um/s^2", "-100 um/s^2"]"#;
const DRIVEN: &str = r#"cells.white.mechanics.volume={ ratio = [["0 s", 1.0], ["0.1 s", 1.2], ["0.3 s", 0.9]] }"#;
const WALK: &str = r#"cells.white.motility.brownian={ speed = "10 um/s", persistence = "0.1 s", space = "volume" }"#;
const ATTRACTION: &str =
    r#"cells.white.motility.attraction={ to = ["10 um", "0 um", "0 um"], stiffness = "0.02 pN/um" }"#;

/// The course of [`DRIVEN`].
fn driven(time: f64) -> f64 {
    if time < 0.1 { 1.0 + 2.0 * time } else { (1.2 - 1.5 * (time - 0.1)).max(0.9) }
}

const INTEGRATORS: [&[&str]; 8] = [
    &["run.integrator.method=implicit"],
    &["run.integrator.step=0.05 s"],
    &["run.integrator.order=1", "run.integrator.step=0.02 s"],
    &["run.integrator.method=explicit"],
    &["run.integrator.method=euler"],
    &["run.integrator.method=semi_implicit_euler"],
    &["run.integrator.method=verlet"],
    &["run.integrator.method=runge_kutta_4"],
];

/// Level of the mesh and number of cells: alone, a whole block, a block and a part of one.
const POPULATIONS: [&[&str]; 4] = [
    &["cells.white.mesh.level=1", "cells.white.number=1"],
    &["cells.white.mesh.level=1", "cells.white.number=8"],
    &["cells.white.mesh.level=1", "cells.white.number=11"],
    &["cells.white.mesh.level=2", "cells.white.number=3"],
];

/// Steps of a scene: the implicit ones reach its end, the explicit ones come past the first bend of each course.
const STEPS: usize = 60;

fn compiled(text: &str, sets: &[&str]) -> Compiled {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let document = Document::parse("volume.toml", text, Path::new("."), &sets);
    let render = |error| pseudopod::error::render(&error, pseudopod::error::Paint::Plain);
    let document = document.unwrap_or_else(|error| panic!("{}", render(error)));
    compile(&document).unwrap_or_else(|error| panic!("{}", render(error)))
}

/// The volume of a cell, µm³, from its first atom, so that its place costs no digits.
fn volume_of(kind: &Kind, state: &State, cell: usize) -> f64 {
    let positions = state.kinds[0].cell(kind, cell);
    let first = positions[0];
    let positions = positions.into_iter().map(|position| position - first).collect();
    geometry::volume(&Surface { positions, facets: kind.rest.facets.clone() })
}

/// Runs a scene with every population; the largest error of a volume after any step, or why a step failed.
fn worst_error(scene: &[&str], integrator: &[&str]) -> Result<f64, String> {
    let mut worst: f64 = 0.0;
    for population in POPULATIONS {
        let Compiled { model, mut state, .. } = compiled(CELL, &[scene, integrator, population].concat());
        let mut ws = Workspace::new(&model);
        let kind = &model.kinds[0];
        let rest = geometry::volume(&kind.rest);
        for number in 0..STEPS {
            if state.time >= model.until {
                break;
            }
            step(&model, &mut state, &mut ws).map_err(|trouble| format!("{population:?}: {trouble}"))?;
            let target = rest * if scene.contains(&DRIVEN) { driven(state.time) } else { 1.0 };
            for cell in 0..state.kinds[0].cells() {
                let error = (volume_of(kind, &state, cell) / target - 1.0).abs();
                if error.is_nan() || error > TOLERANCE {
                    return Err(format!("{population:?}: cell {cell} is {error:.1e} off after step {number}"));
                }
                worst = worst.max(error);
            }
        }
    }
    Ok(worst)
}

#[test]
fn every_volume_is_on_its_target_after_every_step() {
    let mut failures = Vec::new();
    let mut worst: f64 = 0.0;
    for (name, scene) in SCENES {
        for integrator in INTEGRATORS {
            match worst_error(scene, integrator) {
                Ok(error) => worst = worst.max(error),
                Err(failure) => failures.push(format!("{name}, {integrator:?}: {failure}")),
            }
        }
    }
    println!("worst error of a volume: {worst:.1e}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A cell without elasticity that may change its volume at a price; `extra` is the rest of its mechanics.
fn compressible(extra: &str, sets: &[&str]) -> Compiled {
    let text = format!(
        r#"
title = "A cell that may change its volume"
run = {{ until = "60 s", integrator = {{ step = "0.05 s" }} }}
[cells.white]
mesh = {{ shape = "icosphere", radius = "5 um", level = 2 }}
mechanics = {{ drag = "20 pN s/um", volume = {{ rule = "compressible", modulus = "50 Pa" }}, {extra} }}
"#
    );
    compiled(&text, sets)
}

const MODULUS: f64 = 50.0;

/// The cell at rest: its surface and the pressure inside over that outside, `−K (V − V₀)/V₀`, Pa.
fn at_rest(Compiled { model, mut state, .. }: Compiled) -> (Surface, f64, f64) {
    let mut ws = Workspace::new(&model);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap();
    }
    let kind = &model.kinds[0];
    let surface = Surface { positions: state.kinds[0].cell(kind, 0), facets: kind.rest.facets.clone() };
    let (volume, rest) = (geometry::volume(&surface), geometry::volume(&kind.rest));
    (surface, -MODULUS * (volume - rest) / rest, rest)
}

#[test]
fn a_compressible_bubble_has_the_pressure_of_laplace() {
    let tension = 40.0;
    let extra = r#"membrane = { law = "skalak", shear = "0 pN/um", area = "0 pN/um", tension = "40 pN/um" }"#;
    let (surface, pressure, rest) = at_rest(compressible(extra, &[]));
    let (volume, area) = (geometry::volume(&surface), geometry::area(&surface));
    println!("p = {pressure} Pa, V/V0 = {}", volume / rest);
    // Balance under a change of size alone, 3 p V = 2 γ A, holds on any mesh: what is left is the tolerance of the run.
    assert!((3.0 * pressure * volume / (2.0 * tension * area) - 1.0).abs() < 1e-4);
    // Laplace's p = 2 γ/R, R that of the sphere with this volume; 162 atoms have 1.8 % more area than that sphere.
    let radius = (volume * 3.0 / (4.0 * std::f64::consts::PI)).cbrt();
    let excess = pressure * radius / (2.0 * tension) - 1.0;
    assert!((0.0..0.02).contains(&excess), "{excess}");
    // The closed form of the state: K (1 − v) = 2 γ/(R₀ v^⅓), v = V/V₀, with the same excess of area.
    let rest_radius = (rest * 3.0 / (4.0 * std::f64::consts::PI)).cbrt();
    let state = |v: f64| MODULUS * (1.0 - v) - 2.0 * tension * (1.0 + excess) / (rest_radius * v.cbrt());
    let expected = root(state, 0.5, 1.0);
    assert!((volume / rest - expected).abs() < 1e-4, "{} {expected}", volume / rest);
}

#[test]
fn a_compressible_cell_under_an_outer_load_is_in_the_balance_of_its_equation_of_state() {
    let attraction = [r#"cells.white.motility.attraction={ to = ["0 um", "0 um", "0 um"], stiffness = "0.5 pN/um" }"#];
    // Without elasticity a load on bare atoms gathers them, and a stronger one makes the shell buckle, slowly.
    let compiled = compressible(r#"shape_memory = { shape_modulus = "20 pN/um" }"#, &attraction);
    let forces = compiled.model.kinds[0].forces.clone();
    let (surface, pressure, rest) = at_rest(compiled);
    let (volume, positions) = (geometry::volume(&surface), surface.positions);
    println!("p = {pressure} Pa, V/V0 = {}", volume / rest);
    let flat: Vec<f64> = positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let mut force = vec![0.0; flat.len()];
    measure_elastic(&forces, 1, &flat, &mut force, &mut [0.0]);
    // Under a change of size the pressure works against the pull k x on every atom and the elastic forces F:
    // 3 p V = k Σ|x|² - Σ F·x, whatever the shape.
    let pull: f64 = 0.5 * flat.iter().map(|x| x * x).sum::<f64>();
    let elastic: f64 = -flat.iter().zip(&force).map(|(x, f)| x * f).sum::<f64>();
    let balance = 3.0 * pressure * volume / (pull + elastic);
    println!("pull {pull}, elastic {elastic}, balance {balance}");
    assert!((balance - 1.0).abs() < 1e-9, "{balance}");
    // All atoms at one radius R = s R₀: K (1 - s³) = k N R₀²/(3 V₀ s). Atoms with five neighbours carry less area than
    // those with six and sink in a little; what the elasticity takes of the load for that, 3 %, is 1e-3 of the volume.
    let load = 0.5 * 162.0 * 25.0 / (3.0 * rest);
    let expected = root(|s| MODULUS * (1.0 - s.powi(3)) - load / s, 0.5, 1.0).powi(3);
    assert!((volume / rest - expected).abs() < 2e-3, "{} {expected}", volume / rest);
    assert!(expected < 0.98, "the load must show");
}

/// A root of a function with one change of sign between two places, the upper branch first.
fn root(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    // From above: the state next to rest, not the collapsed one.
    let positions = (0..=1000).map(|i| high - (high - low) * f64::from(i) / 1000.0).collect::<Vec<_>>();
    if let Some(pair) = positions.windows(2).find(|pair| f(pair[0]) * f(pair[1]) <= 0.0) {
        (high, low) = (pair[0], pair[1]);
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if f(middle) * f(high) <= 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn the_pressure_is_the_gradient_of_its_energy() {
    for cells in [1, 11] {
        let Compiled { mut model, mut state, .. } = compiled(CELL, &[&format!("cells.white.number={cells}")]);
        model.kinds[0].forces.clear();
        let course = Course::through(vec![(0.0, 1.0), (1.0, 1.5)]).unwrap();
        model.kinds[0].volume = VolumeRule::Compressible { modulus: 70.0, course };
        // Any shape but the one at rest.
        let disturb = |(i, x): (usize, &mut f64)| *x += 0.4 * ((i * 37 % 101) as f64 / 101.0 - 0.5);
        state.kinds[0].positions.iter_mut().enumerate().for_each(disturb);
        let mut ws = Workspace::new(&model);
        let (force, _) = force_and_energy(&model, &state, &mut ws);
        let size = force.iter().fold(0.0_f64, |size, f| size.max(f.abs()));
        let used = force.len() / model.kinds[0].lanes * model.kinds[0].lanes;
        for i in (0..used).step_by(29) {
            // The energy is of sixth degree: central differences of h = 1e-4 µm err by 1e-8, round-off by as much.
            let (h, kept) = (1e-4, state.kinds[0].positions[i]);
            state.kinds[0].positions[i] = kept + h;
            let more = force_and_energy(&model, &state, &mut ws).1;
            state.kinds[0].positions[i] = kept - h;
            let less = force_and_energy(&model, &state, &mut ws).1;
            state.kinds[0].positions[i] = kept;
            let difference = -(more - less) / (2.0 * h);
            assert!((force[i] - difference).abs() < 1e-6 * size, "{i}: {} {difference}", force[i]);
        }
    }
}

/// All forces, and the sum of all energies at half a second.
fn force_and_energy(model: &Model, state: &State, ws: &mut Workspace) -> (Vec<f64>, f64) {
    add_forces(model, 0.5, state, ws);
    (ws.kinds[0].force.clone(), ws.kinds[0].energy.iter().sum())
}
