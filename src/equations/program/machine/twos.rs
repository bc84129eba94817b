//! Numbers two by two, for what is done to all variables alike. Of an odd number the last has itself beside it.

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{
    ConstantData, Endianness, InstBuilder, MemFlags, StackSlot, StackSlotData, StackSlotKind, Value, types,
};

use super::emit::Emitter;

/// Pairs in memory of the function's own.
#[derive(Clone, Copy)]
pub struct Kept(StackSlot);

impl Emitter<'_, '_> {
    /// Two constants.
    pub fn numbers(&mut self, values: [f64; 2]) -> Value {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let constant = self.builder.func.dfg.constants.insert(ConstantData::from(bytes));
        self.builder.ins().vconst(types::F64X2, constant)
    }

    /// A number and the same again.
    pub fn twice(&mut self, value: Value) -> Value {
        self.builder.ins().splat(types::F64X2, value)
    }

    /// The first `count` single numbers of pairs.
    pub fn split(&mut self, pairs: &[Value], count: usize) -> Vec<Value> {
        (0..count).map(|v| self.builder.ins().extractlane(pairs[v / 2], (v % 2) as u8)).collect()
    }

    /// Puts pairs of single numbers into memory of the function's own, from where they are loaded when they are used: there are
    /// more than the processor has registers.
    pub fn keep(&mut self, values: &[Value]) -> Kept {
        let size = 16 * values.len().div_ceil(2) as u32;
        let slot = self.builder.create_sized_stack_slot(StackSlotData::new(StackSlotKind::ExplicitSlot, size, 4));
        for (place, pair) in self.join(values).into_iter().enumerate() {
            self.builder.ins().stack_store(pair, slot, 16 * place as i32);
        }
        Kept(slot)
    }

    /// A pair that was kept.
    pub fn kept(&mut self, kept: Kept, pair: usize) -> Value {
        self.builder.ins().stack_load(types::F64X2, kept.0, 16 * pair as i32)
    }

    /// Pairs of single numbers.
    pub fn join(&mut self, values: &[Value]) -> Vec<Value> {
        let pair = |values: &[Value]| {
            let pair = self.twice(values[0]);
            values.get(1).map_or(pair, |&second| self.builder.ins().insertlane(pair, second, 1))
        };
        values.chunks(2).map(pair).collect()
    }

    /// The errors of a pair of variables over what is allowed, as in eq. (ode.3), given their values before and after a step.
    pub fn ratios(
        &mut self,
        error: Value,
        (before, after): (Value, Value),
        own: [f64; 2],
        [absolute, relative]: [Value; 2],
    ) -> Value {
        let (before, after) = (self.magnitudes(before), self.magnitudes(after));
        let size = self.larger(before, after);
        let relative = self.mul(relative, size);
        let absolute = if own == [1.0; 2] {
            absolute
        } else {
            let own = self.numbers(own);
            self.mul(absolute, own)
        };
        let allowed = self.add(absolute, relative);
        let one = self.numbers([1.0; 2]);
        let inverse = self.builder.ins().fdiv(one, allowed);
        let size = self.magnitudes(error);
        let ratio = self.mul(size, inverse);
        let zero = self.numbers([0.0; 2]);
        let exact = self.builder.ins().fcmp(FloatCC::Equal, error, zero);
        self.chosen(exact, zero, ratio)
    }

    /// The largest number of pairs, or one that is not a number if there is such.
    pub fn largest(&mut self, mut pairs: Vec<Value>) -> Value {
        let sum = pairs.clone().into_iter().reduce(|a, b| self.add(a, b)).expect("a pair");
        while pairs.len() > 1 {
            let two = |two: &[Value]| if two.len() > 1 { self.larger(two[0], two[1]) } else { two[0] };
            pairs = pairs.chunks(2).map(two).collect();
        }
        let [first, second] = [0, 1].map(|lane| self.builder.ins().extractlane(pairs[0], lane));
        let less = self.builder.ins().fcmp(FloatCC::LessThan, second, first);
        let largest = self.builder.ins().select(less, first, second);
        let [first, second] = [0, 1].map(|lane| self.builder.ins().extractlane(sum, lane));
        let sum = self.add(first, second);
        // Branches, so that the result does not wait for the sum.
        let lost = self.builder.ins().fcmp(FloatCC::Unordered, sum, sum);
        let [result] = self.either(lost, |_| [sum], |_| [largest]);
        result
    }

    fn magnitudes(&mut self, pair: Value) -> Value {
        let mask = self.numbers([f64::from_bits(u64::MAX >> 1); 2]);
        self.builder.ins().band(pair, mask)
    }

    /// The larger of two numbers, lane by lane, where both are numbers.
    fn larger(&mut self, a: Value, b: Value) -> Value {
        let less = self.builder.ins().fcmp(FloatCC::LessThan, b, a);
        self.chosen(less, a, b)
    }

    /// Lane by lane one or the other.
    fn chosen(&mut self, which: Value, yes: Value, no: Value) -> Value {
        let flags = MemFlags::new().with_endianness(Endianness::Little);
        let which = self.builder.ins().bitcast(types::F64X2, flags, which);
        self.builder.ins().bitselect(which, yes, no)
    }
}
