//! Who is told where a run is.

use crate::experiment::Settling;
use crate::simulation::Simulation;

/// Listens to a run.
pub trait Report: Send {
    /// Something to know before the run begins.
    fn notice(&mut self, words: &str);
    /// Before the run begins cells are looked at, whether they overlap, and pushed apart.
    fn settle(&mut self, what: Settling) {
        let _ = what;
    }
    /// The run begins, or goes on, at `time` and will end at `until`, s.
    fn begin(&mut self, time: f64, until: f64);
    /// A step ended at `time`, s.
    fn step(&mut self, time: f64, steps: u64);
    /// After a step, what is simulated may be looked at; the run goes on when this returns.
    fn look(&mut self, simulation: &Simulation) {
        let _ = simulation;
    }
    /// The run ended or stopped.
    fn end(&mut self);
}

/// Says nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Quiet;

impl Report for Quiet {
    fn notice(&mut self, _: &str) {}
    fn begin(&mut self, _: f64, _: f64) {}
    fn step(&mut self, _: f64, _: u64) {}
    fn end(&mut self) {}
}
