//! A time in the pieces between which the clock switches something, for methods that are no steppers.

use super::stepper::{Stepper, StepperBuffers};
use super::switches::{Ahead, Switches, after};
use super::{Method, Tolerances};
use crate::equations::program::Program;

/// A piece in which the clock switches nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// When it begins.
    pub begin: f64,
    /// When it ends: no later than it begins where switches follow at once.
    pub end: f64,
    /// Until when what there is at the end is the state, the switch itself included.
    pub until: f64,
}

/// The pieces of a time, one after the other.
pub struct Pieces<'a> {
    /// Tells the time alone.
    clock: Stepper<'a>,
    switches: Switches,
    until: f64,
}

/// What [`Pieces`] work in.
pub type PieceBuffers = (StepperBuffers, Switches);

impl<'a> Pieces<'a> {
    /// Those of a time, of a program that has beside its rates what switches. It is looked so often at what does not run evenly.
    pub fn new(program: &'a Program, (from, until): (f64, f64), looks: usize, buffers: Option<PieceBuffers>) -> Self {
        let (buffers, mut switches) =
            buffers.unwrap_or_else(|| (StepperBuffers::new(program, false), Switches::default()));
        let mut clock = Stepper::within(buffers, program, Method::Euler { step: 1.0 }, Tolerances::default());
        let initial = |quantity: &u32| program.initial[*quantity as usize];
        clock.resume(from, program.variables.iter().map(initial), program.open.iter().map(initial), (0.0, 1.0));
        switches.begin(&clock, until, looks);
        if switches.are_at_present(&mut clock) {
            clock.time = after(from, until);
        }
        Self { clock, switches, until }
    }

    /// The buffers, for the next time.
    pub fn into_buffers(self) -> PieceBuffers {
        (self.clock.into_buffers(), self.switches)
    }
}

impl Iterator for Pieces<'_> {
    type Item = Piece;

    fn next(&mut self) -> Option<Piece> {
        let begin = self.clock.time;
        if begin >= self.until {
            return None;
        }
        let Ahead { switch, seen } = self.switches.next(&mut self.clock);
        let until = self.until.min(switch.at).min(seen);
        let (end, after) = if until == switch.at { (switch.before, switch.after) } else { (until, until) };
        self.clock.time = after;
        Some(Piece { begin, end, until })
    }
}
