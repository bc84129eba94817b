//! Alternating projections that put one cell right: obstacles and volume in turns until both hold. Cells that touch an obstacle and
//! those whose volume one cubic could not restore go through it.

use super::kind::Kind;
use super::model::Model;
use super::obstacle::Obstacle;
use super::obstacles::TOUCH;
use super::spots::{Spot, find_spots};
use crate::Vec3;
use crate::geometry::Beside;
use crate::mechanics::volume;

/// Scratch of a block: empty until one of its cells needs the projection, then kept.
#[derive(Debug, Clone, Default)]
pub struct ProjectScratch {
    /// Positions of the cell.
    pub alone: Vec<f64>,
    /// What obstacles have moved atoms by in the attempt, µm, of the shape of the positions of the block; empty where nobody asks or nothing
    /// touches.
    pub pushed: Vec<f64>,
    /// The same of one cell.
    pub pushed_alone: Vec<f64>,
    /// What obstacles take of the gradient at each atom of a spot that touches.
    taken: Vec<(usize, Vec3)>,
    /// Where the cell is beside obstacles.
    spots: Vec<Spot>,
    g: Vec<f64>,
    h: Vec<f64>,
    /// Spots that touched once.
    touching: Vec<Spot>,
}

impl ProjectScratch {
    /// Writes NaN over all scratch numbers.
    pub fn poison(&mut self) {
        let of_obstacles = [&mut self.pushed, &mut self.pushed_alone];
        [&mut self.alone, &mut self.g, &mut self.h]
            .into_iter()
            .chain(of_obstacles)
            .for_each(|array| array.fill(f64::NAN));
    }
}

/// Turns after which a projection is given up. Each newly touching atom may take one; a few more reach round-off.
const ROUNDS: usize = 40;

/// What is left to put back after the last turn may be this part of an edge: far below what a step leaves.
const CLOSE: f64 = 1e-6;

/// Sweeps by which what several spots take of the gradient of one atom comes to rest.
const SWEEPS: usize = 4;

/// Puts atoms and edges that passed an obstacle back on it and restores the volume by the others, in turns, until both hold; used
/// for one cell whose positions are `x[atom][axis]` at a time (s). Returns the volume error left, relative to `target`.
pub fn project_cell(
    model: &Model,
    kind: &Kind,
    time: f64,
    x: &mut [f64],
    target: Option<f64>,
    scratch: &mut ProjectScratch,
) -> f64 {
    let mut v = [0.0];
    scratch.pushed_alone.clear();
    scratch.pushed_alone.resize(if model.keeps_tractions { x.len() } else { 0 }, 0.0);
    scratch.g.resize(x.len(), 0.0);
    scratch.h.resize(x.len(), 0.0);
    let flat = model.obstacles.iter().all(Obstacle::is_flat);
    let (mut error, mut moved) = (0.0, 0.0);
    // An atom that touched once goes on sliding on its obstacle: else obstacles and volume would push it to and fro.
    scratch.touching.clear();
    for _ in 0..ROUNDS {
        moved = put_back(model, kind, time, x, scratch);
        let Some(target) = target else {
            if flat || moved <= 1e-12 * kind.edge {
                return 0.0;
            }
            continue;
        };
        volume::measure_block(&kind.rest.facets, x, &kind.held, &mut scratch.g, &mut v);
        error = ((v[0] - target) / target).abs();
        if error < 1e-13 && moved <= 1e-12 * kind.edge {
            return error;
        }
        slide_along(model, time, x, scratch);
        let ProjectScratch { g, h, .. } = scratch;
        let c0 = v[0] - target;
        volume::measure_block(&kind.rest.facets, g, &[], h, &mut v);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let relative: f64 = x.iter().zip(h.iter()).enumerate().map(|(i, (value, h))| (value - x[i % 3]) * h).sum();
        let Some(root) = volume::least_root_exact(c0, dot(g, g), relative, v[0]) else { return error };
        x.iter_mut().zip(g.iter()).for_each(|(x, g)| *x += root * g);
        for (atom, along) in &scratch.taken {
            push(&mut scratch.pushed_alone, *atom, -root * along);
        }
    }
    // Points that share atoms are put back to and fro by less and less; the volume was made right last.
    match target {
        Some(target) if moved <= CLOSE * kind.edge => {
            volume::measure_block(&kind.rest.facets, x, &kind.held, &mut scratch.g, &mut v);
            ((v[0] - target) / target).abs()
        }
        _ => error,
    }
}

/// Puts atoms and edges of a cell that passed an obstacle back on it, as far as nothing holds them, and notes what touches. Returns how far the
/// farthest went, µm.
fn put_back(model: &Model, kind: &Kind, time: f64, x: &mut [f64], scratch: &mut ProjectScratch) -> f64 {
    let ProjectScratch { spots, touching, pushed_alone: pushed, .. } = scratch;
    let is_held = |atom: usize| kind.is_held() && (0..3).any(|axis| kind.held[3 * atom + axis] == 0.0);
    let mut moved: f64 = 0.0;
    find_spots(kind, &model.obstacles, time, |atom| position(x, atom), spots);
    for spot in spots.iter() {
        // What was put back before moved it, too.
        let Beside { gap, normal } = model.obstacles[spot.obstacle].beside(time, &spot.mean(|atom| position(x, atom)));
        let free = || spot.parts().filter(|(atom, _)| !is_held(*atom));
        let squares: f64 = free().map(|(_, share)| share * share).sum();
        if gap < 0.0 && squares > 0.0 {
            for (atom, share) in free() {
                let back = -(share / squares) * gap * normal;
                let to = position(x, atom) + back;
                x[3 * atom..3 * atom + 3].copy_from_slice(to.as_slice());
                push(pushed, atom, back);
            }
            moved = moved.max(-gap);
        }
        if gap <= TOUCH * kind.edge && !touching.iter().any(|other| other.is_of(spot)) {
            touching.push(*spot);
        }
    }
    moved
}

/// Takes out of the gradient what would move atoms and edges off the obstacles that they touch, or into them.
fn slide_along(model: &Model, time: f64, x: &[f64], scratch: &mut ProjectScratch) {
    let ProjectScratch { g, taken, touching, .. } = scratch;
    taken.clear();
    let sweeps = if touching.iter().all(|spot| model.obstacles[spot.obstacle].is_flat()) { 1 } else { SWEEPS };
    for _ in 0..sweeps {
        for spot in touching.iter() {
            let at = spot.mean(|atom| position(x, atom));
            let normal = model.obstacles[spot.obstacle].beside(time, &at).normal;
            let squares: f64 = spot.parts().map(|(_, share)| share * share).sum();
            let along = spot.mean(|atom| position(g, atom)).dot(&normal) / squares;
            for (atom, share) in spot.parts() {
                let slot = &mut g[3 * atom..3 * atom + 3];
                let takes = share * along * normal;
                taken.push((atom, takes));
                let left = Vec3::from_column_slice(slot) - takes;
                slot.copy_from_slice(left.as_slice());
            }
        }
    }
}

/// Vector of an atom in the array of a cell.
fn position(values: &[f64], atom: usize) -> Vec3 {
    Vec3::from_column_slice(&values[3 * atom..3 * atom + 3])
}

/// Notes what an obstacle moves an atom by, where somebody asks.
fn push(pushed: &mut [f64], atom: usize, by: Vec3) {
    pushed.iter_mut().skip(3 * atom).zip(&by).for_each(|(pushed, by)| *pushed += by);
}
