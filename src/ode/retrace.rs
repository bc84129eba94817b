//! A stepper that looks back: marks to be met, steps that look back at themselves, and what is kept of them.

use super::stepper::Stepper;
use super::{OdeTrouble, Reason, control};

/// How often a step that looks back at itself is made again before it counts as too long.
const MOST_SWEEPS: usize = 12;
/// Two of these are the same when they differ by this share of the tolerance.
const SAME: f64 = 1e-3;

impl Stepper<'_> {
    /// The next time to step to exactly, since what happened a delay ago happened at once; infinite where there is none.
    pub fn next_mark(&self) -> f64 {
        self.s.past.marks.next()
    }

    /// Takes note of what happens at once at the present: it will be met again when it is looked back at.
    pub fn mark(&mut self, is_new: bool) {
        self.forget_rates();
        if is_new {
            self.s.past.marks.jump(self.time);
        } else {
            self.s.past.marks.pass(self.time);
        }
    }

    /// Whether a delay was below 0.
    pub fn looks_ahead(&self) -> bool {
        self.s.past.ahead.is_some()
    }

    /// The trouble of a delay that looks ahead, if one did since this was asked last.
    ///
    /// # Errors
    /// When one did.
    pub fn check_delays(&mut self) -> Result<(), OdeTrouble> {
        match self.s.past.ahead.take() {
            None => Ok(()),
            Some((index, delay)) => {
                let detail = format!("{} with a delay of {delay}", self.program.delays[index].text);
                let trouble = self.trouble(Reason::LooksAhead);
                self.s.past.ahead = None;
                Err(OdeTrouble { detail, variable: None, ..trouble })
            }
        }
    }

    /// Makes a step. Where it looks back at itself it is made again, with what it gave, until it gives the same: returns whether
    /// it came to that.
    pub(super) fn attempt(&mut self, step: f64, make: impl Fn(&mut Self)) -> bool {
        self.s.past.attempt(step);
        make(self);
        if !self.s.past.is_met() {
            return true;
        }
        let mut before = Vec::new();
        for _ in 0..MOST_SWEEPS {
            before.clone_from(&self.s.proposal);
            self.sketch(step);
            make(self);
            let mut moved = std::mem::take(&mut self.s.error);
            let estimate = moved.clone();
            moved.iter_mut().zip(&before).zip(&self.s.proposal).for_each(|((to, a), b)| *to = [a[0] - b[0]]);
            let far = control::norm(&moved, &self.s.state, &before, &self.program.sizes, &self.tolerances)[0];
            self.s.error = estimate;
            if far <= SAME {
                return true;
            }
        }
        false
    }

    /// Takes down the values within a step of this length, so that it can be looked back at.
    pub(super) fn sketch(&mut self, step: f64) {
        let Some(mut piece) = self.s.past.blank(self.time, step) else { return };
        self.middle.clear();
        let (taken, mut state) = (self.taken, vec![0.0; self.s.state.len()]);
        self.taken = step;
        for node in 0..piece.nodes() {
            self.between(piece.share(node), &mut state);
            piece.set(node, &state);
        }
        self.taken = taken;
        self.s.past.present = Some(piece);
    }
}
