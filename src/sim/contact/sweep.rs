//! Projected Gauss–Seidel over contacts, in a fixed order.
//!
//! Vectors have four numbers, so that they fill a register; the fourth of a displacement is the mobility of its atom. The
//! sweeps are compiled for wide registers and give the same bits in narrow ones.

use pulp::{Arch, NullaryFnOnce};

use super::change::Change;
use super::columns::Columns;
use super::mobility::{Body, Lever, Mobility, Motion, moved_apart, push_body, sides};
use super::rounds::Crew;
use super::rows::{Pull, Row};
use super::together::Together;
use super::turns::Turns;
use super::vectors::{V4, map};
use crate::mechanics::modes::OfModes;

/// Scalar product of the first three numbers.
#[inline(always)]
fn dot(a: &V4, b: &V4) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

#[inline(always)]
fn wide([x, y, z]: [f32; 3]) -> V4 {
    [f64::from(x), f64::from(y), f64::from(z), 0.0]
}

#[inline(always)]
fn narrow(wide: &V4) -> [f32; 3] {
    [wide[0] as f32, wide[1] as f32, wide[2] as f32]
}

#[inline(always)]
fn normal(row: &Row) -> V4 {
    let [x, y, z, _] = row.normal_and_gap;
    wide([x, y, z])
}

/// How much farther apart displacements bring the two sides of a row, µm. The fourth number means nothing.
#[inline(always)]
fn apart(row: &Row, [p, q, r, s]: [f64; 4], moved: &Together<V4>) -> V4 {
    // SAFETY: the caller alone moves the cells of its rows.
    let [a, b, c, d] = row.atoms.map(|atom| unsafe { *moved.item(atom as usize) });
    map(|i| (a[i] * p + b[i] * q) + (c[i] * r + d[i] * s))
}

/// Moves the atoms of a row as a change of its force does; the fourth number of that is 0.
#[inline(always)]
fn push(row: &Row, weights: [f64; 4], change: &V4, moved: &Together<V4>) {
    for (atom, weight) in row.atoms.iter().zip(weights) {
        // SAFETY: the caller alone moves the cells of its rows.
        let slot = unsafe { moved.item(*atom as usize) };
        let share = slot[3] * weight;
        *slot = map(|i| slot[i] + share * change[i]);
    }
}

/// The normal force that a contact should carry, eq. (adhesion.3): it pushes where the gap would close, and pulls, as far
/// as it can, where the gap would grow. `free` is where the gap would be if it carried nothing.
#[inline(always)]
fn normal_force(row: &Row, free: f64, carried: f64) -> f64 {
    let (gap, stiffness, kept) = (row.gap(), row.stiffness(), f64::from(row.kept));
    let (low, high) = (gap.min(0.0), gap.max(0.0));
    let pushed = (low - free) * stiffness;
    let held = (high - free) * stiffness * kept + carried.min(0.0) * (1.0 - kept);
    let pulled = held.min(0.0).max(f64::from(row.least));
    if free < low { pushed } else { pulled }
}

/// The force of a row after its turn: normal by [`normal_force`]; the tangential part keeps the sides from sliding as far
/// as it can, eq. (adhesion.4); beyond that it rubs, eq. (adhesion.20), by where a step of `dt` (s) takes the sides.
#[inline(always)]
fn turn(row: &Row, apart: &V4, force: &V4, carried: &V4, dt: f64) -> V4 {
    let normal = normal(row);
    let (opened, along, carried_along) = (dot(apart, &normal), dot(force, &normal), dot(carried, &normal));
    let free = (row.gap() + opened) - along * f64::from(row.compliance);
    let wanted = normal_force(row, free, carried_along);
    if row.shear == 0.0 && row.friction == 0.0 {
        return map(|i| wanted * normal[i]);
    }
    let (stiffness, kept) = (f64::from(1.0 / row.across), f64::from(row.kept));
    let stuck = map(|i| {
        let (slid, across) = (apart[i] - opened * normal[i], force[i] - along * normal[i]);
        let carried = carried[i] - carried_along * normal[i];
        (across - stiffness * slid) * kept + carried * (1.0 - kept)
    });
    let (squared, shear) = (dot(&stuck, &stuck), f64::from(row.shear));
    let part = match squared > shear * shear {
        true if row.friction > 0.0 => {
            let (size, held) = (squared.sqrt(), f64::from(row.friction) * f64::from(row.across) / dt);
            (shear + held / (1.0 + held) * (size - shear)) / size
        }
        true => shear / squared.sqrt(),
        false => 1.0,
    };
    map(|i| wanted * normal[i] + part * stuck[i])
}

/// One sweep over all contacts of a step of `dt` (s), each of which first goes on along its last direction by `share`, as the displacements did. Jobs of a
/// colour move different cells, so that threads share them; what they change is added up in the order of jobs.
pub fn sweep_contacts(
    rows: &[Row],
    pulls: &mut [Pull],
    moved: &mut [V4],
    mobility: &mut Mobility,
    (dt, share): (f64, f64),
    change: &mut Change,
    crew: Crew,
) {
    let Mobility { has_modes, shapes, kinds, bodies, levers, moved: motions, turns, changes, columns, .. } = mobility;
    let columns = columns.if_there();
    let (moved, motions, pulls) = (Together::new(moved), Together::new(motions), Together::new(pulls));
    let sweep = |job: usize, change: &mut Change| {
        let turns = turns.of_job(job);
        // SAFETY: jobs have turns of their own, and those of a colour move different cells.
        let pulls = unsafe { pulls.part(turns.clone()) };
        let (first, rows) = (turns.start, &rows[turns]);
        let cells = Cells { shapes, kinds, bodies, moved: &moved, motions: &motions, columns };
        *change = Change::default();
        if *has_modes {
            Arch::new().dispatch(Sweep::<true> { first, rows, pulls, levers, cells, dt, share, change });
        } else {
            Arch::new().dispatch(Sweep::<false> { first, rows, pulls, levers, cells, dt, share, change });
        }
    };
    changes.clear();
    changes.resize(turns.jobs(), Change::default());
    let of_jobs = Together::new(changes);
    // SAFETY: each job has a change of its own.
    let sweep = |job: usize| sweep(job, unsafe { of_jobs.item(job) });
    turns.colours().for_each(|jobs| crew.each(jobs.len(), |job| sweep(jobs.start + job)));
    changes.iter().for_each(|of_job| change.add(of_job));
}

/// What contacts move.
#[derive(Clone, Copy)]
struct Cells<'a> {
    shapes: &'a [OfModes],
    kinds: &'a [(u32, OfModes)],
    bodies: &'a [Body],
    moved: &'a Together<'a, V4>,
    motions: &'a Together<'a, Motion>,
    /// Where some cells move by columns.
    columns: Option<&'a Columns>,
}

struct Sweep<'a, const BY_MODES: bool> {
    /// The number of the first row.
    first: usize,
    rows: &'a [Row],
    pulls: &'a mut [Pull],
    levers: &'a [Lever],
    cells: Cells<'a>,
    dt: f64,
    share: f64,
    change: &'a mut Change,
}

/// What the modes of both sides of a row do.
struct BySides<'a> {
    lever: &'a Lever,
    sides: [OfModes; 2],
}

impl<'a> BySides<'a> {
    #[inline(always)]
    fn new(shapes: &[OfModes], lever: &'a Lever, row: &Row, weights: [f64; 4]) -> Self {
        Self { lever, sides: sides(shapes, lever, row, weights) }
    }

    #[inline(always)]
    fn apart(&self, motions: &Together<Motion>) -> V4 {
        // SAFETY: the caller alone moves the cells of its rows.
        let motions = self.lever.bodies.map(|body| unsafe { &*motions.item(body as usize) });
        moved_apart(motions, &self.sides, &self.lever.arms)
    }

    #[inline(always)]
    fn push(&self, Cells { bodies, kinds, motions, .. }: Cells, change: &V4) {
        for (side, body) in self.lever.bodies.into_iter().enumerate() {
            let of = &bodies[body as usize];
            let response = (of, &kinds[of.kind()].1);
            // SAFETY: the caller alone moves the cells of its rows.
            let motion = unsafe { motions.item(body as usize) };
            push_body(response, motion, &self.sides[side], &self.lever.arms[side], change);
        }
    }
}

impl<const BY_MODES: bool> NullaryFnOnce for Sweep<'_, BY_MODES> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { first, rows, pulls, levers, cells, dt, share, change } = self;
        let Cells { shapes, moved, motions, columns, .. } = cells;
        let mut largest = 0.0;
        for (number, (row, pull)) in (first..).zip(rows.iter().zip(pulls)) {
            if row.compliance == 0.0 {
                continue;
            }
            let (weights, direction, last) = (row.weights(), wide(pull.direction), wide(pull.change));
            // As the numbers are kept, so that force and displacement go together.
            let force = wide(pull.force);
            let force = wide(narrow(&map(|i| force[i] + share * direction[i])));
            let mut gap = apart(row, weights, moved);
            let sides = BY_MODES.then(|| BySides::new(shapes, &levers[number], row, weights));
            if let Some(sides) = &sides {
                let by_modes = sides.apart(motions);
                gap = map(|i| gap[i] + by_modes[i]);
            }
            let new = narrow(&turn(row, &gap, &force, &wide(pull.carried), dt));
            // What is open, or at rest, has nothing to write: no force changes, nor did one.
            if new == pull.force && pull.change == [0.0; 3] && pull.direction == [0.0; 3] {
                continue;
            }
            let found = wide(new);
            let step = map(|i| found[i] - force[i]);
            push(row, weights, &step, moved);
            if let Some(sides) = &sides {
                sides.push(cells, &step);
            }
            if let Some(columns) = columns {
                columns.push(number, &normal(row), &step, moved);
            }
            pull.direction = narrow(&map(|i| share * direction[i] + last[i]));
            pull.change = narrow(&step);
            pull.force = new;
            let compliance = f64::from(row.compliance);
            let size = dot(&step, &step) * compliance;
            change.work += size;
            if size * compliance > largest {
                (largest, change.worst) = (size * compliance, number);
            }
        }
        change.largest = change.largest.max(largest.sqrt());
    }
}

/// Pushes out what is inside, by no more than `most` (µm), and leaves no force behind: what curved paths let slip is
/// mended by displacement, not by force, eq. (adhesion.7). `deep` are the rows that are inside and can move, each with the force that
/// would do it, zero at first.
pub fn sweep_depths(
    rows: &[Row],
    deep: &mut [(u32, f64)],
    moved: &mut [V4],
    mobility: &mut Mobility,
    most: f64,
    crew: Crew,
) {
    let Mobility { shapes, kinds, bodies, levers, moved: motions, has_modes, turns, deep_ends, columns, .. } = mobility;
    let (moved, motions) = (&Together::new(moved), &Together::new(motions));
    let cells = Cells { shapes, kinds, bodies, moved, motions, columns: columns.if_there() };
    let levers = has_modes.then_some(&levers[..]);
    if !Turns::are_many(deep.len()) {
        return push_out(rows, deep, levers, cells, most);
    }
    deep_ends.clear();
    let before = |turn: usize| deep.partition_point(|(row, _)| (*row as usize) < turn);
    deep_ends.extend((0..turns.jobs()).map(|job| before(turns.of_job(job).end)));
    let part = |job: usize| if job == 0 { 0 } else { deep_ends[job - 1] }..deep_ends[job];
    let deep = Together::new(deep);
    // SAFETY: jobs have rows of their own, and those of a colour move different cells.
    let push_out = |job: usize| push_out(rows, unsafe { deep.part(part(job)) }, levers, cells, most);
    turns.colours().for_each(|jobs| crew.each(jobs.len(), |job| push_out(jobs.start + job)));
}

/// Pushes out what some rows are inside, one after the other.
fn push_out(rows: &[Row], deep: &mut [(u32, f64)], levers: Option<&[Lever]>, cells: Cells, most: f64) {
    let Cells { shapes, moved, motions, columns, .. } = cells;
    for (number, pushed) in deep {
        let row = &rows[*number as usize];
        let (weights, normal) = (row.weights(), normal(row));
        let sides = levers.map(|levers| BySides::new(shapes, &levers[*number as usize], row, weights));
        let mut opened = dot(&apart(row, weights, moved), &normal);
        if let Some(sides) = &sides {
            opened += dot(&sides.apart(motions), &normal);
        }
        let wanted = (row.gap() + most).min(0.0);
        let missing = wanted - row.gap() - opened;
        let new = (*pushed + missing * row.stiffness()).max(0.0);
        let change = normal.map(|n| (new - *pushed) * n);
        push(row, weights, &change, moved);
        if let Some(sides) = &sides {
            sides.push(cells, &change);
        }
        if let Some(columns) = columns {
            columns.push(*number as usize, &normal, &change, moved);
        }
        *pushed = new;
    }
}
