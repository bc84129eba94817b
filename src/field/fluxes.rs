//! The rates at which transport changes fields, from the fluxes through the faces of boxes, eq. (field.16) and eq. (field.17).

use rayon::iter::{IndexedParallelIterator, IntoParallelRefMutIterator, ParallelIterator};

use super::grid::Grid;
use super::rows::File;
use super::shared::Shared;
use super::tables::{Coefficient, Now};
use super::transport::{Carried, CarriedWall, Transport};
use crate::equations::Range;

/// Parts that the work is cut into when threads share it.
pub const PARTS: usize = 32;
/// Fewest boxes for which threads are worth waking.
const WORTH_THREADS: usize = 1 << 12;
/// Points of a table that one thread works out at a time.
const BATCH: usize = 1024;

/// How fast transport acts, 1/s: the largest over all boxes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Speeds {
    /// At which a box loses what it holds: a step of Euler's rule shorter than one over it leaves nothing below zero, eq. (field.19).
    pub losing: f64,
    /// The eigenvalues of what spreads and decays are no further from zero than this.
    pub spreading: f64,
    /// At which flows pass boxes.
    pub passing: f64,
}

impl Speeds {
    fn with(self, other: Self) -> Self {
        // What is no number stays so, to be found.
        let larger = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
        Self {
            losing: larger(self.losing, other.losing),
            spreading: larger(self.spreading, other.spreading),
            passing: larger(self.passing, other.passing),
        }
    }
}

/// What a part of the work needs by itself.
#[derive(Debug, Clone, Default)]
pub struct PartOfFluxes {
    file: File,
    faces: Vec<Face>,
    speeds: Speeds,
}

/// What passes a face, in the direction of its axis, and what that costs the boxes below and above it for each unit that they hold.
#[derive(Debug, Clone, Copy, Default)]
struct Face {
    flux: f64,
    losing: [f64; 2],
    spreading: f64,
    passing: f64,
}

/// Works out the rates of all carried species at a time, and how fast they act. The tables that vary are worked out anew.
pub fn rates(
    transport: &Transport,
    now: &Now,
    tables: &mut [Vec<f64>],
    parts: &mut [PartOfFluxes],
    to: &mut [f64],
) -> Speeds {
    let threads = now.grid.len() >= WORTH_THREADS && rayon::current_num_threads() > 1;
    for (table, values) in transport.tables.iter().zip(tables.iter_mut()).filter(|(table, _)| table.varies) {
        let (count, shared) = (values.len(), Shared::new(values));
        share(parts, threads, count.div_ceil(BATCH), |part, batch| {
            let first = batch * BATCH;
            // SAFETY: no other batch has these points.
            let values = unsafe { shared.part(first, BATCH.min(count - first)) };
            table.fill(now, first, values, &mut part.file);
        });
    }
    parts.iter_mut().for_each(|part| part.speeds = Speeds::default());
    let (grid, shared, tables) = (now.grid, Shared::new(to), &*tables);
    let [nx, ny, nz] = grid.cells;
    for carried in &transport.carried {
        let fluxes = Fluxes { grid, carried, values: now.values, tables, range: now.ranges[carried.species] };
        share(parts, threads, ny * nz, |part, row| {
            let first = carried.species * grid.len() + row * nx;
            // SAFETY: no other row has these boxes.
            let to = unsafe { shared.part(first, nx) };
            let PartOfFluxes { faces, speeds, .. } = part;
            *speeds = speeds.with(fluxes.row([row % ny, row / ny], faces, to));
        });
    }
    for carried in &transport.carried {
        for source in &carried.sources {
            let strength = source.strength.at(tables, 0);
            for (at, share) in &source.boxes {
                // SAFETY: nobody else is at work.
                let rate = unsafe { shared.part(carried.species * grid.len() + at, 1) };
                rate[0] += strength * share;
            }
        }
    }
    parts.iter().fold(Speeds::default(), |all, part| all.with(part.speeds))
}

/// Does so many tasks, in parts that threads share.
fn share(parts: &mut [PartOfFluxes], threads: bool, count: usize, work: impl Fn(&mut PartOfFluxes, usize) + Sync) {
    let many = parts.len();
    let of_part = |(number, part): (usize, &mut PartOfFluxes)| {
        (number * count / many..(number + 1) * count / many).for_each(|task| work(part, task));
    };
    if threads {
        parts.par_iter_mut().enumerate().for_each(of_part);
    } else {
        parts.iter_mut().enumerate().for_each(of_part);
    }
}

/// The fluxes of one species.
struct Fluxes<'a> {
    grid: &'a Grid,
    carried: &'a Carried,
    values: &'a [f64],
    tables: &'a [Vec<f64>],
    range: Range,
}

/// A line of boxes along an axis through a box.
#[derive(Clone, Copy)]
struct Line {
    axis: usize,
    /// The index along each axis of its boxes; that along its own counts for nothing.
    index: [usize; 3],
    /// The first box, and from one to the next.
    first: usize,
    stride: usize,
    n: usize,
    ring: bool,
}

impl Line {
    fn at(&self, i: usize) -> usize {
        self.first + i * self.stride
    }

    /// The neighbour of a box on either side.
    fn neighbours(&self, i: usize) -> [Option<usize>; 2] {
        let low = if i > 0 { Some(i - 1) } else { self.ring.then(|| self.n - 1) };
        let high = if i + 1 < self.n { Some(i + 1) } else { self.ring.then_some(0) };
        [low, high]
    }
}

impl Fluxes<'_> {
    /// The rates of a row of boxes along x.
    fn row(&self, [y, z]: [usize; 2], faces: &mut Vec<Face>, to: &mut [f64]) -> Speeds {
        let (carried, nx) = (self.carried, self.grid.cells[0]);
        let mut speeds = Speeds::default();
        let along = self.line(0, [0, y, z]);
        faces.clear();
        faces.extend((0..=nx).map(|f| self.face(&along, f)));
        let decay = carried.decay;
        for x in 0..nx {
            let value = self.value(self.grid.at(x, y, z));
            let mut rate = -decay * value;
            let mut speed = Speeds { losing: decay, spreading: decay, passing: 0.0 };
            let index = [x, y, z];
            for axis in (0..3).filter(|axis| self.grid.cells[*axis] > 1) {
                let (low, high) = if axis == 0 {
                    (faces[x], faces[x + 1])
                } else {
                    let line = self.line(axis, index);
                    (self.face(&line, index[axis]), self.face(&line, index[axis] + 1))
                };
                let inverse = 1.0 / self.grid.spacing[axis];
                rate -= (high.flux - low.flux) * inverse;
                speed.losing += (low.losing[1] + high.losing[0]) * inverse;
                speed.spreading += 2.0 * (low.spreading + high.spreading) * inverse;
                speed.passing += low.passing.max(high.passing) * inverse;
            }
            to[x] = rate;
            speeds = speeds.with(speed);
        }
        speeds
    }

    fn line(&self, axis: usize, index: [usize; 3]) -> Line {
        let [nx, ny, _] = self.grid.cells;
        let stride = [1, nx, nx * ny][axis];
        let at = self.grid.at(index[0], index[1], index[2]);
        let ring = self.carried.walls[axis][0] == CarriedWall::Periodic;
        Line { axis, index, first: at - index[axis] * stride, stride, n: self.grid.cells[axis], ring }
    }

    #[inline(always)]
    fn value(&self, at: usize) -> f64 {
        self.values[self.carried.species * self.grid.len() + at]
    }

    /// The face between box f − 1 and box f of a line.
    fn face(&self, line: &Line, f: usize) -> Face {
        let (low, high) = match f {
            0 if line.ring => (line.n - 1, 0),
            0 => return self.wall(line, 0),
            f if f == line.n && line.ring => (line.n - 1, 0),
            f if f == line.n => return self.wall(line, 1),
            f => (f - 1, f),
        };
        let inverse = 1.0 / self.grid.spacing[line.axis];
        let (a, b) = (line.at(low), line.at(high));
        let spreads = self.between(self.diffusion(a), self.diffusion(b)) * inverse;
        let mut speed = self.velocity(line, if line.ring && f == line.n { 0 } else { f });
        for (towards, sensitivity) in &self.carried.taxis {
            let followed = &self.values[towards * self.grid.len()..];
            let chi = 0.5 * (sensitivity.at(self.tables, a) + sensitivity.at(self.tables, b));
            speed += chi * (followed[b] - followed[a]) * inverse;
        }
        let carried = if speed > 0.0 {
            speed * self.at_face(line, low, 1)
        } else if speed < 0.0 {
            speed * self.at_face(line, high, 0)
        } else {
            speed
        };
        let flux = carried - spreads * (self.value(b) - self.value(a));
        let losing = [spreads + 2.0 * speed.max(0.0), spreads + 2.0 * (-speed).max(0.0)];
        Face { flux, losing, spreading: spreads, passing: speed.abs() }
    }

    /// The face at a wall.
    fn wall(&self, line: &Line, side: usize) -> Face {
        let (i, inverse) = (if side == 0 { 0 } else { line.n - 1 }, 1.0 / self.grid.spacing[line.axis]);
        let at = line.at(i);
        let number = {
            let mut index = line.index;
            index[line.axis] = 0;
            let mut counts = self.grid.cells;
            counts[line.axis] = 1;
            (index[2] * counts[1] + index[1]) * counts[0] + index[0]
        };
        let inwards = if side == 0 { 1.0 } else { -1.0 };
        let of_box = |losing: f64| if side == 0 { [0.0, losing] } else { [losing, 0.0] };
        let (held, spreads) = match self.carried.walls[line.axis][side] {
            CarriedWall::NoFlux | CarriedWall::Periodic => return Face::default(),
            CarriedWall::Flux(flux, slope) => {
                let comes = flux.at(self.tables, number);
                let slope = 1.5 * slope.at(self.tables, number).abs();
                return Face { flux: inwards * comes, losing: of_box(slope), spreading: slope, passing: 0.0 };
            }
            CarriedWall::Fixed(value) => (value.at(self.tables, number), 2.0 * self.diffusion(at) * inverse),
            CarriedWall::Open(value) => (value.at(self.tables, number), 0.0),
        };
        let speed = self.velocity(line, if side == 0 { 0 } else { line.n }) * inwards;
        let carried = if speed > 0.0 { speed * held } else { speed * self.at_face(line, i, side) };
        let flux = inwards * (carried + spreads * (held - self.value(at)));
        let losing = spreads + 2.0 * (-speed).max(0.0);
        Face { flux, losing: of_box(losing), spreading: spreads, passing: speed.abs() }
    }

    fn diffusion(&self, at: usize) -> f64 {
        self.carried.diffusion.at(self.tables, at)
    }

    /// The diffusion coefficient of a face between two boxes.
    fn between(&self, a: f64, b: f64) -> f64 {
        match self.carried.diffusion {
            Coefficient::Number(value) => value,
            Coefficient::Table(_) if self.carried.follows_fields => 0.5 * (a + b),
            Coefficient::Table(_) if a + b > 0.0 => 2.0 * a * b / (a + b),
            Coefficient::Table(_) => 0.0 * (a + b),
        }
    }

    fn velocity(&self, line: &Line, f: usize) -> f64 {
        let Some(velocity) = self.carried.velocity[line.axis] else { return 0.0 };
        let (mut index, mut counts) = (line.index, self.grid.cells);
        index[line.axis] = f;
        counts[line.axis] += 1;
        velocity.at(self.tables, (index[2] * counts[1] + index[1]) * counts[0] + index[0])
    }

    /// The value of a box at its low (0) or high (1) face, of third order where the values are smooth, limited, eq. (field.18), so that it lies
    /// between those of the box and its neighbour.
    fn at_face(&self, line: &Line, i: usize, side: usize) -> f64 {
        let value = self.value(line.at(i));
        let near = |i: usize| self.value(line.at(i));
        let slope = match line.neighbours(i) {
            [Some(low), Some(high)] => {
                let (a, b) = (value - near(low), near(high) - value);
                // Behind and ahead of the face.
                let (behind, ahead) = if side == 1 { (a, b) } else { (b, a) };
                let size = (2.0 * behind.abs()).min(2.0 * ahead.abs()).min((behind.abs() + 2.0 * ahead.abs()) / 3.0);
                if a * b > 0.0 { size.copysign(a) } else { 0.0 * (a + b) }
            }
            [Some(low), None] => value - near(low),
            [None, Some(high)] => near(high) - value,
            [None, None] => 0.0,
        };
        let at_face = value + if side == 1 { 0.5 * slope } else { -0.5 * slope };
        match self.range {
            Range::NonNegative if value >= 0.0 => at_face.clamp(0.0, 2.0 * value),
            _ => at_face,
        }
    }
}
