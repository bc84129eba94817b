//! The cells of one task through one window by equal inner steps.

use pulp::Simd;

use super::cells::{CellTrouble, Cells};
use super::mask::{Mask, choose, when};
use super::scratch::Scratch;
use super::{Reason, Work, explicit};
use crate::equations::program::Program;

/// Equal inner steps no longer than `longest`, by the classical method or Euler's.
///
/// # Errors
/// The trouble of the first cell that failed; it keeps its last good state.
#[inline(always)]
pub fn advance<S: Simd, const L: usize, const CLASSICAL: bool>(
    simd: S,
    program: &Program,
    s: &mut Scratch<L>,
    cells: &mut Cells<L>,
    (from, until): (f64, f64),
    longest: f64,
) -> Result<Work, CellTrouble> {
    let (n, open) = (s.state.len(), program.first_open());
    // An inner step that goes into the window but for round-off does so exactly.
    let count = ((until - from) / longest - 1e-9).ceil().max(1.0);
    let step = (until - from) / count;
    let numbers = cells.open_values.len() / cells.steps.len();
    let mut trouble: Option<CellTrouble> = None;
    for block in 0..cells.steps.len() {
        s.state.copy_from_slice(&cells.states[block * n..(block + 1) * n]);
        s.file[open..open + numbers].copy_from_slice(&cells.open_values[block * numbers..(block + 1) * numbers]);
        // Lanes without a cell stay as they are.
        let mut going: Mask<L> = std::array::from_fn(|l| when(block * L + l < cells.count));
        for number in 0..count as u64 {
            let time = from + number as f64 * step;
            if CLASSICAL {
                explicit::classical(simd, program, s, [time; L], [step; L]);
            } else {
                explicit::euler(simd, program, s, [time; L], [step; L]);
            }
            for l in 0..L {
                let broken = (0..n).find(|&v| !s.proposal[v][l].is_finite());
                if broken.is_some() && going[l] != 0 {
                    going[l] = 0;
                    let cell = block * L + l;
                    if trouble.is_none_or(|known| cell < known.cell) {
                        trouble = Some(CellTrouble {
                            cell,
                            time,
                            variable: broken,
                            unknown: None,
                            reason: Reason::NotFinite,
                        });
                    }
                }
            }
            for (state, proposal) in s.state.iter_mut().zip(&s.proposal) {
                choose(state, proposal, &going);
            }
        }
        cells.states[block * n..(block + 1) * n].copy_from_slice(&s.state);
    }
    let steps = count as u64 * cells.count as u64;
    let work = Work { steps, rates: steps * if CLASSICAL { 4 } else { 1 }, ..Work::default() };
    trouble.map_or(Ok(work), Err)
}
