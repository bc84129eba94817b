//! Rigid obstacles: no atom passes them, and the force with which an obstacle holds an atom is part of the implicit solve.
//!
//! In a step the atoms that press on an obstacle are found by the active-set method, eq. (planes.1): with M the constrained
//! mobility of the cell (eq. step.4, step.5) and C the normals of the touching atoms, the reactions r ≥ 0 solve
//! `C M Cᵀ r = −gap − C Y`. So a cell that rests on an obstacle is in exact balance, however large the step.

use super::copies::Copies;
use super::eliminate::eliminate;
use super::kind::{Kind, VolumeRule};
use super::model::Model;
use super::obstacle::Obstacle;
use super::pressure::pressure;
use super::rolling::{Roll, add_rolls};
use super::solver::{Stage, System};
use super::spots::{Spot, find_spots};
use crate::Vec3;
use crate::mechanics::integrator::StepSize;

/// What a correction needs to know.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The model.
    pub model: &'a Model,
    /// The kind of the block.
    pub kind: &'a Kind,
    /// The linear system of its cells.
    pub system: System<'a>,
    /// The stage of the step.
    pub stage: Stage,
    /// When the step ends, s: obstacles that go are where they are then.
    pub end: f64,
    /// γ of the scheme.
    pub gamma: f64,
    /// What forces of the stage count of what moves a cell as a whole.
    pub share: f64,
}

/// An atom closer to an obstacle than this part of an edge touches it: far below any deformation, far above round-off.
pub const TOUCH: f64 = 1e-9;

/// By how much of what a whole rigid body gives way each of its atoms does by itself.
const YIELDING: f64 = 1e-9;

/// Rounds of the active-set method; it ends in two or three, a cycle is cut here and the projection does the rest.
const ROUNDS: usize = 12;

/// More than this many times what pressed before, and some, does not come to press at once: where it seems so, forces that nearly cancel have thrown the
/// cell about, and its step is to be made shorter.
const GROWTH: usize = 4;
const SOME: usize = 256;

/// Scratch of a block: empty until a cell of the block touches an obstacle, then kept.
#[derive(Debug, Clone, Default)]
pub struct TouchScratch {
    /// Forces of obstacles on atoms in the mean over the attempt, pN, of the shape of the positions of the block; empty where nobody asks or
    /// nothing touches.
    pub reactions: Vec<f64>,
    /// Where the cell may touch.
    spots: Vec<Spot>,
    /// Numbers of spots that press now.
    active: Vec<usize>,
    /// Numbers of spots that a look at the gaps found.
    found: Vec<usize>,
    /// Numbers of spots whose column is known.
    known: Vec<usize>,
    /// Which of these each active spot is.
    numbers: Vec<usize>,
    /// How the cell answers a unit reaction of each known spot: increments of all atoms, µm/pN.
    columns: Vec<f64>,
    /// Pressure that holds the volume meanwhile, 1/µm², of each known spot.
    pressures: Vec<f64>,
    /// How what is held rolls on curved obstacles, lane by lane, as the first stage of a step finds it for both.
    rolls: Vec<Vec<Roll>>,
    /// Those of the cell that is corrected now.
    rolling: Vec<Roll>,
    /// How the cell answers a unit force along each of these, µm/pN.
    roll_columns: Vec<f64>,
    /// Pressure that holds the volume meanwhile, 1/µm².
    roll_pressures: Vec<f64>,
    /// The matrix of the reactions, with the forces of what rolls behind them, and the right side beside it, row by row.
    system: Vec<f64>,
    /// One cell's factor, gathered from the block.
    factor: Vec<f64>,
    /// One cell's arrays, gathered from the block.
    cell: CellArrays,
    /// The same cell in every lane, to find several columns at once.
    copies: Copies,
}

/// Arrays `[atom][axis]` of one cell.
#[derive(Debug, Clone, Default)]
struct CellArrays {
    x: Vec<f64>,
    first: Vec<f64>,
    gradient: Vec<f64>,
    swell: Vec<f64>,
    free: Vec<f64>,
    moved: Vec<f64>,
    /// Forces of obstacles, pN.
    pressed: Vec<f64>,
}

impl TouchScratch {
    /// Writes NaN over all scratch numbers.
    pub fn poison(&mut self) {
        let c = &mut self.cell;
        for array in
            [&mut self.columns, &mut self.pressures, &mut self.system, &mut self.factor, &mut c.x, &mut c.first]
                .into_iter()
                .chain([&mut self.roll_columns, &mut self.roll_pressures])
        {
            array.fill(f64::NAN);
        }
        for array in [&mut self.reactions, &mut c.pressed, &mut c.gradient, &mut c.swell, &mut c.free, &mut c.moved] {
            array.fill(f64::NAN);
        }
        self.copies.poison();
    }
}

/// Corrects the increments of the cells of a block that touch obstacles.
pub fn correct_block(
    scene: &Scene,
    x: &[f64],
    first: &[f64],
    gradient: &[f64],
    swell: &[f64],
    target: &[f64],
    y: &mut [f64],
    pressure: &mut [f64],
    scratch: &mut TouchScratch,
) {
    if scene.model.obstacles.is_empty() {
        return;
    }
    let lanes = scene.kind.lanes;
    scratch.rolls.resize(lanes, Vec::new());
    for lane in 0..lanes {
        find_spots_of_stage(
            scene,
            |atom| at(x, lanes, lane, atom),
            |atom| at(first, lanes, lane, atom),
            &mut scratch.spots,
        );
        let end = |atom| end_of(scene.stage, at(first, lanes, lane, atom), at(y, lanes, lane, atom));
        find_touching(scene, &scratch.spots, end, &mut scratch.active);
        if scene.stage == Stage::First {
            scratch.rolls[lane].clear();
        }
        if scratch.active.is_empty() {
            continue;
        }
        let c = &mut scratch.cell;
        for (to, from) in [(&mut c.x, x), (&mut c.first, first), (&mut c.gradient, gradient), (&mut c.swell, swell)] {
            take_lane(from, lanes, lane, to);
        }
        take_lane(y, lanes, lane, &mut c.free);
        let mut factor = std::mem::take(&mut scratch.factor);
        let of_cell = Scene { system: scene.system.of_lane(lane, &mut factor), ..*scene };
        std::mem::swap(&mut scratch.rolling, &mut scratch.rolls[lane]);
        pressure[lane] += correct_cell(&of_cell, target[lane], scratch);
        std::mem::swap(&mut scratch.rolling, &mut scratch.rolls[lane]);
        scratch.factor = factor;
        for (row, value) in y.chunks_exact_mut(lanes).zip(&scratch.cell.moved) {
            row[lane] = *value;
        }
        if scene.model.keeps_tractions {
            scratch.reactions.resize(y.len(), 0.0);
            for (row, force) in scratch.reactions.chunks_exact_mut(lanes).zip(&scratch.cell.pressed) {
                row[lane] += scene.share * force;
            }
        }
    }
}

fn take_lane(from: &[f64], lanes: usize, lane: usize, to: &mut Vec<f64>) {
    to.clear();
    to.extend(from.chunks_exact(lanes).map(|row| row[lane]));
}

/// Vector of an atom in a block.
fn at(values: &[f64], lanes: usize, lane: usize, atom: usize) -> Vec3 {
    Vec3::from_fn(|axis, _| values[(3 * atom + axis) * lanes + lane])
}

/// Vector of an atom in one cell's array.
fn vector_of(values: &[f64], atom: usize) -> Vec3 {
    Vec3::from_column_slice(&values[3 * atom..3 * atom + 3])
}

/// Where an atom ends the step relative to its start.
fn end_of(stage: Stage, first: Vec3, y: Vec3) -> Vec3 {
    match stage {
        Stage::First => y,
        Stage::Second => 1.5 * first + 0.5 * y,
    }
}

/// Finds where a cell may touch in a stage: in the second on curved obstacles from where the first has led, its gap told as if straight from the start.
fn find_spots_of_stage(scene: &Scene, x: impl Fn(usize) -> Vec3, first: impl Fn(usize) -> Vec3, spots: &mut Vec<Spot>) {
    let obstacles = &scene.model.obstacles;
    if scene.stage == Stage::First || obstacles.iter().all(Obstacle::is_flat) {
        return find_spots(scene.kind, obstacles, scene.end, x, spots);
    }
    find_spots(scene.kind, obstacles, scene.end, |atom| x(atom) + first(atom), spots);
    spots.iter_mut().for_each(|spot| spot.gap -= spot.mean(&first).dot(&spot.normal));
}

/// Finds the spots that touch at the start of the step or would pass at its end, given how far atoms go.
fn find_touching(scene: &Scene, spots: &[Spot], end: impl Fn(usize) -> Vec3, touching: &mut Vec<usize>) {
    touching.clear();
    let touches =
        |spot: &Spot| spot.gap <= TOUCH * scene.kind.edge || spot.gap + spot.mean(&end).dot(&spot.normal) < 0.0;
    touching.extend((0..spots.len()).filter(|number| touches(&spots[*number])));
}

/// Finds the reactions of one cell; its increments are left in `moved`. Returns their part of the pressure.
fn correct_cell(scene: &Scene, target: f64, s: &mut TouchScratch) -> f64 {
    let size = s.cell.x.len();
    s.known.clear();
    s.columns.clear();
    s.pressures.clear();
    s.cell.moved.clone_from(&s.cell.free);
    s.cell.pressed.clear();
    s.cell.pressed.resize(if scene.model.keeps_tractions { size } else { 0 }, 0.0);
    answer_rolling(scene, target, s);
    let pressure = settle_reactions(scene, target, s);
    if scene.stage == Stage::Second || !find_rolling(scene, s) {
        return pressure;
    }
    answer_rolling(scene, target, s);
    settle_reactions(scene, target, s)
}

/// Finds which spots press, and moves the cell by what they do. Returns their part of the pressure.
fn settle_reactions(scene: &Scene, target: f64, s: &mut TouchScratch) -> f64 {
    let size = s.cell.x.len();
    let mut pressure = 0.0;
    for _ in 0..ROUNDS {
        let known = s.known.len();
        s.numbers.clear();
        for spot in &s.active {
            let number = s.known.iter().position(|other| other == spot).unwrap_or(s.known.len());
            if number == s.known.len() {
                s.known.push(*spot);
            }
            s.numbers.push(number);
        }
        reach(scene, target, known, s);
        if !solve_reactions(scene, s) {
            break;
        }
        s.cell.moved.copy_from_slice(&s.cell.free);
        s.cell.pressed.fill(0.0);
        pressure = 0.0;
        let (active, width) = (s.active.len(), s.active.len() + s.rolling.len() + 1);
        for (number, &column) in s.numbers.iter().enumerate() {
            let r = s.system[number * width + width - 1];
            let answer = &s.columns[column * size..(column + 1) * size];
            s.cell.moved.iter_mut().zip(answer).for_each(|(to, c)| *to += r * c);
            pressure += r * s.pressures[column];
            let spot = &s.spots[s.known[column]];
            for (atom, share) in spot.parts() {
                press(&mut s.cell.pressed, atom, share * r * spot.normal);
            }
        }
        for (number, roll) in s.rolling.iter().enumerate() {
            let force = s.system[(active + number) * width + width - 1];
            let answer = &s.roll_columns[number * size..(number + 1) * size];
            s.cell.moved.iter_mut().zip(answer).for_each(|(to, c)| *to += force * c);
            pressure += force * s.roll_pressures[number];
            roll.parts.iter().for_each(|(atom, vector)| press(&mut s.cell.pressed, *atom, force * vector));
        }
        if !change_active(scene, s) {
            break;
        }
    }
    pressure
}

/// Notes a force of an obstacle on an atom, where somebody asks.
fn press(pressed: &mut [f64], atom: usize, force: Vec3) {
    pressed.iter_mut().skip(3 * atom).zip(&force).for_each(|(pressed, force)| *pressed += force);
}

/// Finds how what presses rolls; false where nothing does.
fn find_rolling(scene: &Scene, s: &mut TouchScratch) -> bool {
    s.rolling.clear();
    let width = s.active.len() + 1;
    for (row, number) in s.active.iter().enumerate() {
        let (spot, reaction) = (&s.spots[*number], s.system.get(row * width + width - 1).copied().unwrap_or(0.0));
        let obstacle = &scene.model.obstacles[spot.obstacle];
        if reaction > 0.0 && !obstacle.is_flat() {
            add_rolls(obstacle, scene.end, spot, reaction, |atom| vector_of(&s.cell.x, atom), &mut s.rolling);
        }
    }
    !s.rolling.is_empty()
}

/// Solves `C M Cᵀ r = −gap − C Y` for the active spots, eq. (planes.1), together with the forces φ of what rolls, `q·Y = −φ/(γk)`; both stand in the
/// last column of the system.
fn solve_reactions(scene: &Scene, s: &mut TouchScratch) -> bool {
    let (active, size) = (s.active.len(), s.cell.x.len());
    let rows = active + s.rolling.len();
    let width = rows + 1;
    s.system.clear();
    s.system.resize(rows * width, 0.0);
    let columns = || {
        let of_spots = s.numbers.iter().map(|column| &s.columns[column * size..(column + 1) * size]);
        of_spots.chain(s.roll_columns.chunks_exact(size).take(s.rolling.len()))
    };
    for (i, spot) in s.active.iter().map(|number| &s.spots[*number]).enumerate() {
        let along = |values: &[f64]| spot.mean(|atom| vector_of(values, atom)).dot(&spot.normal);
        for (j, column) in columns().enumerate() {
            s.system[i * width + j] = along(column);
        }
        let already = match scene.stage {
            Stage::First => -spot.gap,
            // 3/2 Y₁ + 1/2 Y₂ closes the gap.
            Stage::Second => -2.0 * spot.gap - 3.0 * along(&s.cell.first),
        };
        if scene.kind.rigid.is_some() {
            // More atoms than a rigid body has motions share what holds it: as if each gave way a little.
            s.system[i * width + i] *= 1.0 + YIELDING;
        }
        s.system[i * width + rows] = already - along(&s.cell.free);
    }
    for (i, roll) in (active..).zip(&s.rolling) {
        let along = |values: &[f64]| roll.along(|atom| vector_of(values, atom));
        for (j, column) in columns().enumerate() {
            s.system[i * width + j] = along(column);
        }
        s.system[i * width + i] += 1.0 / (scene.gamma * roll.stiffness);
        s.system[i * width + rows] = -along(&s.cell.free);
    }
    eliminate(rows, &mut s.system)
}

/// Releases spots that pull, takes up spots that pass; tells whether the set changed.
fn change_active(scene: &Scene, s: &mut TouchScratch) -> bool {
    let (before, width) = (s.active.len(), s.active.len() + s.rolling.len() + 1);
    let mut rows = 0..before;
    s.active.retain(|_| rows.next().is_none_or(|row| s.system[row * width + width - 1] >= 0.0));
    let released = s.active.len() < before;
    let c = &s.cell;
    let end = |atom| end_of(scene.stage, vector_of(&c.first, atom), vector_of(&c.moved, atom));
    find_touching(scene, &s.spots, end, &mut s.found);
    let passes = |spot: &Spot| spot.gap + spot.mean(end).dot(&spot.normal) < -TOUCH * scene.kind.edge;
    s.found.retain(|number| passes(&s.spots[*number]) && !s.active.contains(number));
    // Steps of one length have no error that would make them again.
    let may_be_shorter = matches!(scene.model.integrator.size, StepSize::Adaptive { .. });
    if may_be_shorter && s.found.len() > GROWTH * before + SOME {
        return false;
    }
    s.active.extend(&s.found);
    released || !s.found.is_empty()
}

/// M n for the known spots from a number on: how the whole cell moves under a unit reaction of each, its volume
/// constraint included.
fn reach(scene: &Scene, target: f64, from: usize, s: &mut TouchScratch) {
    let size = s.cell.x.len();
    s.columns.resize(s.known.len() * size, 0.0);
    let TouchScratch { spots, known, columns, pressures, cell, copies, .. } = s;
    let (known, columns) = (&known[from..], &mut columns[from * size..]);
    for (number, column) in known.iter().zip(columns.chunks_exact_mut(size)) {
        column.fill(0.0);
        let spot = &spots[*number];
        spot.parts().for_each(|(atom, share)| press(column, atom, share * spot.normal));
    }
    answer(scene, target, (cell, copies), columns, pressures);
}

/// M q for all that rolls.
fn answer_rolling(scene: &Scene, target: f64, s: &mut TouchScratch) {
    let size = s.cell.x.len();
    s.roll_columns.resize(s.rolling.len() * size, 0.0);
    s.roll_pressures.clear();
    let TouchScratch { rolling, roll_columns, roll_pressures, cell, copies, .. } = s;
    for (roll, column) in rolling.iter().zip(roll_columns.chunks_exact_mut(size)) {
        column.fill(0.0);
        roll.parts.iter().for_each(|(atom, vector)| press(column, *atom, *vector));
    }
    answer(scene, target, (cell, copies), roll_columns, roll_pressures);
}

/// Makes forces how the whole cell moves under them, its volume constraint included.
fn answer(
    scene: &Scene,
    target: f64,
    (c, copies): (&CellArrays, &mut Copies),
    columns: &mut [f64],
    pressures: &mut Vec<f64>,
) {
    let (kind, size) = (scene.kind, c.x.len());
    copies.solve(kind, &scene.system, &c.x, columns);
    for column in columns.chunks_exact_mut(size) {
        let mut held = 0.0;
        if kind.volume != VolumeRule::Free {
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            held = pressure(kind, scene.gamma, dot(&c.gradient, column), dot(&c.gradient, &c.swell), 0.0, target);
            column.iter_mut().zip(&c.swell).for_each(|(to, s)| *to += held * s);
        }
        pressures.push(held);
    }
}
