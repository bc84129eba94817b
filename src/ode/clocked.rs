//! Populations whose systems the clock switches: windows are cut where it does, eq. (ode.9), for all cells alike.

use super::buffers::PopulationScratch;
use super::pieces::{Piece, Pieces};
use super::population::Population;
use super::stops::{Stops, stops};
use super::switches::{LOOKS_IN_WINDOW, after};
use super::{OdeTrouble, Tolerances, Work};
use crate::equations::program::Program;
use crate::equations::tree::System;

/// Compiles a system without events for populations, and beside its rates what the clock switches in all cells at the same times: what depends
/// on no input.
///
/// # Errors
/// As [`Program::with`].
pub fn clocked(system: &System) -> Result<Program, Vec<String>> {
    let Stops { differences, counts } = stops(system, false);
    match differences.is_empty() && counts.is_empty() {
        true => Program::new(system),
        // In the places where they stand of systems with events.
        false => Program::with(system, 0.0, &[], &[Vec::new(), Vec::new(), differences, counts]),
    }
}

impl PopulationScratch {
    /// Shows the pieces of a window of a program from [`clocked`], or of one with events, between which the clock switches something in all cells.
    pub fn each_piece(&mut self, program: &Program, window: (f64, f64), each: impl FnMut(Piece)) {
        if program.further.is_empty() || after(window.0, window.1) >= window.1 {
            std::iter::once(Piece { begin: window.0, end: window.1, until: window.1 }).for_each(each);
            return;
        }
        let mut pieces = Pieces::new(program, window, LOOKS_IN_WINDOW, self.clock.take());
        pieces.by_ref().for_each(each);
        self.clock = Some(pieces.into_buffers());
    }
}

impl Population {
    /// As [`Self::advance`], of a program from [`clocked`]: piece by piece between the times at which the clock switches something.
    ///
    /// # Errors
    /// As [`Self::advance`]; where a piece fails no cell goes beyond it.
    ///
    /// # Panics
    /// As [`Self::advance`].
    pub fn advance_by_clock(
        &mut self,
        program: &Program,
        (from, until): (f64, f64),
        tolerances: &Tolerances,
        scratch: &mut PopulationScratch,
    ) -> Result<Work, OdeTrouble> {
        if program.further.is_empty() || after(from, until) >= until {
            return self.advance(program, from, until, tolerances, scratch);
        }
        scratch.suit(program, self.method(), self.blocks());
        let mut pieces = Pieces::new(program, (from, until), LOOKS_IN_WINDOW, scratch.clock.take());
        let mut result = Ok(Work::default());
        for Piece { begin, end, .. } in pieces.by_ref().filter(|piece| piece.end > piece.begin) {
            match (&mut result, self.advance(program, begin, end, tolerances, scratch)) {
                (Ok(work), Ok(more)) => work.add(more),
                (_, advanced) => {
                    result = advanced;
                    break;
                }
            }
        }
        scratch.clock = Some(pieces.into_buffers());
        result
    }
}
