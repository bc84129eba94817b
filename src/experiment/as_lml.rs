//! The loads of an experiment as a document of LML, for the model that its cells are written as.

use crate::Vec3;
use crate::mechanics::Force;
use crate::mechanics::load;
use crate::physical_model::Attributes;
use crate::physical_model::lml::{Component, Direction, Line, Load, LoadKind, Loads, Target, ValueEvent};
use crate::sim::{Kind, Model};
use std::collections::BTreeMap;

/// The loads on some cells, and what of them LML has no words for, a few words each. Of each cell its type and the index of
/// its first atom in the physical model.
pub fn loads_as_lml(model: &Model, cells: &[(usize, u32)]) -> (Loads, Vec<&'static str>) {
    let (mut loads, mut untold) = (Vec::new(), Vec::new());
    for (kind, first) in cells.iter().filter_map(|(kind, first)| Some((model.kinds.get(*kind)?, *first))) {
        held(kind, first, &mut loads);
        if kind.moved.iter().any(|moved| moved.rotation.is_some()) {
            untold.push("atoms that turn");
        }
        for force in &kind.forces {
            match force {
                Force::Load(own) => forces(own, first, &mut loads),
                Force::Gravity(weight) => {
                    let atoms =
                        vec![Target::Range(first, first + (kind.rest.positions.len() as u32).saturating_sub(1))];
                    let directed = Some(direction(weight.acceleration.map(|along| along / 1e3)));
                    loads.push(made(LoadKind::Acceleration, atoms, directed, vec![(0.0, 1.0)], "mm/s^2"));
                }
                Force::Springs(_) => untold.push("springs and links"),
                Force::Fibres(_) => untold.push("fibres"),
                Force::Trap(_) => untold.push("traps"),
                Force::Plate(_) => untold.push("flexible plates"),
                Force::Pressure(_) => untold.push("pressures along normals"),
                Force::Torque(_) => untold.push("torques"),
                _ => {}
            }
        }
    }
    untold.sort_unstable();
    untold.dedup();
    (Loads { loads, ..Loads::default() }, untold)
}

/// A load for each share that atoms have of a force: in LML each atom has the whole value.
fn forces(own: &load::Load, first: u32, loads: &mut Vec<Load>) {
    let mut shares: BTreeMap<u64, Vec<u32>> = BTreeMap::new();
    for (atom, share) in own.atoms.iter().filter(|(_, share)| *share > 0.0) {
        shares.entry(share.to_bits()).or_default().push(first + atom);
    }
    for (share, atoms) in shares {
        let points = own.force.points().iter().map(|(time, force)| (*time, force * f64::from_bits(share)));
        let mut points: Vec<(f64, f64)> = points.collect();
        // A course is constant before its first point, and in LML nothing.
        if let Some((_, value)) = points.first().copied().filter(|(time, value)| *time > 0.0 && *value != 0.0) {
            points.insert(0, (0.0, value));
        }
        loads.push(made(LoadKind::Force, targets(&atoms), Some(direction(own.direction)), points, "pN"));
    }
}

/// Atoms that are held or moved, but for those that turn: one load for each set of axes and course.
fn held(kind: &Kind, first: u32, loads: &mut Vec<Load>) {
    let mut by_axes: BTreeMap<(Option<usize>, [bool; 3]), Vec<u32>> = BTreeMap::new();
    for (atom, factors) in (0..).zip(kind.held.as_chunks::<3>().0) {
        let axes = factors.map(|factor| factor == 0.0);
        let course = kind.moved.iter().position(|moved| moved.atoms.binary_search(&atom).is_ok());
        let turns = course.is_some_and(|number| kind.moved[number].rotation.is_some());
        if axes != [false; 3] && !turns {
            by_axes.entry((course, axes)).or_default().push(first + atom);
        }
    }
    for ((course, axes), atoms) in by_axes {
        let line = course.and_then(|number| kind.moved[number].translation.as_ref());
        let along = |axis: usize| match line.map_or(0.0, |line| line.direction[axis]) {
            _ if !axes[axis] => Component::Free,
            0.0 => Component::Null,
            along => Component::Number(along),
        };
        let directed = Some(Direction { components: [0, 1, 2].map(along), ..Direction::default() });
        let (points, unit) = match line {
            Some(line) => (line.displacement.points().to_vec(), "micron"),
            None => (vec![(0.0, 1.0)], "mm"),
        };
        loads.push(made(LoadKind::Translation, targets(&atoms), directed, points, unit));
    }
}

fn direction(along: Vec3) -> Direction {
    Direction { components: <[f64; 3]>::from(along).map(Component::Number), ..Direction::default() }
}

/// Indices that rise, as ranges where there are some.
fn targets(atoms: &[u32]) -> Vec<Target> {
    let runs = atoms.chunk_by(|one, next| one + 1 == *next);
    runs.map(|run| match run {
        [only] => Target::Index(*only),
        run => Target::Range(run[0], run[run.len() - 1]),
    })
    .collect()
}

fn made(
    kind: LoadKind,
    applied_to: Vec<Target>,
    direction: Option<Direction>,
    points: Vec<(f64, f64)>,
    unit: &str,
) -> Load {
    let event = |(date, value)| ValueEvent { date, value, properties: Attributes::default() };
    Load {
        kind,
        applied_to,
        direction,
        events: points.into_iter().map(event).collect(),
        unit: Some(unit.into()),
        properties: Attributes::default(),
        foreign: Vec::new(),
        line: Line::default(),
    }
}
