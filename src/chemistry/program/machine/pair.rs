//! A whole step of an explicit pair as one function: the choice of its length, stages, rates, error and new state.

use cranelift_codegen::ir::Value;
use cranelift_codegen::ir::condcodes::FloatCC;

use super::emit::Emitter;
use super::module::Compiled;
use super::twos::Kept;
use crate::chemistry::program::Program;

/// The numbers of an explicit pair whose last stage is the first of the next step. Stages of weight 0 are left out.
pub struct Tableau {
    /// Which of the [`PAIRS`] pairs it is, counted from 0.
    pub number: usize,
    /// Times of the stages.
    pub times: &'static [f64],
    /// Weights of the stages before one; of the last, those of the new state.
    pub weights: fn(usize) -> &'static [f64],
    /// Weights of the error.
    pub error: &'static [f64],
    /// A step that is at least this share of what is left of a window is the last.
    pub near: f64,
}

/// How many pairs there are.
pub const PAIRS: usize = 2;

/// A cell on its way through a window.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Way {
    /// Present time.
    pub time: f64,
    /// End of the window.
    pub until: f64,
    /// The step to take, if the window is long enough.
    pub wanted: f64,
    /// The step that was tried last.
    pub step: f64,
    /// Absolute tolerance.
    pub absolute: f64,
    /// Relative tolerance.
    pub relative: f64,
    /// 1 where the rates at the present state are not known, and else 0.
    pub fresh: u64,
}

/// Where the numbers of a [`Way`] stand.
mod place {
    pub const TIME: usize = 0;
    pub const UNTIL: usize = 1;
    pub const WANTED: usize = 2;
    pub const STEP: usize = 3;
    pub const ABSOLUTE: usize = 4;
    pub const RELATIVE: usize = 5;
    pub const FRESH: usize = 6;
}

/// One step of a program by an explicit pair, for a cell that stands in one of `L` lanes.
pub struct PairStep<const L: usize> {
    code: Compiled,
    variables: usize,
    open: usize,
    /// Evaluations of the rates in a step.
    rates: u64,
}

/// Open quantities, state, rates and the way of a cell.
type Function = unsafe extern "C" fn(*const f64, *mut f64, *mut f64, *mut Way) -> f64;

impl<const L: usize> std::fmt::Debug for PairStep<L> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PairStep").field("variables", &self.variables).finish_non_exhaustive()
    }
}

impl<const L: usize> PairStep<L> {
    /// Machine code of a step, or nothing where there can be none.
    pub fn new(program: &Program, tableau: &Tableau) -> Option<Self> {
        let code = Compiled::new(4, |emitter, arguments| {
            let &[open, state, rates, way] = arguments else { unreachable!("as many arguments as asked for") };
            Step { program, tableau, emitter, open, state, rates, way, stride: L }.write()
        })?;
        let rates = tableau.times.len() as u64 - 1;
        Some(Self { code, variables: program.size(), open: program.open.len(), rates })
    }

    /// Evaluations of the rates in a step whose first are known.
    pub fn rates(&self) -> u64 {
        self.rates
    }

    /// Tries one step of the cell in lane `l`: as long as wanted, or into what is left of the window. If it is good enough,
    /// state, rates and time move on. Returns the norm of its error, eq. (ode.3): it was good enough if that is at most 1.
    ///
    /// # Panics
    /// When an array has another length than the program needs.
    #[inline(always)]
    pub fn run(
        &self,
        l: usize,
        open: &[[f64; L]],
        state: &mut [[f64; L]],
        rates: &mut [[f64; L]],
        way: &mut Way,
    ) -> f64 {
        let n = self.variables;
        assert!(l < L && open.len() == self.open && state.len() == n && rates.len() == n, "arrays of the program");
        let open = open.as_ptr().cast::<f64>();
        let (state, rates) = (state.as_mut_ptr().cast::<f64>(), rates.as_mut_ptr().cast::<f64>());
        // SAFETY: `entry` is a function of this type. It reads and writes one number, the lane's, of each of the `L` in every
        // element of these arrays, whose lengths were just checked, and the way.
        unsafe {
            let function = std::mem::transmute::<*const u8, Function>(self.code.entry());
            function(open.wrapping_add(l), state.wrapping_add(l), rates.wrapping_add(l), way)
        }
    }
}

struct Step<'a, 'b, 'c> {
    program: &'a Program,
    tableau: &'a Tableau,
    emitter: &'a mut Emitter<'b, 'c>,
    open: Value,
    state: Value,
    rates: Value,
    way: Value,
    /// Numbers between those of one cell.
    stride: usize,
}

impl Step<'_, '_, '_> {
    fn write(&mut self) -> Value {
        let (n, stride) = (self.program.size(), self.stride);
        let [time, step, then] = self.chosen_step();
        let mut file = self.registers();
        let begin: Vec<Value> = (0..n).map(|v| self.emitter.load(self.state, v * stride)).collect();
        let mut rates = self.first_rates(time, &begin, &mut file);
        let mut stages = vec![self.emitter.keep(&rates)];
        let begin = self.emitter.keep(&begin);
        let mut end = Vec::new();
        for stage in 1..self.tableau.times.len() {
            end = self.arguments(stage, begin, &stages, &rates, step);
            let share = self.emitter.number(self.tableau.times[stage]);
            let since = self.emitter.mul(share, step);
            let clock = self.emitter.add(time, since);
            rates = self.evaluate(clock, &end, &mut file);
            stages.push(self.emitter.keep(&rates));
        }
        let error = self.norm(&stages, begin, &end, step);
        let one = self.emitter.number(1.0);
        let good = self.emitter.compare(FloatCC::LessThanOrEqual, error, one);
        let after = self.emitter.begin_if(good);
        for v in 0..n {
            self.emitter.store(end[v], self.state, v * stride);
            self.emitter.store(rates[v], self.rates, v * stride);
        }
        self.emitter.store(then, self.way, place::TIME);
        self.emitter.end_if(after);
        error
    }

    /// The time, the step that is taken, and the time after it. The choice is made by branches, which the processor guesses:
    /// so it goes on with a step that does not wait for the error of the one before.
    fn chosen_step(&mut self) -> [Value; 3] {
        let (way, near, emitter) = (self.way, self.tableau.near, &mut *self.emitter);
        let [time, until, wanted] = [place::TIME, place::UNTIL, place::WANTED].map(|place| emitter.load(way, place));
        let rest = emitter.sub(until, time);
        let [near, half] = [near, 0.5].map(|share| {
            let share = emitter.number(share);
            emitter.mul(rest, share)
        });
        let last = emitter.compare(FloatCC::GreaterThanOrEqual, wanted, near);
        let [step, then] = emitter.either(
            last,
            |_| [rest, until],
            |emitter| {
                let cut = emitter.compare(FloatCC::GreaterThan, wanted, half);
                let [step] = emitter.either(cut, |_| [half], |_| [wanted]);
                [step, emitter.add(time, step)]
            },
        );
        emitter.store(step, way, place::STEP);
        [time, step, then]
    }

    /// Registers with the open quantities and the constants in their places.
    fn registers(&mut self) -> Vec<Value> {
        let (program, open) = (self.program, self.program.first_open());
        let nothing = self.emitter.number(0.0);
        let mut file = vec![nothing; program.registers.max(open + program.open.len() + program.constants.len())];
        for place in 0..program.open.len() {
            file[open + place] = self.emitter.load(self.open, place * self.stride);
        }
        for (register, &constant) in file[open + program.open.len()..].iter_mut().zip(&program.constants) {
            *register = self.emitter.number(constant);
        }
        file
    }

    fn evaluate(&mut self, clock: Value, state: &[Value], file: &mut [Value]) -> Vec<Value> {
        file[0] = clock;
        file[1..=state.len()].copy_from_slice(state);
        self.emitter.run(&self.program.rates, file);
        self.program.rates.outputs.iter().map(|&register| file[register as usize]).collect()
    }

    /// The rates at the begin: evaluated if they are not known, and then as they stand.
    fn first_rates(&mut self, time: Value, state: &[Value], file: &mut [Value]) -> Vec<Value> {
        let fresh = self.emitter.load_whole(self.way, place::FRESH);
        let after = self.emitter.begin_if(fresh);
        let found = self.evaluate(time, state, &mut file.to_vec());
        found.iter().enumerate().for_each(|(v, &rate)| self.emitter.store(rate, self.rates, v * self.stride));
        self.emitter.end_if(after);
        (0..state.len()).map(|v| self.emitter.load(self.rates, v * self.stride)).collect()
    }

    /// The state at which a stage has its rates: begin + step·Σ weight·stage. The latest stage comes last, in two operations of
    /// its own, so that little waits for it.
    fn arguments(&mut self, stage: usize, begin: Kept, stages: &[Kept], rates: &[Value], step: Value) -> Vec<Value> {
        let (last, earlier) = (self.tableau.weights)(stage).split_last().expect("every stage has weights");
        let steps = self.emitter.twice(step);
        let mut sums: Vec<Value> = (0..rates.len().div_ceil(2)).map(|pair| self.emitter.kept(begin, pair)).collect();
        if !earlier.is_empty() {
            for (pair, sum) in sums.iter_mut().enumerate() {
                let change = self.change(earlier, stages, pair, steps);
                *sum = self.emitter.add(*sum, change);
            }
        }
        let sums = self.emitter.split(&sums, rates.len());
        let last = self.emitter.number(*last);
        let last = self.emitter.mul(step, last);
        let end = |(&sum, &rate): (&Value, &Value)| {
            let change = self.emitter.mul(last, rate);
            self.emitter.add(sum, change)
        };
        sums.iter().zip(rates).map(end).collect()
    }

    /// step·Σ weight·stage of a pair of variables.
    fn change(&mut self, weights: &[f64], stages: &[Kept], pair: usize, steps: Value) -> Value {
        let mut sum = None;
        for (&weight, stage) in weights.iter().zip(stages).filter(|(weight, _)| **weight != 0.0) {
            let weight = self.emitter.numbers([weight; 2]);
            let stage = self.emitter.kept(*stage, pair);
            let part = self.emitter.mul(weight, stage);
            sum = Some(match sum {
                Some(sum) => self.emitter.add(sum, part),
                None => part,
            });
        }
        self.emitter.mul(steps, sum.expect("every stage has weights"))
    }

    /// As over lanes in [`ode`](crate::chemistry::ode).
    fn norm(&mut self, stages: &[Kept], begin: Kept, end: &[Value], step: Value) -> Value {
        let (end, steps) = (self.emitter.join(end), self.emitter.twice(step));
        let allowed = [place::ABSOLUTE, place::RELATIVE].map(|place| {
            let tolerance = self.emitter.load(self.way, place);
            self.emitter.twice(tolerance)
        });
        let ratio = |pair: usize| {
            let error = self.change(self.tableau.error, stages, pair, steps);
            let own = [2 * pair, (2 * pair + 1).min(self.program.size() - 1)].map(|v| self.program.sizes[v]);
            let begin = self.emitter.kept(begin, pair);
            self.emitter.ratios(error, (begin, end[pair]), own, allowed)
        };
        let ratios = (0..end.len()).map(ratio).collect();
        self.emitter.largest(ratios)
    }
}
