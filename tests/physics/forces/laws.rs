//! What each force must do by its own law.

use super::cases::{EDGE, cell, gradient_error, largest, on};
use pseudopod::Vec3;
use pseudopod::geometry::{Surface, Topology, icosphere, sheet};
use pseudopod::mechanics::Force;
use pseudopod::mechanics::angles::Angles;
use pseudopod::mechanics::barrier::{Barrier, BarrierRules};
use pseudopod::mechanics::bending::{Bending, RestAngle};
use pseudopod::mechanics::membrane::{Membrane, MembraneLaw};
use pseudopod::mechanics::shape_memory::{Reaction, ShapeMemory, reference};
use pseudopod::mechanics::tension::Tension;
use std::f64::consts::PI;

/// The cell with one atom moved onto the middle between two others of its neighbour's ring and beyond, eq. (shape.5).
#[test]
fn shape_memory_stays_smooth_where_a_triplet_collapses_and_turns_over() {
    let surface = cell();
    let rings: Vec<Vec<u32>> = Topology::of(&surface).rings.iter().map(|ring| ring.atoms.clone()).collect();
    let memory = ShapeMemory::new(&surface.positions, &rings, 1.3, Reaction::Exact);
    let corner = [rings[0][0], rings[0][1], rings[0][2]].map(|i| i as usize);
    let [a, b, c] = corner.map(|i| surface.positions[i]);
    let mut largest_force = Vec::new();
    for share in [0.5, 0.9, 0.99, 1.0, 1.001, 1.1] {
        let mut positions = surface.positions.clone();
        positions[corner[1]] = b + share * (0.5 * (a + c) - b);
        let force = Force::ShapeMemory(memory.clone());
        let (energy, forces) = on(&force, &positions);
        let (error, at) = gradient_error(&force, &positions, &forces);
        // As above; the third derivative near the collapse is larger by (1/0.2)^2.
        assert!(error < 1e-6, "{share} of the way, {at}: off by {error:e} of the largest force");
        let mut plain = vec![Vec3::zeros(); positions.len()];
        let plain_energy = reference::add_forces(&memory, &positions, &mut plain);
        assert!((energy - plain_energy).abs() < 1e-12 * energy, "{share}: energy {energy} and plainly {plain_energy}");
        for (force, plain) in forces.iter().zip(&plain) {
            assert!((force - plain).norm() < 1e-11 * largest(&forces), "{share}: {force:?} and plainly {plain:?}");
        }
        largest_force.push(largest(&forces));
    }
    // With 1/|N| forces would grow without bound on the last tenth of the way; they grow as they did before it.
    let worst = largest_force[1..].iter().fold(0.0_f64, |most, &f| most.max(f));
    assert!(worst < 1.25 * largest_force[1], "forces on the way to the line: {largest_force:?}");
}

/// A flat sheet of 4 by 3 µm, and the same sheet stretched by the two factors.
fn stretched_sheet(along: f64, across: f64) -> (Surface, Vec<Vec3>) {
    let surface = sheet(4.0, 3.0, 5, 4);
    let stretched = surface.positions.iter().map(|p| Vec3::new(p.x * along, p.y * across, p.z)).collect();
    (surface, stretched)
}

/// W(λ₁, λ₂) as the book writes it, in principal stretches.
fn book_energy(law: MembraneLaw, a: f64, b: f64) -> f64 {
    match law {
        MembraneLaw::Skalak { shear, area } => {
            let (i1, i2) = (a * a + b * b - 2.0, (a * b).powi(2) - 1.0);
            0.25 * shear * (i1 * i1 + 2.0 * i1 - 2.0 * i2) + 0.125 * (area - shear) * i2 * i2
        }
        MembraneLaw::NeoHookean { shear, area, hardening } => {
            let s = (a - b).powi(2) / (a * b);
            0.5 * shear * s + hardening * shear * s.powi(3) + 0.5 * area * (a * b - 1.0).powi(2)
        }
    }
}

const LAWS: [MembraneLaw; 3] = [
    MembraneLaw::Skalak { shear: 2.5, area: 20.0 },
    MembraneLaw::NeoHookean { shear: 2.5, area: 20.0, hardening: 0.0 },
    MembraneLaw::NeoHookean { shear: 2.5, area: 20.0, hardening: 1.0 / 30.0 },
];

#[test]
fn a_stretched_sheet_pulls_as_the_closed_form_says() {
    for law in LAWS {
        for (a, b) in [(1.6, 1.0), (1.5, 0.7), (1.2, 1.2), (0.8, 0.9)] {
            let (surface, positions) = stretched_sheet(a, b);
            let membrane = Force::Membrane(Membrane::new(&surface.positions, &surface.facets, law));
            let (energy, forces) = on(&membrane, &positions);
            let expected = 12.0 * book_energy(law, a, b);
            assert!((energy - expected).abs() < 1e-11 * expected.abs().max(1.0), "{law:?}: {energy} for {expected}");
            // Virtual work: all forces times positions along x equal −A₀ λ₁ ∂W/∂λ₁.
            let work: f64 = positions.iter().zip(&forces).map(|(x, f)| x.x * f.x).sum();
            let slope = (book_energy(law, a + 1e-5, b) - book_energy(law, a - 1e-5, b)) / 2e-5;
            // The central difference of the reference is good to 1e-9.
            assert!((work + 12.0 * a * slope).abs() < 1e-7 * work.abs().max(1.0), "{law:?} at {a}, {b}: {work}");
        }
    }
}

#[test]
fn small_strains_give_the_moduli_back() {
    let strain = 1e-4;
    for law in LAWS {
        let energy_of = |a: f64, b: f64| {
            let (surface, positions) = stretched_sheet(a, b);
            on(&Force::Membrane(Membrane::new(&surface.positions, &surface.facets, law)), &positions).0 / 12.0
        };
        let area =
            (energy_of(1.0 + strain, 1.0 + strain) + energy_of(1.0 - strain, 1.0 - strain)) / (2.0 * strain).powi(2);
        let shear =
            (energy_of(1.0 + strain, 1.0 - strain) + energy_of(1.0 - strain, 1.0 + strain)) / (2.0 * strain).powi(2);
        // Higher terms are 1e-8 of the energy, its round-off 1e-16/1e-8.
        assert!((area / law.area() - 1.0).abs() < 1e-6, "{law:?}: area modulus {area}");
        assert!((shear / law.shear() - 1.0).abs() < 1e-6, "{law:?}: shear modulus {shear}");
    }
}

#[test]
fn tension_pulls_a_bubble_together_as_laplace_says() {
    let bubble = icosphere(3.0, 2);
    let tension = Force::Tension(Tension::new(&bubble.positions, &bubble.facets, 1.7, 0.0));
    let (energy, forces) = on(&tension, &bubble.positions);
    let area = pseudopod::geometry::area(&bubble);
    let virial: f64 = bubble.positions.iter().zip(&forces).map(|(x, f)| x.dot(f)).sum();
    // The area is homogeneous of degree two: Σ x·f = −2 γ A, which is 3 V times Laplace's −2γ/R.
    assert!((energy - 1.7 * area).abs() < 1e-11 * energy);
    assert!((virial + 2.0 * 1.7 * area).abs() < 1e-11 * energy, "{virial}");
}

#[test]
fn a_sphere_has_helfrichs_bending_energy() {
    for (level, within) in [(1, 0.05), (2, 0.013), (3, 0.0033), (4, 0.0009)] {
        let sphere = icosphere(3.0, level);
        let bending = Bending::new(&sphere.positions, &Topology::of(&sphere), 0.3, RestAngle::Flat);
        let (energy, _) = on(&Force::Bending(bending), &sphere.positions);
        let error = energy / (8.0 * PI * 0.3) - 1.0;
        println!("level {level}: 8πκ to {error:e}");
        assert!(error.abs() < within, "level {level}: off by {error}");
    }
}

#[test]
fn an_ellipsoid_has_helfrichs_bending_energy() {
    // ½ ∮ (c₁ + c₂)² of half axes a, a, c at the polar angle t of its parameter, with q = c² sin² t + a² cos² t:
    // c₁ = a c/q^(3/2) and c₂ = c/(a √q).
    for (a, c) in [(1.0_f64, 2.0_f64), (1.0, 0.5)] {
        let panels = 10_000;
        let exact: f64 = (0..panels)
            .map(|panel| {
                let (sine, cosine) = (PI * (f64::from(panel) + 0.5) / f64::from(panels)).sin_cos();
                let root = (c * sine).hypot(a * cosine);
                let sum = a * c / root.powi(3) + c / (a * root);
                0.5 * sum * sum * 2.0 * PI * a * sine * root * PI / f64::from(panels)
            })
            .sum();
        let errors = [2, 3].map(|level| {
            let mut surface = icosphere(1.0, level);
            surface.positions.iter_mut().for_each(|x| *x = Vec3::new(a * x.x, a * x.y, c * x.z));
            let bending = Bending::new(&surface.positions, &Topology::of(&surface), 1.0, RestAngle::Flat);
            on(&Force::Bending(bending), &surface.positions).0 / exact - 1.0
        });
        println!("half axes {a}, {a}, {c}: {exact} to {errors:.5?}");
        assert!(errors[0].abs() < 0.016 && errors[1].abs() < 0.004, "{errors:?}");
    }
}

#[test]
fn bending_does_not_resist_atoms_that_shift_along_a_sphere() {
    // Twice the energy of a small shift v ∇P₂ or swelling w P₂ of a sphere that remembers its curvature, over v² or w² and ∮P₂² = 4π/5:
    // κ (λ − 2)² = 16 κ for the latter with λ = l (l + 1).
    let sphere = icosphere(1.0, 3);
    let bending = Force::Bending(Bending::new(&sphere.positions, &Topology::of(&sphere), 1.0, RestAngle::Remembered));
    let coefficient = |moved: &dyn Fn(&Vec3, f64) -> Vec3| {
        let energy = |by: f64| on(&bending, &sphere.positions.iter().map(|x| moved(x, by)).collect::<Vec<_>>()).0;
        (energy(1e-3) + energy(-1e-3)) / 1e-6 / (0.8 * PI)
    };
    let along = coefficient(&|x, by| (x + 3.0 * by * x.z * (Vec3::z() - x.z * x)).normalize());
    let across = coefficient(&|x, by| x * (1.0 + by * (1.5 * x.z * x.z - 0.5)));
    println!("along {along:.4} κ, across {across:.4} κ");
    assert!(along < 0.01 && (across / 16.0 - 1.0).abs() < 0.02, "{along} and {across}");
}

#[test]
fn a_cylinder_has_helfrichs_bending_energy() {
    // 12 µm around, so radius 12/2π, less a gap of one facet where the sheet does not close.
    let (around, height, columns) = (12.0, 6.0, 48);
    let surface = sheet(around, height, columns, 24);
    let radius = around / (2.0 * PI);
    let bending = Force::Bending(Bending::new(&surface.positions, &Topology::of(&surface), 0.3, RestAngle::Flat));
    let rolled: Vec<Vec3> = surface
        .positions
        .iter()
        .map(|p| Vec3::new(radius * (p.x / radius).cos(), p.y, radius * (p.x / radius).sin()))
        .collect();
    let (energy, _) = on(&bending, &rolled);
    let bent = around * height * (1.0 - 1.0 / f64::from(columns));
    let expected = 0.5 * 0.3 / radius.powi(2) * bent;
    // 1 − cos θ is short of θ²/2 by θ²/12 of it (0.14 %).
    assert!((energy / expected - 1.0).abs() < 2e-3, "{energy} for {expected}");
}

/// The smallest facet area over its rest value, and the largest angle between neighbouring normals.
fn worst(surface: &Surface, rest: &[f64]) -> (f64, f64) {
    let areas = pseudopod::geometry::facet_areas(surface);
    let smallest = areas.iter().zip(rest).map(|(a, r)| a / r).fold(f64::INFINITY, f64::min);
    let normal = |facet: [u32; 3]| {
        let [a, b, c] = surface.corners(facet);
        (b - a).cross(&(c - a)).normalize()
    };
    let angle = Topology::of(surface)
        .flaps
        .iter()
        .map(|flap| flap.facets.map(|facet| normal(surface.facets[facet as usize])))
        .map(|[left, right]| left.dot(&right).clamp(-1.0, 1.0).acos())
        .fold(0.0, f64::max);
    (smallest, angle)
}

/// Lets a cell with shape memory creep under a load for a while, with or without the barrier.
fn crept(load: &[(usize, Vec3)], barrier: f64) -> (f64, f64) {
    let mut surface = icosphere(3.0, 1);
    let topology = Topology::of(&surface);
    let rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let memory = Force::ShapeMemory(ShapeMemory::new(&surface.positions, &rings, 1.0, Reaction::Exact));
    let rules = BarrierRules::with_energy(barrier);
    let wall = Force::Barrier(Barrier::new(&surface.positions, &surface.facets, &topology.flaps, rules));
    let rest = pseudopod::geometry::facet_areas(&surface);
    let mut seen = (f64::INFINITY, 0.0f64);
    for _ in 0..4000 {
        let (_, elastic) = on(&memory, &surface.positions);
        let (_, stopping) = on(&wall, &surface.positions);
        let mut total: Vec<Vec3> = elastic.iter().zip(&stopping).map(|(a, b)| a + b).collect();
        load.iter().for_each(|&(atom, force)| total[atom] += force);
        // Explicit Euler with ζ/k = 1, no atom moving more than a hundredth of an edge at once.
        let step = (0.02f64).min(0.01 * EDGE / largest(&total));
        surface.positions.iter_mut().zip(&total).for_each(|(x, f)| *x += f * step);
        let now = worst(&surface, &rest);
        seen = (seen.0.min(now.0), seen.1.max(now.1));
    }
    seen
}

#[test]
fn a_facet_driven_towards_collapse_is_stopped() {
    let sphere = icosphere(3.0, 1);
    let [a, b] = Topology::of(&sphere).edges[5].map(|atom| atom as usize);
    let squeeze = (sphere.positions[b] - sphere.positions[a]).normalize() * 3.0;
    let load = [(a, squeeze), (b, -squeeze)];
    let (free, _) = crept(&load, 0.0);
    let (stopped, _) = crept(&load, 1.0);
    assert!(free < 0.02, "without the barrier the facet must collapse, its area fell to {free}");
    assert!(stopped > 0.05, "the facet's area fell to {stopped} of its rest value");
}

#[test]
fn an_edge_driven_towards_folding_is_stopped() {
    let sphere = icosphere(3.0, 1);
    let push = sphere.positions[0].normalize() * 6.0;
    let load = [(0, -push), (11, push)];
    let (_, free) = crept(&load, 0.0);
    let (_, stopped) = crept(&load, 1.0);
    println!("folds {free} and {stopped}");
    assert!(free > 3.0, "without the barrier the edge must fold over, the normals are {free} rad apart");
    // There cos²(θ/2) is 0.002: the facets are 5° apart.
    assert!(stopped < 3.05, "the normals are {stopped} rad apart");
}

#[test]
fn the_barrier_does_nothing_in_ordinary_deformation() {
    // Stretched to twice its length at the same volume.
    let sphere = icosphere(3.0, 2);
    let flaps = Topology::of(&sphere).flaps;
    let rules = BarrierRules::with_energy(1.0);
    let barrier = Force::Barrier(Barrier::new(&sphere.positions, &sphere.facets, &flaps, rules));
    let thin = 2f64.powf(-0.5);
    let drawn: Vec<Vec3> = sphere.positions.iter().map(|p| Vec3::new(2.0 * p.x, thin * p.y, thin * p.z)).collect();
    let (energy, forces) = on(&barrier, &drawn);
    assert_eq!(energy, 0.0);
    assert_eq!(largest(&forces), 0.0);
}

#[test]
fn angles_draw_an_atom_on_two_fixed_ones_back_to_its_target() {
    let positions = [Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.3, 0.8, 0.0)];
    let angles = Angles::new(&positions, &[vec![], vec![], vec![0, 1]], 2.0);
    assert!((angles.stances()[2].gamma - 0.3f64.hypot(0.8)).abs() < 1e-15);
    let off = Vec3::new(0.05, -0.02, 0.0);
    let (energy, forces) = on(&Force::Angles(angles), &[positions[0], positions[1], positions[2] + off]);
    assert!((forces[2] + 2.0 * off).norm() < 1e-14, "{}", forces[2]);
    assert!((forces[0] - off).norm() < 1e-14, "each neighbour bears half: {}", forces[0]);
    assert!((energy - off.norm_squared()).abs() < 1e-14);
}
