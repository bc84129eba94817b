//! The values of all species on one grid.

use super::carry::CarryScratch;
use super::error::Change;
use super::grid::Grid;
use super::react::PartScratch;
use super::species::Species;
use super::steady::steady;
use super::sweeps::{Factors, PARTS, diffuse, sweep_buffer};
use crate::Vec3;
use crate::equations::Range;
use crate::error::{Error, Fault, Result};
use crate::ode::{Piece, PopulationScratch};

/// A window is never halved more often than this.
pub const FINEST: u32 = 20;
/// Step sizes whose factors are kept: a step, its half, and those of the last change.
const KEPT_FACTORS: usize = 6;

/// Substances that diffuse, decay and react on one grid.
#[derive(Debug, Clone)]
pub struct Fields {
    pub(super) grid: Grid,
    pub(super) species: Vec<Species>,
    /// `[species][box]`, amount/µm² on the substrate and amount/µm³ in the medium.
    pub(super) values: Vec<f64>,
    pub(super) time: f64,
    /// Halvings of the window that the last window ended with, and steps until the next check.
    pub(super) level: u32,
    pub(super) unchecked: u32,
    pub(super) work: Work,
}

/// What a step needs beside the state; it says nothing about the fields.
#[derive(Debug, Clone)]
pub(super) struct Work {
    /// What each species keeps between held walls; empty without.
    steady: Vec<Vec<f64>>,
    /// Ranges that the sweeps keep: a distance from the steady profile may be negative.
    ranges: Vec<Range>,
    factors: Vec<Factors>,
    /// When each of the factors was last used.
    used: Vec<u64>,
    uses: u64,
    /// For the sweeps along the axes, and for the reactions: one for each part of the work.
    sweeping: Vec<Vec<f64>>,
    pub reacting: Vec<PartScratch>,
    /// Values at the start of the window, at the start of a checked step, and after it in one piece.
    pub start: Vec<f64>,
    pub before: Vec<f64>,
    pub whole: Vec<f64>,
    /// What diffusion and decay changed in a step in one piece; then its error, spread over the time in which reactions act.
    pub spread: Vec<f64>,
    /// The factors of that time, without decay.
    spreading: Factors,
    /// What reactions changed in it.
    pub change: Change,
    /// An error may be negative.
    free: Vec<Range>,
    /// For what the clock switches: the pieces of a window, and the values where it begins.
    pub clock: PopulationScratch,
    pub pieces: Vec<Piece>,
    pub begun: Vec<f64>,
    /// What transport works in, empty until it does.
    pub carrying: CarryScratch,
}

impl Work {
    fn new(grid: &Grid, species: &[Species]) -> Self {
        let steady: Vec<Vec<f64>> = species.iter().map(|species| steady(grid, species).unwrap_or_default()).collect();
        let ranges =
            species.iter().zip(&steady).map(|(s, steady)| if steady.is_empty() { s.range } else { Range::Free });
        Self {
            ranges: ranges.collect(),
            steady,
            factors: vec![Factors::new(grid, species); KEPT_FACTORS],
            used: vec![0; KEPT_FACTORS],
            uses: 0,
            sweeping: vec![sweep_buffer(grid); PARTS],
            reacting: vec![PartScratch::new(species.len()); PARTS],
            start: vec![0.0; grid.len() * species.len()],
            before: vec![0.0; grid.len() * species.len()],
            whole: vec![0.0; grid.len() * species.len()],
            spread: vec![0.0; grid.len() * species.len()],
            spreading: Factors::new(grid, species),
            change: Change::default(),
            free: vec![Range::Free; species.len()],
            clock: PopulationScratch::default(),
            pieces: Vec::new(),
            begun: Vec::new(),
            carrying: CarryScratch::default(),
        }
    }

    /// Writes NaN over all numbers and forgets what is kept.
    fn poison(&mut self) {
        self.factors.iter_mut().for_each(|factors| factors.dt = f64::NAN);
        self.spreading.dt = f64::NAN;
        self.change.poison();
        let lists = [&mut self.start, &mut self.before, &mut self.whole, &mut self.spread];
        lists.into_iter().chain(&mut self.sweeping).for_each(|list| list.fill(f64::NAN));
        self.reacting.iter_mut().for_each(PartScratch::poison);
        self.carrying.poison();
        self.begun.fill(f64::NAN);
        self.clock.poison();
    }

    /// Spreads what stands in `spread` over a time, s, as differences spread: held walls hold zero, and nothing decays.
    pub fn spread_out(&mut self, grid: &Grid, species: &[Species], time: f64) {
        self.spreading.fill(grid, species, time);
        self.spreading.decay.fill(1.0);
        diffuse(grid, &self.spreading, &self.free, &mut self.spread, &mut self.sweeping);
    }

    /// The factors of a step size, made now or kept.
    fn factors(&mut self, grid: &Grid, species: &[Species], dt: f64) -> usize {
        self.uses += 1;
        let known = self.factors.iter().position(|factors| factors.dt == dt);
        let at = known.unwrap_or_else(|| {
            let oldest = (0..KEPT_FACTORS).min_by_key(|at| self.used[*at]).expect("some are kept");
            self.factors[oldest].fill(grid, species, dt);
            oldest
        });
        self.used[at] = self.uses;
        at
    }
}

impl Fields {
    /// Fields without any substance in them, at time 0.
    ///
    /// # Errors
    /// What [`Species::check`] finds, and two species of one name.
    pub fn new(grid: Grid, species: Vec<Species>) -> Result<Self> {
        let mut faults = Vec::new();
        for (s, one) in species.iter().enumerate() {
            if let Err(Error::Input(more)) = one.check(&grid) {
                faults.extend(more);
            }
            if species[..s].iter().any(|other| other.name == one.name) {
                let message = format!("two species of the field are named '{}'", one.name);
                faults.push(Fault::new(message).help("give each species a name of its own"));
            }
        }
        if !faults.is_empty() {
            return Err(Error::Input(faults));
        }
        let work = Work::new(&grid, &species);
        let values = vec![0.0; grid.len() * species.len()];
        Ok(Self { grid, species, values, time: 0.0, level: 0, unchecked: 0, work })
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The species, in the order of their values.
    pub fn species(&self) -> &[Species] {
        &self.species
    }

    /// Time that the values belong to, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Exchanges the values of all species, `[species][box]`, with others of as many numbers: nothing is copied.
    ///
    /// # Panics
    /// When there are not as many numbers.
    pub fn exchange_values(&mut self, values: &mut Vec<f64>) {
        assert_eq!(values.len(), self.values.len(), "one number for each species and box");
        std::mem::swap(values, &mut self.values);
    }

    /// Writes NaN over the values, the time and all scratch: what holds fields for others while they lend their values must not
    /// matter between.
    pub fn poison(&mut self) {
        self.values.fill(f64::NAN);
        self.time = f64::NAN;
        self.work.poison();
    }

    /// Says what time it is, s.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
    }

    /// How many times the window was halved at its end, and the steps since the last check: with the values and the
    /// time, all that a run needs to go on as if it had never stopped.
    pub fn pace(&self) -> (u32, u32) {
        (self.level, self.unchecked)
    }

    /// Takes up the pace of an earlier run.
    pub fn set_pace(&mut self, (level, unchecked): (u32, u32)) {
        (self.level, self.unchecked) = (level.min(FINEST), unchecked);
    }

    /// Values of a species in all boxes, x fastest: amount/µm² on the substrate, amount/µm³ in the medium.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn values(&self, species: usize) -> &[f64] {
        &self.values[species * self.grid.len()..(species + 1) * self.grid.len()]
    }

    /// Gives a species the values of a function of the position of the boxes' centres.
    ///
    /// # Errors
    /// The first value that is not finite, or negative where that is not allowed.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn set(&mut self, species: usize, profile: impl Fn(Vec3) -> f64) -> Result<()> {
        let values: Vec<f64> = (0..self.grid.len()).map(|at| profile(self.grid.centre(at))).collect();
        self.set_values(species, &values)
    }

    /// Gives a species its values in all boxes, x fastest.
    ///
    /// # Errors
    /// A wrong number of values, the first value that is not finite, or negative where that is not allowed.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn set_values(&mut self, species: usize, values: &[f64]) -> Result<()> {
        let (one, len) = (&self.species[species], self.grid.len());
        let fault = |message: String, help: &str| Err(Error::Input(vec![Fault::new(message).help(help)]));
        if values.len() != len {
            let message = format!("species '{}' is given {} values for {len} boxes", one.name, values.len());
            return fault(message, "give one value for each box of the grid");
        }
        let bad = |value: &f64| !value.is_finite() || (*value < 0.0 && one.range == Range::NonNegative);
        if let Some(at) = values.iter().position(bad) {
            let message = format!("species '{}' is {} at {} µm", one.name, values[at], self.grid.told(at));
            return fault(
                message,
                match one.range {
                    Range::NonNegative => {
                        "a concentration is finite and not negative; the range `free` allows what is negative"
                    }
                    Range::Free => "give finite numbers",
                },
            );
        }
        self.values[species * len..(species + 1) * len].copy_from_slice(values);
        Ok(())
    }

    /// Amount of a species on the whole grid.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn amount(&self, species: usize) -> f64 {
        // Compensated, because a test of balance to round-off must not measure its own sum.
        let (mut sum, mut lost) = (0.0_f64, 0.0_f64);
        for value in self.values(species) {
            let next = sum + (value - lost);
            lost = (next - sum) - (value - lost);
            sum = next;
        }
        sum * self.grid.measure()
    }

    /// One step of diffusion and decay of all species.
    pub(super) fn diffuse(&mut self, dt: f64) {
        let Self { grid, species, values, work, .. } = self;
        let at = work.factors(grid, species, dt);
        for (steady, values) in work.steady.iter().zip(values.chunks_exact_mut(grid.len())) {
            for (value, steady) in values.iter_mut().zip(steady) {
                *value -= steady;
            }
        }
        diffuse(grid, &work.factors[at], &work.ranges, values, &mut work.sweeping);
        for (s, (steady, values)) in work.steady.iter().zip(values.chunks_exact_mut(grid.len())).enumerate() {
            let floor = if species[s].range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
            for (value, steady) in values.iter_mut().zip(steady) {
                let sum = *value + steady;
                *value = if sum < floor { floor } else { sum };
            }
        }
    }
}
