//! The pull that keeps the atoms of a surface in order acts along the surface, drives nothing and changes no shape.

use pseudopod::Vec3;
use pseudopod::geometry::{self, Surface, icosphere};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::ordering::Ordering;
use pseudopod::mechanics::sum::measure_elastic;
use pseudopod::mechanics::tension::Tension;
use pseudopod::sim::{Kind, Model, State, Workspace, step};

const STIFFNESS: f64 = 5.0;
const TENSION: f64 = 100.0;

fn ordering(surface: &Surface) -> Force {
    Force::Ordering(Ordering::new(surface.positions.len(), &surface.facets, STIFFNESS))
}

/// Forces on the atoms of a surface, pN.
fn forces(surface: &Surface) -> Vec<Vec3> {
    let x: Vec<f64> = surface.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let (mut f, mut energy) = (vec![0.0; x.len()], [0.0]);
    measure_elastic(&[ordering(surface)], 1, &x, &mut f, &mut energy);
    assert_eq!(energy[0], 0.0);
    f.chunks(3).map(Vec3::from_column_slice).collect()
}

/// A number between −1 and 1 that looks random and is always the same.
fn noise(index: usize) -> f64 {
    let x = (index as f64 * 12.9898 + 4.1414).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// Positions moved about by up to `size` (µm) along each axis.
fn shaken(surface: &Surface, size: f64) -> Surface {
    let mut shaken = surface.clone();
    for (i, p) in shaken.positions.iter_mut().enumerate() {
        *p += Vec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2)) * size;
    }
    shaken
}

/// Sums of the vector areas of the facets around each atom, µm².
fn normals(surface: &Surface) -> Vec<Vec3> {
    let mut normals = vec![Vec3::zeros(); surface.positions.len()];
    for facet in &surface.facets {
        let [a, b, c] = facet.map(|i| surface.positions[i as usize]);
        facet.iter().for_each(|&i| normals[i as usize] += 0.5 * (b - a).cross(&(c - a)));
    }
    normals
}

/// The volume's gradient at an atom is a third of its vector area: what lies across that does no work on the volume.
#[test]
fn the_pull_lies_along_the_surface_without_net_force_and_torque() {
    let surface = shaken(&icosphere(5.0, 2), 0.3);
    let forces = forces(&surface);
    let size = forces.iter().map(Vec3::norm).sum::<f64>();
    assert!(size > 10.0, "shaken atoms are pulled: {size}");
    for (force, normal) in forces.iter().zip(normals(&surface)) {
        // Round-off of some hundred operations.
        assert!(force.dot(&normal.normalize()).abs() < 1e-12 * size, "{force}");
    }
    let net: Vec3 = forces.iter().sum();
    let torque: Vec3 = surface.positions.iter().zip(&forces).map(|(x, f)| x.cross(f)).sum();
    assert!(net.norm() < 1e-12 * size && torque.norm() < 1e-11 * size, "{net} {torque}");
}

#[test]
fn the_pull_vanishes_where_the_mesh_is_regular_and_is_less_than_that_of_one_edge_on_a_refined_sphere() {
    let worst = |level| {
        let surface = icosphere(5.0, level);
        forces(&surface).iter().map(Vec3::norm).fold(0.0, f64::max) / (STIFFNESS * geometry::mean_edge_length(&surface))
    };
    // By symmetry on an icosahedron and on its first refinement.
    assert!(worst(0) < 1e-14 && worst(1) < 1e-14, "{} {}", worst(0), worst(1));
    // The edges of finer icospheres jump where the sides of the icosahedron were, by about a tenth, and the pull is their
    // cube: six of them leave less than one.
    assert!(worst(2) < 1.0 && worst(3) < 1.0, "{} {}", worst(2), worst(3));
}

/// A ball of 162 atoms with tension and ordering that keeps its volume, begun in this shape (at its volume) and left alone for 40 s.
fn settled(begin: &dyn Fn(&Vec3) -> Vec3) -> (Surface, Surface) {
    let rest = icosphere(5.0, 2);
    let tension = Tension::new(&rest.positions, &rest.facets, TENSION, 0.0);
    let mut kind = Kind::new("drop", rest.clone(), vec![Force::Tension(tension), ordering(&rest)]);
    kind.bound_stiffness();
    let method = Method::Implicit { order: Order::Second };
    let integrator = Integrator { method, size: StepSize::Adaptive { tolerance: 1e-3, largest: 0.5 } };
    let model = Model::of(vec![kind], integrator, 40.0);
    let mut begun = rest.clone();
    begun.positions.iter_mut().for_each(|p| *p = begin(p));
    let larger = (geometry::volume(&rest) / geometry::volume(&begun)).cbrt();
    begun.positions.iter_mut().for_each(|p| *p *= larger);
    let mut state = State::new(&model, &[vec![begun.positions.clone()]]);
    let mut ws = Workspace::new(&model);
    while state.time < model.until {
        step(&model, &mut state, &mut ws).unwrap();
    }
    let mut end = rest;
    end.positions = state.kinds[0].cell(&model.kinds[0], 0);
    (begun, end)
}

/// The smallest area of a facet over the mean.
fn smallest(surface: &Surface) -> f64 {
    let areas = geometry::facet_areas(surface);
    areas.iter().copied().fold(f64::INFINITY, f64::min) / (areas.iter().sum::<f64>() / areas.len() as f64)
}

#[test]
fn a_drop_whose_atoms_were_crowded_regains_even_facets_and_stays_a_ball_where_it_is() {
    // Atoms of a ball moved along it towards one pole.
    let crowd = |p: &Vec3| Vec3::new(p.x, p.y, p.z + 3.0).normalize() * 5.0;
    let (begun, end) = settled(&crowd);
    let even = smallest(&icosphere(5.0, 2));
    println!("smallest facet over the mean: {} -> {}, of the icosphere {even}", smallest(&begun), smallest(&end));
    assert!(smallest(&begun) < 0.5 * even, "{}", smallest(&begun));
    assert!(smallest(&end) > 0.8 * even, "{}", smallest(&end));
    // A ball: radii about the centre differ by no more than those of flat facets, h²/8R of 5 µm for edges h of 1.5 µm.
    let centre = geometry::centre_of_volume(&end);
    let radii: Vec<f64> = end.positions.iter().map(|p| (p - centre).norm()).collect();
    let mean = radii.iter().sum::<f64>() / radii.len() as f64;
    let scatter = radii.iter().map(|r| (r - mean).abs()).fold(0.0, f64::max) / mean;
    println!("radius {mean}, scatter {scatter:e}");
    assert!(scatter < 0.011, "{scatter}");
    // Nothing drives it: drag is on atoms, and their mean stays to round-off.
    let mean_position = |surface: &Surface| surface.positions.iter().sum::<Vec3>() / surface.positions.len() as f64;
    let moved = (mean_position(&end) - mean_position(&begun)).norm();
    assert!(moved < 1e-9, "{moved}");
}

#[test]
fn a_drawn_out_drop_rounds_up_and_has_the_least_surface_of_its_volume() {
    let (_, end) = settled(&|p| Vec3::new(p.x / 1.3, p.y / 1.3, p.z * 1.69));
    let round = icosphere(5.0, 2);
    let shape = |surface: &Surface| {
        let area = geometry::facet_areas(surface).iter().sum::<f64>();
        area.powi(3) / geometry::volume(surface).powi(2)
    };
    println!("area^3 / volume^2 over that of the icosphere: {}", shape(&end) / shape(&round));
    // The pressure of a drop is γ dA/dV: with the area of its volume it has 2γ/R. Flat facets make A³/V² of an icosphere larger than
    // that of a ball, 36π, by `facets`; another order of the atoms may change that by a part of it, for which a fifth is left.
    let facets = shape(&round) / (36.0 * std::f64::consts::PI) - 1.0;
    println!("facets make {facets} of it");
    assert!((shape(&end) / shape(&round) - 1.0).abs() < 0.2 * facets);
}
