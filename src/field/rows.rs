//! Runs compiled reactions over long rows of boxes: each operation goes through a whole row, so that what it costs to
//! look up the operation is shared by many boxes.

use std::cell::Cell;

use pulp::Simd;

use crate::elementary;
use crate::equations::program::code::{Action, Code, Op};
use crate::equations::program::{Lanes, Program, run_wide};
use crate::equations::tree::{Binary, Unary};

/// Boxes in a row.
pub const ROW: usize = 64;
/// Numbers that are worked on at once; they fit into registers of the processor.
const PART: usize = 8;
const PARTS: usize = ROW / PART;

type Part = [f64; PART];
type Row<'a> = &'a [Cell<Part>];

/// A run of operations of one kind.
#[derive(Debug, Clone)]
enum Stretch {
    /// Those that have a version for rows here.
    Plain(Vec<Op>),
    /// All others, by the engine.
    Other(Code),
}

/// The rates of a program in stretches.
#[derive(Debug, Clone)]
pub struct Rows {
    stretches: Vec<Stretch>,
    /// Where each rate stands in the end.
    pub outputs: Vec<usize>,
}

/// Registers of a program, a row each.
pub type File = Vec<Lanes<ROW>>;

fn is_plain(action: Action) -> bool {
    use Binary::{Add, Div, Ge, Gt, Le, Lt, Max, Min, Mul, Sub};
    use Unary::{Abs, Exp, Ln, Neg, Sqrt};
    match action {
        Action::Binary(function) => matches!(function, Add | Sub | Mul | Div | Lt | Le | Gt | Ge | Min | Max),
        Action::Unary(function) => matches!(function, Neg | Abs | Sqrt | Exp | Ln),
        Action::Select | Action::MulAdd | Action::MulSub | Action::SubMul => true,
        Action::Copy | Action::Solve(_) => false,
    }
}

impl Rows {
    /// The rates of a program.
    pub fn new(program: &Program) -> Self {
        let mut stretches: Vec<Stretch> = Vec::new();
        for op in &program.rates.ops {
            match (stretches.last_mut(), is_plain(op.action)) {
                (Some(Stretch::Plain(ops)), true) => ops.push(*op),
                (Some(Stretch::Other(code)), false) => code.ops.push(*op),
                (_, true) => stretches.push(Stretch::Plain(vec![*op])),
                (_, false) => stretches.push(Stretch::Other(Code {
                    ops: vec![*op],
                    solved: program.rates.solved.clone(),
                    ..Code::default()
                })),
            }
        }
        Self { stretches, outputs: program.rates.outputs.iter().map(|register| *register as usize).collect() }
    }

    /// Works the rates out from the registers that are set.
    #[inline(always)]
    pub fn run<S: Simd>(&self, simd: S, file: &mut File) {
        for stretch in &self.stretches {
            match stretch {
                Stretch::Plain(ops) => {
                    let (parts, _) = file.as_flattened_mut().as_chunks_mut::<PART>();
                    let cells = Cell::from_mut(parts).as_slice_of_cells();
                    for op in ops {
                        plain(op, cells);
                    }
                }
                Stretch::Other(code) => run_wide(simd, code, file),
            }
        }
    }

    /// Whether all operations have a version for rows.
    #[cfg(test)]
    fn is_plain(&self) -> bool {
        self.stretches.iter().all(|stretch| matches!(stretch, Stretch::Plain(_)))
    }
}

#[inline(always)]
fn row(file: Row, register: u32) -> Row {
    &file[register as usize * PARTS..][..PARTS]
}

/// A part of the row at a time: both operands are read before the result is written, which may stand in their place.
#[inline(always)]
fn one(a: Row, to: Row, function: impl Fn(f64) -> f64) {
    for (a, to) in a.iter().zip(to) {
        let (a, mut result) = (a.get(), [0.0; PART]);
        for l in 0..PART {
            result[l] = function(a[l]);
        }
        to.set(result);
    }
}

#[inline(always)]
fn two(a: Row, b: Row, to: Row, function: impl Fn(f64, f64) -> f64) {
    for ((a, b), to) in a.iter().zip(b).zip(to) {
        let (a, b, mut result) = (a.get(), b.get(), [0.0; PART]);
        for l in 0..PART {
            result[l] = function(a[l], b[l]);
        }
        to.set(result);
    }
}

#[inline(always)]
fn three(a: Row, b: Row, c: Row, to: Row, function: impl Fn(f64, f64, f64) -> f64) {
    for (((a, b), c), to) in a.iter().zip(b).zip(c).zip(to) {
        let (a, b, c, mut result) = (a.get(), b.get(), c.get(), [0.0; PART]);
        for l in 0..PART {
            result[l] = function(a[l], b[l], c[l]);
        }
        to.set(result);
    }
}

#[inline(always)]
fn truth(holds: bool) -> f64 {
    if holds { 1.0 } else { 0.0 }
}

/// One operation over rows. The functions are those of the engine, so that the bits are the same.
#[inline(always)]
#[rustfmt::skip] // a table
#[allow(clippy::redundant_closure)] // a function by its name would be called, not inlined into the lanes
fn plain(op: &Op, file: Row) {
    let (a, b, to) = (row(file, op.a), row(file, op.b), row(file, op.to));
    match op.action {
        Action::Binary(Binary::Add) => two(a, b, to, #[inline(always)] |a, b| a + b),
        Action::Binary(Binary::Sub) => two(a, b, to, #[inline(always)] |a, b| a - b),
        Action::Binary(Binary::Mul) => two(a, b, to, #[inline(always)] |a, b| a * b),
        Action::Binary(Binary::Div) => two(a, b, to, #[inline(always)] |a, b| a / b),
        Action::Binary(Binary::Min) => two(a, b, to, #[inline(always)] |a, b| a.min(b)),
        Action::Binary(Binary::Max) => two(a, b, to, #[inline(always)] |a, b| a.max(b)),
        Action::Binary(Binary::Lt) => two(a, b, to, #[inline(always)] |a, b| truth(a < b)),
        Action::Binary(Binary::Le) => two(a, b, to, #[inline(always)] |a, b| truth(a <= b)),
        Action::Binary(Binary::Gt) => two(a, b, to, #[inline(always)] |a, b| truth(a > b)),
        Action::Binary(Binary::Ge) => two(a, b, to, #[inline(always)] |a, b| truth(a >= b)),
        Action::Unary(Unary::Neg) => one(a, to, #[inline(always)] |a| -a),
        Action::Unary(Unary::Abs) => one(a, to, #[inline(always)] |a| a.abs()),
        Action::Unary(Unary::Sqrt) => one(a, to, #[inline(always)] |a| a.sqrt()),
        Action::Unary(Unary::Exp) => one(a, to, #[inline(always)] |a| elementary::exp(a)),
        Action::Unary(Unary::Ln) => one(a, to, #[inline(always)] |a| elementary::ln(a)),
        Action::MulAdd => three(a, b, row(file, op.c), to, #[inline(always)] |a, b, c| a * b + c),
        Action::MulSub => three(a, b, row(file, op.c), to, #[inline(always)] |a, b, c| a * b - c),
        Action::SubMul => three(a, b, row(file, op.c), to, #[inline(always)] |a, b, c| c - a * b),
        Action::Select => {
            let no = row(file, op.c);
            for (((a, yes), no), to) in a.iter().zip(b).zip(no).zip(to) {
                let (a, yes, no, mut result) = (a.get(), yes.get(), no.get(), [0.0; PART]);
                for l in 0..PART {
                    result[l] = if a[l] != 0.0 { yes[l] } else { no[l] };
                }
                to.set(result);
            }
        }
        _ => unreachable!("other operations stand in stretches of their own"),
    }
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;
    use crate::equations::eml;
    use crate::equations::program::run;
    use crate::error::Source;
    use std::sync::Arc;

    fn program(text: String) -> Program {
        let document = eml::read(Arc::new(Source { name: "rows.eml".into(), text })).expect("a good document");
        Program::new(&document.system).expect("no circle")
    }

    #[test]
    fn rows_give_the_bits_of_the_engine() {
        let rates =
            "-u*v^2 + exp(-u)*0.3 - sqrt(v)/(1 + ln(2 + u)) + piecewise(u, u lt v, max(v, 1) - u^1.5) + tanh(v)";
        let program = program(format!(
            "<eml name=\"rows\" level=\"cell\"><variable id=\"u\" initial=\"1\" rate=\"{rates}\"/>
             <variable id=\"v\" initial=\"1\" rate=\"u - abs(v - min(u, 0.7))*sin(time)\"/></eml>"
        ));
        let rows = Rows::new(&program);
        assert!(!rows.is_plain(), "powers, sine and tanh are the engine's");
        let (mut here, mut there) = (program.file::<ROW>(), program.file::<ROW>());
        for l in 0..ROW {
            (here[0][l], here[1][l], here[2][l]) = (0.1 * l as f64, 0.03 * l as f64, 2.0 / (1.0 + l as f64));
        }
        there[..3].copy_from_slice(&here[..3]);
        rows.run(Scalar, &mut here);
        run(&program.rates, &mut there);
        for (output, other) in rows.outputs.iter().zip(&program.rates.outputs) {
            assert_eq!(here[*output].map(f64::to_bits), there[*other as usize].map(f64::to_bits));
        }
    }

    #[test]
    fn the_reactions_of_the_documents_have_a_version_for_rows() {
        for name in ["gray_scott", "brusselator"] {
            let path = format!("{}/eml/{name}.eml", env!("CARGO_MANIFEST_DIR"));
            let rows = Rows::new(&program(std::fs::read_to_string(path).expect("a document of eml/")));
            assert!(rows.is_plain(), "{name} is left to the engine: add the new operation to `plain`");
        }
    }
}
