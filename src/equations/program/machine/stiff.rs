//! A whole step of a Rosenbrock method as one function. The linear systems are factored without exchanging rows, and only what
//! the pattern of the Jacobian fills is worked out; a step that asks for an exchange is left to the register code.
//!
//! Places that are always zero are left out here and worked out over lanes, where a zero is taken away without a trace; a factor that
//! only happens to be zero may leave another sign to a zero here. No bit of a state depends on it: what is added to a state that is not
//! −0 is the same for zeros of both signs, and numbers that are not finite make the norm one that refuses the step either way.

use cranelift_codegen::ir::Value;
use cranelift_codegen::ir::condcodes::FloatCC;

use super::step::{Frame, LEFT, StepCode};
use super::twos::Kept;
use crate::equations::program::Program;

/// The numbers of a Rosenbrock method whose last stage is its error.
pub struct RosenbrockTableau {
    /// Its place among the methods that have machine code.
    pub number: usize,
    /// The diagonal.
    pub gamma: f64,
    /// Times of the stages.
    pub times: &'static [f64],
    /// Weights of the derivative by time.
    pub drift: &'static [f64],
    /// Weights of the stages before one in its argument.
    pub arguments: fn(usize) -> &'static [f64],
    /// Weights of the stages before one, over the step, on its right side.
    pub rights: fn(usize) -> &'static [f64],
    /// An entry this many times larger than the pivot asks for an exchange of rows.
    pub exchange: f64,
    /// A step that is at least this share of what is left of a window is the last.
    pub near: f64,
}

/// Steps whose linear systems need more products than this stay register code.
const MOST_PRODUCTS: usize = 1500;

/// Machine code of a step by a Rosenbrock method, or nothing where there can be none.
pub fn compile<const L: usize>(program: &Program, tableau: &RosenbrockTableau) -> Option<StepCode<L>> {
    if products(program, tableau.times.len()) > MOST_PRODUCTS {
        return None;
    }
    StepCode::new(program, false, |frame| write(frame, tableau))
}

/// Which places of the factored matrix are not always zero.
fn filled(program: &Program) -> Vec<Vec<bool>> {
    let n = program.size();
    let mut filled: Vec<Vec<bool>> = (0..n).map(|row| (0..n).map(|column| row == column).collect()).collect();
    program.pattern.iter().for_each(|&(row, column)| filled[row as usize][column as usize] = true);
    for k in 0..n {
        for i in (k + 1..n).filter(|&i| filled[i][k]).collect::<Vec<_>>() {
            (k + 1..n).for_each(|j| filled[i][j] |= filled[k][j]);
        }
    }
    filled
}

/// How many products factoring and solving take, about.
fn products(program: &Program, stages: usize) -> usize {
    let filled = filled(program);
    let row = |k: usize| (k + 1..filled.len()).filter(|&j| filled[k][j]).count();
    let column = |k: usize| (k + 1..filled.len()).filter(|&i| filled[i][k]).count();
    let factoring: usize = (0..filled.len()).map(|k| column(k) * (1 + row(k))).sum();
    factoring + stages * filled.iter().flatten().filter(|&&filled| filled).count()
}

/// A factored matrix; nothing at places that are always zero. One over each pivot stands on the diagonal.
type Factors = Vec<Vec<Option<Value>>>;

fn write(frame: &mut Frame, tableau: &RosenbrockTableau) -> Value {
    let (program, n) = (frame.program, frame.program.size());
    let [time, step, then] = frame.chosen_step(tableau.near);
    let mut file = frame.registers();
    let state = frame.begin();
    let one = frame.emitter.number(1.0);
    let inverse = frame.emitter.div(one, step);
    let found = frame.evaluate(&program.linear, time, &state, &mut file);
    let negated: Vec<Value> = found[n..].iter().map(|&value| negated_where_finite(frame, value)).collect();
    let (drift, entries) = negated.split_at(n);
    let mut matrix = matrix(frame, tableau, entries, inverse);
    factor(frame, &mut matrix, tableau.exchange);
    let begin = frame.emitter.keep(&state);
    let mut right = found[..n].to_vec();
    let (mut stages, mut end, mut last): (Vec<Kept>, _, Vec<Value>) = (Vec::new(), state, Vec::new());
    for stage in 0..tableau.times.len() {
        if stage > 0 {
            end = argument(frame, (tableau.arguments)(stage), begin, &stages);
            let clock = frame.clock(time, step, tableau.times[stage]);
            let rates = frame.evaluate(&program.rates, clock, &end, &mut file);
            right = right_side(frame, (tableau.rights)(stage), &stages, &rates, inverse);
        }
        if tableau.drift[stage] != 0.0 && !program.timeless {
            let weight = frame.emitter.number(tableau.drift[stage]);
            let weight = frame.emitter.mul(step, weight);
            for (right, &drift) in right.iter_mut().zip(drift) {
                *right = taken_away(frame, *right, weight, drift);
            }
        }
        last = solved(frame, &matrix, right.clone());
        stages.push(frame.emitter.keep(&last));
    }
    let end: Vec<Value> = end.iter().zip(&last).map(|(&end, &last)| frame.emitter.add(end, last)).collect();
    let errors = frame.emitter.join(&last);
    let error = frame.norm(&errors, begin, &end);
    frame.move_on(error, &end, None, then);
    error
}

/// 1/(γ·step) − J from the negated entries of J.
fn matrix(frame: &mut Frame, tableau: &RosenbrockTableau, entries: &[Value], inverse: Value) -> Factors {
    let n = frame.program.size();
    let mut matrix: Factors = vec![vec![None; n]; n];
    for (&(row, column), &entry) in frame.program.pattern.iter().zip(entries) {
        matrix[row as usize][column as usize] = Some(entry);
    }
    let share = frame.emitter.number(1.0 / tableau.gamma);
    let own = frame.emitter.mul(inverse, share);
    for v in 0..n {
        let entry = matrix[v][v].unwrap_or_else(|| frame.emitter.number(0.0));
        matrix[v][v] = Some(frame.emitter.add(entry, own));
    }
    matrix
}

/// Factors a matrix in place; leaves the step where rows should be exchanged.
fn factor(frame: &mut Frame, matrix: &mut Factors, exchange: f64) {
    let n = matrix.len();
    let one = frame.emitter.number(1.0);
    for k in 0..n {
        let pivot = matrix[k][k].expect("the diagonal is full");
        let limit = frame.emitter.number(exchange);
        let size = frame.emitter.abs(pivot);
        let limit = frame.emitter.mul(limit, size);
        let inverse = frame.emitter.div(one, pivot);
        matrix[k][k] = Some(inverse);
        let above = matrix[k].clone();
        for row in &mut matrix[k + 1..] {
            let Some(entry) = row[k] else { continue };
            let size = frame.emitter.abs(entry);
            let exchanged = frame.emitter.compare(FloatCC::GreaterThan, size, limit);
            frame.emitter.return_if(exchanged, LEFT);
            let factor = frame.emitter.mul(entry, inverse);
            row[k] = Some(factor);
            for j in k + 1..n {
                let Some(above) = above[j] else { continue };
                let below = row[j].unwrap_or_else(|| frame.emitter.number(0.0));
                row[j] = Some(taken_away(frame, below, factor, above));
            }
        }
    }
}

/// The solution of a factored system.
fn solved(frame: &mut Frame, matrix: &Factors, mut right: Vec<Value>) -> Vec<Value> {
    let n = right.len();
    for i in 1..n {
        for j in 0..i {
            if let Some(factor) = matrix[i][j] {
                right[i] = taken_away(frame, right[i], factor, right[j]);
            }
        }
    }
    for i in (0..n).rev() {
        for j in i + 1..n {
            if let Some(factor) = matrix[i][j] {
                right[i] = taken_away(frame, right[i], factor, right[j]);
            }
        }
        let inverse = matrix[i][i].expect("the diagonal is full");
        right[i] = frame.emitter.mul(right[i], inverse);
    }
    right
}

/// from − factor·other.
fn taken_away(frame: &mut Frame, from: Value, factor: Value, other: Value) -> Value {
    let product = frame.emitter.mul(factor, other);
    frame.emitter.sub(from, product)
}

/// A number negated, and 0 where it is not finite.
fn negated_where_finite(frame: &mut Frame, value: Value) -> Value {
    let [infinite, zero] = [f64::INFINITY, 0.0].map(|value| frame.emitter.number(value));
    let size = frame.emitter.abs(value);
    let finite = frame.emitter.compare(FloatCC::LessThan, size, infinite);
    let negated = frame.emitter.neg(value);
    frame.emitter.select(finite, negated, zero)
}

/// begin + Σ weight·stage.
fn argument(frame: &mut Frame, weights: &[f64], begin: Kept, stages: &[Kept]) -> Vec<Value> {
    let n = frame.program.size();
    let pairs: Vec<Value> = (0..n.div_ceil(2))
        .map(|pair| {
            let change = frame.sum(weights, stages, pair);
            let begin = frame.emitter.kept(begin, pair);
            frame.emitter.add(begin, change)
        })
        .collect();
    frame.emitter.split(&pairs, n)
}

/// rate + Σ weight·stage over the step.
fn right_side(frame: &mut Frame, weights: &[f64], stages: &[Kept], rates: &[Value], inverse: Value) -> Vec<Value> {
    let inverses = frame.emitter.twice(inverse);
    let changes: Vec<Value> = (0..rates.len().div_ceil(2))
        .map(|pair| {
            let sum = frame.sum(weights, stages, pair);
            frame.emitter.mul(inverses, sum)
        })
        .collect();
    let changes = frame.emitter.split(&changes, rates.len());
    rates.iter().zip(changes).map(|(&rate, change)| frame.emitter.add(rate, change)).collect()
}
