//! Bodies that are filled with what is viscous: what they lose, how fast they let shapes go, the order of the step with them, and regions of
//! another material.

use crate::viscosity::{farthest, model_of, numbers, run_to_end};
use nalgebra::Matrix3;
use pseudopod::Vec3;
use pseudopod::geometry::Solid as Body;
use pseudopod::geometry::solid::{block, rod};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::integrator::{Order, StepSize};
use pseudopod::mechanics::load::Load;
use pseudopod::mechanics::solid::Solid;
use pseudopod::mechanics::solid::law::{Elastic, SolidLaw};
use pseudopod::mechanics::viscosity::Viscosity;
use pseudopod::mechanics::viscosity::inside::Inside;
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{Kind, Model, State, Workspace, step};
use pseudopod::simulation::Simulation;

/// A viscosity that is the same in all tetrahedra, Pa·s.
fn filled(body: &Body, shear: f64) -> Viscosity {
    let inside = Inside::new(&body.tetrahedra, vec![shear; body.tetrahedra.len()]);
    Viscosity::new(&body.surface.facets, 0.0, 0.0).with_inside(inside)
}

/// A block of 64 cells whose atoms stand where chance has moved them.
fn irregular() -> Body {
    let mut body = block([2.0, 2.0, 2.0], [4, 4, 4]).expect("a sound body");
    for (atom, x) in body.surface.positions.iter_mut().enumerate() {
        let by = |axis: usize| 0.1 * ((atom * 37 + axis * 101) as f64).sin();
        *x += Vec3::new(by(0), by(1), by(2));
    }
    body
}

#[test]
fn a_body_loses_what_a_fluid_does_and_nothing_as_it_goes_and_turns() {
    let body = irregular();
    let x = &body.surface.positions;
    let viscosity = filled(&body, 3.0);
    let resistance = |v: &[Vec3]| -> Vec<Vec3> {
        let mut f = vec![0.0; 3 * x.len()];
        viscosity.add_to(1, 1.0, [&numbers(x), &numbers(v)], &mut f);
        f.chunks_exact(3).map(Vec3::from_column_slice).collect()
    };
    let any: Vec<Vec3> = (0..x.len()).map(|i| Vec3::from_fn(|a, _| ((i * 7 + a * 31) % 13) as f64)).collect();
    let f = resistance(&any);
    let torque: Vec3 = x.iter().zip(&f).map(|(x, f)| x.cross(f)).sum();
    let size: f64 = f.iter().map(|f| f.norm()).sum();
    assert!(f.iter().sum::<Vec3>().norm() < 1e-13 * size && torque.norm() < 1e-13 * size, "{torque} {size}");
    let spin = Matrix3::new(0.0, -0.3, 0.5, 0.3, 0.0, 0.7, -0.5, -0.7, 0.0);
    let at_rate =
        |rate: Matrix3<f64>| -> Vec<Vec3> { x.iter().map(|x| rate * x + Vec3::new(1.0, -2.0, 0.4)).collect() };
    assert!(resistance(&at_rate(spin)).iter().all(|f| f.norm() < 1e-12));
    // A change of volume alone costs nothing.
    assert!(resistance(&at_rate(Matrix3::identity())).iter().all(|f| f.norm() < 1e-12));
    let rate = Matrix3::new(0.3, 0.2, -0.1, 0.0, -0.2, 0.4, 0.5, 0.1, 0.1);
    let strain: Matrix3<f64> = 0.5 * (rate + rate.transpose());
    let strain = strain - Matrix3::identity() * (strain.trace() / 3.0);
    let volume: f64 = body.volumes().sum();
    let wanted = 2.0 * 3.0 * strain.norm_squared() * volume;
    let v = at_rate(rate);
    let power: f64 = resistance(&v).iter().zip(&v).map(|(f, v)| f.dot(v)).sum();
    assert!((power / wanted - 1.0).abs() < 1e-12, "{power} {wanted}");
}

fn material(body: &Body, law: SolidLaw, shear: f64, lame: f64) -> Force {
    let elastic = Elastic { law, shear, lame };
    Force::Solid(Solid::new(&body.surface.positions, &body.tetrahedra, elastic, None))
}

fn kind_of(body: &Body, force: Force, drag: f64) -> Kind {
    let mut kind = Kind::new("body", body.surface.clone(), vec![force]);
    kind.tetrahedra.clone_from(&body.tetrahedra);
    kind.drag = drag;
    kind
}

/// Energy and loss have the same form, µ |dev ε|² and η |dev D|²: every shape goes with e^(-t/τ), τ = η/µ, bent, twisted or drawn out.
#[test]
fn kelvin_and_voigt_let_every_shape_go_in_the_same_time() {
    let body = irregular();
    let (shear, time) = (40.0, 2.0);
    let kind = kind_of(&body, material(&body, SolidLaw::Linear, shear, -2.0 / 3.0 * shear), 1e-4);
    let model = model_of(kind, filled(&body, time * shear), Order::Second, StepSize::Fixed(0.01 * time), time);
    let rest = &body.surface.positions;
    let shapes: [fn(&Vec3) -> Vec3; 3] = [
        |p| Vec3::new(-0.5 * p.x, -0.5 * p.y, p.z),
        |p| Vec3::new(p.z * p.z - 0.3, 0.0, -2.0 * p.x * p.z),
        |p| Vec3::new(p.y * p.z, -p.x * p.z, 0.0),
    ];
    for (number, shape) in shapes.iter().enumerate() {
        let start: Vec<Vec3> = rest.iter().map(|p| p + shape(p) * 1e-4).collect();
        let energy = |positions: Vec<Vec3>| measure_cells(&model, &State::new(&model, &[vec![positions]]))[0].energy;
        let before = energy(start.clone());
        let end = run_to_end(&model, start);
        let left = (energy(end.kinds[0].cell(&model.kinds[0], 0)) / before).sqrt();
        println!("shape {number}: {left} in {} steps", end.step);
        // What drag, steps of τ/100 and deformations of 1e-4 leave.
        assert!((left * std::f64::consts::E - 1.0).abs() < 2e-3, "shape {number}: {left}");
    }
}

/// A rod of rubber that is drawn out by a force from the start, half of what it loses by viscosity.
fn pulled(order: Order, dt: f64) -> Model {
    let body = rod([1.0, 1.0], 4.0, 2, 6).expect("a sound body");
    let mut kind = kind_of(&body, material(&body, SolidLaw::NeoHookean, 40.0, 0.0), 1.0);
    for (name, sign) in [("up", 1.0), ("down", -1.0)] {
        let ends: Vec<u32> =
            (0..).zip(&body.surface.positions).filter(|(_, p)| sign * p.z > 1.99).map(|(atom, _)| atom).collect();
        let share = 1.0 / ends.len() as f64;
        let atoms = ends.into_iter().map(|atom| (atom, share)).collect();
        kind.forces.push(Force::Load(Load::new(name, atoms, sign * Vec3::z(), Course::constant(150.0))));
    }
    model_of(kind, filled(&body, 30.0), order, StepSize::Fixed(dt), 1.0)
}

#[test]
fn steps_of_viscous_bodies_keep_their_order_however_far_these_deform() {
    for (order, wanted) in [(Order::First, 1.0), (Order::Second, 2.0)] {
        let end = |steps: f64| {
            let model = pulled(order, 1.0 / steps);
            run_to_end(&model, model.kinds[0].rest.positions.clone())
        };
        let [coarse, fine, finest] = [32.0, 64.0, 128.0].map(end);
        let found = (farthest(&coarse, &fine) / farthest(&fine, &finest)).log2();
        let stretched = finest.kinds[0].positions.iter().skip(2).step_by(3).copied().fold(0.0, f64::max) / 2.0;
        println!("{order:?}: {found}, {:e} in steps of 1/64 s, stretched {stretched}", farthest(&fine, &finest));
        assert!(stretched > 1.3, "it deforms far: {stretched}");
        // Halvings differ from the limit by the next order's term.
        assert!((found - wanted).abs() < 0.2, "{order:?}: {found}");
    }
}

/// The energy that a body had is what viscosity and drag have taken.
#[test]
fn what_viscosity_takes_of_a_body_is_in_the_account_of_energy() {
    let dt = 1.0 / 64.0;
    let mut model = pulled(Order::Second, dt);
    model.kinds[0].forces.retain(|force| matches!(force, Force::Solid(_)));
    let drawn = |p: &Vec3| p.component_mul(&Vec3::new(0.85, 0.85, 1.4));
    let start = model.kinds[0].rest.positions.iter().map(drawn).collect();
    let mut state = State::new(&model, &[vec![start]]);
    let mut ws = Workspace::new(&model);
    let energy = |state: &State| measure_cells(&model, state)[0].energy;
    // The first step makes the volume exact.
    step(&model, &mut state, &mut ws).expect("a step");
    let (begun, taken, mut by_drag) = (energy(&state), state.kinds[0].dissipated[0], 0.0);
    while state.time < model.until {
        let from = state.kinds[0].positions.clone();
        step(&model, &mut state, &mut ws).expect("a step");
        let gone = from.iter().zip(&state.kinds[0].positions).map(|(a, b)| (b - a) * (b - a)).sum::<f64>();
        by_drag += model.kinds[0].drag * gone / dt;
    }
    let (by_viscosity, lost) = (state.kinds[0].dissipated[0] - taken, begun - energy(&state));
    println!("lost {lost}: {by_viscosity} by viscosity, {by_drag} by drag");
    assert!(by_viscosity > 0.2 * lost && by_drag > 0.02 * lost, "{by_viscosity} {by_drag}");
    // What a step takes is measured along its chord.
    assert!(((by_viscosity + by_drag) / lost - 1.0).abs() < 2e-4, "{by_viscosity} {by_drag} {lost}");
}

/// A bar of two halves, of 1 kPa and 10 kPa, 1 and 4 kPa s, that goes along itself alone: where stress is σ, each is drawn out by σ/E (1 − e^(−t/τ)) with
/// τ = 4η/3E, as a body of Kelvin and Voigt.
#[test]
fn halves_of_a_bar_creep_each_by_its_own_moduli() {
    let text = "title = \"Two halves\"\n[run]\nuntil = \"2 s\"\nintegrator = { step = \"0.02 s\" }\n[output]\nevery = \"1 s\"\n[cells.bar]\n\
         mesh = { shape = \"block\", size = [\"1 um\", \"1 um\", \"8 um\"], divisions = [1, 1, 8] }\n\
         fixed = [{ all = true, axes = [\"x\", \"y\"] }, { cap = { direction = [0, 0, -1], depth = \"0.1 um\" } }]\n\
         [cells.bar.mechanics]\ndrag = \"1e-6 pN s/um\"\nviscosity = { inside = \"1 kPa s\" }\n\
         solid = { law = \"linear\", young = \"1 kPa\", poisson = 0, regions = [{ name = \"stiff\", centre = [0, 0, \"1000 um\"], \
         radii = [\"1e5 um\", \"1e5 um\", \"1000 um\"], young = \"10 kPa\", viscosity = \"4 kPa s\" }] }\n\
         [[cells.bar.loads]]\nname = \"up\"\ncap = { direction = [0, 0, 1], depth = \"0.1 um\" }\nspread = \"area\"\n\
         direction = [0, 0, 1]\nforce = \"0.1 pN\"\n";
    let mut simulation = Simulation::from_text("bar.toml", text).unwrap_or_else(|error| panic!("{error}"));
    for time in [0.6_f64, 2.0] {
        simulation.run_until(time).unwrap_or_else(|error| panic!("{error}"));
        let mut positions = vec![[0.0; 3]; simulation.atom_count()];
        simulation.positions_into(&mut positions).unwrap();
        // Four atoms a layer, in the order of heights: the fifth layer is between the halves. The last two, where the load acts, are left out.
        let mut heights: Vec<f64> = positions.iter().map(|x| x[2]).collect();
        heights.sort_by(f64::total_cmp);
        let layer = |number: usize| heights[4 * number..4 * number + 4].iter().sum::<f64>() / 4.0;
        let (middle, end) = (layer(4), layer(6));
        let stress = 0.1;
        let creep = |young: f64, viscosity: f64| stress / young * (1.0 - (-0.75 * young * time / viscosity).exp());
        let (soft, stiff) = (4.0 * creep(1e3, 1e3), 2.0 * creep(1e4, 4e3));
        println!("{time} s: {middle} and {}, for {soft} and {stiff}", end - middle - 2.0);
        // Strains of 1e-4, by which viscosity goes with the present shape, and the second order of steps of τ/25.
        assert!((middle / soft - 1.0).abs() < 3e-4, "{middle} {soft}");
        assert!(((end - middle - 2.0) / stiff - 1.0).abs() < 3e-4, "{end} {middle} {stiff}");
    }
}

/// A bar between the ground and a flexible plate whose base goes 0.4 µm away: plate, bar and bonds are springs in a row, and the bar creeps as far as
/// the plate lets it, with τ = 4ηA/3L over the stiffness of both.
#[test]
fn a_flexible_plate_reads_what_a_bar_bears() {
    let text = "title = \"A bar on a plate\"\n[run]\nuntil = \"8 s\"\nintegrator = { step = \"0.02 s\" }\n[output]\nevery = \"1 s\"\n[cells.bar]\n\
         mesh = { shape = \"block\", size = [\"2 um\", \"2 um\", \"8 um\"], divisions = [2, 2, 8] }\n\
         placement = { at = [[\"3 um\", 0, \"20 um\"]] }\n\
         fixed = [{ all = true, axes = [\"x\", \"y\"] }, { cap = { direction = [0, 0, -1], depth = \"0.1 um\" } }]\n\
         [cells.bar.mechanics]\ndrag = \"1e-6 pN s/um\"\nviscosity = { inside = \"1 kPa s\" }\n\
         solid = { law = \"linear\", young = \"1 kPa\", poisson = 0 }\n\
         [[cells.bar.plates]]\nname = \"lever\"\ncap = { direction = [0, 0, 1], depth = \"0.1 um\" }\ndirection = [0, 0, 2]\n\
         stiffness = \"300 pN/um\"\ndisplacement = [[\"0 s\", \"0 um\"], [\"0.02 s\", \"0.004 um\"]]\n";
    let mut simulation = Simulation::from_text("bar.toml", text).unwrap_or_else(|error| panic!("{error}"));
    let mut read = |time: f64| {
        simulation.run_until(time).unwrap_or_else(|error| panic!("{error}"));
        ["plate_force.lever", "plate_displacement.lever"].map(|name| simulation.series(name).unwrap()[0])
    };
    // E A/L and 4/3 η A/L of the bar, whose bonds are 100 times as stiff as what holds their atoms: 0.5 % of it.
    let (plate, bar, dashpot, base) = (300.0, 500.0, 4.0 / 3.0 * 500.0, 0.004);
    let gone = |time: f64| {
        let end = base * plate / (plate + bar);
        // The base is there after 0.02 s, in the mean after 0.01 s.
        end * (1.0 - (-(plate + bar) / dashpot * (time - 0.01)).exp())
    };
    for time in [0.5, 8.0] {
        let [force, displacement] = read(time);
        println!("{time} s: {displacement} for {} µm, {force} pN", gone(time));
        // Bonds are springs in the row, too, with 0.5 % of its stiffness.
        assert!((displacement / gone(time) - 1.0).abs() < 6e-3, "{displacement} {}", gone(time));
        assert!((force - plate * (base - displacement)).abs() < 1e-9, "{force}");
    }
}
