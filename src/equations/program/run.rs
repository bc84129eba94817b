//! Runs register code over lanes of cells.

use pulp::{Simd, WithSimd};

use super::code::{Action, Code, Function};
use crate::elementary;
use crate::equations::tree::{Binary, Unary, larger, smaller};

/// One number for each of `L` cells.
pub type Lanes<const L: usize> = [f64; L];

#[inline(always)]
fn map<const L: usize>(a: &Lanes<L>, function: impl Fn(f64) -> f64) -> Lanes<L> {
    let mut result = [0.0; L];
    for l in 0..L {
        result[l] = function(a[l]);
    }
    result
}

#[inline(always)]
fn zip<const L: usize>(a: &Lanes<L>, b: &Lanes<L>, function: impl Fn(f64, f64) -> f64) -> Lanes<L> {
    let mut result = [0.0; L];
    for l in 0..L {
        result[l] = function(a[l], b[l]);
    }
    result
}

#[inline(always)]
fn zip3<const L: usize>(a: &Lanes<L>, b: &Lanes<L>, c: &Lanes<L>, function: impl Fn(f64, f64, f64) -> f64) -> Lanes<L> {
    let mut result = [0.0; L];
    for l in 0..L {
        result[l] = function(a[l], b[l], c[l]);
    }
    result
}

#[inline(always)]
fn truth(holds: bool) -> f64 {
    if holds { 1.0 } else { 0.0 }
}

/// Functions without an own version for lanes, one lane after the other.
#[inline(never)]
fn one_by_one(function: impl Fn(f64) -> f64, values: &mut [f64]) {
    values.iter_mut().for_each(|value| *value = function(*value));
}

#[inline(never)]
fn pairs(function: Binary, a: &mut [f64], b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a = function.apply(*a, *b));
}

/// Runs code on a register file whose slots and constants are set.
#[inline(never)]
pub fn run<const L: usize>(code: &Code, file: &mut [Lanes<L>]) {
    run_in_place(code, file);
}

/// As [`run`], in the processor's wide registers: a function of its own for each kind of these. Compiled into every stage of every method it was a
/// fifth of the library's machine code, and took a third of the time in which it is built.
#[inline(always)]
pub fn run_wide<S: Simd, const L: usize>(simd: S, code: &Code, file: &mut [Lanes<L>]) {
    if S::IS_SCALAR {
        run(code, file);
    } else {
        simd.vectorize(Run { code, file });
    }
}

/// Code and registers as an object with a method of its own: only so is all of it compiled for the wide registers, which a closure is not always.
struct Run<'a, const L: usize> {
    code: &'a Code,
    file: &'a mut [Lanes<L>],
}

impl<const L: usize> WithSimd for Run<'_, L> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        run_in_place(self.code, self.file);
    }
}

/// As [`run`], compiled for the registers of the place where it stands.
#[inline(always)]
fn run_in_place<const L: usize>(code: &Code, file: &mut [Lanes<L>]) {
    for op in &code.ops {
        // Operands stay where they are: copied, they would go through the stack.
        let (a, b) = (&file[op.a as usize], &file[op.b as usize]);
        let value = match op.action {
            Action::Binary(function) => match function {
                Binary::Add => zip(a, b, |a, b| a + b),
                Binary::Sub => zip(a, b, |a, b| a - b),
                Binary::Mul => zip(a, b, |a, b| a * b),
                Binary::Div => zip(a, b, |a, b| a / b),
                Binary::Min => zip(a, b, smaller),
                Binary::Max => zip(a, b, larger),
                Binary::Lt => zip(a, b, |a, b| truth(a < b)),
                Binary::Le => zip(a, b, |a, b| truth(a <= b)),
                Binary::Gt => zip(a, b, |a, b| truth(a > b)),
                Binary::Ge => zip(a, b, |a, b| truth(a >= b)),
                Binary::Eq => zip(a, b, |a, b| truth(a == b)),
                Binary::Ne => zip(a, b, |a, b| truth(a != b)),
                Binary::And => zip(a, b, |a, b| truth((a != 0.0) & (b != 0.0))),
                Binary::Or => zip(a, b, |a, b| truth((a != 0.0) | (b != 0.0))),
                Binary::Xor => zip(a, b, |a, b| truth((a != 0.0) != (b != 0.0))),
                Binary::Pow | Binary::Rem | Binary::Quotient => {
                    let mut result = *a;
                    pairs(function, &mut result, b);
                    result
                }
            },
            Action::Unary(function) => match function {
                Unary::Neg => map(a, |a| -a),
                Unary::Not => map(a, |a| truth(a == 0.0)),
                Unary::Abs => map(a, f64::abs),
                Unary::Sign => map(a, |a| truth(a > 0.0) - truth(a < 0.0)),
                Unary::Sqrt => map(a, f64::sqrt),
                Unary::Heaviside => map(a, |a| truth(a >= 0.0)),
                Unary::Exp => map(a, elementary::exp),
                Unary::Ln => map(a, elementary::ln),
                _ => {
                    let mut result = *a;
                    one_by_one(|value| function.apply(value), &mut result);
                    result
                }
            },
            Action::MulAdd => zip3(a, b, &file[op.c as usize], |a, b, c| a * b + c),
            Action::MulSub => zip3(a, b, &file[op.c as usize], |a, b, c| a * b - c),
            Action::SubMul => zip3(a, b, &file[op.c as usize], |a, b, c| c - a * b),
            Action::Copy => *a,
            Action::Solve(number) => {
                solve(&code.solved[number as usize], &mut file[op.to as usize..]);
                continue;
            }
            Action::Select => zip3(a, b, &file[op.c as usize], |a, b, c| if a != 0.0 { b } else { c }),
        };
        file[op.to as usize] = value;
    }
}

/// Solves the equations in the registers of a call.
#[inline(never)]
fn solve<const L: usize>(function: &Function, registers: &mut [Lanes<L>]) {
    let (own, work) = registers.split_at_mut(function.first_of_search());
    let (search, first_constant) = (function.search, function.used + function.search.count);
    for (register, bits) in own[first_constant..].iter_mut().zip(&function.constants) {
        *register = [f64::from_bits(*bits); L];
    }
    search.solve(&mut work[..search.registers()], |work| {
        for index in 0..search.count {
            own[function.used + index] = work[search.unknown(index)];
        }
        run(&function.code, own);
        let value = |output: usize| own[function.code.outputs[output] as usize];
        for row in 0..search.count {
            work[search.residual(row)] = value(row);
            for column in 0..search.count {
                work[search.slope(row, column)] = value(search.count + row * search.count + column);
            }
        }
    });
}
