//! The stage that adds up every force on every atom.

use std::ops::Range;

use nalgebra::Matrix3;
use rayon::prelude::*;

use super::acting_fibres::ActingFibres;
use super::contact::{ContactForces, add_contact_forces, pull_contacts};
use super::controls::Controls;
use super::elasticity::{self, add_local_elasticity};
use super::kind::{Kind, VolumeRule};
use super::model::Model;
use super::state::{KindState, State};
use super::thread_buffers::{ThreadBuffers, each_or_none};
use super::workspace::{KindScratch, Workspace};
use crate::Vec3;
use crate::mechanics::control::Context;
use crate::mechanics::lanes::LANES;
use crate::mechanics::restoring::restoring;
use crate::mechanics::sum::{measure_elastic, measure_forces, measure_outer};
use crate::mechanics::volume;

/// All forces on the cells of a kind, drag not included. Motility enters as the drag that its velocity
/// overcomes.
#[derive(Clone, Copy)]
pub struct Forces<'a> {
    /// The kind.
    pub kind: &'a Kind,
    /// Its cells, wherever their atoms are.
    pub cells: &'a KindState,
    /// What chemistry and programs set.
    pub controls: &'a Controls,
    /// What acts on them beside what they are made of.
    pub acting: Acting<'a>,
}

/// What acts on all cells of a model beside what they are made of.
#[derive(Clone, Copy)]
pub struct Acting<'a> {
    /// Mean velocity that motility asks of every cell, µm/s.
    pub drive: &'a [[f64; 3]],
    /// What pseudopods do to the atoms of all cells, pN; none in a model without them.
    pub pushes: &'a [Vec3],
    /// Fibres that were made at run time.
    pub fibres: &'a ActingFibres,
    /// What contacts do.
    pub contact: &'a ContactForces,
}

impl Forces<'_> {
    /// The factor of elastic forces in each lane of a block.
    pub fn elastic_factors(&self, block: usize) -> [f64; LANES] {
        let numbers = self.cells.numbers_of_block(self.kind, block);
        let mut factors = [1.0; LANES];
        if let Some(set) = self.controls.stiffness.get(numbers) {
            factors.iter_mut().zip(set).for_each(|(slot, factor)| *slot = *factor);
        }
        if let Some(own) = elasticity::factors(self.kind, self.cells, self.controls) {
            let of_cells = own.chunks_exact(self.kind.atoms()).skip(block * self.kind.lanes);
            factors.iter_mut().zip(of_cells).for_each(|(slot, own)| *slot *= elasticity::largest_factor(own));
        }
        factors
    }

    /// Writes the sum of all forces on the atoms of a block at `x` and a time, pN, over `f`, and the energy of its cells (pN·µm) over
    /// `energy`. `rest` are the rest volumes of the cells; `spare` is scratch of the size of `x`.
    pub fn on_block(
        &self,
        block: usize,
        time: f64,
        (x, rest): (&[f64], &[f64]),
        (f, energy): (&mut [f64], &mut [f64]),
        spare: &mut [f64],
    ) {
        let &Self { kind, cells, controls, acting: Acting { drive, pushes, fibres, contact } } = self;
        let numbers = cells.numbers_of_block(kind, block);
        let context = context(kind, controls, numbers.clone(), time);
        measure_forces(&kind.forces, &context, kind.lanes, x, f, energy);
        add_local_elasticity(kind, cells, (block, controls), x, f, energy);
        if cells.is_driven(kind) {
            add_drive(kind, &drive[numbers], f);
        }
        add_pressure(kind, time, x, rest, spare, f, energy);
        add_to_atoms(kind, cells, block, pushes, f);
        add_to_atoms(kind, cells, block, &controls.atom_forces, f);
        add_fibres(kind, cells, block, fibres, x, f, energy);
        add_contact_forces(kind, cells, block, contact, f);
    }
}

impl Forces<'_> {
    /// Adds a share of the forces from outside on the atoms of a block at `x` and a time, pN, to `outer`. `spare` is scratch of the size of
    /// `x`.
    pub fn add_outer(&self, block: usize, (time, share): (f64, f64), x: &[f64], outer: &mut [f64], spare: &mut [f64]) {
        let &Self { kind, cells, controls, acting: Acting { drive, .. } } = self;
        let numbers = cells.numbers_of_block(kind, block);
        let context = context(kind, controls, numbers.clone(), time);
        measure_outer(&kind.forces, &context, kind.lanes, x, spare, &mut [0.0; LANES][..kind.lanes]);
        if cells.is_driven(kind) {
            add_drive(kind, &drive[numbers], spare);
        }
        add_to_atoms(kind, cells, block, &controls.atom_forces, spare);
        outer.iter_mut().zip(spare).for_each(|(outer, force)| *outer += share * *force);
    }

    /// How loads turn the cell of a lane of a block at `x` back at a time, pN·µm, eq. (step.13).
    pub fn restoring(&self, block: usize, lane: usize, time: f64, x: &[f64]) -> Matrix3<f64> {
        let context = context(self.kind, self.controls, self.cells.numbers_of_block(self.kind, block), time);
        restoring(&self.kind.forces, &context, (self.kind.lanes, lane), x)
    }

    /// Adds a share of the forces `f` on the atoms of a block, pN, without what contacts have of them, to `sum`. `spare` is scratch of that size.
    pub fn add_without_contacts(&self, block: usize, share: f64, f: &[f64], sum: &mut [f64], spare: &mut [f64]) {
        spare.fill(0.0);
        add_contact_forces(self.kind, self.cells, block, self.acting.contact, spare);
        sum.iter_mut()
            .zip(f.iter().zip(spare))
            .for_each(|(sum, (all, of_contacts))| *sum += share * (all - *of_contacts));
    }
}

/// Sets `force` of every kind to the sum of all forces at time `time` (pN), and `energy` to the energy of every cell. What contacts
/// carry must have been found.
pub fn add_forces(model: &Model, time: f64, state: &State, ws: &mut Workspace) {
    ws.suit(model, state);
    ws.fibres.gather(model, &state.kinds);
    sum_forces(model, (time, 0.0), &state.chemistry.controls, &state.kinds, ws);
}

/// As [`add_forces`], for cells that stand elsewhere than where what chemistry sets was set. Where tractions are kept the forces count
/// `share` of the step.
pub fn sum_forces(
    model: &Model,
    (time, share): (f64, f64),
    controls: &Controls,
    cells: &[KindState],
    ws: &mut Workspace,
) {
    pull_contacts(model, controls, cells, &mut ws.contact, share);
    for (w, now) in ws.kinds.iter_mut().zip(cells) {
        w.force.resize(now.positions.len(), 0.0);
    }
    let Workspace { kinds, buffers, drive, pushes, fibres, contact, .. } = ws;
    let acting = Acting { drive, pushes, fibres, contact: &contact.forces };
    for_each_kind(model, time, (controls, acting), cells, kinds, buffers, |w| (&mut w.force, &mut w.energy));
    if share == 0.0 || !model.keeps_tractions {
        return;
    }
    for ((kind, now), w) in model.kinds.iter().zip(cells).zip(kinds) {
        let (forces, length) = (Forces { kind, cells: now, controls, acting }, kind.block_len());
        let blocks = now.positions.par_chunks_exact(length).zip(w.outer.par_chunks_exact_mut(length)).enumerate();
        blocks.for_each(|(block, (x, outer))| {
            buffers.enter(length, |[spare, ..]| forces.add_outer(block, (time, share), x, outer, spare));
        });
    }
}

/// Sets `energy` of every kind to the energy of every cell, pN·µm, without that of fibres made at run time; contacts have none.
pub fn measure_energy(model: &Model, time: f64, controls: &Controls, cells: &[KindState], ws: &mut Workspace) {
    let Workspace { kinds, buffers, drive, .. } = ws;
    let (fibres, contact) = (&ActingFibres::default(), &ContactForces::default());
    let acting = Acting { drive, pushes: &[], fibres, contact };
    for_each_kind(model, time, (controls, acting), cells, kinds, buffers, |w| (&mut [], &mut w.energy));
}

/// Forces and energies of all kinds, written to what is lent of their scratch; forces that are not held are those of a block.
fn for_each_kind(
    model: &Model,
    time: f64,
    (controls, acting): (&Controls, Acting),
    cells: &[KindState],
    kinds: &mut [KindScratch],
    buffers: &ThreadBuffers,
    lent: impl Fn(&mut KindScratch) -> (&mut [f64], &mut [f64]),
) {
    for ((kind, now), w) in model.kinds.iter().zip(cells).zip(kinds) {
        let forces = Forces { kind, cells: now, controls, acting };
        let (length, lanes) = (kind.block_len(), kind.lanes);
        let (force, energy) = lent(w);
        (now.positions.par_chunks_exact(length).zip(now.rest_volumes.par_chunks_exact(lanes)))
            .zip(energy.par_chunks_exact_mut(lanes).zip(each_or_none(force, length, now.blocks(kind))))
            .enumerate()
            .for_each(|(block, (cells, (energy, held)))| {
                buffers.enter(length, |[f, spare, ..]| {
                    forces.on_block(block, time, cells, (held.unwrap_or(f), energy), spare);
                });
            });
    }
}

/// Elastic energy of each cell of a kind alone, pN·µm, for observers.
pub fn elastic_energy(kind: &Kind, cells: &KindState, controls: &Controls) -> Vec<f64> {
    let mut energy = vec![0.0; cells.blocks(kind) * kind.lanes];
    let mut force = vec![0.0; kind.block_len()];
    for (x, energy) in cells.positions.chunks_exact(kind.block_len()).zip(energy.chunks_exact_mut(kind.lanes)) {
        measure_elastic(&kind.forces, kind.lanes, x, &mut force, energy);
    }
    for (cell, energy) in energy.iter_mut().enumerate().take(cells.cells()) {
        *energy *= controls.stiffness_of(cells.first_cell + cell);
    }
    let blocks = cells.positions.chunks_exact(kind.block_len()).zip(energy.chunks_exact_mut(kind.lanes));
    for (block, (x, energy)) in blocks.enumerate() {
        add_local_elasticity(kind, cells, (block, controls), x, &mut force, energy);
    }
    energy.truncate(cells.cells());
    energy
}

/// What forces on these cells depend on beside positions.
fn context<'a>(kind: &Kind, controls: &'a Controls, cells: Range<usize>, time: f64) -> Context<'a> {
    Context { time, mass: kind.mass, cells, stiffness: &controls.stiffness, controls: &controls.forces }
}

fn add_drive(kind: &Kind, drive: &[[f64; 3]], f: &mut [f64]) {
    for (lane, velocity) in drive.iter().enumerate() {
        for atom in 0..kind.atoms() {
            for axis in 0..3 {
                f[(3 * atom + axis) * kind.lanes + lane] += kind.drag * velocity[axis];
            }
        }
    }
}

/// Adds forces on the atoms of all cells to those of a block; where there are none nothing is added.
fn add_to_atoms(kind: &Kind, cells: &KindState, block: usize, forces: &[Vec3], f: &mut [f64]) {
    let Some(forces) = forces.get(cells.atoms(kind)) else { return };
    for lane in 0..kind.lanes {
        let cell = (block * kind.lanes + lane).min(cells.cells() - 1);
        let own = &forces[cell * kind.atoms()..(cell + 1) * kind.atoms()];
        for (atom, force) in own.iter().enumerate() {
            (0..3).for_each(|axis| f[(3 * atom + axis) * kind.lanes + lane] += force[axis]);
        }
    }
}

/// Adds what fibres made at run time do to the atoms of a block, eq. (fibres.1), and their energy.
fn add_fibres(
    kind: &Kind,
    cells: &KindState,
    block: usize,
    fibres: &ActingFibres,
    x: &[f64],
    f: &mut [f64],
    energy: &mut [f64],
) {
    if fibres.is_empty() {
        return;
    }
    for lane in 0..kind.lanes {
        let cell = (block * kind.lanes + lane).min(cells.cells() - 1);
        let at = |atom: u32, axis: usize| (3 * atom as usize + axis) * kind.lanes + lane;
        for fibre in fibres.of(cells.first_cell + cell) {
            let [a, b] = fibre.atoms;
            let (pull, stored) = fibre.pull(Vec3::from_fn(|axis, _| x[at(b, axis)] - x[at(a, axis)]));
            energy[lane] += stored;
            for axis in 0..3 {
                f[at(a, axis)] += pull[axis];
                f[at(b, axis)] -= pull[axis];
            }
        }
    }
}

/// The pressure of a compressible cell, `−K (V − V₀)/V₀ ∇V`, eq. (volume.4).
fn add_pressure(
    kind: &Kind,
    time: f64,
    x: &[f64],
    rest: &[f64],
    gradient: &mut [f64],
    f: &mut [f64],
    energy: &mut [f64],
) {
    let VolumeRule::Compressible { modulus, course } = &kind.volume else { return };
    let factor = course.at(time);
    let mut volumes = [0.0; LANES];
    let volumes = &mut volumes[..kind.lanes];
    volume::measure_block(&kind.rest.facets, x, &[], gradient, volumes);
    for lane in 0..kind.lanes {
        let target = rest[lane] * factor;
        let strain = (volumes[lane] - target) / target;
        energy[lane] += 0.5 * modulus * strain * strain * target;
        for i in 0..3 * kind.atoms() {
            let at = i * kind.lanes + lane;
            f[at] -= modulus * strain * gradient[at];
        }
    }
}
