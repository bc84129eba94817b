//! The sweeps in wide registers against the same equations written plainly.

use super::change::Change;
use super::mobility::{Mobility, Response};
use super::rounds::Crew;
use super::rows::{Pairing, Pull, Row};
use super::sweep::sweep_contacts;
use super::vectors::V4;
use super::volumes::{VolumeRow, sweep_volumes};
use crate::Vec3;
use crate::geometry::icosphere;
use crate::mechanics::integrator::Order;
use crate::mechanics::modes::Modes;
use crate::mechanics::stiffness::StiffnessMatrix;
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
            coordinates: [u as f32, v as f32],
            normal_and_gap: [normal.x as f32, normal.y as f32, normal.z as f32, (0.05 * number(&mut dice)) as f32],
            least: if sticks { -0.3 } else { 0.0 },
            shear: if count % 4 > 1 { 0.2 } else { 0.0 },
            friction: if count % 7 == 0 { 0.3 } else { 0.0 },
            compliance: compliance as f32,
            across: compliance as f32,
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

/// Eqs. (adhesion.3) to (adhesion.5) and (adhesion.19) for one contact: what it should carry.
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
    let shear = f64::from(row.shear);
    if row.friction == 0.0 || stuck.norm() <= shear {
        return along * n + stuck.cap_magnitude(shear);
    }
    // Eq. (adhesion.19), by halving: what is held and the friction of how far it slides in a step, when it bears so much.
    let (mut low, mut high) = (shear, stuck.norm());
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let slid = (stuck.norm() - middle) * compliance;
        if shear + f64::from(row.friction) * slid / DT > middle { low = middle } else { high = middle }
    }
    along * n + low * stuck.normalize()
}

/// The step in which contacts rub, s.
const DT: f64 = 0.1;

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
        let (mut change, mut mobility) = (Change::default(), Mobility::default());
        mobility.turns.leave(rows.len());
        sweep_contacts(&rows, &mut pulls, &mut moved, &mut mobility, (DT, 0.0), &mut change, Crew::ALONE);
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
        let (inverse, swelling) = (1.0 / (0.2 * squared), 0.2 * 0.2 * squared);
        VolumeRow { first, end, offset, inverse, mobility: 0.2, swelling, column: None, body: 0 }
    };
    let volumes = [volume(0, 25, 0.3), volume(25, 40, -0.1)];
    let mut change = Change::default();
    sweep_volumes((&volumes, &[]), &gradient, &mut moved, &mut Mobility::default(), &mut change, Crew::ALONE);
    for volume in &volumes {
        let parts = gradient[volume.first..volume.end].iter().zip(&moved[volume.first..volume.end]);
        let along: f64 = parts.map(|(g, d)| (0..3).map(|axis| g[axis] * d[axis]).sum::<f64>()).sum();
        assert!((along + volume.offset).abs() < 1e-13, "{along} and {}", volume.offset);
    }
    let (mut again, before) = (Change::default(), moved.clone());
    sweep_volumes((&volumes, &[]), &gradient, &mut moved, &mut Mobility::default(), &mut again, Crew::ALONE);
    assert!(again.largest < 1e-13 * change.largest.max(1.0), "nothing is left: {again:?}");
    assert!(moved.iter().zip(&before).all(|(now, before)| now[3] == before[3]), "mobilities stay");
}

/// Two balls beside each other with springs along their edges, and how they give way.
fn balls() -> (Vec<Vec3>, Modes, Response) {
    let ball = icosphere(1.0, 1);
    let mut stiffness = StiffnessMatrix::new(ball.positions.len());
    for &[i, j, k] in &ball.facets {
        [(i, j), (j, k), (k, i)].into_iter().for_each(|(i, j)| stiffness.add_spring(i as usize, j as usize, 3.0));
    }
    let modes = Modes::new(&stiffness, &ball.positions, &vec![false; ball.positions.len()]);
    let response = Response::new(&modes, 1.0, (Order::First, 1.0), 0.5, 2.0);
    let other = ball.positions.iter().map(|x| x + Vec3::new(2.02, 0.1, 0.0));
    (ball.positions.iter().copied().chain(other).collect(), modes, response)
}

fn mobility_of(positions: &[Vec3], modes: &Modes, response: &Response) -> Mobility {
    let mut mobility = Mobility::default();
    mobility.clear(true);
    mobility.add_kind(Some(modes), response, 42);
    for first in [0, 42] {
        mobility.add_cell(first, response, false, positions[first..first + 42].iter().copied());
    }
    mobility.begin();
    mobility
}

/// A contact that bears everything between an atom of the second ball and a facet of the first.
fn row(atom: u32, normal: Vec3) -> Row {
    Row {
        atoms: [atom, 3, 17, 24],
        coordinates: [0.25, 0.35],
        normal_and_gap: [normal.x as f32, normal.y as f32, normal.z as f32, 0.0],
        least: -1e9,
        shear: 1e9,
        friction: 0.0,
        compliance: 0.0,
        across: 0.0,
        kept: 1.0,
        stored: 0.0,
        pairing: Pairing::AtomOnFacet,
    }
}

#[test]
fn a_force_of_a_contact_moves_and_turns_a_cell_as_free_drag_lets_it_and_dents_it_as_the_step_does() {
    let (positions, modes, response) = balls();
    let mut mobility = mobility_of(&positions, &modes, &response);
    // Without friction, so that one turn is all that it takes.
    let mut row = Row { shear: 0.0, ..row(50, Vec3::x()) };
    let (lever, [along, across]) = mobility.lever(&row, [1, 0], &positions);
    mobility.levers.push(lever);
    mobility.turns.leave(1);
    let alone: f64 = row.weights().iter().map(|weight| weight * weight * response.rest).sum();
    [row.compliance, row.across] = [(along + alone) as f32, (across + alone) as f32];
    // The second ball is pulled from where it is by what brings its atom back to the facet.
    let mut moved = vec![[0.0, 0.0, 0.0, response.rest]; 84];
    moved[50] = [0.3, 0.1, -0.2, response.rest];
    let (mut pulls, mut change) = (vec![Pull::default()], Change::default());
    sweep_contacts(&[row], &mut pulls, &mut moved, &mut mobility, (DT, 0.0), &mut change, Crew::ALONE);
    moved[50] = [moved[50][0] - 0.3, moved[50][1] - 0.1, moved[50][2] + 0.2, response.rest];
    let force = pulls[0].force();
    let displaced = |atom: usize| {
        let [x, y, z, _] = moved[atom];
        Vec3::new(x, y, z) + mobility.of_atom(atom / 42, atom % 42, positions[atom])
    };
    for (body, sign) in [(0, -1.0), (1, 1.0)] {
        let atoms = 42 * body..42 * body + 42;
        let centre = positions[atoms.clone()].iter().sum::<Vec3>() / 42.0;
        let mean = atoms.clone().map(displaced).sum::<Vec3>() / 42.0;
        // Forces are kept to seven digits.
        assert!((mean - sign * response.free * force / 42.0).norm() < 1e-7 * mean.norm(), "{mean} for {force}");
        let spin: Vec3 = atoms.clone().map(|atom| (positions[atom] - centre).cross(&displaced(atom))).sum();
        let loads = row.atoms.iter().zip(row.weights()).filter(|(atom, _)| atoms.contains(&(**atom as usize)));
        let torque: Vec3 =
            loads.map(|(atom, weight)| (positions[*atom as usize] - centre).cross(&(weight * force))).sum();
        // The shapes of a ball's rotations are modes but for what sets its atoms of five neighbours apart.
        assert!((spin - response.free * torque).norm() < 0.02 * spin.norm(), "{spin} for {}", response.free * torque);
    }
    // Along the normal the contact comes back in one turn: its compliance is that of the two balls.
    let apart: Vec3 =
        row.atoms.iter().zip(row.weights()).map(|(atom, weight)| weight * displaced(*atom as usize)).sum();
    assert!((apart.x + 0.3).abs() < 1e-6, "{apart}");
    assert!(f64::from(row.compliance) < 0.5 * response.free, "a stiff ball gives way less than free atoms do");
}

#[test]
fn a_sweep_by_modes_brings_volumes_to_their_targets() {
    let (positions, modes, response) = balls();
    let mut mobility = mobility_of(&positions, &modes, &response);
    let gradient: Vec<[f64; 3]> =
        (0..42).map(|atom| (0.3 * positions[atom] + Vec3::new(0.01, 0.0, 0.02)).into()).collect();
    let squared: f64 = gradient.iter().flatten().map(|g| g * g).sum();
    let parts = mobility.project(0, &gradient);
    let by_modes: f64 =
        parts.iter().zip(&response.modes).map(|(part, one)| one * part.iter().map(|p| p * p).sum::<f64>()).sum();
    let volume = VolumeRow {
        first: 0,
        end: 42,
        offset: 0.2,
        inverse: 1.0 / (response.rest * squared + by_modes),
        mobility: response.rest,
        swelling: 1.0,
        column: None,
        body: 0,
    };
    let mut moved = vec![[0.0, 0.0, 0.0, response.rest]; 84];
    sweep_volumes((&[volume], &[parts]), &gradient, &mut moved, &mut mobility, &mut Change::default(), Crew::ALONE);
    let displaced = |atom: usize| {
        Vec3::new(moved[atom][0], moved[atom][1], moved[atom][2]) + mobility.of_atom(0, atom, positions[atom])
    };
    let along: f64 = (0..42).map(|atom| Vec3::from(gradient[atom]).dot(&displaced(atom))).sum();
    assert!((along + 0.2).abs() < 1e-12, "{along}");
}
