//! Areas, weights and linear systems of surfaces with sharp and obtuse angles.

use super::mesh::SurfaceMesh;
use super::shape::{areas, areas_and_weights, total};
use super::solve::{Gradients, Matrix, outflow, solve};
use crate::Vec3;
use crate::geometry::{Surface, area, sheet};

/// A flat sheet, sheared until most facets have an obtuse angle, with atoms that stand where no symmetry helps.
fn sheared() -> Surface {
    let mut surface = sheet(8.0, 8.0, 8, 8);
    for (atom, p) in surface.positions.iter_mut().enumerate() {
        let shift = [0.1 * (3.1 * atom as f64).sin(), 0.08 * (1.7 * atom as f64).cos()];
        *p = Vec3::new(p.x + 1.5 * p.y + shift[0], p.y + shift[1], 0.0);
    }
    surface
}

fn numbers(surface: &Surface) -> Vec<[f64; 1]> {
    surface.positions.iter().flatten().map(|x| [*x]).collect()
}

struct Measured {
    surface: Surface,
    mesh: SurfaceMesh,
    areas: Vec<[f64; 1]>,
    weights: Vec<[f64; 1]>,
}

fn measured() -> Measured {
    let surface = sheared();
    let mesh = SurfaceMesh::new(&surface, false);
    let (mut areas, mut weights) = (vec![[0.0]; mesh.atoms], vec![[0.0]; mesh.edges]);
    areas_and_weights(&mesh, &numbers(&surface), &mut areas, &mut weights);
    Measured { surface, mesh, areas, weights }
}

#[test]
fn areas_of_atoms_are_all_of_the_surface() {
    let Measured { surface, mesh, areas: found, .. } = measured();
    let mut alone = vec![[0.0]; mesh.atoms];
    areas(&mesh, &numbers(&surface), &mut alone);
    assert_eq!(alone, found, "with and without weights");
    assert!((total(&found)[0] / area(&surface) - 1.0).abs() < 1e-13);
}

#[test]
fn what_rises_evenly_on_a_flat_surface_does_not_pile_up_whatever_the_angles() {
    let Measured { surface, mesh, weights, .. } = measured();
    let negative = weights.iter().filter(|weight| weight[0] < -1e-9).count();
    assert!(negative > 20, "there are obtuse angles: {negative}");
    let y: Vec<[f64; 1]> = surface.positions.iter().map(|p| [3.0 * p.x - 2.0 * p.y]).collect();
    let clipped: Vec<[f64; 1]> = weights.iter().map(|weight| [weight[0].max(0.0)]).collect();
    let (mut worst, mut worst_clipped) = (0.0_f64, 0.0_f64);
    for atom in (0..81).filter(|atom| ![0, 8].contains(&(atom % 9)) && (1..8).contains(&(atom / 9))) {
        worst = worst.max(outflow(&mesh, &weights, &y, atom)[0].abs());
        worst_clipped = worst_clipped.max(outflow(&mesh, &clipped, &y, atom)[0].abs());
    }
    println!("what piles up: {worst:.1e}; with weights cut off at zero {worst_clipped:.1e}");
    assert!(worst < 1e-12, "{worst}");
    assert!(worst_clipped > 0.1, "weights cut off at zero would let it: {worst_clipped}");
}

#[test]
fn linear_systems_with_negative_weights_are_solved() {
    let Measured { mesh, areas, weights, .. } = measured();
    let right: Vec<[f64; 1]> = (0..mesh.atoms).map(|atom| [f64::from(u8::from(atom == 40))]).collect();
    for factor in [1e-3, 1.0, 1e3, 1e6] {
        let matrix = Matrix { mesh: &mesh, areas: &areas, weights: &weights, factor: [factor] };
        let (mut y, mut work) = (right.clone(), Gradients::default());
        work.suit(mesh.atoms);
        assert_eq!(solve(&matrix, &right, &mut y, &[1e-12], &mut work), [true], "factor {factor}");
        let wrong = |i: usize| areas[i][0] * (y[i][0] - right[i][0]) + factor * outflow(&mesh, &weights, &y, i)[0];
        let worst = (0..mesh.atoms).map(|i| (wrong(i) / areas[i][0]).abs()).fold(0.0, f64::max);
        // The residual that is worked out anew, not the one that the rounds carry along: each of some fifty rounds leaves a round-off of
        // 2e-16 times the factor.
        assert!(worst < 1e-11 + 1e-14 * factor, "factor {factor}: {worst}");
    }
}
