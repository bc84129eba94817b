//! How far cells are from mechanical equilibrium: the force that drag and viscosity answer, eq. (step.15).

use rayon::prelude::*;

use super::kind::Kind;
use super::model::Model;
use super::scheme::larger;
use super::state::{KindState, State};
use super::thread_buffers::ThreadBuffers;
use super::workspace::Workspace;
use crate::mechanics::lanes::LANES;
use crate::mechanics::sum::measure_elastic;

/// Where a run ends at rest, notes the largest force on an atom that may have been out of balance in the step of `dt` (s) that led from one state to
/// another: what drag and viscosity answered, and by how much elastic forces changed. Where a step is long, it is these that answer.
pub fn note_balance(model: &Model, dt: f64, from: &State, to: &mut State, ws: &Workspace) {
    let kinds = model.kinds.iter().zip(from.kinds.iter().zip(&to.kinds));
    let of_kind = |(kind, ends): (&Kind, (&KindState, &KindState))| largest(kind, dt, ends, &ws.buffers);
    to.out_of_balance = model.rest.map(|_| kinds.map(of_kind).fold(0.0, larger));
}

/// Adds K times how far the atoms of a block went: where the step knows no other stiffness, it is K that answered.
fn add_stiffness(kind: &Kind, lanes: usize, gone: &[f64], force: &mut [f64]) {
    let width = 3 * lanes;
    for (atom, force) in force.chunks_exact_mut(width).enumerate() {
        for (other, stiffness) in kind.stiffness.row(atom) {
            let gone = &gone[other * width..][..width];
            force.iter_mut().zip(gone).for_each(|(force, gone)| *force += stiffness * gone);
        }
    }
}

/// The largest over the cells of a kind, pN.
fn largest(kind: &Kind, dt: f64, (from, to): (&KindState, &KindState), buffers: &ThreadBuffers) -> f64 {
    let (length, lanes) = (kind.block_len(), kind.lanes);
    let blocks = from.positions.par_chunks_exact(length).zip(to.positions.par_chunks_exact(length));
    let of_block = |(start, end): (&[f64], &[f64])| {
        buffers.enter(length, |[gone, force, before, after, ..]| {
            for (number, (start, end)) in start.iter().zip(end).enumerate() {
                gone[number] = end - start;
                force[number] = kind.drag / dt * gone[number];
            }
            kind.add_resistance(lanes, 1.0 / dt, [end, gone], force);
            if kind.tangent.is_some() {
                let mut energy = [0.0; LANES];
                measure_elastic(&kind.forces, lanes, start, before, &mut energy[..lanes]);
                measure_elastic(&kind.forces, lanes, end, after, &mut energy[..lanes]);
                let changes = before.iter().zip(after.iter()).map(|(before, after)| before - after);
                force.iter_mut().zip(changes).for_each(|(force, change)| *force += change);
            } else {
                add_stiffness(kind, lanes, gone, force);
            }
            let mut largest: f64 = 0.0;
            for atom in force.chunks_exact(3 * lanes) {
                let mut squares = [0.0; LANES];
                for row in atom.chunks_exact(lanes) {
                    squares.iter_mut().zip(row).for_each(|(square, force)| *square += force * force);
                }
                largest = squares[..lanes].iter().copied().fold(largest, larger);
            }
            largest.sqrt()
        })
    };
    blocks.map(of_block).reduce(|| 0.0, larger)
}
