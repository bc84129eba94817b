//! A whole step of an explicit pair as one function: the choice of its length, stages, rates, error and new state.

use cranelift_codegen::ir::Value;

use super::step::{Frame, StepCode, place};
use super::twos::Kept;
use crate::equations::program::Program;

/// The numbers of an explicit pair whose last stage is the first of the next step. Stages of weight 0 are left out.
pub struct Tableau {
    /// Its place among the methods that have machine code.
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

/// Machine code of a step by a pair, or nothing where there can be none.
pub fn compile<const L: usize>(program: &Program, tableau: &Tableau) -> Option<StepCode<L>> {
    StepCode::new(program, true, |frame| write(frame, tableau))
}

fn write(frame: &mut Frame, tableau: &Tableau) -> Value {
    let [time, step, then] = frame.chosen_step(tableau.near);
    let mut file = frame.registers();
    let begin = frame.begin();
    let mut rates = first_rates(frame, time, &begin, &mut file);
    let mut stages = vec![frame.emitter.keep(&rates)];
    let begin = frame.emitter.keep(&begin);
    let mut end = Vec::new();
    for stage in 1..tableau.times.len() {
        end = arguments(frame, (tableau.weights)(stage), begin, &stages, &rates, step);
        let clock = frame.clock(time, step, tableau.times[stage]);
        rates = frame.evaluate(&frame.program.rates, clock, &end, &mut file);
        stages.push(frame.emitter.keep(&rates));
    }
    let steps = frame.emitter.twice(step);
    let errors: Vec<Value> = (0..end.len().div_ceil(2))
        .map(|pair| {
            let sum = frame.sum(tableau.error, &stages, pair);
            frame.emitter.mul(steps, sum)
        })
        .collect();
    let error = frame.norm(&errors, begin, &end);
    frame.move_on(error, &end, Some(&rates), then);
    error
}

/// The rates at the begin: evaluated if they are not known, and then as they stand.
fn first_rates(frame: &mut Frame, time: Value, state: &[Value], file: &mut [Value]) -> Vec<Value> {
    let fresh = frame.emitter.load_whole(frame.way, place::FRESH);
    let after = frame.emitter.begin_if(fresh);
    let found = frame.evaluate(&frame.program.rates, time, state, &mut file.to_vec());
    for (v, &rate) in found.iter().enumerate() {
        frame.emitter.store(rate, frame.rates, v * frame.stride);
    }
    frame.emitter.end_if(after);
    (0..state.len()).map(|v| frame.emitter.load(frame.rates, v * frame.stride)).collect()
}

/// The state at which a stage has its rates: begin + step·Σ weight·stage. The latest stage comes last, in two operations of
/// its own, so that little waits for it.
fn arguments(
    frame: &mut Frame,
    weights: &[f64],
    begin: Kept,
    stages: &[Kept],
    rates: &[Value],
    step: Value,
) -> Vec<Value> {
    let (last, earlier) = weights.split_last().expect("every stage has weights");
    let steps = frame.emitter.twice(step);
    let mut sums: Vec<Value> = (0..rates.len().div_ceil(2)).map(|pair| frame.emitter.kept(begin, pair)).collect();
    if !earlier.is_empty() {
        for (pair, sum) in sums.iter_mut().enumerate() {
            let change = frame.sum(earlier, stages, pair);
            let change = frame.emitter.mul(steps, change);
            *sum = frame.emitter.add(*sum, change);
        }
    }
    let sums = frame.emitter.split(&sums, rates.len());
    let last = frame.emitter.number(*last);
    let last = frame.emitter.mul(step, last);
    let end = |(&sum, &rate): (&Value, &Value)| {
        let change = frame.emitter.mul(last, rate);
        frame.emitter.add(sum, change)
    };
    sums.iter().zip(rates).map(end).collect()
}
