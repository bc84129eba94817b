//! The stage that makes constraints exact after the atoms moved: obstacles, the shapes of virtual adhesives, and the volume of
//! every cell, which comes last. Rigid bodies get back their shape.

use rayon::prelude::*;

use super::contact::settle_adhesives;
use super::kind::VolumeRule;
use super::model::Model;
use super::projection::{ProjectScratch, project_cell};
use super::rigid::make_rigid;
use super::state::State;
use super::trouble::Trouble;
use super::workspace::{KindScratch, Workspace};
use crate::mechanics::volume;

/// The volume error that a step may leave, relative to the target.
pub const VOLUME_TOLERANCE: f64 = 1e-10;

/// Turns of exact volumes and shapes of adhesives in a step; each leaves a small part of what the one before left.
const TURNS: usize = 4;

/// Makes obstacles and volumes exact, in turns with the shapes of virtual adhesives where there are any; volumes come last.
///
/// # Errors
/// A volume that could not be restored; `time` is the end of the step, s.
pub fn make_exact(model: &Model, time: f64, from: &State, to: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    for _ in 0..TURNS {
        enforce_constraints(model, time, to, ws)?;
        if !settle_adhesives(model, from, to, ws) {
            return Ok(());
        }
    }
    enforce_constraints(model, time, to, ws)
}

/// Puts atoms back outside the obstacles, every exact volume back on its target, and rigid bodies back to their shape.
///
/// # Errors
/// As [`make_exact`].
pub fn enforce_constraints(model: &Model, time: f64, to: &mut State, ws: &mut Workspace) -> Result<(), Trouble> {
    let Workspace { kinds, buffers, .. } = ws;
    for ((kind, now), w) in model.kinds.iter().zip(&mut to.kinds).zip(kinds) {
        if kind.rigid.is_some() {
            now.positions.par_chunks_exact_mut(kind.block_len()).for_each(|x| make_rigid(model, kind, time, x));
            continue;
        }
        let exact = matches!(kind.volume, VolumeRule::Exact(_));
        if !exact && model.obstacles.is_empty() {
            continue;
        }
        let (length, lanes) = (kind.block_len(), kind.lanes);
        let KindScratch { target, left, project, .. } = w;
        (now.positions.par_chunks_exact_mut(length))
            .zip(target.par_chunks_exact(lanes).zip(left.par_chunks_exact_mut(lanes)).zip(project))
            .for_each(|(x, ((target, left), scratch))| {
                if !model.obstacles.is_empty() {
                    project_block((model, kind, time), exact, x, target, left, scratch);
                } else {
                    buffers.enter(length, |[spare, spare2, ..]| {
                        volume::enforce_block(&kind.rest.facets, x, &kind.held, target, spare, spare2, left);
                    });
                    left.iter_mut().zip(target).for_each(|(left, target)| *left /= target);
                    if left.iter().any(|error| error.is_nan() || *error > VOLUME_TOLERANCE) {
                        project_block((model, kind, time), exact, x, target, left, scratch);
                    }
                }
            });
        let missed = |cell: &usize| exact && (left[*cell].is_nan() || left[*cell] > VOLUME_TOLERANCE);
        if let Some(cell) = (0..now.cells()).find(missed) {
            return Err(Trouble::Volume { kind: kind.name.clone(), cell, error: left[cell], time });
        }
    }
    Ok(())
}

/// Cell by cell, by alternating projections.
fn project_block(
    (model, kind, time): (&Model, &super::kind::Kind, f64),
    exact: bool,
    x: &mut [f64],
    target: &[f64],
    left: &mut [f64],
    scratch: &mut ProjectScratch,
) {
    let lanes = kind.lanes;
    let mut alone = std::mem::take(&mut scratch.alone);
    for lane in 0..lanes {
        alone.clear();
        alone.extend(x.chunks_exact(lanes).map(|row| row[lane]));
        left[lane] = project_cell(model, kind, time, &mut alone, exact.then_some(target[lane]), scratch);
        for (row, value) in x.chunks_exact_mut(lanes).zip(&alone) {
            row[lane] = *value;
        }
        if model.keeps_tractions {
            let ProjectScratch { pushed, pushed_alone, .. } = scratch;
            pushed.resize(x.len(), 0.0);
            pushed.chunks_exact_mut(lanes).zip(&*pushed_alone).for_each(|(row, value)| row[lane] += value);
        }
    }
    scratch.alone = alone;
}
