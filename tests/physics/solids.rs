//! Filled bodies: the patch test on irregular meshes, beams against the elastica, the order of the step, and the books of a body that is
//! moved by grips.

use nalgebra::Matrix3;
use pseudopod::Vec3;
use pseudopod::geometry::Solid as Body;
use pseudopod::geometry::solid::{block, rod};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::integrator::{Integrator, Method, Order, StepSize};
use pseudopod::mechanics::solid::Solid;
use pseudopod::mechanics::solid::dilation::{Dilation, DilationLaw, Parts};
use pseudopod::mechanics::solid::law::{Elastic, SolidLaw};
use pseudopod::mechanics::sum::measure_elastic;
use pseudopod::sim::{Kind, Model, State, VolumeRule, Workspace, step};

const LAWS: [SolidLaw; 4] =
    [SolidLaw::Linear, SolidLaw::Corotational, SolidLaw::StVenantKirchhoff, SolidLaw::NeoHookean];

/// A number between −1 and 1 that looks random and is always the same.
fn noise(index: usize) -> f64 {
    let x = (index as f64 * 12.9898 + 4.1414).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// A block whose inner atoms are moved about by a third of an edge, and which of its atoms are inner.
fn irregular() -> (Body, Vec<bool>) {
    let mut body = block([2.0, 2.0, 2.0], [4, 4, 4]).expect("a sound body");
    let outer = body.outer_atoms();
    for (atom, x) in body.surface.positions.iter_mut().enumerate().skip(outer) {
        *x += Vec3::new(noise(3 * atom), noise(3 * atom + 1), noise(3 * atom + 2)) * 0.15;
    }
    let inner = (0..body.surface.positions.len()).map(|atom| atom >= outer).collect();
    (body, inner)
}

/// The material of shear modulus 1.4 Pa and bulk modulus 3 Pa.
fn material(body: &Body, law: SolidLaw, parts: Option<Parts>) -> Solid {
    let (shear, bulk) = (1.4, 3.0);
    let rest = &body.surface.positions;
    let lame = if parts.is_some() { 0.0 } else { bulk } - 2.0 / 3.0 * shear;
    let dilation =
        parts.map(|parts| Dilation::new(rest, &body.tetrahedra, &body.cells, DilationLaw::Bulk(bulk), parts));
    Solid::new(rest, &body.tetrahedra, Elastic { law, shear, lame }, dilation)
}

fn forces(solid: &Solid, positions: &[Vec3]) -> Vec<Vec3> {
    let x: Vec<f64> = positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let mut f = vec![0.0; x.len()];
    measure_elastic(&[Force::Solid(solid.clone())], 1, &x, &mut f, &mut [0.0]);
    f.chunks(3).map(|c| Vec3::new(c[0], c[1], c[2])).collect()
}

/// Where every atom of a body goes in the same deformation there is no force on those inside, whatever the mesh: the patch test.
#[test]
fn every_material_passes_the_patch_test_on_an_irregular_mesh() {
    let (body, inner) = irregular();
    let deformation = Matrix3::new(1.2, 0.1, -0.05, 0.02, 0.9, 0.15, -0.1, 0.05, 1.1);
    let positions: Vec<Vec3> =
        body.surface.positions.iter().map(|x| deformation * x + Vec3::new(0.3, -0.2, 0.1)).collect();
    for law in LAWS {
        for parts in [None, Some(Parts::Tetrahedra), Some(Parts::Cells), Some(Parts::Atoms)] {
            let f = forces(&material(&body, law, parts), &positions);
            let largest = f.iter().map(|f| f.norm()).fold(0.0, f64::max);
            let inside = f.iter().zip(&inner).filter(|(_, inner)| **inner).map(|(f, _)| f.norm()).fold(0.0, f64::max);
            // Sums of some hundred terms of round-off.
            assert!(inside < 1e-13 * largest && largest > 0.1, "{law:?} {parts:?}: {inside} of {largest}");
        }
    }
}

fn kind_of(body: &Body, solid: Solid) -> Kind {
    let mut kind = Kind::new("body", body.surface.clone(), vec![Force::Solid(solid)]);
    kind.volume = VolumeRule::Free;
    kind
}

fn model_of(mut kind: Kind, order: Order, size: StepSize, until: f64) -> Model {
    kind.bound_stiffness();
    kind.use_tangent(false);
    Model::of(vec![kind], Integrator { method: Method::Implicit { order }, size }, until)
}

fn run_to_end(model: &Model, positions: Vec<Vec3>) -> (Vec<Vec3>, u64) {
    let mut state = State::new(model, &[vec![positions]]);
    let mut ws = Workspace::new(model);
    while state.time < model.until {
        step(model, &mut state, &mut ws).unwrap_or_else(|trouble| panic!("{trouble}"));
    }
    (state.kinds[0].cell(&model.kinds[0], 0), state.step)
}

/// Inner atoms come to where the deformation has them when the surface is held there, in some long steps (where pressed, a part of the true stiffness is left out).
#[test]
fn a_body_whose_surface_is_held_in_a_deformation_comes_to_rest_in_it() {
    let (body, inner) = irregular();
    let deformation = Matrix3::new(1.15, 0.1, 0.0, 0.0, 0.95, 0.1, 0.05, 0.0, 1.05);
    let goal: Vec<Vec3> = body.surface.positions.iter().map(|x| deformation * x).collect();
    for law in LAWS {
        for parts in [None, Some(Parts::Cells)] {
            if parts.is_none() && law == SolidLaw::NeoHookean {
                continue; // Nothing else keeps volumes.
            }
            let mut kind = kind_of(&body, material(&body, law, parts));
            kind.held = inner.iter().flat_map(|inner| [if *inner { 1.0 } else { 0.0 }; 3]).collect();
            let model = model_of(kind, Order::First, StepSize::Fixed(1e4), 4e5);
            let start = goal.iter().zip(&inner).map(|(x, inner)| if *inner { x * 0.93 } else { *x }).collect();
            let (end, _) = run_to_end(&model, start);
            let off = end.iter().zip(&goal).map(|(x, goal)| (x - goal).norm()).fold(0.0, f64::max);
            assert!(off < 1e-7, "{law:?} {parts:?}: {off}");
        }
    }
}

/// A rod that was drawn out and bent relaxes with second order in the step.
#[test]
fn the_step_of_a_filled_body_is_of_second_order() {
    let body = rod([1.0, 1.0], 4.0, 1, 4).expect("a sound body");
    for law in LAWS {
        let parts = if law == SolidLaw::NeoHookean { Some(Parts::Cells) } else { None };
        let start: Vec<Vec3> = body
            .surface
            .positions
            .iter()
            .map(|p| Vec3::new(p.x * 0.95 + 0.03 * p.z * p.z, p.y * 0.95, 1.15 * p.z))
            .collect();
        let ended = |dt: f64| {
            let model = model_of(kind_of(&body, material(&body, law, parts)), Order::Second, StepSize::Fixed(dt), 0.8);
            run_to_end(&model, start.clone()).0
        };
        let finest = ended(0.8 / 512.0);
        let off = [8.0, 16.0, 32.0, 64.0].map(|steps| {
            let end = ended(0.8 / steps);
            end.iter().zip(&finest).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max)
        });
        let ratios: Vec<f64> = off.windows(2).map(|pair| pair[0] / pair[1]).collect();
        println!("{law:?}: off by {off:?}, {ratios:?}");
        // Four in the limit.
        assert!(ratios[2] > 3.5 && off[3] < 1e-3, "{law:?}: {off:?}");
    }
}
