//! The reactions of a document at all boxes of a grid: its compiled equations over lanes of boxes.
//!
//! A step of reactions is one of the classical method of Runge and Kutta, so that its error is far below that of the splitting, or what the
//! document's scheme asks for: the engine's methods with error control, Rosenbrock's for stiff reactions, within each step of the splitting.

use pulp::Arch;

use super::broken::Broken;
use super::grid::Grid;
use super::positions::{Positions, positions, set_positions};
use super::react::{Chunk, POINTS};
use super::reactor_scratch::ReactorScratch;
use super::rows::{ROW, Rows};
use super::scales::{POSITION, Scales, compile};
use crate::equations::eml::{Document, Scheme};
use crate::equations::program::Program;
use crate::equations::tree::{Expr, Role};
use crate::error::{Error, Fault, Result};
use crate::ode::block;
use crate::ode::cells::Cells;
use crate::ode::scratch::Scratch;
use crate::ode::{Method, Tolerances};

/// Boxes side by side.
pub const WIDTH: usize = ROW;

/// The compiled reactions.
#[derive(Debug, Clone)]
pub struct Reactor {
    program: Program,
    rows: Rows,
    /// None for the classical method, one step at a time.
    method: Option<Method>,
    tolerances: Tolerances,
    scales: Scales,
    /// Where the position and the inputs stand among the registers.
    position_registers: Positions,
    inputs: Vec<usize>,
}

impl Reactor {
    /// The reactions of a document, or nothing where nothing reacts.
    ///
    /// # Errors
    /// A scheme that is not for fields.
    pub fn new(document: &Document, scales: Scales) -> Result<Option<Self>> {
        let method = method(document)?;
        let still = |role: &Role| !matches!(role, Role::Variable { rate } if *rate != Expr::Number(0.0));
        if document.system.quantities.iter().all(|quantity| still(&quantity.role)) {
            return Ok(None);
        }
        let program = compile(document)?;
        debug_assert!(document.fields.iter().map(|field| field.quantity).eq(program.variables.iter().copied()));
        let usual = Tolerances::default();
        let tolerances = Tolerances {
            relative: document.solver.rtol.unwrap_or(usual.relative),
            absolute: document.solver.atol.unwrap_or(usual.absolute),
            ..usual
        };
        let (position_registers, rows) = (positions(&program, &program.rates), Rows::new(&program));
        let ours = |number: &usize| !POSITION.contains(&program.names[program.open[*number] as usize].as_str());
        let inputs = (0..program.open.len()).filter(ours).map(|number| program.first_open() + number).collect();
        Ok(Some(Self { program, rows, method, tolerances, scales, position_registers, inputs }))
    }

    /// Lets the boxes of a chunk react; of those whose values are finite before and
    /// not after the one with the largest before.
    pub fn react(&self, grid: &Grid, inputs: &[f64], chunk: &mut Chunk) -> Option<Broken> {
        let key = (self.program.mark, self.method);
        // Taken out for as long as the chunk is worked on.
        let known = chunk.scratch.take().filter(|known| known.key == key);
        let mut own = known.unwrap_or_else(|| Box::new(ReactorScratch::new(key, &self.program)));
        for (register, value) in self.inputs.iter().zip(inputs) {
            own.scratch.file[*register] = [*value; WIDTH];
        }
        let broken = Arch::new().dispatch(Job { reactor: self, grid, own: &mut own, chunk });
        *chunk.scratch = Some(own);
        broken
    }

    #[inline(always)]
    fn blocks<S: pulp::Simd>(
        &self,
        simd: S,
        grid: &Grid,
        own: &mut ReactorScratch,
        chunk: &mut Chunk,
    ) -> Option<Broken> {
        let (from, dt) = (chunk.time / self.scales.seconds, chunk.dt / self.scales.seconds);
        let mut broken = None;
        for first in (0..chunk.points).step_by(WIDTH) {
            let scratch = &mut own.scratch;
            for (s, state) in scratch.state.iter_mut().enumerate() {
                state.copy_from_slice(&chunk.values[s * POINTS + first..][..WIDTH]);
            }
            set_positions(grid, self.scales, &self.position_registers, chunk.first + first, &mut scratch.file);
            match self.method {
                None => classical(simd, &self.rows, scratch, from, dt),
                Some(method) => self.with_method(simd, method, own, (from, from + dt)),
            }
            let scratch = &mut own.scratch;
            let mut fine = true;
            for (s, proposal) in scratch.proposal.iter().enumerate() {
                chunk.values[s * POINTS + first..][..WIDTH].copy_from_slice(proposal);
                for value in proposal {
                    fine &= value.abs() < f64::INFINITY;
                }
            }
            if !fine {
                let found = broken_box(scratch, chunk, first);
                let larger = |known: Broken| found.is_some_and(|found| found.before > known.before);
                broken = if broken.is_none_or(larger) { found } else { broken };
            }
        }
        broken
    }

    /// A step of reactions by one of the engine's methods; a box in trouble gets values that are no numbers.
    #[inline(always)]
    fn with_method<S: pulp::Simd>(&self, simd: S, method: Method, own: &mut ReactorScratch, window: (f64, f64)) {
        let ReactorScratch { scratch, states, before, open_values, .. } = own;
        states.copy_from_slice(&scratch.state);
        let open = self.program.first_open();
        let many = open_values.len();
        open_values.copy_from_slice(&scratch.file[open..open + many]);
        // The splitting has chosen its step for these reactions: it is tried in one piece.
        let (mut steps, mut errors) = ([[window.1 - window.0; WIDTH]], [[1.0; WIDTH]]);
        let mut cells = Cells { count: WIDTH, states, open_values, steps: &mut steps, errors: &mut errors, kept: None };
        before.copy_from_slice(&scratch.state);
        let result = block::advance(simd, &self.program, method, scratch, &mut cells, window, &self.tolerances);
        scratch.proposal.copy_from_slice(states);
        scratch.state.copy_from_slice(before);
        if let Err(trouble) = result {
            scratch.proposal[trouble.variable.unwrap_or(0)][trouble.cell] = f64::NAN;
        }
    }
}

/// The reactions of a chunk, so that they are compiled for the processor's lanes.
struct Job<'a, 'c> {
    reactor: &'a Reactor,
    grid: &'a Grid,
    own: &'a mut ReactorScratch,
    chunk: &'a mut Chunk<'c>,
}

impl pulp::WithSimd for Job<'_, '_> {
    type Output = Option<Broken>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Option<Broken> {
        self.reactor.blocks(simd, self.grid, self.own, self.chunk)
    }
}

/// The box of a block that is finite before and not after; of several the one with the largest value before.
#[inline(never)]
fn broken_box(scratch: &Scratch<WIDTH>, chunk: &Chunk, first: usize) -> Option<Broken> {
    let before = |lane: usize| scratch.state.iter().map(|state| state[lane].abs()).fold(0.0, f64::max);
    let was_fine = |lane: &usize| scratch.state.iter().all(|state| state[*lane].is_finite());
    let bad = |lane: usize| {
        let species = scratch.proposal.iter().position(|values| !values[lane].is_finite())?;
        let (value, at) = (scratch.proposal[species][lane], chunk.first + first + lane);
        Some(Broken { species, value, before: before(lane), at, time: chunk.time, dt: chunk.dt })
    };
    let found = (0..WIDTH.min(chunk.points - first)).filter(was_fine).filter_map(bad);
    found.rev().max_by(|a, b| a.before.total_cmp(&b.before))
}

/// Leaves the proposal of a step of the classical method of order 4, eq. (field.12).
#[inline(always)]
fn classical<S: pulp::Simd>(simd: S, rows: &Rows, s: &mut Scratch<WIDTH>, time: f64, dt: f64) {
    let n = s.state.len();
    s.file[0] = [time; WIDTH];
    s.file[1..=n].copy_from_slice(&s.state);
    s.proposal.copy_from_slice(&s.state);
    // What each stage adds to the proposal, where the next one begins, and when.
    for (weight, ahead, at) in [(1.0, 0.5, 0.5), (2.0, 0.5, 0.5), (2.0, 1.0, 1.0), (1.0, 0.0, 0.0)] {
        rows.run(simd, &mut s.file);
        // A rate may stand in the register of another variable: all are read before one is written.
        for (to, register) in s.stages.iter_mut().zip(&rows.outputs) {
            *to = s.file[*register];
        }
        s.file[0] = [time + at * dt; WIDTH];
        let begins = s.file[1..=n].iter_mut().zip(&s.state);
        for ((rate, to), (begin, from)) in s.stages.iter().zip(&mut s.proposal).zip(begins) {
            for l in 0..WIDTH {
                to[l] += weight * dt / 6.0 * rate[l];
                begin[l] = from[l] + ahead * dt * rate[l];
            }
        }
    }
}

/// The method that a document asks for.
fn method(document: &Document) -> Result<Option<Method>> {
    let inner = document.solver.inner_step.unwrap_or(f64::INFINITY);
    match document.solver.scheme {
        None => Ok(None),
        Some(Scheme::Rk45) => Ok(Some(Method::Rk45)),
        Some(Scheme::Rk65) => Ok(Some(Method::Rk65)),
        Some(Scheme::Rosenbrock) => Ok(Some(Method::Rosenbrock)),
        Some(Scheme::Rk4) => Ok(Some(Method::Rk4 { step: inner })),
        Some(other @ (Scheme::Euler | Scheme::Bdf)) => {
            let name = if other == Scheme::Bdf { "bdf" } else { "euler" };
            let message = format!("the reactions of the fields of '{}' cannot be taken with {name}", document.name);
            let help =
                "write scheme=\"rk4\", \"rk45\", \"rk65\" or, for stiff reactions, \"rosenbrock\", or leave it out";
            Err(Error::input(Fault::new(message).help(help)))
        }
    }
}
