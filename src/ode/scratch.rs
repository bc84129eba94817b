//! Buffers that are kept from window to window so that nothing is allocated meanwhile.

use pulp::{Scalar, Simd};

use super::control::Tolerances;
use super::linear::Linear;
use crate::equations::program::code::Code;
use crate::equations::program::{Lanes, Program, run, run_wide};
use crate::equations::tree::QuantityId;

/// Stages of the method that has most, with the one in the middle of its step.
const MOST_STAGES: usize = 10;

/// What sets the registers that code needs beside time, state and open quantities: delayed values.
pub trait LooksBack<const L: usize> {
    /// Sets them for the time and state that stand in the registers.
    fn fill(&mut self, program: &Program, code: &Code, file: &mut [Lanes<L>]);
}

/// Populations do not look back.
impl<const L: usize> LooksBack<L> for () {
    #[inline(always)]
    fn fill(&mut self, _: &Program, _: &Code, _: &mut [Lanes<L>]) {}
}

/// Registers, stages and matrices of one block of cells.
#[derive(Debug, Clone)]
pub struct Scratch<const L: usize, P = ()> {
    /// The program's registers.
    pub file: Vec<Lanes<L>>,
    /// State at the begin of the step.
    pub state: Vec<Lanes<L>>,
    /// State at its end, if it is accepted.
    pub proposal: Vec<Lanes<L>>,
    /// Estimated error of the proposal.
    pub error: Vec<Lanes<L>>,
    /// Stage after stage, one number a variable.
    pub stages: Vec<Lanes<L>>,
    /// Derivatives of the rates by time, negated.
    pub drift: Vec<Lanes<L>>,
    /// The linear systems of implicit steps.
    pub linear: Linear<L>,
    /// Whether values of lanes keep to the side of nothing that they are on where the step begins.
    pub keeps_side: bool,
    /// Where they do, what such values may be at least: 0, or minus infinity in the other lanes.
    pub floor: Lanes<L>,
    /// The absolute tolerance of the step that does.
    pub absolute: f64,
    /// What was.
    pub past: P,
}

impl<const L: usize> Scratch<L> {
    /// Buffers for a program; `stiff` methods need matrices.
    pub fn new(program: &Program, stiff: bool) -> Self {
        Self::with(program, stiff, ())
    }
}

impl<const L: usize, P: LooksBack<L>> Scratch<L, P> {
    /// Buffers for a program that looks back.
    pub fn with(program: &Program, stiff: bool, past: P) -> Self {
        let n = program.size();
        let empty = || vec![[0.0; L]; n];
        Self {
            file: program.file(),
            state: empty(),
            proposal: empty(),
            error: empty(),
            stages: vec![[0.0; L]; MOST_STAGES * n],
            drift: empty(),
            linear: Linear::new(program, stiff),
            keeps_side: false,
            floor: [f64::NEG_INFINITY; L],
            absolute: 0.0,
            past,
        }
    }

    /// Lets the values of the lanes in which an error is not a number keep to their side of nothing; says whether there is one. What is below
    /// nothing there by less than the absolute tolerance, as steps before may have left it, counts as nothing.
    #[inline(never)]
    pub fn keep_sides(&mut self, error: &Lanes<L>, sizes: &[f64], tolerances: &Tolerances) -> bool {
        (self.keeps_side, self.absolute) = (error.iter().any(|error| error.is_nan()), tolerances.absolute);
        for l in (0..L).filter(|l| error[*l].is_nan()) {
            for (state, size) in self.state.iter_mut().zip(sizes) {
                if state[l] < 0.0 && state[l] >= -tolerances.absolute * size {
                    state[l] = 0.0;
                }
            }
        }
        for l in 0..L {
            self.floor[l] = if error[l].is_nan() { 0.0 } else { f64::NEG_INFINITY };
        }
        self.keeps_side
    }

    /// What a variable may be at least in a step.
    #[inline(always)]
    pub fn floor_of(&self, variable: usize) -> Lanes<L> {
        let (state, mut floor) = (&self.state[variable], self.floor);
        for l in 0..L {
            floor[l] = if state[l] >= 0.0 { floor[l] } else { f64::NEG_INFINITY };
        }
        floor
    }

    /// Rates at the state of the step's begin, as stage 0.
    #[inline(always)]
    pub fn rates_at_state<S: Simd>(&mut self, simd: S, program: &Program, time: Lanes<L>) {
        let n = self.state.len();
        self.file[0] = time;
        self.file[1..=n].copy_from_slice(&self.state);
        self.rates_into(simd, program, 0);
    }

    /// Rates at the time and state that stand in the registers, as a stage.
    #[inline(always)]
    pub fn rates_into<S: Simd>(&mut self, simd: S, program: &Program, stage: usize) {
        self.past.fill(program, &program.rates, &mut self.file);
        run_wide(simd, &program.rates, &mut self.file);
        let n = self.state.len();
        for (to, &from) in self.stages[stage * n..(stage + 1) * n].iter_mut().zip(&program.rates.outputs) {
            *to = self.file[from as usize];
        }
    }

    /// The quantity whose equations have no solution a little after the state, if there is one; the rates there have been worked out.
    #[inline(never)]
    pub fn lost_unknown(&mut self, program: &Program, time: Lanes<L>, l: usize) -> Option<QuantityId> {
        let lost = |file: &[Lanes<L>]| {
            let value = |quantity: QuantityId| file[program.observe.outputs[quantity as usize] as usize][l];
            program.searched.iter().copied().find(|quantity| !value(*quantity).is_finite())
        };
        // Steps have become as short as the clock can tell, or little longer.
        let sizes = std::iter::successors(Some(1e-15), |size| Some(size * 16.0)).take(8);
        sizes.map(|size| size * time[l].abs().max(1e-9)).find_map(|ahead| {
            self.file[0] = time.map(|time| time + ahead);
            for (v, state) in self.state.iter().enumerate() {
                for (to, (value, rate)) in self.file[1 + v].iter_mut().zip(state.iter().zip(&self.stages[v])) {
                    *to = value + ahead * rate;
                }
            }
            self.past.fill(program, &program.observe, &mut self.file);
            run(&program.observe, &mut self.file);
            lost(&self.file)
        })
    }

    /// The variable that is to blame for trouble in a lane: the first whose value or rate is not finite, or else the one
    /// that changes fastest for its size. Also returns whether all are finite.
    #[inline(never)]
    pub fn worst_variable(&mut self, program: &Program, time: Lanes<L>, l: usize) -> (Option<usize>, bool) {
        self.rates_at_state(Scalar, program, time);
        let (state, rates) = (&self.state, &self.stages);
        let broken = (0..state.len()).find(|&v| !(state[v][l].is_finite() && rates[v][l].is_finite()));
        let speed = |v: usize| rates[v][l].abs() / (state[v][l].abs() + f64::MIN_POSITIVE);
        let fastest = || (0..state.len()).max_by(|&a, &b| speed(a).total_cmp(&speed(b)));
        (broken.or_else(fastest), broken.is_none())
    }
}
