//! What all steps in machine code have in common: the cell, the choice of the length, registers, the norm of the error.

use cranelift_codegen::ir::Value;
use cranelift_codegen::ir::condcodes::FloatCC;

use super::emit::Emitter;
use super::module::Compiled;
use super::twos::Kept;
use crate::equations::program::Program;
use crate::equations::program::code::Code;

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
pub mod place {
    pub const TIME: usize = 0;
    pub const UNTIL: usize = 1;
    pub const WANTED: usize = 2;
    pub const STEP: usize = 3;
    pub const ABSOLUTE: usize = 4;
    pub const RELATIVE: usize = 5;
    pub const FRESH: usize = 6;
}

/// What a step gives that is not to be taken from machine code: nothing was changed but the step in the way.
pub const LEFT: f64 = -1.0;

/// One step of a program by a method, for a cell that stands in one of `L` lanes.
pub struct StepCode<const L: usize> {
    code: Compiled,
    variables: usize,
    open: usize,
    /// Whether the rates at the state are kept from step to step.
    keeps: bool,
}

/// Open quantities, state, rates and the way of a cell.
type Function = unsafe extern "C" fn(*const f64, *mut f64, *mut f64, *mut Way) -> f64;

impl<const L: usize> std::fmt::Debug for StepCode<L> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("StepCode").field("variables", &self.variables).finish_non_exhaustive()
    }
}

impl<const L: usize> StepCode<L> {
    /// Machine code of a step that `write` writes, or nothing where there can be none.
    pub fn new(program: &Program, keeps: bool, write: impl FnOnce(&mut Frame) -> Value) -> Option<Self> {
        let code = Compiled::new(4, |emitter, arguments| {
            let &[open, state, rates, way] = arguments else { unreachable!("as many arguments as asked for") };
            write(&mut Frame { program, emitter, open, state, rates, way, stride: L })
        })?;
        Some(Self { code, variables: program.size(), open: program.open.len(), keeps })
    }

    /// Tries one step of the cell in lane `l`: as long as wanted, or into what is left of the window. If it is good enough,
    /// state, rates (of a pair) and time move on. Returns the norm of its error, eq. (ode.3): it was good enough if that is
    /// at most 1; or [`LEFT`].
    ///
    /// # Panics
    /// When an array has another length than the program needs; `rates` are of no use to methods that keep none.
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
        assert!(l < L && open.len() == self.open && state.len() == n, "arrays of the program");
        assert!(rates.len() == n || !self.keeps, "rates of the program");
        let open = open.as_ptr().cast::<f64>();
        let (state, rates) = (state.as_mut_ptr().cast::<f64>(), rates.as_mut_ptr().cast::<f64>());
        // SAFETY: `entry` is a function of this type. It reads and writes one number, the lane's, of each of the `L` in every
        // element of these arrays, whose lengths were just checked, and the way; rates only where they are kept.
        unsafe {
            let function = std::mem::transmute::<*const u8, Function>(self.code.entry());
            function(open.wrapping_add(l), state.wrapping_add(l), rates.wrapping_add(l), way)
        }
    }
}

/// A step that is being written.
pub struct Frame<'a, 'b, 'c> {
    pub program: &'a Program,
    pub emitter: &'a mut Emitter<'b, 'c>,
    open: Value,
    pub state: Value,
    pub rates: Value,
    pub way: Value,
    /// Numbers between those of one cell.
    pub stride: usize,
}

impl Frame<'_, '_, '_> {
    /// The time, the step that is taken, and the time after it. The choice is made by branches, which the processor guesses:
    /// so it goes on with a step that does not wait for the error of the one before.
    pub fn chosen_step(&mut self, near: f64) -> [Value; 3] {
        let (way, emitter) = (self.way, &mut *self.emitter);
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

    /// The state at the begin.
    pub fn begin(&mut self) -> Vec<Value> {
        (0..self.program.size()).map(|v| self.emitter.load(self.state, v * self.stride)).collect()
    }

    /// Registers with the open quantities and the constants in their places.
    pub fn registers(&mut self) -> Vec<Value> {
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

    /// What code gives at a time and state.
    pub fn evaluate(&mut self, code: &Code, clock: Value, state: &[Value], file: &mut [Value]) -> Vec<Value> {
        file[0] = clock;
        file[1..=state.len()].copy_from_slice(state);
        self.emitter.run(code, file);
        code.outputs.iter().map(|&register| file[register as usize]).collect()
    }

    /// The time at a share of the step.
    pub fn clock(&mut self, time: Value, step: Value, share: f64) -> Value {
        let share = self.emitter.number(share);
        let since = self.emitter.mul(share, step);
        self.emitter.add(time, since)
    }

    /// Σ weight·stage of a pair of variables; those of weight 0 are left out.
    pub fn sum(&mut self, weights: &[f64], stages: &[Kept], pair: usize) -> Value {
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
        sum.expect("every stage has weights")
    }

    /// The norm of errors that stand in pairs, as over lanes in [`ode`](crate::ode).
    pub fn norm(&mut self, errors: &[Value], begin: Kept, end: &[Value]) -> Value {
        let end = self.emitter.join(end);
        let allowed = [place::ABSOLUTE, place::RELATIVE].map(|place| {
            let tolerance = self.emitter.load(self.way, place);
            self.emitter.twice(tolerance)
        });
        let ratio = |(pair, &error): (usize, &Value)| {
            let own = [2 * pair, (2 * pair + 1).min(self.program.size() - 1)].map(|v| self.program.sizes[v]);
            let begin = self.emitter.kept(begin, pair);
            self.emitter.ratios(error, (begin, end[pair]), own, allowed)
        };
        let ratios = errors.iter().enumerate().map(ratio).collect();
        self.emitter.largest(ratios)
    }

    /// Moves on to a state, to rates where they are kept, and to a time, if the error is small enough.
    pub fn move_on(&mut self, error: Value, end: &[Value], rates: Option<&[Value]>, then: Value) {
        let one = self.emitter.number(1.0);
        let good = self.emitter.compare(FloatCC::LessThanOrEqual, error, one);
        let after = self.emitter.begin_if(good);
        for (v, &value) in end.iter().enumerate() {
            self.emitter.store(value, self.state, v * self.stride);
        }
        for (v, &rate) in rates.unwrap_or(&[]).iter().enumerate() {
            self.emitter.store(rate, self.rates, v * self.stride);
        }
        self.emitter.store(then, self.way, place::TIME);
        self.emitter.end_if(after);
    }
}
