//! Register code as instructions, one value at a time: what [`run`](crate::equations::program::run) does, operation by
//! operation.

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{AbiParam, Block, BlockArg, InstBuilder, MemFlags, SigRef, Signature, Value, types};
use cranelift_codegen::isa::CallConv;
use cranelift_frontend::FunctionBuilder;

use super::calls;
use crate::equations::program::code::{Action, Code, Op};
use crate::equations::tree::{Binary, Unary};

/// Writes instructions into a function.
pub struct Emitter<'a, 'b> {
    /// The function.
    pub builder: &'a mut FunctionBuilder<'b>,
    /// What functions of one number look like, and of two.
    signatures: [SigRef; 2],
    address: types::Type,
}

impl<'a, 'b> Emitter<'a, 'b> {
    /// For a function that calls others by a convention, on a processor with addresses of a type.
    pub fn new(builder: &'a mut FunctionBuilder<'b>, convention: CallConv, address: types::Type) -> Self {
        let signatures = [1, 2].map(|count| {
            let mut signature = Signature::new(convention);
            signature.params.resize(count, AbiParam::new(types::F64));
            signature.returns.push(AbiParam::new(types::F64));
            builder.import_signature(signature)
        });
        Self { builder, signatures, address }
    }

    /// A constant.
    pub fn number(&mut self, value: f64) -> Value {
        self.builder.ins().f64const(value)
    }

    /// The number at a place of an array.
    pub fn load(&mut self, array: Value, place: usize) -> Value {
        self.builder.ins().load(types::F64, MemFlags::trusted(), array, 8 * place as i32)
    }

    /// The whole number at a place of an array.
    pub fn load_whole(&mut self, array: Value, place: usize) -> Value {
        self.builder.ins().load(types::I64, MemFlags::trusted(), array, 8 * place as i32)
    }

    /// Writes a number to a place of an array.
    pub fn store(&mut self, value: Value, array: Value, place: usize) {
        self.builder.ins().store(MemFlags::trusted(), value, array, 8 * place as i32);
    }

    /// a + b.
    pub fn add(&mut self, a: Value, b: Value) -> Value {
        self.builder.ins().fadd(a, b)
    }

    /// a − b.
    pub fn sub(&mut self, a: Value, b: Value) -> Value {
        self.builder.ins().fsub(a, b)
    }

    /// a·b.
    pub fn mul(&mut self, a: Value, b: Value) -> Value {
        self.builder.ins().fmul(a, b)
    }

    /// a/b.
    pub fn div(&mut self, a: Value, b: Value) -> Value {
        self.builder.ins().fdiv(a, b)
    }

    /// −a.
    pub fn neg(&mut self, a: Value) -> Value {
        self.builder.ins().fneg(a)
    }

    /// |a|.
    pub fn abs(&mut self, a: Value) -> Value {
        self.builder.ins().fabs(a)
    }

    /// One value or the other, without a branch.
    pub fn select(&mut self, holds: Value, yes: Value, no: Value) -> Value {
        self.builder.ins().select(holds, yes, no)
    }

    /// Returns a number from the function where something holds.
    pub fn return_if(&mut self, holds: Value, number: f64) {
        let (leaves, after) = (self.builder.create_block(), self.builder.create_block());
        self.builder.ins().brif(holds, leaves, &[], after, &[]);
        self.enter(leaves);
        let number = self.number(number);
        self.builder.ins().return_(&[number]);
        self.enter(after);
    }

    /// The values that one branch gives where something holds, or else the other.
    pub fn either<const N: usize>(
        &mut self,
        holds: Value,
        yes: impl FnOnce(&mut Self) -> [Value; N],
        no: impl FnOnce(&mut Self) -> [Value; N],
    ) -> [Value; N] {
        let [first, second, after] = [(); 3].map(|()| self.builder.create_block());
        let results = [(); N].map(|()| self.builder.append_block_param(after, types::F64));
        self.builder.ins().brif(holds, first, &[], second, &[]);
        self.enter(first);
        let values = yes(self).map(BlockArg::from);
        self.builder.ins().jump(after, &values);
        self.enter(second);
        let values = no(self).map(BlockArg::from);
        self.builder.ins().jump(after, &values);
        self.enter(after);
        results
    }

    /// Begins what is done only where something holds; returns what [`Self::end_if`] takes.
    pub fn begin_if(&mut self, holds: Value) -> Block {
        let (inner, after) = (self.builder.create_block(), self.builder.create_block());
        self.builder.ins().brif(holds, inner, &[], after, &[]);
        self.enter(inner);
        after
    }

    /// Ends what [`Self::begin_if`] began.
    pub fn end_if(&mut self, after: Block) {
        self.builder.ins().jump(after, &[]);
        self.enter(after);
    }

    fn enter(&mut self, block: Block) {
        self.builder.switch_to_block(block);
        self.builder.seal_block(block);
    }

    /// Runs code on registers whose slots and constants are set.
    pub fn run(&mut self, code: &Code, file: &mut [Value]) {
        for op in &code.ops {
            let operands = [op.a, op.b, op.c].map(|register| file[register as usize]);
            file[op.to as usize] = self.operation(op, operands);
        }
    }

    fn operation(&mut self, op: &Op, [a, b, c]: [Value; 3]) -> Value {
        match op.action {
            Action::Unary(function) => self.unary(function, a),
            Action::Binary(function) => self.binary(function, a, b),
            Action::Select => {
                let holds = self.holds(a);
                self.builder.ins().select(holds, b, c)
            }
            Action::MulAdd => {
                let product = self.mul(a, b);
                self.add(product, c)
            }
            Action::MulSub => {
                let product = self.mul(a, b);
                self.sub(product, c)
            }
            Action::SubMul => {
                let product = self.mul(a, b);
                self.sub(c, product)
            }
        }
    }

    fn unary(&mut self, function: Unary, a: Value) -> Value {
        match function {
            Unary::Neg => self.builder.ins().fneg(a),
            Unary::Abs => self.builder.ins().fabs(a),
            Unary::Sqrt => self.builder.ins().sqrt(a),
            Unary::Not => {
                let zero = self.number(0.0);
                self.compared(FloatCC::Equal, a, zero)
            }
            Unary::Heaviside => {
                let zero = self.number(0.0);
                self.compared(FloatCC::GreaterThanOrEqual, a, zero)
            }
            _ => self.call(0, calls::unary(function) as *const (), &[a]),
        }
    }

    fn binary(&mut self, function: Binary, a: Value, b: Value) -> Value {
        if let Some(call) = calls::binary(function) {
            return self.call(1, call as *const (), &[a, b]);
        }
        match function {
            Binary::Add => self.add(a, b),
            Binary::Sub => self.sub(a, b),
            Binary::Mul => self.mul(a, b),
            Binary::Div => self.builder.ins().fdiv(a, b),
            Binary::Min => self.nearer(FloatCC::LessThan, a, b),
            Binary::Max => self.nearer(FloatCC::GreaterThan, a, b),
            Binary::Lt => self.compared(FloatCC::LessThan, a, b),
            Binary::Le => self.compared(FloatCC::LessThanOrEqual, a, b),
            Binary::Gt => self.compared(FloatCC::GreaterThan, a, b),
            Binary::Ge => self.compared(FloatCC::GreaterThanOrEqual, a, b),
            Binary::Eq => self.compared(FloatCC::Equal, a, b),
            Binary::Ne => self.compared(FloatCC::NotEqual, a, b),
            Binary::And | Binary::Or | Binary::Xor => {
                let (a, b) = (self.holds(a), self.holds(b));
                let both = match function {
                    Binary::And => self.builder.ins().band(a, b),
                    Binary::Or => self.builder.ins().bor(a, b),
                    _ => self.builder.ins().bxor(a, b),
                };
                self.truth(both)
            }
            Binary::Pow | Binary::Rem | Binary::Quotient => unreachable!("these are called"),
        }
    }

    /// `a` where the comparison holds or `b` is not a number, and else `b`.
    fn nearer(&mut self, comparison: FloatCC, a: Value, b: Value) -> Value {
        let nearer = self.builder.ins().fcmp(comparison, a, b);
        let lost = self.builder.ins().fcmp(FloatCC::Unordered, b, b);
        let takes = self.builder.ins().bor(nearer, lost);
        self.builder.ins().select(takes, a, b)
    }

    /// Whether a number counts as true.
    fn holds(&mut self, a: Value) -> Value {
        let zero = self.number(0.0);
        self.builder.ins().fcmp(FloatCC::NotEqual, a, zero)
    }

    /// Whether a comparison holds.
    pub fn compare(&mut self, comparison: FloatCC, a: Value, b: Value) -> Value {
        self.builder.ins().fcmp(comparison, a, b)
    }

    fn compared(&mut self, comparison: FloatCC, a: Value, b: Value) -> Value {
        let holds = self.compare(comparison, a, b);
        self.truth(holds)
    }

    fn truth(&mut self, holds: Value) -> Value {
        let (one, zero) = (self.number(1.0), self.number(0.0));
        self.builder.ins().select(holds, one, zero)
    }

    fn call(&mut self, signature: usize, function: *const (), arguments: &[Value]) -> Value {
        let address = self.builder.ins().iconst(self.address, function as i64);
        let call = self.builder.ins().call_indirect(self.signatures[signature], address, arguments);
        self.builder.inst_results(call)[0]
    }
}
