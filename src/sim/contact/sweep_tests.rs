//! The sweeps in wide registers against the same equations written plainly.

use super::rows::{Pairing, Pull, Row};
use super::sweep::{Change, V4, VolumeRow, sweep_contacts, sweep_volumes};
use crate::Vec3;
use crate::random::{Purpose, Stream};

const ATOMS: u32 = 40;

fn number(dice: &mut Stream) -> f64 {
    2.0 * dice.uniform_pair()[0] - 1.0
}

fn vector(dice: &mut Stream) -> Vec3 {
    Vec3::from_fn(|_, _| number(dice))
}

/// Displacements with mobilities, and contacts of every kind between random atoms.
fn scene(seed: u64) -> (Vec<V4>, Vec<Row>, Vec<Pull>) {
    let mut dice = Stream::new(seed, Purpose::Placement, 0, 0);
    let moved = (0..ATOMS).map(|atom| {
        let (d, mobility) = (0.1 * vector(&mut dice), if atom % 7 == 0 { 0.0 } else { 0.2 });
        [d.x, d.y, d.z, mobility]
    });
    let moved: Vec<V4> = moved.collect();
    let (mut rows, mut pulls) = (Vec::new(), Vec::new());
    for count in 0..60u32 {
        let first = (3 * count + seed as u32) % ATOMS;
        let atoms = [0, 5, 11, 22].map(|step| (first + step * (1 + count % 3)) % ATOMS);
        let [u, v] = [0.3 * number(&mut dice).abs(), 0.3 * number(&mut dice).abs()];
        let normal = vector(&mut dice).normalize();
        let compliance: f64 = atoms
            .iter()
            .zip([1.0, u + v - 1.0, -u, -v])
            .map(|(atom, weight): (&u32, f64)| weight * weight * moved[*atom as usize][3])
            .sum();
        let sticks = count % 4 > 0;
        rows.push(Row {
            atoms,
            coordinates: [u, v],
            normal_and_gap: [normal.x as f32, normal.y as f32, normal.z as f32, (0.05 * number(&mut dice)) as f32],
            least: if sticks { -0.3 } else { 0.0 },
            shear: if count % 4 > 1 { 0.2 } else { 0.0 },
            compliance: compliance as f32,
            kept: 1.0 / (1.0 + 0.05 * (count % 5) as f32),
            stored: 0.0,
            pairing: Pairing::AtomOnFacet,
        });
        let along = if sticks { number(&mut dice).max(-0.3) } else { number(&mut dice).abs() };
        let force = (along * normal).map(|part| part as f32);
        let force = [force.x, force.y, force.z];
        pulls.push(Pull { force, carried: force, ..Pull::default() });
    }
    (moved, rows, pulls)
}

/// Eqs. (adhesion.3) to (adhesion.5) for one contact: what it should carry.
fn plain_turn(row: &Row, force: Vec3, carried: Vec3, moved: &[Vec3]) -> Vec3 {
    let (n, gap, compliance, softness) =
        (row.normal(), row.gap(), f64::from(row.compliance), 1.0 / f64::from(row.kept) - 1.0);
    let apart: Vec3 = row.atoms.iter().zip(row.weights()).map(|(atom, weight)| weight * moved[*atom as usize]).sum();
    let free = gap + n.dot(&apart) - n.dot(&force) * compliance;
    let along = if free < gap.min(0.0) {
        (gap.min(0.0) - free) / compliance
    } else {
        let pull = ((gap.max(0.0) - free) / compliance + softness * n.dot(&carried).min(0.0)) / (1.0 + softness);
        pull.min(0.0).max(f64::from(row.least))
    };
    let across = |v: Vec3| v - n.dot(&v) * n;
    let stuck = (across(force) - across(apart) / compliance + softness * across(carried)) / (1.0 + softness);
    along * n + stuck.cap_magnitude(f64::from(row.shear))
}

#[test]
fn a_sweep_in_wide_registers_is_that_of_the_book() {
    for seed in 1..20 {
        let (mut moved, rows, mut pulls) = scene(seed);
        let mut plain: Vec<Vec3> = moved.iter().map(|d| Vec3::new(d[0], d[1], d[2])).collect();
        let (mut work, mut largest) = (0.0, 0.0_f64);
        let mut forces: Vec<Vec3> = pulls.iter().map(Pull::force).collect();
        for ((row, pull), force) in
            rows.iter().zip(&pulls).zip(&mut forces).filter(|((row, _), _)| row.compliance > 0.0)
        {
            let change = plain_turn(row, *force, pull.force(), &plain) - *force;
            *force += change;
            for (atom, weight) in row.atoms.iter().zip(row.weights()) {
                plain[*atom as usize] += moved[*atom as usize][3] * weight * change;
            }
            work += change.norm_squared() * f64::from(row.compliance);
            largest = largest.max(change.norm() * f64::from(row.compliance));
        }
        let mut change = Change::default();
        sweep_contacts(&rows, &mut pulls, &mut moved, 0.0, &mut change);
        for (fast, plain) in moved.iter().zip(&plain) {
            // Forces are kept to seven digits.
            assert!((Vec3::new(fast[0], fast[1], fast[2]) - plain).norm() < 1e-6, "{seed}: {fast:?} and {plain:?}");
        }
        for (pull, plain) in pulls.iter().zip(&forces) {
            assert!((pull.force() - plain).norm() < 1e-5, "{seed}: {:?} and {plain:?}", pull.force());
        }
        assert!((change.work / work - 1.0).abs() < 1e-5 && (change.largest / largest - 1.0).abs() < 1e-5, "{change:?}");
    }
}

#[test]
fn a_sweep_over_volumes_meets_every_linear_target() {
    let (mut moved, ..) = scene(3);
    let mut dice = Stream::new(4, Purpose::Placement, 0, 0);
    let gradient: Vec<[f64; 3]> = (0..ATOMS).map(|_| vector(&mut dice).into()).collect();
    let volume = |first: usize, end: usize, offset: f64| {
        let squared: f64 = gradient[first..end].iter().flatten().map(|g| g * g).sum();
        VolumeRow { first, end, offset, inverse: 1.0 / squared, mobility: 0.2 }
    };
    let volumes = [volume(0, 25, 0.3), volume(25, 40, -0.1)];
    let mut change = Change::default();
    sweep_volumes(&volumes, &gradient, &mut moved, &mut change);
    for volume in &volumes {
        let parts = gradient[volume.first..volume.end].iter().zip(&moved[volume.first..volume.end]);
        let along: f64 = parts.map(|(g, d)| (0..3).map(|axis| g[axis] * d[axis]).sum::<f64>()).sum();
        assert!((along + volume.offset).abs() < 1e-13, "{along} and {}", volume.offset);
    }
    let (mut again, before) = (Change::default(), moved.clone());
    sweep_volumes(&volumes, &gradient, &mut moved, &mut again);
    assert!(again.largest < 1e-13 * change.largest.max(1.0), "nothing is left: {again:?}");
    assert!(moved.iter().zip(&before).all(|(now, before)| now[3] == before[3]), "mobilities stay");
}
