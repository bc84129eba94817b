//! Pressures push along normals wherever these are.

use std::path::Path;

use pseudopod::Vec3;
use pseudopod::experiment::{Document, compile};
use pseudopod::geometry::{Surface, area, icosphere, volume};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::control::Context;
use pseudopod::mechanics::course::Course;
use pseudopod::mechanics::pressure::{Beyond, Pressure};
use pseudopod::mechanics::sum::measure_forces;
use pseudopod::sim::observe::measure_cells;
use pseudopod::sim::{State, Workspace, step};

fn forces(facets: Vec<[u32; 3]>, beyond: Option<Beyond>, x: &[Vec3]) -> Vec<Vec3> {
    let pressure = Pressure { name: "p".into(), facets, pressure: Course::constant(2.5), beyond, profile: None };
    let x: Vec<f64> = x.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let mut f = vec![0.0; x.len()];
    measure_forces(
        &[Force::Pressure(pressure)],
        &Context { cells: 0..1, ..Context::at(0.0) },
        1,
        &x,
        &mut f,
        &mut [0.0],
    );
    f.chunks_exact(3).map(Vec3::from_column_slice).collect()
}

/// A ball that is drawn out and bent.
fn bent() -> Surface {
    let mut ball = icosphere(5.0, 2);
    let bend = |p: &Vec3| Vec3::new(1.3 * p.x + 0.02 * p.y * p.z, 0.9 * p.y + 0.01 * p.x * p.x, 0.8 * p.z - 0.3);
    ball.positions = ball.positions.iter().map(bend).collect();
    ball
}

#[test]
fn a_pressure_all_around_is_the_gradient_of_the_volume_and_has_neither_sum_nor_torque() {
    let surface = bent();
    let x = &surface.positions;
    let f = forces(surface.facets.clone(), None, x);
    let sum: Vec3 = f.iter().sum();
    let torque: Vec3 = x.iter().zip(&f).map(|(x, f)| x.cross(f)).sum();
    assert!(sum.norm() < 1e-12 && torque.norm() < 1e-11, "{sum} {torque}");
    for atom in [0, 17, 101] {
        for axis in 0..3 {
            let there = |by: f64| {
                let mut surface = surface.clone();
                surface.positions[atom][axis] += by;
                volume(&surface)
            };
            let slope = (there(1e-4) - there(-1e-4)) / 2e-4;
            assert!((f[atom][axis] + 2.5 * slope).abs() < 1e-8, "{} {slope}", f[atom][axis]);
        }
    }
}

/// What is beyond a plane is closed by a flat lid on it, so that the sum is the pressure times the area of the lid, against the direction.
#[test]
fn a_pressure_beyond_a_plane_draws_with_the_area_of_the_cut() {
    let ball = icosphere(5.0, 4);
    let direction = Vec3::new(0.48, 0.6, 0.64);
    for height in [-3.0, 0.2, 3.7] {
        let beyond = Beyond { point: height * direction, direction, radius: None };
        let f = forces(ball.facets.clone(), Some(beyond), &ball.positions);
        let sum: Vec3 = f.iter().sum();
        let lid = std::f64::consts::PI * (25.0 - height * height);
        let wanted = -2.5 * lid * direction;
        // Chords of a ball of 2 562 atoms.
        assert!((sum - wanted).norm() < 4e-3 * wanted.norm(), "{sum} {wanted}");
        let torque: Vec3 = ball.positions.iter().zip(&f).map(|(x, f)| x.cross(f)).sum();
        assert!(torque.norm() < 2e-3 * wanted.norm(), "{torque}");
    }
}

/// A cap of a ball above a plane is drawn by the circle in which a cylinder around the axis cuts it, or the plane does where that is smaller.
#[test]
fn a_pressure_within_a_radius_draws_with_the_area_of_the_circle() {
    let ball = icosphere(5.0, 4);
    let direction = Vec3::new(0.48, 0.6, 0.64);
    for (height, radius) in [(3.0, 2.0), (3.0, 3.5), (3.0, 4.5), (-4.0, 2.5)] {
        let beyond = Beyond { point: height * direction, direction, radius: Some(radius) };
        let f = forces(ball.facets.clone(), Some(beyond), &ball.positions);
        let sum: Vec3 = f.iter().sum();
        // Below the middle of the ball the cylinder leaves the ring between both out: what is drawn is the top of the ball.
        let wanted = -2.5 * std::f64::consts::PI * f64::min(radius * radius, 25.0 - height * height) * direction;
        println!("{height} {radius}: {}", (sum - wanted).norm() / wanted.norm());
        // Chords and tangents a facet (0.35 µm) long: with the sagittas of both a circle of 2 µm has 0.4 % more or less.
        assert!((sum - wanted).norm() < 6e-3 * wanted.norm(), "{height} {radius}: {sum} {wanted}");
    }
}

/// The work of a pressure p as all lengths grow by a small strain e is 3 p V e, the energy of a membrane of area modulus K then 2 K e² A:
/// e = 3 p V/(4 K A), which on a sphere is p R/(4 K).
#[test]
fn a_shell_is_blown_up_by_suction_as_theory_says() {
    let text = "title = \"Blown up\"\n[run]\nuntil = \"60 s\"\nintegrator = { tolerance = 1e-4 }\n[cells.shell]\n\
         mesh = { shape = \"icosphere\", radius = \"5 um\", level = 2 }\n\
         mechanics = { drag = \"20 pN s/um\", membrane = { law = \"skalak\", shear = \"100 pN/um\", area = \"200 pN/um\" }, volume = { rule = \"free\" } }\n\
         pressures = [{ name = \"suction\", all = true, pressure = [[\"0 s\", \"0 Pa\"], [\"10 s\", \"-1 Pa\"]] }]\n";
    let document = Document::parse("p.toml", text, Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
    let compiled = compile(&document).unwrap_or_else(|error| panic!("{error}"));
    let (model, mut state) = (compiled.model, compiled.state);
    let mut ws = Workspace::new(&model);
    let width = |state: &State| measure_cells(&model, state)[0].volume.cbrt();
    let before = width(&state);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    }
    let (rest, strain) = (&model.kinds[0].rest, width(&state) / before - 1.0);
    let wanted = 3.0 * volume(rest) / (4.0 * 200.0 * area(rest));
    println!("{strain} for {wanted} in {} steps", state.step);
    // Of second order in the strain.
    assert!((strain / wanted - 1.0).abs() < 0.02, "{strain} {wanted}");
}

/// A pressure that goes with the cosine of the angle from an axis has the sum p ∫ cos θ n dA over a sphere, 4π R² p/3 along the axis, and
/// one that a table has 1 for everywhere is the pressure itself.
#[test]
fn a_pressure_differs_over_a_surface_as_its_table_says() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..=180).map(|angle| format!("{angle},1,{}\n", f64::from(angle).to_radians().cos())).collect();
    std::fs::write(folder.path().join("stress.csv"), format!("angle,one,cosine\n{rows}")).unwrap();
    let forces_by = |profile: &str| -> Vec<Vec3> {
        let text = format!(
            "title = \"By a table\"\n[run]\nuntil = \"1 s\"\n[cells.ball]\n\
             mesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 3 }}\nmechanics = {{ drag = \"1 pN s/um\" }}\n\
             pressures = [{{ name = \"light\", all = true, pressure = \"-2 Pa\"{profile} }}]\n"
        );
        let document = Document::parse("p.toml", &text, folder.path(), &[]).unwrap_or_else(|error| panic!("{error}"));
        let model = compile(&document).unwrap_or_else(|error| panic!("{error}")).model;
        let x: Vec<f64> = model.kinds[0].rest.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        let mut f = vec![0.0; x.len()];
        let context = Context { cells: 0..1, ..Context::at(0.0) };
        measure_forces(&model.kinds[0].forces, &context, 1, &x, &mut f, &mut [0.0]);
        f.chunks_exact(3).map(Vec3::from_column_slice).collect()
    };
    let by = |column: &str| {
        let (axis, table) = ("axis = [0, 3, 4]", "table = \"stress.csv\"");
        forces_by(&format!(", profile = {{ {axis}, {table}, angle_column = \"angle\", factor_column = \"{column}\" }}"))
    };
    assert_eq!(by("one"), forces_by(""));
    let sum: Vec3 = by("cosine").iter().sum();
    let wanted = 2.0 * 4.0 * std::f64::consts::PI * 25.0 / 3.0 * Vec3::new(0.0, 0.6, 0.8);
    // Facets of a ball of 642 atoms.
    assert!((sum - wanted).norm() < 0.02 * wanted.norm(), "{sum} {wanted}");
}
