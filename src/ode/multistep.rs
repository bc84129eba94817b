//! Solvers of the crate diffsol for a single system without events, fed from the same program as our own.

use std::cell::{Cell, RefCell};

use diffsol::{
    NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason, Vector,
};

use super::scheme::Scheme;
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

/// Solves with one of diffsol's methods, from the initial values.
pub fn solve(
    program: &Program,
    scheme: Scheme,
    from: f64,
    until: f64,
    points: &[f64],
    tolerances: &Tolerances,
    each: &mut dyn FnMut(f64, &[f64]),
) -> Result<Work, OdeTrouble> {
    let machine = Machine::new(program);
    let initial: Vec<f64> = program.variables.iter().map(|&quantity| program.initial[quantity as usize]).collect();
    let failed = |error: diffsol::error::DiffsolError| trouble(program, from, Reason::Solver, error.to_string());
    let problem = OdeBuilder::<Matrix>::new()
        .t0(from)
        .rtol(tolerances.relative)
        .atol(program.sizes.iter().map(|size| tolerances.absolute * size))
        .rhs_implicit(
            |state: &[f64], _: &[f64], time: f64, rates: &mut [f64]| machine.rates(state, time, rates),
            |state: &[f64], _: &[f64], time: f64, vector: &[f64], product: &mut [f64]| {
                machine.jacobian_times(state, time, vector, product);
            },
        )
        .init(|_: &[f64], _: f64, state: &mut [f64]| state.copy_from_slice(&initial), initial.len())
        .build()
        .map_err(failed)?;
    let course = Course { machine: &machine, until, points, most: tolerances.max_steps, each };
    match scheme {
        Scheme::Bdf => course.run(problem.bdf::<Factors>().map_err(failed)?),
        Scheme::Esdirk34 => course.run(problem.esdirk34::<Factors>().map_err(failed)?),
        Scheme::TrBdf2 => course.run(problem.tr_bdf2::<Factors>().map_err(failed)?),
        Scheme::Tsit45 | Scheme::OneStep(_) => course.run(problem.tsit45().map_err(failed)?),
    }
}

struct Course<'a> {
    machine: &'a Machine<'a>,
    until: f64,
    points: &'a [f64],
    most: u32,
    each: &'a mut dyn FnMut(f64, &[f64]),
}

impl Course<'_> {
    fn run<'p, Equations, Solver>(self, mut solver: Solver) -> Result<Work, OdeTrouble>
    where
        Equations: OdeEquations<T = f64, V = NalgebraVec<f64>> + 'p,
        Solver: OdeSolverMethod<'p, Equations>,
    {
        let program = self.machine.program;
        let (mut work, mut written) = (Work::default(), 0);
        let fail =
            |time: f64, error: diffsol::error::DiffsolError| trouble(program, time, Reason::Solver, error.to_string());
        let begin = solver.state().t;
        solver.set_stop_time(self.until).map_err(|error| fail(begin, error))?;
        let mut reason = OdeSolverStopReason::InternalTimestep;
        loop {
            let time = solver.state().t;
            while let Some(&point) = self.points.get(written).filter(|point| **point <= time) {
                let state = solver.interpolate(point).map_err(|error| fail(time, error))?;
                (self.each)(point, &self.machine.observe(&state.clone_as_vec(), point));
                written += 1;
            }
            if matches!(reason, OdeSolverStopReason::TstopReached) || time >= self.until {
                break;
            }
            let before = solver.state().y.clone_as_vec();
            let worst = || self.machine.fastest(&before, time);
            reason = solver.step().map_err(|error| OdeTrouble { variable: worst(), ..fail(time, error) })?;
            if !solver.state().y.clone_as_vec().iter().all(|value| value.is_finite()) {
                let trouble = trouble(program, time, Reason::NotFinite, String::new());
                return Err(OdeTrouble { variable: worst(), ..trouble });
            }
            work.steps += 1;
            if work.steps >= u64::from(self.most) {
                return Err(trouble(program, time, Reason::TooManySteps, String::new()));
            }
        }
        let statistics = solver.get_statistics();
        work.rejected = statistics.number_of_error_test_failures as u64;
        work.rates = self.machine.asked.get();
        work.jacobians = statistics.number_of_linear_solver_setups as u64;
        Ok(work)
    }
}

fn trouble(program: &Program, time: f64, reason: Reason, detail: String) -> OdeTrouble {
    OdeTrouble { system: program.name.clone(), cell: None, time, variable: None, reason, detail }
}
