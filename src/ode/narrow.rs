//! A few cells one after the other: side by side they would leave most lanes of their block empty.

use pulp::Scalar;

use super::block;
use super::cells::{CellTrouble, Cells, Kept, kept_numbers};
use super::scratch::Scratch;
use super::{Method, Tolerances, Work};
use crate::equations::program::{Lanes, Program};

/// Buffers for one cell at a time.
#[derive(Debug)]
pub struct Narrow {
    scratch: Scratch<1>,
    state: Vec<Lanes<1>>,
    open_values: Vec<Lanes<1>>,
    /// See [`Kept`].
    kept: Vec<Lanes<1>>,
}

impl Narrow {
    /// Buffers for a cell of a program; `stiff` methods need matrices.
    pub fn new(program: &Program, stiff: bool) -> Self {
        let empty = |count| vec![[0.0]; count];
        let (n, open) = (program.size(), program.open.len());
        let scratch = Scratch::new(program, stiff);
        Self { scratch, state: empty(n), open_values: empty(open), kept: empty(kept_numbers(n, open)) }
    }

    /// Advances the cells of one block, each by itself: the same bits as side by side.
    ///
    /// # Errors
    /// The trouble of the first cell that failed; all others have reached the end.
    pub fn advance<const L: usize>(
        &mut self,
        program: &Program,
        method: Method,
        cells: &mut Cells<L>,
        window: (f64, f64),
        tolerances: &Tolerances,
    ) -> Result<Work, CellTrouble> {
        let mut result = Ok(Work::default());
        for l in 0..cells.count {
            match (self.advance_one(program, method, cells, l, window, tolerances), &mut result) {
                (Ok(done), Ok(work)) => work.add(done),
                (Err(trouble), Ok(_)) => result = Err(CellTrouble { cell: l, ..trouble }),
                (_, Err(_)) => {}
            }
        }
        result
    }

    fn advance_one<const L: usize>(
        &mut self,
        program: &Program,
        method: Method,
        cells: &mut Cells<L>,
        l: usize,
        window: (f64, f64),
        tolerances: &Tolerances,
    ) -> Result<Work, CellTrouble> {
        copy(&mut self.state, 0, cells.states, l);
        copy(&mut self.open_values, 0, cells.open_values, l);
        let (mut step, mut error) = ([[cells.steps[0][l]]], [[cells.errors[0][l]]]);
        let kept = cells.kept.as_ref().map(|kept| {
            copy(&mut self.kept, 0, kept.numbers, l);
            Kept { numbers: &mut self.kept }
        });
        let (steps, errors) = (&mut step[..], &mut error[..]);
        let mut one = Cells { count: 1, states: &mut self.state, open_values: &self.open_values, steps, errors, kept };
        let result = block::advance(Scalar, program, method, &mut self.scratch, &mut one, window, tolerances);
        copy(cells.states, l, &self.state, 0);
        if let Some(kept) = &mut cells.kept {
            copy(kept.numbers, l, &self.kept, 0);
        }
        (cells.steps[0][l], cells.errors[0][l]) = (step[0][0], error[0][0]);
        result
    }
}

/// Copies one lane of numbers to a lane of others.
fn copy<const A: usize, const B: usize>(to: &mut [Lanes<A>], a: usize, from: &[Lanes<B>], b: usize) {
    to.iter_mut().zip(from).for_each(|(to, from)| to[a] = from[b]);
}
