//! The laws against theory: homogeneous deformation, moduli at small strain, principal directions, the stress of known deformations.

use super::dilation::{DilationLaw, Parts};
use super::principal::eigen;
use super::*;
use crate::geometry::solid::{block, rod};
use crate::mechanics::Force;
use crate::mechanics::sum::measure_elastic;
use nalgebra::{Matrix3, Rotation3, SymmetricEigen, Vector3};

const LAWS: [SolidLaw; 4] =
    [SolidLaw::Linear, SolidLaw::Corotational, SolidLaw::StVenantKirchhoff, SolidLaw::NeoHookean];

fn columns(f: &Matrix3<f64>) -> [V3<f64>; 3] {
    [0, 1, 2].map(|k| V3 { x: f[(0, k)], y: f[(1, k)], z: f[(2, k)] })
}

fn matrix(columns: [V3<f64>; 3]) -> Matrix3<f64> {
    Matrix3::from_columns(&columns.map(|c| Vector3::new(c.x, c.y, c.z)))
}

/// Deformation gradients, from a little to far, with turns.
fn deformations() -> Vec<Matrix3<f64>> {
    let turn = Rotation3::from_euler_angles(0.5, -0.9, 1.4).into_inner();
    let of = |n: [f64; 9]| Matrix3::from_row_slice(&n);
    vec![
        of([1.01, 0.0, 0.003, -0.002, 0.99, 0.0, 0.001, 0.004, 1.0]),
        turn * of([1.3, 0.2, 0.1, 0.0, 0.8, -0.3, 0.1, 0.2, 1.1]),
        of([2.0, 0.7, -0.4, 0.1, 0.6, 0.2, 0.3, -0.1, 0.9]),
        turn,
        Matrix3::identity() * 0.7,
        of([1.2, 0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 0.6]),
    ]
}

#[test]
fn eigenvalues_are_those_of_dense_matrices_and_fall() {
    for f in deformations() {
        let c = f.transpose() * f;
        let symmetric = [[c[(0, 0)], c[(1, 1)], c[(2, 2)]], [c[(1, 2)], c[(2, 0)], c[(0, 1)]]];
        let (values, vectors) = eigen((), symmetric, true);
        let mut expected: Vec<f64> = SymmetricEigen::new(c).eigenvalues.iter().copied().collect();
        expected.sort_by(|a, b| b.total_cmp(a));
        for k in 0..3 {
            assert!((values[k] - expected[k]).abs() < 1e-14 * expected[0], "{values:?} for {expected:?}");
            let v = Vector3::new(vectors[k].x, vectors[k].y, vectors[k].z);
            assert!((c * v - v * values[k]).norm() < 1e-14 * expected[0] && (v.norm() - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn principal_directions_make_up_the_deformation_also_where_it_is_inside_out() {
    let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    for f in deformations().into_iter().flat_map(|f| [f, f * mirror]) {
        let principal = Principal::of((), columns(&f));
        let vector = |v: V3<f64>| Vector3::new(v.x, v.y, v.z);
        let sum: Matrix3<f64> = (0..3)
            .map(|k| {
                vector(principal.directions[k]) * vector(principal.at_rest[k]).transpose() * principal.stretches[k]
            })
            .sum();
        assert!((sum - f).norm() < 1e-13, "{sum} for {f}");
        assert!((matrix(principal.rotation()).determinant() - 1.0).abs() < 1e-13);
        assert!(principal.stretches[2] * f.determinant() > 0.0);
    }
}

#[test]
fn stresses_are_the_slopes_of_energies() {
    for law in LAWS {
        let elastic = Elastic { law, shear: 1.7, lame: 2.3 };
        for f in deformations() {
            let (_, stress) = elastic.stress((), columns(&f));
            let stress = matrix(stress);
            for k in 0..9 {
                let energy = |by: f64| {
                    let mut moved = f;
                    moved[k] += by;
                    elastic.stress((), columns(&moved)).0
                };
                let slope = (energy(1e-5) - energy(-1e-5)) / 2e-5;
                assert!((slope - stress[k]).abs() < 1e-8, "{law:?}: {slope} and {} of {f}", stress[k]);
            }
        }
    }
}

#[test]
fn curvatures_are_the_slopes_of_stresses_before_they_are_made_positive() {
    for law in [SolidLaw::Corotational, SolidLaw::StVenantKirchhoff, SolidLaw::NeoHookean] {
        let elastic = Elastic { law, shear: 1.7, lame: 2.3 };
        for f in deformations() {
            let principal = Principal::of((), columns(&f));
            let of = elastic.curvatures((), principal.stretches);
            // Block of two "atoms" with these gradients: the slope of −force by displacement, Σ ∂P_ac/∂F_bd g_c h_d.
            let (g, h) = ([0.3, -0.8, 0.5], [0.9, 0.2, -0.4]);
            let block = principal.block(principal.part((), g), principal.part((), h), &of, 1.0);
            let (g, h) = (Vector3::from(g), Vector3::from(h));
            for axis in 0..3 {
                let push = |by: f64| {
                    let mut moved = f;
                    (0..3).for_each(|c| moved[(axis, c)] += by * h[c]);
                    matrix(elastic.stress((), columns(&moved)).1) * g
                };
                let slope = (push(1e-5) - push(-1e-5)) / 2e-5;
                for row in 0..3 {
                    let found = [block[row].x, block[row].y, block[row].z][axis];
                    assert!((found - slope[row]).abs() < 1e-7, "{law:?}: {found} and {} at {f}", slope[row]);
                }
            }
        }
    }
}

#[test]
fn positive_parts_leave_alone_what_is_positive_and_have_nothing_negative() {
    let elastic = Elastic { law: SolidLaw::StVenantKirchhoff, shear: 1.7, lame: 2.3 };
    let at = |stretches: [f64; 3]| elastic.curvatures((), stretches);
    let (plain, kept) = (at([1.3, 1.1, 1.05]), at([1.3, 1.1, 1.05]).positive(()));
    for k in 0..3 {
        assert!((plain.stretch[0][k] - kept.stretch[0][k]).abs() < 1e-13 && plain.flip[k] == kept.flip[k]);
        assert!((plain.stretch[1][k] - kept.stretch[1][k]).abs() < 1e-13);
    }
    let pressed = at([0.9, 0.5, 0.2]).positive(());
    let [diagonal, across] = pressed.stretch;
    let whole = Matrix3::new(
        diagonal[0],
        across[2],
        across[1],
        across[2],
        diagonal[1],
        across[0],
        across[1],
        across[0],
        diagonal[2],
    );
    assert!(SymmetricEigen::new(whole).eigenvalues.min() > -1e-14);
    assert!(
        at([0.9, 0.5, 0.2]).twist.iter().any(|twist| *twist < 0.0) && pressed.twist.iter().all(|twist| *twist >= 0.0)
    );
}

/// Energy and forces of a body.
fn measure(solid: &Solid, positions: &[Vec3]) -> (f64, Vec<Vec3>) {
    let x: Vec<f64> = positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let (mut f, mut energy) = (vec![0.0; x.len()], [0.0]);
    measure_elastic(&[Force::Solid(solid.clone())], 1, &x, &mut f, &mut energy);
    (energy[0], f.chunks(3).map(|c| Vec3::new(c[0], c[1], c[2])).collect())
}

#[test]
fn moduli_are_those_of_small_strain_whatever_volumes_are_measured_over() {
    // Young's modulus 3 Pa and Poisson's ratio 0.3, pulled along z with free sides: the energy is E/2 ε² times the volume.
    let (young, poisson, strain) = (3.0, 0.3, 1e-4);
    let shear = young / (2.0 * (1.0 + poisson));
    let bulk = young / (3.0 * (1.0 - 2.0 * poisson));
    let body = rod([1.0, 1.0], 3.0, 2, 3).expect("a sound body");
    let rest = &body.surface.positions;
    let stretched: Vec<Vec3> = rest
        .iter()
        .map(|x| Vec3::new(x.x * (1.0 - poisson * strain), x.y * (1.0 - poisson * strain), x.z * (1.0 + strain)))
        .collect();
    let volume: f64 = body.volumes().sum();
    for law in LAWS {
        for parts in [None, Some(Parts::Tetrahedra), Some(Parts::Cells), Some(Parts::Atoms)] {
            if parts.is_none() && law == SolidLaw::NeoHookean {
                continue;
            }
            let lame = if parts.is_some() { -2.0 / 3.0 * shear } else { bulk - 2.0 / 3.0 * shear };
            let dilation =
                parts.map(|parts| Dilation::new(rest, &body.tetrahedra, &body.cells, DilationLaw::Bulk(bulk), parts));
            let solid = Solid::new(rest, &body.tetrahedra, Elastic { law, shear, lame }, dilation);
            let (energy, forces) = measure(&solid, &stretched);
            let expected = 0.5 * young * strain * strain * volume;
            // Of third order in the strain.
            assert!((energy / expected - 1.0).abs() < 1e-3, "{law:?} {parts:?}: {energy} for {expected}");
            // Nothing pulls at the sides: the forces on atoms between both ends are of second order.
            for (x, f) in rest.iter().zip(&forces).filter(|(x, _)| x.z.abs() < 1.4) {
                assert!(f.norm() < 3e-3 * young * strain, "{law:?} {parts:?}: {f} at {x}");
            }
        }
    }
}

#[test]
fn the_penalty_of_the_documents_pushes_with_the_square_of_the_change_of_volume() {
    let body = block([1.0, 1.0, 1.0], [1, 1, 1]).expect("a sound body");
    let rest = &body.surface.positions;
    let dilation = |law| Some(Dilation::new(rest, &body.tetrahedra, &body.cells, law, Parts::Tetrahedra));
    let elastic = Elastic { law: SolidLaw::Linear, shear: 0.0, lame: 0.0 };
    let solid = Solid::new(rest, &body.tetrahedra, elastic, dilation(DilationLaw::Penalty(5.0)));
    for by in [-0.2, 0.1] {
        let pressed: Vec<Vec3> = rest.iter().map(|x| Vec3::new(x.x * (1.0 + by), x.y, x.z)).collect();
        let (energy, forces) = measure(&solid, &pressed);
        assert!((energy - 5.0 / 3.0 * by.abs().powi(3)).abs() < 1e-12);
        let on_side: f64 = rest.iter().zip(&forces).filter(|(x, _)| x.x > 0.0).map(|(_, f)| f.x).sum();
        assert!((on_side + 5.0 * by * by.abs()).abs() < 1e-12, "{on_side} at {by}");
    }
}
