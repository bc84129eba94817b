//! Alternating projections that put one cell right: planes and volume in turns until both hold. Cells that touch a plane and
//! those whose volume one cubic could not restore go through it.

use super::kind::Kind;
use super::model::Model;
use super::planes::TOUCH;
use crate::Vec3;
use crate::mechanics::volume;

/// Scratch of a block: empty until one of its cells needs the projection, then kept.
#[derive(Debug, Clone, Default)]
pub struct ProjectScratch {
    /// Positions of the cell.
    pub alone: Vec<f64>,
    /// What planes have moved atoms by in the attempt, µm, of the shape of the positions of the block; empty where nobody asks or nothing
    /// touches.
    pub pushed: Vec<f64>,
    /// The same of one cell.
    pub pushed_alone: Vec<f64>,
    /// What planes take of the gradient of each pair that touches.
    taken: Vec<Vec3>,
    g: Vec<f64>,
    h: Vec<f64>,
    touching: Vec<(usize, usize)>,
}

impl ProjectScratch {
    /// Writes NaN over all scratch numbers.
    pub fn poison(&mut self) {
        let of_planes = [&mut self.pushed, &mut self.pushed_alone];
        [&mut self.alone, &mut self.g, &mut self.h].into_iter().chain(of_planes).for_each(|array| array.fill(f64::NAN));
    }
}

/// Turns after which a projection is given up. Each newly touching atom may take one; a few more reach round-off.
const ROUNDS: usize = 40;

/// Puts atoms that passed a plane back on it and restores the volume by the others, in turns, until both hold; used
/// for one cell whose positions are `x[atom][axis]`. Returns the volume error left, relative to `target`.
pub fn project_cell(
    model: &Model,
    kind: &Kind,
    x: &mut [f64],
    target: Option<f64>,
    scratch: &mut ProjectScratch,
) -> f64 {
    let (atoms, mut v) = (kind.atoms(), [0.0]);
    let ProjectScratch { g, h, touching, taken, pushed_alone: pushed, .. } = scratch;
    pushed.clear();
    pushed.resize(if model.keeps_tractions { x.len() } else { 0 }, 0.0);
    g.resize(x.len(), 0.0);
    h.resize(x.len(), 0.0);
    let mut error: f64 = 0.0;
    // An atom that touched once goes on sliding on its plane: else planes and volume would push it to and fro.
    touching.clear();
    for _ in 0..ROUNDS {
        let mut moved: f64 = 0.0;
        for (p, plane) in model.planes.iter().enumerate() {
            for atom in 0..atoms {
                let position = Vec3::from_column_slice(&x[3 * atom..3 * atom + 3]);
                let gap = (position - plane.point).dot(&plane.normal);
                if gap < 0.0 && !(0..3).any(|axis| kind.is_held() && kind.held[3 * atom + axis] == 0.0) {
                    let back = position - gap * plane.normal;
                    x[3 * atom..3 * atom + 3].copy_from_slice(back.as_slice());
                    push(pushed, atom, -gap * plane.normal);
                    moved = moved.max(-gap);
                }
                if gap <= TOUCH * kind.edge && !touching.contains(&(atom, p)) {
                    touching.push((atom, p));
                }
            }
        }
        let Some(target) = target else { return 0.0 };
        volume::measure_block(&kind.rest.facets, x, &kind.held, g, &mut v);
        error = ((v[0] - target) / target).abs();
        if error < 1e-13 && moved <= 1e-12 * kind.edge {
            return error;
        }
        taken.clear();
        for &(atom, p) in touching.iter() {
            let (normal, slot) = (&model.planes[p].normal, &mut g[3 * atom..3 * atom + 3]);
            let free = Vec3::from_column_slice(slot);
            let along = free.dot(normal) * normal;
            taken.push(along);
            slot.copy_from_slice((free - along).as_slice());
        }
        let c0 = v[0] - target;
        volume::measure_block(&kind.rest.facets, g, &[], h, &mut v);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let relative: f64 = x.iter().zip(h.iter()).enumerate().map(|(i, (value, h))| (value - x[i % 3]) * h).sum();
        let Some(root) = volume::least_root_exact(c0, dot(g, g), relative, v[0]) else { return error };
        x.iter_mut().zip(g.iter()).for_each(|(x, g)| *x += root * g);
        for ((atom, _), along) in touching.iter().zip(&*taken) {
            push(pushed, *atom, -root * along);
        }
    }
    error
}

/// Notes what a plane moves an atom by, where somebody asks.
fn push(pushed: &mut [f64], atom: usize, by: Vec3) {
    pushed.iter_mut().skip(3 * atom).zip(&by).for_each(|(pushed, by)| *pushed += by);
}
