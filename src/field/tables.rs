//! Expressions of a document at many points of a grid: worked out once where they stand still, and else whenever they are needed.

use super::grid::Grid;
use super::rows::{File, ROW};
use super::scales::{POSITION, Scales, in_circle};
use super::sites::Sites;
use crate::equations::Range;
use crate::equations::eml::{Document, reads};
use crate::equations::program::code::Code;
use crate::equations::program::{Program, run};
use crate::equations::tree::{Expr, QuantityId, Role};
use crate::error::Result;

/// A number, or the number of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coefficient {
    /// The same everywhere and at all times.
    Number(f64),
    /// In this table.
    Table(usize),
}

impl Coefficient {
    /// Its value at a point of its table.
    #[inline(always)]
    pub fn at(self, tables: &[Vec<f64>], at: usize) -> f64 {
        match self {
            Self::Number(value) => value,
            Self::Table(number) => tables[number][at],
        }
    }
}

/// An expression at the points of a grid.
#[derive(Debug, Clone)]
pub struct Table {
    pub sites: Sites,
    /// Whether it must be worked out anew when time, inputs or fields have changed.
    pub varies: bool,
    program: Program,
    code: Code,
    /// Where the value stands among the registers; none for what is 0.
    output: Option<usize>,
    /// From the document's units to µm and s.
    factor: f64,
    position: [Option<usize>; 3],
    inputs: Vec<usize>,
}

/// What a table is worked out from.
#[derive(Clone, Copy)]
pub struct Now<'a> {
    pub grid: &'a Grid,
    pub scales: Scales,
    /// In s.
    pub time: f64,
    pub inputs: &'a [f64],
    /// `[species][box]`.
    pub values: &'a [f64],
    pub ranges: &'a [Range],
}

impl Table {
    /// The table of an expression.
    ///
    /// # Errors
    /// Definitions in a circle.
    pub fn new(document: &Document, sites: Sites, expr: &Expr, factor: f64) -> Result<Self> {
        let program = Program::with(&document.system, 0.0, &[], &[vec![expr.clone()]]);
        let program = program.map_err(|circle| in_circle(document, &circle))?;
        let (code, output) = (program.further[0].clone(), program.further[0].outputs[0] as usize);
        let varies = !reads(expr, &document.system).stands_still();
        Ok(Self::of(program, code, Some(output), sites, varies, factor))
    }

    /// The tables of an expression and of its derivative by a field.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_slope(
        document: &Document,
        sites: Sites,
        expr: &Expr,
        by: QuantityId,
        factor: f64,
    ) -> Result<[Self; 2]> {
        let mut system = document.system.clone();
        for (number, quantity) in system.quantities.iter_mut().enumerate() {
            if let Role::Variable { rate } = &mut quantity.role {
                *rate = if number as QuantityId == by { expr.clone() } else { Expr::Number(0.0) };
            }
        }
        let program = Program::new(&system).map_err(|circle| in_circle(document, &circle))?;
        let variable = program.variable_index(by).expect("a field is a variable") as u32;
        let entry = program.pattern.iter().position(|entry| *entry == (variable, variable));
        let slope = entry.map(|entry| program.linear.outputs[2 * program.size() + entry] as usize);
        let code = program.linear.clone();
        let slope = Self::of(program, code, slope, sites, true, factor);
        Ok([Self::new(document, sites, expr, factor)?, slope])
    }

    fn of(program: Program, code: Code, output: Option<usize>, sites: Sites, varies: bool, factor: f64) -> Self {
        let register = |number: usize| program.first_open() + number;
        let name = |number: usize| program.names[program.open[number] as usize].as_str();
        let numbers = 0..program.open.len();
        let position = POSITION.map(|axis| numbers.clone().find(|number| name(*number) == axis).map(register));
        let inputs = numbers.filter(|number| !POSITION.contains(&name(*number))).map(register).collect();
        Self { sites, varies, code, output, factor, position, inputs, program }
    }

    /// Works out the values at points from `first` on.
    pub fn fill(&self, now: &Now, first: usize, to: &mut [f64], file: &mut File) {
        let Some(output) = self.output else { return to.fill(0.0) };
        self.program.suit(file);
        let (grid, scales) = (now.grid, now.scales);
        file[0] = [now.time / scales.seconds; ROW];
        for (register, value) in self.inputs.iter().zip(now.inputs) {
            file[*register] = [*value; ROW];
        }
        for (row, to) in to.chunks_mut(ROW).enumerate() {
            for lane in 0..to.len() {
                let at = first + row * ROW + lane;
                let index = self.sites.index(grid, at);
                if self.position.iter().any(Option::is_some) {
                    let position = self.sites.position(grid, index);
                    for (register, position) in self.position.iter().zip(position) {
                        if let Some(register) = register {
                            file[*register][lane] = position / scales.micrometres;
                        }
                    }
                }
                for s in 0..self.program.size() {
                    file[1 + s][lane] = self.field(now, s, at, index);
                }
            }
            run(&self.code, file);
            for (to, value) in to.iter_mut().zip(&file[output]) {
                *to = value * self.factor;
            }
        }
    }

    /// The value of a field at a point: that of its box, or at a wall on the line through the two boxes before it.
    fn field(&self, now: &Now, s: usize, at: usize, index: [usize; 3]) -> f64 {
        let values = now.values.get(s * now.grid.len()..).unwrap_or(&[]);
        match (self.sites, self.sites.behind(now.grid, index)) {
            (Sites::Boxes, _) => values.get(at).copied().unwrap_or(0.0),
            (_, Some([near, far])) if !values.is_empty() => {
                let value = 1.5 * values[near] - 0.5 * values[far];
                if now.ranges[s] == Range::NonNegative { value.max(0.0) } else { value }
            }
            _ => 0.0,
        }
    }
}
