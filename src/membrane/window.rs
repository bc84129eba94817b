//! A block of cells through a step of mechanics: each lane with steps of its own.

use pulp::Simd;

use super::evaluate::{Atoms, Cell, measures, show, sum};
use super::failure::Failure;
use super::kick::{Course, kick};
use super::mesh::SurfaceMesh;
use super::scratch::Work;
use super::shape::{areas, areas_and_weights, coordinates};
use super::step::{UNSOLVED, attempt};
use super::system::{MembraneStepping, MembraneSystem};
use crate::ode::{Piece, Reason};

/// Exponent, safety and bounds of the factor by which steps change.
const EXPONENT: f64 = 1.0 / 3.0;
const SAFETY: f64 = 0.9;
const LEAST: f64 = 0.2;
const MOST: f64 = 5.0;
/// A step refused shrinks at least to this share.
const SHRINK: f64 = 0.9;
/// So many steps in a window are too many.
const MOST_STEPS: usize = 1_000_000;

/// The part of the state that belongs to a block.
pub struct Part<'a, const L: usize> {
    pub values: &'a mut [[f64; L]],
    pub given: &'a [[f64; L]],
    pub areas: &'a mut [[f64; L]],
    pub volume: &'a mut [f64; L],
    pub steps: &'a mut [f64; L],
    /// Pools, then what is open of the inside.
    pub inside: &'a mut [[f64; L]],
    /// Lanes with cells.
    pub cells: usize,
}

/// Moves the cells of a block from one shape to another in a window of the document's time.
#[inline(always)]
pub fn advance<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    mesh: &SurfaceMesh,
    part: &mut Part<L>,
    (from, to): (&[[f64; L]], &[[f64; L]]),
    (window, pieces, block): (&Course, &[Piece], usize),
    work: &mut Work<L>,
) -> Option<Failure> {
    let pools = system.inside.size();
    for (middle, (a, b)) in work.x.iter_mut().zip(from.iter().zip(to)) {
        for l in 0..L {
            middle[l] = 0.5 * (a[l] + b[l]);
        }
    }
    areas_and_weights(mesh, &work.x, &mut work.areas, &mut work.weights);
    coordinates(&work.x, &work.areas, &mut work.coordinates);
    (work.area[0], work.volume[0]) = measures(mesh, &work.x, &work.areas);
    work.pools.copy_from_slice(&part.inside[..pools]);
    work.open.copy_from_slice(&part.inside[pools..]);
    work.given.copy_from_slice(part.given);
    // What is there stays when the surface stretches, eq. (surface.3): half of the change before, half after.
    let ratio = |now: &[f64; L], then: &[f64; L]| -> [f64; L] { std::array::from_fn(|l| then[l] / now[l]) };
    for (row, y) in part.values.chunks_exact(mesh.atoms).zip(work.y.chunks_exact_mut(mesh.atoms)) {
        for (i, value) in row.iter().enumerate() {
            let share = ratio(&work.areas[i], &part.areas[i]);
            y[i] = std::array::from_fn(|l| value[l] * share[l]);
        }
    }
    if mesh.closed {
        let share = ratio(&work.volume[0], part.volume);
        work.pools.iter_mut().for_each(|pool| (0..L).for_each(|l| pool[l] *= share[l]));
    }
    let mut failure = None;
    let mut substeps = window.substeps;
    while failure.is_none()
        && let Some(substep) = substeps.next()
    {
        if let Some(one) = substep.kick {
            kick(simd, system, (window, block), (&substep, one), work);
        }
        if pieces.is_empty() && substep.length > 0.0 {
            failure = course(simd, system, mesh, part, (substep.begin, substep.end), work);
        }
        for piece in pieces {
            let (begin, end) = (piece.begin.max(substep.begin), piece.end.min(substep.end));
            if failure.is_none() && end > begin {
                failure = course(simd, system, mesh, part, (begin, end), work);
            }
        }
    }
    finish(simd, system, mesh, part, to, window.substeps.until(), work);
    failure
}

/// Steps until every lane has reached the end of a part of the window.
#[inline(always)]
fn course<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    mesh: &SurfaceMesh,
    part: &mut Part<L>,
    (begin, end): (f64, f64),
    work: &mut Work<L>,
) -> Option<Failure> {
    let window = end - begin;
    let mut left: [f64; L] = std::array::from_fn(|l| if l < part.cells { window } else { 0.0 });
    let mut wanted: [f64; L] = std::array::from_fn(|l| if part.steps[l] > 0.0 { part.steps[l] } else { window });
    let shortest = 4.0 * f64::EPSILON * begin.abs().max(end.abs());
    let fixed = match system.stepping {
        MembraneStepping::Longest { step, .. } => Some(step),
        MembraneStepping::Adaptive { .. } => None,
    };
    let mut failure = None;
    for _ in 0..MOST_STEPS {
        let (mut step, mut last, mut time) = ([0.0; L], [false; L], [begin; L]);
        for l in 0..L {
            if left[l] > 0.0 {
                let number = (left[l] / fixed.unwrap_or(wanted[l]) - 1e-9).ceil().max(1.0);
                (step[l], last[l]) = (left[l] / number, number <= 1.0);
                time[l] = end - left[l];
            }
        }
        if step.iter().all(|step| *step == 0.0) {
            *part.steps = std::array::from_fn(|l| if l < part.cells && fixed.is_none() { wanted[l] } else { 0.0 });
            return failure;
        }
        let error = attempt(simd, system, mesh, work, (&time, &step));
        let mut good = [false; L];
        for l in (0..L).filter(|l| step[*l] > 0.0) {
            let bearable = error[l] <= 1.0 || (fixed.is_some() && error[l] < UNSOLVED);
            let factor = (SAFETY * error[l].max(1e-12).powf(-EXPONENT)).clamp(LEAST, MOST);
            if bearable {
                good[l] = true;
                left[l] = if last[l] { 0.0 } else { left[l] - step[l] };
                // A step that the window cut says nothing against a longer one.
                let next = step[l] * factor;
                wanted[l] = if factor >= 1.0 { next.max(wanted[l]) } else { next };
            } else {
                wanted[l] = step[l] * factor.min(SHRINK);
                if wanted[l] <= shortest || fixed.is_some() {
                    let reason = match error[l] {
                        f64::INFINITY => Reason::NotFinite,
                        _ if fixed.is_some() => Reason::Solver,
                        _ => Reason::StepUnderflow,
                    };
                    failure = failure.or(Some(Failure { lane: l, time: time[l], reason }));
                    left[l] = 0.0;
                }
            }
        }
        let moved = [(&mut work.y, &work.next), (&mut work.pools, &work.pools_next)];
        for (now, next) in moved {
            for (now, next) in now.iter_mut().zip(next) {
                for l in 0..L {
                    now[l] = if good[l] { next[l] } else { now[l] };
                }
            }
        }
    }
    let lane = (0..L).find(|l| left[*l] > 0.0).unwrap_or(0);
    Some(Failure { lane, time: end - left[lane], reason: Reason::TooManySteps })
}

/// The end of the window: densities on the shape that has come, and what is summed over it.
#[inline(always)]
fn finish<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    mesh: &SurfaceMesh,
    part: &mut Part<L>,
    to: &[[f64; L]],
    end: f64,
    work: &mut Work<L>,
) {
    let pools = system.inside.size();
    areas(mesh, to, part.areas);
    for (row, y) in part.values.chunks_exact_mut(mesh.atoms).zip(work.y.chunks_exact_mut(mesh.atoms)) {
        for (i, value) in row.iter_mut().enumerate() {
            for l in 0..L {
                y[i][l] *= work.areas[i][l] / part.areas[i][l];
                value[l] = if l < part.cells { y[i][l] } else { 0.0 };
            }
        }
    }
    let (area, volume) = measures(mesh, to, part.areas);
    if mesh.closed {
        for pool in &mut work.pools {
            (0..L).for_each(|l| pool[l] *= work.volume[0][l] / volume[l]);
        }
    }
    coordinates(to, part.areas, &mut work.coordinates);
    *part.volume = volume;
    let cell = Cell { time: [end; L], pools: &work.pools, area, volume };
    let atoms = Atoms { y: &work.y, coordinates: &work.coordinates, given: part.given };
    sum(simd, system, &cell, (atoms, part.areas), &mut work.open, &mut work.registers);
    part.inside[..pools].copy_from_slice(&work.pools);
    part.inside[pools..].copy_from_slice(&work.open);
    // Lanes without a cell hold zeros.
    for l in part.cells..L {
        (part.volume[l], part.steps[l]) = (0.0, 0.0);
        part.areas.iter_mut().for_each(|area| area[l] = 0.0);
    }
}

/// Works out an expression that is shown at all atoms of the cells of a block where they stand.
#[inline(always)]
pub fn display<S: Simd, const L: usize>(
    simd: S,
    system: &MembraneSystem,
    mesh: &SurfaceMesh,
    (part, shown): (&Part<L>, &mut [[f64; L]]),
    x: &[[f64; L]],
    (number, time): (usize, f64),
    work: &mut Work<L>,
) {
    let (pools, open) = part.inside.split_at(system.inside.size());
    areas(mesh, x, &mut work.areas);
    coordinates(x, &work.areas, &mut work.coordinates);
    let (area, volume) = measures(mesh, x, &work.areas);
    let cell = Cell { time: [time; L], pools, area, volume };
    let atoms = Atoms { y: part.values, coordinates: &work.coordinates, given: part.given };
    show(simd, system, &cell, (number, atoms), open, &mut work.registers, shown);
}
