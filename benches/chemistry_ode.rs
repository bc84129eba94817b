//! Populations of oscillators over lanes against the crate diffsol, whose solver is set to each cell's state at the begin
//! of each of its windows; the ratios that matter are printed from one run, on one thread. The same cells, start and end
//! for both, and the error of both against a run at 1e-11. A word given picks the problems and methods whose name has it.

#[path = "../tests/support/ode_problems.rs"]
mod ode_problems;

use std::cell::RefCell;
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use diffsol::{NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason};
use diffsol::{Tableau, Vector};
use pseudopod::equations::eml;
use pseudopod::equations::program::{Program, run};
use pseudopod::equations::tree::System;
use pseudopod::error::Source;
use pseudopod::ode::{Method, Population, PopulationScratch, Tolerances};

const WINDOWS: usize = 20;
/// Cells of the runs that are compared.
const CELLS: usize = 1000;
const TOLERANCE: f64 = 1e-6;
/// How often diffsol goes through all windows: long enough for a clock that ticks every few milliseconds.
const REPEATS: usize = 10;

/// Seconds that this thread has had the processor, where the system tells, so that other programs do not count; or else
/// seconds on the clock.
fn seconds() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64(), |count| 1e-9 * count)
}

/// States of all cells.
type States = Vec<Vec<f64>>;

/// A system with the length of its windows.
struct Problem {
    name: &'static str,
    program: Program,
    window: f64,
}

impl Problem {
    fn new(name: &'static str, system: &System, window: f64) -> Self {
        Self { name, program: Program::new(system).expect("no circles"), window }
    }

    fn advance(&self, population: &mut Population, relative: f64, scratch: &mut PopulationScratch) {
        let tolerances = Tolerances { relative, absolute: relative, ..Tolerances::default() };
        for window in 0..WINDOWS {
            let from = self.window * window as f64;
            let advanced = population.advance(&self.program, from, from + self.window, &tolerances, scratch);
            advanced.expect("no cell blows up");
        }
    }

    fn population(&self, method: Method, start: &[Vec<f64>]) -> Population {
        let mut population = Population::new(&self.program, start.len(), method);
        for (cell, state) in start.iter().enumerate() {
            state.iter().enumerate().for_each(|(v, &value)| population.set_state(cell, v, value));
        }
        population
    }

    /// Cells spread along their course: each starts a little elsewhere and has run for a while.
    fn spread(&self) -> States {
        let at = |v: usize| self.program.initial[self.program.variables[v] as usize];
        let factor = |cell: usize, v: usize| 1.0 + 0.3 * (cell as f64 * 0.7 + v as f64).sin();
        let cell = |cell| (0..self.program.size()).map(|v| at(v) * factor(cell, v)).collect();
        let start: States = (0..CELLS).map(cell).collect();
        let mut population = self.population(Method::Rosenbrock, &start);
        self.advance(&mut population, TOLERANCE, &mut PopulationScratch::default());
        states(&population, self.program.size())
    }

    /// Microseconds a cell-window, and the states at the end.
    fn ours(&self, method: Method, start: &[Vec<f64>], relative: f64) -> (f64, States) {
        let fresh = self.population(method, start);
        let (time, population) = self.timed(&[fresh], 100_000 / start.len(), relative);
        (time / start.len() as f64, states(&population, self.program.size()))
    }

    /// The states at the end.
    fn end(&self, method: Method, start: &[Vec<f64>], relative: f64) -> States {
        let mut population = self.population(method, start);
        self.advance(&mut population, relative, &mut PopulationScratch::default());
        states(&population, self.program.size())
    }

    /// Microseconds a window of a population of one cell, on average over cells.
    fn alone(&self, method: Method, start: &[Vec<f64>], relative: f64) -> f64 {
        let fresh: Vec<Population> = start.chunks(1).map(|cell| self.population(method, cell)).collect();
        self.timed(&fresh, 100, relative).0 / start.len() as f64
    }

    /// Microseconds a window of all populations together, and the last of them at the end.
    fn timed(&self, fresh: &[Population], repeats: usize, relative: f64) -> (f64, Population) {
        let (mut best, mut population) = (f64::INFINITY, fresh[0].clone());
        let mut scratch = PopulationScratch::default();
        for _ in 0..5 {
            // Long enough for a clock that ticks every few milliseconds.
            let began = seconds();
            for _ in 0..repeats.max(1) {
                for fresh in fresh {
                    population.copy_from(fresh);
                    self.advance(&mut population, relative, &mut scratch);
                }
            }
            best = best.min((seconds() - began) / repeats.max(1) as f64);
        }
        (1e6 * best / WINDOWS as f64, population)
    }

    /// As [`Self::ours`], by diffsol. Nothing if it gives up.
    fn theirs(&self, which: Theirs, start: &States, relative: f64) -> Option<(f64, States)> {
        let (program, n, file) = (&self.program, self.program.size(), RefCell::new(self.program.file::<1>()));
        let present = RefCell::new(start[0].clone());
        let rates = |x: &[f64], _: &[f64], t: f64, y: &mut [f64]| {
            let mut file = file.borrow_mut();
            file[0] = [t];
            (0..n).for_each(|v| file[1 + v] = [x[v]]);
            run(&program.rates, &mut file);
            (0..n).for_each(|v| y[v] = file[program.rates.outputs[v] as usize][0]);
        };
        let product = |x: &[f64], _: &[f64], t: f64, vector: &[f64], y: &mut [f64]| {
            let mut file = file.borrow_mut();
            file[0] = [t];
            (0..n).for_each(|v| file[1 + v] = [x[v]]);
            run(&program.linear, &mut file);
            y.fill(0.0);
            for (&(row, column), &register) in program.pattern.iter().zip(&program.linear.outputs[2 * n..]) {
                y[row as usize] += file[register as usize][0] * vector[column as usize];
            }
        };
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(relative)
            .atol(vec![relative; n])
            .rhs_implicit(rates, product)
            .init(|_: &[f64], _: f64, y: &mut [f64]| y.copy_from_slice(&present.borrow()), n)
            .build()
            .ok()?;
        let tableau = Tableau::tsit45();
        let (mut tsit45, mut bdf) = (problem.tsit45().ok()?, problem.bdf::<NalgebraLU<f64>>().ok()?);
        let (mut end, mut steps) = (start.clone(), vec![0.0; start.len()]);
        let began = seconds();
        // BDF gives up sooner or later if it goes on from one course to the next.
        let repeats = if which == Theirs::Bdf { 1 } else { REPEATS };
        for _ in 0..repeats {
            end.clone_from(start);
            steps.fill(0.0);
            for _ in 0..WINDOWS {
                for (cell, step) in end.iter_mut().zip(&mut steps) {
                    present.borrow_mut().copy_from_slice(cell);
                    match which {
                        Theirs::Bdf => {
                            bdf.set_state(problem.bdf_state::<NalgebraLU<f64>>().ok()?);
                            // Touched, so that the solver works out its table of differences anew.
                            let _ = bdf.state_mut();
                            to_the_end(&mut bdf, self.window, cell)?;
                        }
                        Theirs::Tsit45Kept if *step > 0.0 => {
                            let state = tsit45.state_mut();
                            (*state.t, *state.h) = (0.0, *step);
                            state.y.batch_as_mut_slice(0).copy_from_slice(cell);
                            rates(cell, &[], 0.0, state.dy.batch_as_mut_slice(0));
                            *step = to_the_end(&mut tsit45, self.window, cell)?;
                        }
                        Theirs::Tsit45 | Theirs::Tsit45Kept => {
                            tsit45.set_state(problem.rk_state(&tableau).ok()?);
                            *step = to_the_end(&mut tsit45, self.window, cell)?;
                        }
                    }
                }
            }
        }
        Some((1e6 * (seconds() - began) / (repeats * WINDOWS * end.len()) as f64, end))
    }
}

fn states(population: &Population, n: usize) -> States {
    (0..population.cells()).map(|cell| (0..n).map(|v| population.state(cell, v)).collect()).collect()
}

/// How diffsol is used.
#[derive(Clone, Copy, PartialEq)]
enum Theirs {
    /// Its explicit pair, with a new state each window, as it makes them.
    Tsit45,
    /// The same with each cell's last step put back by hand.
    Tsit45Kept,
    /// Backward differentiation, with a new state each window.
    Bdf,
}

/// Solves to the end of the window; returns the longest step.
fn to_the_end<'p, E, S>(solver: &mut S, window: f64, cell: &mut [f64]) -> Option<f64>
where
    E: OdeEquations<T = f64, V = NalgebraVec<f64>> + 'p,
    S: OdeSolverMethod<'p, E>,
{
    solver.set_stop_time(window).ok()?;
    let (mut longest, mut time) = (0.0_f64, 0.0);
    loop {
        let reason = solver.step().ok()?;
        longest = longest.max(solver.state().t - time);
        time = solver.state().t;
        if matches!(reason, OdeSolverStopReason::TstopReached) {
            break;
        }
    }
    cell.copy_from_slice(&solver.state().y.clone_as_vec());
    Some(longest)
}

/// Root mean square over cells and variables of the difference over the largest value of the variable.
fn error(found: &States, exact: &States) -> f64 {
    let n = exact[0].len();
    let size: Vec<f64> = (0..n).map(|v| exact.iter().map(|cell| cell[v].abs()).fold(0.0, f64::max)).collect();
    let square = |(a, b): (&Vec<f64>, &Vec<f64>)| (0..n).map(|v| ((a[v] - b[v]) / size[v]).powi(2)).sum::<f64>();
    (found.iter().zip(exact).map(square).sum::<f64>() / (n * exact.len()) as f64).sqrt()
}

/// Tolerances from tight to loose, eight a power of ten.
fn tolerances() -> impl Iterator<Item = f64> {
    (24..=88).rev().map(|eighth| 10_f64.powf(-0.125 * f64::from(eighth)))
}

/// Both at the tolerance asked, and then ours at the loosest that is, with all tighter ones, at least as accurate as theirs was.
fn compare(problem: &Problem, method: Method, whiches: &[(Theirs, &str)]) {
    let name = format!("{}, {method:?}", problem.name);
    if std::env::args().skip(1).any(|wanted| !wanted.starts_with('-') && !name.contains(&wanted)) {
        return;
    }
    let start = problem.spread();
    let exact = problem.end(Method::Rosenbrock, &start, 1e-11);
    let many: States = (0..100 * CELLS).map(|cell| start[cell % CELLS].clone()).collect();
    let at = |tolerance: f64| {
        let (thousand, end) = problem.ours(method, &start, tolerance);
        let alone = problem.alone(method, &start, tolerance);
        ([alone, thousand, problem.ours(method, &many, tolerance).0], error(&end, &exact))
    };
    let same = at(TOLERANCE);
    println!("{name}: error {:.1e}; µs a cell-window of 1, 1 000, 100 000 cells: {:.3?}", same.1, same.0);
    for (which, label) in whiches {
        let runs: Vec<_> = (0..5).filter_map(|_| problem.theirs(*which, &start, TOLERANCE)).collect();
        let Some((time, end)) = runs.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
            println!("  {label} gives up");
            continue;
        };
        let their_error = error(&end, &exact);
        let ratios = same.0.map(|ours| time / ours);
        println!("  {label}: {time:.2} µs, error {their_error:.1e}; ratios {ratios:.1?}");
        let as_good = |tolerance: &f64| error(&problem.end(method, &start, *tolerance), &exact) <= their_error;
        // Not the first loose one by chance: all tighter ones are as accurate too.
        match tolerances().take_while(as_good).last() {
            Some(tolerance) => {
                let (times, error) = at(tolerance);
                let ratios = times.map(|ours| time / ours);
                println!(
                    "    at equal error: ours at {tolerance:.1e}: error {error:.1e}, µs {times:.3?}; ratios {ratios:.1?}"
                );
            }
            None => println!("    at equal error: ours is never so accurate"),
        }
    }
}

/// The oscillators that ship as a document.
fn rac_rhoa() -> System {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/eml/rac_rhoa.eml");
    let text = std::fs::read_to_string(path).expect("a document of the repository");
    eml::read(Arc::new(Source { name: path.into(), text })).expect("a document without faults").system
}

fn main() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    one.install(|| {
        let explicit = [(Theirs::Tsit45, "diffsol tsit45"), (Theirs::Tsit45Kept, "diffsol tsit45, steps kept by hand")];
        let implicit = [(Theirs::Bdf, "diffsol BDF")];
        // A tenth of the oscillators' time scale of 15 s.
        let pair = Problem::new("RAC1/RHOA, windows of 1.5 s", &rac_rhoa(), 1.5);
        let per = Problem::new("Goldbeter's PER, windows of 0.1 h", &ode_problems::goldbeter_per(), 0.1);
        let cyclic = Problem::new("Martiel–Goldbeter, windows of 0.1 min", &ode_problems::martiel_goldbeter(), 0.1);
        for problem in [&pair, &per, &cyclic] {
            compare(problem, Method::Rk45, &explicit);
            compare(problem, Method::Rk65, &explicit);
            compare(problem, Method::Rosenbrock, &implicit);
        }
        let stiff = ode_problems::van_der_pol_pair(100.0);
        let stiff = Problem::new("van der Pol pair, µ = 100, windows of 0.1", &stiff, 0.1);
        compare(&stiff, Method::Rosenbrock, &implicit);
    });
}
