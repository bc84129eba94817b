//! Rigid planes: no atom passes them, and the force with which a plane holds an atom is part of the implicit solve.
//!
//! In a step the atoms that press on a plane are found by the active-set method, eq. (planes.1): with M the constrained
//! mobility of the cell (eq. step.4, step.5) and C the normals of the touching atoms, the reactions r ≥ 0 solve
//! `C M Cᵀ r = −gap − C Y`. So a cell that rests on a plane is in exact balance, however large the step.

use nalgebra::{DMatrix, DVector};

use super::implicit::{Stage, pressure, solve_block};
use super::model::{Kind, Model, VolumeRule};
use super::workspace::Solver;
use crate::Vec3;
use crate::mechanics::volume;

/// What a correction needs to know.
pub struct Scene<'a> {
    /// The model.
    pub model: &'a Model,
    /// The kind of the block.
    pub kind: &'a Kind,
    /// Its solver.
    pub solver: &'a Solver,
    /// The stage of the step.
    pub stage: Stage,
    /// γ of the scheme.
    pub gamma: f64,
}

/// An atom closer to a plane than this part of an edge touches it: far below any deformation, far above round-off.
const TOUCH: f64 = 1e-9;

/// Rounds of the active-set method; it ends in two or three, a cycle is cut here and the projection does the rest.
const ROUNDS: usize = 12;

/// Corrects the increments of the cells of a block that touch planes.
pub fn correct_block(
    scene: &Scene,
    x: &[f64],
    first: &[f64],
    gradient: &[f64],
    swell: &[f64],
    target: &[f64],
    y: &mut [f64],
    pressure: &mut [f64],
) {
    if scene.model.planes.is_empty() {
        return;
    }
    let lanes = scene.kind.lanes;
    for lane in 0..lanes {
        let touching = touching_pairs(scene, lanes, lane, x, first, y);
        if !touching.is_empty() {
            pressure[lane] += correct_cell(scene, lane, x, first, gradient, swell, target[lane], y, touching);
        }
    }
}

/// Vector of an atom in a block.
fn at(values: &[f64], lanes: usize, lane: usize, atom: usize) -> Vec3 {
    Vec3::from_fn(|axis, _| values[(3 * atom + axis) * lanes + lane])
}

/// Pairs (atom, plane) that touch at the start of the step or would pass at its end.
fn touching_pairs(
    scene: &Scene,
    lanes: usize,
    lane: usize,
    x: &[f64],
    first: &[f64],
    y: &[f64],
) -> Vec<(usize, usize)> {
    let kind = scene.kind;
    let mut pairs = Vec::new();
    for (p, plane) in scene.model.planes.iter().enumerate() {
        for atom in 0..kind.atoms() {
            let place = at(x, lanes, lane, atom);
            let gap = (place - plane.point).dot(&plane.normal);
            let end = match scene.stage {
                Stage::First => at(y, lanes, lane, atom),
                Stage::Second => 1.5 * at(first, lanes, lane, atom) + 0.5 * at(y, lanes, lane, atom),
            };
            if gap <= TOUCH * kind.edge || gap + end.dot(&plane.normal) < 0.0 {
                pairs.push((atom, p));
            }
        }
    }
    pairs
}

fn correct_cell(
    scene: &Scene,
    lane: usize,
    x: &[f64],
    first: &[f64],
    gradient: &[f64],
    swell: &[f64],
    target: f64,
    y: &mut [f64],
    mut active: Vec<(usize, usize)>,
) -> f64 {
    let (kind, lanes) = (scene.kind, scene.kind.lanes);
    let mut columns: Vec<((usize, usize), Reach)> = Vec::new();
    let mut pressure = 0.0;
    let take = |values: &[f64]| -> Vec<f64> { values.chunks_exact(lanes).map(|row| row[lane]).collect() };
    let (x, first, gradient, swell, free) = (take(x), take(first), take(gradient), take(swell), take(y));
    let place = |values: &[f64], atom: usize| Vec3::from_column_slice(&values[3 * atom..3 * atom + 3]);
    let mut moved = free.clone();
    for _ in 0..ROUNDS {
        for &pair in &active {
            if !columns.iter().any(|(known, _)| *known == pair) {
                let column = reach(scene, &x, &gradient, &swell, target, pair);
                columns.push((pair, column));
            }
        }
        let column = |pair: &(usize, usize)| &columns.iter().find(|(known, _)| known == pair).expect("made above").1;
        let normal = |pair: &(usize, usize)| scene.model.planes[pair.1].normal;
        let size = active.len();
        let matrix =
            DMatrix::from_fn(size, size, |i, j| normal(&active[i]).dot(&place(&column(&active[j]).moved, active[i].0)));
        let missing = DVector::from_fn(size, |i, _| {
            let (atom, plane) = (active[i].0, &scene.model.planes[active[i].1]);
            let gap = (place(&x, atom) - plane.point).dot(&plane.normal);
            let already = match scene.stage {
                Stage::First => -gap,
                // 3/2 Y₁ + 1/2 Y₂ closes the gap.
                Stage::Second => -2.0 * gap - 3.0 * place(&first, atom).dot(&plane.normal),
            };
            already - place(&free, atom).dot(&plane.normal)
        });
        let Some(reaction) = matrix.lu().solve(&missing) else { break };
        moved.copy_from_slice(&free);
        pressure = 0.0;
        for (pair, r) in active.iter().zip(reaction.iter()) {
            moved.iter_mut().zip(&column(pair).moved).for_each(|(to, c)| *to += r * c);
            pressure += r * column(pair).pressure;
        }
        let before = active.len();
        let mut keep = reaction.iter().map(|&r| r >= 0.0);
        active.retain(|_| keep.next().unwrap_or(true));
        let released = active.len() < before;
        let all = touching_pairs(scene, 1, 0, &x, &first, &moved);
        let mut grown = false;
        for pair in all {
            let plane = &scene.model.planes[pair.1];
            let end = match scene.stage {
                Stage::First => place(&moved, pair.0),
                Stage::Second => 1.5 * place(&first, pair.0) + 0.5 * place(&moved, pair.0),
            };
            let gap = (place(&x, pair.0) + end - plane.point).dot(&plane.normal);
            if gap < -TOUCH * kind.edge && !active.contains(&pair) {
                active.push(pair);
                grown = true;
            }
        }
        if !released && !grown {
            break;
        }
    }
    for (row, value) in y.chunks_exact_mut(lanes).zip(moved) {
        row[lane] = value;
    }
    pressure
}

/// How a cell answers a unit reaction.
struct Reach {
    /// Increments of all atoms, µm/pN.
    moved: Vec<f64>,
    /// Pressure that holds the volume meanwhile, 1/µm².
    pressure: f64,
}

/// M n for an atom and a plane: how the whole cell moves under a unit reaction, its volume constraint included.
fn reach(scene: &Scene, x: &[f64], gradient: &[f64], swell: &[f64], target: f64, pair: (usize, usize)) -> Reach {
    let kind = scene.kind;
    let mut column = vec![0.0; x.len()];
    column[3 * pair.0..3 * pair.0 + 3].copy_from_slice(scene.model.planes[pair.1].normal.as_slice());
    let (mut spare, mut spare2) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    solve_block(kind, 1, scene.solver, x, &mut column, &mut spare, &mut spare2);
    let mut held = 0.0;
    if kind.volume != VolumeRule::Free {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        held = pressure(kind, scene.gamma, dot(gradient, &column), dot(gradient, swell), 0.0, target);
        column.iter_mut().zip(swell).for_each(|(to, s)| *to += held * s);
    }
    Reach { moved: column, pressure: held }
}

/// Puts atoms that passed a plane back on it and restores the volume by the others, in turns, until both hold; used
/// for one cell whose positions are `x[atom][axis]`. Returns the volume error left, relative to `target`.
pub fn project_cell(model: &Model, kind: &Kind, x: &mut [f64], target: Option<f64>) -> f64 {
    let atoms = kind.atoms();
    let (mut g, mut h, mut v) = (vec![0.0; x.len()], vec![0.0; x.len()], [0.0]);
    let mut error: f64 = 0.0;
    for _ in 0..30 {
        let mut moved: f64 = 0.0;
        let mut touching = vec![Vec::new(); atoms];
        for plane in &model.planes {
            for atom in 0..atoms {
                let place = Vec3::from_column_slice(&x[3 * atom..3 * atom + 3]);
                let gap = (place - plane.point).dot(&plane.normal);
                if gap < 0.0 && !(0..3).any(|axis| kind.is_held() && kind.held[3 * atom + axis] == 0.0) {
                    let back = place - gap * plane.normal;
                    x[3 * atom..3 * atom + 3].copy_from_slice(back.as_slice());
                    moved = moved.max(-gap);
                }
                if gap <= TOUCH * kind.edge {
                    touching[atom].push(plane.normal);
                }
            }
        }
        let Some(target) = target else { return 0.0 };
        volume::measure_block(&kind.rest.facets, x, &kind.held, &mut g, &mut v);
        error = ((v[0] - target) / target).abs();
        if error < 1e-13 && moved <= 1e-12 * kind.edge {
            return error;
        }
        for (atom, normals) in touching.iter().enumerate() {
            for normal in normals {
                let free = Vec3::from_column_slice(&g[3 * atom..3 * atom + 3]);
                let free = free - free.dot(normal) * normal;
                g[3 * atom..3 * atom + 3].copy_from_slice(free.as_slice());
            }
        }
        let c0 = v[0] - target;
        volume::measure_block(&kind.rest.facets, &g, &[], &mut h, &mut v);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let relative: Vec<f64> = x.iter().enumerate().map(|(i, value)| value - x[i % 3]).collect();
        let Some(root) = volume::least_root_exact(c0, dot(&g, &g), dot(&relative, &h), v[0]) else { return error };
        x.iter_mut().zip(&g).for_each(|(x, g)| *x += root * g);
    }
    error
}
