//! A window of fields in the pieces between which the clock switches something.

use super::state::{FINEST, Fields};
use super::step::Report;
use crate::equations::program::Program;
use crate::error::Result;
use crate::ode::Piece;

impl Fields {
    /// Moves through a window, s, piece by piece: `advance` is given the length of each, s, and its share of the window.
    ///
    /// # Errors
    /// Of a piece; the fields are then as they were before the window.
    pub(super) fn in_pieces(
        &mut self,
        clock: &Program,
        window: f64,
        seconds: f64,
        advance: impl Fn(&mut Self, f64, f64) -> Result<Report>,
    ) -> Result<Report> {
        let (began, pace) = (self.time, self.pace());
        let mut pieces = std::mem::take(&mut self.work.pieces);
        pieces.clear();
        let within = (began / seconds, (began + window) / seconds);
        self.work.clock.each_piece(clock, within, |piece| pieces.push(piece));
        pieces.retain(|piece| piece.end > piece.begin);
        let result = match pieces[..] {
            [] | [_] if is_whole(&pieces, within) => advance(self, window, 1.0),
            _ => self.each_of(&pieces, (began, window), seconds, advance),
        };
        self.work.pieces = pieces;
        if result.is_err() {
            self.set_pace(pace);
        }
        self.time = if result.is_ok() { began + window } else { began };
        result
    }

    fn each_of(
        &mut self,
        pieces: &[Piece],
        (began, window): (f64, f64),
        seconds: f64,
        advance: impl Fn(&mut Self, f64, f64) -> Result<Report>,
    ) -> Result<Report> {
        let mut begun = std::mem::take(&mut self.work.begun);
        begun.clear();
        begun.extend_from_slice(&self.values);
        let (mut report, mut known) = (Report::default(), window);
        let mut result = Ok(());
        for piece in pieces {
            let length = (piece.end - piece.begin) * seconds;
            self.keep_step(known, length);
            self.time = piece.begin * seconds;
            match advance(self, length, length / window) {
                Ok(more) => report.add(more),
                Err(error) => {
                    result = Err(error);
                    break;
                }
            }
            known = length;
        }
        self.keep_step(known, window);
        if result.is_err() {
            self.values.copy_from_slice(&begun);
            self.time = began;
        }
        self.work.begun = begun;
        result.map(|()| report)
    }

    /// Keeps about the step that was taken in a window of another length.
    pub(super) fn keep_step(&mut self, from: f64, to: f64) {
        self.set_pace((halvings(to, from / f64::from(1_u32 << self.level)), self.unchecked));
    }
}

/// How often a window of a length is halved for steps of about another one, or shorter. Lengths that differ by round-off are the same.
pub(super) fn halvings(window: f64, step: f64) -> u32 {
    (window / step * (1.0 - 1e-9)).log2().ceil().clamp(0.0, f64::from(FINEST)) as u32
}

/// Whether there is one piece, and it is the whole window.
fn is_whole(pieces: &[Piece], (from, until): (f64, f64)) -> bool {
    matches!(pieces, [only] if only.begin == from && only.end == until)
}
