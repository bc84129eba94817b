//! Solvers of the crate diffsol for a single system without events, fed from the same program as our own.

use std::cell::{Cell, RefCell};

use diffsol::{
    NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason, Vector,
};

use super::pieces::{Piece, Pieces};
use super::scheme::Scheme;
use super::switches::LOOKS_IN_SOLVE;
use super::{OdeTrouble, Reason, Tolerances, Work};
use crate::equations::program::{Lanes, Program, run};

type Matrix = NalgebraMat<f64>;
type Factors = NalgebraLU<f64>;

/// The program with registers, for closures that may not change anything.
pub struct Machine<'a> {
    program: &'a Program,
    file: RefCell<Vec<Lanes<1>>>,
    /// Time and state of the Jacobian's entries, and the entries.
    known: RefCell<(Vec<f64>, Vec<f64>)>,
    /// How often the rates were asked for.
    asked: Cell<u64>,
}

impl<'a> Machine<'a> {
    /// A program with all open quantities at their initial values.
    pub fn new(program: &'a Program) -> Self {
        Self { program, file: RefCell::new(program.file()), known: RefCell::default(), asked: Cell::new(0) }
    }

    /// Rates at a state and time.
    pub fn rates(&self, state: &[f64], time: f64, rates: &mut [f64]) {
        self.asked.set(self.asked.get() + 1);
        let mut file = self.file.borrow_mut();
        set(&mut file, state, time);
        run(&self.program.rates, &mut file);
        rates.iter_mut().zip(&self.program.rates.outputs).for_each(|(to, &from)| *to = file[from as usize][0]);
    }

    /// The Jacobian at a state and time, times a vector.
    pub fn jacobian_times(&self, state: &[f64], time: f64, vector: &[f64], product: &mut [f64]) {
        let mut known = self.known.borrow_mut();
        let (state_and_time, entries) = &mut *known;
        let same = state_and_time.split_last().is_some_and(|(last, rest)| *last == time && rest == state);
        if !same {
            let mut file = self.file.borrow_mut();
            set(&mut file, state, time);
            run(&self.program.linear, &mut file);
            entries.clear();
            entries.extend(self.program.linear.outputs[2 * state.len()..].iter().map(|&at| file[at as usize][0]));
            state_and_time.clear();
            state_and_time.extend(state.iter().copied().chain([time]));
        }
        product.fill(0.0);
        for (&(row, column), &entry) in self.program.pattern.iter().zip(entries.iter()) {
            product[row as usize] += entry * vector[column as usize];
        }
    }

    /// The variable that changes fastest for its size: the one to blame when no step is short enough.
    fn fastest(&self, state: &[f64], time: f64) -> Option<String> {
        let mut rates = vec![0.0; state.len()];
        self.rates(state, time, &mut rates);
        let pace =
            |variable: usize| match rates[variable].abs() / (state[variable].abs() + self.program.sizes[variable]) {
                pace if pace.is_nan() => f64::INFINITY,
                pace => pace,
            };
        let worst = (0..state.len()).max_by(|&a, &b| pace(a).total_cmp(&pace(b)))?;
        Some(self.program.names[self.program.variables[worst] as usize].clone())
    }

    /// Values of all quantities.
    fn observe(&self, state: &[f64], time: f64) -> Vec<f64> {
        let mut file = self.file.borrow_mut();
        set(&mut file, state, time);
        run(&self.program.observe, &mut file);
        self.program.observe.outputs.iter().map(|&register| file[register as usize][0]).collect()
    }
}

fn set(file: &mut [Lanes<1>], state: &[f64], time: f64) {
    file[0] = [time];
    file[1..].iter_mut().zip(state).for_each(|(to, &from)| *to = [from]);
}

/// Solves with one of diffsol's methods, from the initial values. What the clock switches is met exactly: the method, which goes by what was before,
/// begins anew after it.
pub fn solve(
    program: &Program,
    scheme: Scheme,
    (from, until): (f64, f64),
    points: &[f64],
    tolerances: &Tolerances,
    each: &mut dyn FnMut(f64, &[f64]),
) -> Result<Work, OdeTrouble> {
    let state = program.variables.iter().map(|&quantity| program.initial[quantity as usize]).collect();
    let (machine, work) = (Machine::new(program), Work::default());
    let mut course = Course { machine: &machine, scheme, tolerances, time: from, state, points, work, each };
    course.write_until(from);
    for Piece { begin, end, until } in Pieces::new(program, (from, until), LOOKS_IN_SOLVE, None) {
        course.time = begin;
        course.run(end)?;
        course.write_until(until);
    }
    course.work.rates = machine.asked.get();
    Ok(course.work)
}

/// A piece shorter than this share of its time is gone through by Euler's rule.
const SHORT: f64 = 64.0 * f64::EPSILON;

/// A solve, as far as it has come.
struct Course<'a> {
    machine: &'a Machine<'a>,
    scheme: Scheme,
    tolerances: &'a Tolerances,
    time: f64,
    state: Vec<f64>,
    /// Those that are still to be written.
    points: &'a [f64],
    work: Work,
    each: &'a mut dyn FnMut(f64, &[f64]),
}

impl Course<'_> {
    /// Writes the points until a time with the present state.
    fn write_until(&mut self, time: f64) {
        while let Some((&point, rest)) = self.points.split_first().filter(|(point, _)| **point <= time) {
            (self.each)(point, &self.machine.observe(&self.state, point));
            self.points = rest;
        }
    }

    /// Goes on until a time, before which the clock switches nothing.
    fn run(&mut self, until: f64) -> Result<(), OdeTrouble> {
        let (program, from) = (self.machine.program, self.time);
        if until - from <= SHORT * until.abs() {
            let mut rates = vec![0.0; self.state.len()];
            self.machine.rates(&self.state, from, &mut rates);
            let length = (until - from).max(0.0);
            self.state.iter_mut().zip(rates).for_each(|(value, rate)| *value += length * rate);
            return Ok(());
        }
        let failed = |error: diffsol::error::DiffsolError| trouble(program, from, Reason::Solver, error.to_string());
        let (machine, initial) = (self.machine, self.state.clone());
        let problem = OdeBuilder::<Matrix>::new()
            .t0(from)
            .rtol(self.tolerances.relative)
            .atol(program.sizes.iter().map(|size| self.tolerances.absolute * size))
            .rhs_implicit(
                |state: &[f64], _: &[f64], time: f64, rates: &mut [f64]| machine.rates(state, time, rates),
                |state: &[f64], _: &[f64], time: f64, vector: &[f64], product: &mut [f64]| {
                    machine.jacobian_times(state, time, vector, product);
                },
            )
            .init(|_: &[f64], _: f64, state: &mut [f64]| state.copy_from_slice(&initial), initial.len())
            .build()
            .map_err(failed)?;
        match self.scheme {
            Scheme::Bdf => self.steps(problem.bdf::<Factors>().map_err(failed)?, until),
            Scheme::Esdirk34 => self.steps(problem.esdirk34::<Factors>().map_err(failed)?, until),
            Scheme::TrBdf2 => self.steps(problem.tr_bdf2::<Factors>().map_err(failed)?, until),
            Scheme::Tsit45 | Scheme::OneStep(_) => self.steps(problem.tsit45().map_err(failed)?, until),
        }
    }

    /// The steps of a solver until a time.
    fn steps<'p, Equations, Solver>(&mut self, mut solver: Solver, until: f64) -> Result<(), OdeTrouble>
    where
        Equations: OdeEquations<T = f64, V = NalgebraVec<f64>> + 'p,
        Solver: OdeSolverMethod<'p, Equations>,
    {
        let program = self.machine.program;
        let fail =
            |time: f64, error: diffsol::error::DiffsolError| trouble(program, time, Reason::Solver, error.to_string());
        solver.set_stop_time(until).map_err(|error| fail(self.time, error))?;
        let mut reason = OdeSolverStopReason::InternalTimestep;
        loop {
            let time = solver.state().t;
            while let Some((&point, rest)) = self.points.split_first().filter(|(point, _)| **point <= time) {
                let state = solver.interpolate(point).map_err(|error| fail(time, error))?;
                (self.each)(point, &self.machine.observe(&state.clone_as_vec(), point));
                self.points = rest;
            }
            if matches!(reason, OdeSolverStopReason::TstopReached) || time >= until {
                break;
            }
            let before = solver.state().y.clone_as_vec();
            let worst = || self.machine.fastest(&before, time);
            reason = solver.step().map_err(|error| OdeTrouble { variable: worst(), ..fail(time, error) })?;
            if !solver.state().y.clone_as_vec().iter().all(|value| value.is_finite()) {
                let trouble = trouble(program, time, Reason::NotFinite, String::new());
                return Err(OdeTrouble { variable: worst(), ..trouble });
            }
            self.work.steps += 1;
            if self.work.steps >= u64::from(self.tolerances.max_steps) {
                return Err(trouble(program, time, Reason::TooManySteps, String::new()));
            }
        }
        self.state = solver.state().y.clone_as_vec();
        let statistics = solver.get_statistics();
        self.work.rejected += statistics.number_of_error_test_failures as u64;
        self.work.jacobians += statistics.number_of_linear_solver_setups as u64;
        Ok(())
    }
}

fn trouble(program: &Program, time: f64, reason: Reason, detail: String) -> OdeTrouble {
    OdeTrouble { system: program.name.clone(), cell: None, time, variable: None, reason, detail }
}
